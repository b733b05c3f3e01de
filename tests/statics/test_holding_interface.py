"""Held states: what has no result, what is refused, how results are arranged."""

import numpy as np
import pytest
from held_tubes import MUSCLE, SECTION, VARYING, B, tube

from freesweep import (
    ActuatorError,
    blocked_force,
    blocked_torque,
    corrected_torque,
)
from freesweep.status import COMPRESSED, OK


def test_a_wall_that_would_have_to_be_pushed_has_no_blocked_force():
    """Region I at any pressure; extensible fibers below a pressure (theory, section 5)."""
    for held in (blocked_force(tube(10, 50), [1e3, 1e5]), blocked_force(MUSCLE, [2e3, 6e3])):
        assert (held["status"] == COMPRESSED).all()
        assert np.isnan(held["force"]).all()
        assert np.isnan(held["deformed_radius"]).all()
    above = blocked_force(MUSCLE, 8.3e3)
    assert above["status"] == OK
    assert -SECTION * 8.3e3 < above["force"] < 0  # pushed, but not the wall: p + f > 0


@pytest.mark.parametrize(("actuator", "pressure", "length"), [(MUSCLE, 7.95e3, 0.192), (MUSCLE, 7.968e3, 0.192)])
def test_edge_of_compression_has_no_result(actuator, pressure, length):
    assert blocked_force(actuator, pressure, length)["status"] == COMPRESSED


def test_held_quantity_load_and_pressure_make_dimensions():
    lengths, torques, pressures = [0.19, 0.192], [0.0, 1e-3], [5e4, 2e4, 8e4]
    held = blocked_force(tube(20, -50, 0.192), pressures, lengths, torques, x=[0.0, 0.1])
    assert held["force"].dims == ("deformed_length", "torque", "pressure")
    assert held["twist"].dims == ("deformed_length", "torque", "pressure", "x")
    assert "deformed_length_error" not in held
    units = {
        "force": "N",
        "force_error": "N",
        "deformed_length": "m",
        "rotation": "degree",
        "torque": "N m",
        "pressure": "Pa",
    }
    assert {name: held[name].attrs["units"] for name in units} == units
    one = blocked_force(tube(20, -50, 0.192), 2e4, 0.19, 1e-3)
    assert set(one.dims) == {"x"}
    same = held["force"].sel(deformed_length=0.19, torque=1e-3, pressure=2e4)
    assert abs(one["force"] - same) <= 2 * one["force_error"] + 1e-12
    turned = blocked_torque(B, 2e4, [0.0, 5.0], [0.0, 1.0])
    assert turned["torque"].dims == ("rotation", "force")
    assert turned["torque"].attrs["units"] == turned["torque_error"].attrs["units"] == "N m"
    assert turned["twist"][:, :, -1].values == pytest.approx(np.array([[0, 0], [5, 5]]), abs=1e-5)


@pytest.mark.parametrize("muscle", [tube(30, -30), tube([(0, 20), (1, 40)], [(0, -20), (1, -40)])])
def test_muscles_have_no_rotation_to_hold(muscle):
    with pytest.raises(ActuatorError, match=r"bonded fibers with alpha = -beta does not rotate.*use blocked_force"):
        blocked_torque(muscle, 1e4)


def test_what_is_held_twice_is_answered_twice():
    twice = blocked_force(B, [1e5, 1e5], [0.131, 0.125, 0.131], x=0.0)
    once = blocked_force(B, 1e5, [0.125, 0.131], x=0.0)["force"].values
    assert twice["deformed_length"].values.tolist() == [0.131, 0.125, 0.131]
    for row in twice["force"].transpose("pressure", "deformed_length").values:
        np.testing.assert_array_equal(row, once[[1, 0, 1]])


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda: blocked_force(B, -1.0, [0.1, 0.1], "1 m", x=[0.2], accuracy=1.0),
            ["torque: expects a torque", "pressure: found -1", "accuracy: found 1", "x: give ascending stations"],
        ),
        (lambda: blocked_force(B, -2.0, 0.0), ["pressure: found -2", "deformed_length: found 0"]),
        (lambda: blocked_torque(B, [1e4], np.nan, [[1]]), ["rotation: found nan", "force: found an array of shape (1, 1)"]),
        (lambda: blocked_force(B, 1e4, rotation=0.0), ["rotation: length and rotation are held both"]),
        (lambda: blocked_torque(B, 1e4, deformed_length=0.131), ["deformed_length: length and rotation are held both"]),
        (lambda: blocked_torque("tube", 1e4), ["tube: found str 'tube'; give an Actuator"]),
        (lambda: blocked_torque(VARYING[0], 1e4, buckled=True), ["buckled: only a tube that is the same all along"]),
        (lambda: corrected_torque(tube(10, 50), 1e4), ["tube: the source's correction is for alpha = 0"]),
        (lambda: corrected_torque(B, -1e4), ["pressure: found -"]),
    ],
)  # fmt: skip
def test_every_fault_of_a_held_state_is_listed(call, says):
    with pytest.raises(ActuatorError) as caught:
        call()
    assert len(caught.value.faults) == len(says)
    for start in says:
        assert any(fault.startswith(start) for fault in caught.value.faults), start

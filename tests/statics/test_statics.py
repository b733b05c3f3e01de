"""One actuator in SI units: what the source and the theory say, what the interface promises, what it refuses."""

import dataclasses

import numpy as np
import pytest

from freesweep import Actuator, ActuatorError, MooneyRivlin, inflate, lock
from freesweep.atlas.schema import FLAG_OF, PROFILES, STATUS_OF, VARIABLES, attributes
from freesweep.status import BEYOND_LIMIT, COMPRESSED, OK, VALUED

RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)  # of the source's prototypes A, B, C
OUTPUTS = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")


def tube(alpha, beta, length=0.141, **more):
    given = {"length": length, "radius": 4.76e-3, "wall": 1.59e-3, "material": RUBBER}
    return Actuator(**{"alpha": alpha, "beta": beta} | given | more)


A, B, C = tube(10, 50), tube(0, 30, 0.131), tube(0, 60, 0.143)


def principal(actuator):
    return dataclasses.replace(actuator, energy="principal")


def contraction(actuator, pressures):
    return 1 - inflate(actuator, pressures)["deformed_length"].values / actuator.length


def test_prototypes_of_the_source():
    """Section 2.4: A first extends, then contracts; B and C contract less than 5 % up to 0.1 and 0.2 MPa."""
    assert contraction(C, 0.2e6) == pytest.approx(0.044, abs=5e-4)
    assert contraction(principal(C), 0.2e6) == pytest.approx(0.101, abs=5e-4)
    up_to = np.linspace(0, 0.1e6, 11)
    for energy in (B, principal(B)):
        assert np.all(np.diff(contraction(energy, up_to)) > 0)
        assert contraction(energy, up_to)[-1] < 0.05
    pressures = np.linspace(0, 0.2e6, 81)
    for energy, turn in ((principal(A), 0.085e6), (A, 0.12e6)):
        length = inflate(energy, pressures)["deformed_length"].values
        top = int(np.argmax(length))
        assert pressures[top] == pytest.approx(turn, abs=2.5e3)
        assert np.all(np.diff(length[: top + 1]) > 0)
        assert np.all(np.diff(length[top:]) < 0)


def test_without_pressure_and_load_it_is_the_undeformed_cylinder():
    actuator = tube(20, -50, fiber_extension=1.01)
    dataset = inflate(actuator, [0.0, 5e4], x=[0.0, 0.05, 0.1, 0.141]).sel(pressure=0.0)
    expected = {"deformed_length": 0.141, "rotation": 0, "mid_radius": 4.76e-3, "strain_energy": 0}
    for name, value in expected.items():
        assert dataset[name].item() == pytest.approx(value, rel=1e-15)
        assert dataset[f"{name}_error"] == 0
    np.testing.assert_allclose(dataset["axial_position"], dataset["x"], rtol=1e-15)
    np.testing.assert_allclose(dataset["deformed_radius"], 4.76e-3, rtol=1e-15)
    np.testing.assert_allclose(dataset["alpha_deformed"], 20, rtol=1e-14)
    np.testing.assert_allclose(dataset["beta_deformed"], -50, rtol=1e-14)
    assert not dataset[["twist", "fiber_tension_alpha", "fiber_tension_beta"]].to_array().any()


def test_exchanged_and_mirrored_families():
    first, second, third = (
        inflate(tube(*pair), 6e4, 1.0, torque)
        for pair, torque in (((20, -50), 0.01), ((-50, 20), 0.01), ((-20, 50), -0.01))
    )
    assert abs(first["rotation"]) > 1
    for name in (*OUTPUTS, *PROFILES):
        twin = name.replace("alpha", "#").replace("beta", "alpha").replace("#", "beta")
        np.testing.assert_allclose(second[twin], first[name], rtol=1e-10, atol=1e-14, err_msg=name)
        sign = -1 if name in ("rotation", "twist", "alpha_deformed", "beta_deformed") else 1
        np.testing.assert_allclose(third[name], sign * first[name], rtol=1e-10, atol=1e-14, err_msg=name)


def test_arrays_make_dimensions_of_their_name_in_the_order_given():
    pressures, forces, torques = [8e4, 2e4, 5e4], [1.0, -0.5], [0.0, 0.01]
    grid = inflate(A, pressures, forces, torques)
    assert grid["rotation"].dims == ("force", "torque", "pressure")
    assert grid["limit_pressure"].dims == ("force", "torque")
    assert grid["twist"].dims == ("force", "torque", "pressure", "x")
    assert grid["pressure"].values.tolist() == pressures
    assert (grid["status"] == OK).all()
    for force, torque in ((1.0, 0.01), (-0.5, 0.0)):
        row = inflate(A, sorted(pressures), force, torque)
        assert row["rotation"].dims == ("pressure",)
        for name in (*OUTPUTS, *PROFILES):
            mine = grid[name].sel(force=force, torque=torque).sortby("pressure")
            np.testing.assert_array_equal(mine, row[name], err_msg=name)
    one = inflate(A, 5e4, 1.0)
    assert one["rotation"].dims == ()
    assert set(one.dims) == {"x"}
    inside = one[[*OUTPUTS]].to_array() - grid[[*OUTPUTS]].sel(pressure=5e4, force=1.0, torque=0.0).to_array()
    bounds = [one[f"{name}_error"] + grid[f"{name}_error"].sel(pressure=5e4, force=1.0, torque=0.0) for name in OUTPUTS]
    assert np.all(np.abs(inside) <= [bound.item() for bound in bounds])


def test_results_are_nan_exactly_where_the_status_gives_no_value():
    limited = inflate(principal(tube(60, 55, 0.19)), [1e5, 3e5, 1e6])
    pushed = inflate(tube(30, -30), [0.0, 1e4, 1e5], [-3.0, 0.0])
    assert limited["status"].values.tolist() == [OK, BEYOND_LIMIT, BEYOND_LIMIT]
    assert pushed["status"].values.tolist() == [[COMPRESSED, COMPRESSED, OK], [OK] * 3]
    for dataset in (limited, pushed):
        valued = dataset["status"].isin(VALUED)
        for name, variable in dataset.data_vars.items():
            if "pressure" in variable.dims and variable.dtype.kind == "f":
                assert (variable.notnull() == valued).all(), name
        assert (dataset["stable"] == valued).all()


def test_limit_pressure_in_pascals():
    """Theory, section 7: p = 1.217827 for 60/55 degrees, Lambda 40, C01/C10 = 0.5, `principal`."""
    rubber = MooneyRivlin(c10=0.2e6, c01=0.1e6)
    dataset = inflate(principal(tube(60, 55, 40 * 4.76e-3, material=rubber)), [1e5, 2.4e5, 1e6])
    assert dataset["status"].values.tolist() == [OK, OK, BEYOND_LIMIT]
    assert dataset["limit_found"] == 1
    assert dataset["limit_pressure"].item() == pytest.approx(1.217827 * 0.2e6, abs=0.2)
    assert 0 < dataset["limit_pressure_error"] < 2
    below = inflate(principal(tube(60, 55, 40 * 4.76e-3, material=rubber)), 2.4e5)
    assert below["limit_found"] == 0
    assert np.isnan(below["limit_pressure"])


def test_slack_fibers_are_flagged_and_keep_their_values():
    """With `principal`, every design of region I starts with a family that would have to push."""
    region_one = inflate(principal(A), [1e3, 1e4])
    assert (region_one["slack_fiber"] > 0).all()
    assert (region_one[["fiber_tension_alpha", "fiber_tension_beta"]].to_array().min("x") < 0).any()
    assert region_one["deformed_length"].notnull().all()
    muscle = inflate(tube(30, -30), [1e3, 1e5])
    assert (muscle["slack_fiber"] == 0).all()
    assert (muscle["fiber_tension_alpha"] > 0).all()


def test_a_fiber_without_tension_is_not_slack():
    """Straight alpha fibers: the beta family is free of tension at the very end, and pulls everywhere else."""
    for beta in (60, 70, 80):
        dataset = inflate(tube(0, beta), np.linspace(0.0, 0.2e6, 41))
        assert dataset["fiber_tension_beta"].min() > -1e-12
        assert (dataset["slack_fiber"] == 0).all()


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9])
def test_the_accuracy_asked_for_is_met(accuracy):
    dataset = inflate(A, 1e5, accuracy=accuracy)
    assert dataset.attrs["accuracy"] == accuracy
    reference = inflate(A, 1e5, accuracy=1e-10)
    for name, size in zip(OUTPUTS, (0.141, 57.3, 4.76e-3, None, None)):
        error, bound = abs(dataset[name] - reference[name]), dataset[f"{name}_error"]
        assert bound <= 1.1 * accuracy * max(size or 0, abs(reference[name].item())), name
        assert error <= bound + reference[f"{name}_error"], name


@pytest.mark.parametrize("locked", [True, False])
def test_every_variable_is_described_by_the_schema(locked):
    solved = lock(tube(20, -50)) if locked else inflate(tube(20, -50), [0.0, 1e4], [0.0, 1.0])
    outputs = [name for name in VARIABLES if name in solved]
    assert set(outputs) >= set(OUTPUTS)
    assert ("limit_pressure" in outputs) != locked
    outputs += PROFILES
    known = {*outputs, *(f"{name}_error" for name in outputs), "status", *FLAG_OF, *solved.coords}
    known -= {"blocked_force_stable", "blocked_torque_stable"}
    assert set(solved.variables) == known - ({"limit_found"} if locked else set())
    for name, variable in solved.variables.items():
        if locked and name.startswith(("fiber_tension", "least_tension")):
            assert variable.attrs["units"] == "N/Pa"
        else:
            assert variable.attrs == attributes(name)
        assert variable.dtype == (np.int8 if name in STATUS_OF or name in FLAG_OF else np.float64)


def test_stations_are_where_they_are_asked_for():
    default = inflate(A, 1e5)
    assert default["x"].values == pytest.approx(np.linspace(0, 0.141, 201))
    for stations in (0.0705, [0.0, 0.141], np.array([0.0, 0.00705, 0.0705])):
        few = inflate(A, 1e5, x=stations)
        assert few["x"].values.tolist() == np.atleast_1d(stations).tolist()
        for name in PROFILES:
            np.testing.assert_allclose(few[name], default[name].sel(x=few["x"], method="nearest"), rtol=1e-9, atol=1e-9)
    assert default["axial_position"][-1] == pytest.approx(default["deformed_length"].item(), rel=1e-12)
    assert default["twist"][-1] == pytest.approx(default["rotation"].item(), rel=1e-12)
    assert default["deformed_radius"].sel(x=0.0705).item() == pytest.approx(default["mid_radius"].item(), rel=1e-9)


def test_a_load_that_stands_twice_is_answered_twice_in_the_order_given():
    """As of a bench that went up and down."""
    up_and_down = [5e4, 2e4, 5e4, 0.0, 2e4]
    found = inflate(A, up_and_down, force=[1.0, 0.0, 1.0], x=0.0, derivatives=["pressure"])
    assert found["pressure"].values.tolist() == up_and_down
    assert found["force"].values.tolist() == [1.0, 0.0, 1.0]
    once = inflate(A, [0.0, 2e4, 5e4], force=[0.0, 1.0], x=0.0, derivatives=["pressure"])
    expected = once.isel(pressure=[2, 1, 2, 0, 1], force=[1, 0, 1])
    assert set(found.data_vars) == set(expected.data_vars)
    for name in found.data_vars:
        np.testing.assert_array_equal(found[name].values, expected[name].values, err_msg=name)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"pressure": -1.0}, ["pressure: found -1 Pa; it has to be 0 or more"]),
        ({"pressure": []}, ["pressure: found an array of shape (0,)"]),
        ({"pressure": [[1.0]]}, ["pressure: found an array of shape (1, 1)"]),
        ({"pressure": "1 mm"}, ["pressure: expects a pressure such as '0.1 MPa', got '1 mm', a length"]),
        ({"pressure": True}, ["pressure: found bool True"]),
        ({"pressure": 1.0, "x": [0.1, 0.05]}, ["x: give ascending stations from 0 to the undeformed length 0.141 m"]),
        ({"pressure": 1.0, "x": 0.142}, ["x: give ascending stations"]),
        ({"pressure": 1.0, "x": np.nan}, ["x: give ascending stations"]),
        ({"pressure": 1.0, "accuracy": 1e-11}, ["accuracy: found 1e-11; give a value from 1e-10 to 0.01"]),
        (
            {"pressure": None, "force": [np.nan], "torque": "1 m", "x": [], "accuracy": 1.0},
            ["force: ", "torque: ", "pressure: ", "accuracy: ", "x: "],
        ),
    ],
)
def test_every_fault_of_the_load_is_listed(given, says):
    with pytest.raises(ActuatorError) as caught:
        inflate(A, **given)
    assert len(caught.value.faults) == len(says)
    for fault, start in zip(caught.value.faults, says):
        assert fault.startswith(start)


def test_only_actuators_are_solved():
    with pytest.raises(ActuatorError, match="tube: found str 'tube'; give an Actuator"):
        lock("tube")


@pytest.mark.parametrize("pressure", [["1 mm"], [True], np.array([True])])
def test_arrays_of_texts_and_truth_values_are_refused(pressure):
    with pytest.raises(ActuatorError, match="pressure"):
        inflate(A, pressure)

"""Blocked force and torque in a sweep: the states of single actuators, poles as what they are."""

import numpy as np
import pytest

import freesweep as fs
from freesweep.status import COMPRESSED, DEGENERATE, HELD_IMPOSSIBLE, OK
from freesweep.sweep.run import run_sweep
from freesweep.sweep.spec import parse

TEXT = """
[actuator]
length = "192 mm"
radius = "4.76 mm"
wall = "1.59 mm"
c10 = "0.11 MPa"
c01 = "0.06 MPa"
[axes]
alpha = [-20, 0, 30, 60]
beta = [-40, -30, 30, 40]
fiber_extension = [1.0, 1.005]
pressure = ["30 kPa", "50 kPa", "100 kPa"]
[solver]
blocked = true
"""


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    with run_sweep(parse(TEXT), tmp_path_factory.mktemp("blocked") / "atlas.nc", progress=False) as atlas:
        return atlas.data.load()


def test_blocked_force_of_the_source_muscle(data):
    point = data.sel(alpha=30, beta=-30)
    assert point["blocked_force"].sel(fiber_extension=1.005).values == pytest.approx([6.99, 14.02, 31.61], abs=0.006)
    assert point["blocked_force"].sel(fiber_extension=1.0).values == pytest.approx([10.68, 17.80, 35.59], abs=0.006)


def test_taut_fibers_give_the_closed_forms(data):
    taut = data.sel(fiber_extension=1.0)
    for name in ("blocked_force", "blocked_torque"):
        difference = np.abs(taut[name] - taut[f"ideal_{name}"])
        assert np.all(difference.values[np.isfinite(difference)] <= 1e-9 * (1.0 + np.abs(taut[name].max().item())))
        assert np.array_equal(np.isnan(taut[name]), np.isnan(taut[f"ideal_{name}"]))


def test_a_grid_point_is_the_single_actuator(data):
    material = fs.MooneyRivlin(c10=0.11e6, c01=0.06e6)
    for alpha, beta in ((-20, 40), (-20, -40), (60, -40)):
        tube = fs.Actuator(
            alpha=alpha, beta=beta, length=0.192, radius=4.76e-3, wall=1.59e-3, material=material, fiber_extension=1.005
        )
        point = data.sel(alpha=alpha, beta=beta, fiber_extension=1.005)
        for name, alone in (
            ("blocked_force", fs.blocked_force(tube, point["pressure"].values)["force"]),
            ("blocked_torque", fs.blocked_torque(tube, point["pressure"].values)["torque"]),
        ):
            assert np.array_equal(np.isnan(point[name]), np.isnan(alone))
            near = np.abs(point[name].values - alone.values) <= 2e-6 * np.abs(alone.values) + 1e-12
            assert np.all(near | np.isnan(alone.values))


def test_poles_and_region_one_are_statuses(data):
    force, torque = data["blocked_force_status"], data["blocked_torque_status"]
    assert np.all(force.sel(alpha=60, beta=30, fiber_extension=1.0) == COMPRESSED)
    assert np.all(torque.sel(alpha=30, beta=-30) == HELD_IMPOSSIBLE)
    assert np.all(force.sel(alpha=0, beta=30, fiber_extension=1.0) == HELD_IMPOSSIBLE)
    assert np.all(torque.sel(alpha=60, beta=30, fiber_extension=1.0) == OK)
    assert np.all(force.sel(alpha=30, beta=30) == DEGENERATE)
    for name in ("blocked_force", "blocked_torque"):
        assert np.array_equal(np.isnan(data[name]), data[f"{name}_status"] != OK)


def test_without_the_line_only_closed_forms_are_stored(tmp_path):
    with run_sweep(parse(TEXT.replace("true", "false")), tmp_path / "atlas.nc", progress=False) as atlas:
        assert "blocked_force" not in atlas.data
        assert "ideal_blocked_force" in atlas.data

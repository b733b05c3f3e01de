"""Held states of tubes that are the same all along: free ones whose load is sought, of any wall and threads."""

import numpy as np
import pytest

import freesweep as fs
from freesweep.solver import hold_batch
from freesweep.status import OK

C, R = 1e5, 5e-3
RUBBER = fs.MooneyRivlin(C, 0.4 * C)
OUTPUTS = "volume", "strain_energy", "mid_radius", "outer_radius", "least_tension_alpha", "slack_beta"


@pytest.fixture(autouse=True)
def no_meshes(monkeypatch):
    def never(*_):
        raise AssertionError("a mesh is needed")

    monkeypatch.setattr(hold_batch, "hold_many", never)


def tubes(model, count, seed):
    draw = np.random.default_rng(seed)
    for _ in range(count):
        alpha = draw.uniform(10.0, 75.0)
        yield fs.Actuator(
            alpha=alpha, beta=draw.choice([-alpha, draw.uniform(-75.0, -10.0)]), length=R * draw.uniform(8.0, 50.0),
            radius=R, wall=R * draw.uniform(0.05, 0.1), material=RUBBER, model=model, energy="full",
        ), C * 10 ** draw.uniform(-1.0, 0.3)  # fmt: skip


@pytest.mark.parametrize("model", ["source", "physical"])
def test_a_length_is_held_by_the_force_under_which_the_free_tube_has_it(model):
    for tube, pressure in tubes(model, 10, 5):
        force = 0.4 * np.pi * R**2 * pressure
        free = fs.inflate(tube, pressure, force=force)
        held = fs.blocked_force(tube, pressure, free["deformed_length"].item())
        assert (free["status"], held["status"], held["stable"]) == (OK, OK, 1)
        assert abs(held["force"] - force) < 1e-7 * force
        for name in OUTPUTS:
            assert abs(held[name] - free[name]) <= held[f"{name}_error"] + free[f"{name}_error"] + 1e-9 * abs(
                free[name]
            )
        for name in ("deformed_radius", "axial_position", "twist", "alpha_deformed", "fiber_tension_beta"):
            apart, bound = abs(held[name] - free[name]), held[f"{name}_error"] + free[f"{name}_error"]
            assert np.all(apart <= bound + 1e-7 * abs(free[name]).max())  # the length held is off, too


@pytest.mark.parametrize("model", ["source", "physical"])
def test_a_rotation_is_held_by_the_torque_under_which_the_free_tube_has_it(model):
    for tube, pressure in tubes(model, 10, 6):
        if tube.alpha == -tube.beta:
            continue
        torque = 0.1 * np.pi * R**3 * pressure
        free = fs.inflate(tube, pressure, torque=torque)
        held = fs.blocked_torque(tube, pressure, free["rotation"].item())
        assert (free["status"], held["status"], held["stable"]) == (OK, OK, 1)
        assert abs(held["torque"] - torque) < 1e-6 * np.pi * R**3 * pressure
        assert abs(held["deformed_length"] - free["deformed_length"]) < 1e-7 * tube.length


@pytest.mark.parametrize(("alpha", "beta", "length"), [(22.66, 79.64, 6.52), (36.51, 77.08, 10.4)])
def test_threads_that_pull_hold_a_straight_tube_by_the_closed_form_at_any_pressure(alpha, beta, length):
    """Eq. 2.19; meshes took the cylinder of loose threads for one that has let go."""
    rubber = fs.MooneyRivlin(C, 0.0)
    tube = fs.Actuator(
        alpha=alpha, beta=beta, length=length * R, radius=0.8 * R, wall=0.2 * R, material=rubber, model="physical"
    )
    pressures = C * np.array([0.003, 0.02, 0.15, 0.6])
    held = fs.blocked_torque(tube, pressures)
    ta, tb = np.tan(np.radians([alpha, beta]))
    assert np.all(held["status"] == OK)
    expected = np.pi * R**3 * pressures * (2.0 + ta * tb) / (ta + tb)
    np.testing.assert_allclose(held["torque"], expected, rtol=1e-9)


def test_a_loose_tube_whose_threads_would_push_is_held_from_the_free_one():
    """Undeformed, one family would have to push: both the torque and the radius differ from the bonded tube's."""
    sections = {"length": 13 * R, "radius": R, "wall": 0.1 * R, "material": RUBBER, "fiber_radius": "outer"}
    loose = fs.Actuator(alpha=70, beta=-20, fibers="loose", wall_model="thick", **sections)
    bonded = fs.Actuator(alpha=70, beta=-20, fibers="bonded", wall_model="thick", **sections)
    one, other = (fs.blocked_force(tube, 0.5 * C, 13 * R) for tube in (loose, bonded))
    assert (one["status"], other["status"]) == (OK, OK)
    taut = other["least_tension_alpha"] >= 0.0 and other["least_tension_beta"] >= 0.0
    assert taut == (abs(one["force"] - other["force"]) <= one["force_error"] + other["force_error"])


MUSCLE = {"alpha": 30, "beta": -30, "length": 0.131, "radius": 4.76e-3, "wall": 1.59e-3}


def test_a_muscle_of_loose_fibers_is_held_turned():
    """Bonded fibers of alpha = -beta do not turn; of loose ones a family goes slack."""
    tube = fs.Actuator(**MUSCLE, material=fs.MooneyRivlin(0.17e6, 0.08e6), model="physical")
    for torque in (0.08, -0.15):
        free = fs.inflate(tube, 1e5, torque=torque)
        held = fs.blocked_torque(tube, 1e5, float(free["rotation"]))
        assert int(held["status"]) == 0
        assert abs(float(held["torque"]) - torque) <= 2.0 * float(held["torque_error"])
    assert int(fs.blocked_torque(tube, 1e5, 0.0)["status"]) == 4  # by any torque up to that


@pytest.mark.parametrize(("model", "most"), [("source", 0.2191), ("physical", 0.2094)])
def test_a_length_that_no_pull_comes_to_is_impossible(model, most):
    """Whatever the pressure: the fibers, bent at their ends, are not long enough, or the wall would close the bore."""
    tube = fs.Actuator(**MUSCLE | {"length": 0.192}, material=fs.MooneyRivlin(0.17e6, 0.08e6), model=model)
    lengths = most * np.array([0.98, 1.004, 1.01, 1.2])
    held = fs.blocked_force(tube, 1e5, lengths)
    assert held["status"].values.tolist() == [0, 4, 4, 4]

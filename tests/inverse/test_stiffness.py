"""Stiffnesses that are wished for are those of the states held, among several that one load may lead to."""

import numpy as np
import pytest

import freesweep as fs
from freesweep.inverse import freedom, misfit

RUBBER = fs.MooneyRivlin(1.2e5, 6e4)
HELD = {"stiffness": ("force", "deformed_length"), "torsional_stiffness": ("torque", "rotation")}


def told(tube, name, pressure, held, thorough=False):
    """A stiffness as a search tells it, by vectors unless it is ``thorough``, and its bound."""
    faults = []
    goal = fs.Goal(name, 1.0, pressure=pressure, **{HELD[name][1]: held})
    space = freedom.read(tube, {"wall": (tube.wall, 1.1 * tube.wall)}, faults)
    found, _ = misfit.make(space, goal.wishes(faults), []).at(np.zeros((1, 1)), np.zeros(1, int), thorough=thorough)
    assert not faults
    return found.values.item(), found.bounds.item()


def solved(tube, name, pressure, held):
    """The same, of the state that is held alone, with its bound, and by differences of loads."""
    load, moved = HELD[name]
    way, step = (fs.blocked_force, 1e-5 * tube.length) if load == "force" else (fs.blocked_torque, 1e-3)
    state = way(tube, pressure, held, x=0.0, accuracy=1e-9, derivatives=[moved])
    beside = way(tube, pressure, [held - step, held + step], x=0.0, accuracy=1e-10)[load].values
    slope = f"d_{load}_d_{moved}"
    return state[slope].item(), state[f"{slope}_error"].item(), np.diff(beside).item() / (2.0 * step)


@pytest.mark.parametrize(
    ("name", "held", "design", "pressure"),
    [
        ("stiffness", 0.15, dict(alpha=30, beta=-40, length=0.15, radius=5e-3, wall=1e-3), 1e5),  # both stay straight
        ("torsional_stiffness", 0.0, dict(alpha=30, beta=-40, length=0.15, radius=5e-3, wall=1e-3), 1e5),
        # the load of a tube that is pulled thin holds it; free, it would swell
        (
            "torsional_stiffness", 31.837237, dict(alpha=20.125188, beta=28.753387, length=0.11628880, radius=6.64777e-3,
            wall=1.4966115e-3), 106311.9,
        ),
        (
            "torsional_stiffness", -34.671574, dict(alpha=30.580263, beta=54.818618, length=0.0940891, radius=4.68134e-3,
            wall=7.92831e-4), 161267.5,
        ),
    ],
)  # fmt: skip
def test_a_stiffness_is_that_of_the_state_that_is_held(name, held, design, pressure):
    tube = fs.Actuator(**design, material=RUBBER)
    (value, bound), (alone, doubt, slope) = told(tube, name, pressure, held), solved(tube, name, pressure, held)
    assert abs(value - alone) <= bound + doubt
    assert bound <= 1e-4 * abs(alone)
    assert value == pytest.approx(slope, rel=1e-4)


def test_a_stiffness_is_no_surer_than_the_load_that_it_follows():
    """Nearly locked: the bound of the force leaves more of it open than its own."""
    tube = fs.Actuator(
        alpha=6.544224325207749, beta=16.00175554640947, length=0.07014380654725998, radius=0.003,
        wall=0.0006882007177690444, material=RUBBER,
    )  # fmt: skip
    state = "stiffness", 229283.40567310315, 0.06733962704038422
    (value, bound), (alone, doubt, _) = told(tube, *state, thorough=True), solved(tube, *state)
    assert abs(value - alone) <= bound + doubt


def test_a_tube_is_found_by_its_stiffness_where_it_is_held_as_long_as_it_is():
    secret = fs.Actuator(alpha=30, beta=-40, length=0.15, radius=6e-3, wall=1e-3, material=RUBBER)
    wanted = fs.blocked_force(secret, 1e5, 0.15, x=0.0, derivatives=["deformed_length"])["d_force_d_deformed_length"]
    goal = fs.Goal("stiffness", wanted.item(), pressure=1e5, deformed_length=0.15)
    template = fs.Actuator(alpha=30, beta=-40, length=0.15, radius=4e-3, wall=1e-3, material=RUBBER)
    found = fs.design(template, {"radius": (3e-3, 9e-3)}, goal, count=1)
    assert found["met"].item()
    assert found["radius"].item() == pytest.approx(6e-3, rel=1e-4)


def test_a_hidden_tube_is_found_by_a_held_stiffness_that_meshes_tell():
    """Nearly straight: vectors tell it to eight digits, not nine, and differences of what is not told lead nowhere."""
    template = fs.Actuator(
        alpha=52.25983953836958, beta=0.0, length=0.1363192111171858, radius=0.011757944957376146, wall=1.15e-3,
        material=RUBBER,
    )  # fmt: skip
    goals = [
        fs.Goal("stiffness", 3007.2083648879575, pressure=67663.86335703751, deformed_length=0.1362363824790605),
        fs.Goal("rotation", between=(-25.17014463161004, -24.671725926033606), pressure=63009.45911467882),
    ]
    found = fs.design(template, {"beta": (-85, 85), "wall": (3e-4, 2e-3)}, goals, count=1)
    assert found["met"].item()


@pytest.mark.parametrize("name", HELD)
def test_free_ends_of_physical_tubes_are_as_stiff_as_their_loads_tell(name):
    """Both families loose, of which one is slack along the second tube: by vectors, against differences of states."""
    load, moved = HELD[name]
    step = {"force": 1e-2, "torque": 1e-5}[load]
    for alpha, beta in ((30.0, -40.0), (60.0, 25.0)):
        tube = fs.Actuator(
            alpha=alpha, beta=beta, length=0.15, radius=5e-3, wall=1e-3, material=RUBBER, model="physical"
        )
        goal = fs.Goal(name, 1.0, pressure=5e4)
        space = freedom.read(tube, {"wall": (1e-3, 1.1e-3)}, [])
        task = misfit.make(space, goal.wishes([]), [])
        assert task.is_quick
        found, _ = task.at(np.zeros((1, 1)), np.zeros(1, int), thorough=False)
        ends = fs.inflate(tube, 5e4, x=0.0, accuracy=1e-9, **{load: [-step, step]})[moved].values
        assert found.values.item() == pytest.approx(2.0 * step / np.diff(ends).item(), rel=1e-4)
        assert found.bounds.item() <= 1e-3 * found.values.item()

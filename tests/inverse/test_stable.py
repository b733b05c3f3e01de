"""Whether what a candidate is held in stands: what the smallest disturbance ends is no answer while there is another one."""

import numpy as np
import pytest

import freesweep as fs
from freesweep.inverse import freedom
from freesweep.inverse.predict import UNKNOWN, predict

RUBBER = fs.MooneyRivlin(1.2e5, 6e4)
PRESSURE = 1.5e5
THIN, ANY = ({"wall": walls, "radius": (5e-3, 7e-3)} for walls in ((3.5e-4, 4.5e-4), (3e-4, 1.5e-3)))


def tube(model="source", **more):
    return fs.Actuator(
        **({"alpha": 20.0, "beta": 60.0, "length": 0.15, "radius": 6e-3, "wall": 4e-4} | more),
        material=RUBBER,
        model=model,
    )


def torque_of(held_tube, pressure=PRESSURE):
    held = fs.blocked_torque(held_tube, pressure, x=0.0)
    return held["torque"].item(), int(held["stable"])


@pytest.mark.parametrize("model", ["source", "physical"])
def test_vectors_know_which_held_states_stand(model):
    """As one tube at a time tells it: straight cylinders of both models, and the source's tubes however they are held."""
    made = tube(model)
    asked = [
        wish
        for pressure in (1e4, PRESSURE)
        for goal in (
            fs.Goal("torque", 0.0, pressure=pressure),
            fs.Goal("torque", 0.0, pressure=pressure, rotation=4.0),
            fs.Goal("force", 0.0, pressure=pressure),
        )
        for wish in goal.wishes([])
    ]
    space = freedom.read(made, {"wall": (2e-4, 6e-4)}, [])
    found = predict(space, asked, np.array([[0.5]]), np.zeros(1, int), 1e-7, thorough=model == "source")
    alone = [
        state
        for pressure in (1e4, PRESSURE)
        for state in (
            fs.blocked_torque(made, pressure, x=0.0),
            fs.blocked_torque(made, pressure, 4.0, x=0.0),
            fs.blocked_force(made, pressure, x=0.0),
        )
    ]
    told = [int(state["stable"]) for state in alone]
    there = np.isfinite(found.values[0])
    known = (found.stable[0] != UNKNOWN) & there
    assert known[0]
    assert known[3]
    assert np.all(known[there]) or model == "physical"
    assert found.stable[0][known].tolist() == np.array(told)[known].tolist()
    assert {told[0], told[3]} == {0, 1}
    pushing = np.bitwise_or.reduce([int(state["slack_fiber"]) for k, state in enumerate(alone) if known[k]])
    assert found.slack[0] & pushing == pushing


@pytest.mark.parametrize("model", ["source", "physical"])
def test_an_unstable_state_answers_only_where_no_other_one_does(model):
    """The torque of a straight cylinder hangs on its radius, how much it bears on its wall, too."""
    torque, stable = torque_of(tube(model))
    assert not stable
    wish = fs.Goal("torque", torque, pressure=PRESSURE)
    found = fs.design(tube(model), THIN, wish, count=3)
    assert found["met"].values.all()
    assert not found["stable"].values.any()
    assert "a state is unstable: the smallest disturbance ends it (stable)" in found.attrs["summary"]
    found = fs.design(tube(model), ANY, wish, count=3)
    assert found["met"].values.all()
    assert found["stable"].values.all()
    assert "unstable" not in found.attrs["summary"]


def test_a_limit_keeps_all_states_stable():
    torque, _ = torque_of(tube())
    wish, kept = fs.Goal("torque", torque, pressure=PRESSURE), fs.Limit("stable", at_least=1)
    found = fs.design(tube(), THIN, wish, kept, count=2)
    assert not found["met"].values.any()
    assert "meets the goals and keeps the limits: stable" in found.attrs["summary"]
    goals = [wish, fs.Goal("deformed_length", at_most=0.2, pressure=1e4)]
    found = fs.design(tube(), ANY, goals, kept, count=2)
    assert found["met"].values.all()
    assert found["limit_value"].values.tolist() == [[1.0]] * found.sizes["candidate"]
    with pytest.raises(fs.ActuatorError, match="no matter of a state"):
        fs.Limit("stable", at_least=1, pressure=1e5)


def test_the_least_of_something_is_sought_among_what_stands():
    torque, _ = torque_of(tube())
    goal = fs.Goal("torque", torque, pressure=PRESSURE, tolerance=1e-3 * abs(torque))
    found = fs.design(tube(), ANY, goal, minimize="wall", count=2)
    assert found["met"].values.all()
    assert found["stable"].values.all()
    thinner = tube(wall=0.97 * found["wall"].values[0], radius=found["radius"].values[0])
    assert not torque_of(thinner)[1]

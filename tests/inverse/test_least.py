"""What is least among tubes that do what is wished for."""

import numpy as np
import pytest

import freesweep as fs

RUBBER = fs.MooneyRivlin(1.2e5, 6e4)


def test_tubes_without_a_limit_pressure_keep_one_that_is_asked_for():
    """A search for what is least goes through them: it had taken them for tubes beyond their limit, and stood still."""
    template = fs.Actuator(alpha=30, beta=-60, length=0.15, radius=5e-3, wall=1e-3, material=RUBBER)
    goal = fs.Goal("rotation", at_least=100, pressure=1e5, tolerance=0.01)
    limit, least = fs.Limit("limit_pressure", at_least=2e5), fs.Limit("rotation", at_least=0, pressure=2e5)
    found = fs.design(template, {"alpha": (0.0, 85.0), "wall": (3e-4, 3e-3)}, goal, limit, minimize=least, count=1)
    assert np.isinf(found["limit_value"].item())
    assert found["goal_value"].item() == pytest.approx(100, abs=0.02)  # more turning then is more turning at last
    assert found["wall"].item() == pytest.approx(3e-4)
    assert found["objective"].item() < 113.0


def slim(count, radii, **more):
    template = fs.Actuator(alpha=30, beta=-50, length=0.15, radius=5e-3, wall=1e-3, material=RUBBER)
    goal = fs.Goal("rotation", at_least=50, pressure=1e5)
    return fs.design(template, {"radius": radii, "alpha": (5, 60)}, goal, count=count, **more)


def test_the_least_of_what_can_be_bought_is_looked_for_among_all_of_it():
    for radii in ([4e-3, 6e-3, 7e-3, 8e-3, 9e-3], [9e-3, 8e-3, 7e-3, 6e-3, 4e-3]):
        assert slim(1, radii, minimize="radius")["radius"].item() == 4e-3


def test_a_front_passes_all_that_can_be_bought():
    """The wider the tube, the less it turns on to the second pressure: each radius is on the front."""
    on = fs.Limit("rotation", at_most=1, pressure=2e5)
    found = slim(6, [4e-3, 5e-3, 6e-3, 7e-3], minimize=["radius", on])
    assert found["radius"].values.tolist() == [4e-3, 5e-3, 6e-3, 7e-3]
    assert np.all(np.diff(found["objective"].values[:, 1]) < 0.0)


def test_lists_alone_have_a_least_and_a_front():
    """Nothing is open between them: each choice is a candidate, once."""
    template = fs.Actuator(alpha=20, beta=-50, length=0.15, radius=5e-3, wall=1e-3, material=RUBBER)
    goal = fs.Goal("rotation", at_least=50, pressure=1e5)
    shop = {"radius": [6e-3, 5e-3, 4e-3], "wall": [1e-3, 1.5e-3]}
    least = fs.design(template, shop, goal, minimize="radius", count=2)
    assert least["radius"].values.tolist() == [4e-3, 4e-3]
    assert least["met"].all()
    front = fs.design(template, shop, goal, minimize=["radius", "wall"], count=8)
    assert front["objective"].values.tolist() == [[4e-3, 1e-3]]

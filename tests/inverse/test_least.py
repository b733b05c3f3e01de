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

"""Cells in which loose fibers go slack."""

import numpy as np
import pytest

from freesweep import interpret
from freesweep.solver.cells import nothing_yet
from freesweep.solver.load import Load
from freesweep.solver.physics import in_a_cell, over_cell

density, look, at_place = (
    interpret._twin(one.py_func) for one in (over_cell.density, over_cell.look, in_a_cell.partials_at)
)


@pytest.mark.parametrize(
    ("alpha", "beta", "pressure", "y", "length", "corners"),
    [
        (0, 30, 0.6, 1.35, 0.1, 1),  # alpha pulls up to y = 1.36
        (0, 30, 0.6, 1.345, 0.1, 1),  # just within the cell's end, beyond its points
        (30, 45, 0.5, 1.065, 0.1, 1),  # both pull from y = 1.07 to 1.085
        (30, 45, 0.5, 1.077, 0.2, 2),
    ],
)
def test_a_cell_s_density_is_its_mean_though_families_go_slack_in_it(alpha, beta, pressure, y, length, corners):
    """The midpoint's slopes are wrong by a hundred times and more of what is left."""
    ta, tb, v = *np.tan(np.radians([alpha, beta])), 0.3
    point, load = (
        (0.5 * (ta + tb), 0.5 * (ta - tb), 0.4),
        Load(1.0, (0.5, 0.0, 0.0), (1.0, 0.6, 1.0), pressure, 0.0, 0.0, 1.0),
    )

    def partials(r):
        found, _ = look(y + r * v, v, point, load, nothing_yet(0.0))
        return found.kind, np.array(at_place(found, y + r * v, v, r, point, load, load))

    every = [partials(r) for r in length * ((np.arange(150) + 0.5) / 150 - 0.5)]
    assert np.count_nonzero(np.diff([kind for kind, _ in every])) == corners
    mean = np.mean([numbers for _, numbers in every], axis=0)
    found = np.array(density(y, v, (*point, length, nothing_yet(0.0)), load)[1:6])
    missed, by_midpoint = np.abs(found - mean)[:2], np.abs(partials(0.0)[1] - mean)[:2]
    assert np.all(missed < 0.02 * by_midpoint)

"""Cells in which loose fibers go slack, and base meshes that are finer there."""

import numpy as np
import pytest

from freesweep import interpret
from freesweep.solver.cells import nothing_yet
from freesweep.solver.lanes import corners
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


def test_nodes_gather_at_a_place_and_rise():
    """By the density of nodes: DENSER + 1 times as many at the place as far from it."""
    counted, number_at, value_at = (
        interpret._twin(one.py_func) for one in (corners.counted, corners.number_at, corners.value_at)
    )
    n, places, x = 24, np.array([[9.3], [np.nan]]), (np.linspace(0.0, 3.0, 25) ** 2)[:, None]
    start, end = (counted(float(z), places, 1, 0)[0] for z in (0, n))
    z = [number_at(start + (end - start) * i / n, 0.0, float(n), places, 1, 0) for i in range(n + 1)]
    assert np.allclose([counted(one, places, 1, 0)[0] for one in z], np.linspace(start, end, n + 1), atol=1e-5)
    steps = np.diff(z)
    assert steps.max() / steps.min() == pytest.approx(1.0 + corners.DENSER, rel=0.1)
    assert abs(z[np.argmin(steps)] - 9.3) < 0.5
    nodes = np.array([value_at(x, one, n, 0) for one in z])
    assert np.all(np.diff(nodes) > 0.0)
    assert np.allclose(nodes, (np.array(z) / 8.0) ** 2, atol=0.01)


@pytest.mark.parametrize(
    ("alpha", "beta", "expected"),
    [
        ([-1, 2, 1, 1, 1, 1], [1, 1, 1, 1, 1, 1], [0.25]),  # pulls from between the end and the first cell's middle
        ([1, 1, 1, 1, 1, 1], [4, 3, 2, 1, -1, -1], [3.5]),  # and falls to zero in the next cell's middle
        ([-1, -1, 1, 2, 3, 4], [4, 3, 2, 1, -1, -1], [0.5, 3.5]),
        ([-1, -1, -1, 1, 2, 3], [3, 2, 1, -1, -1, -1], [2.0]),  # one family for the other, 1.5 to 2.5: one place
        ([1, 1, 1, 1, 1, 1], [-1, -1, -1, -1, -1, -1], []),
    ],
)
def test_places_lie_where_a_pull_begins_or_ends(alpha, beta, expected):
    x = np.array([0.0, 0.5, 1.5, 2.5, 3.5, 4.0])
    seen, places = np.array([x, alpha, beta, 0.0 * x])[:, :, None], np.zeros((6, 1))
    count = interpret._twin(corners.look_for.py_func)(seen, 4, 0, places)
    assert places[:count, 0] == pytest.approx(expected)

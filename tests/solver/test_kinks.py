"""A net that softens beyond a slope, under an even load: there its shape bends, and meshes err by how far off they have it.

``L = F y - W(v)``, with ``W' = v`` up to the slope 1, from there ``1 + A (v - 1)``. Half of it is solved, x from the end to
the plane of symmetry. As ``W'(v) = F (X - x)``, the net is soft up to ``x = X - 1/F``.
"""

import numpy as np
import pytest
from plain import as_kernels_divide, plain

from freesweep.solver.free import space
from freesweep.solver.load import NO_CHANGE
from freesweep.solver.numerics import kinks, nested, newton
from freesweep.solver.numerics.functional import Functional
from freesweep.solver.numerics.held import NOTHING
from freesweep.solver.numerics.properties_along import Tube

kinks, nested, newton, space = plain(kinks, nested, newton, space)
X, A, CELLS, NODE = 1.0, 0.7, 16, 6
ACCURACY = 3e-5
PLACES, WEIGHTS = np.polynomial.legendre.leggauss(4)


@pytest.fixture(autouse=True)
def division():
    with as_kernels_divide():
        yield


def density(y, v, cell, load):
    soft, size = abs(v) > 1.0, abs(v)
    flux = np.sign(v) * (1.0 + A * (size - 1.0)) if soft else v
    numbers = 1.0, cell[0], -flux, 0.0, 0.0, -A if soft else -1.0
    return (*numbers, cell[4]) if len(cell) > 4 else numbers


def integrands(y, v, cell, load):
    numbers = 1.0, y * y, v * v, y**3, float(abs(v) > 1.0)
    return (*numbers, cell[4]) if len(cell) > 4 else numbers


def scales(outputs, cell, load, length, tolerance):
    return (1.0,) * 6, (2e-13 + 10.0 * tolerance,) * 6


def soft_up_to(bend):
    """The net that is: ``(nodes of the base mesh, status, values, bounds)``, from an even one that does not fit itself."""
    room, course = space.make_space(CELLS, 1), np.zeros((1, 1, 3, 4))
    room.x[:], room.y[:], course[0, 0, 0, 0] = np.linspace(0.0, X, CELLS + 1), 1.0, 1.0 / (X - bend)
    tube = Tube(course, np.array([0, CELLS]), np.zeros((1, 3)), True, CELLS, np.array([0.0, X]))
    functional = Functional(density, None, integrands, scales)
    status, _, _ = nested.solve(functional, room, tube, NO_CHANGE, NOTHING, 0.0, 0, ACCURACY)
    return room.x, status, room.out[0, :5], room.out[1, :5]


def exactly(bend):
    """Length, integrals of y^2, v^2 and y^3, and y in the middle."""
    force, at_bend = 1.0 / (X - bend), 1.0 + bend + bend**2 / (X - bend) / (2.0 * A)
    values = np.array([X, 0.0, 0.0, 0.0, at_bend + 0.5 * (X - bend)])
    for left, right in ((0.0, bend), (bend, X)):
        x, soft = 0.5 * (left + right) + 0.5 * (right - left) * PLACES, left == 0.0
        v = 1.0 + force * (bend - x) / A if soft else force * (X - x)
        y = 1.0 + x + force * (bend * x - 0.5 * x * x) / A if soft else values[4] - 0.5 * force * (X - x) ** 2
        values[1:4] += 0.5 * (right - left) * np.array([WEIGHTS @ y**2, WEIGHTS @ v**2, WEIGHTS @ y**3])
    return values


@pytest.mark.parametrize("off", [0.0, 0.003, -0.003, 0.01, -0.01, 0.03, -0.03, 0.1, 0.2, 1 / 3, 0.5, 0.7])
def test_bounds_hold_wherever_a_net_bends_between_two_nodes(off):
    bend = (NODE + off) * X / CELLS
    _, status, values, bounds = soft_up_to(bend)
    assert status == newton.CONVERGED
    assert np.all(np.abs(values - exactly(bend)) <= bounds)
    assert np.max(bounds) <= 1.01 * ACCURACY


def test_nodes_that_hide_where_a_net_bends_are_moved_by_a_third_of_a_cell():
    even = np.linspace(0.0, X, CELLS + 1)
    hidden, seen = soft_up_to((NODE + 0.03) * X / CELLS)[0], soft_up_to((NODE + 1 / 3) * X / CELLS)[0]
    assert np.all(seen == even)
    assert hidden[NODE] - even[NODE] == pytest.approx(kinks.STEP * X / CELLS)
    assert np.all(np.diff(hidden) > 0.9 * X / CELLS)
    assert np.all(hidden[[0, -1]] == [0.0, X])


def test_where_a_segment_ends_the_kind_may_change():
    changes, hidden = np.zeros((4, kinks.MOST)), np.empty((2, kinks.MOST))
    changes[:, 0] = 0.25
    assert kinks.find(changes, 3, np.array([0, 16]), hidden) == 1
    assert hidden[:, 0].tolist() == [4.0, 0.0]
    assert kinks.find(changes, 3, np.array([0, 4, 16]), hidden) == 0
    changes[3, 1] = 0.25 + 1 / 64  # it ends in the cell behind
    assert kinks.find(changes, 3, np.array([0, 16]), hidden) == 1
    assert hidden[:, 0].tolist() == [4.0, 0.125]
    changes[1, 0] = 0.3
    assert kinks.find(changes, 3, np.array([0, 16]), hidden) == 0

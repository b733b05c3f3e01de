"""The axial stretch s without differences of node values, which have no digits for it where the meridian stands upright.

The flux q = T v/s = -L_v follows from the discrete Euler-Lagrange equations, as the reaction of the tube on one side of a
node; it is smooth through jumps of the wall. With it::

    s = T sqrt(G)/sqrt(T^2 + q^2)

A tube of the source's that is the same all along needs none: its first integral ``L - v L_v`` gives s from y and the
middle's y_m, as its fibers leave the wall no choice that the slope could turn (of thick and of loose ones they do, or the
multipliers are others),

    s = T G/(T sqrt(G) + U(y_m) - U(y)),    U(y) = L(y, 0).
"""

from ...jit import kernel
from ..cells import cell_at, of_length
from ..physics import lagrangian


@kernel
def is_alike(course):
    """Whether a tube is the same all along."""
    return course.shape[0] == 1 and course.shape[1] == 1


@kernel
def is_told_by_stretch(course, wall):
    """Whether the first integral alone tells, by its stretch, all of a place."""
    return len(wall) == 1 and is_alike(course)


@kernel
def axial_stretch(y, constant, cell, load):
    """s of a tube of the source's that is the same all along, from the ``constant`` U(y_m) of its first integral."""
    meridional, pull, at_rest = lagrangian.uniform_tube(y, cell, load)
    return meridional * pull / (pull + constant - at_rest)


@kernel
def flux_at(x, y, j, n, cells, load):
    """The flux at node j of a mesh of n cells: the reaction of the cell behind it; at the last node, of the one before."""
    i = min(j, n - 1)
    h = x[i + 1] - x[i]
    cell = of_length(cell_at(cells, i), h)
    _, L_y, L_v, _, _, _ = lagrangian.density(0.5 * (y[i] + y[i + 1]), (y[i + 1] - y[i]) / h, cell, load)
    return (0.5 if j < n else -0.5) * h * L_y - L_v

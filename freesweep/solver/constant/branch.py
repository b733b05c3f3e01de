"""Where node values have no digit to spare for a tube that is the same all along: its branch goes on by its first integral,
and what that shows is solved on a mesh that begins there, or by quadrature.

A fold is told by traces of more and more nodes: the last two differ by less than its distance to either end of the way.
"""

import numpy as np

from ...jit import kernel
from ..guide import cell_along
from ..load import NO_CHANGE
from ..numerics import nested, newton
from ..physics import lagrangian, uniform_tube
from ..status import BEYOND_LIMIT, COMPRESSED, INACCURATE, NOT_CONVERGED, OK
from . import branch_trace, meridian, quadrature, shape_beside

FINER, MOST_NODES = 4, 16 * meridian.NODES  # times the nodes of a trace where it does not tell enough, up to so many
RUN_OUT = 0.05  # cosine of the meridian's angle at an end
CLOSE = 0.02  # of the way: two traces' difference that is good enough
CAUTION = 10.0  # times the bounds of shapes so steep: their errors fall to fourth order only on finer meshes
STRAY = 0.02  # share of |middle - 1| by which a mesh's middle may differ from the trace's


@kernel
def is_upright(track, tube, load):
    """Whether a clamped end of a tube that is the same all along stands so upright that node values run out there."""
    return tube.half and quadrature.end_cosine(track.x, track.y, tube, load) < RUN_OUT


@kernel
def retrace(space, tube, origin, before, load, accuracy):
    """The state at ``load``, from one at ``before`` whose stretch in the middle is ``origin``, left as
    :func:`..numerics.nested.solve`
    leaves it: ``(status, doublings, share of the way at a fold, its bound)``.
    """
    return _retrace(tube.course, space, tube, origin, before, load, accuracy)


@kernel
def _retrace(course, space, tube, origin, before, load, accuracy):
    if course.ndim > 4:  # a body has no first integral
        return NOT_CONVERGED, 0, np.nan, np.nan
    x, y, out = space.x, space.y, space.out
    cell, half = cell_along(tube, 0.0), tube.places[1]
    nodes, turned, doubt = meridian.NODES, np.nan, np.inf
    while nodes <= MOST_NODES:
        what, share, middle = branch_trace.trail(tube, before, load, origin, nodes, x, y, space.curve, space.work)
        nodes *= FINER
        if what == branch_trace.LOST:
            if shape_beside.gives_way(cell, load, half, meridian.NODES, space.curve):
                return COMPRESSED, 0, np.nan, np.nan
        elif what == branch_trace.TURNED:
            turned, doubt = share, abs(share - turned) if turned == turned else np.inf
        else:
            status, unstable, doublings, _ = nested.solve(
                lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube, load,
                nested.PLAIN, NO_CHANGE, 0.0, 0.0, 0, accuracy / CAUTION, space.fine, space.work, space.table, out,
            )  # fmt: skip
            for k in range(nested.OUTPUTS):
                out[1, k] *= CAUTION
            solved = status == newton.CONVERGED or status == nested.UNREACHED
            if solved and unstable == 0 and abs(out[0, nested.MIDDLE] - middle) < STRAY * abs(middle - 1.0) + 1e-6:
                status = OK if status == newton.CONVERGED else INACCURATE
                status, doublings = quadrature.sharpen(tube, load, accuracy, space, status, doublings)
                return status, doublings, np.nan, np.nan
            status, doublings = quadrature.solve(tube, middle, load, len(x) - 1, accuracy, space)
            if status != NOT_CONVERGED:
                return status, doublings, np.nan, np.nan
    if doubt < CLOSE and doubt < min(turned, 1.0 - turned):
        return BEYOND_LIMIT, 0, turned, doubt
    u, part, near = shape_beside.stationary(cell, before, origin), 0.0, origin
    if u == u:  # a long tube's middle goes where the uniform tube does
        drawn = lagrangian.drawn_in(cell, load)
        u, part = uniform_tube.follow(lagrangian.density, u, cell, before, load, half, drawn)
        near = u if part == 1.0 else origin
    status, doublings = quadrature.solve(tube, near, load, len(x) - 1, accuracy, space)  # or it hardly moves at all
    return status, doublings, np.nan, np.nan

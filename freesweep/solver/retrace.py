"""Where the walk on meshes ends without an answer: the branch is traced again by its first integral, and what that shows is
solved on a mesh that begins there, or by quadrature.

A turning point that no mesh holds is told by two traces, one of more nodes than the other: they differ by less than its
distance to either end of the way.
"""

import numpy as np

from ..jit import inlined
from . import beside, guide, lagrangian, meridian, nested, newton, quadrature, trail
from .guide import cell_along
from .status import BEYOND_LIMIT, COMPRESSED, INACCURATE, NOT_CONVERGED, OK

FINER, MOST_NODES = 4, 16 * meridian.NODES  # times the nodes of a trace where it does not tell enough, up to so many
CLOSE = 0.02  # of the way: two traces' difference that is good enough
CAUTION = 10.0  # times the bounds of shapes so steep: their errors fall to fourth order only on finer meshes
LIMIT_ROUNDING = 4e-9  # of a limit pressure: where a load is flat, many shapes are equilibria to rounding
FLAT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def retrace(x, y, origin, lost, tube, before, load, accuracy, space, out):
    """The state at ``load``, from one at ``before`` whose stretch in the middle is ``origin``; ``lost`` is the status where
    nothing is found.

    Returns ``(status, doublings, limit pressure, its bound)``.
    """
    fine, work, table = space[0], space[1], space[2]
    cell, half = cell_along(tube, 0.0), tube[5][1]
    along = (0.0, 0.0, 0.0, load[3] - before[3], load[4] - before[4], load[5] - before[5], 0.0)
    nodes, turned, doubt = meridian.NODES, np.nan, np.inf
    while nodes <= MOST_NODES:
        what, mu, middle = trail.trail(tube, before, load, origin, nodes, x, y, space[3], work)
        nodes *= FINER
        if what == trail.LOST:
            if beside.gives_way(cell, load, half, meridian.NODES, space[3]):
                return COMPRESSED, 0, np.nan, np.nan
            continue
        if what == trail.TURNED and before[0] != load[0]:
            return BEYOND_LIMIT, 0, np.nan, np.nan
        plain = what == trail.ARRIVED
        status, unstable, doublings, _ = nested.solve(
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube,
            load if plain else before, nested.PLAIN if plain else nested.TURNING_POINT, FLAT if plain else along, 0.0,
            0.0 if plain else mu, 0, accuracy / CAUTION, fine, work, table, out,
        )  # fmt: skip
        for k in range(nested.OUTPUTS):
            out[1, k] *= CAUTION
        solved = status == newton.CONVERGED or status == nested.UNREACHED
        if not plain:
            if solved and out[0, nested.MULTIPLIER] < 1.0:
                limit = before[3] + out[0, nested.MULTIPLIER] * along[3]
                return BEYOND_LIMIT, 0, limit, abs(out[1, nested.MULTIPLIER] * along[3]) + LIMIT_ROUNDING * limit
            if not solved:
                turned, doubt = mu, abs(mu - turned) if turned == turned else np.inf
                if doubt < CLOSE and doubt < min(turned, 1.0 - turned):
                    break
            continue
        if solved and unstable == 0 and abs(out[0, nested.MIDDLE] - middle) < guide.STRAY * abs(middle - 1.0) + 1e-6:
            status = OK if status == newton.CONVERGED else INACCURATE
            status, doublings = quadrature.sharpen(
                x, y, tube, np.nan, load, accuracy, fine, space[3], table, out, status, doublings
            )
            return status, doublings, np.nan, np.nan
        status, doublings = quadrature.solve(
            tube, np.nan, middle, load, len(x) - 1, accuracy, fine, space[3], table, out
        )
        if status != NOT_CONVERGED:
            return status, doublings, np.nan, np.nan
    if doubt < min(turned, 1.0 - turned):
        return BEYOND_LIMIT, 0, before[3] + turned * along[3], doubt * abs(along[3])
    return lost, 0, np.nan, np.nan

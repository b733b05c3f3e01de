"""The stretch in the middle of long tubes, as :mod:`freesweep.solver.numerics.middle` tells it, for a vector of designs."""

from math import exp, sqrt

from ...jit import kernel
from ..numerics.middle import ALLOWED, BENT, LONG, MISSED, NEAR
from ..physics import lagrangian
from .vector import WIDTH, get, put, select, spread

RESOLVED = 1.5  # layers: the longest last cell of the base mesh that does not reflect what is left of them


@kernel
def node(x, y, n, u, cell, load, accuracy, room):
    """What the base mesh says of tubes of uniform stretch ``u``: ``(long, share, missed, resolved)``: which are long, the
    ``share`` of what is left at the node that is left in the middle, how much of it may be missed; and whether the last
    node of a mesh can be trusted where they are not long. ``room`` (3, WIDTH) keeps the nodes.
    """
    _, _, _, L_yy, _, L_vv = lagrangian.density(u, 0.0, cell, load)
    k = sqrt(max(L_yy / L_vv, 0.0))
    most = abs(get(y, 0) - u)
    number, at, there = spread(0.0), get(x, 0), get(y, 0)
    for i in range(2, n, 2):
        here = get(y, i)
        far = abs(here - u) > NEAR * most
        number, at, there = select(far, spread(i), number), select(far, get(x, i), at), select(far, here, there)
    put(room, 0, number)
    put(room, 1, k * (get(x, n) - at))
    for lane in range(WIDTH):
        z = exp(-room[1, lane])
        room[1, lane] = 2.0 * z / (1.0 + z * z)
    share = get(room, 1)
    rest = abs(there - u) * share
    _, _, _, L_yy, _, L_vv = lagrangian.density(there, 0.0, cell, load)
    missed = rest * (MISSED + BENT * abs(L_yy / (L_vv * k * k) - 1.0))
    long = (rest <= LONG * most) & (missed <= ALLOWED * accuracy)
    resolved = long | (k * (get(x, n) - get(x, n - 1)) < RESOLVED)
    return long, share, select(long, missed, spread(0.0)), resolved


@kernel
def stretch(y, n, base, u, long, share, room):
    """Stretches in the middle on meshes of n cells, ``base`` on the base mesh."""
    for lane in range(WIDTH):
        room[2, lane] = y[int(room[0, lane]) * n // base, lane]
    return select(long, u + share * (get(room, 2) - u), get(y, n))

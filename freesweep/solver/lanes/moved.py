"""How half a tube's sums change as numbers do, and the depth of its middle, for a vector of designs.

A place is told by its depth, from the end's stretch 1 to that of the middle, y_m (:mod:`meridian`)::

    y = y_m + (1 - y_m) phi,    phi = (z - q)^2/(z (1 - q)^2),    z = exp(-depth),    q = exp(-depth of the middle)

Which depth stands for which place is free: a sum hangs on it no more than on the name of what it sums over. So with a number
the middle moves as a long tube's does (:mod:`moved_middle`). Then all places of a layer move by about as much as it, and
what is summed, ::

    d(dx)/dx = -dy_m/(1 - y_m) - dG/(2 G) - d(sine)/sine,    sine^2 = (R - T)(R + T)/R^2

is as smooth along the depth as what the state itself sums. Near the middle, where R - T has no digits, it is the stretch
from there times the mean of its slope. The depth moves by what leaves half a tube as long as it is.
"""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..either import select, some
from .moved_extremes import FIELDS, SEEN
from .moved_middle import DEPTH, LOADS, MIDDLE, OF_BEND, OF_LEVEL, OF_LOADS, OF_RISE, OF_Y, OWN
from .pack import aligned
from .second import BY_K, BY_T, NUMBERS, ROWS, by_numbers, settled_by
from .slack_ends import MOST
from .vector import get, put, spread

COUNT, LAST_ONES = 20, 2  # Gauss' places of a part, which never lie on an end; of Legendre's coefficients
_AT, _WEIGHTS = np.polynomial.legendre.leggauss(COUNT)
PLACES, WEIGHTS = 0.5 + 0.5 * _AT, 0.5 * _WEIGHTS
_COEFFICIENTS = (2.0 * np.arange(COUNT) + 1.0)[:, None] * (np.polynomial.legendre.legvander(_AT, COUNT - 1).T * WEIGHTS)
TAILS = np.ascontiguousarray(_COEFFICIENTS[-2 * LAST_ONES :])
LATE = TAILS[-1] - TAILS[-2]  # signs alternate of what is hardly smooth where the layer begins
SUM, TAIL, MISSED, SMOOTH = range(0, 4 * (LOADS + 1), LOADS + 1)  # rows of each: LOADS + 1; the last are 4
SUMS = SMOOTH + 2 * LAST_ONES
# shares of R, and of what it is the difference of, up to which R - T changes by rounding: from there on that is
# as much as the mean slope misses
DIGITS = 1e-11
TINY = 1e-140


class Sums(NamedTuple):
    """Scratch: ``rows`` (NUMBERS, ROWS, WIDTH) of a place, those of the ``middle`` (NUMBERS + 2, MIDDLE, WIDTH), and what is
    ``summed`` (NUMBERS + 2, SUMS, WIDTH), of the numbers ``used``; what is ``seen`` of fields (fields, SEEN, WIDTH); for
    both families the length of parts that are ``odd`` (2, NUMBERS + 2, WIDTH), which are that (2, MOST + 2, WIDTH), and what
    was summed ``before`` a part (NUMBERS + 2, WIDTH).
    """

    used: np.ndarray
    rows: np.ndarray
    middle: np.ndarray
    summed: np.ndarray
    seen: np.ndarray
    odd: np.ndarray
    is_odd: np.ndarray
    before: np.ndarray


@kernel
def make_sums(used):
    """Scratch of a vector."""
    all_of_them = NUMBERS + 2
    return Sums(
        used, aligned(NUMBERS, ROWS), aligned(all_of_them, MIDDLE), aligned(all_of_them, SUMS), aligned(FIELDS, SEEN),
        aligned(2, all_of_them), aligned(2, MOST + 2), aligned(1, all_of_them)[0],
    )  # fmt: skip


class Way(NamedTuple):
    """A place's way from the middle: phi, and by the depth of the middle the logarithms of phi, and of how the depth moves
    the stretch; 1/(1 - y_m); which place of a rule it is, and dx; where R - T has no digits, the
    stretch from the middle, how R - T grows with that, relative, and 1/(its mean slope); 1/(R - T), 1/(R + T), 1/T and 1/R.
    """

    phi: float
    by_depth: float
    longer: float
    reach: float
    place: int
    dx: float
    near: bool
    on: float
    lift: float
    per_rise: float
    per_beyond: float
    per_sum: float
    per_T: float
    per_R: float


@kernel
def way_of(k, within, depth, z, per_share, here, load, mid):
    """The :class:`Way` of place k of a part, in the lanes that have it; ``z`` is exp(-``depth``)."""
    q, i = mid.q, 1.0 / (1.0 - mid.q)
    near = here.beyond <= DIGITS * (here.R + abs(mid.level) + abs(load.m * here.psi))
    share = depth / mid.depth
    # what z and q change by
    dz, dq = -z * share, -q
    inner, outer, root = (dz - dq) / select(within, z - q, 1.0), (dz + dq) / (z + q), 2.0 * dq * i
    dx = select(within, per_share, 0.0)
    phi = (z - q) * (z - q) * i * i / z
    on = (1.0 - mid.y) * phi
    per_rise = 1.0 / select(near, mid.rise + 0.5 * mid.bend * on, 1.0)
    return Way(
        phi, 2.0 * inner + share + root, inner + outer + share + root + 1.0 / mid.depth, 1.0 / (1.0 - mid.y), k, dx, near,
        on, (mid.rise + mid.bend * on) * per_rise, per_rise, 1.0 / select(near, 1.0, here.beyond),
        1.0 / (here.beyond + 2.0 * here.T), 1.0 / here.T, 1.0 / here.R,
    )  # fmt: skip


@kernel
def move_place(way, here, at, cell, load, mid, own):
    """Add a place to all that is ``summed``."""
    to, s, pull = own.summed[OWN], here.s, 2.0 * load.p * here.y
    s_c = s * here.T * way.per_R
    apart = (
        s_c - get(own.middle[OWN], OF_LOADS), here.yy * s_c - get(own.middle[OWN], OF_LOADS + 1),
        here.psi - get(own.middle[OWN], OF_LOADS + 2), here.W - get(own.middle[OWN], OF_LOADS + 3),
    )  # fmt: skip
    dx = way.dx
    add(to, way.place, dx, (dx * apart[0], dx * apart[1], dx * apart[2], dx * apart[3]))
    for i in range(2 * LAST_ONES):
        put(to, SMOOTH + i, get(to, SMOOTH + i) + TAILS[i, way.place] * dx * way.phi)
    of = own.middle[DEPTH]
    dy = get(of, OF_Y) * (1.0 - way.phi) + (1.0 - mid.y) * way.phi * way.by_depth
    dR = (get(of, OF_LEVEL) - here.K_y * dy) * here.per_s
    G, psi = here.G_R * dR + here.G_y * dy, here.p_R * dR + here.p_y * dy
    W = here.W_y * dy + here.W_G * G + here.W_p * psi
    near = spread(0.0)
    if some(way.near):
        near = near_middle(of, way, way.by_depth)
    add_move(own.summed[DEPTH], of, way, way.longer, near, dy, pull * dy, dR, (G, psi, W), apart, here)
    by_numbers(here, at, cell, load, own.rows)
    for k in range(len(own.used)):
        j = own.used[k]
        row, of = own.rows[j], own.middle[j]
        dy = get(of, OF_Y) * (1.0 - way.phi)
        dT, dR = get(row, BY_T) + pull * dy, (get(of, OF_LEVEL) - here.K_y * dy - get(row, BY_K)) * here.per_s
        G, psi, W = settled_by(row, here, dy, dR)
        if some(way.near):
            near = near_middle(of, way, spread(0.0))
        add_move(own.summed[j], of, way, spread(0.0), near, dy, dT, dR, (G, psi, W), apart, here)


@kernel
def near_middle(of, way, along):
    """By what share R - T grows where it has no digits: it is the stretch from the middle, which grows by ``along`` but for
    that of the middle's reach, times the mean of its slope, which the middle tells.
    """
    mean = get(of, OF_RISE) + 0.5 * get(of, OF_BEND) * way.on
    return (along - get(of, OF_Y) * way.reach) * way.lift + mean * way.per_rise


@kernel
def add_move(to, of, way, longer, near, dy, dT, dR, settled, apart, here):
    """Add what one change moves at a place: ``longer`` is what it does to the stretch's way along the depth, ``near`` the
    share by which R - T grows where it has no digits, but for that of the middle's reach; ``settled`` what G, psi and W
    change by; what is ``apart`` from the middle is summed.
    """
    G, psi, W = settled
    reach = get(of, OF_Y) * way.reach
    share = select(way.near, near, (dR - dT) * way.per_beyond)  # of R - T
    bare, wider = dR * way.per_R, 0.5 * G * here.per_s * here.per_s
    sine = (here.R * share + dT) * way.per_sum - bare
    dx = way.dx * (longer - reach - wider - sine)
    s = here.s * here.T * way.per_R
    on, own = s * (wider + dT * way.per_T - bare), way.dx
    add(
        to, way.place, dx,
        (
            own * (on - get(of, OF_LOADS)) + dx * apart[0],
            own * (here.yy * on + 2.0 * here.y * dy * s - get(of, OF_LOADS + 1)) + dx * apart[1],
            own * (psi - get(of, OF_LOADS + 2)) + dx * apart[2], own * (W - get(of, OF_LOADS + 3)) + dx * apart[3],
        ),
    )  # fmt: skip


@kernel
def add(to, k, length, others):
    """Add place k to all sums of a row, and to what tells how smooth they are."""
    weight, late = WEIGHTS[k], LATE[k]
    add_one(to, 0, weight, late, length)
    add_one(to, 1, weight, late, others[0])
    add_one(to, 2, weight, late, others[1])
    add_one(to, 3, weight, late, others[2])
    add_one(to, 4, weight, late, others[3])


@kernel
def add_one(to, n, weight, late, value):
    """:func:`add` one of them."""
    put(to, SUM + n, get(to, SUM + n) + weight * value)
    put(to, TAIL + n, get(to, TAIL + n) + late * value)


@kernel
def fallen(to):
    """By what share the last of Legendre's coefficients fall behind those before, of a layer's stretch along x: that is so
    smooth, and none in the middle, as is all else that is summed.
    """
    before, last = (
        max(abs(get(to, SMOOTH)), abs(get(to, SMOOTH + 1))),
        max(abs(get(to, SMOOTH + 2)), abs(get(to, SMOOTH + 3))),
    )
    return min(last / max(before, TINY), 1.0)


@kernel
def close(own):
    """Behind a piece of a part: what its rule misses, by coefficients that are twice as high as the last ones, if they go
    on to fall as these do.
    """
    base, depth = own.summed[OWN], own.summed[DEPTH]
    share = fallen(base)
    share = share * share
    share = share * share
    share = share * share
    close_row(base, share)
    close_row(depth, share)
    for k in range(len(own.used)):
        close_row(own.summed[own.used[k]], share)


@kernel
def close_row(to, share):
    """:func:`close` one row."""
    for n in range(LOADS + 1):
        put(to, MISSED + n, get(to, MISSED + n) + share * abs(get(to, TAIL + n)))
        put(to, TAIL + n, 0.0)
    for i in range(2 * LAST_ONES):
        put(to, SMOOTH + i, 0.0)


@kernel
def clear(own):
    """Nothing is summed yet."""
    for j in range(NUMBERS + 2):
        for n in range(SUMS):
            put(own.summed[j], n, 0.0)

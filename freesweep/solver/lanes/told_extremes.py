"""What is told of the derivatives of the largest and the least along half a tube (:mod:`moved_extremes`), for a vector of
designs, in the order of :mod:`..along.places`, behind the outputs.
"""

from math import sqrt

from ...jit import kernel
from ..along import places
from ..cells import nothing_yet
from ..either import select
from ..physics import lagrangian
from .moved import MISSED
from .moved_extremes import FIELDS, NAN, OUTER, PULL_BETA, change, moves, place_of, place_where, steepness, values
from .moved_middle import DEPTH, OF_LEVEL, OF_Y
from .second import AREA, BY_K, BY_KG, BY_KP, GAMMA, INNER, NUMBERS, T_ALPHA, T_BETA, by_numbers, settled_by
from .told import BEHIND, NOISE, OUTPUTS, SAFETY, TOLD, WRONG, depth_by
from .vector import get, put, spread

RESULTS = OUTPUTS + len(places.NUMBERS)
PLACES = places.LEAST_ALPHA, places.LEAST_BETA, places.OUTER, places.STRETCH  # of the fields


@kernel
def one_if(found):
    """1 where something is so, of all lanes."""
    return 1.0 if found else 0.0


@kernel
def tell_extremes(mid, at, doubts, inner, cell, load, own, out):
    """Write what is told: ``out`` (2, RESULTS TOLD, WIDTH). ``at`` is the middle's level; ``doubts``: (where it is far,
    1/(how half a tube grows with the depth), what is unsure, where slack ends, by what the depth is wrong).
    """
    none = nothing_yet(spread(0.0))
    first = lagrangian.at_level(spread(1.0), mid.level, cell, load, none)
    ends = values(spread(1.0), first, inner, cell, load), values(mid.y, at, inner, cell, load)
    for field in range(FIELDS):
        y, middle, fine, near = place_where(field, ends, mid, inner, cell, load, own.seen)
        there, here = place_of(y, mid.level, near, cell, load)
        by_numbers(here, there, cell, load, own.rows)
        value = values(y, there, inner, cell, load)[field]
        tell_field(field, value, (here, middle, fine), mid, doubts, inner, cell, load, own, out)


@kernel
def tell_field(field, value, place, mid, doubts, inner, cell, load, own, out):
    """:func:`tell_extremes` of one field, which has that ``value`` at its ``place``."""
    (here, middle, fine), (far, per, unsure, ends, off) = place, doubts
    zero, deep, area = spread(0.0), own.middle[DEPTH], cell[2]
    by_level = zero, here.G_R * here.per_s, here.p_R * here.per_s, here.per_s
    by_level = abs(change(field, here, inner, area, by_level, zero, zero, zero, zero))
    by_y = select(middle, abs(steepness(field, here, inner, area)), zero)
    of_depth = by_level * abs(get(deep, OF_LEVEL)) + by_y * abs(get(deep, OF_Y))
    t = cell[0] + cell[1] if field < PULL_BETA else cell[0] - cell[1]
    longer = sqrt(1.0 + t * t)
    scale = -load.gamma * longer if field < OUTER else 0.5 / sqrt(max(value, 0.0) + one_if(field < OUTER))
    at = TOLD * (OUTPUTS + PLACES[field])
    told = scale * value * (1.0 if field < OUTER else 2.0)
    put(out[0], at, select(fine, told, NAN))
    put(out[1], at, unsure * abs(told))
    for j in range(NUMBERS):
        row, (m, missed) = own.rows[j], depth_by(j, far, per, ends, own)
        dy, level, size = moves(j, m, False, middle, own)
        dR = (level - here.K_y * dy - get(row, BY_K)) * here.per_s
        dG, dp, _ = settled_by(row, here, dy, dR)
        of_inner, of_area = zero + one_if(j == INNER), zero + one_if(j == AREA)
        moved = change(field, here, inner, area, (dy, dG, dp, dR), get(row, BY_KG), get(row, BY_KP), of_inner, of_area)
        own_part = zero
        if field < OUTER:
            own_part = -value * (one_if(j == GAMMA) * longer)
            own_part = own_part - value * (
                one_if(j == (T_ALPHA if field < PULL_BETA else T_BETA)) * load.gamma * t / longer
            )
        doubt = missed * of_depth + unsure * (by_level * size[1] + by_y * size[0])
        doubt = doubt + NOISE * (abs(moved) + by_level * abs(get(row, BY_K)))
        put(out[0], at + 1 + j, select(fine, scale * moved + own_part, NAN))
        put(out[1], at + 1 + j, abs(scale) * doubt + NOISE * abs(own_part))
    m = select(far, zero, per)
    dy, level, size = moves(0, m, True, middle, own)
    dR = (level - here.K_y * dy) * here.per_s
    dG, dp = here.G_y * dy + here.G_R * dR, here.p_y * dy + here.p_R * dR
    moved = change(field, here, inner, area, (dy, dG, dp, dR), zero, zero, zero, zero)
    put(out[0], at + TOLD - 1, select(fine, scale * moved, NAN))
    wrong = SAFETY * get(own.summed[DEPTH], MISSED) * abs(per) + unsure + WRONG * off * mid.depth
    behind = select(far, BEHIND * abs(1.0 - mid.y) * mid.rate * (by_level + by_y), zero)
    put(out[1], at + TOLD - 1, abs(scale) * (of_depth * abs(m) * wrong + behind))

"""How the shares of half a tube change along which families of fibers are slack, for a vector of designs.

Parts in which a family pulls, and not in the middle, or the other way round, are summed by themselves. Where such a part
ends the pull, seen from the taut side, vanishes: at the stretch y that moves by ::

    dy = -(da at that stretch)/(a's slope along the tube)

so the end moves along the tube by what its place moves by that keeps its share of the depth (:mod:`moved`), and by what y
moves more than that one's, over the slope of y. Where the pull hardly changes along the tube that hangs on where the end
lies.
"""

from math import sqrt

from ...jit import kernel
from ..along import places
from ..cells import nothing_yet
from ..either import isnt, select, some
from ..physics import lagrangian
from ..physics.fibers import is_taut
from ..physics.first_integral import Level
from ..physics.physical import kind_of
from .meridian import deep, look_down
from .moved import MISSED, SUM
from .moved_extremes import along, pulls_by
from .moved_middle import DEPTH, OF_LEVEL, OF_Y, OWN
from .second import BY_K, BY_KG, BY_KP, NUMBERS, by_numbers, place_at, settled_by
from .slack_ends import MOST
from .told import ENDS, NOISE, OUTPUTS, ROUNDING, SAFETY, TOLD, WRONG, depth_by
from .vector import get, put, spread

FAMILIES = 2
LEAST = 1e-300
STEPS, FARTHEST = 3, 1e-3  # of Newton's method from where an end was found; of the strain in the middle


@kernel
def begin_parts(own):
    """No part is summed yet."""
    for family in range(FAMILIES):
        for j in range(NUMBERS + 2):
            put(own.odd[family], j, spread(0.0))
        for j in range(MOST + 2):
            put(own.is_odd[family], j, spread(0.0))


@kernel
def begin_part(own):
    """Keep what is summed so far."""
    for j in range(NUMBERS + 2):
        put(own.before, j, get(own.summed[j], SUM))


@kernel
def end_part(j, within, pull, in_middle, own):
    """Behind part j: its length counts where a family pulls in it, and not in the middle, or the other way round."""
    for family in range(FAMILIES):
        here, there = pull[family] > 0.0, in_middle[family] > 0.0
        odd = within & ((here & isnt(there)) | (there & isnt(here)))
        put(own.is_odd[family], j, select(odd, 1.0, spread(0.0)))
        for i in range(NUMBERS + 2):
            grown = get(own.summed[i], SUM) - get(own.before, i)
            put(own.odd[family], i, get(own.odd[family], i) + select(odd, grown, 0.0))


@kernel
def tell_slack(parts, room, mid, in_middle, doubts, cell, load, half, own, out):
    """Write what is told of shares: ``out`` as of :func:`.told_extremes.tell_extremes`, with other arguments as of that;
    ``in_middle`` is by how much families pull there.
    """
    far, per, unsure, _, off = doubts
    zero, there, ends = spread(0.0), (in_middle[0] > 0.0, in_middle[1] > 0.0), spread(ENDS)
    for family in range(FAMILIES):
        rows, sign = own.odd[family], select(there[family], 1.0, -1.0 + zero) / half
        at = TOLD * (OUTPUTS + (places.SLACK_ALPHA if family == 0 else places.SLACK_BETA))
        length = get(rows, OWN)
        put(out[0], at, select(there[family], zero, 1.0) + sign * length)
        put(out[1], at, (SAFETY * get(own.summed[OWN], MISSED) + (unsure + ends) * length) / half + ROUNDING)
        for k in range(len(own.used)):
            j = own.used[k]
            (m, missed), one = depth_by(j, far, per, ends, own), own.summed[j]
            still, on = get(rows, j), get(rows, DEPTH)
            wrong = SAFETY * (get(one, MISSED) + abs(m) * get(own.summed[DEPTH], MISSED)) + missed * abs(on)
            wrong = wrong + (unsure + ends) * (abs(still) + abs(m * on))
            put(out[0], at + 1 + j, sign * (still + m * on))
            put(out[1], at + 1 + j, select(length > 0.0, wrong / half, zero))
        m, on = select(far, zero, per), get(rows, DEPTH)
        wrong = SAFETY * get(own.summed[DEPTH], MISSED) * abs(per) + unsure + ends + WRONG * off * mid.depth
        put(out[0], at + TOLD - 1, sign * (m * on - length / half))
        put(out[1], at + TOLD - 1, (abs(m * on) * wrong + unsure * length / half) / half)
    for j in range(1, parts):
        first = get(own.is_odd[0], j - 1) - get(own.is_odd[0], j)
        second = get(own.is_odd[1], j - 1) - get(own.is_odd[1], j)
        if some((abs(first) > 0.5) | (abs(second) > 0.5)):
            families, tube = ((first, second), there), (cell, load, half)
            move_end(get(room.edges, j), families, mid, doubts, tube, own, out, room.scratch)


@kernel
def of_kind(at, kind, a, b):
    """The Level with families of another ``kind``, of which both multipliers are given."""
    return Level(at.room, at.R, at.rise, at.G_1, at.psi, kind, a, b, at.weighed)


@kernel
def slopes_along(here):
    """How both pulls change with the stretch along the tube."""
    zero = spread(0.0)
    return pulls_by(here, *along(here, 1.0 + zero), zero, zero)


@kernel
def nonzero(number):
    """The number, or 1 where it is none."""
    return select(abs(number) > 0.0, number, 1.0)


@kernel
def where_none(place, ended, mid, cell, load):
    """``(y, R - T, Level)`` where the pull of a family is none that has ``ended`` beside a place: what counts as none there
    is not quite that, nor is an end found to all digits.
    """
    taut, zero, most = is_taut(place.at.kind), spread(0.0), FARTHEST * abs(1.0 - mid.y)
    kind = kind_of(taut[0] | ended[0], taut[1] | ended[1])
    y, beyond, at = place.y, place.beyond, of_kind(place.at, kind, place.at.a, place.at.b)
    for _ in range(STEPS):
        slopes = slopes_along(place_at(y, beyond, at, cell, load))
        step = -select(ended[0], at.a, at.b) / nonzero(select(ended[0], slopes[0], slopes[1]))
        step = min(max(step, -most), most)
        near = kind, y, zero, at.psi, zero, zero, at.G_1, zero, zero
        y, beyond = y + step, beyond + at.rise * step
        at = lagrangian.at_level(y, mid.level, cell, load, near)
        at = of_kind(at, kind, at.a, at.b)
    return y, beyond, of_kind(at, kind, select(ended[0], zero, at.a), select(ended[1], zero, at.b))


@kernel
def move_end(t, families, mid, doubts, tube, own, out, scratch):
    """Add what it does to both shares that an end at the share ``t`` of the depth moves; ``families``: (signs, 1 where the
    part that counts lies before it, -1 where behind, else 0; whether each pulls in the middle). ``tube``: (cell, load,
    half).
    """
    (first, second), (cell, load, half) = families[0], tube
    depth, steep = deep(t, mid.depth)
    ended = abs(first) > 0.5, abs(second) > 0.5
    place = look_down(depth, steep, mid, cell, load, nothing_yet(t), scratch)
    (y, beyond, at), zero = where_none(place, ended, mid, cell, load), spread(0.0)
    here, step = place_at(y, beyond, at, cell, load), y - place.y
    by_numbers(here, at, cell, load, own.rows)
    sine = sqrt(max(beyond * (here.R + here.T), LEAST)) / here.R
    grown = select(mid.y > 1.0, 1.0, -1.0 + zero) / (here.s * sine)  # x with y
    i = 1.0 / (1.0 - mid.q)
    phi = (place.z - mid.q) * (place.z - mid.q) * i * i / place.z + step / (1.0 - mid.y)
    middle = mid.q + 0.5 * phi * (1.0 - mid.q) * (1.0 - mid.q)
    z = middle + sqrt(max(middle * middle - mid.q * mid.q, 0.0))
    share = (depth + (place.z - z) / z) / mid.depth
    inner = (mid.q - z * share) / select(z > mid.q, z - mid.q, 1.0)
    by_depth = (1.0 - mid.y) * phi * (2.0 * inner + share - 2.0 * mid.q * i)
    slopes = slopes_along(here)
    for k in range(len(own.used) + 1):
        of_length = k == len(own.used)
        j = 0 if of_length else own.used[k]
        counts = 0.0 if of_length else 1.0
        move_end_by(j, counts, (phi, by_depth, grown, slopes, step), families, mid, here, doubts, half, own, out)


@kernel
def move_end_by(j, counts, end, families, mid, here, doubts, half, own, out):
    """:func:`move_end` with number j, or, where it ``counts`` for nothing, with the length of the half; a ``step`` of the
    stretch leads to the end from where it was found.
    """
    signs, there = families
    phi, by_depth, grown, slopes, step = end
    (far, per, unsure, _, off), zero, ends = doubts, spread(0.0), spread(ENDS)
    row, deeper, of, at_row = own.rows[j], own.middle[DEPTH], own.middle[j], 1 + j
    m, missed = depth_by(j, far, per, ends, own)
    if counts == 0.0:
        m, missed, at_row = select(far, zero, per), abs(per) * (unsure + WRONG * off * mid.depth), TOLD - 1
    level = counts * get(of, OF_LEVEL) + m * get(deeper, OF_LEVEL)
    dR = (level - counts * get(row, BY_K)) * here.per_s
    dG, dp, _ = settled_by(row, here, zero, dR)
    if counts == 0.0:
        dG, dp = here.G_R * dR, here.p_R * dR
    changed = pulls_by(here, zero, dG, dp, dR, counts * get(row, BY_KG), counts * get(row, BY_KP))
    still, on = counts * get(of, OF_Y) * (1.0 - phi), get(deeper, OF_Y) * (1.0 - phi) + by_depth
    for family in range(FAMILIES):
        sign = signs[family]
        ended, slope = abs(sign) > 0.5, slopes[family]
        dy = -changed[family] / nonzero(slope)
        size = select(ended, abs(grown) * (abs(dy) + abs(still) + abs(m * on)), zero)
        wrong = (unsure + ends + NOISE) * size + select(ended, missed * abs(grown * on), zero)
        of_share = TOLD * (OUTPUTS + (places.SLACK_ALPHA if family == 0 else places.SLACK_BETA))
        at, sign = of_share + at_row, select(there[family], sign, -sign) / half
        put(out[0], at, get(out[0], at) + select(ended, sign * grown * (dy - still - m * on), zero))
        put(out[1], at, get(out[1], at) + wrong / half)
        if counts == 0.0:
            on_share = select(ended, sign * grown * step, zero)
            put(out[0], of_share, get(out[0], of_share) + on_share)
            put(out[0], at, get(out[0], at) - on_share / half)

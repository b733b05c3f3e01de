"""What a tube that is the same all along looks like along its half, from its first integral, for a vector of designs.

Sums up to each place of the rules (:mod:`rule`) tell x, axial position and twist there, polynomials between them the
depth of a station; what is known of a place is told by its stretch and the level (:mod:`meridian`). How far a station
may be off, and by how much the middle may have moved, makes the bounds.
"""

from math import atan, sqrt

import numpy as np

from ...jit import entry_point, kernel
from ..along.profile import FIELDS, VALUES
from ..cells import nothing_yet
from ..numerics.error_bounds import TINY
from ..physics import lagrangian
from ..physics.lagrangian import ROUNDING
from ..problem import PHYSICAL, SOURCE
from . import slack_ends
from .first_guess import kept
from .free import seat_states
from .meridian import DEEPEST, Middle, handed_on, look, middle, middle_at, uniform_at
from .outputs import DX, LENGTH, TWIST, by_depth
from .pack import COLUMNS, Asked, Kind, aligned, loads
from .pack import LENGTH as HALF
from .rule import LAST, PLACES, UP_TO, missed_within, summed
from .sums import along, find_ends, graded, make_room, scan
from .vector import WIDTH, bits, get, isnt, mask_of, put, select, spread

# what is kept of each place of the way; axial position and twist as what they differ by from those of a tube like its middle
SHARE, X, GROWTH, Z, TURN, DOUBT_X, DOUBT_Z, DOUBT_TURN = range(8)
KEPT = DOUBT_TURN + 1
STEPS, CLOSE = 40, 1e-14  # to a station, of a part
DEPTH, LONGER, TURNED, LEFT = range(4)  # rows of where a station lies


@kernel
def chosen(given, one, other):
    """The :class:`Middle` of the lanes that are ``given``, in others the other one."""
    return Middle(
        select(given, one.u, other.u), select(given, one.rate, other.rate), select(given, one.depth, other.depth),
        select(given, one.q, other.q), select(given, one.whole, other.whole), select(given, one.y, other.y),
        select(given, one.level, other.level), select(given, one.per_depth, other.per_depth),
        select(given, one.rise, other.rise), select(given, one.bend, other.bend), select(given, one.s, other.s),
        select(given, one.psi, other.psi), select(given, one.energy, other.energy), one.uniform,
        kept(given, one.near, other.near),
    )  # fmt: skip


@kernel
def go(parts, pieces, edges, mid, cell, load, rows, way, scratch):
    """Write what is known of each place along half a tube to the rows of the ``way``; returns how many those are, and
    the lanes that may be.
    """
    valid, near, count = mask_of(-1), nothing_yet(spread(0.0)), 0
    sums, doubts = (spread(0.0), spread(0.0), spread(0.0)), (spread(0.0), spread(0.0), spread(0.0))
    for j in range(parts):
        left, width = get(edges, j), get(edges, j + 1) - get(edges, j)
        for i in range(pieces):
            first, last = left + graded(i, pieces) * width, left + graded(i + 1, pieces) * width
            near, fine = along(first, last, mid, cell, load, near, True, rows, scratch)
            valid = valid & fine
            grown, lengthened, turned = summed(rows[DX]), summed(rows[LENGTH]), summed(rows[TWIST])
            doubts = (
                doubts[0] + missed_within(rows[DX]), doubts[1] + missed_within(rows[LENGTH]),
                doubts[2] + missed_within(rows[TWIST]),
            )  # fmt: skip
            for k in range(LAST + 1):
                x, z, turn = spread(0.0), spread(0.0), spread(0.0)
                for l in range(LAST + 1):
                    x, z = x + UP_TO[k, l] * get(rows[DX], l), z + UP_TO[k, l] * get(rows[LENGTH], l)
                    turn = turn + UP_TO[k, l] * get(rows[TWIST], l)
                put(way[SHARE], count, first + (last - first) * PLACES[k])
                put(way[X], count, sums[0] + x)
                put(way[GROWTH], count, get(rows[DX], k))
                put(way[Z], count, sums[1] + z)
                put(way[TURN], count, sums[2] + turn)
                put(way[DOUBT_X], count, doubts[0])
                put(way[DOUBT_Z], count, doubts[1])
                put(way[DOUBT_TURN], count, doubts[2])
                count += 1
            sums = sums[0] + grown[0], sums[1] + lengthened[0], sums[2] + turned[0]
    return count, valid


@kernel
def between(t, row, first, lane):
    """The polynomial through the places of one rule in a row, at the share t of it: barycentric, of Chebyshev's points."""
    above, below = 0.0, 0.0
    for k in range(LAST + 1):
        apart = t - PLACES[k]
        if apart == 0.0:
            return row[first + k, lane]
        weight = (1.0 if k % 2 == 0 else -1.0) * (0.5 if k == 0 or k == LAST else 1.0) / apart
        above += weight * row[first + k, lane]
        below += weight
    return above / below


@kernel
def meet(x, way, first, lane):
    """The share of one rule at which x is met."""
    low, high = 0.0, 1.0
    t = (x - way[X, first, lane]) / max(way[X, first + LAST, lane] - way[X, first, lane], TINY)
    for _ in range(STEPS):
        t = min(max(t, low), high)
        miss = between(t, way[X], first, lane) - x
        if miss > 0.0:
            high = t
        else:
            low = t
        step = miss / between(t, way[GROWTH], first, lane)
        ahead = t - step
        if not low <= ahead <= high:
            ahead = 0.5 * (low + high)
        if abs(ahead - t) < CLOSE:
            return min(max(ahead, 0.0), 1.0)
        t = ahead
    return t


@kernel
def stand(x, count, way, beside, at, moved):
    """Where the station x lies in each lane, ``at``: the share of the DEPTH, by what axial position and twist differ from
    those of the middle, LONGER and TURNED, and what is LEFT behind the last place, which is like the middle; doubts of x,
    axial position and twist, ``moved``.
    """
    for lane in range(WIDTH):
        first = beside[lane]
        while first + LAST + 1 < count and way[X, first + LAST, lane] < x:
            first += LAST + 1
        beside[lane] = first
        t = 1.0 if x > way[X, count - 1, lane] else meet(x, way, first, lane)
        last = first + LAST
        at[DEPTH, lane] = way[SHARE, first, lane] + t * (way[SHARE, last, lane] - way[SHARE, first, lane])
        at[LONGER, lane], at[TURNED, lane] = between(t, way[Z], first, lane), between(t, way[TURN], first, lane)
        for k in range(3):
            moved[k, lane] = way[DOUBT_X + k, last, lane]
    put(at, LEFT, max(x - get(way[X], count - 1), 0.0))


@kernel
def angle(tangent, scratch):
    """The angles of lanes."""
    put(scratch, 0, tangent)
    for lane in range(WIDTH):
        scratch[0, lane] = atan(scratch[0, lane])
    return get(scratch, 0)


@kernel
def local(y, at, cell, load, scratch):
    """Angles after deformation [rad], and multipliers of both families with their extension, at one place."""
    meridional = sqrt(1.0 + at.G_1)
    return (
        angle(y * (cell[0] + cell[1] + at.psi) / meridional, scratch),
        angle(y * (cell[0] - cell[1] + at.psi) / meridional, scratch), load.gamma * pull(at.a, load),
        load.gamma * pull(at.b, load),
    )  # fmt: skip


@kernel
def pull(multiplier, load):
    """What a family pulls by: a slack one, by nothing."""
    return max(multiplier, 0.0) if slack_ends.may_go_slack(load.wall) else multiplier


@kernel
def tell(x, mid, cell, load, half, placed, stood, near, scratch, out):
    """Write the FIELDS of a station that :func:`stand` found to ``out`` (FIELDS, WIDTH), where the middle may have moved by
    the share ``placed`` of its strain; what is left of a long tube has the middle's, or that of the uniform tube.
    Returns what is handed on.
    """
    at, moved = stood[0], stood[1]
    longer, turned, left = get(at, LONGER), get(at, TURNED), get(at, LEFT)
    here = look(get(at, DEPTH), mid, cell, load, near, scratch)
    y, level = here.y, here.at
    near = handed_on(y, level, near, load.wall)
    s = sqrt(1.0 + level.G_1)
    sine = sqrt(max(1.0 - here.cosine * here.cosine, 0.0))
    off = get(moved, 0)
    z, turn = mid.s * x + longer, mid.psi * x + turned
    middle_off = abs(1.0 - mid.y) * placed
    wrong = s * sine * off + middle_off
    _, G_1, psi, _ = lagrangian.level_of(mid.u, cell, load, near)
    own = local(y, level, cell, load, scratch)
    by_y = local(y + wrong, lagrangian.at_level(y + wrong, mid.level, cell, load, near), cell, load, scratch)
    higher = mid.level + mid.s * mid.rise * middle_off
    by_level = local(y, lagrangian.at_level(y, higher, cell, load, near), cell, load, scratch)
    put(out, 0, y)
    put(out, 1, z)
    put(out, 2, turn)
    put(out, VALUES, wrong + ROUNDING * y)
    put(
        out,
        VALUES + 1,
        get(moved, 1)
        + placed * abs(longer)
        + abs(s * here.cosine - mid.s) * off
        + select(left > 0.0, abs(sqrt(1.0 + G_1) - mid.s) * left, 0.0)  # else u is but a number
        + ROUNDING * half,
    )
    put(
        out,
        VALUES + 2,
        get(moved, 2)
        + placed * abs(turned)
        + abs(level.psi - mid.psi) * off
        + select(left > 0.0, abs(psi - mid.psi) * left, 0.0)
        + ROUNDING * max(1.0, abs(turn)),
    )
    for k in range(4):
        put(out, 3 + k, own[k])
        put(out, VALUES + 3 + k, abs(by_y[k] - own[k]) + abs(by_level[k] - own[k]) + ROUNDING * abs(own[k]))
    return near


@kernel
def judge(out, half, turned, worst, loose, tension):
    """``(worst, loose, tension)`` with one station more: the largest bound, scaled, of all but tensions; of those it,
    and the largest of them.
    """
    worst = max(worst, max(get(out, VALUES), max(get(out, VALUES + 1) / half, get(out, VALUES + 2) / turned)))
    worst = max(worst, max(get(out, VALUES + 3), get(out, VALUES + 4)))
    loose = max(loose, max(get(out, VALUES + 5), get(out, VALUES + 6)))
    return worst, loose, max(tension, max(abs(get(out, 5)), abs(get(out, 6))))


@kernel
def seat(group, count, asked, depths, rows, columns, start, beside):
    """:func:`.free.seat_states`, with the depths of middles behind their stretches."""
    seat_states(group, count, asked, rows, columns, start)
    for lane in range(WIDTH):
        start[1, lane], beside[lane] = depths[rows[lane]], 0


@kernel
def seated(start, cell, load, half, scratch):
    """The :class:`.meridian.Middle` of the uniform stretch and the depth, or, where that is NaN, of its stretch: the
    uniform one where rounding alone drives it.
    """
    u, depth = get(start, 0), get(start, 1)
    known = depth == depth
    found, driven, _ = middle_at(u, cell, load, half, scratch)
    given = middle(uniform_at(u, cell, load), select(known, depth, DEEPEST), cell, load, scratch)
    return chosen(known | isnt(driven), given, found)


@kernel
def draw(asked, depths, stations, kind, pieces, accuracy, profiles, drawn):
    """Write the profiles (FIELDS, m) of the rows that are ``asked`` for at the ``stations`` (m,), ascending distances
    from the end in radii, WIDTH at a time, each part in so many ``pieces``; ``drawn`` (n,) are those whose bounds meet
    the ``accuracy``. Rows start from what :func:`.free.solve` leaves: uniform stretch of the middle and one of the
    ``depths`` (n,), or its stretch and NaN.
    """
    room, way, small = make_room(), aligned(KEPT, (slack_ends.MOST + 1) * pieces * (LAST + 1)), aligned(2, COLUMNS)
    columns, start, out, stood = small[0], small[1], aligned(1, FIELDS)[0], aligned(2, KEPT)
    rows, beside = np.zeros(WIDTH, np.int64), np.zeros(WIDTH, np.int64)
    ends, counts, starts, edges, scratch = room.ends, room.counts, room.starts, room.edges, room.scratch
    for group in range(0, len(asked.order), WIDTH):
        count = min(WIDTH, len(asked.order) - group)
        seat(group, count, asked, depths, rows, columns, start, beside)
        cell, _, load = loads(columns, kind.constants, kind.walls, kind.layers)
        half = get(columns, HALF)
        mid = seated(start, cell, load, half, scratch)
        _, _, _, _, valid, _ = scan(pieces, mid, cell, load, room.rows, ends, counts, starts, scratch)
        parts, unsure = find_ends(mid, cell, load, valid, ends, counts, starts, edges, scratch)
        last, fine = go(parts, pieces, edges, mid, cell, load, room.rows, way, scratch)
        miss = half - get(way[X], last - 1)
        moved = min(mid.rate * (abs(miss) + get(way[DOUBT_X], last - 1)), 1.0)  # deep in a tube little depends on it
        placed = by_depth(mid) * moved
        turned = max(1.0, abs(half * mid.psi + get(way[TURN], last - 1)))
        worst, loose, tension, near = spread(0.0), spread(0.0), spread(0.0), nothing_yet(spread(0.0))
        for j in range(len(stations)):
            stand(stations[j], last, way, beside, stood[0], stood[1])
            near = tell(stations[j], mid, cell, load, half, placed, stood, near, scratch, out)
            worst, loose, tension = judge(out, half, turned, worst, loose, tension)
            for lane in range(count):
                for k in range(FIELDS):
                    profiles[rows[lane], k, j] = out[k, lane]
        worst = max(worst, loose / max(tension, TINY))
        ready = bits(valid & fine & (worst <= accuracy) & (unsure < slack_ends.ENOUGH))
        for lane in range(count):
            drawn[rows[lane]] = (ready >> lane) & 1 == 1


@entry_point
def draw_lanes(problems, owners, pressures, middles, order, stations, constants, pieces, accuracy, profiles, drawn):
    """:func:`draw` the source's tubes."""
    asked, kind = Asked(problems, owners, pressures, middles[:, 0], order), Kind(constants, SOURCE, 1)
    draw(asked, middles[:, 1], stations, kind, pieces, accuracy, profiles, drawn)


@entry_point
def draw_physical(
    problems, owners, pressures, middles, order, stations, constants, layers, pieces, accuracy, profiles, drawn
):  # fmt: skip
    """:func:`draw` physical tubes."""
    asked, kind = Asked(problems, owners, pressures, middles[:, 0], order), Kind(constants, PHYSICAL, layers)
    draw(asked, middles[:, 1], stations, kind, pieces, accuracy, profiles, drawn)

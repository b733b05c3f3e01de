"""Derivatives of free states of tubes that are the same all along, a vector of states at a time.

A state that is known is one number, the stretch in the middle: it tells every place of half the tube (:mod:`meridian`),
part by part between the places where families go slack. How each place answers to numbers (:mod:`second`) is summed along
the depth as the state is (:mod:`moved`); one number more, the depth of the middle, moves by what leaves half a tube as long
as it is, and with it all outputs (:mod:`told`).

Where hardly anything is left of the layer in the middle, the middle is the uniform tube, and answers as that does.
"""

from math import sqrt

import numpy as np

from ...jit import entry_point, kernel
from ..cells import nothing_yet
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from ..problem import PHYSICAL
from . import slack_ends
from .meridian import DEEPEST, EVEN, LEAST_EVEN, Middle, deep, fallen, handed_on, look_down, middle_at
from .moved import COUNT, PLACES, SUM, clear, close, make_sums, move_place, way_of
from .moved_extremes import begin, see
from .moved_middle import DEPTH, OWN, move_middle
from .moved_slack import begin_part, begin_parts, end_part, tell_slack
from .pack import COLUMNS, LENGTH, PRESSURE, aligned, enter, loads, lock
from .quadrature import look_along
from .rule import LAST
from .rule import PLACES as RULE
from .second import place_at
from .sums import ALPHA, KIND, NARROW, along, find_ends, graded, make_room
from .told import LEFT, TOLD, tell
from .told_extremes import RESULTS, tell_extremes
from .vector import WIDTH, bits, get, isnt, mask_of, put, select, some, spread

PASSES = 6  # to a middle whose half has its length
# of what hangs on the depth of the middle: a share that may be wrong, and one that need not be mended
ALMOST, ENOUGH = 1e-5, 3e-10
SWOLLEN = 0.1  # by which a swelling makes the layer's beginning slower
# of a depth, what a step leaves at least; deeper than anything is told apart; by how much it has to be less than the deepest
LEAST, LONGEST, SURELY = 0.5, 30.0, 1.0


@kernel
def seated(y, cell, load, half, scratch):
    """The :class:`.meridian.Middle` of a tube whose middle has the stretch ``y``, and where it is far: where no drive is
    left it is the uniform tube, toward which the layer falls without end.
    """
    mid, driven, _ = middle_at(y, cell, load, half, scratch)
    far = isnt(driven) | (mid.depth >= DEEPEST)
    rate = select(far, mid.s * sqrt(max(mid.bend, 1.0 / (half * half)) / (load.p * y * y + load.f)), mid.rate)
    depth = select(far, min(rate * half, DEEPEST), mid.depth)
    q = select(far, 0.0, fallen(depth, scratch))
    return Middle(
        select(far, y, mid.u), rate, depth, q, 1.0 / (1.0 + q * q), y, mid.level,
        select(far, 1.0 / rate, mid.per_depth), select(far, 0.0, mid.rise), mid.bend, mid.s, mid.psi, mid.energy,
        mid.uniform, mid.near,
    ), far  # fmt: skip


@kernel
def down(share, left, width, mid):
    """``(depth, its derivative)`` at a share of a part, from ``left`` on: slow where the layer begins, the more so where a
    tube swells many times.
    """
    even = max(1.0 - width / EVEN, LEAST_EVEN) / (1.0 + SWOLLEN * select(left > 0.0, 0.0, max(mid.y - 1.0, 0.0)))
    bent = (1.0 - even) * share * share
    return left + width * share * (even + bent), width * (even + 3.0 * bent)


@kernel
def look_for_ends(pieces, mid, cell, load, room):
    """Bracket where families that may push would begin to, or stop it, to the room's ``ends``, along so many ``pieces``."""
    near = nothing_yet(spread(0.0))
    for lane in range(WIDTH):
        room.counts[lane] = 0
    for i in range(pieces):
        left, right = graded(i, pieces), graded(i + 1, pieces)
        near, _ = along(spread(left), spread(right), mid, cell, load, near, False, room.rows, room.scratch)
        for family in range(2):
            slack_ends.bracket(
                left, right - left, RULE, room.rows[ALPHA + family], family, LAST, room.rows[KIND:], room.ends, room.counts,
                room.starts,
            )  # fmt: skip


@kernel
def none_but(lanes, counts):
    """Others than these ``lanes``, as bits, have no ends, whoever their neighbours are."""
    for lane in range(WIDTH):
        if not (lanes >> lane) & 1:
            counts[lane] = 0


@kernel
def over_parts(parts, pieces, edges, mid, in_middle, inner, cell, load, own, scratch):
    """Sum all parts between the ``edges``, each in so many ``pieces``, to our ``own`` :class:`.moved.Sums`; by how much
    families pull ``in_middle``. Returns the lanes in which each part is of one kind.
    """
    valid, near, before = mask_of(-1), nothing_yet(spread(0.0)), spread(1.0)
    clear(own)
    begin(own.seen)
    begin_parts(own)
    for j in range(parts):
        begin_part(own)
        first, width = deep(get(edges, j), mid.depth)[0], deep(get(edges, j + 1), mid.depth)[0]
        width = (width - first) / pieces
        within, kind, pull = width > NARROW * mid.depth, spread(-1.0), (spread(0.0), spread(0.0))
        for i in range(pieces):
            for k in range(COUNT):
                depth, steep = down(PLACES[k], first + i * width, width, mid)
                here = look_down(depth, steep, mid, cell, load, near, scratch)
                at = here.at
                near = handed_on(here.y, at, near, load.wall)
                if k == 0:
                    kind, pull = at.kind, slack_ends.pulls(at, load)
                valid = valid & (((at.room > 0.0) & (at.kind == kind)) | isnt(within))
                place = place_at(here.y, here.beyond, at, cell, load)
                way = way_of(k, within, depth, here.z, here.per_share, place, load, mid)
                move_place(way, place, at, cell, load, mid, own)
                see(within, here.y, before, at, inner, cell, load, own.seen)
                before = here.y
            close(own)
        end_part(j, within, pull, in_middle, own)
    return valid


@kernel
def met_by(mid, far, slope, place, load, half, own, scratch):
    """``(stretch of the middle, share that is missed)`` of which half a tube is as long as it is, about: the uniform stretch
    beside it stays. The share is one of all that hangs on the depth of the middle; that of a long tube is uniform, and may
    be missed by a share of the strain.
    """
    rest = half - get(own.summed[OWN], SUM)
    rise = -place.K_y * place.per_s - 2.0 * load.p * place.y
    step = select(far, rest * mid.rate, rest / select(far, 1.0, get(own.summed[DEPTH], SUM)))
    depth = min(max(mid.depth + step, LEAST * mid.depth), LONGEST)
    q, u = fallen(depth, scratch), select(far, mid.y - rise / slope, mid.u)
    on = (1.0 - u) * 2.0 * (q / (1.0 + q * q) - mid.q * mid.whole)
    short = far & (mid.depth + step < DEEPEST - SURELY)
    y = select(far, select(short, u + on, u), mid.y + on)
    off = select(far, abs(u - mid.y) / abs(1.0 - mid.y), abs(step) / mid.depth * min(LEFT * mid.depth * mid.q, 1.0))
    return y, select(short, 1.0, off)


@kernel
def seat(group, count, order, problems, pressures, known, limp, columns, start):
    """Put the next ``count`` rows in the given ``order`` into the lanes; those that are left take the last one, too. Returns
    of which some family goes slack somewhere, and not everywhere, as bits.
    """
    ends = 0
    for lane in range(WIDTH):
        row = order[group + min(lane, count - 1)]
        enter(lane, problems[row], columns)
        start[0, lane], start[1, lane] = known[0, row], known[1, row]
        ends |= (1 if limp[row] else 0) << lane
        if pressures[row] == np.inf:
            lock(lane, columns)
        else:
            columns[PRESSURE, lane] = pressures[row]
    return ends


@entry_point
def differentiate_lanes(problems, pressures, known, limp, order, constants, layers, used, pieces, told):
    """Values and bounds, ``told`` (2, rows, RESULTS, TOLD), of the rows in the given ``order``, WIDTH at a time: of the
    outputs, of their derivatives by the numbers of :mod:`second`, and by the length of the half. Values are NaN where
    vectors cannot.

    Row i is a physical problem under ``pressures[i]``, of which are ``known`` (2, rows) the stretch of the
    middle, about, and the squared radius of the wall's inner surface; ``limp`` tells where some family goes slack along a
    part. ``used`` are the numbers that there are; others are told nothing. Other arguments as of
    :func:`.free.solve_physical`.
    """
    room, own, small, out = make_room(), make_sums(used), aligned(2, COLUMNS), aligned(2, RESULTS * TOLD)
    columns, start, scratch, edges = small[0], small[1], room.scratch, room.edges
    for group in range(0, len(order), WIDTH):
        seats = min(WIDTH, len(order) - group)
        searched = seat(group, seats, order, problems, pressures, known, limp, columns, start)
        cell, _, load = loads(columns, constants, PHYSICAL, layers)
        y, inner, half = get(start, 0), get(start, 1), get(columns, LENGTH)
        active, met = mask_of((1 << seats) - 1), mask_of(0)
        is_loose = may_go_slack(load.wall)
        for step in range(PASSES):
            (mid, far), parts, unsure = seated(y, cell, load, half, scratch), 1, spread(0.0)
            put(edges, 0, 0.0)
            put(edges, 1, 1.0)
            if searched != 0:
                if is_loose:
                    _, seen, valid = look_along(pieces, mid, cell, load, room)
                    fine = valid & (seen.doubts[0] + seen.doubts[1] == 0.0)
                    active = active & (fine | isnt(mask_of(searched)))
                else:
                    look_for_ends(pieces, mid, cell, load, room)
                none_but(searched, room.counts)
                parts, unsure = find_ends(mid, cell, load, active, room.ends, room.counts, room.starts, edges, scratch)
                active = active & ((unsure < slack_ends.ENOUGH) | mask_of(0 if is_loose else -1))
            at = lagrangian.at_level(mid.y, mid.level, cell, load, nothing_yet(spread(0.0)))
            place = place_at(mid.y, spread(0.0), at, cell, load)
            pull = slack_ends.pulls(at, load)
            slope = move_middle(mid, place, at, cell, load, half, own)
            active = active & over_parts(parts, pieces, edges, mid, pull, inner, cell, load, own, scratch)
            better, off = met_by(mid, far, slope, place, load, half, own, scratch)
            met = active & (off < ALMOST)
            if step + 1 == PASSES or not some(active & (off > ENOUGH)):
                loose = (unsure > 0.0) & mask_of(-1 if is_loose else 0)
                doubts = tell(mid, far, off, loose, load, half, own, out)
                tell_extremes(mid, at, doubts, inner, cell, load, own, out)
                tell_slack(parts, room, mid, pull, doubts, cell, load, half, own, out)
                break
            y = select(off > ENOUGH, better, y)
        for lane in range(seats):
            row = order[group + lane]
            for i in range(RESULTS):
                for j in range(TOLD):
                    k = TOLD * i + j
                    told[0, row, i, j] = out[0, k, lane] if (bits(met) >> lane) & 1 else np.nan
                    told[1, row, i, j] = out[1, k, lane]

"""Derivatives of free states of tubes that are the same all along, a vector of states at a time.

A state that is known is one number, the stretch in the middle: it tells every place of half the tube (:mod:`meridian`), part
by part between the places where families go slack. There the density's second derivatives (:mod:`second`) are summed to
those of the functional (:mod:`element`), by which all that loads are conjugate to, the outputs, change with any number. How
they change with the length of the half is known in the middle alone: there the functional grows by L, and the middle by what
it answers with to a push.

Where hardly anything is left of the layer in the middle, the middle is the uniform tube, and answers as that does.
"""

from math import sqrt

import numpy as np

from ...jit import entry_point, kernel
from ..cells import nothing_yet
from ..physics.wall import may_go_slack
from ..problem import PHYSICAL
from . import slack_ends
from .element import (
    COUNT,
    OF_STATE,
    PIVOT,
    PLACES,
    WEIGHTS,
    assemble,
    clear,
    derive,
    eliminate,
    gather,
    make_variation,
    roughness,
    weigh,
)
from .meridian import DEEPEST, EVEN, LEAST_EVEN, Middle, deep, fallen, handed_on, look_down, middle_at
from .pack import COLUMNS, LENGTH, PRESSURE, aligned, enter, loads, lock
from .quadrature import look_along
from .second import LOADS, bends
from .sums import NARROW, find_ends, make_room
from .told import CLOSE, OUTPUTS, TOLD, finish
from .vector import WIDTH, bits, get, mask_of, put, select, some, spread

PASSES = 4  # to a middle whose half has its length
SWOLLEN = 0.1  # by which a swelling makes the layer's beginning slower


@kernel
def seated(y, cell, load, half, scratch):
    """The :class:`.meridian.Middle` of a tube whose middle has the stretch ``y``; where no drive is left it is the uniform
    tube.
    """
    mid, driven, _ = middle_at(y, cell, load, half, scratch)
    far = ~driven | (mid.depth >= DEEPEST)
    rate = select(far, mid.s * sqrt(max(mid.bend, 1.0 / (half * half)) / (load.p * y * y + load.f)), mid.rate)
    depth = select(far, min(rate * half, DEEPEST), mid.depth)
    q = fallen(depth, scratch)
    return Middle(
        select(far, y, mid.u), rate, depth, q, 1.0 / (1.0 + q * q), y, mid.level,
        select(far, 1.0 / rate, mid.per_depth), select(far, 0.0, mid.rise), mid.bend, mid.s, mid.psi, mid.energy,
        mid.uniform,
    )  # fmt: skip


@kernel
def down(share, left, width, mid):
    """``(depth, its derivative)`` at a share of a part, from ``left`` on: slow where the layer begins, the more so where a
    tube swells many times.
    """
    even = max(1.0 - width / EVEN, LEAST_EVEN) / (1.0 + SWOLLEN * select(left > 0.0, 0.0, max(mid.y - 1.0, 0.0)))
    bent = (1.0 - even) * share * share
    return left + width * share * (even + bent), width * (even + 3.0 * bent)


@kernel
def slope_at(y, per_share, steep, mid):
    """Slope of a place whose depth grows by ``steep`` with a share, and x by ``per_share``: no cosine tells it near the
    middle.
    """
    fall = sqrt(max((y - mid.y) * ((y - mid.u) + (mid.y - mid.u)), 0.0))
    return select(mid.u > 1.0, fall, -fall) * steep / per_share


@kernel
def over_parts(parts, pieces, edges, mid, cell, load, own, scratch):
    """Sum all parts between the ``edges``, each in so many ``pieces``, to a :class:`.element.Variation` of our ``own``.
    Returns the lanes in which each part is of one kind, and the length.
    """
    valid, near, fixed, length = mask_of(-1), nothing_yet(spread(0.0)), mask_of(-1), spread(0.0)
    used, fields, rows = own.used, own.fields, own.rows
    clear(own)
    for j in range(parts):
        first, width = deep(get(edges, j), mid.depth)[0], deep(get(edges, j + 1), mid.depth)[0]
        width = (width - first) / pieces
        within = width > NARROW * mid.depth
        for i in range(pieces):
            kind = spread(-1.0)
            for k in range(COUNT):
                depth, steep = down(PLACES[k], first + i * width, width, mid)
                here = look_down(depth, steep, mid, cell, load, near, scratch)
                near = handed_on(here.y, here.at, near, load.wall)
                if k == 0:
                    kind = here.at.kind
                valid = valid & (((here.at.room > 0.0) & (here.at.kind == kind)) | ~within)
                bends(here.y, slope_at(here.y, here.per_share, steep, mid), here.cosine, here.at, cell, load, rows[0])
                weight = WEIGHTS[k] * here.per_share
                weigh(k, weight, 1.0 / here.per_share, rows[0], rows[1], used, fields)
                weight = select(within, weight, 0.0)
                gather(weight, rows[0], used, own.sums[0])
                length = length + weight
            add_part(within, fixed, own)
            fixed = fixed & ~within
    return valid, length


@kernel
def add_part(where, fixed, own):
    """Add what the fields of a part tell, in the lanes that have it: how rough they are, and what it answers with."""
    used, fields, matrix = own.used, own.fields, own.matrix
    for n in range(LOADS):
        missed, most = roughness(fields[OF_STATE + 2 * len(used) + n])
        put(own.rough[0], n, get(own.rough[0], n) + select(where, missed, 0.0))
        put(own.rough[1], n, get(own.rough[1], n) + select(where, most, 0.0))
    assemble(fields, len(used), matrix[0], own.pushed, own.halves)
    eliminate(where, fixed, used, matrix[0], own.pushed, matrix[1], matrix[2], own.carried, own.known)
    derive(where, used, own.pushed, matrix[2], own.halves[0], own.sums[1])


@kernel
def seat(group, count, order, problems, pressures, middles, limp, columns, start):
    """Put the next ``count`` rows in the given ``order`` into the lanes; those that are left take the last one, too. Returns
    whether some family of one goes slack somewhere, and not everywhere.
    """
    ends = False
    for lane in range(WIDTH):
        row = order[group + min(lane, count - 1)]
        enter(lane, problems[row], columns)
        start[0, lane] = middles[row]
        ends = ends or limp[row]
        if pressures[row] == np.inf:
            lock(lane, columns)
        else:
            columns[PRESSURE, lane] = pressures[row]
    return ends


@entry_point
def differentiate_lanes(problems, pressures, middles, limp, order, constants, layers, used, pieces, told):
    """Values and bounds, ``told`` (2, rows, OUTPUTS, TOLD), of the rows in the given ``order``, WIDTH at a time: of the
    outputs, of their derivatives by the numbers of :mod:`second`, and by the length of the half. Values are NaN where
    vectors cannot.

    Row i is a physical problem under ``pressures[i]``, the stretch of whose middle is ``middles[i]``, about; ``limp`` tells
    where some family goes slack along a part of it. ``used`` are the numbers that there are, all LOADS among them.
    Other arguments as of :func:`.free.solve_physical`.
    """
    room, own, small, out = make_room(), make_variation(used), aligned(2, COLUMNS), aligned(2, OUTPUTS * TOLD)
    columns, start, scratch, edges = small[0], small[1], room.scratch, room.edges
    for group in range(0, len(order), WIDTH):
        seats = min(WIDTH, len(order) - group)
        searched = seat(group, seats, order, problems, pressures, middles, limp, columns, start)
        cell, _, load = loads(columns, constants, PHYSICAL, layers)
        y, half = get(start, 0), get(columns, LENGTH)
        active, wrong, loose = mask_of((1 << seats) - 1), mask_of(0), mask_of(0)
        searched = searched and may_go_slack(load.wall)
        for _ in range(PASSES):
            mid, parts = seated(y, cell, load, half, scratch), 1
            put(edges, 0, 0.0)
            put(edges, 1, 1.0)
            if searched:
                _, seen, valid = look_along(pieces, mid, cell, load, room)
                active = active & valid & (seen.doubts[0] + seen.doubts[1] == 0.0)
                parts, unsure = find_ends(mid, cell, load, active, room.ends, room.counts, room.starts, edges, scratch)
                active, loose = active & (unsure < slack_ends.ENOUGH), unsure > 0.0
            still, flat = spread(0.0), spread(1.0)
            here = look_down(mid.depth, flat, mid, cell, load, nothing_yet(still), scratch)
            bends(mid.y, still, flat, here.at, cell, load, own.rows[1])
            valid, length = over_parts(parts, pieces, edges, mid, cell, load, own, scratch)
            rest = half - length
            grown = finish(mid, rest, loose, load, half, own, out) * rest
            active = active & valid & (get(own.carried[0], PIVOT) > 0.0)  # of others bounds say nothing
            wrong = active & (abs(grown) > CLOSE * abs(1.0 - y))
            y = select(wrong, y + grown, y)
            if not some(wrong):
                break
        met = bits(active & ~wrong)
        for lane in range(seats):
            row = order[group + lane]
            for i in range(OUTPUTS):
                for j in range(TOLD):
                    k = TOLD * i + j
                    told[0, row, i, j] = out[0, k, lane] if (met >> lane) & 1 else np.nan
                    told[1, row, i, j] = out[1, k, lane]

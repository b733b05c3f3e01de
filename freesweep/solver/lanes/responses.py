"""Derivatives of free states of physical tubes that are the same all along, a vector of states at a time.

A state that is known is one number, the stretch in the middle: it tells every place of half the tube (:mod:`meridian`), part
by part between the places where families go slack. There the density's second derivatives (:mod:`second`) are summed to
those of the functional (:mod:`element`), by which all that loads are conjugate to, the outputs, change with any number. How
the half changes with its length is known in the middle alone.
"""

from math import sqrt

import numpy as np

from ...jit import entry_point, kernel
from ..cells import nothing_yet
from ..problem import PHYSICAL
from . import second, slack_ends
from .element import BUBBLES, COUNT, PLACES, SIZE, WEIGHTS, assemble, eliminate, gather, weigh
from .meridian import DEEPEST, EVEN, LEAST_EVEN, Middle, deep, fallen, handed_on, look, look_down, middle_at
from .pack import COLUMNS, LENGTH, PRESSURE, aligned, enter, loads, lock
from .quadrature import NARROW, find_ends, scan
from .rule import LAST
from .second import LOADS, NUMBERS, ROWS, YY, bends
from .vector import WIDTH, bits, get, mask_of, put, select, some, spread

PASSES = 4
CLOSE = 1e-10
SPLIT, BEFORE = 100.0, 6.0


@kernel
def seated(y, cell, load, half, scratch):
    """The :class:`.meridian.Middle` of a tube whose middle has the stretch ``y``; where hardly a drive is left it is the
    uniform tube.
    """
    mid, driven, _ = middle_at(y, cell, load, half, scratch)
    far = ~driven | (mid.depth >= DEEPEST)
    rate = select(far, mid.s * sqrt(max(mid.bend, 1.0 / (half * half)) / (load.p * y * y + load.f)), mid.rate)
    depth = select(far, min(rate * half, DEEPEST), mid.depth)
    q = fallen(depth, scratch)
    return Middle(
        select(far, y, mid.u), rate, depth, q, 1.0 / (1.0 + q * q), y, mid.level,
        select(far, 1.0 / rate, mid.per_depth), select(far, 0.0, mid.rise), mid.bend, mid.s, mid.psi, mid.energy,
    )  # fmt: skip


@kernel
def down(share, left, width):
    """``(depth, its derivative)`` at a share of a part, from ``left`` on: slow where the layer begins."""
    even = max(1.0 - width / EVEN, LEAST_EVEN)
    return left + width * share * (even + (1.0 - even) * share * share), width * (even + 3.0 * (1.0 - even) * share * share)


@kernel
def by_depth(parts, edges, mid, counts):
    """Turn the shares of the depth between which no family goes slack into depths, and of those that are deep add one
    edge that lies before the middle; returns how many parts there are.
    """
    for j in range(parts + 1):
        put(edges, j, deep(get(edges, j), mid.depth)[0])
    split = mid.depth > SPLIT
    if not some(split):
        return parts
    put(edges, parts + 1, select(split, mid.depth - BEFORE, mid.depth))
    for lane in range(WIDTH):
        depth, i = edges[parts + 1, lane], parts + 1
        while i > 1 and edges[i - 1, lane] > depth:
            edges[i, lane] = edges[i - 1, lane]
            i -= 1
        edges[i, lane] = depth
    return parts + 1


@kernel
def slope_at(y, per_share, steep, mid):
    """Slope of a place whose depth grows by ``steep`` with a share, x by ``per_share``: without a cosine's difference from 1."""
    fall = sqrt(max((y - mid.y) * ((y - mid.u) + (mid.y - mid.u)), 0.0))
    return select(mid.u > 1.0, fall, -fall) * steep / per_share


@kernel
def over_parts(parts, pieces, edges, mid, cell, load, used, rows, fields, bent, pushed, lower, inverse, halves, carried, sums, tails, scratch):
    """Sum all parts of half a tube; returns lanes that may be, and the length."""
    valid, near, fixed, length = mask_of(-1), nothing_yet(spread(0.0)), mask_of(-1), spread(0.0)
    for i in range(len(sums)):
        put(sums, i, 0.0)
        put(tails, i, 0.0)
    for i in range(len(carried)):
        put(carried, i, 0.0)
    for i in range(parts * pieces):
        j = i // pieces
        width = (get(edges, j + 1) - get(edges, j)) / pieces
        left = get(edges, j) + (i % pieces) * width
        own = width > NARROW * mid.depth
        kind = spread(-1.0)
        for k in range(COUNT):
            depth, steep = down(PLACES[k], left, width)
            here = look_down(depth, steep, mid, cell, load, near, scratch)
            near = handed_on(here.y, here.at, near)
            kind = here.at.kind if k == 0 else kind
            valid = valid & (((here.at.room > 0.0) & (here.at.kind == kind)) | ~own)
            bends(here.y, slope_at(here.y, here.per_share, steep, mid), here.cosine, here.at, cell, load, rows)
            weight = WEIGHTS[k] * here.per_share
            weigh(k, own, weight, 1.0 / here.per_share, rows, used, fields, sums)
            tell(select(own, weight, 0.0), rows, sums)
            length = length + select(own, weight, 0.0)
        assemble(fields, len(used), bent, pushed, halves)
        eliminate(own, fixed, used, bent, pushed, lower, inverse, carried, sums, tails)
        fixed = fixed & ~own
    return valid, length


@kernel
def tell(weight, rows, sums):
    """Add to the sums, behind the derivatives, what loads are conjugate to."""
    for i in range(LOADS):
        put(sums, LOADS * NUMBERS + i, get(sums, LOADS * NUMBERS + i) + weight * get(rows[0], ROWS - LOADS + i))


@kernel
def finish(mid, rest, cell, load, half, used, rows, carried, sums, tails, out, scratch):
    """Write values and derivatives, in the order of :mod:`.outputs`, to ``out`` (2, ...): rows of 1 + numbers + 1, the last of
    which is by the length of the half. Returns how the middle changes with the length."""
    count, zero = len(used), spread(0.0)
    here = look(spread(1.0), mid, cell, load, nothing_yet(zero), scratch)
    bends(mid.y, zero, spread(1.0), here.at, cell, load, rows)
    gather(rest, rows, used, sums)
    tell(rest, rows, sums)
    put(carried, 0, get(carried, 0) - rest * get(rows[0], YY))
    for j in range(count):
        put(carried, 1 + j, get(carried, 1 + j) + rest * get(rows[0], second.BY_Y + used[j]))
    pivot = 1.0 / get(carried, 0)
    drive = -mid.rise * mid.s
    many = NUMBERS + 2
    for i in range(LOADS):
        load_by = get(carried, 1 + count - LOADS + i) * pivot
        sign = -1.0 if i == LOADS - 1 else 1.0
        put(out[0], many * i, sign * get(sums, LOADS * NUMBERS + i))
        for j in range(count):
            n = NUMBERS * i + used[j]
            put(out[0], many * i + 1 + used[j], sign * (get(sums, n) + load_by * get(carried, 1 + j)))
            put(out[1], many * i + 1 + used[j], get(tails, n))
        put(out[0], many * i + many - 1, sign * (get(rows[0], ROWS - LOADS + i) + drive * load_by))
    put(out[0], many * LOADS, mid.y)
    put(out[1], many * LOADS, mid.depth)
    for j in range(count):
        put(out[0], many * LOADS + 1 + used[j], get(carried, 1 + j) * pivot)
        put(out[1], many * LOADS + 1 + used[j], -get(rows[0], second.BY_Y + used[j]) / get(rows[0], YY))  # du
    put(out[0], many * LOADS + many - 1, drive * pivot)
    return drive * pivot, get(carried, 0) > 0.0


@entry_point
def differentiate_physical(problems, pressures, middles, order, constants, layers, pieces, used, values, bounds):
    """Values and derivatives (rows, 5, 1 + numbers + 1), and bounds."""
    size, count = SIZE * (SIZE + 1) // 2, len(used)
    room, ends, numbers = aligned(15, LAST + 1), aligned(9, slack_ends.MOST), aligned(1, ROWS)
    edges, small = aligned(1, slack_ends.MOST + 3)[0], aligned(3, COLUMNS)
    columns, start, scratch = small[0], small[1], small[2]
    counts = np.zeros(WIDTH, np.int64)
    fields, triangles, pushed = aligned(3 + 2 * count, COUNT), aligned(2, size), aligned(count, SIZE)
    inverse, halves, carried, sums = aligned(1, SIZE)[0], aligned(2, COUNT), aligned(1, 1 + count)[0], aligned(2, 60)
    out = aligned(2, 5 * (NUMBERS + 2))
    for group in range(0, len(order), WIDTH):
        here = min(WIDTH, len(order) - group)
        for lane in range(WIDTH):
            row = order[group + min(lane, here - 1)]
            enter(lane, problems[row], columns)
            start[0, lane] = middles[row]
            if pressures[row] == np.inf:
                lock(lane, columns)
            else:
                columns[PRESSURE, lane] = pressures[row]
        cell, _, load = loads(columns, constants, PHYSICAL, layers)
        y, half = get(start, 0), get(columns, LENGTH)
        active, met = mask_of((1 << here) - 1), mask_of(0)
        for i in range(PASSES):
            mid = seated(y, cell, load, half, scratch)
            _, _, _, doubts, fine, _ = scan(pieces, mid, cell, load, room, ends[:5], counts, ends[5:], scratch)
            active = active & fine & (doubts[0] + doubts[1] == 0.0)
            parts, unsure = find_ends(mid, cell, load, active, ends[:5], counts, ends[5:], edges, scratch)
            parts = by_depth(parts, edges, mid, counts)
            valid, length = over_parts(
                parts, pieces, edges, mid, cell, load, used, numbers, fields, triangles[0], pushed, triangles[1], inverse, halves,
                carried, sums[0], sums[1], scratch,
            )  # fmt: skip
            rest = half - length
            per_length, stable = finish(mid, rest, cell, load, half, used, numbers, carried, sums[0], sums[1], out, scratch)
            active = active & valid
            wrong = active & (abs(rest * per_length) > CLOSE * abs(1.0 - y))
            y = select(wrong, y + rest * per_length, y)
            if not some(wrong):
                break
        met = bits(active & ~wrong)
        for lane in range(here):
            if (met >> lane) & 1:
                row = order[group + lane]
                for i in range(5):
                    for j in range(NUMBERS + 2):
                        k = (NUMBERS + 2) * i + j
                        values[row, i, j], bounds[row, i, j] = out[0, k, lane], out[1, k, lane]

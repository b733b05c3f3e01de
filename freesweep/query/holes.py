"""Holes of a grid: which cells may be answered, and numbers for the nodes beside them that slopes and windows need.

A node without a number next to good ones (the line alpha = beta, an edge of validity) gets the polynomial through its
neighbours. It helps to weigh the cells beside it and never answers a point itself.
"""

import math

import numpy as np

from ..jit import entry_point, kernel
from ..status import INACCURATE, OK
from .axis import WINDOW

SWEEPS = 6  # how far from good nodes numbers are put, in steps along the axes: windows reach two nodes beyond a cell
REACH = 4  # nodes along an axis that a hole looks at, on either side
BETWEEN = 3  # of those it takes the nearest on each side,
BEYOND = 4  # or so many where one side has none
MIXED = 255  # code of a cell whose nodes do not agree


@kernel
def _along(values, good, at, index, count, step, nodes):
    """``(value, sides)`` at a hole from the nearest known nodes along one axis; sides 0 if there are too few."""
    xs, fs = np.empty(2 * BETWEEN), np.empty(2 * BETWEEN)
    sides, found = 0, 0
    for side in (-1, 1):
        mine = 0
        for distance in range(1, REACH + 1):
            i = index + side * distance
            if 0 <= i < count and mine < BETWEEN and good[at + side * distance * step]:
                xs[found], fs[found] = nodes[i], values[at + side * distance * step]
                found += 1
                mine += 1
        sides += 1 if mine > 0 else 0
    if sides == 1:  # polynomials of high degree are wild beyond their nodes
        found = 0
        for distance in range(1, REACH + 1):
            for side in (-1, 1):
                i = index + side * distance
                if 0 <= i < count and found < BEYOND and good[at + side * distance * step]:
                    xs[found], fs[found] = nodes[i], values[at + side * distance * step]
                    found += 1
    if found < 3:
        return 0.0, 0
    total = 0.0
    for j in range(found):
        weight = 1.0
        for k in range(found):
            if k != j:
                weight *= (nodes[index] - xs[k]) / (xs[j] - xs[k])
        total += weight * fs[j]
    return total, sides


@entry_point
def fill(values, shape, strides, nodes):
    """Put numbers on the NaN of ``values`` (nodes,) that lie beside numbers; between nodes rather than beyond them."""
    d, total = len(shape), len(values)
    good = np.isfinite(values)
    for _ in range(SWEEPS):
        put, numbers = [np.int64(0) for _ in range(0)], [0.0 for _ in range(0)]
        for at in range(total):
            if good[at]:
                continue
            best, sides, many = 0.0, 0, 0
            for a in range(d):
                index = (at // strides[a]) % shape[a]
                step, count = strides[a], shape[a]
                beside = (index > 0 and good[at - step]) or (index + 1 < count and good[at + step])
                if not beside or count < 3:
                    continue
                value, own_sides = _along(values, good, at, index, count, step, nodes[a])
                if own_sides > sides:
                    best, sides, many = value, own_sides, 1
                elif own_sides == sides and sides > 0:
                    best += value
                    many += 1
            if many > 0 and math.isfinite(best):
                put.append(at)
                numbers.append(best / many)
        if len(put) == 0:
            break
        for k in range(len(put)):
            values[put[k]] = numbers[k]
            good[put[k]] = True


@kernel
def _short_slope(values, at, index, count, step, widths):
    """Slope at a node from the nodes next to it; NaN if there are none."""
    before, after = math.nan, math.nan
    if index > 0:
        before = (values[at] - values[at - step]) / widths[index - 1]
    if index + 1 < count:
        after = (values[at + step] - values[at]) / widths[index]
    if math.isfinite(before) and math.isfinite(after):
        h, k = widths[index - 1], widths[index]
        return (k * before + h * after) / (h + k)
    return before if math.isfinite(before) else after


@entry_point
def slopes(values, count, step, first, left, right, widths, out):
    """Slopes of ``values`` (nodes,) along an axis of ``count`` nodes, ``step`` apart, into ``out`` (nodes,).

    Where the window of a node has holes, from fewer nodes.
    """
    size = min(WINDOW, count)
    for block in range(len(values) // (count * step)):
        for index in range(count):
            piece = index if index < count - 1 else count - 2
            weights = (left if index == piece else right)[piece]
            at = (block * count + index) * step
            out[at : at + step] = 0.0
            for j in range(size):
                if weights[j] != 0.0:
                    weight, there = weights[j] / widths[piece], (block * count + first[piece] + j) * step
                    if step == 1:
                        out[at] += weight * values[there]
                    else:
                        for k in range(step):
                            out[at + k] += weight * values[there + k]
            for k in range(at, at + step):
                if not math.isfinite(out[k]):
                    out[k] = _short_slope(values, k, index, count, step, widths)


@kernel
def _common(code, other):
    """The code that two nodes share: an inaccurate one makes both inaccurate; MIXED if there is none."""
    if code == other:
        return code
    if code != MIXED and other != MIXED and code >> 4 == other >> 4:
        if (code & 15 == OK or code & 15 == INACCURATE) and (other & 15 == OK or other & 15 == INACCURATE):
            return code & 240 | INACCURATE
    return MIXED


@entry_point
def cell_codes(codes, shape, strides, labels, cells):
    """Common code of the nodes at each cell's corners into ``cells`` (nodes,), MIXED where they differ."""
    for at in range(len(codes)):
        cells[at] = codes[at]
    for a in range(len(shape)):
        if not labels[a]:
            count, step = shape[a], strides[a]
            for block in range(len(codes) // (count * step)):
                for at in range(block * count * step, ((block + 1) * count - 1) * step):
                    if cells[at] != cells[at + step]:
                        cells[at] = _common(cells[at], cells[at + step])


@kernel
def corner_code(codes, cells, strides, pieces, shares, k, cell):
    """Code of the nodes that located point k lies between; MIXED where they differ."""
    d = len(strides)
    inside = True
    for a in range(d):
        inside = inside and 0.0 < shares[k, a] < 1.0
    if inside or cells[cell] != MIXED:
        return cells[cell]
    code, first = MIXED, True
    for corner in range(1 << d):
        i, used = cell, True
        for a in range(d):
            up = corner >> a & 1
            if (up and shares[k, a] == 0.0) or (not up and shares[k, a] == 1.0):
                used = False
                break
            i += up * strides[a]
        if used:
            code = codes[i] if first else _common(code, codes[i])
            first = False
    return code

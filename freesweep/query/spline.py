"""Tensor cubics on a grid of any number of axes: where a point lies, and the sum over the nodes around it.

The two inner axes carry their slopes beside the values, so a point reads 2 x 2 nodes of four numbers there; the outer axes
read windows of six nodes. ``knots`` (d, n, KNOT) holds what is known of each piece of each axis, inner axes last. Kernels
take whole arrays and places in them: parts of arrays would be counted in and out, which takes longer than the sum.
"""

import math

import numpy as np

from ..jit import entry_point, kernel
from .axis import LABEL, LOG, SQRT, WINDOW
from .rows import ROW, weigh_rows

INSIDE, BELOW, ABOVE, NO_NUMBER = range(4)
NODE = ROW // 2  # numbers of a node
PLACE, WIDTH, FIRST, RANK, LEFT, RIGHT = 0, 1, 2, 3, 4, 4 + WINDOW  # columns of knots
KNOT = 4 + 2 * WINDOW
SNAP = 1e-12  # of a piece: nearer to a node than rounding of a unit, a point lies on it


@kernel
def locate(x, knots, a, kind, count):
    """``(piece, share, where)`` of a value on axis ``a``: share 0 to 1 of the piece from its left node."""
    if not math.isfinite(x):
        return 0, 0.0, BELOW if x == -math.inf else ABOVE if x == math.inf else NO_NUMBER
    if kind == SQRT:
        if x < 0.0:
            return 0, 0.0, BELOW
        x = math.sqrt(x)
    elif kind == LOG:
        if x <= 0.0:
            return 0, 0.0, BELOW
        x = math.log(x)
    if kind == LABEL:
        return (int(x), 0.0, INSIDE) if 0.0 <= x < count else (0, 0.0, NO_NUMBER)
    low, high = 0, count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if x >= knots[a, middle, PLACE]:
            low = middle
        else:
            high = middle
    share = (x - knots[a, low, PLACE]) / knots[a, low, WIDTH]
    if abs(share) < SNAP:
        share = 0.0
    elif abs(share - 1.0) < SNAP:
        share = 1.0
    if share < 0.0:
        return low, 0.0, BELOW
    if share > 1.0:
        return low, 1.0, ABOVE
    return low, share, INSIDE


@kernel
def hermite(t, order):
    """Weights (value, slope, value, slope) at a share t of a piece of width one: linear (-1), values (0), slopes (1)."""
    if order == -1:
        return 1.0 - t, 0.0, t, 0.0
    if order == 0:
        end = t * t * (3.0 - 2.0 * t)
        return 1.0 - end, t * (1.0 - t) ** 2, end, -t * t * (1.0 - t)
    end = 6.0 * t * (1.0 - t)
    return -end, (1.0 - t) * (1.0 - 3.0 * t), end, t * (3.0 * t - 2.0)


@kernel
def window(knots, a, size, label, stride, piece, share, order, offsets, weights):
    """Offsets (in the table) and weights of the nodes around a place, those of weight zero left out; returns how many."""
    first = int(knots[a, piece, FIRST])
    if label:
        offsets[0], weights[0] = NODE * stride * first, 1.0
        return 1
    start, start_slope, end, end_slope = hermite(share, order)
    used, place = 0, piece - first
    for j in range(size):
        weight = start_slope * knots[a, piece, LEFT + j] + end_slope * knots[a, piece, RIGHT + j]
        if j == place:
            weight += start
        elif j == place + 1:
            weight += end
        if weight != 0.0:
            offsets[used], weights[used] = NODE * stride * (first + j), weight
            used += 1
    if order == 1:
        for j in range(used):
            weights[j] /= knots[a, piece, WIDTH]
    return used


@kernel
def product_term(weight, number):
    """Weight times number, and nothing where the weight is zero: an unused node may hold NaN."""
    return weight * number if weight != 0.0 else 0.0


@entry_point
def interpolate(table, knots, sizes, labels, strides, pieces, shares, order, orders, values):
    """The tensor cubic at placed points (n, d) into ``values`` (n,), taken in the sequence ``order`` (n,).

    ``table`` (NODE nodes,): value, slope along the last axis, along the last but one, along both. The outer axes' windows
    are multiplied out but for the nearest, along which rows are summed.
    """
    d, most = len(strides), 1
    for a in range(d - 3):
        most *= sizes[a]
    offsets, weights = np.empty(most, np.int64), np.empty(most)
    own_offsets, own, sums = np.empty(WINDOW, np.int64), np.empty(WINDOW), np.empty(2 * ROW)
    r, p = d - 2, d - 1
    for e in range(len(order)):
        at = order[e]
        many, used = 1, 1
        offsets[0], weights[0] = NODE * (pieces[at, r] * strides[r] + pieces[at, p]), 1.0
        own_offsets[0], own[0] = 0, 1.0
        for a in range(d - 2):
            piece, share = pieces[at, a], shares[at, a]
            used = window(knots, a, sizes[a], labels[a], strides[a], piece, share, orders[a], own_offsets, own)
            if a == d - 3:
                break
            # from the last to the first, so that nothing is overwritten before it is read
            for k in range(many - 1, -1, -1):
                begin, weight = offsets[k], weights[k]
                for j in range(used):
                    offsets[k * used + j], weights[k * used + j] = begin + own_offsets[j], weight * own[j]
            many *= used
        weigh_rows(table, offsets, weights, many, own_offsets, own, used, NODE * strides[r], sums)
        width, across = knots[p, pieces[at, p], WIDTH], knots[r, pieces[at, r], WIDTH]
        w0, w1, w2, w3 = hermite(shares[at, p], orders[p])
        v0, v1, v2, v3 = hermite(shares[at, r], orders[r])
        w1, w3, v1, v3 = w1 * width, w3 * width, v1 * across, v3 * across
        total = 0.0
        for k in range(2):
            value, slope = (v0, v1) if k == 0 else (v2, v3)
            total += product_term(value * w0, sums[ROW * k]) + product_term(value * w1, sums[ROW * k + 1])
            total += product_term(slope * w0, sums[ROW * k + 2]) + product_term(slope * w1, sums[ROW * k + 3])
            total += product_term(value * w2, sums[ROW * k + 4]) + product_term(value * w3, sums[ROW * k + 5])
            total += product_term(slope * w2, sums[ROW * k + 6]) + product_term(slope * w3, sums[ROW * k + 7])
        if orders[p] == 1:
            total /= width
        if orders[r] == 1:
            total /= across
        values[at] = total


@entry_point
def by_cell(pieces, strides, many, order):
    """Points (n,) in the order of the cells that they lie in, the last axis apart, for the sake of the processor's cache."""
    outer = len(strides) - 1
    first = np.zeros(many + 1, np.int64)
    cells = np.empty(len(pieces), np.int64)
    least = strides[outer - 1]
    for k in range(len(pieces)):
        cell = 0
        for a in range(outer):
            cell += pieces[k, a] * (strides[a] // least)
        cells[k] = cell
        first[cell + 1] += 1
    for c in range(many):
        first[c + 1] += first[c]
    for k in range(len(pieces)):
        order[first[cells[k]]] = k
        first[cells[k]] += 1

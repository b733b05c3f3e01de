"""Tensor cubics on a grid of any number of axes: where a point lies, and the sum over the nodes around it.

The two inner axes carry their slopes beside the values, so a point reads 2 x 2 nodes of four numbers there; the outer axes
read windows of six nodes. ``axes`` is (nodes (d, n), counts (d,), windows (d,), kinds (d,), first (d, n), left, right,
remainder (d, n, 6)), inner axes last.
"""

import math

import numpy as np

from ..jit import entry_point, kernel
from .axis import LABEL, LOG, SQRT

INSIDE, BELOW, ABOVE, NO_NUMBER = range(4)
SNAP = 1e-12  # of a piece: nearer to a node than rounding of a unit, a point lies on it


@kernel
def locate(x, kind, nodes, count):
    """``(piece, share, where)`` of a value on an axis: share 0 to 1 of the piece from its left node."""
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
        if x >= nodes[middle]:
            low = middle
        else:
            high = middle
    share = (x - nodes[low]) / (nodes[high] - nodes[low])
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
def piece_weights(axes, a, piece, share, order, weights):
    """Weights of the window of one piece: values (order 0), slopes by the axis' coordinate (1), or linear (-1)."""
    size = axes[2][a]
    begin = axes[4][a, piece]
    t = share
    for j in range(size):
        weights[j] = 0.0
    if axes[3][a] == LABEL:
        weights[0] = 1.0
        return
    place = piece - begin
    if order == -1:
        weights[place] += 1.0 - t
        weights[place + 1] += t
        return
    if order == 0:
        end, start_slope, end_slope, width = t * t * (3.0 - 2.0 * t), t * (1.0 - t) ** 2, -t * t * (1.0 - t), 1.0
        start = 1.0 - end
    else:
        end, start_slope, end_slope = 6.0 * t * (1.0 - t), (1.0 - t) * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)
        start = -end
        width = axes[0][a, piece + 1] - axes[0][a, piece]
    left, right = axes[5][a, piece], axes[6][a, piece]
    for j in range(size):
        weights[j] = (start_slope * left[j] + end_slope * right[j]) / width
    weights[place] += start / width
    weights[place + 1] += end / width


@kernel
def inner_weights(axes, a, piece, share, order):
    """``(value, slope, value, slope)`` weights of the two nodes of a piece of an inner axis."""
    t = share
    width = axes[0][a, piece + 1] - axes[0][a, piece]
    if order == -1:
        return 1.0 - t, 0.0, t, 0.0
    if order == 0:
        end = t * t * (3.0 - 2.0 * t)
        return 1.0 - end, width * t * (1.0 - t) ** 2, end, -width * t * t * (1.0 - t)
    end = 6.0 * t * (1.0 - t) / width
    return -end, (1.0 - t) * (1.0 - 3.0 * t), end, t * (3.0 * t - 2.0)


@kernel
def spread(axes, strides, outer, pieces, shares, orders, offsets, weights, own):
    """Offsets and weights of all nodes of the outer windows, those of weight zero left out; returns how many."""
    many = 1
    offsets[0], weights[0] = 0, 1.0
    for a in range(outer):
        piece_weights(axes, a, pieces[a], shares[a], orders[a], own)
        begin, size, step = axes[4][a, pieces[a]], axes[2][a], strides[a]
        used = 0
        for j in range(size):
            if own[j] != 0.0:
                used += 1
        # from the last to the first, so that nothing is overwritten before it is read
        for e in range(many - 1, -1, -1):
            at, weight, put = offsets[e], weights[e], e * used
            for j in range(size):
                if own[j] != 0.0:
                    offsets[put] = at + (begin + j) * step
                    weights[put] = weight * own[j]
                    put += 1
        many *= used
    return many


@kernel
def product_term(weight, number):
    """Weight times number, and nothing where the weight is zero: an unused node may hold NaN."""
    return weight * number if weight != 0.0 else 0.0


@kernel
def contract(table, axes, strides, pieces, shares, orders, offsets, weights, own):
    """The tensor cubic at one point; ``table`` (nodes, 4): value, slopes along the last and the last but one axis, both."""
    d = len(strides)
    many = spread(axes, strides, d - 2, pieces, shares, orders, offsets, weights, own)
    r, p = d - 2, d - 1
    corner = pieces[r] * strides[r] + pieces[p]
    w0, w1, w2, w3 = inner_weights(axes, p, pieces[p], shares[p], orders[p])
    near, near_slope, far, far_slope = inner_weights(axes, r, pieces[r], shares[r], orders[r])
    next_row = strides[r]
    a0, a1, a2, a3, a4, a5, a6, a7 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    b0, b1, b2, b3, b4, b5, b6, b7 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for e in range(many):
        w, i = weights[e], 4 * (offsets[e] + corner)
        a0 += w * table[i]
        a1 += w * table[i + 1]
        a2 += w * table[i + 2]
        a3 += w * table[i + 3]
        a4 += w * table[i + 4]
        a5 += w * table[i + 5]
        a6 += w * table[i + 6]
        a7 += w * table[i + 7]
        i += 4 * next_row
        b0 += w * table[i]
        b1 += w * table[i + 1]
        b2 += w * table[i + 2]
        b3 += w * table[i + 3]
        b4 += w * table[i + 4]
        b5 += w * table[i + 5]
        b6 += w * table[i + 6]
        b7 += w * table[i + 7]
    total = product_term(near * w0, a0) + product_term(near * w1, a1)
    total += product_term(near * w2, a4) + product_term(near * w3, a5)
    total += product_term(near_slope * w0, a2) + product_term(near_slope * w1, a3)
    total += product_term(near_slope * w2, a6) + product_term(near_slope * w3, a7)
    total += product_term(far * w0, b0) + product_term(far * w1, b1)
    total += product_term(far * w2, b4) + product_term(far * w3, b5)
    total += product_term(far_slope * w0, b2) + product_term(far_slope * w1, b3)
    total += product_term(far_slope * w2, b6) + product_term(far_slope * w3, b7)
    return total


@kernel
def room(axes, strides):
    """Most nodes that the outer windows of a point may hold."""
    most = 1
    for a in range(len(strides) - 2):
        most *= axes[2][a]
    return most


@entry_point
def interpolate(table, axes, strides, pieces, shares, order, orders, values):
    """:func:`contract` of placed points (n, d) into ``values`` (n,), taken in the sequence ``order`` (n,)."""
    most = room(axes, strides)
    offsets, weights, own = np.empty(most, np.int64), np.empty(most), np.empty(8)
    for e in range(len(order)):
        k = order[e]
        values[k] = contract(table, axes, strides, pieces[k], shares[k], orders, offsets, weights, own)


@entry_point
def remainders(roughness, strides, pieces, shares, order, out):
    """What the next order would add at placed points (n, d) into ``out`` (n,); ``roughness`` (nodes, d) of the cells.

    Between two nodes what the slopes lack goes with t (1 - t); what the cubic lacks, with its square, is smaller.
    """
    for e in range(len(order)):
        k = order[e]
        cell, total = 0, 0.0
        for a in range(len(strides)):
            cell += pieces[k, a] * strides[a]
        for a in range(len(strides)):
            bubble = 4.0 * shares[k, a] * (1.0 - shares[k, a])
            if bubble > 0.0:  # on a node an unknown roughness says nothing
                total += roughness[cell, a] * bubble
        out[k] = total


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

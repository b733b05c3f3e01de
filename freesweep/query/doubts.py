"""How far an interpolated number may be off for what was put into holes near it, weighed as the nodes are at its place."""

import numpy as np

from ..jit import entry_point, kernel
from .axis import WINDOW
from .spline import FIRST, LEFT, RIGHT, hermite


@entry_point
def doubts_at(places, cell, pieces, shares, doubt, strides, windows, knots, out):
    """Into ``out`` (n,) at ``places`` (k,) what is doubtful of nodes, ``doubt`` (nodes,), times their weights at points that
    lie in a ``cell`` (n,) at ``pieces`` and ``shares`` (n, d).

    Nodes beyond the cell along one axis count; those beyond it along two have little weight.
    """
    d = len(strides)
    lines, shared = np.empty(1 << d, np.int64), np.empty(1 << d)
    weights, near = np.empty((d, WINDOW)), np.empty((d, 2))
    for e in range(len(places)):
        at = places[e]
        for a in range(d):
            if windows[a] > 0:
                weigh(weights[a], knots[a], windows[a], pieces[at, a], shares[at, a])
                own = pieces[at, a] - int(knots[a, pieces[at, a], FIRST])
                near[a, 0], near[a, 1] = weights[a, own], weights[a, own + 1]
        many = corners(lines, cell[at], -1, strides, windows)
        share_out(shared, near, -1, windows)
        total = 0.0
        for k in range(many):
            total += shared[k] * doubt[lines[k]]
        for a in range(d):
            if windows[a] == 0 or shares[at, a] == 0.0 or shares[at, a] == 1.0:
                continue
            beyond = int(knots[a, pieces[at, a], FIRST]) - pieces[at, a]
            many = corners(lines, cell[at], a, strides, windows)
            share_out(shared, near, a, windows)
            for j in range(windows[a]):
                if beyond + j < 0 or beyond + j > 1:
                    for k in range(many):
                        total += shared[k] * weights[a, j] * doubt[lines[k] + (beyond + j) * strides[a]]
        out[at] = total


@kernel
def weigh(weights, knots, window, piece, share):
    """Absolute weights of the nodes of a window, at a share of a piece of an axis, into ``weights`` (WINDOW,)."""
    start, start_slope, end, end_slope = hermite(share, 0)
    for j in range(window):
        weight = start_slope * knots[piece, LEFT + j] + end_slope * knots[piece, RIGHT + j]
        if j == piece - int(knots[piece, FIRST]):
            weight += start
        elif j == piece - int(knots[piece, FIRST]) + 1:
            weight += end
        weights[j] = abs(weight)


@kernel
def share_out(shared, near, along, windows):
    """Into ``shared`` the weights of the corners of a cell, in the order of :func:`corners`, from those of its ends
    along each axis, ``near`` (d, 2).
    """
    many, shared[0] = 1, 1.0
    for b in range(len(windows)):
        if b != along and windows[b] > 0:
            for k in range(many):
                shared[many + k] = shared[k] * near[b, 1]
                shared[k] *= near[b, 0]
            many *= 2


@kernel
def corners(lines, cell, along, strides, windows):
    """Corners of a cell into ``lines``, those at the near end of its edges ``along`` an axis (-1: all); returns how many."""
    many, lines[0] = 1, cell
    for b in range(len(strides)):
        if b != along and windows[b] > 0:
            for k in range(many):
                lines[many + k] = lines[k] + strides[b]
            many *= 2
    return many

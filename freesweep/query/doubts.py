"""How far an interpolated number may be off for what was put into holes near it, weighed as the nodes are at its place."""

import numpy as np

from ..jit import entry_point, kernel
from .cells import corners
from .spline import FIRST, LEFT, RIGHT, hermite


@entry_point
def doubts_at(places, cell, pieces, shares, doubt, strides, windows, knots, out):
    """Into ``out`` (n,) at ``places`` (k,) what is doubtful of nodes, ``doubt`` (nodes,), times their weights at points that
    lie in a ``cell`` (n,) at ``pieces`` and ``shares`` (n, d).

    Windows count along one axis at a time, from each edge of the cell; what is off along two counts little.
    """
    d = len(strides)
    lines, weights = np.empty(1 << d, np.int64), np.empty(1 << d)
    near = np.empty((d, 4))
    for e in range(len(places)):
        at = places[e]
        for a in range(d):
            near[a, 0], near[a, 1], near[a, 2], near[a, 3] = hermite(shares[at, a], 0)
        many = corners(lines, cell[at], -1, strides, windows)
        weigh(weights, near, -1, windows)
        total = 0.0
        for k in range(many):
            total += weights[k] * doubt[lines[k]]
        for a in range(d):
            if windows[a] == 0 or shares[at, a] == 0.0 or shares[at, a] == 1.0:
                continue
            piece = pieces[at, a]
            first = int(knots[a, piece, FIRST])
            many = corners(lines, cell[at], a, strides, windows)
            weigh(weights, near, a, windows)
            for j in range(windows[a]):
                slope = abs(near[a, 1] * knots[a, piece, LEFT + j] + near[a, 3] * knots[a, piece, RIGHT + j])
                for k in range(many):
                    total += weights[k] * slope * doubt[lines[k] + (first + j - piece) * strides[a]]
        out[at] = total


@kernel
def weigh(weights, near, along, windows):
    """Into ``weights`` those of the corners of a cell, in the order of :func:`.cells.corners`, from Hermite's ``near`` (d, 4)."""
    many, weights[0] = 1, 1.0
    for b in range(len(windows)):
        if b != along and windows[b] > 0:
            for k in range(many):
                weights[many + k] = weights[k] * near[b, 2]
                weights[k] *= near[b, 0]
            many *= 2

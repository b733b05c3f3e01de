"""What each cell knows of its neighbourhood: bounds of what is stored there, how rough it is, whether it has holes.

A cell has the index of its first node. It is looked at when a point in it is first asked for: along each axis from each of
its corners, a line of nodes at a time. What is known of a cell is the worst of those lines.
"""

import math
from threading import Lock
from typing import NamedTuple

import numpy as np

from ..jit import entry_point, kernel
from .axis import LABEL, WINDOW
from .doubts import corners, doubts_at
from .spline import FIRST, LEFT, RIGHT, product_term

NOISE, BESIDE, DOUBT, ROUGH = range(4)  # columns of what is known of a cell; one of roughness for each axis
WEIGHT = np.float32(0.1)  # largest weight of a node beside a piece in its slopes
STEEPEST = 4.0 / 27.0  # largest weight of a slope in a cubic, times the width
FIRST_ROWS = 1 << 10  # there is room for; twice as many where they are too few


class Grid(NamedTuple):
    """Numbers of nodes, as of :class:`Cells`, ``doubtful`` (blocks,) of the two last axes, and what is known of the axes:
    ``shape``, ``strides`` and ``windows`` (d,), ``knots``, and ``weights`` (d, n, WINDOW) of what the next order would add.
    """

    values: np.ndarray
    noise: np.ndarray
    doubt: np.ndarray
    doubtful: np.ndarray
    shape: np.ndarray
    strides: np.ndarray
    windows: np.ndarray
    knots: np.ndarray
    weights: np.ndarray


class Cells:
    """What is known of the cells of a grid over ``axes``, with their ``knots`` as :mod:`.spline` takes them.

    ``values`` (nodes,) are end effects, holes filled; ``noise`` (nodes,) are their bounds; ``doubt`` (nodes,) says how far
    numbers that were put in may be off, 0 where there was one.
    """

    def __init__(self, values, noise, doubt, axes, knots):
        shape = np.array([len(axis.nodes) for axis in axes], np.int64)
        strides = np.array([int(np.prod(shape[k + 1 :])) for k in range(len(shape))], np.int64)
        windows = np.array([0 if axis.kind == LABEL else axis.window for axis in axes], np.int64)
        weights = np.zeros((len(axes), knots.shape[1], WINDOW))  # of what the next order would add
        for own, axis in zip(weights, axes):
            own[: len(axis.nodes)] = axis.remainder
        inner = int(np.prod(shape[-2:]))  # nodes of one block of the last two axes
        doubtful = doubt.reshape(-1, inner).any(axis=1)  # few blocks are: what others hold need not be looked at
        self._grid = Grid(values, noise, doubt, doubtful, shape, strides, windows, knots, weights)
        self._slots = np.zeros(len(values), np.int32)  # of each cell in what is known; 0: nothing yet
        self._rows, self._count = np.empty((FIRST_ROWS, ROUGH + len(axes)), np.float32), 1
        self._lock = Lock()

    def doubts(self, places, cell, pieces, shares, out):
        """Into ``out`` (n,) at ``places`` (k,) what :func:`.doubts.doubts_at` tells of points."""
        grid = self._grid
        doubts_at(places, cell, pieces, shares, grid.doubt, grid.strides, grid.windows, grid.knots, out)

    def at(self, cells) -> np.ndarray:
        """What is known of cells (n,): (n, ROUGH + d)."""
        slots = self._slots[cells]
        if not slots.all():
            self._look_at(np.unique(cells[slots == 0]))
            slots = self._slots[cells]
        return self._rows[slots]

    def _look_at(self, cells):
        rows = np.empty((len(cells), self._rows.shape[1]), np.float32)
        _describe(cells, self._grid, rows)
        with self._lock:
            begin, self._count = self._count, self._count + len(cells)
            if self._count > len(self._rows):
                grown = np.empty((2 * self._count, rows.shape[1]), np.float32)
                grown[:begin] = self._rows[:begin]
                self._rows = grown
            self._rows[begin : self._count] = rows
            self._slots[cells] = np.arange(begin, self._count)  # last: another thread may ask for the same


@entry_point
def _describe(cells, grid, rows):
    """Into ``rows`` (k, ROUGH + d) what is known of ``cells`` (k,)."""
    values, noise, doubt, doubtful, shape, strides, windows, knots, weights = grid
    d = len(shape)
    lines, blocks, out = np.empty(1 << d, np.int64), np.empty(1 << d, np.int64), np.empty(ROUGH + d)
    around = np.empty((3, WINDOW + 2))
    inner = shape[d - 1] * shape[d - 2]
    apart = strides // inner  # blocks from node to node: 0 along the last two axes
    for n in range(len(cells)):
        cell = cells[n]
        for k in range(ROUGH + d):
            out[k] = 0.0
        many = corners(lines, cell, -1, strides, windows)
        loudest, worry = 0.0, 0.0
        for k in range(many):
            loudest, worry = max(loudest, noise[lines[k]]), max(worry, doubt[lines[k]])
        for a in range(d):
            if windows[a] == 0:  # labels have nothing beside them
                continue
            count, step = shape[a], strides[a]
            piece = (cell // step) % count
            many = corners(lines, cell, a, strides, windows)
            corners(blocks, cell // inner, a, apart, windows)
            low, high, many_around = all_around(around, knots[a], weights[a], windows[a], piece, count)
            first = int(knots[a, piece, FIRST])
            worst = 0.0
            for k in range(many):
                at = lines[k]
                begin = at - piece * step
                before, here, after = rough_line(around, values, begin + low * step, step, high - low)
                worst = max(worst, smoothed(before, here, after, many_around))
                if piece > 0:
                    loudest = max(loudest, WEIGHT * noise[at - step])
                if piece + 2 < count:
                    loudest = max(loudest, WEIGHT * noise[at + 2 * step])
            out[ROUGH + a] = worst
            for j in range(windows[a]):
                for k in range(many):
                    if doubtful[blocks[k] + (first + j - piece) * apart[a]]:
                        lacks = doubt[lines[k] + (first + j - piece) * step]
                        if lacks > 0.0:
                            share = STEEPEST * (abs(knots[a, piece, LEFT + j]) + abs(knots[a, piece, RIGHT + j]))
                            out[BESIDE], worry = 1.0, max(worry, share * lacks)
        out[NOISE], out[DOUBT] = loudest, worry
        for k in range(ROUGH + d):
            rows[n, k] = out[k]


@kernel
def rough_line(around, values, begin, step, many):
    """What the next order would add in the piece before, in a piece, and in the one after it, on a line of nodes that
    ``around`` weighs: ``many`` of them, from ``begin`` on.
    """
    before = here = after = 0.0
    for j in range(many):
        number = values[begin + j * step]
        before += around[0, j] * number
        here += around[1, j] * number
        after += around[2, j] * number
    if math.isfinite(before + here + after):
        return before, here, after
    before = here = after = 0.0
    for j in range(many):
        number = values[begin + j * step]
        before += product_term(around[0, j], number)
        here += product_term(around[1, j], number)
        after += product_term(around[2, j], number)
    return (
        before if math.isfinite(before) else math.inf,
        here if math.isfinite(here) else math.inf,
        after if math.isfinite(after) else math.inf,
    )


@kernel
def all_around(around, knots, weights, window, piece, count):
    """Into ``around`` (3, WINDOW + 2) the weights of what the next order would add in the piece before, in a piece, and in
    the one after it; returns which nodes of the axis they are of, (first, last + 1), and how many pieces they are.

    A piece on the other side of a bend, where windows do not overlap as elsewhere, is not beside this one.
    """
    own, many = int(knots[piece, FIRST]), 1
    low = high = own
    for i in range(0, 3, 2):
        other = piece - 1 + i
        if 0 <= other < count - 1 and abs(int(knots[other, FIRST]) - own) <= 1:
            low, high = min(low, int(knots[other, FIRST])), max(high, int(knots[other, FIRST]))
            many += 1
    high += window
    for i in range(3):
        for j in range(high - low):
            around[i, j] = 0.0
        other = piece - 1 + i
        if 0 <= other < count - 1 and abs(int(knots[other, FIRST]) - own) <= 1:
            for j in range(window):
                around[i, int(knots[other, FIRST]) + j - low] = weights[other, j]
    return low, high, many


@kernel
def smoothed(before, here, after, many):
    """A remainder may vanish by chance in one piece: it is no less than in both beside it, or in the only one that is.

    Not the larger of those: a coarse or wild piece says nothing of a fine one beside it.
    """
    return max(abs(here), min(abs(before), abs(after)) if many == 3 else abs(before + after))

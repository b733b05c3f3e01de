"""Slopes of the numbers of a grid along its last two axes, put beside them: what :mod:`.spline` reads of a node."""

import math

import numpy as np

from ..jit import entry_point, kernel
from .axis import WINDOW
from .spline import FIRST, LEFT, NODE, PLACE, RIGHT, WIDTH, product_term


@entry_point
def tabulate(values, knots, windows, shape, table):
    """Into ``table`` (NODE nodes,) the ``values`` (nodes,), their slopes along the last axis, along the last but one, and
    along both; ``knots`` and ``windows`` of the axes as :mod:`.spline` takes them.

    The last two axes make blocks that the processor's cache holds while all is done with them.
    """
    outer, inner = len(shape) - 2, len(shape) - 1
    rows, columns = shape[outer], shape[inner]
    first, weights = np.empty((2, max(rows, columns)), np.int64), np.empty((2, max(rows, columns), WINDOW))
    for k in range(2):
        of_nodes(knots[outer + k], shape[outer + k], windows[outer + k], first[k], weights[k])
    block, mixed = np.empty(rows * columns), np.empty(rows * columns)
    along, both = np.empty(columns), np.empty(columns)
    for begin in range(0, len(values), rows * columns):
        for k in range(rows * columns):
            block[k] = values[begin + k]
        for row in range(rows):
            for index in range(columns):
                total, low = 0.0, row * columns + first[1, index]
                for j in range(windows[inner]):
                    total += weights[1, index, j] * block[low + j]
                if not math.isfinite(total):
                    at = row * columns + index
                    total = some_slope(block, at, index, 1, first[1], weights[1], windows[inner], knots[inner], columns)
                mixed[row * columns + index] = total
        for index in range(rows):
            low = first[0, index] * columns
            for p in range(columns):
                along[p] = both[p] = 0.0
            for j in range(windows[outer]):
                weight = weights[0, index, j]
                for p in range(columns):
                    along[p] += weight * block[low + p]
                    both[p] += weight * mixed[low + p]
                low += columns
            for p in range(columns):
                at = index * columns + p
                slope, twist = along[p], both[p]
                if not math.isfinite(slope):
                    slope = some_slope(
                        block, at, index, columns, first[0], weights[0], windows[outer], knots[outer], rows
                    )
                if not math.isfinite(twist):
                    twist = some_slope(
                        mixed, at, index, columns, first[0], weights[0], windows[outer], knots[outer], rows
                    )
                place = NODE * (begin + at)
                table[place], table[place + 1], table[place + 2], table[place + 3] = block[at], mixed[at], slope, twist


@kernel
def of_nodes(knots, count, window, first, weights):
    """Where the window of each node of an axis begins, into ``first`` (n,), and into ``weights`` (n, WINDOW) those of its
    nodes in the slope.
    """
    for index in range(count):
        own = min(index, count - 2)
        side, width = LEFT if own == index else RIGHT, knots[own, WIDTH]
        first[index] = int(knots[own, FIRST])
        for j in range(window):
            weights[index, j] = knots[own, side + j] / width


@kernel
def some_slope(values, at, index, step, first, weights, window, knots, count):
    """The slope at a node whose window has holes: those of weight zero do not count; else from the nodes beside it."""
    total, low = 0.0, at + (first[index] - index) * step
    for j in range(window):
        total += product_term(weights[index, j], values[low + j * step])
    if math.isfinite(total):
        return total
    before = after = math.nan
    h = k = 0.0
    if index > 0:
        h = knots[index, PLACE] - knots[index - 1, PLACE]
        before = (values[at] - values[at - step]) / h
    if index + 1 < count:
        k = knots[index + 1, PLACE] - knots[index, PLACE]
        after = (values[at + step] - values[at]) / k
    if math.isfinite(before) and math.isfinite(after):
        return (k * before + h * after) / (h + k)
    return before if math.isfinite(before) else after

"""Slopes within one phase: where fibers go slack numbers have a kink, and what lies beyond it tells nothing of this side.

Along the two inner axes, whose slopes are stored, each node takes the polynomial through the nearest nodes of its own run:
those next to each other along the axis, and alike in what is slack. A run of one or two nodes takes what lies beyond it.
"""

import math

from ..jit import entry_point, kernel
from .axis import SLOPE, WINDOW

FEWEST = 3  # nodes of a run that tells a slope


@kernel
def run_around(phases, at, index, count, step):
    """The first and the last node of the run of node ``at``, the ``index``-th of ``count`` along its axis, nearby."""
    low, high = index, index
    while low > 0 and index - low < WINDOW and phases[at + (low - 1 - index) * step] == phases[at]:
        low -= 1
    while high < count - 1 and high - index < WINDOW and phases[at + (high + 1 - index) * step] == phases[at]:
        high += 1
    return low, high


@kernel
def nearest(index, size, low, high):
    """The first of the ``size`` nodes from ``low`` to ``high`` around one, and how many there are."""
    many = min(size, high - low + 1)
    return min(max(index - many // 2, low), high - many + 1), many


@kernel
def slope_of(values, nodes, at, index, step, first, many):
    """The slope at a node of the polynomial through ``many`` nodes from ``first`` on."""
    total, x = 0.0, nodes[index]
    for j in range(first, first + many):
        weight = 0.0 if j == index else 1.0 / (nodes[j] - x)
        for k in range(first, first + many):
            if j == index and k != index:
                weight += 1.0 / (x - nodes[k])
            elif k != index and k != j:
                weight *= (x - nodes[k]) / (nodes[j] - nodes[k])
        total += weight * values[at + (j - index) * step]
    return total


@kernel
def polynomial_at(values, nodes, at, index, step, first, many, x):
    """The polynomial through ``many`` nodes from ``first`` on, at a place."""
    total = 0.0
    for j in range(first, first + many):
        weight = 1.0
        for k in range(first, first + many):
            if k != j:
                weight *= (x - nodes[k]) / (nodes[j] - nodes[k])
        total += weight * values[at + (j - index) * step]
    return total


@entry_point
def slopes_within(values, phases, nodes, step, out):
    """Put slopes of ``values`` (nodes,) into ``out`` (nodes,) where the nodes that a slope knows are of several runs."""
    count = len(nodes)
    for at in range(len(values)):
        index = (at // step) % count
        low, high = run_around(phases, at, index, count, step)
        usual, size = nearest(index, SLOPE, 0, count - 1)
        if (low <= usual and usual + size - 1 <= high) or high - low + 1 < FEWEST:
            continue
        first, many = nearest(index, SLOPE, low, high)
        slope = slope_of(values, nodes, at, index, step, first, many)
        if math.isfinite(slope):
            out[at] = slope


@entry_point
def remainders_within(values, slopes, phases, nodes, step, rough, within):
    """Put what the next order would add in the middle of each piece into ``rough`` (nodes,) where its two nodes are of one
    run, but not all that a piece knows, and mark it in ``within`` (nodes,); ``slopes`` (nodes,) are those stored.
    """
    count = len(nodes)
    for at in range(len(values)):
        index = (at // step) % count
        if index == count - 1 or phases[at] != phases[at + step]:
            continue
        low, high = run_around(phases, at, index, count, step)
        usual, size = nearest(index + 1, WINDOW, 0, count - 1)
        if (low <= usual and usual + size - 1 <= high) or high - low + 1 < FEWEST:
            continue
        first, many = nearest(index + 1, WINDOW, low, high)
        if many < SLOPE:  # the cubic is the best there is: without the farthest node
            first, many = nearest(index + 1, many - 1, low, high)
        width = nodes[index + 1] - nodes[index]
        best = polynomial_at(values, nodes, at, index, step, first, many, nodes[index] + 0.5 * width)
        middle = 0.5 * (values[at] + values[at + step]) + 0.125 * width * (slopes[at] - slopes[at + step])
        rest = abs(best - middle)
        rough[at], within[at] = rest if math.isfinite(rest) else math.inf, True

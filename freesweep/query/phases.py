"""Slopes within one phase: where fibers go slack numbers have a kink, and what lies beyond it tells nothing of this side.

Along the two inner axes, whose slopes are stored, each node takes the polynomial through the nearest nodes of its own run:
those next to each other along the axis, and alike in what is slack. A run of one or two nodes takes what lies beyond it.
What a kink leaves in the pieces that know nodes beyond it is told from the change of slope there.
"""

import math

from ..jit import entry_point, kernel
from .axis import SLOPE, WINDOW
from .spline import FIRST

FEWEST = 3  # nodes of a run that tells a slope
KINK = (0.25, 0.04, 0.01)  # of a change of slope times the width: what cubics miss in its piece, and one and two beside


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
def slope_of(table, column, nodes, at, index, step, first, many):
    """The slope at a node of the polynomial through ``many`` nodes from ``first`` on."""
    total, x = 0.0, nodes[index]
    for j in range(first, first + many):
        weight = 0.0 if j == index else 1.0 / (nodes[j] - x)
        for k in range(first, first + many):
            if j == index and k != index:
                weight += 1.0 / (x - nodes[k])
            elif k != index and k != j:
                weight *= (x - nodes[k]) / (nodes[j] - nodes[k])
        total += weight * table[at + (j - index) * step, column]
    return total


@kernel
def polynomial_at(table, nodes, at, index, step, first, many, x):
    """The polynomial through ``many`` nodes from ``first`` on, at a place."""
    total = 0.0
    for j in range(first, first + many):
        weight = 1.0
        for k in range(first, first + many):
            if k != j:
                weight *= (x - nodes[k]) / (nodes[j] - nodes[k])
        total += weight * table[at + (j - index) * step, 0]
    return total


@entry_point
def slopes_within(table, source, column, phases, nodes, step):
    """Put slopes of one column of ``table`` (nodes, NODE) into another where the nodes that a slope knows are of several
    runs.
    """
    count = len(nodes)
    for at in range(len(table)):
        index = (at // step) % count
        low, high = run_around(phases, at, index, count, step)
        usual, size = nearest(index, SLOPE, 0, count - 1)
        if (low <= usual and usual + size - 1 <= high) or high - low + 1 < FEWEST:
            continue
        first, many = nearest(index, SLOPE, low, high)
        slope = slope_of(table, source, nodes, at, index, step, first, many)
        if math.isfinite(slope):
            table[at, column] = slope


@kernel
def remainder_within(table, column, phases, nodes, at, index, count, step):
    """Whether both nodes of a piece, which begins at node ``at``, are of one run, but not all that a piece knows; and what
    the next order would add in its middle to the cubic with the slopes in a ``column``.
    """
    if phases[at] != phases[at + step]:
        return False, 0.0
    low, high = run_around(phases, at, index, count, step)
    usual, size = nearest(index + 1, WINDOW, 0, count - 1)
    if (low <= usual and usual + size - 1 <= high) or high - low + 1 < FEWEST:
        return False, 0.0
    first, many = nearest(index + 1, WINDOW, low, high)
    if many < SLOPE:  # the cubic is the best there is: without the farthest node
        first, many = nearest(index + 1, many - 1, low, high)
    width = nodes[index + 1] - nodes[index]
    best = polynomial_at(table, nodes, at, index, step, first, many, nodes[index] + 0.5 * width)
    middle = 0.5 * (table[at, 0] + table[at + step, 0]) + 0.125 * width * (table[at, column] - table[at + step, column])
    rest = abs(best - middle)
    return True, rest if math.isfinite(rest) else math.inf


@kernel
def kinks_along(table, phases, begin, step, piece, count, window, knots, weights, nodes, column, sums):
    """What kinks leave in a piece of the line that begins at node ``begin``: one inside it, and those that it reaches unless
    it is told from nodes of its own phase only. ``sums`` (3,), remainders of the piece before, of it and of the next one,
    become those told so along an axis whose slopes are stored in a ``column``, 0 if they are not.
    """
    within = False
    for i in range(3 if column > 0 else 0):
        other = piece - 1 + i
        if 0 <= other < count - 1:
            found, rest = remainder_within(table, column, phases, nodes, begin + other * step, other, count, step)
            sums[i] = rest if found else sums[i]
            within = within or (found and i == 1)
    reach, worst = 0 if within else len(KINK) - 1, 0.0
    for other in range(max(piece - reach, 0), min(piece + reach, count - 2) + 1):
        at = begin + other * step
        if phases[at] == phases[at + step]:
            continue
        jump, first = 0.0, int(knots[other, FIRST])
        for side in (1, 2):
            part = 0.0
            for j in range(window):
                weight = weights[other, side, j]
                if weight != 0.0:
                    part += weight * table[begin + (first + j) * step, 0]
            jump += abs(part)
        worst = max(worst, KINK[abs(other - piece)] * (jump if jump < math.inf else math.inf))
    return worst

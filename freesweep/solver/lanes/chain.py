"""The chain rule: from derivatives by the numbers of :mod:`second` to those along what a problem's columns change by."""

import numpy as np

from ...jit import entry_point
from ..problem import AREA, FORCE, GAMMA, INNER, LENGTH, RATIO, SECOND, THIRD, TORQUE, D, H
from . import second
from .told import OUTPUTS, TOLD
from .told_extremes import RESULTS

NONE = 1e-13  # of what an output is measured by: what stands for 0, of two families that cancel, too
LITTLE, TURN = 1e-2, 0.5  # of the work of the loads, and of half a tube: what energy and twist are measured by at least


@entry_point
def chain(problems, pressures, changes, told, doubts, values, bounds, missed):
    """Turn what is ``told`` of rows (n, RESULTS, TOLD), and the ``doubts`` about it, to ``values`` and ``bounds`` (n, 1 +
    directions, RESULTS) along directions: ``changes`` (n, directions, columns + 1) of the problem's columns and the
    pressure. ``missed`` (n,): the largest bound, scaled as outputs are, or by what it belongs to.
    """
    by, size, last, there = np.zeros(TOLD), np.ones(RESULTS), problems.shape[1], np.zeros(TOLD, np.int64)
    for row in range(len(problems)):
        one, largest = problems[row], 0.0
        pressure = 1.0 if pressures[row] == np.inf else pressures[row]
        size[0], size[1], size[2], size[4] = 0.5 * one[LENGTH], told[row, 1, 0], TURN, 1.0
        size[3] = LITTLE * (
            abs(pressure * told[row, 1, 0]) + abs(one[FORCE] * told[row, 0, 0]) + abs(one[TORQUE] * told[row, 2, 0])
        )
        for k in range(changes.shape[1] + 1):
            by[:] = 0.0
            if k == 0:
                by[0] = 1.0
            else:
                own = changes[row, k - 1]
                by[1 + second.T_ALPHA], by[1 + second.T_BETA] = own[H] + own[D], own[H] - own[D]
                by[1 + second.GAMMA], by[1 + second.AREA], by[1 + second.INNER] = own[GAMMA], own[AREA], own[INNER]
                by[1 + second.RATIO], by[1 + second.SECOND], by[1 + second.THIRD] = own[RATIO], own[SECOND], own[THIRD]
                by[1 + second.FORCE], by[1 + second.PRESSURE], by[1 + second.TORQUE] = (
                    own[FORCE],
                    own[last],
                    own[TORQUE],
                )
                by[TOLD - 1] = 0.5 * own[LENGTH]
            count = 0
            for j in range(TOLD):
                if by[j] != 0.0:
                    there[count] = j
                    count += 1
            for i in range(RESULTS):
                value, bound = 0.0, NONE * size[i]
                for n in range(count):
                    j = there[n]
                    value += by[j] * told[row, i, j]
                    bound += abs(by[j]) * doubts[row, i, j]
                values[row, k, i], bounds[row, k, i] = value, bound
                part = bound / max(size[i], abs(value))
                largest = part if i < OUTPUTS and not part <= largest else largest
        missed[row] = largest

"""Where points lie in a table: folded by symmetry, located, checked, with the uniform state that stands behind them.

``asked`` (n, k) holds what a table knows of each point, columns in the order of ``Table.known``; ``kinds`` (k, 3) says of
each the column of a point (-1: the design), the axis of the table (-1: none), and 1 if it turns with both angles.
"""

import math

import numpy as np

from ..jit import entry_point, kernel
from ..status import DEGENERATE, INACCURATE, INVALID, NOT_INTERPOLABLE, OK, OUTSIDE
from .axis import LABEL
from .holes import MIXED, corner_code
from .reference import ALPHA, BETA, FIBERS, HELD, LENGTH, RADIUS, uniform
from .tensor import INSIDE, NO_NUMBER, PLACE, locate

NEAR = 1e-12  # relative: what counts as the value that an atlas fixes, or as the end of an axis
LARGEST, CLOSEST = 90.0, 0.5 * (1.0 - 1e-9)  # [degree] of a fiber angle, of two


@kernel
def within(x, low, high):
    """Whether a number lies in a closed range; ends are met to rounding."""
    slack = NEAR * max(abs(low), abs(high))
    return low - slack <= x <= high + slack


@kernel
def image(asked, k, a, b, swap, turn, kinds, ranges, out):
    """Put one image of point k into ``out`` (k,); whether what turns with it lies in the table."""
    sign = -1.0 if turn else 1.0
    good = True
    for j in range(len(out)):
        x = asked[k, j]
        if j == a:
            x = sign * (asked[k, b] if swap else x) + 0.0
        elif j == b:
            x = sign * (asked[k, a] if swap else x) + 0.0
        elif turn and kinds[j, 2] == 1:
            x = 0.0 - x
        out[j] = x
        if j == a or j == b or (turn and kinds[j, 2] == 1):
            good = good and within(x, ranges[j, 0], ranges[j, 1])
    return good


@kernel
def touches_diagonal(alpha, beta, i, j, knots, pieces, shares, k):
    """Whether the cell of point k holds designs with one fiber family only, or nearly so; angles on axes i and j."""
    a0, a1, b0, b1 = alpha, alpha, beta, beta
    if i >= 0 and 0.0 < shares[k, i] < 1.0:
        a0, a1 = knots[i, pieces[k, i], PLACE], knots[i, pieces[k, i] + 1, PLACE]
    if j >= 0 and 0.0 < shares[k, j] < 1.0:
        b0, b1 = knots[j, pieces[k, j], PLACE], knots[j, pieces[k, j] + 1, PLACE]
    return a0 - b1 < CLOSEST and a1 - b0 > -CLOSEST


@entry_point
def place(
    asked, kinds, ranges, fixed, options, knots, counts, coordinates, strides, codes, cells, slack, slack_cells, points,
    states, pieces, shares, marks,
):  # fmt: skip
    """Place points (n, k) in a table.

    ``fixed`` (designs, 15): what the atlas fixes of a point. ``options``: kind of state, shear, whether the fibers lie at
    the inner radius, whether HELD is given as a length, whether there are statuses. ``codes`` and ``slack``: of the nodes,
    and of their cells. Out: ``points`` (n, 15), ``states`` (n, UNIFORM), ``pieces`` and ``shares`` (n, d), ``marks`` (n, 7):
    status, code, code of slack fibers, cell, node (-1: between nodes), 1 if exchanged, 1 if mirrored.
    """
    kind, shear, inner, by_length, has_status = options
    many, d = asked.shape[1], len(strides)
    row, point, state = np.empty(many), np.empty(points.shape[1]), np.empty(states.shape[1])
    a = b = design = -1
    for j in range(many):
        if kinds[j, 0] == ALPHA:
            a = j
        elif kinds[j, 0] == BETA:
            b = j
        elif kinds[j, 0] == -1:
            design = j
    for k in range(len(asked)):
        status = -1
        exchanged, mirrored = False, False
        image(asked, k, -1, -1, False, False, kinds, ranges, row)
        if a >= 0 and b >= 0 and not image(asked, k, a, b, False, False, kinds, ranges, row):
            found = False
            for way in range(1, 4):
                if image(asked, k, a, b, way != 2, way > 1, kinds, ranges, row):
                    exchanged, mirrored, found = way != 2, way > 1, True
                    break
            if not found:
                image(asked, k, -1, -1, False, False, kinds, ranges, row)
                status = OUTSIDE
        label = row[design] if design >= 0 else 0.0
        known = 0.0 <= label < len(fixed)
        for i in range(len(point)):
            point[i] = fixed[int(label) if known else 0, i]
        for i in range(d):
            pieces[k, i], shares[k, i] = 0, 0.0
        bad = not known
        for j in range(many):
            x = row[j]
            column, axis = kinds[j, 0], kinds[j, 1]
            bad = bad or math.isnan(x)
            if column >= 0:
                point[column] = x
            if axis >= 0:
                pieces[k, axis], shares[k, axis], where = locate(x, knots, axis, coordinates[axis], counts[axis])
                if where != INSIDE and where != NO_NUMBER:
                    status = OUTSIDE
            elif column >= 0 and not within(x, ranges[j, 0], ranges[j, 1]):
                status = OUTSIDE
        if inner:
            point[FIBERS] = point[RADIUS]
        if by_length:
            point[HELD] /= point[LENGTH]
        if bad:
            status = INVALID
        cell, node, exact = 0, 0, True
        for i in range(d):
            cell += pieces[k, i] * strides[i]
            node += (pieces[k, i] + (1 if shares[k, i] == 1.0 else 0)) * strides[i]
            exact = exact and (coordinates[i] == LABEL or shares[k, i] == 0.0 or shares[k, i] == 1.0)
        code = corner_code(codes, cells, strides, pieces, shares, k, cell)
        of_slack = corner_code(slack, slack_cells, strides, pieces, shares, k, cell) if len(slack) > 0 else MIXED
        if status < 0:
            status = NOT_INTERPOLABLE if code == MIXED else code & 15 if has_status else OK
            if not exact:
                if status != OK and status != INACCURATE:
                    status = NOT_INTERPOLABLE
                if a >= 0 and b >= 0:
                    alpha, beta = point[ALPHA], point[BETA]
                    if alpha == beta:
                        status = DEGENERATE
                    elif abs(alpha - beta) < CLOSEST or max(abs(alpha), abs(beta)) >= LARGEST:
                        status = INVALID
                    elif touches_diagonal(alpha, beta, kinds[a, 1], kinds[b, 1], knots, pieces, shares, k):
                        status = NOT_INTERPOLABLE
        uniform(kind, point, shear, state)
        for i in range(len(point)):
            points[k, i] = point[i]
        for i in range(len(state)):
            states[k, i] = state[i]
        marks[k, 0], marks[k, 1], marks[k, 2], marks[k, 3] = status, code, of_slack, cell
        marks[k, 4], marks[k, 5], marks[k, 6] = node if exact else -1, exchanged, mirrored

"""Where points lie in a table: folded by symmetry, located, checked.

``asked`` (n, k) holds what a table knows of each point, columns in the order of ``Table.known``; ``kinds`` (k, 3) says of
each the column of a point (-1: the design), the axis of the table (-1: none), and 1 if it turns with both angles.
"""

import math

import numpy as np

from ..jit import entry_point, kernel
from ..status import DEGENERATE, INACCURATE, INVALID, NOT_INTERPOLABLE, OK, OUTSIDE
from .axis import LABEL
from .missing_nodes import MIXED, corner_code
from .reference import ALPHA, BETA, FIBERS, HELD, LENGTH, RADIUS, WALL
from .spline import BELOW, INSIDE, NO_NUMBER, PLACE, locate

NEAR = 1e-12  # relative: what counts as the value that an atlas fixes, or as the end of an axis
LARGEST, CLOSEST = 90.0, 0.5 * (1.0 - 1e-9)  # [degree] of a fiber angle, of two


@kernel
def within(x, low, high):
    """Whether a number lies in a closed range; ends are met to rounding."""
    slack = NEAR * max(abs(low), abs(high))
    return low - slack <= x <= high + slack


@kernel
def image(asked, k, a, b, swap, turn, kinds, ranges, out):
    """Put one image of point k into ``out`` (k,); whether its angles, and what turns with them, lie in the table."""
    sign = -1.0 if turn else 1.0
    good = True
    for j in range(len(out)):
        angle, turns = j == a or j == b, turn and kinds[j, 2] == 1
        x = asked[k, a + b - j if angle and swap else j]
        if angle or turns:
            x = sign * x + 0.0
            good = good and within(x, ranges[j, 0], ranges[j, 1])
        out[j] = x
    return good


@entry_point
def place(
    asked, kinds, ranges, fixed, options, knots, counts, coordinates, strides, codes, cells, points, pieces, shares, marks,
):  # fmt: skip
    """Place points (n, k) in a table.

    ``fixed`` (designs, 17): what the atlas fixes of a point. ``options``: share of the wall inside the fibers (-1: their
    radius is given), whether
    HELD is given as a length, whether there are statuses; how near to one angle a cell may hold designs [degree]; which of
    what is asked are both angles and the design (-1: none).
    ``codes`` and ``cells`` (2, nodes): codes, and those of slack fibers, of the nodes and of their cells. Out: ``points``
    (n, 17), ``pieces`` and ``shares`` (n, d), ``marks`` (n, 7): status, code, code of slack fibers, cell, node (-1: between
    nodes), 1 if exchanged, 1 if mirrored.
    """
    fiber_share, by_length, has_status, nearest, a, b, design = options
    d, many = len(strides), asked.shape[1]
    row = np.empty(many)
    angles = a >= 0 and b >= 0
    for k in range(len(asked)):
        status, exchanged, mirrored = -1, False, False
        for way in range(5):  # as it is, exchanged, mirrored, both, and as it is if the table holds none of them
            exchanged, mirrored = way == 1 or way == 3, way == 2 or way == 3
            found = image(asked, k, a, b, exchanged, mirrored, kinds, ranges, row)
            if found or not angles:
                break
            status = OUTSIDE if way == 4 else -1
        label = row[design] if design >= 0 else 0.0
        bad = not 0.0 <= label < len(fixed)
        for i in range(fixed.shape[1]):
            points[k, i] = fixed[0 if bad else int(label), i]
        least, most = (
            0.0,
            0.0,
        )  # alpha - beta in the cell: does it hold designs with one fiber family only, or nearly so?
        for j in range(many):
            x, column, axis = row[j], kinds[j, 0], kinds[j, 1]
            bad = bad or math.isnan(x)
            where, low, high = INSIDE, x, x
            if axis >= 0:
                piece, share, where = locate(x, knots, axis, coordinates[axis], counts[axis])
                pieces[k, axis], shares[k, axis] = piece, share
                if 0.0 < share < 1.0:
                    low, high = knots[axis, piece, PLACE], knots[axis, piece + 1, PLACE]
            elif column >= 0 and not within(x, ranges[j, 0], ranges[j, 1]):
                where = BELOW
            if where != INSIDE and where != NO_NUMBER:
                status = OUTSIDE
            if column >= 0:
                points[k, column] = x
            if j == a:
                least, most = least + low, most + high
            elif j == b:
                least, most = least - high, most - low
        if fiber_share >= 0.0:
            points[k, FIBERS] = points[k, RADIUS] + (fiber_share * points[k, WALL] if fiber_share > 0.0 else 0.0)
        if by_length:
            points[k, HELD] /= points[k, LENGTH]
        if bad:
            status = INVALID
        cell, node, exact = np.int64(0), np.int64(0), True
        for i in range(d):
            share = shares[k, i]
            cell += pieces[k, i] * strides[i]
            node += (pieces[k, i] + (1 if share == 1.0 else 0)) * strides[i]
            exact = exact and (coordinates[i] == LABEL or share == 0.0 or share == 1.0)
        for which in range(2):
            marks[k, 1 + which] = corner_code(codes, cells, which, strides, pieces, shares, k, cell)
        code = marks[k, 1]
        if status < 0:
            status = NOT_INTERPOLABLE if code == MIXED else code & 15 if has_status else OK
            if not exact:
                if status != OK and status != INACCURATE:
                    status = NOT_INTERPOLABLE
                if angles:
                    alpha, beta = points[k, ALPHA], points[k, BETA]
                    if alpha == beta:
                        status = DEGENERATE
                    elif abs(alpha - beta) < CLOSEST or max(abs(alpha), abs(beta)) >= LARGEST:
                        status = INVALID
                    elif least < nearest and most > -nearest:
                        status = NOT_INTERPOLABLE
        marks[k, 0], marks[k, 3], marks[k, 4] = status, cell, node if exact else -1
        marks[k, 5], marks[k, 6] = exchanged, mirrored

"""Where points lie in a table: folded by symmetry, located, checked."""

import math
from typing import NamedTuple

import numpy as np

from ..jit import entry_point, kernel
from ..status import DEGENERATE, INACCURATE, INVALID, NOT_INTERPOLABLE, OK, OUTSIDE
from .axis import LABEL
from .fixed import complete
from .missing_nodes import MIXED, corner_code
from .reference import ALPHA, BETA
from .spline import BELOW, INSIDE, NO_NUMBER, PLACE, locate

NEAR = 1e-12  # relative: what counts as the value that an atlas fixes, or as the end of an axis
LARGEST, CLOSEST = 90.0, 0.5 * (1.0 - 1e-9)  # [degree] of a fiber angle, of two


class Columns(NamedTuple):
    """What a table knows of each point: of each column the column of a point (-1: the design), the axis of the table (-1:
    none), and 1 if it turns with both angles, ``kinds`` (k, 3), between which ``bounds`` (k, 2) it may lie; and which of
    them are both angles and the design (-1: none).
    """

    kinds: np.ndarray
    bounds: np.ndarray
    alpha: int
    beta: int
    design: int


class Nodes(NamedTuple):
    """Nodes of a table: ``knots``, ``counts`` and ``coordinates`` (d,) of its axes as :mod:`.spline` takes them, their
    ``strides`` (d,); codes, and those of slack fibers, of the nodes and of their ``cells``, (2, nodes).
    """

    knots: np.ndarray
    counts: np.ndarray
    coordinates: np.ndarray
    strides: np.ndarray
    codes: np.ndarray
    cells: np.ndarray


class Placed(NamedTuple):
    """Where points are: ``points`` (n, 17), ``pieces`` and ``shares`` (n, d) of the axes, ``marks`` (n, 7): status, code,
    code of slack fibers, cell, node (-1: between nodes), 1 if exchanged, 1 if mirrored.
    """

    points: np.ndarray
    pieces: np.ndarray
    shares: np.ndarray
    marks: np.ndarray


@kernel
def within(x, low, high):
    """Whether a number lies in a closed range; ends are met to rounding."""
    slack = NEAR * max(abs(low), abs(high))
    return low - slack <= x <= high + slack


@kernel
def image(asked, k, swap, turn, columns, out):
    """Put one image of point k into ``out`` (k,); whether its angles, and what turns with them, lie in the table."""
    sign, a, b = -1.0 if turn else 1.0, columns.alpha, columns.beta
    good = True
    for j in range(len(out)):
        angle, turns = j == a or j == b, turn and columns.kinds[j, 2] == 1
        x = asked[k, a + b - j if angle and swap else j]
        if angle or turns:
            x = sign * x + 0.0
            good = good and within(x, columns.bounds[j, 0], columns.bounds[j, 1])
        out[j] = x
    return good


@kernel
def fold(asked, k, columns, row):
    """Put the image of point k that the table holds into ``row``: ``(status, exchanged, mirrored)``, of which the status is
    OUTSIDE if it holds none, else -1.
    """
    status, exchanged, mirrored, angles = -1, False, False, columns.alpha >= 0 and columns.beta >= 0
    for way in range(5):  # as it is, exchanged, mirrored, both, and as it is if the table holds none of them
        exchanged, mirrored = way == 1 or way == 3, way == 2 or way == 3
        found = image(asked, k, exchanged, mirrored, columns, row)
        if found or not angles:
            break
        status = OUTSIDE if way == 4 else -1
    return status, exchanged, mirrored


@kernel
def spread_out(row, k, columns, nodes, placed):
    """Put the columns of one point where they belong: ``(whether it is outside, whether some are no numbers, least, most)``,
    the last two what alpha - beta is in its cell: does it hold designs with one fiber family only, or nearly so?
    """
    outside, bad, least, most = False, False, 0.0, 0.0
    for j in range(len(row)):
        x, column, axis = row[j], columns.kinds[j, 0], columns.kinds[j, 1]
        bad = bad or math.isnan(x)
        where, low, high = INSIDE, x, x
        if axis >= 0:
            piece, share, where = locate(x, nodes.knots, axis, nodes.coordinates[axis], nodes.counts[axis])
            placed.pieces[k, axis], placed.shares[k, axis] = piece, share
            if 0.0 < share < 1.0:
                low, high = nodes.knots[axis, piece, PLACE], nodes.knots[axis, piece + 1, PLACE]
        elif column >= 0 and not within(x, columns.bounds[j, 0], columns.bounds[j, 1]):
            where = BELOW
        if where != INSIDE and where != NO_NUMBER:
            outside = True
        if column >= 0:
            placed.points[k, column] = x
        if j == columns.alpha:
            least, most = least + low, most + high
        elif j == columns.beta:
            least, most = least - high, most - low
    return outside, bad, least, most


@kernel
def cell_of(k, nodes, placed):
    """``(cell, node, exact)`` of one point: the first node of its cell, that which it is if it is one, and whether it is."""
    cell, node, exact = np.int64(0), np.int64(0), True
    for i in range(len(nodes.strides)):
        piece, share = placed.pieces[k, i], placed.shares[k, i]
        cell += piece * nodes.strides[i]
        node += (piece + (1 if share == 1.0 else 0)) * nodes.strides[i]
        exact = exact and (nodes.coordinates[i] == LABEL or share == 0.0 or share == 1.0)
    return cell, node, exact


@kernel
def between_nodes(status, alpha, beta, apart, nearest):
    """The status of a point between nodes that have this one, where alpha - beta is in the range ``apart`` in its cell."""
    if alpha == beta:
        return DEGENERATE
    if abs(alpha - beta) < CLOSEST or max(abs(alpha), abs(beta)) >= LARGEST:
        return INVALID
    return NOT_INTERPOLABLE if apart[0] < nearest and apart[1] > -nearest else status


@entry_point
def place(asked, columns, fixed, nodes, has_status, nearest, placed):
    """Place points ``asked`` (n, k) in a table, into ``placed``; ``fixed``: what an atlas fixes of them. ``has_status``: the
    nodes have; ``nearest``: how near to one angle a cell may hold designs [degree].
    """
    row, design, angles = np.empty(asked.shape[1]), columns.design, columns.alpha >= 0 and columns.beta >= 0
    points, marks = placed.points, placed.marks
    for k in range(len(asked)):
        status, exchanged, mirrored = fold(asked, k, columns, row)
        label = row[design] if design >= 0 else 0.0
        unknown = not 0.0 <= label < len(fixed.numbers)
        for i in range(points.shape[1]):
            points[k, i] = fixed.numbers[0 if unknown else int(label), i]
        outside, bad, least, most = spread_out(row, k, columns, nodes, placed)
        complete(points[k], fixed)
        if unknown or bad:
            status = INVALID
        elif outside:
            status = OUTSIDE
        cell, node, exact = cell_of(k, nodes, placed)
        for which in range(2):
            marks[k, 1 + which] = corner_code(
                nodes.codes, nodes.cells, which, nodes.strides, placed.pieces, placed.shares, k, cell
            )
        code = marks[k, 1]
        if status < 0:
            status = NOT_INTERPOLABLE if code == MIXED else code & 15 if has_status else OK
            if not exact:
                if status != OK and status != INACCURATE:
                    status = NOT_INTERPOLABLE
                if angles:
                    status = between_nodes(status, points[k, ALPHA], points[k, BETA], (least, most), nearest)
        marks[k, 0], marks[k, 3], marks[k, 4] = status, cell, node if exact else -1
        marks[k, 5], marks[k, 6] = exchanged, mirrored

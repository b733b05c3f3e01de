"""Holes of a grid: which cells may be answered, and numbers for the nodes beside them that slopes and windows need.

A node without a number next to good ones (the line alpha = beta, an edge of validity) gets the polynomial through its
neighbours. It helps to weigh the cells beside it and never answers a point itself.
"""

import math
from itertools import product
from typing import NamedTuple

import numpy as np

from ..jit import entry_point, kernel
from ..status import INACCURATE, OK
from .axis import lagrange

SWEEPS = 6  # how far from good nodes numbers are put, in steps along the axes: windows reach two nodes beyond a cell
REACH = 4  # nodes along an axis that a hole looks at, on either side
BETWEEN = 3  # of those it takes the nearest on each side,
BEYOND = 4  # or so many where one side has none
LEAST = 1e-30  # square of what a number is off at least
MIXED = 255  # code of a cell whose nodes do not agree


@kernel
def _through(xs, fs, found, x, left_out):
    """The polynomial through ``found`` nodes, one of them left out (-1: none), at one place."""
    total = 0.0
    for j in range(found):
        weight = 1.0
        for k in range(found):
            if k != j and k != left_out:
                weight *= (x - xs[k]) / (xs[j] - xs[k])
        if j != left_out:
            total += weight * fs[j]
    return total


class Holed(NamedTuple):
    """A grid with holes: ``values`` (nodes,), NaN there; what numbers that were put in before may be off, ``doubts``
    (nodes,); ``shape`` and ``strides`` (d,), ``nodes`` of the axes (d, n), and :func:`weights_beyond`.
    """

    values: np.ndarray
    doubts: np.ndarray
    shape: np.ndarray
    strides: np.ndarray
    nodes: np.ndarray
    beyond: np.ndarray


@kernel
def _look_around(given, values, at, index, count, step):
    """Put the numbers beside a node along an axis into ``given`` (2 REACH + 1,), NaN where there is none; returns how many
    there are below and above.
    """
    below = above = 0
    for far in range(1, REACH + 1):
        given[REACH - far] = values[at - far * step] if index >= far else math.nan
        given[REACH + far] = values[at + far * step] if index + far < count else math.nan
        below += 1 if math.isfinite(given[REACH - far]) else 0
        above += 1 if math.isfinite(given[REACH + far]) else 0
    return below, above


@kernel
def _by_weights(given, weights, side):
    """``(number, the same without the farthest node)`` of a node with as many numbers on one side (0: below) as there are
    ``weights`` (2, 2, BEYOND) for.
    """
    value, other = 0.0, 0.0
    for j in range(BEYOND):
        number = given[REACH - 1 - j if side == 0 else REACH + 1 + j]
        value += weights[side, 0, j] * number
        other += weights[side, 1, j] * number
    return value, other


@kernel
def _by_polynomial(given, nodes, index, sides, xs, fs):
    """The same by the nearest numbers on each of its ``sides``; NaN where these are fewer than three. ``xs`` and ``fs`` take
    them.
    """
    found, before = np.int64(0), np.int64(0)
    for place in range(2 * REACH):
        far = place // 2 + 1
        side = -1 if place % 2 == 0 else 1
        room = before < BETWEEN if side < 0 else found - before < BETWEEN
        if sides == 1:  # polynomials of high degree are wild beyond their nodes
            room = found < BEYOND
        if room and math.isfinite(given[REACH + side * far]):
            xs[found], fs[found] = nodes[index + side * far], given[REACH + side * far]
            found += 1
            before += 1 if side < 0 else 0
    if found < 3:
        return math.nan, math.nan
    farthest = np.int64(0)
    for j in range(found):
        if abs(xs[j] - nodes[index]) > abs(xs[farthest] - nodes[index]):
            farthest = j
    return _through(xs, fs, found, nodes[index], -1), _through(xs, fs, found, nodes[index], farthest)


@entry_point
def fill_once(grid, bad, numbers, doubts):
    """Numbers for the NaN of a grid that is :class:`Holed` at ``bad`` (k,), where they lie beside numbers, into ``numbers``
    (k,).

    Between nodes rather than beyond them; NaN where nothing is beside. Of several axes the surer count more. ``doubts``
    (k,): what the farthest node changes, by how much axes differ, and what is inherited of numbers put in before.
    """
    xs, fs, given = np.empty(2 * BETWEEN), np.empty(2 * BETWEEN), np.empty(2 * REACH + 1)
    found_along, weights = np.empty((2, len(grid.shape)))
    for k in range(len(bad)):
        at, most, many = bad[k], 0, 0
        for a in range(len(grid.shape)):
            count, step = grid.shape[a], grid.strides[a]
            index = (at // step) % count
            below, above = _look_around(given, grid.values, at, index, count, step)
            beside = math.isfinite(given[REACH - 1]) or math.isfinite(given[REACH + 1])
            sides = (1 if below > 0 else 0) + (1 if above > 0 else 0) if beside else 0
            if sides == 0 or sides < most:
                continue
            if sides == 1 and below + above == BEYOND:  # as most do
                value, other = _by_weights(given, grid.beyond[a, index], 0 if below > 0 else 1)
            else:
                value, other = _by_polynomial(given, grid.nodes[a], index, sides, xs, fs)
                if math.isnan(value):
                    continue
            inherited = 0.0
            if math.isfinite(given[REACH - 1]):
                inherited = max(inherited, grid.doubts[at - step])
            if math.isfinite(given[REACH + 1]):
                inherited = max(inherited, grid.doubts[at + step])
            many = many if sides == most else 0
            most, doubt = sides, abs(value - other) + inherited
            found_along[many], weights[many] = value, 1.0 / (doubt * doubt + LEAST)
            many += 1
        numbers[k], doubts[k] = weighed(found_along, weights, many)


@kernel
def weighed(numbers, weights, many):
    """The mean of numbers with weights, inverse squares of what they may be off, and how far it may be off."""
    whole, total, spread = 0.0, 0.0, 0.0
    for j in range(many):
        whole += weights[j]
        total += weights[j] * numbers[j]
    mean = total / whole if many > 0 else math.nan
    for j in range(many):
        spread += weights[j] * (numbers[j] - mean) ** 2
    return mean, math.sqrt(many / whole) + math.sqrt(spread / whole) if many > 0 else 0.0


def weights_beyond(nodes, shape):
    """Weights (d, n, 2, 2, BEYOND) of the nearest nodes below a node of each axis, and above, from near to far: of the
    polynomial through them all, and without the farthest.
    """
    found = np.zeros((*nodes.shape, 2, 2, BEYOND))
    for a, count in enumerate(shape):
        for index, side, out in product(range(count), (0, 1), (0, 1)):
            near = index + np.arange(1, BEYOND + 1 - out) * (1 if side else -1)
            if 0 <= near[-1] < count:
                found[a, index, side, out, : BEYOND - out] = lagrange(nodes[a, near], nodes[a, index])
    return found


@entry_point
def with_numbers_beside(values, holes, shape, strides, seen, found):
    """Put those of ``holes`` (k,) that lie beside nodes with numbers into ``found`` (nodes,), and mark them as ``seen``
    (nodes,); returns how many.
    """
    many = 0
    for k in range(len(holes)):
        beside, at = False, holes[k]
        for a in range(len(shape)):
            index, step = (at // strides[a]) % shape[a], strides[a]
            beside = beside or (index > 0 and math.isfinite(values[at - step]))
            beside = beside or (index + 1 < shape[a] and math.isfinite(values[at + step]))
        if beside:
            seen[at] = True
            found[many] = at
            many += 1
    return many


@entry_point
def beside_numbers(values, around, shape, strides, seen, found):
    """Put the nodes without numbers that lie beside nodes ``around`` (k,), and were not ``seen`` (nodes,) before, into
    ``found`` (nodes,); returns how many.
    """
    many = 0
    for k in range(len(around)):
        for a in range(len(shape)):
            index = (around[k] // strides[a]) % shape[a]
            for side in (-1, 1):
                at = around[k] + side * strides[a]
                if 0 <= index + side < shape[a] and not seen[at] and not math.isfinite(values[at]):
                    seen[at] = True
                    found[many] = at
                    many += 1
    return many


def fill(values, shape, strides, nodes, beyond=None):
    """Put numbers on the NaN of ``values`` (nodes,) that lie beside numbers; returns how doubtful each is (nodes,).

    ``beyond``: :func:`weights_beyond` of the axes, where it is known.
    """
    doubt, holes = np.zeros(len(values), np.float32), np.flatnonzero(~np.isfinite(values))
    if len(holes) in (0, len(values)):
        return doubt
    beyond = weights_beyond(nodes, shape) if beyond is None else beyond
    seen, beside = np.zeros(len(values), bool), np.empty(len(holes), np.int64)
    bad = beside[: with_numbers_beside(values, holes, shape, strides, seen, beside)].copy()
    grid = Holed(values, doubt, shape, strides, nodes, beyond)
    for _ in range(SWEEPS):
        if not len(bad):
            break
        numbers, doubts = np.empty((2, len(bad)))
        fill_once(grid, bad, numbers, doubts)
        put = np.isfinite(numbers)
        new, left = bad[put], bad[~put]
        values[new], doubt[new] = numbers[put], doubts[put]
        bad = np.concatenate([left, beside[: beside_numbers(values, new, shape, strides, seen, beside)]])
    return doubt


@kernel
def _common(code, other):
    """The code that two nodes share: an inaccurate one makes both inaccurate; MIXED if there is none."""
    if code == other:
        return code
    if code != MIXED and other != MIXED and code >> 4 == other >> 4:
        if (code & 15 == OK or code & 15 == INACCURATE) and (other & 15 == OK or other & 15 == INACCURATE):
            return code & 240 | INACCURATE
    return MIXED


def cell_codes(codes, shape, labels):
    """Common code of the nodes at each cell's corners, (nodes,) as ``codes``, MIXED where they differ."""
    cells = codes.reshape(shape).copy()
    for a in np.flatnonzero(~np.asarray(labels)):
        here, other = np.moveaxis(cells, a, 0)[:-1], np.moveaxis(cells, a, 0)[1:]
        apart = here != other
        if apart.any():
            one, two = here[apart], other[apart]
            states = [(code & 15 == OK) | (code & 15 == INACCURATE) for code in (one, two)]
            alike = (one != MIXED) & (two != MIXED) & (one >> 4 == two >> 4) & states[0] & states[1]
            here[apart] = np.where(alike, one & 240 | INACCURATE, MIXED)
    return cells.ravel()


@kernel
def corner_code(codes, cells, which, strides, pieces, shares, k, cell):
    """Code of the nodes that located point k lies between; MIXED where they differ. ``codes`` and ``cells``: (2, nodes)."""
    d, inside = len(strides), True
    for a in range(d):
        inside = inside and 0.0 < shares[k, a] < 1.0
    code = np.int64(cells[which, cell])
    if inside or code != MIXED:
        return code
    first = True
    for corner in range(1 << d):
        i, used = cell, True
        for a in range(d):
            up = corner >> a & 1
            used = used and shares[k, a] != (0.0 if up == 1 else 1.0)
            i += up * strides[a]
        if used:
            other = np.int64(codes[which, i])
            code = other if first else _common(code, other)
            first = False
    return code

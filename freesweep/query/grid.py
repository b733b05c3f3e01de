"""The points of a grid, slab by slab along its first axis, without a list of all of them."""

import math
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..jit import entry_point, kernel
from .axis import LABEL
from .reference import ALPHA, BETA, COLUMNS, FIBERS, HELD, LENGTH, PRESSURE, RADIUS, WALL, end_effect, reference


class GridPoints:
    """Points of a grid over ``axes``; ``columns`` (d,) says where in a point an axis goes, -1: nowhere.

    ``fixed`` (designs, 17): what the grid fixes; ``fiber_share``: see :func:`.locate.place`; ``by_length``:
    whether what is held is given as a length.
    """

    def __init__(self, axes, columns, fixed, fiber_share, by_length):
        self.axes, self.columns, self.fixed = axes, columns, fixed
        self.fiber_share, self.by_length = fiber_share, by_length
        self.shape = tuple(len(axis.nodes) for axis in axes)

    def slabs(self):
        """Points (slab, 17) of each slab in turn."""
        return (self.slab(k) for k in range(self.shape[0]))

    def slab(self, k):
        """Points (slab, 17) of one slab."""
        points = np.empty((*self.shape[1:], len(COLUMNS)))
        points[...] = self.fixed[k if self.axes[0].kind == LABEL else 0]
        for a, (axis, column) in enumerate(zip(self.axes, self.columns)):
            if column >= 0:
                along = [-1 if other == a else 1 for other in range(1, len(self.shape))]
                points[..., column] = axis.values[k] if a == 0 else axis.values.reshape(along)
        if self.fiber_share >= 0.0:
            inside = self.fiber_share * points[..., WALL] if self.fiber_share > 0.0 else 0.0
            points[..., FIBERS] = points[..., RADIUS] + inside
        if self.by_length:
            points[..., HELD] /= points[..., LENGTH]
        return points.reshape(-1, len(COLUMNS))


class GridStates:
    """Uniform states of a grid, made and kept once for axes that they do not vary with (``without``)."""

    def __init__(self, points: GridPoints, kind, predictor, without):
        axes = [
            axis for axis, column in zip(points.axes, points.columns) if column < 0 or COLUMNS[column] not in without
        ]
        columns = [column for column in points.columns if column < 0 or COLUMNS[column] not in without]
        self.shape = tuple(n if c < 0 or COLUMNS[c] not in without else 1 for n, c in zip(points.shape, points.columns))
        fixed = points.fixed.copy()
        for axis, column in zip(points.axes, points.columns):
            if column >= 0 and COLUMNS[column] in without:
                fixed[:, column] = axis.values[0]
        own = GridPoints(axes, columns, fixed, points.fiber_share, points.by_length)
        first = predictor.states(kind, own.slab(0))
        states = np.empty((own.shape[0], *first.shape))

        def solve(k):
            states[k] = predictor.states(kind, own.slab(k)) if k > 0 else first

        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            list(pool.map(solve, range(own.shape[0])))
        self.states = states.reshape(*self.shape, first.shape[1])
        self.points, self.whole = points, points.shape

    def slab(self, k):
        """States (slab, UNIFORM) of one slab of the whole grid."""
        states = self.states[min(k, self.shape[0] - 1)]
        width = states.shape[-1]
        return np.ascontiguousarray(np.broadcast_to(states, (*self.whole[1:], width))).reshape(-1, width)

    def end_effects(self, variable, kind, terms, stored, errors, good, apart, effects, noise):
        """Stored numbers (nodes,) and their bounds as end effects and their bounds; NaN and 0 where nodes are not ``good``,
        or where both angles are one, though they are to be ``apart``.

        ``terms`` (nodes, 3) are those of :func:`reference.reference`, (0, 3) where they are to be found.
        """
        points, d = self.points, len(self.whole)
        values = np.zeros((d, max(self.whole)))
        for own, axis in zip(values, points.axes):
            own[: len(axis.values)] = axis.values
        steps = [int(np.prod(self.shape[a + 1 :])) if self.shape[a] > 1 else 0 for a in range(d)]
        of_axes = values, np.array(points.columns, np.int64), np.array(self.whole, np.int64), np.array(steps, np.int64)
        of_points = points.fixed, points.axes[0].kind == LABEL, float(points.fiber_share), bool(points.by_length)
        # arrays that may not be written to, as those of a file, are a type of their own
        stored, errors = (np.require(array, requirements="W") for array in (stored, errors))
        states = self.states.reshape(-1, self.states.shape[-1])
        _end_effects(variable, kind, *of_axes, *of_points, states, terms, stored, errors, good, apart, effects, noise)


@entry_point
def _end_effects(
    variable, kind, values, columns, shape, steps, fixed, labelled, fiber_share, by_length, states, terms, stored, errors,
    good, apart, effects, noise,
):  # fmt: skip
    index, point = np.zeros(len(shape), np.int64), np.empty(fixed.shape[1])
    last = len(shape) - 1
    column = columns[last]  # what else of a point it changes
    alone = column != RADIUS and column != WALL and column != LENGTH and column != HELD and (last > 0 or not labelled)
    row = 0
    for k in range(len(stored)):
        effects[k], noise[k] = math.nan, 0.0
        if index[last] == 0 or not alone:
            row = put(point, index, values, columns, steps, fixed, labelled, fiber_share, by_length)
        else:
            row += steps[last]
            if column >= 0:
                point[column] = values[last, index[last]]
        if good[k] and not (apart and point[ALPHA] == point[BETA]):
            if len(terms) > 0:
                term = terms[k, 0], terms[k, 1], terms[k, 2]
            else:
                term = reference(variable, point, states[row])
            args = point[PRESSURE], states[row, 0], states[row, 3], term, stored[k], errors[k]
            effects[k], noise[k] = end_effect(variable, kind, *args)
        a = last
        index[a] += 1
        while index[a] == shape[a] and a > 0:
            index[a] = 0
            a -= 1
            index[a] += 1


@kernel
def put(point, index, values, columns, steps, fixed, labelled, fiber_share, by_length):
    """Put into ``point`` (17,) the node with an ``index`` along each axis; returns which uniform state is its own."""
    row, design = 0, index[0] if labelled else 0
    for i in range(len(point)):
        point[i] = fixed[design, i]
    for a in range(len(index)):
        row += steps[a] * index[a]
        if columns[a] >= 0:
            point[columns[a]] = values[a, index[a]]
    if fiber_share >= 0.0:
        point[FIBERS] = point[RADIUS] + (fiber_share * point[WALL] if fiber_share > 0.0 else 0.0)
    if by_length:
        point[HELD] /= point[LENGTH]
    return row

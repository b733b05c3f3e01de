"""The points of a grid, slab by slab along its first axis, without a list of all of them."""

import math
import os
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from ..jit import entry_point, kernel
from .axis import LABEL
from .fixed import Fixed, complete
from .reference import ALPHA, BETA, COLUMNS, FIBERS, HELD, LENGTH, PRESSURE, RADIUS, WALL, end_effect, reference


class GridPoints:
    """Points of a grid over ``axes``; ``columns`` (d,) says where in a point an axis goes, -1: nowhere; ``fixed``: what the
    grid fixes.
    """

    def __init__(self, axes, columns, fixed: Fixed):
        self.axes, self.columns, self.fixed = axes, columns, fixed
        self.shape = tuple(len(axis.nodes) for axis in axes)

    def slabs(self):
        """Points (slab, 17) of each slab in turn."""
        return (self.slab(k) for k in range(self.shape[0]))

    def slab(self, k):
        """Points (slab, 17) of one slab."""
        points = np.empty((*self.shape[1:], len(COLUMNS)))
        points[...] = self.fixed.numbers[k if self.axes[0].kind == LABEL else 0]
        for a, (axis, column) in enumerate(zip(self.axes, self.columns)):
            if column >= 0:
                along = [-1 if other == a else 1 for other in range(1, len(self.shape))]
                points[..., column] = axis.values[k] if a == 0 else axis.values.reshape(along)
        share = self.fixed.fiber_share
        if share >= 0.0:
            inside = share * points[..., WALL] if share > 0.0 else 0.0
            points[..., FIBERS] = points[..., RADIUS] + inside
        if self.fixed.by_length:
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
        fixed = points.fixed.numbers.copy()
        for axis, column in zip(points.axes, points.columns):
            if column >= 0 and COLUMNS[column] in without:
                fixed[:, column] = axis.values[0]
        own = GridPoints(axes, columns, points.fixed._replace(numbers=fixed))
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

    def end_effects(self, variable, kind, stored, apart, effects, noise):
        """Numbers that are :class:`Stored`, and their bounds, as end effects and their bounds (nodes,); NaN and 0 where
        nodes are not good, or where both angles are one, though they are to be ``apart``.
        """
        points, d = self.points, len(self.whole)
        values = np.zeros((d, max(self.whole)))
        for own, axis in zip(values, points.axes):
            own[: len(axis.values)] = axis.values
        steps = [int(np.prod(self.shape[a + 1 :])) if self.shape[a] > 1 else 0 for a in range(d)]
        integers = (np.array(each, np.int64) for each in (points.columns, self.whole, steps))
        axes = Axes(values, *integers, points.axes[0].kind == LABEL)
        # arrays that may not be written to, as those of a file, are a type of their own
        numbers, errors = (np.require(array, requirements="W") for array in (stored.numbers, stored.errors))
        stored = stored._replace(numbers=numbers, errors=errors)
        states = self.states.reshape(-1, self.states.shape[-1])
        _end_effects(variable, kind, axes, points.fixed, states, stored, apart, effects, noise)


class Axes(NamedTuple):
    """Axes of a grid: ``values`` (d, n), ``columns`` (d,) of a point, the ``shape`` (d,), and by how many uniform states a
    node is from the next one, ``steps`` (d,); whether the first axis is that of designs with names.
    """

    values: np.ndarray
    columns: np.ndarray
    shape: np.ndarray
    steps: np.ndarray
    labelled: bool


class Stored(NamedTuple):
    """What is stored at nodes (nodes,): ``numbers``, their bounds ``errors``, whether they are ``good``; and ``terms``
    (nodes, 3), those of :func:`reference.reference`, (0, 3) where they are to be found.
    """

    numbers: np.ndarray
    errors: np.ndarray
    good: np.ndarray
    terms: np.ndarray


@entry_point
def _end_effects(variable, kind, axes, fixed, states, stored, apart, effects, noise):
    shape = axes.shape
    index, point = np.zeros(len(shape), np.int64), np.empty(fixed.numbers.shape[1])
    last = len(shape) - 1
    column = axes.columns[last]  # what else of a point it changes
    alone = (
        column != RADIUS and column != WALL and column != LENGTH and column != HELD and (last > 0 or not axes.labelled)
    )
    row = 0
    for k in range(len(stored.numbers)):
        effects[k], noise[k] = math.nan, 0.0
        if index[last] == 0 or not alone:
            row = put(point, index, axes, fixed)
        else:
            row += axes.steps[last]
            if column >= 0:
                point[column] = axes.values[last, index[last]]
        if stored.good[k] and not (apart and point[ALPHA] == point[BETA]):
            if len(stored.terms) > 0:
                term = stored.terms[k, 0], stored.terms[k, 1], stored.terms[k, 2]
            else:
                term = reference(variable, point, states[row])
            args = point[PRESSURE], states[row, 0], states[row, 3], term, stored.numbers[k], stored.errors[k]
            effects[k], noise[k] = end_effect(variable, kind, *args)
        a = last
        index[a] += 1
        while index[a] == shape[a] and a > 0:
            index[a] = 0
            a -= 1
            index[a] += 1


@kernel
def put(point, index, axes, fixed):
    """Put into ``point`` (17,) the node with an ``index`` along each axis; returns which uniform state is its own."""
    row, design = 0, index[0] if axes.labelled else 0
    for i in range(len(point)):
        point[i] = fixed.numbers[design, i]
    for a in range(len(index)):
        row += axes.steps[a] * index[a]
        if axes.columns[a] >= 0:
            point[axes.columns[a]] = axes.values[a, index[a]]
    complete(point, fixed)
    return row

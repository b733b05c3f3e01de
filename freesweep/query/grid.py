"""The points of a grid, slab by slab along its first axis, without a list of all of them."""

import numpy as np

from .axis import LABEL
from .reference import COLUMNS, FIBERS, HELD, LENGTH, RADIUS, WALL


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
        """Points (slab, 17) of each slab in turn, in an array that is used again."""
        points = np.empty((*self.shape[1:], len(COLUMNS)))
        for k in range(self.shape[0]):
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
            yield points.reshape(-1, len(COLUMNS))


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
        found = [predictor.states(kind, slab) for slab in own.slabs()]
        self.states = np.concatenate(found).reshape(*self.shape, found[0].shape[1])
        self.whole = points.shape

    def slab(self, k):
        """States (slab, UNIFORM) of one slab of the whole grid."""
        states = self.states[min(k, self.shape[0] - 1)]
        width = states.shape[-1]
        return np.ascontiguousarray(np.broadcast_to(states, (*self.whole[1:], width))).reshape(-1, width)

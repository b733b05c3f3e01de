"""The uniform tube and the end effects at all nodes of a grid, without a list of its points.

``grid``: what is fixed (designs, 15), the column of each axis (LABELS, or -1 for none), its values (d, n), its count (d,),
whether the fibers lie at the inner radius, whether HELD is given as a length. Labels come first.
"""

import numpy as np

from ..jit import entry_point, kernel
from .reference import COLUMNS, FIBERS, HELD, LENGTH, RADIUS, UNIFORM, end_effect, uniform

LABELS = -2  # column of an axis of labels


@kernel
def _next_node(index, shape):
    """Count ``index`` (d,) on by one in C order; returns the first axis that changed."""
    axis = len(shape) - 1
    index[axis] += 1
    while axis > 0 and index[axis] == shape[axis]:
        index[axis] = 0
        axis -= 1
        index[axis] += 1
    return axis


@kernel
def _put_node(grid, index, first, point):
    """Put what the axes from ``first`` on hold at a node into ``point`` (15,)."""
    fixed, columns, values, _, inner, by_length = grid
    if first == 0 or by_length:
        label = 0
        for a in range(len(columns)):
            if columns[a] == LABELS:
                label = index[a]
        for k in range(len(point)):
            point[k] = fixed[label, k]
    for a in range(0 if by_length else first, len(columns)):
        if columns[a] >= 0:
            point[columns[a]] = values[a, index[a]]
    if inner:
        point[FIBERS] = point[RADIUS]
    if by_length:
        point[HELD] /= point[LENGTH]


@entry_point
def grid_states(kind, grid, shear, out):
    """:func:`uniform` at all nodes of a grid into ``out`` (nodes, UNIFORM)."""
    shape = grid[3]
    index, point, first = np.zeros(len(shape), np.int64), np.empty(len(COLUMNS)), 0
    for at in range(len(out)):
        _put_node(grid, index, first, point)
        uniform(kind, point, shear, out[at])
        first = _next_node(index, shape)


@entry_point
def grid_effects(variable, kind, grid, states, strides, stored, errors, effects, noise):
    """:func:`end_effects` at all nodes of a grid; ``states`` has ``strides`` (d,) of its own, 0 along axes it lacks."""
    shape = grid[3]
    index, point, first = np.zeros(len(shape), np.int64), np.empty(len(COLUMNS)), 0
    state = np.empty(UNIFORM)
    for at in range(len(stored)):
        _put_node(grid, index, first, point)
        own = 0
        for a in range(len(shape)):
            own += index[a] * strides[a]
        for k in range(UNIFORM):
            state[k] = states[own, k]
        effects[at], noise[at] = end_effect(variable, kind, point, state, stored[at], errors[at])
        first = _next_node(index, shape)

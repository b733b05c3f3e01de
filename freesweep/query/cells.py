"""What each cell knows of its neighbourhood: bounds of what is stored there, how rough it is, whether it has holes.

``axes`` are (count, step) of the axes along which cells extend, labels apart; a cell has the index of its first node.
"""

import math

import numpy as np

from ..jit import entry_point
from .axis import WINDOW

WEIGHT = np.float32(0.1)  # largest weight of a node beside a piece in its slopes


def worst_noise(noise, axes):
    """Largest bound of the end effects at each cell's corners, and WEIGHT of those beside it, (nodes,) each."""
    cells = noise.astype(np.float32)
    for count, step in axes:
        before = cells.reshape(-1, count, step)
        after = before.copy()
        np.maximum(after[:, :-1], before[:, 1:], out=after[:, :-1])
        np.maximum(after[:, 1:-1], WEIGHT * before[:, :-2], out=after[:, 1:-1])
        np.maximum(after[:, :-2], WEIGHT * before[:, 2:], out=after[:, :-2])
        cells = after.ravel()
    return cells


@entry_point
def _remainders(values, count, step, first, remainder, out):
    """Size of what the next order would add in the middle of each piece along one axis (nodes,); infinite where unknown."""
    size, row = min(WINDOW, count), np.empty(step)
    for block in range(len(values) // (count * step)):
        for piece in range(count):
            row[:] = 0.0
            if piece + 1 < count:
                for j in range(size):
                    weight, there = remainder[piece, j], (block * count + first[piece] + j) * step
                    for k in range(step):
                        row[k] += weight * values[there + k]
            at = (block * count + piece) * step
            for k in range(step):
                out[at + k] = abs(row[k]) if math.isfinite(row[k]) else math.inf


def roughness(values, axes, axis, first, remainder):
    """Largest remainder along one of ``axes``, in the middle of its pieces, over each cell and the next to it.

    ``values`` (nodes,) with holes filled; returns (nodes,), infinite where unknown.
    """
    rough = np.empty(len(values), np.float32)
    _remainders(values, *axes[axis], first, remainder, rough)
    for other, (count, step) in enumerate(axes):
        if other != axis:
            _over_corners(rough, count, step)
    count, step = axes[axis]
    own = rough.reshape(-1, count, step)
    worst = own.copy()
    np.maximum(worst[:, 1:], own[:, :-1], out=worst[:, 1:])
    np.maximum(worst[:, :-2], own[:, 1:-1], out=worst[:, :-2])
    return worst.ravel()


def beside_holes(bad, axes, firsts):
    """Cells (nodes,) whose corners or slopes look at nodes that had no number; ``firsts``: where windows begin."""
    near = np.zeros(len(bad), bool)
    for axis, (count, step) in enumerate(axes) if bad.any() else ():
        nodes, reached = bad.reshape(-1, count, step), np.zeros(len(bad), bool)
        pieces = reached.reshape(-1, count, step)
        for piece in range(count - 1):
            first = firsts[axis][piece]
            np.any(nodes[:, first : first + WINDOW], axis=1, out=pieces[:, piece])
        for other, extent in enumerate(axes):
            if other != axis:
                _over_corners(reached, *extent)
        near |= reached
    return near


def _over_corners(numbers, count, step):
    """Put into each cell the larger of its two nodes along one axis."""
    nodes = numbers.reshape(-1, count, step)
    np.maximum(nodes[:, :-1], nodes[:, 1:], out=nodes[:, :-1])


@entry_point
def put_column(numbers, column, cells):
    """Numbers (nodes,) into one column of what is known of each cell."""
    for k in range(len(cells)):
        cells[k, column] = numbers[k]

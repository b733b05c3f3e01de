"""What each cell knows of its neighbourhood: bounds of what is stored there, how rough it is, whether it has holes.

A cell has the index of its first node. What is known of it lies in one row of (nodes, ROUGH + d). Grids are gone through
slab by slab along the first axis, as much as a cache holds; an extent is (count, step) of an axis within a slab.
"""

import numpy as np

from .axis import LABEL, WINDOW, extrapolation
from .missing_nodes import weigh
from .phases import remainders_within

NOISE, BESIDE, DOUBT, ROUGH = range(4)  # columns of what is known of a cell; one of roughness for each axis
KINK = (0.25, 0.04, 0.01)  # of a change of slope times the width: what cubics miss in its piece, and one and two beside
WEIGHT = np.float32(0.1)  # largest weight of a node beside a piece in its slopes


def describe(values, noise, doubt, bad, phases, axes, stored):
    """What is known of all cells (nodes, ROUGH + d) of a grid over ``axes``.

    ``values`` (nodes,) are end effects, holes filled; ``noise`` (nodes,) their bounds; ``doubt`` (nodes,) how far numbers
    that were put in may be off; ``bad`` (nodes,) marks nodes that had none; ``phases`` (nodes,) are alike where numbers are
    smooth, or None if they are everywhere. ``stored`` (2, nodes) are the slopes along the two inner axes.
    """
    shape = [len(axis.nodes) for axis in axes]
    slabs, size = shape[0], len(values) // shape[0]
    kept = {a: (shape[a], int(np.prod(shape[a + 1 :]))) for a in range(len(axes)) if axes[a].kind != LABEL}
    inner = {a: extent for a, extent in kept.items() if a > 0}
    own = np.zeros((ROUGH + len(axes), slabs, size), np.float32)
    first_reached = np.zeros((slabs, size), bool)
    if 0 in kept:
        _remainders(values, axes[0], kept[0], own[ROUGH].reshape(-1))
        if phases is not None:
            _kinks(values, np.zeros(len(values), bool), phases, axes[0], kept[0], own[ROUGH].reshape(-1))
        _reach(bad, kept[0], axes[0].first, first_reached.reshape(-1))
    for slab in range(slabs):
        here = slice(slab * size, (slab + 1) * size)
        own[NOISE, slab], own[DOUBT, slab] = noise[here], doubt[here]
        for extent in inner.values():
            _weigh_beside(own[NOISE, slab], extent)
            _over_corners(own[DOUBT, slab], extent)
            _over_corners(first_reached[slab], extent)
        own[BESIDE, slab] = _reached(bad[here], inner, axes)
        for a in kept:
            rough = own[ROUGH + a, slab]
            if a > 0:
                _remainders(values[here], axes[a], inner[a], rough)
                within = np.zeros(size, bool)
                if phases is not None and a >= len(axes) - len(stored):
                    slopes = stored[a - len(axes)][here]
                    remainders_within(values[here], slopes, phases[here], axes[a].nodes, inner[a][1], rough, within)
                _smooth_over(rough, inner[a])
                if phases is not None:
                    _kinks(values[here], within, phases[here], axes[a], inner[a], rough)
            for extent in (extent for other, extent in inner.items() if other != a):
                _over_corners(rough, extent)
    if 0 in kept:
        _weigh_beside(own[NOISE], kept[0])
        _smooth_over(own[ROUGH], kept[0])
        for column in (BESIDE, DOUBT, *(ROUGH + a for a in inner)):
            _over_corners(own[column], kept[0])
        own[BESIDE] += first_reached
    if phases is not None:
        own[BESIDE] += _differ(phases.reshape(shape), kept).reshape(slabs, size)
    cells = np.empty((slabs, size, len(own)), np.float32)
    for slab in range(slabs):
        cells[slab] = own[:, slab].T
    return cells.reshape(-1, len(own))


def _remainders(values, axis, extent, rough):
    """Size of what the next order would add in the middle of each piece along one axis (nodes,); infinite where unknown."""
    out = np.empty(len(values))
    weigh(values, *extent, axis.first, axis.remainder, out)
    np.abs(out, out=out)
    rough[:] = np.where(out < np.inf, out, np.inf)


def _kinks(values, within, phases, axis, extent, rough):
    """Where phases (nodes,) change along one axis, at least what a kink leaves there, and in the pieces that it reaches: not
    those that know nodes ``within`` their phase only.
    """
    nodes = phases.reshape(-1, *extent)
    changes = nodes[:, :-1] != nodes[:, 1:]
    if not changes.any():
        return
    jump, part = np.zeros(len(values)), np.empty(len(values))
    for weights in extrapolation(axis):
        weigh(values, *extent, axis.first, weights, part)
        jump += np.abs(part)
    pieces = rough.reshape(-1, *extent)[:, :-1]
    jump = np.where(changes, np.where(jump < np.inf, jump, np.inf).reshape(-1, *extent)[:, :-1], 0.0)
    np.maximum(pieces, KINK[0] * jump, out=pieces)
    reached = ~within.reshape(-1, *extent)[:, :-1]
    for apart, share in enumerate(KINK[1:], 1):
        for to, by in ((slice(apart, None), slice(None, -apart)), (slice(None, -apart), slice(apart, None))):
            np.maximum(pieces[:, to], np.where(reached[:, to], share * jump[:, by], 0.0), out=pieces[:, to])


def _over_corners(numbers, extent):
    """Put into each cell the larger of its two nodes along one axis."""
    nodes = numbers.reshape(-1, *extent)
    np.maximum(nodes[:, :-1], nodes[:, 1:], out=nodes[:, :-1])


def _weigh_beside(numbers, extent):
    """The same, and WEIGHT of the nodes beside the cell."""
    nodes = numbers.reshape(-1, *extent)
    before = nodes.copy()
    np.maximum(nodes[:, :-1], before[:, 1:], out=nodes[:, :-1])
    np.maximum(nodes[:, 1:-1], WEIGHT * before[:, :-2], out=nodes[:, 1:-1])
    np.maximum(nodes[:, :-2], WEIGHT * before[:, 2:], out=nodes[:, :-2])


def _smooth_over(rough, extent):
    """A remainder may vanish by chance in one piece: it is no less than in both beside it.

    Not the larger of those: a coarse or wild piece says nothing of a fine one beside it.
    """
    pieces = rough.reshape(-1, *extent)[:, :-1]
    if pieces.shape[1] < 2:
        return
    before = pieces.copy()
    np.maximum(before[:, :1], before[:, 1:2], out=pieces[:, :1])
    np.maximum(before[:, -1:], before[:, -2:-1], out=pieces[:, -1:])
    np.maximum(before[:, 1:-1], np.minimum(before[:, :-2], before[:, 2:]), out=pieces[:, 1:-1])


def _reached(bad, extents, axes):
    """Cells (nodes,) whose corners or slopes look at nodes that had no number, along the axes of some extents."""
    near = np.zeros(len(bad), bool)
    for axis in extents if bad.any() else ():
        reached = np.zeros(len(bad), bool)
        _reach(bad, extents[axis], axes[axis].first, reached)
        for extent in (extent for other, extent in extents.items() if other != axis):
            _over_corners(reached, extent)
        near |= reached
    return near


def _differ(phases, axes):
    """Cells whose corners are not of one phase, shape as ``phases``."""
    least, most = phases.copy(), phases.copy()
    for a in axes:
        for kept, choose in ((least, np.minimum), (most, np.maximum)):
            nodes = np.moveaxis(kept, a, 0)
            choose(nodes[:-1], nodes[1:], out=nodes[:-1])
    return least != most


def _reach(bad, extent, first, reached):
    """Cells (nodes,) whose window along one axis holds a node that had no number."""
    nodes, pieces = bad.reshape(-1, *extent), reached.reshape(-1, *extent)
    for piece in range(extent[0] - 1):
        np.any(nodes[:, first[piece] : first[piece] + WINDOW], axis=1, out=pieces[:, piece])

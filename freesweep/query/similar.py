"""Locked tubes know one length only, their own over the radius of their fibers: what clamped ends add to one is what they
add to a tube that is larger all over.

So a grid over lengths and radii holds locked tubes of many more lengths than it has nodes. A point is looked for at that
node of the radius at which a similar tube lies nearest to a node of the length, and nothing is interpolated along the
radius. A thick wall's energy alone knows another length, its own thickness.
"""

import copy

import numpy as np

from . import reference
from .spline import RANK

SIZES = ("length", "radius")


def similar_names(frame, family) -> tuple:
    """Names of the variables of a family that similar tubes share; none, where no axes but those of SIZES tell of sizes, or
    where these are not both there.
    """
    names = frame.axes_of(family.variables)
    others = {"wall", "fiber_radius", "design"} & set(names)
    if family.kind != reference.LOCKED or frame.bodies is not None or frame.fiber_share < 0.0 or others:
        return ()
    if not set(SIZES) <= set(names):
        return ()
    thick = frame.model.is_thick
    return tuple(name for name, kind in family.variables.items() if not (thick and kind == reference.ENERGY))


def at_similar(inquiry):
    """The inquiry (:class:`.answer.Inquiry`) at tubes that are similar to those asked for."""
    table, points = inquiry.table, inquiry.points
    of_length, of_radius = (table.names.index(name) for name in SIZES)
    axis, radii = table.axes[of_length], table.axes[of_radius].values
    inside = table.frame.fiber_share * points[:, reference.WALL] if table.frame.fiber_share > 0.0 else 0.0
    surfaces = radii + np.broadcast_to(inside, len(points))[:, None]
    lengths = points[:, reference.LENGTH, None] * surfaces / points[:, reference.FIBERS, None]  # (n, radii)
    at = axis.forward(lengths)
    piece = np.clip(np.searchsorted(axis.nodes, at, side="right") - 1, 0, len(axis.nodes) - 2)
    width = np.diff(axis.nodes)[piece]
    share = (at - axis.nodes[piece]) / width
    there = (share >= 0.0) & (share <= 1.0)
    far = np.where(there, np.minimum(share, 1.0 - share) * width, np.inf)
    best = np.argmin(far, axis=1)
    found, rows = np.isfinite(far.min(axis=1)), np.arange(len(points))

    moved = copy.copy(inquiry)
    moved.pieces, moved.shares = inquiry.pieces.copy(), inquiry.shares.copy()
    last = best == len(radii) - 1
    for own, new_piece, new_share in (
        (of_length, piece[rows, best], share[rows, best]),
        (of_radius, np.where(last, best - 1, best), np.where(last, 1.0, 0.0)),
    ):
        moved.pieces[found, own], moved.shares[found, own] = new_piece[found], new_share[found]
    moved.cell = moved.pieces @ table.strides
    moved.ranks = table.knots[np.arange(len(table.axes)), moved.pieces, RANK].astype(np.int64)
    return moved

"""Where along a tube stations lie: before, on or behind the places where its profiles jump or bend."""

import numpy as np

from .families import given_by
from .profiles import places_of

ROUNDED = 1e-12  # of the length: stations no farther from a place lie on it
BEFORE = 1e-13  # of the length: how far before a place what lies on it counts


def breaks_of(tube):
    """Places x/l where the profile of an angle, the wall or the radius jumps or bends, and both ends, (n,)."""
    if not tube.varies:
        return np.array([0.0, 1.0])
    names = (*given_by(tube), "wall", "radius") if tube.is_body else (*given_by(tube), "wall")
    return places_of(*(tube.profile(name) for name in names))


def shares_of(tube, stations):
    """Shares x/l of ``stations`` [m]. One on a jump belongs to what is before it; rounding would give what is told of it
    from both sides, so it counts as just before.
    """
    shares = stations / tube.length
    inner = breaks_of(tube)[1:-1]
    if not len(inner):
        return shares
    nearest = inner[np.argmin(np.abs(shares[..., None] - inner), axis=-1)]
    return np.where(np.abs(shares - nearest) <= ROUNDED, nearest - BEFORE, shares)

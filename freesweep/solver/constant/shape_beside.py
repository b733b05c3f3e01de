"""The tube whose middle is close to a given one: by the meridian from that middle, where no uniform tube leads to it.

At a given load each middle belongs to one half length x; a stable tube's grows with its middle.
"""

from math import sqrt

import numpy as np

from ...jit import kernel
from ..physics import lagrangian
from . import meridian

LEAST_SCALE = 1e-12  # of the way from end to middle
NEAREST, FARTHEST, WIDER = 1e-12, 2e-3, 10.0  # relative: how far from a middle another one is looked for
LOOKS, JUST_INSIDE = 32, 1e-9  # middles that are looked at; relative
STATIONARY_STEPS, SETTLED = 20, 1e-13


@kernel
def is_near(one, other):
    """Whether two middles may be those of one branch, at loads close to each other."""
    return abs(one - other) < FARTHEST * other


@kernel
def stationary(cell, load, near):
    """The uniform stretch that a long tube whose middle is ``near`` approaches; NaN if there is none close to it."""
    u = near
    for _ in range(STATIONARY_STEPS):
        room, L_y, _, L_yy, _, _ = lagrangian.density(u, 0.0, cell, load)
        change = -L_y / L_yy
        if not (room > 0.0 and L_yy < 0.0 and is_near(u + change, near)):
            break
        u += change
        if abs(change) < SETTLED * u:
            return u
    return np.nan


@kernel
def beyond(cell, load, middle, half, nodes, crowding, curve):
    """By how much of ``half`` x of a given ``middle`` lies beyond it: infinite where the middle is no tube's."""
    sign, reach = 1.0 if middle >= 1.0 else -1.0, abs(middle - 1.0)
    _, L_y, _, L_yy, _, _ = lagrangian.density(middle, 0.0, cell, load)
    drive = sign * L_y
    if not (drive > 0.0 and reach > 0.0):
        return np.inf
    scale = max(min(drive / -L_yy, reach) if L_yy < 0.0 else reach, LEAST_SCALE * reach)
    total = meridian.trace(cell, load, middle, drive, 0.0, scale, nodes, crowding, curve)
    return total / half - 1.0 if total > 0.0 else np.inf


@kernel
def gives_way(cell, load, half, nodes, curve):
    """Whether the wall would have to be pushed in the middle: a compressive force and a tube drawn in let p y^2 + f vanish
    before any middle lies as far from the end as ``half``.
    """
    p, f = load.p, load.f
    if not 0.0 < -f < p:
        return False
    least = sqrt(-f / p) * (1.0 + JUST_INSIDE)
    for k in range(LOOKS):
        if beyond(cell, load, least + (1.0 - least) * k / LOOKS, half, nodes, meridian.CROWDING, curve) >= 0.0:
            return False
    return True


@kernel
def fit_near(cell, load, near, half, tolerance, nodes, crowding, curve):
    """The curve with ``half`` as x of its middle, which is close to ``near``; that middle, NaN if there is none of a stable
    tube: one whose x grows with its middle.
    """
    outward, span, miss_low, miss_high = near if near >= 1.0 else -near, NEAREST, 1.0, -1.0
    low, high = near, near
    while span < FARTHEST:
        low, high = near - span * outward, near + span * outward
        miss_low = beyond(cell, load, low, half, nodes, crowding, curve)
        miss_high = beyond(cell, load, high, half, nodes, crowding, curve)
        if miss_low < 0.0 < miss_high:
            break
        span *= WIDER
    if span >= FARTHEST:
        return np.nan
    for _ in range(meridian.ROOT_STEPS):
        at = 0.5 * (low + high)
        if miss_high < 1.0:
            at = (low * miss_high - high * miss_low) / (miss_high - miss_low)
        miss = beyond(cell, load, at, half, nodes, crowding, curve)
        if abs(miss) < tolerance:
            return at
        if miss > 0.0:
            high, miss_high, miss_low = at, miss, 0.5 * miss_low
        else:
            low, miss_low, miss_high = at, miss, 0.5 * miss_high
    return np.nan

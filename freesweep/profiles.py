"""What varies along a tube: fiber angles and wall as profiles over x/l, and the course of dimensionless numbers from them.

A profile is a list of pairs ``(x/l, value)``, linear between them, where a repeated x/l is a jump; or a callable of x/l
(array in, array out). Between the places where some profile jumps or bends, H, D and a are smooth: cubic splines on equal
pieces of each such segment, fine enough that nothing is lost.
"""

from itertools import pairwise

import numpy as np

PIECES = (16, 64, 256, 1024, 4096)  # of a segment, until the splines fit
FIT = 1e-10  # relative error of a spline that no output feels
SAMPLES = 257  # of a profile, where its values are checked
CELLS = 240  # of a base mesh, shared by its segments, LEAST_CELLS and MOST_CELLS of each
LEAST_CELLS, MOST_CELLS = 16, 48


class ProfileError(ValueError):
    """A profile that cannot be read; the message says why."""


class Profile:
    """One quantity along the tube: ``breaks`` in x/l, and its values within each segment between them."""

    def __init__(self, value):
        self.function = value if callable(value) else None
        if self.function:
            self.breaks = np.array([0.0, 1.0])
        else:
            self.x, self.values = _pairs(value)
            self.breaks = np.unique(self.x)

    def within(self, low, high, share):
        """Values at ``low + (high - low) share``, as seen from inside that interval."""
        at = low + (high - low) * np.asarray(share, float)
        if self.function:
            values = np.asarray(self.function(at), dtype=float)
            if values.shape != at.shape:
                raise ProfileError(f"the callable made shape {values.shape} of shape {at.shape}; array in, array out")
            return values
        k = np.searchsorted(self.x, 0.5 * (low + high)) - 1
        return self.values[k] + (at - self.x[k]) / (self.x[k + 1] - self.x[k]) * (self.values[k + 1] - self.values[k])

    def at(self, share):
        """Values at shares of the length; on a jump the left one."""
        share = np.atleast_1d(np.asarray(share, float))
        out = np.empty(share.shape)
        for low, high in pairwise(self.breaks):
            here = (share >= low if low == 0.0 else share > low) & (share <= high)
            out[here] = self.within(low, high, (share[here] - low) / (high - low))
        return out

    def samples(self):
        """Values at enough places to check them."""
        inner = np.linspace(0.0, 1.0, SAMPLES)
        return np.concatenate([self.within(low, high, inner) for low, high in pairwise(self.breaks)])


def _pairs(value):
    try:
        pairs = np.array([[float(x), float(y)] for x, y in value])
    except (TypeError, ValueError):
        raise ProfileError("give pairs (x/l, value), or a callable of x/l") from None
    if len(pairs) < 2 or not np.all(np.isfinite(pairs)):
        raise ProfileError("give two or more pairs (x/l, value) of finite numbers")
    x = pairs[:, 0]
    if x[0] != 0.0 or x[-1] != 1.0 or np.any(np.diff(x) < 0.0):
        raise ProfileError("x/l has to rise from 0 to 1; a repeated x/l is a jump")
    if np.any((x[2:] == x[1:-1]) & (x[1:-1] == x[:-2])) or x[0] == x[1] or x[-1] == x[-2]:
        raise ProfileError("a jump takes two pairs at one x/l, inside the tube")
    return x, pairs[:, 1]


def is_profile(value) -> bool:
    """Whether a value describes a profile rather than a number."""
    return callable(value) or isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0)


def as_profile(value) -> Profile:
    """A profile of anything that may vary, numbers included."""
    return Profile(value) if is_profile(value) else Profile([(0.0, value), (1.0, value)])


def together(first, second):
    """Values of two profiles at the same places: everywhere along the tube, both sides of each jump among them."""
    breaks = np.unique(np.concatenate([first.breaks, second.breaks]))
    inner = np.linspace(0.0, 1.0, SAMPLES)
    return tuple(
        np.concatenate([profile.within(low, high, inner) for low, high in pairwise(breaks)])
        for profile in (first, second)
    )


def course(tube):
    """``(course, edges, places)`` of a tube that varies, as the kernels take them; lengths in radii.

    Raises :class:`ProfileError` where a profile changes too fast to be followed.
    """
    alpha, beta, wall = (as_profile(value) for value in (tube.alpha, tube.beta, tube.wall))
    breaks = np.unique(np.concatenate([alpha.breaks, beta.breaks, wall.breaks, [0.5]]))

    def numbers(low, high, share):
        ta = np.tan(np.radians(alpha.within(low, high, share)))
        tb = np.tan(np.radians(beta.within(low, high, share)))
        area = ((tube.radius + wall.within(low, high, share)) ** 2 - tube.radius**2) / tube.fiber_surface**2
        return np.stack([0.5 * (ta + tb), 0.5 * (ta - tb), area])

    for pieces in PIECES:
        segments, error = zip(*(_splines(numbers, low, high, pieces) for low, high in pairwise(breaks)))
        if max(error) < FIT:
            break
    else:
        raise ProfileError(
            f"a profile changes too fast to be followed (error {max(error):.1e} with {pieces} pieces); where it jumps, give"
            " pairs with a repeated x/l"
        )
    each = min(max(2 * round(CELLS / len(segments) / 2), LEAST_CELLS), MOST_CELLS)
    edges = np.arange(len(breaks), dtype=np.int64) * each
    return np.stack(segments), edges, breaks * tube.length / tube.fiber_surface


def _splines(numbers, low, high, pieces):
    """Coefficients (pieces, 3, 4) in rising powers of one segment, and the largest relative error between the nodes."""
    from scipy.interpolate import CubicSpline

    nodes = np.arange(pieces + 1) / pieces
    spline = CubicSpline(nodes, numbers(low, high, nodes), axis=1)
    between = nodes[:-1] + 0.37 / pieces
    exact = numbers(low, high, between)
    scale = np.max(np.abs(exact), axis=1, keepdims=True) + 1e-6
    error = float(np.max(np.abs(spline(between) - exact) / scale))
    powers = spline.c[::-1] * (1.0 / pieces) ** np.arange(4).reshape(4, 1, 1)
    return np.ascontiguousarray(powers.transpose(1, 2, 0)), error

"""What varies along a tube: fiber angles, wall and radius as profiles over x/l.

A profile is a list of pairs ``(x/l, value)``, linear between them, where a repeated x/l is a jump; or a callable of x/l
(array in, array out). What is narrower than 1/8000 of the tube may be missed in a callable: that is what pairs are for.
"""

import functools
from itertools import pairwise

import numpy as np

from .along import Profile as Given
from .given import numbers

SAMPLES = 257  # of a profile, where its values are checked
DENSE = 1 << 14  # of a callable along the tube: what is narrower than two gaps may be missed
GOLDEN = 0.5 * (5.0**0.5 - 1.0)  # multiples modulo 1 are the evenest of irregular places
MOST_SEGMENTS = 48  # into which callables are cut, each with its share of the mesh
SHORTEST = 1e-6  # of the length: of what lies between two places where something jumps or bends
SAME = 1e-9  # places of different profiles that only rounding parts, as 0.3 and 0.1 + 0.2
DEGREE, CUT_OFF = 16, 1e-13  # of polynomials that a callable's slope is taken from; what they may leave

TOO_FAST = (
    "a profile changes too fast to be followed, between x/l = {places}; where it jumps or bends, give pairs with a repeated"
    " x/l instead of a callable"
)


class ProfileError(ValueError):
    """A profile that cannot be read; the message says why."""


class Along:
    """One quantity along the tube: ``breaks`` in x/l, and its values within each segment between them."""

    function = None  # of x/l, where it is one that only its values tell

    def within(self, low, high, share):
        """Values at ``low + (high - low) share``, as seen from inside that interval."""
        raise NotImplementedError

    def at(self, share):
        """Values at shares of the length; on a jump the left one."""
        return self._piecewise(self.within, share)

    def slope_at(self, share):
        """Derivatives along x/l at shares of the length; on a bend the left one."""
        return self._piecewise(self.slope, share)

    def _piecewise(self, within, share):
        share = np.atleast_1d(np.asarray(share, float))
        out = np.empty(share.shape)
        for low, high in pairwise(self.breaks):
            here = (share >= low if low == 0.0 else share > low) & (share <= high)
            out[here] = within(low, high, (share[here] - low) / (high - low))
        return out

    def samples(self):
        """Values at enough places to check them."""
        pieces = pairwise(self.breaks)
        return np.concatenate([self.within(low, high, shares_in(high - low, self)) for low, high in pieces])


class Profile(Along):
    """A quantity given by pairs, linear or ``smooth`` between them, or by a callable."""

    def __init__(self, value, unit="1", smooth=False):
        self.unit = unit
        self.function = value if callable(value) else None
        self.splines = None
        if self.function:
            self.breaks = np.array([0.0, 1.0])
        else:
            self.x, self.values = _pairs(value, unit)
            self.breaks = np.unique(self.x)
            self.splines = _smooth(self.x, self.values) if smooth else None

    def within(self, low, high, share):
        """Values at ``low + (high - low) share``, as seen from inside that interval."""
        at = low + (high - low) * np.asarray(share, float)
        if self.function:
            return self._called(at)
        k = np.searchsorted(self.x, 0.5 * (low + high)) - 1
        if self.splines:
            return self.splines[k](at)
        return self.values[k] + (at - self.x[k]) / (self.x[k + 1] - self.x[k]) * (self.values[k + 1] - self.values[k])

    def slope(self, low, high, share):
        """Derivative along x/l, as seen from inside the interval."""
        at = low + (high - low) * np.asarray(share, float)
        if self.function:
            return self._derivative(at)
        k = np.searchsorted(self.x, 0.5 * (low + high)) - 1
        if self.splines:
            return self.splines[k](at, 1)
        return np.full(at.shape, (self.values[k + 1] - self.values[k]) / (self.x[k + 1] - self.x[k]))

    @functools.cached_property
    def _derivative(self):
        return _derivative(self._called)

    def _called(self, at):
        """Values of the callable, whatever a person's may do."""
        try:
            with np.errstate(all="ignore"):
                found = self.function(at)
        except Exception as error:
            raise ProfileError(f"the callable failed: {type(error).__name__}: {error}") from None
        try:
            values = numbers(found, self.unit)
        except ValueError as error:
            raise ProfileError(f"of the callable {error}") from None
        if values.shape != at.shape:
            raise ProfileError(f"the callable made shape {values.shape} of shape {at.shape}; array in, array out")
        if not np.all(np.isfinite(values)):
            raise ProfileError(f"the profile has values that are not finite; give finite numbers in [{self.unit}]")
        return values


def _smooth(x, values):
    """For each gap between two places the cubic spline that runs through it: one from repeated place to repeated place."""
    from scipy.interpolate import CubicSpline

    found, first = [], 0
    for last in [*np.flatnonzero(np.diff(x) == 0.0), len(x) - 1]:
        spline = CubicSpline(x[first : last + 1], values[first : last + 1])
        found += [spline] * (last - first)
        found += [None] if last < len(x) - 1 else []  # the gap of a repeated place has no inside
        first = last + 1
    return found


def _derivative(function):
    """The derivative of a function on 0..1, by Chebyshev's polynomials on pieces that are halved until they fit."""
    pieces, waiting = [], [(0.0, 1.0)]
    while waiting:
        low, high = waiting.pop()
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        polynomial = np.polynomial.chebyshev.chebinterpolate(lambda z, m=middle, h=half: function(m + h * z), DEGREE)
        if np.max(np.abs(polynomial[-3:])) <= CUT_OFF * np.max(np.abs(polynomial)):
            pieces.append((low, np.polynomial.chebyshev.chebder(polynomial) / half))
        elif len(pieces) + len(waiting) > MOST_SEGMENTS or high - low < 2.0 * SHORTEST:
            raise ProfileError(TOO_FAST.format(places=f"{low:.6g} and {high:.6g}"))
        else:
            waiting += [(middle, high), (low, middle)]
    starts = np.array([low for low, _ in pieces] + [1.0])

    def derivative(at):
        where = np.clip(np.searchsorted(starts, at, side="right") - 1, 0, len(pieces) - 1)
        out = np.empty(at.shape)
        for k, (low, slopes) in enumerate(pieces):
            here = where == k
            z = 2.0 * (at[here] - low) / (starts[k + 1] - low) - 1.0
            out[here] = np.polynomial.chebyshev.chebval(z, slopes)
        return out

    return derivative


def _pairs(value, unit):
    if isinstance(value, np.ndarray) and value.dtype.kind in "iuf":
        pairs = [tuple(row) if np.ndim(row) else () for row in value.tolist()] if value.ndim == 2 else []
    else:
        pairs = value
    try:
        x, y = zip(*((share, number) for share, number in pairs))
    except Exception:
        raise ProfileError("give pairs (x/l, value), or a callable of x/l") from None
    try:
        x, y = numbers(list(x), "1"), numbers(list(y), unit)
    except ValueError as error:
        raise ProfileError(f"{error}; give pairs (x/l, value), or a callable of x/l") from None
    if x.ndim != 1 or y.ndim != 1 or len(x) < 2 or not np.all(np.isfinite(x)) or not np.all(np.isfinite(y)):
        raise ProfileError("give two or more pairs (x/l, value) of finite numbers")
    if x[0] != 0.0 or x[-1] != 1.0 or np.any(np.diff(x) < 0.0):
        raise ProfileError("x/l has to rise from 0 to 1; a repeated x/l is a jump")
    if np.any((x[2:] == x[1:-1]) & (x[1:-1] == x[:-2])) or x[0] == x[1] or x[-1] == x[-2]:
        raise ProfileError("a jump takes two pairs at one x/l, inside the tube")
    gaps = np.diff(np.unique(x))
    if np.any(gaps < SHORTEST):
        near = float(np.unique(x)[np.argmin(gaps)])
        raise ProfileError(
            f"x/l {near!r} and the next are {gaps.min():.1g} apart; give places at least {SHORTEST:g} apart, or twice the"
            " same for a jump"
        )
    return x, y


def is_profile(value) -> bool:
    """Whether a value describes a profile rather than a number."""
    return (
        callable(value) or isinstance(value, (Given, list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0)
    )


def as_profile(value, unit="1") -> Profile:
    """A profile of anything that may vary, numbers included; ``unit`` is that of what pairs and callables give."""
    if isinstance(value, float):
        return _constant(value, unit)
    if isinstance(value, Given):
        if value.is_free:
            raise ProfileError(
                "its values are free; an actuator's are given: pairs, a callable, or knots without between"
            )
        return Profile(value.knots, unit, value.smooth)
    return Profile(value if is_profile(value) else [(0.0, value), (1.0, value)], unit)


@functools.lru_cache(maxsize=1024)
def _constant(value, unit):
    """A profile that is the same all along: most are, and are asked for again and again."""
    return Profile([(0.0, value), (1.0, value)], unit)


def together(first, second):
    """Values of two profiles at the same places: everywhere along the tube, both sides of each jump among them."""
    pieces = list(pairwise(places_of(first, second)))
    inner = [shares_in(high - low, first, second) for low, high in pieces]
    return tuple(
        np.concatenate([profile.within(*piece, share) for piece, share in zip(pieces, inner)])
        for profile in (first, second)
    )


def places_of(*profiles, middle=None):
    """Places x/l where some profile jumps or bends, ascending, and the ``middle``; what only rounding parts is one place."""
    found = np.unique(np.concatenate([profile.breaks for profile in profiles] + ([] if middle is None else [[middle]])))
    found = found[np.concatenate([[True], np.diff(found) > SAME])]
    gaps = np.diff(found)
    if np.any(gaps < SHORTEST):
        k = int(np.argmin(gaps))
        raise ProfileError(
            f"profiles jump or bend at x/l {float(found[k])!r} and {float(found[k + 1])!r}, less than {SHORTEST:g} apart;"
            " give them the same place"
        )
    return found


def shares_in(width, *profiles, least=SAMPLES):
    """Places within a piece of the tube, 0 to 1, where profiles are looked at: irregular, so that nothing that repeats is
    missed, and where there is a callable so dense that nothing is that takes more than two gaps.
    """
    count = max(least, int(DENSE * width) if any(profile.function for profile in profiles) else 0)
    return _irregular(count)


@functools.cache
def _irregular(count):
    places = np.concatenate([[0.0], np.sort(np.arange(1, count) * GOLDEN % 1.0), [1.0]])
    places.flags.writeable = False
    return places

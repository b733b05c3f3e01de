"""Beyond the uniform tube's turning point: shapes from their own middle, and limit pressures.

A clamped tube holds a little more pressure than a uniform one, so its last states have no uniform stretch to approach. They
are integrated from a middle q_m: ``|q_m - q| = scale (cosh(theta) - 1)``. At a given pressure each middle belongs to one
half length X(q_m); the tube turns back where the largest X is its own: that pressure is the limit.
"""

import numpy as np

from .roots import find_roots
from .tube import NO_GUIDE, ROUNDING, SOLVED, Judged, graded, solve_beside
from .uniform import density, state, stationary

PANELS = 40
NEARBY = np.array([1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3])  # relative, of q: how far from the middle given to look
GOLDEN = 0.5 * (5.0**0.5 - 1.0)
SCAN = np.geomspace(0.3, 4.0, 40)  # times the uniform tube's q - 1 at its turning point: where middles are looked for


def along(tubes, middle, panels):
    """dx, q, s, psi, w at nodes along half of each tube whose middle is q = ``middle`` (n,); NaN where it is none."""
    sign = np.where(middle >= 1.0, 1.0, -1.0)[:, None]
    reach, tubes, m = np.abs(middle - 1.0)[:, None], tubes.columns(), middle[:, None]
    distances = reach * 2.0 ** -np.arange(48.0)
    rise = sign * density(tubes, m, m - sign * distances).first  # (U(q_m) - U(q))/|q_m - q|
    at_middle = sign * density(tubes, m, m).slope
    scale = np.max(np.where(rise < 2.0 * at_middle, distances, distances[:, -1:]), axis=1)[:, None]
    end = np.arccosh(1.0 + reach / scale)
    from_end, weight = graded(end, panels)
    theta = end - from_end
    z = 2.0 * scale * np.sinh(0.5 * theta) ** 2
    q = m - sign * z
    rise = sign * density(tubes, m, q).first
    G, psi, w, T = state(tubes, q)
    flat, R = T * np.sqrt(G), z * rise
    rate = np.sqrt(2.0 * scale / rise) * np.cosh(0.5 * theta) * (flat + R) / (2.0 * np.sqrt(q * G * (2.0 * flat + R)))
    sound = (rise > 0.0) & (at_middle > 0.0) & (G > 0.0) & (T > 0.0) & (q > 0.0)
    return np.where(sound, rate, np.nan) * weight, q, T * G / (flat + R), psi, w


def shortfall(tubes, middle, panels=PANELS):
    """1 - half/X(middle): -1 .. 1, rising with X; 1 where X is infinite, for the middle lies beyond a stationary stretch."""
    x = along(tubes, middle, panels)[0].sum(axis=1)
    return np.where(np.isfinite(x), 1.0 - tubes.half / x, 1.0)


def solve_near(tubes, mid_radius) -> Judged:
    """Equilibria whose middle stretch is near ``mid_radius`` (n,), which is taken from whom they judge."""
    middle = mid_radius**2
    with np.errstate(all="ignore"):
        u = stationary(tubes, middle)  # beyond the turning point a uniform tube may be stationary again
        values, errors, reason = solve_beside(tubes, np.where((u - middle) * (middle - 1.0) > -1e-9, u, np.nan))
        away = ~(np.abs(values[:, 4] / mid_radius - 1.0) < NEARBY[-1])
        values[away], errors[away], reason[away] = np.nan, np.nan, NO_GUIDE
        left = np.flatnonzero(reason != SOLVED)
        tubes, middle, results = tubes.at(left), middle[left], []
        low, high = _bracket(tubes, middle)
        for panels in (PANELS, 2 * PANELS):

            def miss(q, which, panels=panels):
                return shortfall(tubes.at(which), q, panels)

            middle = find_roots(miss, low, high)
            dx, q, s, psi, w = along(tubes, middle, panels)
            half = (dx * np.stack([s, q * s, psi, tubes.area[:, None] * w])).sum(axis=2)
            results.append(np.column_stack([*(2.0 * half), np.sqrt(middle)]))
    good = np.all(np.isfinite(results[0] + results[1]), axis=1)
    there = left[good]
    values[there], reason[there] = results[1][good], SOLVED
    errors[there] = (np.abs(results[1] - results[0]) + ROUNDING * np.abs(results[1]))[good]
    return Judged(values, errors, reason)


def _bracket(tubes, middle):
    """``(low, high)`` about ``middle`` between which X grows past the half length; NaN where it does not."""
    low, high = np.full(len(middle), np.nan), np.full(len(middle), np.nan)
    sign = np.where(middle >= 1.0, 1.0, -1.0)
    for near in NEARBY[::-1]:
        inner, outer = middle * (1.0 - sign * near), middle * (1.0 + sign * near)
        fits = (shortfall(tubes, inner) < 0.0) & (shortfall(tubes, outer) > 0.0) & ((inner - 1.0) * sign > 0.0)
        low, high = np.where(fits, np.minimum(inner, outer), low), np.where(fits, np.maximum(inner, outer), high)
    return low, high


def _longest(tubes, turning):
    """The largest X(q_m) over middles q_m, as :func:`shortfall`; ``turning`` (n,) is the uniform tube's q at its turn."""
    middles = 1.0 + (turning - 1.0)[:, None] * SCAN
    every = np.array([shortfall(tubes, middle) for middle in middles.T])
    # up to the first middle from which X falls
    falls = every[1:] < every[:-1]
    top = np.where(falls.any(axis=0), np.argmax(falls, axis=0), len(SCAN) - 1)
    rows = np.arange(len(turning))
    low, high = middles[rows, np.maximum(top - 1, 0)], middles[rows, np.minimum(top + 1, len(SCAN) - 1)]
    best = every[top, rows]
    inner, outer = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_inner, at_outer = shortfall(tubes, inner), shortfall(tubes, outer)
    for _ in range(40):
        left = at_inner > at_outer
        low, high = np.where(left, low, inner), np.where(left, outer, high)
        new = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        value = shortfall(tubes, new)
        inner, outer = np.where(left, new, outer), np.where(left, inner, new)
        at_inner, at_outer = np.where(left, value, at_outer), np.where(left, at_inner, value)
        best = np.maximum(best, value)
    return best


def limit_pressures(tubes, turning, turning_pressure, near):
    """Limit pressures (n,) close to ``near``, NaN where there is none.

    ``turning`` and ``turning_pressure`` (n,): q and pressure at which the uniform tubes turn back.
    """
    with np.errstate(all="ignore"):

        def miss(p, which):
            longest = _longest(tubes.at(which)._replace(pressure=p), turning[which])
            # X grows as (p - p_uniform)^(-1/4)
            return (1.0 - longest) ** 4 - 1.0

        width = np.maximum(1e-3 * near, 2.0 * (near - turning_pressure))
        return find_roots(miss, near - width, near + width, 1e-13)

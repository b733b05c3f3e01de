"""Roots of many functions at once."""

import numpy as np

ITERATIONS = 100


def find_roots(function, low, high, tolerance=4e-15):
    """Roots (n,) of functions that change sign between ``low`` and ``high`` (n,); NaN where they do not.

    ``function(x, which)`` gives the values of the functions numbered ``which``. Chandrupatla's method (1997): inverse
    quadratic interpolation where it is safe, halving elsewhere.
    """
    a, b = np.array(high, float), np.array(low, float)
    every = np.arange(len(a))
    fa, fb = function(a, every), function(b, every)
    roots = np.where(fa == 0.0, a, np.where(fb == 0.0, b, np.nan))
    on = every[(np.sign(fa) * np.sign(fb) < 0.0) & np.isnan(roots)]
    a, b, fa, fb = a[on], b[on], fa[on], fb[on]
    share = np.full(len(on), 0.5)
    for _ in range(ITERATIONS):
        if not len(on):
            break
        x = a + share * (b - a)
        f = function(x, on)
        f = np.where(np.isnan(f), np.inf, f)
        same = np.sign(f) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, f
        best, smallest = np.where(np.abs(fa) < np.abs(fb), a, b), np.minimum(np.abs(fa), np.abs(fb))
        limit = 0.5 * tolerance * np.abs(best) / np.abs(b - a)
        done = (limit > 0.5) | (smallest == 0.0)
        roots[on[done]] = best[done]
        with np.errstate(all="ignore"):
            xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
            inverse = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            safe = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi) & np.isfinite(inverse)
        share = np.where(safe, np.clip(inverse, limit, 1.0 - limit), 0.5)
        keep = ~done
        on, a, b, fa, fb, share = on[keep], a[keep], b[keep], fa[keep], fb[keep], share[keep]
    return roots

"""Equilibria of clamped tubes by quadrature of the first integral.

Where angles, wall and loads are constant the density is free of x, so ``L - y' L_y'`` is the same at every place::

    T G/s - a w + m psi = U(q_m)   =>   s = T G/(T sqrt(G) + R),   y'^2 = G - s^2,   R = U(q_m) - U(q)

The middle q_m lies exponentially close to the stationary stretch u of the uniform tube. With ``|u - q| = e cosh(theta)`` and
``e = |u - q_m|``, theta runs from 0 in the middle to its ``folds`` at the clamped end q = 1, and dx/dtheta is smooth and
nearly constant. ``(U(u) - U(q))/(u - q)^2`` comes from divided differences: no digit is lost in hardly strained or very long
tubes. Beyond DEEP e-folds the middle is u to rounding: there the difference from the uniform tube is integrated.
"""

from typing import NamedTuple

import numpy as np

from .roots import find_roots
from .uniform import density, state, stretch

OUTPUTS = ("deformed_length", "volume", "rotation", "strain_energy", "mid_radius")
DEEP = 34.0  # e-folds from end to middle: exp(-34) is rounding
LAYER = 40.0  # e-folds over which an end layer is integrated
STILL = 1e-14  # |u - 1| below which nothing moves
GRADING = 1e-3  # width in theta over which nodes crowd at the clamped end: a tube may swell thirtyfold from there
NODES, WEIGHTS = (half / 2.0 for half in np.polynomial.legendre.leggauss(12))  # on -0.5 to 0.5
PANELS, MOST_PANELS = 10, 320  # doubled until results change by less than TOLERANCE
TOLERANCE = 1e-12  # relative
ROUNDING = 1e-12  # relative, of every result

# the uniform tube turns back on the way to a load; the shape, between end and middle
SOLVED, NO_GUIDE, NOT_MONOTONE = 0, 1, 2


class Judged(NamedTuple):
    """Whole tubes: ``values``, ``errors`` (n, 5) in the order of OUTPUTS, rotation [radian], lengths in r0; NaN unless
    the ``reason`` (n,) is SOLVED.
    """

    values: np.ndarray
    errors: np.ndarray
    reason: np.ndarray


def graded(end, panels):
    """Distances from the end of intervals of length ``end`` (n, 1), (n, 12 panels), and their weights."""
    stretched = end + np.log((1.0 + GRADING - np.exp(-end)) / GRADING)
    crowded = GRADING * np.exp(stretched * ((np.arange(panels)[:, None] + 0.5 + NODES) / panels).ravel())
    weights = stretched * np.tile(WEIGHTS / panels, panels) * crowded / (1.0 + crowded)
    return np.log1p((crowded - GRADING) / (1.0 + GRADING)), weights


class Quadrature:
    """Integrals along ``tubes`` whose stationary stretches ``u`` (n,) are known."""

    def __init__(self, tubes, u):
        self.tubes, self.u = tubes, u
        self.sign = np.where(u >= 1.0, 1.0, -1.0)
        self.reach = np.abs(u - 1.0)

    def at(self, which):
        """The quadrature of some of the tubes."""
        return Quadrature(self.tubes.at(which), self.u[which])

    def along(self, folds, panels):
        """dx, q, s, psi, w at nodes along half of each tube, ``folds`` e-folds from end to middle (infinite: LAYER)."""
        deep = np.isinf(folds)
        end = np.where(deep, LAYER, folds)[:, None]
        from_end, weight = graded(end, panels)
        reach, u = self.reach[:, None], self.u[:, None]
        e = np.where(deep[:, None], 0.0, reach / np.cosh(end))
        layer = reach * np.exp(-from_end)  # all there is of cosh and sinh where it is deep
        z = np.where(deep[:, None], layer, e * np.cosh(end - from_end))
        fall = np.where(deep[:, None], layer, e * np.sinh(end - from_end))  # squared: z^2 - e^2
        sign, tubes = self.sign[:, None], self.tubes.columns()
        curve = -density(tubes, u, u - sign * np.concatenate([z, e], axis=1)).second  # (U(u) - U(q))/z^2
        ratio = curve[:, :-1] + (curve[:, :-1] - curve[:, -1:]) * (e / fall) ** 2  # R/(z^2 - e^2)
        q = u - sign * z
        G, psi, w, T = state(tubes, q)
        flat, R = T * np.sqrt(G), ratio * fall**2
        rate = (flat + R) / (2.0 * np.sqrt(q * ratio * G * (2.0 * flat + R)))
        sound = (ratio > 0.0) & (G > 0.0) & (T > 0.0) & (q > 0.0)
        return np.where(sound, rate, np.nan) * weight, q, T * G / (flat + R), psi, w

    def folds(self, panels):
        """E-folds from end to middle at which the half length is met; infinite where more than DEEP."""
        half = self.tubes.half

        def miss(folds, which):
            return self.at(which).along(folds, panels)[0].sum(axis=1) - half[which]

        deepest = np.full(len(half), DEEP)
        folds = find_roots(miss, np.full(len(half), 1e-8), deepest)
        return np.where(miss(deepest, np.arange(len(half))) < 0.0, np.inf, folds)

    def integrate(self, folds, panels):
        """Results (n, 5) of whole tubes."""
        dx, q, s, psi, w = self.along(folds, panels)
        energy = self.tubes.area[:, None]
        parts = np.stack([s, q * s, psi, energy * w])
        deep = np.isinf(folds)
        G, psi, w, _ = state(self.tubes, self.u)
        uniform = np.stack([np.sqrt(G), self.u * np.sqrt(G), psi, self.tubes.area * w])
        half = (dx * (parts - np.where(deep, uniform, 0.0)[..., None])).sum(axis=2)
        half = half + np.where(deep, uniform * self.tubes.half, 0.0)
        middle = self.u - self.sign * self.reach / np.cosh(np.where(deep, DEEP, folds))
        return np.column_stack([*(2.0 * half), np.sqrt(np.where(deep, self.u, middle))])


def cylinders(tubes):
    """Results (n, 5) of tubes that do not move: q = 1."""
    G, psi, w, _ = state(tubes, np.ones(len(tubes.half)))
    s = np.sqrt(G)
    return np.column_stack([*(2.0 * tubes.half * part for part in (s, s, psi, tubes.area * w)), np.ones(len(s))])


def solve(tubes) -> Judged:
    """Equilibria on the branch from the undeformed cylinder, and an estimate of this method's own errors."""
    u, carried = stretch(tubes)
    return solve_beside(tubes, np.where(carried, u, np.nan))


def solve_beside(tubes, u) -> Judged:
    """Equilibria that approach the stationary stretches ``u`` in the middle (NaN: none known)."""
    count = len(u)
    values, errors = np.full((count, 5), np.nan), np.full((count, 5), np.nan)
    reason = np.where(np.isnan(u), NO_GUIDE, NOT_MONOTONE)
    still = np.abs(u - 1.0) < STILL
    values[still], errors[still], reason[still] = cylinders(tubes.at(still)), 0.0, SOLVED
    with np.errstate(all="ignore"):
        todo, panels, before = np.flatnonzero(~np.isnan(u) & ~still), PANELS, None
        while todo.size and panels <= MOST_PANELS:
            quadrature = Quadrature(tubes.at(todo), u[todo])
            now = quadrature.integrate(quadrature.folds(panels), panels)
            settled = np.zeros(todo.size, bool)
            if before is not None:
                change = np.abs(now - before)
                settled = np.all(change <= TOLERANCE * np.abs(now) + 1e-300, axis=1)
                settled |= np.all(np.isfinite(change), axis=1) & (panels == MOST_PANELS)
                done = todo[settled]
                values[done], errors[done], reason[done] = now[settled], change[settled], SOLVED
            keep = ~settled & (np.all(np.isfinite(now), axis=1) | (panels == PANELS))
            todo, before, panels = todo[keep], now[keep], 2 * panels
    return Judged(values, errors + ROUNDING * np.abs(values), reason)

"""The branch of a free tube that varies, by someone else: nothing here shares code with freesweep.

Second-order midpoint cells on one fixed mesh, SymPy's derivatives of the density, arclength continuation in small steps
with SciPy's sparse LU of the whole bordered matrix. Good to about 1e-3: it tells which branch a state lies on, and where
that ends.
"""

from functools import cache
from itertools import pairwise

import numpy as np
import sympy as sp
from oracle import ENERGIES, PARAMETERS, V, Y, expressions, half_sum_and_difference, settled
from scipy import sparse
from scipy.sparse.linalg import splu

CELLS = 160  # of each segment
LARGEST = 0.02  # relative change of y in one step
LOAD = 0.15  # and of the load
STRAIGHT = 0.97  # cosine between successive tangents
PAST = 1.001  # of what is left up to the load that is asked for
NOTHING = 1e-4  # of the load
LOST, PUSHED = "lost", "pushed"


@cache
def partials():
    """s, twist, and the derivatives of L, as functions of (y, v, parameters)."""
    L, have = expressions()["L"], expressions()
    what = (have["s"], have["psi"], *(sp.diff(L, *by) for by in ((Y,), (V,), (Y, Y), (Y, V), (V, V))))
    return sp.lambdify((Y, V, PARAMETERS), what, "numpy", cse=True)


def mesh(breaks):
    """Nodes dense at both ends of each segment."""
    share = 0.5 * (1.0 - np.cos(np.pi * np.arange(CELLS + 1) / CELLS))
    share = 0.5 * (1.0 - np.cos(np.pi * share))
    parts = [a + (b - a) * share for a, b in pairwise(breaks)]
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])


class Tube:
    """One tube and its loads: ``cells(x)`` gives alpha, beta [degree] and the dimensionless section at places in radii."""

    def __init__(self, cells, breaks, ratio, energy, gamma=1.0, f=0.0, m=0.0):
        self.x = mesh(np.asarray(breaks, float))
        self.h = np.diff(self.x)
        alpha, beta, self.area = cells(0.5 * (self.x[1:] + self.x[:-1]))
        self.H, self.D = half_sum_and_difference(alpha, beta)
        self.ratio, self.shear, self.full = ratio, ENERGIES[energy], (gamma, f, m)

    def parameters(self, p, f, m, gamma):
        return self.H, self.D, self.area, gamma, self.ratio, self.shear, p, f, m, 1.0, 0.0, 0.0

    def gradient(self, y, load):
        """Gradient and Hessian of -J at the inner nodes, length and rotation."""
        middle, v = 0.5 * (y[1:] + y[:-1]), np.diff(y) / self.h
        s, psi, L_y, L_v, L_yy, L_yv, L_vv = (
            np.broadcast_to(part, middle.shape) for part in partials()(middle, v, self.parameters(*load))
        )
        half = 0.5 * self.h * L_y
        g = -(half[:-1] + L_v[:-1]) - (half[1:] - L_v[1:])
        corner, stiff = 0.25 * self.h * L_yy, L_vv / self.h
        right, left = -(corner + L_yv + stiff), -(corner - L_yv + stiff)
        diagonal, off = right[:-1] + left[1:], (stiff - corner)[1:-1]
        return g, diagonal, off, float(np.sum(self.h * s)), float(np.sum(self.h * psi))


def negative_pivots(diagonal, off):
    below, count = 0.0, 0
    for k, d in enumerate(diagonal):
        pivot = d - below
        count += pivot <= 0
        if k < len(off):
            below = off[k] ** 2 / pivot
    return count


class Branch:
    """Arclength continuation along ``load(mu)``; records (mu, length, rotation) of every stable state on the way."""

    def __init__(self, tube, load, y, mu, sense=1.0):
        self.tube, self.load, self.y, self.mu = tube, load, y, mu
        self.states, self.fold, self.lost = [], None, False
        self.tangent = None
        self.correct(np.zeros(len(y) - 2), sense, 0.0)

    def matrix(self, y, mu, row, row_mu):
        g, diagonal, off, length, rotation = self.tube.gradient(y, self.load(mu))
        step = 1e-4 * max(abs(mu), 1e-3)
        b = (self.tube.gradient(y, self.load(mu + step))[0] - self.tube.gradient(y, self.load(mu - step))[0]) / (
            2 * step
        )
        H = sparse.diags([off, diagonal, off], [-1, 0, 1])
        full = sparse.bmat([[H, b[:, None]], [row[None, :], np.array([[row_mu]])]], format="csc")
        return g, (diagonal, off, length, rotation), splu(full)

    def correct(self, row, row_mu, ds):
        """A corrector step from the predictor; whether it met the branch close by."""
        y, mu = self.y.copy(), self.mu
        if self.tangent is not None:
            y[1:-1] += ds * self.tangent[:-1] * y[1:-1]
            mu += ds * self.tangent[-1] * self.scale()
        start = y.copy(), mu
        with np.errstate(all="ignore"):
            for _ in range(12):
                try:
                    g, beside, lu = self.matrix(y, mu, row, row_mu)
                except (RuntimeError, ValueError):
                    return False
                miss = row @ (y - start[0])[1:-1] + row_mu * (mu - start[1])
                change = lu.solve(-np.append(g, miss))
                if not np.all(np.isfinite(change)):
                    return False
                y[1:-1] += change[:-1]
                mu += change[-1]
                size = max(np.max(np.abs(change[:-1] / y[1:-1])), abs(change[-1]) / max(abs(mu), 1e-6))
                if size < 1e-8:
                    break
                if size > 0.5:
                    return False
            else:
                return False
        direction = lu.solve(np.append(np.zeros(len(g)), 1.0))
        tangent = np.append(direction[:-1] / y[1:-1], direction[-1] / max(abs(mu), 1e-3) * LARGEST / LOAD)
        size = np.sqrt(np.mean(tangent[:-1] ** 2) + tangent[-1] ** 2)
        tangent /= size
        if self.tangent is not None:
            cosine = np.mean(tangent[:-1] * self.tangent[:-1]) + tangent[-1] * self.tangent[-1]
            if cosine < STRAIGHT:
                return False
        before = None if self.tangent is None else self.mu
        self.y, self.mu, self.tangent = y, mu, tangent
        self.note(beside, before)
        return True

    def scale(self):
        return max(abs(self.mu), 1e-3) * LOAD / LARGEST

    def note(self, beside, before):
        diagonal, off, length, rotation = beside
        if negative_pivots(diagonal, off):
            self.fold = self.mu if before is None else max(before, self.mu)
        else:
            self.states.append((self.mu, length, rotation))

    def follow(self, far):
        """On to the load ``far``, or to the end of the branch."""
        ds, sense = 0.2 * LARGEST, np.sign(self.tangent[-1])
        while self.fold is None and (far - self.mu) * sense > 0 and not self.lost:
            longest = LARGEST / max(np.max(np.abs(self.tangent[:-1])), abs(self.tangent[-1]))
            to_far = (far - self.mu) / (self.tangent[-1] * self.scale())
            ds = min(ds, longest, max(PAST * to_far, 1e-6) if to_far > 0 else longest)
            row = self.tangent[:-1] / self.y[1:-1] / len(self.y)
            row_mu = self.tangent[-1] / self.scale()
            if self.correct(row, row_mu, ds):
                ds *= 1.5
            else:
                ds *= 0.5
                self.lost = ds < 1e-7
        return self

    @property
    def pushed(self):
        """Whether nothing is left that keeps the wall round: a meridian that has to be pushed."""
        p, f, _, _ = self.load(self.mu)
        return bool(np.min(p * self.y**2 + f) < NOTHING * (p + abs(f)))


def branch(cells, breaks, ratio, energy, pressure, gamma=1.0, f=0.0, m=0.0):
    """``(state at the pressure or None, fold or None, why there is neither)``: length and rotation [rad] of the whole tube,
    in radii. Where the wall would be PUSHED there is none; what was LOST cannot be judged.
    """
    if pressure + f <= 0:  # at the clamped ends
        return None, None, PUSHED
    tube = Tube(cells, breaks, ratio, energy, gamma, f, m)
    loaded = f != 0 or m != 0 or gamma != 1
    first = settled(pressure, f, m, gamma)

    def proportional(t):
        return t * first, t * f, t * m, 1 + t * (gamma - 1)

    start = 1e-3 if loaded else min(1e-3, pressure) / pressure
    here = Branch(tube, proportional, np.ones(len(tube.x)), start)
    if here.tangent is None:
        return None, None, LOST
    here.follow(1.0)
    if here.fold is not None and here.fold < 1:
        return (None, None, PUSHED) if here.pushed else (None, here.fold * (first if not loaded else np.nan), None)
    if loaded and not here.lost and pressure != first:
        near = here.y

        def alone(p):
            return p, f, m, gamma

        here = Branch(tube, alone, near, first, np.sign(pressure - first))
        if here.tangent is None:
            return None, None, LOST
        here.follow(pressure)
        if here.fold is not None:
            return (None, None, PUSHED) if here.pushed else (None, here.fold, None)
        place = pressure
    else:
        place = 1.0
    if here.lost:
        return None, None, PUSHED if here.pushed else LOST
    states = np.array(sorted(here.states))
    return np.array([np.interp(place, states[:, 0], states[:, k]) for k in (1, 2)]), None, None

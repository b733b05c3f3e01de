"""Tubes with loose fibers and thick walls by brute force; nothing here shares code with freesweep.

Nothing is eliminated: on n midpoint cells the stretches of the nodes, and in each cell the squared meridional stretch G, the
twist rate psi and both fibers' multipliers are unknowns of one system, the stationarity of

    sum h [(p y^2 + f) sqrt(G - v^2) - integral w d(rho^2) + m psi - sum mu_i g_i]
    g_i = G + y^2 (t_i + psi)^2 - g^2 (1 + t_i^2)

with "mu_i >= 0, g_i <= 0, one of them 0" as Fischer's and Burmeister's ``sqrt(mu^2 + g^2) = mu - g``, solved by Newton's
method on sparse matrices while the load rises. A held length or rotation has one more unknown. Results of n, 2n and 4n cells
are extrapolated. Derivatives come from SymPy. Lengths in radii of the fiber surface; of a body of revolution in that at its
fixed end: there nodes carry radii r along the undeformed meridian S, ``y = r/R(S)``, ``v = dr/dS``, and psi turns by psi/R.
"""

import itertools
from functools import cache
from types import SimpleNamespace

import numpy as np
import sympy as sp
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

LAYERS = 16  # Gauss points in rho^2
OUTPUTS = ("length", "volume", "twist", "energy", "middle")


@cache
def _symbolic():
    """Functions of a cell's unknowns and parameters: gradient and Hessian of the density, of one layer, of constraints."""
    left, right, G, psi, a, b, h = unknowns = sp.symbols("left right G psi a b h")
    p, f, m, ta, tb, g, square, c, c2, c3, R = sp.symbols("p f m ta tb g square c c2 c3 R")
    r, v = (left + right) / 2, (right - left) / h
    y = r / R
    q = y**2 + (square - 1) / sp.sqrt(G)
    i = G + q / square + q * psi**2 + square / (G * q) - 3
    second = G * q / square + (G + q / square + q * psi**2) * square / (G * q) - 3
    w = i + c2 * i**2 + c3 * i**3 + c * second
    gaps = [G + y**2 * (t + psi) ** 2 - g**2 * (1 + t**2) for t in (ta, tb)]
    rest = (p * r**2 + f) * sp.sqrt(G - v**2) + m * psi / R - R**2 * (a * gaps[0] + b * gaps[1])
    parts = unknowns[:6]
    upper = [(j, k) for j in range(6) for k in range(j, 6)]

    def function(given, what):
        first = [sp.diff(what, x) for x in parts]
        both = [sp.diff(what, parts[j], parts[k]) for j, k in upper]
        return sp.lambdify((unknowns, given), [what, *first, *both], "numpy", cse=True)

    length = sp.sqrt(G - v**2)
    return SimpleNamespace(
        upper=upper,
        rest=function((p, f, m, ta, tb, g, R), rest),
        layer=function((square, c, c2, c3, R), w),
        length=function((), length),
        gaps=[function((ta, tb, g, R), gap) for gap in gaps],
        volume=sp.lambdify((unknowns, ()), r**2 * length, "numpy"),
    )


class Tube:
    """A tube of fiber angles [degree], ``length`` and the wall ``inner`` to ``outer`` (rho_i, rho_o) in radii of the fiber
    surface; a membrane of area ``area`` where that is given. ``rubber`` is C01, C20, C30 over C10. Of a family that is not
    ``there``, (alpha, beta), the constraint is left out: its multiplier is 0.
    """

    def __init__(
        self, alpha, beta, length, *, inner=None, outer=None, area=None, rubber=(0, 0, 0), gamma=1.0, loose=True,
        there=(True, True),
    ):  # fmt: skip
        self.ta, self.tb = np.tan(np.radians([alpha, beta]))
        self.length, self.rubber, self.gamma, self.loose, self.there = length, rubber, gamma, loose, there
        if area is not None:
            self.layers = [(area, 1.0)]
        else:
            x, w = np.polynomial.legendre.leggauss(LAYERS)
            half = 0.5 * (outer**2 - inner**2)
            self.layers = [(half * wi, inner**2 + half * (1 + xi)) for xi, wi in zip(x, w)]

    def nodes(self, n):
        """Ends graded: cells next to the ends are some hundred times shorter than those in the middle."""
        z = np.linspace(-1, 1, n + 1)
        return 0.5 * self.length * (1 + np.tanh(3.2 * z) / np.tanh(3.2))

    def middle(self, x):
        """The node half way along the axis."""
        return len(x) // 2

    def along(self, x):
        """Of each cell between the nodes ``x``: tangents of both angles, weights and places of the layers, and R."""
        return self.ta, self.tb, self.layers, 1.0

    def at_rest(self, x):
        """Radii of the nodes before deformation."""
        return np.ones(len(x))

    def _cells(self, x, y, G, psi, a, b, p, f, m, gamma):
        have, h = _symbolic(), np.diff(x)
        unknowns = (y[:-1], y[1:], G, psi, a, b, h)
        one = np.ones(len(h))
        ta, tb, layers, R = self.along(x)

        def values(found):
            return np.array([one * part for part in found])

        rest = values(have.rest(unknowns, (p, f, m, ta, tb, gamma, R)))
        w = sum(weight * values(have.layer(unknowns, (square, *self.rubber, R))) for weight, square in layers)
        gaps = [values(gap(unknowns, (ta, tb, gamma, R))) for gap in have.gaps]
        return h, rest - w, w[0], gaps, values(have.length(unknowns, ())), have.volume(unknowns, ()) * one, one / R

    def solve(self, n, p, f=0.0, m=0.0, held=None, target=0.0, steps=12):
        """Outputs on n cells; ``held`` is "length" or "rotation", whose load is unknown then (its outputs go by "load")."""
        have, x = _symbolic(), self.nodes(n)
        n = len(x) - 1
        y, G, psi = self.at_rest(x), np.ones(n), np.zeros(n)
        a, b, load = np.zeros(n), np.zeros(n), 0.0
        inner, size = np.arange(1, n), 5 * n - 1
        where = [None, None] + [n - 1 + k * n + np.arange(n) for k in range(4)]  # columns of G, psi, a, b
        for share in np.linspace(0, 1, steps + 1)[1:] ** 2:
            gamma, now, goal = 1 + share * (self.gamma - 1), share * p, share * target
            if held == "length":
                goal = self.length + share * (target - self.length)
            unit = max(now, 1e-3)
            for _ in range(60):
                force = load if held == "length" else share * f
                torque = load if held == "rotation" else share * m
                h, L, w, gaps, length, volume, turn = self._cells(x, y, G, psi, a, b, now, force, torque, gamma)
                index = [np.arange(n) - 1, np.arange(n)] + [c for c in where[2:]]
                total = size + (held is not None)
                R, entries = np.zeros(total), []

                def add(row, column, value, entries=entries):
                    kept = (row >= 0) & (column >= 0)
                    entries.append((value[kept], row[kept], column[kept]))

                index[1] = np.where(index[1] == n - 1, -1, index[1])  # both ends are clamped
                for j in range(4):
                    kept = index[j] >= 0
                    np.add.at(R, index[j][kept], (h * L[1 + j])[kept])
                for place, (j, k) in enumerate(have.upper):
                    value = h * L[7 + place]
                    if j < 4:
                        add(index[j], index[k], value)
                    if k < 4 and k != j:
                        add(index[k], index[j], value)
                for family, (mu, gap) in enumerate(zip((a, b), gaps)):
                    row, g = where[4 + family], gap[0]
                    if not self.there[family]:
                        R[row], slope = mu, np.zeros(n)
                        add(row, row, np.ones(n))
                    elif self.loose:
                        root = np.sqrt((mu / unit) ** 2 + g**2) + 1e-300
                        R[row] = root - mu / unit + g
                        add(row, row, (mu / (unit * root) - 1) / unit)
                        slope = g / root + 1
                    else:
                        R[row], slope = g, np.ones(n)
                    for j in range(4):
                        add(row, index[j], slope * gap[1 + j])
                if held is not None:
                    last, other = size, np.zeros(total)
                    if held == "length":
                        R[last] = np.sum(h * length[0]) - goal
                        for j in range(4):
                            kept = index[j] >= 0
                            np.add.at(other, index[j][kept], (h * length[1 + j])[kept])
                    else:
                        R[last] = np.sum(h * psi * turn) - goal
                        other[where[3]] = h * turn
                    add(np.full(total, last), np.arange(total), other)
                    add(np.arange(total), np.full(total, last), other)
                numbers, rows, columns = map(np.concatenate, zip(*entries))
                matrix = coo_matrix((numbers, (rows, columns)), (total, total))
                step = -splu(matrix.tocsc()).solve(R)
                part = 1.0
                while part > 1e-9:
                    new_y, new_G = y.copy(), G + part * step[where[2]]
                    new_y[inner] += part * step[inner - 1]
                    if np.all(new_G > (np.diff(new_y) / h) ** 2 + 0.02 * (G - (np.diff(y) / h) ** 2)) and np.all(
                        new_y > 0
                    ):
                        break
                    part *= 0.5
                y, G, psi = new_y, new_G, psi + part * step[where[3]]
                a, b = a + part * step[where[4]], b + part * step[where[5]]
                load += part * step[size] if held is not None else 0.0
                if np.max(np.abs(step[: 3 * n - 1])) < 1e-10:
                    break
            else:
                raise ArithmeticError("Newton's method did not settle")
        h, _, w, _, length, volume, turn = self._cells(x, y, G, psi, a, b, p, f, m, gamma)
        middle = y[self.middle(x)]
        return np.array([h @ length[0], h @ volume, h @ (psi * turn), h @ w, middle, load]), SimpleNamespace(
            x=x, y=y, a=a, b=b
        )

    def extrapolated(self, p, *, cells=100, **loads):
        """Outputs, the held load last, extrapolated from three meshes."""
        one, two, three = (self.solve(cells * factor, p, **loads)[0] for factor in (1, 2, 4))
        first, second = (4 * two - one) / 3, (4 * three - two) / 3
        return (16 * second - first) / 15


class Body(Tube):
    """A body of revolution. ``radius``, ``inner`` and ``outer`` are those of fibers and wall, ``alpha`` and ``beta`` angles
    [degree], functions of x in reference radii; ``section`` is outer^2 - inner^2 of a membrane. Cells end at ``breaks``.
    """

    def __init__(self, radius, alpha, beta, length, breaks=(), *, inner=None, outer=None, section=None, **more):
        super().__init__(0.0, 1.0, length, area=0.0, **more)
        self.radius, self.angles, self.breaks = radius, (alpha, beta), [0.0, *breaks, length]
        self.section, self.wall = section, (inner, outer)
        fine = np.concatenate([np.linspace(a, b, 4001)[:-1] for a, b in zip(self.breaks, self.breaks[1:])] + [[length]])
        z, weight = np.polynomial.legendre.leggauss(8)
        middle, half = 0.5 * (fine[1:] + fine[:-1]), 0.5 * np.diff(fine)
        places = middle[:, None] + half[:, None] * z
        self.x_fine = fine
        self.S_fine = np.concatenate([[0.0], np.cumsum(half * (np.sqrt(1.0 + self.slope(places) ** 2) @ weight))])

    def slope(self, x):
        """dR/dx, by complex steps: the functions are analytic between breaks."""
        return np.imag(self.radius(x + 1e-30j)) / 1e-30

    def x_of(self, S):
        """Axial position of places along the meridian."""
        from scipy.interpolate import CubicSpline

        found = np.empty(len(S))
        ends = np.searchsorted(self.x_fine, self.breaks)
        for a, b in itertools.pairwise(ends):
            here = (self.S_fine[a] <= S) & (self.S_fine[b] >= S)
            found[here] = CubicSpline(self.S_fine[a : b + 1], self.x_fine[a : b + 1])(S[here])
        return found

    def nodes(self, n):
        """Nodes along S, graded toward all breaks, as many in each segment."""
        parts, each = [], n // (len(self.breaks) - 1)
        ends = self.S_fine[np.searchsorted(self.x_fine, self.breaks)]
        for a, b in itertools.pairwise(ends):
            z = np.linspace(-1, 1, each + 1)
            parts.append(a + 0.5 * (b - a) * (1 + np.tanh(3.0 * z) / np.tanh(3.0))[:-1])
        return np.concatenate([*parts, [ends[-1]]])

    def middle(self, x):
        """The node half way along the axis."""
        return int(np.argmin(np.abs(self.x_of(x) - 0.5 * self.length)))

    def along(self, x):
        """Numbers of each cell, at its middle along S."""
        at = self.x_of(0.5 * (x[1:] + x[:-1]))
        R = self.radius(at)
        ta, tb = (np.tan(np.radians(angle(at))) for angle in self.angles)
        if self.section is not None:
            return ta, tb, [(self.section(at), 1.0)], R
        inner, outer = (wall(at) for wall in self.wall)
        z, w = np.polynomial.legendre.leggauss(LAYERS)
        half = 0.5 * (outer**2 - inner**2)
        return ta, tb, [(half * wi, (inner**2 + half * (1 + zi)) / R**2) for zi, wi in zip(z, w)], R

    def at_rest(self, x):
        """Radii of the nodes before deformation."""
        return self.radius(self.x_of(x))

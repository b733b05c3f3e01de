"""Tubes with loose fibers and thick walls by brute force; nothing here shares code with freesweep.

Nothing is eliminated: on n midpoint cells the stretches of the nodes, and in each cell the squared meridional stretch G, the
twist rate psi and both fibers' multipliers are unknowns of one system, the stationarity of

    sum h [(p y^2 + f) sqrt(G - v^2) - integral w d(rho^2) + m psi - sum mu_i g_i]
    g_i = G + y^2 (t_i + psi)^2 - g^2 (1 + t_i^2)

with "mu_i >= 0, g_i <= 0, one of them 0" as Fischer's and Burmeister's ``sqrt(mu^2 + g^2) = mu - g``, solved by Newton's
method on sparse matrices while the load rises. A held length or rotation has one more unknown. Results of n, 2n and 4n cells
are extrapolated. Derivatives come from SymPy. Lengths in radii of the fiber surface.
"""

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
    p, f, m, ta, tb, g, square, c, c2, c3 = sp.symbols("p f m ta tb g square c c2 c3")
    y, v = (left + right) / 2, (right - left) / h
    q = y**2 + (square - 1) / sp.sqrt(G)
    i = G + q / square + q * psi**2 + square / (G * q) - 3
    second = G * q / square + (G + q / square + q * psi**2) * square / (G * q) - 3
    w = i + c2 * i**2 + c3 * i**3 + c * second
    gaps = [G + y**2 * (t + psi) ** 2 - g**2 * (1 + t**2) for t in (ta, tb)]
    rest = (p * y**2 + f) * sp.sqrt(G - v**2) + m * psi - a * gaps[0] - b * gaps[1]
    parts = unknowns[:6]
    upper = [(j, k) for j in range(6) for k in range(j, 6)]

    def function(given, what):
        first = [sp.diff(what, x) for x in parts]
        both = [sp.diff(what, parts[j], parts[k]) for j, k in upper]
        return sp.lambdify((unknowns, given), [what, *first, *both], "numpy", cse=True)

    length = sp.sqrt(G - v**2)
    return SimpleNamespace(
        upper=upper,
        rest=function((p, f, m, ta, tb, g), rest),
        layer=function((square, c, c2, c3), w),
        length=function((), length),
        gaps=[function((ta, tb, g), gap) for gap in gaps],
        volume=sp.lambdify((unknowns, ()), y**2 * length, "numpy"),
    )


class Tube:
    """A tube of fiber angles [degree], ``length`` and the wall ``inner`` to ``outer`` (rho_i, rho_o) in radii of the fiber
    surface; a membrane of area ``area`` where that is given. ``rubber`` is C01, C20, C30 over C10.
    """

    def __init__(
        self, alpha, beta, length, *, inner=None, outer=None, area=None, rubber=(0, 0, 0), gamma=1.0, loose=True
    ):
        self.ta, self.tb = np.tan(np.radians([alpha, beta]))
        self.length, self.rubber, self.gamma, self.loose = length, rubber, gamma, loose
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

    def _cells(self, x, y, G, psi, a, b, p, f, m, gamma):
        have, h = _symbolic(), np.diff(x)
        unknowns = (y[:-1], y[1:], G, psi, a, b, h)
        one = np.ones(len(h))

        def values(found):
            return np.array([one * part for part in found])

        rest = values(have.rest(unknowns, (p, f, m, self.ta, self.tb, gamma)))
        w = sum(weight * values(have.layer(unknowns, (square, *self.rubber))) for weight, square in self.layers)
        gaps = [values(gap(unknowns, (self.ta, self.tb, gamma))) for gap in have.gaps]
        return h, rest - w, w[0], gaps, values(have.length(unknowns, ())), have.volume(unknowns, ()) * one

    def solve(self, n, p, f=0.0, m=0.0, held=None, target=0.0, steps=12):
        """Outputs on n cells; ``held`` is "length" or "rotation", whose load is unknown then (its outputs go by "load")."""
        have, x = _symbolic(), self.nodes(n)
        y, G, psi = np.ones(n + 1), np.ones(n), np.zeros(n)
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
                h, L, w, gaps, length, volume = self._cells(x, y, G, psi, a, b, now, force, torque, gamma)
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
                    if self.loose:
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
                        R[last] = np.sum(h * psi) - goal
                        other[where[3]] = h
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
        h, _, w, _, length, volume = self._cells(x, y, G, psi, a, b, p, f, m, gamma)
        middle = y[n // 2]
        return np.array([h @ length[0], h @ volume, h @ psi, h @ w, middle, load]), SimpleNamespace(x=x, y=y, a=a, b=b)

    def extrapolated(self, p, *, cells=100, **loads):
        """Outputs, the held load last, extrapolated from three meshes."""
        one, two, three = (self.solve(cells * factor, p, **loads)[0] for factor in (1, 2, 4))
        first, second = (4 * two - one) / 3, (4 * three - two) / 3
        return (16 * second - first) / 15

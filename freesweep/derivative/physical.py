"""The physical tube's density over all cells of a mesh, as dual numbers: a thick wall, threads that cannot push, or both.

Where cells settle is told by :mod:`settled`; a taut family whose multiplier is negative goes slack, a slack one beyond its
reach taut. One more step, in dual numbers, gives all first derivatives of the four; bonded fibers stay taut.
"""

from copy import copy
from functools import cache

import numpy as np

from ..description.families import followed
from .dual import Dual, maximum, select, sqrt, value_of
from .equilibrium import NotFound
from .physics import Physics
from .settled import NO_ROOM, Local, Settled, equations, jacobian, newton
from .twins import twin

CHANGES = 30
FIRST_CELLS = 48  # in which the kernel tells where they settle; their neighbours begin there
BEYOND = 1e-12  # by which a family may be beyond its reach, or a multiplier negative, of the load


@cache
def walls():
    """Strain energy of a wall, where it is narrowest, where loose fibers settle, and the tube of a body's radius."""
    from ..solver.physics import body, physical, wall

    counted = twin(wall.points)

    def points(inner, area):
        """As many Gauss points in all cells as one of them needs."""
        both = np.broadcast_arrays(inner.value, area.value)
        thickest = np.argmax(both[1] / both[0])
        return counted(*(float(one[thickest]) for one in both))

    def needs_most(near, far, count):
        """Of all cells, if one of them does."""
        return bool(np.any(value_of(near) < wall.LEAST[count] * value_of(far)))

    def lies_inside(wall):
        """Of each cell: a body's own radius rounds what is no wall inside to next to none, here and there."""
        return (value_of(wall[1]) > 0.0) & (value_of(wall[1]) < 1.0)

    changes = tuple(map(twin, (body.as_tube, body.of_partials, body.of_integrals, body.of_multipliers)))
    narrowest = twin(wall.narrowest, lies_inside=lies_inside, select=select)
    return twin(wall.energy, points=points, needs_most=needs_most), narrowest, twin(physical.place), changes


class PhysicalTube(Physics):
    """As :class:`Physics`, of tubes with a thick wall, loose fibers, or both."""

    settled, beyond = None, 0.0

    def settle(self, y, v, share):
        """Where each cell settles: numbers of the tube there, its slope, and the weight of its energy; the four, which
        families are taut, and the least G - 1, values all; and the cell whose tube it is.
        """
        given, load = self.properties(share)
        energy, narrowest, place, (as_tube, *_) = walls()
        (H, D, area), w, (gamma, rubber, wall, p, f, m, e) = as_tube(y, v, given, load)
        f = f + self.beyond
        local, y, v = Local(y, p, f, m, H + D, H - D, gamma * gamma, area, rubber, wall), y.value, w.value

        def value(number):
            return np.broadcast_to(number.value if isinstance(number, Dual) else number, y.shape)

        rubber, wall = tuple(Dual(c.value) for c in local.rubber), tuple(Dual(c.value) for c in local.wall)
        p, f, m, t_a, t_b, gg = map(value, (local.p, local.f, local.m, local.t_a, local.t_b, local.gg))
        T = np.maximum(p * y * y + f, NO_ROOM)
        weighed = Dual(e * area.value)
        low = np.maximum(v * v, value(narrowest(Dual(y), wall))) - 1.0
        plain = Local(y, p, f, m, t_a, t_b, gg, weighed, rubber, wall)
        if self.settled is None:
            self.settled = self._first(place, share, v, T, (H, D), plain)
        known = self.settled.at(share)
        four, alpha, beta = known.four.copy(), known.alpha.copy(), known.beta.copy()
        size, families = np.abs(T) + np.abs(m) + NO_ROOM, len(followed(self.tube))
        four[0] = np.maximum(four[0], low + 1e-9)
        for _ in range(CHANGES):
            four[2] *= alpha
            four[3] *= beta
            if self.is_locked:  # threads bear it all: where one is slack, only the other's pull tells the twist
                pull = 0.5 * T / np.sqrt(np.maximum(1.0 + four[0] - v * v, NO_ROOM))
                four[2], four[3] = np.where(alpha & ~beta, pull, four[2]), np.where(beta & ~alpha, pull, four[3])
            four = newton(energy, plain, v, low, four, (alpha, beta))
            if not self.tube.is_loose:
                break
            W = energy(Dual(y), Dual(four[0]), Dual(four[1]), weighed, rubber, wall)
            s = np.sqrt(np.maximum(1.0 + four[0] - v * v, NO_ROOM))
            _, _, over_a, over_b = equations(plain, s, four, value(W[2]), value(W[3]))
            new_alpha = np.where(alpha, four[2] >= -BEYOND * size, (over_a > BEYOND) & (families > 0))
            new_beta = np.where(beta, four[3] >= -BEYOND * size, (over_b > BEYOND) & (families > 1))
            if np.array_equal(new_alpha, alpha) and np.array_equal(new_beta, beta):
                break
            alpha, beta = new_alpha, new_beta
        else:
            raise NotFound
        self.settled = Settled(share, four, alpha, beta)
        return local, w, e, four, alpha, beta, low, given

    def _first(self, place, share, v, T, angles, plain):
        """From the kernel itself, in some cells; ``angles``: half the sum and difference of both tangents."""
        from ..solver.load import Load

        y, some = plain.y, np.unique(np.linspace(0, len(v) - 1, min(len(v), FIRST_CELLS)).astype(int))
        four, taut = np.zeros((4, len(some))), np.ones((2, len(some)), bool)

        def at(number, j):
            number = number.value if isinstance(number, Dual) else np.asarray(number)
            return float(number[j] if np.size(number) > 1 else number.reshape(-1)[0])

        gamma = float(np.sqrt(plain.gg[0]))
        for k, j in enumerate(some):
            cell = *(at(one, j) for one in angles), at(plain.area, j)
            own, layers = tuple(at(c, j) for c in plain.rubber), tuple(at(c, j) for c in plain.wall)
            load = Load(gamma, own, layers, 0.0, 0.0, float(plain.m[j]), 1.0)
            _, four[0, k], four[1, k], taut[0, k], taut[1, k] = place(float(y[j]), float(v[j]), float(T[j]), cell, load)
        return Settled(share[some], four, taut[0], taut[1])

    def local(self, y, v, share):
        """As of :class:`Physics`."""
        own, v, e, four, alpha, beta, low, given = self.settle(y, v, share)
        energy, _, _, (_, of_partials, of_integrals, _) = walls()
        G_1, psi, n = four[0], four[1], len(share)
        W = energy(y, Dual(G_1), Dual(psi), own.area * e, own.rubber, own.wall) if e > 0.0 else [Dual(np.zeros(n))] * 10
        s = _root(G_1 + 1.0 - v * v)
        left = equations(own, s, four, W[2], W[3])
        tension = own.p * y * y + own.f
        T = np.maximum(tension.value, NO_ROOM)
        w = [np.broadcast_to(one.value, n) for one in W]
        tangents = [np.broadcast_to(one.value, n) for one in (own.t_a, own.t_b)]
        matrix = jacobian(y.value, T, np.broadcast_to(s.value, n), four, tangents, (alpha, beta), w[7:10])
        count = y.parts.shape[0]
        parts = np.stack([_parts(one, count, n) for one in left], axis=-1)  # (count, n, 4)
        parts[..., 2] *= alpha
        parts[..., 3] *= beta
        moved = -np.linalg.solve(matrix, parts.transpose(1, 2, 0)).transpose(1, 2, 0)  # (4, count, n)
        G, twist, a, b = (Dual(value, part) for value, part in zip(four, moved))
        s = _root(G + 1.0 - v * v)
        by_a, by_b = own.t_a + twist, own.t_b + twist
        W_y = _with(W[1], w[5], w[6], moved)
        L_y = 2.0 * own.p * y * s - W_y - 2.0 * y * (a * by_a * by_a + b * by_b * by_b)
        L_v = -(tension * v / s)
        if e == 0.0:
            W = energy(y, Dual(G_1), Dual(psi), own.area, own.rubber, own.wall)
            w = [np.broadcast_to(one.value, n) for one in W]
        stored = _with(W[0], w[2], w[3], moved)
        room = np.minimum(G_1 - low, np.broadcast_to(tension.value, n))
        self.seen = of_integrals(given, (s, y * y * s, twist, stored, 0.0))[:4]
        self.there = G, twist, (a, b), given
        return of_partials(given, (room, L_y, L_v, 0.0, 0.0, 0.0))[:3]

    def integrands(self, y, v, share):
        """As of :class:`Physics`."""
        return self.seen

    def place(self, y, v, share):
        """As of :class:`Physics`."""
        G_1, twist, pulls, given = self.there
        return G_1, twist, self.tensions(given, *walls()[-1][-1](given, 0.0, *pulls)[1:])

    def at_flux(self, y, flux, share):
        """As of :class:`Physics`: that of a uniform tube of the same resultant, which a stronger pull makes."""
        given, load = self.properties(share)
        _, _, (*_, p, f, _, _) = walls()[-1][0](y, 0.0, given, load)
        T, own, level = p * y * y + f, flux, Dual(np.zeros(len(share)))
        if self.tube.is_body:  # along whose meridian nothing rises
            _, _, _, R, rise, _ = given
            own, level = flux / (R * R * R), -(rise * y) / R
        there = copy(self)
        there.beyond = own * own / (T + sqrt(T * T + own * own))
        there.settled = self.settled.at(share)
        there.local(y, level, share)
        return there.place(y, level, share)

    def begin(self, other):
        """As of :class:`Physics`."""
        self.settled = other.settled

    def kinks(self, segments, cells=slice(None)):
        """As of :class:`Physics`: where the multiplier of the family that goes slack vanishes, seen from its taut side."""
        share, four, *taut = (part[..., cells] for part in self.settled)
        found = []
        for family, mu in zip(taut, four[2:]):
            for j in np.flatnonzero(family[1:] != family[:-1]):
                low, high = share[j], share[j + 1]
                if np.any((segments > low) & (segments < high)):
                    continue
                near = j - np.arange(3) if family[j] else j + 1 + np.arange(3)
                near = near[(near >= 0) & (near < len(share))]
                near = near[np.cumprod(family[near]).astype(bool)]
                found.append(np.clip(_vanishes(share[near], mu[near], low if family[j] else high), low, high))
        return np.unique(found)

    def meridian(self, y, v, share):
        """As of :class:`Physics`."""
        _, slope, _, four, *_ = self.settle(Dual(y), Dual(v), share)
        return slope.value, np.sqrt(np.maximum(1.0 + four[0] - slope.value**2, NO_ROOM))


def _vanishes(x, mu, near):
    """Where the polynomial through up to three points vanishes, beyond the first one, or that where it does not."""
    at = x[0]
    roots = np.roots(np.polyfit((x - at) / (np.ptp(x) + NO_ROOM), mu, len(x) - 1)) if len(x) > 1 else np.zeros(0)
    roots = roots[np.isreal(roots)].real * (np.ptp(x) + NO_ROOM) + at
    beyond = roots[(roots - at) * (at - x[-1]) >= 0.0]
    return beyond[np.argmin(np.abs(beyond - at))] if len(beyond) else near


def _root(square):
    return sqrt(maximum(square, NO_ROOM))


def _parts(number, count, n):
    parts = number.parts if isinstance(number, Dual) else None
    return np.zeros((count, n)) if parts is None else np.broadcast_to(parts, (count, n))


def _with(number, by_G, by_twist, moved):
    """A number with what it changes by as G and psi do."""
    count, n = moved.shape[1:]
    return Dual(number.value, _parts(number, count, n) + by_G * moved[0] + by_twist * moved[1])

"""Where the meridional stretch G and the twist rate psi of a physical tube settle (:mod:`freesweep.solver.physics.relaxed`),
with multipliers a and b of both families::

    T/(2 s) - W_G = a + b,    m - W_psi = 2 y^2 (a (t_a + psi) + b (t_b + psi)),
    g = 0 or multiplier = 0   of each family,    g = G + y^2 (t + psi)^2 - gamma^2 (1 + t^2)

Newton's method solves that in all cells at once, for families that are taut, or slack.
"""

from typing import NamedTuple

import numpy as np

from .dual import Dual
from .equilibrium import NotFound

STEPS = 60
SHORT = 0.1  # share of the way to the edge of the domain that a step in G leaves
ROUNDED = 1e-7  # of G: a shorter way to the edge is rounding; from a longer one steps grow until they settle
NO_ROOM = 1e-30


class Settled(NamedTuple):
    """Where cells at places ``share`` settle: the four unknowns, (4, cells), and which families are taut."""

    share: np.ndarray
    four: np.ndarray
    alpha: np.ndarray
    beta: np.ndarray

    def at(self, share):
        """A first guess in other cells."""
        if np.array_equal(share, self.share):
            return self
        known, own = np.unique(self.share, return_index=True)  # of several meshes
        near = own[np.clip(np.searchsorted(0.5 * (known[1:] + known[:-1]), share), 0, len(known) - 1)]
        four = np.stack([np.interp(share, known, row[own]) for row in self.four])
        return Settled(share, four, self.alpha[near], self.beta[near])


class Local(NamedTuple):
    """A cell's numbers, values only or dual ones."""

    y: object
    p: object
    f: object
    m: object
    t_a: object
    t_b: object
    gg: object
    area: object
    rubber: tuple
    wall: tuple


def equations(local, s, four, w_G, w_p):
    """The four equations' left sides."""
    G_1, psi, a, b = four
    y2 = local.y * local.y

    def reach(t):
        return G_1 + 1.0 + y2 * (t + psi) * (t + psi) - local.gg * (1.0 + t * t)

    first = (local.p * y2 + local.f) / (2.0 * s) - w_G - a - b
    second = local.m - w_p - 2.0 * y2 * (a * (local.t_a + psi) + b * (local.t_b + psi))
    return first, second, reach(local.t_a), reach(local.t_b)


def jacobian(y, T, s, four, tangents, taut, second):
    """Their derivatives by the four, (cells, 4, 4); a slack family's last equation is that its multiplier is 0. ``tangents``
    of both families, whether they are ``taut``; ``second`` derivatives of the wall's energy by G and psi.
    """
    (_, psi, a, b), (t_a, t_b), (alpha, beta), (w_GG, w_Gp, w_pp) = four, tangents, taut, second
    out = np.zeros((len(psi), 4, 4))
    twice = 2.0 * y * y
    by_a, by_b = twice * (t_a + psi), twice * (t_b + psi)
    out[:, 0, 0], out[:, 0, 1], out[:, 0, 2], out[:, 0, 3] = -0.25 * T / s**3 - w_GG, -w_Gp, -1.0, -1.0
    out[:, 1, 0], out[:, 1, 1], out[:, 1, 2], out[:, 1, 3] = -w_Gp, -w_pp - twice * (a + b), -by_a, -by_b
    out[:, 2, 0], out[:, 2, 1], out[:, 2, 2] = alpha, alpha * by_a, ~alpha
    out[:, 3, 0], out[:, 3, 1], out[:, 3, 3] = beta, beta * by_b, ~beta
    return out


def newton(energy, plain, v, low, four, taut):
    """The four of all cells from a first guess; families (alpha, beta) are ``taut``, G - 1 is above ``low``. Raises
    :class:`NotFound`.
    """
    (alpha, beta), own = taut, (plain.area, plain.rubber, plain.wall)
    for _ in range(STEPS):
        W = energy(Dual(plain.y), Dual(four[0]), Dual(four[1]), *own)
        w = [np.broadcast_to(one.value if isinstance(one, Dual) else one, v.shape) for one in W]
        s = np.sqrt(np.maximum(1.0 + four[0] - v * v, NO_ROOM))
        left = equations(plain, s, four, w[2], w[3])
        wrong = np.stack(
            [left[0], left[1], np.where(alpha, left[2], four[2]), np.where(beta, left[3], four[3])], axis=1
        )
        T = plain.p * plain.y**2 + plain.f
        matrix = jacobian(plain.y, T, s, four, (plain.t_a, plain.t_b), (alpha, beta), w[7:10])
        try:
            step = -np.linalg.solve(matrix, wrong[..., None])[..., 0].T
        except np.linalg.LinAlgError:
            raise NotFound from None
        before, way = four[0], four[0] - low
        four = four + step
        four[0] = np.maximum(four[0], low + SHORT * way)
        moved = max(np.max(np.abs(four[0] - before) / (way + ROUNDED * (1.0 + before))), np.max(np.abs(step[1])))
        if not np.isfinite(moved):
            raise NotFound
        if moved < 1e-8:
            return four
    raise NotFound

"""The uniform tube: its density, and its stationary stretch carried along the loads.

With q = y^2, T = p q + f and k = 1 for ``energy="full"``, 0 for "principal" (theory of the thesis, Eqs. 2.2 - 2.11)::

    G   = A - D^2 q - B/q,   A = gamma^2 (1 + H^2 + D^2),   B = gamma^4 H^2             (Eqs. 2.3, 2.4)
    psi = H (gamma^2/q - 1)
    i   = G + q (1 + k psi^2) + 1/(G q) - 3                                              I1 - 3
    w   = i + c (G q + 1/q + (1 + k psi^2)/G - 3) + c2 i^2 + c3 i^3                      (Eq. 2.5, Yeoh's terms)
    U   = T sqrt(G) - a w + m psi

Everything is dimensionless and an array over tubes: lengths by r0, pressure by C10, force by pi r0^2 C10, torque by
pi r0^3 C10, energy by pi r0^3 C10.
"""

from typing import NamedTuple

import numpy as np

from .divided_differences import Divided

LARGEST_CHANGE = 0.06  # relative, of q in one step
NEWTON_ITERATIONS, NEARBY = 40, 0.2  # of one stretch, and how far, relative, it may lie from its first guess
SMALLEST_STEP = 1e-7  # of the way: below it the path turns back


class Tubes(NamedTuple):
    """Arrays (n,); ``half`` is half the length, ``weight`` that of the strain energy: 0 for the locked shape; ``ratio``,
    ``second``, ``third`` are C01, C20, C30 over C10.
    """

    H: np.ndarray
    D: np.ndarray
    area: np.ndarray
    gamma: np.ndarray
    ratio: np.ndarray
    shear: np.ndarray
    pressure: np.ndarray
    force: np.ndarray
    torque: np.ndarray
    weight: np.ndarray
    half: np.ndarray
    second: np.ndarray
    third: np.ndarray

    def at(self, which):
        """Some of the tubes."""
        return Tubes(*(column[which] for column in self))

    def columns(self):
        """The tubes as (n, 1), to meet places along them."""
        return Tubes(*(column[:, None] for column in self))

    def toward(self, other, t):
        """These tubes, a fraction ``t`` of the way to the loads and fiber extension of the ``other``."""
        changing = ("gamma", "pressure", "force", "torque")
        return self._replace(
            **{name: getattr(self, name) + t * (getattr(other, name) - getattr(self, name)) for name in changing}
        )


def density(tube, u, q) -> Divided:
    """The density U of the uniform tube as a function of q, seen from ``u``."""
    q = Divided.of(u, q)
    r = q.inverse()
    gg = tube.gamma**2
    G = q * (-(tube.D**2)) + r * (-((gg * tube.H) ** 2)) + gg * (1.0 + tube.H**2 + tube.D**2)
    psi = r * (gg * tube.H) + (-tube.H)
    sheared = psi * psi * tube.shear + 1.0
    K = G * q
    i = G + q * sheared + K.inverse() + (-3.0)
    w = i + i * i * tube.second + i * i * i * tube.third + (K + r + sheared * G.inverse()) * tube.ratio
    T = q * tube.pressure + tube.force
    return T * G.root() - w * (tube.weight * tube.area) + psi * tube.torque


def state(tube, q):
    """``(G, psi, w, T)`` at q; w keeps its digits near q = 1."""
    gg = tube.gamma**2
    stretched = (tube.gamma - 1.0) * (tube.gamma + 1.0)
    b = q - 1.0
    a = stretched * (1.0 + tube.D**2 - gg * tube.H**2) + b * ((gg * tube.H) ** 2 / q - tube.D**2)  # G - 1
    G = 1.0 + a
    psi = tube.H * (stretched - b) / q
    sheared = tube.shear * psi**2
    both = a + b + a * b  # G q - 1
    i = a * a / G + b * both / (G * q) + q * sheared
    w = i + tube.second * i**2 + tube.third * i**3 + tube.ratio * (a * a / G + b * both / q + sheared / G)
    return G, psi, w, tube.pressure * q + tube.force


def stationary(tubes, q):
    """The stationary stretch near q at which U is largest, by Newton; NaN where there is none."""
    start = q
    for _ in range(NEWTON_ITERATIONS):
        U = density(tubes, q, q)
        q = q - np.clip(0.5 * U.slope / U.second, -0.02 * q, 0.02 * q)
    U = density(tubes, q, q)
    sound = (U.second < 0.0) & (np.abs(q - start) < NEARBY * start) & (np.abs(U.slope / U.second) < 1e-11 * q)
    return np.where(sound, q, np.nan)


def follow(u, start, end):
    """Carry the stationary q of uniform tubes from one load to another; ``(u, t)``: below 1 is where it turns back."""
    u, t, step = u.copy(), np.zeros(len(u)), np.full(len(u), 0.125)
    with np.errstate(all="ignore"):
        while (on := np.flatnonzero((t < 1.0) & (step > SMALLEST_STEP))).size:
            ahead = np.minimum(1.0, t[on] + step[on])
            now = start.at(on).toward(end.at(on), ahead)
            trial, change = u[on].copy(), np.full(on.size, np.inf)
            for _ in range(25):
                near = np.abs(trial - u[on]) < LARGEST_CHANGE * u[on]
                if np.all(~near | (np.abs(change) < 1e-15 * trial)):
                    break
                U = density(now, trial, trial)
                change = -0.5 * U.slope / np.where(U.second < 0.0, U.second, np.nan)  # U.second is U''/2
                trial = np.where(near, trial + change, trial)
            carried = near & (np.abs(change) < 1e-12 * trial) & (now.pressure * trial + now.force > 0.0)
            u[on], t[on] = np.where(carried, trial, u[on]), np.where(carried, ahead, t[on])
            step[on] *= np.where(carried, 1.5, 0.5)
    return u, t


def settled(tubes):
    """``(rest, corner)``: the tubes without loads, and with all of them at the pressure at which they have settled.

    That pressure is the largest of twice an axial compression, the torque and gamma^2 - 1.
    """
    nothing = np.zeros(len(tubes.half))
    rest = tubes._replace(gamma=nothing + 1.0, pressure=nothing, force=nothing, torque=nothing)
    pressure = np.maximum(np.maximum(2.0 * np.maximum(-tubes.force, 0.0), np.abs(tubes.torque)), tubes.gamma**2 - 1.0)
    return rest, tubes._replace(pressure=pressure)


def to_corner(tubes):
    """``(corner, q, carried)``: where the pressure alone begins to change, and the stationary q there, if it is met."""
    rest, corner = settled(tubes)
    u, t = np.ones(len(tubes.half)), np.ones(len(tubes.half))
    if (loaded := np.flatnonzero((tubes.force != 0.0) | (tubes.torque != 0.0) | (tubes.gamma != 1.0))).size:
        u[loaded], t[loaded] = follow(u[loaded], rest.at(loaded), corner.at(loaded))
    return corner, u, t == 1.0


def stretch(tubes):
    """The stationary q = y^2 of uniform tubes on the branch from the undeformed cylinder; ``(u, carried)``.

    Loads and gamma - 1 rise in proportion until they have :func:`settled`, then the pressure alone changes. Locked tubes,
    of weight 0, have a closed form (Eq. 2.12).
    """
    gg = tubes.gamma**2
    A = gg * (1.0 + tubes.H**2 + tubes.D**2)
    u = (A + np.sqrt(A**2 - 3.0 * (gg * tubes.D * tubes.H) ** 2)) / (3.0 * tubes.D**2)
    carried = np.ones(len(u), bool)
    if (walk := np.flatnonzero(tubes.weight > 0.0)).size:
        end = tubes.at(walk)
        corner, u[walk], there = to_corner(end)
        u[walk], further = follow(u[walk], corner, end)
        carried[walk] = there & (further == 1.0)
    return u, carried

"""Tubes and independent solutions for the tests of held states."""

from itertools import pairwise

import numpy as np
from oracle import ENERGIES, NoState, compiled, half_sum_and_difference
from scipy.integrate import solve_bvp

from freesweep import Actuator, MooneyRivlin

RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)  # of the source's prototypes A, B, C
R0, WALL = 4.76e-3, 1.59e-3
SECTION = np.pi * R0**2


def tube(alpha, beta, length=0.141, **more):
    given = {"length": length, "radius": R0, "wall": WALL, "material": RUBBER}
    return Actuator(**{"alpha": alpha, "beta": beta} | given | more)


def rising(share):
    return 45 + 10 * np.tanh((share - 0.5) / 0.2)


MUSCLE = tube(30, -30, 0.192, material=MooneyRivlin(0.11e6, 0.06e6), fiber_extension=1.005)
B, C = tube(0, 30, 0.131), tube(0, 60, 0.143)
STEPPED = [(0, -35), (0.4, -35), (0.4, -50), (1, -50)]
THICKER = [(0, 1.2e-3), (0.6, 1.2e-3), (0.6, 2.0e-3), (1, 2.0e-3)]
VARYING = [
    tube([(0, 15), (1, 30)], [(0, -45), (1, -35)], 0.06, fiber_extension=1.002),
    tube(20, lambda share: -rising(share), 0.05, energy="principal"),
    tube([(0, 20), (0.5, 28), (1, 20)], STEPPED, 0.08, wall=THICKER, fiber_extension=1.01),
    tube(25, -50, 0.05, wall=THICKER, fiber_radius=5.5e-3, fiber_extension=1.003, energy="principal"),
]


def scales(actuator):
    """Units of length, force and torque, and pressure."""
    r, c10 = actuator.fiber_surface, actuator.material.c10
    return r, np.pi * r**2 * c10, np.pi * r**3 * c10, c10


def by_collocation(actuator, pressure, held, target, guess, other=0.0, shape=None):
    """The held state by SciPy's collocation with the multiplier as unknown parameter: results of the whole tube.

    Dimensionless as in ``oracle.collocation``; without a ``target`` the multiplier is ``guess``.
    Returns ``(multiplier, length, volume, rotation, energy, y(x))``.
    """
    canonical, state = compiled()["canonical"], compiled()["state"]
    r, c10 = actuator.fiber_surface, actuator.material.c10
    end, p, gamma = actuator.length / r, pressure / c10, actuator.fiber_extension
    ratio, shear = actuator.material.c01 / c10, ENERGIES[actuator.energy]
    yeoh = actuator.material.c20 / c10, actuator.material.c30 / c10
    profiles = {name: getattr(actuator, name) for name in ("alpha", "beta", "wall")}

    def at(name, share, low, high):
        value = profiles[name]
        if callable(value):
            return value(share)
        if np.ndim(value) == 0:
            return np.full_like(share, value)
        x, y = np.array(value, float).T
        k = np.searchsorted(x, 0.5 * (low + high)) - 1
        return y[k] + (share - x[k]) / (x[k + 1] - x[k]) * (y[k + 1] - y[k])

    # jumps and bends: every piece between them is stretched over 0..1, all of them side by side
    breaks = sorted(
        {0.0, 1.0, *(q[0] for value in profiles.values() if isinstance(value, (list, tuple)) for q in value)}
    )
    pieces = list(pairwise(breaks))

    def rates(t, z, parameters):
        f, m = (parameters[0], other) if held == "length" else (other, parameters[0])
        out = []
        for (low, high), (y, q, *_) in zip(pieces, z.reshape(len(pieces), 6, -1)):
            share = low + (high - low) * t
            H, D = half_sum_and_difference(at("alpha", share, low, high), at("beta", share, low, high))
            area = ((actuator.radius + at("wall", share, low, high)) ** 2 - actuator.radius**2) / r**2
            values = (H, D, area, gamma, ratio, shear, p, f, m, 1.0, *yeoh)
            G, psi, w, T = state(y, values)
            root = np.sqrt(T * T + q * q)
            v, s = -q * np.sqrt(G) / root, T * np.sqrt(G) / root
            rows = np.array([v, canonical(y, v, values)[0], s, y * y * s, psi + 0 * y, area * w])
            out.append((high - low) * end * rows)
        return np.concatenate(out)

    def ends(left, right, parameters):
        left, right = left.reshape(-1, 6), right.reshape(-1, 6)
        kept = parameters[0] - guess if target is None else right[-1, 2 if held == "length" else 4] - target
        joints = (left[1:] - right[:-1]).ravel()  # stretch, meridional force and integrals go on
        return np.concatenate([[left[0, 0] - 1, right[-1, 0] - 1, kept], left[0, 2:], joints])

    t = np.linspace(0, 1, 101)
    start = np.zeros((len(pieces), 6, len(t)))
    start[:, 0] = 1.0
    if shape is not None:
        H, D = half_sum_and_difference(actuator.alpha, actuator.beta)
        y, v = shape(t * end), shape(t * end, 1)
        values = (
            H,
            D,
            1.0,
            gamma,
            ratio,
            shear,
            p,
            *((guess, other) if held == "length" else (other, guess)),
            1.0,
            *yeoh,
        )
        G, psi, w, T = state(y, values)
        s = np.sqrt(G - v * v)
        rows = (y * y * s, psi, w * ((actuator.radius + actuator.wall) ** 2 - actuator.radius**2) / r**2)
        sums = [np.concatenate([[0], np.cumsum(0.5 * (q[1:] + q[:-1]) * end / 100)]) for q in (s, *rows)]
        start[0] = [y, -T * v / s, *sums]
    with np.errstate(invalid="ignore"):
        found = solve_bvp(rates, ends, t, start.reshape(-1, len(t)), p=[guess], tol=1e-9, max_nodes=20_000)
    if not found.success:
        raise NoState(found.message)
    return found.p[0], *found.y[-4:, -1], found.sol


def close(dataset, name, expected, size, unsure=1e-8):
    error, bound = abs(dataset[name].item() - expected), dataset[f"{name}_error"].item()
    assert error < 1e-6 * size, name
    assert error <= bound + unsure * size, name
    assert bound < 1.1e-6 * size, name


def random_designs(count, seed):
    """Angles of region II, sections and loads; fibers 5 degrees or more from straight, alpha + beta 8 or more."""
    random = np.random.default_rng(seed)
    while count:
        alpha, beta = random.uniform(5, 75), -random.uniform(5, 75)
        if abs(alpha + beta) < 8:
            continue
        count -= 1
        radius = random.uniform(3e-3, 9e-3)
        material = MooneyRivlin(random.uniform(0.1e6, 0.4e6), random.uniform(0, 0.2e6))
        yield random, Actuator(
            alpha=alpha, beta=beta, length=radius * random.uniform(5, 40), radius=radius, material=material,
            wall=radius * random.uniform(0.1, 0.4), energy=str(random.choice(["full", "principal"])),
        )  # fmt: skip


def sized(actuator, pressure):
    r = actuator.fiber_surface
    return np.pi * r**2 * pressure, np.pi * r**3 * pressure


HELD = [
    *VARYING,
    MUSCLE,
    tube(20, -50, 0.05, fiber_extension=1.01),
    tube(15, -35, 0.06, fiber_radius=5.5e-3, energy="principal"),
    tube(40, -60, 0.1, fiber_extension=1.005, energy="principal"),
]

"""Blocked force and torque against the theory's numbers and closed forms, the inflated tube and independent solutions."""

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from oracle import ENERGIES, NODES, WEIGHTS, NoState, compiled, first_integral, half_sum_and_difference
from scipy.integrate import solve_bvp

from freesweep import (
    Actuator,
    ActuatorError,
    MooneyRivlin,
    blocked_force,
    blocked_torque,
    closed_form,
    corrected_torque,
    inflate,
)
from freesweep.status import COMPRESSED, OK

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
    breaks = sorted({0.0, 1.0, *(q[0] for value in profiles.values() if isinstance(value, list) for q in value)})
    pieces = list(pairwise(breaks))

    def rates(t, z, parameters):
        f, m = (parameters[0], other) if held == "length" else (other, parameters[0])
        out = []
        for (low, high), (y, q, *_) in zip(pieces, z.reshape(len(pieces), 6, -1)):
            share = low + (high - low) * t
            H, D = half_sum_and_difference(at("alpha", share, low, high), at("beta", share, low, high))
            area = ((actuator.radius + at("wall", share, low, high)) ** 2 - actuator.radius**2) / r**2
            values = (H, D, area, gamma, ratio, shear, p, f, m, 1.0)
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
        values = (H, D, 1.0, gamma, ratio, shear, p, *((guess, other) if held == "length" else (other, guess)), 1.0)
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


# --- the theory's numbers


def test_muscle_with_extensible_fibers_pulls_less_by_an_offset():
    pressures = [0.03e6, 0.05e6, 0.1e6]
    assert blocked_force(MUSCLE, pressures)["force"].values == pytest.approx([6.99, 14.02, 31.61], abs=5e-3)
    ideal = blocked_force(dataclasses.replace(MUSCLE, fiber_extension=1.0), pressures)
    assert ideal["force"].values == pytest.approx([10.68, 17.80, 35.59], abs=5e-3)
    assert (ideal["stable"] == 1).all()


@pytest.mark.parametrize(
    ("pair", "per_pressure", "slack"),
    [((0, 30), (-2.5, 3.0), 1), ((0, 45), (-0.5, 1.0), 1), ((10, -40), (-0.96, 1.46), 1),
     ((10, 50), (-0.21, 0.71), 1), ((0, 60), (0.17, 0.33), 0)],
)  # fmt: skip
def test_fibers_of_blocked_torque_may_have_to_push(pair, per_pressure, slack):
    """Multipliers of the constraints at y = 1 over pressure (theory, section 3)."""
    held = blocked_torque(tube(*pair), 2e4)
    for name, angle, expected in zip(("alpha", "beta"), pair, per_pressure):
        multiplier = held[f"fiber_tension_{name}"] * np.cos(np.radians(angle)) / (2 * SECTION * 2e4)
        assert multiplier.values == pytest.approx(np.full(201, expected), abs=5.1e-3), name
    assert held["slack_fiber"] == slack


def test_corrected_torque_of_the_source():
    for actuator, pressures, ratios in (
        (B, [0.03e6, 0.05e6, 0.1e6], [1.17, 1.31, 1.75]),
        (C, [5e4, 1e5], [0.991, 0.982]),
    ):
        for energy in ("full", "principal"):
            corrected = corrected_torque(dataclasses.replace(actuator, energy=energy), pressures)
            ideal = closed_form.blocked_torque(actuator.alpha, actuator.beta, R0, np.array(pressures))
            assert corrected / ideal == pytest.approx(ratios, abs=6e-3 if ratios[0] > 1 else 6e-4)


def corrected_by_quadrature(actuator, pressure):
    """Eqs. 2.21 and 2.22 on the first integral's shape of the McKibben muscle; the end slopes are exact."""
    r, _, unit, c10 = scales(actuator)
    area, ratio, p = ((R0 + WALL) ** 2 - R0**2) / r**2, actuator.material.c01 / c10, pressure / c10
    half, tb = 0.5 * actuator.length / r, np.tan(np.radians(actuator.beta))
    edges = half * np.concatenate([[0], np.geomspace(1e-5, 1, 24)])
    nodes = np.concatenate([a + (b - a) * np.asarray(NODES, float) for a, b in pairwise(edges)])
    weights = (np.diff(edges)[:, None] * np.asarray(WEIGHTS, float)).ravel()
    shape = first_integral(actuator.beta, -actuator.beta, 2 * half, area, ratio, p, stations=nodes)

    def muscle(y):
        G = 1 + tb**2 * (1 - y**2)
        return G, area * (G + y**2 + 1 / (G * y**2) - 3 + ratio * (G * y**2 + 1 / y**2 + 1 / G - 3))

    G, w = muscle(shape.middle)
    constant, y = p * shape.middle**2 * np.sqrt(G) - w, shape.y
    G, w = muscle(y)
    slope_squared = G - (p * y**2 * G / (constant + w)) ** 2
    squared = 1 + 0.25 * tb**2 * (2 - y**2 - 1 / y**2)
    s = np.sqrt(squared - slope_squared)
    volume_y = 2 * np.sum(weights * (2 * y * s + y**2 * 0.25 * tb**2 * (1 / y**3 - y) / s))
    twist_y = 2 * np.sum(weights * -tb / y**3)
    at_end = np.sign(shape.middle - 1) * np.sqrt(1 - (p / constant) ** 2) / (p / constant)
    return -p * (volume_y - 2 * at_end) / twist_y * unit


@pytest.mark.parametrize("actuator", [B, C, tube(0, -45)])
def test_corrected_torque_is_the_quadrature_and_tends_to_the_ideal_one(actuator):
    pressures = np.array([5e4, 200.0])
    ideal = closed_form.blocked_torque(actuator.alpha, actuator.beta, R0, pressures)
    corrected = corrected_torque(actuator, pressures)
    assert corrected / ideal == pytest.approx(
        [corrected_by_quadrature(actuator, p) for p in pressures] / ideal, rel=1e-7
    )
    assert 0 < abs(corrected[1] / ideal[1] - 1) < 4e-4 < abs(corrected[0] / ideal[0] - 1)


# --- closed forms


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


def test_held_cylinders_keep_equation_2_16_and_2_20():
    """At gamma = 1 the cylinder stays, and F = -pi r^2 P (1 + 2/(ta tb)) + M (ta + tb)/(r ta tb), other loads included."""
    for random, actuator in random_designs(60, 1):
        ta, tb = np.tan(np.radians([actuator.alpha, actuator.beta]))
        r, pressure = actuator.radius, random.uniform(5e3, 5e4)
        section, product = np.pi * r**2 * pressure, ta * tb
        torque = random.uniform(-0.1, 0.1) * section * r * abs(product / (ta + tb))
        held = blocked_force(actuator, pressure, torque=torque, x=0.0)
        expected = -section * (1 + 2 / product) + torque * (ta + tb) / (r * product)
        if expected + section < 1e-3 * section:
            continue
        assert held["status"] == OK
        assert held["force"].item() == pytest.approx(expected, rel=1e-9, abs=1e-9 * section)
        assert held["mid_radius"].item() == pytest.approx(r, rel=1e-9)
        force = random.uniform(-0.3, 0.3) * section
        held = blocked_torque(actuator, pressure, force=force, x=0.0)
        expected = (force + section * (1 + 2 / product)) * r * product / (ta + tb)
        assert held["status"] == OK
        assert held["torque"].item() == pytest.approx(expected, rel=1e-9, abs=1e-9 * section * r)
        assert held["deformed_length"].item() == pytest.approx(actuator.length, rel=1e-9)


@pytest.mark.parametrize("energy", ["principal", "full"])
@pytest.mark.parametrize("actuator", [B, C, tube(0, 40, 0.05), tube(-15, 40, 0.08), tube(10, 35, 0.2)])
def test_held_rotation_is_unstable_beyond_the_critical_pressure(actuator, energy):
    actuator = dataclasses.replace(actuator, energy=energy)
    material = (actuator.material.c10, actuator.material.c01)
    critical = closed_form.critical_pressure(
        actuator.alpha, actuator.beta, actuator.length, R0, WALL, *material, energy=energy
    )
    if actuator.beta == 30:
        assert critical == pytest.approx({"principal": 0.205e6, "full": 0.222e6}[energy], abs=5e2)
    assert np.isfinite(critical)
    held = blocked_torque(actuator, critical * np.array([0.5, 0.998, 1.002]), x=0.0)
    assert held["stable"].values.tolist() == [1, 1, 0]
    # the half tube of the solver does not see this mode: the cylinder itself goes on
    assert held["deformed_length"].values == pytest.approx(np.full(3, actuator.length), rel=1e-9)


def test_blocked_torque_of_large_angles_never_buckles():
    assert closed_form.critical_pressure(0, 75, 0.2, R0, WALL, 0.17e6) == np.inf
    assert (blocked_torque(tube(0, 75, 0.2), [1e5, 1e6, 5e6], x=0.0)["stable"] == 1).all()


# --- beyond the critical pressure


@pytest.mark.parametrize(
    ("energy", "pressure"), [("principal", 0.21e6), ("principal", 0.22e6), ("full", 0.23e6), ("full", 0.24e6)]
)
def test_buckled_state_is_shorter_and_twists_harder(energy, pressure):
    from scipy.interpolate import CubicSpline

    actuator = dataclasses.replace(B, energy=energy)
    held = blocked_torque(actuator, pressure, buckled=True)
    assert (held["status"].item(), held["stable"].item()) == (OK, 1)
    ideal = closed_form.blocked_torque(0, 30, R0, pressure)
    assert 0.94 < held["deformed_length"] / B.length < 0.98
    assert 1.02 < held["torque"] / ideal < 1.07
    assert abs(held["twist"][-1]) < 1e-4
    y = held["deformed_radius"].values / R0
    inside = np.sign(y[1:-1] - 1)
    assert np.count_nonzero(np.diff(inside)) == 1  # one half swells, the other thins
    assert min(y.max() - 1, 1 - y.min()) > 0.15
    # an equilibrium, by collocation on the whole tube from a nearby shape
    r, _, unit_torque, c10 = scales(actuator)
    nearby = CubicSpline(held["x"].values / r, 1 + 1.002 * (y - 1))
    m, length, volume, _, energy_, sol = by_collocation(
        actuator, pressure, "rotation", 0.0, held["torque"].item() / unit_torque, shape=nearby
    )
    close(held, "torque", m * unit_torque, ideal, 1e-7)
    close(held, "deformed_length", length * r, B.length, 1e-7)
    close(held, "volume", volume * np.pi * r**3, SECTION * B.length * 2, 1e-7)
    close(held, "strain_energy", energy_ * np.pi * r**3 * c10, held["strain_energy"].item(), 1e-7)
    assert y == pytest.approx(sol(held["x"].values / B.length)[0], abs=1e-5)


# --- against the inflated tube and independent solutions


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


@pytest.mark.parametrize("actuator", HELD)
def test_the_returned_force_inflates_to_the_held_length(actuator):
    pressure, lengths = 6e4, actuator.length * np.array([1.01, 1.0, 0.97])
    held = blocked_force(actuator, pressure, lengths)
    assert (held["status"] == OK).all()
    assert (np.diff(held["force"]) < 0).all()  # a shorter tube pulls less
    for k, length in enumerate(lengths):
        one = held.isel(deformed_length=k)
        free = inflate(actuator, pressure, one["force"].item())
        slope = abs(np.gradient(lengths, held["force"].values)).max() * 3
        allowed = free["deformed_length_error"] + slope * one["force_error"] + 1e-11 * actuator.length
        assert abs(free["deformed_length"] - length) <= allowed
        for name in ("volume", "rotation", "strain_energy", "mid_radius"):
            size = max(abs(free[name].item()), {"rotation": 1.0, "strain_energy": 1e-4}.get(name, 0.0))
            assert abs(free[name] - one[name]) < 3e-6 * size, name
        assert free["deformed_radius"].values == pytest.approx(one["deformed_radius"].values, abs=3e-6 * R0)


@pytest.mark.parametrize("actuator", [a for a in HELD if a is not MUSCLE])
def test_the_returned_torque_inflates_to_the_held_rotation(actuator):
    pressure, angles = 4e4, np.array([0.0, 3.0])
    held = blocked_torque(actuator, pressure, angles)
    assert (held["status"] == OK).all()
    for k, angle in enumerate(angles):
        one = held.isel(rotation=k)
        free = inflate(actuator, pressure, 0.0, one["torque"].item())
        slope = abs(np.diff(angles)[0] / np.diff(held["torque"].values)[0]) * 3
        assert abs(free["rotation"] - angle) <= free["rotation_error"] + slope * one["torque_error"] + 1e-9
        assert one["twist"][-1] == pytest.approx(angle, abs=1e-5)
        for name in ("volume", "deformed_length", "strain_energy", "mid_radius"):
            assert abs(free[name] - one[name]) < 3e-6 * max(
                abs(free[name].item()), 1e-4 if name == "strain_energy" else 0
            ), name


@pytest.mark.parametrize("held_name", ["length", "rotation"])
@pytest.mark.parametrize("actuator", VARYING)
def test_held_states_of_varying_tubes_are_the_independent_ones(actuator, held_name):
    pressure = 6e4
    r, unit_force, unit_torque, _ = scales(actuator)
    size_force, size_torque = sized(actuator, pressure)
    length = held_name == "length"
    held = (
        blocked_force(actuator, pressure, 0.99 * actuator.length) if length else blocked_torque(actuator, pressure, 1.0)
    )
    target = 0.99 * actuator.length / r if length else np.radians(1.0)
    name, unit = ("force", unit_force) if length else ("torque", unit_torque)
    guess = held[name].item() / unit * 1.01
    multiplier, long, volume, rotation, energy, _ = by_collocation(actuator, pressure, held_name, target, guess)
    close(held, name, multiplier * unit, max(size_force if length else size_torque, abs(multiplier * unit)), 1e-7)
    inside = np.pi * (r**2 - actuator.radius**2) * actuator.length
    close(held, "volume", volume * np.pi * r**3 - inside, volume * np.pi * r**3, 1e-7)
    close(held, "strain_energy", energy * unit_torque, energy * unit_torque, 1e-6)
    if length:
        close(held, "rotation", np.degrees(rotation), np.degrees(1.0) * max(1.0, abs(rotation)), 1e-7)
    else:
        close(held, "deformed_length", long * r, actuator.length, 1e-7)


@pytest.mark.parametrize(
    "actuator", [MUSCLE, tube(20, -50, 0.05, fiber_extension=1.01), tube(40, -60, 0.1, fiber_extension=1.002)]
)
def test_the_quadrature_meets_the_held_length(actuator):
    held = blocked_force(actuator, 6e4, 0.98 * actuator.length)
    r, unit_force, _, c10 = scales(actuator)
    area = ((R0 + WALL) ** 2 - R0**2) / r**2
    shape = first_integral(
        actuator.alpha, actuator.beta, actuator.length / r, area, actuator.material.c01 / c10, 6e4 / c10,
        held["force"].item() / unit_force, 0.0, actuator.fiber_extension, actuator.energy,
    )  # fmt: skip
    assert shape.length * r == pytest.approx(0.98 * actuator.length, rel=1e-6)
    assert shape.volume * np.pi * r**3 == pytest.approx(held["volume"].item(), rel=1e-6)
    assert np.degrees(shape.rotation) == pytest.approx(held["rotation"].item(), abs=6e-5)


def test_held_energy_changes_by_the_work_of_the_multiplier():
    """E = P V - W + (other load) x (its displacement) at a held length: dE = -F dl; at a held rotation dE = -M d(delta)."""
    nodes, weights = np.polynomial.legendre.leggauss(14)
    share, counted = np.concatenate([[0.0], 0.5 * (nodes + 1), [1.0]]), 0
    for random, actuator in random_designs(30, 5):
        actuator = dataclasses.replace(actuator, fiber_extension=random.uniform(1.0, 1.01))
        product = np.prod(np.tan(np.radians([actuator.alpha, actuator.beta])))
        pressure, section = random.uniform(0.15, 0.5) * actuator.material.c10, np.pi * actuator.radius**2
        lengths = actuator.length * (1 + np.sign(-2 - product) * 0.03 * share)  # the way it deforms by itself
        torque = random.uniform(-0.05, 0.05) * section * actuator.radius * pressure
        force = random.uniform(-0.1, 0.1) * section * pressure
        angles = np.sign(actuator.alpha + actuator.beta) * -3 * share
        by_length = blocked_force(actuator, pressure, lengths, torque, x=0.0, accuracy=1e-8)
        by_angle = blocked_torque(actuator, pressure, angles, force, x=0.0, accuracy=1e-8)
        for held, target, name, work in (
            (by_length, lengths, "force", torque * np.radians(by_length["rotation"])),
            (by_angle, np.radians(angles), "torque", force * by_angle["deformed_length"]),
        ):
            if (held["status"] == COMPRESSED).any():
                continue
            assert (held["status"] == OK).all()
            energy = (pressure * held["volume"] - held["strain_energy"] + work).values
            width, multiplier = target[-1] - target[0], held[name].values
            expected = -0.5 * width * np.sum(weights * multiplier[1:-1])
            assert energy[-1] - energy[0] == pytest.approx(expected, abs=1e-6 * abs(width) * np.abs(multiplier).max())
            counted += 1
    assert counted > 45


# --- what has no result, and what is refused


def test_a_wall_that_would_have_to_be_pushed_has_no_blocked_force():
    """Region I at any pressure; extensible fibers below a pressure (theory, section 5)."""
    for held in (blocked_force(tube(10, 50), [1e3, 1e5]), blocked_force(MUSCLE, [2e3, 6e3])):
        assert (held["status"] == COMPRESSED).all()
        assert np.isnan(held["force"]).all()
        assert np.isnan(held["deformed_radius"]).all()
    above = blocked_force(MUSCLE, 8.3e3)
    assert above["status"] == OK
    assert -SECTION * 8.3e3 < above["force"] < 0  # pushed, but not the wall: p + f > 0


@pytest.mark.parametrize(("actuator", "pressure", "length"), [(MUSCLE, 7.95e3, 0.192), (MUSCLE, 7.968e3, 0.192)])
def test_edge_of_compression_has_no_result(actuator, pressure, length):
    assert blocked_force(actuator, pressure, length)["status"] == COMPRESSED


def test_buckled_state_goes_on_with_pressure():
    held = blocked_torque(dataclasses.replace(B, energy="principal"), [0.24e6, 0.25e6], buckled=True, x=0.0)
    assert (held["status"] == OK).all()


def test_buckled_states_of_one_curve_belong_together():
    held = blocked_torque(dataclasses.replace(B, energy="principal"), [0.207e6, 0.21e6], buckled=True, x=B.length / 4)
    assert len(set(np.sign(held["deformed_radius"].values.ravel() - R0))) == 1


def test_held_quantity_load_and_pressure_make_dimensions():
    lengths, torques, pressures = [0.19, 0.192], [0.0, 1e-3], [5e4, 2e4, 8e4]
    held = blocked_force(tube(20, -50, 0.192), pressures, lengths, torques, x=[0.0, 0.1])
    assert held["force"].dims == ("deformed_length", "torque", "pressure")
    assert held["twist"].dims == ("deformed_length", "torque", "pressure", "x")
    assert "deformed_length_error" not in held
    units = {
        "force": "N",
        "force_error": "N",
        "deformed_length": "m",
        "rotation": "degree",
        "torque": "N m",
        "pressure": "Pa",
    }
    assert {name: held[name].attrs["units"] for name in units} == units
    one = blocked_force(tube(20, -50, 0.192), 2e4, 0.19, 1e-3)
    assert set(one.dims) == {"x"}
    same = held["force"].sel(deformed_length=0.19, torque=1e-3, pressure=2e4)
    assert abs(one["force"] - same) <= 2 * one["force_error"] + 1e-12
    turned = blocked_torque(B, 2e4, [0.0, 5.0], [0.0, 1.0])
    assert turned["torque"].dims == ("rotation", "force")
    assert turned["torque"].attrs["units"] == turned["torque_error"].attrs["units"] == "N m"
    assert turned["twist"][:, :, -1].values == pytest.approx(np.array([[0, 0], [5, 5]]), abs=1e-5)


@pytest.mark.parametrize("muscle", [tube(30, -30), tube([(0, 20), (1, 40)], [(0, -20), (1, -40)])])
def test_muscles_have_no_rotation_to_hold(muscle):
    with pytest.raises(ActuatorError, match=r"rotation: a tube with alpha = -beta does not rotate.*use blocked_force"):
        blocked_torque(muscle, 1e4)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda: blocked_force(B, -1.0, [0.1, 0.1], "x", x=[0.2], accuracy=1.0),
            ["deformed_length: a value is given twice", "torque: found the text 'x'", "pressure: found -1",
             "accuracy: found 1", "x: give ascending stations"],
        ),
        (lambda: blocked_force(B, 0.0, 0.0), ["pressure: found 0; it has to be above 0", "deformed_length: found 0"]),
        (lambda: blocked_torque(B, [1e4], np.nan, [[1]]), ["rotation: found nan", "force: found an array of shape (1, 1)"]),
        (lambda: blocked_torque("tube", 1e4), ["tube: found str; give an Actuator"]),
        (lambda: blocked_torque(VARYING[0], 1e4, buckled=True), ["buckled: only a tube that is the same all along"]),
        (lambda: corrected_torque(tube(10, 50), 1e4), ["tube: the source's correction is for alpha = 0"]),
        (lambda: corrected_torque(B, -1e4), ["pressure: found a negative value"]),
    ],
)  # fmt: skip
def test_every_fault_of_a_held_state_is_listed(call, says):
    with pytest.raises(ActuatorError) as caught:
        call()
    assert len(caught.value.faults) == len(says)
    for start in says:
        assert any(fault.startswith(start) for fault in caught.value.faults), start

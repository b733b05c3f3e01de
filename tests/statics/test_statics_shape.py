"""Shapes of one actuator in SI units against independent solutions, and its forces against balances on a cut."""

import dataclasses

import numpy as np
import pytest
from oracle import NODES, WEIGHTS, first_integral, half_sum_and_difference

from freesweep import Actuator, MooneyRivlin, NeoHookean, closed_form, inflate, lock
from freesweep.atlas.schema import PROFILES
from freesweep.status import OK

RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)  # of the source's prototypes A, B, C
OUTPUTS = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")
ORACLE = ("deformed_length", "volume", "rotation", "strain_energy", "mid_radius")  # the order of its errors


def tube(alpha, beta, length=0.141, **more):
    given = {"length": length, "radius": 4.76e-3, "wall": 1.59e-3, "material": RUBBER}
    return Actuator(**{"alpha": alpha, "beta": beta} | given | more)


A, B, C = tube(10, 50), tube(0, 30, 0.131), tube(0, 60, 0.143)


def principal(actuator):
    return dataclasses.replace(actuator, energy="principal")


def scales(actuator):
    """Radius of the fiber surface, units of force and torque, dimensionless wall and ratio of constants."""
    r, c10 = actuator.fiber_surface, actuator.material.c10
    area = ((actuator.radius + actuator.wall) ** 2 - actuator.radius**2) / r**2
    return r, np.pi * r**2 * c10, np.pi * r**3 * c10, area, actuator.material.c01 / c10


def exact(actuator, pressure, force=0.0, torque=0.0, stations=()):
    """The oracle's equilibrium: outputs with what it may be off, in SI units and degrees, profiles at ``stations``."""
    r, unit_force, unit_torque, area, ratio = scales(actuator)
    gamma = actuator.fiber_extension
    p, f, m = pressure / actuator.material.c10, force / unit_force, torque / unit_torque
    edges = np.concatenate([[0.0], stations]) / r
    inner = (edges[:-1, None] + np.diff(edges)[:, None] * NODES.astype(float)).ravel()
    shape = first_integral(
        actuator.alpha, actuator.beta, actuator.length / r, area, ratio, p, f, m, gamma, actuator.energy,
        stations=np.concatenate([inner, edges[1:]]),
    )  # fmt: skip
    H, D = half_sum_and_difference(actuator.alpha, actuator.beta)

    def state(y):
        """G, twist rate, and meridional resultant and energy per G/s of the first integral (theory.md, section 4)."""
        G = gamma**2 * (1 + H**2 + D**2) - (D * y) ** 2 - (gamma**2 * H / y) ** 2
        psi = H * (gamma**2 / y**2 - 1)
        if np.isinf(p):
            return G, psi, y**2, 0.0
        shear = (y * psi) ** 2 if actuator.energy == "full" else 0.0
        C11 = G + shear
        first = C11 + y**2 + 1 / (G * y**2) - 3
        second = G * y**2 + (C11 + y**2) / (G * y**2) - 3
        return G, psi, p * y**2 + f, area * (first + ratio * second) - m * psi

    G, _, T, w = state(shape.middle)
    constant = T * np.sqrt(G) - w
    G, psi, T, w = state(shape.y[: len(inner)])
    pieces = np.array([T * G / (constant + w), psi]).reshape(2, len(stations), -1) * WEIGHTS.astype(float)
    z, twist = np.cumsum(pieces.sum(axis=2) * np.diff(edges), axis=1)
    units = (r, np.pi * r**3, np.degrees(1.0), np.pi * r**3 * actuator.material.c10, r)
    found = (shape.length, shape.volume, shape.rotation, shape.energy, shape.middle)
    values = {
        name: (value * unit, 10 * error * unit) for name, value, unit, error in zip(ORACLE, found, units, shape.errors)
    }
    cavity = values["volume"][0] - np.pi * (r**2 - actuator.radius**2) * actuator.length
    values["volume"] = (cavity, values["volume"][1])
    return values, (r * shape.y[len(inner) :], r * z, np.degrees(twist))


LOADED = [
    (tube(30, -30, 0.192, fiber_extension=1.005), 1e5, 0.0, 0.0),
    (A, 1e5, 0.0, 0.0),
    (B, 2e5, 0.0, 0.0),
    (principal(C), 5e4, 0.0, 0.0),
    (tube(20, -50, 0.04, fiber_radius=5.5e-3), 5e4, 2.0, -0.01),
    (tube(75, -60, 0.1, material=NeoHookean(0.11e6)), 8e4, -1.0, 0.02),
]


def close_to_exact(dataset, actuator, values, profiles, stations):
    sizes = {"deformed_length": actuator.length, "mid_radius": actuator.radius, "rotation": np.degrees(1.0)}
    for name, (value, unsure) in values.items():
        if name in dataset:
            size = max(sizes.get(name, 0.0), abs(value))
            error, bound = abs(dataset[name].item() - value), dataset[f"{name}_error"].item()
            assert error < 1e-6 * size, name
            assert error <= bound + unsure + 1e-12 * size, name
            assert bound <= 1.1e-6 * size, name
    near, far = dataset.sel(x=stations), dataset.isel(x=slice(None, None, -1)).isel(x=slice(len(stations)))
    length, rotation = dataset["deformed_length"].item(), dataset["rotation"].item()
    radius, z, twist = profiles
    turns = max(np.degrees(1.0), abs(rotation))
    off = dataset["deformed_length_error"].item(), dataset["rotation_error"].item()  # of the far end
    for part, there, turned, unsure in ((near, z, twist, (0.0, 0.0)), (far, length - z, rotation - twist, off)):
        for name, expected, size, more in (
            ("deformed_radius", radius, actuator.radius, 0.0), ("axial_position", there, actuator.length, unsure[0]),
            ("twist", turned, turns, unsure[1]),
        ):  # fmt: skip
            error, bound = np.abs(part[name] - expected), part[f"{name}_error"]
            assert (error <= bound + more + 1e-11 * size).all(), name
            assert (bound <= 1.1e-6 * size).all(), name
    for name in PROFILES:
        size = np.abs(dataset[name]).max() if "tension" in name else np.degrees(1.0)
        if name.startswith(("alpha", "beta", "fiber")):
            assert (dataset[f"{name}_error"] <= 1.1e-6 * size).all(), name


def both_halves(actuator, count=24):
    """Stations of the near half, denser at the end, and those of the whole tube."""
    near = 0.5 * actuator.length * np.linspace(0.04, 1.0, count) ** 2
    return near, np.concatenate([near[:-1], (actuator.length - near)[::-1]])


@pytest.mark.parametrize(("actuator", "pressure", "force", "torque"), LOADED)
def test_inflated_shape_is_the_independent_one(actuator, pressure, force, torque):
    near, everywhere = both_halves(actuator)
    dataset = inflate(actuator, pressure, force, torque, x=everywhere)
    assert dataset["status"] == OK
    close_to_exact(dataset, actuator, *exact(actuator, pressure, force, torque, near), near)


@pytest.mark.parametrize("actuator", [A, B, tube(30, -30, 0.03), tube(20, -50, 0.05, fiber_radius=6e-3)])
def test_locked_shape_is_the_independent_one(actuator):
    near, everywhere = both_halves(actuator)
    dataset = lock(actuator, x=everywhere)
    assert dataset["status"] == OK
    close_to_exact(dataset, actuator, *exact(actuator, np.inf, stations=near), near)


@pytest.mark.parametrize("pair", [(30, -30), (0, 30), (10, 50), (70, 20), (20, -80), (60, 55)])
def test_middle_of_a_long_locked_actuator(pair):
    """Angles on the locked manifold; the fibers alone balance the pressure along, across and in torsion."""
    dataset = lock(tube(*pair, length=0.6), x=0.3)
    state = {name: dataset[name].item() for name in PROFILES}
    angles = np.radians([state["alpha_deformed"], state["beta_deformed"]])
    assert np.degrees(angles) == pytest.approx(closed_form.locked_angles(*pair), abs=1e-4)
    assert np.prod(np.tan(angles)) == pytest.approx(-2, abs=1e-5)
    tension = np.array([state["fiber_tension_alpha"], state["fiber_tension_beta"]])
    assert tension.min() > 0
    radius = state["deformed_radius"]
    assert np.sum(tension * np.cos(angles)) == pytest.approx(
        np.pi * radius**2, rel=1e-6
    )  # the ends' thrust per pressure
    hoop = np.sum(tension * np.sin(angles) ** 2 / np.cos(angles)) / (2 * np.pi * radius)
    assert hoop == pytest.approx(radius, rel=1e-5)
    assert np.sum(tension * np.sin(angles)) == pytest.approx(0.0, abs=1e-9 * tension.sum())


def wall_energy(actuator, axial, y, psi):
    """Energy of the wall per length [N] of a uniform tube, as if no fibers bound it."""
    shear = (y * psi) ** 2 if actuator.energy == "full" else 0.0
    third = 1 / (axial * y) ** 2
    first, second = axial**2 + y**2 + shear + third, (axial * y) ** 2 + (axial**2 + y**2 + shear) * third
    area = np.pi * ((actuator.radius + actuator.wall) ** 2 - actuator.radius**2)
    return area * (actuator.material.c10 * (first - 3) + actuator.material.c01 * (second - 3))


@pytest.mark.parametrize("energy", ["full", "principal"])
@pytest.mark.parametrize(("force", "torque"), [(0.0, 0.0), (1.5, -0.01)])
@pytest.mark.parametrize("pair", [(30, -30), (10, 50), (20, -70)])
def test_a_cut_in_the_middle_is_in_equilibrium(pair, force, torque, energy):
    """Fibers and wall carry the ends' thrust and load: derivatives of the wall's energy by complex steps."""
    actuator = tube(*pair, length=0.6, fiber_radius=5e-3, fiber_extension=1.005, energy=energy)
    dataset = inflate(actuator, 1.2e5, force, torque, x=0.3)
    r, y = 5e-3, dataset["mid_radius"].item() / 5e-3
    axial, psi, *angles = (float(part) for part in closed_form.uniform_state(*pair, y, 1.005))
    assert [dataset["alpha_deformed"].item(), dataset["beta_deformed"].item()] == pytest.approx(angles, abs=1e-5)
    angles, h = np.radians(angles), 1e-30
    tension = np.array([dataset["fiber_tension_alpha"].item(), dataset["fiber_tension_beta"].item()])
    stress = [
        wall_energy(actuator, *(q + 1j * h * (k == n) for k, q in enumerate((axial, y, psi)))).imag / h
        for n in range(3)
    ]
    size = np.abs(tension).sum() + np.abs(stress).max()
    thrust = 1.2e5 * np.pi * (r * y) ** 2 + force
    assert np.sum(tension * np.cos(angles)) + stress[0] == pytest.approx(thrust, abs=1e-5 * size)
    assert np.sum(tension * np.sin(angles)) * r * y + r * stress[2] == pytest.approx(torque, abs=1e-5 * size * r)
    across = np.sum(tension * np.sin(angles) ** 2 / np.cos(angles)) * axial / y + stress[1]
    assert across == pytest.approx(1.2e5 * 2 * np.pi * r**2 * y * axial, abs=1e-5 * size)


def test_the_energy_of_the_locked_shape_is_that_of_its_wall():
    """Long tubes add to the strain energy what a uniform locked tube stores."""
    short, long = (lock(tube(20, -50, length))["strain_energy"].item() for length in (0.3, 0.4))
    stretch = float(closed_form.locked_stretch(20, -50))
    axial, psi, *_ = (float(part) for part in closed_form.uniform_state(20, -50, stretch))
    assert (long - short) / 0.1 == pytest.approx(wall_energy(tube(20, -50), axial, stretch, psi), rel=1e-6)


def test_published_muscle_at_its_blocked_force():
    """28.6 degrees, radii 10 to 11.8 mm, 600 kPa: fibers at the outer radius hold their length at 1503 N."""
    muscle = Actuator(
        alpha=28.6, beta=-28.6, length=0.25, radius=10e-3, wall=1.8e-3, fiber_radius=11.8e-3, material=RUBBER
    )
    force = float(closed_form.blocked_force(28.6, -28.6, muscle.fiber_surface, 6e5))
    assert force == pytest.approx(1503, abs=0.5)
    less, held, more = inflate(muscle, 6e5, [0.9 * force, force, 1.1 * force])["deformed_length"].values
    assert held == pytest.approx(0.25, rel=1e-9)
    assert less < held < more


def test_blocked_torque_holds_the_rotation():
    torque = float(closed_form.blocked_torque(0, 30, B.radius, 1e5))
    less, held, more = inflate(B, 1e5, 0.0, [0.9 * torque, torque, 1.1 * torque])["rotation"].values
    assert held == pytest.approx(0.0, abs=1e-7)
    assert less < held < more


def test_fiber_radius_scales_every_formula_and_the_cavity_keeps_what_the_wall_takes():
    """A tube with fibers in its wall is one with that inner radius, the same wall area, and a smaller cavity."""
    r, outer = 5.6e-3, 4.76e-3 + 1.59e-3
    inside = tube(20, -50, fiber_radius=r)
    same = tube(20, -50, radius=r, wall=np.sqrt(r**2 + outer**2 - 4.76e-3**2) - r)
    first, second = (inflate(actuator, 7e4, 1.0, -0.01) for actuator in (inside, same))
    taken = np.pi * (r**2 - 4.76e-3**2) * 0.141
    for name in (*OUTPUTS, *PROFILES):
        expected = second[name] - (taken if name == "volume" else 0.0)
        np.testing.assert_allclose(first[name], expected, rtol=1e-8, atol=1e-12, err_msg=name)
    assert inflate(inside, 0.0)["volume"] == pytest.approx(np.pi * 4.76e-3**2 * 0.141, rel=1e-14)
    assert inflate(inside, 0.0)["mid_radius"] == r

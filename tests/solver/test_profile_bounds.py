"""Fiber tensions at clamped ends, the largest of a tube, and the bounds of profiles."""

import numpy as np
import pytest
from oracle import first_integral, half_sum_and_difference

from freesweep import Actuator, MooneyRivlin, blocked_torque, inflate
from freesweep.atlas.schema import PROFILES
from freesweep.census.designs import BLOCK, draw
from freesweep.description.tube_model import MODELS
from freesweep.solver import batch
from freesweep.solver.along.profile import VALUES
from freesweep.solver.problem import LENGTH
from freesweep.status import OK

R, C10 = 5e-3, 1e5


def tube(alpha, beta, ratio, length, area=0.3, energy="full", **more):
    """Length and section in radii, ``ratio`` C01/C10."""
    return Actuator(
        alpha=alpha, beta=beta, length=length * R, radius=R, wall=R * (np.sqrt(1.0 + area) - 1.0),
        material=MooneyRivlin(c10=C10, c01=ratio * C10), energy=energy, **more,
    )  # fmt: skip


def loads(p, f=0.0, m=0.0):
    return p * C10, f * np.pi * R**2 * C10, m * np.pi * R**3 * C10


def tensions_at_a_clamped_end(actuator, p, f=0.0, m=0.0):
    """Of both families, from the first integral in closed form at y = 1, of inextensible fibers: all but its constant,
    T sqrt(G) - a w + m psi in the middle, is at hand.
    """
    area, ratio = (1.0 + actuator.wall / R) ** 2 - 1.0, actuator.material.c01 / C10
    shape = first_integral(
        actuator.alpha, actuator.beta, actuator.length / R, area, ratio, p, f, m, energy=actuator.energy
    )
    H, D = half_sum_and_difference(actuator.alpha, actuator.beta)
    y = shape.middle
    psi, G = H * (1.0 / y**2 - 1.0), 1.0 + H**2 + D**2 - (D * y) ** 2 - (H / y) ** 2
    sheared = 1.0 + (psi**2 if actuator.energy == "full" else 0.0)
    w = G + y**2 * sheared + 1.0 / (G * y**2) - 3.0 + ratio * (G * y**2 + 1.0 / y**2 + sheared / G - 3.0)
    constant = (p * y**2 + f) * np.sqrt(G) - area * w + m * psi
    s = (p + f) / constant  # G = 1 there, and nothing is strained
    total = 0.5 * (p + f) / s
    difference = (0.5 * m - total * H) / D
    unit = np.pi * R**2 * C10
    return [
        unit * (total + sign * difference) / np.cos(np.radians(angle))
        for sign, angle in ((1.0, actuator.alpha), (-1.0, actuator.beta))
    ]


STEEP = [
    (tube(25.7327, 32.2274, 0.34086, 65.1158, 0.16671, "principal"), (6.6685, 0.53706)),
    (tube(66.5589, 68.1617, 0.4216, 42.876, 0.42765), (0.0178655, -0.0020935)),
    (tube(40.0, 40.8, 0.0, 30.0), (1.0,)),
    (tube(70.0, 64.0, 0.5, 20.0, 0.6), (0.4, 0.1, 0.05)),
    (tube(15.0, -15.0, 0.2, 12.0), (3.0, 0.0, 0.4)),
]


@pytest.mark.parametrize(("actuator", "load"), STEEP)
def test_tension_at_a_clamped_end_is_that_of_the_first_integral(actuator, load):
    """The source of each family's peak: where layers are steep, slopes from node values had no digits left for it."""
    state = inflate(actuator, *loads(*load), x=[0.0, 0.5 * actuator.length, actuator.length])
    exact = tensions_at_a_clamped_end(actuator, *load)
    size = max(map(abs, exact))
    for name, expected in zip(("alpha", "beta"), exact):
        found, bound = (state[f"fiber_tension_{name}{end}"].values for end in ("", "_error"))
        assert found[0] == pytest.approx(expected, abs=bound[0] + 1e-11 * size)
        assert found[2] == pytest.approx(found[0], rel=1e-12)
        assert bound.max() < 1e-6 * size


def test_tension_of_a_tube_of_nearly_equal_angles():
    """25427 N were told once."""
    actuator, load = STEEP[0]
    assert inflate(actuator, *loads(*load), x=0.0)["fiber_tension_alpha"].item() == pytest.approx(24859.029, abs=1e-3)


def test_profiles_are_refined_until_their_bounds_meet_the_accuracy():
    """At 2 kPa and 80 degrees the wall bears most of what the load makes: an error in the radius weighs a thousandfold
    in the tensions.
    """
    actuator = tube(-80.541, 80.541, 0.0, 33.4076, 0.43844, "principal", fiber_extension=1.00017)
    stations = 0.5 * actuator.length * np.array([0.0, 1e-3, 5e-3, 0.02, 0.1, 0.5, 1.0])
    coarse, fine = (inflate(actuator, *loads(0.0227, 0.01477), x=stations, accuracy=a) for a in (1e-6, 1e-9))
    assert coarse["status"] == OK
    for name in PROFILES:
        size = np.abs(fine[name]).max() if "tension" in name else {"deformed_radius": R}.get(name, 1.0)
        assert (np.abs(coarse[name] - fine[name]) <= coarse[f"{name}_error"] + fine[f"{name}_error"]).all(), name
        if "tension" in name:
            assert (coarse[f"{name}_error"] <= 1e-6 * size).all(), name


@pytest.mark.parametrize("beta", [-35.0, [(0.0, -30.0), (0.6, -30.0), (0.6, -45.0), (1.0, -45.0)]])
def test_a_held_state_has_the_profiles_of_the_free_one_under_its_torque(beta):
    actuator = tube(15.0, beta, 0.3, 12.0)
    stations = np.linspace(0.0, actuator.length, 9)
    held = blocked_torque(actuator, 0.4 * C10, 5.0, x=stations)
    torque = held["torque"].item()
    free, beside = (
        inflate(actuator, 0.4 * C10, 0.0, moment, x=stations)
        for moment in (torque, torque + held["torque_error"].item())
    )
    for name in PROFILES:
        allowed = held[f"{name}_error"] + free[f"{name}_error"] + 2.0 * np.abs(beside[name] - free[name])
        assert (np.abs(held[name] - free[name]) <= allowed).all(), name
        assert (held[f"{name}_error"] <= 1e-6 * np.abs(held[name]).max()).all(), name


@pytest.mark.parametrize(("number", "pressure"), [(51, 1), (180, 0), (222, 2)])
def test_profile_of_a_long_tube_found_by_its_middle_meets_the_accuracy(number, pressure):
    # nothing but rounding drives such a middle, whose depth had been taken from that: bounds of a tenth of the radius
    drawn = draw(BLOCK, 43, 0, MODELS["source"])
    problem, pressures = drawn.problems()[number : number + 1], drawn.pressures[number, pressure : pressure + 1]
    stations = np.linspace(0.0, 0.5 * problem[0, LENGTH], 41)
    asked = problem, np.array([0, 1]), pressures, batch.uniform(24), 1e-6, stations
    exact, meshes = batch.walk_all(*asked), batch.walk_all(*asked, lanes=False)
    assert exact.status[0] == OK
    missed = np.abs(exact.profiles[0, :VALUES] - meshes.profiles[0, :VALUES])
    assert np.all(missed <= exact.profiles[0, VALUES:] + meshes.profiles[0, VALUES:])


def test_a_middle_whose_cells_are_longer_than_its_layers_keeps_its_bound():
    """Results fall to their limit slowly at first: by 1.6, then 2.0 from mesh to mesh, in place of 4."""
    wound = Actuator(
        alpha=[(0, 79.7255), (1, 55.3766)], beta=-82.5303, length=0.1666, radius=R,
        wall=[(0, 0.475e-3), (0.5, 0.475e-3), (0.5, 0.525e-3), (1, 0.525e-3)],
        material=MooneyRivlin(c10=C10, c01=0.0), model="physical",
    )  # fmt: skip
    coarse, fine = (inflate(wound, 0.01358 * C10, x=[0.0], accuracy=a) for a in (1e-6, 1e-9))
    for name in ("mid_radius", "deformed_length", "rotation", "volume"):
        bound = coarse[f"{name}_error"].item() + fine[f"{name}_error"].item()
        assert abs(coarse[name].item() - fine[name].item()) <= bound, name

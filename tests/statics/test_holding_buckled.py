"""The stable, antisymmetric state beside the unstable cylinder of blocked torque."""

import dataclasses

import numpy as np
import pytest
from held_tubes import R0, SECTION, B, by_collocation, close, scales

from freesweep import (
    Actuator,
    MooneyRivlin,
    blocked_torque,
    closed_form,
)
from freesweep.status import HELD_IMPOSSIBLE, OK


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


def test_buckled_state_goes_on_with_pressure():
    held = blocked_torque(dataclasses.replace(B, energy="principal"), [0.24e6, 0.25e6], buckled=True, x=0.0)
    assert (held["status"] == OK).all()


def test_buckled_states_of_one_curve_belong_together():
    held = blocked_torque(dataclasses.replace(B, energy="principal"), [0.207e6, 0.21e6], buckled=True, x=B.length / 4)
    assert len(set(np.sign(held["deformed_radius"].values.ravel() - R0))) == 1


@pytest.mark.parametrize("energy", ["principal", "full"])
def test_buckled_branch_has_no_gap(energy):
    """From just above the critical pressure on: shorter and harder twisting with each step, on one smooth curve."""
    pressures = np.linspace(0.23e6, 0.35e6, 31)
    held = blocked_torque(dataclasses.replace(B, energy=energy), pressures, buckled=True, x=B.length / 4)
    assert (held["status"] == OK).all()
    assert (held["stable"] == 1).all()
    for name, sign in (("torque", 1), ("deformed_length", -1)):
        steps = sign * np.diff(held[name].values)
        assert (steps > 0).all()
        assert (np.diff(steps) < 0.1 * steps[:-1]).all()


R, RUBBER = 5e-3, 1e5


def slender(alpha, beta, length, wall, ratio, energy):
    """Length and wall in radii."""
    return Actuator(
        alpha=alpha, beta=beta, length=length * R, radius=R, wall=wall * R, material=MooneyRivlin(RUBBER, ratio * RUBBER),
        energy=energy,
    )  # fmt: skip


def critical_of(actuator):
    constants = actuator.material.c10, actuator.material.c01
    return closed_form.critical_pressure(
        actuator.alpha,
        actuator.beta,
        actuator.length,
        actuator.radius,
        actuator.wall,
        *constants,
        energy=actuator.energy,
    )


@pytest.mark.parametrize(("design", "share", "length", "ratio"), [
    ((37.6, -18.7, 27.1, 0.04, 0.2, "full"), 1.1, 0.95061 * 27.1, 0.916),
    ((70.5, 26.8, 25.4, 0.35, 0.4, "principal"), 2.0, 22.607, None),
    ((-65.073263, 7.4795853, 37.642824, 0.238281164, 0.371955104, "full"), 1.1, 0.9543569 * 37.642824, None),
    ((-23.836222, 24.057310, 26.429447, 0.0720761398, 0.30228177, "principal"), 2.0, 0.7474745 * 26.429447, None),
])  # fmt: skip
def test_stable_buckled_state_is_found_along_the_branch_that_leaves_the_cylinder(design, share, length, ratio):
    actuator = slender(*design)
    pressure = share * critical_of(actuator)
    held = blocked_torque(actuator, pressure, buckled=True, x=0.0)
    assert (held["status"], held["stable"]) == (OK, 1)
    assert held["deformed_length"].item() / R == pytest.approx(length, rel=2e-5)
    if ratio is not None:
        ideal = closed_form.blocked_torque(actuator.alpha, actuator.beta, R, pressure)
        assert held["torque"].item() / ideal == pytest.approx(ratio, abs=5.1e-4)


@pytest.mark.parametrize(("design", "shares"), [
    ((-7.8115477, 22.178972, 30.067567, 0.160655434, 0.326032787, "full"), np.linspace(1.2, 2.4, 7)),
    ((13.6260704, -4.5904536, 33.1982903, 0.041228023, 0.353482548, "full"), np.linspace(1.2, 2.0, 5)),
    ((-65.073263, 7.4795853, 37.642824, 0.238281164, 0.371955104, "full"), np.linspace(1.02, 1.3, 5)),
], ids=["a front that feels the cells", "another", "a sine that is soon left"])  # fmt: skip
def test_steep_fronts_are_stable(design, shares):
    """On 96 cells of a mesh the front of the first is unstable here and there: it is nowhere, but shorter with each step."""
    actuator = slender(*design)
    held = blocked_torque(actuator, shares * critical_of(actuator), buckled=True, x=0.0)
    assert (held["status"] == OK).all()
    assert (held["stable"] == 1).all()
    steps = -np.diff(held["deformed_length"].values)
    assert (steps > 0).all()
    assert (np.diff(steps) < 0).all()


@pytest.mark.parametrize(("design", "share", "length", "torque", "neck"), [
    ((6.2853, -8.3234, 43.719, 0.3507, 0.478, "full"), 1.8, 29.725366880, -75.8747950864, 0.0715127634),
    ((6.2853, -8.3234, 43.719, 0.3507, 0.478, "full"), 2.0, 28.834649398, -77.2964362234, 0.0670446346),
    ((8.52, -3.28, 43.76, 0.0682, 0.201, "full"), 2.0, 29.551009674, 5.4748087764, 0.1064167227),
    ((-5.348, -9.15, 41.09, 0.0305, 0.1, "principal"), 2.0, 24.934230164, -3.0543257644, 0.1628047895),
    ((3.96, 10.09, 29.75, 0.1476, 0.124, "full"), 2.0, 18.278774109, 10.9417139909, 0.1747659046),
    ((-46.21, -38.31, 26.7, 0.05, 0.2, "principal"), 0.98, 18.220027191, -2.8290603908, 0.7328053938),
    ((53.61, 62.69, 44.08, 0.303, 0.1988, "full"), 2.0, 23.065679466, 205.9845565308, 0.8643247605),
])  # fmt: skip
def test_fronts_that_no_mesh_follows(design, share, length, torque, neck):
    """By SciPy's collocation from a density that SymPy differentiated; no direction on 30,000 cells and more is unstable."""
    actuator = slender(*design)
    stations = actuator.length * (1.0 - np.linspace(0.0, 0.7, 400) ** 2)[::-1]
    held = blocked_torque(actuator, share * critical_of(actuator), buckled=True, x=stations)
    assert (held["status"], held["stable"]) == (OK, 1)
    # 1e-12 of the pressure is 3e-10 of the length
    assert held["deformed_length"].item() / R == pytest.approx(length, rel=8e-10)
    assert abs(held["deformed_length"].item() - length * R) < held["deformed_length_error"].item() + 2e-10 * length * R
    assert held["torque"].item() / (np.pi * R**3 * RUBBER) == pytest.approx(torque, rel=1e-9)
    assert held["deformed_radius"].values.min() / R == pytest.approx(neck, rel=2e-4)
    assert abs(held["twist"].values[-1]) < 1e-3


def test_fiber_extension_rotation_and_force():
    """No straight cylinder is a state of this one; SciPy's collocation as above."""
    actuator = slender(24.09, 32.76, 34.36, 0.0525, 0.0149, "full")
    pressure = 1.05 * critical_of(actuator)
    force = 0.61 * np.pi * R**2 * pressure / 1.05
    actuator = dataclasses.replace(actuator, fiber_extension=1.0172)
    held = blocked_torque(actuator, pressure, -4.89, force, buckled=True)
    assert (held["status"], held["stable"]) == (OK, 1)
    assert held["deformed_length"].item() / R == pytest.approx(29.318857260, rel=3e-10)
    assert held["torque"].item() / (np.pi * R**3 * RUBBER) == pytest.approx(1.0799728558, rel=1e-9)
    assert held["twist"].values[-1] == pytest.approx(-4.89, abs=1e-5)


@pytest.mark.parametrize("design", [
    (37.6, -18.7, 27.1, 0.04, 0.2, "full"), (-46.21, -38.31, 26.7, 0.05, 0.2, "principal")
])  # fmt: skip
def test_answers_do_not_depend_on_what_else_is_asked(design):
    actuator = slender(*design)
    pressures = np.array([0.9, 1.1, 1.7]) * critical_of(actuator)
    together = blocked_torque(actuator, pressures, buckled=True, x=actuator.length / 3)
    for i, pressure in enumerate(pressures):
        alone = blocked_torque(actuator, pressure, buckled=True, x=actuator.length / 3)
        for name in ("status", "deformed_length", "torque", "deformed_radius", "least_buckled_pressure"):
            np.testing.assert_array_equal(together[name].isel(pressure=i).values, alone[name].values)


def test_stable_buckled_states_reach_below_the_critical_pressure():
    """The branch leaves the cylinder toward lower pressures: down to where it turns there is a state, below it none."""
    actuator = slender(37.6, -18.7, 27.1, 0.04, 0.2, "full")
    critical = critical_of(actuator)
    first = blocked_torque(actuator, 1.1 * critical, buckled=True, x=0.0)
    least, bound = first["least_buckled_pressure"].item(), first["least_buckled_pressure_error"].item()
    assert 0.5 * critical < least < critical
    assert bound < 1e-4 * least
    held = blocked_torque(actuator, [0.999 * least, 1.001 * least], buckled=True, x=0.0)
    assert held["status"].values.tolist() == [HELD_IMPOSSIBLE, OK]
    assert held["stable"].values.tolist() == [0, 1]

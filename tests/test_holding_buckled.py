"""The stable, antisymmetric state beside the unstable cylinder of blocked torque."""

import dataclasses

import numpy as np
import pytest
from held_tubes import R0, SECTION, B, by_collocation, close, scales

from freesweep import (
    blocked_torque,
    closed_form,
)
from freesweep.status import OK


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
    pressures = np.linspace(0.23e6, 0.35e6, 61)
    held = blocked_torque(dataclasses.replace(B, energy=energy), pressures, buckled=True, x=B.length / 4)
    assert (held["status"] == OK).all()
    assert (held["stable"] == 1).all()
    for name, sign in (("torque", 1), ("deformed_length", -1)):
        steps = sign * np.diff(held[name].values)
        assert (steps > 0).all()
        assert (np.diff(steps) < 0.1 * steps[:-1]).all()

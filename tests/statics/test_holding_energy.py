"""The multiplier of a held quantity is the derivative of the energy with respect to it."""

import dataclasses

import numpy as np
import pytest
from held_tubes import random_designs

from freesweep import (
    blocked_force,
    blocked_torque,
)
from freesweep.status import COMPRESSED, OK


@pytest.mark.filterwarnings("ignore:no state was found")
@pytest.mark.parametrize("count", [20, pytest.param(1000, marks=pytest.mark.long)])
def test_held_energy_changes_by_the_work_of_the_multiplier(count):
    """E = P V - W + (other load) x (its displacement) at a held length: dE = -F dl; at a held rotation dE = -M d(delta)."""
    nodes, weights = np.polynomial.legendre.leggauss(14)
    share, counted, lost = np.concatenate([[0.0], 0.5 * (nodes + 1), [1.0]]), 0, 0
    for random, actuator in random_designs(count, 5):
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
            if (held["status"] != OK).any():
                lost += 1
                continue
            energy = (pressure * held["volume"] - held["strain_energy"] + work).values
            width, multiplier = target[-1] - target[0], held[name].values
            expected = -0.5 * width * np.sum(weights * multiplier[1:-1])
            assert energy[-1] - energy[0] == pytest.approx(expected, abs=1e-6 * abs(width) * np.abs(multiplier).max())
            counted += 1
    assert counted > 1.5 * count
    assert lost <= 0.003 * count  # three curves of two thousand are known to be lost

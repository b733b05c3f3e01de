"""Held states against the inflated tube, independent solutions and their own branch."""

import dataclasses

import numpy as np
import pytest
from held_tubes import HELD, MUSCLE, R0, VARYING, WALL, by_collocation, close, random_designs, scales, sized, tube
from oracle import first_integral

from freesweep import (
    blocked_force,
    blocked_torque,
    inflate,
)
from freesweep.status import OK


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


@pytest.mark.parametrize("count", [12])
def test_profiles_that_do_not_vary_are_held_like_numbers(count):
    """Two ways to one state: all along the branch from rest, and from the straight cylinder under the whole load."""
    for random, actuator in random_designs(count, 11):
        actuator = dataclasses.replace(actuator, fiber_extension=random.uniform(1.0, 1.01))
        ends = {name: [(0, getattr(actuator, name)), (1, getattr(actuator, name))] for name in ("alpha", "beta")}
        profiled = dataclasses.replace(actuator, **ends)
        pressure = random.uniform(0.15, 0.5) * actuator.material.c10
        product = np.prod(np.tan(np.radians([actuator.alpha, actuator.beta])))
        length, angle = (
            actuator.length * (1 + 0.02 * np.sign(-2 - product)),
            -2 * np.sign(actuator.alpha + actuator.beta),
        )
        for solve, target, name in ((blocked_force, length, "force"), (blocked_torque, angle, "torque")):
            one, other = solve(actuator, pressure, target, x=0.0), solve(profiled, pressure, target, x=0.0)
            assert one["status"] == other["status"]
            if one["status"] == OK:
                assert abs(one[name] - other[name]) <= one[f"{name}_error"] + other[f"{name}_error"]


def test_held_state_lies_on_the_branch_from_rest():
    """Where several states exist, it is the one that a rising pressure leads to while the rotation stays held."""
    stepped = tube([(0, 20), (0.5, 20), (0.5, 35), (1, 35)], [(0, -25), (1, -35)], 0.1)
    pressures = np.linspace(0.01e6, 0.2e6, 39)
    held = blocked_torque(stepped, pressures, x=0.0)
    assert (held["status"] == OK).all()
    assert (held["stable"] == 1).all()
    for name, size in (("torque", 0.7), ("deformed_length", 0.1), ("mid_radius", R0)):
        assert np.abs(np.diff(held[name], n=2)).max() < 3e-3 * size, name  # no jump between neighbours
    coarse = blocked_torque(stepped, pressures[[19, 38]], x=0.0)
    assert coarse["torque"].values == pytest.approx(held["torque"].values[[19, 38]], rel=1e-12)

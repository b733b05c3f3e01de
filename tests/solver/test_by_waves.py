"""Buckled tubes as two waves: where their branch begins, turns, and is stable."""

import numpy as np
import pytest

from freesweep import Actuator, MooneyRivlin, closed_form
from freesweep.held_states import _problems
from freesweep.solver.by_waves.branch import begin, critical, follow
from freesweep.solver.by_waves.on_step import at_pressure, parts
from freesweep.solver.by_waves.told import shape
from freesweep.solver.by_waves.waves import PRESSURE, TORQUE, Waves
from freesweep.solver.load import Load
from freesweep.solver.physics import lagrangian

CELLS = 400


def asked(alpha, beta, length, wall, ratio, energy="full"):
    """``(waves, critical pressure over c10)``; length and wall in radii."""
    r, c10 = 5e-3, 1e5
    own = alpha, beta, length * r, r, wall * r, c10, ratio * c10
    tube = Actuator(
        alpha=alpha, beta=beta, length=length * r, radius=r, wall=wall * r, material=MooneyRivlin(c10, ratio * c10),
        energy=energy,
    )  # fmt: skip
    return Waves(_problems(tube, "force", np.zeros(1))[0], 0.0), closed_form.critical_pressure(
        *own, energy=energy
    ) / c10


def unstable_on_a_mesh(waves, look):
    """Unstable directions by the second variation of the discrete energy, the rotation held, on even cells."""
    x = np.linspace(0.0, 2.0 * waves.half, CELLS + 1)
    y = shape(waves, look, x, 1e-6)[0][0]
    H, D, area, gamma, ratio, shear = waves.problem[:6]
    cell, h = (H, D, area), x[1]
    load = Load(gamma, (ratio,), (shear,), look.pair.pressure, 0.0, look.values[TORQUE], 1.0)
    turns = Load(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    hessian, row = np.zeros((CELLS + 1, CELLS + 1)), np.zeros(CELLS + 1)
    for i in range(CELLS):
        middle, slope = 0.5 * (y[i] + y[i + 1]), (y[i + 1] - y[i]) / h
        _, _, _, L_yy, L_yv, L_vv = lagrangian.density(middle, slope, cell, load)
        signs = np.array([-1.0, 1.0])
        own = 0.25 * h * L_yy + 0.5 * L_yv * np.add.outer(signs, signs) + L_vv / h * np.outer(signs, signs)
        hessian[i : i + 2, i : i + 2] -= own
        row[i : i + 2] += 0.5 * h * lagrangian.conjugate(middle, slope, cell, load, turns)[1]
    held = np.linalg.svd(row[1:-1][None])[2][1:]  # what leaves the rotation as it is
    return int(np.sum(np.linalg.eigvalsh(held @ hessian[1:-1, 1:-1] @ held.T) < 0.0))


@pytest.mark.parametrize(
    "design", [(30.0, -10.0, 30.0, 0.2, 0.3), (60.0, 20.0, 25.0, 0.1, 0.2), (53.0, 63.0, 20.0, 0.3, 0.2)]
)
def test_the_branch_leaves_the_cylinder_at_the_critical_pressure(design):
    waves, pressure = asked(*design)
    center, first, clamped = critical(waves)
    assert (center, clamped) == (1.0, True)
    assert first == pytest.approx(pressure, rel=1e-12)
    look = begin(waves, center).look
    assert look.pair.pressure == pytest.approx(pressure, rel=1e-3)
    assert np.abs(look.miss).max() < 1e-7


def test_directions_are_counted_as_the_second_variation_counts_them():
    """Down to where the branch turns one is unstable, from there on none; on it another one is next to none."""
    waves, pressure = asked(37.6, -18.7, 27.1, 0.04, 0.2)
    counts, turned = [], False
    for step in follow(waves, begin(waves, 1.0)):
        for _, _, there, _, stands_out in parts(waves, *step):
            turned = turned or stands_out is not None
            if stands_out is None and there.look.pair.near > 0.05 and len(counts) % 4 == 0:
                assert there.look.unstable == (0 if turned else 1)
                assert there.look.unstable == unstable_on_a_mesh(waves, there.look)
            counts.append(there.look.unstable)
        if there.pressure > 1.2 * pressure:
            break
    assert turned
    assert set(counts) == {0, 1}


def test_numbers_follow_the_branch_by_its_slopes():
    """What is told by differences: the direction of the branch, from points of it."""
    waves, pressure = asked(37.6, -18.7, 27.1, 0.04, 0.2)
    steps = follow(waves, begin(waves, 1.0))
    here, length, there, pieces = next(step for step in steps if step[2].pressure > 1.1 * pressure)
    near = at_pressure(waves, here, length, pieces, 0.5 * (here.pressure + there.pressure))
    change = near.look.pair.numbers - here.look.pair.numbers
    mean = 0.5 * (here.toward / here.look.pair.weights + near.toward / near.look.pair.weights)
    assert change / change[PRESSURE] == pytest.approx(mean / mean[PRESSURE], rel=2e-2)

"""Blocked torque of extensible fibers beyond the critical pressure: the branch from rest, and where it turns back."""

import numpy as np
import pytest
from held_tubes import tube

from freesweep import Actuator, MooneyRivlin, blocked_force, blocked_torque, closed_form, inflate
from freesweep.status import BEYOND_LIMIT, HELD_IMPOSSIBLE, INACCURATE, OK

# angles, length/radius, wall/radius, fiber extension, C01/C10, force/(pi r^2 C10), pressure/C10, energy: each far beyond
# its critical pressure
BEYOND = [
    (9.458603668097622, -49.80728964928987, 43.457779785277864, 0.3327391458914342, 1.0184305005992438, 0.0768832153401986,
     0.0, 7.827693855249575, "principal", OK),
    (-34.33111063382851, 22.52664921377051, 38.07583098171484, 0.05706471573735602, 1.0043862020959902, 0.0,
     1.4915778153067323, 4.15846966916516, "full", BEYOND_LIMIT),
    (-50.93324592060257, -63.10342918518052, 191.31042273160602, 0.06834894197956419, 1.0155, 1.1547, 1.784640776982879,
     3.42168, "principal", BEYOND_LIMIT),
    (-35.10645, 45.22617, 150.5044, 0.0786215, 1.01720, 1.09740, -0.5399, 0.86465, "full", BEYOND_LIMIT),
]  # fmt: skip


@pytest.mark.filterwarnings("ignore:the length is")  # its radius is 1 m
@pytest.mark.parametrize("design", BEYOND)
def test_states_far_beyond_the_critical_pressure_are_explained(design):
    alpha, beta, length, wall, gamma, ratio, force, pressure, energy, status = design
    r, c = 5e-3, 1e5
    actuator = Actuator(
        alpha=alpha, beta=beta, length=length * r, radius=r, wall=wall * r, material=MooneyRivlin(c, ratio * c),
        fiber_extension=gamma, energy=energy,
    )  # fmt: skip
    held = blocked_torque(actuator, np.array([0.02, 1.0]) * pressure * c, force=np.pi * r**2 * c * force, x=0.0)
    assert held["status"].values.tolist()[1] == status


@pytest.mark.parametrize("gamma", [1.002, 1.004])
def test_branch_ends_at_a_turning_point_and_nothing_lies_beyond(gamma):
    """Short of the turning point p* the shape is off its end by the root of p* - p; past it other branches are not taken.
    However close to it: one pressure divides all that are ok from all that are beyond.
    """
    actuator = tube(0, 30, 0.131, fiber_extension=gamma)
    critical = closed_form.critical_pressure(0, 30, 0.131, actuator.radius, actuator.wall, 0.17e6, 0.08e6)
    low, high = 0.8 * critical, 2.0 * critical
    for _ in range(24):
        middle = 0.5 * (low + high)
        status = blocked_torque(actuator, middle, x=0.0)["status"].item()
        assert status in (OK, INACCURATE, BEYOND_LIMIT)
        low, high = (low, middle) if status == BEYOND_LIMIT else (middle, high)
    assert high == pytest.approx(critical, rel=0.02)
    apart = 10.0 ** -np.arange(1.0, 6.6, 0.5)
    beyond = blocked_torque(actuator, high * (1.0 + apart), x=0.0)
    assert (beyond["status"] == BEYOND_LIMIT).all()
    below = blocked_torque(actuator, low * (1.0 - apart), x=0.0)
    assert np.isin(below["status"], (OK, INACCURATE)).all()
    assert (below["status"][apart > 1e-5] == OK).all()
    held = blocked_torque(actuator, low * (1.0 - 0.25 ** np.arange(4.0, 9.0)), x=0.0)
    steps = np.diff(held["mid_radius"].values)
    assert (steps > 0).all()
    assert 1.4 < steps[-2] / steps[-1] < 2.2  # toward 2, the root's, at quarters of the distance


@pytest.mark.parametrize(
    "fibers",
    [
        {"beta": -40, "model": "source"},
        {"beta": [(0, -30), (1, -50)], "model": "source"},
        {"beta": None, "model": "physical"},
    ],
)
def test_straight_fibers_hold_every_length_but_their_own(fibers):
    """No finite force pulls a bulging tube as long as its straight fibers are; shorter ones are what a force makes."""
    tube = Actuator(alpha=0, length=0.06, radius=6e-3, wall=1e-3, material=MooneyRivlin(1e5, 5e4), **fibers)
    for torque in (0.0, -4e-3):
        pulled = inflate(tube, 2e4, 10.0, torque, x=0.0)
        lengths = [pulled["deformed_length"].item(), 0.06]
        found = blocked_force(tube, 2e4, lengths, torque, x=0.0)
        assert found["status"].values.tolist() == [OK, HELD_IMPOSSIBLE]
        assert found["force"].values[0] == pytest.approx(10.0, rel=1e-5)

"""Chapter 3: the string model of an actuator wound around an arm."""

import numpy as np
import pytest

from freesweep import Actuator, ActuatorError, Helix, MooneyRivlin, blocked_force, constriction

SLEEVE = Helix.around(0.0856 / 2, length=0.640, height=0.0992)  # section 3.3; the FREE of section 3.4
STEEP = Helix(length=0.5, height=0.4, turns=1.5)
TUBE = Actuator(
    alpha=30, beta=-30, length=0.640, radius=4.76e-3, wall=1.59e-3, material=MooneyRivlin(0.11e6, 0.06e6),
    fiber_extension=1.0075,
)  # fmt: skip


def line(helix, share):
    """Points of the middle line at shares of its length: arrays (3, n)."""
    turn = 2 * np.pi * helix.turns * share
    return np.array([helix.radius * np.cos(turn), helix.radius * np.sin(turn), helix.height * share])


@pytest.mark.parametrize("helix", [SLEEVE, STEEP])
def test_the_line_has_the_length_and_the_angle_of_the_actuator(helix):
    points = line(helix, np.linspace(0, 1, 200_001))
    steps = np.diff(points, axis=1)
    assert np.linalg.norm(steps, axis=0).sum() == pytest.approx(helix.length, rel=1e-8)
    along = steps[2, 0] / np.linalg.norm(steps[:, 0])
    assert np.degrees(np.arccos(along)) == pytest.approx(helix.angle, abs=1e-4)


@pytest.mark.parametrize("helix", [SLEEVE, STEEP])
def test_the_load_balances_the_turning_of_the_tension(helix):
    """Force per length on a string under tension T is T times the change of its direction (finite differences)."""
    share, step = 0.37, 1e-4
    before, here, after = line(helix, np.array([share - step, share, share + step])).T
    bend = (after - 2 * here + before) / (step * helix.length) ** 2
    outward = -bend @ (here * [1, 1, 0]) / helix.radius
    assert helix.line_load(12.0) == pytest.approx(12.0 * outward, rel=1e-6)


@pytest.mark.parametrize("helix", [SLEEVE, STEEP])
def test_normal_force_is_the_work_of_the_tension_over_a_change_of_radius(helix):
    """T dl = N dr with ends and turns fixed: the radius of a shortened helix, seen from the other side."""
    change = 1e-5 * helix.length
    longer, shorter = helix.shortened(helix.length + change), helix.shortened(helix.length - change)
    per_radius = 2 * change / (longer.radius - shorter.radius)
    assert helix.normal_force(7.0) == pytest.approx(7.0 * per_radius, rel=1e-7)
    assert shorter.turns == helix.turns
    assert shorter.height == helix.height


def test_half_hoops_balance_as_in_figure_3_5():
    """A hoop cut in two halves (Eqs. 3.2, 3.3): its load on the diameter is what both ends pull in the hoop's plane."""
    r, sine = SLEEVE.radius, np.sin(np.radians(SLEEVE.angle))
    along_hoop = np.linspace(-np.pi / 2, np.pi / 2, 20_001)
    per_hoop = np.trapezoid(SLEEVE.hoop_load(9.0) * np.cos(along_hoop) * r, along_hoop)
    per_actuator = np.trapezoid(SLEEVE.line_load(9.0) * np.cos(along_hoop) * r / sine, along_hoop)
    assert per_hoop == pytest.approx(2 * 9.0 * sine, rel=1e-8)
    assert per_actuator == pytest.approx(2 * 9.0 * sine, rel=1e-8)


def test_the_sleeve_of_the_source():
    assert SLEEVE.radius == pytest.approx(0.0428, rel=1e-12)
    assert SLEEVE.turns == pytest.approx(2.3511248, abs=1e-7)
    assert SLEEVE.hoop_load(30.0) / SLEEVE.line_load(30.0) - 1 == pytest.approx(0.012, abs=3e-4)  # the dropped sine
    wound = 2 * np.pi * SLEEVE.radius * SLEEVE.height
    assert SLEEVE.pressure(30.0) * wound == pytest.approx(SLEEVE.line_load(30.0) * 0.640)
    assert SLEEVE.friction_force(30.0, 0.4) == pytest.approx(0.4 * SLEEVE.pressure(30.0) * wound)


def test_constriction_follows_the_blocked_force():
    pressure = np.array([2e4, 1e5, 2e5])
    result = constriction(TUBE, SLEEVE, pressure, friction=0.5)
    force = blocked_force(TUBE, pressure)["force"].values
    assert result["force"].values == pytest.approx(force, rel=1e-6)
    assert result["hoop_load"].values == pytest.approx(force * np.sin(np.radians(SLEEVE.angle)) / 0.0428, rel=1e-6)
    assert result["friction_force"].values == pytest.approx(0.5 * result["line_load"].values * 0.640)
    for name in ("hoop_load", "line_load", "arm_pressure", "friction_force"):
        share = result[f"{name}_error"] / result["force_error"]
        assert share.values == pytest.approx((result[name] / result["force"]).values)
        assert result[name].attrs["units"] in ("N/m", "Pa", "N")
    assert "lower by almost half (Figure 3-13)" in result.attrs["comment"]


def test_a_string_cannot_push():
    assert SLEEVE.line_load([-3.0, 0.0, 1.0]).tolist()[:2] == [0.0, 0.0]
    result = constriction(TUBE, SLEEVE, [1e3, 14e3])
    assert result["status"].values.tolist() == [3, 0]  # the wall would have to be pushed; then it is
    assert np.isnan(result["line_load"].values[0])
    assert result["force"].values[1] < 0.0
    assert result["line_load"].values[1] == 0.0


@pytest.mark.parametrize(
    ("made", "faults"),
    [
        (
            lambda: Helix(length=-1, height="99 N", turns=0),
            ["length: found -1", "height: expects", "turns: found 0"],
        ),
        (lambda: Helix(length=0.1, height=0.1, turns=2), ["height: found 0.1 m; an actuator of 0.1 m winds less"]),
        (lambda: Helix.around(0.0, np.nan, True), ["radius: found 0", "length: found nan", "height: found bool"]),
        (lambda: Helix.around(0.04, 0.1, 0.2), ["height: found 0.2 m"]),
        (lambda: SLEEVE.friction_force(1.0, -0.1), ["coefficient: found -0.1"]),
        (lambda: constriction(TUBE, 3.0, 1e5, friction="x"), ["helix: found float", "friction: expects"]),
        (lambda: constriction(TUBE, SLEEVE, -1.0), ["pressure: found -1"]),
    ],
)
def test_every_fault_is_named(made, faults):
    with pytest.raises(ActuatorError) as error:
        made()
    assert len(error.value.faults) == len(faults)
    for found, expected in zip(error.value.faults, faults):
        assert found.startswith(expected)

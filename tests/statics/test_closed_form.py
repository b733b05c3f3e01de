"""Formulas of the uniform tube against the theory: locked state, blocked force and torque, regions of designs."""

import numpy as np
import pytest

from freesweep import Actuator, ActuatorError, MooneyRivlin, blocked_torque, closed_form

PLANE = [(30, -30), (0, 30), (10, 50), (70, 20), (20, -80), (60, 55), (-40, -15), (85, -85), (2, -75)]
RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)
AREA = np.pi * 4.76e-3**2  # [m2]


def tan(angle):
    return np.tan(np.radians(angle))


def constraint(alpha, axial, stretch, twist):
    """Length of a deformed fiber over the axial length it had: sqrt(1 + tan^2) where it is not stretched (Eq. 2.3)."""
    return np.sqrt(axial**2 + stretch**2 * (tan(alpha) + twist) ** 2)


def test_locked_muscle_of_thirty_degrees():
    stretch = closed_form.locked_stretch(30, -30)
    axial, twist, alpha, beta = closed_form.uniform_state(30, -30, stretch)
    assert stretch == pytest.approx(1.632993, abs=5e-7)
    assert axial == pytest.approx(2 / 3, abs=1e-14)
    assert twist == 0
    assert alpha == pytest.approx(54.7356, abs=5e-5)
    assert beta == -alpha


def test_locked_rotator():
    stretch = closed_form.locked_stretch(0, 30)
    assert stretch == pytest.approx(3.0492, abs=5e-5)
    axial, twist, *_ = closed_form.uniform_state(0, 30, stretch)
    assert axial == pytest.approx(0.6188, abs=5e-5)
    assert twist < 0  # alpha = 0, beta > 0: the free end turns negative when the tube swells


@pytest.mark.parametrize("extension", [1.0, 1.01])
@pytest.mark.parametrize(("alpha", "beta"), PLANE)
def test_fibers_of_a_uniform_tube_keep_their_stretch(alpha, beta, extension):
    for stretch in (1.0, 1.001, float(closed_form.locked_stretch(alpha, beta, extension))):
        axial, twist, alpha_now, beta_now = closed_form.uniform_state(alpha, beta, stretch, extension)
        for before, now in ((alpha, alpha_now), (beta, beta_now)):
            assert constraint(before, axial, stretch, twist) == pytest.approx(extension / np.cos(np.radians(before)))
            assert tan(now) == pytest.approx(stretch * (tan(before) + twist) / axial, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("extension", [1.0, 1.01])
@pytest.mark.parametrize(("alpha", "beta"), PLANE)
def test_locked_designs_lie_on_the_locked_manifold(alpha, beta, extension):
    alpha_now, beta_now = closed_form.locked_angles(alpha, beta, extension)
    assert tan(alpha_now) * tan(beta_now) == pytest.approx(-2, abs=1e-11)


@pytest.mark.parametrize(("alpha", "beta"), PLANE)
def test_the_locked_volume_is_the_largest(alpha, beta):
    locked = float(closed_form.locked_stretch(alpha, beta))
    volume = [y**2 * closed_form.uniform_state(alpha, beta, y)[0] for y in locked * np.array([0.999, 1.0, 1.001])]
    assert volume[1] > max(volume[0], volume[2])


def test_designs_on_the_locked_manifold_do_not_move():
    alpha = np.array([-80.0, -30, 2, 45, 54.735610317245346, 85])
    beta = closed_form.locked_manifold(alpha)
    assert tan(alpha) * tan(beta) == pytest.approx(np.full(6, -2), rel=1e-13)
    assert closed_form.locked_stretch(alpha, beta) == pytest.approx(np.ones(6), abs=1e-13)
    assert np.abs(closed_form.blocked_force(alpha, beta, 1, 1)).max() < 1e-14
    assert np.abs(closed_form.blocked_torque(alpha[:4], beta[:4], 1, 1)).max() < 1e-14
    assert (closed_form.region(alpha, beta) == "LM").all()


def test_a_stretch_beyond_the_fibers_has_no_state():
    axial, *_ = closed_form.uniform_state(30, -30, 2.1)  # 1/sin(30) = 2 is the most
    assert np.isnan(axial)
    assert closed_form.uniform_state(30, -30, 1.99)[0] > 0


def test_blocked_force_of_mckibben_muscles():
    """pi r^2 P (2 cot^2 - 1): zero at 54.7 degrees, growing with radius squared, linear in pressure."""
    alpha = np.array([5.0, 20, 30, 50, 54.735610317245346, 60, 85])
    force = closed_form.blocked_force(alpha, -alpha, 4.76e-3, 1e5)
    assert force == pytest.approx(AREA * 1e5 * (2 / tan(alpha) ** 2 - 1), rel=1e-12, abs=1e-12)
    assert force[0] > force[1] > 0 > force[5]
    assert closed_form.blocked_force(30, -30, 4.76e-3, 1e5) == pytest.approx(35.59, abs=0.005)
    assert closed_form.blocked_force(30, -30, 2 * 4.76e-3, 3e5) == pytest.approx(12 * force[2])


def test_published_muscle_agrees_at_its_outer_radius():
    """28.6 degrees, inner radius 10 mm, wall 1.8 mm, 600 kPa: 1515 N published."""
    assert closed_form.blocked_force(28.6, -28.6, 11.8e-3, 6e5) == pytest.approx(1503, abs=0.5)
    assert closed_form.blocked_force(28.6, -28.6, 10e-3, 6e5) == pytest.approx(1080, abs=0.6)


def test_blocked_torque_with_straight_fibers():
    """Eq. 2.20: 2 pi r0^3 P / tan(beta)."""
    beta = np.array([-60.0, 20, 30, 60, 80])
    torque = closed_form.blocked_torque(0, beta, 4.76e-3, 1e5)
    assert torque == pytest.approx(2 * np.pi * 4.76e-3**3 * 1e5 / tan(beta), rel=1e-13)


def test_blocked_values_keep_the_symmetries():
    for alpha, beta in ((20, -50), (10, -75)):
        assert closed_form.blocked_force(alpha, beta, 1, 1) == closed_form.blocked_force(beta, alpha, 1, 1)
        assert closed_form.blocked_force(alpha, beta, 1, 1) == closed_form.blocked_force(-alpha, -beta, 1, 1)
        assert closed_form.blocked_torque(alpha, beta, 1, 1) == closed_form.blocked_torque(beta, alpha, 1, 1)
        assert closed_form.blocked_torque(alpha, beta, 1, 1) == -closed_form.blocked_torque(-alpha, -beta, 1, 1)


def test_poles_and_meaningless_designs_are_nan():
    for alpha, beta in ((0, 30), (-20, 0), (10, 50), (-10, -50), (30, 30)):  # straight fibers, region I, one family
        assert np.isnan(closed_form.blocked_force(alpha, beta, 1, 1)), (alpha, beta)
    for alpha, beta in ((30, -30), (-5, 5), (0, 0), (30, 30)):
        assert np.isnan(closed_form.blocked_torque(alpha, beta, 1, 1)), (alpha, beta)
    assert np.isnan(closed_form.locked_stretch(30, 30))
    assert np.isfinite(closed_form.blocked_force(0.01, -30, 1, 1))
    assert np.isfinite(closed_form.blocked_torque(10, 50, 1, 1))


def test_blocked_force_grows_without_bound_toward_a_straight_fiber():
    force = closed_form.blocked_force([1, 0.1, 0.01], -30, 1, 1)
    assert force[1:] / force[:-1] == pytest.approx([10, 10], rel=0.01)


@pytest.mark.parametrize(
    ("alpha", "beta", "name"),
    [
        (30, -30, "AF"), (0, 0, "DF"), (30, 30, "DF"), (10, 50, "I"), (-10, -50, "I"), (0, 30, "I"), (30, -50, "IIa"),
        (-50, 30, "IIa"), (70, -60, "IIb"), (60, -70, "IIb"), (20, float(closed_form.locked_manifold(20)), "LM"),
    ],
)  # fmt: skip
def test_regions_of_the_design_space(alpha, beta, name):
    assert closed_form.region(alpha, beta) == name
    assert name in closed_form.REGIONS


def test_motions_of_the_regions():
    """I swells, first longer; IIa swells and shortens; IIb thins and lengthens: volume grows on the way."""
    for (alpha, beta), swells, longer in (((10, 50), 1, 1), ((30, -50), 1, -1), ((70, -60), -1, 1)):
        axial = closed_form.uniform_state(alpha, beta, 1 + swells * 1e-4)[0]
        assert np.sign(closed_form.locked_stretch(alpha, beta) - 1) == swells
        assert np.sign(axial - 1) == longer
        assert (1 + swells * 1e-4) ** 2 * axial > 1


def test_region_one_is_longest_where_the_theory_says():
    """y^2 = H/|D|."""
    half_sum, half_difference = 0.5 * (tan(10) + tan(50)), 0.5 * (tan(50) - tan(10))
    y = np.sqrt(half_sum / half_difference)
    lengths = closed_form.uniform_state(10, 50, np.array([0.999 * y, y, 1.001 * y]))[0]
    assert lengths[1] > max(lengths[0], lengths[2])


def test_arrays_broadcast_and_scalars_stay_scalar():
    alpha, beta = np.array([[10.0], [20.0]]), np.array([-70.0, -50.0, 50.0])
    for function, more in (
        (closed_form.locked_stretch, (1.01,)),
        (closed_form.blocked_force, (4.76e-3, 1e5)),
        (closed_form.blocked_torque, (4.76e-3, 1e5)),
        (closed_form.region, ()),
    ):
        whole = function(alpha, beta, *more)
        assert whole.shape == (2, 3)
        one = function(20, -70, *more)
        assert np.ndim(one) == 0
        assert whole[1, 0] == one
    pressures = np.array([[1e4], [2e4]])
    assert closed_form.blocked_force(30, [-30.0, -50, -60], 1, pressures).shape == (2, 3)
    assert [part.shape for part in closed_form.uniform_state(alpha, beta, 1.01)] == [(2, 3)] * 4


def test_shares_of_the_pressure_balance_it():
    """At y = 1, where nothing is strained: the sums of section 10 of loads along, around and about the axis."""
    draw = np.random.default_rng(4)
    alpha, beta = draw.uniform(1, 80, 50), draw.uniform(-80, 80, 50)
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    for held, kind in (("rotation", closed_form.blocked_torque), ("length", closed_form.blocked_force)):
        a, b = closed_form.held_shares(alpha, beta, held)
        load = kind(alpha, beta, 1.0, 1.0) / np.pi  # per pressure, in radii of the fibers
        known = np.isfinite(load)
        assert (known == np.isfinite(a)).all()
        assert known.sum() > 20
        f, m = (load, 0.0) if held == "length" else (0.0, load)
        np.testing.assert_allclose((a * ta**2 + b * tb**2)[known], 1.0, rtol=1e-10)
        np.testing.assert_allclose((a + b - 0.5 * (1.0 + f))[known], 0.0, atol=1e-9)
        np.testing.assert_allclose((a * ta + b * tb - 0.5 * m)[known], 0.0, atol=1e-8)


def test_of_loose_threads_closed_forms_are_given_where_both_pull():
    alpha, beta = np.meshgrid(np.arange(2.0, 80.0, 3.0), np.arange(-80.5, 80.0, 3.0))
    bonded = closed_form.blocked_torque(alpha, beta, 5e-3, 1e5)
    loose = closed_form.blocked_torque(alpha, beta, 5e-3, 1e5, fibers="loose")
    magic = np.degrees(np.arctan(np.sqrt(2.0)))
    astride = (alpha < magic) != (np.abs(beta) < magic)
    assert (np.isfinite(loose) == astride).all()
    np.testing.assert_array_equal(loose[astride], bonded[astride])
    force = closed_form.blocked_force(alpha, beta, 5e-3, 1e5)
    np.testing.assert_array_equal(closed_form.blocked_force(alpha, beta, 5e-3, 1e5, fibers="loose"), force)
    assert closed_form.held_shares(0.0, 30.0)[0] == pytest.approx(-2.5)  # prototype B's straight family
    with pytest.raises(ActuatorError, match=r"fibers.*'bonded'") as error:
        closed_form.blocked_torque(10, 40, 1, 1, fibers="glued")
    assert "glued" in str(error.value)
    with pytest.raises(ActuatorError, match="held"):
        closed_form.held_shares(10, 40, held="torque")


@pytest.mark.long  # minutes of compiling
@pytest.mark.parametrize(("alpha", "beta", "pulls"), [(20.0, 62.0, True), (15.0, 45.0, False)])
def test_held_tubes_with_loose_threads_and_thick_walls_meet_the_closed_form_where_it_is_given(alpha, beta, pulls):
    tube = Actuator(alpha=alpha, beta=beta, length=0.1, radius=5e-3, wall=1.5e-3, material=RUBBER, model="physical")
    held = blocked_torque(tube, 2e4, x=0.0, accuracy=1e-4)
    by_bonded = closed_form.blocked_torque(alpha, beta, 6.5e-3, 2e4)
    by_loose = closed_form.blocked_torque(alpha, beta, 6.5e-3, 2e4, fibers="loose")
    assert np.isfinite(by_loose) == pulls
    assert (held["slack_fiber"].item() == 0) == pulls
    assert (held["torque"].item() == pytest.approx(by_bonded, rel=1e-5)) == pulls

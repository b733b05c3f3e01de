"""States that no mesh holds from a rough guess, and branches that end where no mesh says so: found by censuses."""

import numpy as np
import pytest

from freesweep.census.designs import Drawn, quadrature, with_pressures
from freesweep.first_integral.folded import solve_near
from freesweep.first_integral.uniform import Tubes
from freesweep.solver import batch, lagrangian, uniform
from freesweep.status import BEYOND_LIMIT, OK
from freesweep.sweep import solve

# alpha, beta, length, wall, fiber extension, C01/C10, force, torque, energy
NO_MERIDIAN = np.array([
    [82.52753102882784, 74.45040863203896, 4.501114541249383, 0.5497215, 1.0179303469048453, 1.4995501, 0, 0.0449308, 1],
    [82.94901425324436, 74.51238048207254, 11.080651514473306, 0.1150006, 1.016793120594669, 0.388958, 0, 0, 0],
    [-71.8063586055306, -83.96191481852523, 55.9180056347678, 0.1379209, 1.0169911439244677, 0, 0, 0, 1],
    [67.98559946646333, 84.36476386756918, 7.068597784190279, 0.0699997, 1.0193293470358176, 0.8691, 1.04176, 1.42, 1],
])  # fmt: skip


def walked(designs, pressures):
    """Free states of designs (n, 9), each at ``pressures`` (n, m), by the scalar kernels."""
    designs, pressures = np.atleast_2d(designs), np.atleast_2d(pressures)
    first = np.arange(len(designs) + 1) * pressures.shape[1]
    return batch.walk_all(
        Drawn(designs, pressures).problems(), first, pressures.ravel(), batch.uniform(24), 1e-6, lanes=False
    )


def test_fiber_extension_that_leaves_the_clamped_ends_hardly_any_meridian():
    """lambda_1^2 at the ends is 0.0001 to 0.006: the tube stands upright there, its axial stretch all but nil."""
    pressures = np.array([[0.01282], [0.004127], [0.005309], [0.0571]])
    walks = walked(NO_MERIDIAN, pressures)
    assert walks.status.tolist() == [OK] * 4
    exact, errors = quadrature(with_pressures(NO_MERIDIAN, pressures)[:, 0], walks.values[:, 4])
    assert np.all(np.abs(walks.values - exact) <= walks.bounds + 3 * errors)
    assert np.all(walks.bounds[:, :3] < 1e-7 * NO_MERIDIAN[:, 2:3])


@pytest.mark.parametrize(("rival", "design", "pressure"), [
    (1.003, [-81.06246655865199, 5.790945059213132, 185.47536115727192, 0.11253429988080539, 1.0194769120033753, 0, 0, 0, 0],
     0.013911768485619631),
    (1.0, [6.427915084038476, -84.54549743225901, 62.10065, 0.5982126, 1.0173103563424473, 0.316522, 0, 0, 0], 0.00562986),
])  # fmt: skip
def test_long_tube_whose_ends_have_a_stretch_that_pays_more_turns_back_before_the_uniform_one(rival, design, pressure):
    """The uniform tube is carried all the way, but a stretch on the way to the ends has a larger U = L(y, 0) by then: no
    meridian leads from one to the other.
    """
    (problem,) = Drawn(np.array([design]), None).problems()
    H, D, area, gamma, ratio, shear = problem[:6]
    rest = (1.0, (ratio,), shear, 0.0, 0.0, 0.0, 1.0)
    load = (gamma, (ratio,), shear, pressure, 0.0, 0.0, 1.0)
    u, carried = uniform.follow(lagrangian.density, 1.0, (H, D, area), rest, load, 0.5 * problem[8])
    assert carried == 1.0
    middle, between = (lagrangian.uniform_tube(y, (H, D, area), load)[2] for y in (u, rival))
    assert between > middle
    walks = walked(design, [pressure])
    assert walks.status.tolist() == [BEYOND_LIMIT]
    assert np.isnan(walks.limits).all()


def test_tension_on_fibers_that_soon_are_taut_snaps_through_a_hundredth_of_the_stretch():
    """All loads rise in proportion: the middle falls to 0.9645 at 2.63 % of them, and snaps to 0.954, where the tube is as
    long as its fibers let it be: a small snap on the first leg, and no state of the branch beyond.
    """
    design = [-26.09781114003923, 84.39392415578224, 9.526823, 0.0615944, 1.0, 0.0, 2.6022336, 0.0, 0.0]
    share = 0.0262
    before = [*design[:6], share * design[6], 0.0, 0.0]
    assert walked(before, [share * 0.0231471]).status.tolist() == [OK]
    assert walked(design, [0.0231471]).status.tolist() == [BEYOND_LIMIT]


@pytest.mark.parametrize(("design", "pressures"), [
    ([54.575542549973655, -50.13356896977278, 3.0750525, 0.0420163, 1.0, 0.3154084, 0.0, 1.3687362, 0.0],
     [0.0138177, 0.0350362, 0.0410376, 0.5664707]),  # as thin as its fibers let it be: it hardly moves any more
    ([-60.50698409064801, -74.27240951628521, 2.4267107, 0.0325138, 1.0115830815, 0.8775549, -0.2473366, 1.0117649, 0.0],
     [0.2640958, 0.4878, 3.0003]),  # swollen to 2.42, then, at rising pressure, less
])  # fmt: skip
def test_middles_that_stand_still_or_turn_back_while_the_load_rises(design, pressures):
    walks = walked(design, pressures)
    assert walks.status.tolist() == [OK] * len(pressures)
    (problem,) = Drawn(np.array([design]), None).problems()
    H, D, area, gamma, ratio, shear, force, torque, length, *yeoh = (np.full(len(pressures), p) for p in problem)
    tubes = Tubes(
        H,
        D,
        area,
        gamma,
        ratio,
        shear,
        np.array(pressures),
        force,
        torque,
        np.ones(len(pressures)),
        0.5 * length,
        *yeoh,
    )
    exact = solve_near(tubes, walks.values[:, 4])
    whole = np.array([2.0, 2.0, 2.0, 2.0, 1.0])
    assert np.all(np.abs(walks.values * whole - exact.values) <= walks.bounds * whole + 3 * exact.errors)


@pytest.mark.parametrize(("design", "pressure"), [
    ([32.678440268795626, -6.121091044035673, 149.2656564, 0.0313171, 1.019817753, 0.0, 0.0, 0.0, 0.0], 5.196446986),
    ([-21.782784033118126, 5.6306109297600635, 45.8915686, 0.044149, 1.0046410117, 0.0, 0.0, 0.0, 0.0], 9.879182936),
])  # fmt: skip
def test_rotation_of_nearly_straight_fibers_is_held_by_a_narrow_neck_and_a_wide_body(design, pressure):
    """One turns as far as the other turns back; between them stands a wall as steep as a flange, which moves as the load
    rises. Meshes that begin apart agree.
    """
    problems = Drawn(np.array([design]), None).problems()
    states = [
        solve._solve_held(
            "blocked_torque", problems, np.zeros(1), np.array([0, 1]), np.array([pressure]),
            (solve.UNIFORM[0], np.array([0, base]), solve.UNIFORM[2]), 1e-6,
        )[0][0]
        for base in (24, 384)
    ]  # fmt: skip
    assert [state["status"] for state in states] == [OK] * 2
    one, other = states
    assert one["stable"] == other["stable"]
    assert abs(one["value"] - other["value"]) <= one["bound"] + other["bound"]
    assert one["bound"] < 1e-5 * abs(one["value"])

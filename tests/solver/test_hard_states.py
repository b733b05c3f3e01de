"""States that no mesh holds from a rough guess, and branches that end where no mesh says so: found by censuses."""

import numpy as np
import pytest
from proportional import in_proportion, judged_near
from scipy.optimize import brentq, minimize_scalar

from freesweep.census.designs import Drawn, with_pressures
from freesweep.first_integral.folded import solve_near
from freesweep.first_integral.uniform import Tubes
from freesweep.solver import batch
from freesweep.solver.load import Load
from freesweep.solver.physics import lagrangian, uniform_tube
from freesweep.status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK
from freesweep.sweep import solve

# alpha, beta, length, wall, fiber extension, C01/C10, force, torque, energy
NO_MERIDIAN = np.array([
    [82.52753102882784, 74.45040863203896, 4.501114541249383, 0.5497215, 1.0179303469048453, 1.4995501, 0, 0.0449308, 1],
    [82.94901425324436, 74.51238048207254, 11.080651514473306, 0.1150006, 1.016793120594669, 0.388958, 0, 0, 0],
    [-71.8063586055306, -83.96191481852523, 55.9180056347678, 0.1379209, 1.0169911439244677, 0, 0, 0, 1],
    [67.98559946646333, 84.36476386756918, 7.068597784190279, 0.0699997, 1.0193293470358176, 0.8691, 1.04176, 1.42, 1],
])  # fmt: skip


def walked(designs, pressures):
    """Free states of designs (n, 9), each at ``pressures`` (n, m), whose loads rise in proportion to the first."""
    designs, pressures = np.atleast_2d(designs), np.atleast_2d(pressures)
    first = np.arange(len(designs) + 1) * pressures.shape[1]
    return in_proportion(Drawn(designs, pressures).problems(), first, pressures.ravel())


def held(design, pressure, base=24):
    """The state of a design (9,) whose rotation is held at 0."""
    problems = Drawn(np.array([design]), None).problems()
    tube = solve.UNIFORM[0], np.array([0, base]), solve.UNIFORM[2]
    first = np.array([0, 1])
    return solve._solve_held("blocked_torque", problems, np.zeros(1), first, np.array([pressure]), (tube, 0.0), 1e-6)[
        0
    ][0]


def rounded(design):
    """A design (9,), and after it some that differ from it in their last digits: near a front that is finer than the meshes
    these decide whether a branch is lost, on each kind of processor for others.
    """
    draw = np.random.default_rng(0)
    yield np.array(design)
    for _ in range(7):
        yield np.append(np.array(design[:8]) * (1.0 + 1e-13 * draw.standard_normal(8)), design[8])


def test_fiber_extension_that_leaves_the_clamped_ends_hardly_any_meridian():
    """lambda_1^2 at the ends is 0.0001 to 0.006: the tube stands upright there, its axial stretch all but nil."""
    pressures = np.array([[0.01282], [0.004127], [0.005309], [0.0571]])
    walks = walked(NO_MERIDIAN, pressures)
    assert walks.status.tolist() == [OK] * 4
    exact, errors = judged_near(with_pressures(NO_MERIDIAN, pressures)[:, 0], walks.values[:, 4])
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
    rest = Load(1.0, (ratio,), (shear,), 0.0, 0.0, 0.0, 1.0)
    load = Load(gamma, (ratio,), (shear,), pressure, 0.0, 0.0, 1.0)
    cell = (H, D, area)
    u = 1.0
    for share in np.linspace(0.0, 1.0, 1001)[1:]:
        for _ in range(8):
            _, L_y, _, L_yy, _, _ = lagrangian.density(u, 0.0, cell, uniform_tube.between(rest, load, share))
            u -= L_y / L_yy
    if L_yy < 0.0 and abs(L_y) < 1e-9:
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
    states = [held(design, pressure, base) for base in (24, 384)]
    assert [state["status"] for state in states] == [OK] * 2
    one, other = states
    assert one["stable"] == other["stable"]
    assert abs(one["value"] - other["value"]) <= one["bound"] + other["bound"]
    assert one["bound"] < 1e-5 * abs(one["value"])


DRAWN_IN = [
    -47.35004990998980,
    54.96819362394741,
    5.405955898672588,
    0.04341255,
    1.01417247,
    1.1425841,
    1.17399,
    1.2436586,
    0,
]


def test_walk_stays_with_the_drawn_in_tube_where_another_shape_is_stable_too():
    """From 2.2 to 2.478 the tube may be drawn in to 0.165, or hardly at all: the branch from P = 0 has one of the two, until
    it ends.
    """
    pressures = np.concatenate([[0.008, 0.18], np.linspace(2.2, 4.2, 41)])
    problem = Drawn(np.array([DRAWN_IN]), None).problems()
    walk = in_proportion(problem, [0, len(pressures)], pressures)
    end = np.count_nonzero(pressures < 2.478)
    assert walk.status.tolist() == [OK] * end + [BEYOND_LIMIT] * (len(pressures) - end)
    middle = walk.values[:end, 4]
    assert np.all(np.diff(middle) > 0.0)
    assert middle[-1] < 0.1651
    np.testing.assert_allclose(walk.limits[0, 0], 2.4781921, rtol=1e-6)


@pytest.mark.parametrize(("design", "pressures", "limit"), [
    (DRAWN_IN, [0.00835639, 0.01211426, 0.18188333, 6.69107055], 2.4781921),
    ([-53.13639022389276, 69.56923577031455, 176.4797611, 0.03801205, 1.007998898, 1.53562397, 2.50068836, 1.08801758, 0],
     [0.07421381, 0.16033788, 2.97631278, 3.6691723], 3.665342),
    ([-51.37504832486609, 45.10533441908118, 3.777033086, 0.03401795, 1.013391523, 0.80311649, 0, -0.87866469, 0],
     [0.00355010416, 0.289979147, 0.706728938], 0.7038525),
    ([45.125085486725105, -40.02539375281235, 35.75187843, 0.03028057, 1.019797923, 0.22608917, 0, 1.37863644, 1],
     [0.05630412, 0.63456986, 2.25971523, 4.31166259], 4.2759),
])  # fmt: skip
def test_limit_pressures_a_hundredth_below_the_pressure_asked_for(design, pressures, limit):
    """The branch of a tube drawn in ends so close before the last pressure, or at so sharp a front, that only traces of
    many nodes tell: the same limit from the pressures of a census as from close ones.
    """
    before = np.count_nonzero(np.array(pressures) < limit)
    close = [*pressures[: before - 1], *np.linspace(pressures[before - 1], limit, 9), pressures[before]]
    for one in rounded(design):
        walk, again = walked(one, pressures), walked(one, close).limits[0]
        if walk.status[-1] != NOT_CONVERGED and np.isfinite(again[0]):
            break
    assert walk.status.tolist() == [OK] * before + [BEYOND_LIMIT] * (len(pressures) - before)
    found, bound = walk.limits[0]
    assert abs(found - again[0]) <= bound + again[1]
    assert abs(found - limit) <= bound + 1e-4 * limit
    assert bound < 4e-3 * limit


@pytest.mark.parametrize(("design", "pressures"), [
    ([3.5997409953131982, -68.94055041532766, 3.28251, 0.0893347, 1.0, 1.0196544, -0.00287541164302, -1.4377177, 1],
     [0.00446352, 0.00824967]),
    ([19.037598450111926, 54.833691070417224, 43.343455, 0.0591159, 1.0, 1.0439081, -0.00204738847043, 1.4216720, 0],
     [0.00369226572, 0.00637907]),
])  # fmt: skip
def test_tube_drawn_in_under_a_force_that_pushes_lets_its_wall_go_in_the_middle(design, pressures):
    """There p y^2 + f is least: it vanishes before the middle is as far from the end as the tube is long."""
    assert walked(design, pressures).status.tolist() == [COMPRESSED, COMPRESSED]
    walk = walked(design, pressures[1:])
    assert walk.status.tolist() == [OK]
    force, middle = design[6], walk.values[0, 4]
    assert pressures[0] * middle**2 + force < 0.0 < pressures[1] * middle**2 + force


NECKED = np.array([
    [15.29470272884684, -2.2070729225853136, 187.1778910, 0.1128477, 1.0052590309921823, 0.0, 0.48638724432075886, 0.0, 1],
    [-9.693540809062114, 2.5518275559715, 119.1575391, 0.8576230, 1.0173541276490436, 0.0, 0.0, 0.0, 0],
    [4.861206474361323, -9.072089209121209, 98.8928131, 0.0380933, 1.0120027072904665, 0.0, 0.0, 0.0, 1],
    [-11.759827303567322, 4.6468324662693075, 176.0917846, 0.2308896, 1.0118060767839698, 0.4474165, 0.0, 0.0, 0],
    [5.191573018859016, -4.917336901930388, 64.4558869, 0.3463806, 1.0064943926432766, 0.0, 0.0, 0.0, 0],
])  # fmt: skip
NECKED_PRESSURES = np.array(
    [4.174003063666797, 8.515280736399443, 4.0215394269594995, 5.183805929986411, 4.7732829653144595]
)


def density(design, pressure, torque):
    """U(y), psi(y) and G(y) of a uniform tube, as functions of y: Eqs. 2.3 - 2.5, 2.11 once more."""
    alpha, beta, _, wall, gamma, ratio, force, _, full = design
    ta, tb = np.tan(np.radians([alpha, beta]))
    H, D, area, gg = (ta + tb) / 2.0, (ta - tb) / 2.0, wall * (2.0 + wall), gamma**2

    def psi(y):
        return H * (gg / y**2 - 1.0)

    def G(y):
        return gg * (1.0 + H**2 + D**2) - D**2 * y**2 - (gg * H / y) ** 2

    def U(y):
        g, shear = G(y), 1.0 + full * psi(y) ** 2
        w = g + y**2 * shear + 1.0 / (g * y**2) - 3.0 + ratio * (g * y**2 + 1.0 / y**2 + shear / g - 3.0)
        return (pressure * y**2 + force) * np.sqrt(g) - area * w + torque * psi(y)

    return U, psi, G


@pytest.mark.parametrize("row", range(4))
def test_long_tube_holds_its_rotation_by_the_torque_at_which_two_stretches_balance(row):
    """A thin and a wide part share the length, as two phases do at Maxwell's pressure: U' = 0 in both, and U is the same."""
    pressure, design = NECKED_PRESSURES[row], NECKED[row]
    state = held(design, pressure)

    def unbalance(torque):
        """Largest U of a thin tube over that of a wide one."""
        U, _, G = density(design, pressure, torque)
        largest = []
        for y in (np.geomspace(0.02, 0.8, 2000), np.geomspace(1.2, 30.0, 2000)):
            k = np.argmax(np.where(G(y) > 1e-3, U(y), -np.inf))
            there = minimize_scalar(
                lambda y: -U(y), bounds=(y[k - 1], y[k + 1]), method="bounded", options={"xatol": 1e-12}
            )
            largest.append(-there.fun)
        return largest[0] - largest[1]

    with np.errstate(invalid="ignore"):
        balanced = brentq(unbalance, 0.8 * state["value"], 1.2 * state["value"], rtol=1e-12)
    np.testing.assert_allclose(state["value"], balanced, rtol=1e-7)
    assert state["bound"] < 1e-6 * abs(state["value"])


def test_necked_tube_has_its_length_and_no_rotation_by_plain_quadrature():
    """Down to the neck at 0.0608 and out to 8.786 again, with the meridian's angle 89.98 degrees between."""
    design, pressure = NECKED[4], NECKED_PRESSURES[4]
    U, psi, G = density(design, pressure, held(design, pressure)["value"])
    node, weight = np.polynomial.legendre.leggauss(600)
    t, weight = 0.5 * (node + 1.0), 0.5 * weight

    def part(extreme, level):
        """Length and twist from an extreme stretch to the end's radius; y - extreme goes as t^2: no root is left there."""
        y = extreme + (1.0 - extreme) * t**2
        R, F = level - U(y), pressure * y**2 * np.sqrt(G(y))
        dx = weight * 2.0 * t * abs(1.0 - extreme) * (F + R) / np.sqrt(G(y) * R * (2.0 * F + R))
        return np.array([np.sum(dx), np.sum(dx * psi(y))])

    def half_and_twist(middle):
        neck = brentq(lambda y: U(y) - U(middle), 0.05, 0.07, xtol=1e-15)
        return 2.0 * part(neck, U(middle)) + part(middle, U(middle))

    middle = brentq(lambda y: half_and_twist(y)[0] - 0.5 * design[2], 8.75, 8.80, xtol=1e-12)
    np.testing.assert_allclose(middle, 8.786447, rtol=1e-6)
    assert abs(half_and_twist(middle)[1]) < 1e-4


@pytest.mark.parametrize("pressures", [[0.05, 0.5], [0.0139118, 0.5], [0.0139118, 0.04, 0.5, 4.0]])
def test_a_climb_passes_no_small_snap_of_the_uniform_tube(pressures):
    """At 0.07599 the stretch snaps from 1.009 to 1.029: within one step of the volume, which is larger behind it."""
    walk = walked([-81.0625, 5.7909, 185.475, 0.5, 1.01948, 0.0, 0.0, 0.0, 0.0], pressures)
    assert walk.status.tolist() == [OK if p < 0.0759 else BEYOND_LIMIT for p in pressures]
    np.testing.assert_allclose(walk.limits[0, 0], 0.0759914722, rtol=1e-8)


SMALL_SNAPS = {  # rows of problems, pressures, how many states lie before the snap, and the limit if it is one of pressures
    "of the pressure": (
        [1.73181918, -1.40975612, 0.59313935, 1.01495279, 1.82527363, 0.0, 0.0, 0.0, 37.40921399, 0.0, 0.0],
        [0.79, 0.798, 0.7985, 1.0, 1.35], 2, 0.79804347,
    ),
    "of the loads": (
        [-2.38957081, -2.83980481, 0.14035131, 1.0, 0.87824629, 0.0, 1.67445543, -0.96614994, 17.30259334, 0.0, 0.0],
        [0.003, 0.04], 0, None,
    ),
    "of the loads, where the branch bends": (
        [4.13170847, -3.96090964, 2.76906313, 1.0, 0.35726336, 0.0, 2.94180303, -1.0884204, 2.88595223, 0.0, 0.0],
        [0.18, 1.5], 0, None,
    ),
}  # fmt: skip


@pytest.mark.parametrize("where", SMALL_SNAPS)
def test_no_step_of_a_branch_passes_a_small_snap(where):
    """Shorter than a step in the stretch, and next to nothing in the load: meshes know them, too."""
    problem, pressures, before, limit = SMALL_SNAPS[where]
    walks = batch.walk_all(
        np.array([problem]), np.array([0, len(pressures)]), np.array(pressures), batch.uniform(24), 1e-6
    )
    assert walks.status.tolist() == [OK] * before + [BEYOND_LIMIT] * (len(pressures) - before)
    if limit:
        assert abs(walks.limits[0, 0] - limit) < 1e-6
        assert walks.limits[0, 1] < 1e-7

"""The walk along pressure against independent solutions of the same boundary-value problem (``oracle.py``)."""

from math import inf, isnan, log, radians, tan

import numpy as np
import pytest
from oracle import NoState, collocation, first_integral, uniform_stretch
from proportional import in_proportion, judged_near

from freesweep import closed_form
from freesweep.census.designs import Drawn
from freesweep.first_integral.tube import solve
from freesweep.first_integral.uniform import Tubes
from freesweep.solver import batch
from freesweep.solver.status import BEYOND_LIMIT, COMPRESSED, INVALID, OK

WHOLE = np.array([2.0, 2.0, 2.0, 2.0, 1.0])  # of the results of half a tube
WALL = (1 + 1.59 / 4.76) ** 2 - 1  # of the source's prototypes
NOTHING = np.empty(0)


def tube(alpha, beta, length=40.0, area=WALL, ratio=0.5, energy="full", f=0.0, m=0.0, gamma=1.0):
    """A row of problems from angles in degrees; ``length`` in radii."""
    ta, tb = tan(radians(alpha)), tan(radians(beta))
    return [0.5 * (ta + tb), 0.5 * (ta - tb), area, gamma, ratio, float(energy == "full"), f, m, length, 0.0, 0.0]


class Walks:
    """Results of the whole tube for lists of problems and of their pressures."""

    def __init__(self, problems, pressures, accuracy=1e-6, stations=NOTHING, lanes=True):
        self.first = np.cumsum([0, *map(len, pressures)])
        walks = batch.walk_all(
            np.array(problems, float), self.first, np.concatenate(pressures).astype(float), batch.uniform(24), accuracy,
            np.asarray(stations, float), lanes=lanes,
        )  # fmt: skip
        self.values, self.bounds, self.status, self.slack = walks[:4]
        self.limits, self.profiles = walks.limits, walks.profiles
        self.values *= WHOLE
        self.bounds *= WHOLE


def one(problem, *pressures, **options):
    return Walks([problem], [pressures], **options)


def scaled(differences, values, length):
    """Length per undeformed length, volume and energy relative, rotation per radian or relative, stretch as it is."""
    scale = [length, values[1], max(1.0, abs(values[2])), values[3], 1.0]
    return np.abs(differences) / scale


def test_the_independent_solutions_agree():
    """Quadrature against collocation: no common expression but the symbolic density."""
    cases = [
        (dict(alpha=30, beta=-30, length_over_radius=40, p=1.0), {}),
        (dict(alpha=0, beta=30, length_over_radius=10, p=2.0), {}),
        (dict(alpha=60, beta=40, length_over_radius=20, p=2.0), dict(m=0.1, energy="full")),
        (dict(alpha=20, beta=-50, length_over_radius=15, p=1.0), dict(f=0.5, m=-0.2, gamma=1.01, energy="principal")),
        (dict(alpha=0, beta=30, length_over_radius=10, p=inf), {}),
    ]
    for where, loads in cases:
        shape = first_integral(**where, wall_ratio_area_a=WALL, c_ratio=0.5, **loads, stations=[0.2, 1.0, 3.0])
        cell = (where["alpha"], where["beta"], WALL)
        path = [0.4, 2.0, inf] if where["p"] == inf else [where["p"]]
        *other, y = collocation(cell, where["length_over_radius"], 0.5, path, **loads, stations=[0.2, 1.0, 3.0])[-1]
        mine = [shape.length, shape.volume, shape.rotation, shape.energy, shape.middle]
        assert mine == pytest.approx([float(q) for q in other], rel=1e-9, abs=1e-9)
        assert shape.y == pytest.approx(y, abs=1e-9)


def random_design(draw, loads):
    """One design of the domain that the solver is asked to cover, and rising pressures."""
    while True:
        alpha, beta = draw.uniform(2, 85), draw.uniform(-85, 85)
        if abs(alpha - beta) >= 0.5:
            break
    wall = np.exp(draw.uniform(log(0.02), 0.0))
    design = {
        "alpha": alpha,
        "beta": beta,
        "length": np.exp(draw.uniform(log(3), log(120))),
        "area": (1 + wall) ** 2 - 1,
        "ratio": draw.uniform(0, 1),
        "energy": "full" if draw.random() < 0.6 else "principal",
    }
    if loads:
        design["gamma"] = draw.uniform(1, 1.02) if draw.random() < 0.5 else 1.0
        design["f"] = draw.choice([-1, 0, 1]) * np.exp(draw.uniform(log(0.003), log(3)))
        design["m"] = draw.choice([-1, 0, 1]) * np.exp(draw.uniform(log(0.003), log(3)))
    pressures = np.sort(np.exp(draw.uniform(log(0.01), log(50), 2)))
    return design, (*pressures, inf) if draw.random() < 0.2 else tuple(pressures)


@pytest.fixture(scope="module")
def compared():
    """Both solutions of a random sample: (design, pressure, status, values, bounds, exact values, their errors)."""
    draw = np.random.default_rng(2024)
    designs = [random_design(draw, loads) for loads in (False, True) for _ in range(16)]
    walks = Walks([tube(**design) for design, _ in designs], [pressures for _, pressures in designs])
    rows = []
    for k, (design, pressures) in enumerate(designs):
        for i, p in enumerate(pressures):
            row = walks.first[k] + i
            given = dict(design, length_over_radius=design["length"], wall_ratio_area_a=design["area"])
            for name in ("length", "area", "ratio"):
                del given[name]
            exact, errors = None, None
            if walks.status[row] == OK:
                shape = first_integral(**given, c_ratio=design["ratio"], p=p)
                exact = np.array([shape.length, shape.volume, shape.rotation, shape.energy, shape.middle])
                errors = shape.errors + 1e-12 * np.abs(exact)
            rows.append((design, p, walks.status[row], walks.values[row], walks.bounds[row], exact, errors))
    return rows


def solved(compared):
    return [row for row in compared if row[2] == OK]


def test_random_designs_are_solved(compared):
    """No defect status; a limit or a compression only where loads or Eq. 2.5 as printed can make one."""
    for design, p, status, values, *_ in compared:
        assert status in (OK, BEYOND_LIMIT, COMPRESSED), (design, p)
        assert np.isnan(values).all() == (status != OK)
        if status == COMPRESSED:
            assert design["f"] < 0, (design, p)
        if status == BEYOND_LIMIT:
            assert design["energy"] == "principal" or design["m"] != 0, (design, p)
    assert len(solved(compared)) > 0.8 * len(compared)


def test_random_designs_to_the_accuracy_asked_for(compared):
    for design, p, _, values, _, exact, _ in solved(compared):
        error = scaled(values - exact, exact, design["length"])
        assert np.all(error < 1e-6), (design, p, error)


def test_every_stated_bound_holds(compared):
    for design, p, _, values, bounds, exact, errors in solved(compared):
        # two quadratures of a long tube share the rounding that their difference measures
        assert np.all(np.abs(values - exact) <= bounds + 10 * errors), (design, p, values - exact, bounds)
        assert np.all(scaled(bounds, exact, design["length"]) <= 1.1e-6), (design, p, bounds)


def test_bounds_are_not_much_larger_than_errors(compared):
    ratios = []
    for design, _, _, values, bounds, exact, _ in solved(compared):
        error, bound = (scaled(q, exact, design["length"]) for q in (values - exact, bounds))
        ratios.extend((bound / np.maximum(error, 1e-300))[error > 1e-11])
    assert len(ratios) > 100
    assert np.median(ratios) <= 3000  # sums converge too fast for what their last coefficients tell to be sharp


@pytest.mark.parametrize(
    ("design", "p"),
    [
        (dict(alpha=30, beta=-30, length=40), 1.0),
        (dict(alpha=0, beta=30, length=10), inf),
        (dict(alpha=10, beta=50, length=20, m=-0.1, gamma=1.01), 3.0),
    ],
)
def test_shape_along_the_tube(design, p):
    """Stretch at stations against the quadrature, axial position and twist against their closed forms at the end."""
    half = 0.5 * design["length"]
    stations = np.array([0.0, 0.05, 0.3, 1.0, 2.5, half])
    walks = one(tube(**design), p, stations=stations)
    given = {name: value for name, value in design.items() if name != "length"}
    shape = first_integral(
        **given, length_over_radius=design["length"], wall_ratio_area_a=WALL, c_ratio=0.5, p=p, stations=stations
    )
    assert walks.profiles[0, 0] == pytest.approx(shape.y, abs=1e-6)
    assert 2 * walks.profiles[0, 1, -1] == pytest.approx(shape.length, abs=1e-6 * design["length"])
    assert 2 * walks.profiles[0, 2, -1] == pytest.approx(shape.rotation, abs=1e-6)


def test_unpressurised_tube_is_a_cylinder():
    walks = one(tube(20, -50, length=14), 0.0, 1.0)
    assert walks.status.tolist() == [OK, OK]
    assert walks.values[0].tolist() == [14.0, 14.0, 0.0, 0.0, 1.0]
    assert not walks.bounds[0].any()
    assert walks.values[1, 4] > 1.01


def test_negative_pressure_is_refused():
    walks = one(tube(20, -50), -1.0, 1.0)
    assert walks.status.tolist() == [INVALID, OK]
    assert np.isnan(walks.values[0]).all()


def test_design_on_the_locked_manifold_does_not_move():
    beta = float(closed_form.locked_manifold(30.0))
    walks = one(tube(30, beta, length=20), 0.1, 10.0, inf)
    assert walks.status.tolist() == [OK] * 3
    assert walks.values[:, 0] == pytest.approx(20, abs=1e-8)
    assert walks.values[:, 4] == pytest.approx(1, abs=1e-8)


def test_limit_pressure_of_a_wall_of_principal_energy():
    """Theory, section 7: 60/55 degrees, Lambda 40 snaps at p = 1.217827."""
    walks = one(tube(60, 55, energy="principal"), 0.5, 1.2, 1.2177, 1.3, 2.0)
    assert walks.status.tolist() == [OK, OK, OK, BEYOND_LIMIT, BEYOND_LIMIT]
    limit, bound = walks.limits[0]
    assert limit == pytest.approx(1.217827, abs=1e-6)
    assert bound < 1e-5
    assert np.isnan(walks.values[3:]).all()
    assert np.isnan(walks.bounds[3:]).all()
    assert np.isfinite(walks.values[:3]).all()


def quadrature_limit(*args, **loads):
    """Pressure at which the quadrature's branch ends."""
    with pytest.raises(NoState) as end:
        first_integral(*args, **loads)
    return float(str(end.value).split("p = ")[1].split(",")[0])


def test_limit_pressure_against_the_quadrature():
    """Short tubes carry more than the uniform tube: the quadrature's branch ends where the walk's does."""
    walks = one(tube(60, 55, length=8, energy="principal"), 0.5, 1.5)
    assert walks.status.tolist() == [OK, BEYOND_LIMIT]
    limit = quadrature_limit(60, 55, 8, WALL, 0.5, 1.5, energy="principal")
    assert walks.limits[0, 0] == pytest.approx(limit, abs=2e-7)


@pytest.mark.parametrize(
    ("alpha", "beta", "length", "area", "ratio", "far"),
    [(80, 23, 20, 0.26, 0.2, 2.4), (22, 84, 4.3, 1.64, 0.04, 9.0), (25, 73, 4.1, 0.19, 0.84, 1.3)],
)
def test_small_snap_is_not_jumped(alpha, beta, length, area, ratio, far):
    """The stretch beyond the limit differs by 2 to 30 %, and is a stable equilibrium: of another branch."""
    design = tube(alpha, beta, length=length, area=area, ratio=ratio, energy="principal")
    walks = one(design, 0.01, far)
    limit = quadrature_limit(alpha, beta, length, area, ratio, 0.6, energy="principal")
    assert walks.status.tolist() == [OK, BEYOND_LIMIT]
    assert walks.limits[0, 0] == pytest.approx(limit, abs=2e-7)
    assert one(design, far).status.tolist() == [BEYOND_LIMIT]


def in_two_parts(problem):
    """The same tube, told as one that varies: two segments alike; ``(course, edges, places)``."""
    course = np.zeros((2, 1, 3, 4))
    course[:, 0, :, 0] = problem[:3]
    length = problem[8]
    return course, np.array([0, 24, 48]), np.array([0.0, 0.5 * length, length])


@pytest.mark.parametrize("parts", [1, 2])
def test_fibers_that_extend_lead_up_to_the_limit_of_the_pressure_alone_and_no_further(parts):
    """A short tube holds 1 % more than the uniform one, whose turning point comes at p = 1.23: once its fibers have settled,
    at p = gamma^2 - 1, the pressure rises alone.
    """
    design = tube(60, 55, length=8, area=0.78, energy="principal", gamma=1.01)
    pressures = [1.235, 1.2375, 1.239, 1.3]
    given = batch.uniform(24) if parts == 1 else in_two_parts(design)
    walks = batch.walk_all(np.array([design]), np.array([0, 4]), np.array(pressures), given, 1e-6)
    assert walks.status.tolist() == [OK, OK, BEYOND_LIMIT, BEYOND_LIMIT]
    limit, bound = walks.limits[0]
    assert abs(limit - 1.238207591) < bound + 1e-8
    for row, p in enumerate(pressures[:2]):
        shape = first_integral(60, 55, 8, 0.78, 0.5, p, gamma=1.01, energy="principal")
        exact = np.array([shape.length, shape.volume, shape.rotation, shape.energy, shape.middle])
        assert np.all(np.abs(walks.values[row] * WHOLE - exact) <= walks.bounds[row] * WHOLE + 10 * shape.errors)
    with pytest.raises(NoState):
        first_integral(60, 55, 8, 0.78, 0.5, limit + bound + 1e-6, gamma=1.01, energy="principal")


def test_full_energy_has_no_limit_there():
    walks = one(tube(60, 55, energy="full"), 0.5, 2.0, 50.0)
    assert walks.status.tolist() == [OK] * 3
    assert isnan(walks.limits[0, 0])
    assert np.all(np.diff(walks.values[:, 1]) > 0)


def test_locked_muscle_of_thirty_degrees():
    """Uniform facts of theory, section 4: y = 1.632993, l/l0 = 2/3, for the middle and the slope in length."""
    short, long = (one(tube(30, -30, length=length), inf).values[0] for length in (60, 80))
    assert long[4] == pytest.approx(1.632993, abs=1e-6)
    assert (long[0] - short[0]) / 20 == pytest.approx(2 / 3, abs=1e-7)


def test_uniform_model_overstates_the_rotation():
    """Theory, section 4: by 35 %, 15 %, 3.3 % at Lambda 5, 10, 40, locked, 0/30 degrees."""
    stretch = closed_form.locked_stretch(0, 30)
    assert stretch == pytest.approx(3.0492, abs=1e-4)
    axial, twist, *_ = closed_form.uniform_state(0, 30, stretch)
    assert axial == pytest.approx(0.6188, abs=1e-4)
    for length, excess in ((5, 0.35), (10, 0.15), (40, 0.033)):
        rotation = one(tube(0, 30, length=length), inf).values[0, 2]
        assert twist * length / rotation - 1 == pytest.approx(excess, abs=0.005 if length < 40 else 0.0005)


def test_middle_of_long_locked_tubes_lies_on_the_locked_manifold():
    """tan(alpha') tan(beta') = -2 pointwise."""
    angles = [(30, -30), (0, 30), (10, 50), (75, -60), (70, 20), (20, -80), (60, 55)]
    walks = Walks([tube(*pair, length=120) for pair in angles], [(inf,)] * len(angles), accuracy=1e-8)
    assert (walks.status == OK).all()
    for pair, values in zip(angles, walks.values):
        _, _, alpha, beta = closed_form.uniform_state(*pair, values[4])
        assert np.tan(np.radians(alpha)) * np.tan(np.radians(beta)) == pytest.approx(-2, abs=1e-6)


def test_wall_that_would_have_to_be_pushed():
    """p y^2 + f <= 0 at the ends: no result; at a higher pressure in the same list the wall is taut again."""
    walks = one(tube(30, -30, f=-0.5), 0.2, 0.5, 0.8, 2.0)
    assert walks.status.tolist() == [COMPRESSED, COMPRESSED, OK, OK]
    assert np.isnan(walks.values[:2]).all()
    alone = one(tube(30, -30, f=-0.5), 0.8)
    assert walks.values[2] == pytest.approx(alone.values[0], rel=1e-6)


def test_torque_that_draws_the_tube_together_slackens_the_wall():
    """p y^2 + f is positive at the ends and negative at the uniform stretch: no result, and none by quadrature."""
    alpha, beta, area, ratio, p, f, m = 75, -20, 0.1, 0.0, 0.1, -0.055, 4.5
    u = uniform_stretch(alpha, beta, area, ratio, p, f, m)
    assert p + f > 0
    assert p * u**2 + f < 0
    walks = one(tube(alpha, beta, length=5, area=area, ratio=ratio, f=f, m=m), p)
    assert walks.status.tolist() == [COMPRESSED]
    assert np.isnan(walks.values).all()
    with pytest.raises(NoState):
        first_integral(alpha, beta, 5, area, ratio, p, f, m)


def test_swapping_the_families_changes_nothing():
    problems = [tube(20, -50, m=0.1), tube(-50, 20, m=0.1)]
    walks = Walks(problems, [(0.3, 3.0)] * 2)
    assert walks.values[:2] == pytest.approx(walks.values[2:], rel=1e-13)


def test_mirrored_tube_turns_the_other_way():
    walks = Walks([tube(20, -50, m=0.1), tube(-20, 50, m=-0.1)], [(0.3, 3.0)] * 2)
    assert abs(walks.values[0, 2]) > 1e-3
    assert walks.values[:2] * [1, 1, -1, 1, 1] == pytest.approx(walks.values[2:], rel=1e-13)


def test_pressure_alone_or_in_a_list():
    designs = [tube(30, -30), tube(0, 30, length=8), tube(60, 40, m=0.05), tube(80, -70, gamma=1.0), tube(10, 75)]
    pressures = (0.02, 0.1, 0.7, 1.0, 4.0, 30.0)
    together = Walks(designs, [pressures] * len(designs))
    alone = Walks([d for d in designs for _ in pressures], [(p,) for _ in designs for p in pressures])
    assert (together.status == OK).all()
    assert (alone.status == OK).all()
    assert np.all(np.abs(together.values - alone.values) <= together.bounds + alone.bounds)


def test_same_bits_alone_or_in_a_batch():
    draw = np.random.default_rng(7)
    designs = [random_design(draw, loads) for loads in (True, False) for _ in range(10)]
    batch = Walks([tube(**design) for design, _ in designs], [pressures for _, pressures in designs])
    for k, (design, pressures) in reversed(list(enumerate(designs))):
        single = one(tube(**design), *pressures)
        rows = slice(batch.first[k], batch.first[k + 1])
        for name in ("values", "bounds", "status", "slack"):
            assert getattr(batch, name)[rows].tobytes() == getattr(single, name).tobytes()


def test_accuracy_asked_for_is_what_the_bounds_meet():
    for accuracy in (1e-4, 1e-6, 1e-9):
        walks = one(tube(15, -40, length=10), 1.0, inf, accuracy=accuracy)
        for values, bounds in zip(walks.values, walks.bounds):
            assert np.all(scaled(bounds, values, 10.0) < 1.1 * accuracy)


def test_torque_and_force_do_work_in_their_direction():
    """Raising the pressure swells, a tension lengthens, a torque turns: the conjugate of each load grows with it."""
    base = dict(alpha=15, beta=55, length=20)
    walks = Walks(
        [tube(**base), tube(**base, f=0.05), tube(**base, m=0.05), tube(**base)], [(1.0,), (1.0,), (1.0,), (1.05,)]
    )
    reference, pulled, turned, inflated = walks.values
    assert pulled[0] > reference[0]
    assert turned[2] > reference[2]
    assert inflated[1] > reference[1]


def test_tubes_that_leave_their_ends_almost_upright():
    """Strong torque on a thin wall, or fibers so steep that their extension leaves the clamped ends hardly any meridian: no
    mesh follows the shape from a rough guess. Quadrature of the first integral solves them too.
    """
    upright = np.array([
        [-57.9189, 37.1325, 192.4893, 0.1667, 1.0, 0.0244, 0.0, -1.4742, 0.0030386, 1.0],
        [34.3257, -65.3817, 52.7936, 0.1139, 1.0, 0.0, 0.0, -1.4287, 0.0043018, 1.0],
        [-84.588, -82.4773, 69.7522, 0.1842, 1.006, 0.9586, 0.0, -0.0938, 0.0038022, 1.0],
        [52.7150, -43.0510, 13.1688, 0.0316, 1.0, 1.81, 0.0, 1.4217, 0.0096, 0.0],
    ])  # fmt: skip
    drawn = Drawn(np.delete(upright, 8, axis=1), upright[:, 8:9])
    walks = in_proportion(drawn.problems(), np.arange(5), upright[:, 8])
    assert walks.status.tolist() == [OK] * 4
    exact, errors = judged_near(upright, walks.values[:, 4])
    assert np.all(np.abs(walks.values - exact) <= walks.bounds + 3 * errors)


def test_turning_point_that_no_rough_mesh_finds():
    """A drawn-in tube whose layer at the ends moves as the pressure nears the limit: the branch is traced by its middle."""
    design = np.array([63.6425, -49.0115, 11.0141, 0.0428, 1.02, 0.0, 1.6625, 0.79, 0.0])
    problem = Drawn(design[None], None).problems()[0]
    below, beyond = one(problem, 0.6, 3.1), one(problem, 0.6, 8.0)
    assert below.status.tolist() == [OK, OK]
    assert beyond.status.tolist() == [OK, BEYOND_LIMIT]
    limit, bound = beyond.limits[0]
    assert limit - bound > 3.1
    H, D, area, gamma, ratio, shear, force, torque, length, *yeoh = problem
    given = (H, D, area, gamma, ratio, shear, 3.1, force, torque, 1.0, 0.5 * length, *yeoh)
    exact = solve(Tubes(*(np.array([number]) for number in given)))
    assert np.all(np.abs(below.values[1] - exact.values[0]) <= below.bounds[1] + 10 * exact.errors[0])
    assert limit == pytest.approx(3.1081, abs=1e-3)


def test_a_tube_that_torque_draws_in_lets_go_at_one_pressure_whatever_the_list():
    """Its clamped ends let go at 1.555; the uniform tube swells on without a limit, and would lead past it."""
    drawn = tube(53.64526, -43.69847, 3.21144, 0.07825 * 2.07825, 0.253916, "principal", f=1.055777, m=1.048992)
    lists = ([0.006176, 1.430731, 9.341646], np.linspace(0.006176, 9.341646, 40), np.linspace(0.006176, 3.0, 200))
    for pressures in lists:
        walks = in_proportion(np.array([drawn]), [0, len(pressures)], pressures)
        limit, bound = walks.limits[0]
        assert abs(limit - 1.5552888) < bound + 1e-7
        beyond = np.asarray(pressures) > limit
        assert np.all(walks.status == np.where(beyond, BEYOND_LIMIT, OK))
        assert np.all(walks.values[~beyond, 4] < 0.3)

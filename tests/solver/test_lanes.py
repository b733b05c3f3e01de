"""Vectors of designs against the scalar kernels, whose physics they share, and against each other."""

import os
import subprocess
import sys

import numba
import numpy as np
import pytest

from freesweep.census.designs import quadrature
from freesweep.scaling import problem_rows
from freesweep.solver import batch
from freesweep.solver.lanes import vector
from freesweep.solver.lanes.vector import WIDTH, bits, get, mask_of, put, select, some, spread
from freesweep.solver.load import Load
from freesweep.solver.physics import lagrangian
from freesweep.solver.status import INACCURATE, OK, PENDING

STEPS = 10


def designs(count, seed, hard=True):
    """Random problems, each with its own rising pressures, the locked shape last: ``(problems, first, pressures)``."""
    draw = np.random.default_rng(seed)
    problems, pressures = np.empty((count, 11)), []
    for k in range(count):
        a, b = np.tan(np.radians([draw.uniform(2, 85), draw.uniform(-85, 85)]))
        while abs(a - b) < 0.05:
            b = np.tan(np.radians(draw.uniform(-85, 85)))
        loaded, extended, wall = hard * (draw.uniform() < 0.5), hard * (draw.uniform() < 0.3), draw.uniform(0.05, 1.0)
        problems[k] = (
            0.5 * (a + b), 0.5 * (a - b), wall * (2 + wall), 1 + extended * draw.uniform(0, 0.02), draw.uniform(0, 1),
            float(draw.integers(2)), loaded * draw.uniform(-0.3, 1), loaded * draw.uniform(-1, 1),
            10 ** draw.uniform(0.5, 2), 0.0, 0.0,
        )  # fmt: skip
        steps = int(draw.integers(1, STEPS))
        pressures.append(
            np.r_[0.0, np.sort(10 ** draw.uniform(-2.5, 1, steps)), np.inf][: steps + int(draw.integers(3))]
        )
    first = np.cumsum([0, *map(len, pressures)])
    return problems, first, np.concatenate(pressures)


def walked(problems, first, pressures, **options):
    return batch.walk_all(problems, first, pressures, batch.uniform(24), 1e-6, **options)


@numba.njit
def _arithmetic(a, b, out):
    x, y = get(a, 0), get(b, 0)
    put(out, 0, x + y * 2.0 - 1 / x)
    put(out, 1, -x / y)
    put(out, 2, max(x, y))
    put(out, 3, min(x, 0.5))
    put(out, 4, select((x < y) & ~(x <= 0.0) | (y == 1.0), x, y))
    put(out, 5, 3.0)
    return bits(x > y), some(x > 1e9), some(mask_of(1)), bits(spread(2.0) >= 2.0)


def test_a_lane_is_a_float_in_every_operation():
    draw = np.random.default_rng(0)
    a, b, out = draw.normal(size=(1, WIDTH)), draw.normal(size=(1, WIDTH)), np.zeros((6, WIDTH))
    b[0, 1] = 1.0
    greater, none, one, all_of_them = _arithmetic(a, b, out)
    x, y = a[0], b[0]
    expected = [
        x + y * 2 - 1 / x, -x / y, np.maximum(x, y), np.minimum(x, 0.5),
        np.where((x < y) & ~(x <= 0) | (y == 1), x, y), np.full(WIDTH, 3.0),
    ]  # fmt: skip
    assert np.allclose(out, expected, rtol=1e-15, atol=0)
    assert [bool(greater >> k & 1) for k in range(WIDTH)] == (x > y).tolist()
    assert (none, one, all_of_them) == (False, True, 2**WIDTH - 1)


@numba.njit
def _extremes(a, out):
    x = get(a, 0)
    put(out, 0, max(x, 1.0))
    put(out, 1, min(x, 1.0))
    return bits(x > 0.0), bits(~(x > 0.0))


def test_a_nan_in_a_lane_is_no_room():
    """Every comparison with it is false, as for a float; its neighbours are not touched."""
    a, out = np.full((1, WIDTH), 2.0), np.zeros((2, WIDTH))
    a[0, 1] = np.nan
    positive, not_positive = _extremes(a, out)
    assert positive == 2**WIDTH - 1 - 2
    assert not_positive == 2
    assert np.all(out[:, [0, 2]] == [[2.0, 2.0], [1.0, 1.0]])


@numba.njit
def _mooney_rivlin(points):
    return (get(points, 11),)


@numba.njit
def _yeoh(points):
    return get(points, 11), get(points, 12), get(points, 13)


@numba.njit(error_model="numpy", fastmath={"contract"})
def _densities(points, rubber, out):
    cell, load = (get(points, 2), get(points, 3), get(points, 4)), Load(
        get(points, 5), rubber(points), (get(points, 6),), get(points, 7), get(points, 8), get(points, 9), get(points, 10),
    )  # fmt: skip
    found = lagrangian.density(get(points, 0), get(points, 1), cell, load)
    for k in range(6):
        put(out, k, found[k])


@numba.njit(error_model="numpy", fastmath={"contract"})
def _density(q, out):
    found = lagrangian.density(
        q[0], q[1], (q[2], q[3], q[4]), Load(q[5], (q[11], q[12], q[13]), (q[6],), q[7], q[8], q[9], q[10])
    )
    for k in range(6):
        out[k] = found[k]


@pytest.mark.parametrize("rubber", [_mooney_rivlin, _yeoh])
def test_the_density_is_the_same_in_a_lane_and_on_a_float(rubber):
    draw = np.random.default_rng(1)
    points = np.array([draw.uniform(0.8, 1.2, WIDTH), draw.uniform(-0.3, 0.3, WIDTH), *draw.uniform(-0.7, 0.7, (2, WIDTH)),
                       *draw.uniform(0.1, 1, (8, WIDTH)), *draw.uniform(-0.1, 0.2, (2, WIDTH))])  # fmt: skip
    points[12:] *= rubber is _yeoh
    out, one = np.zeros((6, WIDTH)), np.zeros(6)
    _densities(points, rubber, out)
    for k in range(WIDTH):
        _density(points[:, k].copy(), one)
        assert np.allclose(out[:, k], one, rtol=1e-13, atol=1e-13)


@pytest.fixture(scope="module")
def sample():
    return designs(150, 3)


@pytest.fixture(scope="module")
def together(sample):
    return walked(*sample)


def test_lanes_agree_with_the_scalar_kernels_within_the_bounds(sample, together):
    alone = walked(*sample, lanes=False)
    assert np.array_equal(together.status, alone.status)
    solved = np.isin(alone.status, (OK, INACCURATE))
    assert solved.mean() > 0.8
    assert np.array_equal(together.slack[solved], alone.slack[solved])
    apart = np.abs(together.values - alone.values)[solved]
    assert np.all(apart <= (together.bounds + alone.bounds)[solved])
    assert np.all(np.isnan(together.values[~solved]))
    assert np.array_equal(np.isnan(together.limits), np.isnan(alone.limits))
    assert np.nanmax(np.abs(together.limits / alone.limits - 1)[:, 0]) < 1e-6


@pytest.mark.parametrize("lanes", [True, False])
def test_the_middle_of_a_long_tube_is_told_by_its_ends(lanes):
    """Meshes that are far too coarse for its last layers: the bound is sharp, and holds against quadrature."""
    columns = [[30, -50, 10**e, 0.3, 1.005, 0.5, 0, 0, p, 1] for e in (0.5, 1, 1.3, 1.6, 2) for p in (1.0, np.inf)]
    tubes, (alpha, beta, length, wall, gamma, ratio, *_, pressures, full) = np.array(columns), np.transpose(columns)
    a, b, zero = np.tan(np.radians(alpha)), np.tan(np.radians(beta)), 0.0 * alpha
    problems = np.column_stack(
        [0.5 * (a + b), 0.5 * (a - b), wall * (2 + wall), gamma, ratio, full, zero, zero, length, zero, zero]
    )
    found = walked(problems, np.arange(len(tubes) + 1), pressures, lanes=lanes)
    exact, errors = quadrature(tubes, found.values[:, 4])
    assert np.all(np.abs(found.values - exact) <= found.bounds + errors)
    assert np.all(found.bounds[length > 15, 4] < 1e-8)


def test_yeoh_rubbers_in_lanes_agree_with_the_scalar_kernels_whoever_else_is_there():
    problems, first, pressures = designs(60, 21)
    yeoh = np.arange(60) % 2 == 1
    problems[yeoh, 9:] = np.random.default_rng(2).uniform([-0.02, 0.0], [0.2, 0.02], (30, 2))
    problems[yeoh, 4] = 0.0  # no C01
    mixed, alone = walked(problems, first, pressures), walked(problems, first, pressures, lanes=False)
    assert np.array_equal(mixed.status, alone.status)
    solved = np.isin(alone.status, (OK, INACCURATE))
    assert solved.mean() > 0.8
    assert np.array_equal(mixed.slack[solved], alone.slack[solved])
    assert np.all(np.abs(mixed.values - alone.values)[solved] <= (mixed.bounds + alone.bounds)[solved])
    for kind in (yeoh, ~yeoh):
        rows = np.repeat(kind, np.diff(first))
        again = walked(problems[kind], np.cumsum([0, *np.diff(first)[kind]]), pressures[rows])
        assert np.array_equal(again.values, mixed.values[rows], equal_nan=True)


def test_which_designs_share_a_vector_does_not_change_a_bit(sample, together):
    problems, first, pressures = sample
    mixed = np.random.default_rng(5).permutation(len(problems))[: len(problems) // 2 + 1]
    rows = np.concatenate([np.arange(first[k], first[k + 1]) for k in mixed])
    again = walked(problems[mixed], np.cumsum([0, *np.diff(first)[mixed]]), pressures[rows])
    for name in ("values", "bounds", "status", "slack"):
        assert np.array_equal(getattr(again, name), getattr(together, name)[rows], equal_nan=True), name
    assert np.array_equal(again.limits, together.limits[mixed], equal_nan=True)


def test_a_design_alone_in_its_vector_is_solved_like_any_other(sample, together):
    problems, first, pressures = sample
    for k in (0, 17):
        alone = walked(problems[k : k + 1], np.array([0, first[k + 1] - first[k]]), pressures[first[k] : first[k + 1]])
        assert np.array_equal(alone.values, together.values[first[k] : first[k + 1]], equal_nan=True)


def test_other_pressures_before_it_change_a_state_within_its_bounds():
    problems, _, _ = designs(40, 9, hard=False)
    many, few = np.linspace(0.05, 3, 30), np.linspace(0.05, 3, 30)[2::9]
    long = walked(problems, np.arange(41) * 30, np.tile(many, 40))
    short = walked(problems, np.arange(41) * len(few), np.tile(few, 40))
    apart, allowed = 0.0, 0.0
    for sign, walks, steps in ((1, long, slice(2, None, 9)), (-1, short, slice(None))):
        apart = apart + sign * walks.values.reshape(40, -1, 5)[:, steps]
        allowed = allowed + walks.bounds.reshape(40, -1, 5)[:, steps]
    both = np.isfinite(apart)
    assert both.mean() > 0.6
    assert np.all(np.abs(apart)[both] <= allowed[both])


def test_what_one_rule_leaves_vectors_solve_in_more_pieces(monkeypatch):
    """Locked states of the main design space whose ends stand upright: bits of their own, the numbers of meshes."""
    angles = [(60, 70), (62.5, 70), (65, 70), (65, 72.5), (67.5, 72.5), (70, 75), (75, 77.5), (75, 80), (80, 82.5)]
    sizes = [(105, 4.4), (190, 5.4), (400, 7), (80, 3), (265, 6.1), (140, 4.4), (80, 8), (80, 5.4), (105, 5.4)]
    angles, sizes = np.array([*angles, (80, 82.5)]), np.array([*sizes, (140, 7)]) * 1e-3
    nothing, radius = np.zeros(len(angles)), sizes[:, 1]
    problems = problem_rows(
        {"alpha": angles[:, 0], "beta": angles[:, 1], "length": sizes[:, 0], "radius": radius, "fiber_radius": radius,
         "wall": nothing + 1.59e-3, "c10": nothing + 0.17e6, "c01": nothing + 0.08e6, "fiber_extension": nothing + 1.0,
         "force": nothing, "torque": nothing},
        "full",
    )  # fmt: skip
    first, pressures = np.arange(len(problems) + 1), np.full(len(problems), np.inf)
    scalar = walked(problems, first, pressures, lanes=False)
    with monkeypatch.context() as patch:
        patch.setattr(batch, "PIECES", (1,))
        assert np.any(batch.walk_by_vectors(problems, first, pressures, 1e-7).status == PENDING)
    assert np.all(batch.walk_by_vectors(problems, first, pressures, 1e-7).status == OK)
    found = walked(problems, first, pressures)
    assert np.all(found.status == OK)
    assert np.all(np.abs(found.values - scalar.values) <= found.bounds + scalar.bounds)
    alone = walked(problems[3:4], first[:2], pressures[:1])
    assert np.array_equal(alone.values[0], found.values[3])
    assert np.array_equal(alone.bounds[0], found.bounds[3])


@pytest.mark.long  # they are compiled for this test alone
def test_narrow_vectors_give_the_same_numbers_to_rounding(tmp_path):
    """A machine without AVX-512: the same states, with bounds that differ by less than a bound."""
    program = (
        "import numpy as np, test_lanes; from freesweep.solver.lanes.vector import WIDTH; "
        "w = test_lanes.walked(*test_lanes.designs(20, 11)); "
        f"np.savez(r'{tmp_path / 'narrow.npz'}', width=WIDTH, values=w.values, status=w.status)"
    )
    narrow = dict(os.environ, NUMBA_CPU_NAME="generic", NUMBA_CPU_FEATURES="", XDG_CACHE_HOME=str(tmp_path))
    narrow["PYTHONPATH"] = os.pathsep.join(sys.path)
    subprocess.run([sys.executable, "-c", program], env=narrow, check=True, cwd=os.path.dirname(__file__))
    found, wide = np.load(tmp_path / "narrow.npz"), walked(*designs(20, 11))
    assert found["width"] == 4
    assert vector.WIDTH >= 4
    done = found["status"] != PENDING
    assert done.mean() > 0.8
    assert np.array_equal(found["status"][done], wide.status[done])
    solved = done & np.isin(wide.status, (OK, INACCURATE))
    assert np.all(np.abs(found["values"] - wide.values)[solved] <= wide.bounds[solved])


def test_profiles_end_where_outputs_do():
    """At the plane of symmetry: length, rotation and stretch of the half; at the end nothing has begun."""
    problems, first, pressures = designs(30, 41)
    for k in range(0, 30, 3):
        own = slice(first[k], first[k + 1])
        stations = np.array([0.0, 0.25, 0.5]) * problems[k, 8]
        found = batch.walk_all(
            problems[k : k + 1], first[k : k + 2] - first[k], pressures[own], batch.uniform(24), 1e-6, stations
        )
        for row in np.flatnonzero((found.status == OK) & (found.bounds[:, 0] > 0.0)):  # nothing is drawn at rest
            y, z, turn = found.profiles[row, :3]
            off = found.profiles[row, 7:10]
            assert (y[0], z[0], turn[0]) == pytest.approx((1.0, 0.0, 0.0), abs=1e-14)
            for column, value, bound in ((4, y, off[0]), (0, z, off[1]), (2, turn, off[2])):
                assert abs(value[-1] - found.values[row, column]) <= bound[-1] + found.bounds[row, column]

"""Held states found by vectors of designs: against the scalar kernels, the first integral, and each other."""

import numpy as np
import pytest

import freesweep as fs
from freesweep.first_integral import held as quadrature
from freesweep.first_integral.uniform import Tubes
from freesweep.solver import batch, hold_batch
from freesweep.solver.held.held_state import HELD_LENGTH, HELD_ROTATION
from freesweep.solver.hold_batch import hold_all
from freesweep.solver.problem import FORCE, LENGTH, TORQUE
from freesweep.solver.status import COMPRESSED, HELD_IMPOSSIBLE, OK, PENDING

KINDS = [HELD_LENGTH, HELD_ROTATION]
PRESSURES = 3


def designs(count, seed, yeoh=False):
    """Random problems of region II, what each holds on the way to its locked shape, and pressures of each."""
    draw = np.random.default_rng(seed)
    ta, tb = np.tan(np.radians([draw.uniform(10, 70, count), -draw.uniform(10, 70, count)]))
    gamma = np.where(draw.random(count) < 0.5, 1.0, draw.uniform(1.0, 1.02, count))
    wall, length = draw.uniform(0.1, 0.5, count), 10 ** draw.uniform(0.7, 1.7, count)
    H, D, zero = 0.5 * (ta + tb), 0.5 * (ta - tb), np.zeros(count)
    higher = draw.uniform(0, [[0.05], [0.01]], (2, count)) * yeoh
    problems = np.column_stack([H, D, wall * (2 + wall), gamma, draw.uniform(0, 1, count) * (not yeoh),
                                draw.integers(2, size=count), zero, zero, length, *higher])  # fmt: skip
    A = gamma**2 * (1 + H**2 + D**2)
    locked = (A + np.sqrt(A**2 - 3 * (gamma**2 * D * H) ** 2)) / (3 * D**2)
    y2 = 1 + draw.uniform(0, 0.6, count) * (locked - 1)
    straight = draw.random(count) < 0.3
    lengths = length * np.where(straight, 1, np.sqrt(A - D**2 * y2 - gamma**4 * H**2 / y2))
    rotations = length * np.where(straight, 0, H * (gamma**2 / y2 - 1))
    pressures = np.sort(10 ** draw.uniform(-1.3, 0.5, (count, PRESSURES)), axis=1)
    return problems, {HELD_LENGTH: lengths, HELD_ROTATION: rotations}, pressures


def held(problems, targets, kind, pressures, **options):
    first = np.arange(len(problems) + 1) * pressures.shape[1]
    return hold_all(problems, targets[kind], kind, first, pressures.ravel(), batch.uniform(24), 1e-6, **options)


@pytest.fixture(scope="module")
def sample():
    return designs(80, 5)


def agree(one, other):
    assert np.array_equal(one.status, other.status)
    assert np.array_equal(one.stable, other.stable)
    valued = one.status == OK
    assert np.all(np.abs(one.loads - other.loads)[valued] <= (one.load_bounds + other.load_bounds)[valued])
    assert np.all(np.isnan(one.loads[~valued]))


@pytest.mark.parametrize("kind", KINDS)
def test_vectors_agree_with_the_scalar_kernels_within_the_bounds(sample, kind, monkeypatch):
    problems, targets, pressures = sample
    left = []
    scalar = hold_batch.hold_many
    monkeypatch.setattr(
        hold_batch, "hold_many", lambda *a: (left.append(np.sum(a[hold_batch.STATUS] == PENDING)), scalar(*a))
    )
    together = held(problems, targets, kind, pressures)
    assert sum(left) < 0.2 * len(together.status)
    agree(together, held(problems, targets, kind, pressures, lanes=False))


def test_vectors_of_yeoh_rubbers_agree_with_the_scalar_kernels():
    few = designs(12, 8, yeoh=True)
    agree(held(few[0], few[1], HELD_LENGTH, few[2]), held(few[0], few[1], HELD_LENGTH, few[2], lanes=False))


@pytest.mark.parametrize("kind", KINDS)
def test_bounds_hold_against_the_first_integral(sample, kind):
    problems, targets, pressures = sample
    found = held(problems, targets, kind, pressures)
    rows = np.flatnonzero(found.status == OK)
    own = rows // PRESSURES
    loads = problems[own, FORCE : TORQUE + 1].T.copy()
    loads[kind] = found.loads[rows]
    zero = np.zeros(len(rows))
    tubes = Tubes(
        *problems[own, :FORCE].T, pressures.ravel()[rows], *loads, zero + 1.0, 0.5 * problems[own, LENGTH], zero, zero
    )
    exact, unsure = quadrature.blocked(tubes, kind, targets[kind][own], found.loads[rows])
    judged = np.isfinite(exact) & np.isfinite(unsure)
    assert judged.mean() > 0.9
    assert np.all(np.abs(found.loads[rows] - exact)[judged] <= (found.load_bounds[rows] + unsure)[judged])


@pytest.mark.parametrize("kind", KINDS)
def test_numbers_do_not_depend_on_which_designs_share_a_vector(sample, kind):
    problems, targets, pressures = sample
    together = held(problems, targets, kind, pressures)
    order = np.random.default_rng(1).permutation(len(problems))[:37]
    mixed = held(problems[order], {kind: targets[kind][order]}, kind, pressures[order])
    for one, other in zip(together[:4], mixed[:4]):  # the source's tubes have no numbers behind them
        assert np.array_equal(one.reshape(-1, PRESSURES)[order].ravel(), other, equal_nan=True)


def test_no_force_holds_a_length_shorter_than_where_the_wall_is_no_longer_pulled(sample):
    """At p + f = 0 the free tube is still longer: a shorter one would have to be pushed."""
    problems, targets, pressures = sample
    found = held(problems, targets, HELD_LENGTH, pressures)
    rows = np.flatnonzero(found.status == COMPRESSED)
    own, p = rows // PRESSURES, pressures.ravel()[rows]
    slack = problems[own]
    slack[:, FORCE] = -0.99 * p
    free = batch.walk_all(slack, np.arange(len(rows) + 1), p, batch.uniform(24), 1e-6)
    solved = free.status == OK
    assert solved.sum() > 20
    assert np.all(2.0 * free.values[solved, 0] > targets[HELD_LENGTH][own[solved]])


def test_no_force_makes_a_tube_longer_than_its_fibers_allow(sample):
    problems, _, pressures = sample
    extended, apart = problems[:, 3], np.abs(problems[:, 0]) - np.abs(problems[:, 1])
    targets = {HELD_LENGTH: 1.000001 * problems[:, LENGTH] * extended * np.hypot(1.0, apart)}
    for lanes in (True, False):
        assert np.all(held(problems, targets, HELD_LENGTH, pressures, lanes=lanes).status == HELD_IMPOSSIBLE)


@pytest.mark.parametrize("kind", KINDS)
def test_a_cylinder_that_is_not_extended_is_held_by_the_closed_form(kind):
    problems, _, pressures = designs(40, 9)
    problems[:, 3] = 1.0
    natural = {HELD_LENGTH: problems[:, LENGTH].copy(), HELD_ROTATION: np.zeros(40)}
    found = held(problems, natural, kind, pressures)
    ta, tb = problems[:, 0] + problems[:, 1], problems[:, 0] - problems[:, 1]
    ideal = -(1 + 2 / (ta * tb)) if kind == HELD_LENGTH else (2 + ta * tb) / (ta + tb)  # Eqs. 2.16, 2.19
    expected = (pressures * ideal[:, None]).ravel()
    assert np.all(found.status == OK)
    assert np.all(np.abs(found.loads - expected) <= found.load_bounds)


def test_a_force_stroke_curve_of_many_states_refuses_what_few_states_refuse():
    """What is solved together has the status of what is solved alone."""
    rubber = fs.MooneyRivlin(0.11e6, 0.06e6)
    muscle = fs.Actuator(
        alpha=30, beta=-30, length=0.1, radius=5e-3, wall=1.5e-3, material=rubber, fiber_extension=1.004
    )
    lengths, pressures = 0.1 * np.linspace(0.8, 1.2, 21), np.array([1e4, 5e4, 2e5])
    few = [fs.blocked_force(muscle, p, lengths, x=0.0)["status"].values for p in pressures]
    many = fs.blocked_force(muscle, pressures, lengths, [-0.01, 0.0, 0.01, 0.02], x=0.0)
    assert np.array_equal(many["status"].sel(torque=0.0), np.array(few).T)
    assert {OK, HELD_IMPOSSIBLE} <= {*np.unique(few)}

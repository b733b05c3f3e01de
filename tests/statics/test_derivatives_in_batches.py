"""Derivatives of batches of random states by all numbers of a problem, against differences of whole batches: `-m long`.

As in the campaign of single states a difference counts by what its two last extrapolations, the states' own bounds and a
slope that jumps within its step leave open. Columns are those of :mod:`freesweep.solver.problem`, the pressure behind them.
"""

import numpy as np
import pytest

from freesweep.bench.models import as_model
from freesweep.solver.batch import walk_by_vectors
from freesweep.solver.physics.wall import BONDED, LOOSE, NONE, ONE_LOOSE
from freesweep.solver.problem import FORCE, GAMMA, INNER, LENGTH, RATIO, SECOND, SHEAR, THIRD, TORQUE, D, H
from freesweep.solver.slopes import OUTPUTS, differentiate

KINDS = (
    "source", "source loads", "source yeoh loads", "physical", "physical loads", "physical yeoh loads",
    "physical single loads", "physical balloon loads", "membrane loose loads", "membrane loose single loads",
    "membrane bonded loads", "thick bonded loads",
)  # fmt: skip
COUNT, ACCURACY, STEP, SCALES, PARTS = 150, 1e-10, 1.2e-3, (1.0, 0.1, 0.01), (0.25, 0.5, 1.0)
OF_LAYERS = 4  # numbers that any tube has
OF_BOUNDS, OF_CORNERS, CLOSE, TELLING = 6.0, 40.0, 1e-6, 1e-5  # as in the campaign of single states


def sample(kind, rng):
    """``(problems, pressures)``: random tubes (COUNT, columns), each at a P/C10."""
    n, yeoh, loaded = COUNT, "yeoh" in kind, "loads" in kind
    alpha, beta = rng.uniform(0.0, 85.0, n), rng.uniform(-85.0, 85.0, n)
    beta = np.where(np.abs(alpha - beta) < 3.0, -beta - 5.0, beta)
    t_a, t_b, wall, one = np.tan(np.radians(alpha)), np.tan(np.radians(beta)), rng.uniform(0.05, 0.4, n), np.ones(n)
    pressures = 10.0 ** rng.uniform(-1.5, 0.3, n)
    gamma = np.where(rng.uniform(size=n) < 0.3, rng.uniform(1.0, 1.03, n), 1.0)
    force, torque = (pressures * loaded * rng.uniform(-0.3, most, n) for most in (0.8, 0.3))
    second, third = rng.uniform(0.02, 0.3, n) * yeoh, rng.uniform(0.001, 0.02, n) * yeoh
    ratio = rng.uniform(0.1, 1.0, n) * (not yeoh)
    problems = np.column_stack(
        [0.5 * (t_a + t_b), 0.5 * (t_a - t_b), wall * (2.0 + wall), gamma, ratio, one, force, torque,
         rng.uniform(5.0, 60.0, n), second, third]
    )  # fmt: skip
    if kind.startswith("source"):
        return problems, pressures
    words = {"single": ONE_LOOSE, "balloon": NONE, "bonded": BONDED}
    threads = next((threads for word, threads in words.items() if word in kind), LOOSE)
    problems = as_model(problems, not kind.startswith("membrane"), threads)
    if threads in (ONE_LOOSE, NONE):
        problems[:, H], problems[:, D] = t_a * (threads == ONE_LOOSE), 0.0
    return problems, pressures


def columns_of(kind, problems):
    """Columns by which states of a kind may be differentiated, the pressure behind them."""
    without = {SHEAR} | ({RATIO} if "yeoh" in kind else {SECOND, THIRD})
    without |= {H, D} if "balloon" in kind else {D} if "single" in kind else set()
    own = [k for k in range(LENGTH + 3) if k not in without]
    thick = kind.startswith(("physical", "thick"))
    return [*own, *([INNER] if thick else []), problems.shape[1]]


def sizes_of(column, problems, pressures):
    """What a step is a part of, (n,)."""
    if column in (FORCE, TORQUE, problems.shape[1]):
        return pressures
    return np.abs(problems[:, column]) + {H: 1.0, D: 0.1, RATIO: 0.1, SECOND: 0.01, THIRD: 0.01, INNER: 0.1}.get(
        column, 0.0
    )


def solved(problems, pressures):
    """Values and bounds (n, outputs and what :mod:`freesweep.solver.along.places` tells), NaN where vectors have none; and
    where a family goes slack along a part. A membrane's surfaces are not those of its one layer.
    """
    found = walk_by_vectors(problems, np.arange(len(pressures) + 1), pressures, ACCURACY)
    there, shares = (found.status == 0)[:, None], found.values[:, OUTPUTS : OUTPUTS + 2]
    most = found.values.shape[1] if problems.shape[1] > INNER and problems[0, INNER] > 0.0 else OUTPUTS + OF_LAYERS
    own = (np.where(there, array[:, :most], np.nan) for array in (found.values, found.bounds))
    return *own, np.any((shares > 0.0) & (shares < 1.0), axis=1)


def difference(column, problems, pressures, here, bounds):
    """Differences along a column (n, outputs), and by how much they may err."""
    best, doubt, size = np.full(here.shape, np.nan), np.full(here.shape, np.inf), sizes_of(column, problems, pressures)
    for scale in SCALES:
        h, found, worst = STEP * scale * size * (0.3 if column == GAMMA else 1.0), {}, bounds
        for part in (*PARTS, *(-part for part in PARTS)):
            rows = np.column_stack([problems, pressures])
            rows[:, column] += part * h
            found[part], missed, _ = solved(np.ascontiguousarray(rows[:, :-1]), rows[:, -1].copy())
            worst = np.fmax(worst, missed)
        h = h[:, None]
        slopes = [(found[part] - found[-part]) / (2.0 * part * h) for part in PARTS]
        near, far = ((4.0 * one - other) / 3.0 for one, other in (slopes[:2], slopes[1:]))
        bends = [(found[part] - 2.0 * here + found[-part]) / (part * h) for part in PARTS[:2]]
        corner = 2.0 * np.maximum(np.abs(2.0 * bends[0] - bends[1]) - OF_CORNERS * worst / h, 0.0)
        error = np.abs(near - far) + corner + OF_BOUNDS * worst / h
        better = np.isfinite(near) & (error < doubt)
        best, doubt = np.where(better, near, best), np.where(better, error, doubt)
    return best, doubt, 1e-3 * np.abs(here) / size[:, None]


@pytest.mark.parametrize("kind", [kind for kind in KINDS if "single" in kind])
def test_vectors_know_where_a_single_loose_family_goes_slack(kind):
    """The one that is not there lacks endlessly much of being taut, and counts for nothing."""
    problems, pressures = sample(kind, np.random.default_rng(77))
    values, _, limp = solved(problems, pressures)
    there = np.isfinite(values[:, 0])
    assert np.count_nonzero(limp & there) > 30
    problems, pressures, limp = problems[there], pressures[there], limp[there]
    middles, none = (
        np.ascontiguousarray(values[there, OUTPUTS - 1]),
        np.zeros((len(problems), 1, problems.shape[1] + 1)),
    )
    found, _ = differentiate(problems, pressures, none, 1e-7, middles, limp)
    assert np.all(np.isfinite(found[:, 0, :OUTPUTS]))


@pytest.mark.parametrize("kind", ["physical loads", "physical single loads"])
def test_a_derivative_does_not_hang_on_who_shares_its_vector(kind):
    problems, pressures = sample(kind, np.random.default_rng(5))
    values, _, limp = solved(problems, pressures)
    there = np.isfinite(values[:, 0])
    problems, pressures, limp = problems[there], pressures[there], limp[there]
    middles, columns = np.ascontiguousarray(values[there, OUTPUTS - 1]), columns_of(kind, problems)
    changes = np.zeros((len(problems), len(columns), problems.shape[1] + 1))
    changes[:, np.arange(len(columns)), columns] = 1.0
    together = differentiate(problems, pressures, changes, 1e-7, middles, limp)
    for part in np.array_split(np.random.default_rng(1).permutation(len(problems)), len(problems) // 15 + 1):
        few = differentiate(problems[part], pressures[part], changes[part], 1e-7, middles[part], limp[part])
        for one, all_of_them in zip(few, together):
            assert np.array_equal(one, all_of_them[part], equal_nan=True)


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_of_batches_are_what_differences_tell(kind):
    problems, pressures = sample(kind, np.random.default_rng(77))
    there = np.isfinite(solved(problems, pressures)[0][:, 0])
    problems, pressures = problems[there], pressures[there]
    here, near, limp = solved(problems, pressures)
    columns = columns_of(kind, problems)
    changes = np.zeros((len(problems), len(columns), problems.shape[1] + 1))
    changes[:, np.arange(len(columns)), columns] = 1.0
    middles = np.ascontiguousarray(here[:, OUTPUTS - 1])
    values, bounds = differentiate(problems, pressures, changes, 1e-7, middles, limp)
    assert np.mean(np.isfinite(values[:, 0, 0])) > 0.98
    there = np.isfinite(values[:, 0, 0])
    assert np.mean(np.isfinite(values[there][:, :, : here.shape[1]])) > 0.98
    compared = telling = 0
    for k, column in enumerate(columns):
        told, doubt, least = difference(column, problems, pressures, here, near)
        exact, bound = (array[:, 1 + k, : told.shape[1]] for array in (values, bounds))
        judged = np.isfinite(told) & np.isfinite(exact)
        compared += np.sum(judged[:, :OUTPUTS])
        telling += np.sum((judged & (doubt <= TELLING * np.maximum(np.abs(told), least)))[:, :OUTPUTS])
        wrong = judged & ~(np.abs(exact - told) <= np.maximum(CLOSE * np.abs(exact), bound) + doubt)
        assert not np.any(wrong), (column, np.argwhere(wrong))
    print(f"{kind}: {len(problems)} states, {compared} compared, {compared - telling} of them say nothing")
    assert telling > 0.4 * compared

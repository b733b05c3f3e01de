"""Vectors of tubes with thick walls and loose fibers against the scalar kernels, the source's membrane, and finer rules."""

import numpy as np
import pytest
from test_lanes import designs, walked

from freesweep.solver import batch
from freesweep.solver.status import INACCURATE, OK, PENDING

PARTS = {"thick": (True, False), "loose": (False, True), "both": (True, True)}


def tubes(problems, thick, loose, seed=0):
    """The ``problems`` as physical ones, whose fibers lie at the inner, middle or outer radius."""
    draw = np.random.default_rng(seed)
    wall, place = draw.uniform(0.05, 0.6, len(problems)), draw.integers(3, size=len(problems))
    square = (1 + 0.5 * place * wall) ** 2
    rows = np.column_stack([problems, thick / square, np.full(len(problems), float(loose))])
    rows[:, 2], rows[:, 5] = ((1 + wall) ** 2 - 1) / square, 1.0
    return rows


@pytest.fixture
def only_vectors(monkeypatch):
    """What vectors leave stays PENDING."""
    monkeypatch.setattr(batch, "follow_many", lambda *arguments: None)


@pytest.mark.parametrize("part", PARTS)
def test_vectors_agree_with_the_scalar_kernels_within_the_bounds(part, monkeypatch):
    problems, first, pressures = designs(8, 23)
    problems = tubes(problems, *PARTS[part])
    with monkeypatch.context() as patch:
        patch.setattr(batch, "follow_many", lambda *arguments: None)
        found = walked(problems, first, pressures)
    done = found.status != PENDING
    assert done.mean() > 0.85
    asked = np.flatnonzero(done & (found.status == OK))[::5]
    owners = np.repeat(np.arange(len(problems)), np.diff(first))[asked]
    alone = walked(problems[owners], np.arange(len(asked) + 1), pressures[asked], lanes=False)
    assert np.all(np.isin(alone.status, (OK, INACCURATE)))
    assert np.array_equal(found.slack[asked], alone.slack)
    assert np.all(np.abs(found.values[asked] - alone.values) <= found.bounds[asked] + alone.bounds)


@pytest.mark.parametrize("part", PARTS)
def test_bounds_hold_against_finer_rules(part, only_vectors, monkeypatch):
    problems, first, pressures = designs(150, 31)
    problems = tubes(problems, *PARTS[part])
    found = walked(problems, first, pressures)
    monkeypatch.setattr(batch, "PIECES", (8,))
    exact = walked(problems, first, pressures)
    both = (found.status == OK) & (exact.status == OK)
    assert both.mean() > 0.8
    missed = np.abs(found.values - exact.values)[both] > (found.bounds + exact.bounds)[both]
    assert missed.any(axis=1).mean() < 0.003
    assert np.median(found.bounds[both][:, :5], axis=0).max() < 1e-7


def test_a_wall_without_thickness_and_bonded_fibers_are_the_source_s_tube(only_vectors):
    problems, first, pressures = designs(60, 3)
    problems[:, 5] = 1.0
    source = walked(problems, first, pressures)
    found = walked(np.column_stack([problems, np.zeros((60, 2))]), first, pressures)
    solved = found.status == OK
    assert np.mean(found.status == source.status) > 0.99
    assert np.array_equal(found.slack[solved], source.slack[solved])
    same = np.s_[:, : batch.OUTPUTS]
    assert np.all(np.abs(found.values[same] - source.values)[solved] <= (found.bounds[same] + source.bounds)[solved])


@pytest.mark.parametrize("part", PARTS)
def test_which_tubes_share_a_vector_does_not_change_a_bit(part, only_vectors):
    """Walls of other thickness, which ask for other numbers of layers, fibers of the other kind."""
    problems, first, pressures = designs(40, 5)
    problems = np.where(
        (np.arange(40) % 3 == 0)[:, None], tubes(problems, True, False, 1), tubes(problems, *PARTS[part])
    )
    together = walked(problems, first, pressures)
    assert np.mean(together.status == OK) > 0.4
    mixed = np.random.default_rng(5).permutation(40)[:15]
    rows = np.concatenate([np.arange(first[k], first[k + 1]) for k in mixed])
    again = walked(problems[mixed], np.cumsum([0, *np.diff(first)[mixed]]), pressures[rows])
    for name in ("values", "bounds", "status", "slack"):
        assert np.array_equal(getattr(again, name), getattr(together, name)[rows], equal_nan=True), name

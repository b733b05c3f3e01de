"""Branches in two numbers, of made-up states whose branches are known."""

from itertools import pairwise
from math import hypot

import numpy as np
import pytest

from freesweep.solver.by_middle.question import Answer, Told
from freesweep.solver.by_middle.states import middle_at, state_at, turning_point
from freesweep.solver.by_middle.steps import ARRIVED, LOST, TURNED, Point, advance, begin, follow

RISE, TOP = 1.2, 0.36  # the hill's


def hill(middle):
    """The share of the way at a stretch in the middle: it turns at 1.6."""
    strain = middle - 1.0
    return strain * (RISE - strain)


def answered(steps, missing):
    """What ``steps`` return where ``missing(middle, share)`` is the miss times the strain, and how often they asked."""
    answer, count = None, 0
    while True:
        try:
            question = steps.send(answer)
        except StopIteration as end:
            return end.value, count
        count += 1
        miss = missing(question.middle, question.share) / (question.middle - 1.0)
        values, one = np.array([[question.middle]]), np.ones((1, 1))
        answer = Answer(miss, 0.0, question.fineness, Told(values, 1e-15 * values, one, 0.0 * one, [0]), 0)


def branch(missing, far=1.0):
    """``(what became of it, its last points, all its points)`` of a branch from rest, and the questions that it took."""
    seen = []

    def note(here, there):
        seen.append(there)
        yield from ()

    start, _ = answered(begin(), missing)
    (what, points), count = answered(follow(start, 1.0, far, note), missing)
    return what, points, seen, count


def over_the_hill(middle, share):
    return share - hill(middle)


def test_branch_is_followed_to_its_turning_point():
    what, points, seen, _ = branch(over_the_hill)
    assert what == TURNED
    assert all(abs(point.share - hill(point.middle)) < 1e-4 for point in seen)
    (share, bound, point), _ = answered(turning_point(points, 1.0), over_the_hill)
    assert abs(share - TOP) <= bound < 1e-6
    assert point.middle == pytest.approx(1.6, abs=1e-3)


def test_state_between_two_points_is_met_to_rounding():
    _, _, seen, _ = branch(over_the_hill)
    near, far = next(pair for pair in pairwise(seen) if pair[0].share < 0.2 <= pair[1].share)
    exact = 1.0 + 0.5 * (RISE - np.sqrt(RISE**2 - 0.8))
    (told, bounds, _), _ = answered(state_at(0.2, near, far, 1e-9), over_the_hill)
    assert abs(told.values[0] - exact) <= bounds[0] + 1e-14 < 1e-9
    assert answered(middle_at(0.2, near, far), over_the_hill)[0] == pytest.approx(exact, abs=1e-9)


def test_jump_of_the_miss_is_no_state():
    """The sign changes, and nowhere is the miss none: of such a number no state is told."""
    near, far = (Point(middle, share, 0.5, 0.1, 0.0, 1.0) for middle, share in ((1.1, 0.1), (1.3, 0.3)))
    state, _ = answered(state_at(0.2, near, far, 1e-6), lambda middle, share: 1.0 if middle < 1.2 + 1e-3 else -1.0)
    assert state is None


def test_smooth_branch_takes_few_questions():
    what, _, seen, count = branch(lambda middle, share: share - 2.0 * (middle - 1.0))
    assert what == ARRIVED
    assert count < 6 * len(seen)  # two of them beside its middle


@pytest.mark.parametrize("gap", [0.02, 2e-3])
def test_no_step_lands_on_the_branch_beside(gap):
    """Another branch keeps a little above the first one, all along: its signs are the other way round."""

    def missing(middle, share):
        return (share - hill(middle)) * (hill(middle) + gap - share)

    what, _, seen, _ = branch(missing)
    assert what == TURNED
    assert len(seen) > 10
    assert all(abs(point.share - hill(point.middle)) < 0.3 * gap for point in seen)


@pytest.mark.parametrize("fall", [-5.0, -500.0])
def test_needle_of_a_fold_is_turned_round(fall):
    """The branch rises to a corner and comes back beside itself."""

    def needle(middle, share):
        strain = middle - 1.0
        return share - min(1.1 * strain, 0.33 + fall * (strain - 0.3))

    what, points, _, _ = branch(needle)
    assert what == TURNED
    (share, bound, _), _ = answered(turning_point(points, 1.0), needle)
    assert abs(share - 0.33) <= bound < 5e-3


def test_corner_is_no_turning_point():
    def missing(middle, share):
        strain = middle - 1.0
        return share - max(0.2 * strain, 0.02 + 5.0 * (strain - 0.1))

    what, points, seen, _ = branch(missing)
    assert what == ARRIVED
    assert points[-1].middle == pytest.approx(1.1 + 0.98 / 5.0, abs=0.02)
    assert min(abs(point.middle - 1.1) for point in seen) < 2e-3


def test_branch_goes_through_the_stretch_of_its_ends():
    """The middle narrows again, to less than the ends: the miss has a pole there, its product with the strain has none."""

    def missing(middle, share):
        return middle - 1.0 - share * (0.5 - share) if middle != 1.0 else 0.0

    seen = branch(lambda middle, share: -missing(middle, share), far=0.9)[2]
    assert seen[-1].share >= 0.9
    assert seen[-1].middle < 0.8
    assert all(abs(point.middle - 1.0 - point.share * (0.5 - point.share)) < 1e-4 for point in seen)


def test_what_is_no_tube_ends_a_branch():
    what, points, _, _ = branch(lambda middle, share: np.nan if middle > 1.3 else over_the_hill(middle, share))
    assert what == LOST
    assert 1.29 < points[-1].middle <= 1.3


def test_steps_grow_where_the_branch_is_straight():
    start, _ = answered(begin(), lambda middle, share: share - 2.0 * (middle - 1.0))
    (_, there, longer), _ = answered(advance(start, 0.01), lambda middle, share: share - 2.0 * (middle - 1.0))
    assert hypot(np.log(there.middle / start.middle), there.share - start.share) == pytest.approx(0.01, rel=1e-6)
    assert longer == 0.02

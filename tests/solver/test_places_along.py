"""What a tube is like along its length: where a pull ends between two places, and how wide the tube gets."""

import numpy as np
import pytest

from freesweep.solver.along import places
from freesweep.solver.along.slack import summed
from freesweep.solver.load import Load

LOAD = Load(1.0, (0.0,), (1.0, 0.5, 1.0), 1.0, 0.0, 0.0, 1.0)  # of pressure 1 and loose fibers
BONDED = Load(*LOAD[:2], (1.0, 0.5, 0.0), *LOAD[3:])


def seen(x, alpha, beta, squares):
    return np.array([x, alpha, beta, squares])


@pytest.mark.parametrize(("load", "pushes"), [(LOAD, False), (BONDED, True)])
def test_a_pull_that_falls_linearly_ends_where_it_is_zero(load, pushes):
    x = np.linspace(0.0, 2.0, 21)
    alpha, beta = 0.73 - x, x - 1.26  # slack at the far end, and at the near one
    if not pushes:  # of a slack family nothing is told but that it is
        alpha, beta = (np.where(one > 0.0, one, -1e-300) for one in (alpha, beta))
    found = summed(seen(x, alpha, beta, 1.0 + 0.0 * x), len(x), load)
    assert found[0] == pytest.approx((2.0 - 0.73) / 2.0, abs=1e-12)
    assert found[2] == pytest.approx(1.26 / 2.0, abs=1e-12)
    assert (found[1], found[3]) == pytest.approx((places.DOUBT * 0.1 / 2.0,) * 2)


def test_all_slack_and_all_taut_are_told_without_doubt_and_faint_pulls_with_all_of_it():
    x = np.linspace(0.0, 1.0, 11)
    alpha, beta = -1e-300 + 0.0 * x, 1.0 + 0.0 * x
    assert summed(seen(x, alpha, beta, 1.0 + 0.0 * x), len(x), LOAD)[:4] == pytest.approx((1.0, 0.0, 0.0, 0.0))
    faint = 0.1 * places.FAINT + 0.0 * x
    assert summed(seen(x, faint, beta, 1.0 + 0.0 * x), len(x), LOAD)[:2] == pytest.approx((0.0, 1.0))


def test_one_place_with_a_pull_among_slack_ones_may_be_slack_up_to_it():
    x = np.linspace(0.0, 1.0, 11)
    alpha = np.where(np.arange(11) == 5, 1.0, -1e-300)
    share, doubt = summed(seen(x, alpha, 1.0 + 0.0 * x, 1.0 + 0.0 * x), len(x), LOAD)[:2]
    assert share == pytest.approx(0.8)
    assert doubt == pytest.approx(0.2)


def test_what_lies_above_the_widest_place_is_told():
    x = np.linspace(0.0, 1.0, 11)
    squares = 4.0 - (x - 0.53) ** 2
    most, missed = summed(seen(x, 1.0 + 0.0 * x, 1.0 + 0.0 * x, squares), len(x), LOAD)[4:]
    assert most < 4.0 <= most + missed
    at_end = summed(seen(x, 1.0 + 0.0 * x, 1.0 + 0.0 * x, 4.0 - x), len(x), LOAD)[4:]
    assert at_end == (4.0, 0.0)


def test_two_meshes_tell_the_bound():
    numbers, bounds = places.together((0.30, 0.01, 0.0, 0.0, 4.0004, 0.0), (0.32, 0.02, 0.0, 0.0, 4.0016, 0.0))
    assert numbers[:2] == (0.30, 0.0)
    assert bounds[:2] == pytest.approx((0.03, 0.0))
    assert abs(numbers[places.OUTER] - 2.0) < bounds[places.OUTER] < 4e-4  # errors that fall by four

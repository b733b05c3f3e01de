"""What a tube is like along its length: where a pull ends between two places, and how wide the tube gets."""

import numpy as np
import pytest

from freesweep.solver.along import places
from freesweep.solver.along.slack import at_peaks, doubts, look_along, peaks, without_pulls
from freesweep.solver.load import Load, by
from freesweep.solver.numerics import finest
from freesweep.solver.numerics.properties_along import Tube

LOAD = Load(1.0, (0.0,), (1.0, 0.5, 1.0), 1.0, 0.0, 0.0, 1.0)  # of pressure 1 and loose fibers
BONDED = Load(*LOAD[:2], (1.0, 0.5, 0.0), *LOAD[3:])


def seen(x, alpha, beta, squares):
    """What is seen where the pulls are the multipliers, and the wall is stretched as it is wide."""
    return np.array([x, alpha, beta, -alpha, -beta, squares, squares])


def told(rows, load):
    """What is told of one segment, of whose places the first and the last are its ends: shares and their doubts, then what
    is largest of pulls, their sign turned, and of squares, and by how much each may be missed.
    """
    n = rows.shape[1] - 2
    found = peaks(rows, n, n, np.array([0, n]), tuple(np.maximum(rows[3:, 0], rows[3:, -1])), load)
    return without_pulls(rows, n, load), *zip([one[0] for one in found], doubts(found))


@pytest.mark.parametrize(("load", "pushes"), [(LOAD, False), (BONDED, True)])
def test_a_pull_that_falls_linearly_ends_where_it_is_zero(load, pushes):
    x = np.linspace(0.0, 2.0, 21)
    alpha, beta = 0.73 - x, x - 1.26  # slack at the far end, and at the near one
    if not pushes:  # of a slack family nothing is told but that it is
        alpha, beta = (np.where(one > 0.0, one, -1e-300) for one in (alpha, beta))
    found = told(seen(x, alpha, beta, 1.0 + 0.0 * x), load)[0]
    assert found[0] == pytest.approx((2.0 - 0.73) / 2.0, abs=1e-12)
    assert found[2] == pytest.approx(1.26 / 2.0, abs=1e-12)
    assert (found[1], found[3]) == pytest.approx((places.DOUBT * 0.1 / 2.0,) * 2)


def test_all_slack_and_all_taut_are_told_without_doubt_and_faint_pulls_with_all_of_it():
    x = np.linspace(0.0, 1.0, 11)
    alpha, beta = -1e-300 + 0.0 * x, 1.0 + 0.0 * x
    assert told(seen(x, alpha, beta, 1.0 + 0.0 * x), LOAD)[0] == pytest.approx((1.0, 0.0, 0.0, 0.0))
    faint = 0.1 * places.FAINT + 0.0 * x
    assert told(seen(x, faint, beta, 1.0 + 0.0 * x), LOAD)[0][:2] == pytest.approx((0.0, 1.0))


def test_one_place_with_a_pull_among_slack_ones_may_be_slack_up_to_it():
    x = np.linspace(0.0, 1.0, 11)
    alpha = np.where(np.arange(11) == 5, 1.0, -1e-300)
    share, doubt = told(seen(x, alpha, 1.0 + 0.0 * x, 1.0 + 0.0 * x), LOAD)[0][:2]
    assert share == pytest.approx(0.8)
    assert doubt == pytest.approx(0.2)


@pytest.mark.parametrize("bend", [1.0, 0.3])  # of cubics the parabola misses what is told
def test_a_smooth_curve_is_widest_between_its_places(bend):
    x = np.linspace(0.0, 1.0, 11)
    t = x - 0.53
    squares = 4.0 - t**2 + (1.0 - bend) * t**3
    for most, missed in told(seen(x, 1.0 + 0.0 * x, 1.0 + 0.0 * x, squares), LOAD)[3:]:
        assert abs(most - 4.0) < (1e-12 if bend == 1.0 else 1e-3)
        assert abs(most - 4.0) <= missed
    assert told(seen(x, 1.0 + 0.0 * x, 1.0 + 0.0 * x, 4.0 - x), LOAD)[3:] == ((4.0, 0.0), (4.0, 0.0))


@pytest.mark.parametrize("place", np.linspace(0.41, 0.59, 10))
@pytest.mark.parametrize("fall", [0.1, 1.0, 10.0])
def test_a_corner_between_two_places_is_within_what_is_told(place, fall):
    x = np.linspace(0.0, 1.0, 11)
    squares = 40.0 - np.where(x < place, place - x, fall * (x - place))
    most, missed = told(seen(x, 1.0 + 0.0 * x, 1.0 + 0.0 * x, squares), LOAD)[3]
    assert abs(most - 40.0) <= missed


@pytest.mark.parametrize("load", [LOAD, BONDED])
def test_a_smooth_pull_is_least_between_its_places(load):
    x = np.linspace(0.0, 1.0, 11)
    pull = 0.7 + (x - 0.53) ** 2
    _, (least, missed), other, _, _ = told(seen(x, pull, 1.0 + x, 1.0 + 0.0 * x), load)
    assert abs(least + 0.7) < 1e-12
    assert missed < 0.01
    assert other == (-1.0, 0.0)


def test_what_is_largest_beside_a_jump_is_not_doubted_by_the_jump():
    x, n = np.concatenate([[0.0], np.linspace(0.05, 0.95, 10), [1.0]]), 10
    squares = np.where(x < 0.5, 4.0 + x, 2.0 + x)  # 4.5 just before the middle
    rows = seen(x, 1.0 + 0.0 * x, 1.0 + 0.0 * x, squares)
    found = peaks(rows, n, n, np.array([0, 5, 10]), (-1.0, -1.0, 4.5, 4.5), LOAD)
    assert (found[2][0], doubts(found)[2]) == (4.5, 0.0)


def test_coarse_meshes_are_asked_where_the_fine_one_is_largest():
    """Where a tube is uniform far from its end, coarse cells overshoot beside its layer, by chance as high as fine ones."""
    edges, apart = np.array([0, 8]), (0.0, 0.0, 1.0, 1.0)

    def rows(n, wave):
        x = np.concatenate([[0.0], (np.arange(n) + 0.5) / n, [1.0]])
        plateau = 2.0 - (16.0 / n) ** 2 * 1e-3 - np.exp(-40.0 * x) + wave * np.exp(-(((x - 0.3) / 0.05) ** 2))
        return seen(x, 1.0 + 0.0 * x, 1.0 + 0.0 * x, plateau)

    found = peaks(rows(64, 0.0), 64, 8, edges, apart, LOAD)
    coarse = [at_peaks(rows(n, wave), n, 8, edges, apart, LOAD, found)[2] for n, wave in ((32, 2e-4), (16, 1e-3))]
    numbers, bounds = places.together(
        ((0.0,) * 4,) * 3,
        ((1.0, 1.0, found[2][0], 1.0), *((1.0, 1.0, one, 1.0) for one in coarse)),
        doubts(found),
        LOAD,
    )
    assert abs(numbers[places.OUTER] - np.sqrt(2.0)) < 1e-6 < bounds[places.OUTER]


def test_three_meshes_tell_the_bound():
    shares = (0.30, 0.01, 0.0, 0.0), (0.32, 0.02, 0.0, 0.0), (0.36, 0.04, 0.0, 0.0)
    one, two, three = (-0.7001, 0.0, 4.0004, 9.0006), (-0.7004, 0.0, 4.0016, 9.0024), (-0.7016, 0.0, 4.0064, 9.0096)
    numbers, bounds = places.together(shares, (one, two, three), (0.0,) * 4, LOAD)
    assert numbers[:2] == (0.30, 0.0)
    assert bounds[:2] == pytest.approx((0.01 + 1.5 * 0.02, 0.0))  # its doubt, and more than two meshes differ by
    exact = {places.LEAST_ALPHA: 0.7, places.OUTER: 2.0, places.STRETCH: 3.0}  # errors that fall by four
    for number in exact:
        assert abs(numbers[number] - exact[number]) < bounds[number] < 5e-4
    by_chance = places.together(shares, (one, (one[0], *two[1:]), three), (0.0,) * 4, LOAD)[1]  # alike on two meshes
    assert by_chance[places.LEAST_ALPHA] > 1e-4


@pytest.mark.parametrize("rho_square", [0.3, 0.7549958919736488, 0.9, 1.7])
def test_a_wall_that_is_not_stretched_has_the_stretch_1_to_all_digits(rho_square):
    assert places.principal_square(1.0, 0.0, 0.0, rho_square) == pytest.approx(1.0, abs=1e-15)


def test_each_mesh_is_looked_at_under_its_own_torque():
    """A straight cylinder, whose fibers pull as the torque asks for: meshes have it to second order, and so the pulls."""
    n, torque, off = 16, 0.3, 1e-3
    course = np.zeros((1, 1, 3, 4))
    course[0, 0, :, 0] = 0.4, 1.1, 0.5  # half the sum and difference of both tangents, the wall's section
    tube = Tube(course, np.array([0, n // 4]), course[0, :, :, 0], True, n // 4, np.array([0.0, 2.0]))
    load = Load(1.0, (0.0, 0.0, 0.0), (1.0, 0.6, 1.0), 2.0, 0.5, torque, 1.0)

    def seen(errors):
        """Numbers along, and bounds, where the torques of the three meshes have these errors."""
        fine, work, numbers, bounds = np.ones((5, 2 * n + 4)), np.zeros((13, n + 3)), np.zeros(6), np.zeros(6)
        for which in range(finest.MESHES):
            x, _ = finest.mesh_of(which, n // 2, fine)
            x[:] = np.linspace(0.0, 2.0, len(x))
        finest.leave_loads(torque + np.array(errors[::-1]), 2, torque, by(0.0, 0.0, 1.0), 0.0, fine)
        look_along(fine, n, n // 4, tube, load, work, numbers, bounds)
        return numbers[[places.LEAST_ALPHA, places.LEAST_BETA]], bounds[[places.LEAST_ALPHA, places.LEAST_BETA]]

    exact, _ = seen((0.0, 0.0, 0.0))
    pulls, bounds = seen((off, 4.0 * off, 16.0 * off))
    assert np.all(np.abs(pulls - exact) < 1e-12)
    assert np.all(bounds > off)

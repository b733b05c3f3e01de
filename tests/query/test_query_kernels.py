"""The kernels behind the query: cubics that reproduce cubics, the uniform tube, what the ends add, slack fibers."""

import numpy as np
import pytest

from freesweep import Actuator, MooneyRivlin, closed_form, inflate
from freesweep.query import reference, spline
from freesweep.query.axis import bent, make_axis
from freesweep.query.calibration import UNMEASURED
from freesweep.query.doubts import doubts_at
from freesweep.query.missing_nodes import fill
from freesweep.query.slack import UNKNOWN, slack_families
from freesweep.query.slopes import tabulate
from freesweep.query.uniform_tube import balance, energy, kinematics, squared_stretch

RUBBER = MooneyRivlin(0.17e6, 0.08e6)


def cubic_table(axes, function):
    """A table of a function of the axes' coordinates, with exact slopes along the last two."""
    grids = np.meshgrid(*(axis.nodes for axis in axes), indexing="ij")
    h = 1e-5
    *outer, r, p = grids
    columns = [
        function(*grids),
        (function(*outer, r, p + h) - function(*outer, r, p - h)) / (2 * h),
        (function(*outer, r + h, p) - function(*outer, r - h, p)) / (2 * h),
        (function(*outer, r + h, p + h) - function(*outer, r + h, p - h) - function(*outer, r - h, p + h)
         + function(*outer, r - h, p - h)) / (4 * h * h),
    ]  # fmt: skip
    return np.stack(columns, axis=-1).ravel()


def knots(axes):
    table = np.zeros((len(axes), max(len(axis.nodes) for axis in axes), spline.KNOT))
    for own, axis in zip(table, axes):
        count = len(axis.nodes)
        own[:count, spline.PLACE], own[: count - 1, spline.WIDTH] = axis.nodes, np.diff(axis.nodes)
        own[:count, spline.FIRST] = axis.first
        own[:count, spline.LEFT : spline.LEFT + 6], own[:count, spline.RIGHT : spline.RIGHT + 6] = axis.left, axis.right
    return table, np.array([axis.window for axis in axes]), np.zeros(len(axes), bool)


def test_tensor_cubics_reproduce_cubics_on_any_grid():
    axes = [make_axis("alpha", [0.0, 1.0, 1.5, 3.0, 4.0, 6.0, 7.0]), make_axis("beta", [-2.0, -1.0, 0.5, 1.0]),
            make_axis("force", [0.0, 0.3, 1.0, 1.2, 2.0]), make_axis("torque", [0.0, 1.0, 1.5, 2.5, 3.0])]  # fmt: skip

    def function(a, b, f, m):
        return 1.0 + a**3 - 2.0 * a * b**3 + f**3 * m - a * b * f * m**3 + m**2

    shape = np.array([len(axis.nodes) for axis in axes])
    strides = np.array([int(np.prod(shape[k + 1 :])) for k in range(4)])
    draw = np.random.default_rng(0)
    at = np.column_stack([draw.uniform(axis.nodes[0], axis.nodes[-1], 200) for axis in axes])
    pieces = np.column_stack([np.searchsorted(axis.nodes, at[:, k], side="right") - 1 for k, axis in enumerate(axes)])
    left = np.column_stack([axis.nodes[pieces[:, k]] for k, axis in enumerate(axes)])
    right = np.column_stack([axis.nodes[pieces[:, k] + 1] for k, axis in enumerate(axes)])
    shares = (at - left) / (right - left)
    table, found = cubic_table(axes, function), np.empty(200)
    args = (table, *knots(axes), strides, pieces, shares, np.arange(200))
    spline.interpolate(*args, np.zeros(4, np.int64), found)
    np.testing.assert_allclose(found, function(*at.T), rtol=1e-5, atol=1e-5)
    spline.interpolate(*args, np.array([1, 0, 0, 0]), found)
    a, b, f, m = at.T
    np.testing.assert_allclose(found, 3 * a**2 - 2 * b**3 - b * f * m**3, rtol=1e-4, atol=1e-4)
    spline.interpolate(*args, np.array([0, 0, 0, 1]), found)
    np.testing.assert_allclose(found, f**3 - 3 * a * b * f * m**2 + 2 * m, rtol=1e-4, atol=1e-4)


THREE = [
    make_axis("alpha", np.linspace(0.0, 7.0, 8)),
    make_axis("beta", np.linspace(-1.0, 1.0, 8)),
    make_axis("torque", [0.0, 0.4, 1.0, 1.5, 2.5, 3.0]),
]


def test_slopes_beside_the_numbers_are_exact_for_cubics_and_come_from_the_nodes_beside_where_one_lacks():
    a, b, m = np.meshgrid(*(axis.nodes for axis in THREE), indexing="ij")
    values = (1.0 + a) * (b**3 - m**3 + b * m**2)
    table, windows, _ = knots(THREE)
    shape, found = np.array(values.shape), np.empty(4 * values.size)
    tabulate(values.ravel(), table, windows, shape, found)
    own = found.reshape(*values.shape, 4)
    exact = values, (1.0 + a) * (2.0 * b * m - 3.0 * m**2), (1.0 + a) * (3.0 * b**2 + m**2), (1.0 + a) * 2.0 * m
    for k, array in enumerate(exact):
        np.testing.assert_allclose(own[..., k], array, rtol=1e-10, atol=1e-9)
    values[2, 0, 0] = np.nan
    tabulate(values.ravel(), table, windows, shape, found)
    assert own[2, 0, 1, 1] == pytest.approx((values[2, 0, 2] - values[2, 0, 1]) / 0.6)
    assert own[2, 1, 0, 2] == pytest.approx((values[2, 2, 0] - values[2, 1, 0]) / (2.0 / 7.0))
    np.testing.assert_array_equal(np.isnan(own[..., 1]).sum(), 1)  # at the hole itself
    np.testing.assert_allclose(own[3, ..., 1], exact[1][3], rtol=1e-10, atol=1e-9)


def test_what_is_doubtful_of_one_node_counts_as_much_as_the_node():
    shape = np.array([len(axis.nodes) for axis in THREE])
    strides = np.array([48, 6, 1])
    table, windows, labels = knots(THREE)
    pieces, shares = np.array([[3, 4, 2]]), np.array([[0.3, 0.6, 0.45]])
    cell = pieces @ strides
    for apart in ((0, 0, 0), (1, 0, 1), (2, 0, 0), (-1, 1, 0), (0, 2, 1), (1, 1, -2), (0, -3, 0), (2, 2, 0)):
        one, numbers = np.zeros(shape.prod()), np.empty(4 * shape.prod())
        one[cell + np.array(apart) @ strides] = 1.0
        tabulate(one, table, windows, shape, numbers)
        weight, doubt = np.empty(1), np.empty(1)
        place = (pieces, shares, np.array([0]))
        spline.interpolate(numbers, table, windows, labels, strides, *place, np.zeros(3, np.int64), weight)
        single = one.astype(np.float32)
        doubts_at(np.array([0]), cell, pieces, shares, single, strides, windows, table, doubt)
        if apart == (2, 2, 0):  # beyond the cell along two axes: little, and not counted
            assert 0.0 < abs(weight[0]) < 0.01
            assert doubt[0] == 0.0
        else:
            assert doubt[0] == pytest.approx(abs(weight[0]), rel=1e-6, abs=1e-12), apart
            assert (doubt[0] > 0.0) == (apart != (0, -3, 0))


def test_no_window_reaches_across_a_bend():
    plain = make_axis("beta", np.linspace(-10.0, 10.0, 21))
    axis = bent(plain, 0.0)
    assert axis.bend == 10
    assert (axis.first[:10] + axis.window <= 11).all()
    assert (axis.first[10:] >= 10).all()
    values = np.abs(axis.nodes) * (1.0 + 0.3 * axis.nodes**2)
    for own, worst in ((axis, 1e-12), (plain, 1.0)):
        windows = values[own.first[:20, None] + np.arange(6)]
        middle = 0.5 * (values[:-1] + values[1:]) + 0.125 * ((own.left - own.right)[:20] * windows).sum(axis=1)
        between = 0.5 * (own.nodes[:-1] + own.nodes[1:])
        gap = np.abs(middle - np.abs(between) * (1.0 + 0.3 * between**2)).max()
        assert gap < worst
    assert gap > 0.01
    assert bent(plain, 0.5) is plain
    assert bent(plain, 8.0) is plain  # too few nodes beyond


@pytest.mark.parametrize("count", [17, 33])
def test_slopes_are_of_fourth_order_and_the_remainder_is_about_the_error(count):
    nodes = np.linspace(0.0, 2.0, count)
    axis = make_axis("force", nodes)
    values = np.sin(3.0 * nodes)
    for i in range(2, count - 4):
        window = values[axis.first[i] : axis.first[i] + 6]
        width = nodes[1]
        assert abs(axis.left[i] @ window / width - 3.0 * np.cos(3.0 * nodes[i])) < 0.05 * (3.0 * width) ** 4 * 3.0
        middle = 0.5 * (values[i] + values[i + 1]) + 0.125 * (axis.left[i] - axis.right[i]) @ window
        error = np.sin(3.0 * (nodes[i] + 0.5 * width)) - middle
        scale = (3.0 * width) ** 4 / 384.0
        assert abs(axis.remainder[i] @ window - error) < 2.0 * scale


def test_holes_are_filled_by_the_polynomial_of_their_neighbours():
    x, y = np.arange(9.0), np.arange(8.0)
    values = x[:, None] ** 3 - 2.0 * y**2 + x[:, None] * y
    holed = values.copy()
    holed[4, 4] = holed[0, 0] = holed[5, 5] = np.nan
    flat = holed.ravel()
    nodes = np.zeros((2, 9))
    nodes[0], nodes[1, :8] = x, y
    fill(flat, np.array([9, 8]), np.array([8, 1]), nodes)
    np.testing.assert_allclose(flat.reshape(9, 8), values, atol=1e-9)


def test_a_number_put_beyond_the_last_nodes_says_how_doubtful_it_is():
    x = np.arange(8.0)
    values = np.exp(-0.7 * (x[:, None] + x))
    holed = values.copy()
    holed[0, 0] = holed[4, 4] = np.nan
    flat = holed.ravel()
    doubt = fill(flat, np.array([8, 8]), np.array([8, 1]), np.stack([x, x]))
    gap = np.abs(flat.reshape(8, 8) - values)
    doubt = doubt.reshape(8, 8)
    assert gap[0, 0] > 0.01  # the corner of a grid, from one side
    assert 0.3 * gap[0, 0] < doubt[0, 0] < 10.0 * gap[0, 0]
    assert gap[4, 4] < doubt[4, 4] < 1e-4
    assert np.count_nonzero(doubt) == 2


@pytest.mark.parametrize("shear", [0.0, 1.0])
def test_near_rest_bounds_hold_though_hardly_a_digit_is_left(shear):
    draw, count = np.random.default_rng(3), 200
    alpha, beta = draw.uniform(0, 85, count), draw.uniform(-85, 85, count)
    length, radius = draw.uniform(0.08, 0.4, count), draw.uniform(3e-3, 8e-3, count)
    found = {}
    for pressure in (1.0, 1e-3, 1e-4):
        points = np.array([point(*each, pressure) for each in zip(alpha, beta, length, radius)])
        states = np.empty((count, reference.UNIFORM))
        reference.uniform_states(reference.LOADED, points, shear, states)
        value, estimate, bound = np.empty((3, count))
        nothing = np.zeros(count)
        for variable in (reference.ROTATION, reference.ENERGY):
            reference.restore_all(variable, points, states, nothing, nothing, nothing, value, estimate, bound)
            found[variable, pressure] = value.copy(), estimate.copy()
    apart = np.abs(alpha - beta) > 2.0
    for (variable, pressure), (value, estimate) in found.items():
        order = 1 if variable == reference.ROTATION else 2  # of the pressure, of which it is a power so near rest
        expected = found[variable, 1.0][0] * pressure**order
        assert (estimate > 0.0).all()
        assert (
            np.abs(value - expected) <= estimate + found[variable, 1.0][1] * pressure**order + 1e-4 * np.abs(expected)
        )[apart].all()


PROBLEMS = [
    (0.3, 0.9, 0.7, 1.0, (0.5, 0.0, 0.0), 1.0, 0.0, 0.0),
    (1.2, 0.4, 0.4, 1.005, (0.5, 0.0, 0.0), 0.0, 0.2, -0.1),
    (0.0, 1.7, 1.3, 1.01, (0.0, 0.2, 0.03), 1.0, -0.05, 0.0),
    (0.4, 0.8, 0.5, 1.0, (0.0, -0.1, 0.02), 1.0, 0.1, 0.0),
]


@pytest.mark.parametrize("problem", PROBLEMS)
def test_the_uniform_balance_is_the_derivative_of_the_lagrangian(problem):
    h, d, area, gamma, rubber, shear, f, m = problem
    p, step = 0.8, 1e-5

    def density(q):
        state = kinematics(q, h, d, gamma)
        return (p * q + f) * np.sqrt(state[0]) - area * energy(q, state, rubber, shear)[0] + m * state[3]

    for q in (0.9, 1.05, 1.2):
        first, second = balance(q, problem, p)
        assert first == pytest.approx((density(q + step) - density(q - step)) / (2 * step), rel=1e-7, abs=1e-8)
        slope = (balance(q + step, problem, p)[0] - balance(q - step, problem, p)[0]) / (2 * step)
        assert second == pytest.approx(slope, rel=1e-6, abs=1e-7)
    q = squared_stretch(problem, p)
    assert abs(balance(q, problem, p)[0]) < 1e-12


def point(alpha, beta, length, radius, pressure):
    wall, c10, c01 = 1.59e-3, RUBBER.c10, RUBBER.c01
    return np.array([alpha, beta, length, radius, wall, radius, 1.0, c10, c01, 0.0, 0.0, pressure, 1.0, 0.0, 0.0])


@pytest.mark.parametrize(("alpha", "beta", "pressure"), [(30, -30, 1e5), (10, 50, 5e4), (75, -65, 2e5)])
def test_far_from_its_ends_a_long_tube_is_uniform(alpha, beta, pressure):
    here = point(alpha, beta, 0.6, 4e-3, pressure)[None]
    states = np.empty((1, reference.UNIFORM))
    reference.uniform_states(reference.LOADED, here, 1.0, states)
    tube = Actuator(alpha=alpha, beta=beta, length=0.6, radius=4e-3, wall=1.59e-3, material=RUBBER)
    solved = inflate(tube, pressure, x=0.0)
    assert 4e-3 * np.sqrt(states[0, 3]) == pytest.approx(solved["mid_radius"].item(), rel=1e-8)
    reference.uniform_states(reference.LOCKED, here, 1.0, states)
    assert np.sqrt(states[0, 3]) == pytest.approx(closed_form.locked_stretch(alpha, beta), rel=1e-13)


@pytest.mark.parametrize("variable", range(1, 8))
def test_end_effects_give_back_what_was_stored(variable):
    held = {reference.HOLDING_FORCE: reference.LENGTH_HELD, reference.HOLDING_TORQUE: reference.ROTATION_HELD}
    kind = held.get(variable, reference.LOADED)
    points = np.array([point(25.0, -40.0, 0.12, 5e-3, 5e4), point(20.0, 55.0, 0.1, 4e-3, 3e4)])
    points[:, reference.HELD] = 1.0 if kind == reference.LENGTH_HELD else 0.0
    points[:, reference.EXTENSION] = 1.002
    states = np.empty((2, reference.UNIFORM))
    reference.uniform_states(kind, points, 1.0, states)
    stored, nothing, out = np.empty(2), np.zeros(2), np.empty(2)
    reference.restore_all(variable, points, states, np.full(2, 0.3), nothing, nothing, stored, out, out)
    effects, noise = np.empty(2), np.empty(2)
    errors = 1e-9 * np.abs(stored)
    reference.end_effects(variable, kind, points, states, stored, errors, effects, noise)
    np.testing.assert_allclose(effects, 0.3, rtol=1e-6)
    values, estimates, bounds = np.empty((3, 2))
    args = (effects, np.full(2, 1e-3), noise, values, estimates, bounds)
    reference.restore_all(variable, points, states, *args)
    np.testing.assert_allclose(values, stored, rtol=1e-12)
    assert (bounds >= errors * (1 - 1e-9)).all()
    assert (estimates > 0.0).all()


def test_slack_fibers_follow_from_the_stretch_in_the_middle():
    draw = np.random.default_rng(2)
    count = 60
    columns = [draw.uniform(5, 70, count), draw.uniform(-70, 70, count), draw.uniform(0.08, 0.2, count),
               draw.uniform(3e-3, 8e-3, count), draw.uniform(5e3, 1.5e5, count)]  # fmt: skip
    points, middle, expected = [], [], []
    for alpha, beta, length, radius, pressure in zip(*columns):
        if abs(alpha - beta) > 3.0:
            tube = Actuator(alpha=alpha, beta=beta, length=length, radius=radius, wall=1.59e-3, material=RUBBER)
            solved = inflate(tube, pressure, x=0.0)
            points.append(point(alpha, beta, length, radius, pressure))
            middle.append(solved["mid_radius"].item())
            expected.append(solved["slack_fiber"].item())
    points, expected = np.array(points), np.array(expected)
    states, found = np.empty((len(points), reference.UNIFORM)), np.empty(len(points), np.uint8)
    reference.uniform_states(reference.LOADED, points, 1.0, states)
    slack_families(points, states, np.array(middle), 1.0, found)
    known = found != UNKNOWN
    assert known.mean() > 0.9
    np.testing.assert_array_equal(found[known], expected[known])
    assert len(set(expected.tolist())) > 2


def test_a_node_far_off_spoils_no_slope():
    """A tube that snaps between two pressures far below the others says nothing of these."""
    near = np.array([50e3, 60e3, 75e3, 90e3, 110e3])
    alone, beside = make_axis("pressure", near), make_axis("pressure", [10.0, *near])
    assert beside.first[1] == 0  # the window reaches there, the slopes of all but the nearest piece do not
    np.testing.assert_allclose(beside.left[3:5, 1:6], alone.left[2:4, :5], atol=1e-12)
    np.testing.assert_allclose(beside.right[2:5, 1:6], alone.right[1:4, :5], atol=1e-12)
    assert (beside.left[3:5, 0] == 0.0).all()
    assert (np.abs(beside.remainder[:5]).sum(axis=1) > 1e-3).all()  # something is told of the error everywhere


@pytest.mark.parametrize("count", [3, 4, 5])
def test_where_nodes_are_few_what_is_stated_without_a_measurement_is_no_less_than_the_error(count):
    """In the middle of each piece; a polynomial through all but the farthest node is what it is told from."""
    axis = make_axis("torque", np.linspace(0.0, 1.0, count))
    for function in (lambda x: np.exp(1.5 * x), lambda x: 1.0 / (1.0 + x)):
        values, middles = function(axis.nodes), 0.5 * (axis.nodes[1:] + axis.nodes[:-1])
        for i, middle in enumerate(middles):
            near = values[axis.first[i] : axis.first[i] + axis.window]
            slopes = (axis.left[i] - axis.right[i])[: axis.window] @ near
            told = 0.5 * (values[i] + values[i + 1]) + 0.125 * slopes
            estimate = abs(axis.remainder[i, : axis.window] @ near)
            assert 0.0 < abs(told - function(middle)) < UNMEASURED * estimate

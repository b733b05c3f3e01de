"""Fibers that cannot push, at one point: the relaxed density against finite differences and a general convex optimizer."""

import numpy as np
import pytest
from scipy.optimize import minimize

from freesweep.solver.cells import nothing_yet
from freesweep.solver.load import Load, loaded
from freesweep.solver.physics import fibers, membrane, physical, relaxed, wall

QUICK, MANY = 2000, 100_000


def random_point(draw, loose=1.0, room=0.02):
    """An admissible point: (y, v, cell, load); half of the walls are thick, half of the rubbers are Yeoh's."""
    while True:
        alpha, beta = np.radians(draw.uniform(-85, 85, 2))
        if abs(alpha - beta) < np.radians(1.0):
            continue
        H, D = 0.5 * (np.tan(alpha) + np.tan(beta)), 0.5 * (np.tan(alpha) - np.tan(beta))
        yeoh = draw.uniform(0, 1, 2) * (0.3, 0.05) * draw.integers(2)
        inner, area = 0.0, draw.uniform(0.04, 3)
        if draw.integers(2):
            radius = draw.uniform(0.5, 1.0)
            inner, area = radius**2, ((1 + draw.uniform(0.02, 1)) ** 2 - 1) * radius**2
        p = 10 ** draw.uniform(-3, 1.5)
        force, torque = draw.integers(2) * draw.uniform(-0.9 * p, 3), draw.integers(2) * draw.uniform(-3, 3)
        gamma = 1 + draw.integers(2) * draw.uniform(0, 0.02)
        y, v = draw.uniform(0.6, 2), draw.uniform(-0.95, 0.95) * draw.uniform(0, 1.5)
        cell = (H, D, area)
        load = Load(gamma, (draw.uniform(0, 1), *yeoh), (1.0, inner, loose), p, float(force), float(torque), 1.0)
        if physical.density(y, v, cell, load)[0] > room:
            return y, v, cell, load


def value(y, v, cell, load):
    """L itself."""
    _, s, G_1, psi, *_ = physical.state(y, v, cell, load, nothing_yet(0.0))
    W = wall.energy(y, G_1, psi, cell[2], load[1], load[2])[0]
    return (load[3] * y * y + load[4]) * s - W + load[5] * psi


def taut(y, v, cell, load):
    """Which families are taut."""
    return tuple(bool(one) for one in physical.place(y, v, load[3] * y * y + load[4], cell, load)[3:])


def is_upright(y, v, cell, load):
    """Whether the meridian stands upright all but to rounding."""
    G_1 = physical.place(y, v, load.p * y * y + load.f, cell, load)[1]
    return 1 + G_1 - v * v < 1e-6 * (1 + G_1)


def check_derivatives(draw, loose):
    """First derivatives against differences of L, second against those of the first; whether the latter could be seen."""
    y, v, cell, load = random_point(draw, loose, room=0.05)
    while is_upright(y, v, cell, load):
        y, v, cell, load = random_point(draw, loose, room=0.05)
    d = 1e-5
    stencil = [(y + d, v), (y - d, v), (y, v + d), (y, v - d)]
    _, L_y, L_v, L_yy, L_yv, L_vv = physical.density(y, v, cell, load)
    right, left, up, down = (np.array(physical.density(*at, cell, load)[1:3]) for at in stencil)
    by_y, by_v = (right - left) / (2 * d), (up - down) / (2 * d)
    size = 1 + abs(L_yy) + abs(L_vv) + abs(L_yv)
    # a slope of L, whose third derivatives are of the order of size^2 over the load's where little room is left
    bend = 1e-4 * size * (1 + size / (1e-2 + load[3]))
    difference = [value(*at, cell, load) for at in stencil]
    widest = max(
        size, *(1 + np.sum(np.abs(physical.density(*at, cell, load)[3:])) for at in stencil)
    )  # beyond a corner
    assert abs((difference[0] - difference[1]) / (2 * d) - L_y) <= 1e-5 * widest
    assert abs((difference[2] - difference[3]) / (2 * d) - L_v) <= 1e-5 * widest
    alike = len({taut(*at, cell, load) for at in [(y, v), *stencil]}) == 1
    if alike:
        found, ours = np.array([by_y[0], by_y[1], by_v[0], by_v[1]]), np.array([L_yy, L_yv, L_yv, L_vv])
        assert np.all(np.abs(found - ours) <= bend), (y, v, cell, load, found, ours)
    return alike, taut(y, v, cell, load)


def steep_point(draw):
    """As :func:`random_point`, of families that are steep and all but parallel, under little pressure: what both leave is
    far from where either is longest; the meridian may stand all but upright.
    """
    while True:
        alpha = draw.uniform(50, 85) * draw.choice([-1, 1])
        beta = alpha + 10 ** draw.uniform(-0.3, 1) * draw.choice([-1, 1])
        if abs(beta) > 85:
            continue
        H, D = (0.5 * (np.tan(np.radians(alpha)) + sign * np.tan(np.radians(beta))) for sign in (1, -1))
        inner = 1 / (1 + np.exp(draw.uniform(-3.5, 0))) ** 2
        p, torque = 10 ** draw.uniform(-3, 0), draw.integers(2) * draw.uniform(-1.5, 1.5)
        rubber = (draw.integers(2) * draw.uniform(0, 2), *(draw.uniform(0, 1, 2) * (0.3, 0.05) * draw.integers(2)))
        load = Load(1 + draw.integers(2) * draw.uniform(0, 0.02), rubber, (1.0, inner, 1.0), p, 0.0, float(torque), 1.0)
        y, v, cell = draw.uniform(0.5, 2), draw.uniform(-1.4, 1.4) * draw.integers(2), (H, D, 1 - inner)
        if physical.density(y, v, cell, load)[0] > 1e-3:
            return y, v, cell, load


def fault(y, v, cell, load):
    """By how much the place that was found fails to be the maximum, which is the only one: fibers that are overreached or
    would push, and forces on the stretch and the twist that nothing carries, each to what it is made of.
    """
    H, D, area = cell
    T, t, most = load.p * y * y + load.f, np.array([H + D, H - D]), load.gamma**2
    _, G_1, psi, *on = physical.place(y, v, T, cell, load)
    if is_upright(y, v, cell, load):
        return 0.0
    on = np.array(on, bool)
    _, W_G, W_p, *_ = wall.slopes(y, G_1, psi, area, load.rubber, load.wall)
    pull = 0.5 * T / np.sqrt(1 + G_1 - v * v)
    mu = np.array(fibers.multipliers(y, np.sqrt(1 + G_1 - v * v), psi, tuple(on), cell, T, load.m, W_G, W_p))
    along, round = pull - W_G - mu.sum(), load.m - W_p - 2 * y * y * np.sum(mu * (t + psi))
    size = pull + abs(W_G) + abs(load.m) + abs(W_p) + area
    gaps = (1 + G_1 + y * y * (t + psi) ** 2 - most * (1 + t * t)) / (1 + t * t)
    turning = 2 * y * y * np.sum(np.abs(mu * (t + psi)))
    return max(
        abs(along) / size, abs(round) / (size + turning), *(-mu / size), np.max(gaps), *np.abs(gaps[on])
    )  # fmt: skip


def check_maximum(draw):
    """The place that was found is feasible, and a general optimizer finds no better one."""
    y, v, cell, load = random_point(draw)
    H, D, area = cell
    T, t = load[3] * y * y + load[4], np.array([H + D, H - D])
    most = load[0] ** 2 * (1 + t * t)
    _, _, G_1, psi, *_ = physical.state(y, v, cell, load, nothing_yet(0.0))
    gaps = 1 + G_1 + y * y * (t + psi) ** 2 - most
    assert np.all(gaps <= 1e-12 * (1 + most))
    low = max(v * v, wall.narrowest(y, load[2]))

    def negative(at):
        G_1 = at[0] - 1
        W = wall.energy(y, G_1, at[1], area, load[1], load[2])[0]
        return -(T * np.sqrt(at[0] - v * v) - W + load[5] * at[1])

    ours = -negative((1 + G_1, psi))
    size = T + abs(load[5]) + area
    constraint = {
        "type": "ineq",
        "fun": lambda at: most - at[0] - y * y * (t + at[1]) ** 2,
        "jac": lambda at: np.column_stack([-np.ones(2), -2 * y * y * (t + at[1])]),
    }
    # start inside: below the place found, towards the middle of what is feasible
    start = (low + 0.5 * (1 + G_1 - low), psi)
    found = minimize(
        negative, start, method="SLSQP", bounds=[(low * (1 + 1e-9) + 1e-9, None), (None, None)], constraints=constraint,
        options={"ftol": 1e-13, "maxiter": 300},
    )  # fmt: skip
    feasible = np.all(constraint["fun"](found.x) > -1e-9 * (1 + most))
    if feasible:
        assert -found.fun <= ours + 1e-6 * size, (y, v, cell, load, found, ours)
    # strictly concave between feasible places: the maximum is the only one
    for _ in range(3):
        other = np.array([low + (1 + G_1 - low) * draw.uniform(0.05, 1), psi])
        middle = 0.5 * (other + np.array([1 + G_1, psi]))
        assert -negative(middle) >= 0.5 * (-negative(other) + ours) - 1e-12 * size
    return bool(found.success and feasible and abs(-found.fun - ours) < 1e-5 * size)


@pytest.mark.parametrize("loose", [1.0, 0.0])
def test_partial_derivatives_are_those_of_the_density(loose):
    draw = np.random.default_rng(int(loose))
    seen = [check_derivatives(draw, loose) for _ in range(QUICK // 4)]
    assert np.mean([alike for alike, _ in seen]) > 0.98
    kinds = {kind for _, kind in seen}
    assert len(kinds) == (4 if loose else 1)  # every set of taut families was met


def test_what_a_neighbour_hands_on_changes_nothing_but_the_way():
    """Begun from a point nearby, from one on the other side of a change of the taut families, or from nothing."""
    draw, changed = np.random.default_rng(9), 0
    for _ in range(QUICK // 4):
        y, v, cell, load = random_point(draw, room=0.05)
        T = load[3] * y * y + load[4]
        _, G_1, psi, alpha, beta = relaxed.settle(fibers.given_at(y, v, cell, load), T)
        alone = physical.state(y, v, cell, load, nothing_yet(0.0))
        far = 10 ** draw.uniform(-5, 0)
        beside = y * (1 + far * draw.uniform(-1, 1)), v + far * draw.uniform(-1, 1)
        there = physical.state(*beside, cell, load, nothing_yet(0.0))
        after = physical.state(y, v, cell, load, physical.handed_on(there, *beside, load))
        changed += there.kind != alone.kind
        for at in (alone, after):
            assert at.kind == alpha + 2.0 * beta
            wanted, found = (G_1, psi, alone.L_y), (at.G_1, at.psi, at.L_y)
            for one, other, unit in zip(wanted, found, (1e-11, 1e-11, 1e-8)):
                assert abs(one - other) <= unit * (1.0 + abs(one))
    assert changed >= 5


def test_no_optimizer_finds_a_better_place():
    draw = np.random.default_rng(7)
    assert np.mean([check_maximum(draw) for _ in range(100)]) > 0.9  # and mostly it finds the same


@pytest.mark.parametrize("point", [random_point, steep_point])
def test_what_is_found_is_the_maximum(point):
    draw = np.random.default_rng(13)
    assert max(fault(*point(draw)) for _ in range(QUICK)) < 1e-5


@pytest.mark.long
def test_derivatives_and_maximum_at_many_points():
    draw = np.random.default_rng(12)
    assert np.mean([fault(*steep_point(draw)) > 1e-5 for _ in range(MANY)]) < 1e-4  # rounding, and walls at the axis
    draw = np.random.default_rng(11)
    assert np.mean([check_derivatives(draw, 1.0)[0] for _ in range(MANY)]) > 0.98
    assert np.mean([check_maximum(draw) for _ in range(MANY // 10)]) > 0.9


def test_where_both_tensions_are_positive_threads_and_cement_agree():
    draw, met = np.random.default_rng(3), 0
    while met < 200:
        y, v, cell, load = random_point(draw)
        if taut(y, v, cell, load) != (True, True):
            continue
        met += 1
        bonded = Load(*load[:2], (load[2][0], load[2][1], 0.0), *load[3:])
        assert physical.density(y, v, cell, load)[1:] == physical.density(y, v, cell, bonded)[1:]
        assert min(physical.at_slope(y, v, cell, load)[1:]) >= 0.0


def test_a_bonded_membrane_is_the_source_s():
    draw = np.random.default_rng(5)
    for _ in range(300):
        y, v, cell, load = random_point(draw, loose=0.0, room=0.05)
        thin, source = Load(*load[:2], (1.0, 0.0, 0.0), *load[3:]), Load(*load[:2], (1.0,), *load[3:])
        if membrane.density(y, v, cell, source)[0] < 0.05:
            continue
        direction = Load(0.0, 0.0, 0.0, 0.3, -0.7, 1.9, 0.0)
        for ours, theirs in (
            (physical.density(y, v, cell, thin), membrane.density(y, v, cell, source)),
            (physical.uniform_tube(y, cell, thin), membrane.uniform_tube(y, cell, source)),
            (physical.integrands(y, v, cell, thin)[:4], membrane.integrands(y, v, cell, source)[:4]),
            (physical.conjugate(y, v, cell, thin, direction), membrane.conjugate(y, v, cell, source, direction)),
            (physical.at_slope(y, v, cell, thin)[1:], membrane.at_slope(y, v, cell, source)[1:]),
            (physical.at_flux(y, 0.3, cell, thin), membrane.at_flux(y, 0.3, cell, source)),
        ):
            size = 1 + np.max(np.abs(theirs))
            assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-10 * size)


def test_what_is_conjugate_to_a_load_is_the_change_of_the_density_with_it():
    draw, d = np.random.default_rng(9), 1e-5
    for _ in range(300):
        y, v, cell, load = random_point(draw, room=0.05)
        direction = Load(0.0, 0.0, 0.0, 0.3, 0.7, 1.9, 0.0)
        low, high = (loaded(load, direction, e) for e in (-d, d))
        c, c_y, c_v, c_mu = physical.conjugate(y, v, cell, load, direction)
        first, last = physical.density(y, v, cell, low), physical.density(y, v, cell, high)
        assert (value(y, v, cell, high) - value(y, v, cell, low)) / (2 * d) == pytest.approx(c, rel=1e-5, abs=1e-6)
        if taut(y, v, cell, low) == taut(y, v, cell, high):
            change = (np.array(last[1:3]) - first[1:3]) / (2 * d)
            assert change == pytest.approx([c_y, c_v], rel=1e-3, abs=1e-3 * (1 + abs(c_y) + abs(c_v)))
            before, after = (physical.conjugate(y, v, cell, at, direction)[0] for at in (low, high))
            assert (after - before) / (2 * d) == pytest.approx(c_mu, rel=1e-3, abs=1e-4)

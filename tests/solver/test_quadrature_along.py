"""The first integral along physical tubes: a place from its level, sums along the depth, ends and peaks."""

import numpy as np
import pytest
from scipy.integrate import quad

from freesweep import interpret
from freesweep.solver.cells import nothing_yet
from freesweep.solver.lanes import extremes, pushed, rule, slack_ends
from freesweep.solver.load import Load
from freesweep.solver.physics import first_integral, physical, wall

place, at_level, stored = (
    interpret._twin(one.py_func) for one in (physical.place, first_integral.at_level, wall.stored)
)


@pytest.mark.parametrize("threads", [wall.BONDED, wall.LOOSE, wall.ONE_LOOSE, wall.NONE])
def test_level_of_the_first_integral_tells_resultant_stretch_and_twist_of_an_inclined_place(threads):
    """L - v L_v, from what the fibers leave at the slope v; G and psi are those of no slope under T/cosine."""
    draw, kinds = np.random.default_rng(4), set()
    for _ in range(60):
        ta, tb = np.tan(np.radians(draw.uniform(-80.0, 80.0, 2)))
        cell = (0.5 * (ta + tb), 0.5 * (ta - tb), draw.uniform(0.1, 0.6))
        load = Load(
            1.0, (draw.uniform(0.0, 1.0),), (1.0, 1.0 - cell[2], threads), draw.uniform(0.05, 3.0), draw.uniform(0.0, 0.3),
            draw.uniform(-0.1, 0.1), 1.0,
        )  # fmt: skip
        y, v = 1.0 + draw.uniform(-0.05, 0.1), draw.uniform(-0.4, 0.4)
        T = load.p * y * y + load.f
        room, G_1, psi, alpha, beta = place(y, v, T, cell, load)
        if not room > 0.1:
            continue
        s = np.sqrt(1.0 + G_1 - v * v)
        level = T * s + T * v * v / s - stored(y, G_1, psi, cell[2], load.rubber, load.wall) + load.m * psi
        at = at_level(y, level, cell, load, nothing_yet(0.0))
        assert pytest.approx(T * np.sqrt(1.0 + G_1) / s, rel=1e-10) == at.R
        assert (at.G_1, at.psi) == pytest.approx((G_1, psi), rel=1e-5, abs=1e-7)
        assert at.kind == physical.kind_of.py_func(alpha, beta)
        kinds.add(at.kind)
    assert len(kinds) >= {wall.BONDED: 1, wall.LOOSE: 3, wall.ONE_LOOSE: 1, wall.NONE: 1}[threads]


def test_resultant_less_the_work_of_pressure_rises_with_the_stretch_as_told():
    """Against differences of places of one level."""
    cell, load = (0.3, 0.7, 0.4), Load(1.0, (0.5,), (1.0, 0.6, wall.LOOSE), 0.8, 0.05, 0.02, 1.0)
    for y, level in ((1.02, 1.2), (1.05, 1.4), (0.97, 1.1)):
        beyond = [at_level(y + h, level, cell, load, nothing_yet(0.0)).R - load.p * (y + h) ** 2 for h in (-1e-5, 1e-5)]
        told = at_level(y, level, cell, load, nothing_yet(0.0)).rise
        assert told == pytest.approx((beyond[1] - beyond[0]) / 2e-5, rel=1e-6)


missed_by, missed_within = (interpret._twin(one.py_func) for one in (rule.missed_by, rule.missed_within))


def test_what_the_rule_misses_is_less_than_its_bound():
    """Poles and roots beside the interval, sharp and far, where the bound is good enough for an accuracy of 1e-4."""
    draw, used = np.random.default_rng(2), []
    for _ in range(300):
        a, b, kind = 10.0 ** draw.uniform(-2.0, 0.5), draw.uniform(-0.9, 0.9), draw.integers(3)

        def curve(x, a=a, b=b, kind=kind):
            return (1.0 / (1.0 + a - x), np.sqrt(1.0 + a - x), 1.0 / np.hypot(x - 0.4, a))[kind] * (1.0 + b * x)

        at = curve(rule.PLACES)
        whole, within = missed_by(at[:, None]), missed_within(at[:, None])
        if whole > 1e-4:
            continue
        exact = quad(curve, 0.0, 1.0, points=[0.4], epsabs=1e-13, epsrel=1e-13)[0]
        missed = abs(rule.WEIGHTS @ at - exact)
        assert missed <= whole + 1e-13
        used.append(missed / (whole + 1e-13))
        part = quad(curve, 0.0, rule.PLACES[9], points=[0.4], epsabs=1e-13, epsrel=1e-13)[0]
        assert abs(rule.UP_TO[9] @ at - part) <= within + 1e-13
    assert len(used) > 150
    assert max(used) > 0.02  # it is no bound for anything


def test_weights_are_exact_for_polynomials():
    for power in range(rule.LAST + 1):
        assert rule.WEIGHTS @ rule.PLACES**power == pytest.approx(1.0 / (power + 1), abs=1e-13)


@pytest.mark.parametrize("at", [0.03, 0.29, 0.48, 0.77])
def test_a_peak_between_places_is_told_within_what_may_be_wrong(at):
    row = np.exp(-3.0 * (rule.PLACES - at) ** 2)
    most, wrong = interpret._twin(extremes.widest.py_func)(row[:, None], rule.LAST, -1.0, 0.0)
    assert abs(most - 1.0) < 1e-5 + 0.3 * (1.0 - row.max())
    assert abs(most - 1.0) <= wrong < 5e-3


@pytest.mark.parametrize("roots", [(0.31,), (0.02, 0.9), (0.2, 0.21, 0.6), ()])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_fibers_begin_and_cease_to_push_at_the_roots_of_their_pull(roots, sign):
    def pull(t):
        return sign * np.prod([t - root for root in roots], axis=0) * np.exp(-t) if roots else sign + 0.0 * t

    def grows(t):
        return np.exp(2.0 * t) * (1.0 + t * t)

    rows, series = [row(rule.PLACES)[:, None] for row in (pull, grows)], np.zeros((2, rule.LAST + 2, 1))
    for matrix, row, own in zip((rule.COEFFICIENTS, rule.INTEGRALS), rows, series):
        interpret._twin(pushed.expand.py_func)(matrix, row, own)
    next_end, root, evaluate = (interpret._twin(one.py_func) for one in (pushed.next_end, pushed.root, pushed.evaluate))
    taken, found = -1.0, []
    for _ in range(rule.LAST):
        *bracket, taken, there = next_end(rows[0], taken)
        if not there:
            break
        found.append(root(series[0], *bracket, there))
    seen = [
        t for t in roots if not (t in (0.2, 0.21) and 0.21 in roots)
    ]  # two between the same two places: nobody sees them
    assert found == pytest.approx(seen, abs=1e-8)
    for t in seen:
        assert evaluate(series[1], rule.LAST + 2, t) == pytest.approx(quad(grows, 0.0, t)[0], abs=1e-12)


def test_ends_of_a_part_are_sorted_and_counted():
    edges, counts = np.array([[0.0], [0.7], [0.2], [0.5], [1.0]]), np.array([3])
    slack_ends.sort.py_func.__globals__["WIDTH"], width = 1, slack_ends.WIDTH
    try:
        slack_ends.sort.py_func(edges, counts)
    finally:
        slack_ends.sort.py_func.__globals__["WIDTH"] = width
    assert edges[:, 0].tolist() == [0.0, 0.2, 0.5, 0.7, 1.0]

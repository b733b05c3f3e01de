"""The stable, antisymmetric state beside the straight cylinder: the source's "blocked deformation".

At the critical pressure a branch leaves the cylinder, whose first shape is a whole sine. It may begin toward lower
pressures: then it turns back at the least pressure of any buckled state, and from there on is stable. All of it is gone,
through its turning points, until it comes to the pressure asked for in a stable state.
"""

from math import pi, sin

import numpy as np

from ..jit import kernel
from . import held, lagrangian, nested, newton, pinned, turn
from .course import at_point
from .march import (
    GROWTH,
    LARGEST_CHANGE,
    NO_SNAP,
    STRAY,
    TOLERANCE,
    cylinder_multiplier,
    even_mesh,
    fastest,
    halt,
    top,
)  # fmt: skip
from .problem import GAMMA, SHEAR, rubber_of
from .shapes import largest_drift
from .stability import unstable_directions
from .status import HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK

AMPLITUDES = (0.003, 0.01, 0.03, 0.1)  # of the sine, tried in turn: with fiber extension no cylinder is straight
STEPS, SMALLEST_STEP = 600, 1e-6
FARTHEST = 2.5  # times the larger of the pressure asked for and the critical one: a branch that far seldom comes back
DIRECTION = (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
PROBE = 1e-3  # of the pressure
BUCKLED = 1e-3  # |y - 1| from which a tube counts as swollen, or as thinned
PRESSURE_STEP = 0.005  # of it, where a front is too steep for steps along the branch


@kernel
def critical(cell, load, length):
    """The pressure at which y = 1 loses its stability to a whole sine; L_yy and L_vv are linear in it. NaN: never."""
    found = np.zeros(2)
    for k in range(2):
        now = (load[0], load[1], load[2], 1.0 * k, load[4], 0.0, 1.0)
        now = held.loaded(now, DIRECTION, cylinder_multiplier(cell, now, DIRECTION))
        _, _, _, L_yy, _, L_vv = lagrangian.density(1.0, 0.0, cell, now)
        found[k] = L_yy + L_vv * (2.0 * pi / length) ** 2
    p = -found[0] / (found[1] - found[0])
    return p if p > 0.0 else np.nan


@kernel
def is_buckled(y):
    """Whether a tube swells somewhere and thins somewhere."""
    return np.max(y) > 1.0 + BUCKLED and np.min(y) < 1.0 - BUCKLED


@kernel
def on_meshes(x, y, tube, load, direction, wanted, mu, accuracy, space, out):
    """A buckled state of the base mesh on nested ones: ``(status, doublings, load)``; NOT_CONVERGED where it is none that is
    stable. Its multiplier is left in units of ``direction``.
    """
    fine, work, table = space[0], space[1], space[2]
    n = len(x) - 1
    status, unstable, doublings, _ = nested.solve(
        lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube, load, nested.HELD,
        direction, wanted, mu, 1, accuracy, fine, work, table, out,
    )  # fmt: skip
    good = status == newton.CONVERGED or status == nested.UNREACHED
    if not good or unstable > 0 or not is_buckled(y):
        return NOT_CONVERGED, 0, load
    now = held.loaded(load, direction, out[0, nested.MULTIPLIER])
    _, rounding = unstable_directions(
        fine[0], fine[1], n << doublings, n, tube, now, direction, abs(wanted), work
    )  # fmt: skip
    out[1, nested.MULTIPLIER] += rounding
    return (OK if status == newton.CONVERGED else INACCURATE), doublings, now


@kernel
def scaled(out, scale):
    """Turn the multiplier from units of the direction to those of its load."""
    out[0, nested.MULTIPLIER] *= scale
    out[1, nested.MULTIPLIER] *= scale


@kernel
def by_pressure(x, y, kept_x, kept_y, tube, way, t, mu, work):
    """On an even mesh, in steps of the pressure, from a state at share ``t`` of it, which is stable and stays so:
    ``(whether it came to the end, mu)``.
    """
    n, direction, target = len(x) - 1, way[4], way[3]
    even_mesh(x, tube[5], tube[1])
    j = 0
    for i in range(n + 1):
        while j < n - 1 and kept_x[j + 1] < x[i]:
            j += 1
        y[i] = kept_y[j] + (x[i] - kept_x[j]) * (kept_y[j + 1] - kept_y[j]) / (kept_x[j + 1] - kept_x[j])
    while True:
        own, now = pinned.at_share(way, tube, x, n, n, t)
        status, unstable, mu, _ = held.solve_held(
            lagrangian.density, lagrangian.conjugate, x, y, n, False, own, now, direction, mu, target, TOLERANCE,
            newton.MAX_ITERATIONS, work,
        )  # fmt: skip
        if status != newton.CONVERGED or not is_buckled(y):
            return False, mu
        if t == 1.0:
            return unstable == 0, mu
        nested.regrade(lagrangian.density, lagrangian.integrands, x, y, n, tube, held.loaded(now, direction, mu), work)
        t = min(1.0, t + PRESSURE_STEP)


@kernel
def find_buckled(problem, p, force, target, tube, accuracy, space, out, least):
    """The stable buckled state at pressure ``p``; arguments and what is returned as of :func:`find.find`, but for
    ``least`` (2,): the least pressure at which the branch has a state, and its bound.
    """
    return _find_buckled(tube[0], problem, p, force, target, tube, accuracy, space, out, least)


@kernel
def _find_buckled(course, problem, p, force, target, tube, accuracy, space, out, least):
    if course.ndim > 4:  # nothing straight to buckle from
        return HELD_IMPOSSIBLE, 0, 0, (problem[GAMMA], rubber_of(problem), (problem[SHEAR],), p, force, 0.0, 1.0)
    fine, work, table, shapes = space[0], space[1], space[2], space[4]
    _, edges, _, _, _, places = tube
    n = edges[len(edges) - 1]
    x, y, cell = shapes[0, : n + 1], shapes[1, : n + 1], at_point(course, 0, 0.0)
    length = places[len(places) - 1]
    load = (problem[GAMMA], rubber_of(problem), (problem[SHEAR],), p, force, 0.0, 1.0)
    least[0], least[1] = np.nan, np.nan
    p_c = critical(cell, load, length)
    if not p_c > 0.0 or not p_c + force > 0.0:
        return HELD_IMPOSSIBLE, 0, 0, load
    at_critical = (load[0], load[1], load[2], p_c, force, 0.0, 1.0)
    scale = max(p, abs(cylinder_multiplier(cell, at_critical, DIRECTION)))
    direction, wanted = (0.0, 0.0, 0.0, 0.0, 0.0, scale, 0.0), target * scale
    nothing = (load[0], load[1], load[2], 0.0, force, 0.0, 1.0)
    way = (nothing, load, wanted, wanted, direction, True, course, cell, False)
    quarter = n // 4 - (n // 4) % 2
    kept_x, kept_y, along, guess = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    status, mu, t, by_mu, by_t, unstable, k = newton.STALLED, 0.0, 0.0, 0.0, 0.0, 0, quarter
    for amplitude in AMPLITUDES:
        even_mesh(x, places, edges)
        for i in range(n + 1):
            y[i] = 1.0 + amplitude * sin(2.0 * pi * x[i] / x[n])
        t, mu = p_c / p, cylinder_multiplier(cell, at_critical, direction)
        status, unstable, mu, t, by_mu, by_t = pinned.solve(
            x, y, n, n, tube, way, quarter, y[quarter], t, mu, TOLERANCE, work
        )
        if status == newton.CONVERGED and y[n - quarter] < 1.0:
            break
    if status != newton.CONVERGED:
        return NOT_CONVERGED, 0, 0, load
    sign = 1.0 if work[12, quarter] >= 0.0 else -1.0
    step, first_t = 0.5 * LARGEST_CHANGE, min(t, p_c / p)
    least[0], least[1] = first_t * p, abs(t - p_c / p) * p  # a branch that rises begins at the critical pressure
    farthest = FARTHEST * max(1.0, t)
    for _ in range(STEPS):
        kept_mu, kept_t, kept_unstable = mu, t, unstable
        by_mu, by_t = sign * by_mu, sign * by_t
        for i in range(n + 1):
            kept_x[i], kept_y[i], along[i] = x[i], y[i], sign * work[12, i]
        solved, new_mu, new_t = False, 0.0, 0.0
        while step > SMALLEST_STEP and not solved:
            k, most = fastest(kept_y, along, n)
            ahead = min(step, LARGEST_CHANGE / max(most, 1e-300))
            for i in range(n + 1):
                x[i], y[i] = kept_x[i], kept_y[i] + ahead * along[i]
            mu, t = kept_mu + ahead * by_mu, kept_t + ahead * by_t
            own, now = pinned.at_share(way, tube, x, n, n, t)
            if newton.admissible(lagrangian.density, x, y, n, own, held.loaded(now, direction, mu)):
                nested.regrade(
                    lagrangian.density, lagrangian.integrands, x, y, n, tube, held.loaded(now, direction, mu), work
                )
            for i in range(n + 1):
                guess[i] = y[i]
            expected, value = t, y[k]
            status, unstable, mu, t, new_mu, new_t = pinned.solve(
                x, y, n, n, tube, way, k, value, t, mu, TOLERANCE, work
            )
            drift = largest_drift(y, guess)
            solved = status == newton.CONVERGED and drift < STRAY * ahead + NO_SNAP and abs(t - expected) < STRAY
            step = (GROWTH if drift < 0.2 * STRAY * ahead else 1.0) * ahead if solved else 0.5 * ahead
        if not solved:  # a front that is too steep for steps along the branch
            if not (kept_unstable == 0 and kept_t < 1.0 and kept_y[quarter] > 1.0 > kept_y[n - quarter]):
                return NOT_CONVERGED, 0, 0, load
            found, mu = by_pressure(x, y, kept_x, kept_y, tube, way, kept_t, kept_mu, work)
            status, doublings, now = NOT_CONVERGED, 0, load
            if found:
                status, doublings, now = on_meshes(x, y, tube, load, direction, wanted, mu, accuracy, space, out)
            if status != NOT_CONVERGED:
                scaled(out, scale)
            return status, 0, doublings, now
        if not 0.0 < t < farthest:
            break
        dot = new_t * by_t
        for i in range(n + 1):
            dot += work[12, i] * along[i] / (y[i] * y[i] * n)
        sign = 1.0 if dot >= 0.0 else -1.0
        if by_t < 0.0 and sign * new_t >= 0.0:  # the least pressure of this branch
            there_x, there_y, there = x.copy(), y.copy(), work[12].copy()
            found, low, its_mu, bend = top(x, y, n, n, tube, way, k, t, mu, new_t / work[12, k], 0.0, -1.0, work)
            if found and low < first_t:
                found, low, bound, _, _, _ = turn.on_nested_meshes(
                    x, y, tube, way, k, 0.0, low, its_mu, bend, accuracy, fine, work, table, out
                )
                if found:
                    least[0], least[1], first_t = low * p, bound * p, low
            for i in range(n + 1):
                x[i], y[i], work[12, i] = there_x[i], there_y[i], there[i]
        by_mu, by_t = new_mu, new_t
        if (
            (kept_t - 1.0) * (t - 1.0) <= 0.0
            and min(unstable, kept_unstable) == 0
            and y[quarter] > 1.0 > y[n - quarter]
        ):
            here_x, here_y, here = x.copy(), y.copy(), work[12].copy()
            found, its_mu = halt(x, y, n, n, tube, way, k, t, mu, new_t, 1.0, work)
            if found:
                status, doublings, now = on_meshes(x, y, tube, load, direction, wanted, its_mu, accuracy, space, out)
                if status != NOT_CONVERGED and y[quarter] > 1.0 > y[n - quarter]:
                    scaled(out, scale)
                    return status, 0, doublings, now
            for i in range(n + 1):
                x[i], y[i], work[12, i] = here_x[i], here_y[i], here[i]
            unstable = kept_unstable
    return HELD_IMPOSSIBLE, 0, 0, load

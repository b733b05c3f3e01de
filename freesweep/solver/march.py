"""The ways to a held state: small steps of the load, of what is held, and of the course along the tube."""

from math import pi, sin

import numpy as np

from ..jit import kernel
from . import held, lagrangian, newton
from .climb import largest_drift, pushed, regraded
from .course import at_point, fill
from .status import COMPRESSED, HELD_IMPOSSIBLE, OK
from .uniform import between

STEP, SMALLEST_STEP = 0.1, 1e-4  # of a march
LARGEST_STEP_CHANGE = 0.05  # relative change of y in one step of a march
FIRST_SHARE = 1.0 / 32.0  # of the load: small enough for a single state
AMPLITUDES = (0.02, 0.04, 0.08, 0.15, 0.25, 0.35)  # of the antisymmetric mode, tried in turn
LOWERING, LOWERINGS = 0.93, 16  # of the pressure, until the buckled state is found; then up again
BUCKLED = 1e-4  # |y - 1| from which a state counts as buckled


@kernel
def cylinder_multiplier(cell, load, direction):
    """The multiplier that makes y = 1 an equilibrium of a tube that is ``cell`` all along."""
    return -lagrangian.density(1.0, 0.0, cell, load)[1] / lagrangian.conjugate(1.0, 0.0, cell, load, direction)[1]


@kernel
def blend(course, cell, t, out):
    """The course a fraction ``t`` of the way from a tube that is ``cell`` all along."""
    for s in range(course.shape[0]):
        for piece in range(course.shape[1]):
            for k in range(3):
                for power in range(4):
                    start = cell[k] if power == 0 else 0.0
                    out[s, piece, k, power] = start + t * (course[s, piece, k, power] - start)


@kernel
def march(x, y, tube, course, cell, blending, start, end, direction, mu, first, target, tolerance, work):
    """From load ``start`` with ``first`` held to load ``end`` with ``target`` held; where it is ``blending``, also from a
    tube that is ``cell`` all along to ``course``. ``tube`` holds the course that is changed on the way.

    Returns ``(status, multiplier)``.
    """
    own, edges, cells, free, _, _ = tube
    n = len(x) - 1
    kept_x, kept_y, kept_mu = np.empty(n + 1), np.empty(n + 1), mu
    t, step = 0.0, STEP
    while t < 1.0:
        for i in range(n + 1):
            kept_x[i], kept_y[i] = x[i], y[i]
        ahead = min(1.0, t + step)
        if blending:
            blend(course, cell, ahead, own)
        load = between(start, end, ahead)
        status, _, mu, _ = held.solve_held(
            lagrangian.density, lagrangian.conjugate, x, y, n, free, fill(own, edges, x, n, n, cells), load, direction,
            kept_mu, first + ahead * (target - first), tolerance, work,
        )  # fmt: skip
        if status == newton.CONVERGED and largest_drift(y, kept_y) < LARGEST_STEP_CHANGE:
            t, step, kept_mu = ahead, 1.6 * step, mu
            regraded(x, y, n, tube, held.loaded(load, direction, mu), work)
            continue
        for i in range(n + 1):
            x[i], y[i] = kept_x[i], kept_y[i]
        step *= 0.5
        if step < SMALLEST_STEP:
            last = held.loaded(between(start, end, t), direction, kept_mu)
            return (COMPRESSED if pushed(y, last) else HELD_IMPOSSIBLE), kept_mu
    if blending:
        blend(course, cell, 1.0, own)
    return OK, kept_mu


@kernel
def even_mesh(x, places, edges):
    """Equal cells within each segment."""
    for s in range(len(edges) - 1):
        a, b = edges[s], edges[s + 1]
        for i in range(a, b + 1):
            x[i] = places[s] + (places[s + 1] - places[s]) * (i - a) / (b - a)


@kernel
def buckle(x, y, tube, load, direction, mu, target, work):
    """A stable state beside the straight cylinder, swollen in its first half; returns ``(status, multiplier)``."""
    course, edges, cells, free, _, places = tube
    n = len(x) - 1
    for amplitude in AMPLITUDES:
        even_mesh(x, places, edges)
        for i in range(n + 1):
            y[i] = 1.0 + amplitude * sin(2.0 * pi * x[i] / x[n])
        status, unstable, trial, _ = held.solve_held(
            lagrangian.density, lagrangian.conjugate, x, y, n, free, fill(course, edges, x, n, n, cells), load, direction,
            mu, target, 1e-11, work,
        )  # fmt: skip
        largest = 0.0
        for i in range(n + 1):
            largest = max(largest, abs(y[i] - 1.0))
        if status == newton.CONVERGED and unstable == 0 and largest > BUCKLED:
            if y[n // 4] < 1.0:  # the mirror image is as good a state: keep to one of the two
                for i in range(n // 2):
                    y[i], y[n - i] = y[n - i], y[i]
            return OK, trial
    return HELD_IMPOSSIBLE, mu


@kernel
def buckled_at(x, y, tube, course, load, attempts, direction, mu, target, work):
    """The buckled state at ``load``: found at a lower pressure, close above the critical one where the mode is small, and
    followed up from there. ``attempts`` are (first, end) in powers of LOWERING. Returns ``(status, multiplier)``.
    """
    own = tube[0]
    cell = at_point(own, 0, 0.0)
    for attempt in range(attempts[0], attempts[1]):
        lower = (load[0], load[1], load[2], load[3] * LOWERING**attempt, load[4], load[5], load[6])
        status, found = buckle(x, y, tube, lower, direction, mu, target, work)
        if status == OK and attempt > 0:
            status, found = march(
                x, y, tube, course, cell, False, lower, load, direction, found, target, target, 1e-10, work
            )
        if status == OK:
            return OK, found
    return HELD_IMPOSSIBLE, mu


@kernel
def begin(x, y, tube):
    """The straight cylinder, on equal cells."""
    even_mesh(x, tube[5], tube[1])
    for i in range(len(x)):
        y[i] = 1.0


@kernel
def from_rest(x, y, tube, course, cell, load, direction, natural, target, work):
    """The state at ``load`` with ``target`` held, on the branch that begins without load: pressure, the other load and
    fiber extension - 1 rise in proportion while the ``natural`` length or rotation, the undeformed one, is held; then what
    is held changes to ``target``. Returns ``(status, multiplier)``.

    So small a share of the load has one state only: there the tube is blended from one that is ``cell`` all along.
    """
    small = between((1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0), load, FIRST_SHARE)
    mu = cylinder_multiplier(cell, small, direction)
    first = lagrangian.conjugate(1.0, 0.0, cell, small, direction)[0] * x[len(x) - 1]
    status, mu = march(x, y, tube, course, cell, True, small, small, direction, mu, first, natural, 1e-10, work)
    if status == OK:
        status, mu = march(x, y, tube, course, cell, False, small, load, direction, mu, natural, natural, 1e-10, work)
    if status == OK and target != natural:
        status, mu = march(x, y, tube, course, cell, False, load, load, direction, mu, natural, target, 1e-10, work)
    return status, mu

"""Held states: the deformed length or the rotation of the free end is given, the force or the torque that keeps it unknown.

The straight cylinder y = 1 of a tube that is the same all along is an equilibrium under the load that makes L_y(1, 0) = 0.
From there one march leads to the state asked for: the course along the tube, the held quantity and the pressure change in
small steps, the multiplier follows. Beyond a critical pressure of blocked torque the cylinder is unstable (its first mode
is antisymmetric); ``buckled`` starts from that mode instead, and takes the stable state beside it.
"""

from math import pi, sin

import numpy as np

from ..jit import entry_point, kernel
from . import guide, held, lagrangian, nested, newton
from .branch import GAMMA, RATIO, SHEAR
from .climb import largest_drift, pushed, regraded
from .course import fill
from .profile import FIELDS, at_stations
from .slack import slack_fibers
from .stability import unstable_directions
from .status import COMPRESSED, HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK
from .uniform import between

HELD_LENGTH, HELD_ROTATION = 0, 1
STEP, SMALLEST_STEP = 0.1, 1e-4  # of a march
LARGEST_STEP_CHANGE = 0.05  # relative change of y in one step of a march
RAISES = 40  # of the pressure by a half, until the wall of the starting cylinder is under tension
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
def march(x, y, tube, course, cell, start, end, direction, mu, first, target, tolerance, work):
    """From the tube ``cell`` at load ``start`` with ``first`` held to ``course`` at ``end`` with ``target`` held.

    ``tube`` holds the course that is changed on the way. Returns ``(status, multiplier)``.
    """
    own, edges, cells, free, _, _ = tube
    n = len(x) - 1
    kept_x, kept_y, kept_mu = np.empty(n + 1), np.empty(n + 1), mu
    t, step = 0.0, STEP
    while t < 1.0:
        for i in range(n + 1):
            kept_x[i], kept_y[i] = x[i], y[i]
        ahead = min(1.0, t + step)
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
    blend(course, cell, 1.0, own)
    return OK, kept_mu


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
def even_mesh(x, places, edges):
    """Equal cells within each segment."""
    for s in range(len(edges) - 1):
        a, b = edges[s], edges[s + 1]
        for i in range(a, b + 1):
            x[i] = places[s] + (places[s + 1] - places[s]) * (i - a) / (b - a)


@kernel
def find(problem, p, other, target, kind, buckled, course, tube, accuracy, space, out):
    """One held state; returns ``(status, unstable directions, doublings, multiplier, load)``."""
    fine, work, table, shapes = space[0], space[1], space[2], space[4]
    _, edges, _, _, _, places = tube
    base = edges[len(edges) - 1]
    x, y = shapes[0, : base + 1], shapes[1, : base + 1]
    total = places[len(places) - 1]
    gamma = problem[GAMMA]
    force, torque = (0.0, other) if kind == HELD_LENGTH else (other, 0.0)
    load = (gamma, problem[RATIO], problem[SHEAR], p, force, torque, 1.0)
    unit = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0) if kind == HELD_LENGTH else (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    # a place whose cylinder can carry the load, at a higher pressure if it must be
    start, cell, raised = load, guide.cell_along(tube, 0.5), False
    for attempt in range(RAISES * guide.PLACES):
        share = ((attempt // RAISES) * 0.5 / (guide.PLACES - 1) + 0.5) % 1.0
        cell = guide.cell_along(tube, share)
        higher = p * 1.5 ** (attempt % RAISES)
        start = (gamma, problem[RATIO], problem[SHEAR], higher, force, torque, 1.0)
        mu = cylinder_multiplier(cell, start, unit)
        at_start = held.loaded(start, unit, mu)
        raised = lagrangian.density(1.0, 0.0, cell, at_start)[0] > 0.0
        if raised or (course.shape[0] == 1 and attempt == RAISES - 1):
            break
    # a straight fiber cannot stretch: whatever the force, the length stays (the pole of Eq. 2.16)
    if course.shape[0] == 1 and lagrangian.conjugate(1.0, 0.0, cell, load, unit)[1] == 0.0:
        return HELD_IMPOSSIBLE, 0, 0, 0.0, load
    if not raised:
        return COMPRESSED, 0, 0, 0.0, load
    scale = max(abs(mu), p)
    direction = tuple_times(unit, scale)
    mu /= scale
    even_mesh(x, places, edges)
    for i in range(base + 1):
        y[i] = 1.0
    first = lagrangian.conjugate(1.0, 0.0, cell, start, unit)[0] * total * scale
    wanted = target * scale
    found, regrades = OK, 1
    for tries in range(2):  # a buckled shape that no mesh holds is come to from a lower pressure
        if buckled:
            lower, actual = load, guide.cell_along(tube, 0.5)
            found = HELD_IMPOSSIBLE
            # close above the critical pressure the mode is small: there it is found
            for attempt in range(tries, LOWERINGS):
                lower = (gamma, problem[RATIO], problem[SHEAR], p * LOWERING**attempt, force, torque, 1.0)
                found, mu = buckle(x, y, tube, lower, direction, mu, wanted, work)
                if found == OK:
                    break
            if found == OK and lower[3] != p:
                found, mu = march(x, y, tube, course, actual, lower, load, direction, mu, wanted, wanted, 1e-10, work)
        else:
            found, mu = march(x, y, tube, course, cell, start, start, direction, mu, first, wanted, 1e-10, work)
            if found == OK and start[3] != p:
                actual = guide.cell_along(tube, 0.5)
                found, mu = march(x, y, tube, course, actual, start, load, direction, mu, wanted, wanted, 1e-10, work)
        if found != OK:
            return found, 0, 0, 0.0, load
        status, _, doublings, _ = nested.solve(
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube, load,
            nested.HELD, direction, wanted, mu, regrades, accuracy, fine, work, table, out,
        )  # fmt: skip
        if status == newton.CONVERGED or status == nested.UNREACHED or not buckled:
            break
    if status != newton.CONVERGED and status != nested.UNREACHED:
        vanishing = pushed(y, held.loaded(load, direction, mu))
        return (COMPRESSED if vanishing else NOT_CONVERGED), 0, 0, 0.0, load
    now = held.loaded(load, direction, out[0, nested.MULTIPLIER])
    if not now[3] + now[4] > 0.0:  # at the clamped ends, where y = 1
        return COMPRESSED, 0, 0, 0.0, load
    unstable = unstable_directions(fine[0], fine[1], base << doublings, base, tube, now, direction, space[5], work)
    out[0, nested.MULTIPLIER] *= scale
    out[1, nested.MULTIPLIER] *= scale
    return (OK if status == newton.CONVERGED else INACCURATE), unstable, doublings, mu, now


@kernel
def tuple_times(values, factor):
    """A load direction times a number."""
    return (0.0, 0.0, 0.0, 0.0, factor * values[4], factor * values[5], 0.0)


@entry_point
def hold_many(
    problem, pressures, others, targets, kind, buckled, course, edges, places, accuracy, values, bounds, status, stable,
    slack, stations, profiles,
):  # fmt: skip
    """Held states of one design, for arrays of pressure, of the load that is not unknown, and of the held quantity.

    The n-th entries belong together. ``targets`` are in radii (deformed length) or radians, of the whole tube; a tube that
    is the same all along is solved by half (``edges`` and ``places`` of one segment), unless ``buckled``. ``values`` and
    ``bounds`` are (n, 6): length, volume, twist, energy of half the tube, stretch in the middle, multiplier.
    """
    base = edges[len(edges) - 1]
    size = (base << nested.MAX_DOUBLINGS) + 2
    half = len(places) == 2
    middle = base if half else edges[np.argmin(np.abs(places - 0.5 * places[len(places) - 1]))]
    cells = np.zeros((1 if half and course.shape[1] == 1 else size, 3))
    space = (
        np.zeros((5, size)), np.zeros((13, 2 * size)), np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS)),
        np.zeros((5, size)), np.zeros((2, base + 1)), np.zeros((3, 2 * size)),
    )  # fmt: skip
    out = np.zeros((4, nested.OUTPUTS))
    for i in range(len(pressures)):
        for k in range(6):
            values[i, k], bounds[i, k] = np.nan, np.nan
        for j in range(len(stations)):
            for k in range(FIELDS):
                profiles[i, k, j] = np.nan
        slack[i], stable[i] = 0, 0
        tube = (course.copy(), edges, cells, half, middle, places)
        target = 0.5 * targets[i] if half else targets[i]
        status[i], unstable, doublings, _, now = find(
            problem, pressures[i], others[i], target, kind, buckled, course, tube, accuracy, space, out
        )
        if status[i] == OK or status[i] == INACCURATE:
            for k in range(6):
                share = 0.5 if not half and k < 4 else 1.0
                values[i, k], bounds[i, k] = share * out[0, k], share * out[1, k]
            stable[i] = 1 if unstable == 0 else 0
            slack[i] = slack_fibers(space[0][0], space[0][1], base << doublings, base, tube, now)
            if len(stations) > 0:
                at_stations(stations, base, doublings, tube, now, space[0], space[3], profiles[i])

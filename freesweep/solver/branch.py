"""The walk: one design, its equilibria at rising pressures, on the branch that starts at the undeformed cylinder.

First leg: pressure, force, torque and fiber extension - 1 rise in proportion up to the smallest pressure asked for at
which the meridional resultant is a tension. Second leg: the pressure alone. The uniform tube guides (``uniform.py``):
where it is carried without a turning point, the shape is solved directly and must lie between 1 and the uniform stretch.
Elsewhere the walk climbs in small steps of the quantity conjugate to the load (the volume, for a rising pressure), which
rises through a turning point: no jump to another branch is possible, and the turning point itself is the limit pressure.

Here physics and numerics are bound together.
"""

import numpy as np

from . import guide, lagrangian, nested, newton, uniform
from .climb import CLIMB_CHANGE, NEARLY_FLAT, climb, creep
from .course import fill
from .jit import entry_point, inlined, kernel
from .mesh import cell_at
from .profile import FIELDS, at_stations
from .status import BEYOND_LIMIT, COMPRESSED, INACCURATE, INVALID, NOT_CONVERGED, OK

# columns of a problem: what one design is, dimensionless
PROBLEM_SIZE = 9
H, D, AREA, GAMMA, RATIO, SHEAR, FORCE, TORQUE, LENGTH = range(PROBLEM_SIZE)

COLD_REGRADES, WARM_REGRADES = 3, 1
WARM, COLD, SLOW, LAST_STEP = 0, 1, 2, 3
TENSIONLESS = 1e-9  # of the load: a fiber family without tension does not push
TENSIONLESS_END = 1e-3  # at a clamped end, where the slope is carried on from the cells beside
FLAT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def slack_fibers(x, y, n, base, tube, load):
    """Bit 1: the alpha family would have to push somewhere; bit 2: the beta family."""
    course, edges, cells, free, _, _ = tube
    own = fill(course, edges, x, n, base, cells)
    flag = 0
    for j in range(-1, n + 1):
        if 0 <= j < n:
            v, middle = (y[j + 1] - y[j]) / (x[j + 1] - x[j]), 0.5 * (y[j] + y[j + 1])
        elif j == n and free:
            continue
        else:  # a clamped end itself, with the slope carried on from the two cells next to it
            i, k = (0, 1) if j < 0 else (n - 1, n - 2)
            near, after = (y[i + 1] - y[i]) / (x[i + 1] - x[i]), (y[k + 1] - y[k]) / (x[k + 1] - x[k])
            h = x[i + 1] - x[i]
            v, middle = near + (near - after) * h / (h + x[k + 1] - x[k]), y[0 if j < 0 else n]
        cell = cell_at(own, min(max(j, 0), n - 1))
        if v * v < 1.0 + lagrangian.kinematics(middle, cell, load)[3]:
            alpha, beta = lagrangian.fiber_multipliers(middle, v, cell, load)
            least = -(TENSIONLESS if 0 <= j < n else TENSIONLESS_END) * (load[3] + abs(load[4]))
            flag |= (1 if alpha < least else 0) | (2 if beta < least else 0)
    return flag


@inlined
def reach(x, y, last_x, last_y, u, scratch, reached, started, tube, before, load, accuracy, space, out):
    """The state at ``load``, from the last one at ``before``: the quick ways first, then the slow one.

    Returns ``(status, doublings, limit pressure, its bound)``.
    """
    fine, work, table = space[0], space[1], space[2]
    start, way, goal, mu = before, WARM, nested.PLAIN, 0.0
    direction = FLAT
    limit, limit_bound = np.nan, np.nan
    flat, shapes = NEARLY_FLAT, space[4]
    for i in range(len(x)):
        shapes[4, i], shapes[5, i] = last_x[i], last_y[i]
    if reached < 1.0:
        way = SLOW
    elif not started:
        way = COLD
    while True:
        regrades = WARM_REGRADES
        if way == COLD:
            guide.start(tube, u, load, x, y)
            regrades = COLD_REGRADES
        elif way == SLOW:
            start = before
            if started:
                for i in range(len(x)):
                    x[i], y[i] = shapes[4, i], shapes[5, i]
            else:
                part = guide.begin(tube, load, scratch[0], scratch[1], x, y)
                if part == 0.0:
                    return NOT_CONVERGED, 0, limit, limit_bound
                start = uniform.between((1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0), load, part)
            status, mu = OK, 1.0
            if start[0] != load[0]:
                status, _ = creep(x, y, tube, start, load, work)
                if status == BEYOND_LIMIT:
                    return status, 0, limit, limit_bound
            else:
                status, mu = climb(x, y, tube, start, load, flat, work)
            if status == BEYOND_LIMIT:
                goal = nested.TURNING_POINT
                regrades = 0  # the climb has graded the mesh; close to a turning point no other is safe
                direction = (0.0, 0.0, 0.0, load[3] - start[3], load[4] - start[4], load[5] - start[5], 0.0)
            elif status != OK:
                return status, 0, limit, limit_bound
            for i in range(len(x)):
                last_x[i], last_y[i] = x[i], y[i]
        from_load = load if goal == nested.PLAIN else start
        status, unstable, doublings, _ = nested.solve(
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube,
            from_load, goal, direction, 0.0, mu if goal == nested.TURNING_POINT else 0.0, regrades, accuracy, fine,
            work, table, out,
        )  # fmt: skip
        solved = status == newton.CONVERGED or status == nested.UNREACHED
        if goal == nested.TURNING_POINT:
            if not solved:
                if flat == 0.0:
                    return NOT_CONVERGED, 0, limit, limit_bound
                goal, direction, way, flat = nested.PLAIN, FLAT, SLOW, 0.0  # hardly rising, but no turning point: go on
                continue
            if out[0, nested.MULTIPLIER] < 1.0:
                limit = start[3] + out[0, nested.MULTIPLIER] * direction[3]
                return BEYOND_LIMIT, 0, limit, out[1, nested.MULTIPLIER] * direction[3]
            # the turning point lies just beyond: the state asked for is one step away
            goal, direction, way = nested.PLAIN, FLAT, LAST_STEP
            for i in range(len(x)):
                x[i], y[i] = last_x[i], last_y[i]
            continue
        if solved and unstable == 0:
            guided = way == WARM or way == COLD
            if (guided and not guide.strays(y, u)) or (
                not guided and abs(y[tube[4]] / last_y[tube[4]] - 1.0) < 3.0 * CLIMB_CHANGE
            ):
                return (OK if status == newton.CONVERGED else INACCURATE), doublings, limit, limit_bound
        if way == SLOW or way == LAST_STEP:
            return NOT_CONVERGED, 0, limit, limit_bound
        way = COLD if way == WARM else SLOW


@inlined
def walk(problem, tube, pressures, accuracy, space, values, bounds, status, slack, limit, stations, profiles):
    """Equilibria of one design at rising ``pressures``, on the branch that the module describes.

    Arguments
    ---------
    problem : (PROBLEM_SIZE,) the design, dimensionless
    tube : what varies along it, and where its base mesh begins, bends and ends: see :func:`nested.solve`
    pressures : (n,) p = P/C10, ascending; infinity is the locked shape, where the wall no longer counts
    accuracy : bound to reach, scaled
    values, bounds : (n, 5) length, volume, twist, energy of half the tube, stretch in the middle, and error bounds
    status, slack : (n,) codes; values are NaN unless the status is OK or INACCURATE
    limit : (2,) limit pressure and its bound, NaN if none was met
    stations, profiles : (m,), (n, FIELDS, m): see :func:`at_stations`; m = 0 for none
    """
    fine, shapes, guides = space[0], space[4], space[5]
    base = tube[1][len(tube[1]) - 1]
    x, y, last_x, last_y = shapes[0, : base + 1], shapes[1, : base + 1], shapes[2, : base + 1], shapes[3, : base + 1]
    places = 1 if tube[0].shape[0] == 1 and tube[0].shape[1] == 1 else guide.PLACES
    u, ahead, scratch = guides[0, :places], guides[1, :places], guides[2:, :places]
    share = 1.0 if tube[3] else 0.5
    half = 0.5 * problem[LENGTH]
    out = np.zeros((4, nested.OUTPUTS))
    gamma, f, m = problem[GAMMA], problem[FORCE], problem[TORQUE]
    before = (1.0, problem[RATIO], problem[SHEAR], 0.0, 0.0, 0.0, 1.0)
    started, guided, ended = False, True, OK
    clamped = 1.0
    for end in range(2):
        stretch = lagrangian.kinematics(1.0, guide.cell_along(tube, 1.0 * end), (gamma, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))[
            3
        ]
        clamped = min(clamped, 1.0 + stretch)
    for k in range(places):
        u[k] = 1.0
    limit[0], limit[1] = np.nan, np.nan
    for i in range(len(pressures)):
        p = pressures[i]
        slack[i] = 0
        for k in range(5):
            values[i, k], bounds[i, k] = np.nan, np.nan
        for j in range(len(stations)):
            for k in range(FIELDS):
                profiles[i, k, j] = np.nan
        if not (p >= 0.0 and clamped > 0.0):
            status[i] = INVALID
            continue
        locked = p == np.inf
        if p == 0.0 and f == 0.0 and m == 0.0:
            status[i] = OK
            values[i, 0], values[i, 1], values[i, 2], values[i, 3], values[i, 4] = half, half, 0.0, 0.0, 1.0
            for k in range(5):
                bounds[i, k] = 0.0
            continue
        if not p + f > 0.0:
            status[i] = COMPRESSED
            continue
        if ended != OK and not locked:
            status[i] = ended
            continue
        load = (gamma, problem[RATIO], problem[SHEAR], p, f, m, 1.0)
        if locked:
            load = (gamma, problem[RATIO], problem[SHEAR], 1.0, 0.0, 0.0, 0.0)
            guide.locked(tube, gamma, ahead)
            reached, started = 1.0, False
        elif guided:
            reached = guide.follow(tube, u, before, load, ahead)
        else:
            reached = 0.0
        if reached == 1.0 and started:
            guide.carry(u, ahead, x[base], x, y)
        found, doublings, fold, fold_bound = reach(
            x, y, last_x, last_y, ahead, scratch, reached, started, tube, before, load, accuracy, space, out
        )
        status[i] = found
        if found == OK or found == INACCURATE:
            for k in range(5):
                whole = share if k < 4 else 1.0
                values[i, k], bounds[i, k] = whole * out[0, k], whole * out[1, k]
            slack[i] = slack_fibers(fine[0], fine[1], base << doublings, base, tube, load)
            if len(stations) > 0:
                at_stations(stations, base, doublings, tube, load, fine, space[3], profiles[i])
            before, started, guided = load, True, reached == 1.0
            for k in range(places):
                u[k] = ahead[k]
            for k in range(base + 1):
                last_x[k], last_y[k] = x[k], y[k]
        elif not started and (found == COMPRESSED or found == NOT_CONVERGED):
            continue  # a higher pressure may hold the wall, or be easier to reach
        else:
            ended = found
            if found == BEYOND_LIMIT:
                # a turning point of the first leg, of part of the load, is no limit pressure
                alone = f == 0.0 and m == 0.0 and gamma == 1.0
                limit[0], limit[1] = (fold, fold_bound) if started or alone else (np.nan, np.nan)


@entry_point
def walk_many(
    problems,
    first,
    pressures,
    course,
    edges,
    places,
    accuracy,
    values,
    bounds,
    status,
    slack,
    limits,
    stations,
    profiles,
):
    """:func:`walk` for each row of ``problems``; problem k owns rows ``first[k]`` to ``first[k + 1]`` of all others.

    Tubes that vary share one ``course`` (segments, pieces, 3, 4) with ``places`` (segments + 1,), in radii, where the
    segments meet: one of them is the middle. A course without segments stands for tubes that are the same all along,
    half of each solved. ``edges`` (segments + 1,) are the nodes of the base mesh at those places.
    """
    base = edges[len(edges) - 1]
    size = (base << nested.MAX_DOUBLINGS) + 2
    table = np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS))
    varying = course.shape[0] > 0
    cells = np.zeros((size if varying else 1, 3))
    space = (
        np.zeros((5, size)), np.zeros((13, size)), table, np.zeros((5, size)), np.zeros((6, base + 1)),
        np.zeros((4, guide.PLACES)),
    )  # fmt: skip
    own_course = course if varying else np.zeros((1, 1, 3, 4))
    own_places = places.copy() if varying else np.zeros(2)
    middle = base
    for k in range(len(own_places)):
        if (
            varying
            and abs(own_places[k] - 0.5 * own_places[len(own_places) - 1]) < 1e-9 * own_places[len(own_places) - 1]
        ):
            middle = edges[k]
    for k in range(len(problems)):
        if not varying:
            own_places[1] = 0.5 * problems[k, LENGTH]
            for i in range(3):
                own_course[0, 0, i, 0] = problems[k, i]
        tube = (own_course, edges, cells, not varying, middle, own_places)
        own = slice(first[k], first[k + 1])
        walk(
            problems[k], tube, pressures[own], accuracy, space, values[own], bounds[own], status[own], slack[own],
            limits[k], stations, profiles[own],
        )  # fmt: skip

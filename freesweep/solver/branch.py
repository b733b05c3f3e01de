"""The walk: one design, its equilibria at rising pressures, on the branch that starts at the undeformed cylinder.

First leg: pressure, force, torque and fiber extension - 1 rise in proportion up to the smallest pressure asked for at
which the meridional resultant is a tension. Second leg: the pressure alone. The uniform tube guides (``uniform.py``):
where it is carried without a turning point, the shape is solved directly and must lie between 1 and the uniform stretch.
Elsewhere the walk climbs in small steps of the quantity conjugate to the load (the volume, for a rising pressure), which
rises through a turning point: no jump to another branch is possible, and the turning point itself is the limit pressure.

Here physics and numerics are bound together.
"""

from math import exp, sqrt

import numpy as np

from . import lagrangian, mesh, nested, newton, uniform
from .climb import CLIMB_CHANGE, climb, creep
from .held import loaded
from .jit import entry_point, inlined, kernel
from .mesh import cell_at
from .profile import FIELDS, at_stations, rest_profile
from .status import BEYOND_LIMIT, COMPRESSED, INACCURATE, INVALID, NOT_CONVERGED, OK

# columns of a problem: what one design is, dimensionless
PROBLEM_SIZE = 9
H, D, AREA, GAMMA, RATIO, SHEAR, FORCE, TORQUE, LENGTH = range(PROBLEM_SIZE)

COLD_REGRADES, WARM_REGRADES = 3, 1
WARM, COLD, SLOW, LAST_STEP = 0, 1, 2, 3
STRAY = 0.02  # share of |u - 1| by which a shape may leave the interval from 1 to the uniform stretch u
FIRST_STRAIN = 0.02  # |u - 1| at which a climb starts
FLAT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def first_shape(u, rate, x, y):
    """First guess: an exponential end layer whose slope can be met."""
    rate = min(rate, 0.9 / max(abs(u - 1.0), 1e-9))
    for i in range(len(x)):
        y[i] = 1.0 + (u - 1.0) * (1.0 - exp(-rate * x[i]))


@kernel
def start_shape(u, cells, load, half_length, x, y):
    """Mesh and first guess from the uniform stretch ``u``."""
    _, _, _, L_yy, _, L_vv = lagrangian.density(u, 0.0, cell_at(cells, 0), load)
    rate = sqrt(L_yy / L_vv)
    mesh.layer_mesh(half_length, rate, len(x) - 1, x)
    first_shape(u, rate, x, y)


@kernel
def strays(y, u):
    """Whether the shape leaves the interval from 1 to the uniform stretch: another branch."""
    slack = STRAY * abs(u - 1.0) + 1e-6
    low, high = min(1.0, u) - slack, max(1.0, u) + slack
    for i in range(len(y)):
        if not low <= y[i] <= high:
            return True
    return False


@kernel
def slack_fibers(x, y, n, cells, load):
    """Bit 1: the alpha family would have to push somewhere; bit 2: the beta family."""
    flag = 0
    for j in range(-1, n):
        if j < 0:  # the clamped end itself, with the slope carried on from the first two cells
            near = (y[1] - y[0]) / (x[1] - x[0])
            next_ = (y[2] - y[1]) / (x[2] - x[1])
            v, middle = near + (near - next_) * (x[1] - x[0]) / (x[2] - x[0]), y[0]
            if not v * v < 1.0 + lagrangian.kinematics(middle, cell_at(cells, 0), load)[3]:
                continue
        else:
            v, middle = (y[j + 1] - y[j]) / (x[j + 1] - x[j]), 0.5 * (y[j] + y[j + 1])
        alpha, beta = lagrangian.fiber_multipliers(middle, v, cell_at(cells, max(j, 0)), load)
        flag |= (1 if alpha < 0.0 else 0) | (2 if beta < 0.0 else 0)
    return flag


@inlined
def begin(x, y, cells, load, half_length):
    """A small part of the way to ``load`` and its first shape; returns that part, 0 where there is none."""
    rest = (1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0)
    part, u, reached = 1.0, 1.0, 0.0
    for _ in range(80):
        now = uniform.between(rest, load, part)
        u, reached = uniform.follow(lagrangian.density, 1.0, cell_at(cells, 0), rest, now)
        if reached == 1.0 and abs(u - 1.0) < FIRST_STRAIN:
            start_shape(u, cells, now, half_length, x, y)
            return part
        part *= 0.5
    return 0.0


@inlined
def reach(x, y, last_x, last_y, u, reached, started, cells, before, load, half, accuracy, space, out):
    """The state at ``load``, from the last one at ``before``: the quick ways first, then the slow one.

    Returns ``(status, doublings, limit pressure, its bound)``.
    """
    fine, work, table, _ = space
    start, way, goal, mu = before, WARM, nested.PLAIN, 0.0
    direction = FLAT
    limit, limit_bound = np.nan, np.nan
    if reached < 1.0:
        way = SLOW
    elif not started:
        way = COLD
    while True:
        regrades = WARM_REGRADES
        if way == COLD:
            start_shape(u, cells, load, half, x, y)
            regrades = COLD_REGRADES
        elif way == SLOW:
            if started:
                for i in range(len(x)):
                    x[i], y[i] = last_x[i], last_y[i]
            else:
                part = begin(x, y, cells, load, half)
                if part == 0.0:
                    return NOT_CONVERGED, 0, limit, limit_bound
                start = uniform.between((1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0), load, part)
            status, mu = OK, 1.0
            if start[0] != load[0]:
                status, _ = creep(x, y, True, cells, start, load, work)
                if status == BEYOND_LIMIT:
                    return status, 0, limit, limit_bound
            else:
                status, mu = climb(x, y, True, cells, start, load, work)
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
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, True, cells,
            from_load, goal, direction, 0.0, mu if goal == nested.TURNING_POINT else 0.0, regrades, accuracy, fine,
            work, table, out,
        )  # fmt: skip
        solved = status == newton.CONVERGED or status == nested.UNREACHED
        if goal == nested.TURNING_POINT:
            if not solved:
                return NOT_CONVERGED, 0, limit, limit_bound
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
            if (guided and not strays(y, u)) or (
                not guided and abs(y[len(y) - 1] / last_y[len(y) - 1] - 1.0) < 3.0 * CLIMB_CHANGE
            ):
                return (OK if status == newton.CONVERGED else INACCURATE), doublings, limit, limit_bound
        if way == SLOW or way == LAST_STEP:
            return NOT_CONVERGED, 0, limit, limit_bound
        way = COLD if way == WARM else SLOW


@inlined
def walk(problem, pressures, x, y, accuracy, space, values, bounds, status, slack, limit, stations, profiles):
    """Equilibria of one design at rising ``pressures``, on the branch that the module describes.

    Arguments
    ---------
    problem : (PROBLEM_SIZE,) the design, dimensionless
    pressures : (n,) p = P/C10, ascending; infinity is the locked shape, where the wall no longer counts
    x, y : (cells + 1,) scratch: base mesh of half the tube
    accuracy : bound to reach, scaled
    values, bounds : (n, 5) length, volume, twist, energy of the half tube, stretch in the middle, and error bounds
    status, slack : (n,) codes; values are NaN unless the status is OK or INACCURATE
    limit : (2,) limit pressure and its bound, NaN if none was met
    stations, profiles : (m,), (n, FIELDS, m): see :func:`at_stations`; m = 0 for none
    """
    fine = space[0]
    out = np.zeros((4, nested.OUTPUTS))
    cells = np.empty((1, 3))
    cells[0, 0], cells[0, 1], cells[0, 2] = problem[H], problem[D], problem[AREA]
    half = 0.5 * problem[LENGTH]
    gamma, f, m = problem[GAMMA], problem[FORCE], problem[TORQUE]
    rest = (1.0, problem[RATIO], problem[SHEAR], 0.0, 0.0, 0.0, 1.0)
    before, u, started, ended = rest, 1.0, False, OK
    last_x, last_y = np.zeros(len(x)), np.zeros(len(x))
    clamped = 1.0 + lagrangian.kinematics(1.0, cell_at(cells, 0), (gamma, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))[3]
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
            rest_profile(stations, cell_at(cells, 0), profiles[i])
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
            ahead, reached, started = lagrangian.locked_stretch(cell_at(cells, 0), gamma), 1.0, False
        elif u == u:
            ahead, reached = uniform.follow(lagrangian.density, u, cell_at(cells, 0), before, load)
        else:
            ahead, reached = u, 0.0
        if reached == 1.0 and started and abs(u - 1.0) > 1e-9:
            for k in range(len(y)):
                y[k] = 1.0 + (y[k] - 1.0) * (ahead - 1.0) / (u - 1.0)
        found, doublings, fold, fold_bound = reach(
            x, y, last_x, last_y, ahead, reached, started, cells, before, load, half, accuracy, space, out
        )
        status[i] = found
        if found == OK or found == INACCURATE:
            for k in range(5):
                values[i, k], bounds[i, k] = out[0, k], out[1, k]
            slack[i] = slack_fibers(fine[0], fine[1], (len(x) - 1) << doublings, cells, load)
            if len(stations) > 0:
                at_stations(stations, len(x) - 1, doublings, cells, load, fine, space[3], profiles[i])
            before, started = load, True
            u = ahead if reached == 1.0 else np.nan
            for k in range(len(x)):
                last_x[k], last_y[k] = x[k], y[k]
        elif found == COMPRESSED and not started:
            continue  # a higher pressure may hold the wall
        else:
            ended = found
            if found == BEYOND_LIMIT:
                limit[0], limit[1] = fold, fold_bound


@entry_point
def walk_many(
    problems, first, pressures, base_cells, accuracy, values, bounds, status, slack, limits, stations, profiles
):
    """:func:`walk` for each row of ``problems``; problem k owns rows ``first[k]`` to ``first[k + 1]`` of all others."""
    size = (base_cells << nested.MAX_DOUBLINGS) + 2
    table = np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS))
    space = np.zeros((5, size)), np.zeros((13, size)), table, np.zeros((5, size))
    x, y = np.zeros(base_cells + 1), np.zeros(base_cells + 1)
    for k in range(len(problems)):
        own = slice(first[k], first[k + 1])
        walk(
            problems[k], pressures[own], x, y, accuracy, space, values[own], bounds[own], status[own], slack[own],
            limits[k], stations, profiles[own],
        )  # fmt: skip

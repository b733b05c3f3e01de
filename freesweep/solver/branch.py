"""The walk: one tube that is the same all along, its equilibria at pressures that rise, or fall, along its one path of loads
(:mod:`load_path`): on the branch that starts at the undeformed cylinder.

The uniform tube guides (``uniform.py``): where it is carried without a turning point, the shape is solved directly and must
lie between 1 and the uniform stretch. Elsewhere the walk climbs in small steps of the quantity conjugate to the load (the
volume, for a rising pressure), which rises through a turning point: no jump to another branch is possible, and the turning
point itself is the limit pressure. Of a loaded tube the first state of each walk is the one at which its loads have settled;
where there is none, none follows.

Here physics and numerics are bound together.
"""

import numpy as np

from ..jit import entry_point, inlined, kernel
from . import guide, lagrangian, nested
from .drawing import draw
from .profile import FIELDS
from .reach import reach
from .slack import slack_fibers
from .status import BEYOND_LIMIT, COMPRESSED, INACCURATE, INVALID, NOT_CONVERGED, OK, PENDING

# columns of a problem: what one design is, dimensionless
PROBLEM_SIZE = 11
H, D, AREA, GAMMA, RATIO, SHEAR, FORCE, TORQUE, LENGTH, SECOND, THIRD = range(PROBLEM_SIZE)
MOONEY_RIVLIN, YEOH = (RATIO,), (RATIO, SECOND, THIRD)  # columns of a rubber's constants, over C10
FINER = 4  # times the cells of the base mesh, for a walk that did not converge


@kernel
def rubber_of(problem):
    """What :mod:`lagrangian` takes as a rubber: C01/C10, C2/C1, C3/C1."""
    return problem[RATIO], problem[SECOND], problem[THIRD]


@kernel
def workspace(base):
    """Scratch of :func:`walk` for a base mesh of ``base`` cells."""
    size = (base << nested.MAX_DOUBLINGS) + 2
    return (
        np.zeros((5, size)), np.zeros((13, size)), np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS)),
        np.zeros((5, size)), np.zeros((6, base + 1)), np.zeros((4, 1)),
    )  # fmt: skip


@inlined
def walk(problem, tube, pressures, accuracy, space, values, bounds, status, slack, limit, stations, profiles):
    """Equilibria of one design at ``pressures`` that rise, or fall, on the branch that the module describes.

    Rows whose status is not PENDING are passed over.

    Arguments
    ---------
    problem : (PROBLEM_SIZE,) the design, dimensionless
    tube : its cell, and where its base mesh begins and ends: see :func:`nested.solve`
    pressures : (n,) p = P/C10, monotone; infinity is the locked shape, where the wall no longer counts
    accuracy : bound to reach, scaled
    values, bounds : (n, 5) length, volume, twist, energy of half the tube, stretch in the middle, and error bounds
    status, slack : (n,) codes; values are NaN unless the status is OK or INACCURATE
    limit : (2,) limit pressure and its bound, NaN if none was met
    stations, profiles : (m,), (n, FIELDS, m): see :func:`profile.at_stations`; m = 0 for none
    """
    fine, shapes, guides = space[0], space[4], space[5]
    base = tube[1][len(tube[1]) - 1]
    x, y, last_x, last_y = shapes[0, : base + 1], shapes[1, : base + 1], shapes[2, : base + 1], shapes[3, : base + 1]
    u, ahead, scratch = guides[0], guides[1], guides[2:]
    half = 0.5 * problem[LENGTH]
    out = np.zeros((4, nested.OUTPUTS))
    gamma, f, m = problem[GAMMA], problem[FORCE], problem[TORQUE]
    alone = f == 0.0 and m == 0.0 and gamma == 1.0
    rubber, shear = rubber_of(problem), problem[SHEAR]
    before = (1.0, rubber, shear, 0.0, 0.0, 0.0, 1.0)
    started, guided, ended, middle = False, True, OK, 1.0
    clamped = 1.0 + lagrangian.kinematics(1.0, guide.cell_along(tube, 0.0), (gamma, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))[3]
    u[0] = 1.0
    limit[0], limit[1] = np.nan, np.nan
    passed = -1
    for i in range(len(pressures)):
        # the last state that is done already, and goes on to one that is not, is solved again
        if status[i] == OK and pressures[i] < np.inf and (pressures[i] > 0.0 or not alone):
            passed = i
        elif status[i] == PENDING and pressures[i] < np.inf:
            if passed >= 0:
                status[passed] = PENDING
            break
    for i in range(len(pressures)):
        p = pressures[i]
        if status[i] != PENDING:
            if status[i] == OK and p < np.inf and (p > 0.0 or not alone):  # on the same two legs
                load = (gamma, rubber, shear, p, f, m, 1.0)
                if guide.follow(tube, u, before, load, ahead) == 1.0:
                    before, u[0], middle = load, ahead[0], values[i, 4]
            continue
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
        load = (gamma, rubber, shear, p, f, m, 1.0)
        if locked:
            load = (gamma, rubber, shear, 1.0, 0.0, 0.0, 0.0)
            guide.locked(tube, gamma, ahead)
            reached, started = 1.0, False
        elif guided:
            reached = guide.follow(tube, u, before, load, ahead)
        else:
            reached = 0.0
        if reached == 1.0 and started:
            guide.carry(u, ahead, x[base], x, y)
        found, doublings, fold, fold_bound = reach(
            x, y, last_x, last_y, middle, ahead, scratch, reached, started, tube, before, load, accuracy, space, out
        )
        status[i] = found
        if found == OK or found == INACCURATE:
            for k in range(5):
                values[i, k], bounds[i, k] = out[0, k], out[1, k]
            slack[i] = slack_fibers(fine[0], fine[1], base << doublings, base, tube, load)
            if len(stations) > 0:
                drawn = draw(stations, base, doublings, tube, load, fine, space[3], space[1], accuracy, profiles[i])
                status[i] = found if drawn else INACCURATE
            before, started, guided, middle = load, True, reached == 1.0, out[0, nested.MIDDLE]
            u[0] = ahead[0]
            for k in range(base + 1):
                last_x[k], last_y[k] = x[k], y[k]
        elif not started and alone and (found == COMPRESSED or found == NOT_CONVERGED):
            continue  # a higher pressure may be easier to reach
        else:
            ended = found
            if found == BEYOND_LIMIT and (started or alone):  # that of loads that settle is no limit pressure
                limit[0], limit[1] = fold, fold_bound


@entry_point
def walk_many(
    problems, first, pressures, edges, accuracy, values, bounds, status, slack, limits, stations, profiles
):  # fmt: skip
    """:func:`walk` for each row of ``problems``; problem k owns rows ``first[k]`` to ``first[k + 1]`` of all others.

    Half of each tube is solved, on a base mesh of ``edges[-1]`` cells. A walk that does not converge there, where cells may
    be longer than an end layer, is walked again on a finer one.
    """
    space, cells = workspace(edges[len(edges) - 1]), np.zeros((1, 3))
    finer_space, has_finer = space, False  # large: made where it is needed
    course, places = np.zeros((1, 1, 3, 4)), np.zeros(2)
    for k in range(len(problems)):
        places[1] = 0.5 * problems[k, LENGTH]
        for i in range(3):
            course[0, 0, i, 0] = problems[k, i]
        own = slice(first[k], first[k + 1])
        if not np.any(status[own] == PENDING):
            limits[k, 0], limits[k, 1] = np.nan, np.nan
            continue
        for factor in (1, FINER):
            if factor == FINER and not has_finer:
                finer_space, has_finer = workspace(FINER * edges[len(edges) - 1]), True
            own_space = space if factor == 1 else finer_space
            tube = (course, factor * edges, cells, True, factor * edges[len(edges) - 1], places)
            walk(
                problems[k], tube, pressures[own], accuracy, own_space, values[own], bounds[own], status[own], slack[own],
                limits[k], stations, profiles[own],
            )  # fmt: skip
            if factor == FINER or not np.any((status[own] == NOT_CONVERGED) | (status[own] == INACCURATE)):
                break
            for i in range(first[k], first[k + 1]):
                status[i] = PENDING  # all of it again

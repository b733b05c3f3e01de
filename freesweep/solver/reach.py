"""From one state of a branch to the next: the quick ways first, then the slow one."""

import numpy as np

from ..jit import inlined
from . import guide, lagrangian, nested, newton, uniform
from .climb import CLIMB_CHANGE, NEARLY_FLAT, climb, creep, graded_for_turning
from .status import BEYOND_LIMIT, INACCURATE, NOT_CONVERGED, OK

COLD_REGRADES, WARM_REGRADES = 3, 1
WARM, COLD, SLOW, LAST_STEP = 0, 1, 2, 3
FLAT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


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
                regrades = 0  # close to a turning point no other mesh is safe
                direction = (0.0, 0.0, 0.0, load[3] - start[3], load[4] - start[4], load[5] - start[5], 0.0)
                graded_for_turning(x, y, len(x) - 1, tube, start, direction, mu, work)
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

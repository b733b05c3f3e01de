"""From one state of a branch to the next: the quick ways first, then the slow one."""

import numpy as np

from ..jit import inlined
from . import guide, lagrangian, meridian, nested, newton, quadrature, retrace, uniform
from .climb import CLIMB_CHANGE, NEARLY_FLAT, climb, creep, graded_for_turning
from .status import BEYOND_LIMIT, INACCURATE, NOT_CONVERGED, OK

COLD_REGRADES, WARM_REGRADES = 3, 1
WARM, COLD, STEEP, INTEGRATED, SLOW, LAST_STEP = 0, 1, 2, 3, 4, 5


@inlined
def reach(x, y, last_x, last_y, middle, u, scratch, reached, started, tube, before, load, accuracy, space, out):
    """The state at ``load``, from the last one at ``before``, with stretch ``middle`` in the middle: the quick ways first.

    Returns ``(status, doublings, limit pressure, its bound)``.
    """
    fine, work, table = space[0], space[1], space[2]
    start, way, goal, mu = before, WARM, nested.PLAIN, 0.0
    direction = retrace.FLAT
    flat, shapes, lost = NEARLY_FLAT, space[4], NOT_CONVERGED
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
        elif way == STEEP:
            regrades = 0  # its mesh is that of the shape itself
            if not meridian.start(tube, u, load, x, y, space[3], work):
                way = INTEGRATED
        if way == INTEGRATED:
            status, doublings = quadrature.solve(
                tube, u[0], u[0], load, len(x) - 1, accuracy, fine, space[3], table, out
            )
            if status != NOT_CONVERGED:
                return status, doublings, np.nan, np.nan
            way = SLOW
        if way == SLOW:
            start = before
            status, mu = OK, 1.0
            if started:
                for i in range(len(x)):
                    x[i], y[i] = shapes[4, i], shapes[5, i]
            else:
                part = guide.begin(tube, load, scratch[0], scratch[1], x, y)
                start = uniform.between((1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0), load, part)
                status = OK if part > 0.0 else NOT_CONVERGED
            if status == OK and start[0] != load[0]:
                status, _ = creep(x, y, tube, start, load, work)
                if status == BEYOND_LIMIT:  # steps may die out for another reason: the tracer decides, if it can
                    lost, status = BEYOND_LIMIT, NOT_CONVERGED
            elif status == OK:
                status, mu = climb(x, y, tube, start, load, flat, work)
            if status == BEYOND_LIMIT:
                goal = nested.TURNING_POINT
                regrades = 0  # close to a turning point no other mesh is safe
                direction = (0.0, 0.0, 0.0, load[3] - start[3], load[4] - start[4], load[5] - start[5], 0.0)
                graded_for_turning(x, y, len(x) - 1, tube, start, direction, mu, work)
            elif status == NOT_CONVERGED:
                break
            elif status != OK:
                return status, 0, np.nan, np.nan
            for i in range(len(x)):
                last_x[i], last_y[i] = x[i], y[i]
        caution = retrace.CAUTION if way == STEEP else 1.0
        from_load = load if goal == nested.PLAIN else start
        status, unstable, doublings, _ = nested.solve(
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube,
            from_load, goal, direction, 0.0, mu if goal == nested.TURNING_POINT else 0.0, regrades, accuracy / caution,
            fine, work, table, out,
        )  # fmt: skip
        for k in range(nested.OUTPUTS):
            out[1, k] *= caution
        solved = status == newton.CONVERGED or status == nested.UNREACHED
        if status == nested.UNREACHED and way < STEEP:
            way = STEEP
            continue
        if goal == nested.TURNING_POINT:
            if not solved:
                if flat == 0.0:
                    break
                # hardly rising, but no turning point: go on
                goal, direction, way, flat = nested.PLAIN, retrace.FLAT, SLOW, 0.0
                continue
            if out[0, nested.MULTIPLIER] < 1.0:
                limit = start[3] + out[0, nested.MULTIPLIER] * direction[3]
                bound = abs(out[1, nested.MULTIPLIER] * direction[3]) + retrace.LIMIT_ROUNDING * limit
                return BEYOND_LIMIT, 0, limit, bound
            # the turning point lies just beyond: the state asked for is one step away
            goal, direction, way = nested.PLAIN, retrace.FLAT, LAST_STEP
            for i in range(len(x)):
                x[i], y[i] = last_x[i], last_y[i]
            continue
        if solved and unstable == 0:
            guided = way <= STEEP
            if guided:
                shape = fine[1, : ((len(x) - 1) << doublings) + 1]
                found = not guide.strays(shape, u, out[0, nested.MIDDLE], tube, load)
            else:
                found = abs(y[tube[4]] / last_y[tube[4]] - 1.0) < 3.0 * CLIMB_CHANGE
            if found:
                status = OK if status == newton.CONVERGED else INACCURATE
                if way >= STEEP:
                    status, doublings = quadrature.sharpen(
                        x, y, tube, u[0] if guided else np.nan, load, accuracy, fine, space[3], table, out, status,
                        doublings,
                    )  # fmt: skip
                return status, doublings, np.nan, np.nan
        if way >= SLOW:
            break
        way = INTEGRATED if way == STEEP else COLD if way == WARM else STEEP
    return retrace.retrace(x, y, middle, lost, tube, before, load, accuracy, space, out)

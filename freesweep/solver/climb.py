"""The slow way along a branch: steps of the quantity conjugate to the load, which rises through a turning point.

For a rising pressure that quantity is the volume. Held at each step, it leaves no room for a jump to another branch. Where
it has all but stopped growing, as near lock, the load itself is stepped.
"""

import numpy as np

from ..jit import inlined, kernel
from . import lagrangian, nested, newton, uniform
from .course import at_point, fill
from .held import hold, largest_change, loaded, solve_held, strayed, turning_point
from .status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK

CLIMB_CHANGE = 0.06  # relative change of y in one step
CLIMB_STEPS = 400
TOLERANCE = 1e-10  # of states on the way
CLOSING = 1.2  # times what is left of the way, by the linear prediction: the last step passes the end
SMALLEST_SHRINK = 1e-3  # of a step, before the climb is given up
NEARLY_FLAT = 1e-3  # of the first slope dmu/dC: as good as a turning point
WELL_BEFORE = 0.05  # of the first slope: a safe start for the search of a turning point
LEAST_SHARE = 0.02  # of a step, however close the slope's zero seems
LEAST_GAIN, MOST_GAIN, ROUNDING_GAIN = 0.95, 1.05, 1e-9
NO_SNAP = 1e-4  # relative change of y under which nothing can snap
SMALLEST_CREEP = 1e-6  # of the way
CREPT_NEAR = 1e-3  # of the way: a turning point so close is what stopped the steps
PUSHED = 0.02  # share of its largest part to which the resultant p y^2 + f has fallen where a climb ends in it


@kernel
def pushed(y, load):
    """Whether the meridional resultant p y^2 + f has all but vanished somewhere."""
    for i in range(len(y)):
        part = load[3] * y[i] * y[i]
        if part + load[4] < PUSHED * max(abs(part), abs(load[4])):
            return True
    return False


@kernel
def largest_drift(y, other):
    """Largest relative difference of two shapes on the same nodes."""
    largest = 0.0
    for i in range(len(y)):
        largest = max(largest, abs(y[i] - other[i]) / other[i])
    return largest


@kernel
def smooth(gain, first, last):
    """Whether the multiplier's ``gain`` in a step lies between those that the slopes at its ends promise: where it does
    not, the step may have passed over two turning points, a small snap.
    """
    slack = ROUNDING_GAIN * max(1.0, abs(gain))
    return LEAST_GAIN * min(first, last) - slack <= gain <= MOST_GAIN * max(first, last) + slack


@kernel
def hops(middle, other, tube, start, end):
    """Whether a step of a tube that is the same all along, its ends far, may have passed over a small snap of the uniform
    tube, which its middle follows.
    """
    if abs(other - middle) < uniform.SCAN * middle:
        return False
    cell, half = at_point(tube[0], 0, 0.0), tube[5][1]
    for y in (middle, other):
        _, L_yy, L_vv = uniform.slope_at(lagrangian.density, y, 1.0, cell, start, end)
        if not uniform.is_far(L_yy, L_vv, half):
            return False
    return uniform.dips(lagrangian.density, middle, other, cell, start, end, half, lagrangian.drawn_in(cell, end))


@kernel
def regraded(x, y, n, tube, load, work):
    """Adapt the mesh to the solution, unless that would leave the solution inadmissible."""
    old_x, old_y = work[10], work[11]
    for i in range(n + 1):
        old_x[i], old_y[i] = x[i], y[i]
    if not nested.adapt(lagrangian.density, lagrangian.integrands, x, y, n, tube, load, work):
        for i in range(n + 1):
            x[i], y[i] = old_x[i], old_y[i]


@kernel
def respond(n, free, work):
    """``sigma = dC/dmu`` at a state that :func:`newton.solve` has just found, whose factors it left in ``work``; the change
    of y per unit of mu goes to ``work[9]``. ``work[8]`` holds -dC/dy.
    """
    b, response = work[8], work[9]
    last = n if free else n - 1
    newton.substitute(work[3], work[2], 1, last, b, response)
    response[0] = 0.0
    response[n] = response[n] if free else 0.0
    sigma = 0.0
    for i in range(1, last + 1):
        sigma += b[i] * response[i]
        response[i] = -response[i]
    return sigma


@kernel
def graded_for_turning(x, y, n, tube, start, direction, mu, work):
    """Grade the mesh by the shape at the turning point, and carry over ``y``, a state before it."""
    course, edges, cells, free, _, _ = tube
    old_x, first_y = np.empty(n + 1), np.empty(n + 1)
    for i in range(n + 1):
        old_x[i], first_y[i] = x[i], y[i]
    status, limit = turning_point(
        lagrangian.density, lagrangian.conjugate, x, y, n, free, fill(course, edges, x, n, n, cells), start, direction,
        mu, TOLERANCE, work,
    )  # fmt: skip
    if status == newton.CONVERGED:
        now = loaded(start, direction, limit)
        nested.adapt(lagrangian.density, lagrangian.integrands, x, y, n, tube, now, work)
        j = 0
        for i in range(n + 1):
            while j < n - 1 and old_x[j + 1] < x[i]:
                j += 1
            y[i] = first_y[j] + (x[i] - old_x[j]) * (first_y[j + 1] - first_y[j]) / (old_x[j + 1] - old_x[j])
        own = fill(course, edges, x, n, n, cells)
        if newton.admissible(lagrangian.density, x, y, n, own, loaded(start, direction, mu)):
            return
    for i in range(n + 1):
        x[i], y[i] = old_x[i], first_y[i]


@inlined
def climb(x, y, tube, start, end, flat, work):
    """Follow the branch from load ``start`` (solved: x, y) toward ``end`` in steps of the conjugate quantity.

    ``flat`` is the share of the first slope dmu/dC that counts as a turning point: NEARLY_FLAT or, where the search found
    none there, 0. Returns ``(status, fraction of the way)``: OK with y close to the solution at the end, BEYOND_LIMIT with
    a state well before a turning point, COMPRESSED where the meridional resultant falls to zero, else NOT_CONVERGED.
    """
    n = len(x) - 1
    course, edges, cells, free, _, _ = tube
    direction = (0.0, 0.0, 0.0, end[3] - start[3], end[4] - start[4], end[5] - start[5], 0.0)
    kept_y, response = np.empty(n + 1), np.empty(n + 1)
    safe_x, safe_y = np.empty(n + 1), np.empty(n + 1)
    kept_mu, kept_target, kept_sigma, safe_mu = 0.0, 0.0, 1.0, 0.0
    first_slope, trend = 1.0, 0.0
    mu, target, change, shrink, stepping, started, by_load = 0.0, 0.0, 0.0, 1.0, False, False, False
    for _ in range(CLIMB_STEPS):
        own = fill(course, edges, x, n, n, cells)
        if by_load:
            now = loaded(start, direction, mu)
            status, unstable, _, _ = newton.solve(
                lagrangian.density, x, y, n, free, own, now, newton.UNKNOWN, TOLERANCE, work
            )
            target = hold(lagrangian.conjugate, x, y, n, own, now, direction, work[8])
            sigma = respond(n, free, work)
        else:
            if not stepping:
                target = hold(lagrangian.conjugate, x, y, n, own, loaded(start, direction, mu), direction, work[8])
            status, unstable, mu, sigma = solve_held(
                lagrangian.density, lagrangian.conjugate, x, y, n, free, own, start, direction, mu, target, TOLERANCE,
                newton.MAX_ITERATIONS, work,
            )  # fmt: skip
        solved = status == newton.CONVERGED
        if solved and (sigma <= 0.0 or unstable > 0 or (stepping and mu < kept_mu)):
            for i in range(n + 1):
                x[i], y[i] = safe_x[i], safe_y[i]
            return (BEYOND_LIMIT if started else NOT_CONVERGED), safe_mu
        if solved and not stepping:
            slope = 1.0 / sigma
            if not started:
                first_slope = slope
            elif slope < flat * first_slope:
                for i in range(n + 1):
                    x[i], y[i] = safe_x[i], safe_y[i]
                return BEYOND_LIMIT, safe_mu
            if not started or slope > WELL_BEFORE * first_slope:
                for i in range(n + 1):
                    safe_x[i], safe_y[i] = x[i], y[i]
                safe_mu = mu
            trend = (slope - 1.0 / kept_sigma) / (target - kept_target) if started else 0.0
            by_load = by_load and trend > 0.0
            for i in range(n + 1):
                kept_y[i], response[i] = y[i], work[9, i]
            kept_mu, kept_target, kept_sigma, started = mu, target, sigma, True
        elif (
            solved
            and strayed(y, n, kept_y, response, change) < CLIMB_CHANGE
            and not hops(kept_y[n], y[n], tube, start, end)
            and (
                smooth(mu - kept_mu, (target - kept_target) / kept_sigma, (target - kept_target) / sigma)
                or (by_load and largest_drift(y, kept_y) < NO_SNAP)
            )
        ):
            if mu >= 1.0:
                for i in range(n + 1):
                    y[i] = kept_y[i] + (y[i] - kept_y[i]) * (1.0 - kept_mu) / (mu - kept_mu)
                return OK, 1.0
            shrink = min(1.0, 1.5 * shrink)
            regraded(x, y, n, tube, loaded(start, direction, mu), work)
            stepping = False
            continue
        elif stepping and not by_load and trend > 0.0:
            by_load = True  # the slope grows, as near lock: what is held has all but stopped growing
        else:
            shrink *= 0.5
            by_load = False
            if shrink < SMALLEST_SHRINK or not stepping:
                last = loaded(start, direction, kept_mu)
                if not started:
                    return NOT_CONVERGED, mu
                for i in range(n + 1):
                    x[i], y[i] = safe_x[i], safe_y[i]
                # stuck: at a turning point of many modes (long tubes), unless the wall went slack
                return (COMPRESSED if pushed(kept_y, last) else BEYOND_LIMIT), safe_mu
        change = shrink * CLIMB_CHANGE / largest_change(kept_y, response, n)  # of mu, to first order
        change = min(change, CLOSING * (1.0 - kept_mu))
        if trend < 0.0:  # mu may stop rising where the slope 1/sigma would reach zero: halve the way there, not pass it
            change = min(change, max(-0.5 / (trend * kept_sigma * kept_sigma), LEAST_SHARE * change))
        for i in range(n + 1):
            y[i] = kept_y[i] + change * response[i]
        mu, target, stepping = kept_mu + change, kept_target + change * kept_sigma, True
    return NOT_CONVERGED, mu


@inlined
def creep(x, y, tube, start, end, work):
    """As :func:`climb`, in steps along the line between two loads that differ in fiber extension too.

    At a turning point the shape changes as the root of the way that is left: the inverse square of its speed falls in a
    straight line to zero there. Where the steps die out elsewhere, the solver has failed: NOT_CONVERGED.
    """
    n = len(x) - 1
    course, edges, cells, free, _, _ = tube
    kept_y = np.empty(n + 1)
    t, step = 0.0, 0.1
    at, slowness, left = 0.0, 0.0, 1.0  # middle of the last step, 1/speed^2 there, way to the turning point
    while t < 1.0:
        for i in range(n + 1):
            kept_y[i] = y[i]
        ahead = min(1.0, t + step)
        now = uniform.between(start, end, ahead)
        status, unstable, _, _ = newton.solve(
            lagrangian.density, x, y, n, free, fill(course, edges, x, n, n, cells), now, newton.UNKNOWN, TOLERANCE, work
        )
        drift = largest_drift(y, kept_y)
        if status == newton.CONVERGED and unstable == 0 and drift < CLIMB_CHANGE:
            middle, before = 0.5 * (t + ahead), slowness
            slowness = ((ahead - t) / max(drift, 1e-300)) ** 2
            left = slowness * (middle - at) / (before - slowness) - (ahead - middle) if slowness < before else 1.0
            t, step, at = ahead, 1.5 * step, middle
            regraded(x, y, n, tube, uniform.between(start, end, t), work)
            continue
        for i in range(n + 1):
            y[i] = kept_y[i]
        step *= 0.5
        if step < SMALLEST_CREEP:
            if pushed(y, uniform.between(start, end, t)):
                return COMPRESSED, t
            return (BEYOND_LIMIT if left < CREPT_NEAR else NOT_CONVERGED), t
    return OK, 1.0

"""The slow way along a branch: steps of the quantity conjugate to the load, which rises through a turning point.

For a rising pressure that quantity is the volume. Held at each step, it leaves no room for a jump to another branch.
"""

import numpy as np

from . import lagrangian, nested, newton, uniform
from .held import MOST_GAIN, hold, largest_change, loaded, solve_held, strayed
from .jit import inlined, kernel
from .status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK

CLIMB_CHANGE = 0.06  # relative change of y in one step
CLIMB_STEPS = 400
TOLERANCE = 1e-10  # of states on the way
CLOSING = 1.2  # times what is left of the way, by the linear prediction: the last step passes the end
SMALLEST_SHRINK = 1e-3  # of a step, before the climb is given up
SMALLEST_CREEP = 1e-6  # of the way
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
def regraded(x, y, n, free, cells, load, work):
    """Adapt the mesh to the solution, unless that would leave the solution inadmissible."""
    old_x, old_y = work[10], work[11]
    for i in range(n + 1):
        old_x[i], old_y[i] = x[i], y[i]
    if not nested.adapt(lagrangian.density, lagrangian.integrands, x, y, n, free, cells, load, work):
        for i in range(n + 1):
            x[i], y[i] = old_x[i], old_y[i]


@inlined
def climb(x, y, free, cells, start, end, work):
    """Follow the branch from load ``start`` (solved: x, y) toward ``end`` in steps of the conjugate quantity.

    Returns ``(status, fraction of the way)``: OK with y close to the solution at the end, BEYOND_LIMIT with a state well
    before a turning point, COMPRESSED where the meridional resultant falls to zero, NOT_CONVERGED otherwise.
    """
    n = len(x) - 1
    direction = (0.0, 0.0, 0.0, end[3] - start[3], end[4] - start[4], end[5] - start[5], 0.0)
    kept_x, kept_y, response = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    safe_x, safe_y = np.empty(n + 1), np.empty(n + 1)
    kept_mu, kept_target, kept_sigma, safe_mu = 0.0, 0.0, 0.0, 0.0
    mu, target, change, shrink, stepping, started = 0.0, 0.0, 0.0, 1.0, False, False
    for _ in range(CLIMB_STEPS):
        if not stepping:
            target = hold(lagrangian.conjugate, x, y, n, cells, loaded(start, direction, mu), direction, work[8])
        status, unstable, mu, sigma = solve_held(
            lagrangian.density,
            lagrangian.conjugate,
            x,
            y,
            n,
            free,
            cells,
            start,
            direction,
            mu,
            target,
            TOLERANCE,
            work,
        )
        solved = status == newton.CONVERGED
        if solved and (sigma <= 0.0 or unstable > 0 or (stepping and mu < kept_mu)):
            for i in range(n + 1):
                x[i], y[i] = safe_x[i], safe_y[i]
            return (BEYOND_LIMIT if started else NOT_CONVERGED), safe_mu
        if solved and not stepping:
            for i in range(n + 1):
                safe_x[i], safe_y[i] = (kept_x[i], kept_y[i]) if started else (x[i], y[i])
                kept_x[i], kept_y[i], response[i] = x[i], y[i], work[9, i]
            safe_mu = kept_mu if started else mu
            kept_mu, kept_target, kept_sigma, started = mu, target, sigma, True
        elif solved and mu - kept_mu < MOST_GAIN * change and strayed(y, n, kept_y, response, change) < CLIMB_CHANGE:
            if mu >= 1.0:
                for i in range(n + 1):
                    y[i] = kept_y[i] + (y[i] - kept_y[i]) * (1.0 - kept_mu) / (mu - kept_mu)
                return OK, 1.0
            shrink = min(1.0, 1.5 * shrink)
            regraded(x, y, n, free, cells, loaded(start, direction, mu), work)
            stepping = False
            continue
        else:
            shrink *= 0.5
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
        for i in range(n + 1):
            y[i] = kept_y[i] + change * response[i]
        mu, target, stepping = kept_mu + change, kept_target + change * kept_sigma, True
    return NOT_CONVERGED, mu


@inlined
def creep(x, y, free, cells, start, end, work):
    """As :func:`climb`, in steps along the line between two loads that differ in fiber extension too."""
    n = len(x) - 1
    kept_y = np.empty(n + 1)
    t, step = 0.0, 0.1
    while t < 1.0:
        for i in range(n + 1):
            kept_y[i] = y[i]
        ahead = min(1.0, t + step)
        now = uniform.between(start, end, ahead)
        status, unstable, _ = newton.solve(
            lagrangian.density, x, y, n, free, cells, now, newton.UNKNOWN, TOLERANCE, work
        )
        if status == newton.CONVERGED and unstable == 0 and largest_drift(y, kept_y) < CLIMB_CHANGE:
            t, step = ahead, 1.5 * step
            regraded(x, y, n, free, cells, uniform.between(start, end, t), work)
            continue
        for i in range(n + 1):
            y[i] = kept_y[i]
        step *= 0.5
        if step < SMALLEST_CREEP:
            return (COMPRESSED if pushed(y, uniform.between(start, end, t)) else BEYOND_LIMIT), t
    return OK, 1.0

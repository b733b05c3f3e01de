"""One integral held: Newton's method with its multiplier as one more unknown, and turning points.

With ``C = sum h c(y_mid, slope)`` held at a target t, the load ``mu`` conjugate to it (c = dL/dmu) is unknown::

    [ H    b ] [ dy  ]     [ g     ]
    [ b^T  0 ] [ dmu ] = - [ C - t ],    b = -dC/dy

solved with two tridiagonal solutions. ``sigma = b^T H^-1 b = dC/dmu`` along the branch: positive as long as the branch is
stable under given loads; through a turning point of mu, 1/sigma falls smoothly through zero.
"""

from ..jit import kernel
from .mesh import cell_at
from .newton import (
    CONVERGED,
    INFEASIBLE,
    MAX_HALVINGS,
    MAX_ITERATIONS,
    STALLED,
    UNKNOWN,
    assemble,
    factor,
    new_rate,
    settled,
    substitute,
)

FIRST_CHANGE = 1e-3  # relative change of y of the first step of the search for a turning point
SEARCH_STEPS = 80
MOST_GAIN = 1.5  # of the multiplier, times the larger of the two linear predictions: more is another branch
MOST_STRAY = 0.03  # relative difference from the linear prediction: more is another branch
LARGEST_GROWTH = 3.0  # of the step from one to the next
OVERSHOOT = 1.2  # times the way to where the slope would vanish: the search wants both sides
TURNING_GAIN = 1e-8  # of mu between the two sides, relative: the cubic between them is exact to rounding then
ROUNDING_GAIN = 1e-11  # of mu
SMALLEST_SHARE = 1e-13  # of the held integral


@kernel
def loaded(load, direction, mu):
    """The load changed by ``mu`` along ``direction``, component by component; the rubber stays."""
    return (
        load[0] + mu * direction[0],
        load[1],
        load[2] + mu * direction[2],
        load[3] + mu * direction[3],
        load[4] + mu * direction[4],
        load[5] + mu * direction[5],
        load[6] + mu * direction[6],
    )


@kernel
def hold(conjugate, x, y, n, cells, load, direction, b):
    """The held integral C, and its gradient as ``b = -dC/dy``."""
    total = 0.0
    b[0] = 0.0
    for j in range(n):
        h = x[j + 1] - x[j]
        c, c_y, c_v = conjugate(0.5 * (y[j] + y[j + 1]), (y[j + 1] - y[j]) / h, cell_at(cells, j), load, direction)
        total += h * c
        b[j] -= 0.5 * h * c_y - c_v
        b[j + 1] = -(0.5 * h * c_y + c_v)
    return total


@kernel
def solve_held(density, conjugate, x, y, n, free, cells, load, direction, mu, target, tolerance, iterations, work):
    """Newton, at most so many ``iterations``, for ``y`` (in place) and the multiplier ``mu`` of ``direction``, with the
    conjugate integral held.

    Returns ``(status, unstable directions that keep the integral, mu, sigma)``; ``work[9]`` is left with the change of y
    per unit of mu. ``direction`` is to be scaled so that mu is of order 1.
    """
    g, d, e, inverse, step, trial, room, least = work[0], work[1], work[2], work[3], work[4], work[5], work[6], work[7]
    b, response = work[8], work[9]
    first, last = 1, n if free else n - 1
    for i in range(n + 1):
        trial[i] = y[i]
        least[i] = 0.0
    size, before, rate, fraction, change, sigma = 1e300, 1e300, UNKNOWN, 0.0, 0.0, 0.0
    made, halvings = 0, 0
    while made < iterations and halvings < MAX_HALVINGS:
        now = loaded(load, direction, mu + fraction * change)
        if not assemble(density, x, trial, n, cells, now, False, least, room, g, d, e):
            if made == 0:
                return INFEASIBLE, 0, mu, 0.0
            fraction *= 0.5
            halvings += 1
            for i in range(n + 1):
                trial[i] = y[i] + fraction * step[i]
            continue
        before = size if fraction == 1.0 else 1e300
        mu += fraction * change
        for i in range(n + 1):
            y[i], least[i] = trial[i], room[i]
        negative = factor(d, e, first, last, inverse)
        value = hold(conjugate, x, y, n, cells, now, direction, b)
        substitute(inverse, e, first, last, g, step)
        substitute(inverse, e, first, last, b, response)
        response[0] = 0.0
        response[n] = response[n] if free else 0.0
        sigma, lag = 0.0, 0.0
        for i in range(first, last + 1):
            response[i] = -response[i]
            sigma -= b[i] * response[i]
            lag += b[i] * step[i]
        # dC = sigma dmu: a held change of C moves mu by change / sigma
        change = (target - value - lag) / sigma
        size = abs(change) / max(1.0, abs(mu))
        step[0] = 0.0
        step[n] = step[n] if free else 0.0
        for i in range(1, n + 1):
            step[i] = change * response[i] - step[i]
            size = max(size, abs(step[i]) / y[i])
        rate = new_rate(rate, size, before)
        for i in range(n + 1):
            trial[i] = y[i] + step[i]
        if settled(size, before, rate, tolerance):
            for i in range(n + 1):
                y[i] = trial[i]
            return CONVERGED, negative - (1 if sigma < 0.0 else 0), mu + change, sigma
        fraction, halvings, made = 1.0, 0, made + 1
    return STALLED, 1, mu, 0.0


@kernel
def largest_change(y, response, n):
    """Largest relative change of y that ``response`` makes."""
    largest = 0.0
    for i in range(n + 1):
        largest = max(largest, abs(response[i]) / y[i])
    return largest


@kernel
def strayed(y, n, start, response, change):
    """Largest relative difference of ``y`` from its linear prediction."""
    largest = 0.0
    for i in range(n + 1):
        expected = start[i] + change * response[i]
        largest = max(largest, abs(y[i] - expected) / abs(expected))
    return largest


@kernel
def turning_point(density, conjugate, x, y, n, free, cells, load, direction, mu, tolerance, work):
    """The turning point of ``mu`` nearest along the branch through ``y``: ``(status, multiplier)``.

    Steps of the held integral C toward it until the slope dmu/dC = 1/sigma changes sign, then false position (Illinois)
    between. Only states are taken that are stable while C is held and close to their linear prediction. The nearest of
    them on this side is left in ``y``, the first in ``work[12]``.
    """
    near_y, near_response, first_y = work[10], work[11], work[12]
    target = hold(conjugate, x, y, n, cells, loaded(load, direction, mu), direction, work[8])
    status, _, mu, sigma = solve_held(
        density, conjugate, x, y, n, free, cells, load, direction, mu, target, tolerance, MAX_ITERATIONS, work
    )
    if status != CONVERGED:
        return status, mu
    near, near_slope, near_mu = target, 1.0 / sigma, mu
    far, far_slope, far_mu = 0.0, 0.0, 0.0
    near_weight, far_weight = 1.0, 1.0
    for i in range(n + 1):
        first_y[i], near_y[i], near_response[i] = y[i], y[i], work[9, i] * near_slope
    # a positive slope lies before the turning point: step toward it, whichever side this is
    step = FIRST_CHANGE * sigma / largest_change(y, work[9], n)
    between, status = False, STALLED
    for _ in range(SEARCH_STEPS):
        target = near + step
        for i in range(n + 1):
            y[i] = near_y[i] + step * near_response[i]
        found, unstable, mu, sigma = solve_held(
            density, conjugate, x, y, n, free, cells, load, direction, near_mu, target, tolerance, MAX_ITERATIONS, work
        )
        slope = 1.0 / sigma
        gain = MOST_GAIN * max(abs(slope), abs(near_slope)) * abs(step) + ROUNDING_GAIN * max(1.0, abs(near_mu))
        if (
            found != CONVERGED
            or unstable > 0
            or abs(mu - near_mu) > gain
            or strayed(y, n, near_y, near_response, step) > MOST_STRAY
        ):
            step *= 0.25  # back to the last good state, and not so far
            if abs(step) < SMALLEST_SHARE * abs(near):
                break
            continue
        if slope * near_slope > 0.0:
            bend = (slope - near_slope) / step
            growth = LARGEST_GROWTH * step
            full = -OVERSHOOT * slope / bend if bend * slope * step < 0.0 else growth
            if not between:
                step = full if abs(full) < abs(growth) else growth
            near, near_slope, near_mu = target, slope, mu
            near_weight, far_weight = 1.0, 0.5 * far_weight
            for i in range(n + 1):
                near_y[i], near_response[i] = y[i], work[9, i] * slope
        else:
            far, far_slope, far_mu, between = target, slope, mu, True
            far_weight, near_weight = 1.0, 0.5 * near_weight
        if between:
            width = far - near
            # the tangent bounds mu from above
            if near_slope * width < TURNING_GAIN * max(1.0, abs(near_mu)) or abs(width) < SMALLEST_SHARE * abs(near):
                t = near_slope / (near_slope - far_slope)  # top of the cubic through values and slopes at both ends
                rest = 1.0 - t
                mu = (1.0 + 2.0 * t) * rest * rest * near_mu + t * t * (3.0 - 2.0 * t) * far_mu
                mu += t * rest * width * (rest * near_slope - t * far_slope)
                status = CONVERGED
                break
            step = width * near_weight * near_slope / (near_weight * near_slope - far_weight * far_slope)
    for i in range(n + 1):
        y[i] = near_y[i]
    return status, mu


@kernel
def solve(density, conjugate, x, y, n, free, cells, load, direction, mu, target, turning, tolerance, work):
    """Solve with the conjugate integral held at ``target``, or, if ``turning``, find the turning point of ``mu``.

    Returns ``(status, unstable directions, mu)``. ``y`` is changed in place, but for a turning point: that is no safe start
    on another mesh.
    """
    if turning:
        status, mu = turning_point(density, conjugate, x, y, n, free, cells, load, direction, mu, tolerance, work)
        if status == CONVERGED:
            for i in range(n + 1):
                y[i] = work[12, i]
        return status, 0, mu
    status, unstable, mu, _ = solve_held(
        density, conjugate, x, y, n, free, cells, load, direction, mu, target, tolerance, MAX_ITERATIONS, work
    )
    return status, unstable, mu

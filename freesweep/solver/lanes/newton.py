"""Damped Newton of :mod:`freesweep.solver.numerics.newton` on a vector of designs, each with its own mesh.

One pass assembles the gradient and the Hessian of -J cell by cell, factors it and eliminates forward; a second one
substitutes back. Every decision is a mask: a lane that has converged, or failed, is not touched again, whatever the
others need.
"""

from ...jit import kernel
from ..numerics.newton import SMALL_STEP
from .vector import HUGE, get, mask_of, put, select, some, spread

MAX_ITERATIONS = 30
SHRINK = 0.85  # of a first guess toward y = 1, where every state is admissible
SMALLEST_FRACTION = 1e-6  # of a step
LARGEST_SHARE = 0.9  # of the room of a cell that a step may take, by the linear model
CAUTION, SOFTNESS = 3.0, 10.0  # how far Newton's model is off: the room that a step takes, and its own size


@kernel
def eliminate(density, x, y, step, fraction, convex, n, free, cell, load, ratio, value, steepness):
    """Newton's equations at ``y + fraction step``, factored, eliminated forward into ``ratio`` and ``value``.

    Returns ``(admissible, definite, slope along the step, slope of the new step, last value)``; node 0 is held, node n
    unless ``free``. ``steepness`` takes the relative loss of room of each cell per difference of the step at its ends. In
    ``convex`` lanes whatever makes a cell's own Hessian indefinite is dropped.
    """
    bent = some(convex)
    zero = spread(0.0)
    below, carried, along, decline = zero, zero, zero, zero
    g_left, d_left = zero, zero
    fits, definite = fraction == fraction, fraction == fraction
    x_left, y_left, step_left = get(x, 0), get(y, 0), zero
    for j in range(n):
        x_right, step_right = get(x, j + 1), get(step, j + 1)
        y_right = get(y, j + 1) + fraction * step_right
        h = x_right - x_left
        per_h = 1.0 / h
        v = (y_right - y_left) * per_h
        middle = 0.5 * (y_left + y_right)
        room, L_y, L_v, L_yy, L_yv, L_vv = density(middle, v, cell, load)
        fits = fits & (min(room, middle) > 0.0)  # a NaN counts as no room
        put(steepness, j, 2.0 * v * per_h / room)
        if bent:
            L_yy = select(convex, min(L_yy, L_yv * L_yv / L_vv), L_yy)
        half = 0.5 * h * L_y
        corner = 0.25 * h * L_yy
        stiff = L_vv * per_h
        e = stiff - corner
        if j > 0:
            g = g_left - half + L_v
            pivot = d_left - corner + L_yv - stiff - below
            per_pivot = 1.0 / pivot
            b = g - carried
            below = e * e * per_pivot
            carried = e * b * per_pivot
            put(ratio, j, e * per_pivot)
            put(value, j, b * per_pivot)
            along = along + g * step_left
            decline = decline - b * b * per_pivot
            definite = definite & (pivot > 0.0)
        g_left = -half - L_v
        d_left = -corner - L_yv - stiff
        x_left, y_left, step_left = x_right, y_right, step_right
    last = zero
    if free:
        pivot = d_left - below
        b = g_left - carried
        last = b / pivot
        along = along + g_left * step_left
        decline = decline - b * last
        definite = definite & (pivot > 0.0)
    return fits, definite, along, decline, last


@kernel
def substitute(y, step, fraction, n, accepted, ratio, value, steepness, last):
    """Accept ``y + fraction step`` where told, with the new step from there.

    Returns that step's relative size, and the largest share of the room of a cell that it takes: how far Newton's model of
    the functional is off.
    """
    s, outer = last, last
    largest, longest, share = spread(1.0), spread(0.0), spread(0.0)
    for k in range(n):
        i = n - k
        if k > 0:
            outer, s = s, get(value, i) - get(ratio, i) * s
            share = max(share, abs(get(steepness, i) * (outer - s)))
        old = get(step, i)
        here = get(y, i) + select(accepted, fraction, spread(0.0)) * old
        put(y, i, here)
        put(step, i, select(accepted, -s, old))
        largest = max(largest, here)
        longest = max(longest, abs(s))
    share = max(share, abs(get(steepness, 0) * s))
    return longest / largest, share


@kernel
def solve(density, x, y, n, free, cell, load, active, safe, patient, small, tolerance, work):
    """From ``y`` (changed in place in ``active`` lanes) to a relative error of ``tolerance``, the last step below ``small``.
    A lane whose ``y`` is not admissible starts from ``safe``, if that is not either from a shape ever closer to y = 1; it
    fails at once unless the solver is ``patient``.

    Returns ``(converged, error)``: masks, and what the last step may have left. ``work`` is scratch (4, > n, WIDTH).
    """
    step, ratio, value, steepness = work[0], work[1], work[2], work[3]
    for i in range(n + 1):
        put(step, i, 0.0)
    fraction, size, slope, error = spread(0.0), spread(HUGE), spread(0.0), spread(0.0)
    todo, converged, convex = active, mask_of(0), mask_of(0)
    for iteration in range(MAX_ITERATIONS):
        fits, definite, along, decline, last = eliminate(
            density, x, y, step, fraction, convex, n, free, cell, load, ratio, value, steepness
        )
        fresh = fraction == 0.0
        outside = todo & fresh & ~fits
        if not patient:
            todo = todo & ~outside
        elif some(outside):
            toward = select(outside, spread(SHRINK), spread(1.0))
            for i in range(n + 1):
                here = get(y, i)
                if iteration == 0:
                    put(y, i, select(outside, get(safe, i), here))
                else:
                    put(y, i, 1.0 + toward * (here - 1.0))
        # shorten a long step until its slope says that the valley's floor was not overshot by much
        overshot = (size >= SMALL_STEP) & (along > -0.9 * slope)
        good = todo & fits & (fresh | ~overshot)
        accepted = good & (definite | convex)
        before = select((fraction == 1.0) & ~convex, size, spread(HUGE))
        now, share = substitute(y, step, fraction, n, accepted, ratio, value, steepness, last)
        size, slope = select(accepted, now, size), select(accepted, decline, slope)
        fraction = select(accepted, min(LARGEST_SHARE / share, 1.0), select(good, fraction, 0.5 * fraction))
        ahead = CAUTION * size * (share + SOFTNESS * size)
        rounded = (size < 1e-9) & (size > 0.3 * before)
        settled = accepted & ~convex & (size < small) & ((ahead < tolerance) | rounded)
        error = select(settled, min(ahead, size), error)
        converged = converged | settled
        hopeless = (good & convex & ~definite) | (~fresh & (fraction < SMALLEST_FRACTION))
        todo = todo & ~settled & ~hopeless
        convex = good & ~accepted
        if not some(todo):
            break
    for i in range(n + 1):
        here = get(y, i)
        put(y, i, select(converged, here + get(step, i), here))
    return converged, error

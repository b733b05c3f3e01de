"""A point of a way: Newton's method for a shape, its multiplier and the share t of the way, one of which is pinned.

On a way load and held integral C are functions of t. Where t is pinned this is an ordinary held state. Where it is the
stretch y_k of a node that moves fast, t is unknown, and the same equations stay regular through a turning point of t::

    [ H    b   c          ] [ dy  ]     [ g          ]
    [ b^T  0   C_t - T_t  ] [ dmu ] = - [ C - T(t)   ],   b = -dC/dy,  c = dg/dt
    [ e^T  0   0          ] [ dt  ]     [ y_k - value ]

with three tridiagonal solutions. A way may also have nothing held, ``mu`` being 0: there the second row is dmu = 0.
"""

from ..jit import kernel
from . import held, lagrangian
from .course import blend, fill
from .newton import (
    CONVERGED,
    INFEASIBLE,
    MAX_HALVINGS,
    STALLED,
    UNKNOWN,
    assemble,
    factor,
    new_rate,
    settled,
    substitute,
)  # fmt: skip
from .uniform import between

SHARE_STEP = 1e-5  # of t, for slopes along it
BY_SHARE = -1  # node that stands for t pinned
ITERATIONS = 12  # a step that needs more is too long


@kernel
def at_share(way, tube, x, n, base, t):
    """Cells of a mesh of n cells, nested in one of ``base`` cells, and the load, at a share ``t`` of the way.

    ``way`` is (load at its start, at its end, held integral at its start, at its end, direction of the multiplier, whether
    it is held, course, cell, blending): where it is ``blending``, the tube is ``cell`` all along at its start.
    """
    if way[8]:
        blend(way[6], way[7], t, tube[0])
    return fill(tube[0], tube[1], x, n, base, tube[2]), between(way[0], way[1], t)


@kernel
def slopes_by_share(x, y, n, base, tube, way, t, mu, work):
    """``c = dg/dt`` into ``work[10]``; returns C_t."""
    direction = way[4]
    own, load = at_share(way, tube, x, n, base, t + SHARE_STEP)
    now = held.loaded(load, direction, mu)
    assemble(lagrangian.density, x, y, n, own, now, False, work[6], work[6], work[10], work[11], work[12])
    after, _ = held.hold(lagrangian.conjugate, x, y, n, own, now, direction, work[11])
    own, load = at_share(way, tube, x, n, base, t - SHARE_STEP)
    now = held.loaded(load, direction, mu)
    assemble(lagrangian.density, x, y, n, own, now, False, work[6], work[6], work[4], work[11], work[12])
    before, _ = held.hold(lagrangian.conjugate, x, y, n, own, now, direction, work[11])
    for i in range(n + 1):
        work[10, i] = (work[10, i] - work[4, i]) / (2.0 * SHARE_STEP)
    return (after - before) / (2.0 * SHARE_STEP)


@kernel
def solve(x, y, n, base, tube, way, k, value, t, mu, tolerance, work):
    """Newton from ``y`` (changed in place), ``mu`` and ``t``; the stretch of node ``k`` is ``value``, or t is where that is
    BY_SHARE.

    Returns ``(status, unstable directions, mu, t, mu's and t's part of the tangent)``; ``work[12]`` takes the shape's. The
    largest part of the tangent, relative, is 1; its sign is any.
    """
    g, d, e, inverse, step, trial, room, least = work[0], work[1], work[2], work[3], work[4], work[5], work[6], work[7]
    b, of_mu, of_t, tangent = work[8], work[9], work[11], work[12]
    direction, keeps, free = way[4], way[5], tube[3]
    last = n if free else n - 1
    if k != BY_SHARE:
        y[k] = value
    for i in range(n + 1):
        trial[i], least[i] = y[i], 0.0
    size, before, rate, fraction, change, ahead = 1e300, 1e300, UNKNOWN, 0.0, 0.0, 0.0
    made, halvings = 0, 0
    while made < ITERATIONS and halvings < MAX_HALVINGS:
        own, load = at_share(way, tube, x, n, base, t + fraction * ahead)
        now = held.loaded(load, direction, mu + fraction * change)
        if not assemble(lagrangian.density, x, trial, n, own, now, False, least, room, g, d, e):
            if made == 0:
                return INFEASIBLE, 0, mu, t, 0.0, 0.0
            fraction *= 0.5
            halvings += 1
            for i in range(n + 1):
                trial[i] = y[i] + fraction * step[i]
            continue
        before = size if fraction == 1.0 else 1e300
        mu += fraction * change
        t += fraction * ahead
        for i in range(n + 1):
            y[i], least[i] = trial[i], room[i]
        negative = factor(d, e, 1, last, inverse)
        total, sigma = held.hold(lagrangian.conjugate, x, y, n, own, now, direction, b)
        total_t = slopes_by_share(x, y, n, base, tube, way, t, mu, work)
        substitute(inverse, e, 1, last, g, step)
        substitute(inverse, e, 1, last, b, of_mu)
        substitute(inverse, e, 1, last, work[10], of_t)
        for row in (step, of_mu, of_t):
            row[0] = 0.0
            row[n] = row[n] if free else 0.0
        by_t, miss = 0.0, 0.0
        for i in range(1, last + 1):
            sigma += b[i] * of_mu[i]
            by_t += b[i] * of_t[i]
            miss += b[i] * step[i]
        if keeps:
            by_t += total_t - (way[3] - way[2])
            miss += total - (way[2] + t * (way[3] - way[2]))
        else:
            sigma, by_t, miss = 1.0, 0.0, 0.0
        if k == BY_SHARE:
            change, ahead = -miss / sigma, 0.0
        else:
            lag = value - y[k] + step[k]
            determinant = of_mu[k] * by_t - of_t[k] * sigma
            change = (-lag * by_t + of_t[k] * miss) / determinant
            ahead = (lag * sigma - of_mu[k] * miss) / determinant
        size = max(abs(change) / max(1.0, abs(mu)), abs(ahead))
        for i in range(1, n + 1):
            step[i] = -(step[i] + of_mu[i] * change + of_t[i] * ahead)
            size = max(size, abs(step[i]) / y[i])
        rate = new_rate(rate, size, before)
        for i in range(n + 1):
            trial[i] = y[i] + step[i]
        if settled(size, before, rate, tolerance):
            largest = abs(sigma)
            for i in range(n + 1):
                y[i] = trial[i]
                tangent[i] = of_mu[i] * by_t - of_t[i] * sigma
                largest = max(largest, abs(tangent[i]) / y[i])
            for i in range(n + 1):
                tangent[i] /= largest
            held_one = 1 if keeps and sigma < 0.0 else 0
            return CONVERGED, negative - held_one, mu + change, t + ahead, -by_t / largest, sigma / largest
        fraction, halvings, made = 1.0, 0, made + 1
    return STALLED, 1, mu, t, 0.0, 0.0

"""One integral held: Newton's method with its multiplier as one more unknown.

With ``C = sum h c(y_mid, slope)`` held at a target t, the load ``mu`` conjugate to it (c = dL/dmu) is unknown::

    [ H    b ] [ dy  ]     [ g     ]
    [ b^T -k ] [ dmu ] = - [ t - C ],    b = -dC/dy,  k = dC/dmu where y stays (0 where J is linear in mu)

solved with two tridiagonal solutions. ``sigma = k + b^T H^-1 b = dC/dmu`` along the branch: positive as long as the branch
is stable under given loads; through a turning point of mu, 1/sigma falls smoothly through zero.
"""

from typing import NamedTuple

from ...jit import kernel
from ..cells import cell_at, of_length
from ..load import NO_CHANGE, Load, loaded
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
    system_in,
)


class Target(NamedTuple):
    """What is held while a state is solved, if ``any``thing is: the integral conjugate to the load ``direction``, at a
    ``value``. The direction is to be scaled so that its multiplier mu is of order 1.
    """

    direction: Load
    value: float
    any: bool


NOTHING = Target(NO_CHANGE, 0.0, False)


@kernel
def hold(conjugate, x, y, n, cells, load, direction, b):
    """The held integral C, its gradient as ``b = -dC/dy``, and k: ``(C, k)``."""
    total, k = 0.0, 0.0
    b[0] = 0.0
    for j in range(n):
        h = x[j + 1] - x[j]
        c, c_y, c_v, c_mu = conjugate(
            0.5 * (y[j] + y[j + 1]), (y[j + 1] - y[j]) / h, of_length(cell_at(cells, j), h), load, direction
        )
        total += h * c
        k += h * c_mu
        b[j] -= 0.5 * h * c_y - c_v
        b[j + 1] = -(0.5 * h * c_y + c_v)
    return total, k


@kernel
def solve_held(functional, y, mesh, load, target, mu, tolerance, work):
    """Newton's method for ``y`` (in place) and the multiplier ``mu`` of the :class:`Target`.

    Returns ``(status, unstable directions that keep the integral, mu)``.
    """
    (x, n, free, cells), direction, system = mesh, target.direction, system_in(work)
    g, d, e, inverse, step, trial, room, least = system
    b, response = work[8], work[9]  # and the change of y per unit of mu
    first, last = 1, n if free else n - 1
    for i in range(n + 1):
        trial[i] = y[i]
        least[i] = 0.0
    size, before, rate, fraction, change, sigma = 1e300, 1e300, UNKNOWN, 0.0, 0.0, 0.0
    made, halvings = 0, 0
    while made < MAX_ITERATIONS and halvings < MAX_HALVINGS:
        now = loaded(load, direction, mu + fraction * change)
        if not assemble(functional.density, x, trial, n, cells, now, False, system):
            if made == 0:
                return INFEASIBLE, 0, mu
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
        value, sigma = hold(functional.conjugate, x, y, n, cells, now, direction, b)
        substitute(inverse, e, first, last, g, step)
        substitute(inverse, e, first, last, b, response)
        response[0] = 0.0
        response[n] = response[n] if free else 0.0
        lag = 0.0
        for i in range(first, last + 1):
            response[i] = -response[i]
            sigma -= b[i] * response[i]
            lag += b[i] * step[i]
        # dC = sigma dmu: a held change of C moves mu by change / sigma
        change = (target.value - value - lag) / sigma
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
            return CONVERGED, negative - (1 if sigma < 0.0 else 0), mu + change
        fraction, halvings, made = 1.0, 0, made + 1
    return STALLED, 1, mu

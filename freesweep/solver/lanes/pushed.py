"""Along how much of a piece of half a tube fibers that may push would have to, for a vector of designs.

Such fibers leave no corner: pull and length are polynomials through the places of the rule. Where the pull changes its sign
between two places, it ends near the root of its polynomial, from which two steps of the secant lead to its end; up to there
the other is summed.
"""

from ...jit import kernel
from ..cells import nothing_yet
from .meridian import look
from .rule import COEFFICIENTS, INTEGRALS, LAST, PLACES, missed_within, summed
from .slack_ends import CLOSE, STEPS, SURE, narrowed, pulls, trial
from .vector import get, isnt, mask_of, put, select, some, spread

NEAR, NONE = 1e-5, 1e-300  # of a piece: places beside a root


@kernel
def expand(matrix, row, series):
    """Coefficients in Chebyshev polynomials, to ``series`` (> rows of the matrix, WIDTH)."""
    for i in range(len(matrix)):
        total = spread(0.0)
        for k in range(LAST + 1):
            total = total + matrix[i, k] * get(row, k)
        put(series, i, total)


@kernel
def evaluate(series, count, t):
    """The sum of so many Chebyshev polynomials at the share t of the piece, by Clenshaw's recurrence."""
    x = 2.0 * t - 1.0
    here = before = spread(0.0)
    for i in range(count - 1, 0, -1):
        here, before = 2.0 * x * here - before + get(series, i), here
    return x * here - before + get(series, 0)


@kernel
def next_end(pull, taken):
    """``(left, right, pull before, pull behind, place, lanes)`` of the first change of sign behind the place ``taken``."""
    zero, none = spread(0.0), mask_of(0)
    left, right, before, behind, place, there = zero, spread(1.0), zero, zero, taken, none
    for k in range(LAST):
        here, ahead = get(pull, k), get(pull, k + 1)
        fresh = isnt(there) & (taken < k) & ((here > 0.0) & (ahead <= 0.0) | (here <= 0.0) & (ahead > 0.0))
        left, right = select(fresh, PLACES[k], left), select(fresh, PLACES[k + 1], right)
        before, behind = select(fresh, here, before), select(fresh, ahead, behind)
        place, there = select(fresh, spread(1.0 * k), place), there | fresh
    return left, right, before, behind, place, there


@kernel
def root(series, left, right, before, behind, going):
    """Where the polynomial of the ``series`` is none between two shares of the piece."""
    t, far, last, of_far, of_last = right, left, right, before, behind
    for i in range(STEPS):
        new = trial(i, far, last, of_far, of_last, going)
        moved, t = abs(new - t), select(going, new, t)
        going = going & (moved > CLOSE)
        if not some(going):
            break
        pull = evaluate(series, LAST + 1, t)
        far, of_far = narrowed(pull, far, last, of_far, of_last)
        last, of_last = t, pull
    return t


@kernel
def end_of(family, t, steep, left, right, first, width, mid, cell, load, scratch):
    """``(where the pull of a family ends, by how much that may be off)`` between two shares of a piece: two steps of the
    secant from ``t``, near which the pull is as ``steep``.
    """
    before, pulled = t, spread(0.0)
    for i in range(2):
        alpha, beta = pulls(look(first + width * t, mid, cell, load, nothing_yet(t), scratch).at, load)
        pull = alpha if family == 0 else beta
        if i > 0:
            moved = abs(t - before) > 0.0
            steep = select(moved, (pull - pulled) / select(moved, t - before, 1.0), steep)
        before, pulled = t, pull
        t = t - pull / select(abs(steep) > NONE, steep, 1.0)
        t = min(max(t, left), right)
    return t, abs(t - before)


@kernel
def length(family, pull, dx, series, first, width, mid, cell, load, scratch):
    """``(length, what may be wrong of it)`` along which a ``family`` (0, 1), whose row is ``pull``, would have to push in a
    piece of that ``width`` from a ``first`` share of the depth on; x grows by the row ``dx`` along it. ``series`` (2, > LAST
    + 1, WIDTH) is scratch.
    """
    slack, (whole, missed) = get(pull, LAST) <= 0.0, summed(dx)
    total, doubt, taken = select(slack, whole, 0.0), select(slack, missed, 0.0), spread(-1.0)
    left, right, before, behind, taken, there = next_end(pull, taken)
    if not some(there):
        return total, doubt
    expand(COEFFICIENTS, pull, series[0])
    expand(INTEGRALS, dx, series[1])
    within, most = missed_within(dx), spread(0.0)
    for k in range(LAST + 1):
        most = max(most, get(dx, k))
    for _ in range(LAST):
        t = root(series[0], left, right, before, behind, there)
        steep = (evaluate(series[0], LAST + 1, t + NEAR) - evaluate(series[0], LAST + 1, t - NEAR)) / (2.0 * NEAR)
        t, off = end_of(family, t, steep, left, right, first, width, mid, cell, load, scratch)
        up_to = evaluate(series[1], LAST + 2, t)
        total = total + select(there, select(behind > 0.0, up_to, -up_to), 0.0)
        doubt = doubt + select(there, within + (off + SURE) * most, 0.0)
        left, right, before, behind, taken, there = next_end(pull, taken)
        if not some(there):
            break
    return total, doubt

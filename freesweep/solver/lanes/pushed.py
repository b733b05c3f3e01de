"""Along how much of a piece of half a tube fibers that may push would have to, for a vector of designs.

Such fibers leave no corner: pull and length are polynomials through the places of the rule. Where the pull changes its sign
between two places, it ends at the root of its polynomial; up to there the other is summed.
"""

from ...jit import kernel
from .rule import COEFFICIENTS, INTEGRALS, LAST, LATE, PLACES, largest, missed_within
from .vector import get, isnt, mask_of, put, select, some, spread

STEPS, CLOSE = 40, 1e-14  # of the search for a root; its last step, of the piece
NONE = 1e-300


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
def root(series, left, right, before, behind, going):
    """Where the polynomial of the ``series`` ends between two shares of the piece: the regula falsi of Anderson and Bjorck."""
    t = spread(right)
    left, right = spread(left), spread(right)
    for i in range(STEPS):
        new = right - behind * (right - left) / select(going, behind - before, 1.0)
        halved = mask_of(-1 if i % 3 == 2 else 0)
        new = select((new > left) & (new < right) & isnt(halved), new, 0.5 * (left + right))
        moved = abs(new - t)
        t = select(going, new, t)
        going = going & (moved > CLOSE)
        if not some(going):
            break
        pull = evaluate(series, LAST + 1, t)
        same = pull * behind > 0.0
        share = 1.0 - pull / select(same, behind, before)
        share = select(share > 0.0, share, 0.5)
        before, behind = select(same, before * share, pull), select(same, pull, behind * share)
        left, right = select(same, left, t), select(same, t, right)
    return t


@kernel
def length(pull, dx, series, whole, missed):
    """``(length, what may be wrong of it)`` of a piece along which the row ``pull`` is none, where x grows by the row ``dx``,
    by the ``whole`` in all, of which so much may be ``missed``. ``series`` (2, > LAST + 1, WIDTH) is scratch.
    """
    slack = get(pull, LAST) <= 0.0
    total, doubt, known = select(slack, whole, 0.0), select(slack, missed, 0.0), False
    for k in range(LAST):
        before, behind = get(pull, k), get(pull, k + 1)
        begins, ends = (before <= 0.0) & (behind > 0.0), (before > 0.0) & (behind <= 0.0)
        if not some(begins | ends):
            continue
        if not known:
            expand(COEFFICIENTS, pull, series[0])
            expand(INTEGRALS, dx, series[1])
            known = True
        up_to = evaluate(series[1], LAST + 2, root(series[0], PLACES[k], PLACES[k + 1], before, behind, begins | ends))
        total = total + select(begins, up_to, select(ends, -up_to, 0.0))
        steep = abs(behind - before) / (PLACES[k + 1] - PLACES[k]) + NONE
        off = missed_within(dx) + largest(pull, LATE) / steep * max(get(dx, k), get(dx, k + 1))
        doubt = doubt + select(begins | ends, off, 0.0)
    return total, doubt

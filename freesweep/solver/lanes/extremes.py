"""The largest of what is known at the places of Clenshaw and Curtis, for a vector of designs.

By the angle of which a place is the cosine, places lie evenly, and what is smooth along the tube is smooth, and even about
both ends. Beside the largest place goes a polynomial through five of them; by what it rises more, or less, than a parabola
through three it may be wrong, and by a little of what bends it. At an end that is a peak beyond doubt, as the curve bends
down by more than what bends it, nothing slopes: it is as high as there.
"""

from ...jit import kernel
from .vector import HUGE, get, isnt, select, spread

CAUTION, BENT = 6.0, 0.2  # times what two curves differ by, and times the fourth difference


@kernel
def beside(row, k, last):
    """The number of place k, mirrored at both ends."""
    k = max(k, -k)
    return get(row, min(k, 2 * last - k))


@kernel
def parabola(before, here, after):
    """By what a parabola through three places rises beside the middle one, where that is the highest."""
    flat, own = 0.5 * (after - before), before - 2.0 * here + after
    peak = (here >= before) & (here >= after) & (own < 0.0)
    return select(peak, flat * flat / select(peak, -2.0 * own, 1.0), 0.0)


@kernel
def rises(before, here, after, slope, bend, third, fourth):
    """``(by what a curve of these differences rises to its peak beside a place, what may be wrong of it)``."""
    simple = parabola(before, here, after)
    peak = (here >= before) & (here >= after) & (before - 2.0 * here + after < 0.0)
    bent = peak & (bend < 0.0)
    on = select(bent, -slope / select(bent, bend, 1.0), 0.0)
    on = min(max(on, -1.0), 1.0)
    lift = on * (slope + on * (bend / 2.0 + on * (third / 6.0 + on * fourth / 24.0)))
    lift = select(bent, max(lift, 0.0), simple)
    unsure = peak & isnt((before == after) & (-bend > abs(fourth)))
    return lift, select(unsure, CAUTION * abs(lift - simple) + BENT * abs(fourth), 0.0)


@kernel
def widest(row, last, most, missed):
    """``(most, missed)``: the largest number so far, with those of a ``row`` up to ``last``, and what may be wrong of it. Of
    the row that is looked at beside which a parabola rises the highest.
    """
    highest_yet = spread(-HUGE)
    first = before = here = after = second = get(row, 0)
    for k in range(last + 1):
        left, own, right = beside(row, k - 1, last), get(row, k), beside(row, k + 1, last)
        top = own + parabola(left, own, right)
        higher = top > highest_yet
        highest_yet = select(higher, top, highest_yet)
        first = select(higher, beside(row, k - 2, last), first)
        second = select(higher, beside(row, k + 2, last), second)
        before, here, after = select(higher, left, before), select(higher, own, here), select(higher, right, after)
    lift, wrong = rises(
        before, here, after, (8.0 * (after - before) - second + first) / 12.0,
        (16.0 * (after + before) - 30.0 * here - second - first) / 12.0,
        0.5 * (second - first) - (after - before), second + first - 4.0 * (after + before) + 6.0 * here,
    )  # fmt: skip
    wider = here + lift > most
    return select(wider, here + lift, most), select(wider, wrong, missed)


@kernel
def highest(row, last, most):
    """The largest number so far, with those of a ``row`` up to ``last``, between which lie parabolas."""
    for k in range(last + 1):
        before, here, after = beside(row, k - 1, last), get(row, k), beside(row, k + 1, last)
        most = max(most, here + parabola(before, here, after))
    return most

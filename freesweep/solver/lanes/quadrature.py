"""Free states of physical tubes by quadrature of their first integral, for a vector of designs: no mesh, no Newton's method
but that for what the fibers leave the wall at one place.

A state is one number, the depth of its middle (:mod:`meridian`), at which half a tube is as long as it is: the secant finds
it, first by one rule along the whole depth, then part by part between the places where families go slack
(:mod:`slack_ends`). Each part is summed by the rule of Clenshaw and Curtis. What is summed is what an output differs by from
that of the middle; the last coefficients of its expansion in Chebyshev polynomials tell how much the rule may miss: of
600 functions with poles and roots beside the interval none missed more than a hundredth of the largest of four.
"""

from math import sqrt

import numpy as np

from ...jit import kernel
from ..along import places
from ..cells import nothing_yet
from ..guide import FAR_FROM
from ..numerics.nested import SMALLEST_TOLERANCE
from ..physics import lagrangian
from ..physics.uniform_tube import FAR
from ..physics.wall import has_any_family, has_two_families, may_go_slack
from . import slack_ends
from .extremes import widest
from .meridian import DEEPEST, fallen, handed_on, look, middle
from .vector import HUGE, WIDTH, get, mask_of, put, select, some, spread

LAST = 16  # places 0 to LAST of the rule
_ANGLES = np.pi * np.arange(LAST + 1) / LAST
_BASIS = np.polynomial.chebyshev.chebvander(-np.cos(_ANGLES), LAST)
PLACES = 0.5 - 0.5 * np.cos(_ANGLES)
WEIGHTS = np.linalg.solve(_BASIS.T, [0.0 if k % 2 else 1.0 / (1.0 - k * k) for k in range(LAST + 1)])
TAILS = 4
TAIL = np.ascontiguousarray(np.linalg.inv(_BASIS)[-TAILS:])
MISSED = 0.02  # of the largest of the last coefficients
SUMS = DX, LENGTH, VOLUME, TWIST, ENERGY = range(5)
ALPHA, BETA, PUSH_ALPHA, PUSH_BETA, SQUARE, STRAIN, KIND, Y, PSI, WIDE = range(5, 15)
FITS, ROUGH, CLOSE = (
    16,
    1e-3,
    1e-10,
)  # for the depth of the middle: trials, and shares of the layer that may be wrong there
SLACK, WORST = 5, 7  # behind the SUMS: lengths without a pull of both families, and the largest of four rows
STEEPEST = 3.0  # how much faster than evenly the depth may grow with its share
NARROW = 1e-6  # of the depth: a part of no length
FAINT = 1e-8  # of a layer: what the rounding of R - T makes of its length
SHORTEST, LONGEST = 0.3, 3.0  # of a depth: the next one


@kernel
def along(first, last, mid, cell, load, near, whole, rows, scratch):
    """Look at the places of one rule between two shares of the depth. ``rows`` (15, > LAST, WIDTH) take how x grows with the
    share of the part, pulls, and what was handed on; and as the ``whole`` also what else is to be summed and known. Returns
    what is handed on, and the lanes that may be.
    """
    valid, width = mask_of(-1), last - first
    for k in range(LAST + 1):
        here = look(first + width * PLACES[k], mid, cell, load, near, scratch)
        at, y = here.at, here.y
        near = handed_on(y, at, near)
        valid = valid & (at.room > 0.0)
        alpha, beta = slack_ends.pulls(at, load)
        dx = width * here.per_share
        put(rows[DX], k, dx)
        put(rows[ALPHA], k, alpha)
        put(rows[BETA], k, beta)
        put(rows[KIND], k, near[0])
        put(rows[Y], k, y)
        put(rows[PSI], k, at.psi)
        put(rows[WIDE], k, at.G_1)
        if not whole:
            continue
        s, volume, psi, energy = lagrangian.summed(at, y, here.cosine, cell, load)
        put(rows[LENGTH], k, dx * (s - mid.s))
        put(rows[VOLUME], k, dx * (volume - mid.y * mid.y * mid.s))
        put(rows[TWIST], k, dx * (psi - mid.psi))
        put(rows[ENERGY], k, dx * (energy - mid.energy))
        put(rows[PUSH_ALPHA], k, -pulled(at.a, load))
        put(rows[PUSH_BETA], k, -pulled(at.b, load))
        put(rows[SQUARE], k, places.outer_square(y, at.G_1, cell, load.wall))
        put(rows[STRAIN], k, places.strain_square(y, at.G_1, at.psi, cell, load.wall))
    return near, valid


@kernel
def pulled(multiplier, load):
    """What a family pulls by: one that cannot push not less than 0."""
    return max(multiplier, 0.0) if may_go_slack(load.wall) else multiplier


@kernel
def summed(row):
    """Sum of a row by the rule, and what it may miss."""
    total, missed = spread(0.0), spread(0.0)
    for k in range(LAST + 1):
        total = total + WEIGHTS[k] * get(row, k)
    for i in range(TAILS):
        tail = spread(0.0)
        for k in range(LAST + 1):
            tail = tail + TAIL[i, k] * get(row, k)
        missed = max(missed, abs(tail))
    return total, MISSED * missed


@kernel
def scan(pieces, mid, cell, load, rows, ends, counts, starts, scratch):
    """Look along the whole depth in so many ``pieces``: ``(length, (alpha, beta) limp somewhere, (alpha, beta) limp in the
    middle, (alpha, beta) lengths in doubt, lanes that may be)``. Brackets of the ends go to ``ends``, what may be handed on
    to them to ``starts``, (4, MOST, WIDTH).
    """
    valid, near, total = mask_of(-1), nothing_yet(spread(0.0)), spread(0.0)
    limp_a, limp_b, doubt_a, doubt_b = mask_of(0), mask_of(0), spread(0.0), spread(0.0)
    for lane in range(WIDTH):
        counts[lane] = 0
    for i in range(pieces):
        left, right = i / pieces, (i + 1) / pieces
        near, fine = along(spread(left), spread(right), mid, cell, load, near, False, rows, scratch)
        valid, total = valid & fine, total + summed(rows[DX])[0]
        limp_a, limp_b = limp_a | limp(rows[ALPHA]), limp_b | limp(rows[BETA])
        doubt_a = doubt_a + slack_ends.passed_over(rows[ALPHA], rows[DX], LAST)
        doubt_b = doubt_b + slack_ends.passed_over(rows[BETA], rows[DX], LAST)
        for family in range(2):
            slack_ends.bracket(
                left, right - left, PLACES, rows[ALPHA + family], family, LAST, rows[KIND:], ends, counts, starts
            )
    middle_limp = get(rows[ALPHA], LAST) <= 0.0, get(rows[BETA], LAST) <= 0.0
    return total, (limp_a, limp_b), middle_limp, (doubt_a, doubt_b), valid


@kernel
def find_ends(mid, cell, load, active, ends, counts, starts, edges, scratch):
    """Write the shares of the depth between which no family goes slack to ``edges`` (> MOST + 1, WIDTH); returns how many
    parts there are, and by how much an end may be off.
    """
    most, zero, unsure = 0, spread(0.0), spread(0.0)
    for lane in range(WIDTH):
        most = max(most, counts[lane])
    put(edges, 0, zero)
    for j in range(most):
        asked = 0
        for lane in range(WIDTH):
            asked |= (1 if j < counts[lane] else 0) << lane
        near = (
            get(starts[0], j), get(starts[1], j), zero, get(starts[2], j), zero, zero, get(starts[3], j), zero, zero
        )  # fmt: skip
        own = mask_of(asked) & active
        t, doubt = slack_ends.search(ends, j, own, mid, cell, load, near, scratch)
        put(edges, j + 1, t)
        unsure = unsure + select(own, doubt, zero)
    put(edges, most + 1, spread(1.0))
    slack_ends.sort(edges, counts)
    return most + 1, unsure


@kernel
def is_mixed(pull):
    """Where a pull ends within a part nevertheless."""
    middle, mixed = get(pull, LAST // 2) > 0.0, mask_of(0)
    for k in range(1, LAST):
        here = get(pull, k) > 0.0
        mixed = mixed | (here & ~middle) | (middle & ~here)
    return mixed


@kernel
def between_ends(parts, pieces, edges, mid, cell, load, rows, numbers, scratch):
    """Sum all parts, each in so many ``pieces``. ``numbers`` (2, > 10, WIDTH) take the SUMS and what they may miss, behind
    them the lengths without a pull, and the largest of the rows from PUSH_ALPHA to STRAIN. Returns the lanes that may be.
    """
    valid, near = mask_of(-1), nothing_yet(spread(0.0))
    for k in range(WORST + 4):
        put(numbers[0], k, spread(0.0 if k < WORST else -HUGE))
        put(numbers[1], k, spread(0.0))
    for j in range(parts):
        left, width = get(edges, j), (get(edges, j + 1) - get(edges, j)) / pieces
        for i in range(pieces):
            near, fine = along(left + i * width, left + (i + 1) * width, mid, cell, load, near, True, rows, scratch)
            own = width > 0.0  # others have more parts
            valid = valid & fine & ((width < NARROW) | ~(is_mixed(rows[ALPHA]) | is_mixed(rows[BETA])))
            dx, doubt = summed(rows[DX])
            add(numbers, DX, dx, doubt)
            for k in range(LENGTH, ENERGY + 1):
                add(numbers, k, *summed(rows[k]))
            for family in range(2):
                slack = get(rows[ALPHA + family], LAST // 2) <= 0.0
                add(numbers, SLACK + family, select(slack, dx, 0.0), select(slack, doubt, 0.0))
            for k in range(4):
                before = get(numbers[0], WORST + k), get(numbers[1], WORST + k)
                most, missed = widest(rows[PUSH_ALPHA + k], LAST, *before)
                put(numbers[0], WORST + k, select(own, most, before[0]))
                put(numbers[1], WORST + k, select(own, missed, before[1]))
    return valid


@kernel
def add(numbers, k, total, doubt):
    """One sum more."""
    put(numbers[0], k, get(numbers[0], k) + total)
    put(numbers[1], k, get(numbers[1], k) + doubt)


@kernel
def next_depth(wrong, depth, miss, before, slope):
    """``(depth, (depth, miss) before, slope)`` of one more trial of the secant in the lanes that are wrong."""
    moved = depth - before[0]
    steeper = (miss - before[1]) / select(moved == 0.0, 1.0, moved)
    slope = select(wrong & (steeper < 0.0) & (abs(moved) > 0.0), steeper, slope)
    trial = depth - miss / slope
    trial = min(max(trial, SHORTEST * depth), min(LONGEST * depth, DEEPEST))
    before = select(wrong, depth, before[0]), select(wrong, miss, before[1])
    return select(wrong, trial, depth), before, slope


@kernel
def limp(pull):
    """Where a pull is none at some place."""
    anywhere = mask_of(0)
    for k in range(LAST + 1):
        anywhere = anywhere | (get(pull, k) <= 0.0)
    return anywhere


@kernel
def let_go(mid, cell, load, half):
    """Where the middle misses a uniform stretch that draws the tube in, though its end is far: that is another branch."""
    drawn, missed = mid.u < lagrangian.drawn_in(cell, load), mid.y - mid.u > FAR_FROM * (1.0 - mid.u)
    return drawn & missed & (mid.rate * half > FAR)


@kernel
def finish(mid, miss, cell, load, half, middle_limp, doubts, unsure, numbers, scratch, out):
    """Write outputs, numbers and bounds; returns the largest scaled bound of the outputs, rounding left out."""
    sums, missed = numbers[0], numbers[1]
    wrong = get(missed, DX) + abs(miss) + FAINT / mid.rate  # of half the tube's length
    moved = 2.0 * mid.q * mid.rate * wrong  # of the middle, as a share of the layer
    rest = fallen(mid.rate * miss, scratch)  # how much of what is left of the layer is left in the middle itself
    outputs = (
        half * mid.s + get(sums, LENGTH), half * mid.y * mid.y * mid.s + get(sums, VOLUME),
        half * mid.psi + get(sums, TWIST), half * mid.energy + get(sums, ENERGY),
        mid.u + (mid.y - mid.u) * rest,
    )  # fmt: skip
    by = min(moved, 2.0 * mid.q)
    middle_moved = abs(1.0 - mid.u) * by
    errors = (
        get(missed, LENGTH) + moved * abs(get(sums, LENGTH)), get(missed, VOLUME) + moved * abs(get(sums, VOLUME)),
        get(missed, TWIST) + moved * abs(get(sums, TWIST)), get(missed, ENERGY) + moved * abs(get(sums, ENERGY)),
        middle_moved * rest,
    )  # fmt: skip
    scale, floor = lagrangian.scales(outputs, cell, load, half, SMALLEST_TOLERANCE)
    largest = max(
        max(max(errors[0] / scale[0], errors[1] / scale[1]), max(errors[2] / scale[2], errors[3] / scale[3])), errors[4]
    )
    record(out, 0, outputs, errors, floor)
    size = load.p + abs(load.f)
    share_a = (get(sums, SLACK) + select(middle_limp[0], miss, 0.0)) / half
    share_b = (get(sums, SLACK + 1) + select(middle_limp[1], miss, 0.0)) / half
    doubt = (get(missed, DX) + STEEPEST * unsure * mid.depth / mid.rate) / half
    least_a, least_b = places.pulls(pulled(-get(sums, WORST), load), pulled(-get(sums, WORST + 1), load), cell, load)
    off_a, off_b = places.pulls(get(missed, WORST), get(missed, WORST + 1), cell, load)
    outer, strain = sqrt(get(sums, WORST + 2)), sqrt(get(sums, WORST + 3))
    faint, least, none = (places.ROUNDING + moved) * size, spread(places.ROUNDING), spread(0.0)
    record(
        out, len(outputs),
        (share_a, share_b, least_a, least_b, outer, strain),
        (
            doubt + doubts[0] / half, doubt + doubts[1] / half,
            off_a + faint + moved * abs(least_a), off_b + faint + moved * abs(least_b),
            0.5 * get(missed, WORST + 2) / outer + 3.0 * middle_moved,
            0.5 * get(missed, WORST + 3) / strain + 3.0 * by * (strain - 1.0),
        ),
        (least, least, none, none, places.ROUNDING * outer, places.ROUNDING * strain),
    )  # fmt: skip
    return largest


@kernel
def record(out, first, numbers, errors, floors):
    """Numbers and bounds, from a row on."""
    for k in range(len(numbers)):
        put(out[0], first + k, numbers[k])
        put(out[1], first + k, errors[k] + floors[k])


@kernel
def solve(u, cell, load, half, active, pieces, accuracy, rows, ends, starts, edges, numbers, scratch, counts, out):
    """Solve the ``active`` lanes, whose uniform tubes have the stretch ``u``, all rules in so many ``pieces``. ``out`` (2, >
    11, WIDTH) takes the outputs, the numbers of :mod:`..along.places`, and their bounds. Returns masks: ``(met, alpha slack
    or pushed somewhere, beta)``.

    The rest is scratch: ``rows`` (15, > LAST, WIDTH), ``ends`` (5, > MOST, ...), ``starts`` (4, > MOST, ...), ``edges`` (>
    MOST + 1, ...), ``numbers`` (2, > 11, ...), ``scratch`` (1, ...), ``counts`` (WIDTH,).
    """
    mid = middle(u, spread(DEEPEST), cell, load, scratch)
    depth = min(mid.rate * half, DEEPEST)
    slope, before, settled = -1.0 / mid.rate, (depth, half), mask_of(0)
    found, alpha, beta, long = mask_of(0), mask_of(0), mask_of(0), mask_of(0)
    unsure, miss, doubts, middle_limp = spread(0.0), spread(0.0), (spread(0.0), spread(0.0)), (mask_of(0), mask_of(0))
    for _ in range(FITS):
        mid = middle(u, depth, cell, load, scratch)
        total, (alpha, beta), middle_limp, doubts, valid = scan(
            pieces, mid, cell, load, rows, ends, counts, starts, scratch
        )
        active = active & valid
        miss = half - total
        long = (depth >= DEEPEST) & (miss >= 0.0)
        wrong = active & ~settled & ~long & (abs(miss) * mid.rate * mid.q > ROUGH)
        arrived = active & ~wrong & ~settled
        settled = settled | arrived
        before = select(arrived, depth, before[0]), before[1]
        if not some(wrong):
            parts, unsure = find_ends(mid, cell, load, active, ends, counts, starts, edges, scratch)
            active = active & (unsure < slack_ends.ENOUGH)
            active = active & between_ends(parts, pieces, edges, mid, cell, load, rows, numbers, scratch)
            miss = half - get(numbers[0], DX)
            long = (depth >= DEEPEST) & (miss >= 0.0)
            wrong = active & ~long & (abs(miss) * mid.rate * mid.q > CLOSE)
            found = active & ~wrong
            if not some(wrong):
                break
        depth, before, slope = next_depth(wrong, depth, miss, before, slope)
    largest = finish(mid, miss, cell, load, half, middle_limp, doubts, unsure, numbers, scratch, out)
    if not has_two_families(load.wall):  # what is not there is not slack
        beta = mask_of(0)
    if not has_any_family(load.wall):
        alpha = mask_of(0)
    return found & (largest <= accuracy) & ~let_go(mid, cell, load, half), alpha, beta

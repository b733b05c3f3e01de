"""Free states of tubes that are the same all along by quadrature of their first integral, for a vector of designs: no
mesh, no Newton's method but that for what loose fibers leave the wall at one place.

A state is one number, the depth of its middle (:mod:`meridian`), at which half a tube is as long as it is: the secant
finds it, first by one rule along the whole depth, then part by part between the places where families go slack
(:mod:`slack_ends`); the source's tubes, which nobody asks where those are, have one part. What is summed (:mod:`rule`)
is what an output differs by from that of the middle; :mod:`outputs` makes of the sums what is told.
"""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..along import places
from ..cells import nothing_yet
from ..guide import FAR_FROM
from ..physics import lagrangian
from ..physics.uniform_tube import FAR
from ..physics.wall import has_any_family, has_two_families
from . import slack_ends
from .extremes import highest, widest
from .meridian import CERTAIN, DEEPEST, handed_on, look, middle
from .outputs import DX, ENERGY, LENGTH, SLACK, TWIST, VOLUME, WITHIN, WORST, finish, pulled, unmet
from .pack import aligned
from .rule import LAST, PLACES, missed_within, summed
from .vector import HUGE, WIDTH, bits, get, isnt, mask_of, put, select, some, spread

ALPHA, BETA, PUSH_ALPHA, PUSH_BETA, SQUARE, STRAIN, KIND, Y, PSI, WIDE = range(5, 15)
SHORT = SQUARE  # which only what is known of the whole needs
FITS = 16  # trials for the depth of the middle
ROUGH, CLOSE = 1e-3, 1e-10  # shares of the layer that may be wrong there
MUCH = 1e-2  # of the accuracy asked for
STEPS, MET = 8, 1e-12  # to the uniform stretch, relative
NARROW = 1e-6  # of the depth: a part of no length
SHORTEST, LONGEST = 0.3, 3.0  # of a depth: the next one


class Room(NamedTuple):
    """Scratch: ``rows`` (15, > LAST, WIDTH) of the places of one rule; brackets of ``ends`` (5, MOST, ...), their ``counts``
    (WIDTH,), ``starts`` (4, MOST, ...) and ``edges`` (MOST + 2, ...); ``numbers`` (2, 16, ...), sums and what they may miss;
    and one row (1, WIDTH).
    """

    rows: np.ndarray
    ends: np.ndarray
    counts: np.ndarray
    starts: np.ndarray
    edges: np.ndarray
    numbers: np.ndarray
    scratch: np.ndarray


class Seen(NamedTuple):
    """What a look along the depth tells of both families: limp somewhere, limp in the middle, lengths in doubt."""

    limp: tuple
    middle: tuple
    doubts: tuple


@kernel
def make_room():
    """Scratch of a vector."""
    ends = aligned(9, slack_ends.MOST)
    return Room(
        aligned(15, LAST + 1), ends[:5], np.zeros(WIDTH, np.int64), ends[5:], aligned(1, slack_ends.MOST + 2)[0],
        aligned(2, 16), aligned(1, 1)[0],
    )  # fmt: skip


@kernel
def along(first, last, mid, cell, load, near, whole, rows, scratch):
    """Look at the places of one rule between two shares of the depth. ``rows`` (15, > LAST, WIDTH) take how x grows
    with the share of the part, pulls, and what was handed on; and as the ``whole`` also what else is to be summed and
    known; if not, a row takes by what share R falls SHORT of T. Returns what is handed on, and the lanes that may be.
    """
    valid, width = mask_of(-1), last - first
    for k in range(LAST + 1):
        here = look(first + width * PLACES[k], mid, cell, load, near, scratch)
        at, y = here.at, here.y
        near = handed_on(y, at, near, load.wall)
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
            put(rows[SHORT], k, here.short)
            continue
        s, volume, psi, energy = lagrangian.summed(at, y, here.cosine, cell, load)
        put(rows[LENGTH], k, dx * (s - mid.s))
        put(rows[VOLUME], k, dx * (volume - mid.y * mid.y * mid.s))
        put(rows[TWIST], k, dx * (psi - mid.psi))
        put(rows[ENERGY], k, dx * (energy - mid.energy))
        look_at(y, at, k, cell, load, rows, load.wall)
    return near, valid


@kernel
def look_at(y, at, k, cell, load, rows, wall):
    """Of a physical tube the pulls, and the squares of its outer radius and of the wall's stretch, at one place."""
    if len(wall) == 1:
        return
    put(rows[PUSH_ALPHA], k, -pulled(at.a, load))
    put(rows[PUSH_BETA], k, -pulled(at.b, load))
    put(rows[SQUARE], k, places.outer_square(y, at.G_1, cell, load.wall))
    put(rows[STRAIN], k, places.strain_square(y, at.G_1, at.psi, cell, load.wall))


@kernel
def graded(i, pieces):
    """Where piece i of a part begins, as a share of it: they are short at a tube's end, where the meridian may stand
    upright.
    """
    return (i / pieces) * (i / pieces)


@kernel
def scan(pieces, mid, cell, load, rows, ends, counts, starts, scratch):
    """Look along the whole depth in so many ``pieces``: ``(length, (alpha, beta) limp somewhere, (alpha, beta) limp in
    the middle, (alpha, beta) lengths in doubt, lanes that may be, share by which R falls short of T)``. Brackets of the
    ends go to ``ends``, what may be handed on to them to ``starts``, (4, MOST, WIDTH).
    """
    valid, near, total = mask_of(-1), nothing_yet(spread(0.0)), spread(0.0)
    limp_a, limp_b, doubt_a, doubt_b = mask_of(0), mask_of(0), spread(0.0), spread(0.0)
    short = spread(CERTAIN)
    for lane in range(WIDTH):
        counts[lane] = 0
    for i in range(pieces):
        left, right = graded(i, pieces), graded(i + 1, pieces)
        near, fine = along(spread(left), spread(right), mid, cell, load, near, False, rows, scratch)
        valid, total = valid & fine, total + summed(rows[DX])[0]
        short = highest(rows[SHORT], LAST, short)
        limp_a, limp_b = limp_a | limp(rows[ALPHA]), limp_b | limp(rows[BETA])
        if len(load.wall) == 1:
            continue
        doubt_a = doubt_a + slack_ends.passed_over(rows[ALPHA], rows[DX], LAST)
        doubt_b = doubt_b + slack_ends.passed_over(rows[BETA], rows[DX], LAST)
        for family in range(2):
            slack_ends.bracket(
                left, right - left, PLACES, rows[ALPHA + family], family, LAST, rows[KIND:], ends, counts, starts
            )
    middle_limp = get(rows[ALPHA], LAST) <= 0.0, get(rows[BETA], LAST) <= 0.0
    return total, (limp_a, limp_b), middle_limp, (doubt_a, doubt_b), valid, short - CERTAIN


@kernel
def find_ends(mid, cell, load, active, ends, counts, starts, edges, scratch):
    """Write the shares of the depth between which no family goes slack to ``edges`` (> MOST + 1, WIDTH); returns how
    many parts there are, and by how much an end may be off.
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
        mixed = mixed | (here & isnt(middle)) | (middle & isnt(here))
    return mixed


@kernel
def between_ends(parts, pieces, edges, mid, cell, load, rows, numbers, scratch):
    """Sum all parts, each in so many ``pieces``. ``numbers`` (2, > 10, WIDTH) take the SUMS and what they may miss; of
    physical tubes behind them the lengths without a pull, and the largest of the rows from PUSH_ALPHA to STRAIN.
    Returns the lanes that may be, and ``(alpha, beta)`` limp somewhere in the last part.
    """
    valid, near, limp_a, limp_b = mask_of(-1), nothing_yet(spread(0.0)), mask_of(0), mask_of(0)
    for k in range(WITHIN + 1):
        put(numbers[0], k, spread(-HUGE if WORST <= k < WITHIN else 0.0))
        put(numbers[1], k, spread(0.0))
    for j in range(parts):
        left, width = get(edges, j), get(edges, j + 1) - get(edges, j)
        for i in range(pieces):
            first, last = left + graded(i, pieces) * width, left + graded(i + 1, pieces) * width
            near, fine = along(first, last, mid, cell, load, near, True, rows, scratch)
            dx, doubt = summed(rows[DX])
            add(numbers, DX, dx, doubt)
            add(numbers, WITHIN, spread(0.0), missed_within(rows[DX]))
            for k in range(LENGTH, ENERGY + 1):
                add(numbers, k, *summed(rows[k]))
            valid = valid & fine
            if len(load.wall) == 1:
                limp_a, limp_b = limp_a | limp(rows[ALPHA]), limp_b | limp(rows[BETA])
                continue
            own = width > 0.0  # others have more parts
            valid = valid & ((width < NARROW) | isnt(is_mixed(rows[ALPHA]) | is_mixed(rows[BETA])))
            for family in range(2):
                slack = get(rows[ALPHA + family], LAST // 2) <= 0.0
                add(numbers, SLACK + family, select(slack, dx, 0.0), select(slack, doubt, 0.0))
            for k in range(4):
                before = get(numbers[0], WORST + k), get(numbers[1], WORST + k)
                most, missed = widest(rows[PUSH_ALPHA + k], LAST, *before)
                put(numbers[0], WORST + k, select(own, most, before[0]))
                put(numbers[1], WORST + k, select(own, missed, before[1]))
    return valid, (limp_a, limp_b)


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
def other(where, new, old):
    """One mask where it is so, elsewhere the other."""
    return (where & new) | (isnt(where) & old)


@kernel
def with_ends(counts, ended):
    """Which lanes have ends, of those that had before; others have none any more."""
    had, some_have = bits(ended), 0
    for lane in range(WIDTH):
        if not (had >> lane) & 1:
            counts[lane] = 0
        some_have |= (1 if counts[lane] > 0 else 0) << lane
    return mask_of(some_have)


@kernel
def let_go(mid, cell, load, half):
    """Where the middle misses a uniform stretch that draws the tube in, though its end is far: that is another branch."""
    drawn, missed = mid.u < lagrangian.drawn_in(cell, load), mid.y - mid.u > FAR_FROM * (1.0 - mid.u)
    return drawn & missed & (mid.rate * half > FAR)


@kernel
def stationary(u, cell, load, active):
    """``(u, lanes where it is met)``: the uniform stretch near one that is all but it."""
    zero, near, todo = spread(0.0), nothing_yet(spread(0.0)), active
    for _ in range(STEPS):
        (_, L_y, _, L_yy, _, _), near = lagrangian.density_beside(u, zero, cell, load, near)
        change = L_y / L_yy
        u = select(todo, u - change, u)
        todo = todo & (abs(change) > MET * u)
        if not some(todo):
            break
    return u, active & isnt(todo)


@kernel
def is_off(mid, miss, straight, share):
    """Where half a tube is not as long as it is, by more than a ``share`` of the layer. What is left behind the deepest
    middle, or that of a ``straight`` tube, is uniform.
    """
    long = (straight | (mid.depth >= DEEPEST)) & (miss >= 0.0)
    return isnt(long) & (abs(miss) * mid.rate * mid.q > share)


@kernel
def seen_again(where, new, old):
    """What is :class:`Seen`, in some lanes anew."""
    return Seen(
        (other(where, new.limp[0], old.limp[0]), other(where, new.limp[1], old.limp[1])),
        (other(where, new.middle[0], old.middle[0]), other(where, new.middle[1], old.middle[1])),
        (select(where, new.doubts[0], old.doubts[0]), select(where, new.doubts[1], old.doubts[1])),
    )


@kernel
def look_along(pieces, mid, cell, load, room):
    """``(length, what is Seen, lanes that may be)`` of a :func:`scan`."""
    total, limp, middle_limp, doubts, valid, _ = scan(
        pieces, mid, cell, load, room.rows, room.ends, room.counts, room.starts, room.scratch
    )
    return total, Seen(limp, middle_limp, doubts), valid


@kernel
def sum_parts(pieces, mid, cell, load, active, room):
    """Sum all parts, to the room's ``numbers``: ``(lanes that may be, (alpha, beta) limp in the last part, by how much an
    end may be off)``.
    """
    parts, unsure = find_ends(mid, cell, load, active, room.ends, room.counts, room.starts, room.edges, room.scratch)
    valid, limps = between_ends(parts, pieces, room.edges, mid, cell, load, room.rows, room.numbers, room.scratch)
    return active & (unsure < slack_ends.ENOUGH) & valid, limps, unsure


@kernel
def tell(mid, miss, seen, unsure, cell, load, half, room, out):
    """Write what is told of a state (:mod:`outputs`) whose half is missed by so much; returns the largest scaled bound."""
    nearest = 2.0 * mid.q  # at most that far is a long tube's from the end
    moved = nearest * min(mid.rate * unmet(mid, miss, get(room.numbers[1], DX)), 1.0)
    placed = nearest * min(mid.rate * unmet(mid, miss, get(room.numbers[1], WITHIN)), 1.0)
    behind = select(mid.depth >= DEEPEST, max(miss, 0.0), 0.0)
    return finish(
        mid,
        miss,
        moved,
        placed,
        behind,
        cell,
        load,
        half,
        seen.middle,
        seen.doubts,
        unsure,
        room.numbers,
        room.scratch,
        out,
    )


@kernel
def there(limps, wall):
    """``(alpha, beta)``: what is not there is not slack."""
    none = mask_of(0)
    return limps[0] if has_any_family(wall) else none, limps[1] if has_two_families(wall) else none


@kernel
def solve(u, cell, load, half, active, pieces, accuracy, room, out):
    """Solve the ``active`` lanes, whose uniform tubes have about the stretch ``u``, all rules in so many ``pieces``.
    ``out`` (2, > 11, WIDTH) takes the outputs, of physical tubes the numbers of :mod:`..along.places`, and their
    bounds. Returns masks, and uniform stretch and depth of the middle: ``(met, alpha slack or pushed somewhere, beta,
    (u, depth))``.
    """
    u, active = stationary(u, cell, load, active)
    mid, none, zero = middle(u, spread(DEEPEST), cell, load, room.scratch), mask_of(0), spread(0.0)
    depth, straight = min(mid.rate * half, DEEPEST), u == 1.0
    slope, before, settled, found = -1.0 / mid.rate, (depth, half), none, none
    seen, unsure, miss = Seen((none, none), (none, none), (zero, zero)), zero, zero
    rough, fine = 0, 0  # trials that each lane has had, whatever its neighbours need
    ended = mask_of(-1)  # whose parts have to be looked for again: of all the same, they are one
    while fine < FITS:
        mid, wrong = middle(u, depth, cell, load, room.scratch), none
        if fine == 0 or some(active & ended):
            total, now, valid = look_along(pieces, mid, cell, load, room)
            seen, active, miss = seen_again(ended, now, seen), active & (valid | isnt(ended)), half - total
            rough += 1
            wrong = active & isnt(settled) & is_off(mid, miss, straight, ROUGH)
            if rough == FITS:
                active, wrong = active & isnt(wrong), none
            arrived = active & isnt(wrong) & isnt(settled)
            settled = settled | arrived
            before = select(arrived, depth, before[0]), before[1]
        if not some(wrong):
            fine += 1
            ended = ended & with_ends(room.counts, ended)
            active, limps, unsure = sum_parts(pieces, mid, cell, load, active, room)
            if len(load.wall) == 1:
                seen = Seen(limps, seen.middle, seen.doubts)
            miss = half - get(room.numbers[0], DX)
            wrong = active & is_off(mid, miss, straight, min(CLOSE, MUCH * accuracy))
            found = active & isnt(wrong)
            if not some(wrong):
                break
        depth, before, slope = next_depth(wrong, depth, miss, before, slope)
    largest = tell(mid, miss, seen, unsure, cell, load, half, room, out)
    alpha, beta = there(seen.limp, load.wall)
    return found & (largest <= accuracy) & isnt(let_go(mid, cell, load, half)), alpha, beta, (u, depth)

"""Sums along half a tube that is the same all along, for a vector of designs: along the depth of its middle
(:mod:`meridian`), part by part between the places where families go slack (:mod:`slack_ends`). Fibers that may push leave
no corner: their tubes have one part, along which :mod:`pushed` tells where they do. What is summed (:mod:`rule`) is what an
output differs by from that of the middle.
"""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..along import places
from ..cells import nothing_yet
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from . import pushed, slack_ends
from .extremes import highest, widest
from .meridian import CERTAIN, handed_on, look
from .outputs import DX, ENERGY, LENGTH, SLACK, TWIST, VOLUME, WITHIN, WORST, told_of
from .pack import OUTPUTS, aligned
from .rule import LAST, PLACES, missed_within, summed
from .vector import HUGE, WIDTH, get, isnt, mask_of, put, select, spread

ALPHA, BETA, PUSH_ALPHA, PUSH_BETA, SQUARE, STRAIN, KIND, Y, PSI, WIDE, SERIES = range(5, 16)
SHORT = SQUARE  # which only what is known of the whole needs
NARROW = 1e-6  # of the depth: a part of no length
TOLD = OUTPUTS + len(places.NUMBERS)  # of a state


class Room(NamedTuple):
    """Scratch: ``rows`` (17, > LAST + 1, WIDTH) of the places of one rule; brackets of ``ends`` (7, MOST, ...), their
    ``counts`` (WIDTH,), ``starts`` (4, MOST, ...) and ``edges`` (MOST + 2, ...); ``numbers`` (2, 16, ...), sums and what
    they may miss; what is ``kept`` (11, WIDTH) of what was told of a trial; and one row (1, WIDTH).
    """

    rows: np.ndarray
    ends: np.ndarray
    counts: np.ndarray
    starts: np.ndarray
    edges: np.ndarray
    numbers: np.ndarray
    kept: np.ndarray
    scratch: np.ndarray


@kernel
def make_room():
    """Scratch of a vector."""
    ends = aligned(11, slack_ends.MOST)
    return Room(
        aligned(17, LAST + 2), ends[:7], np.zeros(WIDTH, np.int64), ends[7:], aligned(1, slack_ends.MOST + 2)[0],
        aligned(2, 16), aligned(1, TOLD)[0], aligned(1, 1)[0],
    )  # fmt: skip


@kernel
def along(first, last, mid, cell, load, near, whole, rows, scratch):
    """Look at the places of one rule between two shares of the depth. ``rows`` (17, > LAST + 1, WIDTH) take how x grows
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
    told = told_of(y, at, cell, load)
    put(rows[PUSH_ALPHA], k, told[0])
    put(rows[PUSH_BETA], k, told[1])
    put(rows[SQUARE], k, told[2])
    put(rows[STRAIN], k, told[3])


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
    ends, where fibers cannot push, go to ``ends``, what may be handed on to them to ``starts``, (4, MOST, WIDTH).
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
        if not may_go_slack(load.wall):
            continue
        doubt_a = doubt_a + slack_ends.passed_over(rows[ALPHA], rows[BETA], rows[DX], LAST)
        doubt_b = doubt_b + slack_ends.passed_over(rows[BETA], rows[ALPHA], rows[DX], LAST)
        for family in range(2):
            slack_ends.bracket(
                left, right - left, PLACES, rows[ALPHA + family], family, LAST, rows[KIND:], ends, counts, starts
            )
    middle_limp = get(rows[ALPHA], LAST) <= 0.0, get(rows[BETA], LAST) <= 0.0
    return total, (limp_a, limp_b), middle_limp, (doubt_a, doubt_b), valid, short - CERTAIN


@kernel
def find_ends(mid, cell, load, active, ends, counts, starts, edges, scratch):
    """Write the shares of the depth between which no family goes slack to ``edges`` (> MOST + 1, WIDTH); in the ``active``
    lanes they are looked for, and written to ``ends`` in place of their brackets, where others have left them. Returns how
    many parts there are, and by how much an end that was looked for may be off.
    """
    most, zero, unsure = 0, spread(0.0), spread(0.0)
    for lane in range(WIDTH):
        most = max(most, counts[lane])
    put(edges, 0, zero)
    for j in range(most):
        there = mask_of(slack_ends.lanes_with(counts, j))
        own, near = there & active, slack_ends.start_of(starts, j)
        t, doubt = slack_ends.search(ends, j, own, mid, cell, load, near, scratch)
        t = select(own, t, get(ends[slack_ends.LEFT], j))
        put(ends[slack_ends.RIGHT], j, select(own, t, get(ends[slack_ends.RIGHT], j)))
        put(ends[slack_ends.LEFT], j, t)
        put(edges, j + 1, select(there, t, 1.0))
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
def limp(pull):
    """Where a pull is none at some place."""
    anywhere = mask_of(0)
    for k in range(LAST + 1):
        anywhere = anywhere | (get(pull, k) <= 0.0)
    return anywhere


@kernel
def between_ends(parts, pieces, edges, mid, cell, load, rows, numbers, scratch):
    """Sum all parts, each in so many ``pieces``. ``numbers`` (2, > 10, WIDTH) take the SUMS and what they may miss; of
    physical tubes behind them the lengths without a pull, and the largest of the rows from PUSH_ALPHA to STRAIN.
    Returns the lanes that may be, and of fibers that may push (alpha, beta) each: which do somewhere, and in the middle; and
    lengths in doubt.
    """
    valid, near, limp_a, limp_b = mask_of(-1), nothing_yet(spread(0.0)), mask_of(0), mask_of(0)
    doubt_a, doubt_b = spread(0.0), spread(0.0)
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
            own = width > 0.0  # others have more parts
            if not may_go_slack(load.wall):
                limp_a, limp_b = limp_a | limp(rows[ALPHA]), limp_b | limp(rows[BETA])
            if len(load.wall) == 1:
                continue
            if may_go_slack(load.wall):
                valid = valid & ((width < NARROW) | isnt(is_mixed(rows[ALPHA]) | is_mixed(rows[BETA])))
                for family in range(2):
                    slack = get(rows[ALPHA + family], LAST // 2) <= 0.0
                    add(numbers, SLACK + family, select(slack, dx, 0.0), select(slack, doubt, 0.0))
            else:
                doubt_a = doubt_a + slack_ends.passed_over(rows[ALPHA], rows[ALPHA], rows[DX], LAST)
                doubt_b = doubt_b + slack_ends.passed_over(rows[BETA], rows[BETA], rows[DX], LAST)
                for family in range(2):
                    told = pushed.length(
                        family, rows[ALPHA + family], rows[DX], rows[SERIES:], first, last - first, mid, cell, load, scratch
                    )  # fmt: skip
                    add(numbers, SLACK + family, *told)
            for k in range(4):
                before = get(numbers[0], WORST + k), get(numbers[1], WORST + k)
                most, missed = widest(rows[PUSH_ALPHA + k], LAST, *before)
                put(numbers[0], WORST + k, select(own, most, before[0]))
                put(numbers[1], WORST + k, select(own, missed, before[1]))
    middle = get(rows[ALPHA], LAST) <= 0.0, get(rows[BETA], LAST) <= 0.0
    return valid, ((limp_a, limp_b), middle, (doubt_a, doubt_b))


@kernel
def add(numbers, k, total, doubt):
    """One sum more."""
    put(numbers[0], k, get(numbers[0], k) + total)
    put(numbers[1], k, get(numbers[1], k) + doubt)

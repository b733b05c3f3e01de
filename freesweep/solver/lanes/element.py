"""Half a tube's second variation, part by part, each of them one polynomial along its depth, for a vector of designs.

Within a part, where no family of fibers goes slack, what a state answers with is smooth: a line between the part's ends and
BUBBLES, integrals of Legendre's polynomials, which are none there. With ``A = -J_yy`` of the functional summed at Gauss'
PLACES, which never lie on an end, and ``g = J_y,number``, an answer is ``dy = A^-1 g``; and of the numbers by which J is
derived twice::

    J_ij = sum L_ij + g_i A^-1 g_j = sum L_ij + sum over pivots d of  g_i g_j / d,   g eliminated

so nothing is substituted back, and what dy misses counts by its square. Parts are eliminated one after the other: what is
left of one, at the end that it shares with the next, is carried on.

What it misses is told by FEWER bubbles, eliminated beside: what they lose is a positive form, of which
``|lost_ij|^2 <= lost_ii lost_jj``. And as J is stationary the g of the loads, each times its load, are none together, but
for what places and state miss.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from ...jit import kernel
from .pack import aligned
from .second import BY_V, BY_Y, LOADS, NUMBERS, OF_LOADS, ROWS, VV, YV, YY
from .vector import get, put, select, spread

COUNT, BUBBLES, FEWER = 16, 14, 10
TINY = 1e-140
LEFT, RIGHT = BUBBLES, BUBBLES + 1  # behind the bubbles
SIZE = RIGHT + 1
TRIANGLE = SIZE * (SIZE + 1) // 2
_AT, _WEIGHTS = np.polynomial.legendre.leggauss(COUNT)
PLACES, WEIGHTS = 0.5 + 0.5 * _AT, 0.5 * _WEIGHTS
_LEGENDRE = np.polynomial.legendre.legvander(_AT, BUBBLES + 1)
_BUBBLES = (_LEGENDRE[:, 2:] - _LEGENDRE[:, :-2]) / (2.0 * np.arange(1, BUBBLES + 1) + 1.0)
SHAPES = np.column_stack([_BUBBLES, 1.0 - PLACES, PLACES])
SLOPES = np.column_stack([2.0 * _LEGENDRE[:, 1 : BUBBLES + 1], -np.ones(COUNT), np.ones(COUNT)])
LAST_ONES = 3  # of Legendre's coefficients, which tell how smooth a row is
_COEFFICIENTS = (2.0 * np.arange(COUNT) + 1.0)[:, None] * (np.polynomial.legendre.legvander(_AT, COUNT - 1).T * WEIGHTS)
TAILS = np.ascontiguousarray(_COEFFICIENTS[-LAST_ONES:])
OF_STATE = 3  # fields before those of the numbers; behind them those of what loads are conjugate to
PIVOT = 0  # rows of what is carried on: A, and behind it g of each number
SQUARES, LOST = range(2)  # rows of what is known of errors: g A^-1 g of each number, and what FEWER lose of it


class Variation(NamedTuple):
    """What a second variation by the numbers ``used`` is made in: ``rows`` (2, ROWS, WIDTH) of a place and of the middle,
    ``fields`` (OF_STATE + 2 numbers + LOADS, COUNT, ...) of a part, its A and the factors (3, TRIANGLE, ...), ``pushed``
    (numbers, SIZE, ...), and two rows of half of what it is made of (2, COUNT, ...). What parts leave: ``carried``
    (2, 1 + numbers, ...), ``known`` errors (2, numbers, ...), ``sums`` (2, LOADS NUMBERS + LOADS, ...) at a fixed shape and
    answered, and how ``rough`` they are (2, LOADS, ...); last the force that is ``left`` (numbers, ...).
    """

    used: np.ndarray
    rows: np.ndarray
    fields: np.ndarray
    matrix: np.ndarray
    pushed: np.ndarray
    halves: np.ndarray
    carried: np.ndarray
    known: np.ndarray
    sums: np.ndarray
    rough: np.ndarray
    left: np.ndarray


@kernel
def make_variation(used):
    """Scratch of a vector."""
    count = len(used)
    return Variation(
        used, aligned(2, ROWS), aligned(OF_STATE + 2 * count + LOADS, COUNT), aligned(3, TRIANGLE), aligned(count, SIZE),
        aligned(2, COUNT), aligned(2, 1 + count), aligned(2, count), aligned(2, LOADS * NUMBERS + LOADS), aligned(2, LOADS),
        aligned(1, count)[0],
    )  # fmt: skip


@kernel
def clear(own):
    """Nothing is summed yet."""
    for array in (own.sums, own.carried, own.known, own.rough):
        for i in range(2):
            for k in range(array.shape[1]):
                put(array[i], k, 0.0)


@kernel
def weigh(k, weight, per_length, rows, middle, used, fields):
    """Enter place k of a part into the ``fields`` (OF_STATE + 2 numbers + LOADS, COUNT, WIDTH) from its ``rows``
    (:func:`.second.bends`), and those of the ``middle``: ``weight`` is its length, ``per_length`` how fast the part's share
    grows with that; ``used`` are the numbers that there are.
    """
    slope = weight * per_length
    put(fields[0], k, weight * get(rows, YY))
    put(fields[1], k, slope * get(rows, YV))
    put(fields[2], k, slope * per_length * get(rows, VV))
    for j in range(len(used)):
        put(fields[OF_STATE + 2 * j], k, weight * get(rows, BY_Y + used[j]))
        put(fields[OF_STATE + 2 * j + 1], k, slope * get(rows, BY_V + used[j]))
    for i in range(LOADS):
        n = OF_LOADS + LOADS * NUMBERS + i
        put(fields[OF_STATE + 2 * len(used) + i], k, weight / WEIGHTS[k] * (get(rows, n) - get(middle, n)))


@kernel
def roughness(row):
    """What Gauss' rule misses of a row, by Legendre's coefficients that are twice as high as its last ones: a square of
    these; and the row's largest number.
    """
    most, tail = spread(TINY), spread(0.0)
    for k in range(COUNT):
        most = max(most, abs(get(row, k)))
    for i in range(LAST_ONES):
        total = spread(0.0)
        for k in range(COUNT):
            total = total + TAILS[i, k] * get(row, k)
        tail = max(tail, abs(total))
    share = tail / most
    return tail * share * sqrt(sqrt(share)), most


@kernel
def gather(weight, rows, used, sums):
    """Add to the ``sums`` (LOADS NUMBERS + LOADS, WIDTH) what loads are conjugate to along a ``weight`` of length: its
    derivatives at a fixed shape, and behind them itself.
    """
    for i in range(LOADS):
        for j in range(len(used)):
            n = NUMBERS * i + used[j]
            put(sums, n, get(sums, n) + weight * get(rows, OF_LOADS + n))
        n = LOADS * NUMBERS + i
        put(sums, n, get(sums, n) + weight * get(rows, OF_LOADS + n))


@kernel
def assemble(fields, count, bent, pushed, halves):
    """The lower triangle of a part's A to ``bent`` (TRIANGLE, WIDTH), all g to ``pushed`` (numbers, SIZE, WIDTH)."""
    for n in range(SIZE):
        for k in range(COUNT):
            S, C, V = get(fields[0], k), get(fields[1], k), get(fields[2], k)
            put(halves[0], k, -(S * SHAPES[k, n] + C * SLOPES[k, n]))
            put(halves[1], k, -(C * SHAPES[k, n] + V * SLOPES[k, n]))
        for m in range(n + 1):
            total = spread(0.0)
            for k in range(COUNT):
                total = total + get(halves[0], k) * SHAPES[k, m] + get(halves[1], k) * SLOPES[k, m]
            put(bent, at(n, m), total)
    for j in range(count):
        for n in range(SIZE):
            total = spread(0.0)
            for k in range(COUNT):
                by_y, by_v = get(fields[OF_STATE + 2 * j], k), get(fields[OF_STATE + 2 * j + 1], k)
                total = total + by_y * SHAPES[k, n] + by_v * SLOPES[k, n]
            put(pushed[j], n, total)


@kernel
def at(n, m):
    """Where a triangle has row n, column m."""
    return n * (n + 1) // 2 + m


@kernel
def divided(bent, lower, inverse):
    """Split A of the bubbles, and its rows of both ends, into ``lower`` and pivots, of which the ``inverse`` is kept."""
    for n in range(SIZE):
        for m in range(min(n + 1, BUBBLES)):
            total = get(bent, at(n, m))
            for i in range(m):
                total = total - get(bent, at(n, i)) * get(lower, at(m, i))
            put(bent, at(n, m), total)
            if m < n:
                put(lower, at(n, m), total * get(inverse, m))
        if n < BUBBLES:
            put(inverse, n, 1.0 / get(bent, at(n, n)))


@kernel
def between(n, m, bubbles, bent, lower):
    """What A has at two ends when so many bubbles are eliminated."""
    total = get(bent, at(n, m))
    for i in range(bubbles):
        total = total - get(bent, at(n, i)) * get(lower, at(m, i))
    return total


@kernel
def eliminate(own, fixed, used, bent, pushed, lower, inverse, carried, known):
    """Eliminate all but the right end of a part: ``carried`` (2, 1 + numbers, WIDTH) takes over what is left of A and g
    there, with all bubbles and with FEWER; ``known`` (2, ...) what is known of errors. Only in the lanes that have it for
    their ``own``; where its left end is ``fixed`` it does not move. ``pushed`` becomes g eliminated,
    ``inverse`` takes 1/pivot.
    """
    count = len(used)
    divided(bent, lower, inverse)
    pivot = 1.0 / (between(LEFT, LEFT, BUBBLES, bent, lower) + get(carried[0], PIVOT))
    fewer_pivot = 1.0 / (between(LEFT, LEFT, FEWER, bent, lower) + get(carried[1], PIVOT))
    pivot, fewer_pivot = select(fixed, 0.0, pivot), select(fixed, 0.0, fewer_pivot)
    put(inverse, LEFT, pivot)
    edge, fewer_edge = between(RIGHT, LEFT, BUBBLES, bent, lower), between(RIGHT, LEFT, FEWER, bent, lower)
    last, fewer_last = between(RIGHT, RIGHT, BUBBLES, bent, lower), between(RIGHT, RIGHT, FEWER, bent, lower)
    put(carried[0], PIVOT, select(own, last - edge * edge * pivot, get(carried[0], PIVOT)))
    put(carried[1], PIVOT, select(own, fewer_last - fewer_edge * fewer_edge * fewer_pivot, get(carried[1], PIVOT)))
    for j in range(count):
        g = pushed[j]
        for n in range(1, BUBBLES):
            total = get(g, n)
            for i in range(n):
                total = total - get(lower, at(n, i)) * get(g, i)
            put(g, n, total)
        left, right, squares, more = get(g, LEFT), get(g, RIGHT), spread(0.0), spread(0.0)
        fewer_left, fewer_right = left, right
        for i in range(BUBBLES):
            left, right = left - get(lower, at(LEFT, i)) * get(g, i), right - get(lower, at(RIGHT, i)) * get(g, i)
            square = get(g, i) * get(g, i) * get(inverse, i)
            squares = squares + square
            if i < FEWER:
                fewer_left, fewer_right = left, right
            else:
                more = more + square
        left, fewer_left = left + get(carried[0], 1 + j), fewer_left + get(carried[1], 1 + j)
        squares = squares + left * left * pivot
        more = more + left * left * pivot - fewer_left * fewer_left * fewer_pivot
        put(known[SQUARES], j, get(known[SQUARES], j) + select(own, squares, 0.0))
        put(known[LOST], j, get(known[LOST], j) + select(own, more, 0.0))
        put(g, LEFT, left)
        put(carried[0], 1 + j, select(own, right - edge * pivot * left, get(carried[0], 1 + j)))
        put(carried[1], 1 + j, select(own, fewer_right - fewer_edge * fewer_pivot * fewer_left, get(carried[1], 1 + j)))


@kernel
def derive(own, used, pushed, inverse, room, answers):
    """Add to the ``answers`` (LOADS NUMBERS, WIDTH) what J is derived to by what a part answers with."""
    count = len(used)
    for i in range(LOADS):
        for n in range(RIGHT):
            put(room, n, get(pushed[count - LOADS + i], n) * get(inverse, n))
        for j in range(count - 1):
            total = spread(0.0)
            for n in range(RIGHT):
                total = total + get(room, n) * get(pushed[j], n)
            n = NUMBERS * i + used[j]
            put(answers, n, get(answers, n) + select(own, total, 0.0))

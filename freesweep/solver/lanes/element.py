"""Part of a tube as one polynomial: its share of the second variation, for a vector of designs.

Within a part, where no family of fibers goes slack, what a state answers with is smooth along the depth: a line between the
part's ends and BUBBLES, integrals of Legendre's polynomials, that are none there. With ``A = -J_yy`` of the functional
summed at Gauss' PLACES, which never lie on an end, and ``g = J_y,number``, an answer is ``dy = A^-1 g``; and of the numbers
by which J is derived twice::

    J_ij = sum L_ij + g_i A^-1 g_j = sum L_ij + sum over pivots d of  g_i g_j / d,   g eliminated

so nothing is substituted back. What is missed of dy counts by its square. Parts are eliminated one after the other: what is
left of one, at the end that it shares with the next, is carried on.
"""

import numpy as np

from ...jit import kernel
from .second import BY_V, BY_Y, LOADS, NUMBERS, OF_LOADS, VV, WEIGHT, YV, YY
from .vector import get, put, select, spread

COUNT, BUBBLES = 16, 14
LEFT, RIGHT = BUBBLES, BUBBLES + 1  # behind the bubbles
SIZE = RIGHT + 1
_AT, _WEIGHTS = np.polynomial.legendre.leggauss(COUNT)
PLACES, WEIGHTS = 0.5 + 0.5 * _AT, 0.5 * _WEIGHTS
_LEGENDRE = np.polynomial.legendre.legvander(_AT, BUBBLES + 1)
_RISES = 2.0 * _LEGENDRE[:, 1 : BUBBLES + 1]
_BUBBLES = (_LEGENDRE[:, 2:] - _LEGENDRE[:, :-2]) / (2.0 * np.arange(1, BUBBLES + 1) + 1.0)
SHAPES = np.column_stack([_BUBBLES, 1.0 - PLACES, PLACES])
SLOPES = np.column_stack([_RISES, -np.ones(COUNT), np.ones(COUNT)])
OF_STATE = 3  # rows of what is summed, before those of the numbers


@kernel
def weigh(k, own, weight, per_share, rows, used, fields, sums):
    """Enter place k of a part into the ``fields`` (OF_STATE + 2 numbers, COUNT, WIDTH), and add to the ``sums`` (LOADS
    times NUMBERS, WIDTH), from its ``rows`` (:func:`.second.bends`). ``weight`` is its length, ``per_share`` how fast the
    part's share grows with the length; ``used`` are the numbers that there are.
    """
    slope = weight * per_share
    put(fields[0], k, weight * get(rows[0], YY))
    put(fields[1], k, slope * get(rows[0], YV))
    put(fields[2], k, slope * per_share * get(rows[0], VV))
    for j in range(len(used)):
        put(fields[OF_STATE + 2 * j], k, weight * get(rows[0], BY_Y + used[j]))
        put(fields[OF_STATE + 2 * j + 1], k, slope * get(rows[0], BY_V + used[j]))
    gather(select(own, weight, 0.0), rows, used, sums)


@kernel
def gather(weight, rows, used, sums):
    """Add to the ``sums`` what loads are conjugate to changes by along a ``weight`` of length."""
    for i in range(LOADS):
        for j in range(len(used)):
            n = NUMBERS * i + used[j]
            put(sums, n, get(sums, n) + weight * get(rows[0], OF_LOADS + n))


@kernel
def assemble(fields, count, bent, pushed, halves):
    """The part's A, rows (SIZE (SIZE + 1)/2, WIDTH) of its lower triangle, and g of each number, (numbers, SIZE, WIDTH)."""
    for n in range(SIZE):
        for k in range(COUNT):
            S, C, V = get(fields[0], k), get(fields[1], k), get(fields[2], k)
            put(halves[0], k, -(S * SHAPES[k, n] + C * SLOPES[k, n]))
            put(halves[1], k, -(C * SHAPES[k, n] + V * SLOPES[k, n]))
        for m in range(n + 1):
            total = spread(0.0)
            for k in range(COUNT):
                total = total + get(halves[0], k) * SHAPES[k, m] + get(halves[1], k) * SLOPES[k, m]
            put(bent, n * (n + 1) // 2 + m, total)
    for j in range(count):
        for n in range(SIZE):
            total = spread(0.0)
            for k in range(COUNT):
                by_y, by_v = get(fields[OF_STATE + 2 * j], k), get(fields[OF_STATE + 2 * j + 1], k)
                total = total + by_y * SHAPES[k, n] + by_v * SLOPES[k, n]
            put(pushed[j], n, total)


@kernel
def eliminate(own, fixed, used, bent, pushed, lower, inverse, carried, sums, tails):
    """Eliminate all but the right end of a part: ``carried`` (1 + numbers, WIDTH) takes over what is left of A and g there,
    the ``sums`` what J is derived to, the ``tails`` what the last two bubbles add. Only in the lanes that have it for their
    ``own``; where its left end is ``fixed`` it does not move.
    """
    count = len(used)
    put(bent, LEFT * (LEFT + 1) // 2 + LEFT, get(bent, LEFT * (LEFT + 1) // 2 + LEFT) + get(carried, 0))
    for j in range(count):
        put(pushed[j], LEFT, get(pushed[j], LEFT) + get(carried, 1 + j))
    for n in range(SIZE):
        first = n * (n + 1) // 2
        for m in range(n + 1):
            total = get(bent, first + m)
            for i in range(m):
                total = total - get(bent, first + i) * get(lower, m * (m + 1) // 2 + i)
            put(bent, first + m, total)
            if m < n:
                put(lower, first + m, total * get(inverse, m))
        pivot = 1.0 / get(bent, first + n)
        put(inverse, n, select(fixed, 0.0, pivot) if n == LEFT else pivot)
    for j in range(count):
        for n in range(1, SIZE):
            total = get(pushed[j], n)
            for i in range(n):
                total = total - get(lower, n * (n + 1) // 2 + i) * get(pushed[j], i)
            put(pushed[j], n, total)
    for i in range(LOADS):
        load = count - LOADS + i
        for n in range(RIGHT):
            put(lower, n, get(pushed[load], n) * get(inverse, n))
        for j in range(count):
            if used[j] == WEIGHT:
                continue
            total, tail = spread(0.0), spread(0.0)
            for n in range(RIGHT):
                part = get(lower, n) * get(pushed[j], n)
                total = total + part
                if n == BUBBLES - 1 or n == BUBBLES - 2:
                    tail = tail + abs(part)
            k = NUMBERS * i + used[j]
            put(sums, k, get(sums, k) + select(own, total, 0.0))
            put(tails, k, get(tails, k) + select(own, tail, 0.0))
    put(carried, 0, select(own, get(bent, SIZE * (SIZE + 1) // 2 - 1), get(carried, 0)))
    for j in range(count):
        put(carried, 1 + j, select(own, get(pushed[j], RIGHT), get(carried, 1 + j)))

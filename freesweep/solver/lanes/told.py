"""What is told of a state's derivatives, for a vector of designs, from what :mod:`element` summed and eliminated: values,
and what they may miss.

That is, of each of them: of what FEWER bubbles lose; of the force that the loads leave, together, by what each number
answers with; of how rough the sums are; of where families go slack; and rounding. The middle of a long tube answers as the
uniform tube does, but for what is left of the layer there.
"""

from math import sqrt

from ...jit import kernel
from ..numerics.nested import TINY
from .element import LOST, PIVOT, SQUARES, gather
from .second import BY_Y, LOADS, NUMBERS, OF_LOADS, VV, YY
from .vector import get, put, select, spread

OUTPUTS = LOADS + 1
TOLD = NUMBERS + 2  # of each: itself, its derivatives by the numbers, and by the length
# depth from which on the middle is the uniform tube's; times what is left of a layer there
UNIFORM, SHALLOW = 17.0, 12.0
SAFETY, ALIKE = 0.25, 0.03  # of what FEWER bubbles lose; and of the most that this may be of a push in the middle
FORCED, ROUGH = 10.0, 4.0  # times the force that is left; and what is not smooth
ENDS, ROUNDING, FAINT = 3e-9, 1e-11, 1e-14  # of where ends of slack lie, of numbers, and of the drive of the middle
CLOSE = 1e-10  # of the strain in the middle, that may be wrong


@kernel
def finish(mid, rest, loose, load, half, own, out):
    """Add the ``rest`` of the half, which is uniform, as the rows of the middle tell, and write what is told: ``out``
    (2, OUTPUTS TOLD, WIDTH), values and what they may miss. Returns how the middle grows with the length. Where ``loose``,
    a family goes slack along the tube; ``own`` is the :class:`.element.Variation`.
    """
    rows, carried, sums, used = own.rows[1], own.carried, own.sums, own.used
    gather(rest, rows, used, sums[0])
    pulls, strain, stiff = (load.f, load.p, load.m, load.e), 1.0 - mid.y, -get(rows, YY)
    pivot = 1.0 / (get(carried[0], PIVOT) + rest * stiff)
    fewer_pivot = 1.0 / (get(carried[1], PIVOT) + rest * stiff)
    work = close(rest, pivot, fewer_pivot, pulls, abs(stiff) * half * strain * strain, own)
    missed = FORCED * force_left(pulls, work, used, sums[1], own.left) + select(loose, ENDS, 0.0) + ROUNDING
    drive = -mid.rise * mid.s
    wrong = abs(drive * pivot) * (abs(rest) + missed * half)  # a half that sums miss has another middle
    grown, doubt = growth(mid, load, drive, pivot, fewer_pivot, missed, wrong, rows)
    tell_loads(half, grown, doubt, wrong, missed, own, out)
    tell_middle(mid, half, pivot, fewer_pivot, missed, own, out)
    first = TOLD * LOADS + TOLD - 1
    put(out[0], first, grown)
    put(out[1], first, doubt)
    return drive * pivot


@kernel
def close(rest, pivot, fewer_pivot, pulls, work, own):
    """Eliminate the middle, too. Returns the ``work`` of the state, by which forces are measured, and that of its loads."""
    used, rows, carried, known, answers = own.used, own.rows[1], own.carried, own.known, own.sums[1]
    count = len(used)
    for j in range(count):
        more = rest * get(rows, BY_Y + used[j])
        push, fewer = get(carried[0], 1 + j) + more, get(carried[1], 1 + j) + more
        put(carried[0], 1 + j, push)
        put(carried[1], 1 + j, fewer)
        put(known[SQUARES], j, max(get(known[SQUARES], j) + push * push * pivot, 0.0))
        put(known[LOST], j, abs(get(known[LOST], j) + push * push * pivot - fewer * fewer * fewer_pivot))
    for i in range(LOADS):
        one = count - LOADS + i
        push = get(carried[0], 1 + one) * pivot
        work = work + pulls[i] * pulls[i] * get(known[SQUARES], one)
        for j in range(count - 1):
            n = NUMBERS * i + used[j]
            put(answers, n, get(answers, n) + push * get(carried[0], 1 + j))
    return max(work, TINY)


@kernel
def force_left(pulls, work, used, answers, left):
    """What the loads leave together by what each number answers with, ``left`` (numbers, WIDTH), over the root of the
    ``work``; returns its largest share of that of a load.
    """
    count, most, root = len(used), spread(0.0), 1.0 / sqrt(work)
    for j in range(count - 1):
        own = spread(0.0)
        for i in range(LOADS):
            own = own + pulls[i] * get(answers, NUMBERS * i + used[j])
        put(left, j, abs(own) * root)
        if j >= count - LOADS:
            most = max(most, abs(pulls[j - count + LOADS] * own) / work)
    own = spread(0.0)
    for i in range(LOADS - 1):
        own = own + pulls[i] * get(left, count - LOADS + i)
    put(left, count - 1, own)  # what is left of the energy is so of the loads
    return most


@kernel
def tell_loads(half, grown, doubt, wrong, missed, own, out):
    """Write what loads are conjugate to, and its derivatives; ``grown`` is how the middle grows with the length, but for
    its ``doubt``; the middle itself may be ``wrong``.
    """
    used, rows, carried, sums, known, left, rough = (
        own.used, own.rows[1], own.carried, own.sums, own.known, own.left, own.rough
    )  # fmt: skip
    count = len(used)
    for i in range(LOADS):
        one, sign = count - LOADS + i, -1.0 if i == LOADS - 1 else 1.0
        value = get(sums[0], LOADS * NUMBERS + i)
        put(out[0], TOLD * i, sign * value)
        bend = ROUGH * get(rough[0], i) / (get(rough[1], i) + TINY)
        bent = bend * abs(value - half * get(rows, OF_LOADS + LOADS * NUMBERS + i))
        put(out[1], TOLD * i, missed * abs(value) + bent)
        for j in range(count - 1):
            n = NUMBERS * i + used[j]
            fixed, answer = get(sums[0], n), get(sums[1], n)
            lost = sqrt(get(known[LOST], one) * get(known[LOST], j))
            first, other = sqrt(get(known[SQUARES], one)), sqrt(get(known[SQUARES], j))
            forced = FORCED * (get(left, one) * other + get(left, j) * first)
            bent = bend * abs(fixed - half * get(rows, OF_LOADS + n))
            put(out[0], TOLD * i + 1 + used[j], sign * (fixed + answer))
            put(out[1], TOLD * i + 1 + used[j], SAFETY * lost + forced + bent + missed * (abs(fixed) + first * other))
        value = get(rows, OF_LOADS + LOADS * NUMBERS + i) + grown * get(carried[0], 1 + one)
        put(out[0], TOLD * i + TOLD - 1, sign * value)
        there = wrong * abs(get(rows, BY_Y + used[one])) + doubt * abs(get(carried[0], 1 + one))
        put(out[1], TOLD * i + TOLD - 1, missed * abs(value) + there)


@kernel
def growth(mid, load, drive, pivot, fewer_pivot, missed, wrong, rows):
    """How the middle grows with the length, and what that may miss where the middle is ``wrong`` by so much."""
    stiff, shallow = -get(rows, YY), SHALLOW * mid.depth * mid.q
    even = 1.0 / sqrt(max(-stiff * get(rows, VV), TINY))  # of a long tube that falls toward its middle
    faint = FAINT * (load.p * mid.y * mid.y + abs(load.f))
    uniform = mid.depth > UNIFORM
    short = shallow * abs(drive) + faint + 2.0 * mid.q * abs(1.0 - mid.y) * stiff
    near = abs(drive) * SAFETY * abs(pivot - fewer_pivot) + (faint + abs(stiff) * wrong) * abs(pivot)
    grown = select(uniform, drive * even, drive * pivot)
    return grown, missed * abs(grown) + select(uniform, abs(even) * short, near)


@kernel
def tell_middle(mid, half, pivot, fewer_pivot, missed, own, out):
    """Write the stretch of the middle and its derivatives: the uniform tube's where less is missed so."""
    used, rows, carried, known = own.used, own.rows[1], own.carried, own.known
    count, first, stiff = len(used), TOLD * LOADS, -get(rows, YY)
    lost = abs(pivot - fewer_pivot)  # of what the middle answers with to a push
    put(out[0], first, mid.y)
    put(out[1], first, CLOSE * abs(1.0 - mid.y) + ROUNDING)
    shallow = SHALLOW * mid.depth * mid.q
    for j in range(count - 1):
        push, even, square = get(carried[0], 1 + j) * pivot, get(rows, BY_Y + used[j]) / stiff, get(known[SQUARES], j)
        typical = sqrt(square / (abs(stiff) * half))
        doubt = SAFETY * abs(push - get(carried[1], 1 + j) * fewer_pivot)
        doubt = doubt + ALIKE * sqrt(lost * get(known[LOST], j))
        of_even = shallow * (abs(even) + typical)
        put(out[0], first + 1 + used[j], select(of_even < doubt, even, push))
        put(out[1], first + 1 + used[j], min(doubt, of_even) + missed * (abs(push) + typical))

"""Graded nodes of :mod:`freesweep.solver.numerics.mesh` for a vector of designs; see there for why.

The inverse of a monotone piecewise linear function is written as a sum of ramps, one for each cell: no search, no branch.
"""

from math import sqrt

from ...jit import kernel
from .vector import get, put, select, spread

SMOOTHINGS = 5  # passes over the cell sizes


@kernel
def even_out(x, n, size):
    """Let neighbouring cells differ little: geometric means, so that a jump over decades becomes a slope."""
    start, length = get(x, 0), get(x, n) - get(x, 0)
    for j in range(n):
        put(size, j, get(x, j + 1) - get(x, j))
    for _ in range(SMOOTHINGS):
        left = get(size, 0)
        for j in range(n):
            here = get(size, j)
            put(size, j, sqrt(here * sqrt(left * get(size, min(j + 1, n - 1)))))
            left = here
    total = spread(0.0)
    for j in range(n):
        total = total + get(size, j)
    share = length / total
    for j in range(n - 1):
        start = start + get(size, j) * share
        put(x, j + 1, start)


@kernel
def split(x, n, factor, out):
    """Split each of n cells into ``factor`` through cubics whose slopes dx/dz are harmonic means of the cells beside."""
    before = get(x, 1) - get(x, 0)
    h = before
    for j in range(n):
        here = get(x, j)
        after = get(x, j + 2) - get(x, j + 1) if j < n - 1 else h
        left = 2.0 * before * h / (before + h)
        right = 2.0 * h * after / (h + after)
        put(out, j * factor, here)
        for i in range(1, factor):
            t = i / factor
            bend = t * (1.0 - t) * ((1.0 - t) * left - t * right)
            put(out, j * factor + i, here + h * (t * t * (3.0 - 2.0 * t)) + bend)
        before, h = h, after
    put(out, n * factor, get(x, n))


@kernel
def prolong(x, y, n, fine_x, out):
    """First guess on twice as many cells: the cubic through four neighbours."""
    for j in range(n):
        k = min(max(j - 1, 0), n - 3)
        xa, xb, xc, xd = get(x, k), get(x, k + 1), get(x, k + 2), get(x, k + 3)
        at = get(fine_x, 2 * j + 1)
        a, b, c, d = at - xa, at - xb, at - xc, at - xd
        ab, ac, ad, bc, bd, cd = xa - xb, xa - xc, xa - xd, xb - xc, xb - xd, xc - xd
        left, right = a * b, c * d
        put(out, 2 * j, get(y, j))
        put(
            out,
            2 * j + 1,
            right * (get(y, k) * b / (ab * ac * ad) - get(y, k + 1) * a / (ab * bc * bd))
            + left * (get(y, k + 2) * d / (ac * bc * cd) - get(y, k + 3) * c / (ad * bd * cd)),
        )
    put(out, 2 * n, get(y, n))


@kernel
def sine(integrands, x, y, j, cell, load):
    """Sine of the meridian's angle in cell j."""
    v = (get(y, j + 1) - get(y, j)) / (get(x, j + 1) - get(x, j))
    s = integrands(0.5 * (get(y, j) + get(y, j + 1)), v, cell, load)[0]
    return v / sqrt(s * s + v * v)


@kernel
def halve(integrands, x, y, n, cell, load, fine_x, out):
    """An admissible guess on twice as many cells: marched along the meridian's angle, so that no slope can be too steep."""
    here = sine(integrands, x, y, 0, cell, load)
    after = sine(integrands, x, y, 1, cell, load)
    flat, flat_after = 1.0 - abs(here), 1.0 - abs(after)
    before = select(here < 0.0, spread(-1.0), spread(1.0)) * (1.0 - min(flat * flat / flat_after, 1.0))
    at = get(y, 0)
    put(out, 0, at)
    for j in range(n):
        after = sine(integrands, x, y, j + 1, cell, load) if j < n - 1 else 0.0 * here
        for half in range(2):
            i = 2 * j + half
            turned = 0.75 * here + 0.25 * (before if half == 0 else after)
            h = get(fine_x, i + 1) - get(fine_x, i)
            room = integrands(at, 0.0, cell, load)[0]
            room = integrands(at + 0.5 * h * turned * room, 0.0, cell, load)[0]
            at = at + h * turned * room
            put(out, i + 1, at)
        before, here = here, after


@kernel
def merge(integrands, x, y, n, cell, load, out):
    """An admissible guess on half as many cells, marched along the mean of the meridian's angles."""
    at = get(y, 0)
    put(out, 0, at)
    for i in range(n // 2):
        turned = 0.5 * (sine(integrands, x, y, 2 * i, cell, load) + sine(integrands, x, y, 2 * i + 1, cell, load))
        h = get(x, 2 * i + 2) - get(x, 2 * i)
        room = integrands(at, 0.0, cell, load)[0]
        room = integrands(at + 0.5 * h * turned * room, 0.0, cell, load)[0]
        at = at + h * turned * room
        put(out, i + 1, at)

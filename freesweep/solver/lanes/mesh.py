"""Graded nodes of :mod:`freesweep.solver.mesh` for a vector of designs; see there for why.

The inverse of a monotone piecewise linear function is written as a sum of ramps, one for each cell: no search, no branch.
"""

from math import sqrt

from ...jit import kernel
from ..mesh import EVEN_SHARE, SMOOTHINGS, TAIL_SHARE
from .vector import get, put, select, spread


@kernel
def turning(integrands, x, y, n, free, cell, load, sine, slant, out):
    """Root of the meridian's turning |d(angle)/dx| (1 + |tan(angle)|) in each cell."""
    for j in range(n):
        v = (get(y, j + 1) - get(y, j)) / (get(x, j + 1) - get(x, j))
        s = integrands(0.5 * (get(y, j) + get(y, j + 1)), v, cell, load)[0]
        per_cosine = sqrt(s * s + v * v) / s
        put(sine, j, v / (s * per_cosine))
        put(slant, j, per_cosine)
    for j in range(n):
        left, right = max(j - 1, 0), min(j + 1, n - 1)
        change = abs(get(sine, right) - get(sine, left))
        distance = 0.5 * (get(x, right + 1) + get(x, right) - get(x, left + 1) - get(x, left))
        if j == n - 1 and free:  # the slope vanishes in the plane of symmetry
            change, distance = abs(get(sine, left)), get(x, n) - 0.5 * (get(x, left) + get(x, left + 1))
        per_cosine = get(slant, j)
        put(out, j, sqrt(change / distance * (1.0 + abs(get(sine, j)) * per_cosine) * per_cosine))


@kernel
def node_shares(x, n, root, out):
    """How many nodes belong to each cell, from the ``root`` of its turning."""
    largest = spread(1e-150)
    for j in range(n):
        largest = max(largest, get(root, j))
    layer, tail = spread(1e-300), spread(1e-300)
    for j in range(n):
        h = get(x, j + 1) - get(x, j)
        here = get(root, j) / largest
        put(root, j, here)
        put(out, j, sqrt(sqrt(here)))
        layer = layer + h * here
        tail = tail + h * get(out, j)
    even = EVEN_SHARE / (get(x, n) - get(x, 0))
    per_layer, per_tail = (1.0 - TAIL_SHARE - EVEN_SHARE) / layer, TAIL_SHARE / tail
    for j in range(n):
        put(out, j, even + get(root, j) * per_layer + get(out, j) * per_tail)
        put(out, j, get(out, j) * (get(x, j + 1) - get(x, j)))


@kernel
def interpolate(at, n, grid, values, out):
    """Value at each of n - 1 inner places ``at`` of the piecewise linear function through ``values`` on ``grid``: the first
    value and a ramp for each cell.
    """
    for i in range(1, n):
        put(out, i, get(values, 0))
    for j in range(n):
        start, rise = get(grid, j), get(values, j + 1) - get(values, j)
        per_width = 1.0 / (get(grid, j + 1) - start)
        for i in range(1, n):
            ramp = min(max((get(at, i) - start) * per_width, 0.0), 1.0)
            put(out, i, get(out, i) + ramp * rise)


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
def adapt(integrands, x, y, n, free, cell, load, work, new_x, new_y):
    """Spread n cells to where the solution bends, and carry it over, linearly: ``new_x`` and ``new_y``."""
    root, share, scratch = work[0], work[1], work[2]
    turning(integrands, x, y, n, free, cell, load, share, scratch, root)
    node_shares(x, n, root, share)
    total = spread(0.0)
    for j in range(n):  # nodes up to each old node, in scratch; where the new ones belong, in root
        put(scratch, j, total)
        total = total + get(share, j)
    put(scratch, n, total)
    for i in range(n):
        put(root, i, total * (i / n))
    for end in range(2):
        put(new_x, end * n, get(x, end * n))
        put(new_y, end * n, get(y, end * n))
    interpolate(root, n, scratch, x, new_x)
    even_out(new_x, n, share)
    interpolate(new_x, n, x, y, new_y)


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


@kernel
def farthest(x, new_x, n):
    """The longest way of a node to its new place, in cells of the new mesh."""
    longest = spread(0.0)
    for i in range(1, n):
        longest = max(longest, 2.0 * abs(get(new_x, i) - get(x, i)) / (get(new_x, i + 1) - get(new_x, i - 1)))
    return longest

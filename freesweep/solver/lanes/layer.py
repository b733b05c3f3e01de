"""First mesh and shape of a tube, for a vector of designs: what its first integral says of them.

The first integral of a tube that is the same all along is known from the stretch y_m in its middle, and with it the
meridian's angle at every other stretch (theory: section 4), with T = p y^2 + f and L of
:mod:`freesweep.solver.physics.lagrangian`::

    T G/s - a w + m psi = L(y_m, 0)
    cos(angle) = s/sqrt(G) = T sqrt(G)/(T sqrt(G) + d),    d = L(y_m, 0) - L(y, 0)

The layer at an end falls as exp(-k x) toward the uniform stretch u, to meet that of the other end in the middle::

    y = u - (u - 1) (z + q^2/z)/(1 + q^2),    z = exp(-depth),    q = exp(-depth of the middle)

By the depth, the way x along the tube is the integral of a smooth function. The depth of the middle is found so that
it ends there. Nodes are spread by the densities of :mod:`freesweep.solver.numerics.mesh`.
"""

from math import exp, sqrt

from ...jit import kernel
from ..numerics.mesh import EVEN_SHARE, TAIL_SHARE
from ..physics import lagrangian
from .mesh import even_out
from .vector import WIDTH, get, put, select, some, spread

DEPTHS = 24
FIRST_STEP, FIRST_STRETCH, FIRST_SHARE = 0.03, 0.3, 0.3  # largest first step: of depth, of y, of equal steps
DEEPEST = 36.0  # where nothing is left of the layer
FITS, CLOSE = 8, 2e-3  # for the depth of the middle: trials, and the share of the layer that may be wrong there
CERTAIN = 1e-9  # share of L from which d is more than rounding; below it the layer is an exponential
TINY = 1e-300


@kernel
def end_cosine(u, cell, load):
    """Cosine of the meridian's angle at the end of a long tube of uniform stretch ``u``; of one float too."""
    _, _, most = lagrangian.uniform_tube(u, cell, load)
    _, pull, here = lagrangian.uniform_tube(1.0, cell, load)
    return pull / (most - here + pull)


@kernel
def depths(last, swelling, scratch):
    """The depths ``step j + bend j^3``, finer where the layer begins, and what makes z = exp(-depth) step by step:
    ``(step, bend, factor of z, its factor, z in the end)``.
    """
    step = min(min(FIRST_STEP, FIRST_STRETCH / (swelling + TINY)), FIRST_SHARE / DEPTHS * last)
    bend = (last - step * DEPTHS) / DEPTHS**3
    put(scratch, 0, step + bend)
    put(scratch, 1, 6.0 * bend)
    put(scratch, 2, last)
    for k in range(3):
        for lane in range(WIDTH):
            scratch[k, lane] = exp(-scratch[k, lane])
    return step, bend, get(scratch, 0), get(scratch, 1), get(scratch, 2)


@kernel
def descend(u, rate, depth, cell, load, places, sine, slant, left, fall, scratch):
    """Along the layer, from its beginning to ``depth``: the places, sine and 1/cosine of the meridian's angle, and what is
    ``left`` of the way to u, which falls by ``fall`` per length.

    Returns the last place and q.
    """
    swelling = abs(u - 1.0)
    step, bend, factor, growth, q = depths(depth, swelling, scratch)
    steeper = growth
    image = q * q
    whole = 1.0 / (1.0 + image)
    _, _, most = lagrangian.uniform_tube(u - (u - 1.0) * 2.0 * q * whole, cell, load)
    at, before, z = spread(0.0), 1.0 / rate, spread(1.0)
    for j in range(DEPTHS + 1):
        other = image / z
        rest, rise = (z + other) * whole, (z - other) * whole
        stretch, pull, here = lagrangian.uniform_tube(u - (u - 1.0) * rest, cell, load)
        d = most - here
        certain = (d > CERTAIN * (abs(most) + pull)) & (rise > 0.0)
        turned = sqrt(max(d * (d + 2.0 * pull), 0.0)) / (d + pull)
        per_depth = select(certain, swelling * rise / (turned * stretch), before)  # dx/d(depth)
        if j > 0:
            at = at + 0.5 * (step + (3 * j * (j - 1) + 1) * bend) * (before + per_depth)
        put(places, j, at)
        put(sine, j, select(certain, turned, swelling * abs(rise) / (per_depth * stretch)))
        put(slant, j, select(certain, (d + pull) / pull, spread(1.0)))
        put(left, j, rest)
        put(fall, j, -rise / per_depth)
        before = per_depth
        z, factor, growth = z * factor, factor * growth, growth * steeper
    return at, q


@kernel
def end_layer(u, rate, half, cell, load, places, sine, slant, left, fall, scratch):
    """The layer in half a tube, as :func:`descend` gives it, stretched a little where the middle is not met exactly."""
    depth = min(rate * half, DEEPEST)
    depth_before, miss_before = spread(0.0), half
    for _ in range(FITS):
        at, q = descend(u, rate, depth, cell, load, places, sine, slant, left, fall, scratch)
        miss = half - at
        wrong = abs(miss) * rate * q > CLOSE
        if not some(wrong):
            break
        slope = (miss - miss_before) / (depth - depth_before)
        trial = depth - miss / select(slope < 0.0, slope, -1.0 / rate)
        trial = min(max(trial, 0.3 * depth), min(3.0 * depth, DEEPEST))
        depth_before, miss_before = select(wrong, depth, depth_before), select(wrong, miss, miss_before)
        depth = select(wrong, trial, depth)
    factor = select((depth < DEEPEST) | (at > half), half / at, spread(1.0))
    for j in range(DEPTHS + 1):
        put(places, j, get(places, j) * factor)
        put(fall, j, get(fall, j) / factor)


@kernel
def node_shares(places, half, sine, slant, root, out):
    """Nodes up to each depth, of one in all, from the root of the meridian's turning."""
    largest = spread(TINY)
    for j in range(DEPTHS):
        change = abs(get(sine, j + 1) - get(sine, j))
        h = get(places, j + 1) - get(places, j)
        per_cosine = 0.5 * (get(slant, j) + get(slant, j + 1))
        turned = 0.5 * (get(sine, j) + get(sine, j + 1))
        here = sqrt(change / h * (1.0 + turned * per_cosine) * per_cosine)
        put(root, j, here)
        largest = max(largest, here)
    layer, tail = spread(TINY), spread(TINY)
    for j in range(DEPTHS):
        h = get(places, j + 1) - get(places, j)
        here = get(root, j) / largest
        eighth = sqrt(sqrt(here))
        put(root, j, here)
        put(out, j + 1, eighth)
        layer = layer + h * here
        tail = tail + h * eighth
    per_layer, per_tail, even = (1.0 - TAIL_SHARE - EVEN_SHARE) / layer, TAIL_SHARE / tail, EVEN_SHARE / half
    total = spread(0.0)
    put(out, 0, total)
    for j in range(DEPTHS):
        h = get(places, j + 1) - get(places, j)
        total = total + h * (even + get(root, j) * per_layer + get(out, j + 1) * per_tail)
        put(out, j + 1, total)


@kernel
def spread_nodes(places, shares, half, n, x):
    """Nodes by their ``shares``, as a sum of one ramp for each depth; those that are left lie behind the last depth."""
    last, reached = get(places, DEPTHS), get(shares, DEPTHS)
    per_share = 1.0 / max(1.0 - reached, TINY)
    for i in range(1, n):
        put(x, i, (half - last) * max((i / n - reached) * per_share, 0.0))
    for j in range(DEPTHS):
        rise, before = get(places, j + 1) - get(places, j), get(shares, j)
        per_share = 1.0 / (get(shares, j + 1) - before)
        for i in range(1, n):
            put(x, i, get(x, i) + rise * min(max((i / n - before) * per_share, 0.0), 1.0))
    put(x, 0, 0.0)
    put(x, n, half)


@kernel
def remains(places, left, fall, x, n, out):
    """What is ``left`` at the nodes 1 to n: cubics between the depths, as sums of one ramp for each."""
    for i in range(1, n + 1):
        put(out, i, 1.0)
    for j in range(DEPTHS):
        start, h, rise = get(places, j), get(places, j + 1) - get(places, j), get(left, j + 1) - get(left, j)
        per_h, before, after = 1.0 / h, h * get(fall, j), h * get(fall, j + 1)
        for i in range(1, n + 1):
            t = min(max((get(x, i) - start) * per_h, 0.0), 1.0)
            bend = t * (1.0 - t) * ((1.0 - t) * before - t * after)
            put(out, i, get(out, i) + rise * (t * t * (3.0 - 2.0 * t)) + bend)


@kernel
def begin(u, cell, load, half, n, work, more, x, y):
    """Mesh and shape of half a tube of uniform stretch ``u`` on n cells. ``work`` and ``more`` are scratch: (4, > n,
    WIDTH), (4, ...), with more rows than DEPTHS.
    """
    places, sine, slant, left = work[0], work[1], work[2], work[3]
    fall, root, shares, scratch = more[0], more[1], more[2], more[3]
    _, _, _, L_yy, _, L_vv = lagrangian.density(u, 0.0, cell, load)
    rate = sqrt(max(L_yy / L_vv, 1e-12))
    end_layer(u, rate, half, cell, load, places, sine, slant, left, fall, scratch)
    node_shares(places, half, sine, slant, root, shares)
    spread_nodes(places, shares, half, n, x)
    even_out(x, n, root)
    remains(places, left, fall, x, n, root)
    put(y, 0, 1.0)
    for i in range(1, n + 1):
        put(y, i, u - (u - 1.0) * get(root, i))

"""The branch of a tube that is the same all along, traced by its first integral in steps of the stretch in the middle.

That stretch goes on through a turning point of the load, and to each one belongs one load, whatever a mesh would make of the
shape. Where the walk on meshes ends without an answer, this tells whether the branch turned back, and gives a guess.
"""

from math import exp, log

import numpy as np

from ...jit import kernel
from ..guide import cell_along
from ..numerics import mesh
from ..numerics.properties_along import fill
from ..physics import lagrangian
from ..physics.uniform_tube import between
from . import meridian, shape_beside

LEAST_DRIVE = 1e-10  # of its size at the end: below it lies rounding
FIRST_FOLDS, LONG = 3.0, 3.5  # e-folds of the drive: first step; up to which the middle is as good as a uniform tube's
PROBE = 1e-3  # of the way
FARTHEST = 10.0  # times the load asked for and the way there
FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 1e-3, 0.01, 1e-7  # relative changes of the middle
TURNING_STEP = 1e-4  # with which a turning point is looked at: behind it the load may soon rise again
SLOWER = 0.5  # times the gain per step before: less needs smaller steps
LOOKS, FRONT = 400, 1e-3  # places along the meridian; share of what R was nearer to the middle
MOST_STEPS = 2000
LARGEST_GAIN = 0.25  # of the way in one step
ARRIVES = 1e-6
GOLDEN, GOLDEN_STEPS = 0.381966, 20
LOST, ARRIVED, TURNED = 0, 1, 2


@kernel
def load_for(cell, y, sign, drive, start, end, t):
    """The part of the way from load ``start`` to ``end`` at which ``sign U'(y)`` is ``drive``, near ``t``; NaN if none.

    What is too far away counts in loads: on a short way it is many times the way.
    """
    size = abs(end.p) + abs(end.f) + abs(end.m)
    farthest = FARTHEST * (1.0 + size / (abs(end.p - start.p) + abs(end.f - start.f) + abs(end.m - start.m)))
    for _ in range(20):
        here = sign * lagrangian.density(y, 0.0, cell, between(start, end, t))[1] - drive
        after = sign * lagrangian.density(y, 0.0, cell, between(start, end, t + PROBE))[1] - drive
        change = here * PROBE / (here - after)
        t += change
        if not abs(t) < farthest:
            return np.nan
        if abs(change) < 1e-12:
            return t
    return np.nan


@kernel
def middle_at(cell, middle, start, end, t, half, nodes, curve):
    """The part of the way, near ``t``, at which the ``middle`` of a tube of that ``half`` length is reached, and the number
    of cells of its ``curve``; NaN and 0 where none was found.

    The half length falls as the drive U' in the middle grows, evenly with its logarithm.
    """
    sign = 1.0 if middle >= 1.0 else -1.0
    reach = abs(middle - 1.0)
    load = between(start, end, t)
    _, _, _, bend, _, _ = lagrangian.density(middle, 0.0, cell, load)
    size = abs(bend) * reach + abs(lagrangian.density(1.0, 0.0, cell, load)[1])
    low, high, miss_low, miss_high = log(LEAST_DRIVE * size), 0.0, 1.0, -1.0
    first, at, bracketed = low, low, False
    for _ in range(meridian.ROOT_STEPS):
        drive = exp(at)
        part = load_for(cell, middle, sign, drive, start, end, t)
        total = np.nan
        if part == part:
            load = between(start, end, part)
            bend = -lagrangian.density(middle, 0.0, cell, load)[3]
            scale = min(drive / bend, reach) if bend > 0.0 else reach
            total = meridian.trace(
                cell, load, middle, drive, 0.0, max(scale, 1e-12 * reach), nodes, meridian.CROWDING, curve
            )
        if total <= half and at < first + LONG:  # so long a tube that its middle is a uniform one's
            return part, meridian.lengthened(curve, half, nodes)
        miss = total / half - 1.0 if total == total else FARTHEST
        if abs(miss) < meridian.HALF_FITS:
            return part, meridian.scaled(curve, half, nodes)
        if miss > 0.0:
            low, miss_low, miss_high = at, min(miss, FARTHEST), 0.5 * miss_high
        else:
            high, miss_high, miss_low, bracketed = at, miss, 0.5 * miss_low, True
        if not bracketed:
            at = low + FIRST_FOLDS
        elif miss_low > 1.0 or miss_high < -0.5:
            at = 0.5 * (low + high)
        else:
            at = (low * miss_high - high * miss_low) / (miss_high - miss_low)
    return np.nan, 0


@kernel
def fronted(cell, middle, load):
    """Whether R of :mod:`meridian` all but vanishes on the way from the middle to the end, where it rises again or ends.

    Another stretch balances that of the middle there. Between the two lies a front that a long tube holds anywhere: its
    branch turns back.
    """
    at_middle, most = lagrangian.uniform_tube(middle, cell, load)[2], 0.0
    for k in range(1, LOOKS + 1):
        R = at_middle - lagrangian.uniform_tube(middle + (1.0 - middle) * k / LOOKS, cell, load)[2]
        if R < FRONT * most:
            return True
        most = max(most, R)
    return False


@kernel
def top(cell, low, best, high, t_best, start, end, half, nodes, curve):
    """The middle between ``low`` and ``high``, about ``best``, to which the largest part of the way belongs, and that part;
    or the first one seen beyond the end.
    """
    for _ in range(GOLDEN_STEPS):
        at = best + GOLDEN * ((high - best) if abs(high - best) > abs(low - best) else (low - best))
        t, _ = middle_at(cell, at, start, end, t_best, half, nodes, curve)
        upward = (at - best) * (high - low) > 0.0
        if t > t_best:
            low, high = (best, high) if upward else (low, best)
            best, t_best = at, t
        elif upward:
            high = at
        else:
            low = at
        if t_best >= 1.0:
            break
    return best, t_best


@kernel
def by_load(cell, start, end, near, t, half, nodes, curve):
    """As :func:`follow`, from a part ``t`` of the way on in steps of the load: where the middle stands still, or turns."""
    step = FIRST_STEP
    for _ in range(MOST_STEPS):
        ahead = min(1.0, t + step)
        load = between(start, end, ahead)
        u, middle, count = shape_beside.stationary(cell, load, near), np.nan, 0
        if u == u:
            count = meridian.fit(cell, load, u, half, nodes, curve)
            middle = curve[1, count] if count > 0 else np.nan
        else:
            middle = shape_beside.fit_near(cell, load, near, half, meridian.HALF_FITS, nodes, meridian.CROWDING, curve)
            count = nodes
        if shape_beside.is_near(middle, near):
            near, t, step = middle, ahead, 2.0 * step
            if t == 1.0:
                return ARRIVED, 1.0, count
        else:
            step *= 0.5
            if step < SMALLEST_STEP:
                break
    load = between(start, end, t)
    u = shape_beside.stationary(cell, load, near)
    if u == u and fronted(cell, near, load):
        count = meridian.fit(cell, load, u, half, nodes, curve)
        return (TURNED if count > 0 else LOST), t, count
    return LOST, t, 0


@kernel
def follow(cell, start, end, origin, half, nodes, curve):
    """The branch from a tube whose middle is ``origin`` at load ``start`` toward ``end``, in steps of its middle: these rise
    through a turning point of the load.

    Returns ``(what, part of the way, cells of the curve)``: ARRIVED with the shape at the end, TURNED with that at the
    turning point, else LOST.
    """
    before = lagrangian.density(origin, 0.0, cell, start)[1]
    drive = lagrangian.density(origin, 0.0, cell, between(start, end, PROBE))[1] - before
    ahead = 1.0 if drive > 0.0 else -1.0
    last, near, far = origin, origin, origin
    t_near, t_far = 0.0, 0.0
    step, rate = FIRST_STEP, 0.0
    for _ in range(MOST_STEPS):
        far = near + ahead * step * near
        t_far, count = middle_at(cell, far, start, end, t_near, half, nodes, curve)
        if not abs(t_far - t_near) < LARGEST_GAIN:
            step *= 0.25
            if step < SMALLEST_STEP:
                if near != origin and fronted(cell, near, between(start, end, t_near)):
                    t_near, count = middle_at(cell, near, start, end, t_near, half, nodes, curve)
                    return (TURNED if count > 0 else LOST), t_near, count
                return by_load(cell, start, end, near, t_near, half, nodes, curve)
            continue
        if t_far - t_near < SLOWER * rate * step and step > TURNING_STEP:
            step *= 0.5
            continue
        if t_far >= 1.0 or t_far <= t_near:
            break
        last, near, rate, t_near = near, far, (t_far - t_near) / step, t_far
        step = min(1.5 * step, LARGEST_STEP)
    if not (t_far >= 1.0 or t_far <= t_near):
        return LOST, t_near, 0
    best, t_best = far, t_far
    if t_far < 1.0:
        best, t_best = top(cell, last, near, far, t_near, start, end, half, nodes, curve)
        if t_best < 1.0:
            t_best, count = middle_at(cell, best, start, end, t_best, half, nodes, curve)
            return (TURNED if count > 0 else LOST), t_best, count
    low, high, miss_low, miss_high = near, best, t_near - 1.0, t_best - 1.0
    for _ in range(meridian.ROOT_STEPS):
        at = (low * miss_high - high * miss_low) / (miss_high - miss_low)
        t, count = middle_at(cell, at, start, end, 1.0, half, nodes, curve)
        if not abs(t - 1.0) > ARRIVES:
            break
        if t > 1.0:
            high, miss_high, miss_low = at, t - 1.0, 0.5 * miss_low
        else:
            low, miss_low, miss_high = at, t - 1.0, 0.5 * miss_high
    return (ARRIVED if count > 0 else LOST), 1.0, count


@kernel
def trail(tube, before, load, origin, nodes, x, y, curve, work):
    """Mesh and shape at ``load``, or at the turning point on the way there: ``(what, part of the way, middle)``; by so many
    ``nodes`` along the meridian.
    """
    cell = cell_along(tube, 0.0)
    n = len(x) - 1
    what, part, count = follow(cell, before, load, origin, tube.places[1], nodes, curve)
    middle = origin
    if what != LOST:
        middle, now = curve[1, count], between(before, load, part)
        own = fill(tube.course, tube.edges, x, n, n, tube.cells)
        meridian.spread(curve, count, cell, now, n, x, y, work)
        mesh.ease(lagrangian.integrands, x, y, n, work[0], own, now)
    return what, part, middle

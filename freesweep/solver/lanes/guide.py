"""The uniform tube of :mod:`freesweep.solver.uniform` as a guide, for a vector of designs.

L_y and L_yy are linear in pressure, force and torque: their values at the two ends of a path give them all along it. Where
the fibers' extension changes, Newton's method finds the place on it.
"""

from ...jit import kernel
from .. import lagrangian
from ..guide import FAR_FROM, STRAY
from ..uniform import BENDS, FAR, ITERATIONS, LARGEST_CHANGE, PROBE, SCAN, between
from ..wall import is_loose
from .vector import HUGE, get, mask_of, select, some, spread

FIRST_STEP = 1.0  # of the way: pressures of a sweep lie close
GLANCE = 0.06  # relative change of the stretch between two looks at the slope, where that is even:
EVEN = 0.5  # its smallest value is more than this share of the largest
SMALLEST_STEP = 1e-4  # of the way; below it a lane is left to the scalar kernels
SMALLEST_LOOSE = 0.04  # of tubes with loose fibers, whose density is dear: smaller steps hardly ever arrive


@kernel
def scan(u, change, samples, cell, start, end, half, asked):
    """Where the load rises at all so many ``samples`` of the way, and between them; its smallest and largest slope."""
    risen, least, most = asked, spread(HUGE), spread(0.0)
    first, second = spread(0.0), spread(0.0)
    drawn = lagrangian.drawn_in(cell, end)
    bent = asked & (
        abs(end[0] - start[0]) > 0.0
    )  # the fibers' extension is no linear load, and loose ones bear none so
    if is_loose(end[2]):
        bent = asked
    ahead = select(change > 0.0, spread(1.0), spread(-1.0))
    i = 0
    while True:
        within = asked & (samples + 1.0 > i)
        if not some(within):
            break
        here = u + change * min(i / samples, 1.0)
        _, L_y, _, L_yy, _, L_vv = lagrangian.density(here, 0.0, cell, start)
        _, end_y, _, end_yy, _, end_vv = lagrangian.density(here, 0.0, cell, end)
        drive = end_y - L_y
        t = -L_y / drive
        L_yy, L_vv = L_yy + t * (end_yy - L_yy), L_vv + t * (end_vv - L_vv)
        if some(bent):
            for _ in range(BENDS):
                _, here_y, _, here_yy, _, here_vv = lagrangian.density(here, 0.0, cell, between(start, end, t))
                there_y = lagrangian.density(here, 0.0, cell, between(start, end, t + PROBE))[1]
                drive = select(bent, (there_y - here_y) / PROBE, drive)
                L_yy, L_vv = select(bent, here_yy, L_yy), select(bent, here_vv, L_vv)
                t = select(bent, t - here_y / drive, t)
        far = L_yy * half * half < FAR * FAR * L_vv
        slope = -L_yy / drive * ahead
        risen = risen & (~within | ((far | (here > drawn)) & (slope > 0.0)))
        if i >= 2:
            dips = within & (second < first) & (second < slope)
            bend = first - 2.0 * second + slope
            low = second - (slope - first) * (slope - first) / (8.0 * bend)
            risen = risen & (~dips | (low > 0.0))
        least, most = select(within, min(least, slope), least), select(within, max(most, slope), most)
        first, second = second, slope
        i += 1
    return risen, least, most


@kernel
def rising(u, trial, cell, start, end, half, asked):
    """Where the load rises all the way from ``u`` to ``trial``: see :func:`uniform.rising`. A few looks tell it where the
    slope hardly changes, which leaves no room for a dip, and the tube is not drawn in.
    """
    change = trial - u
    still = abs(change) < 1e-9 * u
    asked = asked & ~still
    size = abs(change) / min(u, trial)
    risen, least, most = scan(u, change, max(1.0 + size / GLANCE, 2.0), cell, start, end, half, asked)
    unsure = risen & ((least < EVEN * most) | (min(u, trial) < lagrangian.drawn_in(cell, end)))
    if some(unsure):
        risen_all, _, _ = scan(u, change, 2.0 + size / SCAN, cell, start, end, half, unsure)
        risen = risen & (~unsure | risen_all)
    return still | risen


@kernel
def follow(u, cell, start, end, half, asked):
    """Carry the uniform stretch ``u`` from load ``start`` to ``end``; returns it and the lanes that arrived."""
    t, step = spread(0.0), spread(FIRST_STEP)
    smallest = SMALLEST_LOOSE if is_loose(end[2]) else SMALLEST_STEP
    todo, done = asked, mask_of(0)
    while some(todo):
        ahead = min(t + step, 1.0)
        trial, before = u, spread(HUGE)
        going, arrived = todo, mask_of(0)
        for _ in range(ITERATIONS):
            room, L_y, _, L_yy, _, _ = lagrangian.density(trial, 0.0, cell, between(start, end, ahead))
            going = going & (room > 0.0) & (L_yy < 0.0)
            change = -L_y / L_yy
            trial = select(going, trial + change, trial)
            going = going & (abs(trial - u) < LARGEST_CHANGE * u)
            size = abs(change)
            there = going & ((size < 1e-13 * u) | ((size < 1e-10 * u) & (size >= 0.5 * before)))
            arrived, going, before = arrived | there, going & ~there, size
            if not some(going):
                break
        arrived = rising(u, trial, cell, start, end, half, arrived) & arrived
        t, u = select(arrived, ahead, t), select(arrived, trial, u)
        step = select(arrived, 2.0 * step, 0.5 * step)
        done = done | (todo & (t >= 1.0))
        todo = todo & (t < 1.0) & (step > smallest)
    return u, done


@kernel
def within(y, n, u, cell, load, half):
    """Where the shape lies between 1 and the uniform stretch, and its middle near one that draws the tube in while the end
    is far; elsewhere it is another branch.
    """
    slack = STRAY * abs(u - 1.0) + 1e-6
    low, high = spread(HUGE), spread(-HUGE)
    for i in range(n + 1):
        low, high = min(low, get(y, i)), max(high, get(y, i))
    kept = (min(u, 1.0) - slack <= low) & (high <= max(u, 1.0) + slack)
    missed = kept & (u < lagrangian.drawn_in(cell, load)) & (get(y, n) - u > FAR_FROM * (1.0 - u))
    if some(missed):
        _, _, _, L_yy, _, L_vv = lagrangian.density(u, 0.0, cell, load)
        kept = kept & ~(missed & (L_yy * half * half < FAR * FAR * L_vv))
    return kept

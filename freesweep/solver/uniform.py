"""The uniform tube: one number instead of a shape, followed along a straight line in load space.

It is the guide of the walk: where the uniform stretch is carried from one load to the next without a turning point, so is
the tube with clamped ends, and its stretch lies between 1 and the uniform one. Where it is not, the walk goes slowly.
"""

from ..jit import kernel
from .wall import is_loose

FIRST_STEP = 0.25  # of the way from one load to the other
SMALLEST_STEP = 1e-7  # below it the path is taken to end in a turning point
LARGEST_CHANGE = 0.15  # relative change of the stretch in one step; a jump to another branch is larger
ITERATIONS = 12
SCAN = 0.015  # relative change of the stretch between two looks at the slope
BENDS, PROBE = 3, 1e-3  # of Newton's method on a way that is not linear; share of the way to see its slope
FAR = 8.0  # end layers per half tube, up to which clamped ends may turn back a tube that is drawn in


@kernel
def between(start, end, t):
    """The load a fraction ``t`` of the way from ``start`` to ``end``."""
    return (
        start[0] + t * (end[0] - start[0]),
        end[1],
        end[2],
        start[3] + t * (end[3] - start[3]),
        start[4] + t * (end[4] - start[4]),
        start[5] + t * (end[5] - start[5]),
        end[6],
    )


@kernel
def is_far(L_yy, L_vv, half):
    """Whether half a tube of length ``half`` is so many end layers long that its middle does what the uniform tube does."""
    return L_yy * half * half < FAR * FAR * L_vv


@kernel
def may_let_go(u, L_yy, L_vv, half, drawn):
    """Whether half a tube of length ``half`` is drawn in, below the stretch ``drawn``, its clamped end so near that this may
    turn it back.
    """
    return u < drawn and not is_far(L_yy, L_vv, half)


@kernel
def slope_at(density, u, ahead, cell, start, end):
    """Slope dt/du, ``ahead`` (1 or -1) times, of the share t of the way at which the stretch ``u`` is an equilibrium, and
    L_yy and L_vv there: explicit where L_y is linear along the way, as it is in pressure, force and torque.
    """
    before = density(u, 0.0, cell, start)[1]
    drive = density(u, 0.0, cell, end)[1] - before
    t = -before / drive
    if start[0] != end[0] or is_loose(end[2]):  # the fibers' extension is no linear load, and loose ones bear none so
        for _ in range(BENDS):
            here = density(u, 0.0, cell, between(start, end, t))[1]
            drive = (density(u, 0.0, cell, between(start, end, t + PROBE))[1] - here) / PROBE
            t -= here / drive
    _, _, _, L_yy, _, L_vv = density(u, 0.0, cell, between(start, end, t))
    return -L_yy / drive * ahead, L_yy, L_vv


@kernel
def dips(density, u, trial, cell, start, end, half, drawn):
    """Whether the load falls somewhere on the way from ``u`` to ``trial``: a small snap would be passed over. Where half a
    tube of length ``half`` is drawn in, below ``drawn``, its clamped end, which is not, may let go before: there the end has
    to be far.

    A dip of the slope below zero between samples shows in the parabola through three of them.
    """
    count = 2 + int(abs(trial - u) / (SCAN * min(u, trial)))
    ahead, first, second = 1.0 if trial > u else -1.0, 0.0, 0.0
    for i in range(count + 1):
        here = u + (trial - u) * i / count
        slope, L_yy, L_vv = slope_at(density, here, ahead, cell, start, end)
        if not slope > 0.0 or may_let_go(here, L_yy, L_vv, half, drawn):
            return True
        if i >= 2 and second < first and second < slope:
            bend = first - 2.0 * second + slope
            if second - (slope - first) * (slope - first) / (8.0 * bend) <= 0.0:
                return True
        first, second = second, slope
    return False


@kernel
def rising(density, u, trial, cell, start, end, half, drawn):
    """Whether the load rises all the way from ``u`` to ``trial``, as far as that can be told."""
    return abs(trial - u) < 1e-9 * u or not dips(density, u, trial, cell, start, end, half, drawn)


@kernel
def follow(density, u, cell, start, end, half, drawn):
    """Carry the uniform stretch ``u`` from load ``start`` to ``end``; returns it and the fraction reached (1: all)."""
    t, step = 0.0, FIRST_STEP
    by_load = start[0] == end[0]
    while t < 1.0:
        ahead = min(1.0, t + step)
        load = between(start, end, ahead)
        trial, before, arrived = u, 1e300, False
        for _ in range(ITERATIONS):
            room, L_y, _, L_yy, _, L_vv = density(trial, 0.0, cell, load)
            if not (room > 0.0 and L_yy < 0.0):
                break
            change = -L_y / L_yy
            trial += change
            if not abs(trial - u) < LARGEST_CHANGE * u:
                break
            if abs(change) < 1e-13 * u or (abs(change) < 1e-10 * u and abs(change) >= 0.5 * before):
                arrived = True
                break
            before = abs(change)
        if by_load and arrived and ahead - t < FIRST_STEP and may_let_go(trial, L_yy, L_vv, half, drawn):
            break  # a smaller step would only creep on to here
        if arrived and rising(density, u, trial, cell, start, end, half, drawn):
            t, u, step = ahead, trial, 2.0 * step
        else:
            step *= 0.5
            if step < SMALLEST_STEP:
                break
    return u, t

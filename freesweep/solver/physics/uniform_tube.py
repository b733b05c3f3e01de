"""The uniform tube: one number instead of a shape, followed along a straight line in load space.

It is the guide of the walk: where the uniform stretch is carried from one load to the next without a turning point, so is
the tube with clamped ends, and its stretch lies between 1 and the uniform one. Where it is not, the walk goes slowly.
"""

from ...jit import kernel
from ..load import Load
from .wall import may_go_slack

FIRST_STEP = 0.25  # of the way from one load to the other
SMALLEST_STEP = 1e-7  # below it the path is taken to end in a turning point
LARGEST_CHANGE = 0.15  # relative change of the stretch in one step; a jump to another branch is larger
ITERATIONS = 30  # five do nearly always
SCAN = 0.015  # relative change of the stretch between two looks at the slope
SECANTS, CLOSE = 24, 1e-3  # for the load of a stretch; share of L_y at the bounds that is as good as nothing
FAR = 8.0  # end layers per half tube, up to which clamped ends may turn back a tube that is drawn in


@kernel
def between(start, end, t):
    """The load a fraction ``t`` of the way from ``start`` to ``end``."""
    return Load(
        start.gamma + t * (end.gamma - start.gamma),
        end.rubber,
        end.wall,
        start.p + t * (end.p - start.p),
        start.f + t * (end.f - start.f),
        start.m + t * (end.m - start.m),
        end.e,
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
def curvature_at(density, u, cell, start, end, low, high):
    """``(L_yy, L_vv)`` at the load, between the shares ``low`` and ``high`` of the way, at which the stretch ``u`` is an
    equilibrium; L_yy is positive where there is none. By the secant between bounds, in turn with their middle: at once where
    L_y is linear along the way, as it is in pressure, force and torque, but not in the fibers' extension, nor where fibers
    are loose: there it has corners.
    """
    first, last = (
        density(u, 0.0, cell, between(start, end, low))[1],
        density(u, 0.0, cell, between(start, end, high))[1],
    )
    close = CLOSE * max(abs(first), abs(last))
    for i in range(SECANTS):
        t = min(max(low - first * (high - low) / (last - first), low), high) if i % 2 == 0 else 0.5 * (low + high)
        _, here, _, L_yy, _, L_vv = density(u, 0.0, cell, between(start, end, t))
        if abs(here) <= close:
            return L_yy, L_vv
        if here * last > 0.0:
            high, last = t, here
        else:
            low, first = t, here
    return 1.0, -1.0


@kernel
def dips(density, u, trial, cell, start, end, low, high, half, drawn):
    """Whether the load falls somewhere on the way from ``u``, at the share ``low``, to ``trial`` at ``high``: a small snap
    would be passed over. Where half a tube of length ``half`` is drawn in, below ``drawn``, its clamped end, which is not,
    may let go before: there the end has to be far.

    The load falls where -L_yy is negative; a dip of it between samples shows in the parabola through three of them, unless
    fibers go slack: then it jumps.
    """
    count = 2 + int(abs(trial - u) / (SCAN * min(u, trial)))
    first, second = 0.0, 0.0
    for i in range(count + 1):
        here = u + (trial - u) * i / count
        L_yy, L_vv = curvature_at(density, here, cell, start, end, low, high)
        slope = -L_yy
        if not slope > 0.0 or may_let_go(here, L_yy, L_vv, half, drawn):
            return True
        if i >= 2 and second < first and second < slope and not may_go_slack(end.wall):
            bend = first - 2.0 * second + slope
            if second - (slope - first) * (slope - first) / (8.0 * bend) <= 0.0:
                return True
        first, second = second, slope
    return False


@kernel
def rising(density, u, trial, cell, start, end, low, high, half, drawn):
    """Whether the load rises all the way from ``u`` to ``trial``, as far as that can be told: see :func:`dips`."""
    return abs(trial - u) < 1e-9 * u or not dips(density, u, trial, cell, start, end, low, high, half, drawn)


@kernel
def follow(density, u, cell, start, end, half, drawn):
    """Carry the uniform stretch ``u`` from load ``start`` to ``end``; returns it and the fraction reached (1: all)."""
    t, step = 0.0, FIRST_STEP
    by_load = start.gamma == end.gamma
    while t < 1.0:
        ahead = min(1.0, t + step)
        load = between(start, end, ahead)
        trial, before, arrived, least, most = u, 1e300, False, 0.0, 1e300
        for _ in range(ITERATIONS):
            room, L_y, _, L_yy, _, L_vv = density(trial, 0.0, cell, load)
            if not (room > 0.0 and L_yy < 0.0):
                break
            least, most = (trial, most) if L_y > 0.0 else (least, trial)  # L is concave
            new = trial - L_y / L_yy
            if not least <= new <= most:  # where L_yy jumps: fibers go slack
                new = 0.5 * (least + most)
            change, trial = abs(new - trial), new
            if not abs(trial - u) < LARGEST_CHANGE * u:
                break
            if change < 1e-13 * u or (change < 1e-10 * u and change >= 0.5 * before):
                arrived = True
                break
            before = change
        if by_load and arrived and ahead - t < FIRST_STEP and may_let_go(trial, L_yy, L_vv, half, drawn):
            break  # a smaller step would only creep on to here
        if arrived and rising(density, u, trial, cell, start, end, t, ahead, half, drawn):
            t, u, step = ahead, trial, 2.0 * step
        else:
            step *= 0.5
            if step < SMALLEST_STEP:
                break
    return u, t

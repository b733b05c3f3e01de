"""The uniform tube of :mod:`freesweep.solver.physics.uniform_tube` as a guide, for a vector of designs.

L_y and L_yy are linear in pressure, force and torque: their values at the two ends of a path give them all along it. Where
the fibers' extension changes, or fibers are loose, the secant finds the place on it.
"""

from ...jit import kernel
from ..cells import nothing_yet
from ..physics import lagrangian
from ..physics.uniform_tube import CLOSE, FAR, ITERATIONS, LARGEST_CHANGE, SCAN, SECANTS, between
from ..physics.wall import has_two_families, leaves_choice, may_go_slack
from .meridian import CERTAIN
from .vector import HUGE, isnt, mask_of, select, some, spread

FIRST_STEP = 1.0  # of the way: pressures of a sweep lie close
GLANCE = 0.06  # relative change of the stretch between two looks at the slope, where that is even:
EVEN = 0.5  # its smallest value is more than this share of the largest
ON_THE_WAY = 8  # places between a stretch and the end
MET = 1e-8  # of the stretch: the next step of Newton's method is its square
SMALLEST_STEP = 1e-4  # of the way; below it a lane is left to the scalar kernels


@kernel
def kept(where, new, old):
    """What the next look may start from, of the lanes that took part in the last."""
    return (
        select(where, new[0], old[0]), select(where, new[1], old[1]), select(where, new[2], old[2]),
        select(where, new[3], old[3]), select(where, new[4], old[4]), select(where, new[5], old[5]),
        select(where, new[6], old[6]), select(where, new[7], old[7]), select(where, new[8], old[8]),
    )  # fmt: skip


@kernel
def seek(here, cell, start, end, low, high, t, steep, near, todo):
    """``(L_yy, L_vv, t, steep, what is handed on)`` where the stretches ``here`` are equilibria on a way, between its shares
    ``low`` and ``high``, along which L_y is not linear: from a guess of the share t, and of how L_y changes with it. See
    :func:`..physics.uniform_tube.curvature_at`.
    """
    zero = spread(0.0)
    t = select(todo & isnt((t >= low) & (t <= high)), 0.5 * (low + high), t)
    L_yy, L_vv, before, L_before = spread(1.0), spread(-1.0), t, zero
    for _ in range(SECANTS):
        (_, L_y, _, now_yy, _, now_vv), then = lagrangian.density_beside(here, zero, cell, between(start, end, t), near)
        near = kept(todo, then, near)
        moved = todo & (abs(t - before) > 0.0)
        rise = (L_y - L_before) / select(moved, t - before, 1.0)
        steep = select(moved & (rise * steep > 0.0), rise, steep)
        there = todo & (abs(L_y) <= CLOSE * abs(steep) * (high - low))
        L_yy, L_vv = select(there, now_yy, L_yy), select(there, now_vv, L_vv)
        todo = todo & isnt(there)
        if not some(todo):
            break
        above = L_y * steep > 0.0
        low, high = select(todo & isnt(above), t, low), select(todo & above, t, high)
        before, L_before = t, L_y
        ahead = t - L_y / steep
        t = select(todo, select((ahead > low) & (ahead < high), ahead, 0.5 * (low + high)), t)
    return L_yy, L_vv, t, steep, near


@kernel
def reaches(u, cell, load):
    """Where a tube whose middle has the stretch ``u`` has a meridian from there to its clamped end: on the way no stretch
    may have a higher level, as one has where two loose families leave another equilibrium.
    """
    _, near = lagrangian.density_beside(u, 0.0 * u, cell, load, nothing_yet(u))
    level, _, _, _ = lagrangian.level_of(u, cell, load, near)
    reached = mask_of(-1)
    for k in range(1, ON_THE_WAY + 1):
        y = u + (1.0 - u) * (k / ON_THE_WAY)
        _, near = lagrangian.density_beside(y, 0.0 * u, cell, load, near)
        higher, _, _, _ = lagrangian.level_of(y, cell, load, near)
        reached = reached & isnt(higher - level > CERTAIN * (abs(level) + abs(higher)))
    return reached


@kernel
def scan(u, change, samples, cell, start, end, low, high, half, asked):
    """Where the load rises at all so many ``samples`` of the way, and between them; smallest and largest -L_yy."""
    risen, least, most, zero = asked, spread(HUGE), spread(0.0), spread(0.0)
    first, second = spread(0.0), spread(0.0)
    drawn, before, after = lagrangian.drawn_in(cell, end), between(start, end, low), between(start, end, high)
    bent = asked if leaves_choice(end.wall) else asked & (abs(end.gamma - start.gamma) > 0.0)
    t, t_before, steep, near = low, low, zero, nothing_yet(zero)
    i = 0
    while True:
        within = asked & (samples + 1.0 > i)
        if not some(within):
            break
        here, L_yy, L_vv = u + change * min(i / samples, 1.0), spread(1.0), spread(-1.0)
        if some(within & isnt(bent)):
            _, low_y, _, low_yy, _, low_vv = lagrangian.density(here, 0.0, cell, before)
            _, high_y, _, high_yy, _, high_vv = lagrangian.density(here, 0.0, cell, after)
            share = low_y / (low_y - high_y)
            L_yy, L_vv = low_yy + share * (high_yy - low_yy), low_vv + share * (high_vv - low_vv)
        own = bent & within
        if some(own):
            if i == 0:
                (_, high_y, _, _, _, _), near = lagrangian.density_beside(here, zero, cell, after, near)
                (_, low_y, _, bent_yy, _, bent_vv), near = lagrangian.density_beside(here, zero, cell, before, near)
                steep = (high_y - low_y) / (high - low)
            else:
                share = min(i / samples, 1.0)
                ahead = 2.0 * t - t_before if i > 1 else low + share * (high - low)
                last = own & (share >= 1.0)
                if some(last):  # met before, it would be so again on another branch
                    (_, L_y, _, _, _, _), _ = lagrangian.density_beside(
                        here, zero, cell, between(start, end, 0.5 * (t + high)), near
                    )
                    risen = risen & (isnt(last) | (L_y * steep < 0.0))
                guess = select(share >= 1.0, high, ahead)
                t_before = select(own, t, t_before)
                bent_yy, bent_vv, found, rise, near = seek(here, cell, start, end, low, high, guess, steep, near, own)
                t, steep = select(own, found, t), select(own, rise, steep)
            L_yy, L_vv = select(own, bent_yy, L_yy), select(own, bent_vv, L_vv)
        far = L_yy * half * half < FAR * FAR * L_vv
        slope = -L_yy
        risen = risen & (isnt(within) | ((far | (here > drawn)) & (slope > 0.0)))
        if i >= 2 and not may_go_slack(end.wall):
            dips = within & (second < first) & (second < slope)
            bend = first - 2.0 * second + slope
            lowest = second - (slope - first) * (slope - first) / (8.0 * bend)
            risen = risen & (isnt(dips) | (lowest > 0.0))
        least, most = select(within, min(least, slope), least), select(within, max(most, slope), most)
        first, second = second, slope
        i += 1
    return risen, least, most


@kernel
def rising(u, trial, cell, start, end, low, high, half, asked):
    """Where the load rises all the way from ``u``, at the share ``low``, to ``trial`` at ``high``: see
    :func:`..physics.uniform_tube.rising`. A few looks tell it where L_yy hardly changes, which leaves no room for a
    dip, and the tube is not drawn in.
    """
    change = trial - u
    still = abs(change) < 1e-9 * u
    asked = asked & isnt(still)
    size = abs(change) / min(u, trial)
    risen, least, most = scan(u, change, max(1.0 + size / GLANCE, 2.0), cell, start, end, low, high, half, asked)
    unsure = risen & ((least < EVEN * most) | (min(u, trial) < lagrangian.drawn_in(cell, end)))
    if some(unsure):
        risen_all, _, _ = scan(u, change, 2.0 + size / SCAN, cell, start, end, low, high, half, unsure)
        risen = risen & (isnt(unsure) | risen_all)
    return still | risen


@kernel
def attempt(u, t, step, near, cell, start, end, half, todo):
    """One step on the way from load ``start`` to ``end``, from its share ``t`` on, in the lanes that are ``todo``; returns
    ``(u, t, the next step, what the next look may start from)``.
    """
    ahead = min(t + step, 1.0)
    trial, least, most = u, spread(0.0), spread(HUGE)
    going, arrived = todo, mask_of(0)
    for _ in range(ITERATIONS):
        (room, L_y, _, L_yy, _, _), then = lagrangian.density_beside(
            trial, spread(0.0), cell, between(start, end, ahead), near
        )
        near = kept(going, then, near)
        going = going & (room > 0.0) & (L_yy < 0.0)
        least, most = select(L_y > 0.0, trial, least), select(L_y > 0.0, most, trial)
        new = trial - L_y / L_yy
        new = select((least <= new) & (new <= most), new, 0.5 * (least + most))
        size = abs(new - trial)
        trial = select(going, new, trial)
        going = going & (abs(trial - u) < LARGEST_CHANGE * u)
        there = going & (size < MET * u)
        arrived, going = arrived | there, going & isnt(there)
        if not some(going):
            break
    arrived = rising(u, trial, cell, start, end, t, ahead, half, arrived) & arrived
    loaded = arrived & (abs(end.f) + abs(end.m) + abs(end.gamma - 1.0) > 0.0)
    if leaves_choice(end.wall) and has_two_families(end.wall) and some(loaded):
        arrived = arrived & (isnt(loaded) | reaches(trial, cell, between(start, end, ahead)))
    return select(arrived, trial, u), select(arrived, ahead, t), select(arrived, 2.0 * step, 0.5 * step), near


@kernel
def follow(u, cell, start, end, half, asked):
    """Carry the uniform stretch ``u`` from load ``start`` to ``end``; returns it and the lanes that arrived."""
    t, step, near = spread(0.0), spread(FIRST_STEP), nothing_yet(spread(0.0))
    todo, done = asked, mask_of(0)
    while some(todo):
        u, t, step, near = attempt(u, t, step, near, cell, start, end, half, todo)
        done = done | (todo & (t >= 1.0))
        todo = todo & (t < 1.0) & (step > SMALLEST_STEP)
    return u, done

"""Held states, for a vector of designs: which of the free states is the one that has the length or rotation held.

To each uniform stretch u belongs one force or torque, the multiplier mu, and by the first integral (:mod:`.layer`) the shape
of a tube with clamped ends, and so its length or rotation C. The u that has the C wanted is sought from the straight
cylinder on, which is an equilibrium of both tubes. Where the uniform tube is carried from there to mu without a turning
point, so is the other (:mod:`.first_guess`): each state on this way is stable under its loads, all the more with C
held, and C rises with mu. So the way holds no other state with this C, and it is the one
:mod:`freesweep.solver.held.held_state` goes. Whatever else may be is left to that.

Where the wall of that cylinder would have to be pushed at any pressure, the search begins at the tube with nothing held.

A wall cannot be pushed. Where the same way leads to p + f = 0, and the tube is longer there than wanted, no force holds it.
"""

from math import pi, sqrt

from ...jit import entry_point, kernel
from ..held.sought import RAISES
from ..load import Load, at_pressure, under
from ..physics import lagrangian
from ..physics.lagrangian import ROUNDING
from ..problem import FORCE, SOURCE, TORQUE
from ..status import COMPRESSED, HELD_IMPOSSIBLE, OK
from . import first_guess, layer
from .pack import COLUMNS, LENGTH, PRESSURE, aligned, enter, is_clamped, loads
from .vector import WIDTH, bits, get, mask_of, put, select, some, spread

OF_LENGTH, OF_ROTATION = Load(0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), Load(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
RAISE = 1.5  # of the pressure, where the wall of the straight cylinder is not under tension
TRIALS, CLOSE = 12, 1e-6  # of the search for u, and the share of the way in C that may be left
LEAST_SHARE, MOST_SHARE = 0.4, 2.5  # of u less where it begins, from one trial to the next
SAME = 1e-6  # relative difference of u, searched and carried
NEAR = 1e-12  # difference of u: rounding
UNSURE = 0.02  # share of the way in C to where the wall would be pushed: so near nothing is decided
UNCLEAR = 0.01  # relative distance from loss of stability: so near the scalar kernels count
POLE = 1e-9  # dC/dy of the cylinder, to what it is made of: below it, fibers alone hold C
LONGER = 1e-9  # relative: more than rounding


@kernel
def holding(load, length_held, mu):
    """The load with its multiplier: a force, or a torque."""
    return under(load, load.p, mu, load.m) if length_held else under(load, load.p, load.f, mu)


@kernel
def multiplier(u, cell, load, length_held):
    """The force or torque under which ``u`` is the stretch of a uniform tube; ``load`` is without it."""
    unit = OF_LENGTH if length_held else OF_ROTATION
    return -lagrangian.density(u, 0.0, cell, load)[1] / lagrangian.conjugate(u, 0.0, cell, load, unit)[1]


@kernel
def held_integral(u, cell, load, half, length_held, work, more):
    """Length or rotation of half a tube whose uniform stretch is ``u``, by its first integral."""
    places, sine, slant, left = work[0], work[1], work[2], work[3]
    _, _, _, L_yy, _, L_vv = lagrangian.density(u, 0.0, cell, load)
    rate = sqrt(max(L_yy / L_vv, 1e-12))
    layer.end_layer(u, rate, half, cell, load, places, sine, slant, left, more[0], more[1])
    x_before, before, here, total = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for j in range(layer.DEPTHS + 1):
        y = u - (u - 1.0) * get(left, j)
        slope = get(sine, j) * sqrt(max(1.0 + lagrangian.kinematics(y, cell, load)[3], 0.0))
        length, _, turned, _, _ = lagrangian.integrands(y, slope, cell, load)
        x, here = get(places, j), length if length_held else turned
        if j > 0:
            total = total + 0.5 * (x - x_before) * (before + here)
        x_before, before = x, here
    return total + (half - x_before) * here


@kernel
def uniform_stretch(target, half, cell, gamma, length_held):
    """Stretch of the uniform tube that has the length or the rotation (Eqs. 2.3, 2.4); NaN if none has."""
    H, D, gg = cell[0], cell[1], gamma * gamma
    share = target / half
    if not length_held:
        return sqrt(gg / (1.0 + share / H))
    # D^2 y^4 - b y^2 + gamma^4 H^2 = 0; undeformed and not extended, its roots are 1 and H^2/D^2
    b = gg * (1.0 + H * H + D * D) - share * share
    larger = (b + sqrt(b * b - 4.0 * D * D * gg * gg * H * H)) / (2.0 * D * D)
    return sqrt(select(H * H < D * D, larger, gg * gg * H * H / (D * D * larger)))


@kernel
def straight_start(cell, load, length_held, asked):
    """The straight cylinder's load at the lowest pressure, of ``load`` or raised, at which its wall is under tension; and
    where there is one.
    """
    one, p, fits = spread(1.0), load.p, mask_of(0)
    for _ in range(RAISES):
        now = at_pressure(load, p)
        now = holding(now, length_held, multiplier(one, cell, now, length_held))
        fits = fits | (lagrangian.density(one, 0.0, cell, now)[0] > 0.0)
        if not some(asked & ~fits):
            break
        p = select(fits, p, RAISE * p)
    now = at_pressure(load, p)
    return holding(now, length_held, multiplier(one, cell, now, length_held)), fits


@kernel
def free_start(cell, load, half, asked, work, more):
    """The uniform stretch with nothing held, carried from rest, and the length that belongs to it; where there is one."""
    one, zero = spread(1.0), spread(0.0)
    rest = Load(one, load.rubber, load.wall, zero, zero, zero, one)
    u, came = first_guess.follow(one, cell, rest, load, half, asked)
    u = select(asked & came, u, one)
    return u, held_integral(u, cell, load, half, True, work, more), asked & came


@kernel
def cylinder_stability(cell, load, half):
    """Where the straight cylinder is stable while C is held, and where that is clear: its first mode is a whole sine."""
    _, _, _, L_yy, _, L_vv = lagrangian.density(spread(1.0), 0.0, cell, load)
    bend, stiff = L_yy * half * half, -L_vv * pi * pi
    return bend < stiff, abs(bend - stiff) > UNCLEAR * stiff


@kernel
def search(origin, first, target, half, cell, load, length_held, asked, work, more):
    """The uniform stretch u whose tube has C = ``target``, by secants from the one at ``origin``, which has C = ``first``:
    ``(u, multiplier, dC/d(multiplier), where they were found)``.
    """
    u = uniform_stretch(target, half, cell, load.gamma, length_held)
    todo, found = asked & (abs(u - origin) > NEAR), mask_of(0)
    u = select(todo, u, origin)
    mu = multiplier(origin, cell, load, length_held)
    u_before, c_before, mu_before, sigma = origin, first, mu, spread(0.0)
    for _ in range(TRIALS):
        mu = select(todo, multiplier(u, cell, load, length_held), mu)
        now = holding(load, length_held, mu)
        room, _, _, L_yy, _, _ = lagrangian.density(u, 0.0, cell, now)
        fits = todo & (min(room, now.p + now.f) > 0.0) & (L_yy < 0.0)
        c = held_integral(select(fits, u, origin), cell, now, half, length_held, work, more)
        sigma = select(fits, (c - c_before) / (mu - mu_before), sigma)
        close = fits & (abs(c - target) <= CLOSE * abs(target - first))
        found, todo = found | close, todo & ~close
        if not some(todo):
            break
        ahead = u + (target - c) * (u - u_before) / (c - c_before)
        ahead = origin + min(max((ahead - origin) / (u - origin), LEAST_SHARE), MOST_SHARE) * (u - origin)
        back = 0.5 * (u + u_before)  # not so far: the wall would have to be pushed
        u_next = select(fits, ahead, back)
        c_before, mu_before = select(fits, c, c_before), select(fits, mu, mu_before)
        u_before, u = select(fits, u, u_before), select(todo, u_next, u)
    return u, mu, sigma, found


@kernel
def refused(origin, start, first, target, half, cell, load, length_held, asked, work, more):
    """Where no force or torque holds what is wanted, and where that is too close to tell."""
    pushed, near = mask_of(0), mask_of(0)
    if not length_held:
        return asked & ~(load.p + load.f > 0.0), near
    if some(asked):
        limit = holding(load, True, -load.p)
        u, came = first_guess.follow(origin, cell, start, limit, half, asked)
        came = came & (u > 1.0)  # the clamped ends are the first to be pushed
        u = select(came, u, origin)
        least = held_integral(u, cell, limit, half, True, work, more)
        short, close = least - target, UNSURE * abs(first - least)
        pushed, near = came & (short > close), came & (abs(short) <= close)
    return pushed, near


@entry_point
def seek_lanes(
    problems, targets, owners, pressures, order, length_held, constants, values, bounds, status, stable, stretches,
    cosines, multipliers, sigmas,
):  # fmt: skip
    """Guesses of the held states of the rows in the given ``order``, WIDTH at a time: row i belongs to problem
    ``owners[i]``, half of whose length or rotation is in ``targets``.

    They are uniform ``stretches``, ``cosines`` at an end as of :func:`.free.carry_lanes`, ``multipliers`` and ``sigmas``,
    dC/d(multiplier) of half the tube; NaN where the way to them is not certain. What needs no solving, straight cylinders
    and what nothing holds, is written to ``values``, ``bounds``, ``status`` and ``stable``.
    """
    space, columns, found = aligned(6, max(layer.DEPTHS, COLUMNS) + 2), aligned(1, COLUMNS)[0], aligned(1, 6)[0]
    work, more = space[:4], space[4:]
    unit, unknown = (OF_LENGTH, FORCE) if length_held else (OF_ROTATION, TORQUE)
    for group in range(0, len(order), WIDTH):
        count = min(WIDTH, len(order) - group)
        valid = 0
        for lane in range(WIDTH):
            row = order[group + min(lane, count - 1)]
            problem = problems[owners[row]]
            enter(lane, problem, columns)
            columns[PRESSURE, lane], columns[unknown, lane] = pressures[row], 0.0
            found[0, lane] = targets[owners[row]]
            if lane < count and is_clamped(problem):
                valid |= 1 << lane
        cell, _, load = loads(columns, constants, SOURCE, 1)
        half, target, one = get(columns, LENGTH), get(found, 0), spread(1.0)
        c, c_y, _, _ = lagrangian.conjugate(one, 0.0, cell, load, unit)
        first = c * half
        todo = mask_of(valid) & (abs(c_y) > POLE * (cell[0] * cell[0] + cell[1] * cell[1]))
        too_long = mask_of(0)
        if length_held:
            too_long = todo & (target > (1.0 + LONGER) * half * lagrangian.longest(cell, load.gamma, load.wall))
            todo = todo & ~too_long
        start, fits = straight_start(cell, load, length_held, todo)
        pushed, origin = mask_of(0), one
        straight = todo & fits & (start.p == load.p) & (target == first)
        if not length_held:  # p + f alone decides
            pushed, todo = todo & ~fits, todo & fits
        elif some(todo & ~fits):
            origin, at_free, freely = free_start(cell, load, half, todo & ~fits, work, more)
            first = select(freely, at_free, first)
            start_p, start_mu = select(freely, load.p, start.p), select(freely, spread(0.0), start.f)
            start = holding(at_pressure(load, start_p), True, start_mu)
            todo = todo & (fits | freely)
        again, near = refused(origin, start, first, target, half, cell, load, length_held, todo & ~straight, work, more)
        pushed, todo = pushed | again, todo & ~(again | near)
        firm, clear = cylinder_stability(cell, start, half)
        straight, todo = straight & todo & clear, todo & ~straight
        mu = start.f if length_held else start.m
        put(found, 1, ROUNDING * max(abs(load.p), max(abs(start.f), abs(start.m))))
        put(found, 2, mu)
        if some(todo):
            u, ahead, sigma, there = search(origin, first, target, half, cell, load, length_held, todo, work, more)
            now = holding(load, length_held, ahead)
            carried, came = first_guess.follow(origin, cell, start, now, half, todo & there)
            todo = todo & there & came & (abs(carried - u) < SAME * u)
            put(found, 0, u)
            put(found, 2, select(todo, ahead, mu))
            put(found, 3, sigma)
            put(found, 4, layer.end_cosine(u, cell, now))
        known, sought, never = bits(straight), bits(todo), bits(too_long)
        stands, none = bits(firm), bits(pushed)
        for lane in range(count):
            row = order[group + lane]
            if (known >> lane) & 1:
                values[row], bounds[row], status[row] = found[2, lane], found[1, lane], OK
                stable[row] = (stands >> lane) & 1
            elif (sought >> lane) & 1:
                stretches[row], multipliers[row], sigmas[row] = found[0, lane], found[2, lane], found[3, lane]
                cosines[row] = found[4, lane]
            elif ((never | none) >> lane) & 1:
                status[row] = COMPRESSED if (none >> lane) & 1 else HELD_IMPOSSIBLE

"""Where the search for a held state begins, and how it goes on, for a vector of designs.

A held state is the free one whose force or torque, the multiplier mu, gives it the length or rotation C that is held
(:mod:`..held_by_load`). The straight cylinder is an equilibrium of both tubes, under the mu that makes L_y(1, 0) = 0. Where
the uniform tube is carried from there to another mu without a turning point, so is the other (:mod:`.first_guess`): each
state on this way is stable under its loads, all the more with C held, and C rises with mu. So the way holds no other state
with this C, and it is the one :mod:`..held.held_state` goes. Whatever else may be is left to that.

Where the wall of that cylinder would have to be pushed, or its fibers would, or where it does not stand, the search begins
at the tube with nothing held, or under a strong pull.
"""

from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from ...jit import entry_point, kernel
from ..cells import nothing_yet
from ..load import SPARED, Load, under
from ..physics import lagrangian, membrane, physical
from ..physics.lagrangian import LONGER, ROUNDING
from ..physics.wall import may_go_slack, with_bonded_fibers
from ..problem import FORCE, PHYSICAL, SOURCE, TORQUE
from ..status import COMPRESSED, HELD_IMPOSSIBLE, OK
from . import first_guess
from .pack import COLUMNS, LENGTH, PRESSURE, Kind, aligned, enter, is_clamped, loads
from .vector import WIDTH, bits, get, isnt, mask_of, put, select, some, spread

SYMMETRIC = 4.493409458 / pi  # tan k = k: the first mode that leaves C as it is, and is symmetric, to a whole sine
POLE = 1e-9  # dC/dy of the cylinder, to what it is made of: below it, fibers alone hold C
STRONG, STRONGER = 4.0, 32.0  # pulls, to pressure and torque
# of a beginning: stretch and multiplier, length or rotation C of half the tube (NaN: not known yet), dC/dmu of a cylinder,
# the longest half tube that the fibers allow, and whether the way from rest with C held is gone
STRETCH, MULTIPLIER, HELD, RISE, LONGEST, LOST = range(6)
AT_CYLINDER, AT_FREE, AT_STRONG, AT_STRONGER, AT_OPPOSITE = TRIALS = range(5)  # where to begin, at first
BEGINNING = LOST + 1
ROUNDED = BEGINNING  # behind a beginning: what rounding leaves of the multiplier of a straight cylinder


class Asked(NamedTuple):
    """Held states (n,) that are asked for: row i is that of a problem of its own, half of whose length or rotation is
    ``targets[i]``; rows in the given ``order`` share vectors.
    """

    problems: np.ndarray
    pressures: np.ndarray
    targets: np.ndarray
    order: np.ndarray


class Told(NamedTuple):
    """What is told of held states (n,)."""

    multipliers: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    stable: np.ndarray


@kernel
def holding(load, length_held, mu):
    """The load with its multiplier: a force, or a torque."""
    return under(load, load.p, mu, load.m) if length_held else under(load, load.p, load.f, mu)


@kernel
def cylinder(cell, load, length_held):
    """``(c, c_y, mu)`` of the straight cylinder: what it adds to C at each place, and its multiplier."""
    psi, psi_y, _, G_1, G_y, _ = membrane.kinematics(spread(1.0), cell, load)
    s = sqrt(max(1.0 + G_1, 0.0))
    c, c_y = (s, 0.5 * G_y / s) if length_held else (psi, psi_y)
    return c, c_y, -lagrangian.density(spread(1.0), 0.0, cell, with_bonded_fibers(load))[1] / c_y


@kernel
def both_pull(cell, load):
    """Where no family of the cylinder would have to push, which loose ones cannot."""
    return _both_pull(cell, load, load.wall)


@kernel
def _both_pull(cell, load, wall):
    if len(wall) == 1:
        return mask_of(-1)
    if not may_go_slack(wall):
        return mask_of(-1)
    alpha, beta, _ = physical.tensions(
        spread(1.0), spread(0.0), cell, with_bonded_fibers(load), nothing_yet(spread(0.0))
    )
    return (alpha > 0.0) & (beta > 0.0)


@kernel
def loose_turn(load, length_held):
    """Where a torque turns what has alpha = -beta: loose fibers go slack, bonded ones do not turn."""
    return mask_of(-1 if may_go_slack(load.wall) and not length_held else 0)


@kernel
def free_start(cell, load, half, length_held, toward, trial, asked):
    """The uniform stretch of the free tube, carried from rest, where there is one, and the multiplier under which: none, or,
    where it would snap then or that was tried, a strong pull, or a strong torque ``toward`` what is held; at last the
    opposite.
    """
    zero = spread(0.0)
    u, came = carried_from_rest(cell, load, half, asked & isnt(trial > AT_FREE))
    if not some(asked & isnt(came)):
        return u, came, zero
    opposite = trial > AT_STRONGER
    strength = select((trial > AT_STRONG) & isnt(opposite), spread(STRONGER), spread(STRONG))
    if length_held:
        pull = select(opposite, (SPARED - 1.0) * load.p, strength * max(load.p, abs(load.m)))
    else:
        pull = strength * select(opposite, -toward, toward) * max(load.p, abs(load.f))
    other, pulled = carried_from_rest(cell, holding(load, length_held, pull), half, asked & isnt(came))
    return select(came, u, other), came | pulled, select(came, zero, pull)


@kernel
def carried_from_rest(cell, load, half, asked):
    """The uniform stretch under a load, and where it is come to from rest."""
    one, zero = spread(1.0), spread(0.0)
    rest = Load(one, load.rubber, load.wall, zero, zero, zero, one)
    u, came = first_guess.follow(one, cell, rest, load, half, asked)
    return select(asked & came, u, one), asked & came


@kernel
def rise_of(c_y, cell, load, half):
    """dC/d(multiplier) of half a cylinder, roughly: its layers hold back what its middle would do."""
    _, _, _, L_yy, _, L_vv = lagrangian.density(spread(1.0), 0.0, cell, load)
    deep = sqrt(max(L_yy / L_vv, 0.0)) * half
    return half * c_y * c_y / max(-L_yy, 1e-12) * deep * deep / (3.0 + deep + deep * deep)


@kernel
def cylinder_stability(cell, load, half):
    """Where the straight cylinder is stable while C is held: its first mode is a whole sine; and where its first symmetric
    mode has let go, too, and the branch from rest turned back.
    """
    _, _, _, L_yy, _, L_vv = lagrangian.density(spread(1.0), 0.0, cell, load)
    bend, stiff = L_yy * half * half, -L_vv * pi * pi
    return bend < stiff, bend > SYMMETRIC * SYMMETRIC * stiff


@kernel
def seat(group, count, asked, unknown, walls, beginnings, columns, found):
    """Put the next ``count`` rows in the given order into the lanes, without the load ``unknown``; those that are left take
    the last one, too. Returns the lanes whose tubes can be clamped.
    """
    valid = 0
    for lane in range(WIDTH):
        row = asked.order[group + min(lane, count - 1)]
        enter(lane, asked.problems[row], columns)
        columns[PRESSURE, lane], columns[unknown, lane] = asked.pressures[row], 0.0
        found[HELD, lane], found[LOST, lane] = asked.targets[row], beginnings[row, LOST]
        if lane < count and is_clamped(asked.problems[row], walls):
            valid |= 1 << lane
    return mask_of(valid)


@kernel
def refused(valid, todo, cell, load, target, most, length_held):
    """Where no load holds the ``target``, and where the wall would be pushed: p + f alone decides, of given rotation."""
    if length_held:
        return todo & (target > (1.0 + LONGER) * most), mask_of(0)
    unturned = (cell[0] == 0.0) & isnt(loose_turn(load, length_held) & isnt(target == 0.0))
    return valid & unturned, todo & isnt(load.p + load.f > 0.0)


@kernel
def tell(count, rows, refused, straight, begun, found, told, beginnings):
    """Write what was ``found`` in the lanes of the ``rows``: (never, pushed) are ``refused``, (lanes, firm) ``straight``; of
    those ``begun``, (lanes, upright, from rest), what is upright is a cylinder.
    """
    never, pushed = bits(refused[0]), bits(refused[1])
    known, firm = bits(straight[0]), bits(straight[1])
    started, upright, from_rest = bits(begun[0]), bits(begun[1]), bits(begun[2])
    for lane in range(count):
        row = rows[lane]
        if ((never | pushed) >> lane) & 1:
            told.status[row] = COMPRESSED if (pushed >> lane) & 1 else HELD_IMPOSSIBLE
            continue
        if (known >> lane) & 1:
            told.multipliers[row], told.bounds[row] = found[MULTIPLIER, lane], found[ROUNDED, lane]
            told.status[row], told.stable[row] = OK, (firm >> lane) & 1
        if (started >> lane) & 1:
            for k in range(BEGINNING):
                beginnings[row, k] = found[k, lane]
            beginnings[row, LOST] = 0.0 if (from_rest >> lane) & 1 else 1.0
            if not (upright >> lane) & 1:
                beginnings[row, HELD] = beginnings[row, RISE] = np.nan


@kernel
def start(asked, length_held, kind, told, beginnings):
    """Beginnings (n, BEGINNING) of the search for the held states that are ``asked`` for, WIDTH at a time; their stretch is
    NaN where there is none. In place of LOST they tell which of the TRIALS it is. What needs no search, straight cylinders
    and what nothing holds, is ``told``.
    """
    columns, found = aligned(1, COLUMNS)[0], aligned(1, BEGINNING + 1)[0]
    for group in range(0, len(asked.order), WIDTH):
        count = min(WIDTH, len(asked.order) - group)
        valid = seat(group, count, asked, FORCE if length_held else TORQUE, kind.walls, beginnings, columns, found)
        cell, _, load = loads(columns, kind.constants, kind.walls, kind.layers)
        half, target, trial = get(columns, LENGTH), get(found, HELD), get(found, LOST)
        c, c_y, mu = cylinder(cell, load, length_held)
        first, upheld = c * half, abs(c_y) > POLE * (cell[0] * cell[0] + cell[1] * cell[1])
        todo = valid & (upheld | loose_turn(load, length_held))
        most = half * lagrangian.longest(cell, load.gamma, load.wall)
        never, pushed = refused(valid, todo, cell, load, target, most, length_held)
        todo = todo & isnt(never | pushed)
        now = holding(load, length_held, mu)
        pulled = lagrangian.density(spread(1.0), 0.0, cell, with_bonded_fibers(now))[0] > 0.0
        stands = todo & upheld & pulled & both_pull(cell, now)
        firm, gone = cylinder_stability(cell, now, half)
        natural = half if length_held else spread(0.0)
        todo = todo & isnt((trial > AT_CYLINDER) & stands & (target == natural))  # has its one way from rest
        stands = stands & isnt(trial > AT_CYLINDER)
        straight = stands & (target == first)
        lost = upheld & gone & (first == natural) & isnt(target == first)
        stands = stands & isnt(lost)
        toward = select(target < first, -1.0, spread(1.0))
        u, came, pull = free_start(cell, load, half, length_held, toward, trial, todo & isnt(stands))
        put(found, MULTIPLIER, select(stands, mu, pull))
        put(found, HELD, first)
        put(found, RISE, rise_of(c_y, cell, now, half))
        put(found, LONGEST, most)
        put(found, STRETCH, u)
        put(found, ROUNDED, ROUNDING * max(abs(load.p), max(abs(now.f), abs(now.m))))
        begun = stands | came, stands, pulled & isnt(lost)
        tell(count, asked.order[group:], (never, pushed), (straight, firm), begun, found, told, beginnings)


@kernel
def move(problems, pressures, order, length_held, kind, before, after, stretches):
    """Carry the uniform ``stretches`` (n,) of the rows in the given ``order`` from the multipliers ``before`` to those
    ``after``; NaN where no quick way leads there.
    """
    columns, found = aligned(1, COLUMNS)[0], aligned(1, 3)[0]
    for group in range(0, len(order), WIDTH):
        count = min(WIDTH, len(order) - group)
        for lane in range(WIDTH):
            row = order[group + min(lane, count - 1)]
            enter(lane, problems[row], columns)
            columns[PRESSURE, lane] = pressures[row]
            found[0, lane], found[1, lane], found[2, lane] = stretches[row], before[row], after[row]
        cell, _, load = loads(columns, kind.constants, kind.walls, kind.layers)
        here, there = holding(load, length_held, get(found, 1)), holding(load, length_held, get(found, 2))
        u, came = first_guess.follow(get(found, 0), cell, here, there, get(columns, LENGTH), mask_of((1 << count) - 1))
        put(found, 0, u)
        for lane in range(count):
            stretches[order[group + lane]] = found[0, lane] if (bits(came) >> lane) & 1 else np.nan


@entry_point
def start_lanes(
    problems, pressures, targets, order, length_held, constants, multipliers, bounds, status, stable, beginnings
):  # fmt: skip
    """:func:`start` the source's tubes."""
    asked, told = Asked(problems, pressures, targets, order), Told(multipliers, bounds, status, stable)
    start(asked, length_held, Kind(constants, SOURCE, 1), told, beginnings)


@entry_point
def start_physical(
    problems, pressures, targets, order, length_held, constants, layers, multipliers, bounds, status, stable, beginnings
):  # fmt: skip
    """:func:`start` physical tubes."""
    asked, told = Asked(problems, pressures, targets, order), Told(multipliers, bounds, status, stable)
    start(asked, length_held, Kind(constants, PHYSICAL, layers), told, beginnings)


@entry_point
def move_lanes(problems, pressures, order, length_held, constants, before, after, stretches):
    """:func:`move` the source's tubes."""
    move(problems, pressures, order, length_held, Kind(constants, SOURCE, 1), before, after, stretches)


@entry_point
def move_physical(problems, pressures, order, length_held, constants, layers, before, after, stretches):
    """:func:`move` physical tubes."""
    move(problems, pressures, order, length_held, Kind(constants, PHYSICAL, layers), before, after, stretches)

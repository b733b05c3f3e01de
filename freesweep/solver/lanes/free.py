"""Free states of tubes that are the same all along, a vector of designs at a time.

First each design's uniform tube is carried along its pressures, as far as it rises without a turning point; none waits
for others, whose steps may be shorter. Then the states are solved, in vectors of states that are alike, whichever designs
they belong to: each begins as a long tube, so none needs another one. No lane's numbers depend on its neighbours.
"""

from typing import NamedTuple

import numpy as np

from ...jit import entry_point, kernel
from ..cells import nothing_yet
from ..load import Load
from ..physics import lagrangian
from ..problem import AREA, GAMMA, PHYSICAL, SOURCE, D, H
from . import first_guess, meridian, quadrature, sums
from .pack import BEFORE, COLUMNS, PRESSURE, Asked, Kind, Told, aligned, enter, is_clamped, loads, lock, record, settle
from .pack import LENGTH as HALF
from .vector import WIDTH, bits, get, mask_of, put, select, some, spread

MEMBER, ROW, CLAMPED, LEADS = range(4)  # who sits in a lane; whether its ends may have a length, whether a way leads on


class Walks(NamedTuple):
    """Problems (n, columns), of which i is asked for the ``pressures`` from ``first[i]`` on, taken in the given ``order``;
    for each pressure the uniform stretch, and a number from 0 to 1 that tells states that are as much work.
    """

    problems: np.ndarray
    first: np.ndarray
    pressures: np.ndarray
    order: np.ndarray
    stretches: np.ndarray
    likeness: np.ndarray


@kernel
def first_leg(before, fresh):
    """The load before, where the ``fresh`` lanes begin without any."""
    zero, one = spread(0.0), spread(1.0)
    gamma, rubber, k, p, f, m, e = before
    return Load(select(fresh, one, gamma), rubber, k, p, select(fresh, zero, f), select(fresh, zero, m), e)


@kernel
def locked(problem):
    """Uniform stretch of the locked tube, and what tells how much work it is."""
    cell, gamma = (problem[H], problem[D], problem[AREA]), problem[GAMMA]
    u = lagrangian.locked_stretch(cell, gamma)
    return u, 1.0


@kernel
def onward(lane, taken, seats, walks, walls, columns, told):
    """Put the next load that has to be solved into a lane: of its own problem, or of the next one in the order, of which
    ``taken`` are in lanes. Returns ``(taken, whether there is one, whether it is another problem's)``.
    """
    k, row, fresh = seats[MEMBER, lane], seats[ROW, lane] + 1, False
    while True:
        if k < 0 or row == walks.first[k + 1]:
            if taken == len(walks.order):
                return taken, False, fresh
            k, fresh = walks.order[taken], True
            row, taken = walks.first[k], taken + 1
            seats[MEMBER, lane], seats[CLAMPED, lane] = k, int(is_clamped(walks.problems[k], walls))
            seats[LEADS, lane] = seats[CLAMPED, lane]
            enter(lane, walks.problems[k], columns)
            continue
        p, seats[ROW, lane] = walks.pressures[row], row
        walks.stretches[row] = np.nan
        if not settle(p, walks.problems[k], seats[CLAMPED, lane] == 1, row, told):
            if p == np.inf:
                walks.stretches[row], walks.likeness[row] = locked(walks.problems[k])
            elif seats[LEADS, lane] == 1:
                columns[PRESSURE, lane] = p
                return taken, True, fresh
        row += 1


@kernel
def carry(walks, kind, told):
    """Uniform ``stretches`` of the :class:`Walks`: NaN from where no quick way leads on; and ``likeness``. What needs no
    solving at all is ``told``. Each lane goes on by itself: the next load is its own, or, at the end, another problem's.
    """
    if len(walks.order) == 0:  # as where it is called to be compiled
        return
    columns, found, seats = aligned(1, COLUMNS)[0], aligned(1, 2)[0], np.zeros((LEADS + 1, WIDTH), np.int64)
    u, t, step, near = spread(1.0), spread(0.0), spread(first_guess.FIRST_STEP), nothing_yet(spread(0.0))
    at_end = near
    taken, active, started, ended = 0, 0, 0, 0
    for lane in range(WIDTH):
        seats[MEMBER, lane] = -1
        ended |= 1 << lane
        enter(lane, walks.problems[walks.order[0]], columns)
    while True:
        fresh = 0
        for lane in range(WIDTH):
            if (ended >> lane) & 1:
                taken, there, new = onward(lane, taken, seats, walks, kind.walls, columns, told)
                active = active | (1 << lane) if there else active & ~(1 << lane)
                fresh |= (1 if new else 0) << lane
        if active == 0:
            return
        new, next_load = mask_of(fresh), mask_of(ended)
        started &= ~fresh
        nothing = nothing_yet(spread(0.0))
        u, near, at_end = (
            select(new, 1.0, u),
            first_guess.kept(new, nothing, near),
            first_guess.kept(new, nothing, at_end),
        )
        t, step = select(next_load, 0.0, t), select(next_load, first_guess.FIRST_STEP, step)
        cell, before, now = loads(columns, kind.constants, kind.walls, kind.layers)
        before, todo = first_leg(before, mask_of(active & ~started)), mask_of(active)
        u, t, step, near = first_guess.attempt(u, t, step, near, cell, before, now, get(columns, HALF), todo)
        arrived = todo & (t >= 1.0)
        if some(arrived):
            put(columns, BEFORE, select(arrived, now.p, get(columns, BEFORE)))
            put(found, 0, u)
            work, then = meridian.work_of(u, cell, now, get(columns, HALF), near, at_end)
            put(found, 1, work)
            at_end = first_guess.kept(arrived, then, at_end)
        ended, started = bits(arrived | todo & (step <= first_guess.SMALLEST_STEP)), started | bits(arrived)
        for lane in range(WIDTH):
            if (bits(arrived) >> lane) & 1:
                row = seats[ROW, lane]
                walks.stretches[row], walks.likeness[row] = found[0, lane], found[1, lane]
            elif (ended >> lane) & 1:
                seats[LEADS, lane] = 0


@kernel
def seat_states(group, count, asked, rows, columns, start):
    """Put the next ``count`` rows in the given order into the lanes; those that are left take the last one, too."""
    for lane in range(WIDTH):
        row = asked.order[group + min(lane, count - 1)]
        rows[lane] = row
        enter(lane, asked.problems[asked.owners[row]], columns)
        start[0, lane] = asked.starts[row]
        if asked.pressures[row] == np.inf:
            lock(lane, columns)
        else:
            columns[PRESSURE, lane] = asked.pressures[row]


@kernel
def solve(asked, kind, pieces, accuracy, told, middles):
    """Solve the rows that are ``asked`` for, WIDTH at a time, by :mod:`quadrature`, each part in so many ``pieces``: they
    begin at uniform stretches. Rows that a lane could not do keep the status that they have. ``middles`` (n, 2) take the
    uniform stretch and the depth of the middle, from which profiles are drawn, and finer pieces start.
    """
    room, out, small = sums.make_room(), aligned(2, 16), aligned(2, COLUMNS)
    columns, start, rows = small[0], small[1], np.zeros(WIDTH, np.int64)
    for group in range(0, len(asked.order), WIDTH):
        count = min(WIDTH, len(asked.order) - group)
        seat_states(group, count, asked, rows, columns, start)
        for lane in range(WIDTH):
            start[1, lane] = middles[rows[lane], 1]  # NaN at first
        cell, _, load = loads(columns, kind.constants, kind.walls, kind.layers)
        found, met, alpha, beta, (u, depth) = quadrature.solve(
            (get(start, 0), get(start, 1)), cell, load, get(columns, HALF), mask_of((1 << count) - 1), pieces, accuracy,
            room, out,
        )  # fmt: skip
        record(bits(met), bits(alpha), bits(beta), rows, out, told)
        put(start, 0, u)
        put(start, 1, depth)
        for lane in range(count):
            if (bits(found) >> lane) & 1:
                middles[rows[lane], 0], middles[rows[lane], 1] = start[0, lane], start[1, lane]


@entry_point
def carry_lanes(problems, first, pressures, order, constants, values, bounds, status, stretches, likeness):
    """:func:`carry` the source's tubes."""
    walks, kind = Walks(problems, first, pressures, order, stretches, likeness), Kind(constants, SOURCE, 1)
    carry(walks, kind, Told(values, bounds, status, status))


@entry_point
def carry_physical(problems, first, pressures, order, constants, layers, values, bounds, status, stretches, likeness):
    """:func:`carry` physical tubes."""
    walks, kind = Walks(problems, first, pressures, order, stretches, likeness), Kind(constants, PHYSICAL, layers)
    carry(walks, kind, Told(values, bounds, status, status))


@entry_point
def solve_lanes(
    problems, owners, pressures, stretches, order, constants, pieces, accuracy, values, bounds, status, slack, middles
):  # fmt: skip
    """:func:`solve` the source's tubes."""
    asked, kind = Asked(problems, owners, pressures, stretches, order), Kind(constants, SOURCE, 1)
    solve(asked, kind, pieces, accuracy, Told(values, bounds, status, slack), middles)


@entry_point
def solve_physical(
    problems, owners, pressures, stretches, order, constants, layers, pieces, accuracy, values, bounds, status, slack,
    middles,
):  # fmt: skip
    """:func:`solve` physical tubes."""
    asked, kind = Asked(problems, owners, pressures, stretches, order), Kind(constants, PHYSICAL, layers)
    solve(asked, kind, pieces, accuracy, Told(values, bounds, status, slack), middles)

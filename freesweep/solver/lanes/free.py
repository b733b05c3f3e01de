"""Free states of tubes that are the same all along, a vector of designs at a time.

First each design's uniform tube is carried along its pressures, as far as it rises without a turning point. Then the
states are solved, in vectors of states that are alike, whichever designs they belong to: each begins as a long tube, so
none needs another one. No lane's numbers depend on its neighbours.
"""

import numpy as np

from ...jit import entry_point, kernel
from ..load import Load
from ..physics import lagrangian
from ..problem import AREA, GAMMA, PHYSICAL, SOURCE, D, H
from . import first_guess, meridian, quadrature, sums
from .pack import BEFORE, COLUMNS, PRESSURE, Asked, Kind, Told, aligned, enter, is_clamped, loads, lock, record, settle
from .pack import LENGTH as HALF
from .vector import WIDTH, bits, get, mask_of, put, select, spread


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
def carry(problems, first, pressures, order, kind, told, stretches, likeness):
    """Uniform ``stretches`` (pressures,) of the problems, taken in the given ``order``, WIDTH at a time: NaN from where
    no quick way leads on; and ``likeness`` (pressures,), numbers from 0 to 1 that tell states that are as much work.
    What needs no solving at all is ``told``. Problem i is asked for the ``pressures`` from ``first[i]`` on.
    """
    columns, found = aligned(1, COLUMNS)[0], aligned(1, 2)[0]
    members, rows = np.zeros(WIDTH, np.int64), np.zeros(WIDTH, np.int64)
    for group in range(0, len(order), WIDTH):
        count = min(WIDTH, len(order) - group)
        longest, going = 0, 0
        for lane in range(WIDTH):
            k = order[group + min(lane, count - 1)]
            members[lane] = k
            going |= (1 if is_clamped(problems[k]) else 0) << lane
            longest = max(longest, first[k + 1] - first[k])
            enter(lane, problems[k], columns)
        u, started, valid = spread(1.0), 0, going
        for step in range(longest):
            active = 0
            for lane in range(count):
                k = members[lane]
                row = first[k] + step
                rows[lane] = row
                if row < first[k + 1]:
                    p, clamped = pressures[row], (valid >> lane) & 1 == 1
                    stretches[row] = np.nan
                    if settle(p, problems[k], clamped, row, told):
                        continue
                    if p == np.inf:
                        stretches[row], likeness[row] = locked(problems[k])
                    elif (going >> lane) & 1:
                        columns[PRESSURE, lane] = p
                        active |= 1 << lane
            if active == 0:
                continue
            cell, before, now = loads(columns, kind.constants, kind.walls, kind.layers)
            ahead, arrived = first_guess.follow(
                u, cell, first_leg(before, mask_of(active & ~started)), now, get(columns, HALF), mask_of(active)
            )
            u = select(arrived, ahead, u)
            put(columns, BEFORE, select(arrived, now.p, get(columns, BEFORE)))
            put(found, 0, ahead)
            put(found, 1, meridian.work_of(ahead, cell, now, get(columns, HALF)))
            for lane in range(count):
                if (bits(arrived) >> lane) & 1:
                    stretches[rows[lane]], likeness[rows[lane]] = found[0, lane], found[1, lane]
            started |= bits(arrived)
            going &= ~(active & ~bits(arrived))


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
    kind, told = Kind(constants, SOURCE, 1), Told(values, bounds, status, status)
    carry(problems, first, pressures, order, kind, told, stretches, likeness)


@entry_point
def carry_physical(problems, first, pressures, order, constants, layers, values, bounds, status, stretches, likeness):
    """:func:`carry` physical tubes."""
    kind, told = Kind(constants, PHYSICAL, layers), Told(values, bounds, status, status)
    carry(problems, first, pressures, order, kind, told, stretches, likeness)


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

"""The walk of :mod:`freesweep.solver.branch` along its quick way, for a vector of designs at a time.

A lane follows its own list of pressures for as long as the uniform tube guides it and Newton's method converges to a
bound that meets the accuracy, warm or anew. Where that ends (a limit pressure, a snap) the lane is left, and ``states``
says from where the scalar walk goes on. No lane's numbers depend on its neighbours.
"""

import numpy as np

from ...jit import entry_point, kernel
from .. import lagrangian
from . import guide, nested
from .seat import (
    BEFORE,
    COLUMNS,
    PRESSURE,
    aligned,
    begin,
    draw_profiles,
    enter,
    is_clamped,
    loads,
    lock,
    record,
    settle,
)
from .seat import LENGTH as HALF
from .vector import WIDTH, bits, get, mask_of, put, select, spread


@kernel
def first_leg(before, fresh):
    """The load before, where the ``fresh`` lanes begin without any."""
    zero, one = spread(0.0), spread(1.0)
    gamma, rubber, k, p, f, m, e = before
    return select(fresh, one, gamma), rubber, k, p, select(fresh, zero, f), select(fresh, zero, m), e


@kernel
def rescale(u, ahead, base, x, y, kept_x, kept_y, safe):
    """Keep the last shapes, and scale them to the uniform stretches ``ahead``."""
    factor = select(abs(u - 1.0) > 1e-9, (ahead - 1.0) / (u - 1.0), spread(1.0))
    for i in range(base + 1):
        put(kept_x, i, get(x, i))
        put(kept_y, i, get(y, i))
        put(safe, i, get(y, i))
        put(y, i, 1.0 + (get(y, i) - 1.0) * factor)


@entry_point
def walk_lanes(
    problems,
    first,
    pressures,
    order,
    constants,
    base,
    accuracy,
    values,
    bounds,
    status,
    slack,
    stations,
    profiles,
    states,
):
    """Walk the problems in the given ``order``, WIDTH at a time. Arguments as of :func:`branch.walk_many`; rows that a lane
    could not do keep the status that they have, and ``states`` says from where the scalar walk goes on. ``constants`` are
    the columns of their rubbers' constants, branch.MOONEY_RIVLIN or branch.YEOH: each has machine code of its own.

    states : (problems, 2, base + 2) mesh and shape, each with one number behind: the pressure of that state (NaN where
        none was solved), and the uniform stretch
    """
    size = (base << nested.LANE_DOUBLINGS) + 2
    space = aligned(23, size)
    meshes, work, table, out, found = space[:7], space[7:11], space[11:19], space[19:21], space[21:]
    shapes, small = aligned(5, base + 2), aligned(3, COLUMNS)
    x, y, kept_x, kept_y, safe = shapes[0], shapes[1], shapes[2], shapes[3], shapes[4]
    columns, sizes, stretches = small[0], small[1], small[2]
    drawn = len(stations) > 0
    kept, nodes, doublings = np.zeros((WIDTH if drawn else 0, 5, size)), np.zeros((5, size)), np.zeros(WIDTH, np.int64)
    line = np.zeros((3, base + 1))
    tube = (np.zeros((1, 1, 3, 4)), np.array([0, base]), np.zeros((1, 3)), True, base, np.zeros(2))
    members, rows = np.zeros(WIDTH, np.int64), np.zeros(WIDTH, np.int64)
    for group in range(0, len(order), WIDTH):
        count = min(WIDTH, len(order) - group)
        longest, valid, limits = 0, 0, 0
        for lane in range(WIDTH):
            k = order[group + min(lane, count - 1)]
            members[lane] = k
            valid |= (1 if is_clamped(problems[k]) else 0) << lane
            longest = max(longest, first[k + 1] - first[k])
            if first[k + 1] > first[k] and pressures[first[k + 1] - 1] == np.inf:
                limits |= 1 << lane
        u, started, going = spread(1.0), 0, valid
        for step in range(-1 if limits & valid != 0 else 0, longest):  # the locked shapes first
            if step <= 0:
                for lane in range(WIDTH):
                    enter(lane, problems[members[lane]], columns, base, x, y)
            active = 0
            for lane in range(count):
                k = members[lane]
                rows[lane] = first[k] + step
                if step < 0:
                    rows[lane] = first[k + 1] - 1
                    if (limits & valid) >> lane & 1:
                        active |= 1 << lane
                        lock(lane, columns)
                elif rows[lane] < first[k + 1] and not pressures[rows[lane]] == np.inf:
                    p, clamped = pressures[rows[lane]], (valid >> lane) & 1 == 1
                    if not settle(p, problems[k], clamped, rows[lane], values, bounds, status) and (going >> lane) & 1:
                        columns[PRESSURE, lane] = p
                        active |= 1 << lane
            if active == 0:
                continue
            cell, before, now = loads(columns, constants)
            if step < 0:
                ahead, arrived = lagrangian.locked_stretch(cell, now[0]), mask_of(active)
            else:
                before = first_leg(before, mask_of(active & ~started))
                ahead, arrived = guide.follow(u, cell, before, now, mask_of(active))
            put(stretches, 0, ahead)
            rescale(u, ahead, base, x, y, kept_x, kept_y, safe)
            met, cold = mask_of(0), bits(arrived) & ~started
            asked = arrived
            while True:
                for lane in range(count):
                    if (cold >> lane) & 1:
                        begin(lane, columns, base, stretches[0, lane], x, y, safe, tube, line)
                here, alpha, beta = nested.solve(
                    x, y, safe, base, cell, now, get(columns, HALF), asked, accuracy, meshes, work, table, sizes, found, out,
                    kept, doublings,
                )  # fmt: skip
                here = here & guide.within(y, base, ahead)
                record(bits(here), bits(alpha), bits(beta), rows, out, values, bounds, status, slack)
                if drawn:
                    draw_profiles(bits(here), rows, columns, base, doublings, kept, stations, tube, nodes, profiles)
                met = met | here
                cold = bits(asked & ~here) & started & ~cold  # a lane whose warm start fails begins anew
                if cold == 0:
                    break
                asked = mask_of(cold)
            if step < 0:
                continue
            for i in range(base + 1):
                put(x, i, select(met, get(x, i), get(kept_x, i)))
                put(y, i, select(met, get(y, i), get(kept_y, i)))
            u = select(met, ahead, u)
            put(columns, BEFORE, select(met, now[3], get(columns, BEFORE)))
            started |= bits(met)
            going &= ~(active & ~bits(met))
        put(stretches, 0, u)
        for lane in range(count):
            state = states[members[lane]]
            for i in range(base + 1):
                state[0, i], state[1, i] = x[i, lane], y[i, lane]
            state[0, base + 1] = columns[BEFORE, lane] if (started >> lane) & 1 else np.nan
            state[1, base + 1] = stretches[0, lane]

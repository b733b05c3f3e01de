"""The walk of :mod:`freesweep.solver.branch` along its quick way, for a vector of designs at a time.

A lane follows its own list of pressures for as long as the uniform tube guides it and a warm start converges to a bound
that meets the accuracy. Where that ends (a limit pressure, a snap, a very long tube) the lane is left: ``left`` says at
which of its pressures, ``states`` from where the scalar walk goes on. No lane's numbers depend on its neighbours.
"""

import numpy as np

from ...jit import entry_point, kernel
from .. import guide, lagrangian
from ..branch import AREA, FORCE, GAMMA, LENGTH, RATIO, SHEAR, TORQUE, D, H
from ..status import COMPRESSED, INVALID, OK
from . import guide as lane_guide
from . import nested
from .vector import WIDTH, bits, get, mask_of, put, select, spread

COLUMNS = 12  # H, D, area, gamma, c, shear, f, m, half length; pressure, pressure before, weight of the energy
PRESSURE, BEFORE, WEIGHT = 9, 10, 11
LINE = 64  # bytes: arrays of lanes begin on a cache line


@kernel
def aligned(rows, size):
    """Zeros of shape (rows, size, WIDTH) that begin on a cache line."""
    count = rows * size * WIDTH
    room = np.zeros(count + LINE // 8)
    skipped = (-(room.ctypes.data // 8)) % (LINE // 8)
    return room[skipped : skipped + count].reshape((rows, size, WIDTH))


@kernel
def loads(columns, locked):
    """What the density takes: ``(cell, load before, load now)``; a locked shape bears nothing but pressure."""
    cell = (get(columns, H), get(columns, D), get(columns, AREA))
    gamma, c, k = get(columns, GAMMA), get(columns, RATIO), get(columns, SHEAR)
    part = 0.0 if locked else 1.0
    f, m, e = part * get(columns, FORCE), part * get(columns, TORQUE), get(columns, WEIGHT)
    now = (gamma, c, k, get(columns, PRESSURE), f, m, e)
    return cell, (gamma, c, k, get(columns, BEFORE), f, m, e), now


@kernel
def begin(lane, columns, base, stretch, x, y, safe, tube, line):
    """Mesh and first shape of one lane, from its uniform ``stretch``."""
    course, _, _, _, _, places = tube
    for k in range(3):
        course[0, 0, k, 0] = columns[k, lane]
    places[1] = columns[LENGTH, lane]
    load = (
        columns[GAMMA, lane], columns[RATIO, lane], columns[SHEAR, lane], columns[PRESSURE, lane],
        columns[FORCE, lane], columns[TORQUE, lane], columns[WEIGHT, lane],
    )  # fmt: skip
    line[2, 0] = stretch
    guide.start(tube, line[2, :1], load, line[0], line[1])
    for i in range(base + 1):
        x[i, lane], y[i, lane], safe[i, lane] = line[0, i], line[1, i], line[1, i]


@kernel
def enter(lane, problem, columns, base, x, y):
    """Put a design into a lane, undeformed."""
    for i in range(LENGTH):
        columns[i, lane] = problem[i]
    columns[LENGTH, lane] = 0.5 * problem[LENGTH]
    columns[PRESSURE, lane], columns[BEFORE, lane], columns[WEIGHT, lane] = 1.0, 0.0, 1.0
    for i in range(base + 1):
        x[i, lane], y[i, lane] = 1.0 * i, 1.0


@kernel
def is_clamped(problem):
    """Whether the fibers leave the clamped ends any meridional stretch."""
    rest = (problem[GAMMA], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return 1.0 + lagrangian.kinematics(1.0, (problem[H], problem[D], problem[AREA]), rest)[3] > 0.0


@kernel
def record(met, alpha, beta, rows, out, values, bounds, status, slack):
    """Write what was found in the lanes that are met."""
    for lane in range(WIDTH):
        row = rows[lane]
        if (met >> lane) & 1:
            status[row] = OK
            slack[row] = ((alpha >> lane) & 1) | (((beta >> lane) & 1) << 1)
            for k in range(nested.OUTPUTS):
                values[row, k], bounds[row, k] = out[0, k, lane], out[1, k, lane]


@kernel
def settle(p, problem, clamped, row, values, bounds, status):
    """What needs no solving: an unpressed tube, one that is pushed, one that is not valid. Whether that is so."""
    f, m = problem[FORCE], problem[TORQUE]
    if not (p >= 0.0 and clamped):
        status[row] = INVALID
    elif p == 0.0 and f == 0.0 and m == 0.0:
        half = 0.5 * problem[LENGTH]
        status[row] = OK
        values[row, 0], values[row, 1], values[row, 2], values[row, 3], values[row, 4] = half, half, 0.0, 0.0, 1.0
        for k in range(nested.OUTPUTS):
            bounds[row, k] = 0.0
    elif not p + f > 0.0 and not p == np.inf:
        status[row] = COMPRESSED
    else:
        return False
    return True


@entry_point
def walk_lanes(problems, first, pressures, order, base, accuracy, values, bounds, status, slack, states):
    """Walk the problems in the given ``order``, WIDTH at a time. Arguments as of :func:`branch.walk_many`; rows that a lane
    could not do keep the status that they have, and ``states`` says from where the scalar walk goes on:

    states : (problems, 2, base + 2) mesh and shape, each with one number behind: the pressure of that state (NaN where
        none was solved), and the uniform stretch
    """
    size = (base << nested.LANE_DOUBLINGS) + 2
    meshes, work, shapes = aligned(7, size), aligned(4, size), aligned(5, base + 2)
    x, y, kept_x, kept_y, safe = shapes[0], shapes[1], shapes[2], shapes[3], shapes[4]
    table, out = aligned(nested.LANE_DOUBLINGS + 2, nested.OUTPUTS), aligned(2, nested.OUTPUTS)
    found, small = aligned(2, nested.OUTPUTS), aligned(3, COLUMNS)
    columns, sizes, stretches = small[0], small[1], small[2]
    line = np.zeros((3, base + 1))
    tube = (np.zeros((1, 1, 3, 4)), np.array([0, base]), np.zeros((1, 3)), True, base, np.zeros(2))
    members, rows = np.zeros(WIDTH, np.int64), np.zeros(WIDTH, np.int64)
    for group in range(0, len(order), WIDTH):
        count = min(WIDTH, len(order) - group)
        longest, valid = 0, 0
        for lane in range(WIDTH):
            k = order[group + min(lane, count - 1)]
            members[lane] = k
            enter(lane, problems[k], columns, base, x, y)
            valid |= (1 if is_clamped(problems[k]) else 0) << lane
            longest = max(longest, first[k + 1] - first[k])

        active = 0  # the locked shapes: the last of each list
        for lane in range(count):
            k = members[lane]
            rows[lane] = first[k + 1] - 1
            if (valid >> lane) & 1 and first[k + 1] > first[k] and pressures[rows[lane]] == np.inf:
                active |= 1 << lane
                columns[WEIGHT, lane] = 0.0
                cell = (problems[k, H], problems[k, D], problems[k, AREA])
                begin(lane, columns, base, lagrangian.locked_stretch(cell, problems[k, GAMMA]), x, y, safe, tube, line)
        if active != 0:
            cell, _, now = loads(columns, True)
            asked = mask_of(active)
            met, alpha, beta = nested.solve(
                x,
                y,
                safe,
                base,
                cell,
                now,
                get(columns, LENGTH),
                asked,
                accuracy,
                meshes,
                work,
                table,
                sizes,
                found,
                out,
            )
            record(bits(met), bits(alpha), bits(beta), rows, out, values, bounds, status, slack)

        started, going = 0, valid
        u = spread(1.0)
        for lane in range(WIDTH):
            enter(lane, problems[members[lane]], columns, base, x, y)
        for step in range(longest):
            active = 0
            for lane in range(count):
                k = members[lane]
                rows[lane] = first[k] + step
                if rows[lane] < first[k + 1] and not pressures[rows[lane]] == np.inf:
                    p, clamped = pressures[rows[lane]], (valid >> lane) & 1 == 1
                    if not settle(p, problems[k], clamped, rows[lane], values, bounds, status) and (going >> lane) & 1:
                        columns[PRESSURE, lane] = p
                        active |= 1 << lane
            if active == 0:
                continue
            cell, before, now = loads(columns, False)
            if started & active != active:  # the first leg begins without any load
                fresh = mask_of(active & ~started)
                rest, one = spread(0.0), spread(1.0)
                before = (
                    select(fresh, one, before[0]), before[1], before[2], before[3],
                    select(fresh, rest, before[4]), select(fresh, rest, before[5]), before[6],
                )  # fmt: skip
            ahead, arrived = lane_guide.follow(u, cell, before, now, mask_of(active))
            put(stretches, 0, ahead)
            rescale = select(abs(u - 1.0) > 1e-9, (ahead - 1.0) / (u - 1.0), spread(1.0))
            for i in range(base + 1):
                put(kept_x, i, get(x, i))
                put(kept_y, i, get(y, i))
                put(safe, i, get(y, i))
                put(y, i, 1.0 + (get(y, i) - 1.0) * rescale)
            met, cold = mask_of(0), bits(arrived) & ~started
            for warm in range(1, -1, -1):  # a lane whose warm start fails begins anew
                asked = arrived & ~met
                if warm == 0:
                    cold = bits(asked) & started
                    asked = mask_of(cold)
                    if cold == 0:
                        break
                for lane in range(count):
                    if (cold >> lane) & 1:
                        begin(lane, columns, base, stretches[0, lane], x, y, safe, tube, line)
                found_here, alpha, beta = nested.solve(
                    x, y, safe, base, cell, now, get(columns, LENGTH), asked, accuracy, meshes, work, table, sizes,
                    found, out,
                )  # fmt: skip
                found_here = found_here & lane_guide.within(y, base, ahead)
                record(bits(found_here), bits(alpha), bits(beta), rows, out, values, bounds, status, slack)
                met = met | found_here
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

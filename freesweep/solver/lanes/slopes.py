"""Derivatives of free states of tubes that are the same all along, a vector of states at a time.

Each state is solved on nested meshes as :mod:`nested` does, from the same guess. On each of them the outputs' derivatives
along any number of directions are exact (:mod:`response`); they are extrapolated and bounded as outputs are.
"""

import numpy as np

from ...jit import entry_point, kernel
from ..load import Load
from ..numerics.nested import FAINT, SAFETY, SMALLEST_TOLERANCE, TINY
from ..numerics.newton import SMALL_STEP
from ..physics import lagrangian
from ..problem import LENGTH, SOURCE
from . import layer, mesh, middle, newton, response
from .nested import EARLY, LANE_DOUBLINGS, MIDDLE, OUTPUTS, foresee, integrate
from .pack import COLUMNS, PRESSURE, aligned, enter, loads, lock
from .tangent import join
from .vector import WIDTH, bits, get, mask_of, put, select, some, spread

TOLERANCE = 1e-12  # of Newton's last step, relative: a derivative takes its error many times
STRAIGHT, SLIGHTLY = 1e-8, 1e-3  # of the loads that balance; swelling of the tube that tells a straight one's mesh
LITTLE = 1e-2  # of the work of the loads, whose rounding the energy of a hardly strained wall carries
ROUNDING = 1e-11  # of what a derivative is measured by


@kernel
def paired(columns, changes, constants):
    """``(cell, load, relative change of the length)`` of the designs as tangents, from what each column changes by."""
    cell, _, load = loads(columns, constants, SOURCE, 1)
    own, _, change = loads(changes, constants, SOURCE, 1)
    gamma, rubber, wall, p, f, m, e = load
    longer = join(spread(1.0), get(changes, LENGTH) / get(columns, LENGTH))
    return (
        (join(cell[0], own[0]), join(cell[1], own[1]), join(cell[2], own[2])),
        Load(
            join(gamma, change.gamma), joined(rubber, change.rubber), wall, join(p, change.p), join(f, change.f),
            join(m, change.m), e,
        ),
        longer,
    )  # fmt: skip


@kernel
def joined(rubber, changes):
    """A rubber's constants as tangents."""
    if len(rubber) == 1:
        return (join(rubber[0], changes[0]),)
    return join(rubber[0], changes[0]), join(rubber[1], changes[1]), join(rubber[2], changes[2])


@kernel
def extrapolate(table, level, first, sizes, values, bounds):
    """Fourth-order values and bounds of the OUTPUTS numbers from row ``first`` on, from the last four meshes or the first
    three; returns the largest bound, scaled by ``sizes`` or by the number itself.
    """
    a, b, c, d = table[max(level - 3, 0)], table[level - 2], table[level - 1], table[level]
    change, share, largest = spread(TINY), spread(0.0), spread(0.0)
    for k in range(first, first + OUTPUTS):
        size = max(get(sizes, k - first), abs(get(d, k)))
        change = change + FAINT / OUTPUTS * abs(get(d, k) - get(c, k)) / size
    for k in range(first, first + OUTPUTS):
        second, third = (4.0 * get(c, k) - get(b, k)) / 3.0, (4.0 * get(d, k) - get(c, k)) / 3.0
        estimate = abs(third - second) / 15.0
        if level > 2:
            estimate = max(estimate, abs(second - (4.0 * get(b, k) - get(a, k)) / 3.0) / 225.0)
        size = max(get(sizes, k - first), abs(get(d, k)))
        put(values, k, third)
        put(bounds, k, estimate)
        share = max(share, estimate / (abs(get(d, k) - get(c, k)) + size * change))
    caution = EARLY if level == 2 else 1.0
    for k in range(first, first + OUTPUTS):
        size = max(get(sizes, k - first), abs(get(d, k)))
        bound = caution * max(SAFETY * get(bounds, k), share * abs(get(d, k) - get(c, k)))
        largest = max(largest, bound / size)
        put(bounds, k, bound + ROUNDING * size)
    return largest


@kernel
def at_mesh(x, y, n, base, u, columns, changes, constants, long, share, room, work, row):
    """Outputs on one mesh, and their changes along each of the ``changes``, into ``row``."""
    ratio, inverse, moved = work[0], work[1], work[2]
    cell, _, load = loads(columns, constants, SOURCE, 1)
    integrate(x, y, n, cell, load, row)
    put(row, MIDDLE, middle.stretch(y, n, base, u, long, share, room))
    response.factor(x, y, n, cell, load, ratio, inverse)
    for k in range(len(changes)):
        cells, under, longer = paired(columns, changes[k], constants)
        response.respond(x, y, n, cells, under, longer, ratio, inverse, moved)
        own = row[OUTPUTS * (k + 1) :]
        response.change(x, y, moved, n, cells, under, longer, own)
        response.middle(x, y, moved, n, base, u, cells, under, longer, long, share, room, own)


@kernel
def solve(x, y, n, u, straight, columns, changes, constants, active, accuracy, meshes, work, table, sizes, found, out):
    """Solve the ``active`` lanes, unless they are ``straight`` cylinders, and differentiate them: ``found`` and ``out`` (2,
    OUTPUTS times directions and one, WIDTH) take values and bounds, of lanes whose bounds meet the ``accuracy``, which are
    returned. Other arguments as of :func:`nested.solve`.
    """
    density = lagrangian.density
    cell, _, load = loads(columns, constants, SOURCE, 1)
    tolerance = max(TOLERANCE, SMALLEST_TOLERANCE)
    length = get(columns, LENGTH)
    bent = active & ~straight
    converged, error = newton.solve(density, x, y, n, True, cell, load, bent, y, True, SMALL_STEP, tolerance, work)
    todo = (bent & converged) | (active & straight)
    room = sizes[OUTPUTS:]
    long, share, _, _ = middle.node(x, y, n, u, cell, load, accuracy, room)
    at_mesh(x, y, n, n, u, columns, changes, constants, long, share, room, work, table[1])
    half_x, half_y, here_x, here_y, fine_x, fine_y = meshes[0], meshes[1], meshes[2], meshes[3], meshes[4], meshes[5]
    for i in range(n // 2 + 1):
        put(half_x, i, get(x, 2 * i))
        put(half_y, i, get(y, 2 * i))
    for i in range(n + 1):
        put(here_x, i, get(x, i))
        put(here_y, i, get(y, i))
    converged, _ = newton.solve(
        density, half_x, half_y, n // 2, True, cell, load, todo & bent, y, False, SMALL_STEP, tolerance, work
    )
    todo = todo & (converged | straight)
    at_mesh(half_x, half_y, n // 2, n, u, columns, changes, constants, long, share, room, work, table[0])
    met, level, count = mask_of(0), 1, n
    while some(todo) and level <= LANE_DOUBLINGS:
        level += 1
        mesh.split(x, n, 1 << (level - 1), fine_x)
        foresee(half_x, half_y, here_x, here_y, count, fine_x, fine_y, work[0], work[1])
        count *= 2
        half_x, half_y, here_x, here_y, fine_x, fine_y = here_x, here_y, fine_x, fine_y, half_x, half_y
        converged, error = newton.solve(
            density, here_x, here_y, count, True, cell, load, todo & bent, here_y, False, SMALL_STEP, tolerance, work
        )
        todo = todo & (converged | straight)
        row = table[level]
        at_mesh(here_x, here_y, count, n, u, columns, changes, constants, long, share, room, work, row)
        outputs = (get(row, 0), get(row, 1), get(row, 2), get(row, 3), get(row, 4))
        scale, _ = lagrangian.scales(outputs, cell, load, length, error)
        put(sizes, 0, scale[0])
        put(sizes, 1, scale[1])
        put(sizes, 2, scale[2])
        work_done = abs(load.p * outputs[1]) + abs(load.f * outputs[0]) + abs(load.m * outputs[2])
        put(sizes, 3, max(scale[3], LITTLE * work_done))
        put(sizes, 4, scale[4])
        largest = spread(0.0)
        for k in range(len(changes) + 1):
            largest = max(largest, extrapolate(table, level, OUTPUTS * k, sizes, found[0], found[1]))
        ready = todo & (largest <= accuracy)
        for k in range(OUTPUTS * (len(changes) + 1)):
            put(out[0], k, select(ready, get(found[0], k), get(out[0], k)))
            put(out[1], k, select(ready, get(found[1], k), get(out[1], k)))
        met, todo = met | ready, todo & ~ready
    return met


@kernel
def is_straight(cell, load):
    """Where the undeformed cylinder is an equilibrium: what holds it may keep it from buckling, which loads alone do not."""
    _, L_y, _, _, _, _ = lagrangian.density(spread(1.0), 0.0, cell, load)
    size = (abs(load.p) + abs(load.f) + abs(load.m)) * (1.0 + cell[0] * cell[0] + cell[1] * cell[1])
    return abs(L_y) <= STRAIGHT * size


@entry_point
def differentiate_lanes(problems, pressures, stretches, order, changes, constants, base, accuracy, values, bounds):
    """Values and bounds (rows, 1 + directions, OUTPUTS) of the rows in the given ``order``, WIDTH at a time: of outputs, and
    of their derivatives along the directions. NaN in rows that no vector could do.

    Row i is a problem of its own under ``pressures[i]``, whose uniform tube has the stretch ``stretches[i]``, NaN where that
    is not known, unless it is a straight cylinder; ``changes``
    (rows, directions, COLUMNS) are what the columns of a seat (:mod:`.pack`) change by.
    """
    size, directions = (base << LANE_DOUBLINGS) + 2, changes.shape[1]
    numbers = OUTPUTS * (directions + 1)
    space = aligned(11, size)
    meshes, work = space[:7], space[7:]
    table, ends = aligned(LANE_DOUBLINGS + 2, numbers), aligned(4, numbers)
    found, out = ends[:2], ends[2:]
    shape, small, seats = aligned(2, base + 1), aligned(3, COLUMNS), aligned(directions, COLUMNS)
    x, y = shape[0], shape[1]
    columns, sizes, start = small[0], small[1], small[2]
    for group in range(0, len(order), WIDTH):
        count = min(WIDTH, len(order) - group)
        for lane in range(WIDTH):
            row = order[group + min(lane, count - 1)]
            enter(lane, problems[row], columns)
            start[0, lane] = stretches[row]
            if pressures[row] == np.inf:
                lock(lane, columns)
            else:
                columns[PRESSURE, lane] = pressures[row]
            for k in range(directions):
                for i in range(COLUMNS):
                    seats[k, i, lane] = changes[row, k, i]
        cell, _, load = loads(columns, constants, SOURCE, 1)
        u, half = get(start, 0), get(columns, LENGTH)
        known = u == u
        straight = is_straight(cell, load) & ~known
        layer.begin(select(known, u, spread(1.0 + SLIGHTLY)), cell, load, half, base, work, meshes, x, y)
        for i in range(base + 1):
            put(y, i, select(straight, spread(1.0), get(y, i)))
        active = mask_of((1 << count) - 1) & (known | straight)
        met = bits(solve(
            x, y, base, select(known, u, spread(1.0)), straight, columns, seats, constants, active, accuracy, meshes, work,
            table, sizes, found, out,
        ))  # fmt: skip
        for lane in range(count):
            if (met >> lane) & 1:
                row = order[group + lane]
                for k in range(directions + 1):
                    for i in range(OUTPUTS):
                        values[row, k, i], bounds[row, k, i] = (
                            out[0, OUTPUTS * k + i, lane],
                            out[1, OUTPUTS * k + i, lane],
                        )

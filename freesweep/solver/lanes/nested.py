"""Nested meshes of :mod:`freesweep.solver.numerics.nested` for a vector of designs: the same values, the same bounds.

Three meshes suffice where bounds that are more generous by EARLY meet the accuracy. A lane whose bounds meet the accuracy
keeps its numbers; the others go on to finer meshes. A lane that needs more than LANE_DOUBLINGS, or fails, is left
to another try or the scalar kernels.
"""

from ...jit import kernel
from ..numerics import finest
from ..numerics.nested import FAINT, SAFETY, SMALLEST_TOLERANCE, TINY
from ..numerics.newton import SMALL_STEP
from ..physics import lagrangian
from . import mesh, middle, newton
from .slack import pushing
from .vector import WIDTH, bits, get, mask_of, put, select, some, spread

OUTPUTS = 5  # length, volume, twist, energy, middle stretch
MIDDLE = 4
LANE_DOUBLINGS = 6  # of the base mesh
LARGEST_TOLERANCE = 1e-7  # of Newton's last step; what it leaves is in the bounds
EARLY = 2.2  # of bounds that no third extrapolation confirms
STILL = 1e-3  # radii: if the last node moves more, the layer is not resolved there, and all outputs err the more


@kernel
def integrate(x, y, n, cell, load, row):
    """Integrals over the tube on one mesh, and the stretch in the middle."""
    length, volume, twist, energy = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    x_left, y_left = get(x, 0), get(y, 0)
    for j in range(n):
        x_right, y_right = get(x, j + 1), get(y, j + 1)
        h = x_right - x_left
        s, v, t, w, _ = lagrangian.integrands(0.5 * (y_left + y_right), (y_right - y_left) / h, cell, load)
        length = length + h * s
        volume = volume + h * v
        twist = twist + h * t
        energy = energy + h * w
        x_left, y_left = x_right, y_right
    put(row, 0, length)
    put(row, 1, volume)
    put(row, 2, twist)
    put(row, 3, energy)
    put(row, 4, y_left)


@kernel
def extrapolate(table, level, cell, load, length, error, missed, sizes, values, bounds):
    """Fourth-order values and bounds from the last four rows, or the first three; returns the largest scaled bound,
    rounding left out.
    """
    row = table[level]
    outputs = (get(row, 0), get(row, 1), get(row, 2), get(row, 3), get(row, 4))
    scale, floor = lagrangian.scales(outputs, cell, load, length, error)
    put(sizes, 0, scale[0])
    put(sizes, 1, scale[1])
    put(sizes, 2, scale[2])
    put(sizes, 3, scale[3])
    put(sizes, 4, scale[4])
    change, share, largest = spread(TINY), spread(0.0), spread(0.0)
    for k in range(OUTPUTS):
        change = change + FAINT / OUTPUTS * abs(get(row, k) - get(table[level - 1], k)) / get(sizes, k)
    for k in range(OUTPUTS):
        b, c, d = get(table[level - 2], k), get(table[level - 1], k), get(row, k)
        second, third = (4.0 * c - b) / 3.0, (4.0 * d - c) / 3.0
        estimate = abs(third - second) / 15.0
        if level > 2:
            first = (4.0 * b - get(table[level - 3], k)) / 3.0
            estimate = max(estimate, abs(second - first) / 225.0)
        put(values, k, third)
        put(bounds, k, estimate)
        share = max(share, estimate / (abs(d - c) + get(sizes, k) * change))
    caution = EARLY if level == 2 else 1.0
    for k in range(OUTPUTS):
        second_order = share * abs(get(row, k) - get(table[level - 1], k))
        bound = caution * max(SAFETY * get(bounds, k), second_order)
        if k == MIDDLE:
            bound = bound + missed
        largest = max(largest, bound / get(sizes, k))
        put(bounds, k, bound)
    put(bounds, 0, get(bounds, 0) + floor[0])
    put(bounds, 1, get(bounds, 1) + floor[1])
    put(bounds, 2, get(bounds, 2) + floor[2])
    put(bounds, 3, get(bounds, 3) + floor[3])
    put(bounds, 4, get(bounds, 4) + floor[4])
    return largest


@kernel
def foresee(half_x, half_y, x, y, n, fine_x, fine_y, change, both):
    """First guess on twice as many cells: the solution on n cells, carried on by the change from n/2 cells, which doubling
    the cells will repeat at a quarter.
    """
    for i in range(n // 2 + 1):
        put(change, i, 0.25 * (get(y, 2 * i) - get(half_y, i)))
    mesh.prolong(half_x, change, n // 2, x, both)
    for i in range(n + 1):
        put(both, i, get(both, i) + get(y, i))
    mesh.prolong(x, both, n, fine_x, fine_y)


@kernel
def restart(lost, safe, n, y):
    """Put the shape that cannot be too steep into the lanes that are lost."""
    for i in range(n + 1):
        put(y, i, select(lost, get(safe, i), get(y, i)))


@kernel
def keep(ready, count, error, coarsest_x, coarsest_y, coarse_x, coarse_y, x, y, kept):
    """The finest mesh of ``count`` cells, and the two before, of the lanes that are ready, as in
    :mod:`..numerics.finest`.
    """
    for lane in range(WIDTH):
        if (ready >> lane) & 1:
            fine = kept[lane]
            for i in range(count + 1):
                fine[0, i], fine[1, i] = x[i, lane], y[i, lane]
            behind = count // 2 + 1
            fine[3, finest.LEFT] = error[0, lane]
            for i in range(behind):
                fine[2, i], fine[4, i] = coarse_x[i, lane], coarse_y[i, lane]
            for i in range(count // 4 + 1):
                fine[2, behind + i], fine[4, behind + i] = coarsest_x[i, lane], coarsest_y[i, lane]


@kernel
def solve(x, y, n, u, cell, load, length, active, accuracy, meshes, work, table, sizes, found, out, kept, doublings):
    """Solve the ``active`` lanes, whose uniform tubes have stretch ``u``; ``x`` and ``y`` (n + 1, WIDTH) are the graded base
    mesh and a first guess, replaced by its solution.

    ``meshes`` is scratch (7, > n 2^LANE_DOUBLINGS, WIDTH), ``work`` (7, as many, WIDTH). ``out`` (2, > OUTPUTS, WIDTH) takes
    values and bounds of the lanes that are met; ``found`` (2, ...) is scratch. ``kept`` (WIDTH, 5, ...), unless None, takes
    their finest meshes as :func:`..along.profile.at_stations` reads them, with ``doublings``. Returns masks: ``(met, alpha
    fibers would have to push, beta fibers would)``.
    """
    # the energy at a low pressure is little beside the work whose error it takes: more than the accuracy of the rest
    tolerance = max(min(accuracy * accuracy, LARGEST_TOLERANCE), SMALLEST_TOLERANCE)
    density, integrands = lagrangian.density, lagrangian.integrands
    todo = active
    converged, error = newton.solve(density, x, y, n, True, cell, load, todo, y, True, SMALL_STEP, tolerance, work)
    todo = todo & converged
    integrate(x, y, n, cell, load, table[1])
    room = sizes[OUTPUTS:]
    long, share, missed, resolved = middle.node(x, y, n, u, cell, load, accuracy, room)
    put(table[1], MIDDLE, middle.stretch(y, n, n, u, long, share, room))
    half_x, half_y, here_x, here_y, fine_x, fine_y = meshes[0], meshes[1], meshes[2], meshes[3], meshes[4], meshes[5]
    for i in range(n // 2 + 1):
        put(half_x, i, get(x, 2 * i))
        put(half_y, i, get(y, 2 * i))
    for i in range(n + 1):
        put(here_x, i, get(x, i))
        put(here_y, i, get(y, i))
    converged, _ = newton.solve(
        density, half_x, half_y, n // 2, True, cell, load, todo, y, False, SMALL_STEP, tolerance, work
    )
    lost = todo & ~converged
    if some(lost):
        safe = meshes[6]
        mesh.merge(integrands, x, y, n, cell, load, safe)
        restart(lost, safe, n // 2, half_y)
        again, _ = newton.solve(
            density, half_x, half_y, n // 2, True, cell, load, lost, safe, True, SMALL_STEP, tolerance, work
        )
        converged = converged | again
    todo = todo & converged
    integrate(half_x, half_y, n // 2, cell, load, table[0])
    put(table[0], MIDDLE, middle.stretch(half_y, n // 2, n, u, long, share, room))
    met, alpha, beta = mask_of(0), mask_of(0), mask_of(0)
    level, count = 1, n
    while some(todo) and level <= LANE_DOUBLINGS:
        level += 1
        mesh.split(x, n, 1 << (level - 1), fine_x)
        foresee(half_x, half_y, here_x, here_y, count, fine_x, fine_y, work[0], work[1])
        count *= 2
        half_x, half_y, here_x, here_y, fine_x, fine_y = here_x, here_y, fine_x, fine_y, half_x, half_y
        coarser = error
        converged, error = newton.solve(
            density, here_x, here_y, count, True, cell, load, todo, here_y, False, SMALL_STEP, tolerance, work
        )
        lost = todo & ~converged
        if some(lost):
            safe = meshes[6]
            mesh.halve(integrands, half_x, half_y, count // 2, cell, load, here_x, safe)
            restart(lost, safe, count, here_y)
            again, last = newton.solve(
                density, here_x, here_y, count, True, cell, load, lost, safe, True, SMALL_STEP, tolerance, work
            )
            converged, error = converged | again, select(again, last, error)
        todo = todo & converged
        integrate(here_x, here_y, count, cell, load, table[level])
        put(table[level], MIDDLE, middle.stretch(here_y, count, n, u, long, share, room))
        if kept is not None:
            if level == 2:
                continue  # profiles want more of the nodes than the integrals do
        largest = extrapolate(table, level, cell, load, length, max(error, coarser), missed, sizes, found[0], found[1])
        ready = todo & (largest <= accuracy)
        if level == 2:
            ready = ready & resolved & (abs(get(here_y, count) - get(half_y, count // 2)) < STILL)
        for k in range(OUTPUTS):
            put(out[0], k, select(ready, get(found[0], k), get(out[0], k)))
            put(out[1], k, select(ready, get(found[1], k), get(out[1], k)))
        if some(ready):
            alpha_here, beta_here = pushing(here_y, count, cell, load)
            alpha, beta = alpha | (alpha_here & ready), beta | (beta_here & ready)
            if kept is not None:
                put(sizes, 0, max(error, coarser))
                keep(bits(ready), count, sizes, fine_x, fine_y, half_x, half_y, here_x, here_y, kept)
                for lane in range(WIDTH):
                    doublings[lane] = level - 1 if (bits(ready) >> lane) & 1 else doublings[lane]
        met, todo = met | ready, todo & ~ready
    return met, alpha, beta

"""Nested meshes: every output extrapolated, with an error bound, refined until the bound meets the accuracy asked for.

A midpoint cell errs by even powers of its size, so results A on meshes of n/2, n, 2n, 4n cells extrapolate to fourth
order, ``E = (4 A_2n - A_n)/3``. The difference of two successive E, divided by the 15 that the order allows, or by less
where it has fallen by less (cells longer than a layer), estimates the error of the second; the difference before it,
divided by 225, guards against its passing through zero. So does the
largest share that such an estimate has in the last change of any output, A_2n - A_n: no other has a smaller one. The bound
is ``SAFETY`` times the estimate, plus a floor for rounding and for what Newton's last steps left.

The rows of ``table`` belong to the meshes, coarsest first; its columns are the outputs: the four integrals, y in the
middle, and the multiplier of a held integral.
"""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..cells import MIXED, behind, cell_at, largest_sizes, nothing_yet
from ..load import loaded
from . import finest, held, kinks, newton
from . import mesh as grading
from .newton import Mesh
from .properties_along import fill

OUTPUTS = 6  # length, volume, twist, energy, middle stretch, multiplier
MIDDLE, MULTIPLIER = 4, 5
MAX_DOUBLINGS = 7  # of the base mesh, which a coarser one (half) and two or more finer ones join
MOVES = 2  # of the base mesh, so that it does not hide where the kind of cell changes
STEP_SHARE = 1e-6  # of the accuracy: what Newton's last step may leave
SMALLEST_TOLERANCE = 1e-14
SAFETY = 3.3
SLOWEST = 0.75  # share of a difference that the next one is taken to be at most
FAINT = 0.02  # of the outputs' mean change: what counts as change of an output that hardly changes
TINY = 1e-300

UNREACHED = 3  # the accuracy was not met on the finest mesh


class Room(NamedTuple):
    """The graded base mesh ``x``, ``y`` a first guess, (n + 1,); scratch for the ``fine`` meshes, left as :mod:`finest`
    describes, and of Newton's method, (13, ...); the ``table``; and ``out`` (4, OUTPUTS): values, bounds, scales, floors.
    """

    x: np.ndarray
    y: np.ndarray
    fine: np.ndarray
    work: np.ndarray
    table: np.ndarray
    out: np.ndarray


@kernel
def integrate(integrands, x, y, n, cells, load, row, changes):
    """Integrals over the tube on one mesh; whether the kind of cell, in which the density is smooth, changes along it, and
    where, in shares of the cells.
    """
    length, volume, twist, energy = 0.0, 0.0, 0.0, 0.0
    count, before, near = 0, -1.0, nothing_yet(0.0)
    varying = len(cells) > 1
    cell = cell_at(cells, 0)
    for j in range(n):
        if varying:
            cell = cell_at(cells, j)
        h = x[j + 1] - x[j]
        s, v, t, w, kind, near = integrands(0.5 * (y[j] + y[j + 1]), (y[j + 1] - y[j]) / h, behind(cell, h, near), load)
        if (kind != before or kind == MIXED) and j > 0:
            if count < kinks.MOST:
                changes[count] = j / n
            count += 1
        before = kind
        length += h * s
        volume += h * v
        twist += h * t
        energy += h * w
    row[0], row[1], row[2], row[3] = length, volume, twist, energy
    kinks.forget(changes, count)
    return count > 0


@kernel
def fourth_order(a, b, c, d, broken):
    """``(value, estimate of its error)`` from results on meshes of twice the cells each. On ``broken`` ones a cell somewhere
    holds a change of smoothness: it errs now by more, now by less, and no difference is divided by what an order allows.
    """
    first, second, third = (4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0, (4.0 * d - c) / 3.0
    last, before = abs(third - second), abs(second - first)
    if broken:
        return third, max(last, 0.25 * before)
    fallen = min(last / (before + TINY), SLOWEST)
    return third, max(last * max(fallen / (1.0 - fallen), 1.0 / 15.0), before / 225.0)


@kernel
def extrapolate(table, level, scales, floors, broken, values, bounds):
    """Fourth-order values and bounds from the last four rows; returns the largest scaled bound."""
    largest, share, change = 0.0, 0.0, TINY
    for k in range(OUTPUTS):
        change += FAINT / OUTPUTS * abs(table[level, k] - table[level - 1, k]) / scales[k]
    for k in range(OUTPUTS):
        c, d = table[level - 1, k], table[level, k]
        values[k], estimate = fourth_order(table[level - 3, k], table[level - 2, k], c, d, broken)
        bounds[k] = SAFETY * estimate
        share = max(share, estimate / scales[k] / (abs(d - c) / scales[k] + change))
    for k in range(OUTPUTS):
        bounds[k] = max(bounds[k], share * abs(table[level, k] - table[level - 1, k]))
        largest = max(largest, bounds[k] / scales[k])
        bounds[k] += floors[k]
    return largest


@kernel
def make_admissible(density, x, y, n, cells, load):
    """Shrink ``y`` toward 1, where every state is admissible, until each cell has room."""
    for _ in range(60):
        if newton.admissible(density, x, y, n, cells, load):
            return True
        for i in range(n + 1):
            y[i] = 1.0 + 0.85 * (y[i] - 1.0)
    return False


@kernel
def ease(integrands, x, y, n, guess, mesh, load, work):
    """Ease a ``guess`` on a mesh of half or twice as many cells as the solution ``y`` on n cells, by the slopes of that."""
    sine, cosine, here = work[0], work[1], work[2]
    grading.slants(integrands, x, y, n, mesh.cells, load, sine, cosine)
    for j in range(mesh.n):
        here[j] = min(cosine[2 * j], cosine[2 * j + 1]) if mesh.n < n else cosine[j // 2]
    grading.ease(integrands, mesh.x, guess, mesh.n, here, mesh.cells, load)


@kernel
def adapt(functional, x, y, n, tube, load, work):
    """Move the nodes of the base mesh to where the solution bends, and carry the solution over, eased where that leaves a
    cell no room; returns whether it is admissible there.
    """
    course, edges, cells, free, _, _ = tube
    density, integrands = functional.density, functional.integrands
    own = fill(course, edges, x, n, n, cells)
    cosine, rate, nodes, new_x, new_y, least = work[1], work[2], work[3], work[4], work[5], work[7]
    for s in range(len(edges) - 1):  # each segment keeps its nodes: the jumps between them stay on the mesh
        a, b = edges[s], edges[s + 1]
        here = own[a:b] if len(own) > 1 else own
        symmetric = free and s == len(edges) - 2
        grading.turning(integrands, x[a : b + 1], y[a : b + 1], b - a, symmetric, here, load, work, rate)
        grading.node_density(x[a : b + 1], b - a, rate, nodes)
        grading.regrade(x[a : b + 1], y[a : b + 1], nodes, b - a, b - a, new_x[a : b + 1], new_y[a : b + 1], work[6])
    own = fill(course, edges, new_x, n, n, cells)
    fits = newton.admissible(density, new_x, new_y, n, own, load)
    if free and not fits:
        grading.least_between(x, cosine, n, new_x, least)
        grading.ease(integrands, new_x, new_y, n, least, own, load)
        fits = newton.admissible(density, new_x, new_y, n, own, load)
    for i in range(n + 1):
        x[i], y[i] = new_x[i], new_y[i]
    return fits


@kernel
def move_on(density, room, tube, hidden, found, level, load, kept):
    """Move the base mesh, so that it does not hide where the kind of cell changes, see :mod:`kinks`; its nodes and shape
    before are ``kept``. Whether all cells have room then; else it is as it was.
    """
    x, y, n, edges = room.x, room.y, len(room.x) - 1, tube.edges
    for i in range(n + 1):
        kept[0, i], kept[1, i] = x[i], y[i]
    kinks.move_on(x, y, edges, hidden, found, level - 3)
    fits = newton.admissible(density, x, y, n, fill(tube.course, edges, x, n, n, tube.cells), load)
    for i in range(n + 1):
        x[i], y[i] = (x[i], y[i]) if fits else (kept[0, i], kept[1, i])
    return fits


@kernel
def split(x, n, edges, factor, out):
    """A finer mesh: each cell of the base mesh in ``factor``, smoothly within each segment."""
    for s in range(len(edges) - 1):
        a, b = edges[s], edges[s + 1]
        grading.split(x[a : b + 1], b - a, factor, out[a * factor : b * factor + 1])


@kernel
def foresee(fine, n, work):
    """First guess in row 1 of ``fine`` on twice as many cells, whose nodes are in row 0: the solution on n cells (rows 2,
    4), carried on by the change from n/2 cells (row 3), which doubling the cells will repeat at a quarter.
    """
    half_x, change, both = work[0], work[1], work[2]
    for i in range(n // 2 + 1):
        half_x[i] = fine[2, 2 * i]
        change[i] = 0.25 * (fine[4, 2 * i] - fine[3, i])
    grading.prolong(half_x, change, n // 2, fine[2], both)
    for i in range(n + 1):
        both[i] += fine[4, i]
    grading.prolong(fine[2], both, n, fine[0], fine[1])


@kernel
def go_finer(x, n, edges, doublings, fine, work):
    """Nodes and first guess of the next finer mesh in rows 0, 1 of ``fine``, which hold the solution on this one, after so
    many ``doublings`` of the base mesh ``x``; row 3 holds that on the coarser one, which becomes the last of three.
    """
    count = n << doublings
    for i in range(count // 2 + 1):
        fine[2, count + 1 + i], fine[4, count + 1 + i] = fine[0, 2 * i], fine[3, i]
    for i in range(count + 1):
        fine[2, i], fine[4, i] = fine[0, i], fine[1, i]
    split(x, n, edges, 2 << doublings, fine[0])
    foresee(fine, count, work)
    for i in range(count + 1):
        fine[3, i] = fine[4, i]


@kernel
def on_mesh(functional, y, mesh, load, target, mu, rate, tolerance, work):
    """The state on one mesh, ``y`` in place: ``(status, unstable directions, multiplier, rate of convergence, error that
    the last step left)``.
    """
    if target.any:
        status, unstable, mu = held.solve_held(functional, y, mesh, load, target, mu, tolerance, work)
        return status, unstable, mu, rate, tolerance
    status, unstable, rate, error = newton.solve(functional.density, y, mesh, load, rate, tolerance, work)
    return status, unstable, mu, rate, error


@kernel
def rescue(functional, room, level, guess, mesh, load):
    """Ease a guess that leaves a cell no room, by the solution on the mesh before; whether all have room then."""
    x, y, fine, n = room.x, room.y, room.fine, len(room.x) - 1
    if level == 0 and mesh.free:
        ease(functional.integrands, x, y, n, guess, mesh, load, room.work)
    elif level > 1 and mesh.free:
        ease(functional.integrands, fine[2], fine[4], mesh.n // 2, guess, mesh, load, room.work)
    return make_admissible(functional.density, mesh.x, guess, mesh.n, mesh.cells, load)


@kernel
def tell(functional, y, mesh, base, center, mu, load, row, changes):
    """Write the outputs on one mesh, nested in one of ``base`` cells, to a ``row`` of the table. Returns whether the kind of
    cell changes along the tube; where is written to ``changes``.
    """
    row[MIDDLE], row[MULTIPLIER] = y[center * mesh.n // base], mu
    return integrate(functional.integrands, mesh.x, y, mesh.n, mesh.cells, load, row, changes)


@kernel
def measure(scales, direction, held, out):
    """Write scales and floors of outputs, the pair of ``scales``, to ``out``; of a multiplier in units of its direction."""
    for k in range(OUTPUTS):
        out[2, k], out[3, k] = scales[0][k], scales[1][k]
    if held:
        unit = max(abs(direction.p), max(abs(direction.f), abs(direction.m)))
        out[2, MULTIPLIER] /= max(unit, 1.0)
        out[3, MULTIPLIER] /= unit


@kernel
def judge(functional, room, level, cells, load, target, error, broken):
    """Values and bounds from the last four rows of the table, into ``out``; returns the largest scaled bound."""
    x, out = room.x, room.out
    scales = functional.scales(room.table[level], largest_sizes(cells), load, x[len(x) - 1] - x[0], error)
    measure(scales, target.direction, target.any, out)
    return extrapolate(room.table, level, out[2], out[3], broken, out[0], out[1])


@kernel
def next_mesh(room, edges, level):
    """The mesh after this one, and a first guess on it: ``(row of the table, cells, nodes, guess)``. The base mesh (row 1)
    comes first, then half of it (row 0), then it is doubled, and again, ...
    """
    x, y, fine, n = room.x, room.y, room.fine, len(room.x) - 1
    if level == 1:
        for i in range(n // 2 + 1):
            fine[2, i], fine[3, i] = x[2 * i], y[2 * i]
        return 0, n // 2, fine[2], fine[3]
    if level == 0:
        level = 1
        for i in range(n + 1):
            fine[0, i], fine[1, i] = x[i], y[i]
    go_finer(x, n, edges, level - 1, fine, room.work)
    return level + 1, n << level, fine[0], fine[1]


@kernel
def solve(functional, room, tube, load, target, mu, regrades, accuracy):
    """Solve on nested meshes until every bound meets ``accuracy``.

    ``tube`` is a :class:`.properties_along.Tube`; of one that is solved by half the last node is free. The ``room``, or
    what has all that a :class:`Room` has, begins with a guess, and the multiplier of the :class:`.held.Target` with about
    ``mu``; its base mesh and guess are replaced by the adapted mesh and its solution: the next call's warm start.

    Returns ``(status, unstable directions, doublings of the base mesh)``.
    """
    n, table = len(room.x) - 1, room.table
    course, edges, cells, free, center, _ = tube
    tolerance = max(STEP_SHARE * accuracy, SMALLEST_TOLERANCE)
    error, on_base, rate = tolerance, mu, newton.UNKNOWN
    passes, moves, level, count, shrunk, xs, ys = 0, 0, 1, n, False, room.x, room.y
    changes, hidden, kept = np.empty((MAX_DOUBLINGS + 2, kinks.MOST)), np.empty((2, kinks.MOST)), np.empty((2, n + 1))
    while True:
        own, coarser = Mesh(xs, count, free, fill(course, edges, xs, count, n, cells)), error
        status, unstable, mu, rate, error = on_mesh(functional, ys, own, load, target, mu, rate, tolerance, room.work)
        now = loaded(load, target.direction, mu)
        if status == newton.INFEASIBLE and not shrunk:
            shrunk = True
            if rescue(functional, room, level, ys, own, now):
                continue
        if status != newton.CONVERGED:
            if not 0 < moves <= MOVES:
                return status, unstable, max(level - 1, 0)
            for i in range(n + 1):  # the mesh before it was moved had the state
                room.x[i], room.y[i] = kept[0, i], kept[1, i]
            moves, mu, shrunk, level, count, xs, ys = MOVES + 1, on_base, False, 1, n, room.x, room.y
            continue
        shrunk = False
        if level == 1 and passes < regrades:
            adapt(functional, room.x, room.y, n, tube, now, room.work)
            passes += 1
            continue
        broken = tell(functional, ys, own, n, center, mu, now, table[level], changes[level])
        if level >= 3:
            left, found = max(error, coarser), kinks.find(changes, level, edges, hidden)
            if found > 0 and moves < MOVES and move_on(functional.density, room, tube, hidden, found, level, now, kept):
                moves, mu, level, count, xs, ys = moves + 1, on_base, 1, n, room.x, room.y
                continue
            largest = judge(functional, room, level, own.cells, now, target, left, broken)
            met = largest <= accuracy and found == 0
            if met or level == MAX_DOUBLINGS + 1:
                multiplier = room.out[0, MULTIPLIER]
                finest.leave_loads(table[:, MULTIPLIER], level, multiplier, target.direction, left, room.fine)
                return newton.CONVERGED if met else UNREACHED, unstable, level - 1
        on_base = mu if level == 1 else on_base
        mu = on_base if level == 0 else mu
        level, count, xs, ys = next_mesh(room, edges, level)

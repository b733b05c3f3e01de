"""Nested meshes: every output extrapolated, with an error bound, refined until the bound meets the accuracy asked for.

What results on meshes of n/2, n, 2n, 4n cells tell of their limit, and how exactly, is told by :mod:`error_bounds`; how the
meshes lie, by :mod:`base_mesh`.
"""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..cells import MIXED, behind, cell_at, largest_sizes, nothing_yet
from ..load import loaded
from . import finest, held, kinks, newton
from . import mesh as grading
from .base_mesh import adapt, go_finer, move_on
from .error_bounds import MIDDLE, MULTIPLIER, extrapolate, measure
from .newton import Mesh
from .properties_along import fill

MAX_DOUBLINGS = 7  # of the base mesh, which a coarser one (half) and two or more finer ones join
MOVES = 2  # of the base mesh, so that it does not hide where the kind of cell changes
STEP_SHARE = 1e-6  # of the accuracy: what Newton's last step may leave
SMALLEST_TOLERANCE = 1e-14

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

"""The held state of a tube with a neck (:mod:`.necked_shape`): from a mesh's shape on, in small steps of what loads it."""

import numpy as np

from ...jit import kernel
from ..load import loaded
from ..numerics import error_bounds, finest, nested
from ..numerics.dense import eliminate
from ..physics import lagrangian
from ..status import INACCURATE, NOT_CONVERGED, OK
from . import necked_shape, quadrature
from .necked_shape import FOLDS, MIDDLE, MU, NECK_FOLDS, Asked, Traced

NEAR = 0.05  # relative difference of the first middle from the mesh's
NODES, MOST_NODES = 320, 6144  # along body and neck: on the way, and at its end
ITERATIONS, HOPELESS = 20, 1e6  # Newton's; times the largest steps
DIFFERENCE, FOLDS_DIFFERENCE = 1e-9, 1e-5  # for slopes: of a stretch or mu, with which much turns sharply, and of q
CLOSE, CLOSEST = 1e-8, 1e-13  # relative, of every equation: on the way, and at its end
ROUNDED = 1e3  # times that: near enough where it falls no further
FIRST_STEP, SMALLEST_STEP, STEPS = 0.02, 1e-6, 2000  # of the way
LARGEST_CHANGE, LARGEST_FOLDS = 0.1, 3.0  # of a stretch or mu, and of q, in a step
STRAY = 0.03  # of y_m from its linear prediction: more is another branch


@kernel
def copy(numbers, out):
    for k in range(len(numbers)):
        out[k] = numbers[k]


@kernel
def fit(asked, now, free, nodes, tolerance, traced):
    """Newton's method from a guess ``now``, which is replaced; whether it converged."""
    miss, moved, there, matrix = np.empty(3), np.empty(3), np.empty(5), np.empty((3, 3))
    least = 1e300
    for _ in range(ITERATIONS):
        necked_shape.misses(asked, now, free, nodes, traced, miss)
        most = np.max(np.abs(miss))
        if most < tolerance or (most < ROUNDED * tolerance and most >= 0.5 * least):
            return True
        least = min(least, most)
        for j in range(3):
            k = free[j]
            step = FOLDS_DIFFERENCE if k == FOLDS or k == NECK_FOLDS else DIFFERENCE * now[k]
            copy(now, there)
            there[k] += step
            necked_shape.misses(asked, there, free, nodes, traced, moved)
            for i in range(3):
                matrix[i, j] = (moved[i] - miss[i]) / step
        eliminate(matrix, miss.reshape((3, 1)))
        largest = 1.0
        for j in range(3):
            k = free[j]
            most = LARGEST_FOLDS if k == FOLDS or k == NECK_FOLDS else LARGEST_CHANGE * abs(now[k])
            largest = max(largest, abs(miss[j]) / most)
        if not largest < HOPELESS:
            break
        for j in range(3):
            now[free[j]] -= miss[j] / largest
    return False


@kernel
def asked_at(cell, path, t, half):
    """What is asked at the share t of a path."""
    load, what = loaded(path.origin, path.direction, t), path.held
    return Asked(cell, load, what.unit, what.first + t * what.change, half)


@kernel
def follow(cell, track, path, t, half, traced, now):
    """The numbers ``now`` at the end of the path; arguments as of :func:`solve`. Whether they were found."""
    n = len(track.x) - 1
    mu, asked = track.y[n + 1], asked_at(cell, path, t, half)
    if not necked_shape.guess_of(cell, loaded(asked.load, asked.direction, mu), track.x, track.y[: n + 1], now):
        return False
    now[MU] = mu
    middle, last, guess, t_last, step = now[MIDDLE], np.empty(5), np.empty(5), t, FIRST_STEP * t
    if not fit(asked, now, necked_shape.unknowns(asked, now), NODES, CLOSE, traced):
        return False
    if not abs(now[MIDDLE] / middle - 1.0) < NEAR:
        return False
    copy(now, last)
    for _ in range(STEPS):
        if t >= 1.0:
            return True
        ahead = min(1.0, t + step)
        share = (ahead - t) / (t - t_last) if t > t_last else 0.0
        for k in range(5):
            guess[k] = now[k] + share * (now[k] - last[k])
        expected, asked = guess[MIDDLE], asked_at(cell, path, ahead, half)
        if (
            fit(asked, guess, necked_shape.unknowns(asked, now), NODES, CLOSE, traced)
            and abs(guess[MIDDLE] / expected - 1.0) < STRAY
            and abs(guess[MIDDLE] / now[MIDDLE] - 1.0) < LARGEST_CHANGE
        ):
            copy(now, last)
            copy(guess, now)
            t_last, t, step = t, ahead, 1.5 * step
            continue
        step *= 0.5
        if step < SMALLEST_STEP * t:
            break
    return False


@kernel
def solve(room, tube, cell, path, t, scale, accuracy):
    """The state at the end of a path; at its share ``t`` the mesh in the room's track has the necked shape.

    Returns ``(status, doublings, load)``, and what :func:`..numerics.nested.solve` leaves, with the multiplier in units of
    the held ``unit/scale``.
    """
    space, table, out, end = room.space, room.space.table, room.space.out, loaded(path.origin, path.direction, 1.0)
    if len(cell) > 3:  # a body has no first integral
        return NOT_CONVERGED, 0, end
    half, base, now, spare = tube.places[1], len(space.x) - 1, np.empty(5), table[quadrature.ROWS]
    if not follow(cell, room.track, path, t, half, Traced(space.curve, table[0], spare), now):
        return NOT_CONVERGED, 0, end
    asked = Asked(cell, end, path.held.unit, path.held.first + path.held.change, half)
    direction, free = asked.direction, necked_shape.unknowns(asked, now)
    doublings = nested.MAX_DOUBLINGS
    while doublings > 1 and base << doublings > MOST_NODES:
        doublings -= 1
    nodes = base << doublings
    for k in range(quadrature.ROWS):
        count = nodes >> (quadrature.ROWS - 1 - k)
        if not fit(asked, now, free, count, CLOSEST, Traced(space.curve, table[k], spare)):
            return NOT_CONVERGED, 0, end
        if k >= quadrature.ROWS - finest.MESHES:
            lay(space.curve, count, half, *finest.mesh_of(quadrature.ROWS - 1 - k, nodes // 2, space.fine))
    there, last = loaded(end, direction, now[MU]), table[quadrature.ROWS - 1]
    error_bounds.measure(lagrangian.scales(last, cell, there, half, nested.SMALLEST_TOLERANCE), direction, True, out)
    largest = quadrature.finish(table, out)
    finest.leave_loads(
        table[:, error_bounds.MULTIPLIER],
        quadrature.ROWS - 1,
        out[0, error_bounds.MULTIPLIER],
        direction,
        finest.NO_MESH,
        space.fine,
    )
    out[0, error_bounds.MULTIPLIER] *= scale
    out[1, error_bounds.MULTIPLIER] *= scale
    return (OK if largest <= accuracy else INACCURATE), doublings, there


@kernel
def lay(curve, nodes, half, x, y):
    """Nodes and shape of half a tube from its neck's and its body's."""
    body, quarter = nodes // 2, nodes // 4
    x_neck, y_neck = curve[0, body + 1 :], curve[1, body + 1 :]
    to_neck = x_neck[quarter]
    for k in range(quarter + 1):
        x[k], y[k] = x_neck[k], y_neck[k]
        x[2 * quarter - k], y[2 * quarter - k] = 2.0 * to_neck - x_neck[k], y_neck[k]
    for k in range(1, body + 1):
        x[2 * quarter + k], y[2 * quarter + k] = 2.0 * to_neck + curve[0, k], curve[1, k]
    x[nodes] = half

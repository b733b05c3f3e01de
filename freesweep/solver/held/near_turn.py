"""States just before a way turns back, where meshes differ in whether they have the state at its end at all.

So a mesh is asked at what share of the way the stretch of one node has a value: that is as smooth in the size of cells as
any output, extrapolates like it, and has a bound. The value is sought at which that share is 1.
"""

from math import sqrt

import numpy as np

from ...jit import kernel
from ..cells import largest_sizes
from ..numerics import base_mesh, error_bounds, finest, kinks, nested
from ..numerics.bordered import FOLLOWED, correct
from ..numerics.continuation import CHANGE
from ..numerics.path import Track, load_at
from ..numerics.properties_along import fill
from ..of_tube import of_tube
from ..physics import lagrangian
from ..status import INACCURATE, NOT_CONVERGED, OK

ROUNDING = 1e-11  # of a share of the way
APPROACHES = 6  # to its end


@kernel
def fastest(track):
    """The even node, which coarser meshes share, whose stretch changes most along the branch a step ahead."""
    node, most = 2, 0.0
    for i in range(2, track.last + 1, 2):
        change = abs(track.next_tangent[i]) / track.next_y[i]
        if change > most:
            node, most = i, change
    return node


@kernel
def track_on(x, y, space, n, free):
    """A track on a mesh of n cells in ``x``, with the state in ``y``; nothing ahead of it."""
    tangent, normal = space.curve[0, : n + 2], space.curve[1, : n + 1]
    return Track(x[: n + 1], y[: n + 2], tangent, tangent, tangent, normal, normal, normal, n if free else n - 1)


@kernel
def pin(track, n, cells, path, node, value, mu, work):
    """The state near the track's at which the stretch of a node has a value; returns as
    :func:`..numerics.bordered.correct`.
    """
    for i in range(n + 1):
        track.normal[i] = 0.0
    track.normal[node], track.y[node] = 1.0, value
    return correct(of_tube(), track, track.y, mu, n, cells, path, 0.0, track.tangent, work)


@kernel
def extrapolate(shares, level, scales, broken, unit, space):
    """The share and its bound from the last four ``shares``, the outputs and theirs from as many rows of the table, with the
    ``scales`` and floors of these; returns ``(share, its bound, largest scaled bound of the outputs)``.
    """
    out, table = space.out, space.table
    error_bounds.measure(scales, unit, True, out)
    largest = error_bounds.extrapolate(table, level, out[2], out[3], broken, out[0], out[1])
    finest.leave_loads(
        table[:, error_bounds.MULTIPLIER],
        level,
        out[0, error_bounds.MULTIPLIER],
        unit,
        nested.SMALLEST_TOLERANCE,
        space.fine,
    )
    share, estimate = error_bounds.fourth_order(
        shares[level - 3], shares[level - 2], shares[level - 1], shares[level], broken
    )
    return share, error_bounds.SAFETY * estimate + ROUNDING, largest


@kernel
def at_value(space, tube, path, node, value, mu, accuracy):
    """The share of the way at which the stretch of a ``node`` of the base mesh has the ``value``, and the outputs there,
    from a state near it in ``space.x``, ``space.y``, with ``mu`` = (share, held load).

    Returns ``(whether it was found, share, its bound, doublings, largest scaled bound of outputs, unstable directions)``.
    """
    fine, table, work = space.fine, space.table, space.work
    n, shares, changes = len(space.x) - 1, np.empty(nested.MAX_DOUBLINGS + 2), np.empty(kinks.MOST)
    course, edges, cells, free, middle, _ = tube
    base = track_on(fine[0], fine[1], space, n, free)
    for i in range(n + 1):
        fine[0, i], fine[1, i] = space.x[i], space.y[i]
    fine[1, n + 1] = mu[1]
    level, count, own, share, first_held, first_share = 1, n, base, mu[0], 0.0, 0.0
    while True:
        filled = fill(course, edges, own.x, count, n, cells)
        status, negative, share, _ = pin(own, count, filled, path, node * count // n, value, share, work)
        if status != FOLLOWED:
            return False, share, 0.0, level, 0.0, negative
        shares[level], row, now = share, table[level], load_at(path, own.y, count, share)
        broken = nested.integrate(lagrangian.integrands, own.x, own.y, count, filled, now, row, changes)
        row[error_bounds.MIDDLE], row[error_bounds.MULTIPLIER] = own.y[middle * count // n], own.y[count + 1]
        if level == 1:
            first_held, first_share = own.y[count + 1], share
            for i in range(n + 1):
                space.y[i] = own.y[i]
            level, count = 0, n // 2
            for i in range(count + 1):
                fine[2, i], fine[3, i] = space.x[2 * i], space.y[2 * i]
            fine[3, count + 1] = first_held
            own = track_on(fine[2], fine[3], space, count, free)
            continue
        if level >= 3:
            scales = lagrangian.scales(row, largest_sizes(filled), now, own.x[count], nested.SMALLEST_TOLERANCE)
            third, bound, largest = extrapolate(shares, level, scales, broken, path.held.unit, space)
            if largest <= accuracy or level == nested.MAX_DOUBLINGS + 1:
                return True, third, bound, level - 1, largest, negative
        if level == 0:
            level, share = 1, first_share
            for i in range(n + 1):
                fine[0, i], fine[1, i] = space.x[i], space.y[i]
            fine[1, n + 1] = first_held
        count = n << (level - 1)
        last_held = fine[1, count + 1]
        base_mesh.go_finer(space.x, n, edges, level - 1, fine, work)
        level, count = level + 1, 2 * count
        fine[1, count + 1] = last_held
        own = track_on(fine[0], fine[1], space, count, free)


@kernel
def before(track, space, tube, end, limit, accuracy):
    """The state at the end of a way that turns back at the share ``limit`` behind it, from the ``end`` of what was followed.
    Returns ``(status, doublings, unstable directions)``; the error of the share that was met enters the bounds.
    """
    n, node = len(space.x) - 1, fastest(track)
    from_turn = track.y[node] - track.next_y[node]
    bend = (end.ahead[0] - end.here[0]) / (from_turn * from_turn)
    part = sqrt((limit - 1.0) / bend) / abs(from_turn)  # of the step, back from the turn
    for i in range(n + 1):
        space.x[i], space.y[i] = track.x[i], track.next_y[i] + part * (track.y[i] - track.next_y[i])
    value, rise = space.y[node], -2.0 * bend * part * from_turn
    guess = 1.0, track.next_y[n + 1] + part * (track.y[n + 1] - track.next_y[n + 1])
    last, last_share, last_out = value, 1.0, np.zeros(error_bounds.OUTPUTS)
    for attempt in range(APPROACHES):
        found, share, bound, doublings, largest, unstable = at_value(
            space, tube, end.path, node, value, guess, accuracy
        )
        if not found:
            break
        out = space.out
        if attempt > 0 and abs(share - 1.0) <= bound:
            for j in range(error_bounds.OUTPUTS):
                slope = abs(out[0, j] - last_out[j]) / max(abs(share - last_share), bound)
                out[1, j] += slope * (bound + abs(share - 1.0))
                largest = max(largest, out[1, j] / out[2, j])
            return (OK if largest <= accuracy else INACCURATE), doublings, unstable
        if attempt > 0 and value != last:
            rise = (share - last_share) / (value - last)
        last, last_share, guess = value, share, (share, out[0, error_bounds.MULTIPLIER])
        for j in range(error_bounds.OUTPUTS):
            last_out[j] = out[0, j]
        value += min(max((1.0 - share) / rise, -CHANGE * value), CHANGE * value)
    return NOT_CONVERGED, 0, 0

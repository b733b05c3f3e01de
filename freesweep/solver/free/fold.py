"""Where a branch ends: the edge of its stability, by bisection in arclength on four nested meshes, extrapolated.

At a fold the load turns back; where a mode of another symmetry lets go, it goes on, but no longer as a maximum. Each mesh
has that edge at a place of its own, before or behind the state that the base mesh stands on: it is looked for both ways.
"""

import numpy as np

from ...jit import kernel
from ..numerics import base_mesh, error_bounds
from ..numerics.bordered import FOLLOWED, correct
from ..numerics.continuation import CHANGE, FIRST_STEP, advance, is_flat, is_stable, last_alike, make_unit
from ..numerics.path import Track, load_at, size_of
from ..numerics.properties_along import fill
from ..of_tube import of_tube
from ..physics.wall import may_go_slack

COUNTS = 1, 2, 4, 8  # halves of the base mesh's cells
FINEST = COUNTS[-1] // 2  # times them on the finest
FALLING, SMALL = 0.5, 1e-7  # of the change from mesh to mesh, and of the load: else no order is seen
AGREED = 1e-4  # of the load: by more the meshes do not agree
STEPS = 40  # along the branch, to the edge
ROUNDING = 4e-9  # of its load, relative: where a load is flat, many shapes are equilibria to rounding


@kernel
def nodes_of(track, n, free):
    """The first n + 1 nodes of a track that has room for more."""
    m = n + 1
    state = m + len(track.y) - len(track.x)
    return Track(
        track.x[:m], track.y[:state], track.tangent[:state], track.next_y[:state], track.next_tangent[:state],
        track.normal[:m], track.spare[:m], track.other[:m], n if free else n - 1,
    )  # fmt: skip


@kernel
def carry(old_x, old, x, y):
    """Values at nodes ``x`` of what is linear between those at ``old_x``."""
    j = 0
    for i in range(len(x)):
        while j < len(old_x) - 2 and old_x[j + 1] < x[i]:
            j += 1
        y[i] = old[j] + (x[i] - old_x[j]) * (old[j + 1] - old[j]) / (old_x[j + 1] - old_x[j])


@kernel
def edge(track, n, cells, path, mu, tangent_mu, sense, work):
    """The load at the edge of stability nearest to the state in ``track`` on its own mesh, NaN if there is none near; and
    by how much it may be missed where a branch that is flat was lost.
    """
    unit, step = size_of(mu, path), FIRST_STEP * CHANGE
    for i in range(n + 1):
        track.normal[i] = track.tangent[i] / (n * track.y[i] * track.y[i])
    normal_mu = tangent_mu / (unit * unit)
    status, negative, mu, tangent_mu = correct(
        of_tube(), track, track.y, mu, n, cells, path, normal_mu, track.tangent, work
    )
    if status != FOLLOWED:
        return np.nan, 0.0
    tangent_mu = make_unit(track, n, mu, tangent_mu, path)
    stable = is_stable(negative, tangent_mu, sense)
    if not stable:  # turn round
        sense, tangent_mu = -sense, -tangent_mu
        for i in range(len(track.tangent)):
            track.tangent[i] = -track.tangent[i]
    for _ in range(STEPS):
        if status != FOLLOWED:
            return (mu if is_flat(mu, tangent_mu, path) else np.nan), CHANGE * abs(tangent_mu)
        here = (mu, tangent_mu)
        status, negative, next_mu, next_tangent_mu, made, step = advance(
            of_tube(), track, n, cells, path, here, step, work
        )
        if is_stable(negative, next_tangent_mu, sense) != stable:
            found, _, _ = last_alike(of_tube(), track, n, cells, path, here, made, sense, stable, work)
            return found, 0.0
        for i in range(len(track.y)):
            track.y[i], track.tangent[i] = track.next_y[i], track.next_tangent[i]
        mu, tangent_mu = next_mu, make_unit(track, n, next_mu, next_tangent_mu, path)
    return np.nan, 0.0


@kernel
def locate(room, tube, path, here, ahead, sense):
    """The load at which the branch ends, from the state ``here`` in the room's track; ``ahead`` is where the base mesh has
    that edge. ``(load, bound)``, NaN where some mesh has none near, or they do not agree.
    """
    space, track, n = room.space, room.track, len(room.track.x) - 1
    course, edges, cells, free, _, _ = tube
    for i in range(n + 1):
        space.x[i], space.y[i] = track.x[i], track.next_y[i]
    now = load_at(path, track.next_y, n, ahead[0])
    if not base_mesh.adapt(of_tube(), space.x, space.y, n, tube, now, space.work):
        for i in range(n + 1):
            space.x[i] = track.x[i]
    loads, doubt = space.table[0], 0.0
    for k in range(len(COUNTS)):
        count = n * COUNTS[k] // 2
        own = nodes_of(room.roomy, count, free)
        if COUNTS[k] == 1:
            for i in range(count + 1):
                own.x[i] = space.x[2 * i]
        else:
            base_mesh.split(space.x, n, edges, COUNTS[k] // 2, own.x)
        carry(track.x, track.y, own.x, own.y)
        carry(track.x, track.tangent, own.x, own.tangent)
        for i in range(len(track.y) - n - 1):
            own.y[count + 1 + i], own.tangent[count + 1 + i] = track.y[n + 1 + i], track.tangent[n + 1 + i]
        filled = fill(course, edges, own.x, count, n, cells)
        loads[k], missed = edge(own, count, filled, path, here[0], here[1], sense, space.work)
        doubt = max(doubt, missed)
    changes = abs(loads[1] - loads[0]), abs(loads[2] - loads[1]), abs(loads[3] - loads[2])
    least = SMALL * abs(loads[3])  # where rounding counts, nothing need fall
    falls = changes[1] < FALLING * changes[0] + least and changes[2] < FALLING * changes[1] + least
    broken = may_go_slack(path.origin.wall) or not falls
    found, estimate = error_bounds.fourth_order(loads[0], loads[1], loads[2], loads[3], broken)
    if not estimate < AGREED * abs(found):
        return np.nan, 0.0
    return found, error_bounds.SAFETY * estimate + ROUNDING * abs(found) + doubt

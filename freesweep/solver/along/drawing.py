"""Profiles as accurate as asked for: where three meshes do not do, a finer one joins them.

Tensions ask for it at a low pressure and large angles, where the wall's stress, beside theirs, feels an error of the
stretch a thousandfold.
"""

import numpy as np

from ...jit import kernel
from ..load import by
from ..numerics import base_mesh, held, nested, newton
from ..numerics.finest import LEFT, MESHES, load_of
from ..numerics.properties_along import fill
from ..of_tube import of_tube
from .profile import at_stations


@kernel
def draw(stations, base, doublings, tube, load, fine, nodes, work, accuracy, profile):
    """:func:`profile.at_stations`, refined until its bounds meet the ``accuracy``; returns whether they do."""
    met, finer = False, True
    while finer and not met:
        met = at_stations(stations, base, doublings, tube, load, fine, nodes, profile) <= accuracy
        finer = not met and doublings < nested.MAX_DOUBLINGS
        if finer:
            finer = refine(base, doublings, tube, load, accuracy, fine, work)
            doublings += 1
    return met


@kernel
def refine(base, doublings, tube, load, accuracy, fine, work):
    """Solve on twice as many cells as the finest mesh has, with held what was held there; whether that converged."""
    course, edges, cells, free, _, _ = tube
    count = base << doublings
    tolerance = max(nested.STEP_SHARE * accuracy, nested.SMALLEST_TOLERANCE)
    x, changes = np.empty(base + 1), np.empty(3 * MESHES)
    for i in range(base + 1):
        x[i] = fine[0, i << doublings]
    for k in range(3 * MESHES):
        changes[k] = fine[3, k]
    now = load_of(0, load, fine)
    most = max(abs(now.p), max(abs(now.f), abs(now.m)))
    by_force, by_torque = changes[1] != changes[4], changes[2] != changes[5]
    direction = by(0.0, most if by_force else 0.0, most if by_torque else 0.0)
    holds = by_force or by_torque
    own, functional, value = fill(course, edges, fine[0], count, base, cells), of_tube(), 0.0
    if holds:
        value, _ = held.hold(functional.conjugate, fine[0], fine[1], count, own, now, direction, work[8])
    for i in range(count // 2 + 1):
        fine[3, i] = fine[4, i]
    base_mesh.go_finer(x, base, edges, doublings, fine, work)
    mesh = newton.Mesh(fine[0], 2 * count, free, fill(course, edges, fine[0], 2 * count, base, cells))
    status, _, mu, _, left = nested.on_mesh(
        functional, fine[1], mesh, now, held.Target(direction, value, holds), 0.0, newton.UNKNOWN, tolerance, work
    )
    for i in range(3):
        fine[3, 3 + i], fine[3, 6 + i] = changes[i], changes[3 + i]
    fine[3, 0], fine[3, 1], fine[3, 2] = changes[0], changes[1] + mu * direction.f, changes[2] + mu * direction.m
    fine[3, LEFT] = left
    return status == newton.CONVERGED

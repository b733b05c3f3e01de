"""Held states: the deformed length or the rotation of the free end is given, the force or the torque that keeps it unknown.

The state meant is the one on the branch that begins without load: pressure, the other load and fiber extension - 1 rise in
proportion while the undeformed length (no rotation) is held, then what is held changes to its target; the multiplier
follows in small steps. The straight cylinder y = 1 of a tube that is the same all along is an equilibrium on this way under
the load that makes L_y(1, 0) = 0: the march may begin there at once, as long as no state on it is unstable. Else all of the
way is gone (``march.from_rest``), as by a tube that varies; only where the wall of such a tube would have to be pushed
on the way, it is blended from a straight one at the load asked for.

A tube that is the same all along, or its own mirror image, keeps a symmetric state. Beyond a critical pressure of blocked
torque an antisymmetric mode makes it unstable, which is no obstacle on the way; somewhat later, with fiber extension, the
branch turns back, at most designs for good: BEYOND_LIMIT. ``buckled`` starts from the antisymmetric mode and takes the
stable state beside the cylinder.
"""

import numpy as np

from ..jit import kernel
from . import guide, held, lagrangian, neck_march, neck_shape, nested, newton
from .branch import GAMMA, SHEAR, rubber_of
from .buckle import LOWERINGS, buckled_at
from .climb import pushed
from .course import fill
from .march import EVERY, NEWTON_ITERATIONS, TOLERANCE, begin, blend, cylinder_multiplier, from_rest, march
from .stability import unstable_directions
from .status import BEYOND_LIMIT, COMPRESSED, HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK

HELD_LENGTH, HELD_ROTATION = 0, 1
LONGER = 1e-9  # relative: than all that the fibers allow
RAISES = 40  # of the pressure by a half, until the wall of the starting cylinder is under tension
MESH_CHANGE = 0.03  # relative difference of a shape from one mesh to the next
MIRROR_OFFSET, MIRROR_TOLERANCE = 0.37, 1e-12  # places off jumps; of H, D and the section


@kernel
def find(problem, p, other, target, kind, buckled, course, tube, accuracy, space, out):
    """One held state on one base mesh; returns ``(status, unstable directions, doublings, load, share of it reached)``."""
    fine, work, table, shapes = space[0], space[1], space[2], space[4]
    _, edges, _, _, _, places = tube
    base = edges[len(edges) - 1]
    x, y = shapes[0, : base + 1], shapes[1, : base + 1]
    total = places[len(places) - 1]
    varying = course.shape[0] > 1 or course.shape[1] > 1
    gamma = problem[GAMMA]
    force, torque = (0.0, other) if kind == HELD_LENGTH else (other, 0.0)
    rubber, shear = rubber_of(problem), problem[SHEAR]
    load = (gamma, rubber, shear, p, force, torque, 1.0)
    unit = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0) if kind == HELD_LENGTH else (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    # a place whose cylinder can carry the load, at a higher pressure if it must be
    start, cell, raised = load, guide.cell_along(tube, 0.5), False
    for attempt in range(RAISES * guide.PLACES):
        share = ((attempt // RAISES) * 0.5 / (guide.PLACES - 1) + 0.5) % 1.0
        cell = guide.cell_along(tube, share)
        higher = p * 1.5 ** (attempt % RAISES)
        start = (gamma, rubber, shear, higher, force, torque, 1.0)
        mu = cylinder_multiplier(cell, start, unit)
        at_start = held.loaded(start, unit, mu)
        raised = lagrangian.density(1.0, 0.0, cell, at_start)[0] > 0.0
        if raised or (course.shape[0] == 1 and attempt == RAISES - 1):
            break
    # a straight fiber cannot stretch: whatever the force, the length stays (the pole of Eq. 2.16)
    if course.shape[0] == 1 and lagrangian.conjugate(1.0, 0.0, cell, load, unit)[1] == 0.0:
        return HELD_IMPOSSIBLE, 0, 0, load, 0.0
    if kind == HELD_LENGTH and not varying and target > (1.0 + LONGER) * total * lagrangian.longest(cell, gamma):
        return HELD_IMPOSSIBLE, 0, 0, load, 0.0
    if not raised:
        return COMPRESSED, 0, 0, load, 0.0
    scale = max(abs(mu), p)
    direction = tuple_times(unit, scale)
    mu /= scale
    natural, wanted = total * scale if kind == HELD_LENGTH else 0.0, target * scale
    came_from, last_leg = (1.0, rubber, shear, 0.0, 0.0, 0.0, 1.0), wanted == natural
    found, reached, regrades = NOT_CONVERGED, 0.0, 1
    for tries in range(2):  # a buckled shape that no mesh holds is come to from a lower pressure
        if buckled:
            found, mu = buckled_at(x, y, tube, course, load, (tries, LOWERINGS), direction, mu, wanted, work)
        else:
            if not varying:
                found, mu = directly(x, y, tube, course, cell, start, load, direction, wanted, 0, work)
            if varying or (found != OK and found != COMPRESSED):
                allowed = 1 if varying and mirrored(tube) else 0
                begun, mu, reached = from_rest(x, y, tube, course, cell, load, direction, natural, allowed, work)
                if begun == OK and wanted != natural:
                    came_from, last_leg = load, True
                    begun, mu, reached = march(
                        x, y, tube, course, cell, False, load, load, 0.0, direction, mu, natural, wanted, EVERY, work
                    )
                    begun = HELD_IMPOSSIBLE if begun == BEYOND_LIMIT else begun
                if varying and begun == COMPRESSED:
                    begun, mu = directly(x, y, tube, course, cell, start, load, direction, wanted, EVERY, work)
                found = begun
        if found != OK:
            if found != COMPRESSED and last_leg and not (varying or buckled):
                status, doublings, now = neck_march.solve(
                    cell, tube, x, y, mu, came_from, load, reached, natural, wanted, direction, scale, accuracy, base, fine,
                    space[3], table, out,
                )  # fmt: skip
                if status != NOT_CONVERGED:
                    return status, 1, doublings, now, 1.0
            return found, 0, 0, load, reached
        marched = extremes(y, tube[4])
        status, _, doublings, _ = nested.solve(
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube, load,
            nested.HELD, direction, wanted, mu, regrades, accuracy, fine, work, table, out,
        )  # fmt: skip
        if status == newton.CONVERGED or status == nested.UNREACHED or not buckled:
            break
    solved = status == newton.CONVERGED or status == nested.UNREACHED
    if solved and not buckled and strays(marched, extremes(y, tube[4])):
        return NOT_CONVERGED, 0, 0, load, 1.0  # close to a turning point finer meshes may jump past it
    if not solved:
        vanishing = pushed(y, held.loaded(load, direction, mu))
        return (COMPRESSED if vanishing else NOT_CONVERGED), 0, 0, load, 1.0
    now = held.loaded(load, direction, out[0, nested.MULTIPLIER])
    if not now[3] + now[4] > 0.0:  # at the clamped ends, where y = 1
        return COMPRESSED, 0, 0, load, 1.0
    size = (2.0 if tube[3] else 1.0) * max(abs(wanted), abs(natural))
    unstable, rounding = unstable_directions(
        fine[0], fine[1], base << doublings, base, tube, now, direction, size, work
    )
    if not (varying or buckled) and neck_shape.depth_of(y) > 0.0:
        unstable = max(unstable, 1)  # of which a mesh may know nothing
    out[1, nested.MULTIPLIER] += rounding
    out[0, nested.MULTIPLIER] *= scale
    out[1, nested.MULTIPLIER] *= scale
    return (OK if status == newton.CONVERGED else INACCURATE), unstable, doublings, now, 1.0


@kernel
def tuple_times(values, factor):
    """A load direction times a number."""
    return (0.0, 0.0, 0.0, 0.0, factor * values[4], factor * values[5], 0.0)


@kernel
def extremes(y, middle):
    """What tells one branch from another: stretch in the middle, least and largest."""
    return y[middle], np.min(y), np.max(y)


@kernel
def strays(one, other):
    """Whether two shapes differ by more than meshes do."""
    return max(abs(one[0] - other[0]), max(abs(one[1] - other[1]), abs(one[2] - other[2]))) > MESH_CHANGE * one[2]


@kernel
def directly(x, y, tube, course, cell, start, load, direction, wanted, allowed, work):
    """From the straight cylinder under the load ``start`` to what is ``wanted``, then to ``load``, its pressure lowered."""
    begin(x, y, tube)
    _, edges, cells, free, _, _ = tube
    n = len(x) - 1
    mu = cylinder_multiplier(cell, start, direction)
    first = lagrangian.conjugate(1.0, 0.0, cell, start, direction)[0] * x[n]
    blend(course, cell, 0.0, tube[0])
    _, unstable, _, _ = held.solve_held(
        lagrangian.density, lagrangian.conjugate, x, y, n, free, fill(tube[0], edges, x, n, n, cells), start, direction, mu,
        first, TOLERANCE, NEWTON_ITERATIONS, work,
    )  # fmt: skip
    if unstable > allowed and first != wanted:
        return HELD_IMPOSSIBLE, mu
    found, mu, _ = march(x, y, tube, course, cell, True, start, start, 0.0, direction, mu, first, wanted, allowed, work)
    if found == OK and start[3] != load[3]:
        found, mu, _ = march(
            x, y, tube, course, cell, False, start, load, 0.0, direction, mu, wanted, wanted, allowed, work
        )
    return (HELD_IMPOSSIBLE if found == BEYOND_LIMIT else found), mu


@kernel
def mirrored(tube):
    """Whether a tube is its own mirror image."""
    same = True
    for k in range(guide.PLACES):
        share = (k + MIRROR_OFFSET) / guide.PLACES
        one, other = guide.cell_along(tube, share), guide.cell_along(tube, 1.0 - share)
        for i in range(3):
            same = same and abs(one[i] - other[i]) < MIRROR_TOLERANCE * max(1.0, abs(one[i]))
    return same

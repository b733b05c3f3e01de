"""Held states: the deformed length or the rotation of the free end is given, the force or the torque that keeps it unknown.

The state meant is the one on the branch that begins without load: pressure, the other load and fiber extension - 1 rise in
proportion while the undeformed length (no rotation) is held, then what is held changes to its target. The straight cylinder
y = 1 of a tube that is the same all along is an equilibrium on this way under the load that makes L_y(1, 0) = 0: the march
may begin there at once, as long as no state on it is unstable. Else all of the way is gone (``march.from_rest``), as by a
tube that varies.

Where the wall would have to be pushed on that way, or another length or rotation than the undeformed one is not come to,
the other is gone (``march.from_free``): the loads rise with nothing held, then what is held changes from what was found.
Without pressure neither way begins; they go to a pressure like the wall's stiffness, which is lowered at the end.

A tube that is the same all along, or its own mirror image, keeps a symmetric state. Beyond a critical pressure of blocked
torque an antisymmetric mode makes it unstable, which is no obstacle on the way; somewhat later, with fiber extension, the
branch turns back, at most designs for good: BEYOND_LIMIT, decided by :mod:`turn`.
"""

from ..jit import kernel
from . import guide, held, lagrangian, march, neck_march, neck_shape, nested, newton, pinned, turn
from .course import fill
from .march import EVERY, NO_TURN, begin, cylinder_multiplier, from_free, from_rest
from .pinned import BY_SHARE
from .problem import GAMMA, rubber_of, wall_of
from .shapes import differ, extremes
from .stability import pushed, unstable_directions
from .status import BEYOND_LIMIT, COMPRESSED, HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK

HELD_LENGTH, HELD_ROTATION = 0, 1
FROM_REST, FROM_FREE = 0, 1
LONGER = 1e-9  # relative: than all that the fibers allow
RAISES = 40  # of the pressure by a half, until the wall of the starting cylinder is under tension
WITHOUT_PRESSURE = 0.1  # times the wall's section: the pressure that is gone to first where none is asked for
MIRROR_OFFSET, MIRROR_TOLERANCE = 0.37, 1e-12  # places off jumps; of H, D and the section


@kernel
def at_pressure(load, p):
    """The load under another pressure."""
    return load[0], load[1], load[2], p, load[4], load[5], load[6]


@kernel
def find(problem, walls, p, other, target, kind, course, tube, accuracy, space, out):
    """One held state on one base mesh; returns ``(status, unstable directions, doublings, load, share of it reached, whether
    that is certain, path)``: a way's end that is certain no finer mesh has to confirm.
    """
    fine, work, table, shapes = space[0], space[1], space[2], space[4]
    edges, places = tube[1], tube[5]
    base = edges[len(edges) - 1]
    x, y = shapes[0, : base + 1], shapes[1, : base + 1]
    total = places[len(places) - 1]
    varying = course.shape[0] > 1 or course.shape[1] > 1
    gamma = problem[GAMMA]
    force, torque = (0.0, other) if kind == HELD_LENGTH else (other, 0.0)
    load = (gamma, rubber_of(problem), wall_of(problem, walls), p, force, torque, 1.0)
    unit = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0) if kind == HELD_LENGTH else (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    cell = guide.cell_along(tube, 0.5)
    # a straight fiber cannot stretch: whatever the force, the length stays (the pole of Eq. 2.16)
    if course.shape[0] == 1 and lagrangian.conjugate(1.0, 0.0, cell, load, unit)[1] == 0.0:
        return HELD_IMPOSSIBLE, 0, 0, load, 0.0, True, FROM_REST
    if kind == HELD_LENGTH and not varying and target > (1.0 + LONGER) * total * lagrangian.longest(cell, gamma):
        return HELD_IMPOSSIBLE, 0, 0, load, 0.0, True, FROM_REST
    if not p + force > 0.0 and kind == HELD_ROTATION:  # at the clamped ends
        return COMPRESSED, 0, 0, load, 0.0, True, FROM_REST
    there = at_pressure(load, p if p > 0.0 or kind == HELD_ROTATION else WITHOUT_PRESSURE * cell[2])
    # a place whose cylinder can carry the load, at a higher pressure if it must be
    start, raised = there, False
    for attempt in range(RAISES * guide.PLACES):
        share = ((attempt // RAISES) * 0.5 / (guide.PLACES - 1) + 0.5) % 1.0
        cell = guide.cell_along(tube, share)
        start = at_pressure(there, there[3] * 1.5 ** (attempt % RAISES))
        raised = (
            lagrangian.density(1.0, 0.0, cell, held.loaded(start, unit, cylinder_multiplier(cell, start, unit)))[0]
            > 0.0
        )
        if raised or (not varying and attempt == RAISES - 1):
            break
    scale = max(there[3], abs(force))
    if raised:
        scale = max(scale, abs(cylinder_multiplier(cell, start, unit)))
    direction = tuple_times(unit, scale)
    natural, wanted = total * scale if kind == HELD_LENGTH else 0.0, target * scale
    way = (there, there, natural, wanted, direction, True, course, cell, False)
    found, mu, reached, turned, allowed = COMPRESSED, 0.0, 0.0, NO_TURN, 0
    came_from, last_leg = (1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0), wanted == natural
    if raised:
        if not varying:
            found, mu, reached, turned, way = directly(
                x, y, tube, course, cell, start, there, direction, wanted, 0, work
            )
        if varying or (found != OK and found != COMPRESSED):
            allowed = 1 if varying and mirrored(tube) else 0
            found, mu, reached, turned, way = from_rest(
                x, y, tube, course, cell, there, direction, natural, allowed, work
            )
            if found == OK and wanted != natural:
                came_from, last_leg = there, True
                way = (there, there, natural, wanted, direction, True, course, cell, False)
                found, mu, reached, turned = march.march(x, y, tube, way, 0.0, 1.0, mu, EVERY, work)
            if varying and found == COMPRESSED:
                found, mu, reached, turned, way = directly(
                    x, y, tube, course, cell, start, there, direction, wanted, EVERY, work
                )
    came_to = found == OK
    status, unstable, doublings, now, reached, sure = settle(
        x, y, tube, way, found, mu, reached, turned, load, wanted, accuracy, space, out
    )
    if status == HELD_IMPOSSIBLE and wanted == natural:  # close to a turning point of the branch from rest itself
        status = BEYOND_LIMIT
    if not valued(status) and not sure and status != COMPRESSED and last_leg and not varying:
        necked, levels, under = neck_march.solve(
            cell, tube, x, y, mu, came_from, there, min(reached, 1.0), natural, wanted, direction, scale, accuracy, base,
            fine, space[3], table, out,
        )  # fmt: skip
        if necked != NOT_CONVERGED:
            return necked, 1, levels, under, 1.0, True, FROM_REST
    path = FROM_REST
    # not where only finer meshes have no such state: which way is gone must not hang on the accuracy
    if status == COMPRESSED or (not valued(status) and wanted != natural and not (came_to and status == NOT_CONVERGED)):
        found, mu, came, turned, way = from_free(x, y, tube, course, cell, there, direction, wanted, EVERY, work)
        again, others, levels, under, came, certain = settle(
            x, y, tube, way, found, mu, came, turned, load, wanted, accuracy, space, out
        )
        if valued(again):
            status, unstable, doublings, now, reached, sure, path = (
                again,
                others,
                levels,
                under,
                came,
                certain,
                FROM_FREE,
            )
    if valued(status):
        size = (2.0 if tube[3] else 1.0) * max(abs(wanted), abs(natural))
        unstable, rounding = unstable_directions(
            fine[0], fine[1], base << doublings, base, tube, now, direction, size, work
        )
        if not varying and neck_shape.depth_of(y) > 0.0:
            unstable = max(unstable, 1)  # of which a mesh may know nothing
        out[1, nested.MULTIPLIER] += rounding
        out[0, nested.MULTIPLIER] *= scale
        out[1, nested.MULTIPLIER] *= scale
    return status, unstable, doublings, now, reached, sure, path


@kernel
def valued(status):
    """Whether a state was found."""
    return status == OK or status == INACCURATE


@kernel
def settle(x, y, tube, way, found, mu, reached, turned, load, wanted, accuracy, space, out):
    """The state at ``load`` on finer meshes, at the end of a ``way`` of which :func:`march.march` returned ``found``,
    ``mu``, ``reached`` and ``turned``; that way may end at a higher pressure, which is lowered. Returns ``(status, unstable
    directions, doublings, load, share reached, whether that is certain)``.
    """
    fine, work, table, direction = space[0], space[1], space[2], way[4]
    if found == OK and way[1][3] != load[3]:
        way = (way[1], load, wanted, wanted, direction, True, way[6], way[7], False)
        found, mu, reached, turned = march.march(x, y, tube, way, 0.0, 1.0, mu, EVERY, work)
        found = COMPRESSED if found == NOT_CONVERGED and reached > 1.0 - turn.NEAR else found
    status, unstable, doublings, now, sure = found, 0, 0, load, False
    if found == OK:
        status, unstable, doublings, now = on_meshes(
            x, y, tube, load, direction, wanted, mu, accuracy, fine, work, table, out
        )
        if status == NOT_CONVERGED:  # a turning point just behind?
            found, mu, reached, turned = march.march(x, y, tube, way, 1.0, 1.0 + turn.NEAR, mu, EVERY, work)
            reached = max(reached, 1.0)
    if found == BEYOND_LIMIT and turned[0] != BY_SHARE:
        k, bend, side = turned
        status = HELD_IMPOSSIBLE if way[2] != way[3] else BEYOND_LIMIT
        good, limit, bound, doublings, _, _ = turn.on_nested_meshes(
            x, y, tube, way, k, 0.0, reached, mu, bend, accuracy, fine, work, table, out
        )
        sure = good and limit < 1.0 + bound
        if good and limit > 1.0 + bound:
            status, doublings, unstable = turn.before(
                x, y, tube, way, k, side, limit, mu, bend, accuracy, fine, work, table, out
            )
            now = held.loaded(load, direction, out[0, nested.MULTIPLIER])
        reached = limit if good else reached
    if valued(status) and not now[3] + now[4] > 0.0:  # at the clamped ends, where y = 1
        return COMPRESSED, 0, 0, load, 1.0, True
    return status, unstable, doublings, now, reached, sure


@kernel
def on_meshes(x, y, tube, load, direction, wanted, mu, accuracy, fine, work, table, out):
    """A state of the base mesh on finer ones: ``(status, unstable directions, doublings, load)``; NOT_CONVERGED where these
    have another or none.
    """
    marched = extremes(y, tube[4])
    kept_x, kept_y = x.copy(), y.copy()
    status, unstable, doublings, _ = nested.solve(
        lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube, load, nested.HELD,
        direction, wanted, mu, 1, accuracy, fine, work, table, out,
    )  # fmt: skip
    if status == newton.CONVERGED or status == nested.UNREACHED:
        if not differ(marched, extremes(y, tube[4])):
            now = held.loaded(load, direction, out[0, nested.MULTIPLIER])
            return (OK if status == newton.CONVERGED else INACCURATE), unstable, doublings, now
    for i in range(len(x)):
        x[i], y[i] = kept_x[i], kept_y[i]
    own = fill(tube[0], tube[1], x, len(x) - 1, len(x) - 1, tube[2])
    if pushed(y, own, held.loaded(load, direction, mu)):
        return COMPRESSED, 0, 0, load
    return NOT_CONVERGED, 0, 0, load


@kernel
def tuple_times(values, factor):
    """A load direction times a number."""
    return (0.0, 0.0, 0.0, 0.0, factor * values[4], factor * values[5], 0.0)


@kernel
def directly(x, y, tube, course, cell, start, load, direction, wanted, allowed, work):
    """From the straight cylinder under the load ``start`` to what is ``wanted``, then to ``load``, its pressure lowered.
    Returns as :func:`march.from_rest`.
    """
    begin(x, y, tube)
    mu = cylinder_multiplier(cell, start, direction)
    first = lagrangian.conjugate(1.0, 0.0, cell, start, direction)[0] * x[len(x) - 1]
    way = (start, start, first, wanted, direction, True, course, cell, True)
    _, unstable, _, _, _, _ = pinned.solve(
        x, y, len(x) - 1, len(x) - 1, tube, way, BY_SHARE, 0.0, 0.0, mu, march.TOLERANCE, work
    )
    if unstable > allowed and first != wanted:
        return HELD_IMPOSSIBLE, mu, 0.0, NO_TURN, way
    found, mu, reached, turned = march.march(x, y, tube, way, 0.0, 1.0, mu, allowed, work)
    if found == OK:
        pinned.blend(course, cell, 1.0, tube[0])
        way = (start, load, wanted, wanted, direction, True, course, cell, False)
        if start[3] != load[3]:
            found, mu, reached, turned = march.march(x, y, tube, way, 0.0, 1.0, mu, allowed, work)
        else:
            way = (load, load, first, wanted, direction, True, course, cell, course.shape[0] > 1 or course.shape[1] > 1)
    return (HELD_IMPOSSIBLE if found == BEYOND_LIMIT else found), mu, reached, turned, way


@kernel
def mirrored(tube):
    """Whether a tube is its own mirror image."""
    same = True
    for k in range(guide.PLACES):
        share = (k + MIRROR_OFFSET) / guide.PLACES
        one, other = guide.cell_along(tube, share), guide.cell_along(tube, 1.0 - share)
        for i in range(len(one)):
            same = same and abs(one[i] - other[i]) < MIRROR_TOLERANCE * max(1.0, abs(one[i]))
    return same

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

from ..jit import entry_point, inlined, kernel
from . import guide, held, lagrangian, nested, newton
from .branch import GAMMA, SHEAR, rubber_of
from .buckle import LOWERINGS, buckled_at
from .climb import pushed
from .course import fill
from .march import EVERY, NEWTON_ITERATIONS, TOLERANCE, begin, blend, cylinder_multiplier, from_rest, march
from .profile import FIELDS, at_stations
from .slack import slack_fibers
from .stability import unstable_directions
from .status import BEYOND_LIMIT, COMPRESSED, HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK

HELD_LENGTH, HELD_ROTATION = 0, 1
RAISES = 40  # of the pressure by a half, until the wall of the starting cylinder is under tension
FINER, FINEST = (
    4,
    6144,
)  # times the cells of the base mesh, up to so many: layers between slender and swollen parts are thin
CONFIRMED = 0.01  # relative difference of a limit's place from one mesh to the next
MIRROR_OFFSET, MIRROR_TOLERANCE = 0.37, 1e-12  # places off jumps; of H, D and the section


@inlined
def find(problem, p, other, target, kind, buckled, course, tube, accuracy, space, out):
    """One held state on one base mesh; returns ``(status, unstable directions, doublings, load, share of it reached)``."""
    fine, work, table, shapes = space[0], space[1], space[2], space[4]
    _, edges, _, _, _, places = tube
    base = edges[len(edges) - 1]
    x, y = shapes[0, : base + 1], shapes[1, : base + 1]
    total = places[len(places) - 1]
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
    if not raised:
        return COMPRESSED, 0, 0, load, 0.0
    scale = max(abs(mu), p)
    direction = tuple_times(unit, scale)
    mu /= scale
    natural, wanted = total * scale if kind == HELD_LENGTH else 0.0, target * scale
    varying = course.shape[0] > 1 or course.shape[1] > 1
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
                    begun, mu, reached = march(
                        x, y, tube, course, cell, False, load, load, 0.0, direction, mu, natural, wanted, EVERY, work
                    )
                    begun = HELD_IMPOSSIBLE if begun == BEYOND_LIMIT else begun
                if varying and begun == COMPRESSED:
                    begun, mu = directly(x, y, tube, course, cell, start, load, direction, wanted, EVERY, work)
                found = begun
        if found != OK:
            return found, 0, 0, load, reached
        status, _, doublings, _ = nested.solve(
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube, load,
            nested.HELD, direction, wanted, mu, regrades, accuracy, fine, work, table, out,
        )  # fmt: skip
        if status == newton.CONVERGED or status == nested.UNREACHED or not buckled:
            break
    if status != newton.CONVERGED and status != nested.UNREACHED:
        vanishing = pushed(y, held.loaded(load, direction, mu))
        return (COMPRESSED if vanishing else NOT_CONVERGED), 0, 0, load, 1.0
    now = held.loaded(load, direction, out[0, nested.MULTIPLIER])
    if not now[3] + now[4] > 0.0:  # at the clamped ends, where y = 1
        return COMPRESSED, 0, 0, load, 1.0
    unstable = unstable_directions(fine[0], fine[1], base << doublings, base, tube, now, direction, space[5], work)
    out[0, nested.MULTIPLIER] *= scale
    out[1, nested.MULTIPLIER] *= scale
    return (OK if status == newton.CONVERGED else INACCURATE), unstable, doublings, now, 1.0


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


@kernel
def workspace(base, varying):
    """Scratch for a base mesh of ``base`` cells: see :func:`nested.solve`; and the cells of a tube that varies."""
    size = (base << nested.MAX_DOUBLINGS) + 2
    space = (
        np.zeros((5, size)), np.zeros((13, 2 * size)), np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS)),
        np.zeros((5, size)), np.zeros((2, base + 1)), np.zeros((3, 2 * size)),
    )  # fmt: skip
    return space, np.zeros((size if varying else 1, 3))


@kernel
def find_on_some_mesh(problem, p, other, target, kind, buckled, course, tube, accuracy, space, out):
    """As :func:`find`, on finer base meshes where one does not do: where the solver fails, or a limit is met that the next
    mesh has to confirm. Returns also the tube and the scratch that were used.
    """
    _, edges, cells, free, middle, places = tube
    base = edges[len(edges) - 1]
    status, factor, before = NOT_CONVERGED, 1, (NOT_CONVERGED, 0.0)
    while True:
        tube[0][:] = course  # a march leaves it changed
        status, unstable, doublings, now, reached = find(
            problem, p, other, target, kind, buckled, course, tube, accuracy, space, out
        )
        limit = status == BEYOND_LIMIT or (status == HELD_IMPOSSIBLE and not buckled)
        confirmed = status == before[0] and abs(reached - before[1]) <= CONFIRMED * reached
        if not (status == NOT_CONVERGED or status == INACCURATE or (limit and not confirmed)):
            break
        before, factor = (status, reached), FINER * factor
        if factor * base > FINEST:
            break
        space, cells = workspace(factor * base, len(cells) > 1)
        tube = (tube[0], factor * edges, cells, free, factor * middle, places)
    return status, unstable, doublings, now, tube, space


@kernel
def tuple_times(values, factor):
    """A load direction times a number."""
    return (0.0, 0.0, 0.0, 0.0, factor * values[4], factor * values[5], 0.0)


@entry_point
def hold_many(
    problem, pressures, others, targets, kind, buckled, course, edges, places, accuracy, values, bounds, status, stable,
    slack, stations, profiles,
):  # fmt: skip
    """Held states of one design, for arrays of pressure, of the load that is not unknown, and of the held quantity.

    The n-th entries belong together. ``targets`` are in radii (deformed length) or radians, of the whole tube; a tube that
    is the same all along is solved by half (``edges`` and ``places`` of one segment), unless ``buckled``. ``values`` and
    ``bounds`` are (n, 6): length, volume, twist, energy of half the tube, stretch in the middle, multiplier.
    """
    base = edges[len(edges) - 1]
    half = len(places) == 2
    middle = base if half else edges[np.argmin(np.abs(places - 0.5 * places[len(places) - 1]))]
    varying = not half or course.shape[1] > 1
    first_space, cells = workspace(base, varying)
    first_tube = (course.copy(), edges, cells, half, middle, places)
    out = np.zeros((4, nested.OUTPUTS))
    for i in range(len(pressures)):
        for k in range(6):
            values[i, k], bounds[i, k] = np.nan, np.nan
        for j in range(len(stations)):
            for k in range(FIELDS):
                profiles[i, k, j] = np.nan
        slack[i], stable[i] = 0, 0
        target = 0.5 * targets[i] if half else targets[i]
        status[i], unstable, doublings, now, tube, space = find_on_some_mesh(
            problem, pressures[i], others[i], target, kind, buckled, course, first_tube, accuracy, first_space, out
        )
        if status[i] == OK or status[i] == INACCURATE:
            for k in range(6):
                share = 0.5 if not half and k < 4 else 1.0
                values[i, k], bounds[i, k] = share * out[0, k], share * out[1, k]
            stable[i] = 1 if unstable == 0 else 0
            cells_of_base = tube[1][len(tube[1]) - 1]
            slack[i] = slack_fibers(space[0][0], space[0][1], cells_of_base << doublings, cells_of_base, tube, now)
            if len(stations) > 0:
                at_stations(stations, cells_of_base, doublings, tube, now, space[0], space[3], profiles[i])

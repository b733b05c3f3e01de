"""Held states: one after another, each on a mesh that holds it."""

import numpy as np

from ..jit import entry_point, kernel
from . import guide, held, lagrangian, nested
from .branch import GAMMA, SHEAR, rubber_of
from .course import copy
from .drawing import draw
from .find import HELD_LENGTH, find
from .march import cylinder_multiplier
from .profile import FIELDS
from .slack import slack_fibers
from .status import BEYOND_LIMIT, HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK, PENDING

FINER, FINEST = 4, 6144  # times the cells of the base mesh, up to so many: some layers are thin
CONFIRMED = 0.01  # relative difference of a limit's place from one mesh to the next
ENDED = 1e-3  # the same: where two meshes agree so well on its place, the branch ends there
THINNEST_LAYER = 100.0  # times it fits into a cell of an even base mesh; thinner ones need a finer mesh from the start
JUST_BEYOND = 1.0001  # times the pressure


@kernel
def workspace(base, varying):
    """Scratch for a base mesh of ``base`` cells: see :func:`nested.solve`; and the cells of a tube that varies."""
    size = (base << nested.MAX_DOUBLINGS) + 2
    space = (
        np.zeros((5, size)), np.zeros((13, size)), np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS)),
        np.zeros((5, size)), np.zeros((2, base + 1)),
    )  # fmt: skip
    return space, np.zeros((size if varying else 1, 3))


@kernel
def layers(problem, p, other, kind, tube):
    """How many times the thinnest end layer of a cylinder under the load fits into the length that is solved."""
    course, places = tube[0], tube[5]
    force, torque = (0.0, other) if kind == HELD_LENGTH else (other, 0.0)
    unit = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0) if kind == HELD_LENGTH else (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    load = (problem[GAMMA], rubber_of(problem), problem[SHEAR], p, force, torque, 1.0)
    largest = 0.0
    for k in range(1 if course.shape[0] == 1 and course.shape[1] == 1 else guide.PLACES):
        cell = guide.cell_along(tube, k / (guide.PLACES - 1))
        room, _, _, L_yy, _, L_vv = lagrangian.density(
            1.0, 0.0, cell, held.loaded(load, unit, cylinder_multiplier(cell, load, unit))
        )
        if room > 0.0 and L_yy < 0.0:
            largest = max(largest, L_yy / L_vv)
    return np.sqrt(largest) * places[len(places) - 1]


@kernel
def find_on_some_mesh(problem, p, other, target, kind, buckled, course, tube, accuracy, space, out):
    """As :func:`find`, on finer base meshes where one does not do: where the solver fails, or a limit is met that the next
    mesh has to confirm. Returns also the tube and the scratch that were used.
    """
    _, edges, cells, free, middle, places = tube
    base, factor = edges[len(edges) - 1], 1
    while factor * base <= FINEST and layers(problem, p, other, kind, tube) > THINNEST_LAYER * factor * base:
        factor *= FINER
    if factor > 1:
        space, cells = workspace(factor * base, len(cells) > 1)
        tube = (tube[0], factor * edges, cells, free, factor * middle, places)
    status, before = NOT_CONVERGED, (NOT_CONVERGED, 0.0)
    while True:
        copy(course, tube[0])  # a march leaves it changed
        status, unstable, doublings, now, reached = find(
            problem, p, other, target, kind, buckled, course, tube, accuracy, space, out
        )
        limit = status == BEYOND_LIMIT or (status == HELD_IMPOSSIBLE and not buckled)
        confirmed = status == before[0] and abs(reached - before[1]) <= CONFIRMED * reached
        if (
            status == NOT_CONVERGED
            and abs(reached - before[1]) <= ENDED * reached
            and 0.0 < reached < 1.0
            and not buckled
        ):
            status = BEYOND_LIMIT  # steps die out at one place on any mesh
            break
        if not (status == NOT_CONVERGED or status == INACCURATE or (limit and not confirmed)):
            break
        before, factor = (status, reached), FINER * factor
        if factor * base > FINEST:
            if status == NOT_CONVERGED and reached == 1.0 and not buckled:  # no mesh holds it: a limit just beyond?
                copy(course, tube[0])
                beyond, _, _, _, _ = find(
                    problem, JUST_BEYOND * p, other, target, kind, buckled, course, tube, accuracy, space, out
                )
                status = BEYOND_LIMIT if beyond == BEYOND_LIMIT else status
            break
        space, cells = workspace(factor * base, len(cells) > 1)
        tube = (tube[0], factor * edges, cells, free, factor * middle, places)
    return status, unstable, doublings, now, tube, space


@entry_point
def hold_many(
    problem, pressures, others, targets, kind, buckled, course, edges, places, accuracy, values, bounds, status, stable,
    slack, stations, profiles,
):  # fmt: skip
    """Held states of one design, for arrays of pressure, of the load that is not unknown, and of the held quantity.

    The n-th entries belong together; those whose status is not PENDING are passed over. ``targets`` are in radii (deformed
    length) or radians, of the whole tube; a tube that is the same all along is solved by half (``edges`` and ``places`` of
    one segment), unless ``buckled``. ``values`` and ``bounds`` are (n, 6): length, volume, twist, energy of half the tube,
    stretch in the middle, multiplier.
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
        if status[i] != PENDING:
            continue
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
                drawn = draw(
                    stations, cells_of_base, doublings, tube, now, space[0], space[3], space[1], accuracy, profiles[i]
                )
                status[i] = status[i] if drawn else INACCURATE

"""Held states: one after another, each on a mesh that holds it."""

from math import atan

import numpy as np

from ..jit import entry_point, kernel
from . import guide, held, lagrangian, nested
from .buckle import find_buckled
from .course import copy, make_cells, volume
from .drawing import draw
from .find import FROM_REST, HELD_LENGTH, find, valued
from .march import cylinder_multiplier
from .problem import GAMMA, LENGTH, D, H, rubber_of, wall_of
from .profile import FIELDS
from .shapes import MESH_CHANGE
from .slack import slack_fibers
from .status import BEYOND_LIMIT, COMPRESSED, INACCURATE, NOT_CONVERGED, OK, PENDING

FINER, FINEST = 4, 6144  # times the cells of the base mesh, up to so many: some layers are thin
ENDED = 1e-2  # relative difference of a limit's place: where two meshes agree so well, the branch ends there
THINNEST_LAYER = 100.0  # times it fits into a cell of an even base mesh; thinner ones need a finer mesh from the start


@kernel
def workspace(base, varying, course):
    """Scratch for a base mesh of ``base`` cells: see :func:`nested.solve`; and the cells of a tube, which may vary."""
    size = (base << nested.MAX_DOUBLINGS) + 2
    space = (
        np.zeros((5, size)), np.zeros((13, size)), np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS)),
        np.zeros((5, size)), np.zeros((2, base + 1)),
    )  # fmt: skip
    return space, make_cells(course, size if varying else 1)


@kernel
def layers(problem, walls, p, other, kind, tube):
    """How many times the thinnest end layer of a cylinder under the load fits into the length that is solved."""
    course, places = tube[0], tube[5]
    force, torque = (0.0, other) if kind == HELD_LENGTH else (other, 0.0)
    unit = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0) if kind == HELD_LENGTH else (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    load = (problem[GAMMA], rubber_of(problem), wall_of(problem, walls), p, force, torque, 1.0)
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
def find_on_some_mesh(problem, walls, p, other, target, kind, course, tube, accuracy, space, out):
    """As :func:`find`, on finer base meshes where one does not do: where the solver fails, misses the accuracy, or meets an
    end of the way that is not certain. Returns also the tube and the scratch that were used.

    Where the accuracy is missed on all of them, the first mesh's state stands. Among unstable states branches lie close to
    each other, and a mesh that sees too little of them leads astray: such a state is given where two meshes lead to it.
    """
    _, edges, cells, free, middle, places = tube
    base, factor = edges[len(edges) - 1], 1
    while factor * base <= FINEST and layers(problem, walls, p, other, kind, tube) > THINNEST_LAYER * factor * base:
        factor *= FINER
    if factor > 1:
        space, cells = workspace(factor * base, len(cells) > 1, course)
        tube = (tube[0], factor * edges, cells, free, factor * middle, places)
    copy(course, tube[0])  # a march leaves it changed
    status, unstable, doublings, now, reached, sure, path = find(
        problem, walls, p, other, target, kind, course, tube, accuracy, space, out
    )
    doubtful, differed = valued(status) and unstable > 0 and out[0, nested.MIDDLE] != 1.0, False
    while (doubtful or not (status == OK or status == COMPRESSED or sure)) and FINER * factor * base <= FINEST:
        factor *= FINER
        finer_space, cells = workspace(factor * base, len(cells) > 1, course)
        finer_tube, finer_out = (tube[0].copy(), factor * edges, cells, free, factor * middle, places), out.copy()
        copy(course, finer_tube[0])
        again, others, levels, then, came, certain, way = find(
            problem, walls, p, other, target, kind, course, finer_tube, accuracy, finer_space, finer_out
        )
        same = valued(status) and valued(again) and alike(out, finer_out)
        if status == INACCURATE and again != OK and (same or not doubtful):
            differed = False
            break
        if doubtful and same and status == OK:
            differed = False
            break
        differed = doubtful and not same
        ended = abs(came - reached) <= ENDED * reached and 0.0 < reached < 1.0
        status, unstable, doublings, now, reached, sure, path = again, others, levels, then, came, certain, way
        tube, space = finer_tube, finer_space
        for row in range(out.shape[0]):
            for k in range(out.shape[1]):
                out[row, k] = finer_out[row, k]
        doubtful = valued(status) and unstable > 0 and not same
        if status != OK and status != INACCURATE and ended:  # steps die out at one place on any mesh
            status = BEYOND_LIMIT if status == NOT_CONVERGED else status
            break
    if doubtful and differed:
        status = NOT_CONVERGED
    return status, unstable, doublings, now, tube, space, path


@kernel
def alike(out, other):
    """Whether the outputs of two base meshes are those of one state."""
    same = True
    for k in range(nested.MULTIPLIER):
        same = same and abs(out[0, k] - other[0, k]) <= MESH_CHANGE * out[2, k]
    return same


@kernel
def at_rest(stations, fields, problem):
    """Fields of the undeformed tube; the fiber angles of one that varies are put in by who asks."""
    for j in range(len(stations)):
        for k in range(FIELDS):
            fields[k, j] = 0.0
        fields[0, j], fields[1, j] = 1.0, stations[j]
        fields[3, j], fields[4, j] = atan(problem[H] + problem[D]), atan(problem[H] - problem[D])


@entry_point
def hold_many(
    problem, walls, pressures, others, targets, kind, buckled, course, edges, places, accuracy, values, bounds, status,
    stable, slack, paths, least, stations, profiles,
):  # fmt: skip
    """Held states of one design, for arrays of pressure, of the load that is not unknown, and of the held quantity.

    The n-th entries belong together; those whose status is not PENDING are passed over. ``targets`` are in radii (deformed
    length) or radians, of the whole tube; a tube that is the same all along is solved by half (``edges`` and ``places`` of
    one segment), unless ``buckled``. ``values`` and ``bounds`` are (n, 6): length, volume, twist, energy of half the tube,
    stretch in the middle, multiplier. ``paths`` (n,) takes the way by which a state was found, ``least`` (n, 2) the least
    pressure of the ``buckled`` branch and its bound.
    """
    base = edges[len(edges) - 1]
    half = len(places) == 2
    middle = base if half else edges[np.argmin(np.abs(places - 0.5 * places[len(places) - 1]))]
    varying = not half or course.shape[1] > 1
    first_space, cells = workspace(base, varying, course)
    first_tube = (course.copy(), edges, cells, half, middle, places)
    out = np.zeros((4, nested.OUTPUTS))
    for i in range(len(pressures)):
        for k in range(6):
            values[i, k], bounds[i, k] = np.nan, np.nan
        for j in range(len(stations)):
            for k in range(FIELDS):
                profiles[i, k, j] = np.nan
        slack[i], stable[i], paths[i] = 0, 0, FROM_REST
        least[i, 0], least[i, 1] = np.nan, np.nan
        if status[i] != PENDING:
            continue
        target = 0.5 * targets[i] if half else targets[i]
        whole = places[len(places) - 1]
        if (
            pressures[i] == 0.0
            and others[i] == 0.0
            and target == (whole if kind == HELD_LENGTH else 0.0)
            and not buckled
        ):
            rest = 0.5 * problem[LENGTH]
            status[i], stable[i] = OK, 1
            values[i, 0], values[i, 1], values[i, 4] = rest, (1.0 if half else 0.5) * volume(course, places), 1.0
            values[i, 2], values[i, 3], values[i, 5] = 0.0, 0.0, 0.0
            for k in range(6):
                bounds[i, k] = 0.0
            at_rest(stations, profiles[i], problem)
            continue
        tube, space, unstable = first_tube, first_space, 0
        if buckled:
            status[i], unstable, doublings, bare = find_buckled(
                problem, pressures[i], others[i], target, tube, accuracy, space, out, least[i]
            )
            now = (
                bare[0],
                bare[1],
                wall_of(problem, walls),
                bare[3],
                bare[4],
                bare[5],
                bare[6],
            )  # a load's type is one
        else:
            status[i], unstable, doublings, now, tube, space, paths[i] = find_on_some_mesh(
                problem, walls, pressures[i], others[i], target, kind, course, first_tube, accuracy, first_space, out
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

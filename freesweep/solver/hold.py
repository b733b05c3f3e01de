"""Held states: one after another, each on a mesh that holds it."""

from math import atan

import numpy as np

from ..jit import entry_point, kernel
from . import guide, held, lagrangian, nested
from .buckle import find_buckled
from .drawing import draw
from .find import find
from .problem import LENGTH, D, H
from .profile import FIELDS
from .shapes import MESH_CHANGE
from .slack import slack_fibers
from .sought import FROM_REST, HELD_LENGTH, Found, failed, load_of, unit_of, valued
from .status import BEYOND_LIMIT, COMPRESSED, INACCURATE, NOT_CONVERGED, OK, PENDING
from .way import cylinder_multiplier, make_room

FINER, FINEST = 4, 6144  # times the cells of the base mesh, up to so many: some layers are thin
ENDED = 1e-2  # relative difference of a limit's place: where two meshes agree so well, the branch ends there
THINNEST_LAYER = 100.0  # times it fits into a cell of an even base mesh; thinner ones need a finer mesh from the start


@kernel
def layers(problem, walls, p, other, kind, tube):
    """How many times the thinnest end layer of a cylinder under the load fits into the length that is solved."""
    course, places, load, unit = tube[0], tube[5], load_of(problem, walls, p, other, kind), unit_of(kind, 1.0)
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
def cells_for(base, varies):
    """Room for what varies along a tube, on the finest mesh."""
    return np.zeros(((base << nested.MAX_DOUBLINGS) + 2 if varies else 1, 3))


@kernel
def made_finer(tube, factor):
    """The tube on a base mesh of so many times the cells."""
    course, edges, cells, free, middle, places = tube
    return (
        course,
        factor * edges,
        cells_for(factor * edges[len(edges) - 1], len(cells) > 1),
        free,
        factor * middle,
        places,
    )


@kernel
def first_factor(problem, walls, p, other, kind, tube):
    """Times the cells of the base mesh that its thinnest layer needs."""
    base, factor = tube[1][len(tube[1]) - 1], 1
    most = layers(problem, walls, p, other, kind, tube) / THINNEST_LAYER
    while factor * base <= FINEST and most > factor * base:
        factor *= FINER
    return factor


@kernel
def find_on_some_mesh(problem, walls, p, other, target, kind, tube, accuracy, room, out):
    """As :func:`find`, on finer base meshes where one does not do: where the solver fails, misses the accuracy, or meets an
    end of the way that is not certain. Returns also the tube and the room that were used.

    Where the accuracy is missed on all of them, the first mesh's state stands. Among unstable states branches lie close to
    each other, and a mesh that sees too little of them leads astray: such a state is given where two meshes lead to it.
    """
    base, half, varies = tube[1][len(tube[1]) - 1], tube[3], len(tube[2]) > 1
    factor = first_factor(problem, walls, p, other, kind, tube)
    if factor > 1:
        tube, room = made_finer(tube, factor), make_room(factor * base, half, varies)
    found = find(problem, walls, p, other, target, kind, tube, accuracy, room, out)
    doubtful, differed = valued(found.status) and found.unstable > 0 and out[0, nested.MIDDLE] != 1.0, False
    settled = found.status == OK or found.status == COMPRESSED or found.sure
    first_tube = tube
    finer = 1
    while (doubtful or not settled) and FINER * finer * factor * base <= FINEST:
        finer *= FINER
        finer_tube, finer_room = made_finer(first_tube, finer), make_room(finer * factor * base, half, varies)
        finer_out = out.copy()
        again = find(problem, walls, p, other, target, kind, finer_tube, accuracy, finer_room, finer_out)
        same = valued(found.status) and valued(again.status) and alike(out, finer_out)
        keeps = found.status == INACCURATE and again.status != OK and (same or not doubtful)
        if keeps or (doubtful and same and found.status == OK):
            differed = False
            break
        differed = doubtful and not same
        ended = abs(again.reached - found.reached) <= ENDED * found.reached and 0.0 < found.reached < 1.0
        found, tube, room = again, finer_tube, finer_room
        settled = found.status == OK or found.status == COMPRESSED or found.sure
        for row in range(out.shape[0]):
            for k in range(out.shape[1]):
                out[row, k] = finer_out[row, k]
        doubtful = valued(found.status) and found.unstable > 0 and not same
        if not valued(found.status) and ended:  # steps die out at one place on any mesh
            found = as_limit(found)
            break
    if doubtful and differed:
        found = failed(NOT_CONVERGED, found.load)
    return found, tube, room


@kernel
def as_limit(found):
    """The same, whose end is a limit."""
    status = BEYOND_LIMIT if found.status == NOT_CONVERGED else found.status
    return Found(status, found.unstable, found.doublings, found.load, found.reached, found.sure, found.path)


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
    first_room = make_room(base, half, varying)
    first_tube = course, edges, cells_for(base, varying), half, middle, places
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
            values[i, 0], values[i, 1], values[i, 4] = rest, rest, 1.0
            values[i, 2], values[i, 3], values[i, 5] = 0.0, 0.0, 0.0
            for k in range(6):
                bounds[i, k] = 0.0
            at_rest(stations, profiles[i], problem)
            continue
        tube, room = first_tube, first_room
        if buckled:
            found = find_buckled(problem, walls, pressures[i], others[i], target, tube, accuracy, room, out, least[i])
        else:
            found, tube, room = find_on_some_mesh(
                problem, walls, pressures[i], others[i], target, kind, first_tube, accuracy, first_room, out
            )
        status[i], paths[i] = found.status, found.path
        if status[i] == OK or status[i] == INACCURATE:
            for k in range(6):
                share = 0.5 if not half and k < 4 else 1.0
                values[i, k], bounds[i, k] = share * out[0, k], share * out[1, k]
            stable[i] = 1 if found.unstable == 0 else 0
            space, cells_of_base = room.space, tube[1][len(tube[1]) - 1]
            doublings, now = found.doublings, found.load
            slack[i] = slack_fibers(space.fine[0], space.fine[1], cells_of_base << doublings, cells_of_base, tube, now)
            if len(stations) > 0:
                drawn = draw(
                    stations,
                    cells_of_base,
                    doublings,
                    tube,
                    now,
                    space.fine,
                    space.curve,
                    space.work,
                    accuracy,
                    profiles[i],
                )
                status[i] = status[i] if drawn else INACCURATE

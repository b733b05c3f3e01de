"""Held states: one after another, each on a mesh that holds it."""

from math import atan
from typing import NamedTuple

import numpy as np

from ...jit import entry_point, kernel
from .. import guide
from ..along.drawing import draw
from ..along.profile import FIELDS
from ..along.slack import look_along
from ..numerics import held, nested
from ..numerics.properties_along import Tube, make_cells, volume
from ..numerics.shapes import MESH_CHANGE
from ..physics import lagrangian
from ..problem import LENGTH, D, H
from ..status import BEYOND_LIMIT, COMPRESSED, INACCURATE, NOT_CONVERGED, OK, PENDING
from .buckled import find_buckled
from .held_state import find
from .sought import FROM_REST, HELD_LENGTH, Found, failed, load_of, unit_of, valued
from .ways import cylinder_multiplier, make_room

FINER, FINEST = 4, 6144  # times the cells of the base mesh, up to so many: some layers are thin
ENDED = 1e-2  # relative difference of a limit's place: where two meshes agree so well, the branch ends there
THINNEST_LAYER = 100.0  # times it fits into a cell of an even base mesh; thinner ones need a finer mesh from the start


@kernel
def layers(problem, walls, p, other, kind, tube):
    """How many times the thinnest end layer of a cylinder under the load fits into the length that is solved."""
    course, places, load, unit = tube.course, tube.places, load_of(problem, walls, p, other, kind), unit_of(kind, 1.0)
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
def cells_for(base, varies, course):
    """Room for what varies along a tube, on the finest mesh."""
    return make_cells(course, (base << nested.MAX_DOUBLINGS) + 2 if varies else 1)


@kernel
def made_finer(tube, factor):
    """The tube on a base mesh of so many times the cells."""
    course, edges, cells, free, middle, places = tube
    return Tube(
        course,
        factor * edges,
        cells_for(factor * edges[len(edges) - 1], len(cells) > 1, course),
        free,
        factor * middle,
        places,
    )


@kernel
def first_factor(problem, walls, p, other, kind, tube):
    """Times the cells of the base mesh that its thinnest layer needs."""
    base, factor = tube.edges[len(tube.edges) - 1], 1
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
    base, half, varies = tube.edges[len(tube.edges) - 1], tube.half, len(tube.cells) > 1
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


class States(NamedTuple):
    """Arrays of states: see :func:`hold_many`."""

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    stable: np.ndarray
    slack: np.ndarray
    paths: np.ndarray
    least: np.ndarray
    stations: np.ndarray
    profiles: np.ndarray


@kernel
def blank(states, i):
    """No value yet."""
    for k in range(6):
        states.values[i, k], states.bounds[i, k] = np.nan, np.nan
    for j in range(len(states.stations)):
        for k in range(FIELDS):
            states.profiles[i, k, j] = np.nan
    states.slack[i], states.stable[i], states.paths[i] = 0, 0, FROM_REST
    states.least[i, 0], states.least[i, 1] = np.nan, np.nan


@kernel
def leave_at_rest(states, i, problem, tube):
    """The undeformed tube; the fiber angles of one that varies are put in by who asks."""
    rest, fields = 0.5 * problem[LENGTH], states.profiles[i]
    states.status[i], states.stable[i] = OK, 1
    for k in range(6):
        states.values[i, k], states.bounds[i, k] = 0.0, 0.0
    states.values[i, 0], states.values[i, 4] = rest, 1.0
    states.values[i, 1] = (1.0 if tube.half else 0.5) * volume(tube.course, tube.places)
    for j in range(len(states.stations)):
        for k in range(FIELDS):
            fields[k, j] = 0.0
        fields[0, j], fields[1, j] = 1.0, states.stations[j]
        fields[3, j], fields[4, j] = atan(problem[H] + problem[D]), atan(problem[H] - problem[D])


@kernel
def record(states, i, found, tube, space, accuracy, out):
    """What was found."""
    states.status[i], states.paths[i] = found.status, found.path
    if not valued(found.status):
        return
    base = tube.edges[len(tube.edges) - 1]
    for k in range(6):
        share = 0.5 if not tube.half and k < 4 else 1.0
        states.values[i, k], states.bounds[i, k] = share * out[0, k], share * out[1, k]
    states.stable[i] = 1 if found.unstable == 0 else 0
    states.slack[i] = look_along(
        space.fine,
        base << found.doublings,
        base,
        tube,
        found.load,
        space.work,
        states.values[i, 6:],
        states.bounds[i, 6:],
    )
    if len(states.stations) > 0:
        drawn = draw(
            states.stations, base, found.doublings, tube, found.load, space.fine, space.curve, space.work, accuracy,
            states.profiles[i],
        )  # fmt: skip
        states.status[i] = found.status if drawn else INACCURATE


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
    base, whole, half = edges[len(edges) - 1], places[len(places) - 1], len(places) == 2
    middle = base if half else edges[np.argmin(np.abs(places - 0.5 * whole))]
    varying = not half or course.shape[1] > 1
    first_room, out = make_room(base, half, varying), np.zeros((4, nested.OUTPUTS))
    first_tube = Tube(course, edges, cells_for(base, varying, course), half, middle, places)
    states = States(values, bounds, status, stable, slack, paths, least, stations, profiles)
    for i in range(len(pressures)):
        blank(states, i)
        if status[i] != PENDING:
            continue
        p, other, target = pressures[i], others[i], 0.5 * targets[i] if half else targets[i]
        natural = target == (whole if kind == HELD_LENGTH else 0.0)
        if p == 0.0 and other == 0.0 and natural and not buckled:
            leave_at_rest(states, i, problem, first_tube)
            continue
        tube, room = first_tube, first_room
        if buckled:
            found = find_buckled(problem, walls, p, other, target, tube, accuracy, room, out, least[i])
        else:
            found, tube, room = find_on_some_mesh(
                problem, walls, p, other, target, kind, first_tube, accuracy, first_room, out
            )
        record(states, i, found, tube, room.space, accuracy, out)

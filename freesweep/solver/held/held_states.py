"""Held states, of one design or many: one after another, each on a mesh that holds it."""

from math import atan
from typing import NamedTuple

import numpy as np

from ...jit import entry_point, kernel
from .. import guide
from ..along import places
from ..along.drawing import draw
from ..along.profile import FIELDS
from ..along.slack import look_along
from ..free.space import make_room
from ..numerics import error_bounds, held, nested
from ..numerics.properties_along import Tube, make_cells, of_problems, seat, turns, volume
from ..numerics.shapes import MESH_CHANGE
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from ..problem import GAMMA, LENGTH, D, H, wall_of
from ..status import (
    BEYOND_LIMIT,
    COMPRESSED,
    HELD_IMPOSSIBLE,
    INACCURATE,
    INVALID,
    NOT_CONVERGED,
    OK,
    PENDING,
)
from .held_state import find
from .sought import HELD_ROTATION, Asked, Found, failed, load_of, unit_of, valued
from .ways import cylinder_multiplier

FEW, EVERY = 2, 99  # meshes that are tried
FINER, FINEST = 4, 6144  # times the cells of the base mesh, up to so many: some layers are thin
ENDED = 1e-2  # relative difference of a limit's place: where two meshes agree so well, the branch ends there
THINNEST_LAYER = 100.0  # times it fits into a cell of an even base mesh; thinner ones need a finer mesh from the start


@kernel
def layers(problem, asked, tube):
    """How many times the thinnest end layer of a cylinder under the load fits into the length that is solved."""
    course, places, load, unit = tube.course, tube.places, load_of(problem, asked), unit_of(asked.kind, 1.0)
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
def first_factor(problem, asked, tube):
    """Times the cells of the base mesh that its thinnest layer needs."""
    base, factor = tube.edges[len(tube.edges) - 1], 1
    most = layers(problem, asked, tube) / THINNEST_LAYER
    while factor * base <= FINEST and most > factor * base:
        factor *= FINER
    return factor


@kernel
def find_on_some_mesh(problem, asked, tube, accuracy, most, room):
    """As :func:`find`, on finer base meshes, so many at ``most``, where one does not do: where the solver fails, misses the
    accuracy, or meets an end of the way that is not certain; PENDING where finer ones may tell. Returns also the tube and
    the room that were used.

    Where the accuracy is missed on all of them, the first mesh's state stands. Among unstable states branches lie close to
    each other, and a mesh that sees too little of them leads astray: such a state is given where two meshes lead to it.
    """
    base, half, count = tube.edges[len(tube.edges) - 1], tube.half, guide.PLACES if len(tube.cells) > 1 else 1
    factor = first_factor(problem, asked, tube)
    if factor > 1:
        tube, room = made_finer(tube, factor), make_room(factor * base, half, True, count)
    found = find(problem, asked, tube, accuracy, room)
    straight, differed = room.space.out[0, error_bounds.MIDDLE] == 1.0, False
    doubtful = valued(found.status) and found.unstable > 0 and not straight
    settled = found.status == OK or found.status == COMPRESSED or found.sure
    first_tube = tube
    finer, meshes = 1, 1
    while (doubtful or not settled) and FINER * finer * factor * base <= FINEST:
        if meshes >= most or (most < EVERY and not valued(found.status)):
            return failed(PENDING, found.load), tube, room
        finer *= FINER
        meshes += 1
        finer_tube, finer_room = made_finer(first_tube, finer), make_room(finer * factor * base, half, True, count)
        again = find(problem, asked, finer_tube, accuracy, finer_room)
        same = valued(found.status) and valued(again.status) and alike(room.space.out, finer_room.space.out)
        keeps = found.status == INACCURATE and again.status != OK and (same or not doubtful)
        if keeps or (doubtful and same and found.status == OK):
            differed = False
            break
        differed = doubtful and not same
        near = abs(again.reached - found.reached) <= ENDED * found.reached and 0.0 < found.reached < 1.0
        ended = near and again.status == found.status  # for other reasons they end near each other by chance
        found, tube, room = again, finer_tube, finer_room
        settled = found.status == OK or found.status == COMPRESSED or found.sure
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
    for k in range(error_bounds.MULTIPLIER):
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
    stations: np.ndarray
    profiles: np.ndarray


@kernel
def leave_at_rest(states, i, problem, wall, tube):
    """The undeformed tube; the fiber angles of one that varies are put in by who asks."""
    rest, fields = 0.5 * problem[LENGTH], states.profiles[i]
    states.status[i], states.stable[i] = OK, 1
    for k in range(6):
        states.values[i, k], states.bounds[i, k] = 0.0, 0.0
    states.values[i, 0], states.values[i, 4] = rest, 1.0
    states.values[i, 1] = (1.0 if tube.half else 0.5) * volume(tube.course, tube.places)
    if states.values.shape[1] > 6:
        places.rest(tube.course, wall, states.values[i, 6:], states.bounds[i, 6:])
    for j in range(len(states.stations)):
        for k in range(FIELDS):
            fields[k, j] = 0.0
        fields[0, j], fields[1, j] = 1.0, states.stations[j]
        fields[3, j], fields[4, j] = atan(problem[H] + problem[D]), atan(problem[H] - problem[D])


@kernel
def record(states, i, found, tube, space, accuracy):
    """What was found."""
    states.status[i], states.paths[i] = found.status, found.path
    if not valued(found.status):
        return
    base, out = tube.edges[len(tube.edges) - 1], space.out
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


@kernel
def ends_last(problem, wall, tube):
    """Whether longer fibers leave the clamped ends, whose radius is given, any length."""
    least = 1.0
    for end in range(2):
        cell = guide.cell_along(tube, 1.0 * end)
        least = min(least, lagrangian.clamped(cell, problem[GAMMA], wall))
    return least > 0.0


@kernel
def hold(states, i, problem, asked, tube, accuracy, most, room):
    """Hold one state, on so many meshes at ``most``."""
    wall, turned = wall_of(problem, asked.walls), asked.kind == HELD_ROTATION
    natural = asked.target == (0.0 if turned else (0.5 if tube.half else 1.0) * problem[LENGTH])
    if not ends_last(problem, wall, tube):
        states.status[i] = INVALID
    elif asked.p == 0.0 and asked.other == 0.0 and natural:
        leave_at_rest(states, i, problem, wall, tube)
    elif turned and not (turns(tube.course) or may_go_slack(wall)):
        states.status[i] = HELD_IMPOSSIBLE
    else:
        found, tube, room = find_on_some_mesh(problem, asked, tube, accuracy, most, room)
        record(states, i, found, tube, room.space, accuracy)


@entry_point
def hold_many(
    problems, walls, first, pressures, others, targets, kind, given, accuracy, most, values, bounds, status, stable, slack,
    paths, stations, profiles,
):  # fmt: skip
    """Held states of designs, each for pressures, the load that is not unknown, and what is held (``kind`` HELD_LENGTH, or
    HELD_ROTATION).

    ``problems``, ``first`` and ``pressures`` are those of :func:`..free.free_states.follow_many`, ``given`` its tube. The
    n-th entries of ``pressures``, ``others`` and ``targets`` belong together; those whose status is not PENDING are
    passed over, and where no value is found none is written; it stays PENDING where so many meshes as ``most`` do not
    settle it. ``targets`` are in radii (deformed length) or radians, of
    the whole tube; a tube that is the same all along is solved by half. ``values`` and ``bounds`` are (n, 6): length,
    volume, twist, energy of half the tube, stretch in the middle, multiplier; of physical tubes (n, 12), if the numbers
    of :mod:`..along.places` are asked for. ``paths`` (n,) takes the way by which a state was found.
    """
    course, edges, places = given
    alike, base = course.shape[0] == 0, edges[len(edges) - 1]
    own_course, own_places = of_problems(course) if alike else course, np.zeros(2) if alike else places.copy()
    whole = own_places[len(own_places) - 1]
    middle = base if alike else edges[np.argmin(np.abs(own_places - 0.5 * whole))]
    tube = Tube(own_course, edges, cells_for(base, not alike, own_course), alike, middle, own_places)
    room = make_room(base, alike, True, 1 if alike else guide.PLACES)
    states = States(values, bounds, status, stable, slack, paths, stations, profiles)
    for k in range(len(problems)):
        if alike:
            own_places[1] = 0.5 * problems[k, LENGTH]
            seat(own_course, problems[k])
        for i in range(first[k], first[k + 1]):
            if status[i] == PENDING:
                asked = Asked(walls, pressures[i], others[i], (0.5 if alike else 1.0) * targets[i], kind)
                hold(states, i, problems[k], asked, tube, accuracy, most, room)

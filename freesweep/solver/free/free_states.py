"""Free states: each tube's own branch is followed on meshes, along the one path of loads (:mod:`load_path`).

First leg: pressure, force, torque and fiber extension - 1 rise in proportion, the pressure to the settling one. Second leg:
from there the pressure alone, upward and downward. Which pressures are asked for changes no step: each state is solved on
nested meshes from the two states of the branch that enclose it.
"""

import numpy as np

from ...jit import entry_point, kernel
from .. import guide
from ..along import places
from ..load import Load, by, under
from ..numerics.bordered import FOLLOWED
from ..numerics.path import NOTHING, Path
from ..numerics.properties_along import Tube, make_cells, volume
from ..physics import lagrangian
from ..physics.wall import has_two_families, may_go_slack
from ..problem import FORCE, GAMMA, TORQUE, rubber_of, wall_of
from ..status import COMPRESSED, DEGENERATE, INACCURATE, INVALID, NOT_CONVERGED, OK, PENDING
from .branch import follow
from .meshes import stand
from .one_state import blank, cold, plain, record
from .space import Rows, make_room
from .way import begin, rise

FINER = (1, 4, 16)  # times the cells of the base mesh, one after another for what did not converge


@kernel
def settle(problem, wall, tube, rows):
    """Write the rows that need no solving."""
    gamma, f, m = problem[GAMMA], problem[FORCE], problem[TORQUE]
    clamped, half = 1.0, 0.5 * tube.places[len(tube.places) - 1]
    for end in range(2):
        cell = guide.cell_along(tube, 1.0 * end)
        clamped = min(clamped, lagrangian.clamped(cell, gamma, wall))
    for i in range(len(rows.pressures)):
        p = rows.pressures[i]
        if rows.status[i] != PENDING:
            continue
        blank(rows, i)
        if not (p >= 0.0 and clamped > 0.0):
            rows.status[i] = INVALID
        elif p == np.inf and not has_two_families(wall):
            rows.status[i] = DEGENERATE
        elif p == 0.0 and f == 0.0 and m == 0.0:
            rows.status[i] = OK
            for k in range(5):
                rows.values[i, k], rows.bounds[i, k] = 0.0, 0.0
            rows.values[i, 0], rows.values[i, 4] = half, 1.0
            rows.values[i, 1] = 0.5 * volume(tube.course, tube.places)
            places.rest(tube.course, wall, rows.values[i, 5:], rows.bounds[i, 5:])
        elif not p + f > 0.0:
            rows.status[i] = COMPRESSED


@kernel
def first_states(path, first, tube, space, rows, accuracy):
    """Unloaded tubes at pressures below that at which their branch begins."""
    for i in range(len(rows.pressures)):
        p = rows.pressures[i]
        if rows.status[i] == PENDING and p < first:
            load = under(path.origin, p, 0.0, 0.0)
            if guide.near_rest(tube, load, space.u):
                guide.start(tube, space.u, load, space.x, space.y)
                status, doublings = cold(space, tube, load, accuracy)
                record(space, tube, load, status, doublings, accuracy, rows, i)


@kernel
def leave(rows, status, low, high):
    """Rows that still wait, from pressure ``low`` to ``high``, get a status."""
    for i in range(len(rows.pressures)):
        if rows.status[i] == PENDING and low <= rows.pressures[i] <= high:
            rows.status[i] = status


@kernel
def lock(problem, walls, tube, room, rows, accuracy):
    """Locked shapes, where the wall no longer counts: from a rough guess or, where that is too rough, on a straight way
    from rest along which the wall fades.
    """
    track, space = room.track, room.space
    load = Load(problem[GAMMA], rubber_of(problem), wall_of(problem, walls), 1.0, 0.0, 0.0, 0.0)
    for i in range(len(rows.pressures)):
        if rows.status[i] == PENDING and rows.pressures[i] == np.inf:
            guide.locked(tube, problem[GAMMA], space.u)
            guide.start(tube, space.u, load, space.x, space.y)
            status, doublings = cold(space, tube, load, accuracy)
            if status == NOT_CONVERGED:
                rest = Load(1.0, load.rubber, load.wall, 0.0, 0.0, 0.0, 1.0)
                fading = Load(load.gamma - 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0)
                way = Path(rest, fading, 0.0, may_go_slack(load.wall), NOTHING)
                if rise(room, tube, way).status == OK:
                    for k in range(len(space.x)):
                        space.x[k], space.y[k] = track.x[k], track.y[k]
                    status, doublings = plain(space, tube, load, accuracy)
            record(space, tube, load, status, doublings, accuracy, rows, i)


@kernel
def along_pressure(room, tube, path, status, here, sense, far, rows, limit, accuracy):
    """The states from the pressure ``here[0]`` on, where the room's track stands if its ``status`` is FOLLOWED, to the
    pressure ``far``; rows on that side that no state belongs to get a status.
    """
    if status == FOLLOWED:
        status = follow(room, tube, path, here, far, rows, limit, accuracy)
    else:
        status = NOT_CONVERGED
    low, high = (here[0], np.inf) if sense > 0.0 else (0.0, here[0])
    leave(rows, status if status != OK else NOT_CONVERGED, low, high)


@kernel
def walk(problem, walls, settled, tube, room, rows, limit, accuracy):
    """All states of one design; rows whose status is not PENDING are passed over. ``settled`` is its settling pressure,
    ``limit`` (2,) takes the limit pressure and its bound, if one is met. Rows: see :func:`follow_many`.
    """
    settle(problem, wall_of(problem, walls), tube, rows)
    lock(problem, walls, tube, room, rows, accuracy)
    least, most = np.inf, -1.0
    for i in range(len(rows.pressures)):
        if rows.status[i] == PENDING:
            least, most = min(least, rows.pressures[i]), max(most, rows.pressures[i])
    if most < 0.0:
        return
    gamma, f, m = problem[GAMMA], problem[FORCE], problem[TORQUE]
    rubber, wall = rubber_of(problem), wall_of(problem, walls)
    rest, pressure = Load(1.0, rubber, wall, 0.0, 0.0, 0.0, 1.0), by(1.0, 0.0, 0.0)
    if f == 0.0 and m == 0.0 and gamma == 1.0:
        path = Path(rest, pressure, 0.0, may_go_slack(wall), NOTHING)
        status, mu, tangent_mu = begin(room, tube, path)
        if status == FOLLOWED:
            first_states(path, mu, tube, room.space, rows, accuracy)
        else:
            mu = 0.0
        if most > mu:
            along_pressure(room, tube, path, status, (mu, tangent_mu), 1.0, most, rows, limit, accuracy)
        leave(rows, NOT_CONVERGED, 0.0, np.inf)
        return
    loads, track = Load(gamma - 1.0, 0.0, 0.0, settled, f, m, 0.0), room.track
    origin = Load(gamma, rubber, wall, 0.0, f, m, 1.0)
    path = Path(origin, pressure, max(f, 0.0), may_go_slack(wall), NOTHING)
    status = rise(room, tube, Path(rest, loads, 0.0, may_go_slack(wall), NOTHING)).status
    if status != OK:
        leave(rows, status, 0.0, np.inf)
        return
    x, y = track.x.copy(), track.y.copy()
    for sense, far in ((1.0, most), (-1.0, least)):
        if (far - settled) * sense < 0.0:
            continue
        for i in range(len(x)):
            track.x[i], track.y[i] = x[i], y[i]
        status, _, tangent_mu = stand(track, tube, path, settled, sense, 0, room.space.work)
        along_pressure(room, tube, path, status, (settled, tangent_mu), sense, far, rows, limit, accuracy)


@entry_point
def follow_many(
    problems, walls, settled, first, pressures, tube, accuracy, values, bounds, status, slack, limits, stations, profiles
):  # fmt: skip
    """Equilibria of many designs, each on its own branch: see :func:`walk`.

    Arguments
    ---------
    problems : (k, PROBLEM_SIZE) the designs, dimensionless; problem i owns rows ``first[i]`` to ``first[i + 1]`` of the rest
    walls : the columns of a wall, SOURCE or PHYSICAL of :mod:`problem`
    settled : (k,) pressure at which the loads of each are full
    pressures : (n,) p = P/C10; infinity is the locked shape, where the wall no longer counts
    tube : (course, edges, places), what varies along them, where segments begin and end on the base mesh, and along x
    accuracy : bound to reach, scaled
    values, bounds : (n, 5) length, volume, twist, energy of half the tube, stretch in the middle, and error bounds; of
        physical tubes (n, 11), with the numbers of :mod:`..along.places`
    status, slack : (n,) codes; rows that are not PENDING are passed over; values are NaN unless the status is OK or
        INACCURATE
    limits : (k, 2) limit pressure and its bound; what is there stays if none is met
    stations, profiles : (m,), (n, FIELDS, m): see :func:`..along.profile.at_stations`; m = 0 for none
    """
    course, edges, places = tube
    middle, half = edges[len(edges) - 1], 0.5 * places[len(places) - 1]
    for k in range(len(places)):
        if abs(places[k] - half) < 1e-9 * half:
            middle = edges[k]
    for k in range(len(problems)):
        own = slice(first[k], first[k + 1])
        if not np.any(status[own] == PENDING):
            continue
        for factor in FINER:
            base = factor * edges[len(edges) - 1]
            room = make_room(base, False, False, guide.PLACES)
            cells = make_cells(course, len(room.space.fine[0]))
            whole = Tube(course, factor * edges, cells, False, factor * middle, places)
            rows = Rows(pressures[own], values[own], bounds[own], status[own], slack[own], stations, profiles[own])
            walk(problems[k], walls, settled[k], whole, room, rows, limits[k], accuracy)
            again = False
            for i in range(first[k], first[k + 1]):
                if status[i] == NOT_CONVERGED or status[i] == INACCURATE:
                    again = True
                    if factor < FINER[len(FINER) - 1]:
                        status[i] = PENDING
            if not again:
                break

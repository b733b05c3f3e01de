"""Free states of tubes that vary: continuation on meshes, along the one path of loads (:mod:`load_path`), and nothing else.

First leg: pressure, force, torque and fiber extension - 1 rise in proportion, the pressure to the settling one. Second leg:
from there the pressure alone, upward and downward. Which pressures are asked for changes no step: each state is solved on
nested meshes from the two states of the branch that enclose it.
"""

import numpy as np

from ...jit import entry_point, inlined, kernel
from .. import guide, lagrangian
from ..branch import FORCE, GAMMA, SHEAR, TORQUE, rubber_of
from ..continuation import FOLLOWED, Path
from ..status import COMPRESSED, INACCURATE, INVALID, NOT_CONVERGED, OK, PENDING
from .branch import begin, follow, guess
from .fold import FINEST
from .meshes import stand
from .one_state import blank, cold, differ, extremes, record
from .space import Rows, make_space, make_track

FINER = 4  # times the cells of the base mesh, for what did not converge on it


@inlined
def settle(problem, tube, rows):
    """Write the rows that need no solving."""
    gamma, f, m = problem[GAMMA], problem[FORCE], problem[TORQUE]
    clamped, whole = 1.0, tube[5][len(tube[5]) - 1]
    for end in range(2):
        cell = guide.cell_along(tube, 1.0 * end)
        clamped = min(clamped, 1.0 + lagrangian.kinematics(1.0, cell, (gamma, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))[3])
    for i in range(len(rows.pressures)):
        p = rows.pressures[i]
        if rows.status[i] != PENDING:
            continue
        blank(rows, i)
        if not (p >= 0.0 and clamped > 0.0):
            rows.status[i] = INVALID
        elif p == 0.0 and f == 0.0 and m == 0.0:
            rows.status[i] = OK
            for k in range(5):
                rows.values[i, k], rows.bounds[i, k] = 0.0, 0.0
            rows.values[i, 0], rows.values[i, 1], rows.values[i, 4] = 0.5 * whole, 0.5 * whole, 1.0
        elif not p + f > 0.0:
            rows.status[i] = COMPRESSED


@inlined
def lock(problem, tube, space, rows, accuracy):
    """Locked shapes: at infinite pressure."""
    load = (problem[GAMMA], rubber_of(problem), problem[SHEAR], 1.0, 0.0, 0.0, 0.0)
    for i in range(len(rows.pressures)):
        if rows.status[i] == PENDING and rows.pressures[i] == np.inf:
            guide.locked(tube, problem[GAMMA], space.ahead)
            guide.start(tube, space.ahead, load, space.x, space.y)
            status, doublings = cold(space, tube, load, accuracy)
            record(space, tube, load, status, doublings, accuracy, rows, i)


@inlined
def first_states(path, first, tube, space, rows, accuracy):
    """Unloaded tubes at pressures below that at which their branch begins."""
    for i in range(len(rows.pressures)):
        p = rows.pressures[i]
        if rows.status[i] == PENDING and p < first:
            load = (path.origin[0], path.origin[1], path.origin[2], p, 0.0, 0.0, 1.0)
            for k in range(len(space.u)):
                space.u[k] = 1.0
            if guide.follow(tube, space.u, path.origin, load, space.ahead) == 1.0:
                guide.start(tube, space.ahead, load, space.x, space.y)
                status, doublings = cold(space, tube, load, accuracy)
                record(space, tube, load, status, doublings, accuracy, rows, i)


@kernel
def leave(rows, status, low, high):
    """Rows that still wait, from pressure ``low`` to ``high``, get a status."""
    for i in range(len(rows.pressures)):
        if rows.status[i] == PENDING and low <= rows.pressures[i] <= high:
            rows.status[i] = status


@inlined
def settle_loads(path, track, roomy, space, tube, rows, limit, accuracy):
    """Stand on the state at which all loads are at their full size; its status."""
    status, mu, tangent_mu = begin(track, space, tube, path)
    if status != FOLLOWED:
        return NOT_CONVERGED
    if mu < 1.0:
        none = Rows(
            rows.pressures[:0], rows.values[:0], rows.bounds[:0], rows.status[:0], rows.slack[:0], rows.stations,
            rows.profiles[:0],
        )  # fmt: skip
        status, here, ahead = follow(track, roomy, space, tube, path, mu, tangent_mu, 1.0, none, limit, accuracy)
        if status != OK:
            return status
        guess(track, space, here, ahead, 1.0)
        for i in range(len(space.y)):
            track.y[i] = space.y[i]
        status, negative, _ = stand(track, tube, path, 1.0, 1.0, 0, space.work)
        if status != FOLLOWED or negative > 0 or differ(extremes(space.y, tube[4]), extremes(track.y, tube[4])):
            return NOT_CONVERGED
    return OK


@inlined
def walk(problem, settled, tube, track, roomy, space, rows, limit, accuracy):
    """All states of one design; rows whose status is not PENDING are passed over. ``settled`` is its settling pressure,
    ``limit`` (2,) the limit pressure and its bound, NaN if none was met. See :func:`freesweep.solver.branch.walk`.
    """
    limit[0], limit[1] = np.nan, np.nan
    settle(problem, tube, rows)
    lock(problem, tube, space, rows, accuracy)
    least, most = np.inf, -1.0
    for i in range(len(rows.pressures)):
        if rows.status[i] == PENDING:
            least, most = min(least, rows.pressures[i]), max(most, rows.pressures[i])
    if most < 0.0:
        return
    gamma, f, m, rubber, shear = problem[GAMMA], problem[FORCE], problem[TORQUE], rubber_of(problem), problem[SHEAR]
    rest, pressure = (1.0, rubber, shear, 0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    if f == 0.0 and m == 0.0 and gamma == 1.0:
        path = Path(rest, pressure, 0.0)
        status, mu, tangent_mu = begin(track, space, tube, path)
        if status == FOLLOWED:
            first_states(path, mu, tube, space, rows, accuracy)
            status = OK
            if most > mu:
                status, _, _ = follow(track, roomy, space, tube, path, mu, tangent_mu, most, rows, limit, accuracy)
        leave(rows, status, 0.0, np.inf)
        return
    first = Path(rest, (gamma - 1.0, 0.0, 0.0, settled, f, m, 0.0), 0.0)
    status = settle_loads(first, track, roomy, space, tube, rows, limit, accuracy)
    if status != OK:
        leave(rows, status, 0.0, np.inf)
        return
    path, n = Path((gamma, rubber, shear, 0.0, f, m, 1.0), pressure, max(f, 0.0)), len(track.x) - 1
    x, y = track.x.copy(), track.y.copy()
    for sense, far in ((1.0, most), (-1.0, least)):
        if (far - settled) * sense < 0.0:
            continue
        for i in range(n + 1):
            track.x[i], track.y[i] = x[i], y[i]
        status, _, tangent_mu = stand(track, tube, path, settled, sense, 0, space.work)
        if status == FOLLOWED:
            status, _, _ = follow(track, roomy, space, tube, path, settled, tangent_mu, far, rows, limit, accuracy)
        else:
            status = NOT_CONVERGED
        leave(rows, status, settled if sense > 0.0 else 0.0, np.inf if sense > 0.0 else settled)


@entry_point
def follow_many(
    problems, settled, first, pressures, course, edges, places, accuracy, values, bounds, status, slack, limits, stations,
    profiles,
):  # fmt: skip
    """:func:`walk` for each row of ``problems``, of tubes that share one ``course``; arguments as of
    :func:`freesweep.solver.branch.walk_many`, and the ``settled`` pressure of each.
    """
    middle, half = edges[len(edges) - 1], 0.5 * places[len(places) - 1]
    for k in range(len(places)):
        if abs(places[k] - half) < 1e-9 * half:
            middle = edges[k]
    for k in range(len(problems)):
        own = slice(first[k], first[k + 1])
        for factor in (1, FINER):
            base = factor * edges[len(edges) - 1]
            space, track, roomy = make_space(base), make_track(base), make_track(FINEST * base)
            cells = np.zeros((len(space.fine[0]), 3))
            tube = (course, factor * edges, cells, False, factor * middle, places)
            rows = Rows(pressures[own], values[own], bounds[own], status[own], slack[own], stations, profiles[own])
            walk(problems[k], settled[k], tube, track, roomy, space, rows, limits[k], accuracy)
            again = False
            for i in range(first[k], first[k + 1]):
                if status[i] == NOT_CONVERGED or status[i] == INACCURATE:
                    again = True
            if not again:
                break
            if factor == 1:
                for i in range(first[k], first[k + 1]):
                    status[i] = PENDING

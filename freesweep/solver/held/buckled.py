"""The stable, antisymmetric state beside the straight cylinder: the source's "blocked deformation".

At the critical pressure a branch leaves the cylinder, whose first shape is a whole sine. It may begin toward lower
pressures: then it turns back at the least pressure of any buckled state, and from there on is stable. All of it is gone,
through its turning points, until it comes to the pressure asked for in a stable state.
"""

from math import pi, sin

import numpy as np

from ...jit import kernel
from ..free.fold import carry, locate
from ..free.meshes import take
from ..load import Load, by, loaded, under
from ..numerics import held, nested, newton
from ..numerics.bordered import FOLLOWED, LOST
from ..numerics.continuation import CHANGE, FIRST_STEP, advance, is_stable, last_alike, make_unit
from ..numerics.path import Path, load_at
from ..numerics.properties_along import at_point, fill
from ..physics import lagrangian
from ..stability import unstable_directions
from ..status import HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK
from . import ways
from .near_turn import pin
from .sought import FROM_REST, HELD_ROTATION, Found, failed, load_of, unsure
from .ways import EVERY, cylinder_multiplier, even_mesh, held_at

# of the sine, tried in turn: with fiber extension no cylinder is straight; steep fibers soon leave the sine
AMPLITUDES = (0.003, 0.01, 0.03, 0.1, 3e-4, 3e-5)
STEPS, TOLERANCE = 600, 1e-10
FARTHEST = 2.5  # times the larger of the pressure asked for and the critical one: a branch that far seldom comes back
DIRECTION = Load(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
BUCKLED = 1e-3  # |y - 1| from which a tube counts as swollen, or as thinned
PRESSURE_STEP = 0.005  # of it, where a front is too steep for steps along the branch


@kernel
def critical(cell, load, length):
    """The pressure at which y = 1 loses its stability to a whole sine; L_yy and L_vv are linear in it. NaN: never."""
    found = np.zeros(2)
    for k in range(2):
        now = under(load, 1.0 * k, load.f, 0.0)
        now = loaded(now, DIRECTION, cylinder_multiplier(cell, now, DIRECTION))
        _, _, _, L_yy, _, L_vv = lagrangian.density(1.0, 0.0, cell, now)
        found[k] = L_yy + L_vv * (2.0 * pi / length) ** 2
    p = -found[0] / (found[1] - found[0])
    return p if p > 0.0 else np.nan


@kernel
def is_buckled(y):
    """Whether a tube swells somewhere and thins somewhere."""
    return np.max(y) > 1.0 + BUCKLED and np.min(y) < 1.0 - BUCKLED


@kernel
def on_meshes(room, tube, path, pressure, accuracy, out):
    """The buckled state of the track on nested meshes; NOT_CONVERGED where it is none that is stable."""
    space, track, unit = room.space, room.track, path.held.unit
    n, load, wanted = len(track.x) - 1, loaded(path.origin, path.direction, pressure), path.held.first
    for i in range(n + 1):
        space.x[i], space.y[i] = track.x[i], track.y[i]
    status, unstable, doublings, _ = nested.solve(
        lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, space.x, space.y, tube, load,
        nested.HELD, unit, wanted, track.y[n + 1], 1, accuracy, space.fine, space.work, space.table, out,
    )  # fmt: skip
    good = status == newton.CONVERGED or status == nested.UNREACHED
    if not good or unstable > 0 or not is_buckled(space.y) or not space.y[n // 4] > 1.0:
        return unsure(NOT_CONVERGED, load)
    now = loaded(load, unit, out[0, nested.MULTIPLIER])
    _, rounding = unstable_directions(
        space.fine[0], space.fine[1], n << doublings, n, tube, now, unit, abs(wanted), space.work
    )
    out[1, nested.MULTIPLIER] += rounding
    out[0, nested.MULTIPLIER] *= unit.m
    out[1, nested.MULTIPLIER] *= unit.m
    return Found(OK if status == newton.CONVERGED else INACCURATE, 0, doublings, now, 1.0, True, FROM_REST)


@kernel
def by_pressure(room, tube, path, mu, pressure):
    """From the state in the track, which is stable and stays so, to a pressure in steps of it, on an even mesh: whether it
    came there.
    """
    track, work = room.track, room.space.work
    n, (course, edges, cells, _, _, places) = len(track.x) - 1, tube
    even_mesh(track.spare, places, edges)
    carry(track.x, track.y, track.spare, track.other)
    for i in range(n + 1):
        track.x[i], track.y[i] = track.spare[i], track.other[i]
    while True:
        load = loaded(path.origin, path.direction, mu)
        own = fill(course, edges, track.x, n, n, cells)
        status, unstable, track.y[n + 1], _ = held.solve_held(
            lagrangian.density, lagrangian.conjugate, track.x, track.y, n, False, own, load, path.held.unit, track.y[n + 1],
            path.held.first, TOLERANCE, newton.MAX_ITERATIONS, work,
        )  # fmt: skip
        if status != newton.CONVERGED or not is_buckled(track.y[: n + 1]):
            return False
        if mu == pressure:
            return unstable == 0
        now = load_at(path, track.y, n, mu)
        nested.regrade(lagrangian.density, lagrangian.integrands, track.x, track.y, n, tube, now, work)
        mu = min(pressure, mu + PRESSURE_STEP * pressure)


@kernel
def leave_cylinder(room, tube, path, critical_pressure, multiplier):
    """Stand on the branch beside the cylinder, as far as a small sine is: ``(status, pressure, the tangent's)``."""
    track, work = room.track, room.space.work
    course, edges, cells, _, _, _ = tube
    n, status, mu, tangent_mu = len(track.x) - 1, LOST, 0.0, 0.0
    quarter = n // 4 - (n // 4) % 2
    for amplitude in AMPLITUDES:
        ways.make_straight(track, tube, multiplier)
        for i in range(n + 1):
            track.y[i] += amplitude * sin(2.0 * pi * track.x[i] / track.x[n])
        own = fill(course, edges, track.x, n, n, cells)
        status, _, mu, tangent_mu = pin(track, n, own, path, quarter, track.y[quarter], critical_pressure, work)
        if status == FOLLOWED and track.y[n - quarter] < 1.0:
            break
    return status, mu, make_unit(track, n, mu, tangent_mu, path)


@kernel
def follow(room, tube, path, first, pressure, farthest, accuracy, out, least):
    """Along the branch from the state in the track, at ``first`` = (pressure, the tangent's), until it has a stable state at
    the ``pressure``, which a mesh moved to the branch may step over, too. ``least`` takes the lowest at which it turned, and
    its bound. There is none below that only. Above it a mesh that has none is too coarse: a front between the swollen part
    and the thin one feels its cells, which can keep it where nothing does.
    """
    track, space, here = room.track, room.space, first
    course, edges, cells, _, _, _ = tube
    n, step, lowest, nothing, before = len(track.x) - 1, FIRST_STEP * CHANGE, first[0], path.origin, first[0]
    for _ in range(STEPS):
        own = fill(course, edges, track.x, n, n, cells)
        status, _, mu, tangent_mu, made, step = advance(
            lagrangian.density, lagrangian.conjugate, track, n, own, path, here[0], here[1], step, space.work
        )
        if status != FOLLOWED:  # a front that is too steep for steps along the branch
            came = here[0] < pressure and by_pressure(room, tube, path, here[0], pressure)
            return on_meshes(room, tube, path, pressure, accuracy, out) if came else unsure(NOT_CONVERGED, nothing)
        if not 0.0 < mu < farthest:
            break
        if here[1] < 0.0 and not is_stable(0, tangent_mu, -1.0):  # the least pressure of this branch
            turn = last_alike(
                lagrangian.density, lagrangian.conjugate, track, n, own, path, here[0], here[1], made, -1.0, True, space.work
            )  # fmt: skip
            value, bound = locate(track, room.roomy, space, tube, path, here, turn, -1.0)
            if value < lowest:
                least[0], least[1], lowest = value, bound, value
            own = fill(course, edges, track.x, n, n, cells)
            advance(lagrangian.density, lagrangian.conjugate, track, n, own, path, here[0], here[1], made, space.work)
        if min(before, min(here[0], mu)) <= pressure <= max(before, max(here[0], mu)):
            x, y, tangent = track.x.copy(), track.y.copy(), track.tangent.copy()
            end = ways.land(room, tube, path, here, (mu, tangent_mu, made), pressure)
            if end.status == OK:
                found = on_meshes(room, tube, path, pressure, accuracy, out)
                if found.status != NOT_CONVERGED:
                    return found
            for i in range(len(track.y)):
                track.y[i], track.tangent[i] = y[i], tangent[i]
            for i in range(n + 1):
                track.x[i] = x[i]
        before, here = mu, take(track, tube, path, mu, tangent_mu, space.work)
    return failed(HELD_IMPOSSIBLE, nothing) if pressure < lowest else unsure(NOT_CONVERGED, nothing)


@kernel
def find_buckled(problem, walls, p, force, target, tube, accuracy, room, out, least):
    """The stable buckled state at pressure ``p``; arguments and what is returned as of :func:`.held_state.find`, but for
    ``least`` (2,): the least pressure at which the branch has a state, and its bound.
    """
    return _find_buckled(tube.course, problem, walls, p, force, target, tube, accuracy, room, out, least)


@kernel
def _find_buckled(course, problem, walls, p, force, target, tube, accuracy, room, out, least):
    load = load_of(problem, walls, p, force, HELD_ROTATION)
    if course.ndim > 4:  # nothing straight to buckle from
        return failed(HELD_IMPOSSIBLE, load)
    cell, places = at_point(course, 0, 0.0), tube.places
    least[0], least[1] = np.nan, np.nan
    p_c = critical(cell, load, places[len(places) - 1])
    if not p_c > 0.0 or not p_c + force > 0.0:
        return failed(HELD_IMPOSSIBLE, load)
    at_critical = cylinder_multiplier(cell, under(load, p_c, force, 0.0), DIRECTION)
    scale = max(p, abs(at_critical))
    unit = by(0.0, 0.0, scale)
    nothing, pressure = under(load, 0.0, force, 0.0), by(1.0, 0.0, 0.0)
    path = Path(nothing, pressure, 0.0, False, held_at(unit, target * scale, target * scale, EVERY))
    status, mu, tangent_mu = leave_cylinder(room, tube, path, p_c, at_critical / scale)
    if status != FOLLOWED:
        return unsure(NOT_CONVERGED, load)
    least[0], least[1] = min(mu, p_c), abs(mu - p_c)  # a branch that rises begins at the critical pressure
    return follow(room, tube, path, (mu, tangent_mu), p, FARTHEST * max(p, mu), accuracy, out, least)

"""What the end of a way gives: the state there on nested meshes, the one before a turn, or none; and how it stands."""

from ...jit import kernel
from ..free.fold import locate
from ..load import loaded
from ..numerics import error_bounds, nested, newton
from ..numerics.continuation import is_flat
from ..numerics.held import Target
from ..numerics.path import load_at
from ..numerics.properties_along import fill
from ..numerics.shapes import differ, extremes
from ..of_tube import of_tube
from ..stability import pushed, unstable_directions
from ..status import BEYOND_LIMIT, COMPRESSED, HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK
from . import near_turn, ways
from .sought import Found, valued
from .ways import EVERY, held_at

ROUNDED = 1e-12  # relative
ROUNDED_OFF, SHALLOWEST = 1e-9, 1e-6  # a neck's height that may be rounding, and its share of the body's that is none
NEAR = 0.05  # of the way behind its end: as far it is looked for a turn where no mesh holds the state


@kernel
def lower(room, tube, end, start, load, sought):
    """From the ``end`` of a way to the same state under the pressure of another load."""
    if start.p == load.p:
        return end
    return ways.go(room, tube, ways.falling(start, load, held_at(sought.unit, sought.wanted, sought.wanted, EVERY)))


@kernel
def settle(room, tube, end, sought, path, accuracy):
    """The state at the ``end`` of a way, or before its turn, on finer meshes."""
    load, track = sought.load, room.track
    if end.status == OK and sought.with_pressure.p != load.p:
        end = lower(room, tube, end, sought.with_pressure, load, sought)
        if end.status == NOT_CONVERGED and end.here[0] > 1.0 - NEAR:
            return Found(COMPRESSED, 0, 0, load, end.here[0], False, path)
    found = Found(end.status, 0, 0, load, end.here[0], False, path)
    if end.status == OK:
        found = on_meshes(room, tube, end, sought, path, accuracy)
        if found.status == NOT_CONVERGED:  # a turn just behind?
            end = ways.follow(room, tube, end.path, 1.0, end.here[1], 1.0 + NEAR)
    turned = end.status == BEYOND_LIMIT and end.path.held.any and end.ahead[2] > 0.0
    if turned and is_flat(end.ahead[0], end.ahead[1], end.path):
        n = len(track.x) - 1
        own = fill(tube.course, tube.edges, track.x, n, n, tube.cells)
        if pushed(track.y[: n + 1], own, load_at(end.path, track.y, n, end.here[0])):
            return Found(COMPRESSED, 0, 0, load, end.here[0], True, path)
        found = at_turn(room, tube, end, sought, path, accuracy)
    if valued(found.status) and not found.load.p + found.load.f > 0.0:  # at the clamped ends, where y = 1
        return Found(COMPRESSED, 0, 0, load, 1.0, True, path)
    return found


@kernel
def leads_to(path, sought):
    """Whether a path is the last one of its way."""
    first, wanted = path.held.first, sought.wanted
    missed, size = abs(first + path.held.change - wanted), max(abs(first), abs(wanted))
    pressure, p = path.origin.p + path.direction.p, sought.load.p
    return missed <= ROUNDED * size and abs(pressure - p) <= ROUNDED * max(path.origin.p, p)


@kernel
def at_turn(room, tube, end, sought, path, accuracy):
    """What is at the end of a way that turns back there: the state before the turn, if all meshes together have it."""
    status = BEYOND_LIMIT if sought.wanted == sought.natural else HELD_IMPOSSIBLE
    space, track, load = room.space, room.track, sought.load
    limit, bound = locate(room, tube, end.path, end.here, end.ahead, 1.0)
    if limit > 1.0 + bound and leads_to(end.path, sought):
        again, doublings, unstable = near_turn.before(track, space, tube, end, limit, accuracy)
        now = loaded(load, end.path.held.unit, space.out[0, error_bounds.MULTIPLIER])
        return Found(again if valued(again) else status, unstable, doublings, now, limit, False, path)
    return Found(status, 0, 0, load, limit if limit == limit else end.here[0], limit <= 1.0 + bound, path)


@kernel
def on_meshes(room, tube, end, sought, path, accuracy):
    """The track's state on finer meshes; NOT_CONVERGED where these have another or none."""
    space, track, load, unit = room.space, room.track, sought.load, sought.unit
    n = len(track.x) - 1
    for i in range(n + 1):
        space.x[i], space.y[i] = track.x[i], track.y[i]
    target = Target(unit, sought.wanted, True)
    status, unstable, doublings = nested.solve(of_tube(), space, tube, load, target, track.y[n + 1], 1, accuracy)
    if status == newton.CONVERGED or status == nested.UNREACHED:
        if not differ(extremes(track.y[: n + 1], tube.middle), extremes(space.y, tube.middle)):
            now = loaded(load, unit, space.out[0, error_bounds.MULTIPLIER])
            return Found(OK if status == newton.CONVERGED else INACCURATE, unstable, doublings, now, 1.0, False, path)
    own = fill(tube.course, tube.edges, track.x, n, n, tube.cells)
    gone = pushed(track.y[: n + 1], own, load_at(end.path, track.y, n, 1.0))
    return Found(COMPRESSED if gone else NOT_CONVERGED, 0, 0, load, 1.0, False, path)


@kernel
def shaped(y):
    """Whether half a tube has a neck, the other side of the end's radius than the middle; or is a wave, and surely without
    one.
    """
    outward = 1.0 if y[len(y) - 1] > 1.0 else -1.0
    body, neck = abs(y[len(y) - 1] - 1.0), 0.0
    for i in range(len(y)):
        neck = max(neck, outward * (1.0 - y[i]))
    return neck > ROUNDED_OFF and neck > SHALLOWEST * body, neck <= ROUNDED_OFF < body


@kernel
def finish(room, tube, sought, found):
    """The unstable directions of a state on the whole tube, and the load that holds it without its unit."""
    space, edges, out = room.space, tube.edges, room.space.out
    base = edges[len(edges) - 1]
    size = (2.0 if tube.half else 1.0) * max(abs(sought.wanted), abs(sought.natural))
    count = base << found.doublings
    x, y = space.fine[0], space.fine[1, : count + 1]
    necked, is_wave = shaped(y) if not sought.varies else (False, False)
    unstable, rounding = unstable_directions(
        x, space.fine[1], count, base, tube, found.load, sought.unit, size, is_wave, space.work
    )  # fmt: skip
    if necked:
        unstable = max(unstable, 1)  # of which a mesh may know nothing
    out[1, error_bounds.MULTIPLIER] += rounding
    out[0, error_bounds.MULTIPLIER] *= sought.scale
    out[1, error_bounds.MULTIPLIER] *= sought.scale
    return Found(found.status, unstable, found.doublings, found.load, found.reached, found.sure, found.path)

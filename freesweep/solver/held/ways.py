"""The ways to a held state, each a path from mu = 0 to 1 along which a branch is followed
(:mod:`..numerics.continuation`): loads rise
from rest while something is held, or nothing; what is held moves to its target; the pressure falls to the one asked for.
"""

from ...jit import kernel
from .. import guide
from ..free.meshes import stand
from ..free.way import HALVINGS, follow, rise, stopped
from ..load import NO_CHANGE, Load, by, loaded
from ..numerics import held
from ..numerics.bordered import FOLLOWED
from ..numerics.path import NOTHING, Held, Path
from ..numerics.properties_along import fill
from ..physics import lagrangian
from ..physics.uniform_tube import SMALL_STRAIN
from ..physics.wall import may_go_slack, with_bonded_fibers
from ..status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK

EVERY = 1 << 30  # unstable directions allowed: any number
LEAST_SHARE = 1e-6  # of the loads: all but none


@kernel
def at_rest(load):
    """No load on the same tube."""
    return Load(1.0, load.rubber, load.wall, 0.0, 0.0, 0.0, 1.0)


@kernel
def held_at(unit, first, last, allowed):
    """What is held, from ``first`` to ``last``."""
    return Held(unit, first, last - first, True, allowed)


@kernel
def rising(load, what):
    """Pressure, the other load and fiber extension - 1 rise in proportion."""
    direction = Load(load.gamma - 1.0, 0.0, 0.0, load.p, load.f, load.m, 0.0)
    return Path(at_rest(load), direction, 0.0, may_go_slack(load.wall), what)


@kernel
def moving(load, what):
    """What is held moves to its target."""
    return Path(load, NO_CHANGE, 1.0, may_go_slack(load.wall), what)


@kernel
def falling(start, load, what):
    """The pressure falls."""
    direction = by(load.p - start.p, 0.0, 0.0)
    return Path(start, direction, 1.0, may_go_slack(load.wall), what)


@kernel
def cylinder_multiplier(cell, load, direction):
    """The multiplier that makes y = 1 an equilibrium of a tube that is ``cell`` all along."""
    return -lagrangian.density(1.0, 0.0, cell, load)[1] / lagrangian.conjugate(1.0, 0.0, cell, load, direction)[1]


@kernel
def even_mesh(x, places, edges):
    """Equal cells within each segment."""
    for s in range(len(edges) - 1):
        a, b = edges[s], edges[s + 1]
        for i in range(a, b + 1):
            x[i] = places[s] + (places[s + 1] - places[s]) * (i - a) / (b - a)


@kernel
def make_straight(track, tube, multiplier):
    """The straight cylinder, on equal cells."""
    n = len(track.x) - 1
    even_mesh(track.x, tube.places, tube.edges)
    for i in range(n + 1):
        track.y[i] = 1.0
    track.y[n + 1] = multiplier


@kernel
def go(room, tube, path):
    """All of a path, from the state in the track."""
    status, negative, tangent_mu = stand(room.track, tube, path, 0.0, 1.0, 0, room.space.work)
    if status != FOLLOWED or negative > 0:
        return stopped(NOT_CONVERGED if status != FOLLOWED else BEYOND_LIMIT, path, 0.0, 1.0)
    return follow(room, tube, path, 0.0, tangent_mu, 1.0)


@kernel
def from_rest(room, tube, cell, load, what):
    """The state at ``load`` on the branch that begins without load while ``what`` is held stays. It begins at a share of the
    load so small that the wall's stiffness prevails: there it has one state only. Of loose fibers it is looked for from the
    cylinder that taut ones hold straight, too: in another one a family may be slack, far from what is held.
    """
    track, path, share = room.track, rising(load, what), 1.0
    for _ in range(HALVINGS):
        share *= 0.5
        now = loaded(path.origin, path.direction, share)
        for guess in range(2 if may_go_slack(load.wall) else 1):
            multiplier = cylinder_multiplier(cell, with_bonded_fibers(now) if guess == 0 else now, what.unit)
            make_straight(track, tube, multiplier)
            status, negative, tangent_mu = stand(track, tube, path, share, 1.0, 0, room.space.work)
            n, largest = len(track.x) - 1, 0.0
            for i in range(n + 1):
                largest = max(largest, abs(track.y[i] - 1.0))
            if status == FOLLOWED and negative == 0 and largest < SMALL_STRAIN and is_stiff(tube, path, share):
                return follow(room, tube, path, share, tangent_mu, 1.0)
    least = loaded(path.origin, path.direction, LEAST_SHARE)
    least = loaded(least, what.unit, cylinder_multiplier(cell, least, what.unit))
    gone = lagrangian.density(1.0, 0.0, cell, least)[0] <= 0.0  # the wall would be pushed from the first load on
    return stopped(COMPRESSED if gone else NOT_CONVERGED, path, 0.0, 1.0)


@kernel
def is_stiff(tube, path, mu):
    """Whether the wall keeps every place of the tube straight."""
    load = loaded(path.origin, path.direction, mu)
    for k in range(guide.PLACES):
        cell = guide.cell_along(tube, k / (guide.PLACES - 1))
        now = loaded(load, path.held.unit, cylinder_multiplier(cell, load, path.held.unit))
        if lagrangian.density(1.0, 0.0, cell, now)[3] >= 0.0:  # not a number: no twist
            return False
    return True


@kernel
def from_free(room, tube, load, unit, pull, target):
    """The state at ``load`` on the branch that begins with nothing held: the loads rise, and with them so much of the
    ``unit`` that holds, then the length or rotation found is changed to the ``target``.
    """
    track, path = room.track, rising(loaded(load, unit, pull), NOTHING)
    n = len(track.x) - 1
    course, edges, cells, _, _, _ = tube
    track.y[n + 1] = track.next_y[n + 1] = 0.0
    end = rise(room, tube, path)
    if end.status != OK:
        return end
    track.y[n + 1] = pull
    own, now = fill(course, edges, track.x, n, n, cells), loaded(load, unit, pull)
    first, _ = held.hold(lagrangian.conjugate, track.x, track.y, n, own, now, unit, room.space.work[8])
    return go(room, tube, moving(load, held_at(unit, first, target, EVERY)))

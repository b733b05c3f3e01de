"""A whole way: a branch followed to a share of it, whatever is held on it; and how each step of a branch goes on."""

from typing import NamedTuple

from ...jit import kernel
from .. import guide
from ..load import loaded
from ..numerics.bordered import FOLLOWED
from ..numerics.continuation import CHANGE, FIRST_STEP, advance, between, is_flat, is_stable, last_alike
from ..numerics.path import Path, load_at
from ..numerics.properties_along import fill
from ..numerics.shapes import differ, extremes
from ..of_tube import of_tube
from ..stability import pushed
from ..status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK
from .meshes import GRADINGS, stand, take

MOST_STEPS = 1000
HALVINGS = 80  # of the load, until it is small enough to begin with


class End(NamedTuple):
    """Where a way was left: OK at its end, BEYOND_LIMIT where it turns back or becomes unstable; (mu, the tangent's mu) of
    the state in the track, and (mu, the tangent's mu, step) of the last one ahead of it.
    """

    status: int
    path: Path
    here: tuple
    ahead: tuple


@kernel
def begin(room, tube, path):
    """The first state of a branch from rest, where the load is small enough to have one state only: ``(status, mu, the
    tangent's mu)``.
    """
    track, space, mu = room.track, room.space, 1.0
    for _ in range(HALVINGS):
        load = loaded(path.origin, path.direction, mu)
        if guide.near_rest(tube, load, space.u):
            guide.start(tube, space.u, load, track.x, track.y)
            status, negative, tangent_mu = stand(track, tube, path, mu, 1.0, GRADINGS, space.work)
            if status == FOLLOWED and negative == 0:
                return FOLLOWED, mu, tangent_mu
        mu *= 0.5
    return NOT_CONVERGED, mu, 0.0


@kernel
def go_on(track, tube, path, here, sense, step, work):
    """One step of a branch from the state ``here`` (mu, the tangent's mu): ``(status, what is ahead, step to try next)``. OK
    where that is stable; BEYOND_LIMIT where it is the last state that is, which lies ``here`` if no step leads round so
    sharp a fold; else the branch is lost.
    """
    course, edges, cells, _, _, _ = tube
    n = len(track.x) - 1
    own = fill(course, edges, track.x, n, n, cells)
    status, negative, mu, tangent_mu, made, step = advance(of_tube(), track, n, own, path, here, step, work)
    if status != FOLLOWED:
        gone = pushed(track.y[: n + 1], own, load_at(path, track.y, n, here[0]))
        for i in range(len(track.y)):
            track.next_y[i], track.next_tangent[i] = track.y[i], track.tangent[i]
        flat = is_flat(here[0], here[1], path)
        return (COMPRESSED if gone else BEYOND_LIMIT if flat else NOT_CONVERGED), (here[0], here[1], 0.0), step
    if is_stable(negative, tangent_mu, sense):
        return OK, (mu, tangent_mu, made), step
    return BEYOND_LIMIT, last_alike(of_tube(), track, n, own, path, here, made, sense, True, work), step


@kernel
def stopped(status, path, mu, tangent_mu):
    """The end of a way at the state in the track."""
    return End(status, path, (mu, tangent_mu), (mu, tangent_mu, 0.0))


@kernel
def land(room, tube, path, here, ahead, until):
    """Stand at ``until``, on the step that leads beyond it."""
    track = room.track
    n, guess = len(track.x) - 1, room.space.curve[0, : len(track.y)]
    between(track, n, here[0], here[1], ahead[0], ahead[1], ahead[2], until, guess)
    for i in range(len(track.y)):
        track.y[i] = guess[i]
    status, _, tangent_mu = stand(track, tube, path, until, 1.0, 0, room.space.work)
    if status != FOLLOWED or differ(extremes(guess[: n + 1], tube.middle), extremes(track.y[: n + 1], tube.middle)):
        return stopped(NOT_CONVERGED, path, here[0], here[1])
    return stopped(OK, path, until, tangent_mu)


@kernel
def follow(room, tube, path, mu, tangent_mu, until):
    """Follow the branch from the state in the track, at ``mu``, to the state at ``until``."""
    track, work, here, step = room.track, room.space.work, (mu, tangent_mu), FIRST_STEP * CHANGE
    for _ in range(MOST_STEPS):
        status, ahead, step = go_on(track, tube, path, here, 1.0, step, work)
        if ahead[0] >= until:
            return land(room, tube, path, here, ahead, until)
        if status != OK:
            return End(status, path, here, ahead)
        here = take(track, tube, path, ahead[0], ahead[1], work)
    return stopped(NOT_CONVERGED, path, here[0], here[1])


@kernel
def rise(room, tube, path):
    """All of a path from rest, on which nothing is held."""
    status, mu, tangent_mu = begin(room, tube, path)
    if status != FOLLOWED:
        return stopped(NOT_CONVERGED, path, 0.0, 1.0)
    return follow(room, tube, path, mu, tangent_mu, 1.0) if mu < 1.0 else stopped(OK, path, mu, tangent_mu)

"""The branch of a free tube: followed through the pressures asked for, to the fold where it ends."""

import numpy as np

from ...jit import kernel
from .. import guide
from ..load import loaded
from ..numerics.bordered import FOLLOWED
from ..numerics.continuation import CHANGE, FIRST_STEP, advance, between, is_flat, is_stable, last_alike
from ..numerics.properties_along import fill
from ..of_tube import of_tube
from ..stability import pushed
from ..status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK, PENDING
from .fold import locate
from .meshes import GRADINGS, stand, take
from .one_state import near_fold, plain, record

MOST_STEPS = 600
SMALL_STRAIN = 0.02  # of all uniform stretches along the tube: where a branch begins, the wall has one state only
HALVINGS = 80  # of the load, until that holds


@kernel
def begin(room, tube, path):
    """The first state of a branch from rest, where the load is small enough to have one state only: ``(status, mu, the
    tangent's mu)``.
    """
    track, space, mu = room.track, room.space, 1.0
    for _ in range(HALVINGS):
        load, largest = loaded(path.origin, path.direction, mu), 0.0
        for k in range(len(space.u)):
            space.u[k] = 1.0
        reached = guide.follow(tube, space.u, path.origin, load, space.ahead)
        for k in range(len(space.u)):
            largest = max(largest, abs(space.ahead[k] - 1.0))
        if reached == 1.0 and largest < SMALL_STRAIN:
            guide.start(tube, space.ahead, load, track.x, track.y)
            status, negative, tangent_mu = stand(track, tube, path, mu, 1.0, GRADINGS, space.work)
            if status == FOLLOWED and negative == 0:
                return FOLLOWED, mu, tangent_mu
        mu *= 0.5
    return NOT_CONVERGED, mu, 0.0


@kernel
def guess(room, here, ahead, pressure):
    """A guess of the state at ``pressure`` on a step from ``here`` to what is ``ahead``, each (mu, the tangent's mu), the
    step's length beside.
    """
    track, space, n = room.track, room.space, len(room.track.x) - 1
    for i in range(n + 1):
        space.x[i] = track.x[i]
    between(track, n, here[0], here[1], ahead[0], ahead[1], ahead[2], pressure, space.y)


@kernel
def answer(room, tube, path, first, here, ahead, rows, accuracy):
    """Solve the rows that wait for a pressure on the step from ``here`` to what is ``ahead``; the step before ended at the
    load ``first``, on another mesh.
    """
    low, high = min(min(first, here[0]), ahead[0]), max(max(first, here[0]), ahead[0])
    for i in range(len(rows.pressures)):
        p = rows.pressures[i]
        if rows.status[i] == PENDING and low <= p <= high:
            guess(room, here, ahead, p)
            load = loaded(path.origin, path.direction, p)
            status, doublings = plain(room.space, tube, load, accuracy)
            record(room.space, tube, load, status, doublings, accuracy, rows, i)


@kernel
def end_at_fold(room, tube, path, first, here, ahead, fold, rows, limit, accuracy):
    """What rows still wait for, where the branch of a rising pressure ends on a step, at the ``fold`` (load, bound): states
    before it are solved, the rest lie beyond; they wait on where the fold is not known.
    """
    value, bound = fold
    for i in range(len(rows.pressures)):
        p = rows.pressures[i]
        if rows.status[i] != PENDING or p < first or p == np.inf or (value != value and p >= ahead[0]):
            continue
        load, status, doublings = loaded(path.origin, path.direction, p), NOT_CONVERGED, 0
        if p >= value - bound:
            rows.status[i], limit[0], limit[1] = BEYOND_LIMIT, value, bound
            continue
        if p < ahead[0]:
            guess(room, here, ahead, p)
            status, doublings = plain(room.space, tube, load, accuracy)
        if status == NOT_CONVERGED and value == value:
            status, doublings = near_fold(room, tube, path, p, here[0], value, accuracy)
        record(room.space, tube, load, status, doublings, accuracy, rows, i)


@kernel
def follow(room, tube, path, here, far, rows, limit, accuracy):
    """Follow the branch from the state ``here``, in the room's track, to the load ``far``, and solve the ``rows`` that wait
    on the way.

    Returns ``(status, here, ahead)``: OK where the last step, which is not taken yet, from ``here`` to what is ``ahead``,
    passes ``far``.
    """
    track, work, n = room.track, room.space.work, len(room.track.x) - 1
    course, edges, cells, _, _, _ = tube
    first, sense, step = here[0], (1.0 if here[1] > 0.0 else -1.0), FIRST_STEP * CHANGE
    for _ in range(MOST_STEPS):
        own = fill(course, edges, track.x, n, n, cells)
        status, negative, mu, tangent_mu, made, step = advance(of_tube(), track, n, own, path, here, step, work)
        ahead = (mu, tangent_mu, made)
        lost = status != FOLLOWED
        if lost and not is_flat(here[0], here[1], path):
            gone = pushed(track.y, own, loaded(path.origin, path.direction, here[0]))
            return (COMPRESSED if gone else NOT_CONVERGED), here, ahead
        if lost or not is_stable(negative, tangent_mu, sense):
            if lost:  # no step leads round so sharp a fold: it lies here
                ahead = (here[0], here[1], 0.0)
                for i in range(len(track.y)):
                    track.next_y[i], track.next_tangent[i] = track.y[i], track.tangent[i]
            else:
                ahead = last_alike(of_tube(), track, n, own, path, here, made, sense, True, work)
            passed = (ahead[0] - far) * sense >= 0.0
            if sense < 0.0 or (passed and len(rows.pressures) == 0):  # a limit pressure is one of rising pressures
                answer(room, tube, path, first, here, ahead, rows, accuracy)
                return (OK if passed else BEYOND_LIMIT), here, ahead
            fold = locate(room, tube, path, here, ahead, sense)
            end_at_fold(room, tube, path, first, here, ahead, fold, rows, limit, accuracy)
            return (OK if passed else BEYOND_LIMIT if fold[0] == fold[0] else NOT_CONVERGED), here, ahead
        answer(room, tube, path, first, here, ahead, rows, accuracy)
        if (mu - far) * sense >= 0.0:
            return OK, here, ahead
        first, here = mu, take(track, tube, path, mu, tangent_mu, work)
    return NOT_CONVERGED, here, (here[0], here[1], 0.0)

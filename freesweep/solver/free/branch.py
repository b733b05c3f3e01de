"""The branch of a free tube: followed through the pressures asked for, to the fold where it ends."""

import numpy as np

from ...jit import kernel
from ..load import loaded
from ..numerics.continuation import CHANGE, FIRST_STEP, between
from ..status import BEYOND_LIMIT, NOT_CONVERGED, OK, PENDING
from .fold import locate
from .meshes import take
from .one_state import near_fold, plain, record
from .way import MOST_STEPS, go_on


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
    on the way. OK where a step passes ``far``.
    """
    track, work = room.track, room.space.work
    first, sense, step = here[0], (1.0 if here[1] > 0.0 else -1.0), FIRST_STEP * CHANGE
    for _ in range(MOST_STEPS):
        status, ahead, step = go_on(track, tube, path, here, sense, step, work)
        if status != OK and status != BEYOND_LIMIT:
            return status
        passed = (ahead[0] - far) * sense >= 0.0
        if status == BEYOND_LIMIT:
            fold = locate(room, tube, path, here, ahead, sense)
            if sense > 0.0:  # a limit pressure is one of rising pressures
                end_at_fold(room, tube, path, first, here, ahead, fold, rows, limit, accuracy)
            else:
                answer(room, tube, path, first, here, ahead, rows, accuracy)
            return OK if passed else BEYOND_LIMIT if fold[0] == fold[0] else NOT_CONVERGED
        answer(room, tube, path, first, here, ahead, rows, accuracy)
        if passed:
            return OK
        first, here = ahead[0], take(track, tube, path, ahead[0], ahead[1], work)
    return NOT_CONVERGED

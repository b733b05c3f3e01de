"""Blocked force and torque of many problems at once, for sweeps."""

import numpy as np

from ...jit import entry_point
from .. import guide
from ..numerics import nested
from ..numerics.properties_along import Tube, of_problems, seat, turns
from ..physics import lagrangian
from ..problem import FORCE, GAMMA, LENGTH, TORQUE, wall_of
from ..status import HELD_IMPOSSIBLE, INACCURATE, INVALID, OK, PENDING
from .held_states import cells_for, find_on_some_mesh
from .sought import HELD_LENGTH
from .ways import make_room


@entry_point
def block_many(
    problems, walls, targets, kind, first, pressures, course, edges, places, accuracy, values, bounds, status, stable
):  # fmt: skip
    """The force that holds a length (``kind`` HELD_LENGTH), or the torque that holds a rotation, of rows of problems.

    ``problems``, ``first``, ``pressures``, ``course``, ``edges``, ``places`` are those of
    :func:`..free.free_states.follow_many`; ``targets`` (k,) the deformed lengths in radii or the rotations in radians,
    of the whole tube. A problem keeps its torque while its length is held, its force while its rotation is. At zero
    pressure and no load the undeformed state is at rest. Rows whose status is not PENDING are passed over.
    """
    base = edges[len(edges) - 1]
    varying = course.shape[0] > 0
    room, cells = make_room(base, not varying, varying), cells_for(base, varying, course)
    out = np.zeros((4, nested.OUTPUTS))
    own_course = course if varying else of_problems(course)
    own_places = places.copy() if varying else np.zeros(2)
    total = own_places[len(own_places) - 1]
    middle = edges[np.argmin(np.abs(own_places - 0.5 * total))] if varying else base
    for k in range(len(problems)):
        if not varying:
            own_places[1] = 0.5 * problems[k, LENGTH]
            seat(own_course, problems[k])
        tube = Tube(own_course, edges, cells, not varying, middle, own_places)
        clamped = 1.0
        for end in range(2):
            cell = guide.cell_along(tube, 1.0 * end)
            clamped = min(clamped, lagrangian.clamped(cell, problems[k, GAMMA], wall_of(problems[k], walls)))
        rotates = kind == HELD_LENGTH or turns(own_course)
        other = problems[k, TORQUE] if kind == HELD_LENGTH else problems[k, FORCE]
        undeformed = targets[k] == (problems[k, LENGTH] if kind == HELD_LENGTH else 0.0)
        for row in range(first[k], first[k + 1]):
            if status[row] != PENDING:
                continue
            p = pressures[row]
            values[row], bounds[row], status[row], stable[row] = np.nan, np.nan, HELD_IMPOSSIBLE, 0
            if not clamped > 0.0:
                status[row] = INVALID
            elif p == 0.0 and other == 0.0 and undeformed:
                status[row], values[row], bounds[row], stable[row] = OK, 0.0, 0.0, 1
            elif rotates:
                target = targets[k] if varying else 0.5 * targets[k]
                found, _, _ = find_on_some_mesh(problems[k], walls, p, other, target, kind, tube, accuracy, room, out)
                status[row] = found.status
                if found.status == OK or found.status == INACCURATE:
                    values[row], bounds[row] = out[0, nested.MULTIPLIER], out[1, nested.MULTIPLIER]
                    stable[row] = 1 if found.unstable == 0 else 0

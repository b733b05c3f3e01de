"""Blocked force and torque of many problems at once, for sweeps."""

import numpy as np

from ..jit import entry_point
from . import guide, lagrangian, nested
from .branch import FORCE, GAMMA, LENGTH, TORQUE, H
from .hold import HELD_LENGTH, HELD_ROTATION, find
from .status import HELD_IMPOSSIBLE, INACCURATE, INVALID, OK


@entry_point
def block_many(problems, first, pressures, base, accuracy, values, bounds, status, stable):
    """Blocked force (column 0) and torque (column 1) of rows of problems, as :func:`branch.walk_many` takes them.

    Force: the undeformed length is held under the problem's torque. Torque: no rotation is held under its force. Rows of
    infinite pressure are passed over; at zero pressure nothing has to be held.
    """
    size = (base << nested.MAX_DOUBLINGS) + 2
    edges, places, course = np.array([0, base]), np.zeros(2), np.zeros((1, 1, 3, 4))
    space = (
        np.zeros((5, size)), np.zeros((13, 2 * size)), np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS)),
        np.zeros((5, size)), np.zeros((2, base + 1)), np.zeros((3, 2 * size)),
    )  # fmt: skip
    out = np.zeros((4, nested.OUTPUTS))
    cells = np.zeros((1, 3))
    for k in range(len(problems)):
        half = 0.5 * problems[k, LENGTH]
        places[1] = half
        for i in range(3):
            course[0, 0, i, 0] = problems[k, i]
        rest = (problems[k, GAMMA], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        clamped = (
            1.0 + lagrangian.kinematics(1.0, guide.cell_along((course, edges, cells, True, base, places), 0.0), rest)[3]
        )
        for row in range(first[k], first[k + 1]):
            for kind in range(2):
                values[row, kind], bounds[row, kind] = np.nan, np.nan
                status[row, kind], stable[row, kind] = HELD_IMPOSSIBLE, 0
                p = pressures[row]
                other = problems[k, TORQUE] if kind == HELD_LENGTH else problems[k, FORCE]
                if not clamped > 0.0:
                    status[row, kind] = INVALID
                elif p == 0.0 and other == 0.0:
                    values[row, kind], bounds[row, kind], status[row, kind], stable[row, kind] = 0.0, 0.0, OK, 1
                elif p < np.inf and not (kind == HELD_ROTATION and problems[k, H] == 0.0):
                    tube = (course.copy(), edges, cells, True, base, places)
                    target = half if kind == HELD_LENGTH else 0.0
                    found, unstable, _, _, _ = find(
                        problems[k], p, other, target, kind, False, course, tube, accuracy, space, out
                    )
                    status[row, kind] = found
                    if found == OK or found == INACCURATE:
                        values[row, kind], bounds[row, kind] = out[0, nested.MULTIPLIER], out[1, nested.MULTIPLIER]
                        stable[row, kind] = 1 if unstable == 0 else 0

"""Many designs at once: vectors of designs go the quick way, the scalar walk goes on where that ends."""

from typing import NamedTuple

import numpy as np
from numba import config

from ..interpret import at_once
from .branch import MOONEY_RIVLIN, SECOND, THIRD, YEOH, walk_many
from .profile import FIELDS
from .status import PENDING

OUTPUTS = 5  # length, volume, twist, energy of half the tube, stretch in the middle
NOTHING = np.empty(0)


class Walks(NamedTuple):
    """Equilibria of many designs: rows of states, but ``limits`` (problems, 2); see :func:`branch.walk`."""

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    limits: np.ndarray
    profiles: np.ndarray


def uniform(cells):
    """``(course, edges, places)`` of tubes that are the same all along, on a base mesh of ``cells``."""
    return np.empty((0, 1, 3, 4)), np.array([0, cells]), np.zeros(2)


def walk_all(problems, first, pressures, tube, accuracy, stations=NOTHING, lanes=True, soon=False) -> Walks:
    """Walk each problem along its pressures; arguments as of :func:`branch.walk_many`, ``tube`` its (course, edges, places).

    Vectors of designs serve where tubes do not vary. Their numbers do not depend on which
    designs share a vector; those of the scalar kernels alone (``lanes=False``) differ by less than the bounds.
    ``soon``: a few states need not wait for the compiler (:mod:`freesweep.interpret`).
    """
    uniform_tubes, count, base = len(tube[0]) == 0, len(pressures), int(tube[1][-1])
    found = Walks(
        np.full((count, OUTPUTS), np.nan), np.full((count, OUTPUTS), np.nan), np.full(count, PENDING, np.int64),
        np.zeros(count, np.int64), np.full((len(problems), 2), np.nan), np.full((count, FIELDS, len(stations)), np.nan),
    )  # fmt: skip
    scalar = (problems, first, pressures, *tube, accuracy, *found[:5], stations, found.profiles)
    if lanes and uniform_tubes and not config.DISABLE_JIT:
        from .lanes.walk import carry_lanes, solve_lanes

        if soon and at_once(count, solve_lanes, walk_many, *scalar):
            return found
        # what shares a vector should need much the same work: as many pressures, as steep ends
        steps, yeoh = np.diff(first), np.any(problems[:, [SECOND, THIRD]] != 0.0, axis=1)
        owners, order = np.repeat(np.arange(len(problems)), steps), np.argsort(steps, kind="stable")
        stretches, cosines = np.full(count, np.nan), np.full(count, np.nan)
        for constants, some in ((MOONEY_RIVLIN, ~yeoh), (YEOH, yeoh)):
            if not np.any(some):
                continue
            carry_lanes(problems, first, pressures, order[some[order]], constants, *found[:3], stretches, cosines)
            rows = np.flatnonzero(some[owners] & (found.status == PENDING) & np.isfinite(stretches))
            alike = np.argsort(_steepness(cosines[rows]), kind="stable")
            solve_lanes(
                problems, owners, pressures, stretches, rows[alike], constants, base, accuracy, *found[:4], stations,
                found.profiles,
            )  # fmt: skip
        if not np.any(found.status == PENDING):
            return found
    if not (soon and at_once(np.count_nonzero(found.status == PENDING), walk_many, walk_many, *scalar)):
        walk_many(*scalar)
    return found


def _steepness(cosines):
    """Short integers, which are sorted in no time; finer where the ends are steep."""
    return (np.sqrt(np.fmin(np.fmax(cosines, 0.0), 1.0)) * np.iinfo(np.uint16).max).astype(np.uint16)

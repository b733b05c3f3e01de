"""Derivatives of many free states of physical tubes that are the same all along, in vectors."""

import numpy as np
from numba import config

from .batch import walk_by_vectors
from .by_middle.many import PIECES
from .problem import (
    AREA,
    FORCE,
    GAMMA,
    INNER,
    LENGTH,
    MOONEY_RIVLIN,
    PHYSICAL,
    RATIO,
    SECOND,
    THIRD,
    THREADS,
    TORQUE,
    YEOH,
    D,
    H,
)

OUTPUTS, NUMBERS = 5, 12  # as :mod:`.lanes.responses` has them
CELLS = 24  # of a base mesh, which physical tubes do not need
LITTLE, TURN = 1e-2, 0.5  # of the work of the loads, and of half a tube: what energy and twist are measured by at least
SURE = 1e-8  # accuracy of states that are not known


def differentiate(problems, pressures, changes, accuracy, middles=None, limp=None):
    """Values and bounds (n, 1 + directions, 5) as of :func:`.slopes.differentiate`, of physical ``problems`` (n, 13), whose
    ``changes`` are (n, directions, 14).

    ``middles`` (n,): stretches of the middle, of states that are known; ``limp`` (n,): where some family of these goes slack
    along a part. Of others that state is taken that vectors find.
    """
    count, directions = changes.shape[:2]
    values, bounds = (np.full((count, directions + 1, OUTPUTS), np.nan) for _ in range(2))
    if count == 0 or config.DISABLE_JIT:
        return values, bounds
    if middles is None:
        found = walk_by_vectors(problems, np.arange(count + 1), pressures, CELLS, SURE).values
        middles, shares = np.ascontiguousarray(found[:, OUTPUTS - 1]), found[:, OUTPUTS : OUTPUTS + 2]
        limp = np.any((shares > 0.0) & (shares < 1.0), axis=1)
    limp = np.ones(count, bool) if limp is None else limp
    along = directions_of(changes)
    left = np.isfinite(middles) & ((pressures > 0.0) | np.any(problems[:, [FORCE, TORQUE]] != 0.0, axis=1))
    for pieces in PIECES:
        rows = np.flatnonzero(left)
        if len(rows) == 0:
            break
        told, doubts = answers(problems, pressures, middles, limp, rows, pieces)
        values[rows, 0], bounds[rows, 0] = told[rows, :, 0], doubts[rows, :, 0]
        values[rows, 1:] = np.einsum("nok,ndk->ndo", told[rows, :, 1:], along[rows])
        bounds[rows, 1:] = np.einsum("nok,ndk->ndo", doubts[rows, :, 1:], np.abs(along[rows]))
        scaled = bounds[rows] / np.maximum(np.abs(values[rows]), scales(problems, pressures, values[:, 0])[rows, None])
        left[rows] = ~(np.max(scaled, axis=(1, 2)) <= accuracy)
    values[left], bounds[left] = np.nan, np.nan
    return values, bounds


def answers(problems, pressures, middles, limp, rows, pieces):
    """Values and bounds (n, 5, 1 + numbers + 1) of :func:`.lanes.responses.differentiate_physical`, of some ``rows``."""
    from .lanes import second
    from .lanes.pack import count_layers
    from .lanes.responses import TOLD, differentiate_physical

    values, bounds = (np.full((len(problems), OUTPUTS, TOLD), np.nan) for _ in range(2))
    rows = rows[np.lexsort((middles[rows], limp[rows]))]  # what shares a vector should need much the same work
    yeoh, count = np.any(problems[:, [SECOND, THIRD]] != 0.0, axis=1), np.empty(len(problems), np.int64)
    count_layers(problems, PHYSICAL, count)
    kinds = np.column_stack([yeoh, count, problems[:, THREADS]])[rows]
    for kind in np.unique(kinds, axis=0):
        own, absent = rows[np.all(kinds == kind, axis=1)], () if kind[0] else (second.SECOND, second.THIRD)
        used = np.array([k for k in range(NUMBERS) if k not in absent])
        differentiate_physical(
            problems, pressures, middles, limp, own, YEOH if kind[0] else MOONEY_RIVLIN, int(kind[1]), used, pieces, values,
            bounds,
        )  # fmt: skip
    return values, bounds


def directions_of(changes):
    """What the numbers of :mod:`.lanes.second`, and the length of the half, change by: (n, directions, numbers + 1)."""
    by_column = (GAMMA, AREA, INNER, RATIO, SECOND, THIRD, FORCE, changes.shape[-1] - 1, TORQUE)
    still = np.zeros(changes.shape[:2])
    return np.stack(
        [
            changes[..., H] + changes[..., D], changes[..., H] - changes[..., D],
            *(changes[..., k] for k in by_column), still, 0.5 * changes[..., LENGTH],
        ],
        axis=-1,
    )  # fmt: skip


def scales(problems, pressures, outputs):
    """What the ``outputs`` (n, 5) are measured by: lengths by the half's, volumes and energies by themselves."""
    pressures = np.where(np.isinf(pressures), 1.0, pressures)
    work = np.abs(pressures * outputs[:, 1]) + np.abs(problems[:, FORCE] * outputs[:, 0])
    work += np.abs(problems[:, TORQUE] * outputs[:, 2])
    return np.column_stack([
        0.5 * problems[:, LENGTH], outputs[:, 1], np.full(len(problems), TURN), LITTLE * work, np.ones(len(problems))
    ])  # fmt: skip

"""Derivatives of many free states of tubes that are the same all along, in vectors."""

import numpy as np
from numba import config

from .load_path import is_loaded, legs
from .problem import LENGTH, MOONEY_RIVLIN, PHYSICAL, PROBLEM_SIZE, SECOND, THIRD, YEOH, wall_columns
from .slopes_physical import differentiate as differentiate_physical

BASE = 24  # cells of the base mesh, as of a sweep's
OUTPUTS = 5


def differentiate(problems, pressures, changes, accuracy, middles=None, limp=None):
    """Values and bounds (n, 1 + directions, 5) of the outputs of ``problems`` (n, columns), each under one of the
    ``pressures``, and of their derivatives along directions: ``changes`` (n, directions, columns + 1) are what the problem's
    columns and the pressure change by.

    NaN where vectors have no answer. ``accuracy`` is that of derivatives, relative or by the size of the output; what is
    known of physical tubes' states are ``middles`` and ``limp`` (:func:`.slopes_physical.differentiate`).
    """
    if wall_columns(problems) == PHYSICAL:
        return differentiate_physical(problems, pressures, changes, accuracy, middles, limp)
    count, directions = changes.shape[:2]
    values, bounds = (np.full((count, directions + 1, OUTPUTS), np.nan) for _ in range(2))
    if count == 0 or config.DISABLE_JIT:
        return values, bounds
    from .lanes.pack import COLUMNS, PRESSURE
    from .lanes.slopes import differentiate_lanes

    seats = np.zeros((count, directions, COLUMNS))
    seats[..., :PROBLEM_SIZE], seats[..., PRESSURE] = changes[..., :PROBLEM_SIZE], changes[..., PROBLEM_SIZE]
    seats[..., LENGTH] *= 0.5  # half of a tube is solved
    yeoh = np.any(problems[:, [SECOND, THIRD]] != 0.0, axis=1)
    for constants, some in ((MOONEY_RIVLIN, ~yeoh), (YEOH, yeoh)):
        stretches, cosines = uniform_stretches(problems, pressures, constants, np.flatnonzero(some))
        rows = np.flatnonzero(some)  # one whose stretch is not known may be a straight cylinder
        order = rows[np.argsort(cosines[rows], kind="stable")]  # what shares a vector should need much the same work
        if len(order):
            differentiate_lanes(problems, pressures, stretches, order, seats, constants, BASE, accuracy, values, bounds)
    return values, bounds


def uniform_stretches(problems, pressures, constants, some):
    """The stretch of the uniform tube of each problem, and its end's cosine, (n,): NaN but in rows ``some``, and where no
    quick way leads to it.
    """
    from .lanes.free import carry_lanes

    count = len(problems)
    stretches, cosines = np.full(count, np.nan), np.full(count, np.nan)
    own = problems[some]
    first, asked, rows = np.arange(len(some) + 1), pressures[some], np.arange(len(some))
    if np.any(is_loaded(own)):
        way = legs(own, first, asked)
        own, first, asked, rows = own[way.owners], way.first, way.pressures, way.rows
    found = np.full((2, len(asked)), np.nan)
    nothing = np.empty((len(asked), OUTPUTS)), np.empty((len(asked), OUTPUTS)), np.empty(len(asked), np.int64)
    carry_lanes(own, first, asked, np.arange(len(own)), constants, *nothing, *found)
    wanted = rows >= 0
    stretches[some[rows[wanted]]], cosines[some[rows[wanted]]] = found[:, wanted]
    return stretches, cosines

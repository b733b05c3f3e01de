"""Derivatives of many free states of tubes that are the same all along, in vectors."""

import numpy as np
from numba import config

from .along import places
from .batch import OUTPUTS, kinds_of, walk_by_vectors
from .problem import FORCE, INNER, MOONEY_RIVLIN, SOURCE, TORQUE, wall_columns

FINENESS, SHARP = (1, 2, 4, 8, 16, 32), 1e-5  # pieces of parts; a bound that is taken where no more pieces are tried
ONE = 1  # layer
MENDED = 0.5  # of a bound: what twice as many pieces leave more of is no pieces' fault
RESULTS = OUTPUTS + len(places.NUMBERS)
SURE = 1e-8  # accuracy of states that are not known


def differentiate(problems, pressures, changes, accuracy, middles=None, limp=None, surface=None):
    """Values and bounds (n, 1 + directions, RESULTS) of the outputs and, behind them, the numbers of :mod:`.along.places`,
    of ``problems`` (n, columns), each under one of the ``pressures``, and of their derivatives along directions: ``changes``
    (n, directions, columns + 1) are what the problem's columns and the pressure change by.

    NaN where vectors have no answer. ``accuracy`` is that of derivatives, relative or by the size of the output.
    ``middles`` (n,): stretches of the middle, of states that are known; ``limp`` (n,): where some family of these goes slack
    along a part. Of others that state is taken that vectors find. ``surface``: squared radii of the
    walls' inner surfaces (n,), which membranes' columns do not tell, and what they change by (n, directions); else those are
    the fibers'.
    """
    count, directions = changes.shape[:2]
    values, bounds = (np.full((count, directions + 1, RESULTS), np.nan) for _ in range(2))
    if count == 0 or config.DISABLE_JIT:
        return values, bounds
    if middles is None:
        found = walk_by_vectors(problems, np.arange(count + 1), pressures, SURE).values
        middles, shares = np.ascontiguousarray(found[:, OUTPUTS - 1]), found[:, OUTPUTS : OUTPUTS + 2]
        limp = np.any((shares > 0.0) & (shares < 1.0), axis=1)
    limp = np.ones(count, bool) if limp is None else limp
    if wall_columns(problems) == SOURCE:
        problems, changes = as_physical(problems), as_physical(changes, problems.shape[1])
    inner = np.where(problems[:, INNER] > 0.0, problems[:, INNER], 1.0)
    if surface is not None:
        inner, changes = np.ascontiguousarray(surface[0]), changes.copy()
        changes[..., INNER] = surface[1]
    loaded = (pressures > 0.0) | (problems[:, FORCE] != 0.0) | (problems[:, TORQUE] != 0.0)
    left = np.flatnonzero(np.isfinite(middles) & loaded)
    before = np.full(len(left), np.inf)
    for pieces in FINENESS:
        enough = accuracy if pieces < FINENESS[-1] else max(accuracy, SHARP)
        known = middles[left], inner[left], limp[left]
        found = along(problems[left], pressures[left], known, changes[left], pieces)
        met = (found[2] <= enough) | ((found[2] > MENDED * before) & (found[2] <= SHARP))
        values[left[met]], bounds[left[met]] = found[0][met], found[1][met]
        left, before = left[~met], found[2][~met]
        if len(left) == 0:
            break
    return values, bounds


def as_physical(columns, at=None):
    """The source's tubes as physical ones: their wall has no inside, and both families are bonded. Columns behind those
    of a problem come behind these, too.
    """
    at = columns.shape[-1] if at is None else at
    none = np.zeros((*columns.shape[:-1], 2))
    return np.concatenate([columns[..., :at], none, columns[..., at:]], axis=-1)


def along(problems, pressures, known, changes, pieces):
    """Values and bounds as of :func:`differentiate`, of physical ``problems`` of which middles, inner surfaces, and which
    are limp, are ``known``, and the largest of these, scaled (n,); each part of a tube is summed in so many ``pieces``.
    """
    from .lanes.chain import chain

    told, doubts = answers(problems, pressures, *known, pieces)
    shape = len(problems), changes.shape[1] + 1, RESULTS
    values, bounds, missed = np.empty(shape), np.empty(shape), np.empty(len(problems))
    chain(problems, pressures, changes, told, doubts, values, bounds, missed)
    return values, bounds, missed


def answers(problems, pressures, middles, inner, limp, pieces):
    """Values and bounds (n, 11, 1 + numbers + 1) of :func:`.lanes.responses.differentiate_lanes`."""
    from .lanes import second
    from .lanes.responses import differentiate_lanes
    from .lanes.told import TOLD

    told, known = np.zeros((2, len(problems), RESULTS, TOLD)), np.array([middles, inner])
    order = np.lexsort((middles, limp))  # what shares a vector should need much the same work
    for _, _, (constants, layers), some in kinds_of(problems):
        absent = (second.SECOND, second.THIRD) if constants == MOONEY_RIVLIN else ()
        absent += (second.INNER,) if layers == ONE else ()  # a membrane has no inside
        used = np.array([k for k in range(second.NUMBERS) if k not in absent])
        given = problems, pressures, known, limp, order[some[order]], constants, layers
        differentiate_lanes(*given, used, pieces, told)
    return told[0], told[1]

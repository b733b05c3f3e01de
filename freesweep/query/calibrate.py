"""The least factors with which stated errors hold, found from true errors at many designs."""

import functools

import numpy as np

from . import calibration, errors
from .calibration import CLASSES, CLEAR, LYING, MOST_CELLS, RANKS
from .family import TOLD_FROM
from .reference import MID_RADIUS

BEYOND = 4e-4  # share of the designs of a class that may need more than its factor
FEW = 200.0  # factors go beyond what was seen, the more the fewer designs were seen
TAIL = 1.0 / 3.0  # ten times as many designs bring about twice the largest need, as atlases show
ENOUGH, LEAST = 500, 200  # designs of a class that speak for it; of all classes together
SMALLEST = 0.03  # of all factors
SHARES = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)  # of stored bounds, from which the sharpest is taken
ALONE = 0.6  # share of an estimate with which one axis makes it
HIGH = 0.97  # quantile of errors over estimates that is made one on all pieces of the axes
SPEAK = 100  # designs of a piece that speak for it
SPEAK_IN_CELL, IN_CELL = (
    30,
    15.0,
)  # designs of a cell that speak for it, and so many that would miss half of what it needs
ROUNDS = 3  # of finding those; more change little
WIDEST = 1e3  # largest scale, and the smallest's inverse
PLAIN = 1.0  # of the bound: below it, what was stored wrongly would pass for what the next order adds


def calibrate(error, estimate, bound, size, beside, allowed) -> calibration.Factors:
    """The least factors with which stated errors hold, with a margin: (n,) errors and what they are told from.

    Of the shares of stored bounds that one is taken with which stated errors up to what is ``allowed`` are nearest to the
    true ones. Where nothing is told of an error, as between nodes whose fibers are taut all along, no factor makes a number
    of it: there it has to be none.
    """
    best, least = calibration.cautious(0), np.inf
    for share in SHARES if np.isfinite(error).sum() >= LEAST else ():
        total = estimate + share * bound
        told = total > 0.0
        needed = np.divide(error, total, out=np.full(len(error), np.nan), where=told)
        found = _by_class(needed, errors.classes(total, size), beside)
        factors = calibration.Factors(found, share, best.scales)
        stated = errors.stated(factors, estimate, bound, size, beside)
        given = np.isfinite(error) & (stated <= allowed) & (error > 0.0) & told
        excess = np.median(np.log(stated[given] / error[given])) if given.any() else np.inf
        if excess < least or not np.isfinite(least):
            best, least = factors, excess
    return best


def _by_class(needed, classes, beside):
    """Largest factor but a few of each class, as it lies to holes; classes with few designs ask their neighbours."""
    known = np.isfinite(needed)
    key = (np.asarray(beside, np.int8) * CLASSES + classes.astype(np.int8))[known]
    order = np.argsort(key, kind="stable")
    numbers, edges = needed[known][order], np.searchsorted(key[order], np.arange(LYING * CLASSES + 1))

    @functools.cache
    def factor(first, last):
        return float(f"{max(SMALLEST, _high(numbers[edges[first] : edges[last]])):.3g}")

    found = np.empty((LYING, CLASSES))
    for kind in range(LYING):
        for k in range(CLASSES):
            for reach in range(CLASSES):
                first, last = kind * CLASSES + max(k - reach, 0), kind * CLASSES + min(k + reach + 1, CLASSES)
                if edges[last] - edges[first] >= ENOUGH:
                    break
            else:  # too few of the kind: all designs
                first, last = 0, LYING * CLASSES
            found[kind, k] = factor(first, last)
    return found


def _high(numbers):
    """The largest but a few in ten thousand, and more where few numbers (n,) cannot have met the worst."""
    if not len(numbers):
        return calibration.UNMEASURED
    few = max(1.0 + FEW / len(numbers), (BEYOND * len(numbers)) ** -TAIL)
    return few * _quantile(numbers, 1.0 - BEYOND)


def _quantile(numbers, share):
    """As ``np.quantile``, which takes longer to begin than a few numbers to be put in order."""
    place = share * (len(numbers) - 1)
    low, high = int(place), min(int(place) + 1, len(numbers) - 1)
    sorted_there = np.partition(numbers, (low, high))
    return sorted_there[low] + (place - low) * (sorted_there[high] - sorted_there[low])


def piece_scales(inquiry, name, interpolated, places, exact):
    """Scales (d, RANKS) of what the next order would add, so that errors reach up to it on each piece of each axis.

    ``interpolated`` at all points of the inquiry; ``exact`` (k,) solutions at ``places``, NaN where there is none. A piece
    is told from the designs whose estimate it makes almost alone; which these are hangs on the scales.
    """
    table = inquiry.table
    scales = np.ones((len(table.axes), RANKS))
    value, estimate, bound, beside = (array[places] for array in inquiry.estimate(name, scales, interpolated))
    parts = inquiry.rests(interpolated[1][places], scales, places)
    whole = parts.sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.abs(value - exact) * whole / estimate  # as an end effect's
    use = np.isfinite(error) & (beside == CLEAR) & (estimate > PLAIN * bound) & (whole > 0.0)
    summed = table.family.variables[name] != MID_RADIUS and name not in TOLD_FROM
    if use.sum() < SPEAK or not summed:  # an estimate that is no sum over axes
        return scales
    error, parts, ranks = error[use], parts[use], inquiry.ranks[places][use]
    rows = np.arange(len(table.axes))
    for _ in range(ROUNDS):
        own = parts * scales[rows, ranks]
        whole = own.sum(axis=1)
        ratio = error / whole
        usual = _quantile(ratio, HIGH)
        if usual == 0.0:
            break
        change = np.full(scales.shape, usual)
        for a in rows:
            alone = np.flatnonzero(own[:, a] > ALONE * whole)
            alone = alone[np.argsort(ranks[alone, a], kind="stable")]
            edges = np.searchsorted(ranks[alone, a], np.arange(RANKS + 1))
            for rank in np.flatnonzero(np.diff(edges) >= SPEAK):
                change[a, rank] = _quantile(ratio[alone[edges[rank] : edges[rank + 1]]], HIGH)
        scales = np.clip(scales * change, 1.0 / WIDEST, WIDEST)
    return np.array([[float(f"{scale:.3g}") for scale in row] for row in scales])


def cell_factors(error, stated, cell, nodes):
    """What share of ``stated`` errors (n,) those of the designs in each ``cell`` (n,) need, with a margin: (nodes,), all
    of it where too few designs speak; (0,) for tables of more than a few ``nodes``.
    """
    if nodes > MOST_CELLS or len(error) < LEAST:
        return np.empty(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = np.where(error > 0.0, error / stated, 0.0)
    found, many = np.zeros(nodes), np.bincount(cell, minlength=nodes)
    np.maximum.at(found, cell, needed)
    margin = 1.0 + IN_CELL / np.sqrt(np.maximum(many, 1))
    found = np.where(many >= SPEAK_IN_CELL, np.clip(found * margin, SMALLEST, 1.0), 1.0)
    return np.array([float(f"{share:.3g}") for share in found])

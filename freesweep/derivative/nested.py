"""Derivatives on nested meshes, extrapolated and bounded like the outputs (:mod:`freesweep.solver.numerics.nested`)."""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from . import grid
from .equilibrium import Meshes, NotFound, equilibrium, outputs, sums

LEVELS, MOST_LEVELS = 4, 8  # meshes, each with twice the cells of the one before; the first ones are solved at once
SAFETY = 3.3  # as in the solver's bounds
FAINT = 0.02  # likewise
ROUNDING = 1e-11  # of a derivative's own unit: what nearly cancels in it
ROUNDS, CAUTION = 6, 2.0  # of placing nodes where kinds of cells change; times what is left of their way
SHRINKINGS, SHRUNK = 60, 0.85


class Found(NamedTuple):
    """Outputs and their derivatives with bounds: arrays (outputs, 1 + parameters)."""

    values: np.ndarray
    bounds: np.ndarray


def admissible(physics, meshes, y):
    """A guess shrunk toward 1, where every state is admissible, until each cell has room."""
    for _ in range(SHRINKINGS):
        with np.errstate(all="ignore"):
            if np.all(sums(physics, meshes, y).room > 0.0):
                return y
        y = 1.0 + SHRUNK * (y - 1.0)
    raise NotFound


def follow(physics, x, y, free, segments):
    """``(nodes, edges, shape)`` of a coarse mesh that follows a state, from its stretches ``y`` at ``x``, and these as a
    function of the place.
    """
    shape, x = PchipInterpolator(x, y), np.union1d(x, segments)
    y = shape(x)
    slope = np.diff(y) / (np.diff(x) * physics.length.value)
    w, s = physics.meridian(0.5 * (y[1:] + y[:-1]), slope, 0.5 * (x[1:] + x[:-1]))
    whole = np.hypot(s, w)
    nodes, edges = grid.graded(x, w / whole, s / whole, segments, free)
    return nodes, edges, shape


def solve(known, wanted, x, y, free, segments, finish, accuracy) -> Found:
    """Outputs and derivatives of the state whose stretches at ``x`` are about ``y``: ``known`` solves, ``wanted`` has all
    parameters; ``finish`` makes tables of outputs (meshes, outputs, 1 + parameters), and the unit of each number.

    Where the kind of cell changes (:mod:`physical`) a node is put: on either side everything is smooth then. What is left of
    its distance from there enters the bounds, as the results moved when it was moved before.
    """
    first = Meshes([x], free)
    y = equilibrium(known, first, admissible(known, first, y))
    kinks, before, shift = known.kinks(segments), None, None
    for made in range(ROUNDS):
        ends = np.union1d(segments, kinks)
        found, units, seen = on_nested(known, wanted, x, y, free, ends, segments, finish, accuracy)
        if len(kinks) == 0 and len(seen) == 0:
            return found
        if len(seen) == len(kinks):
            left = np.max(np.abs(seen - kinks))
            if before is not None:
                doubt = np.abs(found.values - before.values) * (CAUTION * left / shift if shift > 0.0 else 0.0)
                if np.max(doubt / units) <= accuracy or made == ROUNDS - 1:
                    return Found(found.values, found.bounds + doubt)
            before, shift = found, left
        else:
            before, shift = None, None
        kinks = seen
    raise NotFound


def on_nested(known, wanted, x, y, free, ends, segments, finish, accuracy):
    """Results on nested meshes with nodes at ``ends``, their units, and where kinds of cells change."""
    nodes, edges, shape = follow(known, x, y, free, ends)
    table, seen, level = [], [], 0
    while level < MOST_LEVELS:
        own = [grid.finer(nodes, edges, 1 << k) for k in (range(LEVELS) if level == 0 else [level])]
        meshes = Meshes(own, free)
        y = equilibrium(known, meshes, admissible(known, meshes, shape(meshes.x)))
        wanted.begin(known)
        rows, units = finish(outputs(wanted, meshes, y), wanted)
        table += list(rows)
        seen += [known.kinks(segments, meshes.cells(k)) for k in range(len(own))]
        level += len(own)
        values, bounds = extrapolate(table, units)
        if np.max(bounds / units) <= accuracy:
            break
        shape = PchipInterpolator(own[-1], y[meshes.starts[-1] :])
    last, one = seen[-1], seen[-2]
    return Found(values, bounds), units, (4.0 * last - one) / 3.0 if len(last) == len(one) else last


def extrapolate(table, units):
    """Fourth-order values and bounds from the last four meshes."""
    a, b, c, d = table[-4:]
    first, second, third = (4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0, (4.0 * d - c) / 3.0
    estimate = np.maximum(np.abs(third - second) / 15.0, np.abs(second - first) / 225.0)
    change = np.abs(d - c)
    share = np.max(estimate / (change + units * (FAINT * np.mean(change / units) + 1e-300)))
    bounds = np.maximum(SAFETY * estimate, share * change)
    return third, bounds + ROUNDING * units + ROUNDING * np.abs(third)

"""Derivatives on nested meshes, extrapolated and bounded like the outputs (:mod:`freesweep.solver.nested`)."""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from . import grid
from .equilibrium import NotFound, equilibrium, outputs, responses, sums

LEVELS, MOST_LEVELS = 4, 8  # meshes, each with twice the cells of the one before
SAFETY = 3.3  # as in the solver's bounds
FAINT = 0.02  # likewise
ROUNDING = 1e-11  # of a derivative's own unit: what nearly cancels in it
ROUNDS, CAUTION = 6, 2.0  # of placing nodes where kinds of cells change; times what is left of their way
SHRINKINGS, SHRUNK = 60, 0.85


class Found(NamedTuple):
    """Outputs and their derivatives with bounds: arrays (outputs, 1 + parameters)."""

    names: tuple
    values: np.ndarray
    bounds: np.ndarray


def admissible(physics, x, y):
    """A guess shrunk toward 1, where every state is admissible, until each cell has room."""
    for _ in range(SHRINKINGS):
        with np.errstate(all="ignore"):
            if np.all(sums(physics, x, y).room > 0.0):
                return y
        y = 1.0 + SHRUNK * (y - 1.0)
    raise NotFound


def follow(physics, x, y, free, segments):
    """``(nodes, edges, stretches)`` of a coarse mesh that follows a state, from its stretches ``y`` at ``x``."""
    shape, x = PchipInterpolator(x, y), np.union1d(x, segments)
    y = shape(x)
    slope = np.diff(y) / (np.diff(x) * physics.length.value)
    s = physics.axial(0.5 * (y[1:] + y[:-1]), slope, 0.5 * (x[1:] + x[:-1]))
    whole = np.hypot(s, slope)
    nodes, edges = grid.graded(x, slope / whole, s / whole, segments, free)
    return nodes, edges, shape(nodes)


def on_mesh(known, wanted, x, y, free, held):
    """Stretches on a mesh, and the table of outputs with their derivatives there: (outputs, 1 + parameters).

    ``known`` solves, ``wanted`` has all parameters, that of the load that holds first.
    """
    y = equilibrium(known, x, admissible(known, x, y), free, held)
    if held is not None:
        wanted.load = known.load
    wanted.begin(known)
    found = sums(wanted, x, y)
    moved, _ = responses(found, free)
    return y, outputs(wanted, x, y, free, found, moved)


def solve(known, wanted, x, y, free, held, segments, finish, accuracy) -> Found:
    """Outputs and derivatives of the state whose stretches at ``x`` are about ``y``; ``finish`` makes a table of the outputs
    of one mesh, ``names`` and an array, and tells the unit of each.

    Where the kind of cell changes (:mod:`physical`) a node is put: on either side everything is smooth then. What is left of
    its distance from there enters the bounds, as the results moved when it was moved before.
    """
    y = equilibrium(known, x, admissible(known, x, y), free, held)
    kinks, before, shift = known.kinks(segments), None, None
    for made in range(ROUNDS):
        found, units, seen = on_nested(
            known, wanted, x, y, free, held, np.union1d(segments, kinks), segments, finish, accuracy
        )
        if len(kinks) == 0 and len(seen) == 0:
            return found
        if len(seen) == len(kinks):
            left = np.max(np.abs(seen - kinks))
            if before is not None:
                doubt = np.abs(found.values - before.values) * (CAUTION * left / shift if shift > 0.0 else 0.0)
                if np.max(doubt / units) <= accuracy or made == ROUNDS - 1:
                    return Found(found.names, found.values, found.bounds + doubt)
            before, shift = found, left
        else:
            before, shift = None, None
        kinks = seen
    raise NotFound


def on_nested(known, wanted, x, y, free, held, ends, segments, finish, accuracy):
    """Results on nested meshes with nodes at ``ends``, their units, and where kinds of cells change."""
    nodes, edges, y = follow(known, x, y, free, ends)
    x, table, seen = nodes, [], []
    for level in range(MOST_LEVELS):
        if level > 0:
            coarse, x = x, grid.finer(nodes, edges, 1 << level)
            y = PchipInterpolator(coarse, y)(x)
        y, made = on_mesh(known, wanted, x, y, free, held)
        names, rows, units = finish(made, wanted)
        table.append(rows)
        seen.append(known.kinks(segments))
        if level + 1 >= LEVELS:
            values, bounds = extrapolate(table, units)
            if np.max(bounds / units) <= accuracy:
                break
    last, one = seen[-1], seen[-2]
    return Found(names, values, bounds), units, (4.0 * last - one) / 3.0 if len(last) == len(one) else last


def extrapolate(table, units):
    """Fourth-order values and bounds from the last four meshes."""
    a, b, c, d = table[-4:]
    first, second, third = (4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0, (4.0 * d - c) / 3.0
    estimate = np.maximum(np.abs(third - second) / 15.0, np.abs(second - first) / 225.0)
    change = np.abs(d - c)
    share = np.max(estimate / (change + units * (FAINT * np.mean(change / units) + 1e-300)))
    bounds = np.maximum(SAFETY * estimate, share * change)
    return third, bounds + ROUNDING * units + ROUNDING * np.abs(third)

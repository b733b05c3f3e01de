"""Derivatives on nested meshes, extrapolated and bounded like the outputs (:mod:`freesweep.solver.numerics.nested`)."""

from collections.abc import Callable
from copy import copy
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from . import grid
from .equilibrium import Meshes, NotFound, equilibrium, sums
from .outputs import outputs
from .physics import Physics

LEVELS = 4  # meshes, each with twice the cells of the one before, that are solved at once
FINEST = 8  # doublings of the coarsest mesh's cells
COARSEST, OF_WAVES = 7, 5  # as many, at most, of those that have no state; of a shape that needs many places
FINER = 2  # times that the places of a shape are asked four times as densely
SAFETY, FAINT, SLOWEST = 3.3, 0.02, 0.75  # as in the solver's bounds
ROUGH, LATER = 1e-6, 1  # accuracy of other outputs, for which so many meshes are added
ROUNDING = 1e-11  # of a derivative's own unit: what nearly cancels in it
ROUNDS, CAUTION = 8, 2.0  # of placing nodes where kinds of cells change; times what is left of their way
FINER_FOR_PLACES, NEXT_TO_NONE = 2, 1e-12  # doublings of meshes that miss such a place by too much; a way of a node
SHRINKINGS, SHRUNK = 60, 0.85


class Found(NamedTuple):
    """Outputs and their derivatives with bounds: arrays (outputs, 1 + parameters)."""

    values: np.ndarray
    bounds: np.ndarray


class Shape:
    """A state as a guess for meshes: its stretches ``y`` at the places ``x`` and where ``segments`` meet."""

    def __init__(self, physics, x, y, segments):
        self.stretch, self.x = PchipInterpolator(x, y), np.union1d(x, segments)
        y = self.stretch(self.x)
        slope = np.diff(y) / (np.diff(self.x) * physics.length.value)
        rise, axial = physics.meridian(0.5 * (y[1:] + y[:-1]), slope, 0.5 * (self.x[1:] + self.x[:-1]))
        whole = np.hypot(axial, rise)
        self.sine, self.cosine = rise / whole, axial / whole

    def graded(self, segments, free):
        """``(nodes, edges)`` of a coarse mesh that follows the shape."""
        return grid.graded(self.x, self.sine, self.cosine, segments, free)

    def on(self, physics, meshes):
        """A guess on ``meshes``, eased on those where some cell has no room, as the solver's are."""
        y = self.stretch(meshes.x)
        for mesh in without_room(physics, meshes, y):
            nodes, share = meshes.nodes(mesh), meshes.share[meshes.cells(mesh)]
            least = grid.least_between(self.x, self.cosine, meshes.x[nodes])
            middle = len(share) if meshes.free else meshes.middle[mesh] - meshes.starts[mesh]
            y[nodes] = physics.eased(meshes.x[nodes], y[nodes], share, least, middle)
        return shrunk(physics, meshes, y)


def without_room(physics, meshes, y):
    """Which meshes have a cell without room."""
    with np.errstate(all="ignore"):
        room = sums(physics, meshes, y).room
    return np.flatnonzero(~(np.minimum.reduceat(room, meshes.first_cells) > 0.0))


def shrunk(physics, meshes, y):
    """A guess shrunk toward 1, where every state is admissible, on each mesh until all its cells have room."""
    for _ in range(SHRINKINGS):
        tight = without_room(physics, meshes, y)
        if len(tight) == 0:
            return y
        for mesh in tight:
            nodes = meshes.nodes(mesh)
            y[nodes] = 1.0 + SHRUNK * (y[nodes] - 1.0)
    raise NotFound


class Task(NamedTuple):
    """What is to be told of a state: ``known`` solves, ``wanted`` has all parameters; whether the last node is ``free``, as
    of half a tube, and where ``segments`` meet; ``finish`` makes tables of outputs (meshes, outputs, 1 + parameters), and
    the unit of each number, and its doubts; how exactly; and how many outputs are to be told so exactly, which come first.
    """

    known: Physics
    wanted: Physics
    free: bool
    segments: np.ndarray
    finish: Callable
    accuracy: float
    first: int


def solve(task, shape, hold) -> Found:
    """Outputs and derivatives of the state of which ``shape(finer)`` gives places and the stretches there, about.

    Where the kind of cell changes (:mod:`physical`) a node is put: on either side everything is smooth then. What is left of
    its distance from there, and by how much meshes miss that place, enters the bounds, as the results moved when it was
    first moved; where meshes miss it by too much, finer ones are taken.
    """
    known, x, y, hold, least = on_first(task.known, shape, task.free, task.segments, hold)
    task, segments, accuracy, first = task._replace(known=known), task.segments, task.accuracy, slice(task.first)
    kinks, before, slope, finest = known.kinks(segments), None, None, least + FINER_FOR_PLACES
    for made in range(ROUNDS):
        ends = np.union1d(segments, kinks)
        found, units, (seen, unsure) = on_nested(task, x, y, ends, hold, least)
        if len(kinks) == 0 and len(seen) == 0:
            return found
        if len(seen) == len(kinks):
            left = np.max(np.abs(seen - kinks))
            if before is not None:
                values, shift = before
                if slope is None:
                    slope = np.abs(found.values - values) / max(shift, NEXT_TO_NONE)
                doubt, missed = CAUTION * left * slope, np.where(slope > 0.0, np.max(unsure) * slope, 0.0)
                if made == ROUNDS - 1 or np.max((doubt / units)[first]) <= accuracy:
                    if made == ROUNDS - 1 or least == finest or np.max((missed / units)[first]) <= accuracy:
                        return Found(found.values, found.bounds + doubt + missed)
                    least += 1
            before = found.values, left
        else:
            before = slope = None
        kinks = seen
    raise NotFound


def on_first(known, shape, free, segments, hold):
    """``(physics, x, y, hold, least)``: ``known`` with what it settles at on the mesh of the guess, the guess itself, and
    how fine meshes begin. Where that mesh has no state, the waves of a long tube lie between its places: a fine mesh
    follows a shape of more of them. Its state is no better guess: where layers are sharp it is that of a coarse mesh.
    """
    for finer in range(FINER + 1):
        places, y = shape(finer)
        physics, least = copy(known), 0
        if finer:
            guess, least = Shape(known, places, y, segments), OF_WAVES
            places = grid.finer(*guess.graded(segments, free), 1 << COARSEST)
            y = guess.stretch(places)
        mesh = Meshes([places], free)
        try:
            y = shrunk(physics, mesh, y)
            equilibrium(physics, mesh, y, hold)
            if hold is not None:
                physics.bear(hold.unknown, hold.load)
            return physics, places, y, hold, least
        except NotFound:
            if finer == FINER:
                raise


def on_nested(task, x, y, ends, hold, least):
    """Results on nested meshes with nodes at ``ends``, their units, and where kinds of cells change, and how unsure that is;
    the coarsest, doubled ``least`` times, is a finer one where that has no state.
    """
    known, wanted, free, segments, finish, accuracy, first = task
    shape = Shape(known, x, y, ends)
    nodes, edges = shape.graded(ends, free)

    def stand(physics, levels, shape, hold):
        meshes = Meshes([grid.finer(nodes, edges, 1 << level) for level in levels], free)
        return meshes, *equilibrium(physics, meshes, shape.on(physics, meshes), hold)

    for coarsest in range(least, COARSEST + 1):
        levels, physics = range(coarsest, coarsest + LEVELS), copy(known)
        try:
            meshes, y, own = stand(physics, levels, shape, hold)
            break
        except NotFound:
            if coarsest == COARSEST:
                raise
    table, seen, later = [], [], 0
    while True:
        if own is not None:
            wanted.bear(own.unknown, meshes.in_cells(own.load))
        wanted.begin(physics)
        rows, units, doubts = finish(*outputs(wanted, meshes, y, ends, segments), own)
        table += list(rows)
        seen += [physics.kinks(segments, meshes.cells(k)) for k in range(len(levels))]
        if not later:  # finer meshes are for the others only
            values, bounds = extrapolate([rows[:first] for rows in table], units[:first])
            met = np.max(bounds / units[:first]) <= accuracy
        others = [
            extrapolate([rows[k : k + 1] for rows in table], units[k : k + 1], True) for k in range(first, len(units))
        ]
        rough = max(np.max(about / units[k]) for k, (_, about) in enumerate(others, first))
        if (met and (rough <= ROUGH or later == LATER)) or levels[-1] >= FINEST:
            break
        later += met
        last = meshes.nodes(len(levels) - 1)
        levels = [levels[-1] + 1]
        try:
            meshes, y, own = stand(physics, levels, Shape(physics, meshes.x[last], y[last], ends), own)
        except NotFound:
            if not met:
                raise
            break
    values, bounds = map(np.concatenate, zip((values, bounds), *others))
    return Found(values, bounds + doubts), units, places_of(seen[-3:])


def places_of(seen):
    """Where kinds of cells change, from what the last three meshes told, and what that may miss; endless where these do not
    tell as many places.
    """
    two, one, last = seen
    if len(last) != len(one):
        return last, np.full(len(last), np.inf)
    found = (4.0 * last - one) / 3.0
    if len(two) != len(one):
        return found, np.abs(last - one)
    return found, SAFETY / 15.0 * np.abs(found - (4.0 * one - two) / 3.0)


def extrapolate(table, units, is_rough=False):
    """Fourth-order values and bounds from the last four meshes; of ``is_rough`` results, whose differences may fall by less
    than the order allows, or, once meshes are fine enough, by far more.
    """
    a, b, c, d = table[-4:]
    first, second, third = (4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0, (4.0 * d - c) / 3.0
    last, before = np.abs(third - second), np.abs(second - first)
    fallen = np.minimum(last / (before + 1e-300), SLOWEST) if is_rough else 0.0
    guard = np.minimum(before / 225.0, np.abs(c - b) / 12.0) if is_rough else before / 225.0
    estimate = np.maximum(last * np.maximum(fallen / (1.0 - fallen), 1.0 / 15.0), guard)
    change = np.abs(d - c)
    share = np.max(estimate / (change + units * (FAINT * np.mean(change / units) + 1e-300)))
    bounds = np.maximum(SAFETY * estimate, share * change)
    return third, bounds + ROUNDING * units + ROUNDING * np.abs(third)

"""States of many actuators in vectors: the quick way of a fit, which asks for states of tubes that hardly differ."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..query import reference
from ..query.exact import solve
from ..query.reference import COLUMNS, FIBERS, FORCE, HELD, LENGTH, LENGTH_HELD, LOADED, PRESSURE, ROTATION_HELD
from ..tube_model import TubeModel

ACCURACY = {False: 1e-8, True: 1e-7}  # of the solver, scaled; of physical tubes
SPLIT = 48  # states that are worth a thread
FAR = 44.0  # fiber radii: from here on the ends of a tube do not feel each other
FORCES = np.linspace(0.0, 1.0, 10) ** 1.5  # shares of a range of forces, denser where the muscle is nearly free
TURNS = 6  # of secants
SETTLED = 1e-8  # of the length


def model_of(tube) -> TubeModel:
    """The parts of a tube's model."""
    return TubeModel("outer", "thick" if tube.is_thick else "membrane", "loose" if tube.is_loose else "bonded")


def points_of(tube, pressure, force=0.0, torque=0.0, held=0.0):
    """Points (n, 15) of one tube, as the exact solver takes them."""
    design = tube.design()
    own = design | {"pressure": pressure, "force": force, "torque": torque, "held": held}
    columns = np.broadcast_arrays(*(np.asarray(own.get(name, 0.0), float) for name in COLUMNS))
    return np.column_stack([np.atleast_1d(column) for column in columns])


def free_states(points, energy, model, names):
    """Outputs (n, names) of free states, NaN where there is none."""
    found = _shared(LOADED, points, energy, model)
    return np.column_stack([found[name] for name in names])


def held_torques(points, energy, model):
    """Torques (n,) that hold rotations."""
    return _shared(ROTATION_HELD, points, energy, model)["torque"]


class Forces:
    """Forces (n,) that hold lengths. Vectors of physical tubes know free states only: secants through those find the force.

    A short tube, whose ends feel each other, would often be left to the scalar kernels. Its length is told from two long
    ones, ``l = lambda L + e``, and ``correction`` (n,), what that misses of the length, is found now and then (``refresh``).
    """

    def __init__(self, count):
        self.correction = np.zeros(count)  # [m]
        self.force = np.full(count, np.nan)
        self.slope = np.full(count, np.nan)  # [m/N]

    def solve(self, points, energy, model, own):
        """Forces at points (k, 15) of which each is the state ``own`` (k,) of a measurement."""
        found = np.full(len(points), np.nan)
        rest = (points[:, PRESSURE] == 0.0) & (points[:, HELD] <= 1.0 + 1e-12)  # a thread cannot be pushed
        found[rest & (points[:, HELD] >= 1.0 - 1e-12)] = 0.0
        todo = np.flatnonzero(~rest)
        if not model.is_physical:
            if len(todo):
                found[todo] = _shared(LENGTH_HELD, points[todo], energy, model)["force"]
            return found
        if len(todo):
            found[todo] = self._sought(points[todo], energy, model, own[todo])
        return found

    def _sought(self, points, energy, model, own):
        target = points[:, HELD] * points[:, LENGTH] - self.correction[own]
        force, slope = self.force[own].copy(), self.slope[own].copy()
        force, slope, done = _secants(points, energy, model, target, force, slope)
        if not done.all():
            anew = np.flatnonzero(~done)
            first = _first_forces(points[anew], energy, model, target[anew])
            force[anew], slope[anew], done[anew] = _secants(points[anew], energy, model, target[anew], *first)
        self.force[own[done]], self.slope[own[done]] = force[done], slope[done]
        return np.where(done, force, np.nan)

    def refresh(self, points, energy, model, own):
        """Correct lengths of short tubes by exact solutions at the forces found; the largest change that makes [N]."""
        short = (points[:, LENGTH] < FAR * points[:, FIBERS]) & np.isfinite(self.force[own])
        if not (model.is_physical and short.any()):
            return 0.0
        points, own = points[short].copy(), own[short]
        points[:, FORCE] = self.force[own]
        exact = _shared(LOADED, points, energy, model)["deformed_length"]
        missed = exact - _lengths(points, energy, model)
        change = np.where(np.isfinite(missed), missed - self.correction[own], 0.0)
        self.correction[own] += change
        return float(np.max(np.abs(change / self.slope[own]), initial=0.0))


def _lengths(points, energy, model):
    """Deformed lengths (n,) of free states, of short tubes told from long ones."""
    far = np.maximum(points[:, LENGTH], FAR * points[:, FIBERS])
    short = np.flatnonzero(points[:, LENGTH] < far)
    both = np.concatenate([points, points[short]])
    both[:, LENGTH] = np.concatenate([far, 2.0 * far[short]])
    found = _shared(LOADED, both, energy, model)["deformed_length"]
    one, two = found[: len(points)], found[len(points) :]
    stretch = (two - one[short]) / far[short]
    one[short] += stretch * (points[short, LENGTH] - far[short])
    return one


def _first_forces(points, energy, model, target):
    """Forces and slopes to begin with, from lengths at forces over the whole range."""
    thrust = np.pi * points[:, FIBERS] ** 2 * points[:, PRESSURE]
    ta, tb = (np.tan(np.radians(points[:, COLUMNS.index(name)])) for name in ("alpha", "beta"))
    with np.errstate(divide="ignore"):
        blocked = -thrust * (1.0 + 2.0 / (ta * tb))
    wall = np.pi * ((points[:, reference.RADIUS] + points[:, reference.WALL]) ** 2 - points[:, reference.RADIUS] ** 2)
    rubber = 6.0 * (points[:, reference.C10] + points[:, reference.C01]) * wall
    stretched = np.maximum(points[:, HELD] - 0.95, 0.05)
    top = np.maximum(np.where(np.isfinite(blocked), blocked, 20.0 * thrust), 0.0) * 1.1 + 4.0 * rubber * stretched
    low = -0.7 * thrust
    tried = low[:, None] + (top - low)[:, None] * FORCES
    grid = np.repeat(points, len(FORCES), axis=0)
    grid[:, FORCE] = tried.ravel()
    lengths = _lengths(grid, energy, model).reshape(tried.shape)
    force, slope = np.full(len(points), np.nan), np.full(len(points), np.nan)
    for i, (own, found) in enumerate(zip(tried, lengths)):
        there = np.flatnonzero(np.isfinite(found))
        if len(there) < 2:
            continue
        at = np.clip(np.searchsorted(found[there], target[i]), 1, len(there) - 1)
        a, b = there[at - 1], there[at]
        if found[b] > found[a] and (target[i] >= found[a] or a == 0 or not np.isfinite(found[a - 1])):
            slope[i] = (found[b] - found[a]) / (own[b] - own[a])
            force[i] = own[a] + (target[i] - found[a]) / slope[i]
    return force, slope


def _secants(points, energy, model, target, force, slope):
    """Forces, slopes and whether they are found (n,)."""
    points, done = points.copy(), np.zeros(len(points), bool)
    thrust = np.pi * points[:, FIBERS] ** 2 * points[:, PRESSURE] + np.abs(np.nan_to_num(force))
    before_force, before = np.full(len(points), np.nan), np.full(len(points), np.nan)
    todo = np.flatnonzero(np.isfinite(force) & (slope > 0.0))
    for _ in range(TURNS):
        if len(todo) == 0:
            break
        points[todo, FORCE] = force[todo]
        length = np.full(len(points), np.nan)
        length[todo] = _lengths(points[todo], energy, model)
        with np.errstate(all="ignore"):
            secant = (length - before) / (force - before_force)
            slope = np.where(secant > 0.0, secant, slope)
        miss = target - length
        settled = np.abs(miss) <= SETTLED * points[:, LENGTH]
        done[todo] = settled[todo]
        before_force, before = np.where(done, before_force, force), length
        with np.errstate(all="ignore"):
            step = np.clip(miss / slope, -thrust, thrust)
        todo = todo[~settled[todo] & np.isfinite(step[todo])]
        force = force.copy()
        force[todo] += step[todo]
    return force, slope, done


def _shared(kind, points, energy, model):
    """Exact solutions, on all cores."""
    cores = os.cpu_count() or 1
    parts = min(cores, max(len(points) // SPLIT, 1))
    accuracy = ACCURACY[model.is_physical]
    if parts == 1:
        return solve(kind, points, energy, accuracy, model=model)
    with ThreadPoolExecutor(parts) as pool:
        solved = list(pool.map(lambda k: solve(kind, points[k::parts], energy, accuracy, model=model), range(parts)))
    found = {name: np.empty(len(points), array.dtype) for name, array in solved[0].items()}
    for k, part in enumerate(solved):
        for name, array in part.items():
            found[name][k::parts] = array
    return found

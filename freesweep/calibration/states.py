"""States of many actuators in vectors: the quick way of a fit, which asks for states of tubes that hardly differ."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numba import config

from ..description.tube_model import TubeModel
from ..query import reference
from ..query.exact import Tubes, solve
from ..query.reference import COLUMNS, FIBERS, FORCE, HELD, LENGTH, LENGTH_HELD, LOADED, PRESSURE, ROTATION_HELD
from ..scaling import problem_rows
from ..status import VALUED

ACCURACY = {False: 1e-8, True: 1e-7}  # of the solver, scaled; of physical tubes
SPLIT = 48  # states that are worth a thread
FAR = 44.0  # fiber radii: from here on the ends of a tube do not feel each other
NEAR = 1e-3  # of the length: a difference that tells a slope
LOWEST = -0.3  # of pressure times section: a push from which a search begins, at most
PUSH = -0.02  # of pressure times section: what was measured below it is a push
TURNS = 8  # of secants
ASIDE, ROUNDING = 0.02, 1e-9  # of pressure times section, a pull beside none; relative
SETTLED = 1e-8  # of the length


def model_of(tube) -> TubeModel:
    """The parts of a tube's model."""
    return TubeModel("outer", "thick" if tube.is_thick else "membrane", "loose" if tube.is_loose else "bonded")


def points_of(tube, pressure, force=0.0, torque=0.0, held=0.0):
    """Points (n, 17) of one tube, as the exact solver takes them."""
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
    """Forces (n,) that hold lengths: secants through free states, which vectors solve, find them.

    A short tube, whose ends feel each other, would often be left to the scalar kernels. Its length is told from two long
    ones, ``l = lambda L + e``, and ``correction`` (n,), what that misses of the length, is found now and then (``refresh``).
    Where a bench did not measure a push, a push is told from the slope at no force: near where walls would have to be
    pushed, such states are dear, and nobody asks for them.
    """

    def __init__(self, measured):
        self.measured = measured
        count = len(measured)
        self.correction = np.zeros(count)  # [m]
        self.force = np.full(count, np.nan)
        self.slope = np.full(count, np.nan)  # [m/N]

    def solve(self, points, energy, model, own, keep=True):
        """Forces at points (k, 15) of which each is the state ``own`` (k,) of a measurement; ``keep`` them to begin with."""
        found = np.full(len(points), np.nan)
        rest = (points[:, PRESSURE] == 0.0) & (points[:, HELD] <= 1.0 + 1e-12)  # a thread cannot be pushed
        found[rest & (points[:, HELD] >= 1.0 - 1e-12)] = 0.0
        todo = np.flatnonzero(~rest)
        if len(todo):
            found[todo] = self._sought(points[todo], energy, model, own[todo], keep)
        return found

    def _sought(self, points, energy, model, own, keep):
        target = points[:, HELD] * points[:, LENGTH] - self.correction[own]
        force, slope = self.force[own].copy(), self.slope[own].copy()
        thrust = np.pi * points[:, FIBERS] ** 2 * points[:, PRESSURE]
        floor = np.where(self.measured[own] < PUSH * thrust, -thrust, 0.0)
        force, slope, done = _secants(points, energy, model, target, force, slope, floor)
        if not done.all():
            anew = np.flatnonzero(~done)
            first = _first_forces(points[anew], target[anew])
            found = _secants(points[anew], energy, model, target[anew], *first, floor[anew], aside=True)
            force[anew], slope[anew], done[anew] = found
        if keep:
            self.force[own[done]], self.slope[own[done]] = force[done], slope[done]
        return np.where(done & (force > -thrust), force, np.nan)  # beyond, the wall would have to be pushed

    def refresh(self, points, energy, model, own):
        """Correct lengths of short tubes by exact solutions at the forces found, and pushes by slopes at no force; the
        largest change that makes [N].
        """
        change = self._refresh_pushes(points, energy, model, own)
        short = (points[:, LENGTH] < FAR * points[:, FIBERS]) & np.isfinite(self.force[own])
        short &= (self.force[own] >= 0.0) | (self.measured[own] < 0.0)
        if not short.any():
            return change
        points, own = points[short].copy(), own[short]
        points[:, FORCE] = self.force[own]
        exact = _shared(LOADED, points, energy, model)["deformed_length"]
        missed = exact - _lengths(points, energy, model)
        more = np.where(np.isfinite(missed), missed - self.correction[own], 0.0)
        self.correction[own] += more
        return float(np.max(np.abs(more / self.slope[own]), initial=change))

    def _refresh_pushes(self, points, energy, model, own):
        """Tell pushes anew, that are told from slopes of tubes that may have differed more; slack muscles are none."""
        thrust = np.pi * points[:, FIBERS] ** 2 * points[:, PRESSURE]
        told = (self.force[own] < 0.0) & (self.measured[own] >= PUSH * thrust) & (self.measured[own] != 0.0)
        if not told.any():
            return 0.0
        points, own = points[told], own[told]
        target, none = points[:, HELD] * points[:, LENGTH] - self.correction[own], np.zeros(len(own))
        force, slope, done = _secants(points, energy, model, target, none, self.slope[own].copy(), none, aside=True)
        change = np.abs(force - self.force[own])[done]
        self.force[own[done]], self.slope[own[done]] = force[done], slope[done]
        return float(np.max(change, initial=0.0))


def _lengths(points, energy, model):
    """Deformed lengths (n,) of free states, of short tubes told from long ones."""
    far = np.maximum(points[:, LENGTH], FAR * points[:, FIBERS])
    short = np.flatnonzero(points[:, LENGTH] < far)
    both = np.concatenate([points, points[short]])
    both[:, LENGTH] = np.concatenate([far, 2.0 * far[short]])
    cores = os.cpu_count() or 1
    parts = min(cores, max(len(both) // SPLIT, 1))
    found = np.empty(len(both))
    with ThreadPoolExecutor(parts) as pool:
        for k, part in enumerate(pool.map(lambda k: _by_vectors(both[k::parts], energy, model), range(parts))):
            found[k::parts] = part
    one, two = found[: len(points)], found[len(points) :]
    stretch = (two - one[short]) / far[short]
    one[short] += stretch * (points[short, LENGTH] - far[short])
    return one


def _by_vectors(points, energy, model):
    """Deformed lengths (n,) of free states as vectors have them; NaN where there is none, and where they leave it open."""
    from ..solver.batch import walk_by_vectors

    if config.DISABLE_JIT:  # vectors are machine code only
        return solve(LOADED, points, Tubes(energy, model), ACCURACY[model.is_physical])["deformed_length"]
    design = dict(zip(COLUMNS, points.T))
    rows = problem_rows(design, energy, model.is_thick, model.is_loose)
    pressures = points[:, PRESSURE] / points[:, reference.C10]
    each = np.arange(len(rows) + 1)
    found = walk_by_vectors(np.ascontiguousarray(rows), each, pressures, ACCURACY[model.is_physical])
    there = np.isin(found.status, VALUED)
    return np.where(there, 2.0 * points[:, FIBERS] * found.values[:, 0], np.nan)


def rough_states(kind, points, names):
    """The same of uniform membranes (n, names), for a first look at physical tubes far from what is measured."""
    own = {"free": LOADED, "force": LENGTH_HELD, "torque": ROTATION_HELD}[kind]
    u = np.full((len(points), reference.UNIFORM), np.nan)
    reference.uniform_states(own, np.ascontiguousarray(points), 1.0, u)
    r, length = points[:, FIBERS], points[:, LENGTH]
    scale = np.pi * points[:, reference.C10]
    with np.errstate(invalid="ignore"):
        found = {
            "deformed_length": length * u[:, 4], "rotation": np.degrees(length / r * u[:, 5]),
            "mid_radius": r * np.sqrt(u[:, 3]), "force": u[:, 7] * scale * r**2, "torque": u[:, 7] * scale * r**3,
        }  # fmt: skip
    return np.column_stack([found[name] for name in names or (kind,)])


def _first_forces(points, target):
    """Forces and slopes of the uniform membrane, to begin with: what the ends and the wall change is left to secants."""
    found = []
    for ratio in (target / points[:, LENGTH], target / points[:, LENGTH] + NEAR):
        held, out = points.copy(), np.full((len(points), reference.UNIFORM), np.nan)
        held[:, HELD] = ratio
        reference.uniform_states(LENGTH_HELD, held, 1.0, out)
        found.append(out[:, 7] * np.pi * points[:, FIBERS] ** 2 * points[:, reference.C10])
    force = np.maximum(found[0], LOWEST * np.pi * points[:, FIBERS] ** 2 * points[:, PRESSURE])
    with np.errstate(all="ignore"):
        return force, NEAR * points[:, LENGTH] / (found[1] - found[0])


def _secants(points, energy, model, target, force, slope, floor, aside=False):
    """Forces, slopes and whether they are found (n,). A push is told from the slope at no force: one that is not that of a
    state like these (``aside``) is told by a state beside.
    """
    points, done, force = points.copy(), np.zeros(len(points), bool), np.maximum(force, floor)
    thrust = np.pi * points[:, FIBERS] ** 2 * points[:, PRESSURE] + np.abs(np.nan_to_num(force))
    known_force, known = np.full(len(points), np.nan), np.full(len(points), np.nan)
    todo = np.flatnonzero(np.isfinite(force) & (slope > 0.0))
    for _ in range(TURNS):
        if len(todo) == 0:
            break
        points[todo, FORCE] = force[todo]
        length = _lengths(points[todo], energy, model)
        there = np.isfinite(length)
        with np.errstate(all="ignore"):
            secant = (length - known[todo]) / (force[todo] - known_force[todo])
        slope[todo] = np.where(secant > 0.0, secant, slope[todo])
        miss = target[todo] - length
        below = (force[todo] <= floor[todo]) & (miss < 0.0) & (floor[todo] == 0.0)
        if aside:
            step = np.abs(force[todo] - known_force[todo])
            unknown = below & ~(step <= ASIDE * thrust[todo] * (1.0 + ROUNDING))
        else:
            unknown = np.zeros(len(todo), bool)
        below &= ~unknown
        settled = (np.abs(miss) <= SETTLED * points[todo, LENGTH]) | below
        done[todo] = settled
        half = 0.5 * (force[todo] + np.where(np.isfinite(known_force[todo]), known_force[todo], 0.0))
        ahead = force[todo] + np.clip(miss / slope[todo], -thrust[todo], thrust[todo])
        known_force[todo[there]], known[todo[there]] = force[todo[there]], length[there]
        ahead = np.where(there, ahead, half)  # no state: back to where there was one
        force[todo] = np.where(
            below, miss / slope[todo], np.where(settled, force[todo], np.maximum(ahead, floor[todo]))
        )
        force[todo[unknown]] = ASIDE * thrust[todo[unknown]]
        todo = todo[~settled]
    return force, slope, done


def _shared(kind, points, energy, model):
    """Exact solutions, on all cores."""
    cores = os.cpu_count() or 1
    parts = min(cores, max(len(points) // SPLIT, 1))
    accuracy, tubes = ACCURACY[model.is_physical], Tubes(energy, model)
    if parts == 1:
        return solve(kind, points, tubes, accuracy)
    with ThreadPoolExecutor(parts) as pool:
        solved = list(pool.map(lambda k: solve(kind, points[k::parts], tubes, accuracy), range(parts)))
    found = {name: np.empty(len(points), array.dtype) for name, array in solved[0].items()}
    for k, part in enumerate(solved):
        for name, array in part.items():
            found[name][k::parts] = array
    return found

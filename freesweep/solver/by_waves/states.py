"""States of a buckled tube: those of its branch at the pressures asked for."""

import itertools
from typing import NamedTuple

import numpy as np

from ..along.profile import FIELDS
from ..problem import FORCE
from ..stability import PUSHED
from ..status import COMPRESSED, HELD_IMPOSSIBLE, INVALID, NOT_CONVERGED
from .branch import begin, critical, follow
from .on_step import parts
from .told import SURE, doubt_of_turn, refined, told_of
from .waves import PRESSURE, Waves

FARTHEST = 2.5  # times the larger of the pressure asked for and the critical one: a branch that far seldom comes back
NUMBERS = 6  # length, volume, twist, energy of half the tube, stretch in the middle, torque


class Buckled(NamedTuple):
    """Of states (n,): numbers and bounds (n, NUMBERS), status, families that would have to push, whether it is stable, the
    least pressure of the branch so far and its bound (n, 2), profiles (n, FIELDS, stations).
    """

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    stable: np.ndarray
    least: np.ndarray
    profiles: np.ndarray


def find_buckled(problems, pressures, targets, accuracy, stations) -> Buckled:
    """The stable buckled state of each problem, with the force in it, at its pressure and rotation [rad]: the first one of
    the branch that leaves the straight tube at the critical pressure. Profiles at ``stations``, distances in radii.
    """
    count = len(pressures)
    found = Buckled(
        np.full((count, NUMBERS), np.nan), np.full((count, NUMBERS), np.nan), np.full(count, NOT_CONVERGED),
        np.zeros(count, np.int64), np.zeros(count, np.int64), np.full((count, 2), np.nan),
        np.full((count, FIELDS, len(stations)), np.nan),
    )  # fmt: skip
    keys = np.column_stack([problems[:, FORCE], targets])
    for key in np.unique(keys, axis=0):
        rows = np.flatnonzero(np.all(keys == key, axis=1))
        with np.errstate(all="ignore"):  # of what is no tube nothing can be told
            walk(Waves(problems[rows[0]], key[1]), rows, pressures, accuracy, stations, found)
    return found


def walk(asked, rows, pressures, accuracy, stations, found):
    """Write the ``rows`` of one branch."""
    center, critical_pressure, is_clamped = critical(asked)
    if not is_clamped:
        found.status[rows] = INVALID
        return
    if not critical_pressure > 0.0 or not critical_pressure + asked.problem[FORCE] > 0.0:
        found.status[rows] = HELD_IMPOSSIBLE
        return
    point = begin(asked, center)
    if point is None:
        return
    waiting, least = {i: pressures[i] for i in rows.tolist()}, (point.pressure, doubt_of_beginning(point))
    for step in follow(asked, point):
        for here, length, there, pieces, stands_out in parts(asked, *step):
            if stands_out is not None and there.pressure < least[0]:
                least = there.pressure, doubt_of_turn(there.look) + (stands_out + SURE) * there.pressure
            low, high = sorted((here.pressure, there.pressure))
            for i in [i for i, p in waiting.items() if low <= p <= high]:
                states = stable(refined(asked, here, length, pieces, waiting[i]))
                if write(told_of(asked, states, accuracy, stations), i, found):
                    found.least[i] = least
                    del waiting[i]
        point = there
        if not waiting or point.pressure > FARTHEST * max(critical_pressure, *waiting.values()):
            break
    for i, p in waiting.items():
        found.least[i] = least
        found.status[i] = HELD_IMPOSSIBLE if p < least[0] else lost(asked, point)


def lost(asked, point):
    """Why a branch has no state."""
    pair, neck = point.look.pair, point.look.told[1, 4]
    part, force = pair.pressure * neck * neck, asked.problem[FORCE]
    return COMPRESSED if part + force < PUSHED * max(part, abs(force)) else NOT_CONVERGED


def doubt_of_beginning(point):
    """How far off the pressure is at which there is no smaller wave, where the logarithm of that falls forever."""
    small = np.argmin(point.look.pair.numbers[:2])
    by_number = point.toward / point.look.pair.weights
    return point.pressure * abs(by_number[PRESSURE] / by_number[small])


def stable(states):
    """Those of the states, up to the first that is not."""
    return itertools.takewhile(lambda state: not state[1].unstable, states)


def write(state, i, found):
    """Write a stable state to row i; whether there is one."""
    if state is None or state.unstable:
        return False
    found.values[i], found.bounds[i], found.profiles[i] = state.values, state.bounds, state.profiles
    found.status[i], found.slack[i], found.stable[i] = state.status, state.slack, 1
    return True

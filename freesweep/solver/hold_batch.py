"""Held states of many designs at once: of tubes that are the same all along vectors find most, as free states
(:mod:`.held_by_load`); meshes go on where those end, and hold what varies.
"""

from typing import NamedTuple

import numpy as np
from numba import config

from ..interpret import run
from .along.places import NUMBERS
from .along.profile import FIELDS
from .batch import NOTHING, OUTPUTS, draw
from .halves import one_by_one
from .held.held_states import EVERY, FEW, hold_many
from .held.sought import HELD_LENGTH, HELD_ROTATION
from .held_by_load import States, hold_by_load, room_for
from .lanes.meridian import DEEPEST
from .problem import FORCE, PHYSICAL, TORQUE, wall_columns
from .status import INACCURATE, OK, PENDING

HOLDER = OUTPUTS  # column of the force or torque among a held state's numbers; behind it those of :mod:`.along.places`
STATUS = 12  # place among the arguments of hold_many


class Beside(NamedTuple):
    """Of a state beside each of the states found: load, middle, and how many times what both differ by may be missing."""

    loads: np.ndarray
    middles: np.ndarray
    parts: np.ndarray


class Holds(NamedTuple):
    """Held states (n,): the force or torque that holds each and its bound, status, whether it is stable, by which way it was
    found; its :class:`.held_by_load.States`, of half the tube; profiles (n, FIELDS, stations); and states beside.
    """

    loads: np.ndarray
    load_bounds: np.ndarray
    status: np.ndarray
    stable: np.ndarray
    paths: np.ndarray
    states: States
    profiles: np.ndarray
    beside: Beside


def hold_all(
    problems, targets, kind, first, pressures, tube, accuracy, stations=NOTHING, lanes=True, soon=False, meshes=EVERY
) -> Holds:
    """Hold each problem at its target (k,) under each of its pressures, keeping its torque while its length is held, its
    force while its rotation is; arguments as of :func:`.held.held_states.hold_many`, ``tube`` its (course, edges, places).

    Vectors of designs serve where tubes do not vary. Their numbers do not depend on which designs share a vector; those
    of meshes alone (``lanes=False``) differ by less than the bounds. Where few meshes do not settle that no rotation is
    held, waves go on (:mod:`.by_waves.held`). What nothing settles, no more than so many ``meshes``, stays PENDING.
    ``soon``: a few states need not wait for the compiler (:mod:`freesweep.interpret`).
    """
    count, along = len(pressures), len(NUMBERS) if wall_columns(problems) == PHYSICAL else 0
    found = Holds(
        *np.full((2, count), np.nan), np.full(count, PENDING), *np.zeros((2, count), np.int64),
        room_for(count, OUTPUTS + along), np.full((count, FIELDS, len(stations)), np.nan),
        Beside(np.full(count, np.nan), np.full((count, 2), np.nan), np.full(count, np.nan)),
    )  # fmt: skip
    vectors = lanes and len(tube[0]) == 0 and not config.DISABLE_JIT
    if vectors:
        owners = np.repeat(np.arange(len(problems)), np.diff(first))
        own, unknown = np.ascontiguousarray(problems[owners]), FORCE if kind == HELD_LENGTH else TORQUE
        hold_by_load(own, np.ascontiguousarray(pressures), 0.5 * targets[owners], unknown, accuracy, found, soon)
        if len(stations):
            _draw(own, pressures, unknown, stations, accuracy, found, soon)
    if meshes:
        given = problems, targets, kind, first, pressures, tube, accuracy
        if vectors and kind == HELD_ROTATION and meshes > FEW:
            _mesh(*given, FEW, stations, found, soon)
            _find_waves(*given, stations, found, soon)
        _mesh(*given, meshes, stations, found, soon)
    return found


def _mesh(problems, targets, kind, first, pressures, tube, accuracy, most, stations, found, soon):
    """Hold what is left by meshes, so many of each state at ``most``."""
    for call in _calls(problems, targets, kind, first, pressures, tube, accuracy, most, stations, found):
        run(hold_many, np.count_nonzero(call[STATUS] == PENDING), soon, *call)


def _find_waves(problems, targets, kind, first, pressures, tube, accuracy, stations, found, soon):
    """Tell what is left by waves, where no rotation is held."""
    from .by_waves.held import held_of

    def find(problem, pressure, places):
        return hold_all(
            problem[None], np.zeros(1), kind, np.array([0, 1]), np.array([pressure]), tube, accuracy, places, soon=soon,
            meshes=FEW,
        )  # fmt: skip

    owners = np.repeat(np.arange(len(problems)), np.diff(first))
    for i in np.flatnonzero((found.status == PENDING) & (targets[owners] == 0.0) & (pressures > 0.0)):
        with np.errstate(all="ignore"):  # of what is no tube nothing can be told
            found.status[i], state, found.paths[i] = held_of(
                problems[owners[i]], pressures[i], find, accuracy, stations
            )
        if state is None:
            continue
        values, bounds = state.values, state.bounds
        found.loads[i], found.load_bounds[i] = values[HOLDER], bounds[HOLDER]
        found.states.values[i], found.states.bounds[i] = np.delete(values, HOLDER), np.delete(bounds, HOLDER)
        found.states.slack[i], found.profiles[i] = state.slack, state.profiles
        found.stable[i] = state.unstable == 0


def _draw(problems, pressures, unknown, stations, accuracy, found, soon):
    """Draw the states that vectors found; a second time beside each of them, as its load may be off."""
    rows, owners = np.flatnonzero(found.status == OK), np.arange(len(problems))
    straight = rows[np.isnan(found.beside.loads[rows])]
    middles = found.states.middles.copy()
    middles[straight] = 1.0, DEEPEST
    problems[rows, unknown] = found.loads[rows]
    drawn = draw(problems, owners, pressures, middles, rows, stations, accuracy, found.profiles, soon)
    found.status[rows[~drawn[rows]]] = INACCURATE
    rows = np.setdiff1d(rows, straight)
    other, half = np.full_like(found.profiles, np.nan), FIELDS // 2
    problems[rows, unknown] = found.beside.loads[rows]
    draw(problems, owners, pressures, found.beside.middles, rows, stations, accuracy, other, soon)
    changed = np.abs(other[rows, :half] - found.profiles[rows, :half])
    found.profiles[rows, half:] += found.beside.parts[rows, None, None] * changed


def _calls(problems, targets, kind, first, pressures, tube, accuracy, most, stations, found):
    """Arguments of :func:`hold_many`: of all problems at once, or of each that has to be solved whole; what it finds is
    kept.
    """
    walls, each = wall_columns(problems), np.diff(first)
    others = np.repeat(problems[:, TORQUE if kind == HELD_LENGTH else FORCE], each)
    targets, states = np.repeat(targets, each), found.states
    for own, rows, starts, whole in one_by_one(problems, first, tube, True):
        left = found.status[rows] == PENDING
        if not np.any(left):
            continue
        count = len(left)
        values, bounds = np.full((2, count, states.values.shape[1] + 1), np.nan)
        yield (
            problems[own], walls, starts, pressures[rows], others[rows], targets[rows], kind, whole, accuracy, most,
            values, bounds, found.status[rows], found.stable[rows], states.slack[rows], found.paths[rows],
            stations, found.profiles[rows],
        )  # fmt: skip
        for one, told, loads in ((states.values, values, found.loads), (states.bounds, bounds, found.load_bounds)):
            one[rows][left], loads[rows][left] = np.delete(told[left], HOLDER, axis=1), told[left, HOLDER]

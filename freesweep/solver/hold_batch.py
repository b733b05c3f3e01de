"""Held states of many designs at once: vectors of designs find most of them, the scalar kernels go on where those end.

A vector solves free states only. A held one is the free one whose force or torque mu gives the length or rotation C that is
held: the first integral guesses mu to a few digits, secants through solved states do the rest::

    mu = mu_1 + (target - C(mu_1))/sigma,    sigma = dC/dmu
"""

from functools import partial
from typing import NamedTuple

import numpy as np
from numba import config

from ..interpret import at_once
from .along.places import NUMBERS
from .along.profile import FIELDS
from .by_middle.many import PIECES
from .halves import one_by_one
from .held.held_states import hold_many
from .held.sought import HELD_LENGTH
from .physics.lagrangian import ROUNDING
from .problem import FORCE, MOONEY_RIVLIN, PHYSICAL, PROBLEM_SIZE, SECOND, THIRD, TORQUE, YEOH, wall_columns
from .status import COMPRESSED, HELD_IMPOSSIBLE, OK, PENDING

TURNS = 5  # solutions of one state, at most; two do nearly always
CLEAR = 20.0  # times its bounds: a difference of C from which a secant is good
DOUBT, BLIND = 0.02, 0.2  # share of the last correction that a secant, or the guess of sigma, may miss, at least
TWIST = 2  # column of a free state's values
HOLDER = 5  # column of the force or torque among a held state's numbers; behind it those of :mod:`.along.places`
STATUS = 14  # place among the arguments of hold_many
LEAST_ACCURACY = 1e-11  # asked of free states


class Holds(NamedTuple):
    """Held states (n,): the force or torque, its bound, status, whether it is stable; of physical tubes the numbers of
    :mod:`.along.places` and their bounds, (n, k).
    """

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    stable: np.ndarray
    along: np.ndarray
    along_bounds: np.ndarray


def _pending(problems, count):
    along = len(NUMBERS) if wall_columns(problems) == PHYSICAL else 0
    return Holds(
        np.full(count, np.nan), np.full(count, np.nan), np.full(count, PENDING, np.int64), np.zeros(count, np.int64),
        *np.full((2, count, along), np.nan),
    )  # fmt: skip


def hold_all(problems, targets, kind, first, pressures, tube, accuracy, lanes=True, soon=False) -> Holds:
    """Hold each problem at its target (k,) under each of its pressures, keeping its torque while its length is held, its
    force while its rotation is; arguments as of :func:`.held.held_states.hold_many`, ``tube`` its (course, edges, places).

    Vectors of designs serve where tubes do not vary. Their numbers do not depend on which designs share a vector; those
    of the scalar kernels alone (``lanes=False``) differ by less than the bounds. ``soon``: a few states need not wait for
    the compiler (:mod:`freesweep.interpret`).
    """
    problems, targets, pressures = map(
        np.ascontiguousarray, (problems, targets, pressures)
    )  # others are compiled for anew
    count, found = len(pressures), _pending(problems, len(pressures))
    numbers = np.full((2, count, HOLDER + 1 + found.along.shape[1]), np.nan)
    scalar = partial(_scalar_calls, problems, targets, kind, first, pressures, tube, accuracy, found, *numbers)
    if lanes and len(tube[0]) == 0 and problems.shape[1] == PROBLEM_SIZE and not config.DISABLE_JIT:
        from .lanes.held import seek_lanes

        given = (
            problems,
            targets,
            first,
            pressures,
            first,
            True,
            _constants(problems[0]),
            *found[:4],
            *np.empty((4, 0)),
        )
        if not (soon and at_once(count, seek_lanes, hold_many, *next(scalar()), instead=given)):
            _hold_lanes(problems, targets, kind, first, pressures, accuracy, found)
    for call in scalar():
        left = np.count_nonzero(call[STATUS] == PENDING)
        if left and not (soon and at_once(left, hold_many, hold_many, *call)):
            hold_many(*call)
    own = np.isfinite(numbers[0, :, HOLDER])
    found.values[own], found.bounds[own] = numbers[:, own, HOLDER]
    found.along[:], found.along_bounds[:] = numbers[:, :, HOLDER + 1 :]
    return found


def _scalar_calls(problems, targets, kind, first, pressures, tube, accuracy, found, values, bounds):
    """Arguments of :func:`hold_many`: of all problems at once, or of each that has to be solved whole."""
    walls, each = wall_columns(problems), np.diff(first)
    others = np.repeat(problems[:, TORQUE if kind == HELD_LENGTH else FORCE], each)
    targets, nothing = np.repeat(targets, each), np.empty(0)
    for own, rows, starts, whole in one_by_one(problems, first, tube, True):
        count = len(pressures[rows])
        yield (
            problems[own], walls, starts, pressures[rows], others[rows], targets[rows], kind, False, *whole, accuracy,
            values[rows], bounds[rows], found.status[rows], found.stable[rows], *np.zeros((2, count), np.int64),
            np.empty((count, 2)), nothing, np.empty((count, FIELDS, 0)),
        )  # fmt: skip


def _hold_lanes(problems, targets, kind, first, pressures, accuracy, found):
    """Hold what vectors can of tubes that do not vary."""
    owners = np.repeat(np.arange(len(problems)), np.diff(first))
    yeoh = np.any(problems[:, [SECOND, THIRD]] != 0.0, axis=1)[owners]
    for constants, some in ((MOONEY_RIVLIN, ~yeoh), (YEOH, yeoh)):
        rows = np.flatnonzero(some & (pressures > 0.0))
        if len(rows):
            _hold(problems, 0.5 * targets, kind == HELD_LENGTH, owners, pressures, rows, constants, accuracy, found)


def refuse(problem, pressures, others, targets, kind, status):
    """Mark in ``status`` what nothing can hold, of a design that is the same all along; arguments as of
    :func:`.held.held_states.hold_many`. To the scalar kernels such a state is the dearest, as they look for it on
    several meshes.
    """
    if config.DISABLE_JIT:
        return
    from .lanes.held import seek_lanes

    count = len(pressures)
    some = np.flatnonzero(pressures > 0.0)
    problems = np.repeat(problem[None], count, axis=0)
    problems[:, TORQUE if kind == HELD_LENGTH else FORCE] = others
    found, each, constants = _pending(problems, count), np.arange(count), _constants(problem)
    seek_lanes(
        problems, 0.5 * targets, each, pressures, some, kind == HELD_LENGTH, constants, *found[:4],
        *np.empty((4, count)),
    )  # fmt: skip
    none = (found.status == COMPRESSED) | (found.status == HELD_IMPOSSIBLE)
    status[none] = found.status[none]


def _constants(problem):
    return YEOH if np.any(problem[[SECOND, THIRD]] != 0.0) else MOONEY_RIVLIN


def _hold(problems, targets, length_held, owners, pressures, rows, constants, accuracy, found):
    """The states of ``rows`` that vectors find; ``targets`` (k,) are of half the tube."""
    from .lanes.free import solve_lanes
    from .lanes.held import seek_lanes

    guesses = np.full((4, len(pressures)), np.nan)
    seek_lanes(problems, targets, owners, pressures, rows, length_held, constants, *found[:4], *guesses)
    rows = rows[np.isfinite(guesses[0, rows])]
    rows = rows[np.argsort(guesses[1, rows], kind="stable")]  # what shares a vector should need much the same work
    stretches, _, mu, sigma = guesses[:, rows]
    own, p, target = problems[owners[rows]], pressures[rows], targets[owners[rows]]
    unknown, given, column = (FORCE, TORQUE, 0) if length_held else (TORQUE, FORCE, TWIST)
    fine, todo = np.full(len(rows), accuracy), np.arange(len(rows))
    before = np.full((3, len(rows)), np.nan)  # mu, C and its bound
    for _ in range(TURNS):
        own[:, unknown] = mu
        c, bound = np.full(len(rows), np.nan), np.full(len(rows), np.nan)
        for asked in np.unique(fine[todo]):
            part = todo[fine[todo] == asked]
            size = len(part)
            free = np.full((2, size, 5), np.nan)
            status, slack = np.full(size, PENDING), np.zeros(size, np.int64)
            middles = np.empty((size, 2))
            for pieces in PIECES:
                left = np.flatnonzero(status == PENDING)
                told = *free, status, slack, middles
                solve_lanes(own, part, p[part], stretches[part], left, constants, pieces, asked, *told)
            c[part], bound[part] = np.where(status == OK, free[:, :, column], np.nan)
        with np.errstate(all="ignore"):
            gain = c - before[1]
            clear = np.abs(gain) > CLEAR * (bound + before[2])
            secant = gain / (mu - before[0])
            doubt = np.where(clear, np.abs(1.0 - sigma / secant) + DOUBT, BLIND)
            sigma = np.where(clear, secant, sigma)
            miss = target - c
            ahead, unsure = mu + miss / sigma, doubt * np.abs(miss)
            size = np.maximum(np.maximum(p, np.abs(ahead)), np.abs(own[:, given]))
            most = accuracy * size * sigma  # of C
            own_bound = (bound + unsure) / sigma + ROUNDING * size
            sound = (sigma > 0.0) & ((p + ahead > 0.0) | (not length_held))
            done = sound & (unsure <= bound) & (own_bound <= accuracy * size)
            finer = 10.0 ** -np.ceil(np.log10(np.maximum(2.0 * bound / most, 1.0)))
        done = done[todo]
        ready = todo[done]
        found.values[rows[ready]], found.bounds[rows[ready]] = ahead[ready], own_bound[ready]
        found.status[rows[ready]], found.stable[rows[ready]] = OK, 1
        todo = todo[~done & sound[todo]]
        fine[todo] = fine[todo] * finer[todo]
        todo = todo[fine[todo] >= LEAST_ACCURACY]
        if len(todo) == 0:
            return
        before[:] = mu, c, bound
        mu = ahead

"""Many designs at once: vectors go the quick way, once more on a finer mesh; the scalar walk goes on where that ends."""

from typing import NamedTuple

import numpy as np
from numba import config

from ..interpret import at_once
from .along.places import NUMBERS
from .along.profile import FIELDS
from .by_middle.many import PIECES, follow_branches
from .free.carried import carried_many
from .free.free_states import follow_many
from .halves import one_by_one
from .load_path import MISSED, is_loaded, legs, next_to_nothing, settling_pressure
from .problem import MOONEY_RIVLIN, PHYSICAL, SECOND, THIRD, THREADS, YEOH, wall_columns
from .status import BEYOND_LIMIT, INACCURATE, NOT_CONVERGED, OK, PENDING

OUTPUTS = 5  # length, volume, twist, energy of half the tube, stretch in the middle; of physical tubes NUMBERS behind
NOTHING = np.empty(0)
FINER = 2  # times the cells of the base mesh, for states that vectors left: the same machine code solves nearly all


class Walks(NamedTuple):
    """Equilibria of many designs: rows of states, but ``limits`` (problems, 2); see :func:`.free.free_states.walk`."""

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    limits: np.ndarray
    profiles: np.ndarray


STATES = tuple(name for name in Walks._fields if name != "limits")


def uniform(cells):
    """``(course, edges, places)`` of tubes that are the same all along, on a base mesh of ``cells``."""
    return np.empty((0, 1, 3, 4)), np.array([0, cells]), np.zeros(2)


def walk_all(problems, first, pressures, tube, accuracy, stations=NOTHING, lanes=True, soon=False) -> Walks:
    """Walk each problem along its pressures; arguments as of :func:`follow_many`, ``tube`` its (course, edges, places).

    Vectors of designs serve where tubes do not vary. Their numbers do not depend on which
    designs share a vector; those of the scalar kernels alone (``lanes=False``) differ by less than the bounds.
    ``soon``: a few states need not wait for the compiler (:mod:`freesweep.interpret`).
    """
    problems, pressures = (
        np.ascontiguousarray(problems),
        np.ascontiguousarray(pressures),
    )  # others would be compiled for anew
    found = _nothing(problems, len(pressures), stations)
    pressures, limp = next_to_nothing(problems, first, pressures)
    drawn = len(stations) > 0 and wall_columns(problems) == PHYSICAL  # vectors draw no profiles of such tubes
    if lanes and len(tube[0]) == 0 and not drawn and not config.DISABLE_JIT:
        calls = _scalar_calls(problems, first, pressures, tube, accuracy, stations, found)
        solve, given = _vector_call(problems, stations)
        if soon and all(at_once(len(call[4]), solve, follow_many, *call, instead=given) for call in calls):
            found.status[_doubt(problems, first, pressures, found)] = PENDING
        if np.any(found.status == PENDING):
            _walk_lanes(problems, first, pressures, int(tube[1][-1]), accuracy, stations, found)
        if wall_columns(problems) == PHYSICAL:
            kinds = [(kind, some) for _, _, kind, some in _kinds(problems)]
            follow_branches(problems, first, pressures, kinds, accuracy, found)
    for call in _scalar_calls(problems, first, pressures, tube, accuracy, stations, found):
        left = np.count_nonzero(call[11] == PENDING)
        if left and not (soon and at_once(left, follow_many, follow_many, *call)):
            follow_many(*call)
    if drawn and lanes and len(tube[0]) == 0 and not config.DISABLE_JIT:
        doubtful = _doubt(problems, first, pressures, found)
        if np.any(doubtful):
            _replace(found, doubtful, walk_all(problems, first, pressures, tube, accuracy))
    found.bounds[limp] += MISSED * np.abs(found.values[limp])
    return found


def walk_by_vectors(problems, first, pressures, cells, accuracy) -> Walks:
    """:func:`walk_all` of tubes that do not vary: what vectors find, PENDING where they leave it open."""
    found = _nothing(problems, len(pressures), NOTHING)
    pressures, _ = next_to_nothing(problems, first, pressures)
    _walk_lanes(problems, first, pressures, cells, accuracy, NOTHING, found)
    return found


def _scalar_calls(problems, first, pressures, tube, accuracy, stations, found):
    """Arguments of :func:`follow_many`: of all problems at once, or of each that has to be solved whole."""
    walls, settled = wall_columns(problems), settling_pressure(problems)
    for own, rows, starts, whole in one_by_one(problems, first, tube):
        yield (
            problems[own], walls, settled[own], starts, pressures[rows], *whole, accuracy,
            *(array[rows] for array in found[:4]), found.limits[own], stations, found.profiles[rows],
        )  # fmt: skip


def _doubt(problems, first, pressures, found):
    """Which states of physical tubes scalar kernels did not find, or found where the uniform tube does not lead: a coarse
    mesh may pass over a small snap, which the first integral sees.
    """
    walls = wall_columns(problems)
    if walls != PHYSICAL:
        return np.zeros(len(pressures), bool)
    carried = np.zeros(len(pressures), np.int64)
    call = problems, walls, settling_pressure(problems), first, pressures, carried
    if not at_once(len(pressures), carried_many, carried_many, *call):
        carried_many(*call)
    valued = np.isin(found.status, (OK, INACCURATE))
    return (valued & (carried == 0)) | np.isin(found.status, (BEYOND_LIMIT, NOT_CONVERGED))


def _replace(found, rows, better):
    """Put what is known ``better`` into these rows. Profiles stay where they are of the same states; where there are none,
    the status says that something is missing.
    """
    apart = np.abs(found.values - better.values)[:, :OUTPUTS]
    alike = np.all(apart <= (found.bounds + better.bounds)[:, :OUTPUTS], axis=1)
    for name in STATES[:-1]:
        getattr(found, name)[rows] = getattr(better, name)[rows]
    found.limits[:] = better.limits
    found.profiles[rows & ~alike] = np.nan
    found.status[rows & ~alike & (found.status == OK)] = INACCURATE


def _walk_lanes(problems, first, pressures, base, accuracy, stations, found, most=None):
    """Solve what vectors can of tubes that do not vary, in so many tries at ``most``. A loaded one's stretch is carried up
    and down from the state at which its loads have settled.
    """
    if not np.any(is_loaded(problems)):
        _solve_lanes(problems, first, pressures, np.ones(len(pressures), bool), base, accuracy, stations, found, most)
        return
    own = legs(problems, first, pressures)
    asked = own.rows >= 0
    on_the_way = _nothing(problems[own.owners], len(own.pressures), stations)
    _solve_lanes(problems[own.owners], own.first, own.pressures, asked, base, accuracy, stations, on_the_way, most)
    for name in STATES:
        getattr(found, name)[own.rows[asked]] = getattr(on_the_way, name)[asked]


def _nothing(problems, states, stations):
    """Room for walks that are not made yet."""
    columns = OUTPUTS + (len(NUMBERS) if wall_columns(problems) == PHYSICAL else 0)
    return Walks(
        np.full((states, columns), np.nan), np.full((states, columns), np.nan), np.full(states, PENDING, np.int64),
        np.zeros(states, np.int64), np.full((len(problems), 2), np.nan), np.full((states, FIELDS, len(stations)), np.nan),
    )  # fmt: skip


def _solve_lanes(problems, first, pressures, asked, base, accuracy, stations, found, most=None):
    """Solve the states that are ``asked`` for, on walks along pressures that rise or fall."""
    # what shares a vector should need much the same work: as many pressures, and likeness tells the rest
    steps = np.diff(first)
    owners, order = np.repeat(np.arange(len(problems)), steps), np.argsort(steps, kind="stable")
    stretches, likeness = np.full(len(pressures), np.nan), np.full(len(pressures), np.nan)
    drawn = (stations, found.profiles) if len(stations) else (None, None)
    for carry, solve, kind, some in _kinds(problems):
        carry(problems, first, pressures, order[some[order]], *kind, *found[:3], stretches, likeness)
        carried = some[owners] & asked & np.isfinite(stretches)
        for fineness in tries(problems, base)[:most]:
            rows = np.flatnonzero(carried & (found.status == PENDING))
            alike = np.argsort(_in_order(likeness[rows]), kind="stable")
            solve(
                problems, owners, pressures, stretches, rows[alike], *kind, fineness, accuracy, *found[:4],
                *(drawn if len(kind) == 1 else ()),
            )  # fmt: skip


def _vector_call(problems, stations):
    """The entry point by which vectors solve such problems as the first, and arguments of the kinds that it is given."""
    (_, solve, kind, _), whole, states = next(_kinds(problems[:1])), np.empty(0, np.int64), np.empty((0, OUTPUTS))
    drawn = () if len(kind) > 1 else (NOTHING, np.empty((0, FIELDS, 0))) if len(stations) else (None, None)
    return solve, (
        problems, whole, NOTHING, NOTHING, whole, *kind, 1, 1.0, states, states, whole, whole, *drawn
    )  # fmt: skip


def tries(problems, base):
    """How fine one try after the other is: cells of the base mesh; of physical tubes, which need none, in how many
    pieces each part of the way is summed in which the same fibers pull.
    """
    return PIECES if wall_columns(problems) == PHYSICAL else (base, FINER * base)


def _kinds(problems):
    """``(carry, solve, kind, which problems)``: the kernels of vectors, and what is the same for all that share one."""
    from .lanes import free
    from .lanes.pack import count_layers

    yeoh = np.any(problems[:, [SECOND, THIRD]] != 0.0, axis=1)
    kinds = yeoh[:, None].astype(np.int64)
    if wall_columns(problems) == PHYSICAL:
        count = np.empty(len(problems), np.int64)
        count_layers(problems, PHYSICAL, count)
        kinds = np.column_stack([kinds, count, problems[:, THREADS]])
    for kind in np.unique(kinds, axis=0):
        some, constants = np.all(kinds == kind, axis=1), (YEOH if kind[0] else MOONEY_RIVLIN)
        if len(kind) == 1:
            yield free.carry_lanes, free.solve_lanes, (constants,), some
        else:
            yield free.carry_physical, free.solve_physical, (constants, int(kind[1])), some


def _in_order(likeness):
    """Short integers, which are sorted in no time; finer where the ends are steep."""
    return (np.sqrt(np.fmin(np.fmax(likeness, 0.0), 1.0)) * np.iinfo(np.uint16).max).astype(np.uint16)

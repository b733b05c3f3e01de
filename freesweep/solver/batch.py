"""Many designs at once: vectors go the quick way, branches are followed where that ends; tubes that vary go by meshes."""

from typing import NamedTuple

import numpy as np
from numba import config

from ..interpret import run
from .along.places import NUMBERS
from .along.profile import FIELDS
from .by_middle.many import PIECES, follow_branches
from .free.free_states import follow_many
from .halves import one_by_one
from .load_path import MISSED, is_loaded, legs, next_to_nothing, settling_pressure
from .problem import MOONEY_RIVLIN, PHYSICAL, SECOND, THIRD, THREADS, YEOH, D, wall_columns
from .status import INACCURATE, NOT_CONVERGED, OK, PENDING

OUTPUTS = 5  # length, volume, twist, energy of half the tube, stretch in the middle; of physical tubes NUMBERS behind
MIDDLE = OUTPUTS - 1
NOTHING = np.empty(0)


class Walks(NamedTuple):
    """Equilibria of many designs: rows of states, but ``limits`` (problems, 2); see :func:`.free.free_states.walk`. The
    ``middles`` are those of :func:`.lanes.profile.draw`.
    """

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    middles: np.ndarray
    profiles: np.ndarray
    limits: np.ndarray


STATES = Walks._fields[:5]  # what vectors find


def uniform(cells):
    """``(course, edges, places)`` of tubes that are the same all along, on a base mesh of ``cells``."""
    return np.empty((0, 1, 3, 4)), np.array([0, cells]), np.zeros(2)


def walk_all(problems, first, pressures, tube, accuracy, stations=NOTHING, lanes=True, soon=False) -> Walks:
    """Walk each problem along its pressures; arguments as of :func:`follow_many`, ``tube`` its (course, edges, places).

    Tubes that are the same all along go by their first integral, in vectors of designs; their numbers do not depend on
    which designs share a vector. Those of meshes (``lanes=False``), by which tubes go that vary, differ by less than
    the bounds. ``soon``: a few states need not wait for the compiler (:mod:`freesweep.interpret`).
    """
    problems, pressures = (
        np.ascontiguousarray(problems),
        np.ascontiguousarray(pressures),
    )  # others would be compiled for anew
    found = _nothing(problems, len(pressures), stations)
    pressures, limp = next_to_nothing(problems, first, pressures)
    if lanes and len(tube[0]) == 0 and not config.DISABLE_JIT:
        _walk_lanes(problems, first, pressures, accuracy, found, soon)
        kinds = [(kind, some) for _, _, kind, some in kinds_of(problems)]
        follow_branches(problems, first, pressures, kinds, accuracy, found, soon)
        found.status[found.status == PENDING] = NOT_CONVERGED
        if len(stations):
            _draw(problems, first, pressures, stations, accuracy, found, soon)
    else:
        for call in _scalar_calls(problems, first, pressures, tube, accuracy, stations, found):
            run(follow_many, len(call[4]), soon, *call)
    found.bounds[limp] += MISSED * np.abs(found.values[limp])
    return found


def walk_by_vectors(problems, first, pressures, accuracy, most=None) -> Walks:
    """:func:`walk_all` of tubes that do not vary: what vectors find in so many tries at ``most``, PENDING
    elsewhere.
    """
    found = _nothing(problems, len(pressures), NOTHING)
    pressures, _ = next_to_nothing(problems, first, pressures)
    _walk_lanes(problems, first, pressures, accuracy, found, False, most)
    return found


def _scalar_calls(problems, first, pressures, tube, accuracy, stations, found):
    """Arguments of :func:`follow_many`: of all problems at once, or of each that has to be solved whole."""
    walls, settled = wall_columns(problems), settling_pressure(problems)
    for own, rows, starts, whole in one_by_one(problems, first, tube):
        yield (
            problems[own], walls, settled[own], starts, pressures[rows], whole, accuracy,
            *(array[rows] for array in found[:4]), found.limits[own], stations, found.profiles[rows],
        )  # fmt: skip


def _walk_lanes(problems, first, pressures, accuracy, found, soon, most=None):
    """Solve what vectors can of tubes that do not vary, in so many tries at ``most``. A loaded one's stretch is carried up
    and down from the state at which its loads have settled.
    """
    if not np.any(is_loaded(problems)):
        _solve_lanes(problems, first, pressures, np.ones(len(pressures), bool), accuracy, found, soon, most)
        return
    own = legs(problems, first, pressures)
    asked = own.rows >= 0
    on_the_way = _nothing(problems[own.owners], len(own.pressures), NOTHING)
    _solve_lanes(problems[own.owners], own.first, own.pressures, asked, accuracy, on_the_way, soon, most)
    for name in STATES:
        getattr(found, name)[own.rows[asked]] = getattr(on_the_way, name)[asked]


def _nothing(problems, states, stations):
    """Room for walks that are not made yet."""
    columns = OUTPUTS + (len(NUMBERS) if wall_columns(problems) == PHYSICAL else 0)
    return Walks(
        np.full((states, columns), np.nan), np.full((states, columns), np.nan), np.full(states, PENDING, np.int64),
        np.zeros(states, np.int64), np.full((states, 2), np.nan), np.full((states, FIELDS, len(stations)), np.nan),
        np.full((len(problems), 2), np.nan),
    )  # fmt: skip


def _solve_lanes(problems, first, pressures, asked, accuracy, found, soon, most):
    """Solve the states that are ``asked`` for, on walks along pressures that rise or fall."""
    # what shares a vector should need much the same work: like angles, and likeness tells the rest
    owners, order = np.repeat(np.arange(len(problems)), np.diff(first)), np.argsort(problems[:, D], kind="stable")
    stretches, likeness = np.full(len(pressures), np.nan), np.full(len(pressures), np.nan)
    for carry, solve, kind, some in kinds_of(problems):
        given = problems, first, pressures, order[some[order]], *kind, *found[:3], stretches, likeness
        run(carry, len(pressures), soon, *given)
        carried = some[owners] & asked & np.isfinite(stretches)
        for pieces in PIECES[:most]:
            rows = np.flatnonzero(carried & (found.status == PENDING))
            alike = np.argsort(_in_order(likeness[rows]), kind="stable")
            given = problems, owners, pressures, stretches, rows[alike], *kind, pieces, accuracy, *found[:5]
            if len(rows):
                run(solve, len(rows), soon, *given)
    found.middles[found.status == PENDING] = np.nan  # others may find these states elsewhere


def _draw(problems, first, pressures, stations, accuracy, found, soon):
    """Draw the states that were found; what no rule tells to the accuracy has a status that says so."""
    rows = np.flatnonzero(np.isin(found.status, (OK, INACCURATE)) & (found.bounds[:, 0] > 0.0))  # at rest, exactly
    met = np.isnan(found.middles[:, 0])  # on a branch, by the stretch in the middle
    found.middles[met, 0] = found.values[met, MIDDLE]
    owners = np.repeat(np.arange(len(problems)), np.diff(first))
    drawn = draw(problems, owners, pressures, found.middles, rows, stations, accuracy, found.profiles, soon)
    found.status[rows[~drawn[rows]]] = INACCURATE


def draw(problems, owners, pressures, middles, rows, stations, accuracy, profiles, soon):
    """Draw these rows of states from their ``middles``, into ``profiles``; returns which meet the accuracy, (n,)."""
    from .lanes.profile import draw_lanes, draw_physical

    drawn = np.zeros(len(pressures), bool)
    for _, _, kind, some in kinds_of(problems):
        draw = draw_lanes if len(kind) == 1 else draw_physical
        for pieces in PIECES:
            left = rows[some[owners[rows]] & ~drawn[rows]]
            if len(left):
                given = problems, owners, pressures, middles, left, stations, *kind, pieces, accuracy
                run(draw, len(left), soon, *given, profiles, drawn)
    return drawn


def kinds_of(problems):
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

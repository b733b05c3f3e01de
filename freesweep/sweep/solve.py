"""One shard of a sweep: some distinct problems of one kind, solved by the kernels into records."""

import numpy as np

from ..description.profiles import SENSITIVITY, widened
from ..status import INVALID
from .canonical_problem import PHYSICAL
from .records import HELD_STATE, LIMIT, state, unsolved, upward

BASE_CELLS = 24
UNIFORM = np.empty((0, 1, 3, 4)), np.array([0, BASE_CELLS]), np.zeros(2)


def is_physical(problems):
    """Whether rows of problems are those of physical tubes."""
    return problems.shape[1] > PHYSICAL


def solve_shard(job, accuracy, lanes=True):
    """Records of a job's states, and of its problems' limits (none of held states).

    ``lanes=False``: by the scalar kernels alone, which else go on where vectors of designs end.
    """
    solve = _solve_free if job.kind == "free" else _solve_held
    if not job.courses:
        return solve(job.kind, job.problems, job.targets, job.first, job.pressures, (UNIFORM, 0.0), accuracy, lanes)
    states = np.zeros(len(job.pressures), state(job.kind, is_physical(job.problems)))
    limits = np.full(len(job.problems) if job.kind == "free" else 0, np.nan, LIMIT)
    for k, tube in enumerate(job.courses):
        own = np.flatnonzero(job.course == k)
        rows = np.concatenate([np.arange(job.first[i], job.first[i + 1]) for i in own])
        if tube is None:  # a profile that no mesh can follow
            states[rows] = unsolved(states.dtype, INVALID)
            continue
        first = np.concatenate([[0], np.cumsum(np.diff(job.first)[own])])
        found = solve(job.kind, job.problems[own], job.targets[own], first, job.pressures[rows], tube, accuracy, lanes)
        states[rows] = found[0]
        if len(limits):
            limits[own] = found[1]
    return states, limits


def _solve_free(_, problems, __, first, pressures, followed, accuracy, lanes=True):
    from ..solver.batch import walk_all

    tube, error = followed
    walks = walk_all(problems, first, pressures, tube, accuracy - SENSITIVITY * error, lanes=lanes)
    states = np.empty(len(pressures), state("free", is_physical(problems)))
    states["values"], states["bounds"] = walks.values, upward(widened(walks.values, walks.bounds, error))
    states["status"], states["slack"] = walks.status, walks.slack
    found = np.empty(len(problems), LIMIT)
    found["limit"], found["bound"] = walks.limits[:, 0], widened(*walks.limits.T, error)
    return states, found


def _solve_held(kind, problems, targets, first, pressures, followed, accuracy, lanes=True):
    from ..solver.held.held_state import HELD_LENGTH, HELD_ROTATION
    from ..solver.hold_batch import hold_all

    tube, error = followed
    held = HELD_LENGTH if kind == "blocked_force" else HELD_ROTATION
    found = hold_all(problems, targets, held, first, pressures, tube, accuracy - SENSITIVITY * error, lanes)
    states = np.empty(len(pressures), HELD_STATE)
    states["value"], states["bound"] = found.values, upward(widened(found.values, found.bounds, error))
    states["status"], states["stable"] = found.status, found.stable
    return states, np.empty(0, LIMIT)

"""One shard of a sweep: some distinct problems of one kind, solved by the kernels into records."""

import numpy as np

from ..description.families import beyond_a_point
from ..description.splines import SENSITIVITY, widened
from ..description.tube_model import THREADS as CODES
from ..scaling import OUTPUTS, SLACK
from ..status import DEGENERATE, INVALID
from .canonical_problem import PHYSICAL, THREADS
from .records import LIMIT, state, unsolved, upward

BASE_CELLS = 24
THREADS_OF_TWO = CODES[2, "loose"]  # the largest of those of two families
UNIFORM = np.empty((0, 1, 3, 4)), np.array([0, BASE_CELLS]), np.zeros(2)


def is_physical(problems):
    """Whether rows of problems are those of physical tubes."""
    return problems.shape[1] > PHYSICAL


def solve_shard(job, accuracy, lanes=True):
    """Records of a job's states, and of its problems' limits (none of held states).

    ``lanes=False``: by the scalar kernels alone, which else go on where vectors of designs end.
    """
    solve = _solve_free if job.kind == "free" else _solve_held
    if job.kind == "free" and (locks := _locks(job)) is not None:
        return _unlocked(job, locks, accuracy, lanes)
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


def _locks(job):
    """Which states of a job are no locked shapes that there are not, (n,); None if all are."""
    if not is_physical(job.problems):
        return None
    few = np.repeat(job.problems[:, THREADS] > THREADS_OF_TWO, np.diff(job.first))
    none = few & np.isinf(job.pressures)
    return ~none if none.any() else None


def _unlocked(job, locks, accuracy, lanes):
    """Records of a job some of whose locked shapes there are not: fewer than two families leave them free."""
    first = np.concatenate([[0], np.cumsum(locks)])[job.first]
    found, limits = solve_shard(job._replace(first=first, pressures=job.pressures[locks]), accuracy, lanes)
    states = np.full(len(locks), unsolved(found.dtype, DEGENERATE))
    states[locks] = found
    return states, limits


def _solve_free(_, problems, __, first, pressures, followed, accuracy, lanes=True):
    from ..solver.batch import walk_all

    tube, error = followed
    walks = walk_all(problems, first, pressures, tube, accuracy - SENSITIVITY * error, lanes=lanes)
    states = np.empty(len(pressures), state("free", is_physical(problems)))
    states["values"], states["bounds"] = walks.values, upward(widened(walks.values, walks.bounds, error))
    states["status"], states["slack"] = walks.status, walks.slack
    if is_physical(problems):
        shares = walks.values[:, len(OUTPUTS) : len(OUTPUTS) + len(SLACK)]
        states["slack"] = beyond_a_point(walks.slack, *shares.T)
    found = np.empty(len(problems), LIMIT)
    found["limit"], found["bound"] = walks.limits[:, 0], widened(*walks.limits.T, error)
    return states, found


def _solve_held(kind, problems, targets, first, pressures, followed, accuracy, lanes=True):
    from ..solver.held.held_state import HELD_LENGTH, HELD_ROTATION
    from ..solver.hold_batch import hold_all

    tube, error = followed
    held = HELD_LENGTH if kind == "blocked_force" else HELD_ROTATION
    found = hold_all(problems, targets, held, first, pressures, tube, accuracy - SENSITIVITY * error, lanes=lanes)
    states = np.empty(len(pressures), state(kind, is_physical(problems)))
    states["value"], states["bound"] = found.loads, upward(widened(found.loads, found.load_bounds, error))
    states["status"], states["stable"] = found.status, found.stable
    if is_physical(problems):
        slack, bound = (array[:, len(OUTPUTS) : len(OUTPUTS) + len(SLACK)] for array in found.states[:2])
        states["slack"], states["slack_bound"] = slack, upward(widened(slack, bound, error))
    return states, np.empty(0, LIMIT)

"""Walks whose loads all rise in proportion to the first pressure: hard ways for the kernels, of which no actuator asks."""

from unittest import mock

import numpy as np

from freesweep.census.designs import _tubes
from freesweep.first_integral.folded import solve_near
from freesweep.solver import batch
from freesweep.solver.by_middle import many
from freesweep.solver.status import NOT_CONVERGED, PENDING


def in_proportion(problems, first, pressures):
    """States of ``problems`` (n, 11), whose loads are at their full size at the first of each one's ``pressures``."""
    problems, pressures = np.ascontiguousarray(problems), np.ascontiguousarray(pressures, dtype=float)
    first, found = np.asarray(first), batch._nothing(problems, len(pressures), batch.NOTHING)
    kinds = [(kind, some) for _, _, kind, some in batch.kinds_of(problems)]
    with mock.patch.object(many, "settling_pressure", return_value=pressures[first[:-1]]):
        many.follow_branches(problems, first, pressures, kinds, 1e-6, found)
    found.status[found.status == PENDING] = NOT_CONVERGED
    return found


def judged_near(designs, mid_radius):
    """Values and errors (n, 5) of ``designs`` (n, 10) by the second method, of the equilibria with about such middles."""
    found = solve_near(_tubes(designs), mid_radius)
    of_half = np.array([0.5, 0.5, 0.5, 0.5, 1.0])
    return found.values * of_half, found.errors * of_half

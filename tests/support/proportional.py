"""Walks whose loads all rise in proportion to the first pressure: hard ways for the kernels, of which no actuator asks."""

import numpy as np

from freesweep.census.designs import _tubes
from freesweep.first_integral.folded import solve_near
from freesweep.solver import batch


def in_proportion(problems, first, pressures):
    """States of ``problems`` (n, 11), whose loads are at their full size at the first of each one's ``pressures``."""
    problems, pressures = np.ascontiguousarray(problems), np.ascontiguousarray(pressures, dtype=float)
    first, nothing = np.asarray(first), batch.NOTHING
    found = batch._nothing(problems, len(pressures), nothing)
    batch.follow_many(
        problems,
        batch.wall_columns(problems),
        pressures[first[:-1]],
        first,
        pressures,
        *batch.uniform(24),
        1e-6,
        *found[:5],
        nothing,
        found.profiles,
    )
    return found


def judged_near(designs, mid_radius):
    """Values and errors (n, 5) of ``designs`` (n, 10) by the second method, of the equilibria with about such middles."""
    found = solve_near(_tubes(designs), mid_radius)
    of_half = np.array([0.5, 0.5, 0.5, 0.5, 1.0])
    return found.values * of_half, found.errors * of_half

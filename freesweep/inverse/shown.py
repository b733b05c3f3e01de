"""What a picture of candidates shows: their curves over the pressure, and their shapes."""

import math
import warnings
from typing import NamedTuple

import numpy as np

from .predict import state_of
from .singles import solve_single, states_of
from .wishes import UNITS

CANDIDATES, GOALS = 5, 2  # that are shown
PRESSURES, BEYOND = 61, 1.25  # of a curve, up to so many times the pressure that was asked for
ROUGH = 1e-5  # accuracy
LOADS = ("pressure", "force", "torque")


class Curve(NamedTuple):
    """An output over the ``pressure`` (p,) [Pa]: ``values`` (candidates, p); what was ``asked``: (pressure, low, high)."""

    output: str
    unit: str
    pressure: np.ndarray
    values: np.ndarray
    asked: list


class Shape(NamedTuple):
    """A candidate at a ``pressure`` [Pa]: position and radius (x,) [m], rotation [degree]; length and radius at ``rest``."""

    pressure: float
    position: np.ndarray
    radius: np.ndarray
    rotation: float
    rest: tuple


def shown(found, tubes, goals):
    """``(curves, shapes)`` of the first of the ``tubes`` in ``found``, for :func:`freesweep.plot.candidates.draw`."""
    tubes = tubes[:CANDIDATES]
    loads = [
        {name: float(found[name].values[k]) if name in found else 0.0 for name in LOADS} for k in range(len(tubes))
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said where the candidates were found
        curves = [
            _curve(goal, tubes, loads) for goal in goals if goal.wishes([])[0].kind in ("free", "force", "torque")
        ]
        return curves[:GOALS], _shapes(goals, tubes, loads)


def _pressures(goal, loads):
    given = [dict(wish.conditions).get("pressure", loads[0]["pressure"]) for wish in goal.wishes([])]
    return [p for p in given if math.isfinite(p)]


def _curve(goal, tubes, loads):
    wishes, asked = goal.wishes([]), _pressures(goal, loads)
    grid = np.linspace(0.0, BEYOND * max(asked), PRESSURES)[1:]
    first = state_of(wishes[0])
    rest = tuple(item for item in first.conditions if item[0] != "pressure")
    states = {first._replace(conditions=(*rest, ("pressure", p))): [goal.output] for p in grid.tolist()}
    values = []
    for tube, own in zip(tubes, loads):
        answers = solve_single(tube, states, tube.design() | own, ROUGH)
        values.append([answers[state][goal.output][0] for state in states])
    ends = [[end for end in (wish.low, wish.high) if math.isfinite(end)] for wish in wishes]
    marks = [(p, min(end), max(end)) for p, end in zip(asked, ends)]
    return Curve(goal.output, UNITS.get(goal.output, ""), grid, np.array(values), marks)


def _shapes(goals, tubes, loads):
    """In the state of the first goal that has a pressure: free, or held as it says."""
    asked = [wish for goal in goals for wish in goal.wishes([]) if wish.kind in ("free", "force", "torque")]
    asked = [wish for wish in asked if math.isfinite(dict(wish.conditions).get("pressure", 0.0))]
    kind, conditions = (asked[0].kind, dict(asked[0].conditions)) if asked else ("free", {})
    rest = tuple(item for item in conditions.items() if item[0] != "pressure")
    found = []
    for tube, own in zip(tubes, loads):
        given = own | conditions
        state = states_of(tube, kind, rest, given["pressure"], given, None, accuracy=ROUGH)
        position, radius = state["axial_position"].values, state["deformed_radius"].values
        rotation = float(state["rotation"])
        found.append(Shape(given["pressure"], position, radius, rotation, (tube.length, tube.fiber_surface)))
    return found

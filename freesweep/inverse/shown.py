"""What a picture of candidates shows: their curves over the pressure, and their shapes."""

import math
import warnings
from typing import NamedTuple

import numpy as np

from .predict import state_of
from .singles import solve_single, states_of
from .wishes import UNITS

CANDIDATES, CURVES = 5, 2  # that are shown
PRESSURES, BEYOND = 61, 1.25  # of a curve, up to so many times the pressure that was asked for
BETWEEN = 13  # places of a curve over what is held, or over another load, whose states are dearer
ROUGH = 1e-5  # accuracy
LOADS = ("pressure", "force", "torque")
STATES = ("free", "force", "torque")  # kinds of wishes that have a curve and a shape


class Curve(NamedTuple):
    """An output ``along`` a condition, ``at`` (p,): ``values`` (candidates, p); what was ``asked``: (at, low, high)."""

    output: str
    unit: str
    along: str
    at: np.ndarray
    values: np.ndarray
    asked: list


class Shape(NamedTuple):
    """A candidate at a ``pressure`` [Pa], ``held`` by a "force", a "torque" or "": position and radius (x,) [m], rotation
    [degree]; length and radius at ``rest``.
    """

    pressure: float
    held: str
    position: np.ndarray
    radius: np.ndarray
    rotation: float
    rest: tuple


def shown(found, tubes, goals, limits=()):
    """``(curves, shapes)`` of the first of the ``tubes`` in ``found``, for :func:`freesweep.plot.candidates.draw`: of the
    first goals, and of limits where these are fewer.
    """
    tubes = tubes[:CANDIDATES]
    loads = [
        {name: float(found[name].values[k]) if name in found else 0.0 for name in LOADS} for k in range(len(tubes))
    ]
    wishes = [one.wishes([]) for one in (*goals, *limits)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said where the candidates were found
        drawn = [own for own in wishes if own[0].kind in STATES][:CURVES]
        return [_curve(own, tubes, loads) for own in drawn], _shapes(wishes, tubes, loads)


def _along(wishes):
    """The condition along which a curve goes: what its wishes differ in, else the pressure."""
    conditions = [dict(wish.conditions) for wish in wishes]
    differ = [name for name in conditions[0] if len({own[name] for own in conditions}) > 1]
    return differ[0] if len(differ) == 1 else "pressure"


def _curve(wishes, tubes, loads):
    output, along = wishes[0].output, _along(wishes)
    asked = [dict(wish.conditions).get(along, loads[0].get(along)) for wish in wishes]
    known = [at for at in asked if math.isfinite(at)]
    if along == "pressure":
        grid = np.linspace(0.0, BEYOND * max(known), PRESSURES)[1:]
    else:
        grid = np.linspace(min(known), max(known), BETWEEN)
    first = state_of(wishes[0])
    rest = tuple(item for item in first.conditions if item[0] != along)
    states = {first._replace(conditions=(*rest, (along, at))): [output] for at in grid.tolist()}
    values = []
    for tube, own in zip(tubes, loads):
        answers = solve_single(tube, states, tube.design() | own, ROUGH)
        values.append([answers[state][output][0] for state in states])
    marks = [(at, wish.low, wish.high) for at, wish in zip(asked, wishes) if math.isfinite(at)]
    return Curve(output, UNITS.get(output, ""), along, grid, np.array(values), marks)


def _tells_little(wish):
    """A held tube that is as long as undeformed, or not turned, often is the cylinder that it was; a free one is not."""
    held = dict(wish.conditions)
    return wish.kind != "free", held.get("deformed_length", math.inf), -abs(held.get("rotation", 0.0))


def _shapes(wishes, tubes, loads):
    """In that state wished for at a pressure which tells most, free, or held as it says."""
    asked = [wish for own in wishes for wish in own if wish.kind in STATES]
    asked = [wish for wish in asked if math.isfinite(dict(wish.conditions).get("pressure", 0.0))]
    asked.sort(key=_tells_little)
    kind, conditions = (asked[0].kind, dict(asked[0].conditions)) if asked else ("free", {})
    rest = tuple(item for item in conditions.items() if item[0] != "pressure")
    held = "" if kind == "free" else kind
    found = []
    for tube, own in zip(tubes, loads):
        given = own | conditions
        state = states_of(tube, kind, rest, given["pressure"], given, None, accuracy=ROUGH)
        position, radius = state["axial_position"].values, state["deformed_radius"].values
        rotation = float(state["rotation"])
        found.append(Shape(given["pressure"], held, position, radius, rotation, (tube.length, tube.fiber_surface)))
    return found

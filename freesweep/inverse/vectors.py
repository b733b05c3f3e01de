"""States of the source's tubes that are the same all along: all designs and all states of a kind in one call."""

import numpy as np

from ..derivative.request import SHAPE
from ..interpret import foretell
from ..query.exact import solve
from ..query.reference import COLUMNS, LENGTH_HELD, LOADED, LOCKED, ROTATION_HELD
from ..status import INVALID, OK
from .outputs import output
from .stiff import stiffness
from .wishes import HELD, STIFF

KINDS = {"free": LOADED, "locked": LOCKED, "force": LENGTH_HELD, "torque": ROTATION_HELD, "limit": LOADED}
TOLD = (*SHAPE, "stroke", "length_change", "outer_radius", "limit_pressure", *HELD, *STIFF)  # outputs
HARDLY = 1e-3  # [Pa]: the pressure of a limit that nothing is asked of


def solve_vectors(energy, asked, columns, accuracy, thorough=True) -> dict:
    """For each state in ``asked`` (state -> outputs) of designs (name -> (n,)): "status" and, by output, (value, bound).
    Not ``thorough``: what vectors cannot do has no value.
    """
    from ..solver.lanes.free import solve_lanes

    foretell(solve_lanes)
    answers, count = {}, len(columns["radius"])
    none = np.zeros(count)  # of what makes bodies
    for kind in dict.fromkeys(state.kind for state in asked):
        states = [state for state in asked if state.kind == kind]
        parts = [_points(state, columns, count) for state in states]
        points = np.concatenate([np.column_stack([part.get(name, none) for name in COLUMNS]) for part in parts])
        most = max(part["pressure"].max(initial=0.0) for part in parts) if kind == "limit" else None
        found = solve(KINDS[kind], points, energy, accuracy, most, thorough=thorough)
        for k, (state, part) in enumerate(zip(states, parts)):
            own = {name: array[k * count : (k + 1) * count] for name, array in found.items()}
            own |= stiffness(asked[state], kind, own, part, energy)
            answers[state] = {name: output(name, kind, own, part) for name in asked[state]}
            limit = np.where(own["status"] == INVALID, INVALID, OK)
            answers[state]["slack"] = np.where(kind == "limit", 0, own["slack_fiber"]).astype(np.int8)
            answers[state]["status"] = limit if kind == "limit" else own["status"]
    return answers


def _points(state, columns, count):
    """Columns of the points of one state."""
    given = dict(state.conditions)
    points = columns | {name: np.full(count, value) for name, value in given.items()} | {"held": np.zeros(count)}
    if state.kind == "limit":
        points["pressure"] = np.full(count, HARDLY if state.least is None else state.least)
    elif state.kind in HELD:
        held = HELD[state.kind][0]
        if state.kind == "force":
            points["held"] = points[held] / points["length"] if held in given else np.ones(count)
        else:
            points["held"] = points[held] if held in given else np.zeros(count)
        points[state.kind] = np.zeros(count)
    return points

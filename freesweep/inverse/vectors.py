"""States of tubes that are the same all along: all designs and all states of a kind in one call."""

from typing import NamedTuple

import numpy as np

from ..derivative.request import SHAPE
from ..description.families import given_by
from ..description.tube_model import TubeModel
from ..interpret import foretell
from ..query.exact import Tubes, solve
from ..query.reference import COLUMNS, LENGTH_HELD, LOADED, LOCKED, ROTATION_HELD
from ..scaling import PULLS, SLACK
from ..status import INVALID, NOT_CONVERGED, OK
from .beside import Held, beside
from .by_loads import hold_by_loads, straight_loads
from .outputs import output
from .predict import STABLE, UNKNOWN
from .stiff import stiffness
from .wishes import HELD, STIFF

KINDS = {"free": LOADED, "locked": LOCKED, "force": LENGTH_HELD, "torque": ROTATION_HELD, "limit": LOADED}
ALONG = (*SLACK, *PULLS)  # what only sums along the depth tell (:mod:`freesweep.solver.lanes.sums`)
WORST = ("outer_radius", "largest_stretch")
TOLD = (*SHAPE, "stroke", "length_change", *HELD, *ALONG)  # outputs, of all tubes
OF_SOURCE = (*WORST, "limit_pressure")
HARDLY = 1e-3  # [Pa]: the pressure of a limit that nothing is asked of
STRAIGHT = 1e-6  # strain in the middle: beside it a tube is straight, and leads to none that is not
ONSET = 1e-2  # strain of the middle from which a state is looked for beside a straight one
SUMMED = 1e-6  # accuracy that such sums have nearly always
ROUGH = 1e-3  # of states beside which something else is asked


class Kind(NamedTuple):
    """What tubes designs are: their ``energy``, ``model`` and ``families``."""

    energy: str
    model: TubeModel
    families: tuple

    @classmethod
    def of(cls, tube):
        """That of a tube."""
        parts = "thick" if tube.is_thick else "membrane", "loose" if tube.is_loose else "bonded"
        return cls(tube.energy, TubeModel("inner", *parts), given_by(tube))

    @property
    def is_source(self):
        """Whether they are the source's: membranes with two bonded families."""
        return not self.model.is_physical and len(self.families) == 2

    def tells(self, output, kind) -> bool:
        """Whether vectors tell an output of states of a kind, as of :class:`.wishes.Wish`: of physical tubes that are held,
        which mostly stay straight, no stiffness.
        """
        if output in STIFF:
            return self.is_source or (kind == "free" and len(self.families) == 2)
        return output in TOLD + (OF_SOURCE if self.is_source else WORST if self.model.is_thick else ())


def solve_vectors(tube, asked, columns, accuracy, thorough=True, sure=False, near=None) -> dict:
    """For each state in ``asked`` (state -> outputs) of designs (name -> (n,)): "status" and, by output, (value, bound);
    ``tube`` is one of the kind that they are. Not ``thorough``: what vectors cannot do has no value. ``sure``: held states
    of physical tubes are those that the ways from rest lead to, each by itself; ``near``: held state -> loads (n,) and
    radii of the middle [m] of tubes beside these.
    """
    from ..solver.lanes.free import solve_lanes, solve_physical

    own = Kind.of(tube)
    if asked:
        foretell(solve_lanes if own.is_source else solve_physical)
    answers, count = {}, len(columns["radius"])
    none = np.zeros(count)  # of what makes bodies
    for kind in dict.fromkeys(state.kind for state in asked):
        states = [state for state in asked if state.kind == kind]
        parts = [_points(state, columns, count) for state in states]
        points = np.concatenate([np.column_stack([part.get(name, none) for name in COLUMNS]) for part in parts])
        most = max(part["pressure"].max(initial=0.0) for part in parts) if kind == "limit" else None
        along = any(name in ALONG for state in states for name in asked[state])
        others, none_near = near or {}, np.full((2, count), np.nan)
        known = np.concatenate([others.get(state, none_near) for state in states], axis=1)
        found = _solved(own, kind, points, accuracy, most, thorough, sure, along, known)
        for k, (state, part) in enumerate(zip(states, parts)):
            numbers = {name: array[k * count : (k + 1) * count] for name, array in found.items()}
            if set(asked[state]) & set(STIFF):
                numbers |= stiffness(asked[state], kind, numbers, part, tube)
            answers[state] = {name: output(name, kind, numbers, part) for name in asked[state]}
            limit = np.where(numbers["status"] == INVALID, INVALID, OK)
            answers[state]["slack"] = np.where(kind == "limit", 0, numbers["slack_fiber"]).astype(np.int8)
            answers[state]["status"] = limit if kind == "limit" else numbers["status"]
            answers[state]["stable"] = numbers["stable"] if kind != "limit" else np.full(count, STABLE)
            answers[state]["middle"] = numbers["mid_radius"] if kind != "limit" else np.full(count, np.nan)
    return answers


def _solved(own, kind, points, accuracy, most, thorough, sure, along, near):
    """What the exact solver tells of all points."""
    tubes = Tubes(own.energy, own.model, own.families)
    if own.is_source and not along:
        return solve(KINDS[kind], points, tubes, accuracy, most, thorough=thorough)
    accuracy = max(accuracy, SUMMED)
    if kind in HELD and not own.is_source:

        def free(points):
            return solve(LOADED, points, tubes, accuracy, thorough=False)

        two = len(own.families) == 2

        def like(points):
            return solve(KINDS[kind], points, Tubes(own.energy), accuracy, thorough=False)[kind] if two else 0.0

        def alone(points):
            return solve(KINDS[kind], points, tubes, accuracy)

        if sure:
            return alone(points)

        def stands(points):
            return solve(KINDS[kind], points, tubes, max(accuracy, ROUGH), thorough=False)["stable"]

        found = _held(kind, points, own, near, accuracy, two, free, like, alone if thorough else None)
        straight = np.flatnonzero(np.isfinite(straight_loads(kind, points))) if two else []
        if len(straight):
            found["stable"][straight] = stands(points[straight])
        return found
    if own.is_source:  # the few that vectors leave are not worth it that scalar kernels are compiled for them
        found = solve(KINDS[kind], points, tubes, accuracy, thorough=False, along=True)
    else:
        found = solve(KINDS[kind], points, tubes, accuracy, thorough=thorough)
    if not own.model.is_thick:  # a layer without a wall around it
        found = {name: array for name, array in found.items() if not name.startswith(WORST)}
    if kind == "locked":  # that of the pressure c10
        for name in PULLS:
            for key in (name, f"{name}_error"):
                found[key] = found[key] / points[:, COLUMNS.index("c10")]
    return found


def _held(kind, points, own, near, accuracy, two, free, like, alone):
    """Held states: those beside states that are known from these, others among free ones; ``alone``, if it is given, solves
    what both do not find.
    """
    (loads, radii), radius = near, points[:, COLUMNS.index("fiber_radius")]
    stretch = radii / radius
    known = np.flatnonzero(np.isfinite(loads) & np.isnan(straight_loads(kind, points)))
    stretch = np.where(np.abs(stretch - 1.0) > STRAIGHT, stretch, 1.0 + ONSET)[known]  # what was straight will swell
    pair = beside(Held(kind, points[known], own), loads[known], stretch, accuracy)
    met = np.isfinite(pair.load)
    rest = np.setdiff1d(np.arange(len(points)), known[met] if alone else known)
    others = hold_by_loads(kind, points[rest], free, like, alone, accuracy, two, loads[rest])
    found = {name: np.empty(len(points), array.dtype) for name, array in others.items()}
    status, middle = np.where(met, OK, NOT_CONVERGED), pair.middle * radius[known]
    own = {
        kind: pair.load,
        f"{kind}_error": pair.bound,
        "mid_radius": middle,
        "slack_fiber": pair.slack,
        "status": status,
        "stable": np.full(len(known), UNKNOWN),
    }
    for name, array in found.items():
        array[known], array[rest] = own[name], others[name]
    return found


def points_of(state, columns, count):
    """Points (n, 17) of one state of designs."""
    part, none = _points(state, columns, count), np.zeros(count)
    return np.column_stack([part.get(name, none) for name in COLUMNS])


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

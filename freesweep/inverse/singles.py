"""States of any tubes, each by the public functions: what differs in pressure only, in one call."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..description.faults import ActuatorError
from ..holding import blocked_force, blocked_torque
from ..statics import inflate, lock
from ..status import INVALID, OK
from .outputs import FOLLOWING, output
from .predict import STABLE, UNSTABLE
from .stiff import derivatives_for, stiffness_of
from .vectors import HARDLY


def solve_singles(tubes, asked, columns, accuracy) -> dict:
    """As :func:`vectors.solve_vectors`, of ``tubes`` (n,), None where there is none."""

    def one(i):
        design = {name: float(column[i]) for name, column in columns.items()}
        try:
            return solve_single(tubes[i], asked, design, accuracy) if tubes[i] is not None else None
        except ActuatorError:  # a profile that no spline follows so closely
            return None

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        rows = list(pool.map(one, range(len(tubes))))
    none, unknown = {"status": INVALID, "slack": 0, "stable": UNSTABLE}, np.full(len(tubes), np.nan)
    answers = {}
    for state, names in asked.items():
        own = [none | dict.fromkeys(names, (np.nan, np.nan)) if row is None else row[state] for row in rows]
        answers[state] = {name: tuple(np.array([each[name] for each in own], float).T) for name in names}
        for name in ("status", "slack", "stable"):
            answers[state][name] = np.array([each[name] for each in own], np.int8)
        answers[state]["middle"] = unknown
    return answers


def solve_single(tube, asked, design, accuracy) -> dict:
    """Of one tube: state -> "status", "stable", "slack", and output -> (value, bound); ``design``: its numbers and loads."""
    answers, families = {}, {}
    for state in asked:
        rest = tuple((name, value) for name, value in state.conditions if name != "pressure")
        families.setdefault((state.kind, rest), []).append(state)
    for (kind, rest), states in families.items():
        given = design | dict(rest)
        own = [HARDLY if kind == "limit" and s.pressure is None else s.pressure for s in states]
        own = np.array([given["pressure"] if p is None else p for p in own])
        pressures, places = np.unique(own, return_inverse=True)
        names = {name for state in states for name in asked[state]}
        more = {"accuracy": accuracy, "derivatives": derivatives_for(names, kind)}
        found = states_of(tube, kind, rest, pressures, given, 0.0, **more)
        numbers = {name: v.values for name, v in found.data_vars.items() if "x" not in v.dims}
        numbers |= stiffness_of(numbers, names, kind)
        for name in names:
            seen = (name, kind, numbers, given)
            if name in (*numbers, *FOLLOWING):
                value, bound = output(*seen)
            else:  # of other tubes than this one
                value, bound = np.nan, np.nan
            value, bound = np.broadcast_to(value, len(pressures)), np.broadcast_to(bound, len(pressures))
            for state, place in zip(states, places):
                if name in asked[state]:
                    answers.setdefault(state, {})[name] = float(value[place]), float(bound[place])
        for state, place in zip(states, places):
            answers[state]["status"] = OK if kind == "limit" else int(numbers["status"][place])
            answers[state]["stable"] = STABLE if kind == "limit" else int(numbers["stable"][place])
            answers[state]["slack"] = int(numbers["slack_fiber"][place]) if "slack_fiber" in numbers else 0
    return answers


def states_of(tube, kind, rest, pressures, given, x, **more):
    """The Dataset of a tube's states of a ``kind`` at ``pressures``; ``rest``: other conditions, ``given``: all loads."""
    if kind == "locked":
        return lock(tube, x=x, **more).expand_dims("pressure")
    if kind == "force":
        return blocked_force(tube, pressures, dict(rest).get("deformed_length"), given["torque"], x=x, **more)
    if kind == "torque":
        return blocked_torque(tube, pressures, dict(rest).get("rotation", 0.0), given["force"], x=x, **more)
    return inflate(tube, pressures, given["force"], given["torque"], x=x, **more)

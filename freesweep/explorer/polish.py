"""Wishes of the page as goals of an inverse design: ranges on measures, met by moving what is lit."""

import math

import numpy as np

from ..inverse.wishes import Goal
from .desk import AskError
from .exact import loads_of, tube_of

FREE = {
    "stroke", "rotation", "deformed_length", "mid_radius", "outer_radius", "volume", "strain_energy", "slack_alpha",
    "slack_beta", "largest_stretch", "least_tension_alpha", "least_tension_beta",
}  # fmt: skip
LOCKED = {"stroke", "rotation", "deformed_length", "mid_radius", "volume", "strain_energy"}
HELD = {"blocked_force": "force", "blocked_torque": "torque"}
COUNT = 5  # designs that come back, at most: as many as can be pinned
LEAST = {"alpha": 1.0, "beta": 1.0}  # widths of what is free: a single lit design may still move


def goals_of(wishes, tube, loads) -> list:
    """Wishes ``[{"measure", "low", "high"}]`` (None: open) as goals in the state of ``loads``. Raises AskError."""
    goals, faults = [], []
    for wish in wishes:
        name, (low, high) = wish["measure"], (wish.get("low"), wish.get("high"))
        state = {key: value for key, value in loads.items() if value != 0.0 or key == "pressure"}
        locked = name.startswith("locked_")
        plain = name.removeprefix("locked_")
        if locked:
            state = {"pressure": math.inf}
        output, size, sign = plain, 1.0, 1.0
        if plain == "length_change":  # which keeps its meaning while the length moves
            output, sign = "stroke", -1.0
        elif plain == "relative_radius":
            output, size = "mid_radius", tube.fiber_surface
        if name in HELD:
            output, state = HELD[name], {"pressure": loads["pressure"]}
        elif name == "limit_pressure":
            state = {key: value for key, value in state.items() if key != "pressure"}
        elif output not in (LOCKED if locked else FREE):
            faults.append(f"{name}: no output that designs are looked for by")
            continue
        if low is None and high is None:
            continue
        low, high = (None if end is None else sign * size * end for end in (low, high))
        low, high = (high, low) if sign < 0.0 else (low, high)
        ends = {"at_most": high} if low is None else {"at_least": low} if high is None else {"between": (low, high)}
        goals.append(Goal(output, **ends, **state))
    if not goals and not faults:
        faults.append("no wish has a range yet: drag over a strip, or type its ends")
    if faults:
        raise AskError("; ".join(faults))
    return goals


def polished(desk, ask) -> dict:
    """Designs that meet the wishes, looked for with :func:`freesweep.design` within ``free`` (axis -> (low, high))."""
    from ..inverse.designing import find

    at, frame = ask["at"], desk.reader.frame
    tube, loads = tube_of(desk, at), loads_of(desk, at)
    goals = goals_of(ask["wishes"], tube, loads)
    if any(wish["measure"].endswith("relative_radius") for wish in ask["wishes"]):
        moves = {"radius", "wall", "fiber_radius"} & set(ask["free"])
        ask["free"] = {
            name: span for name, span in ask["free"].items() if name not in moves
        }  # what they are relative to
    free = {}
    for name, (low, high) in ask["free"].items():
        if name not in desk.design_axes:
            raise AskError(f"{name}: no axis of design of this atlas")
        least, most = frame.ranges[name]
        room = max(LEAST.get(name, 0.02 * (most - least)) - (high - low), 0.0) / 2.0
        free[name] = (max(low - room, least), min(high + room, most))
    found = find(tube, free, goals, count=COUNT, atlas=desk.atlas)
    data = found.data
    names = [name for name in desk.design_axes if name in data]
    pins = [
        {
            **{name: at[name] for name in desk.design_axes},
            **{name: float(np.asarray(data[name].values)[k]) for name in names},
        }
        for k in range(data.sizes["candidate"])
    ]
    if "design" in at:
        pins = [pin | {"design": at["design"]} for pin in pins]
    met = [bool(one) for one in data["met"].values]
    if any(met):
        pins = [pin for pin, one in zip(pins, met) if one]
    if ask.get("taut"):
        some = next(iter(desk.measures))
        taut = [pin for pin in pins if desk.point({"at": at | pin, "measures": [some]})["slack"] == 0]
        pins = taut or pins
    return {"pins": pins, "met": met, "summary": data.attrs["summary"]}

"""Pinned designs solved exactly, through the functions that everybody calls; and their shapes as plots draw them."""

import warnings

import numpy as np

from ..atlas.schema import SHAPE
from ..description.actuator import Actuator
from ..description.along import written
from ..description.elastomer import rubber_of
from ..description.families import FAMILIES
from ..description.faults import ActuatorError
from ..description.local import UNITS
from ..description.tube_model import MODELS
from ..plot.shape import shape_of
from ..status import STATUSES, VALUED

STATIONS = 161  # of a shape
DRAWN = 121  # of them that travel to the page


def tube_of(desk, pin: dict) -> Actuator:
    """The actuator at a pin of the page (axis -> number). Raises ActuatorError, or AskError where the atlas has none."""
    from .desk import AskError

    frame = desk.reader.frame
    if not frame.in_numbers:
        raise AskError("the tubes of this atlas have profiles; solve them with freesweep.inflate")
    values = {name: array[0] for name, array in _columns(desk, pin).items()}
    rubber = rubber_of(*(float(values.get(name, 0.0)) for name in ("c10", "c01", "c20", "c30")))
    own = {name: float(values[name]) for name in ("length", "radius", "wall", "fiber_extension")}
    own |= {name: float(values[name]) if name in frame.families else None for name in FAMILIES}
    usual = MODELS["source"]._asdict()
    parts = {name: part for name, part in frame.model._asdict().items() if part != usual[name]}
    if frame.bodies is not None:
        own |= {name: float(values.get(name, 0.0)) for name in SHAPE}
        own |= {name: written(name, own[name], UNITS[name]) for name in frame.bodies.rules}
    if "fiber_radius" in frame.values:
        parts["fiber_radius"] = float(values["fiber_radius"])
    return Actuator(**own, **parts, material=rubber, energy=frame.energy, model="source")


def loads_of(desk, pin: dict) -> dict:
    """Pressure, force and torque [Pa, N, N m] at a pin."""
    return {
        name: float(array[0]) for name, array in _columns(desk, pin).items() if name in ("pressure", "force", "torque")
    }


def _columns(desk, pin):
    from .measures import _columns as columns

    return columns(desk.reader, desk._at(pin, 1), 1)


def shape(desk, ask) -> dict:
    """The shape of a design under its loads, solved: radius and position [mm], twist and threads [radian], (n,) each."""
    tube, loads = tube_of(desk, ask["at"]), loads_of(desk, ask["at"])
    from ..statics import inflate

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        state = inflate(tube, **loads, x=np.linspace(0.0, tube.length, STATIONS))
    if int(state["status"]) not in VALUED:
        return {"status": STATUSES[int(state["status"])].sentence}
    return {"rest": _drawn(shape_of(tube)), "state": _drawn(shape_of(tube, state)), "status": ""}


def _drawn(found):
    at = np.linspace(0, len(found.radius) - 1, DRAWN).round().astype(int)
    return {
        "radius": found.radius[at], "position": found.position[at], "twist": found.twist[at],
        "fibers": [turn[at] for turn in found.fibers], "counts": list(found.counts),
    }  # fmt: skip


def solved(desk, ask) -> dict:
    """What the solver says of a pinned design, free, locked and blocked: measure -> value and bound, or the status."""
    from ..holding import blocked_force, blocked_torque
    from ..statics import inflate, lock

    tube, loads = tube_of(desk, ask["at"]), loads_of(desk, ask["at"])
    ends = {"x": [0.0, tube.length]}
    one = {"pressure": loads["pressure"]}
    ways = (
        ("", lambda: inflate(tube, **loads, **ends)),
        ("locked_", lambda: lock(tube, **ends)),
        (
            "blocked_",
            lambda: blocked_force(tube, **one, torque=loads["torque"], **ends)[["force", "force_error", "status"]],
        ),
        (
            "blocked_",
            lambda: blocked_torque(tube, **one, force=loads["force"], **ends)[["torque", "torque_error", "status"]],
        ),
    )
    found, slack = {}, 0
    for prefix, way in ways:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                state = way()
        except ActuatorError:
            continue  # no such state of this tube
        status = int(state["status"])
        if prefix == "":
            slack = int(state["slack_fiber"])
        for name in state.data_vars:
            if f"{name}_error" in state and state[name].ndim == 0:
                found[prefix + name] = {
                    "value": float(state[name]),
                    "error": float(state[f"{name}_error"]),
                    "status": status,
                }
    for prefix in ("", "locked_"):
        if prefix + "deformed_length" in found:
            of = found[prefix + "deformed_length"]
            found[prefix + "length_change"] = of | {
                "value": of["value"] / tube.length - 1.0,
                "error": of["error"] / tube.length,
            }
            of = found[prefix + "mid_radius"]
            scale = np.ravel(tube.fiber_surface_at(0.5))[0]
            found[prefix + "relative_radius"] = of | {"value": of["value"] / scale, "error": of["error"] / scale}
    return {"measures": found, "slack": slack}

"""What designs do: the wished-for output of each, many at a time.

Tubes of the source that are the same all along are solved in vectors; others one by one, on threads.
"""

import os
import warnings
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from ..faults import ActuatorError
from ..holding import blocked_force, blocked_torque
from ..statics import inflate, lock
from ..status import INVALID, OK, VALUED
from .freedom import Space
from .wishes import HELD

HARDLY = 1e-3  # [Pa]: the pressure of a limit that nothing is asked of


class Predicted(NamedTuple):
    """Values (n, wishes) in SI units and degrees, NaN where there is no state; bounds of their errors; status."""

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray

    def part(self, where):
        return Predicted(self.values[where], self.bounds[where], self.status[where])


def predict(space: Space, wishes, u, choice, accuracy) -> Predicted:
    """What the designs at points u (n, p) of the ``space``, with ``choice`` (n,), do."""
    shape = len(u), len(wishes)
    found = Predicted(np.full(shape, np.nan), np.full(shape, np.nan), np.full(shape, INVALID))
    columns = space.columns(u, choice)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # designs on the way are nobody's
        for state in dict.fromkeys((wish.kind, wish.conditions, _asked(wish)) for wish in wishes):
            own = [k for k, wish in enumerate(wishes) if (wish.kind, wish.conditions, _asked(wish)) == state]
            if state[0] == "design":
                for k in own:
                    found.values[:, k], found.bounds[:, k], found.status[:, k] = columns[wishes[k].output], 0.0, OK
                continue
            loaded = columns | {name: np.full(len(u), value) for name, value in state[1]}
            solve = _alike if space.is_alike else _one_by_one
            answer = solve(space, state, [wishes[k].output for k in own], loaded, u, choice, accuracy)
            for k in own:
                found.values[:, k], found.bounds[:, k] = answer[wishes[k].output]
                found.status[:, k] = answer["status"]
    return found


def _asked(wish):
    """The pressure up to which a limit has to be known."""
    return wish.low if wish.kind == "limit" and np.isfinite(wish.low) else None


def _alike(space, state, outputs, loaded, u, choice, accuracy):
    """States of tubes that are the same all along, in vectors."""
    from ..query.exact import solve
    from ..query.reference import COLUMNS, LENGTH_HELD, LOADED, LOCKED, ROTATION_HELD

    kind, conditions, least = state
    points, given = loaded | {"held": np.zeros(len(u))}, dict(conditions)
    if kind in HELD:
        held = HELD[kind][0]
        points["held"] = loaded[held] / loaded["length"] if held in given and kind == "force" else loaded.get(held)
        if held not in given:
            points["held"] = np.full(len(u), 1.0 if kind == "force" else 0.0)
        points[kind] = np.zeros(len(u))
    if kind == "limit":
        points["pressure"] = np.full(len(u), HARDLY if least is None else least)
    code = {"locked": LOCKED, "force": LENGTH_HELD, "torque": ROTATION_HELD}.get(kind, LOADED)
    array = np.column_stack([points[name] for name in COLUMNS])
    energy = space.template.energy
    found = solve(code, array, energy, accuracy, np.max(points["pressure"]) if kind == "limit" else None)
    answer = {"status": found["status"]}
    for name in outputs:
        answer[name] = _output(name, kind, found, loaded, np.asarray(found["status"]))
    if kind == "limit":
        answer["status"] = np.where(found["status"] == INVALID, INVALID, OK)
    return answer


def _output(name, kind, found, design, status):
    """``(value, bound)`` of an output, of those that a state has."""
    if kind == "limit":
        none = np.isnan(found["limit_pressure"]) & np.isin(status, VALUED)
        return np.where(none, np.inf, found["limit_pressure"]), np.where(none, 0.0, found["limit_pressure_error"])
    if name == "stroke":
        length, bound = found["deformed_length"], found["deformed_length_error"]
        return 1.0 - length / design["length"], bound / design["length"]
    if name == "length_change":
        return found["deformed_length"] - design["length"], found["deformed_length_error"]
    if name == "outer_radius" and "outer_radius" not in found:
        return _outer_radius(found["mid_radius"], found["mid_radius_error"], design)
    return found[name], found[f"{name}_error"]


def _outer_radius(middle, bound, design):
    """The largest outer radius of a tube that bulges or necks in its middle: the wall keeps its volume, ``r_o^2 = r^2 +
    (r_o0^2 - r_0^2)/lambda_1`` outside the fibers (theory, section 11).
    """
    ta, tb = np.tan(np.radians(design["alpha"])), np.tan(np.radians(design["beta"]))
    h, d, gg = 0.5 * (ta + tb), 0.5 * (ta - tb), design["fiber_extension"] ** 2
    r0 = design["fiber_radius"]
    outside = (design["radius"] + design["wall"]) ** 2 - r0**2

    def outer(r):
        q = (r / r0) ** 2
        squared = gg * (1.0 + h * h + d * d) - d * d * q - gg * gg * h * h / q  # lambda_1^2, Eqs. 2.3, 2.4
        return np.sqrt(r * r + outside / np.sqrt(squared))

    with np.errstate(invalid="ignore"):
        here = outer(middle)
        return np.maximum(here, outer(r0)), np.maximum(np.abs(outer(middle + bound) - here), bound)


def _one_by_one(space, state, outputs, loaded, u, choice, accuracy):
    """States of any tubes, each by the public functions."""

    def one(i):
        design = {name: column[i] for name, column in loaded.items()}
        try:
            tube = space.actuator(u[i], choice[i])
        except ActuatorError:
            return {"status": INVALID} | dict.fromkeys(outputs, (np.nan, np.nan))
        return answer_of(tube, state, outputs, design, accuracy)

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        rows = list(pool.map(one, range(len(u))))
    answer = {"status": np.array([row["status"] for row in rows])}
    for name in outputs:
        answer[name] = tuple(np.array([row[name] for row in rows]).reshape(len(u), 2).T)
    return answer


def answer_of(tube, state, outputs, design, accuracy):
    """Status, and ``(value, bound)`` of each output, of one tube in one state; ``design`` has its loads."""
    kind, conditions, least = state
    given = dict(conditions)
    x = None if "outer_radius" in outputs else 0.0
    force, torque, pressure = (float(design[name]) for name in ("force", "torque", "pressure"))
    if kind == "locked":
        found = lock(tube, x=x, accuracy=accuracy)
    elif kind == "force":
        found = blocked_force(tube, pressure, given.get("deformed_length"), torque, x=x, accuracy=accuracy)
    elif kind == "torque":
        found = blocked_torque(tube, pressure, given.get("rotation", 0.0), force, x=x, accuracy=accuracy)
    else:
        pressure = (HARDLY if least is None else least) if kind == "limit" else pressure
        found = inflate(tube, pressure, force, torque, x=x, accuracy=accuracy)
    numbers = {name: variable.values for name, variable in found.data_vars.items() if variable.ndim == 0}
    status = int(numbers["status"])
    answer = {"status": OK if kind == "limit" else status}
    for name in outputs:
        if name == "outer_radius" and name not in numbers:
            answer[name] = _widest(tube, found)
        else:
            answer[name] = tuple(map(float, _output(name, kind, numbers, design, np.asarray(status))))
    return answer


def _widest(tube, found):
    """The largest outer radius along the profiles of a state, and its bound; fibers that are taut tell the stretch
    ``lambda_1 = gamma cos(alpha')/cos(alpha)``.
    """
    alpha, _ = tube.angles(found["x"].values / tube.length)
    wall = tube.profile("wall").at(found["x"].values / tube.length)
    outside = (tube.radius + wall) ** 2 - tube.fiber_surface**2
    r = found["deformed_radius"].values
    turned = np.radians(found["alpha_deformed"].values)
    stretch = tube.fiber_extension * np.cos(turned) / np.cos(np.radians(alpha))
    outer = np.sqrt(r * r + outside / stretch)
    return float(np.max(outer)), float(np.max(found["deformed_radius_error"].values))

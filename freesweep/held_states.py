"""States of one actuator of which something is held: from what is asked for to the kernels, and from these to a Dataset."""

from typing import NamedTuple

import numpy as np

from .derivative.request import asked_of
from .description.loads import each_once, read_load, read_stations, warn_of_loads
from .description.splines import SENSITIVITY, widened
from .results import dataset, near_stations
from .scaling import problem_rows
from .statics import read_course, undeformed
from .thick_wall import thin_wall_attributes
from .worst_places import with_own

HALF_CELLS = 48  # of half a tube that is the same all along


class Held(NamedTuple):
    """What is held, under which loads: ``axes`` name -> number or array of what is held, the load that is given and the
    pressure; where profiles are asked for; and whether beside the straight cylinder.
    """

    name: str
    axes: dict
    stations: np.ndarray
    buckled: bool

    @property
    def loads(self):
        """Names of the load that is unknown, and of the one that is given."""
        return ("force", "torque") if self.name == "deformed_length" else ("torque", "force")

    @property
    def states(self):
        """Pressure, the load that is given and what is held, of every state: arrays of one shape."""
        grid = dict(zip(self.axes, np.meshgrid(*self.axes.values(), indexing="ij")))
        return grid["pressure"], grid[self.loads[1]], grid[self.name]


def hold(tube, given, x, accuracy, buckled=False, derivatives=None, tied=False):
    """``given``: name -> what the caller gave, of what is held first, then of the other load, then of the pressure."""
    faults, (held_name, load_name, _) = [], given
    units = {"deformed_length": "m", "rotation": "degree", "force": "N", "torque": "N m", "pressure": "Pa"}
    domains = {"pressure": {"least": 0.0}, "deformed_length": {"positive": True}}
    axes = {name: read_load(name, value, units[name], faults, **domains.get(name, {})) for name, value in given.items()}
    names = asked_of(tube, derivatives, faults, ("pressure", load_name), held_name)
    stations, accuracy = read_stations(tube, x, accuracy, faults)
    warn_of_loads(tube, **{name: axes[name] for name in axes if name != "rotation"}, stacklevel=4)
    axes, at = each_once(axes)
    held = Held(held_name, axes, stations, bool(buckled))
    result = _solve(tube, held, accuracy)
    if names:
        from .derivative.attach import attach

        result = attach(result, *_differentiable(tube, held, result, names, accuracy, tied))
    return result.isel(at)


def _differentiable(tube, held, result, names, accuracy, tied):
    """What :func:`.derivative.attach.attach` takes: what is asked for, under which loads, how to solve, and what is held."""
    from .derivative.asked import Asked

    course, error = read_course(tube, accuracy) if tube.varies else (None, 0.0)
    unknown, other = held.loads
    asked = Asked(tube, names, accuracy, course, error, held.name, unknown, tied, held.buckled)
    pressures, others, targets = held.states
    loads = {"pressure": pressures, other: others, unknown: result[unknown].values}
    return asked, loads, lambda x, guess: _solve(tube, held._replace(stations=x), guess), targets


def _solve(tube, held, accuracy):
    """Solve all states, and put the results into a Dataset."""
    from .solver.held.sought import HELD_LENGTH, HELD_ROTATION
    from .solver.status import OK

    r, c10, of_length = tube.fiber_surface, tube.material.c10, held.name == "deformed_length"
    whole, (course, error) = tube.varies or held.buckled, _course(tube, accuracy)
    every = with_own(tube, held.stations)
    unique, index = near_stations(tube, every, whole)
    pressures, others, targets = (array.ravel() for array in held.states)
    others = others / (np.pi * r ** (3 if of_length else 2) * c10)
    rows = _problems(tube, held.loads[1], others)
    states = rows, targets / r if of_length else np.radians(targets), HELD_LENGTH if of_length else HELD_ROTATION
    find = _hold_buckled if held.buckled else _hold
    found = find(*states, pressures / c10, course, accuracy - SENSITIVITY * error, unique)
    found["bounds"] = widened(found["values"], found["bounds"], error)
    found["load_bounds"] = widened(found["loads"], found["load_bounds"], error)
    found["fields"] = found["fields"][..., index]
    if tube.varies:  # whose angles at rest the kernels do not know
        at_rest = (found["status"] == OK) & (pressures == 0.0) & (others == 0.0) & (found["loads"] == 0.0)
        found["fields"][at_rest] = undeformed(tube, every, whole)
    shape = held.states[0].shape
    return _told(
        tube, held, accuracy, whole, {name: array.reshape(*shape, *array.shape[1:]) for name, array in found.items()}
    )


def _course(tube, accuracy):
    """``(course, its error)``, as the kernels take them."""
    from .solver.batch import uniform

    return read_course(tube, accuracy) if tube.varies else (uniform(HALF_CELLS), 0.0)


def _problems(tube, load, others):
    """Rows of problems, one for each ``load`` that is given, dimensionless."""
    from .solver.problem import FORCE, TORQUE

    count = len(others)
    design = {name: np.full(count, value) for name, value in tube.design().items()}
    rows = problem_rows(
        design | {"force": np.zeros(count), "torque": np.zeros(count)}, tube.energy, tube.is_thick, tube.threads
    )
    rows[:, FORCE if load == "force" else TORQUE] = others
    return np.ascontiguousarray(rows)


def _hold(rows, targets, kind, pressures, course, accuracy, stations):
    """What the kernels find, by name, all along the tube or along half of it."""
    from .solver.hold_batch import hold_all

    first = np.arange(len(pressures) + 1)
    found = hold_all(rows, targets, kind, first, pressures, course, accuracy, stations, soon=True)
    return {
        "status": found.status, "stable": found.stable, "slack_fiber": found.states.slack, "values": found.states.values,
        "bounds": found.states.bounds, "fields": found.profiles, "loads": found.loads, "load_bounds": found.load_bounds,
        "held_path": found.paths,
    }  # fmt: skip


def _hold_buckled(rows, targets, kind, pressures, course, accuracy, stations):
    """The same of the states beside the straight cylinder."""
    from .solver.by_waves.states import find_buckled
    from .solver.hold_batch import HOLDER

    found = find_buckled(rows, pressures, targets, accuracy, stations)
    return {
        "status": found.status, "stable": found.stable, "slack_fiber": found.slack, "values": found.values[:, :HOLDER],
        "bounds": found.bounds[:, :HOLDER], "fields": found.profiles, "loads": found.values[:, HOLDER],
        "load_bounds": found.bounds[:, HOLDER], "least_buckled_pressure": found.least,
    }  # fmt: skip


def _told(tube, held, accuracy, whole, found):
    """The Dataset of what the kernels found of all states."""
    from .solver.held.sought import FROM_FREE

    dims, unknown = tuple(held.axes), held.loads[0]
    scale = np.pi * tube.fiber_surface ** (2 if unknown == "force" else 3) * tube.material.c10
    extra = {unknown: (dims, found["loads"] * scale), f"{unknown}_error": (dims, found["load_bounds"] * scale)}
    if held.buckled:
        pressure = found["least_buckled_pressure"] * tube.material.c10
        extra |= {"least_buckled_pressure": (dims, pressure[..., 0])}
        extra |= {"least_buckled_pressure_error": (dims, pressure[..., 1])}
    else:
        extra["held_path"] = dims, found["held_path"].astype(np.int8)
    told = found | {"fields": (found["fields"], whole), "extra": extra}
    result = dataset(tube, held.axes, held.stations, told, without=(held.name,))
    result.attrs = {"title": repr(tube), "energy": tube.energy, "accuracy": accuracy, "buckled": int(held.buckled)}
    if tube.is_loose:
        result.attrs["fibers"] = "loose"
    result.attrs |= thin_wall_attributes(tube)
    if not held.buckled and np.any(found["held_path"] == FROM_FREE):
        result.attrs["comment"] = (
            "held_path: the way from rest with the undeformed length or rotation held ends elsewhere, or the wall would have"
            " to be pushed on it; some states were found from the free one"
        )
    return result

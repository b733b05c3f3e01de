"""States of one actuator of which something is held: from what is asked for to the kernels, and from these to a Dataset."""

from typing import NamedTuple

import numpy as np

from .derivative.request import asked_of
from .description.loads import read_load, read_stations, warn_of_loads
from .description.profiles import SENSITIVITY, widened
from .results import dataset, near_stations
from .scaling import problem_rows
from .statics import read_course, undeformed
from .thick_wall import thin_wall_attributes
from .worst_places import with_own

HALF_CELLS = 48  # of half a tube that is the same all along
MANY = 200  # states among which it is worth to look first for those that nothing holds


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
    warn_of_loads(tube, **{name: axes[name] for name in (load_name, "pressure")}, stacklevel=4)
    held = Held(held_name, axes, stations, bool(buckled))
    result = _solve(tube, held, accuracy)
    if not names:
        return result
    from .derivative.attach import attach

    return attach(result, *_differentiable(tube, held, result, names, accuracy, tied))


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
    from .interpret import at_once
    from .solver.along.places import NUMBERS
    from .solver.along.profile import FIELDS
    from .solver.held.held_state import HELD_LENGTH, HELD_ROTATION
    from .solver.held.held_states import hold_many
    from .solver.hold_batch import refuse
    from .solver.problem import PHYSICAL, wall_columns
    from .solver.status import OK, PENDING

    r, c10, of_length = tube.fiber_surface, tube.material.c10, held.name == "deformed_length"
    row, solved, whole, error = _problem(tube, held.buckled, accuracy)
    every = with_own(tube, held.stations)
    unique, index = near_stations(tube, every, whole)
    pressures, others, targets = (array.ravel() for array in held.states)
    count = len(pressures)
    along = len(NUMBERS) if wall_columns(row) == PHYSICAL else 0
    values, bounds = np.full((2, count, 6 + along), np.nan)
    codes, least = np.full(count, PENDING), np.full((count, 2), np.nan)
    stable, slack, paths = np.zeros((3, count), np.int64)
    fields = np.full((count, FIELDS, len(unique)), np.nan)
    states = (
        pressures / c10, others / (np.pi * r ** (3 if of_length else 2) * c10),
        targets / r if of_length else np.radians(targets), HELD_LENGTH if of_length else HELD_ROTATION,
    )  # fmt: skip
    if count >= MANY and not whole:
        refuse(row, *states, codes)
    arguments = (
        row[None], wall_columns(row), np.array([0, count]), *states, held.buckled, *solved,
        accuracy - SENSITIVITY * error, values, bounds, codes, stable, slack, paths, least, unique, fields,
    )  # fmt: skip
    if not at_once(np.count_nonzero(codes == PENDING), hold_many, hold_many, *arguments):
        hold_many(*arguments)
    bounds, profiles = widened(values, bounds, error), fields[..., index]
    if tube.varies:  # whose angles at rest the kernels do not know
        profiles[(codes == OK) & (pressures == 0.0) & (others == 0.0) & (values[:, 5] == 0.0)] = undeformed(
            tube, every, whole
        )
    return _told(tube, held, accuracy, whole, (codes, stable, slack, values, bounds, profiles, paths, least))


def _problem(tube, buckled, accuracy):
    """``(row, course, whether the whole tube is solved, error of the course)``, as the kernels take them."""
    from .solver.batch import uniform
    from .solver.halves import in_two_halves

    design = {name: np.full(1, value) for name, value in tube.design().items()}
    unloaded = design | {"force": np.zeros(1), "torque": np.zeros(1)}
    row = problem_rows(unloaded, tube.energy, tube.is_thick, tube.threads)[0]
    whole = (
        tube.varies or tube.is_thick or tube.threads > 0.0 or buckled
    )  # on meshes only the source's tubes go by halves
    if tube.varies:
        solved, error = read_course(tube, accuracy)
        return row, solved, whole, error
    return row, in_two_halves(row, HALF_CELLS) if whole else uniform(HALF_CELLS), whole, 0.0


def _told(tube, held, accuracy, whole, found):
    """The Dataset of what the kernels found of all states."""
    from .solver.held.sought import FROM_FREE

    dims, shape, unknown = tuple(held.axes), held.states[0].shape, held.loads[0]
    codes, stable, slack, values, bounds, profiles, paths, least = (
        array.reshape(*shape, *array.shape[1:]) for array in found
    )
    scale = np.pi * tube.fiber_surface ** (2 if unknown == "force" else 3) * tube.material.c10
    extra = {unknown: (dims, values[..., 5] * scale), f"{unknown}_error": (dims, bounds[..., 5] * scale)}
    if held.buckled:
        pressure = least * tube.material.c10
        extra |= {"least_buckled_pressure": (dims, pressure[..., 0])}
        extra |= {"least_buckled_pressure_error": (dims, pressure[..., 1])}
    else:
        extra["held_path"] = dims, paths.astype(np.int8)
    told = {
        "status": codes,
        "stable": stable,
        "slack_fiber": slack,
        "values": np.delete(values, 5, axis=-1),
        "bounds": np.delete(bounds, 5, axis=-1),
    }
    told |= {"fields": (profiles, whole), "extra": extra}
    result = dataset(tube, held.axes, held.stations, told, without=(held.name,))
    result.attrs = {"title": repr(tube), "energy": tube.energy, "accuracy": accuracy, "buckled": int(held.buckled)}
    if tube.is_loose:
        result.attrs["fibers"] = "loose"
    result.attrs |= thin_wall_attributes(tube)
    if not held.buckled and np.any(paths == FROM_FREE):
        result.attrs["comment"] = (
            "held_path: the way from rest with the undeformed length or rotation held ends elsewhere, or the wall would have"
            " to be pushed on it; some states were found from the free one"
        )
    return result

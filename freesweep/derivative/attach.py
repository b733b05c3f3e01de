"""Derivatives of a Dataset's outputs, put beside them."""

import warnings

import numpy as np

from .. import status
from ..profiles import SENSITIVITY
from . import grid
from .course import Course
from .equilibrium import NotFound
from .nested import Found, solve
from .physical import PhysicalTube
from .physics import OWN, Physics
from .request import SHAPE, attributes, sizes
from .rest import at_rest, is_at_rest

GUESS = 1e-4  # accuracy of shapes to begin from
SHARE = 0.01  # of the accuracy asked for: what a derivative's bound has to meet, scaled
SAME = 1e-7  # scaled, beside the bounds: by how much a state may differ from the one that was found
LOST = "derivatives: {count} of {all} states were not met again on meshes of their own; theirs are NaN"


class Asked:
    """What is asked of one actuator: names of ``parameters``; ``held`` and ``unknown``, what is held and the load that does
    it; ``course``: ``(course, edges, places)`` of a tube that varies, with the ``error`` of its splines.
    """

    def __init__(
        self, tube, parameters, accuracy, course=None, error=0.0, held=None, unknown=None, tied=False, whole=False
    ):
        self.tube, self.parameters, self.accuracy, self.error = tube, parameters, accuracy, error
        self.held, self.unknown, self.tied = held, unknown, tied
        self.course = None if course is None else Course(course[0], course[2])
        self.half = self.course is None and not whole
        places = [0.0, 0.5] if self.half else [0.0, 0.5, 1.0]
        self.segments = np.array(places) if self.course is None else self.course.places
        radii = tube.length / tube.fiber_surface
        self.x = grid.first_places(self.segments[:1] if self.half else self.segments, radii, self.half)
        own = [name for name in parameters if name != held]
        self.seeds = own if unknown is None else [unknown, *own]
        shape = [name for name in SHAPE if name != held]
        self.outputs = shape if unknown is None else [unknown, *shape]

    def stations(self):
        """Where shapes to begin from have to be known [m]."""
        return np.minimum(self.x * self.tube.length, self.tube.length)

    def table(self, made, physics):
        """(outputs, 1 + parameters) from one mesh's outputs as dual numbers."""
        count = len(self.seeds)
        rows = {name: number_of(value, count) for name, value in made.items()}
        if self.unknown is None:
            return np.array([rows[name] for name in self.outputs])
        rows[self.unknown] = np.array([physics.load, 1.0, *np.zeros(count - 1)])
        held = rows[self.held]
        by = {}  # of the load that holds, by each parameter
        for k, name in enumerate(self.seeds[1:]):
            by[name] = (float(self.tied and name == "length") - held[2 + k]) / held[1]
        by[self.held] = 1.0 / held[1]
        table = np.zeros((len(self.outputs), 1 + len(self.parameters)))
        for i, output in enumerate(self.outputs):
            own = rows[output]
            table[i, 0] = own[0]
            for j, name in enumerate(self.parameters):
                direct = 0.0 if name == self.held or output == self.unknown else own[1 + self.seeds.index(name)]
                table[i, 1 + j] = direct + own[1] * by[name]
        return table

    def state(self, loads, target, y) -> Found:
        """Outputs and derivatives of one state whose stretches at :meth:`stations` are ``y``."""
        kind = PhysicalTube if self.tube.is_thick or self.tube.is_loose else Physics
        known = kind(self.tube, self.course, loads, self.seeds[:1] if self.unknown else ())
        wanted = kind(self.tube, self.course, loads, self.seeds)

        def finish(made, physics):
            rows = self.table(made, physics)
            return self.outputs, rows, np.maximum(np.abs(rows), self.units(loads, rows))

        if is_at_rest(loads, self.held, target, self.tube):
            rows = self.table(at_rest(wanted, 0.5 * (self.x[1:] + self.x[:-1]), np.diff(self.x), self.half), wanted)
            return Found(self.outputs, rows, 0.0 * rows)
        held = None if self.held is None else (self.held, target)
        return solve(known, wanted, self.x, y, self.half, held, self.segments, finish, SHARE * self.accuracy)

    def units(self, loads, rows):
        """What outputs and derivatives are measured by."""
        return sizes(self.tube, loads, self.outputs, self.parameters, rows[:, 0])


def number_of(value, count):
    """Value and parts of a dual number of one place."""
    parts = np.zeros(count) if value.parts is None else value.parts[OWN:, 0]
    return np.concatenate([np.broadcast_to(value.value, 1), parts])


def shapes_of(asked, solve):
    """Stretches at the stations of what is ``asked``, one axis more than the states: from ``solve(stations, accuracy)``."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # who asks has been warned
        shapes = solve(asked.stations(), GUESS)
    return shapes["deformed_radius"].values / asked.tube.fiber_surface


def attach(result, asked, loads, shapes, target=None):
    """Add derivatives to a ``result``: ``loads``, name -> array over its dimensions (those of ``status``), in SI units;
    ``shapes``: stretches at the stations of ``asked``, along one more axis; ``target``: what is held, likewise.
    """
    tube, dims, shape = asked.tube, result["status"].dims, result["status"].shape
    table = np.full((*shape, len(asked.outputs), 1 + len(asked.parameters)), np.nan)
    bounds, lost, valued = table.copy(), 0, np.isin(result["status"].values, status.VALUED)
    for at in np.ndindex(*shape):
        if not valued[at]:
            continue
        own = {name: float(value[at]) for name, value in loads.items()}
        held = None if target is None else float(target[at])
        try:
            found = asked.state(own, held, shapes[at])
            known = np.array([float(result[name].values[at]) for name in asked.outputs])
            near = np.array([float(result[f"{name}_error"].values[at]) for name in asked.outputs])
            unit = asked.units(own, found.values)[:, 0]
            same = np.abs(found.values[:, 0] - known) <= near + found.bounds[:, 0] + SAME * unit
            if not np.all(same | np.isnan(found.values[:, 0])):
                raise NotFound
        except NotFound:
            lost += 1
            continue
        table[at], bounds[at] = found.values, found.bounds + SENSITIVITY * asked.error * np.abs(found.values)
    if lost:
        warnings.warn(LOST.format(count=lost, all=np.count_nonzero(valued)), stacklevel=4)
    for i, output in enumerate(asked.outputs):
        for j, name in enumerate(asked.parameters):
            one, about = f"d_{output}_d_{name}", attributes(output, name, tube)
            result[one] = dims, table[..., i, 1 + j], about
            result[f"{one}_error"] = dims, bounds[..., i, 1 + j], about | {"long_name": f"error bound of {one}"}
    return result

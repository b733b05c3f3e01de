"""The designs of a sweep: all combinations of its axes but pressure. Any of them at a time, never all at once."""

import math

import numpy as np

from ..atlas.schema import PARAMETERS
from ..description.courses import distinct, followed
from ..description.local import COURSE, Bodies
from ..description.profiles import as_profile
from ..description.revolution import resolved, wall_volume_inside
from ..description.tube_model import fiber_place


class Grid:
    """The designs that vary in the dimensions of a sweep, those ``without`` left out; counted as C order counts them."""

    def __init__(self, sweep, without=()):
        self.sweep = sweep
        pairs = [(name, size) for name, size in zip(sweep.dims, sweep.shape) if name not in (*without, "pressure")]
        self.dimensions = tuple(name for name, _ in pairs)
        self.shape = tuple(size for _, size in pairs)
        self.size = math.prod(self.shape)

    def columns(self, at) -> dict:
        """Numbers of the designs ``at`` (n,) in the units of schema.PARAMETERS: name -> (n,); of a profile, the middle's."""
        places = dict(zip(self.dimensions, np.unravel_index(at, self.shape) if self.shape else ()))
        full = {name: np.full(len(at), value) for name, value in self.sweep.fixed.items()}
        full |= {name: np.full(len(at), as_profile(pairs).at(0.5)[0]) for name, pairs in self.sweep.profiles.items()}
        full |= {name: values[places[name]] for name, values in self.sweep.axes.items() if name in places}
        if self.sweep.designs:
            full |= {name: column[places["design"]] for name, column in self.sweep.designs["columns"].items()}
        design = {name: full[name] for name in PARAMETERS if name in full and name != "pressure"}
        if "fiber_radius" not in design:
            wall = design["wall"]
            if "wall" in self.sweep.profiles:
                wall = as_profile(self.sweep.profiles["wall"]).samples().min()
            profile = self.sweep.profiles.get("radius")
            inner = design["radius"] if profile is None else np.full(len(at), as_profile(profile).at(0.0)[0])
            design["fiber_radius"] = fiber_place(self.sweep.model.fiber_radius, inner, wall)
        return design

    def surface_of_bodies(self, at):
        """Of designs ``at`` (n,), bodies of revolution: radius of the fibers at half length [m], and volume between cavity
        and fibers [m3]; (2, n).
        """
        designs, which = distinct(self.columns(at), COURSE)
        bodies = [self.tube(design) for design in designs]
        found = np.array([(resolved(body).fibers.at(0.5)[0], wall_volume_inside(body)) for body in bodies])
        return found.reshape(-1, 2)[which].T

    def tube(self, design):
        """What :mod:`freesweep.description.revolution` takes for a tube, of a ``design``: numbers for COURSE."""
        found = Bodies(self.sweep.model, self.sweep.rules, self.sweep.families).tube(
            design.tolist(), self.sweep.profiles
        )
        if not self.sweep.is_of_bodies:
            found.radius = design.tolist()[COURSE.index("radius")]
        return found

    def within(self, other, at):
        """Where the designs ``at`` of this grid lie in ``other``, which has all its dimensions: first along the others."""
        places = dict(zip(self.dimensions, np.unravel_index(at, self.shape) if self.shape else ()))
        index = np.zeros(len(at), np.int64)
        for name, size in zip(other.dimensions, other.shape):
            index = index * size + places.get(name, 0)
        return index


def coordinates(sweep) -> dict:
    """Coordinates of the dataset: name -> (dimensions, values)."""
    found = {name: ((name,), values) for name, values in sweep.axes.items()}
    if sweep.designs:
        found["design"] = (("design",), np.array(sweep.designs["names"], dtype=object))
        found |= {name: (("design",), column) for name, column in sweep.designs["columns"].items()}
    return found | {name: ((), value) for name, value in sweep.fixed.items()}


def tubes(grid, at):
    """Courses, with errors, of the designs ``at`` where some profile varies, each once, and which is whose: see ``Job``."""
    if not grid.sweep.varies:
        return [], np.zeros(len(at), np.int64)
    sweep = grid.sweep
    designs, which = distinct(grid.columns(at), COURSE)
    return [followed(grid.tube(design), sweep.accuracy, bool(sweep.rules)) for design in designs], which

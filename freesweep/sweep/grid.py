"""The designs of a sweep: all combinations of its axes but pressure. Any of them at a time, never all at once."""

import math
from types import SimpleNamespace

import numpy as np

from ..atlas.schema import PARAMETERS
from ..description.profiles import ProfileError, as_profile, follow
from ..description.tube_model import SHARES, fiber_place


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
            inner = self._radius.at(0.0)[0] if self._radius else design["radius"]
            design["fiber_radius"] = fiber_place(self.sweep.model.fiber_radius, inner, wall)
        return design

    @property
    def _radius(self):
        """The profile of the inner radius of bodies of revolution, None of tubes."""
        return as_profile(self.sweep.profiles["radius"]) if "radius" in self.sweep.profiles else None

    def surface_of_bodies(self, design):
        """Of bodies of revolution, whose design has the radius of the fibers at x = 0: ``(that at half length [m], volume
        between cavity and fibers [m3])``; None of tubes.
        """
        if self._radius is None:
            return None
        inside = design["fiber_radius"] - self._radius.at(0.0)[0]
        mean = np.trapezoid(self._radius.values, self._radius.x)
        return self._radius.at(0.5)[0] + inside, np.pi * design["length"] * inside * (2.0 * mean + inside)

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
    profiles = grid.sweep.profiles
    if not profiles:
        return [], np.zeros(len(at), np.int64)
    columns = grid.columns(at)
    names = ("alpha", "beta", "wall", "length", "radius", "fiber_radius")
    designs, which = np.unique(np.column_stack([columns[name] for name in names]), axis=0, return_inverse=True)
    found = []
    for design in designs.tolist():
        numbers = dict(zip(names, design)) | profiles
        numbers["fiber_surface"] = numbers.pop("fiber_radius")
        model = grid.sweep.model
        numbers |= {"fiber_share": SHARES[model.fiber_radius], "is_thick": model.is_thick}
        try:
            found.append(follow(SimpleNamespace(**numbers), grid.sweep.accuracy))
        except ProfileError:
            found.append(None)
    return found, which

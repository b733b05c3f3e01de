"""The grid of an atlas as plain arrays: what is read once and asked often."""

import numpy as np

from ..atlas.schema import PARAMETERS, SHAPE
from ..description.families import families_of
from ..description.local import Bodies, rules_of
from ..description.tube_model import SHARES, model_of
from .axis import make_axis

DEFAULTS = {"fiber_extension": 1.0, "c01": 0.0, "c20": 0.0, "c30": 0.0, "force": 0.0, "torque": 0.0}
DEFAULTS |= dict.fromkeys(SHAPE, 0.0)


class Frame:
    """Coordinates of an atlas' dataset.

    ``values``: name -> (n,) array, of labels for ``design``; ``by_design``: the names that each design has its own of;
    ``ranges``: parameter -> (least, largest); ``dims``: variable -> its axes; ``sizes``: axes in the order of the file.
    """

    def __init__(self, data):
        self.values, self.by_design, self.attributes = {}, [], {}
        for name in data.coords:
            if name != "design" and name not in PARAMETERS:
                continue
            coordinate = data[name]
            self.values[name] = np.atleast_1d(coordinate.values)
            self.attributes[name] = dict(coordinate.attrs)
            if name != "design" and "design" in coordinate.dims:
                self.by_design.append(name)
        self.ranges = {
            name: (float(array.min()), float(array.max())) for name, array in self.values.items() if name in PARAMETERS
        }
        self.dims = {name: variable.dims for name, variable in data.variables.items()}
        self.sizes = dict(data.sizes)
        self.energy = data.attrs.get("energy", "full")
        self.model = model_of(data.attrs)
        self.families = families_of(data.attrs)
        of_bodies = set(SHAPE) & set(self.values)
        self.bodies = Bodies(self.model, rules_of(data.attrs), self.families) if of_bodies else None
        self.accuracy = float(data.attrs.get("accuracy", 1e-6))
        self.title = data.attrs.get("title", "")
        self._axes = {}

    def axis(self, name):
        """The :class:`axis.Axis` of a name along which points are told apart."""
        if name not in self._axes:
            self._axes[name] = make_axis(name, self.values[name])
        return self._axes[name]

    def axes_of(self, variables) -> tuple:
        """The axes along which any of these variables varies: the locked energy does in the wall, too."""
        fullest = max((self.dims[name] for name in variables if name in self.dims), key=len)
        return tuple(name for name in fullest if self.varies(name))

    def varies(self, name) -> bool:
        """Whether a name is an axis along which points are told apart."""
        return name == "design" or (name not in self.by_design and len(self.values[name]) > 1)

    @property
    def fiber_share(self) -> float:
        """Share of the wall that lies inside the fibers; -1 where their radius is given."""
        return -1.0 if "fiber_radius" in self.values else SHARES[self.model.fiber_radius]

    @property
    def asked(self) -> list:
        """Names that a question may give."""
        return [name for name in self.values if name not in self.by_design]

    @property
    def in_numbers(self) -> bool:
        """Whether numbers describe the designs in full: tubes that are the same all along, or bodies of a taper, a bulge."""
        return {*self.families, "length", "radius", "wall", "c10"} <= set(self.values)

    @property
    def uniform_along_x(self) -> bool:
        """Whether the designs are the same all along the tube, have two families, and are described in full."""
        return self.in_numbers and self.bodies is None and len(self.families) == 2

"""What a sweep asks for, once it is read and without faults."""

import hashlib
import math
from dataclasses import dataclass, field

import numpy as np

from ..atlas.schema import HELD, SHAPE
from ..description.families import FAMILIES
from ..description.tube_model import MODELS, TubeModel
from .solver_table import BUDGET


@dataclass(frozen=True, eq=False)
class Sweep:
    """A checked sweep. Values are in the units of schema.PARAMETERS, arrays are read-only.

    ``fixed`` holds single values; ``axes`` strictly increasing arrays, shape (n,), in the order of schema.PARAMETERS.
    ``designs`` is None, or {"names": tuple of texts, "columns": {parameter: array, shape (designs,)}}. Every parameter
    stands in one of the three, or in ``profiles``: name -> pairs (x/l, value), or a smooth profile of them. Only
    ``fiber_radius`` may be in none, then the fibers lie where the ``model`` says; ``c20`` and ``c30``: then the rubber is no
    Yeoh rubber; ``taper`` and ``bulge``. ``rules`` are words that numbers follow along a body: they are those at x = 0.
    """

    title: str
    energy: str
    fixed: dict[str, float]
    axes: dict[str, np.ndarray]
    designs: dict | None
    accuracy: float
    text: str = field(repr=False)
    blocked: tuple[str, ...] = ()  # which of blocked_force, blocked_torque are solved
    profiles: dict[str, tuple] = field(default_factory=dict)
    interpolation_tolerance: float | None = None
    budget: int = BUDGET  # points to which axes may grow for the tolerance
    material: str = ""  # name of its rubber, if it came from the library
    model: TubeModel = MODELS["source"]
    rules: dict[str, str] = field(default_factory=dict)
    families: tuple[str, ...] = FAMILIES  # of fibers that its tubes have

    @property
    def sha256(self) -> str:
        """Hash of the text, hexadecimal."""
        return hashlib.sha256(self.text.encode("utf-8")).hexdigest()

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions: ``design`` first if there are designs, then the axes."""
        return (("design",) if self.designs else ()) + tuple(self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the dimensions."""
        return shape_of(self.axes, self.designs)

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the parameters that have numbers."""
        return (*self.fixed, *self.axes, *(self.designs or {}).get("columns", ()))

    @property
    def is_of_bodies(self) -> bool:
        """Whether its radius varies along the tubes: a profile, or what has a taper or a bulge, if of 0."""
        return "radius" in self.profiles or bool(set(SHAPE) & set(self.places))

    @property
    def varies(self) -> bool:
        """Whether something varies along its tubes."""
        return bool(self.profiles) or self.is_of_bodies

    @property
    def is_physical(self) -> bool:
        """Whether its tubes are more than the source's, or less: thick, loose, or without a family."""
        return self.model.is_physical or len(self.families) < 2

    @property
    def points(self) -> int:
        """Number of equilibria asked for, those of held states apart."""
        return math.prod(size for name, size in zip(self.dims, self.shape) if name not in HELD)


def shape_of(axes, designs) -> tuple[int, ...]:
    """Sizes of the dimensions that axes and named designs make."""
    return ((len(designs["names"]),) if designs else ()) + tuple(len(array) for array in axes.values())

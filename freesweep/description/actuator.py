"""What a person describes: the actuator, checked, in SI units and degrees."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from .along import rule_of
from .elastomer import MooneyRivlin, Yeoh
from .families import FAMILIES, followed, given_by, threads
from .faults import ActuatorError
from .fields import VARYING, read_fields
from .given import numbers
from .impossible import clamped_stretch, impossible
from .options import read_choice
from .profiles import Along as AlongTube
from .profiles import ProfileError, as_profile, is_profile
from .quantities import Along, Quantities, Quantity
from .revolution import inner_radius, is_body, resolved
from .tube_model import DEFAULT, MODELS, SHARES, fiber_place
from .unit_warnings import design_doubts, warn_of

HASHED = np.linspace(0.0, 1.0, 9)  # places of profiles whose values go into a hash
EVENLY = np.linspace(0.0, 1.0, 257)  # places of a body at which its wall is held against its radius


@dataclass(frozen=True, kw_only=True)
class Actuator:
    """A fiber-reinforced tube before deformation.

    Parameters
    ----------
    alpha, beta : fiber angles from the axis [degree], between -90 and 90, at least 0.5 apart; a number, or a profile
        along the tube: pairs ``[(x/l, angle), ...]`` (a repeated x/l is a jump), a callable of x/l (array in, array out), or
        ``Profile(pairs, smooth=True)``, a spline through pairs. On a body of revolution also "geodesic 30 deg": the winding
        of that angle at x = 0 that does not slip (Clairaut). None, or "none": there is no such family; a tube without both
        is a balloon. Loose fibers may also have one angle: two families that are one
    length, radius : undeformed length, inner radius [m]; numbers, texts with units ("4.76 mm") or what carries units. The
        radius may be a profile over x/l along the axis, which may bend but not jump: a body of revolution
    taper, bulge : what makes a body of any radius, which counts ``(1 - taper x/l) (1 + bulge sin^2(pi x/l))`` times: the
        share by which the far end is slimmer than the near one (-10 to 1; negative: wider), and that by which the middle is
        wider than without (-1 to 10), smoothly
    wall : wall thickness [m], number or profile; of a body also "constant volume 1.5 mm": the section stays that at x = 0
    material : :class:`MooneyRivlin`, :class:`NeoHookean`, :class:`Yeoh`, or the name of a rubber of the library, as of
        :func:`freesweep.material`
    fiber_extension : stretch gamma >= 1 of the fibers at any pressure (Eqs. 2.3, 2.17); 1 is inextensible
    model : "source": the membrane with bonded fibers at the inner radius that the source computes; "physical": a thick wall
        with loose fibers at the outer radius. Each part can be given by itself:
    fiber_radius : "inner", "middle", "outer" (of a wall that varies, where it is thinnest), or the radius at which the
        fibers lie [m], from the inner to the outer one; None: as the model has it
    wall_model : "thick": each layer of the wall is strained by itself; "membrane": all of it as at the fibers; or None
    fibers : "loose": threads, which cannot push; "bonded": fibers that push where they have to; or None. A single family,
        too, is one or the other
    energy : "full": the wall is sheared by the twist; "principal": Eq. 2.5 as printed, for two bonded families only

    Raises :class:`ActuatorError`, which lists every fault. Warns of what looks like a slip of units, and where the wall is
    thicker than the radius. Equal actuators have equal hashes; callables are equal if they are the same.
    """

    alpha: Any
    beta: Any
    length: float
    radius: Any
    wall: Any
    material: MooneyRivlin | Yeoh
    taper: float = 0.0
    bulge: float = 0.0
    fiber_extension: float = 1.0
    fiber_radius: float | str | None = None
    energy: str = "full"
    model: str = DEFAULT
    wall_model: str | None = None
    fibers: str | None = None

    if TYPE_CHECKING:  # what may be given is more than what is kept

        def __init__(
            self,
            *,
            alpha: Along | None,
            beta: Along | None,
            length: Quantity,
            radius: Along,
            wall: Along,
            material: MooneyRivlin | Yeoh | str,
            taper: Quantity = 0.0,
            bulge: Quantity = 0.0,
            fiber_extension: Quantity = 1.0,
            fiber_radius: Quantity | None = None,
            energy: str = "full",
            model: str = DEFAULT,
            wall_model: str | None = None,
            fibers: str | None = None,
        ) -> None: ...

    def __post_init__(self):
        faults = []
        for name, value in read_fields(self, faults).items():
            object.__setattr__(self, name, value)
        if not faults:
            try:
                faults = impossible(self)
            except ProfileError as error:
                faults = [f"alpha, beta, wall, radius: {error}"]
        if faults:
            raise ActuatorError(faults)
        varying = [name for name in VARYING if getattr(self, name) is not None and (self.is_body or name != "radius")]
        without = dict.fromkeys((name for name in FAMILIES if getattr(self, name) is None), 0.0)
        numbers = self.design() | without | {name: self.profile(name).samples() for name in varying}
        own = {name: numbers[name] for name in (*VARYING, "length", "c10")}
        thickness = self.profile("wall").at(EVENLY) / self.profile("radius").at(EVENLY) if self.is_body else None
        warn_of(design_doubts(own, self.is_thick, thickness), stacklevel=3)

    @classmethod
    def from_cord(cls, *, cord: Quantity, turns: Quantity, length: Quantity, **others: Any) -> Actuator:
        """The muscle of a cord of length ``cord`` [m] that winds ``turns`` times around ``length`` [m].

        Unrolled, the cord is the hypotenuse: ``cord^2 = length^2 + (2 pi R turns)^2``, with the angle
        ``acos(length/cord)`` from the axis and R the radius on which it lies. ``others`` are parameters of the actuator.
        Where ``radius`` is left out, it is what puts the fibers there: R for fibers inside, less the wall for fibers
        outside; where it is given, R becomes the fiber radius. ``beta`` is ``-alpha`` by default. Raises
        :class:`ActuatorError`.
        """
        from .cord import of_cord

        return cls(**of_cord(cord, turns, length, others))

    def __hash__(self):
        fields = (
            self.length, self.taper, self.bulge, self.material, self.fiber_extension, self.fiber_radius, self.energy,
            self.model, self.wall_model, self.fibers,
        )  # fmt: skip
        profiles = [self.profile(name) for name in VARYING if getattr(self, name) is not None]
        varying = (given_by(self), *(tuple(profile.at(HASHED).tolist()) for profile in profiles))
        return hash((*fields, varying))

    def __repr__(self):
        """What makes it: what is not usual, and the model, whose default may change."""
        usual = {one.name: repr(one.default) for one in fields(self) if one.name != "model"}
        told = [one for one in fields(self) if repr(getattr(self, one.name)) != usual.get(one.name)]
        return f"Actuator({', '.join(f'{one.name}={getattr(self, one.name)!r}' for one in told)})"

    def _repr_html_(self):
        from ..notebook import of_actuator

        return of_actuator(self)

    def clamped_stretch(self) -> float:
        """Squared meridional stretch at the clamped ends [-] (G at y = 1): positive if the fibers can meet them."""
        return min(clamped_stretch(a, b, self.fiber_extension) for a, b in zip(*self.angles(np.array([0.0, 1.0]))))

    @property
    def varies(self) -> bool:
        """Whether a fiber angle, the wall or the radius is a profile along the tube."""
        return self.is_body or any(is_profile(getattr(self, name)) for name in VARYING)

    @property
    def is_body(self) -> bool:
        """Whether the radius varies: a body of revolution."""
        return is_body(self)

    def angles(self, share: Quantities) -> tuple[Any, Any]:
        """Both fiber angles [degree] at shares x/l of the length, 0 to 1; on a jump the left ones. NaN where there is no
        such family.

        Raises :class:`ActuatorError`.
        """
        try:
            share = numbers(share, "1")
        except ValueError as error:
            raise ActuatorError([f"share: {error}"]) from None
        if not np.all((share >= 0.0) & (share <= 1.0)):
            raise ActuatorError(["share: a place x/l lies beyond the tube; give numbers from 0 to 1"])
        return tuple(
            np.full(np.atleast_1d(share).shape, np.nan) if getattr(self, name) is None else self.profile(name).at(share)
            for name in FAMILIES
        )

    def lines(self, share: Quantities) -> tuple[Any, Any]:
        """Angles [degree] of the lines that the solver follows: the fibers, where there are two families of them
        (:mod:`freesweep.description.families`).
        """
        own = resolved(self)
        return own.first.at(share), own.second.at(share)

    def profile(self, name: str) -> AlongTube:
        """Fiber angle [degree], wall or inner radius [m] along the tube, as
        :class:`freesweep.description.profiles.Along`, numbers too.

        ``name`` is "alpha", "beta", "wall" or "radius". Raises :class:`ActuatorError`, also of a family that there is not.
        """
        faults = []
        if read_choice("name", name, VARYING, faults) is None:
            raise ActuatorError(faults)
        value = getattr(self, name)
        if value is None:
            raise ActuatorError([f"name: this tube has no fibers of the family {name}"])
        if name == "radius":
            return inner_radius(self)
        return resolved(self).named(name) if rule_of(name, value) else as_profile(value, VARYING[name])

    @property
    def fiber_surface(self) -> float:
        """Radius at which the fibers lie [m], of a body at x = 0; every formula is scaled by it."""
        if self.is_body:
            return resolved(self).scale[1]
        place = MODELS[self.model].fiber_radius if self.fiber_radius is None else self.fiber_radius
        if isinstance(place, str):
            inside = float(np.min(self.profile("wall").samples())) if SHARES[place] else 0.0
            return fiber_place(place, self.radius, inside)
        return place

    @property
    def fiber_share(self) -> float:
        """Share of the wall inside the fibers of a body."""
        return SHARES[self.fiber_radius or MODELS[self.model].fiber_radius]

    def fiber_surface_at(self, share: Quantities) -> Any:
        """Radius at which the fibers lie [m] at shares x/l of the length; one number of a tube."""
        return resolved(self).fibers.at(share) if self.is_body else self.fiber_surface

    @property
    def is_thick(self) -> bool:
        """Whether each layer of the wall is strained by itself."""
        return (self.wall_model or MODELS[self.model].wall_model) == "thick"

    @property
    def is_loose(self) -> bool:
        """Whether the fibers are threads, which cannot push."""
        return (self.fibers or MODELS[self.model].fibers) == "loose"

    @property
    def threads(self) -> float:
        """What families of fibers there are and whether they may push, as the solver takes it."""
        return threads(self)

    @property
    def has_two_families(self) -> bool:
        """Whether fibers of two angles hold the wall; fewer leave the locked shape free."""
        return len(followed(self)) == 2

    def design(self) -> dict[str, float]:
        """The numbers that a sweep would vary: name -> value in SI units and degrees; of a profile, the middle's; with fewer
        than two families the angles of :meth:`lines`.
        """
        alpha, beta = self.lines(0.5)
        return {
            "alpha": alpha.item(),
            "beta": beta.item(),
            "length": self.length,
            "radius": self.profile("radius").at(0.5).item(),
            "wall": self.profile("wall").at(0.5).item(),
            "fiber_radius": self.fiber_surface,
            "fiber_extension": self.fiber_extension,
            "c10": self.material.c10,
            "c01": self.material.c01,
            "c20": self.material.c20,
            "c30": self.material.c30,
        }

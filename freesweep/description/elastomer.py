"""Rubbers: strain energy densities and their constants, checked, in [Pa].

All are cases of ``w = c10 (I1 - 3) + c01 (I2 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3``; each has these four numbers.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from .faults import ActuatorError
from .given import described, read_number
from .quantities import Quantity


@dataclass(frozen=True)
class MooneyRivlin:
    """Mooney-Rivlin rubber: w = c10 (I1 - 3) + c01 (I2 - 3), Eq. 2.5.

    ``c10`` > 0 and ``c01`` >= 0 in [Pa]. ``largest_stretch``, if known, is the principal stretch up to which the constants
    were found to hold: solutions that go beyond it give a warning. ``source`` says where they come from. Raises
    :class:`ActuatorError`.
    """

    constants: ClassVar[tuple[str, ...]] = ("c10", "c01")
    c20: ClassVar[float] = 0.0
    c30: ClassVar[float] = 0.0

    c10: float
    c01: float = 0.0
    largest_stretch: float | None = field(default=None, repr=False, compare=False, kw_only=True)
    source: str = field(default="", repr=False, compare=False, kw_only=True)

    if TYPE_CHECKING:  # what may be given is more than what is kept

        def __init__(
            self, c10: Quantity, c01: Quantity = 0.0, *, largest_stretch: Quantity | None = None, source: str = ""
        ) -> None: ...

    def __post_init__(self):
        _read(self, c10={"positive": True}, c01={"least": 0.0})

    def _repr_html_(self):
        from ..notebook import of_rubber

        return of_rubber(self)


@dataclass(frozen=True)
class NeoHookean(MooneyRivlin):
    """Neo-Hookean rubber: w = c10 (I1 - 3), ``c10`` > 0 in [Pa]; the rest as in :class:`MooneyRivlin`."""

    constants: ClassVar[tuple[str, ...]] = ("c10",)

    c01: float = field(default=0.0, init=False, repr=False)

    if TYPE_CHECKING:

        def __init__(self, c10: Quantity, *, largest_stretch: Quantity | None = None, source: str = "") -> None: ...


@dataclass(frozen=True)
class Yeoh:
    """Yeoh rubber: w = c1 (I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3; it stiffens at large stretches where these are positive.

    ``c1`` > 0, half the small-strain shear modulus, ``c2`` and ``c3`` of any sign, in [Pa]; the rest as in
    :class:`MooneyRivlin`. Where c2 or c3 is negative the energy may cease to be convex (:func:`convex_to`): a warning says
    where, unless ``largest_stretch`` lies below that, and each solution that goes there gives another. Raises
    :class:`ActuatorError`.
    """

    constants: ClassVar[tuple[str, ...]] = ("c1", "c2", "c3")
    c01: ClassVar[float] = 0.0

    c1: float
    c2: float = 0.0
    c3: float = 0.0
    largest_stretch: float | None = field(default=None, repr=False, compare=False, kw_only=True)
    source: str = field(default="", repr=False, compare=False, kw_only=True)

    if TYPE_CHECKING:

        def __init__(
            self,
            c1: Quantity,
            c2: Quantity = 0.0,
            c3: Quantity = 0.0,
            *,
            largest_stretch: Quantity | None = None,
            source: str = "",
        ) -> None: ...

    def __post_init__(self):
        _read(self, c1={"positive": True}, c2={}, c3={})
        limit = float(convex_to(self.c1, self.c2, self.c3))
        if limit < (math.inf if self.largest_stretch is None else strip_strain(self.largest_stretch)):
            warnings.warn(
                f"{self!r} is convex only up to I1 - 3 = {limit:.3g}, a strip drawn to {_strip(limit):.3g} times its length:"
                " beyond it the stress would fall as the strain grows; take these constants below that only",
                stacklevel=3,
            )

    def _repr_html_(self):
        from ..notebook import of_rubber

        return of_rubber(self)

    @property
    def c10(self) -> float:
        """Coefficient of I1 - 3 [Pa]."""
        return self.c1

    @property
    def c20(self) -> float:
        """Coefficient of (I1 - 3)^2 [Pa]."""
        return self.c2

    @property
    def c30(self) -> float:
        """Coefficient of (I1 - 3)^3 [Pa]."""
        return self.c3


ELASTOMERS = (MooneyRivlin, Yeoh)


def rubber_of(c10, c01=0.0, c20=0.0, c30=0.0):
    """The rubber of four coefficients [Pa]: Yeoh if one of the last two is not 0."""
    return Yeoh(c10, c20, c30) if c20 or c30 else MooneyRivlin(c10, c01)


def convex_to(c1, c2, c3):
    """I1 - 3 up to which a Yeoh energy is convex [-], infinite where it always is; arrays broadcast.

    Convex as rubbers have to be (strongly elliptic): the shear stress ``2 k w'(k^2)`` grows with the amount of shear k, for
    which I1 - 3 = k^2. At a given I1 no other deformation is nearer to failing. That is ``c1 + 6 c2 i + 15 c3 i^2 > 0``.
    """
    c1, b, c = np.broadcast_arrays(np.asarray(c1, float), 6.0 * np.asarray(c2, float), 15.0 * np.asarray(c3, float))
    with np.errstate(all="ignore"):
        inner = -0.5 * (b + np.copysign(np.sqrt(b * b - 4.0 * c * c1), b))  # roots inner/c and c1/inner; NaN: none
        roots = np.stack([inner / c, c1 / inner])
        return np.min(np.where(roots > 0.0, roots, np.inf), axis=0)


def strip_strain(stretch):
    """I1 - 3 of a strip drawn to ``stretch`` times its length [-]."""
    return stretch * stretch + 2.0 / stretch - 3.0


def _strip(strain):
    """Stretch of a strip at which I1 - 3 is ``strain``: the largest root of x^3 - (strain + 3) x + 2."""
    return float(np.max(np.roots([1.0, 0.0, -(strain + 3.0), 2.0]).real))


def _read(rubber, **constants):
    """Make floats of a rubber's constants, each with its domain, and of its range; raises :class:`ActuatorError`."""
    faults = []
    read = {
        name: read_number(name, getattr(rubber, name), "Pa", faults, **domain) for name, domain in constants.items()
    }
    if rubber.largest_stretch is not None:
        stretch = read["largest_stretch"] = read_number("largest_stretch", rubber.largest_stretch, "1", faults)
        if stretch is not None and not stretch > 1.0:
            faults.append(f"largest_stretch: found {stretch:g}; it has to be above 1")
    if not isinstance(rubber.source, str):
        faults.append(f"source: found {described(rubber.source)}; give a text")
    if faults:
        raise ActuatorError(faults)
    for name, number in read.items():
        object.__setattr__(rubber, name, number)

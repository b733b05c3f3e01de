"""Rubbers: strain energy densities and their constants, checked, in [Pa]."""

from dataclasses import dataclass, field
from typing import ClassVar

from .faults import ActuatorError, number_fault


@dataclass(frozen=True)
class MooneyRivlin:
    """Mooney-Rivlin rubber: w = c10 (I1 - 3) + c01 (I2 - 3), Eq. 2.5.

    ``c10`` > 0 and ``c01`` >= 0 in [Pa]. ``largest_stretch``, if known, is the principal stretch up to which the constants
    were found to hold: solutions that go beyond it give a warning. ``source`` says where they come from. Raises
    :class:`ActuatorError`.
    """

    constants: ClassVar[tuple] = ("c10", "c01")

    c10: float
    c01: float = 0.0
    largest_stretch: float | None = field(default=None, repr=False, compare=False, kw_only=True)
    source: str = field(default="", repr=False, compare=False, kw_only=True)

    def __post_init__(self):
        _check(
            number_fault("c10", self.c10, "Pa", positive=True),
            number_fault("c01", self.c01, "Pa", least=0.0),
            _range_fault(self.largest_stretch),
        )


@dataclass(frozen=True)
class NeoHookean(MooneyRivlin):
    """Neo-Hookean rubber: w = c10 (I1 - 3), ``c10`` > 0 in [Pa]; the rest as in :class:`MooneyRivlin`."""

    constants: ClassVar[tuple] = ("c10",)

    c01: float = field(default=0.0, init=False, repr=False)


def _check(*faults):
    if faults := [fault for fault in faults if fault]:
        raise ActuatorError(faults)


def _range_fault(stretch):
    if stretch is None:
        return None
    fault = number_fault("largest_stretch", stretch, "1")
    return fault or (None if stretch > 1.0 else f"largest_stretch: found {stretch:g}; it has to be above 1")

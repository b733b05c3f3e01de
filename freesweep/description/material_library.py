"""Published constants of rubbers by name, each with its source and the stretch up to which they hold.

Silicones differ between batches, curing and test speeds: published constants of one product differ by a factor of 2 (Ecoflex
00-30: c1 is 7.9 kPa here, 8.4 and 17 kPa in two sets of the simulator Sorotoki). Take these for a first design, and
:func:`freesweep.calibrate` for your own.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Literal, TypeAlias, overload

from .elastomer import MooneyRivlin, Yeoh
from .faults import ActuatorError
from .given import described
from .units import shown

_TABLE_1 = (
    "source, Table 1 (natural rubber latex, Kent Elastomer), adjusted there to the measured lengths of the McKibben muscle"
    " of {angle} degrees; no wall of it is stretched beyond its locked shape"
)
_TENSILE = (
    "least squares, to a stretch of {stretch}, of the tensile test (ASTM D412, 450 mm/min) published by L. Marechal,"
    " P. Balland, L. Lindenroth, F. Petrou, C. Kontovounisios, F. Bello: Toward a Common Framework and Database of Materials"
    " for Soft Robotics, Soft Robotics 8 (2021), doi 10.1089/soro.2019.0115 (data: their Soft-Robotics-Materials-Database);"
    " largest misfit {misfit} of the stress there"
)


class Library(Mapping[str, MooneyRivlin | Yeoh]):
    """Rubbers by name: ``materials["ecoflex-00-30"]``; each has its ``source`` and its ``largest_stretch``."""

    def __init__(self, rubbers):
        self._rubbers = rubbers

    def __getitem__(self, name):
        return self._rubbers[name]

    def __iter__(self):
        return iter(self._rubbers)

    def __len__(self):
        return len(self._rubbers)

    def __repr__(self):
        from ..notebook import library_text

        return library_text(self)

    def _repr_html_(self):
        from ..notebook import of_library

        return of_library(self)


materials: Library = Library(
    {
        "natural-latex": MooneyRivlin(0.11e6, 0.06e6, largest_stretch=1.64, source=_TABLE_1.format(angle=30)),
        "natural-latex-35": MooneyRivlin(0.18e6, 0.12e6, largest_stretch=1.43, source=_TABLE_1.format(angle=35)),
        "natural-latex-40": MooneyRivlin(0.18e6, 0.10e6, largest_stretch=1.28, source=_TABLE_1.format(angle=40)),
        "ecoflex-00-30": Yeoh(7.93e3, 85.4, largest_stretch=4.0, source=_TENSILE.format(stretch=4, misfit="1.9 %")),
        "dragon-skin-30": Yeoh(
            92.2e3, 9.03e3, -357.0, largest_stretch=3.0, source=_TENSILE.format(stretch=3, misfit="0.7 %")
        ),
        "elastosil-m4601": Yeoh(
            0.11e6,
            0.02e6,
            largest_stretch=2.0,
            source="Yeoh C1 = 0.11 MPa, C2 = 0.02 MPa, of Elastosil (Shore A 28) in the soft-robot simulator Sorotoki"
            " (B. Caasenbrood, SorotokiCode, preset material Elastosil28) and in public finite-element models of PneuNets"
            " actuators. That M 4601 is meant is our reading: neither names the type, tests or a range; the stretch of 2 is"
            " our own caution",
        ),
    }
)


Latex: TypeAlias = Literal["natural-latex", "natural-latex-35", "natural-latex-40"]  # editors complete them
Silicone: TypeAlias = Literal["ecoflex-00-30", "dragon-skin-30", "elastosil-m4601"]


@overload
def material(name: Latex) -> MooneyRivlin: ...
@overload
def material(name: Silicone) -> Yeoh: ...
@overload
def material(name: str) -> MooneyRivlin | Yeoh: ...
def material(name: str) -> MooneyRivlin | Yeoh:
    """A rubber of the library (``freesweep.materials`` lists them); its ``source`` says where the constants come from.

    Raises :class:`ActuatorError` for a name it does not hold.
    """
    if isinstance(name, str):
        found = materials.get(name.strip().lower().replace(" ", "-").replace("_", "-"))
        if found is not None:
            return found
    text = name.lower()[:40] if isinstance(name, str) else ""
    near = difflib.get_close_matches(text, list(materials), n=1, cutoff=0.4)
    hint = f"did you mean {near[0]!r}? " if near else ""
    found = shown(name) if isinstance(name, str) else described(name)
    raise ActuatorError([f"material: found {found}; {hint}The library holds {', '.join(materials)}"])


def name_of(rubber: MooneyRivlin | Yeoh) -> str:
    """The name of a rubber in the library, or, of one that is not in it, how it is made."""
    return next((name for name, one in materials.items() if one == rubber), repr(rubber))

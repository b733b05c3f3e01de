"""How stiff the free end of a tube is, along the axis and in torsion: the derivative of a load by what it moves."""

import numpy as np

from ..derivative.dual import Dual
from ..derivative.physics import OWN
from ..derivative.request import SHAPE
from .wishes import HELD, STIFF

ACCURACY = 1e-7


def stiffness(names, kind, found, design, energy) -> dict:
    """Those of ``names`` that are stiffnesses, with their bounds, of states of the source's tubes that were ``found``; NaN
    where vectors tell no derivative.
    """
    from ..derivative.vectors import differentiated

    made = {}
    for name in set(names) & set(STIFF):
        load, moved = STIFF[name], HELD[STIFF[name]][0]
        held = found[kind] if kind in HELD else None
        numbers = design | ({} if held is None else {kind: held})
        known = np.flatnonzero(np.isfinite(held if held is not None else found[moved]))
        numbers = {key: column[known] for key, column in numbers.items()}
        parts = np.zeros((OWN + 1, 1))
        parts[OWN] = 1.0
        numbers[load] = Dual(numbers[load], parts)
        size = np.pi * numbers["fiber_radius"] ** (2 if load == "force" else 3) * numbers["c10"]
        rows, bounds = differentiated(numbers, energy, size[None], SHAPE, ACCURACY)
        slope, doubt = rows[SHAPE.index(moved), 1], bounds[SHAPE.index(moved), 1]
        value, bound = np.full((2, len(design["alpha"])), np.nan)
        value[known], bound[known] = 1.0 / slope, doubt / slope**2
        made |= {name: value, f"{name}_error": bound}
    return made


def derivatives_for(names, kind):
    """The derivatives that tell the stiffnesses among ``names`` in a state of a ``kind``; None for none."""
    asked = [HELD[kind][0] if kind in HELD else STIFF[name] for name in names if name in STIFF]
    return sorted(set(asked)) or None


def stiffness_of(numbers, names, kind) -> dict:
    """The same as :func:`stiffness`, of a state with its derivatives."""
    made = {}
    for name in set(names) & set(STIFF):
        load, moved = STIFF[name], HELD[STIFF[name]][0]
        if kind in HELD:
            slope = f"d_{load}_d_{moved}"
            made |= {name: numbers[slope], f"{name}_error": numbers[f"{slope}_error"]}
        else:
            slope, doubt = (numbers[f"d_{moved}_d_{load}{end}"] for end in ("", "_error"))
            made |= {name: 1.0 / slope, f"{name}_error": doubt / slope**2}
    return made

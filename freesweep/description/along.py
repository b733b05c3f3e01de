"""What a person gives along a tube, beyond pairs and callables: knots that are smooth or free, and two rules by words."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from .faults import ActuatorError
from .given import described
from .quantities import Quantity

MOST_KNOTS = 40
GEODESIC, CONSTANT_VOLUME = "geodesic", "constant volume"
RULES = {"alpha": GEODESIC, "beta": GEODESIC, "wall": CONSTANT_VOLUME}  # by what a parameter may follow the radius


@dataclass(frozen=True)
class Profile:
    """A profile along the tube: given by knots, or free between two values (for :func:`freesweep.design`).

    Parameters
    ----------
    knots : pairs ``[(x/l, value), ...]``, as other parameters of an actuator take them; or a number, 2 or more, of evenly
        spaced knots that are free
    between : of free knots the lowest and the highest value, in the unit of the parameter; linear in between
    smooth : of given knots: a cubic spline through them, without a bend at the knots, instead of straight lines; at a
        repeated x/l it ends and another begins, so that there is a bend, or a jump
    """

    knots: Any
    between: tuple[Quantity, Quantity] | None = None
    smooth: bool = False

    def __post_init__(self):
        faults = []
        if not isinstance(self.smooth, bool):
            faults.append(f"smooth: found {described(self.smooth)}; give True or False")
        if self.between is None:
            if isinstance(self.knots, (int, float, str)) or callable(self.knots):
                faults.append(f"knots: found {described(self.knots)}; give pairs (x/l, value), or between, too")
        elif not isinstance(self.knots, int) or isinstance(self.knots, bool) or not 2 <= self.knots <= MOST_KNOTS:
            faults.append(f"knots: found {described(self.knots)}; give a whole number, 2 to {MOST_KNOTS}")
        elif self.smooth:
            faults.append("smooth: free knots are joined by straight lines; leave it out")
        if faults:
            raise ActuatorError(faults)

    @property
    def is_free(self) -> bool:
        """Whether its values are to be found."""
        return self.between is not None


def rule_of(name, value):
    """The text behind the word of a rule that the parameter ``name`` may follow ("geodesic 30 deg" -> "30 deg"), or None."""
    if not isinstance(value, str) or name not in RULES:
        return None
    found = re.fullmatch(rf"\s*{RULES[name].replace(' ', '[ -]+')}\s+(.+)", value)
    return found and found[1]


def written(name, number, unit) -> str:
    """A rule as a text: read again, it is the same."""
    return f"{RULES[name]} {number!r} {'deg' if unit == 'degree' else unit}"

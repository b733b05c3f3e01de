"""What designs are at one place along them, from the numbers that describe them: those of :mod:`.revolution` for many
designs at once, arrays that broadcast.
"""

from typing import NamedTuple

import numpy as np

from .along import RULES, Profile
from .profiles import as_profile
from .revolution import shape, shape_slope
from .tube_model import SHARES


class Bodies(NamedTuple):
    """Bodies whose fibers lie at one ``place`` in the wall, one of FIBER_PLACES; ``rules``: parameter -> word."""

    place: str
    rules: dict

    def at(self, design, share, near=None) -> dict:
        """``design`` (name -> numbers [degree, m]; of what follows a rule those at x = 0) as it is at shares x/l of the
        length, with its ``fiber_radius`` [m]. Where its radius is given along it, that at x = 0 is ``near`` [m]. NaN for the
        angle of a geodesic that has turned back.
        """
        wall, part = design["wall"], SHARES[self.place]
        inner = design["radius"] * shape(share, design.get("taper", 0.0), design.get("bulge", 0.0))
        near = design["radius"] if near is None else near
        first = near + part * wall
        if "wall" in self.rules:
            section = (near + wall) ** 2 - near**2
            wall = section / (np.sqrt(inner**2 + section) + inner)
        found = design | {"radius": inner, "wall": wall, "fiber_radius": inner + part * wall}
        with np.errstate(invalid="ignore"):
            for name in {"alpha", "beta"} & set(self.rules):
                sine = np.sin(np.radians(design[name])) * first / found["fiber_radius"]
                found[name] = np.degrees(np.arcsin(sine))
        return found

    def rise(self, design, share):
        """Slope of the fibers' surface there, dR/dx."""
        inside = design["radius"] * shape_slope(share, design.get("taper", 0.0), design.get("bulge", 0.0))
        if "wall" in self.rules:
            own = self.at(design, share)
            inside = inside * (1.0 + SHARES[self.place] * (own["radius"] / (own["radius"] + own["wall"]) - 1.0))
        return inside / design["length"]


def rules_of(attributes) -> dict:
    """The rules that an atlas tells in its attributes."""
    return {name: word for name, word in RULES.items() if attributes.get(f"rule_{name}") == word}


def profile_of(attributes, name):
    """The profile of a parameter that an atlas tells in its attributes, None without."""
    if f"profile_{name}" not in attributes:
        return None
    pairs = np.reshape(attributes[f"profile_{name}"], (-1, 2)).tolist()
    return as_profile(Profile(pairs, smooth=bool(attributes.get(f"smooth_{name}", 0))))

"""What designs are at one place along them, from the numbers that describe them: those of :mod:`.revolution` for many
designs at once, arrays that broadcast.
"""

from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from .along import RULES, Profile, written
from .families import FAMILIES
from .profiles import as_profile
from .revolution import shape, shape_slope
from .tube_model import SHARES, TubeModel

UNITS = {"alpha": "degree", "beta": "degree", "wall": "m"}  # of what may follow a rule
COURSE = ("alpha", "beta", "wall", "length", "radius", "fiber_radius", "taper", "bulge")  # numbers that make one
# places x/l and weights for means along a body, whose radius is smooth but may be slim: to rounding
SHARE, WEIGHT = (0.5 * (np.polynomial.legendre.leggauss(48)[k] + (k == 0)) for k in (0, 1))


class Bodies(NamedTuple):
    """Bodies of revolution that numbers describe, of one ``model``; ``rules``: parameter -> word."""

    model: TubeModel
    rules: dict
    families: tuple = FAMILIES

    @property
    def part(self) -> float:
        """Share of the wall inside the fibers."""
        return SHARES[self.model.fiber_radius]

    def at(self, design, share, near=None) -> dict:
        """``design`` (name -> numbers [degree, m]; of what follows a rule those at x = 0) as it is at shares x/l of the
        length, with its ``fiber_radius`` [m]. Where its radius is given along it, that at x = 0 is ``near`` [m]. NaN for the
        angle of a geodesic that has turned back.
        """
        wall, part = design["wall"], self.part
        inner = design["radius"] * shape(share, design.get("taper", 0.0), design.get("bulge", 0.0))
        near = design["radius"] if near is None else near
        first = near + part * wall
        if "wall" in self.rules:
            section = (near + wall) ** 2 - near**2
            wall = section / (np.sqrt(inner**2 + section) + inner)
        found = design | {"radius": inner, "wall": wall, "fiber_radius": inner + part * wall}
        with np.errstate(invalid="ignore"):
            for name in {"alpha", "beta"} & set(self.rules) & set(design):
                sine = np.sin(np.radians(design[name])) * first / found["fiber_radius"]
                found[name] = np.degrees(np.arcsin(sine))
        return found

    def rise(self, design, share):
        """Slope dR/dx of the fibers' surface there."""
        rise = design["radius"] * shape_slope(share, design["taper"], design["bulge"]) / design["length"]
        if "wall" in self.rules:
            own = self.at(design, share)
            rise = rise * (1.0 + self.part * (own["radius"] / (own["radius"] + own["wall"]) - 1.0))
        return rise

    def surface(self, design) -> tuple:
        """Of designs (name -> (n,)) the radius of the fibers at half length [m], and the volume between cavity and fibers
        [m3], (n,) each.
        """
        along = self.at(
            {name: np.asarray(design[name])[:, None] for name in ("radius", "wall", "taper", "bulge")}, SHARE
        )
        mean = (along["fiber_radius"] ** 2 - along["radius"] ** 2) @ WEIGHT
        return self.at(design, 0.5)["fiber_radius"], np.pi * design["length"] * mean

    def tube(self, numbers, profiles=()):
        """What :mod:`.revolution` takes for a tube, of ``numbers`` for COURSE; some are given along it by ``profiles``."""
        own = dict(zip(COURSE, numbers))
        own |= {name: written(name, own[name], UNITS[name]) for name in self.rules}
        own["radius"] = [(0.0, own["radius"]), (1.0, own["radius"])]  # of the straight ones, too
        own |= {name: None for name in FAMILIES if name not in self.families}
        own |= profiles
        own["fiber_surface"] = own.pop("fiber_radius")
        return SimpleNamespace(**own, fiber_share=self.part, is_thick=self.model.is_thick)


def rules_of(attributes) -> dict:
    """The rules that an atlas tells in its attributes."""
    return {name: word for name, word in RULES.items() if attributes.get(f"rule_{name}") == word}


def profile_of(attributes, name):
    """The profile of a parameter that an atlas tells in its attributes, None without."""
    if f"profile_{name}" not in attributes:
        return None
    pairs = np.reshape(attributes[f"profile_{name}"], (-1, 2)).tolist()
    return as_profile(Profile(pairs, smooth=bool(attributes.get(f"smooth_{name}", 0))))

"""What each part of a specification may say, but not all of them together: no design of the sweep could be that."""

import numpy as np

from ..atlas.schema import SHAPE
from ..description.families import FAMILIES
from ..description.impossible import APART, SMALLEST_DIFFERENCE
from ..description.profiles import as_profile, together
from ..description.tube_model import FIBER_PLACES
from . import along


def check_profiles(faults, profiles, fixed, given, families):
    """Refuses profiles, and families that are none, which some designs would not use, and families that meet somewhere along
    every tube.
    """
    for name in (*profiles, *(name for name in FAMILIES if name not in families)):
        if given[name] != f"actuator.{name}":
            what = "a profile" if name in profiles else "none"
            faults.add(given[name], f"actuator.{name} is {what} already; give one of the two")
    if "radius" in profiles or set(SHAPE) & set(given):
        if "fiber_radius" in given:
            faults.add(given["fiber_radius"], f"the radius varies; choose one of {', '.join(FIBER_PLACES)}")
    if "radius" in profiles:
        x, values = np.array(along.pairs_of(profiles["radius"])).T
        if np.any((np.diff(x) == 0.0) & (np.diff(values) != 0.0)):
            faults.add("actuator.radius", "it jumps; a body's radius may bend at a place, but not jump")
    angles = [profiles.get(name, fixed.get(name)) for name in ("alpha", "beta")]
    if None in angles or not any(name in profiles for name in ("alpha", "beta")):
        return
    alpha, beta = together(*map(as_profile, angles))
    if np.min(np.abs(alpha - beta)) < APART or len(set(np.sign(alpha - beta))) > 1:
        faults.add(
            "actuator.alpha, actuator.beta",
            f"the fiber families cross, or are less than {SMALLEST_DIFFERENCE:g} degree apart, somewhere along the tube: no"
            " finite locked shape there; keep alpha above beta all along, or below",
        )


def check_fibers(faults, values):
    """Refuses a sweep in which the fibers lie in the wall of no design at all."""
    if not all(name in values for name in ("fiber_radius", "radius", "wall")):
        return
    fibers, radius, wall = (np.asarray(values[name]) for name in ("fiber_radius", "radius", "wall"))
    if fibers.max() < radius.min() or fibers.min() > radius.max() + wall.max():
        found = f"{fibers.min():g} to {fibers.max():g} m"
        faults.add("fiber_radius", f"found {found}; must lie within the wall, from radius to radius + wall")

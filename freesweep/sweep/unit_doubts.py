"""What of a sweep looks like a slip of units: all its values as :mod:`freesweep.description.unit_warnings` takes them."""

import numpy as np

from ..description.families import FAMILIES
from ..description.unit_warnings import design_doubts, load_doubts
from .along import pairs_of

DESIGN = ("alpha", "beta", "length", "radius", "wall", "c10")
LOAD = ("pressure", "force", "torque")


def doubts_of(sweep) -> list:
    """Sentences about a sweep's tubes and loads; none for most."""
    design = {name: _values(sweep, name) for name in DESIGN}
    wall, radius = design["wall"], design["radius"]
    columns = (sweep.designs or {}).get("columns", {})  # each with its own; else each with each
    thickness = wall / radius if {"wall", "radius"} <= set(columns) else np.divide.outer(wall, radius)
    loads = {name: _values(sweep, name) for name in LOAD}
    thick = sweep.model.is_thick
    return design_doubts(design, thick, thickness) + load_doubts(design, loads, thickness)


def _values(sweep, name):
    """Every value of a parameter, shape (n,)."""
    if name in sweep.profiles:
        return np.array([value for _, value in pairs_of(sweep.profiles[name])])
    if name in FAMILIES and name not in sweep.families:
        return np.zeros(1)
    given = sweep.fixed | sweep.axes | (sweep.designs or {}).get("columns", {})
    return np.atleast_1d(given[name])

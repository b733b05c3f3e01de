"""Derivatives of many designs whose loads leave them the undeformed cylinder: in closed form."""

import numpy as np

from ..derivative.cylinder import at_cylinder
from ..derivative.physics import Physics
from ..derivative.request import SHAPE
from ..derivative.table import rows_of


class Designs(Physics):
    """Many designs like a ``tube``: name -> dual numbers (n,), with derivatives along some directions."""

    def __init__(self, tube, design, directions):
        self.tube, self.course, self.parameters, self.is_locked = tube, None, tuple(range(directions)), False
        self.design, self.length = design, design["length"] / design["fiber_radius"]


def straight(tube, design, directions, count):
    """Values and derivatives (SHAPE, 1 + directions, count) of membranes like a ``tube`` with two bonded families, and where
    (count,) they are such: tubes whose own length is held, or no rotation.
    """
    with np.errstate(all="ignore"):
        made, there = at_cylinder(Designs(tube, design, directions), count)
    return rows_of(made, SHAPE, directions), there

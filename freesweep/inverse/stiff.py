"""How stiff the free end of a tube is, along the axis and in torsion: the derivative of a load by what it moves."""

import numpy as np

from ..derivative.dual import Dual
from ..derivative.physics import OWN
from ..derivative.request import SHAPE
from .straight import straight
from .wishes import HELD, STIFF

ACCURACY = 1e-7
SAME = 1e-4  # of the length, or of a radian: a state of which what moves is further off is another one
ASIDE, CAUTION = 1e-4, 2.0  # states beside one, and times what it is not known by
FOLLOWED = 1e-6  # to which the middle of a state is known that was found beside another
ROUNDING = 1e-9  # of what closed forms tell
RADIAN = 57.3  # [degree]


def stiffness(names, kind, found, design, tube) -> dict:
    """Those of ``names`` that are stiffnesses, with their bounds, of states of tubes of two families, like the ``tube``,
    that were ``found``; NaN where vectors tell no derivative of that state.
    """
    made = {}
    for name in set(names) & set(STIFF):
        value, bound = np.full((2, len(found["status"])), np.nan)
        states = _States(STIFF[name], kind, found, design, tube)
        for way in states.ways:
            left = states.rows[np.isnan(value[states.rows])]
            value[left], bound[left] = states.tell(way, left)
        made |= {name: value, f"{name}_error": bound}
    return made


class _States:
    """States of a kind, the stiffness of which against a ``load`` is asked for: the derivative of what it moves, of the
    free state under that load. Of several states under one load that one counts in which what moves is where it is.
    """

    def __init__(self, load, kind, found, design, tube):
        self.load, self.moved, self.tube = load, HELD[load][0], tube
        self.design, self.errors = design, np.zeros(len(found["status"]))
        self.middles = found["mid_radius"]
        self.doubts = found.get("mid_radius_error", FOLLOWED * self.middles)
        closed = [] if tube.is_thick or tube.threads else [self.straight]
        self.ways = [self.by_loads, *closed, self.by_middles]
        if kind in HELD:
            self.design, self.errors = design | {kind: found[kind]}, found[f"{kind}_error"]
            self.target = design["held"] * (design["length"] if kind == "force" else 1.0)
        else:
            self.target = found[self.moved]
        self.rows = np.flatnonzero(np.isfinite(self.target) & np.isfinite(self.middles))
        self.unit = design["length"] if load == "force" else np.full(len(self.errors), RADIAN)
        self.size = np.pi * design["fiber_radius"] ** (2 if load == "force" else 3) * design["c10"]

    def tell(self, way, rows):
        """Stiffnesses and bounds of some rows, NaN where the ``way`` does not tell them."""
        none = np.zeros(len(rows))
        if len(rows) == 0:
            return none, none
        with np.errstate(invalid="ignore", divide="ignore"):
            moved, slope, doubt = way(rows, none, none)
            off = np.abs(moved - self.target[rows]) - CAUTION * np.abs(slope) * self.errors[rows]
            value = np.where(off <= SAME * self.unit[rows], 1.0 / slope, np.nan)
            bound = doubt / slope**2
            load = np.maximum(self.size[rows], np.abs(self.design[self.load][rows]))
            unsure = [(self.errors[rows], load, 0.0)]
            unsure += [(self.doubts[rows], 0.0, self.middles[rows])] if way == self.by_middles else []
            for error, step, wider in unsure:
                if np.any(error > 0.0):
                    _, beside, _ = way(rows, ASIDE * step, ASIDE * wider)
                    change = np.abs(1.0 / beside - value) / ASIDE
                    change = np.where(np.isfinite(change), change, np.abs(value))
                    bound = bound + CAUTION * error * change / (step + wider)
        return value, np.where(np.isnan(value), np.nan, bound)

    def by_loads(self, rows, step, _):
        """What is moved, its derivative by the load, and the bound of that, (n,): of the states that loads lead to."""
        return self._differentiated(rows, step, None)

    def by_middles(self, rows, step, wider):
        """The same, of states of which the middle's radius is known."""
        return self._differentiated(rows, step, (self.middles[rows] + wider, np.full(len(rows), self.tube.is_loose)))

    def straight(self, rows, step, _):
        """The same, of tubes that stay straight, in closed form."""
        made, there = straight(self.tube, self._dual(rows, step), 1, len(rows))
        moved, slope = np.where(there, made[SHAPE.index(self.moved)], np.nan)
        return moved, slope, ROUNDING * np.abs(slope)

    def _differentiated(self, rows, step, known):
        from ..derivative.vectors import differentiated

        sizes = self.size[None, rows]
        tube, design = self.tube, self._dual(rows, step)
        kind = tube.is_thick, tube.threads
        own, bounds = differentiated(design, tube.energy, sizes, SHAPE, ACCURACY, *kind, known)
        place = SHAPE.index(self.moved)
        return own[place, 0], own[place, 1], bounds[place, 1]

    def _dual(self, rows, step):
        """The designs and loads of some rows, the load, greater by a ``step``, with its derivative."""
        parts = np.zeros((OWN + 1, 1))
        parts[OWN] = 1.0
        numbers = {name: Dual(column[rows]) for name, column in self.design.items()}
        return numbers | {self.load: Dual(self.design[self.load][rows] + step, parts)}


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

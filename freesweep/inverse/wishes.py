"""What a tube shall do: goals to meet and limits to keep, as a person gives them.

A wish names an output and the state in which it counts: pressure, force and torque of a free tube, or what is held. What a
wish leaves out is free, if ``free`` names it, else 0; a held tube is held as it is undeformed.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..atlas import schema
from ..atlas.schema import PARAMETERS, SHAPE
from ..description.faults import ActuatorError
from ..description.given import described, numbers, read_number
from ..description.quantities import Quantities, Quantity
from .curve_file import curve_of, is_path

FREE = {name: each.units for name, each in schema.VARIABLES.items() if each.without == schema.HELD}  # of a free state
UNITS = FREE | {
    "force": "N", "torque": "N m", "stroke": "1", "length_change": "m", "limit_pressure": "Pa",
    "stiffness": "N/m", "torsional_stiffness": "N m/degree", "stable": "1",
}  # fmt: skip
CONDITIONS = {"pressure": "Pa", "force": "N", "torque": "N m", "deformed_length": "m", "rotation": "degree"}
HELD = {
    "force": ("deformed_length", "torque"),
    "torque": ("rotation", "force"),
}  # what is held, what may work on the rest
STIFF = {"stiffness": "force", "torsional_stiffness": "torque"}  # of a free tube, or of one held by that load
TUBE = ("alpha", "beta", "length", "radius", "wall", "fiber_radius", "fiber_extension", *SHAPE)
DESIGN = (*TUBE, "c10", "c01", "c20", "c30")
RELATIVE = 1e-4  # of a goal's value, or of its natural size: what counts as met where no tolerance is given


class Wish(NamedTuple):
    """One number wished for: an output in one state, and the range it shall lie in, in SI units and degrees."""

    output: str
    conditions: tuple  # (name, value) of the state, what is free left out
    low: float
    high: float
    tolerance: float  # nan: RELATIVE
    title: str

    @property
    def kind(self) -> str:
        """One of "free", "locked", "force" or "torque" (held), "limit", "design" or "every" (of the states of others)."""
        if self.output == "stable":
            return "every"
        if self.output in DESIGN or self.output == "pressure":
            return "design"
        if self.output in HELD:
            return self.output
        if self.output in STIFF and HELD[STIFF[self.output]][0] in dict(self.conditions):
            return STIFF[self.output]
        if self.output == "limit_pressure":
            return "limit"
        return "locked" if math.isinf(dict(self.conditions).get("pressure", 0.0)) else "free"


@dataclass(frozen=True)
class _Asked:
    """What goals and limits share.

    Parameters
    ----------
    output : any scalar of :func:`freesweep.inflate` (``deformed_length`` [m], ``rotation`` [degree], ``volume`` [m3],
        ``mid_radius`` [m], ``strain_energy`` [J], ...), what holds a tube (``force`` [N] at a held deformed length,
        ``torque`` [N m] at a held rotation), or what follows from them: ``stroke`` (1 - deformed_length/length),
        ``length_change`` [m], ``outer_radius`` [m] (the largest of the deformed tube), ``limit_pressure`` [Pa],
        ``stiffness`` [N/m] and ``torsional_stiffness`` [N m/degree] of a free tube's end, or of one held at a
        ``deformed_length`` or ``rotation`` that is given; ``stable``, 1 where every state that is wished for is, else 0; or
        a parameter of the design
    value : the number wished for, or an array: a curve over arrays of the same length among the conditions; or the path of a
        CSV file (``pressure [kPa],deformed_length [mm],force [N]``): its columns are the output and conditions
    at_least, at_most, between : a range instead
    tolerance : by how much a goal may be missed; default 1e-4 of it, or what a column ``<output>_sigma`` of the file says
    pressure, force, torque : the loads [Pa, N, N m]; a pressure of infinity is the locked shape
    deformed_length, rotation : what is held, for the outputs ``force`` and ``torque`` [m, degree]
    """

    output: str
    value: Quantities | os.PathLike[str] | None = None
    at_least: Quantities | None = None
    at_most: Quantities | None = None
    between: tuple[Quantities, Quantities] | None = None
    tolerance: Quantity | None = None
    pressure: Quantities | None = None
    force: Quantities | None = None
    torque: Quantities | None = None
    deformed_length: Quantities | None = None
    rotation: Quantities | None = None

    def __post_init__(self):
        faults = []
        self.wishes(faults, type(self).__name__)
        if faults:
            raise ActuatorError(faults)

    def __repr__(self):
        """What was given."""
        given = ", ".join(f"{name}={value!r}" for name, value in vars(self).items() if value is not None)
        return f"{type(self).__name__}({given})"

    def wishes(self, faults, where="") -> list:
        """The single wishes; faults are noted."""
        units = UNITS | {name: PARAMETERS[name].units for name in (*DESIGN, "pressure")}
        if not isinstance(self.output, str) or self.output not in units:
            faults.append(f"{where}: output: found {described(self.output)}; choose one of {', '.join(units)}")
            return []
        before = len(faults)
        unit = units[self.output]
        value, given, tolerance = self.value, {}, np.full(1, math.nan)
        if is_path(value):
            curve = curve_of(value, self.output, self._conditions(), faults, where)
            if curve is None:
                return []
            value, given = curve.values, curve.conditions
            tolerance = tolerance if curve.sigma is None else curve.sigma
        low, high = self._range(value, unit, faults, where)
        if self.output.endswith("pressure") and (np.any((low < 0.0) & np.isfinite(low)) or np.any(high < 0.0)):
            faults.append(f"{where}: {self.output}: pressures are 0 or more")
        for name in CONDITIONS:
            if getattr(self, name) is not None:
                if name in given:
                    faults.append(f"{where}: {name}: a column of the file, and given beside it; keep one")
                else:
                    label, can = f"{where}: {name}", name == "pressure"  # at an infinite one a tube is locked
                    found = _column(label, getattr(self, name), CONDITIONS[name], faults, infinite=can)
                    given |= {} if found is None else {name: found}
        self._check(given, faults, where)
        if self.tolerance is not None:
            tolerance = np.full(1, read_number(f"{where}: tolerance", self.tolerance, unit, faults, positive=True))
        columns = [low, high, tolerance, *given.values()]
        sizes = {len(column) for column in columns if len(column) > 1}
        if len(sizes) > 1:
            faults.append(
                f"{where}: curves of {' and '.join(map(str, sorted(sizes)))} points; give arrays of one length"
            )
        if len(faults) > before:
            return []
        count = max(len(column) for column in columns)
        columns = [np.broadcast_to(column, count).tolist() for column in columns]
        return [
            Wish(self.output, tuple(zip(given, conditions)), a, b, allowed, _title(self.output, given, conditions))
            for a, b, allowed, *conditions in zip(*columns)
        ]

    def notes(self) -> tuple:
        """What of a file was passed over, in words."""
        if not is_path(self.value):
            return ()
        curve = curve_of(self.value, self.output, self._conditions(), [], "")
        return () if curve is None else curve.notes

    def _range(self, value, unit, faults, where):
        ways = [name for name in ("value", "at_least", "at_most", "between") if getattr(self, name) is not None]
        if len(ways) != 1 and ways != ["at_least", "at_most"]:
            found = ", ".join(ways) or "none"
            faults.append(f"{where}: found {found}; give one of value, at_least, at_most, between=(low, high)")
            return np.zeros(1), np.zeros(1)
        if ways == ["between"]:
            pair = self.between
            if not isinstance(pair, (tuple, list)) or len(pair) != 2:
                faults.append(f"{where}: between: give two numbers, the lower one first")
                return np.zeros(1), np.zeros(1)
            ends = pair
        elif ways == ["value"]:
            column = _column(f"{where}: {self.output}", value, unit, faults)
            return (np.zeros(1),) * 2 if column is None else (column, column)
        else:
            ends = self.at_least, self.at_most
        none = (np.full(1, -np.inf), np.full(1, np.inf))
        low, high = (
            none[k] if end is None else _column(f"{where}: {self.output}", end, unit, faults)
            for k, end in enumerate(ends)
        )
        low, high = (none[k] if column is None else column for k, column in enumerate((low, high)))
        fits = len(low) == len(high) or 1 in (len(low), len(high))  # else it is told as curves of two lengths
        if fits and np.any(low > high):
            first, last = next((a, b) for a, b in np.broadcast(low, high) if a > b)
            faults.append(f"{where}: {', '.join(ways)}: found {first:g}, then {last:g}; give the lower number first")
        return low, high

    def _conditions(self) -> tuple:
        """What may be said of a state with this output."""
        if self.output in (*DESIGN, "pressure", "stable"):
            return ()
        if self.output == "limit_pressure":
            return ("force", "torque")
        if self.output in HELD:
            return ("pressure", *HELD[self.output])
        held = HELD[STIFF[self.output]][:1] if self.output in STIFF else ()
        return ("pressure", "force", "torque", *held)

    def _check(self, given, faults, where):
        """Conditions that belong to no state with this output."""
        allowed = self._conditions()
        if self.output in STIFF and HELD[STIFF[self.output]][0] in given:
            allowed = ("pressure", *HELD[STIFF[self.output]])
        if np.any(given.get("pressure", np.zeros(1)) < 0.0):
            faults.append(f"{where}: pressure: found {_least(given, 'pressure')} Pa; pressures are 0 or more")
        held = self.output in (*HELD, *STIFF)
        if np.any(given.get("deformed_length", np.ones(1)) <= 0.0):
            faults.append(f"{where}: deformed_length: found {_least(given, 'deformed_length')} m; lengths are above 0")
        for name in given:
            if name not in allowed:
                can = f"give {', '.join(allowed)}" if allowed else "it is no matter of a state"
                faults.append(f"{where}: {self.output} under a given {name} is not among what is solved; {can}")
        if held and np.any(np.isinf(given.get("pressure", 0.0))):
            faults.append(f"{where}: pressure: a locked shape has no {self.output}; give a finite pressure")


class Goal(_Asked):
    """What a design shall do: see the parameters of :class:`Limit`, which are the same. Goals may be missed, by as much as
    ``misfit`` says; where all are met within their tolerance, a candidate is ``met``.

    Raises :class:`ActuatorError`.
    """

    __doc__ += _Asked.__doc__.partition("\n")[2]


class Limit(_Asked):
    """What all candidates have to keep: at_least, at_most or between.

    Raises :class:`ActuatorError`.
    """

    __doc__ += _Asked.__doc__.partition("\n")[2]

    def __post_init__(self):
        if self.value is not None:
            raise ActuatorError(["Limit: a limit is a range; give at_least, at_most or between, or make it a Goal"])
        super().__post_init__()


def read(name, given, kind, faults) -> list:
    """The single wishes of a list of goals or limits."""
    given = [given] if isinstance(given, _Asked) else given
    if not isinstance(given, (list, tuple)) or not all(isinstance(one, kind) for one in given):
        faults.append(f"{name}: found {described(given)}; give a list of freesweep.{kind.__name__}")
        return []
    return [wish for k, one in enumerate(given) for wish in one.wishes(faults, f"{name}[{k}]")]


def _least(given, name):
    return f"{np.min(given[name]):g}"


def _column(name, value, unit, faults, infinite=False):
    try:
        found = np.atleast_1d(numbers(value, unit))
    except ValueError as error:
        faults.append(f"{name}: {error}")
        return None
    if found.ndim != 1 or found.size == 0 or np.any(np.isnan(found)) or not (infinite or np.all(np.isfinite(found))):
        faults.append(f"{name}: found {described(value)}; give finite numbers, one or a column of them, in [{unit}]")
        return None
    return found


def _title(output, names, values):
    state = ", ".join(f"{name} {value:.9g} {CONDITIONS[name]}" for name, value in zip(names, values))
    return f"{output} at {state}" if state else output

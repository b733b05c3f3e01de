"""Reads a sweep from TOML: what is fixed, what varies, and every fault of the text in one error.

    title = "What this sweep is for"
    [actuator]                  # fixed values of the design, with units; plain numbers are SI and degrees
    wall = "1.59 mm"
    c10 = "0.17 MPa"
    energy = "full"             # or "principal"
    [load]                      # fixed force, torque, pressure
    [axes]                      # what varies: all combinations are solved
    alpha = {start = "0 deg", stop = "85 deg", step = "2.5 deg"}
    length = ["100 mm", "200 mm"]
    pressure = {start = "0 kPa", stop = "300 kPa", num = 41, spacing = "sqrt"}     # or "linear", "log"
    [[designs]]                 # or named designs, each combined with all axes
    name = "A"
    beta = 50
    [solver]
    accuracy = 1e-6
    blocked = true              # blocked force and torque too, with fiber extension and loads

A design takes what it leaves out from [actuator] and [load].
"""

import hashlib
import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..atlas.schema import PARAMETERS
from ..scaling import ACCURACIES
from ..units import quantity, shown
from . import axis, toml_guard
from .designs import DEFAULTS, HOME, OWN, read_designs
from .faults import Faults, SpecificationError

__all__ = ["MAX_POINTS", "SpecificationError", "Sweep", "parse", "read_file"]

MAX_POINTS = 2_000_000_000  # 16 GB for each variable of the atlas
ENERGIES = ("full", "principal")
REQUIRED = ("alpha", "beta", "length", "radius", "wall", "c10", "pressure")


@dataclass(frozen=True, eq=False)
class Sweep:
    """A checked sweep. Values are in the units of schema.PARAMETERS, arrays are read-only.

    ``fixed`` holds single values; ``axes`` strictly increasing arrays, shape (n,), in the order of schema.PARAMETERS.
    ``designs`` is None, or {"names": tuple of texts, "columns": {parameter: array, shape (designs,)}}. Every parameter
    stands in one of the three; only ``fiber_radius`` may be in none: then the fibers lie at the inner radius.
    """

    title: str
    energy: str
    fixed: dict[str, float]
    axes: dict[str, np.ndarray]
    designs: dict | None
    accuracy: float
    text: str = field(repr=False)
    blocked: bool = False

    @property
    def sha256(self) -> str:
        """Hash of the text, hexadecimal."""
        return hashlib.sha256(self.text.encode("utf-8")).hexdigest()

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions: ``design`` first if there are designs, then the axes."""
        return (("design",) if self.designs else ()) + tuple(self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the dimensions."""
        return _shape(self.axes, self.designs)

    @property
    def points(self) -> int:
        """Number of equilibria asked for."""
        return math.prod(self.shape)


def read_file(path: str | Path) -> Sweep:
    """The sweep that a TOML file describes; raises FileNotFoundError or, with every fault, SpecificationError."""
    return parse(toml_guard.read_text(path), str(path))


def parse(text: str, name: str = "specification") -> Sweep:
    """The sweep that a TOML text describes; raises SpecificationError, under ``name``, with every fault."""
    document = toml_guard.load(text, name)
    faults = Faults(name)
    elsewhere = {key: f"it belongs in [{home}] or [axes]" for key, home in HOME.items()}
    sections = ("title", "actuator", "load", "axes", "designs", "solver")
    faults.unknown_keys(document, sections, elsewhere=elsewhere | {"design": "designs are written [[designs]]"})
    tables = {key: _table(faults, document, key) for key in ("actuator", "load", "axes", "solver")}
    title = faults.line("title", document.get("title", ""))
    energy = _energy(faults, tables["actuator"])
    accuracy = _accuracy(faults, tables["solver"])
    blocked = _blocked(faults, tables["solver"])
    given = {}  # parameter: where it is given, faulty or not
    fixed = _fixed(faults, tables, given)
    axes = _axes(faults, tables["axes"], given)
    designs = read_designs(faults, document["designs"], given, fixed) if "designs" in document else None
    for parameter in REQUIRED:
        if parameter not in given:
            homes = f"[{HOME[parameter]}] or [axes]"
            faults.add(
                parameter,
                f"is missing; give it in {homes}" + (", or in every design" if designs and parameter in OWN else ""),
            )
    fixed = {key: DEFAULTS.get(key) if key not in given else fixed.get(key) for key in PARAMETERS}
    fixed = {key: number for key, number in fixed.items() if number is not None}
    _check_fibers(faults, fixed | axes | (designs or {}).get("columns", {}))
    points = math.prod(_shape(axes, designs))
    if points > MAX_POINTS:
        faults.add(
            "axes",
            f"{points:,} points ({8 * points:,} bytes a variable), at most {MAX_POINTS:,} are allowed; "
            "use coarser axes or several sweeps",
        )
    faults.check()
    return Sweep(title, energy, fixed, axes, designs, accuracy, text, blocked)


def _shape(axes, designs):
    return ((len(designs["names"]),) if designs else ()) + tuple(len(array) for array in axes.values())


def _table(faults, document, key):
    table = document.get(key, {})
    if not isinstance(table, dict):
        faults.add(key, f"found {shown(table)}, must be a table: write [{key}] on a line of its own")
        return {}
    return table


def _energy(faults, actuator):
    energy = actuator.get("energy", "full")
    if energy not in ENERGIES:
        faults.add("actuator.energy", f"found {shown(energy)}, allowed: {', '.join(ENERGIES)}")
    return energy


def _blocked(faults, solver):
    blocked = solver.get("blocked", False)
    if not isinstance(blocked, bool):
        faults.add("solver.blocked", f"found {shown(blocked)}; write true or false")
    return blocked


def _accuracy(faults, solver):
    faults.unknown_keys(solver, ("accuracy", "blocked"), "solver")
    low, high = ACCURACIES
    try:
        accuracy = quantity(solver.get("accuracy", 1e-6), "1")
    except ValueError as error:
        faults.add("solver.accuracy", str(error))
        return None
    if not low <= accuracy <= high:
        faults.add("solver.accuracy", f"found {accuracy:g}, allowed is {low:g} to {high:g}; 1e-6 suits most sweeps")
    return accuracy


def _fixed(faults, tables, given):
    fixed = {}
    for section in ("actuator", "load"):
        table = tables[section]
        own = [name for name in PARAMETERS if HOME[name] == section]
        elsewhere = {name: f"it belongs in [{HOME[name]}]" for name in PARAMETERS}
        faults.unknown_keys(table, [*own, "energy"] if section == "actuator" else own, section, elsewhere)
        for name in own:
            if name in table:
                given[name] = f"{section}.{name}"
                fixed[name] = axis.value(faults, given[name], name, table[name])
    return fixed


def _axes(faults, table, given):
    faults.unknown_keys(table, tuple(PARAMETERS), "axes", {"energy": "it belongs in [actuator] and cannot vary"})
    axes = {}
    for name in PARAMETERS:
        if name in table:
            if name in given:
                faults.add(f"axes.{name}", f"given twice, also as {given[name]}; remove one")
            given[name] = f"axes.{name}"
            array = axis.values(faults, f"axes.{name}", name, table[name])
            if array is not None:
                axes[name] = array
    return axes


def _check_fibers(faults, values):
    """Refuses a sweep in which the fibers lie in the wall of no design at all."""
    if not all(name in values for name in ("fiber_radius", "radius", "wall")):
        return
    fibers, radius, wall = (np.asarray(values[name]) for name in ("fiber_radius", "radius", "wall"))
    if fibers.max() < radius.min() or fibers.min() > radius.max() + wall.max():
        found = f"{fibers.min():g} to {fibers.max():g} m"
        faults.add("fiber_radius", f"found {found}; must lie within the wall, from radius to radius + wall")

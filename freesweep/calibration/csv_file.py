"""CSV files of measured curves: the first line names each column and its unit, such as ``pressure [psi],force [N]``."""

import csv
import difflib
import re

import numpy as np

from ..actuator import Actuator, ActuatorError, MooneyRivlin
from ..atlas.schema import PARAMETERS
from ..options import read_path
from ..units import NEAR, quantity, shown
from .measured import COLUMNS, Measurement, default_measured, measured_faults, read_names

TUBE = (
    "alpha",
    "beta",
    "length",
    "radius",
    "wall",
    "fiber_radius",
    "fiber_extension",
)  # columns, or given beside the file
SIGMA = "_sigma"  # ends the name of a column of standard uncertainties
FIRST_GUESS = MooneyRivlin(0.15e6, 0.08e6)  # a rubber between those of the source's Table 1
LARGEST_FILE = 16_000_000  # bytes
MOST_FAULTS = 30
_HEAD = re.compile(r"\s*([^\[\]()]*?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))?\s*")


def read_measurements(paths, *, measured=(), material=FIRST_GUESS, energy="full", **tube) -> list:
    """The :class:`Measurement` objects of one or several CSV files, one for each actuator in each file.

    Columns: ``pressure``, those of :class:`Measurement`, their standard uncertainties as ``force_sigma``, and whatever
    describes the actuator (alpha, beta, length, radius, wall, fiber_radius, fiber_extension), unless that is given as an
    argument [degree, m]: rows that agree in it make one measurement. Columns are parted by commas, semicolons or tabs; empty
    lines and lines that begin with # are left out. ``measured`` holds in files with such columns. ``material`` is the first
    guess of what is fitted.

    Raises FileNotFoundError, or :class:`ActuatorError` with every fault.
    """
    faults = []
    paths = list(paths) if isinstance(paths, (list, tuple)) else [paths]
    measured = read_names("measured", measured, faults)
    paths = [read_path("paths", path, "a CSV file", faults) for path in paths]
    unknown = sorted(set(tube) - set(TUBE))
    faults += [f"{name}: no such part of an actuator; known: {', '.join(TUBE)}" for name in unknown]
    made, seen = [], set()
    for path in [] if faults else paths:
        try:
            columns = _read(path)
            seen |= set(columns)
            made += _measurements(columns, measured, tube, {"material": material, "energy": energy})
        except ActuatorError as error:
            faults += [f"{path.name or path}: {fault}" for fault in error.faults]
    if not faults:
        faults = [f"measured: no file has a column {name!r:.40}" for name in measured if name not in seen]
    if faults:
        raise ActuatorError(faults)
    return made


def _read(path):
    """Columns of a file: name -> array (rows,) in SI units and degrees."""
    faults = []
    heads, rows = _table(path, faults)
    columns = _columns(heads, rows, faults)
    if faults:
        raise ActuatorError(faults)
    return columns


def _measurements(columns, measured, tube, others):
    """One measurement for each actuator: rows that agree in it."""
    faults = [f"{name}: a column, and given beside it; keep one" for name in sorted(set(columns) & set(tube))]
    for name in ("pressure", "alpha", "beta", "length", "radius", "wall"):
        if name not in columns and name not in tube:
            beside = "" if name == "pressure" else ", or beside the file"
            faults.append(f"{name}: is missing; give it as a column{beside}")
    measured = tuple(name for name in measured if name in columns) or default_measured(columns)
    faults += measured_faults(measured, columns)
    own = [name for name in TUBE if name in columns]
    if faults:
        raise ActuatorError(faults)
    keys = np.column_stack([np.zeros(len(columns["pressure"])), *(columns[name] for name in own)])
    designs, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    made = []
    for k in np.argsort(first):  # in the file's order
        here = which.ravel() == k
        try:
            made.append(
                Measurement(
                    Actuator(**tube, **others, **dict(zip(own, designs[k, 1:].tolist()))),
                    columns["pressure"][here],
                    **{name: columns[name][here] for name in COLUMNS if name in columns},
                    measured=measured,
                    sigma={name: columns[name + SIGMA][here] for name in COLUMNS if name + SIGMA in columns},
                )
            )
        except ActuatorError as error:
            faults += [fault for fault in error.faults if fault not in faults]
    if faults:
        raise ActuatorError(faults)
    return made


def _table(path, faults):
    """Heads and rows of a file, as texts; rows come with their line numbers."""
    if path.is_dir():
        raise ActuatorError(["is a folder; give the paths of CSV files"])
    size = path.stat().st_size
    if size > LARGEST_FILE:
        raise ActuatorError([f"{size:,} bytes; at most {LARGEST_FILE:,} are read"])
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ActuatorError(["not a text in UTF-8; save it as CSV (UTF-8)"]) from None
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if len(lines) < 2:
        raise ActuatorError([f"found {len(lines)} lines; give a line of names and units, then the states"])
    parting = max(",;\t", key=lines[0][1].count)
    cells = csv.reader((line for _, line in lines), delimiter=parting)
    heads, *rows = [[cell.strip() for cell in row] for row in cells]
    for (number, _), row in zip(lines[1:], rows):
        if len(row) != len(heads) and len(faults) < MOST_FAULTS:
            faults.append(f"line {number}: {len(row)} cells under {len(heads)} names; {_uneven(row, len(heads))}")
    return heads, [(number, row) for (number, _), row in zip(lines[1:], rows)]


def _uneven(row, count):
    """What may have made a row longer or shorter than the ``count`` of names."""
    if len(row) < count:
        return "cells are missing at its end"
    if not any(row[count:]):
        return "it ends with a separator too many; remove that"
    return "a separator too many, or a decimal comma where a point belongs"


def _columns(heads, rows, faults):
    """Name -> array (rows,) in SI units and degrees."""
    columns = {}
    for k, head in enumerate(heads):
        match = _HEAD.fullmatch(head)
        name = re.sub(r"\W+", "_", match.group(1).lower()) if match else head
        unit = (match.group(2) or match.group(3) or "").strip() if match else ""
        kept = _units(name)
        if not head:
            faults.append(f"column {k + 1}: has no name; name it or remove it")
        elif kept is None:
            known = ["pressure", *COLUMNS, *(f"{name}{SIGMA}" for name in COLUMNS), *TUBE]
            near = difflib.get_close_matches(name[:40], known, n=1, cutoff=NEAR)
            hint = f"did you mean {near[0]}?" if near else f"remove it, as all but {', '.join(known)}"
            faults.append(f"column {shown(head)}: unknown; {hint}")
        elif name in columns:
            faults.append(f"column {shown(head)}: given twice")
        elif not unit and kept != "1":
            faults.append(f"column {shown(head)}: names no unit; write '{name} [{_EXAMPLES[kept]}]'")
        else:
            columns[name] = _numbers(
                name, [(number, row[k]) for number, row in rows if k < len(row)], unit, kept, faults
            )
    return columns


_EXAMPLES = {"m": "mm", "Pa": "kPa", "degree": "deg", "N": "N", "N m": "N m"}


def _units(name):
    """The unit a column is kept in; None if no column is called so."""
    name = name.removesuffix(SIGMA) if name.removesuffix(SIGMA) in COLUMNS else name
    if name in COLUMNS:
        return COLUMNS[name]
    return PARAMETERS[name].units if name in (*TUBE, "pressure") else None


def _numbers(name, cells, unit, kept, faults):
    try:
        quantity(f"1 {unit}", kept)
    except ValueError as error:
        faults.append(f"column {name}: {error}")
        return np.array([])
    numbers = []
    for line, cell in cells:
        try:
            numbers.append(quantity(f"{cell} {unit}", kept))
        except ValueError as error:
            if len(faults) < MOST_FAULTS:
                faults.append(f"line {line}, {name}: {error if cell else 'the cell is empty; leave such states out'}")
    return np.array(numbers)

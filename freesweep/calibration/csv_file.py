"""CSV files of measured curves: a line names each column and its unit, such as ``pressure [psi],force [N]``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..atlas.schema import PARAMETERS
from ..description.actuator import Actuator, ActuatorError, MooneyRivlin
from ..description.elastomer import Yeoh
from ..description.options import read_path
from ..description.quantities import Path
from ..description.units import shown
from ..report import SHOWN
from ..table_file import read_columns
from ..table_heads import RATIO, TEXT, Known
from .branches import BRANCHES, branch_faults
from .measured import COLUMNS, SHORTENINGS, Measurement, as_length, default_measured, measured_faults, read_names

TUBE = (
    "alpha",
    "beta",
    "length",
    "radius",
    "wall",
    "fiber_radius",
    "fiber_extension",
)  # columns, or given beside the file
WORDS = ("model", "wall_model", "fibers")  # given beside the file only
SIGMA = "_sigma"  # ends the name of a column of standard uncertainties
FIRST_GUESS = MooneyRivlin(0.15e6, 0.08e6)  # a rubber between those of the source's Table 1
KNOWN = Known(
    {"pressure": "Pa", **COLUMNS, "contraction": RATIO, "stroke": "m", "branch": TEXT}
    | {name + SIGMA: unit for name, unit in COLUMNS.items()}
    | {name: PARAMETERS[name].units for name in TUBE},
    {"p": "pressure", "gauge_pressure": "pressure", "pressure_gauge": "pressure", "f": "force", "moment": "torque"}
    | {"shortening": "stroke", "contraction_ratio": "contraction", "direction": "branch"},
)


def read_measurements(
    paths: Path | Sequence[Path],
    *,
    measured: str | Sequence[str] = (),
    material: MooneyRivlin | Yeoh | str = FIRST_GUESS,
    energy: str = "full",
    **tube: Any,
) -> list[Measurement]:
    """The :class:`Measurement` objects of one or several CSV files, one for each actuator in each file.

    Columns: ``pressure``, those of :class:`Measurement`, ``contraction [%]`` or ``stroke [mm]`` in place of a deformed
    length, standard uncertainties as ``force_sigma``, ``branch`` (loading or unloading), and whatever describes the actuator
    (alpha, beta, length, radius, wall, fiber_radius, fiber_extension), unless that is given as an argument [degree, m]: rows
    that agree in it make one measurement. ``model``, ``wall_model`` and ``fibers`` are as of :class:`Actuator`. Columns are
    parted by commas, semicolons or tabs; decimal points or commas; lines that begin with #, rows that lack a number and
    columns that nobody asked for are passed over, and counted in the ``notes`` of the measurements. ``measured`` holds in
    files with such columns. ``material`` is the first guess of what is fitted.

    Raises FileNotFoundError, or :class:`ActuatorError` with every fault.
    """
    faults = []
    paths = list(paths) if isinstance(paths, (list, tuple)) else [paths]
    measured = read_names("measured", measured, faults)
    paths = [read_path("paths", path, "a CSV file", faults) for path in paths]
    unknown = sorted(set(tube) - {*TUBE, *WORDS})
    faults += [f"{name}: no such part of an actuator; known: {', '.join((*TUBE, *WORDS))}" for name in unknown]
    made, seen = [], set()
    for path in [] if faults else paths:
        try:
            found = read_columns(path, KNOWN)
            seen |= set(found.values)
            others = {"material": material, "energy": energy}
            made += _measurements(found, measured, tube, others, path.name)
        except ActuatorError as error:
            faults += [f"{path.name or path}: {fault}" for fault in error.faults]
    if not faults:
        faults = [f"measured: no file has a column {name!r:.40}" for name in measured if name not in seen]
    if faults:
        raise ActuatorError(faults)
    return made


def units_of_files(paths) -> list:
    """Pairs of a text and the unit in which its kind is kept, of the columns of CSV files that can be read."""
    found = {}
    for path in paths:
        found = read_columns(path, KNOWN).units | found  # the first counts
    return [(f"1 {unit}", KNOWN.units[name]) for name, unit in found.items() if unit and KNOWN.units[name] in SHOWN]


def _measurements(found, measured, tube, others, name):
    """One measurement for each actuator: rows that agree in it."""
    columns = found.values
    faults = [f"{name}: a column, and given beside it; keep one" for name in sorted(set(columns) & set(tube))]
    for part in ("pressure", "alpha", "beta", "length", "radius", "wall"):
        if part not in columns and part not in tube:
            beside = "" if part == "pressure" else ", or beside the file"
            others = f" (passed over: {', '.join(map(shown, found.others))})" if found.others else ""
            faults.append(f"{part}: is missing; give it as a column{beside}{others}")
    given = set(map(as_length, columns))
    measured = tuple(as_length(part) for part in measured if part in columns) or default_measured(given)
    faults += measured_faults(measured, given)
    faults += outside(found)
    if "branch" in columns:
        faults += branch_faults(found)
    own = [part for part in TUBE if part in columns]
    if faults:
        raise ActuatorError(faults)
    keys = np.column_stack([np.zeros(len(columns["pressure"])), *(columns[part] for part in own)])
    designs, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    notes = tuple(f"{name}: {note}" for note in found.notes)
    made = []
    for k in np.argsort(first):  # in the file's order
        here = which.ravel() == k
        branch = [BRANCHES[word.lower()] for word in columns.get("branch", ())]
        try:
            made.append(
                Measurement(
                    Actuator(**tube, **others, **dict(zip(own, designs[k, 1:].tolist()))),
                    columns["pressure"][here],
                    **{part: columns[part][here] for part in (*COLUMNS, *SHORTENINGS) if part in columns},
                    measured=measured,
                    sigma={part: columns[part + SIGMA][here] for part in COLUMNS if part + SIGMA in columns},
                    branch=np.array(branch)[here] if branch else None,
                    notes=notes if not made else (),
                )
            )
        except ActuatorError as error:
            row = int(np.flatnonzero(here)[0])
            for fault in error.faults:
                named = [part for part in own if fault.startswith(part)]
                faults.append(f"{fault} {found.where(named[0], row)}" if named else fault)
            faults = list(dict.fromkeys(faults))
    if faults:
        raise ActuatorError(faults)
    return made


def outside(found) -> list:
    """Faults of numbers that no bench measures, with their places in a file of which that was ``found``."""
    faults = []
    for name, array in found.values.items():
        if name == "pressure":
            wrong, words = array < 0.0, "0 or more"
        elif name == "contraction":
            wrong, words = array >= 1.0, "below 1, which is nothing left of the length"
        elif name in ("deformed_length", "mid_radius") or name.endswith(SIGMA):
            wrong, words = array <= 0.0, "above 0"
        else:
            continue
        unit = {RATIO: ""}.get(KNOWN.units[name], f" {KNOWN.units[name]}")
        for row in np.flatnonzero(wrong)[:3]:
            faults.append(f"{name}: found {array[row]:g}{unit}; it has to be {words} {found.where(name, row)}")
    return faults

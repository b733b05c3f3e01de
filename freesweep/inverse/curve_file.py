"""Curves that are wished for, from CSV files: columns and units as :func:`freesweep.read_measurements` reads them."""

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..calibration.csv_file import KNOWN, SIGMA, outside
from ..description.faults import ActuatorError
from ..table_file import read_columns
from ..table_heads import TEXT


def is_path(value) -> bool:
    """Whether a wished-for value is the path of a CSV file."""
    return isinstance(value, Path) or (isinstance(value, str) and value.lower().endswith(".csv"))


class Curve(NamedTuple):
    """Values (points,), name -> condition (points,), standard uncertainties (points,) or None, and what was passed over."""

    values: np.ndarray
    conditions: dict
    sigma: np.ndarray | None
    notes: tuple


def curve_of(path, output, conditions, faults, where) -> Curve | None:
    """The curve in a file; None after noting faults."""
    own = Path(path).name
    try:
        found = read_columns(Path(os.fspath(path)), KNOWN)
    except (OSError, ActuatorError) as error:
        words = getattr(error, "faults", None) or [f"{path}: {getattr(error, 'strerror', error)}"]
        faults += [f"{where}: {word if str(path) in word else f'{own}: {word}'}" for word in words]
        return None
    columns = {name: values for name, values in found.values.items() if KNOWN.units[name] != TEXT}
    words = [f"column {name!r} passed over" for name in found.values if name not in columns]
    wrong = outside(found)
    if output not in columns:
        wrong.append(f"no column {output!r}; found {', '.join(columns)}")
    sigma, values = columns.pop(f"{output}{SIGMA}", None), columns.pop(output, None)
    allowed = ", ".join(conditions)
    wrong += [
        f"column {name!r} is no state of {output}; those are {allowed}" for name in columns if name not in conditions
    ]
    faults += [f"{where}: {own}: {word}" for word in wrong]
    return None if wrong else Curve(values, columns, sigma, tuple(f"{own}: {note}" for note in (*found.notes, *words)))

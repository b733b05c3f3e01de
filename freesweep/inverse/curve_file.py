"""Curves that are wished for, from CSV files: columns and units as :func:`freesweep.read_measurements` reads them."""

import os
from pathlib import Path

from ..calibration.csv_file import KNOWN, SIGMA
from ..description.faults import ActuatorError
from ..table_file import read_columns
from ..table_heads import TEXT


def is_path(value) -> bool:
    """Whether a wished-for value is the path of a CSV file."""
    return isinstance(value, Path) or (isinstance(value, str) and value.lower().endswith(".csv"))


def columns_of(path, output, conditions, faults, where):
    """``(values, name -> condition, sigma)`` of a curve, arrays (points,); sigma None where the file has none."""
    try:
        found = read_columns(Path(os.fspath(path)), KNOWN)
        columns = {name: values for name, values in found.values.items() if KNOWN.units[name] != TEXT}
    except (OSError, ActuatorError) as error:
        words = getattr(error, "faults", None) or [f"{path}: {getattr(error, 'strerror', error)}"]
        faults += [f"{where}: {word if str(path) in word else f'{Path(path).name}: {word}'}" for word in words]
        return None
    if output not in columns:
        faults.append(f"{where}: {Path(path).name}: no column {output!r}; found {', '.join(columns)}")
        return None
    sigma = columns.pop(f"{output}{SIGMA}", None)
    values = columns.pop(output)
    unknown = [name for name in columns if name not in conditions]
    if unknown:
        faults.append(
            f"{where}: {Path(path).name}: column {unknown[0]!r} is no state of {output}; those are {', '.join(conditions)}"
        )
        return None
    return values, columns, sigma

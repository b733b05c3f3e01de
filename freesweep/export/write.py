"""Writes a slice of an atlas in one of the formats, whole or not at all."""

import re
import warnings
from pathlib import Path

import numpy as np

from ..atlas.files import write_whole
from ..description.options import read_choice, read_path
from ..status import NOT_INTERPOLABLE, OUTSIDE, STATUSES
from .arrays import as_mat, as_npz
from .c_header import as_c
from .chosen import chosen
from .mujoco import as_mujoco
from .plain import as_csv, as_json
from .simulink import as_simulink
from .table import ExportError, grid_of

# name -> (how, suffix)
FORMATS = {
    "csv": (as_csv, ".csv"),
    "npz": (as_npz, ".npz"),
    "mat": (as_mat, ".mat"),
    "c": (as_c, ".h"),
    "json": (as_json, ".json"),
    "mujoco": (as_mujoco, ".xml"),
    "simulink": (as_simulink, ".m"),
}


def export(atlas, path, to=None, variables=None, derivatives=False, at=None) -> Path:
    """See :meth:`freesweep.Atlas.export`."""
    faults = []
    path = read_path("path", path, "the table to make", faults)
    if to is None and path is not None:
        to = next((name for name, (_, suffix) in FORMATS.items() if path.suffix == suffix), None)
        if to is None:
            known = ", ".join(f"{suffix} ({name})" for name, (_, suffix) in FORMATS.items())
            faults.append(f"path: the suffix {path.suffix!r} names no format; use {known}, or give to=")
    elif to is not None:
        to = read_choice("to", to, tuple(FORMATS), faults)
    if faults:
        raise ExportError(faults)
    name = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    name = name if re.match("[A-Za-z]", name) else f"table_{name}"
    grid = grid_of(chosen(atlas, variables, derivatives, at or {}))
    content = FORMATS[to][0](grid, name)
    _warn_of_holes(grid)
    write_whole(path, content)
    return path


def _warn_of_holes(grid):
    """What was asked for and is not in the table, as the atlas does not reach there, or is not exact enough."""
    for name in grid.statuses:
        status = grid.columns[name]
        holes = {STATUSES[why].meaning: int(np.sum(status == why)) for why in (OUTSIDE, NOT_INTERPOLABLE)}
        if any(holes.values()):
            told = ", ".join(f"{count:,} {word}" for word, count in holes.items() if count)
            warnings.warn(f"{name}: rows without a number, of {status.size:,}: {told}", stacklevel=4)

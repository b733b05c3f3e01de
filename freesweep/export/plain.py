"""Tables as text that any program reads: CSV, one row for each point, and JSON, one list for each variable."""

import csv
import io
import json

import numpy as np

from .table import Grid, meanings


def as_csv(grid: Grid, _) -> bytes:
    """Columns ``name [unit]``: what is fixed, axes, variables with errors, statuses in words; missing numbers empty."""
    places = np.meshgrid(*grid.axes.values(), indexing="ij")
    columns = {name: np.full(grid.shape, value) for name, value in grid.fixed.items()}
    columns |= dict(zip(grid.axes, places)) | grid.columns
    said, lists = meanings(), []
    for name, array in columns.items():
        own = np.ravel(array).tolist()
        if name in grid.statuses:
            own = [said[status] for status in own]
        lists.append(["" if value != value else value for value in own])
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    units = {name: grid.units.get(name, "") for name in columns}
    writer.writerow([f"{name} [{unit}]" if unit not in ("", "1") else name for name, unit in units.items()])
    writer.writerows(zip(*lists))
    return text.getvalue().encode()


def as_json(grid: Grid, _) -> bytes:
    """Axes, fixed values and variables, each with its unit; arrays nested in the order of ``axes``, missing numbers null."""

    def described(name, values):
        return {"units": grid.units.get(name, ""), "long_name": grid.words.get(name, name), "values": values}

    content = {
        "title": grid.attrs.get("title", ""),
        "source": grid.attrs.get("source", ""),
        "order": list(grid.axes),
        "axes": {name: described(name, array.tolist()) for name, array in grid.axes.items()},
        "fixed": {name: described(name, value) for name, value in grid.fixed.items()},
        "variables": {name: described(name, _without_nan(array)) for name, array in grid.columns.items()},
        "statuses": {str(value): meaning for value, meaning in meanings().items()},
    }
    return (json.dumps(content, indent=1, allow_nan=False) + "\n").encode()


def _without_nan(array):
    """Nested lists, None for NaN."""
    if array.dtype.kind != "f":
        return array.tolist()
    return np.where(np.isfinite(array), array.astype(object), None).tolist()

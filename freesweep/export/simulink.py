"""A table as a MATLAB script that makes one Simulink.LookupTable object for each variable."""

import numpy as np

from .table import ExportError, Grid, meanings


def as_simulink(grid: Grid, name: str) -> bytes:
    """The script; its objects begin with ``name``, errors and statuses are plain arrays beside them."""
    if not grid.axes or min(grid.shape) < 2:
        raise ExportError(["a lookup table needs two breakpoints or more along each axis"])
    lines = [
        f"% {_line(grid.attrs.get('title', ''))}",
        f"% {_line(grid.attrs.get('source', 'freesweep'))}",
        *(f"% {each} = {value!r} {grid.units[each]}".removesuffix(" 1") for each, value in grid.fixed.items()),
        "% statuses: " + ", ".join(f"{value} {meaning}" for value, meaning in meanings().items()),
        "% NaN stands where there is no number: see the status beside it",
    ]
    for column, array in grid.columns.items():
        own = f"{name}_{column}"
        sizes = " ".join(map(str, grid.shape if len(grid.shape) > 1 else (1, *grid.shape)))
        values = f"reshape({_row(np.ravel(array, order='F'))}, [{sizes}]);"
        if column.endswith("_error") or array.dtype.kind != "f":
            lines.append(f"{own} = {values}")
            continue
        lines += [
            f"{own} = Simulink.LookupTable;",
            f"{own}.Table.Value = {values}",
            f"{own}.Table.FieldName = '{column}';",
            f"{own}.Table.Unit = '{grid.units[column]}';",
            f"{own}.Table.Description = '{_line(grid.words[column])}';",
        ]
        for k, (axis, nodes) in enumerate(grid.axes.items(), start=1):
            lines += [
                f"{own}.Breakpoints({k}).Value = {_row(nodes)};",
                f"{own}.Breakpoints({k}).FieldName = '{axis}';",
                f"{own}.Breakpoints({k}).Unit = '{grid.units[axis]}';",
            ]
    return "\n".join([*lines, ""]).encode()


def _row(array):
    """Numbers as MATLAB reads them."""
    return "[" + " ".join("NaN" if value != value else repr(value) for value in array.tolist()) + "]"


def _line(text):
    return str(text).replace("'", "''").replace("\n", " ")

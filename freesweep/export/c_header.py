"""A table as a C99 header: constant arrays, and a function for each variable that interpolates between them."""

import numpy as np

from .table import ExportError, Grid, meanings

ROW = 6  # numbers of a line
INTERPOLATE = """
/* Linear between the nodes; NAN beyond the axes and beside missing numbers. values: row-major over the axes. */
static inline double {p}_interpolate(const double *values, const double *at)
{{
    static const double *const axes[{n}] = {{{axes}}};
    static const int sizes[{n}] = {{{sizes}}};
    int low[{n}], k, corner;
    double share[{n}], sum = 0.0;
    for (k = 0; k < {n}; ++k) {{
        const double *nodes = axes[k];
        const int last = sizes[k] - 1;
        int i = 0;
        if (!(at[k] >= nodes[0] && at[k] <= nodes[last]))
            return NAN;
        while (i + 1 < last && at[k] > nodes[i + 1])
            ++i;
        low[k] = i;
        share[k] = last > 0 ? (at[k] - nodes[i]) / (nodes[i + 1] - nodes[i]) : 0.0;
    }}
    for (corner = 0; corner < (1 << {n}); ++corner) {{
        double weight = 1.0;
        int index = 0;
        for (k = 0; k < {n}; ++k) {{
            const int side = (corner >> k) & 1;
            weight *= side ? share[k] : 1.0 - share[k];
            index = index * sizes[k] + low[k] + (weight != 0.0 ? side : 0);
        }}
        if (weight != 0.0)
            sum += weight * values[index];
    }}
    return sum;
}}
"""


def as_c(grid: Grid, name: str) -> bytes:
    """The header; everything in it begins with ``name``."""
    if not grid.axes:
        raise ExportError(["a single point is no table; leave an axis free"])
    sizes = ", ".join(map(str, grid.shape))
    lines = [
        f"/* {_comment(grid.attrs.get('title', ''))}",
        f" * {_comment(grid.attrs.get('source', 'freesweep'))}",
        " * Arrays are row-major over " + ", ".join(f"{axis} [{grid.units[axis]}]" for axis in grid.axes) + ".",
        *(f" * {each} = {value!r} {grid.units[each]}".removesuffix(" 1") for each, value in grid.fixed.items()),
        " * Statuses: " + ", ".join(f"{value} {meaning}" for value, meaning in meanings().items()) + ". */",
        f"#ifndef {name.upper()}_H",
        f"#define {name.upper()}_H",
        "#include <math.h>",
        "",
    ]
    for axis, array in grid.axes.items():
        lines += _array(f"{name}_{axis}", array, grid.units[axis])
    for column, array in grid.columns.items():
        lines += _array(f"{name}_{column}", array, grid.units[column])
    axes = ", ".join(f"{name}_{axis}" for axis in grid.axes)
    lines.append(INTERPOLATE.format(p=name, n=len(grid.axes), axes=axes, sizes=sizes))
    given = ", ".join(f"double {axis}" for axis in grid.axes)
    for column in grid.values:
        lines += [
            f"/* {_comment(grid.words[column])} [{grid.units[column]}] */",
            f"static inline double {name}_{column}_at({given})",
            "{",
            f"    const double at[] = {{{', '.join(grid.axes)}}};",
            f"    return {name}_interpolate({name}_{column}, at);",
            "}",
            "",
        ]
    return "\n".join([*lines, "#endif", ""]).encode()


def _array(name, array, unit):
    """Lines of one constant array."""
    whole = array.dtype.kind in "iub"
    flat = ["NAN" if value != value else repr(value) for value in np.ravel(array).tolist()]
    rows = [", ".join(flat[k : k + ROW]) for k in range(0, len(flat), ROW)]
    kind = "signed char" if whole else "double"
    unit = f" /* [{unit}] */" if unit and not whole else ""
    return [f"static const {kind} {name}[{len(flat)}] = {{{unit}", *(f"    {row}," for row in rows), "};"]


def _comment(text):
    return str(text).replace("*/", "* /").replace("\n", " ")

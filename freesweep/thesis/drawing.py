"""A figure of the source as it is handed over: the picture, its numbers as rows, and a sentence on what was chosen."""

import csv
import io
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..atlas import schema
from ..plot import style
from ..plot.curve import draw_line
from ..plot.display import absolute, shown_units

UNITS = {
    "hoop_load": "N/m", "line_load": "N/m", "arm_pressure": "Pa", "force": "N", "torque": "N m", "fiber_angle": "degree",
    "share": "1",
}  # fmt: skip
DIGITS = 10  # of a number in a CSV file


class Numbers:
    """The rows behind a picture, as a CSV file: added line by line, every column with its unit."""

    def __init__(self):
        self.rows = []

    def add(self, **columns):
        """Rows of equal length: arrays give one value each, numbers and texts the same in all."""
        count = max(np.size(value) for value in columns.values())
        spread = {name: np.broadcast_to(np.asarray(value), count) for name, value in columns.items()}
        self.rows += [{name: values[k] for name, values in spread.items()} for k in range(count)]

    def csv(self) -> str:
        """The table as text; a number that does not exist is left empty."""
        names = list(dict.fromkeys(name for row in self.rows for name in row))
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow([_head(name) for name in names])
        for row in self.rows:
            writer.writerow([_cell(row.get(name, "")) for name in names])
        return text.getvalue()


def _head(name):
    base = name.removesuffix("_error")
    if base in UNITS:
        return f"{name} [{UNITS[base]}]"
    try:
        return f"{name} [{schema.attributes(name)['units']}]"
    except KeyError:
        return name


def _cell(value):
    if isinstance(value, str) or not isinstance(value, float | np.floating):
        return str(value)
    return "" if np.isnan(value) else f"{value:.{DIGITS}g}"


class Drawing(NamedTuple):
    """One figure of the source."""

    figure: Figure
    numbers: Numbers
    note: str = ""


def line(ax: Axes, numbers: Numbers, data, variable, along="pressure", *, of=None, **how) -> Line2D:
    """Draws ``variable`` of a Dataset along one dimension, in shown units, with its error bound, and adds the rows.

    ``of`` holds what distinguishes this line (name: text or number), written beside each row.
    """
    of = of or {}
    error = data.get(f"{variable}_error")
    rows = {along: data[along].values, variable: data[variable].values}
    if error is not None:
        rows[f"{variable}_error"] = error.values
    numbers.add(**of, **rows, status=data["status"].values)
    shown = absolute(variable)
    return draw_line(
        ax,
        shown_units(along)[1] * data[along].values,
        shown.convert(data[variable].values, {}),
        error=None if error is None else shown.convert(error.values, {}),
        gid=" ".join([*(str(value) for value in of.values()), variable]),
        **how,
    )


def key(figure: Figure, entries, columns=None):
    """A legend below the axes: (words, style of a line) each."""
    handles = [
        Line2D([], [], label=words, **{"color": style.INK, "linewidth": style.THICK, **how}) for words, how in entries
    ]
    with style.context():
        return figure.legend(
            handles=handles, loc="outside lower center", ncols=columns or len(handles), handlelength=3.0
        )


def panels(width, height, rows=1, columns=1, **how):
    """A figure of ``width`` and ``height`` [mm] and its Axes, in the style of the house."""
    figure = style.new_figure(width, height)
    with style.context():
        return figure, figure.subplots(rows, columns, **how)

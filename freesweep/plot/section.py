"""Maps of an atlas over any two of its axes, alone or as small multiples along others, in one set of colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, MultipleLocator

from .. import closed_form
from ..description.quantities import Quantity
from . import style
from .choice import check_name, dimensions, read_selection, warn_missed
from .display import axis_label, describe, display, shown_units, title
from .fill import draw_bar, draw_failures, draw_values, shades, shown_values
from .plane import ALPHA, BETA, Plane, section
from .slack import draw_slack

if TYPE_CHECKING:
    import xarray as xr

SIZE = (style.PAGE * 0.75, 105.0)  # of a figure of one map [mm]
SMOOTH = 6  # nodes along an axis from which contours are drawn between them
MOST = 4  # panels along an axis
PANEL = 46.0  # height of a panel [mm]
LETTER = 1.3  # of the words above the maps [mm]
LEGEND_COLUMN = 43.0  # [mm]


def section_map(
    dataset: xr.Dataset,
    variable: str = "rotation",
    x: str = "alpha",
    y: str = "beta",
    ax: Axes | None = None,
    slack: bool = True,
    **select: Quantity,
) -> Axes:
    """Draws ``variable`` of an atlas over the axes ``x`` and ``y``, and returns the Axes.

    Everything else, ``slack`` too, is as in :func:`freesweep.plot.map.design_map`, which draws more over both fiber angles.
    Raises ValueError for unknown names, and axes that the variable does not have.
    """
    sheet = section(dataset, variable, x, y, select)
    warn_missed(sheet.point)
    with style.context():
        ax = style.new_axes(*SIZE) if ax is None else ax
        values = shown_values(sheet, variable)
        shade = shades(values.compressed(), display(variable).centre)
        keys = _draw(ax, sheet, values, shade, variable, dataset, select if slack else None)
        draw_bar(ax.figure, shade, display(variable).axis_label, cax=ax.inset_axes([1.04, 0.0, 0.035, 1.0]))
        ax.set(xlabel=axis_label(x), ylabel=axis_label(y))
        head(ax.figure, ax, title(variable), sheet.point, 6.0)
        legend(ax.figure, keys)
    return ax


def multiples(
    dataset: xr.Dataset,
    variable: str = "rotation",
    x: str = "alpha",
    y: str = "beta",
    over: str | Sequence[str] = ("pressure",),
    figure: Figure | None = None,
    slack: bool = True,
    **select: Quantity,
) -> Figure:
    """Small maps of ``variable`` over ``x`` and ``y``, one for each node of one or two axes ``over``; returns the figure.

    Of an axis with more than four nodes, four are taken, the last among them (without pressure there is nothing to see), and
    steps of the colours so that each of them shows some; the first axis runs to the right, the
    second down. One set of colours serves all. Raises ValueError as :func:`section_map` does.
    """
    over = (over,) if isinstance(over, str) else tuple(over)
    if not 1 <= len(over) <= 2 or len(set(over)) < len(over) or {x, y} & set(over):
        raise ValueError(
            f"small multiples run over one or two axes other than {x} and {y}, found {', '.join(over) or 'none'}"
        )
    for name in over:
        check_name(name, [axis for axis in dimensions(dataset) if axis not in (x, y)], "axis to run over")
    nodes = [_some(name, dataset[name].values) for name in over]
    rows = nodes[1] if len(over) == 2 else [None]
    sheets = [
        [
            section(dataset, variable, x, y, select | {over[0]: column} | ({} if row is None else {over[1]: row}))
            for column in nodes[0]
        ]
        for row in rows
    ]
    warn_missed(sheets[0][0].point)
    with style.context():
        figure = style.new_figure(style.PAGE, PANEL * len(rows) + 34.0) if figure is None else figure
        axes = figure.subplots(len(rows), len(nodes[0]), sharex=True, sharey=True, squeeze=False)
        values = [[shown_values(sheet, variable) for sheet in row] for row in sheets]
        panels = [one.compressed() for row in values for one in row]
        shade = shades(np.concatenate(panels), display(variable).centre, panels)
        keys = {}
        for (i, k), ax in np.ndenumerate(axes):
            sheet = sheets[i][k]
            here = dict(zip(over, (nodes[0][k], rows[i])))
            keys |= _draw(ax, sheet, values[i][k], shade, variable, dataset, select | here if slack else None)
            if i == 0:
                ax.set_title(describe(over[0], nodes[0][k]), loc="left", fontsize=style.points(style.NORMAL))
            if i == len(rows) - 1:
                ax.set_xlabel(axis_label(x, short=True))
            if k == 0:
                row = "" if rows[i] is None else f"{describe(over[1], rows[i])}\n"
                ax.set_ylabel(row + axis_label(y, short=True))
        draw_bar(figure, shade, display(variable).axis_label, ax=axes, aspect=30.0, pad=0.02)
        shared = sheets[0][0].point.only(lambda name: name not in over)
        head(figure, axes[0, 0], title(variable), shared, 20.0)
        legend(figure, keys)
    return figure


def _some(name, nodes):
    """Up to MOST nodes, evenly among them: numbers, or names of designs. Without pressure there is nothing to see."""
    blank = int(name == "pressure" and len(nodes) > 1 and nodes[0] == 0.0)
    at = np.unique(np.linspace(0, len(nodes) - 1, MOST + blank).round().astype(int))[blank:]
    return [str(node) if nodes.dtype.kind in "UO" else float(node) for node in nodes[at]]


def scaled(sheet: Plane) -> Plane:
    """The sheet with its axes in shown units."""
    x, y = (nodes * shown_units(name)[1] for name, nodes in zip(sheet.names, (sheet.x, sheet.y)))
    return sheet._replace(x=x, y=y)


def _draw(ax, sheet, values, shade, variable, dataset, select):
    """Values, failures, and at what was ``select``-ed slack fibers of one map (None: without); returns their keys."""
    sheet = scaled(sheet)
    draw_values(ax, sheet, values, shade, min(sheet.x.size, sheet.y.size) >= SMOOTH)
    window(ax, sheet)
    keys = {} if select is None else draw_slack(ax, dataset, variable, sheet, read_selection(select))
    return keys | draw_failures(ax, sheet, variable, dataset)


def window(ax, sheet: Plane) -> None:
    """Limits and ticks of a map; over both fiber angles the locked manifold, too."""
    if sheet.names == ("alpha", "beta"):
        alpha = np.linspace(*ALPHA, 181)
        ax.plot(alpha, closed_form.locked_manifold(alpha), color=style.LOCKED, linewidth=1.0, gid="LM", zorder=4)
        ax.set(xlim=ALPHA, ylim=BETA)
        ax.xaxis.set_major_locator(MultipleLocator(30.0))
        ax.yaxis.set_major_locator(MultipleLocator(45.0))
    else:
        ax.xaxis.set_major_locator(MaxNLocator(5))
        ax.yaxis.set_major_locator(MaxNLocator(6))


def head(figure, ax, text, point, lift) -> None:
    """Title of the figure and, ``lift`` points above the first map, what was chosen."""
    width = figure.get_size_inches()[0] * style.INCH
    below = style.broken(point.words(), width, LETTER)
    heading = "\n".join([text, *[" "] * len(below)])  # room for what was chosen
    figure.suptitle(heading, x=0.01, ha="left", fontsize=style.points(style.LARGE), fontweight="bold", linespacing=1.0)
    how = {"xycoords": "axes fraction", "textcoords": "offset points", "annotation_clip": False, "gid": "chosen"}
    chosen = ax.annotate(
        "\n".join(below), (0.0, 1.0), xytext=(0.0, lift), color=style.QUIET, fontsize=style.points(style.SMALL), **how
    )
    chosen.set_in_layout(False)  # it may run over several maps


def legend(figure, keys) -> None:
    """The keys of what is drawn, below the maps."""
    if keys:
        width = figure.get_size_inches()[0] * style.INCH
        figure.legend(handles=list(keys.values()), loc="outside lower left", ncols=max(1, int(width / LEGEND_COLUMN)))

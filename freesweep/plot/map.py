"""The map of the design space: one variable of an atlas over the two fiber angles, in the manner of Figure 1-2."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator
from matplotlib.transforms import ScaledTranslation

from ..description.quantities import Quantity
from . import glyph, regions, style
from .choice import read_selection, warn_missed
from .display import display, title
from .fill import draw_bar, draw_failures, draw_values, shades, shown_values
from .plane import ALPHA, BETA, Plane, plane
from .slack import draw_slack

if TYPE_CHECKING:
    import xarray as xr

SIZE = (style.PAGE, 165.0)  # of a figure of its own [mm]
LEGEND_COLUMN = 43.0  # [mm]
LETTER = 1.3  # of the line below the title [mm]
COARSE = 12.0  # [degree]: wider grids are drawn node by node, without contours between them


def design_map(
    dataset: xr.Dataset,
    variable: str = "rotation",
    ax: Axes | None = None,
    paths: bool = True,
    examples: bool = True,
    slack: bool = True,
    **select: Quantity,
) -> Axes:
    """Draws ``variable`` of an atlas (xarray Dataset) over alpha and beta [degree], and returns the Axes.

    ``select`` gives the other dimensions (``length=0.2``, ``pressure="1 bar"``; plain numbers in stored units), named below
    the title.
    Between its nodes an atlas is interpolated, as by a query; a dataset that cannot be is drawn at the nearest node, which
    is said there and in a warning. Not given: the largest pressure, the force and torque nearest zero,
    the middle of anything else. ``paths`` draws the way of some designs under pressure (uniform tube), ``examples``
    little actuators; both want Axes about 100 mm wide. ``slack`` hatches where a fiber family is slack, or would have to
    push. Without ``ax`` a figure of 170 mm is made; the figure of a given
    one should have ``layout="constrained"``, for the colour bar and the legend stand outside the Axes.

    Shown: lengths as change in percent, radii in units of the undeformed one, rotation in degrees, pressure in kPa,
    torque in mN m. Contours end at failed nodes, which are hatched by status. A dataset of one part of the plane is
    completed by symmetry. Raises ValueError for an unknown variable or dimension, a value that is no number, or a
    dataset without alpha and beta as dimensions.
    """
    sheet = plane(dataset, variable, select)
    warn_missed(sheet.point)
    with style.context():
        ax = style.new_axes(*SIZE) if ax is None else ax
        values = shown_values(sheet, variable)
        shade = shades(values.compressed(), display(variable).centre)
        draw_values(ax, sheet, values, shade, max(np.diff(sheet.x).max(), np.diff(sheet.y).max()) <= COARSE)
        beside = ax.inset_axes([1.03, 0.0, 0.03, 1.0])  # a column of its own would keep clear of the legend, too
        draw_bar(ax.figure, shade, display(variable).axis_label, cax=beside)
        handles = [regions.draw_lines(ax)]
        if paths:
            handles.append(regions.draw_paths(ax)[0])
        if examples:
            glyph.draw_examples(ax)
            handles += [
                Line2D([], [], color=colour, linewidth=1.0, label=f"fibers at ${name}$")
                for name, colour in zip((r"\alpha", r"\beta"), style.FAMILIES)
            ]
        if slack:
            handles += draw_slack(ax, dataset, variable, sheet, read_selection(select)).values()
        handles += draw_failures(ax, sheet, variable, dataset).values()
        _dress(ax, sheet, variable, handles)
    return ax


def _dress(ax, sheet: Plane, variable, handles):
    """Window, ticks, title with what was chosen, and the legend below the axes."""
    family = {"fontfamily": mpl.rcParams["font.family"]}  # Axes that were handed in bring their own type
    plain = {"fontsize": style.points(style.NORMAL + 1.0), "color": mpl.rcParams["axes.labelcolor"], **family}
    plain["math_fontfamily"] = mpl.rcParams["mathtext.fontset"]
    ax.set(xlim=ALPHA, ylim=BETA, facecolor=style.PAPER)
    ax.set_xlabel(r"fiber angle $\alpha$ [degree]", **plain)
    ax.set_ylabel(r"fiber angle $\beta$ [degree]", labelpad=1.0, **plain)
    for axis, major, minor in ((ax.xaxis, 15.0, 5.0), (ax.yaxis, 30.0, 10.0)):
        axis.set_major_locator(MultipleLocator(major))
        axis.set_minor_locator(MultipleLocator(minor))
    ax.tick_params(labelsize=style.points(style.NORMAL), labelfontfamily=family["fontfamily"])

    width = ax.get_position().width * ax.figure.bbox.width / ax.figure.dpi * style.INCH  # before the layout [mm]
    below = style.broken(sheet.point.words(), width, LETTER)
    heading = {**plain, "fontsize": style.points(style.LARGE), "fontweight": "bold"}
    ax.set_title(title(variable), loc="left", pad=7.0 + style.points(10.0) * len(below), **heading)
    ax.annotate(
        "\n".join(below),
        (0.0, 1.0),
        xytext=(0.0, 5.0),
        xycoords="axes fraction",
        textcoords="offset points",
        color=style.QUIET,
        va="bottom",
        linespacing=1.0,
        gid="chosen",
    )
    ax.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.0, 0.0),
        bbox_transform=ax.transAxes + ScaledTranslation(0.0, -30.0 / 72.0, ax.figure.dpi_scale_trans),
        ncols=int(np.clip(width / LEGEND_COLUMN, 1, 3)),
        borderaxespad=0.0,
        columnspacing=1.6,
        handlelength=2.4,
        handleheight=1.0,
        labelspacing=0.5,
    )

"""The map of the design space: one variable of an atlas over the two fiber angles, in the manner of Figure 1-2."""

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator, MultipleLocator
from matplotlib.transforms import ScaledTranslation

from .. import status
from . import glyph, regions, style
from .display import USUAL, describe, display, title
from .plane import ALPHA, BETA, NO_VALUE, Plane, plane

SIZE = (style.PAGE, 165.0)  # of a figure of its own [mm]
STEPS = 16  # of the colour bar, about
TICKS = 9  # with a number, about
ROBUST = (6.0, 94.0)  # percentiles between which the colours run: the neighbours of a pole do not flatten the rest
LEGEND_COLUMN = 43.0  # [mm]
LETTER = 1.3  # of the line below the title [mm]
NICE = [1, 2, 2.5, 5, 10]  # steps of the colour bar, times a power of ten
COARSE = 6.0  # [degree]: wider grids are drawn node by node, without contours between them
HATCH = {
    NO_VALUE: None,
    status.OUTSIDE: None,
    status.DEGENERATE: "......",
    status.BEYOND_LIMIT: "//////",
    status.COMPRESSED: "\\\\\\\\\\\\",
    status.HELD_IMPOSSIBLE: "xxxxx",
    status.INACCURATE: "...",
    status.NOT_CONVERGED: "+++++",
    status.INVALID: "-----",
    status.NOT_INTERPOLABLE: "ooo",
}


def design_map(dataset, variable="rotation", ax=None, paths=True, examples=True, **select) -> Axes:
    """Draws ``variable`` of an atlas (xarray Dataset) over alpha and beta [degree], and returns the Axes.

    ``select`` gives the other dimensions (``length=0.2``, ``pressure=1e5``, in the stored units): the nearest value of
    the grid is taken, and named below the title. Not given: the largest pressure, the force and torque nearest zero,
    the middle of anything else. ``paths`` draws the way of some designs under pressure (uniform tube), ``examples``
    little actuators; both want Axes about 100 mm wide. Without ``ax`` a figure of 170 mm is made; the figure of a given
    one should have ``layout="constrained"``, for the colour bar and the legend stand outside the Axes.

    Shown: lengths as change in percent, radii in units of the undeformed one, rotation in degrees, pressure in kPa,
    torque in mN m. Contours end at failed nodes, which are hatched by status. A dataset of one part of the plane is
    completed by symmetry. Raises ValueError for an unknown variable or dimension, a value that is no number, or a
    dataset without alpha and beta as dimensions.
    """
    sheet = plane(dataset, variable, select)
    with style.context():
        ax = style.new_axes(*SIZE) if ax is None else ax
        bar = _draw_values(ax, sheet, variable)
        handles = [regions.draw_lines(ax)]
        if paths:
            handles.append(regions.draw_paths(ax)[0])
        if examples:
            glyph.draw_examples(ax)
            handles += [
                Line2D([], [], color=colour, linewidth=1.0, label=f"fibers at ${name}$")
                for name, colour in zip((r"\alpha", r"\beta"), style.FAMILIES)
            ]
        handles += _draw_failures(ax, sheet, variable, dataset)
        _dress(ax, sheet, variable, handles)
        bar.ax.tick_params(labelsize=style.NORMAL, width=0.6)
    return ax


def _draw_values(ax, sheet: Plane, variable):
    shown = display(variable)
    values = shown.convert(sheet.values, sheet.point)
    levels, colours, extend = _levels(values.compressed(), shown.centre)
    norm = BoundaryNorm(levels, len(levels) - 1)
    edges = _edges(sheet.alpha), _edges(sheet.beta)
    # an image also in vector files: cells that abut would show seams there
    ax.pcolormesh(*edges, values, cmap=colours, norm=norm, rasterized=True, zorder=1)
    ax.add_patch(Rectangle((edges[0][0], edges[1][0]), np.ptp(edges[0]), np.ptp(edges[1]), fill=False,
                           edgecolor=style.QUIET, linewidth=0.5, zorder=3))  # fmt: skip
    if max(np.diff(sheet.alpha).max(), np.diff(sheet.beta).max()) <= COARSE:
        for side in _sides(sheet, variable):
            part = np.ma.array(values, mask=np.ma.getmaskarray(values) | ~side)
            if part.count():
                ax.contourf(sheet.alpha, sheet.beta, part, levels, cmap=colours, norm=norm, extend=extend, zorder=2)
    beside = ax.inset_axes([1.03, 0.0, 0.03, 1.0])  # a column of its own would keep clear of the legend, too
    bar = ax.figure.colorbar(ScalarMappable(norm, colours), cax=beside, extend=extend)
    first = 0 if shown.centre is None else np.abs(levels - shown.centre).argmin()  # the centre gets a number
    stride = -(-len(levels) // TICKS)
    bar.set_ticks(levels[first % stride :: stride])
    bar.set_label(shown.axis_label)
    bar.outline.set_linewidth(0.5)
    return bar


def _levels(values, centre):
    """Boundaries of the colours, the colours, and on which sides values lie beyond them."""
    low, high = np.percentile(values, ROBUST) if values.size else (0.0, 1.0)
    if centre is None:
        levels = MaxNLocator(STEPS, steps=NICE).tick_values(low, high)
        place, colours = (lambda value: (value - levels[0]) / (levels[-1] - levels[0])), style.SEQUENTIAL
    else:  # colours symmetric about the centre; the bar covers the values only
        low, high = min(low, centre), max(high, centre)
        if low == high:  # nothing moves
            low, high = centre - 1.0, centre + 1.0
        reach = max(centre - low, high - centre)
        count = min(2.0 * STEPS, STEPS * 2.0 * reach / (high - low))
        levels = MaxNLocator(int(count), steps=NICE).tick_values(-reach, reach) + centre
        width = np.abs(levels - centre).max()
        levels = levels[max(np.searchsorted(levels, low, "right") - 1, 0) : np.searchsorted(levels, high) + 1]
        place, colours = (lambda value: 0.5 + 0.5 * (value - centre) / width), style.DIVERGING
    under, over = (values.size > 0 and values.min() < levels[0]), (values.size > 0 and values.max() > levels[-1])
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[bool(under), bool(over)]
    middles = np.convolve(np.pad(levels, 1, "reflect", reflect_type="odd"), [0.5, 0.5], "valid")
    shades = colours(place(middles))  # one more on either side, for what lies beyond
    listed = ListedColormap(shades[1:-1]).with_extremes(bad=style.BLANK, under=shades[0], over=shades[-1])
    return levels, listed, extend


def _sides(sheet, variable):
    """Masks (m, n) of the parts between which no contour may run: DF is degenerate, a torque has a pole on AF."""
    alpha, beta = np.meshgrid(sheet.alpha, sheet.beta)
    sides = [alpha > beta, alpha < beta]
    if variable == "ideal_blocked_torque":
        sides = [side & half for side in sides for half in (alpha > -beta, alpha < -beta)]
    return sides


def _edges(nodes):
    """Boundaries of the cells around nodes [degree], half way between them; none beyond the last node."""
    return np.concatenate([nodes[:1], 0.5 * (nodes[1:] + nodes[:-1]), nodes[-1:]])


def _draw_failures(ax, sheet: Plane, variable, dataset):
    """Hatches the cells without a value, and the inaccurate ones, by reason; returns the keys for the legend."""
    x, y = _edges(sheet.alpha), _edges(sheet.beta)
    keys = []
    for reason in np.unique(sheet.reason[sheet.reason != status.OK]).tolist():
        meaning = _meaning(reason, variable, dataset)
        face = style.PAPER if reason in (status.INACCURATE, status.OUTSIDE) else style.BLANK
        cells = [_cell(x[i : i + 2], y[j : j + 2]) for j, i in np.argwhere(sheet.reason == reason)]
        patch = PathPatch(
            Path.make_compound_path(*cells), fill=reason == status.OUTSIDE, facecolor=face, edgecolor=style.QUIET,
            linewidth=0.0, hatch=HATCH[reason], label=meaning, gid=f"reason {reason}", zorder=3,
        )  # fmt: skip
        ax.add_patch(patch)
        keys.append(Patch(facecolor=face, edgecolor=style.QUIET, linewidth=0.4, hatch=HATCH[reason], label=meaning))
    return keys


def _cell(x, y):
    return Path([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])], closed=True)


def _meaning(reason, variable, dataset):
    if reason != NO_VALUE:
        return status.STATUSES[reason].meaning.replace("_", " ")
    if variable != "limit_pressure":
        return "no value"
    return f"no limit up to {describe('pressure', float(dataset['pressure'].max()))}"


def _dress(ax, sheet: Plane, variable, handles):
    """Window, ticks, title with what was chosen, and the legend below the axes."""
    family = {"fontfamily": style.SETTINGS["font.family"]}  # Axes that were handed in bring their own type
    plain = {"fontsize": style.NORMAL + 1.0, "color": style.INK, "math_fontfamily": "stix", **family}
    ax.set(xlim=ALPHA, ylim=BETA, facecolor=style.PAPER)
    ax.set_xlabel(r"fiber angle $\alpha$ [degree]", **plain)
    ax.set_ylabel(r"fiber angle $\beta$ [degree]", labelpad=1.0, **plain)
    for axis, major, minor in ((ax.xaxis, 15.0, 5.0), (ax.yaxis, 30.0, 10.0)):
        axis.set_major_locator(MultipleLocator(major))
        axis.set_minor_locator(MultipleLocator(minor))
    ax.tick_params(labelsize=style.NORMAL, labelfontfamily=family["fontfamily"])

    width = ax.get_position().width * ax.figure.bbox.width / ax.figure.dpi * style.INCH  # before the layout [mm]
    chosen = [describe(name, value) for name, value in sheet.point.items() if USUAL.get(name) != value]
    below = textwrap.wrap(", ".join(chosen), max(int(width / LETTER), 30))
    heading = {**plain, "fontsize": style.LARGE, "fontweight": "bold"}
    ax.set_title(title(variable), loc="left", pad=7.0 + 10.0 * len(below), **heading)
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

"""Curves: a variable of a dataset along one of its dimensions, with its error bound as a band and its flags."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ..atlas import schema
from ..description.quantities import Quantity
from ..status import STATUSES, VALUED
from . import style
from .between import between
from .choice import DESIGN, check_name, choose, dimensions, read_selection, warn_missed
from .display import absolute, axis_label, shown_units
from .plane import status_of

if TYPE_CHECKING:
    import xarray as xr

SIZE = (style.PAGE * 0.75, 85.0)  # of a figure of its own [mm]
MOST = 9  # lines in one plot
LETTER = 1.2  # width of one below the heading [mm]
BESIDE = 1.025  # where labels begin, in widths of the axes
GAP = 1.15  # between two labels at the ends of lines, in heights of type
MARKS = {"firm": "thin lines: a fiber family would have to push", "unstable": "open circles: unstable"}


def draw_line(ax: Axes, x, y, *, error=None, slack=None, unstable=None, **how) -> Line2D:
    """A line through ``(x, y)`` with ``error`` as a band; thin where fibers are ``slack``, none where ``unstable``.

    Where a state is unstable its nodes are open circles. Arrays of one shape; ``how`` goes to the line. Returns the line,
    which holds all of the data: the parts are drawn over it.
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    width = how.pop("linewidth", style.THICK)
    weak = np.zeros(x.shape, bool) if slack is None else np.asarray(slack, bool)
    loose = np.zeros(x.shape, bool) if unstable is None else np.asarray(unstable, bool)
    marked = np.any(weak | loose)
    (line,) = ax.plot(x, y, linewidth=style.THIN if marked else width, **how)
    if marked:
        firm = np.where(_joined(weak | loose), np.nan, y)
        ax.plot(x, firm, linewidth=width, color=line.get_color(), gid="firm", zorder=line.get_zorder())
    if loose.any():
        ax.plot(x[loose], y[loose], "o", markersize=2.6, markerfacecolor=style.PAPER, color=line.get_color(),
                markeredgewidth=0.7, gid="unstable")  # fmt: skip
    if error is not None:
        band(ax, x, y, error, line.get_color())
    return line


def _joined(mask):
    """Nodes that only touch others of the mask: a thick line runs up to the first of them."""
    padded = np.pad(mask, 1, mode="edge")
    return padded[:-2] & mask & padded[2:]


def band(ax: Axes, x, y, error, colour) -> PolyCollection:
    """The band ``y - error`` to ``y + error`` about a line."""
    error = np.asarray(error, float)
    return ax.fill_between(x, y - error, y + error, color=colour, alpha=style.BAND, linewidth=0.0, gid="error")


def label_ends(ax: Axes, lines, texts) -> list:
    """Writes ``texts`` in the colours of ``lines`` beside their right ends, pushed apart until none covers another.

    They stand right of the axes, joined to ends that lie elsewhere. Lines without a finite value get none.
    """
    ends = []
    for line, text in zip(lines, texts, strict=True):
        data = np.asarray(line.get_xydata(), float)
        data = data[np.all(np.isfinite(data), axis=1)]
        if len(data) and text:
            ends.append((*data[np.argmax(data[:, 0])], text, line.get_color()))
    if not ends:
        return []
    ends.sort(key=lambda end: end[1])
    (low, high), right = ax.get_ylim(), ax.get_xlim()[1]
    height = max(ax.get_position().height * ax.figure.bbox.height / ax.figure.dpi * 72.0, 1.0)  # before the layout
    step = GAP * style.NORMAL * (high - low) / height
    places = spread(np.array([end[1] for end in ends]), step)
    places += max(low - places[0], 0.0) if places[-1] - places[0] < high - low else 0.0
    labels = []
    for place, (x, y, text, colour) in zip(places, ends):
        far = abs(place - y) > 0.4 * step or x < right - 1e-6 * abs(right)
        joint = {"arrowstyle": "-", "color": colour, "linewidth": 0.5, "shrinkA": 0.0, "shrinkB": 0.0}
        how = {"color": style.legible(colour), "fontsize": style.points(style.NORMAL), "va": "center", "gid": "end"}
        labels.append(ax.annotate(
            text, (x, y), xytext=(BESIDE, place), textcoords=ax.get_yaxis_transform(), annotation_clip=False,
            arrowprops={**joint, "relpos": (0.0, 0.5)} if far else None, **how,
        ))  # fmt: skip
    return labels


def spread(places, step):
    """Ascending ``places`` moved as little as needed to lie ``step`` apart or more."""
    groups = [[place, 1] for place in places]  # centre and size of runs of labels that touch
    k = 0
    while k + 1 < len(groups):
        (low, m), (high, n) = groups[k], groups[k + 1]
        if high - low < 0.5 * (m + n) * step * (1.0 - 1e-9):
            groups[k : k + 2] = [[(low * m + high * n) / (m + n), m + n]]
            k = max(k - 1, 0)
        else:
            k += 1
    return np.concatenate([centre + step * (np.arange(size) - 0.5 * (size - 1)) for centre, size in groups])


def curve(
    dataset: xr.Dataset,
    variable: str = "deformed_length",
    along: str = "pressure",
    each: str | None = None,
    ax: Axes | None = None,
    **select: Quantity,
) -> Axes:
    """Draws ``variable`` of a Dataset (an atlas, or one actuator) along one dimension, and returns the Axes.

    ``each`` names a second dimension: one line per node of it, 9 at most, evenly chosen. ``select`` gives the others
    (stored units, texts with units, or the name of a ``design``), named below the title; between its nodes an atlas is
    interpolated, of
    another dataset the nearest node is taken, and a warning says so. Not given: the largest
    pressure, force and torque nearest zero, the middle of anything else. The error bound is a band, thin lines mark states
    that need a fiber family to push, open circles unstable ones; lines end where there is no result, and it is said why.

    Raises ValueError for unknown names, and where ``along`` or ``each`` is no dimension of the variable.
    """
    select = read_selection(select)
    known = [name for name in (*schema.VARIABLES, "force", "torque") if name in dataset.data_vars]
    check_name(variable, known, "variable")
    dims = [name for name in dimensions(dataset) if name in dataset[variable].dims]
    if not dims:
        raise ValueError(
            f"{variable} is of a single state here; a curve needs several, as of inflate at several pressures"
        )
    check_name(along, [name for name in dims if name != DESIGN], f"numeric dimension of {variable}")
    if each is not None:
        check_name(each, [name for name in dims if name != along], f"further dimension of {variable}")
    dataset = between(dataset, variable, select, (along, each))
    point, index = choose(dataset, select, (along, each))
    warn_missed(point)
    plane = dataset.isel(index)
    nodes = [None] if each is None else _nodes(dataset.sizes[each])
    shown = absolute(variable)
    with style.context():
        ax = style.new_axes(*SIZE) if ax is None else ax
        colours = style.SERIES * 2 if each == DESIGN else style.ramp(len(nodes))
        drawn = [
            _draw(ax, plane if node is None else plane.isel({each: node}), variable, along, shown, colour)
            for node, colour in zip(nodes, colours)
        ]
        _name_axes(ax, along, shown)
        if not any(
            np.isfinite(line.get_ydata()).any() for line in drawn
        ):  # axes without a line have no range of their own
            ax.set(xlim=np.sort(shown_units(along)[1] * plane[along].values)[[0, -1]], yticks=[])
        named = ""
        if each is not None:
            label_ends(ax, drawn, _texts(plane[each].values[nodes], each))
            units = "" if each == DESIGN else f" [{shown_units(each)[0]}]".replace(" [1]", "")
            named = each.replace("_", " ") + units
            ax.annotate(named, (1.0, 1.0), xycoords="axes fraction", xytext=(4.0, 9.0),
                        textcoords="offset points", color=style.QUIET, gid="each")  # fmt: skip
        relevant = point.only(lambda name: name in dataset[variable].coords)
        shown_nodes = plane if each is None else plane.isel({each: nodes})
        marks = [words for gid, words in MARKS.items() if _marked(ax, gid)]
        _name_choice(ax, relevant, [*marks, *_reasons(shown_nodes, variable)], named)
    return ax


def _nodes(size):
    return np.unique(np.linspace(0, size - 1, MOST).round().astype(int)).tolist()


def _texts(values, each):
    if each == DESIGN:
        return [str(value) for value in values]
    return [f"{shown_units(each)[1] * float(value):.4g}".replace("-", "\N{MINUS SIGN}") for value in values]


def _draw(ax, one, variable, along, shown, colour):
    value = one[variable]

    def beside(name):
        """An array that runs along the same dimension, or None."""
        return one[name].values if name in one and one[name].dims == value.dims else None

    status, slack, error = beside(status_of(variable)), beside("slack_fiber"), beside(f"{variable}_error")
    held = variable if variable.startswith("blocked") else None
    stable = beside(f"{held}_stable" if held else "stable")
    valued = np.isfinite(value.values)
    if status is not None and variable != "limit_pressure":
        valued &= np.isin(status, VALUED)
    return draw_line(
        ax, shown_units(along)[1] * one[along].values, np.where(valued, shown.convert(value.values, {}), np.nan),
        error=None if error is None else np.abs(shown.convert(error, {})),
        slack=None if slack is None or held else valued & (slack > 0),
        unstable=None if stable is None else valued & (stable == 0), color=colour, gid=variable,
    )  # fmt: skip


def _reasons(drawn, variable):
    """Why lines end, or are not there, in words."""
    if variable == "limit_pressure":
        return ["no line: no limit up to the largest pressure"] if np.isnan(drawn[variable]).any() else []
    name = status_of(variable)
    codes = np.unique(drawn[name].values) if name in drawn else []
    why = [STATUSES[code].meaning.replace("_", " ") for code in codes if code not in VALUED]
    return [f"no result: {', '.join(why)}"] if why else []


def _name_axes(ax, along, shown):
    style.dress(ax, axis_label(along), shown.axis_label, shown.label[0].upper() + shown.label[1:])
    ax.xaxis.set_major_locator(MaxNLocator(7))
    ax.margins(x=0.0)


def _marked(ax, gid):
    """Whether some line has nodes with a mark: parts that are drawn thin, or circles."""
    return any(line.get_gid() == gid for line in ax.lines)


def _name_choice(ax, point, marks, beside):
    """What was chosen and what marks mean, in words below the heading, where there are others ``beside`` the axes."""
    words = [*point.words(), *marks]
    if words:
        width = ax.get_position().width * ax.figure.bbox.width / ax.figure.dpi * style.INCH  # before the layout [mm]
        below = style.broken(words, width - LETTER * style.wider() * len(beside), LETTER)
        ax.set_title(ax.get_title("left"), loc="left", pad=6.0 + style.points(9.0) * len(below),
                     fontsize=style.points(style.NORMAL + 1.0), fontweight="bold")  # fmt: skip
        ax.annotate("\n".join(below), (0.0, 1.0), xycoords="axes fraction", xytext=(0.0, 4.0), gid="chosen",
                    textcoords="offset points", color=style.QUIET, fontsize=style.points(style.SMALL),
                    linespacing=1.0)  # fmt: skip

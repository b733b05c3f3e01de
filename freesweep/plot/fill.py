"""Filled maps of one variable over two axes: colours, contours between solved nodes, hatches where there is no value."""

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator

from .. import status
from . import style
from .display import describe, display
from .plane import NO_VALUE, Plane

STEPS = 16  # of the colour bar, about
TICKS = 9  # with a number, about
ROBUST = (6.0, 94.0)  # percentiles between which the colours run: the neighbours of a pole do not flatten the rest
OWN = 5  # of one panel among several, where equal ones do not serve all
FEWEST = 4  # boundaries of colours within a panel that shows something
CLEAR = 0.02  # of its width: so far a strip keeps off the nodes beside it
NOTHING = 1e-6  # of the whole range: a panel in which nothing moves
NICE = [1, 2, 2.5, 5, 10]  # steps of the colour bar, times a power of ten
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


ONE_ANGLE = "degenerate: fibers of one angle"


class Shades(NamedTuple):
    """Boundaries of the colours, the colours, and on which sides values lie beyond them."""

    levels: np.ndarray
    colours: ListedColormap
    extend: str
    centre: float | None

    @property
    def norm(self):
        return BoundaryNorm(self.levels, len(self.levels) - 1)


def shown_values(sheet: Plane, variable):
    """The values of a sheet in shown units: what they are scaled by may be one of its axes."""
    x, y = np.meshgrid(sheet.x, sheet.y)
    return display(variable).convert(sheet.values, sheet.point | {sheet.names[0]: x, sheet.names[1]: y})


def shades(values, centre, panels=()) -> Shades:
    """Colours for some values (1-D, shown units) with a sign about ``centre``, or None.

    ``panels`` are the values of each of several maps that share them: where equal steps would leave one of them, or all
    that there is, few colours, each adds steps of its own.
    """
    panels = panels or (values,)
    low, high = np.percentile(values, ROBUST) if values.size else (0.0, 1.0)
    even = _even(low, high, centre)
    spans = [np.percentile(panel, ROBUST) for panel in panels if panel.size]
    spans = [span for span in spans if span[1] - span[0] > NOTHING * max(high - low, 0.0)]
    poor = [span for span in spans if np.count_nonzero((even > span[0]) & (even < span[1])) < FEWEST]
    levels = np.unique(np.round(np.concatenate([_own(span, len(spans)) for span in spans]), 12)) if poor else even
    rank = np.arange(len(levels)) if poor else levels
    if centre is None:
        first, last = rank[0], rank[-1]
        place, colours = (lambda value: (value - first) / (last - first)), style.SEQUENTIAL
    else:
        middle = np.interp(centre, levels, rank, -1.0, len(levels)) if poor else centre  # beyond: all are of one sign
        width = np.abs(rank - middle).max() if poor else _reach(low, high, centre)
        place, colours = (lambda value: 0.5 + 0.5 * (value - middle) / width), style.DIVERGING

    under, over = (values.size > 0 and values.min() < levels[0]), (values.size > 0 and values.max() > levels[-1])
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[bool(under), bool(over)]
    middles = np.convolve(np.pad(rank.astype(float), 1, "reflect", reflect_type="odd"), [0.5, 0.5], "valid")
    tones = colours(place(middles))  # one more on either side, for what lies beyond
    listed = ListedColormap(tones[1:-1]).with_extremes(bad=style.BLANK, under=tones[0], over=tones[-1])
    return Shades(levels, listed, extend, centre)


def _even(low, high, centre):
    """Equal steps, symmetric about the centre; the bar covers the values only."""
    if centre is None:
        return MaxNLocator(STEPS, steps=NICE).tick_values(low, high)
    levels = _symmetric(low, high, centre)
    low, high = _about(low, high, centre)
    return levels[max(np.searchsorted(levels, low, "right") - 1, 0) : np.searchsorted(levels, high) + 1]


def _about(low, high, centre):
    low, high = min(low, centre), max(high, centre)
    return (low, high) if low < high else (centre - 1.0, centre + 1.0)  # nothing moves


def _symmetric(low, high, centre):
    low, high = _about(low, high, centre)
    reach = max(centre - low, high - centre)
    count = min(2.0 * STEPS, STEPS * 2.0 * reach / (high - low))
    return MaxNLocator(int(count), steps=NICE).tick_values(-reach, reach) + centre


def _reach(low, high, centre):
    """The largest distance of a step from the centre: where a colour is deepest."""
    return np.abs(_symmetric(low, high, centre) - centre).max()


def _own(span, panels):
    """Steps of one panel among so many."""
    return MaxNLocator(STEPS if panels == 1 else OWN, steps=NICE).tick_values(*span)


def draw_values(ax: Axes, sheet: Plane, values, shade: Shades, smooth: bool) -> None:
    """Cells in their colours; where ``smooth``, contours between the nodes of each connected part."""
    x, y = edges(sheet.x), edges(sheet.y)
    # an image also in vector files: cells that abut would show seams there
    ax.pcolormesh(x, y, values, cmap=shade.colours, norm=shade.norm, rasterized=True, zorder=1)
    frame = {"fill": False, "edgecolor": style.QUIET, "linewidth": 0.5, "zorder": 3}
    ax.add_patch(Rectangle((x[0], y[0]), np.ptp(x), np.ptp(y), **frame))
    if not smooth:
        return
    for part in sheet.parts:
        inside = np.ma.array(values, mask=np.ma.getmaskarray(values) | ~part)
        if inside.count():
            ax.contourf(sheet.x, sheet.y, inside, shade.levels, cmap=shade.colours, norm=shade.norm, extend=shade.extend,
                        zorder=2)  # fmt: skip


def draw_bar(figure, shade: Shades, label: str, **place):
    """The colour bar, in Axes of its own (``cax``) or beside others (``ax``); a centre gets a number."""
    bar = figure.colorbar(ScalarMappable(shade.norm, shade.colours), extend=shade.extend, **place)
    first = 0 if shade.centre is None else np.abs(shade.levels - shade.centre).argmin()
    stride = -(-len(shade.levels) // TICKS)
    bar.set_ticks(shade.levels[first % stride :: stride])
    bar.set_label(label)
    bar.outline.set_linewidth(0.5)
    bar.ax.tick_params(labelsize=style.points(style.NORMAL), width=0.6)
    return bar


def edges(nodes):
    """Boundaries of the cells around nodes, half way between them; none beyond the last node."""
    return np.concatenate([nodes[:1], 0.5 * (nodes[1:] + nodes[:-1]), nodes[-1:]])


def seam(sheet: Plane):
    """Vertices (n, 2) of the strip about alpha = beta that lies between solved nodes of both sides, or None.

    The truth is a line there, of which the nodes' cells would make stairs.
    """
    half = len(sheet.parts) // 2
    if half == 0:
        return None
    side = sum(part.astype(int) for part in sheet.parts[:half]) - sum(part.astype(int) for part in sheet.parts[half:])
    swapped = bool(np.any(np.all(side == 0, axis=0)))
    along, across = (sheet.y, sheet.x) if swapped else (sheet.x, sheet.y)
    low, high, places = [], [], []
    for place, column in zip(along, side if swapped else side.T):
        kinds = column[column != 0]
        if not kinds.size:
            return None  # no side is solved there
        crosses, starts = kinds[0] != kinds[-1], column[0] == 0
        if not crosses and kinds.size == column.size:
            continue  # it meets the line nowhere
        below = None if starts and not crosses else across[np.flatnonzero(column == kinds[0])[-1]]
        above = across[np.flatnonzero(column == kinds[-1])[0]] if crosses or starts else None
        width = CLEAR * ((across[-1] if above is None else above) - (across[0] if below is None else below))
        places.append(place)
        low.append(across[0] if below is None else below + width)  # clear of the nodes beside it
        high.append(across[-1] if above is None else above - width)
    if len(places) < 2:
        return None
    points = np.array([*zip(places, low), *reversed(list(zip(places, high)))])
    return points[:, ::-1] if swapped else points


def draw_failures(ax: Axes, sheet: Plane, variable, dataset) -> dict:
    """Hatches the cells without a value, and the inaccurate ones, by reason; returns the keys of the legend by reason."""
    x, y = edges(sheet.x), edges(sheet.y)
    keys = {}
    for reason in np.unique(sheet.reason[sheet.reason != status.OK]).tolist():
        meaning = _meaning(reason, variable, dataset)
        face = style.PAPER if reason in (status.INACCURATE, status.OUTSIDE) else style.BLANK
        strip = seam(sheet) if reason == status.DEGENERATE else None  # it covers cells of other nodes
        cells = [cell(x[i : i + 2], y[j : j + 2]) for j, i in np.argwhere(sheet.reason == reason)]
        cells = cells if strip is None else [Path(strip, closed=False)]
        patch = PathPatch(
            Path.make_compound_path(*cells), fill=reason == status.OUTSIDE or strip is not None, facecolor=face,
            edgecolor=style.QUIET, linewidth=0.0, hatch=HATCH[reason], label=meaning, gid=f"reason {reason}", zorder=3,
        )  # fmt: skip
        ax.add_patch(patch)
        how = {"facecolor": face, "edgecolor": style.QUIET, "linewidth": 0.4, "hatch": HATCH[reason]}
        keys[reason] = Patch(label=meaning, **how)
    return keys


def cell(x, y):
    return Path([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])], closed=True)


def _meaning(reason, variable, dataset):
    if reason == status.DEGENERATE:
        return ONE_ANGLE
    if reason != NO_VALUE:
        return status.STATUSES[reason].meaning.replace("_", " ")
    if variable != "limit_pressure":
        return "no value"
    return f"no limit up to {describe('pressure', float(dataset['pressure'].max()))}"

"""Validity of an atlas: where it has results, which fibers would have to push there, what is unstable, what fails."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ..description.quantities import Quantity
from ..status import VALUED
from . import style
from .between import between
from .choice import check_name, read_selection, warn_missed
from .display import axis_label
from .fill import draw_failures, edges
from .plane import Plane, section
from .section import head, legend, scaled, window
from .slack import flag, hatch

if TYPE_CHECKING:
    import xarray as xr

STATES = {  # what may be shown: a variable that has it, its stability, its slack fibers
    "equilibrium": ("deformed_length", "stable", "slack_fiber"),
    "blocked_force": ("blocked_force", "blocked_force_stable", None),
    "blocked_torque": ("blocked_torque", "blocked_torque_stable", None),
}
KINDS = ("#d3e8df", "#e3a0c6", "#a9b3c0", "#efd9a7")  # colours of states that have a result
WORDS = {  # of each, by what fibers are
    "bonded": (
        "both fiber families taut", r"$\alpha$ family would have to push", r"$\beta$ family would have to push",
        "each family would have to push somewhere",
    ),
    "loose": (
        "both fiber families taut", r"$\alpha$ family slack somewhere", r"$\beta$ family slack somewhere",
        "each family slack somewhere",
    ),
}  # fmt: skip
SOLVED = "a result"  # where slack fibers are not told
UNSTABLE = ("oo", "unstable")  # hatch and words
PANEL = 75.0  # height of a map [mm]


def validity_map(
    dataset: xr.Dataset,
    of: str = "equilibrium",
    x: str = "alpha",
    y: str = "beta",
    ax: Axes | None = None,
    **select: Quantity,
) -> tuple[Axes, dict, Plane]:
    """Draws validity, stability and slack fibers of an atlas over two axes.

    ``of`` is "equilibrium", "blocked_force" or "blocked_torque"; ``select`` is as in :func:`freesweep.plot.map.design_map`.
    Returns the Axes, the keys of a legend by what they mean, and the sheet. Raises ValueError for unknown names.
    """
    check_name(of, [name for name, (host, _, _) in STATES.items() if host in dataset], "state")
    host, stable, slack = STATES[of]
    select = read_selection(select)
    dataset = between(dataset, host, select, (x, y))  # its flags with it
    sheet = scaled(section(dataset, host, x, y, select))
    warn_missed(sheet.point)
    kind = np.zeros(sheet.reason.shape) if slack is None else _slack(dataset, host, slack, x, y, select)
    solved = np.isin(sheet.reason, VALUED)
    with style.context():
        ax = style.new_axes(style.PAGE * 0.6, PANEL + 40.0) if ax is None else ax
        colours = ListedColormap(KINDS)
        ax.pcolormesh(edges(sheet.x), edges(sheet.y), np.ma.array(kind, mask=~solved), cmap=colours, gid="kind", zorder=1,
                      norm=BoundaryNorm(np.arange(len(KINDS) + 1) - 0.5, len(KINDS)), rasterized=True)  # fmt: skip
        keys = {}
        for k, (colour, words) in enumerate(zip(KINDS, WORDS[sheet.point.model.fibers])):
            if np.any(solved & (kind == k)):
                words = SOLVED if slack is None else words
                keys[words] = Patch(facecolor=colour, edgecolor=style.QUIET, linewidth=0.4, label=words)
        loose = solved & (flag(dataset, host, stable, x, y, select) == 0.0)
        if loose.any():
            hatch(ax, sheet, loose, UNSTABLE[0], "unstable")
            keys["unstable"] = Patch(
                fill=False, edgecolor=style.QUIET, linewidth=0.4, hatch=UNSTABLE[0], label=UNSTABLE[1]
            )
        keys |= {key.get_label(): key for key in draw_failures(ax, sheet, host, dataset).values()}
        window(ax, sheet)
        ax.set(xlabel=axis_label(x), ylabel=axis_label(y))
    return ax, keys, sheet


def validity_maps(
    datasets: Sequence[xr.Dataset],
    of: str = "equilibrium",
    x: str = "alpha",
    y: str = "beta",
    figure: Figure | None = None,
    **select: Quantity,
) -> Figure:
    """The validity maps of several atlases side by side, each named by its strain energy; returns the figure."""
    with style.context():
        count = len(datasets)
        width = style.PAGE * (0.65 if count == 1 else 1.0)
        figure = style.new_figure(width, PANEL + 45.0) if figure is None else figure
        axes = figure.subplots(1, count, sharey=True, squeeze=False)[0]
        keys = {}
        for ax, dataset in zip(axes, datasets):
            _, found, sheet = validity_map(dataset, of, x, y, ax, **select)
            keys |= found
            ax.set_title(
                f"strain energy: {dataset.attrs.get('energy', 'not named')}",
                loc="left",
                fontsize=style.points(style.NORMAL),
            )
            if ax is not axes[0]:
                ax.set_ylabel("")
            else:
                point = sheet.point
        head(figure, axes[0], f"Validity: {of.replace('_', ' ')}", point, 20.0)
        legend(figure, keys)
    return figure


def _slack(dataset, host, name, x, y, select):
    """Slack families (m, n); where a node is the image of one with its families swapped, they are swapped back."""
    kind = flag(dataset, host, name, x, y, select)
    if {x, y} != {"alpha", "beta"}:
        return kind
    a, b = np.abs(dataset["alpha"]), np.abs(dataset["beta"])
    marked = dataset.assign(mark=(np.sign(a - b) + 0.0 * dataset[name]).astype(float))
    sheet = section(dataset, host, x, y, select)
    alpha, beta = np.meshgrid(sheet.x, sheet.y)
    swapped = flag(marked, host, "mark", x, y, select) * np.sign(np.abs(alpha) - np.abs(beta)) < 0.0
    return np.where(swapped & np.isin(kind, (1, 2)), 3 - kind, kind)

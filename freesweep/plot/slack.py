"""Where states rely on fibers that would have to push, or hang loose: flags over two axes, and their hatch on a map."""

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from ..atlas.schema import EXCHANGED
from . import style
from .between import between
from .fill import cell, edges
from .plane import section, status_of

FAINT = 0.45  # of a hatch over colours: they are what is read
SLACK = "////"
WORDS = {"loose": "threads are slack somewhere", "bonded": "fibers would have to push"}


def flag(dataset, host, name, x, y, select):
    """A flag of the states that ``host`` is of, over ``x`` and ``y``: (m, n), NaN where there is none."""
    status = status_of(host)
    lent = {one: dataset[name].astype(float) for one in (host, EXCHANGED.get(host, host))}
    lent = dataset.assign(lent | {status: dataset[status] * 0})
    return section(lent, host, x, y, select, kinds=True).values.filled(np.nan)


def hatch(ax, sheet, where, pattern, gid, colour=style.QUIET):
    """Hatch the cells of the nodes ``where``."""
    x, y = edges(sheet.x), edges(sheet.y)
    cells = [cell(x[i : i + 2], y[j : j + 2]) for j, i in np.argwhere(where)]
    if cells:
        ax.add_patch(PathPatch(Path.make_compound_path(*cells), fill=False, edgecolor=colour, linewidth=0.0,
                               hatch=pattern, gid=gid, zorder=2.5))  # fmt: skip


def draw_slack(ax, dataset, variable, sheet, select) -> dict:
    """Hatch, on a map over any two axes, the free states in which a family is slack; returns what a legend says of it."""
    free = "slack_fiber" in dataset and status_of(variable) == "status"
    if not free or set(dataset[variable].dims) != set(dataset["slack_fiber"].dims):  # held, or at no pressure
        return {}
    dataset = between(dataset, variable, select, sheet.names)
    where = ~np.ma.getmaskarray(sheet.values) & (flag(dataset, variable, "slack_fiber", *sheet.names, select) > 0)
    if not where.any():
        return {}
    colour = (*to_rgb(style.QUIET), FAINT)
    hatch(ax, sheet, where, SLACK, "slack", colour)
    words = WORDS[dataset.attrs.get("fibers", "bonded")]
    return {words: Patch(fill=False, edgecolor=colour, linewidth=0.4, hatch=SLACK, label=words)}

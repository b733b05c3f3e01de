"""The design space itself (Figure 1-2): its lines AF, DF and LM, its regions, the way designs take under pressure."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from .. import closed_form
from . import style

UNDEFORMABLE = np.degrees(np.arctan(np.sqrt(2.0)))  # where AF meets LM: 54.7 [degree]

# name, alpha, beta [degree]; in parentheses the mirror image of a region
NAMES = (
    ("I", 68.0, 9.0),
    ("IIa", 42.0, -17.0),
    ("IIb", 80.0, -68.0),
    ("(I)", 10.0, 50.0),
    ("(IIa)", 10.0, -62.0),
    ("(IIb)", 45.0, -77.0),
)
# designs whose way is drawn (alpha, beta) [degree]
STARTS = (
    (20.0, -20.0),
    (50.0, -10.0),
    (60.0, 25.0),
    (30.0, 10.0),
    (80.0, 45.0),
    (85.0, -45.0),
    (78.0, -78.0),
    (10.0, -50.0),
    (45.0, -85.0),
)


def _halo(width):
    return [withStroke(linewidth=width, foreground=style.PAPER, alpha=0.85)]


def draw_lines(ax: Axes) -> Line2D:
    """Draws AF, DF, the locked manifold and the names on a map of alpha and beta [degree]; returns the manifold."""
    thin = {"color": style.INK, "linewidth": 0.9, "zorder": 4}
    ax.plot([0.0, 90.0], [0.0, -90.0], linestyle=(0, (6, 2)), gid="AF", **thin)
    ax.plot([0.0, 90.0], [0.0, 90.0], linestyle=(0, (6, 2, 1, 2)), gid="DF", **thin)
    ax.axhline(0.0, color=style.INK, linewidth=0.5, zorder=3)
    alpha = np.linspace(0.0, 90.0, 361)
    (manifold,) = ax.plot(
        alpha, closed_form.locked_manifold(alpha), color=style.LOCKED, linewidth=2.0, gid="LM", zorder=5,
        label=r"locked manifold LM: $\tan\alpha\,\tan\beta=-2$", path_effects=_halo(3.4),
    )  # fmt: skip
    ax.plot(UNDEFORMABLE, -UNDEFORMABLE, "o", markersize=4.5, color=style.LOCKED, zorder=5)
    for name, x, y, colour in (
        (f"{UNDEFORMABLE:.1f}°", 54.5, -63.0, style.LOCKED),
        ("AF", 30.0, -37.5, style.INK),
        ("DF", 76.0, 69.0, style.INK),
        ("LM", 30.0, -70.0, style.LOCKED),
    ):
        ax.text(x, y, name, color=colour, ha="center", va="center", weight="bold", path_effects=_halo(2.5), zorder=7)
    for name, x, y in NAMES:
        size = style.LARGE if name.startswith("(") else style.LARGE + 3.0
        how = {"color": style.INK, "ha": "center", "va": "center"}  # over light colours, whatever the user's style
        ax.text(x, y, name, fontsize=size, path_effects=_halo(2.5), zorder=7, **how)
    return manifold


def path(alpha: float, beta: float) -> tuple[np.ndarray, np.ndarray]:
    """Fiber angles ``(alpha', beta')`` [degree] of a uniform tube of inextensible fibers, from rest to locked."""
    return closed_form.uniform_state(alpha, beta, np.linspace(1.0, closed_form.locked_stretch(alpha, beta), 201))[2:]


def draw_paths(ax: Axes) -> list[Line2D]:
    """Draws the way of STARTS into the locked manifold, each with an arrow head on it."""
    lines = []
    for start in STARTS:
        x, y = path(*start)
        (line,) = ax.plot(x, y, color=style.INK, linewidth=0.8, gid="path", zorder=4.5, path_effects=_halo(2.0))
        ax.plot(*start, "o", zorder=6, **style.DESIGN)
        way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        tip = np.searchsorted(way, 0.6 * way[-1])
        ax.annotate(
            "",
            (x[tip], y[tip]),
            (x[tip - 1], y[tip - 1]),
            arrowprops={"arrowstyle": "-|>,head_length=0.35,head_width=0.16", "color": style.INK, "linewidth": 0.8},
            zorder=6,
        )
        lines.append(line)
    lines[0].set_label("fiber angles under pressure (uniform tube)")
    return lines

"""Several shapes of one actuator below each other, to one scale: undeformed on top, then deformed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from ..description.actuator import Actuator
from . import style
from .shape import draw_shape, project, shape_of

if TYPE_CHECKING:
    import xarray as xr

WIDTH = style.PAGE  # of a figure of its own [mm]
MARGIN = 0.02  # beside a shape, over its length
DASHED = {"loose": "slack threads", "bonded": "fibers that would push"}


class _Layout(NamedTuple):
    """Shapes below each other in one window [mm of data]; ``words`` is the height of two lines of type."""

    left: float
    right: float
    bottom: float
    lifts: tuple
    words: float

    @property
    def span(self):
        return (self.right - self.left) * (1.0 + 2.0 * MARGIN)


def _layout(shapes):
    left = min(float(np.min(project(shape, 0.0)[0])) for shape in shapes)
    right = max(float(np.max(project(shape, np.pi)[0])) for shape in shapes)
    words = 2.0 * style.LARGE / 72.0 * style.INCH * (right - left) * (1.0 + 2.0 * MARGIN) / (WIDTH - 12.0)
    lifts, bottom = [], 0.0
    for shape in shapes:
        lifts.append(bottom - words - shape.radius.max())
        bottom = lifts[-1] - shape.radius.max() - 0.35 * words
    return _Layout(left, right, bottom, tuple(lifts), words)


def size_of(tube: Actuator, *states) -> tuple[float, float]:
    """Width and height [mm] of the figure that :func:`shape_plot` fills."""
    layout = _layout([shape_of(tube), *(shape_of(tube, state) for state in states)])
    return WIDTH, -layout.bottom / layout.span * (WIDTH - 4.0) + 14.0


def shape_plot(tube: Actuator, *states: xr.Dataset, titles: Sequence[str] = (), ax: Axes | None = None) -> Axes:
    """The undeformed actuator on top, in blue, and below it each of ``states`` in red; returns the Axes.

    A state is a Dataset of one load, from ``lock``, ``inflate``, ``blocked_force`` or the like; ``titles`` names each.
    Lengths along the axis and across are drawn to one scale. Raises ValueError, see :func:`shape_of`.
    """
    shapes = [shape_of(tube), *(shape_of(tube, state) for state in states)]
    names = ["undeformed", *titles, *["deformed"] * (len(states) - len(titles))]
    layout = _layout(shapes)
    with style.context():
        ax = style.new_axes(*size_of(tube, *states)) if ax is None else ax
        fibers = ["bonded", *(state.attrs.get("fibers", "bonded") for state in states)]  # of each its own
        for k, (shape, lift, name) in enumerate(zip(shapes, layout.lifts, names)):
            draw_shape(ax, shape, style.AFTER if k else style.BEFORE, lift)
            slack = f", dashed: {DASHED[fibers[k]]}" if np.any(shape.slack) else ""
            _name(ax, shape, name, layout.left, lift + shape.radius.max() + 0.25 * layout.words, k, slack)
        _name_families(ax, tube, layout.right, layout.lifts[0] + shapes[0].radius.max() + 0.25 * layout.words)
        margin = MARGIN * (layout.right - layout.left)
        ax.set(xlim=(layout.left - margin, layout.right + margin), ylim=(layout.bottom, 0.0), aspect="equal")
        ax.set_xlabel("axial position [mm], radii to the same scale")
        ax.yaxis.set_visible(False)
        ax.spines[["left", "top", "right"]].set_visible(False)
    return ax


def _name(ax, shape, name, left, height, deformed, more):
    turned = np.degrees(shape.twist[-1])
    size = f": {shape.position[-1] - shape.position[0]:.1f} mm long, {2.0 * shape.radius.max():.1f} mm across"
    size += f", turned by {turned:.0f}°".replace("-", "\N{MINUS SIGN}") if abs(turned) >= 0.5 else ""
    size += more
    colour = (style.AFTER if deformed else style.BEFORE)[0]
    head = ax.text(left, height, name, color=colour, fontweight="bold", gid="name")
    ax.annotate(size, (1.0, 0.0), xycoords=head, color=colour, va="bottom", annotation_clip=False, gid="size")


def _name_families(ax, tube, right, height):
    """The angles of both families in their colours, at the right."""
    words = []
    for name, angles in zip((r"$\alpha$", r"$\beta$"), tube.angles(np.linspace(0.0, 1.0, 257))):
        if np.all(np.isnan(angles)):
            words.append("")
            continue
        first, last = (f"{round(angle, 1) + 0.0:g}°".replace("-", "\N{MINUS SIGN}") for angle in angles[[0, -1]])
        words.append(f"{name} = {first}" if np.ptp(angles) == 0.0 else f"{name} from {first} to {last}")
    beta = ax.text(right, height, words[1], color=style.BEFORE[1], ha="right", gid="family")
    ax.annotate(words[0] + "   ", (0.0, 0.0), xycoords=beta, color=style.BEFORE[0], ha="right", va="bottom",
                annotation_clip=False, gid="family")  # fmt: skip

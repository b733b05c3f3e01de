"""Little drawings of actuators with their two families of fibers, and the examples that stand on the design map."""

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.offsetbox import AnnotationBbox, DrawingArea, TextArea, VPacker
from matplotlib.patches import Ellipse, Rectangle

from . import style

LENGTH, RADIUS = 40.0, 6.5  # of a drawn tube [points]
SPACING = 5.0  # between the fibers of a family [points]
CAP = 2.2  # half width of an end seen at a slant [points]

# (alpha, beta) of a design and where its drawing stands, all [degree]
EXAMPLES = (
    ((25.0, 60.0), (16.0, 76.0)),
    ((45.0, 45.0), (39.0, 62.0)),
    ((60.0, 25.0), (63.0, 41.0)),
    ((20.0, -20.0), (11.0, -34.0)),
    ((50.0, -10.0), (43.0, 9.5)),
    ((85.0, -45.0), (73.0, -52.0)),
    ((78.0, -78.0), (62.0, -80.5)),
)


def tube(alpha: float, beta: float) -> DrawingArea:
    """A tube, axis to the right, with the front halves of its fibers at ``alpha`` and ``beta`` [degree]."""
    area = DrawingArea(LENGTH + 2.0 * CAP, 2.0 * RADIUS)
    edge = {"edgecolor": style.QUIET, "linewidth": 0.5}
    left, right = CAP, CAP + LENGTH
    area.add_artist(Ellipse((left, RADIUS), 2.0 * CAP, 2.0 * RADIUS, facecolor="#f4f2ee", **edge))
    strips = np.linspace(-1.0, 1.0, 14)
    for low, high in pairwise(strips):  # light from above
        shade = 0.97 - 0.16 * (0.5 * (low + high) - 0.35) ** 2
        box = ((left, RADIUS * (1.0 + low)), LENGTH, RADIUS * (high - low))
        area.add_artist(Rectangle(*box, facecolor=(shade, shade, 0.985 * shade), edgecolor="none", antialiased=False))
    for angle, colour in zip((beta, alpha), reversed(style.FAMILIES)):
        for x, y in _front(angle):
            area.add_artist(Line2D(left + x, RADIUS + y, color=colour, linewidth=0.9, solid_capstyle="butt"))
    for y in (0.0, 2.0 * RADIUS):
        area.add_artist(Line2D([left, right], [y, y], color=style.QUIET, linewidth=0.5))
    area.add_artist(Ellipse((right, RADIUS), 2.0 * CAP, 2.0 * RADIUS, facecolor="#dedbd4", **edge))
    return area


def _front(angle):
    """The visible pieces (x, y) [points] of one family on a tube of LENGTH and RADIUS."""
    turn = np.tan(np.radians(angle)) / RADIUS  # [radian per point]
    fibers = max(1, round(2.0 * np.pi * RADIUS * np.cos(np.radians(angle)) / SPACING))
    x = np.linspace(0.0, LENGTH, 400)
    for start in 2.0 * np.pi * (np.arange(fibers) + 0.5) / fibers:
        phase = start + turn * x
        hidden = np.flatnonzero(np.diff(np.cos(phase) > 0.0)) + 1
        for piece in np.split(np.arange(x.size), hidden):
            if np.cos(phase[piece[len(piece) // 2]]) > 0.0:
                yield x[piece], RADIUS * np.sin(phase[piece])


def draw_examples(ax: Axes) -> list[AnnotationBbox]:
    """Draws EXAMPLES on a map of alpha and beta [degree], each joined to its design."""
    cards = []
    for (alpha, beta), place in EXAMPLES:
        angles = f"{alpha:.0f}°, {beta:.0f}°".replace("-", "\N{MINUS SIGN}")
        words = TextArea(angles, textprops={"fontsize": style.points(style.SMALL - 0.5), "color": style.INK})
        card = AnnotationBbox(
            VPacker(children=[tube(alpha, beta), words], align="center", pad=0.0, sep=2.5),
            (alpha, beta),
            xybox=place,
            boxcoords="data",
            pad=0.25,
            bboxprops={"boxstyle": "round,rounding_size=0.3", "linewidth": 0.4, "edgecolor": style.QUIET},
            arrowprops={"arrowstyle": "-", "linewidth": 0.6, "color": style.INK, "shrinkB": 2.0},
            zorder=6,
        )
        cards.append(ax.add_artist(card))
        ax.plot(alpha, beta, "o", zorder=6, **style.DESIGN)
    return cards

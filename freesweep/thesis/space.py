"""Figures 1-2 and 2-4: the design space of fiber angles, and where locked actuators lie in it."""

import numpy as np
from matplotlib.ticker import MultipleLocator

from .. import closed_form
from ..plot import glyph, regions, style
from ..statics import lock
from .drawing import Drawing, Numbers, key, panels
from .prototypes import RADIUS, RUBBER, WALL, source_tube

TINTS = {"I": "#f6efe0", "IIa": "#e6f0ef", "IIb": "#eee8f3"}
# four designs of Figure 2-4, one from each part of the space: the source does not print its own
FOUR = ((20.0, -20.0), (45.0, 10.0), (50.0, -10.0), (85.0, -45.0))
LENGTH = 0.2  # [m]


def _space(ax):
    """Tints of the regions, and axes in degrees."""
    alpha = np.linspace(0.0, 90.0, 181)
    manifold = closed_form.locked_manifold(alpha)
    for name, low, high in (("I", 0.0, 90.0), ("IIa", manifold, 0.0), ("IIb", -90.0, manifold)):
        ax.fill_between(alpha, low, high, color=TINTS[name], linewidth=0.0, zorder=0, gid=f"region {name}")
    ax.set(xlim=(0.0, 90.0), ylim=(-90.0, 90.0))
    ax.set_xlabel(r"fiber angle $\alpha$ [degree]")
    ax.set_ylabel(r"fiber angle $\beta$ [degree]")
    ax.xaxis.set_major_locator(MultipleLocator(15.0))
    ax.yaxis.set_major_locator(MultipleLocator(30.0))


def figure_1_2() -> Drawing:
    """Design space with its regions and the way of some designs under pressure."""
    figure, ax = panels(style.PAGE * 0.8, 160.0)
    numbers = Numbers()
    with style.context():
        _space(ax)
        manifold = regions.draw_lines(ax)
        numbers.add(curve="LM", alpha=manifold.get_xdata(), beta=manifold.get_ydata())
        for start, path in zip(regions.STARTS, regions.draw_paths(ax)):
            name = f"{start[0]:g}/{start[1]:g}"
            numbers.add(curve=name, alpha=path.get_xdata(), beta=path.get_ydata())
        glyph.draw_examples(ax)
    entries = [
        (r"locked manifold LM: $\tan\alpha\,\tan\beta=-2$", {"color": style.LOCKED, "linewidth": 2.0}),
        ("fiber angles under pressure", {"linewidth": 0.8}),
        (r"fibers at $\alpha$", {"color": style.FAMILIES[0], "linewidth": 1.0}),
        (r"fibers at $\beta$", {"color": style.FAMILIES[1], "linewidth": 1.0}),
    ]
    key(figure, entries, 2)
    note = (
        "I swells and rotates, first longer, then shorter; IIa swells, shortens and rotates; IIb thins, "
        "lengthens and rotates. In parentheses: the mirror images."
    )
    return Drawing(figure, numbers, note)


def figure_2_4() -> Drawing:
    """Fiber angles before and after locking, exact curvilinear shape."""
    figure, ax = panels(style.PAGE * 0.62, 120.0)
    numbers = Numbers()
    with style.context():
        _space(ax)
        alpha = np.linspace(0.0, 90.0, 361)
        ax.plot(alpha, closed_form.locked_manifold(alpha), color=style.LOCKED, linewidth=1.6, zorder=2, gid="LM")
        for design in FOUR:
            tube = source_tube(
                alpha=design[0], beta=design[1], length=LENGTH, radius=RADIUS, wall=WALL, material=RUBBER
            )
            state = lock(tube, x=0.5 * LENGTH * (1.0 - np.cos(np.linspace(0.0, np.pi, 401))))  # dense where it bends
            after = state["alpha_deformed"].values, state["beta_deformed"].values
            middle = len(after[0]) // 2
            ax.plot(*after, color=style.AFTER[1], linewidth=style.THIN, zorder=3, gid="along the tube")
            ax.plot(*design, "o", color=style.BEFORE[0], markersize=5.0, zorder=4, gid="before")
            ax.plot(
                after[0][middle], after[1][middle], "o", color=style.AFTER[0], markersize=5.0, zorder=4, gid="after"
            )
            numbers.add(design=f"{design[0]:g}/{design[1]:g}", x=state["x"].values, alpha_deformed=after[0],
                        beta_deformed=after[1])  # fmt: skip
    dot = {"marker": "o", "linestyle": "none", "markersize": 5.0}
    key(figure, [
        ("locked manifold", {"color": style.LOCKED}),
        ("undeformed", {"color": style.BEFORE[0], **dot}),
        ("locked, middle of the tube", {"color": style.AFTER[0], **dot}),
        ("locked, from there to the clamped ends", {"color": style.AFTER[1], "linewidth": style.THIN}),
    ], 2)  # fmt: skip
    note = (
        "Tubes of 200 mm. The angles lie on the manifold in the middle; toward the clamped ends, which keep "
        "their radius, they return to the undeformed ones."
    )
    return Drawing(figure, numbers, note)

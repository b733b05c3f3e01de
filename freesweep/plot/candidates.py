"""Candidates of an inverse design on one page: where they lie among all angles, what they do, and their shapes."""

import textwrap

import numpy as np
from matplotlib.figure import Figure

from ..report import FAMILIES, SHOWN, THREADS
from . import style
from .display import axis_label, shown_units
from .labels import label_points

SIZE = (style.PAGE, 120.0)  # [mm]
MOST = 5  # candidates that have a colour of their own
WIDTH = 100  # letters of a line
MARGIN, AROUND = 3.0, 0.12  # around the angles of all candidates: [degree], at least, and of what they range over
LINE = 4.5  # [mm] from one line of words to the next
HELD = {"": "free", "force": "held in length", "torque": "held from turning"}


def draw(found, curves, shapes) -> Figure:
    """A figure of the candidates in ``found`` (of :func:`freesweep.design`), of what they do and how they look
    (:mod:`freesweep.inverse.shown`).
    """
    with style.context():
        figure = style.new_figure(*SIZE)
        names = [f"curve {k}" for k in range(len(curves))]
        axes = figure.subplot_mosaic([["angles", *names], ["shapes"] * (1 + len(names))], height_ratios=(3, 2))
        _draw_angles(axes["angles"], found)
        for name, curve in zip(names, curves):
            _draw_curve(axes[name], curve)
        _draw_shapes(axes["shapes"], shapes, found)
        figure.suptitle(
            "\n".join(textwrap.wrap(found.attrs["summary"], WIDTH)), fontsize=style.points(style.NORMAL + 1)
        )
        if "knot" not in found.dims:
            points, count = np.column_stack([found["alpha"].values, found["beta"].values]), found.sizes["candidate"]
            label_points(axes["angles"], points, [str(k) for k in range(count)], [_colour(k) for k in range(count)])
    return figure


def _colour(k):
    return style.SERIES[k % len(style.SERIES)] if k < MOST else style.QUIET


def _threads(found, k):
    """Which families are slack in a candidate, or would push: a word, "" for none."""
    flag = int(found["slack_fiber"].values[k])
    return f"{FAMILIES[flag]} {THREADS[found.attrs['fibers']][0]}".lstrip() if flag else ""


def _draw_angles(ax, found):
    """Both angles of each candidate as a point; over the tube, where they vary along it."""
    met = found["met"].values
    words = {"fontsize": style.points(style.NORMAL), "loc": "left"}
    said = ["filled: meets all" if met.any() else "none meets all"]
    if (found["slack_fiber"].values > 0).any():
        said.append(f"square: threads {THREADS[found.attrs['fibers']][0]}")
    if "knot" in found.dims:
        for k in range(min(len(met), MOST)):
            for name, line in (("alpha", "-"), ("beta", "--")):
                _draw_along(ax, found, name, k, linestyle=line)
        style.dress(ax, "place along the tube, x/l", "fiber angle [degree]")
        ax.set_title("solid: alpha, dashed: beta", **words)
        return
    alpha, beta = found["alpha"].values, found["beta"].values
    for k, fine in enumerate(met):
        colour, mark = _colour(k), "s" if found["slack_fiber"].values[k] else "o"
        ax.plot(alpha[k], beta[k], mark, color=colour, markerfacecolor=colour if fine else style.PAPER, markersize=5)
    style.dress(ax, axis_label("alpha"), axis_label("beta"))
    ax.set_title("; ".join(said), **words)
    for limit, angles in ((ax.set_xlim, alpha), (ax.set_ylim, beta)):
        margin = max(MARGIN, AROUND * np.ptp(angles))
        limit(angles.min() - margin, angles.max() + margin)


def _draw_along(ax, found, name, k, **how):
    if "knot" in found[name].dims:
        places, values = found[f"{name}_place"].values, found[name].values[k]
    else:
        places, values = [0.0, 1.0], np.repeat(found[name].values[k], 2)
    ax.plot(places, values, color=_colour(k), marker="o", markersize=3, **how)


def _draw_curve(ax, curve):
    """An output over the pressure, or what is held, of each candidate, and what was asked for."""
    _, across = shown_units(curve.along)
    unit, up = SHOWN.get(curve.unit, (curve.unit, 1.0))
    for k, values in enumerate(curve.values):
        ax.plot(across * curve.at, up * values, color=_colour(k), linewidth=style.THICK)
    for at, low, high in curve.asked:
        ends = [end for end in (low, high) if np.isfinite(end)]  # of one alone: an arrow to where it shall be
        one = "^" if np.isfinite(low) else "v"
        mark = one if len(ends) == 1 else "D" if low == high else "none"  # of a range no place is better than others
        ax.errorbar(across * at, up * np.mean(ends), yerr=0.5 * up * np.ptp(ends), fmt=mark, color=style.INK,
                    markersize=4 if mark == "D" else 6, markerfacecolor=style.PAPER, ecolor=style.INK,
                    elinewidth=style.THIN, capsize=0 if mark == one else 3, zorder=5)  # fmt: skip
    unit = "degree" if unit == "deg" else unit  # as at the other axes
    label = f"{curve.output.replace('_', ' ')} [{unit}]".removesuffix(" [1]")
    style.dress(ax, axis_label(curve.along), label)


def _draw_shapes(ax, shapes, found):
    """Each candidate from the side, at rest in grey and under pressure."""
    step = 0.0
    longest = max((np.nanmax(np.append(shape.position, shape.rest[0])) * 1e3 for shape in shapes), default=0.0)
    line = LINE * longest / SIZE[0]  # as high as a line of words, where the longest is as wide as the page
    for k, shape in enumerate(shapes):
        x, r = shape.position * 1e3, shape.radius * 1e3
        half = max(1.15 * max(np.nanmax(r, initial=0.0), shape.rest[1] * 1e3), 0.5 * line)
        step += half
        for side in (-1.0, 1.0):
            ax.plot([0.0, shape.rest[0] * 1e3], [side * shape.rest[1] * 1e3 - step] * 2, color=style.BLANK, linewidth=2)
        ax.fill_between(x, -step - r, -step + r, color=_colour(k), alpha=0.55, linewidth=0)
        end = np.nanmax(np.append(x, shape.rest[0] * 1e3))
        said = f"{k}: {shape.rotation:.0f}\u00b0".replace(": -0\u00b0", ": 0\u00b0")
        rubber = str(found["material"].values[k]) if "material" in found else ""
        said = ", ".join(filter(None, (said, rubber, _threads(found, k))))
        ax.annotate(said, (end, -step), (6, -3), textcoords="offset points", color=style.legible(_colour(k)))
        step += half
    held = HELD[shapes[0].held] if shapes else ""
    state = f"; colour: {held} at {shapes[0].pressure / 1e3:g} kPa" if shapes else ""
    ax.set(xlabel=f"axial position [mm] (grey: at rest{state})", yticks=[], aspect="equal")
    ax.margins(x=0.08)
    for side in ("left", "right", "top"):
        ax.spines[side].set_visible(False)

"""Candidates of an inverse design on one page: where they lie among all angles, what they do, and their shapes."""

import math

import numpy as np
from matplotlib.figure import Figure

from . import style
from .display import axis_label

SIZE = (style.PAGE, 120.0)  # [mm]
MOST = 5  # candidates that are drawn in full
PRESSURES, BEYOND = 61, 1.25  # of a curve, up to so many times the pressure that was asked for
ROUGH = 1e-5  # accuracy of curves
LOADS = ("pressure", "force", "torque")


def draw(found, goals, tubes) -> Figure:
    """A figure of the candidates in ``found`` (of :func:`freesweep.design`), of the ``goals`` that were asked for and of the
    actuators themselves (:func:`freesweep.inverse.candidates.actuators`).
    """
    tubes = tubes[:MOST]
    with style.context():
        figure = Figure(figsize=(SIZE[0] / style.INCH, SIZE[1] / style.INCH), layout="constrained")
        shown = [goal for goal in goals if goal.pressure is not None][:2] or list(goals)[:1]
        axes = figure.subplot_mosaic([["angles", *[f"goal {k}" for k in range(len(shown))]], ["shapes"] * (1 + len(shown))],
                                     height_ratios=(3, 2))  # fmt: skip
        _draw_angles(axes["angles"], found)
        for k, goal in enumerate(shown):
            _draw_goal(axes[f"goal {k}"], goal, tubes, found)
        _draw_shapes(axes["shapes"], tubes, found, shown)
        figure.suptitle(_wrapped(found.attrs["summary"]), fontsize=style.NORMAL + 1)
    return figure


def _colour(k):
    return style.SERIES[k % len(style.SERIES)] if k < MOST else style.QUIET


def _draw_angles(ax, found):
    alpha, beta = (_middle(found[name]) for name in ("alpha", "beta"))
    met = found["met"].values
    for k in range(len(met)):
        colour = _colour(k)
        ax.plot(alpha[k], beta[k], "o", color=colour, markerfacecolor=colour if met[k] else style.PAPER, markersize=5)
        ax.annotate(str(k), (alpha[k], beta[k]), (4, 3), textcoords="offset points", color=colour)
    low, high = min(0.0, alpha.min() - 5), max(alpha.max() + 8, 20)
    ax.set(xlabel=axis_label("alpha"), ylabel=axis_label("beta"), xlim=(low, high))
    ax.set_ylim(min(beta.min() - 8, -10), max(beta.max() + 8, 10))
    ax.set_title("filled: meets all" if met.any() else "none meets all", fontsize=style.NORMAL)


def _middle(variable):
    return variable.values if variable.ndim == 1 else variable.values[:, variable.shape[1] // 2]


def _draw_goal(ax, goal, tubes, found):
    """The goal's output over the pressure, of each candidate, and what was asked for."""
    from ..inverse.predict import state_of
    from ..inverse.singles import solve_single
    from ..inverse.wishes import UNITS

    wishes = goal.wishes([])
    asked = [p for p in _pressures(goal) if math.isfinite(p)] or found["pressure"].values.tolist()
    grid = np.linspace(0.0, BEYOND * max(asked), PRESSURES)[1:]
    first = state_of(wishes[0])
    rest = tuple(item for item in first.conditions if item[0] != "pressure")
    states = [first._replace(conditions=(*rest, ("pressure", p))) for p in grid.tolist()]
    for k, tube in enumerate(tubes):
        design = tube.design() | {name: float(found[name].values[k]) if name in found else 0.0 for name in LOADS}
        answers = solve_single(tube, {state: [goal.output] for state in states}, design, ROUGH)
        curve = [answers[state][goal.output][0] for state in states]
        ax.plot(grid / 1e3, curve, color=_colour(k), linewidth=style.THICK)
    for wish, p in zip(wishes, _pressures(goal)):
        ends = [end for end in (wish.low, wish.high) if math.isfinite(end)]
        ax.errorbar(p / 1e3, np.mean(ends), yerr=0.5 * (max(ends) - min(ends)), fmt="D", color=style.INK, markersize=4,
                    markerfacecolor=style.PAPER, capsize=3, zorder=5)  # fmt: skip
    ax.set(xlabel="pressure [kPa]", ylabel=f"{goal.output.replace('_', ' ')} [{UNITS.get(goal.output, '')}]")


def _pressures(goal):
    return [dict(wish.conditions).get("pressure", math.nan) for wish in goal.wishes([])]


def _draw_shapes(ax, tubes, found, goals):
    """Each candidate from the side, at rest in grey and under the pressure of the first goal."""
    from ..statics import inflate

    finite = [p for goal in goals for p in _pressures(goal) if math.isfinite(p)]
    step = 0.0
    for k, tube in enumerate(tubes):
        pressure = finite[0] if finite else float(found["pressure"].values[k]) if "pressure" in found else 0.0
        state = inflate(tube, pressure)
        x, r = state["axial_position"].values * 1e3, state["deformed_radius"].values * 1e3
        half = 1.15 * max(np.nanmax(r) if np.isfinite(r).any() else 0.0, tube.fiber_surface * 1e3)
        step += half
        for side in (-1.0, 1.0):
            ax.plot(
                [0.0, tube.length * 1e3], [side * tube.fiber_surface * 1e3 - step] * 2, color=style.BLANK, linewidth=2
            )
        ax.fill_between(x, -step - r, -step + r, color=_colour(k), alpha=0.55, linewidth=0)
        turn = float(state["rotation"]) if np.isfinite(state["rotation"]) else math.nan
        ax.annotate(f"{k}: {turn:.0f}\u00b0", (max(x[-1] if np.isfinite(x[-1]) else 0.0, tube.length * 1e3), -step), (6, -3),
                    textcoords="offset points", color=_colour(k))  # fmt: skip
        step += half
    state = f"colour: at {finite[0] / 1e3:g} kPa" if finite else "colour: under pressure"
    ax.set(xlabel=f"axial position [mm] (grey: at rest; {state})", yticks=[], aspect="equal")
    ax.margins(x=0.08)
    for side in ("left", "right", "top"):
        ax.spines[side].set_visible(False)


def _wrapped(text, width=100):
    import textwrap

    return "\n".join(textwrap.wrap(text, width))

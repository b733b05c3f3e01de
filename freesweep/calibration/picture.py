"""The picture of a calibration: each measured curve with the model's and its band, and what is left below it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ..atlas.schema import PARAMETERS
from ..plot import style
from ..plot.curve import LETTER, draw_line, label_ends
from .branches import curves_of
from .calibration import Calibration
from .measured import COLUMNS, Measurement
from .predicted import Predictor
from .report import USUAL

MOST = 2  # quantities beside each other
PLACES = 31  # of the model along a curve, beside those that were measured
HEIGHTS = (3.0, 1.0)  # of curves, and of what is left
WIDTH, HEIGHT, KEY = 0.5 * style.PAGE, 100.0, 8.0  # of one quantity, and of the key below all [mm]
ALONE = 1.4 * WIDTH  # one that has the page for itself [mm]
STEPS = (1, 2, 5, 10)  # from tick to tick
DOT = {"linestyle": "none", "marker": "o", "markersize": 3.2, "markeredgewidth": 0.8}
WORDS = ("alpha", "beta", "length", "radius", "wall", "fiber_extension")  # that tell actuators apart


def picture(found: Calibration, shown: dict = USUAL) -> Figure:
    """A pair of axes for each quantity of each measurement; units as :func:`.report.shown_as` finds them."""
    pairs = [(k, name) for k, m in enumerate(found.measurements) for name in m.measured]
    columns = min(len(pairs), MOST)
    rows = -(-len(pairs) // columns)
    figure = style.new_figure(WIDTH * columns if columns > 1 else ALONE, HEIGHT * rows + KEY)
    with style.context():
        axes = figure.subplots(2 * rows, columns, squeeze=False, height_ratios=HEIGHTS * rows)
        models = [between(found, k) for k in range(len(found.measurements))]
        for place, (k, name) in enumerate(pairs):
            row, column = divmod(place, columns)
            _draw(found, k, name, shown, models[k], *axes[2 * row : 2 * row + 2, column])
        for ax in axes[-2:, (len(pairs) - 1) % columns + 1 :].ravel():
            ax.remove()
        _key(figure, any(m.slack.any() for m in found.measurements))
    return figure


def png(found: Calibration, shown: dict = USUAL) -> bytes:
    """The same as a file for a page."""
    return style.drawn(picture(found, shown), Path("picture.png"), 150.0)


def between(found: Calibration, k: int) -> list:
    """The model along each curve of a measurement, between its states, too: ``(states, predicted)``, where ``states`` is a
    measurement of what was imposed there, and ``predicted`` (n, measured), NaN where the model has no state.
    """
    measurement, parameters = found.measurements[k], found.parameters
    curve, swept = curves_of(measurement)
    along = measurement.pressure if swept == "pressure" else measurement.imposed(swept)
    columns = {name: getattr(measurement, name) for name in ("pressure", *COLUMNS)}
    columns = {name: array for name, array in columns.items() if array is not None}
    setup = parameters.setups((found.values - parameters.offset) / parameters.unit)[k]
    made = []
    for number in np.unique(curve):
        rows = np.flatnonzero(curve == number)
        rows = rows[np.argsort(along[rows], kind="stable")]
        places = np.union1d(along[rows], np.linspace(along[rows[0]], along[rows[-1]], PLACES))
        states = replace(
            measurement, **{name: np.interp(places, along[rows], array[rows]) for name, array in columns.items()},
            contraction=None, stroke=None, length_as=measurement.length_as, sigma={}, branch=None, half_width={},
        )  # fmt: skip
        made.append((states, _predicted(states, setup)))
    return made


def _predicted(states, setup):
    """What the model says of states (n, measured); of pushes that nobody measured, which are told roughly only, nothing."""
    predictor = Predictor([states])
    predictor.settle([setup])
    ((predicted,),) = predictor.predict([[setup]])
    if "force" in states.measured:
        force = predicted[:, states.measured.index("force")]
        force[(force < 0.0) & (states.force >= 0.0)] = np.nan
    return predicted


def _draw(found, k, name, shown, models, top, bottom):
    """One quantity of one measurement, curve by curve; ``models`` as of :func:`between`."""
    measurement = found.measurements[k]
    curve, swept = curves_of(measurement)
    across, place = axis(measurement, swept, shown)
    label, scaled = axis(measurement, name, shown)
    at = measurement.measured.index(name)
    along = place(measurement.pressure if swept == "pressure" else measurement.imposed(swept))
    value, model = scaled(getattr(measurement, name)), scaled(found.predicted[k][:, at])
    half = abs(scaled(found.quantile * found.sigma[name] + found.hysteresis.get(name, 0.0)) - scaled(0.0))
    slack = measurement.slack if name == "force" else np.zeros(len(measurement), bool)
    lines = []
    for number, colour, (states, predicted) in zip(np.unique(curve), style.ramp(curve.max() + 1), models):
        rows = np.flatnonzero(curve == number)
        rows = rows[np.argsort(along[rows], kind="stable")]
        x = place(states.pressure if swept == "pressure" else states.imposed(swept))
        lines.append(draw_line(top, x, scaled(predicted[:, at]), error=np.full(len(x), half), color=colour))
        for hangs, face in ((False, colour), (True, style.PAPER)):
            own = rows[slack[rows] == hangs]
            top.plot(along[own], value[own], color=colour, markerfacecolor=face, **DOT)
        left = np.where(slack, np.nan, value - model)[rows]
        bottom.plot(along[rows], left, color=colour, linewidth=style.THIN, **DOT | {"linestyle": "-"})
    style.dress(top, "", label)
    _head(top, label.partition(" [")[0].capitalize(), words_of(found, k, shown))
    top.tick_params(labelbottom=False)
    style.dress(bottom, across, f"measured\n\N{MINUS SIGN} model{label[label.index(' [') :]}")
    bottom.yaxis.label.set_linespacing(1.0)
    bottom.axhline(0.0, color=style.QUIET, linewidth=style.THIN)
    bottom.xaxis.set_major_locator(MaxNLocator(6, steps=STEPS))
    top.sharex(bottom)
    if len(lines) > 1:
        label_ends(top, lines, _names(measurement, curve, swept, shown))


def axis(measurement: Measurement, name: str, shown: dict = USUAL) -> tuple[str, Callable]:
    """What is written at an axis, and how numbers are shown there: lengths as they were given."""
    length = measurement.tube.length
    if name == "deformed_length" and measurement.length_as == "contraction":
        return "contraction [%]", lambda array: 100.0 * (1.0 - array / length)
    unit, scale = shown["Pa" if name == "pressure" else COLUMNS[name]]
    unit = "degree" if unit == "deg" else unit  # as at other axes
    if name == "deformed_length" and measurement.length_as == "stroke":
        return f"stroke [{unit}]", lambda array: (length - array) * scale
    return f"{name.replace('_', ' ')} [{unit}]", lambda array: array * scale


def words_of(found: Calibration, k: int, shown: dict = USUAL) -> list[str]:
    """What tells the actuator of a measurement, as it was found, from the others."""
    designs = [tube.design() for tube in found.tubes]
    differ = [name for name in WORDS if len({design[name] for design in designs}) > 1]
    words = []
    for name in differ:
        unit, scale = shown.get(PARAMETERS[name].units, ("", 1.0))
        words.append(f"{name.replace('_', ' ')} {scale * designs[k][name]:.4g} {unit}".rstrip())
    return words


def _head(ax, heading, words):
    """A heading, and words below it."""
    width = ax.get_position().width * ax.figure.bbox.width / ax.figure.dpi * style.INCH  # before the layout [mm]
    below = style.broken([word.replace("-", "\N{MINUS SIGN}") for word in words], width, LETTER)
    pad, size = 6.0 + style.points(9.0) * len(below), style.points(style.NORMAL + 1.0)
    ax.set_title(heading, loc="left", pad=pad, fontsize=size, fontweight="bold")
    ax.annotate("\n".join(below), (0.0, 1.0), xycoords="axes fraction", xytext=(0.0, 4.0), textcoords="offset points",
                color=style.QUIET, fontsize=style.points(style.SMALL), linespacing=1.0, gid="actuator")  # fmt: skip


def _names(measurement, curve, swept, shown):
    """What tells each curve from the others: what it was measured at."""
    other = (
        next((name for name in COLUMNS if _differs(measurement, name, curve)), "")
        if swept == "pressure"
        else "pressure"
    )
    if not other:
        return [""] * (curve.max() + 1)
    label, scaled = axis(measurement, other, shown)
    values = scaled(measurement.pressure if other == "pressure" else measurement.imposed(other))
    unit = label[label.index("[") + 1 : -1]
    return [f"{np.mean(values[curve == number]):.4g} {unit}" for number in np.unique(curve)]


def _differs(measurement, name, curve):
    """Whether the bench imposed another value on each curve."""
    imposed = None if name in measurement.measured else getattr(measurement, name)
    return imposed is not None and np.ptp([np.mean(imposed[curve == number]) for number in np.unique(curve)]) > 0.0


def _key(figure, hangs):
    """What lines, bands and marks mean."""
    ink = {"color": style.INK}
    handles = [
        Line2D([], [], label="measured", **ink, **DOT),
        Line2D([], [], label="model", linewidth=style.THICK, **ink),
        Patch(label="where 95 % of readings are expected", alpha=style.BAND, linewidth=0.0, **ink),
    ]
    if hangs:
        handles.append(Line2D([], [], label="slack muscle", **ink, **DOT, markerfacecolor=style.PAPER))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))

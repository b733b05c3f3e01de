"""A calibration as one page that people send around: HTML with its picture inside, or the picture."""

import base64
import html
import io

import numpy as np

from ..description.python_line import python_line
from ..report import SHOWN
from .branches import curves_of
from .measured import COLUMNS
from .report import USUAL, rows_of, told_rows

DOTS = 100  # per inch


def picture(found) -> bytes:
    """PNG: measured curves with the model's and its band, and residuals below."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    pairs = [(k, name) for k, m in enumerate(found.measurements) for name in m.measured]
    figure = Figure((4.6 * len(pairs), 5.6), dpi=DOTS, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(2, len(pairs), squeeze=False, sharex="col", height_ratios=(3, 1))
    for column, (k, name) in enumerate(pairs):
        _draw(found, k, name, *axes[:, column])
    content = io.BytesIO()
    figure.savefig(content, format="png", metadata={"Software": None})
    return content.getvalue()


def _draw(found, k, name, top, bottom):
    """One quantity of one measurement, curve by curve."""
    measurement = found.measurements[k]
    curve, swept = curves_of(measurement)
    axis, place = _axis(measurement, swept)
    label, shown = _axis(measurement, name)
    along = place(measurement.pressure if swept == "pressure" else measurement.imposed(swept))
    value, predicted = getattr(measurement, name), found.predicted[k][:, measurement.measured.index(name)]
    half = found.quantile * found.sigma[name] + found.hysteresis.get(name, 0.0)
    for number in np.unique(curve):
        rows = np.flatnonzero(curve == number)
        rows = rows[np.argsort(along[rows], kind="stable")]
        x, y, model = along[rows], shown(value[rows]), shown(predicted[rows])
        (line,) = top.plot(x, model, "-", linewidth=1.2, label=_label(found, k, swept, rows))
        ends = shown(predicted[rows] - half), shown(predicted[rows] + half)
        top.fill_between(x, *ends, color=line.get_color(), alpha=0.15, linewidth=0)
        slack = measurement.slack[rows] & (name == "force")
        top.plot(x[~slack], y[~slack], "o", color=line.get_color(), markersize=3.5)
        top.plot(x[slack], y[slack], "o", color=line.get_color(), markersize=3.5, fillstyle="none")
        bottom.plot(x, np.where(slack, np.nan, y - model), "o-", color=line.get_color(), markersize=3, linewidth=0.6)
    bottom.axhline(0.0, color="0.5", linewidth=0.8)
    top.set_ylabel(label)
    bottom.set_ylabel(f"measured\n- model {label[label.index('[') :]}")
    bottom.set_xlabel(axis)
    top.legend(fontsize="small", frameon=False)


def _axis(measurement, name):
    """What is written at an axis, and how numbers are shown there: lengths as they were given."""
    length = measurement.tube.length
    if name == "deformed_length" and measurement.length_as == "contraction":
        return "contraction [%]", lambda array: 100.0 * (1.0 - array / length)
    unit, scale = SHOWN["Pa" if name == "pressure" else COLUMNS[name]]
    if name == "deformed_length" and measurement.length_as == "stroke":
        return f"stroke [{unit}]", lambda array: (length - array) * scale
    return f"{name.replace('_', ' ')} [{unit}]", lambda array: array * scale


def _label(found, k, swept, rows):
    """What a curve is told from others by: of what was found, not of the first guess."""
    if swept == "pressure":
        return f"alpha {found.tubes[k].design()['alpha']:.3g} deg"
    return f"{np.mean(found.measurements[k].pressure[rows]) * 1e-3:.4g} kPa"


def page(found, shown=USUAL) -> str:
    """The page as HTML."""
    image = base64.b64encode(picture(found)).decode()
    verdict, *others = found.notes
    verdict = f"{verdict[0].upper()}{verdict[1:]}."
    parts = [
        "<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><title>Calibration</title><style>",
        "body{font:15px/1.45 sans-serif;max-width:70em;margin:2em auto;padding:0 1em}table{border-collapse:collapse}",
        "td,th{padding:.2em .8em;text-align:right;border-bottom:1px solid #ccc}",
        "td:first-child,th:first-child{text-align:left}",
        "pre{background:#f4f4f4;padding:.8em;overflow:auto}img{max-width:100%}</style></head><body><h1>Calibration</h1>",
        f"<p><strong>{html.escape(verdict)}</strong></p>",
        "<h2>What was found</h2>", _table(rows_of(found, shown)),
        "<h2>How well it is met</h2>", _table(told_rows(found, shown)),
        f"<h2>Curves</h2><img alt='curves and residuals' src='data:image/png;base64,{image}'>",
        "<p>Lines: the model; bands: where 95 % of readings are expected, with half of what parts the branches of loops;"
        " rings: slack muscles. Below: what is left.</p>",
        "<h2>What a reader has to know</h2><ul>", *(f"<li>{html.escape(note)}</li>" for note in others), "</ul>",
    ]  # fmt: skip
    for number, tube in enumerate(dict.fromkeys(found.tubes), 1):
        parts += [f"<h2>Actuator {number}</h2>", f"<pre>{html.escape(as_toml(found, tube))}</pre>"]
        parts.append(f"<pre>{html.escape(python_line(tube))}</pre>")
    return "".join(parts) + "</body></html>\n"


def as_toml(found, tube) -> str:
    """The calibrated actuator as a table of TOML; what is dead of the length is no part of it."""
    lines = ["[actuator]"]
    for name in ("alpha", "beta", "length", "radius", "wall", "fiber_extension"):
        lines.append(f"{name} = {_toml(getattr(tube, name))}")
    for name, value in (("fiber_radius", tube.fiber_radius), ("wall_model", tube.wall_model), ("fibers", tube.fibers)):
        if value is not None:
            lines.append(f"{name} = {_toml(value)}")
    lines += [f"model = {_toml(tube.model)}", f"energy = {_toml(tube.energy)}"]
    lines += [f"{name} = {getattr(tube.material, name)!r}" for name in ("c10", "c01", "c20", "c30")
              if getattr(tube.material, name) != 0.0]  # fmt: skip
    if found.dead_length or found.threshold_pressure:
        lines.append(f"# of the bench: dead_length = {found.dead_length:.6g} m (not in length),"
                     f" threshold_pressure = {found.threshold_pressure:.6g} Pa")  # fmt: skip
    return "\n".join(lines)


def _toml(value):
    if isinstance(value, str):
        return f'"{value}"'
    if callable(value):
        return '"a callable of x/l, see Python"'
    return repr([list(pair) for pair in value] if isinstance(value, tuple) else value)


def _table(rows):
    head, *body = rows
    made = ["<table><tr>", *(f"<th>{html.escape(cell)}</th>" for cell in head), "</tr>"]
    for row in body:
        made += ["<tr>", *(f"<td>{html.escape(cell)}</td>" for cell in row), "</tr>"]
    return "".join(made) + "</table>"

"""A calibration as one page that people send around: HTML with its picture inside."""

import base64
import html

from ..description.python_line import python_line
from .picture import png
from .report import USUAL, rows_of, told_rows


def page(found, shown=USUAL) -> str:
    """The page as HTML."""
    image = base64.b64encode(png(found, shown)).decode()
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

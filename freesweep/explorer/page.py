"""One HTML file with everything in it: BokehJS, figures, scripts, style, what is known of the atlas. It loads nothing."""

import html
import json
from importlib.resources import files

import numpy as np

from .. import __version__, closed_form
from ..atlas.schema import LOADS, PARAMETERS
from ..description.along import RULES
from ..description.units import known_units
from ..plot import regions, style
from ..report import THREADS
from .desk import sentences
from .measures import FLOORS, SYSTEMS, system_units

SCRIPTS = (
    "state", "units", "provider", "table", "picture", "map", "pins", "shape", "panels", "wishes", "front", "export",
    "controls", "keys", "main",
)  # fmt: skip
SHADES = 256
POLICY = "default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; script-src 'unsafe-inline' 'unsafe-eval'"


def page_of(desk, table=None, token="") -> str:
    """The page of an atlas: with a ``table`` (of :func:`freesweep.explorer.table.small_table`) it needs no server, without
    it asks the one it came from, which knows the ``token``.
    """
    from bokeh.embed import components
    from bokeh.resources import Resources

    from .figures import figures

    folder = files(__package__) / "page"
    script, places = components(figures(), wrap_script=False)
    own = "\n".join((folder / f"{name}.js").read_text(encoding="utf-8") for name in SCRIPTS)
    parts = {
        "TITLE": html.escape(f"{desk.reader.frame.title or desk.atlas.path.name} - freesweep"),
        "POLICY": POLICY + ("" if table else "; connect-src 'self'"),
        "STYLE": (folder / "style.css").read_text(encoding="utf-8"),
        "BOKEH": Resources(mode="inline", components=["bokeh"]).render_js(),
        "FACTS": _embedded(facts(desk) | {"token": token}),
        "TABLE": _embedded(table),
        "SCRIPT": f'(() => {{\n"use strict";\n{own}\n}})();',
        "FIGURES": script,
        **{f"FIGURE_{name}": place for name, place in places.items()},
    }
    text = (folder / "page.html").read_text(encoding="utf-8")
    for key, value in parts.items():
        text = text.replace(f"<!--{key}-->", value)
    return text


def _embedded(value) -> str:
    """JSON inside a script: no text of an atlas ends the script early."""
    return (
        json.dumps(value, allow_nan=False)
        .replace("<", "\\u003c")
        .replace("\u2028", "\\u2028")
        .replace("\u2029", "\\u2029")
    )


def facts(desk) -> dict:
    """What the page knows of the atlas from the beginning."""
    from .figures import HATCHES

    frame = desk.reader.frame
    fixed = {name: float(array[0]) for name, array in frame.values.items() if name in PARAMETERS and len(array) == 1}
    axes = {name: _axis(frame, name) for name in desk.axes}
    kinds = {unit for unit in (one.unit for one in desk.measures.values())} | {
        PARAMETERS[name].units for name in PARAMETERS
    }
    alpha = np.linspace(0.0, 90.0, 181)
    word, sentence = THREADS[frame.model.fibers]
    return {
        "title": frame.title, "file": desk.atlas.path.name, "version": __version__,
        "axes": axes, "fixed": fixed, "designs": desk.labels, "along": desk.along, "design_axes": desk.design_axes,
        "loads": [name for name in desk.axes if name in LOADS],
        "units_of": {name: parameter.units for name, parameter in PARAMETERS.items()},
        "model": {"energy": frame.energy, **frame.model._asdict()},
        "fiber_share": frame.fiber_share, "in_numbers": frame.in_numbers, "families": list(frame.families),
        "rules": {name: RULES[name] for name in frame.bodies.rules} if frame.bodies else {},
        "by_design": {name: frame.values[name].tolist() for name in frame.by_design if desk.labels},
        "measures": [one._asdict() for one in desk.measures.values()],
        "written": {unit: known_units(unit) for unit in sorted(kinds)},
        "systems": list(SYSTEMS), "units": {unit: system_units(unit) for unit in sorted(kinds)},
        "statuses": sentences(), "hatches": {str(kind): pattern for kind, pattern in HATCHES.items()},
        "slack": ["taut", *(f"{which} {word}" for which in ("alpha", "beta", "both"))], "slack_sentence": sentence,
        "floors": FLOORS,
        "colours": {
            "diverging": _shades(style.DIVERGING), "sequential": _shades(style.SEQUENTIAL), "series": style.SERIES[:5],
            "on_dark": style.ON_DARK,
            "families": style.FAMILIES, "before": style.BEFORE, "after": style.AFTER, "locked": style.LOCKED,
            "ink": style.INK, "quiet": style.QUIET, "blank": style.BLANK,
        },
        "manifold": {"x": alpha.tolist(), "y": _numbers(closed_form.locked_manifold(alpha))},
        "regions": [[name, x, y] for name, x, y in regions.NAMES],
        "undeformable": float(regions.UNDEFORMABLE),
    }  # fmt: skip


def _axis(frame, name):
    low, high = frame.ranges[name]
    about = PARAMETERS[name]
    root = name == "pressure" and low >= 0.0
    return {
        "low": low,
        "high": high,
        "count": len(frame.values[name]),
        "unit": about.units,
        "label": about.long_name,
        "root": root,
    }


def _shades(colours):
    return [[round(255 * float(part)) for part in colours(k / (SHADES - 1))[:3]] for k in range(SHADES)]


def _numbers(array):
    return [float(one) if np.isfinite(one) else None for one in array]

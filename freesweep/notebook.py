"""What notebooks show of actuators, rubbers and atlases: small tables in HTML, everything from outside escaped."""

import math
from html import escape

from .report import quantity

WIDE, HIGH = 220.0, 70.0  # of the drawn wall, unrolled [pixels]
PITCH = 22.0  # between threads of a family [pixels]
STEEPEST = 85.0  # [degree], as drawn
FAMILIES = ("#c2187f", "#1d2b3a")  # as in plots
STYLE = "border-collapse:collapse;font-size:90%"
CELL = "text-align:left;padding:2px 10px 2px 0;vertical-align:top"


def table(caption, rows) -> str:
    """A table of two or more columns of texts; a caption in bold above."""
    lines = ["<tr>" + "".join(f'<td style="{CELL}">{escape(str(cell))}</td>' for cell in row) + "</tr>" for row in rows]
    return f'<div><b>{escape(caption)}</b><table style="{STYLE}">{"".join(lines)}</table></div>'


def of_rubber(rubber) -> str:
    """A rubber: its constants, to which stretch they hold, where they come from."""
    return table(type(rubber).__name__, _rubber(rubber))


def _rubber(rubber):
    rows = [(name, quantity(getattr(rubber, name), "Pa")) for name in rubber.constants]
    if rubber.largest_stretch is not None:
        rows.append(("holds to a stretch of", f"{rubber.largest_stretch:g}"))
    return [*rows, *([("source", rubber.source)] if rubber.source else [])]


def of_actuator(tube) -> str:
    """A tube: its wall unrolled with both families of fibers, and what it is made of."""
    rows = []
    for name, units in (("alpha", "degree"), ("beta", "degree"), ("length", "m"), ("radius", "m"), ("wall", "m")):
        value = getattr(tube, name)
        if value is None:
            text = "none"
        elif name != "length":
            samples = tube.profile(name).samples()
            text = quantity(samples[0], units)
            if samples.min() < samples.max():
                text = f"{quantity(samples.min(), units)} to {quantity(samples.max(), units)}, varies along the tube"
        else:
            text = quantity(value, units)
        rows.append((name, text))
    if tube.fiber_extension != 1.0:
        rows.append(("fiber extension", f"{tube.fiber_extension:g}"))
    threads = "loose threads" if tube.is_loose else "bonded fibers"
    if tube.alpha is None and tube.beta is None:
        threads = "no fibers, measured"
    wall = "thick wall" if tube.is_thick else "membrane"
    rows.append(
        ("model", f"{wall}, {threads} at {quantity(tube.fiber_surface, 'm')}{', at x = 0' if tube.is_body else ''}")
    )
    rows += [(f"rubber {name}" if name != "source" else name, text) for name, text in _rubber(tube.material)]
    return f'<div style="display:flex;gap:20px">{table("Actuator", rows)}{_wall(tube)}</div>'


def _wall(tube):
    """The middle of the unrolled wall as SVG; the axis lies across, the longer side of the picture."""
    lines = []
    for angle, colour in zip(tube.angles(0.5), FAMILIES):
        if math.isnan(angle.item()):
            continue
        steep = math.radians(max(min(angle.item(), STEEPEST), -STEEPEST))
        slope, across = math.tan(steep), PITCH / math.cos(steep)
        for k in range(-int(WIDE * abs(slope) / across) - 2, int((HIGH + WIDE * abs(slope)) / across) + 2):
            y = k * across
            lines.append(
                f'<line x1="0" y1="{y:.1f}" x2="{WIDE:g}" y2="{y - slope * WIDE:.1f}" stroke="{colour}" stroke-width="1.2"/>'
            )
    frame = f'<rect width="{WIDE:g}" height="{HIGH:g}" fill="#f3f1ec"/>'
    own = f'xmlns="http://www.w3.org/2000/svg" width="{WIDE:g}" height="{HIGH:g}" style="overflow:hidden;flex:none"'
    return f'<svg {own} role="img" aria-label="the wall, unrolled">{frame}{"".join(lines)}</svg>'


def of_library(rubbers) -> str:
    """All rubbers: constants, range, source."""
    rows = [("name", "constants", "to a stretch of", "source")]
    for name, rubber in rubbers.items():
        rows.append((name, _constants(rubber), f"{rubber.largest_stretch:g}", rubber.source))
    return table("Rubbers: fs.material(name)", rows)


def _constants(rubber):
    return ", ".join(f"{name} = {quantity(getattr(rubber, name), 'Pa')}" for name in rubber.constants)


def library_text(rubbers) -> str:
    """The same for a terminal."""
    import textwrap

    lines = []
    for name, rubber in rubbers.items():
        lines.append(f"{name:<18}{_constants(rubber)}; to a stretch of {rubber.largest_stretch:g}")
        lines += textwrap.wrap(rubber.source, 100, initial_indent=" " * 18, subsequent_indent=" " * 18)
    return "\n".join(lines)


def of_atlas(atlas) -> str:
    """An atlas: its axes, what it holds, how many points have which status."""
    data = atlas.data
    rows = []
    for name, size in data.sizes.items():
        values, units = data[name].values, data[name].attrs.get("units", "")
        numbers = values.dtype.kind == "f"
        span = (
            f"{quantity(values[0], units)} to {quantity(values[-1], units)}" if numbers else ", ".join(values.tolist())
        )
        rows.append((name, f"{size:,}", span))
    held = [name for name in data.data_vars if f"{name}_error" in data]
    rows.append(("variables", len(held), ", ".join(held)))
    rows += [(meaning, f"{count:,}", "points") for meaning, count in atlas.status_counts().items()]
    return table(f"Atlas {atlas.path.name}: {data.attrs.get('title', '')}", rows)

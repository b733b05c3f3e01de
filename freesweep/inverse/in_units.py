"""Wishes and amounts in the units in which people read them: such as :func:`freesweep.report.shown_in` finds."""

from ..atlas.schema import PARAMETERS
from .wishes import UNITS


def unit_of(name) -> str:
    """Unit in which an output or a parameter is kept; of a profile's knot, too."""
    return UNITS.get(name) or PARAMETERS[name.partition("[")[0]].units


def shown_unit(name, shown) -> tuple:
    """``(unit, scale)`` in which an output or a parameter is shown; the unit is "" where it has none."""
    unit, scale = shown.get(unit_of(name), (unit_of(name), 1.0))
    return "" if unit == "1" else unit, scale


def amount(value, name, shown, digits=6) -> str:
    """A number of an output or a parameter with its unit, "120 mm"."""
    unit, scale = shown_unit(name, shown)
    return f"{scale * value:.{digits}g} {unit}".rstrip()


def title_parts(title, shown) -> tuple:
    """``(output, state)`` of a wish's title, ``output at name value unit, ...``, its units as they are shown."""
    output, _, state = title.partition(" at ")
    said = []
    for name, value, kept in (part.split(" ", 2) for part in state.split(", ") if part):
        own, factor = shown.get(kept, (kept, 1.0))
        said.append(f"{name} {factor * float(value):.6g} {own}")
    return output, ", ".join(said)


def titled(title, shown) -> str:
    """A wish's title with its units as they are shown."""
    output, state = title_parts(title, shown)
    return f"{output} at {state}" if state else output

"""How a variable is shown to a designer: label, unit, scale, and the value a diverging colour map is centred at."""

from collections.abc import Callable
from typing import NamedTuple

from ..atlas import schema


class Display(NamedTuple):
    """Shown value = ``convert(stored value, parameters of the point)`` [units]."""

    label: str
    units: str
    convert: Callable
    centre: float | None  # None: the quantity has no sign

    @property
    def axis_label(self):
        return f"{self.label} [{self.units}]" if self.units else self.label


def _scaled(factor):
    return lambda value, point: factor * value


def _stroke(value, point):
    return 100.0 * (value / point["length"] - 1.0)


def _relative_radius(value, point):
    # mid_radius is that of the surface on which the fibers lie
    return value / point.get("fiber_radius", point["radius"])


_SHOWN = {
    "deformed_length": Display("change of length", "%", _stroke, 0.0),
    "rotation": Display("rotation of the free end", "degree", _scaled(1.0), 0.0),
    "mid_radius": Display("radius at half length / undeformed radius", "", _relative_radius, 1.0),
    "volume": Display("volume of the cavity", "mL", _scaled(1e6), None),
    "strain_energy": Display("strain energy of the wall", "mJ", _scaled(1e3), None),
    "limit_pressure": Display("limit pressure", "kPa", _scaled(1e-3), None),
    "blocked_force": Display("blocked force", "N", _scaled(1.0), 0.0),
    "blocked_torque": Display("blocked torque", "mN m", _scaled(1e3), 0.0),
    "ideal_blocked_force": Display("blocked force", "N", _scaled(1.0), 0.0),
    "ideal_blocked_torque": Display("blocked torque", "mN m", _scaled(1e3), 0.0),
}
PARAMETER_UNITS = {  # shown unit and its factor, where it is not the stored one
    **dict.fromkeys(("length", "radius", "wall", "fiber_radius"), ("mm", 1e3)),
    **dict.fromkeys(("c10", "c01", "pressure"), ("kPa", 1e-3)),
    "torque": ("mN m", 1e3),
}


def display(variable: str) -> Display:
    """How ``variable`` (a name of ``schema.VARIABLES``) is shown."""
    return _SHOWN[variable.removeprefix("locked_")]


def title(variable: str) -> str:
    """Heading of a plot of ``variable``."""
    label = display(variable).label.split(" /")[0]
    label = label[0].upper() + label[1:]
    if variable.startswith("locked_"):
        return f"{label}, locked"
    if variable.startswith("ideal_"):
        return f"{label} of inextensible fibers"
    return label if variable == "limit_pressure" else f"{label} under pressure"


def describe(name: str, value: float) -> str:
    """One parameter in words, such as ``pressure 100 kPa``; ``value`` in its stored unit."""
    units, factor = PARAMETER_UNITS.get(name, (schema.PARAMETERS[name].units, 1.0))
    text = f"{name.replace('_', ' ')} {factor * value:.4g} {units}".removesuffix(" 1")
    return text.replace(" ", "\u00a0")  # a title breaks between two of them, not within

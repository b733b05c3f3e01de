"""How a variable is shown to a designer: label, unit, scale, and the value a diverging colour map is centred at."""

from collections.abc import Callable
from typing import NamedTuple

from ..atlas import schema
from ..description.tube_model import fiber_surface


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
    return value / fiber_surface(point, point.model)


_SHOWN = {
    "deformed_length": Display("change of length", "%", _stroke, 0.0),
    "rotation": Display("rotation of the free end", "degree", _scaled(1.0), 0.0),
    "mid_radius": Display("radius at half length / undeformed radius", "", _relative_radius, 1.0),
    "volume": Display("volume of the cavity", "mL", _scaled(1e6), None),
    "strain_energy": Display("strain energy of the wall", "mJ", _scaled(1e3), None),
    "outer_radius": Display("largest outer radius", "mm", _scaled(1e3), None),
    "largest_stretch": Display("largest stretch of the wall", "", _scaled(1.0), None),
    "least_tension_alpha": Display("least tension of family alpha", "N", _scaled(1.0), None),
    "least_tension_beta": Display("least tension of family beta", "N", _scaled(1.0), None),
    "slack_alpha": Display("part of the length where family alpha is slack", "%", _scaled(100.0), None),
    "slack_beta": Display("part of the length where family beta is slack", "%", _scaled(100.0), None),
    "limit_pressure": Display("limit pressure", "kPa", _scaled(1e-3), None),
    "blocked_force": Display("blocked force", "N", _scaled(1.0), 0.0),
    "blocked_torque": Display("blocked torque", "mN m", _scaled(1e3), 0.0),
    "force": Display("axial force", "N", _scaled(1.0), 0.0),
    "torque": Display("torque", "mN m", _scaled(1e3), 0.0),
    "ideal_blocked_force": Display("blocked force", "N", _scaled(1.0), 0.0),
    "ideal_blocked_torque": Display("blocked torque", "mN m", _scaled(1e3), 0.0),
}
_ABSOLUTE = {
    "deformed_length": Display("length", "mm", _scaled(1e3), None),
    "mid_radius": Display("radius at half length", "mm", _scaled(1e3), None),
}
_SYMBOLS = {"alpha": r"fiber angle $\alpha$", "beta": r"fiber angle $\beta$", "c10": "$C_{10}$", "c01": "$C_{01}$"}
_SYMBOLS |= {"c20": "$C_{20}$", "c30": "$C_{30}$"}
USUAL = {
    "fiber_extension": 1.0,
    "force": 0.0,
    "torque": 0.0,
    "held_rotation": 0.0,
    "held_length_ratio": 1.0,
}  # not worth a word below a title
PARAMETER_UNITS = {  # shown unit and its factor, where it is not the stored one
    **dict.fromkeys(("length", "radius", "wall", "fiber_radius", "deformed_length", "held_length"), ("mm", 1e3)),
    **dict.fromkeys(("c10", "c01", "c20", "c30", "pressure"), ("kPa", 1e-3)),
    "torque": ("mN m", 1e3),
}


def display(variable: str) -> Display:
    """How ``variable`` (a name of ``schema.VARIABLES``) is shown."""
    return _SHOWN[schema.plain(variable)]


def absolute(variable: str) -> Display:
    """The same for plots along one axis, where sizes need no scale: lengths and radii in [mm]."""
    name = schema.plain(variable)
    return _ABSOLUTE.get(name, _SHOWN[name])


def title(variable: str) -> str:
    """Heading of a plot of ``variable``."""
    label = display(variable).label.split(" /")[0]
    label = label[0].upper() + label[1:]
    for prefix, state in schema.STATES.items():
        if variable.startswith(prefix):
            return f"{label}, {state}"
    if variable.startswith("ideal_"):
        return f"{label} of inextensible fibers"
    return label if variable == "limit_pressure" else f"{label} under pressure"


def shown_units(name: str) -> tuple[str, float]:
    """Unit in which a parameter is shown, and the factor from the stored one."""
    return PARAMETER_UNITS.get(name) or (schema.attributes(name)["units"], 1.0)


def axis_label(name: str, short: bool = False) -> str:
    """Label of an axis along a parameter, with its unit; ``short``: a symbol, where there is one."""
    label = (_SYMBOLS.get(name) or name.replace("_", " ")).removeprefix("fiber angle " if short else "")
    return f"{label} [{shown_units(name)[0]}]".removesuffix(" [1]")


def describe(name: str, value: float | str) -> str:
    """One parameter in words, such as ``pressure 100 kPa``; ``value`` in its stored unit, or the name of a design."""
    if isinstance(value, str):
        return f"{name} {value}"
    units, factor = shown_units(name)
    text = f"{name.replace('_', ' ')} {factor * value:.4g} {units}".removesuffix(" 1")
    return text.replace(" ", "\u00a0")  # a title breaks between two of them, not within

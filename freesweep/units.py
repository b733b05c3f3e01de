"""Reads quantities at the rim: "4.76 mm", "15 psi", "30 deg" become floats in the unit that a parameter is kept in.

Numbers are converted in decimal, so "4.76 mm" is exactly the float 0.00476. Nothing is evaluated: a text is one number
and one unit of the table, or it is refused.
"""

import difflib
import numbers
import re
from decimal import Context, Decimal

MAX_CHARACTERS = 64  # a longer text is no quantity
_DECIMAL = Context(prec=40, traps=[])  # no traps: overflow becomes infinity, which is refused below

# Factor of each unit to the unit its kind is kept in. Case counts: mN and MN differ by nine orders of magnitude.
_LENGTH = {
    **{"m": "1", "nm": "1e-9", "um": "1e-6", "mm": "1e-3", "cm": "1e-2", "dm": "1e-1", "km": "1e3"},
    **{"in": "0.0254", "inch": "0.0254", "ft": "0.3048", "mil": "2.54e-5"},
}
_PRESSURE = {
    **{"Pa": "1", "hPa": "1e2", "kPa": "1e3", "MPa": "1e6", "GPa": "1e9", "mbar": "1e2", "bar": "1e5"},
    **{"N/m2": "1", "N/mm2": "1e6", "kgf/cm2": "98066.5"},
    **{"psi": "6894.757293168361", "ksi": "6894757.293168361", "atm": "101325", "mmHg": "133.322387415"},
}
_FORCE = {
    **{"N": "1", "uN": "1e-6", "mN": "1e-3", "kN": "1e3", "gf": "9.80665e-3", "kgf": "9.80665"},
    **{"lbf": "4.4482216152605", "ozf": "0.27801385095378125"},
}
_TORQUE = {
    **{"N m": "1", "uN m": "1e-6", "mN m": "1e-3", "kN m": "1e3", "N mm": "1e-3", "N cm": "1e-2"},
    **{"kgf m": "9.80665", "kgf cm": "9.80665e-2", "gf cm": "9.80665e-5"},
    **{"lbf ft": "1.3558179483314004", "lbf in": "0.1129848290276167", "ozf in": "0.007061551814226044"},
}
_DEGREES = "57.295779513082320876798154814105"  # in one radian
_ANGLE = {
    **{"deg": "1", "degree": "1", "degrees": "1", "°": "1", "rad": _DEGREES},
    "mrad": "0.057295779513082320876798154814105",
}
_NUMBER = {"1": "1", "%": "0.01"}

# kept in: (what it is, an example, its units)
_KINDS = {
    "m": ("a length", "4.76 mm", _LENGTH),
    "Pa": ("a pressure", "0.1 MPa", _PRESSURE),
    "N": ("a force", "12 N", _FORCE),
    "N m": ("a torque", "0.5 N m", _TORQUE),
    "degree": ("an angle", "30 deg", _ANGLE),
    "1": ("a number without unit", "1.005", _NUMBER),
}
_SPELLINGS = str.maketrans({"µ": "u", "μ": "u", "º": "°", "²": "2", "^": None})
_PRODUCT = re.compile(r"(?<=[A-Za-z])\s*[\s·⋅*.-]\s*(?=[A-Za-z])")
_QUANTITY = re.compile(r"([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)(.*)", re.DOTALL)


def _known_units():
    known = {}
    for kept, (_, _, units) in _KINDS.items():
        for name, factor in units.items():
            entry = (kept, _DECIMAL.create_decimal(factor))
            known[name] = entry
            if kept == "N m":  # also "Nm", "in lbf"
                known[name.replace(" ", "")] = known[" ".join(reversed(name.split()))] = entry
    return known


_KNOWN = _known_units()


def shown(value, limit: int = 40) -> str:
    """Any value as one short line for a message: shortened, control characters escaped."""
    if isinstance(value, int) and abs(value) >= 10**38:
        return "a whole number of more than 38 digits"  # Python refuses to print a very long one
    if isinstance(value, list | dict):
        return _type_name(value)
    text = repr(value[: limit + 1] if isinstance(value, str) else value)
    return text if len(text) <= limit else f"{text[:limit]}..."


def quantity(value: str | float, units: str) -> float:
    """The quantity as a float in ``units``: "m", "Pa", "N", "N m", "degree" or "1" (no unit).

    A number, or a text without unit, is taken to be in ``units`` already. Raises ValueError with a sentence that says
    what was found, what is allowed and what to write instead.
    """
    kind, example, _ = _KINDS[units]
    expects = f"expects {kind} such as {example!r}"
    if isinstance(value, str):
        result = _from_text(value, units, expects)
    elif isinstance(value, numbers.Real) and not isinstance(value, bool):
        try:
            result = float(value)
        except OverflowError:
            raise ValueError(f"{expects}, found {shown(value)}") from None
    else:
        raise ValueError(f"{expects}, found {_type_name(value)}")
    if not abs(result) < float("inf"):
        raise ValueError(f"{expects}, found {shown(value)}: the number must be finite")
    return result + 0.0  # -0.0 becomes 0.0


def _from_text(text, units, expects):
    if len(text) > MAX_CHARACTERS:
        raise ValueError(f"{expects}, found a text of {len(text)} characters; {MAX_CHARACTERS} are allowed")
    match = _QUANTITY.fullmatch(text.strip().replace("−", "-"))
    if match is None:
        raise ValueError(f"{expects}, found {shown(text)}: write a number, then its unit")
    number, unit = match.groups()
    if re.match(r",[0-9]", unit):
        raise ValueError(f"{expects}, found {shown(text)}: write the decimal comma as a point")
    unit = _PRODUCT.sub(" ", unit.strip().translate(_SPELLINGS))
    kept, factor = _KNOWN.get(unit, (None, None)) if unit else (units, Decimal(1))
    if kept is None:
        raise ValueError(f"{expects}, found {shown(text)}: unknown unit {_nearest(unit, units)}")
    if kept != units:
        raise ValueError(f"{expects}, got {shown(text)}, {_KINDS[kept][0]}")
    return float(_DECIMAL.multiply(_DECIMAL.create_decimal(number), factor))


def _nearest(unit, units):
    names = {name.lower(): name for name, (kept, _) in _KNOWN.items() if kept == units}
    near = difflib.get_close_matches(unit.lower(), names, n=1, cutoff=0.5)
    meant = f", did you mean {names[near[0]]!r}?" if near else "."
    return f"{shown(unit)}{meant} Known here: {', '.join(_KINDS[units][2])}"


def _type_name(value):
    names = {bool: "true or false", list: "a list", tuple: "a list", dict: "a table", type(None): "nothing"}
    return names.get(type(value), f"a value of type {type(value).__name__}")

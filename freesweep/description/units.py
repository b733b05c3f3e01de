"""Reads quantities at the rim: "4.76 mm", "15 psi", "30 deg" become floats in the unit that a parameter is kept in.

Numbers are converted in decimal, so "4.76 mm" is exactly the float 0.00476. Nothing is evaluated: a text is one number
and one unit of the table, or it is refused.
"""

import difflib
import numbers
import re
from decimal import Context, Decimal

MAX_CHARACTERS = 64  # a longer text is no quantity
NEAR = 0.75  # likeness of two units from which one may be a slip for the other
_DECIMAL = Context(prec=40, traps=[])  # no traps: overflow becomes infinity, which is refused below

# Factor of each unit to the unit its kind is kept in. Case counts: mN and MN differ by nine orders of magnitude.
_LENGTH = {
    **{"m": "1", "nm": "1e-9", "um": "1e-6", "mm": "1e-3", "cm": "1e-2", "dm": "1e-1", "km": "1e3"},
    **{"in": "0.0254", "inch": "0.0254", "ft": "0.3048", "mil": "2.54e-5"},
}
_PRESSURE = {
    **{"Pa": "1", "hPa": "1e2", "kPa": "1e3", "MPa": "1e6", "GPa": "1e9", "mbar": "1e2", "bar": "1e5"},
    **{"N/m2": "1", "N/mm2": "1e6", "kgf/cm2": "98066.5"},
    **{"psi": "6894.757293168361", "ksi": "6894757.293168361", "atm": "101325", "at": "98066.5"},
    **{"mmHg": "133.322387415", "cmHg": "1333.22387415", "inHg": "3386.388640341", "Torr": "133.32236842105263158"},
    **{"mmH2O": "9.80665", "cmH2O": "98.0665", "mH2O": "9806.65", "inH2O": "249.08891"},
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
    **{"radian": _DEGREES, "radians": _DEGREES},
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
_GAUGE = re.compile(
    r"(.+?)\s*(?:g|G|\(g\)|\(G\)|\(?gauge\)?)"
)  # psig, bar(g): above the atmosphere, as all pressures here
_ABSOLUTE = re.compile(r"(.+?)\s*(?:a|A|\(a\)|\(A\)|\(?abs(?:olute)?\)?)")  # psia, bara
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
    expects = _expects(units)
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


def _expects(units):
    kind, example, _ = _KINDS[units]
    return f"expects {kind} such as {example!r}"


def _from_text(text, units, expects):
    if len(text) > MAX_CHARACTERS:
        raise ValueError(f"{expects}, found a text of {len(text)} characters; {MAX_CHARACTERS} are allowed")
    match = _QUANTITY.fullmatch(text.strip().replace("−", "-"))
    if match is None:
        raise ValueError(f"{expects}, found {shown(text)}: write a number, then its unit")
    number, unit = match.groups()
    if re.match(r",[0-9]", unit):
        raise ValueError(f"{expects}, found {shown(text)}: write the decimal comma as a point")
    return float(_DECIMAL.multiply(_DECIMAL.create_decimal(number), _factor(unit, units, text)))


def unit_of(text: str) -> str:
    """The unit that is written behind a number, "" if there is none."""
    match = _QUANTITY.fullmatch(str(text).strip().replace("−", "-"))
    return match[2].strip() if match else ""


def known_units(units: str) -> dict[str, float]:
    """The units of the kind that is kept in ``units``: name -> what a number in it is multiplied with."""
    return {name: float(value) for name, (kept, value) in _KNOWN.items() if kept == units}


def factor(unit: str, units: str) -> float:
    """What a number in a ``unit`` is multiplied with, to be in ``units``; no unit at all: 1. Raises ValueError as above."""
    return float(_factor(unit, units, unit))


def _factor(unit, units, text):
    expects = _expects(units)
    unit = _PRODUCT.sub(" ", unit.strip().translate(_SPELLINGS))
    kept, value = _KNOWN.get(unit, (None, None)) if unit else (units, Decimal(1))
    if kept is None and (gauge := _GAUGE.fullmatch(unit)) and gauge.group(1) in _PRESSURE:
        kept, value = _KNOWN[gauge.group(1)]
    folded = {name.lower(): name for name in _PRESSURE}  # PSIA is no slip for psi either
    if kept is None and (absolute := _ABSOLUTE.fullmatch(unit)) and (name := folded.get(absolute.group(1).lower())):
        atmosphere = 101325.0 / float(_PRESSURE[name])
        raise ValueError(
            f"{expects}, found {shown(text)}, an absolute pressure; gauge pressure counts here, what is above the"
            f" surroundings: subtract the atmosphere, {atmosphere:.6g} {name} by standard, and write {name!r}"
        )
    if kept is None:
        raise ValueError(f"{expects}, found {shown(text)}: unknown unit {_nearest(unit, units)}")
    if kept != units:
        raise ValueError(f"{expects}, got {shown(text)}, {_KINDS[kept][0]}")
    return value


def _nearest(unit, units):
    """An unknown unit, and the one meant where hardly a letter differs: inches of mercury are no slip for millimetres."""
    names = {name.lower(): name for name, (kept, _) in _KNOWN.items() if kept == units}
    near = difflib.get_close_matches(unit.lower(), names, n=1, cutoff=NEAR)
    meant = f", did you mean {names[near[0]]!r}?" if near else "."
    return f"{shown(unit)}{meant} Known here: {', '.join(_KINDS[units][2])}"


def _type_name(value):
    names = {bool: "true or false", list: "a list", tuple: "a list", dict: "a table", type(None): "nothing"}
    return names.get(type(value), f"a value of type {type(value).__name__}")

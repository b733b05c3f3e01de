"""Numbers as people give them, read in one place: plain ones, texts with units, arrays and objects that carry units.

What carries a unit is converted to the one asked for: texts ("4.76 mm"), what has ``.to()`` and units (astropy, pint, unyt;
also in lists and DataArrays), what has an attribute ``units`` (xarray, pandas, netCDF4). What is masked is refused. NumPy
drops both, units and masks, without a word.
"""

from collections.abc import Mapping
from decimal import Decimal
from numbers import Real

import numpy as np

from .units import factor, quantity, shown

SMALLEST, LARGEST = 1e-12, 1e12  # beyond any actuator in any unit; keeps every scaled quantity finite
DEEPEST = 8  # of nested lists and wrapped quantities
TARGETS = {
    "degree": ("degree", "deg"),
    "N m": ("N m", "N*m"),
    "1": ("", "dimensionless"),
}  # as such libraries write units


class _Nothing(Exception):
    """A value that holds no numbers; told by the caller, who knows how many are allowed."""


def numbers(value, units) -> np.ndarray:
    """Floats in ``units`` ("m", "Pa", "N", "N m", "degree", "1"), of the shape given; not all need be finite.

    Raises ValueError with a sentence that says what was found and what to do.
    """
    if type(value) is np.ndarray and value.dtype.kind == "f":
        return value.astype(float)
    try:
        with np.errstate(over="ignore"):  # a long double beyond all floats becomes infinite
            return _read(value, units, 0)
    except _Nothing:
        raise ValueError(f"found {described(value)}; give numbers in [{units}]") from None


def read_number(name, value, unit, faults, *, positive=False, least=None, most=LARGEST):
    """One number as a float in ``unit``; None after noting in ``faults`` what is wrong with it."""
    try:
        array = numbers(value, unit)
    except ValueError as error:
        faults.append(f"{name}: {error}".replace("give numbers in", "give one number in"))
        return None
    if array.ndim:
        faults.append(f"{name}: found {described(value)}; give one number in [{unit}]")
        return None
    number = array.item() + 0.0  # -0.0 becomes 0.0
    fault = _domain_fault(number, unit, positive, least, most)
    if fault:
        faults.append(f"{name}: {fault}")
    return None if fault else number


def read_column(name, value, unit, faults, *, positive=False, least=None, most=LARGEST):
    """A number or several in one dimension as an array () or (n,) in ``unit``; None after noting what is wrong."""
    try:
        array = numbers(value, unit)
    except ValueError as error:
        faults.append(f"{name}: {error}".replace("give numbers in", "give a number or a 1-D array of numbers in"))
        return None
    if array.ndim > 1 or array.size == 0:
        shape = f"found an array of shape {array.shape}"
        faults.append(f"{name}: {shape}; give a number or a 1-D array of numbers in [{unit}]")
        return None
    array = array + 0.0
    low = SMALLEST if positive else -most if least is None else least
    wrong = ~((array >= low) & (array <= most))
    if wrong.any():
        at = int(np.argmax(wrong))
        place = f"entry {at + 1}: " if array.size > 1 else ""
        faults.append(f"{name}: {place}{_domain_fault(array.ravel()[at].item(), unit, positive, least, most)}")
        return None
    return array


def _domain_fault(number, unit, positive, least, most):
    """A sentence on a number outside its domain, or None."""
    low = SMALLEST if positive else -most if least is None else least
    own = "" if unit == "1" else f" {unit}"
    if not np.isfinite(number):
        return f"found {number}; give a finite number in [{unit}]"
    if positive and not number > 0.0:
        return f"found {number:g}{own}; it has to be above 0"
    if least is not None and number < least:
        return f"found {number:g}{own}; it has to be {least:g} or more"
    return None if low <= number <= most else f"found {number:g}{own}; it has to lie between {low:g} and {most:g}"


def described(value) -> str:
    """A type and what it holds, in one short line."""
    try:
        return f"{type(value).__name__} {' '.join(repr(value)[:60].split())}"
    except Exception:  # a foreign type that cannot be printed, or an integer too long to be
        return type(value).__name__


def _read(value, units, depth):
    if depth > DEEPEST:
        raise _Nothing
    _refuse_mask(value)
    if isinstance(value, str):
        return np.array(quantity(value, units))
    if isinstance(value, (Real, Decimal)) and not isinstance(value, (bool, np.generic)):
        return np.array(_float(value))
    if (unit := _unit(value)) is not None:
        return _converted(value, unit, units, depth)
    if isinstance(value, (list, tuple)):
        if set(map(type, value)) <= {float}:
            return np.array(value, float)
        parts = [_read(one, units, depth + 1) for one in value]
        if len({part.shape for part in parts}) > 1:
            raise ValueError(f"found {described(value)} of uneven rows; give numbers in [{units}]")
        return np.stack(parts)
    inner = getattr(value, "data", None) if type(value).__module__.startswith("xarray") else None
    if inner is not None and not isinstance(inner, Mapping):  # a DataArray may hold what carries units itself
        return _read(inner, units, depth + 1)
    try:
        array = np.asanyarray(value)
    except Exception:  # ragged or foreign
        raise _Nothing from None
    _refuse_mask(array)
    array = np.asarray(array)
    if array.dtype.kind in "iuf":
        return array.astype(float)
    if array.dtype.kind not in "UO" or (array.ndim == 0 and array.item() is value):
        raise _Nothing
    parts = [_read(one, units, depth + 1) for one in array.ravel().tolist()]
    if any(part.ndim for part in parts):
        raise _Nothing
    return np.array(parts, float).reshape(array.shape)


def _float(value):
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"found {shown(value)}; give a number that a float can hold") from None


def _refuse_mask(value):
    """Refuse what is masked somewhere; ``mask`` of a pandas object is a method."""
    mask = getattr(value, "mask", None)
    if isinstance(mask, (np.ndarray, bool, np.bool_)) and np.any(mask):
        count = f"{np.count_nonzero(mask)} of {np.size(mask)} values" if np.size(mask) > 1 else "a value"
        raise ValueError(f"found {type(value).__name__} with {count} masked; leave those out, or fill them in")


def _unit(value):
    """The unit that a value carries: a text, or an object of its library; None where it carries none."""
    attributes = getattr(value, "attrs", None)
    own = attributes.get("units") if isinstance(attributes, Mapping) else None
    if own is None and not isinstance(value, (list, tuple, type, np.dtype)):
        own = getattr(value, "units", None)
        own = getattr(value, "unit", None) if own is None else own
    return None if own is None or callable(getattr(own, "__func__", None)) else own


def _converted(value, unit, units, depth):
    """Plain floats in ``units`` of a value that carries a ``unit``."""
    convert = getattr(value, "to", None) or getattr(value, "rescale", None)
    if not callable(convert):  # the unit is an attribute beside plain numbers
        inner = getattr(value, "data", value) if type(value).__module__.startswith("xarray") else np.asanyarray(value)
        return _read(inner, units, depth + 1) * factor(str(unit), units)
    for target in TARGETS.get(units, (units,)):
        try:
            found = convert(target)
        except Exception:  # each library has its own for units that do not agree
            continue
        plain = getattr(found, "magnitude", None)
        plain = getattr(found, "value", None) if plain is None else plain
        if plain is None or _unit(plain) is not None:
            raise _Nothing
        return _read(plain, units, depth + 1)
    raise ValueError(f"found {described(value)}, which cannot be converted to [{units}]")

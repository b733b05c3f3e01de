"""Values of one axis: a list of quantities, or a range {start, stop, step} or {start, stop, num, spacing}."""

import math

import numpy as np

from ..atlas.schema import PARAMETERS
from ..description.fields import SHAPE
from ..description.units import quantity, shown
from .faults import Faults

MAX_AXIS = 10_000  # values of one axis: beyond it a typing slip is likelier than a purpose
COUNTED = 10**18  # a larger count is not spelt out
RANGE = ("start", "stop", "step", "num", "spacing")
OTHERS = {"start": ("from", "min"), "stop": ("to", "end", "max"), "num": ("n", "count", "number", "points", "size")}
MEANT = {other: f"write {key}" for key, others in OTHERS.items() for other in others}
SPACINGS = ("linear", "sqrt", "log")
STEP_TOLERANCE = 1e-9  # relative: how well a step must divide its range
ROUNDING = 1e-14  # of the larger end: what is nearer to 0 is 0

SMALLEST, LARGEST = 1e-12, 1e12  # beyond any actuator in any unit; keeps every scaled quantity finite
_SIZE = (SMALLEST, LARGEST, "must be positive")
_ANGLE = (math.nextafter(-90.0, 0.0), math.nextafter(90.0, 0.0), "fibers at 90 degrees are rings, without a winding")
_LOAD = (-LARGEST, LARGEST, "")
DOMAIN = {
    "alpha": _ANGLE,
    "beta": _ANGLE,
    "length": _SIZE,
    "radius": _SIZE,
    "taper": (*SHAPE["taper"], "the far end is slimmer by that share: 1 would be a tip"),
    "bulge": (*SHAPE["bulge"], "the middle is wider by that share: -1 would close it"),
    "wall": _SIZE,
    "fiber_radius": _SIZE,
    "fiber_extension": (1.0, 10.0, "it is a stretch: fibers 0.5 % longer have 1.005"),
    "c10": _SIZE,
    "c01": (0.0, LARGEST, "must not be negative"),
    "c20": _LOAD,
    "c30": _LOAD,
    "force": _LOAD,
    "torque": _LOAD,
    "held_length": _SIZE,
    "held_length_ratio": (1e-3, 1e3, "it is a stretch of the whole tube: a tenth shorter is 0.9"),
    "held_rotation": _LOAD,
    "pressure": (0.0, LARGEST, "vacuum is another problem: pressures are 0 or more"),
}


def value(faults: Faults, path: str, name: str, given) -> float | None:
    """One value of the parameter ``name`` in its unit of schema.PARAMETERS; None after noting a fault."""
    units = PARAMETERS[name].units
    if isinstance(given, list | dict):
        faults.add(path, "several values found, one is allowed here; move the parameter to [axes]")
        return None
    try:
        number = quantity(given, units)
    except ValueError as error:
        faults.add(path, str(error))
        return None
    if fault := outside(name, number, given):
        faults.add(path, fault)
        return None
    return number


def outside(name: str, number: float, given) -> str:
    """What is wrong with a ``number`` of the parameter ``name``, as it was ``given``; "" where it may have it."""
    low, high, reason = DOMAIN[name]
    if low <= number <= high:
        return ""
    bounds = "between -90 and 90, both excluded" if DOMAIN[name] is _ANGLE else f"{low:g} to {high:g}"
    unit = "" if PARAMETERS[name].units == "1" else f" [{PARAMETERS[name].units}]"
    return f"found {shown(given)}, allowed is {bounds}{unit}" + (f"; {reason}" if reason else "")


def values(faults: Faults, path: str, name: str, given) -> np.ndarray | None:
    """Values of an axis, shape (n,), strictly increasing, read-only; None after noting its faults."""
    if isinstance(given, list):
        array = _from_list(faults, path, name, given)
    elif isinstance(given, dict):
        array = _from_range(faults, path, name, given)
    else:
        faults.add(
            path,
            f"found {shown(given)}; an axis is a list, or {{start, stop, step}}, or {{start, stop, num}}; "
            "a single value belongs in [actuator] or [load]",
        )
        return None
    if array is not None:
        array.setflags(write=False)
    return array


def _from_list(faults, path, name, given):
    if not given:
        faults.add(path, "found an empty list; give at least one value")
        return None
    if len(given) > MAX_AXIS:
        faults.add(path, _too_many(len(given)))
        return None
    numbers = [value(faults, f"{path}[{i}]", name, entry) for i, entry in enumerate(given)]
    if None in numbers:
        return None
    for i in range(1, len(numbers)):
        if not numbers[i] > numbers[i - 1]:
            faults.add(
                path,
                f"values must increase, but {shown(given[i])} follows {shown(given[i - 1])} "
                f"(entries {i} and {i + 1}); sort them and remove repeats",
            )
            return None
    return np.array(numbers)


def _from_range(faults, path, name, given):
    before = len(faults.found)
    faults.unknown_keys(given, RANGE, path, MEANT)
    missing = [key for key in ("start", "stop") if key not in given]
    if ("step" in given) == ("num" in given):
        missing.append("either step or num" + (", not both" if "num" in given else ""))
    if missing:
        faults.add(path, f"a range needs {' and '.join(missing)}")
    start = value(faults, f"{path}.start", name, given["start"]) if "start" in given else None
    stop = value(faults, f"{path}.stop", name, given["stop"]) if "stop" in given else None
    spacing = given.get("spacing", "linear")
    if spacing not in SPACINGS:
        faults.add(f"{path}.spacing", f"found {shown(spacing)}, allowed: {', '.join(SPACINGS)}")
    elif spacing != "linear" and "step" in given:
        faults.add(f"{path}.spacing", f"{spacing!r} needs num, not step")
    if len(faults.found) > before:
        return None
    if start > stop:
        faults.add(path, f"start {shown(given['start'])} lies above stop {shown(given['stop'])}; swap them")
        return None
    count = _count_of_steps(faults, path, name, given, start, stop) if "step" in given else _num(faults, path, given)
    if count is None:
        return None
    if count > MAX_AXIS:
        faults.add(path, _too_many(count))
        return None
    if (count == 1) != (start == stop):
        found = f"{count:,} value{'s' * (count > 1)} from {shown(given['start'])} to {shown(given['stop'])}"
        faults.add(path, f"found {found}; one value needs start = stop, several need start below stop")
        return None
    lowest = {"linear": -math.inf, "sqrt": 0.0, "log": SMALLEST}[spacing]
    if start < lowest:
        faults.add(f"{path}.start", f"found {shown(given['start'])}, but {spacing!r} needs start >= {lowest:g}")
        return None
    array = _spaced(start, stop, count, spacing)
    if count > 1 and not np.all(np.diff(array) > 0.0):
        faults.add(path, f"the range is too narrow for {count} different values; lower num")
        return None
    return array


def _num(faults, path, given):
    num = given["num"]
    if isinstance(num, bool) or not isinstance(num, int) or num < 1:
        faults.add(f"{path}.num", f"found {shown(num)}, allowed is a whole number from 1 to {MAX_AXIS:,}")
        return None
    return num


def _count_of_steps(faults, path, name, given, start, stop):
    path, units = f"{path}.step", PARAMETERS[name].units
    try:
        step = quantity(given["step"], units)
    except ValueError as error:
        faults.add(path, str(error))
        return None
    if not step > 0.0:
        faults.add(path, f"found {shown(given['step'])}, must be positive; axes increase from start to stop")
        return None
    ratio = (stop - start) / step
    if ratio >= MAX_AXIS:
        faults.add(path, _too_many(round(ratio) + 1 if math.isfinite(ratio) else COUNTED))
        return None
    steps = round(ratio)
    if abs(ratio - steps) > STEP_TOLERANCE * max(1.0, abs(ratio)):
        reached = start + math.floor(ratio) * step
        unit = "" if units == "1" else f" {units}"
        faults.add(
            path,
            f"steps of {shown(given['step'])} do not meet stop {shown(given['stop'])}: the last value would be "
            f"{reached:.12g}{unit}; change stop or step, or give num",
        )
        return None
    return steps + 1


def _spaced(start, stop, count, spacing):
    """Equal steps of the value, its square root or its logarithm; shape (count,)."""
    if count == 1:
        return np.array([start])
    if spacing == "sqrt":
        array = np.linspace(math.sqrt(start), math.sqrt(stop), count) ** 2
    elif spacing == "log":
        array = np.exp(np.linspace(math.log(start), math.log(stop), count))
    else:
        array = np.linspace(start, stop, count)
    # 15 digits: 0.3, not 0.30000000000000004, so that a value can be looked up as it is written
    array = np.array([float(f"{number:.15g}") for number in array.tolist()])
    array[np.abs(array) < ROUNDING * max(abs(start), abs(stop))] = 0.0
    array[0], array[-1] = start, stop
    return array


def _too_many(count):
    found = f"{count:,} values ({8 * count:,} bytes)" if count < COUNTED else f"more than {COUNTED:.0e} values"
    return f"found {found}, at most {MAX_AXIS:,} are allowed on one axis; use fewer"

"""A sweep given by Python's arguments, written as the TOML text that an atlas keeps: one specification, two ways to it."""

import json
import re
from collections.abc import Mapping
from numbers import Integral

import numpy as np

from ..atlas.schema import PARAMETERS
from ..description.along import Profile
from ..description.elastomer import ELASTOMERS
from ..description.given import described, numbers
from ..description.material_library import materials
from .along import VARYING
from .designs import HOME
from .faults import Faults, SpecificationError
from .rubber import CONSTANTS
from .spec import Sweep, parse

HERE = "sweep"  # what errors call this specification
ENDS = ("start", "stop", "step")  # of a tuple


def sweep_of(given: dict) -> Sweep:
    """The checked sweep of arguments by name; raises SpecificationError with every fault."""
    faults = Faults(HERE)
    text = specification(given, faults)
    unread = {fault.partition(":")[0] for fault in faults.found}
    unread |= {"c10"} if "material" in unread else set()
    try:
        sweep = parse(text, HERE)
    except SpecificationError as error:  # what could not be read is not missing
        rest = [_in_python(fault) for fault in error.faults if fault.split(": is missing")[0] not in unread]
        raise SpecificationError(faults.found + rest, HERE) from None
    faults.check()
    return sweep


def _in_python(fault):
    """A fault of the text as one of its arguments: there are no tables."""
    name = fault.partition(":")[0]
    how = f"give {name}=" + (" or material=" if name == "c10" else "")
    return re.sub(r"give it in \[\w+\] or \[axes\]", how, fault)


def specification(given: dict, faults: Faults) -> str:
    """The TOML text of arguments by name, those that are None left out; what cannot be read becomes a fault."""
    given = {name: value for name, value in given.items() if value is not None}
    tables = {"actuator": {}, "load": {}, "axes": {}, "solver": {}}
    for name, rubber in _of_material(given, faults).items():
        tables["actuator"][name] = rubber
    for name in ("energy", "model", "wall_model", "fibers"):
        if name in given:
            tables["actuator"][name] = _plain(given[name], name, faults)
    for name in PARAMETERS:
        if name in given and (written := _parameter(name, given[name], faults)) is not None:
            tables["axes" if _varies(name, written) else HOME[name]][name] = written
    for name in ("accuracy", "blocked", "interpolation_tolerance", "budget"):
        if name in given:
            tables["solver"][name] = _plain(given[name], f"solver.{name}", faults)
    lines = [f"title = {_plain(given['title'], 'title', faults)}"] if "title" in given else []
    for name, table in tables.items():
        lines += [f"[{name}]", *(f"{key} = {value}" for key, value in table.items())] if table else []
    return "\n".join([*lines, *_designs(given.get("designs", ()), faults)]) + "\n"


def _varies(name, written):
    """Whether what is written is an axis: a range, or a list but no profile."""
    if name in VARYING and written.startswith(("[[", "{knots")):
        return False
    return written[0] in "{["


def _of_material(given, faults):
    """Keys of [actuator] for a rubber: its name if the library holds it, else its constants."""
    rubber = given.get("material")
    if rubber is None or isinstance(rubber, str):
        return {} if rubber is None else {"material": _text(rubber)}
    for name, known in materials.items():
        if known is rubber:
            return {"material": _text(name)}
    if not isinstance(rubber, ELASTOMERS):
        faults.add("material", f"found {described(rubber)}; give a rubber, or the name of one in freesweep.materials")
        return {}
    constants = {name: getattr(rubber, name) for name in CONSTANTS}
    for name in constants:
        if name in given:
            faults.add(name, "material gives the rubber; remove one of the two")
    return {name: repr(value) for name, value in constants.items() if value != 0.0 and name not in given}


def _parameter(name, value, faults, path=None):
    """A value, an axis or a profile as TOML writes it; None after noting a fault."""
    units, path = PARAMETERS[name].units, path or name
    try:
        if isinstance(value, Profile) and name in VARYING and not value.is_free:
            knots = _profile(value.knots, units)
            return f"{{knots = {knots}, smooth = true}}" if value.smooth else knots
        if isinstance(value, Mapping):
            return _range(value, units, path, faults)
        if isinstance(value, tuple) and not (name in VARYING and _is_profile(value)):
            if len(value) != len(ENDS):
                faults.add(path, f"found a tuple of {len(value)}; (start, stop, step) makes a range, values are a list")
                return None
            return _range(dict(zip(ENDS, value)), units, path, faults)
        if callable(value):
            faults.add(
                path, "found a function; profiles of sweeps are pairs of x/l and value, which their atlas can keep"
            )
            return None
        if name in VARYING and _is_profile(value):
            return _profile(value, units)
        return _number(value, units)
    except ValueError as error:
        faults.add(path, str(error))
        return None


def _profile(pairs, units):
    return "[" + ", ".join(f"[{_number(u, '1')}, {_number(v, units)}]" for u, v in pairs) + "]"


def _is_profile(value):
    """Whether these are pairs."""
    if not isinstance(value, (list, tuple)) and not (isinstance(value, np.ndarray) and value.ndim == 2):
        return False
    return len(value) > 0 and all(isinstance(pair, (list, tuple, np.ndarray)) and np.size(pair) == 2 for pair in value)


def _range(table, units, path, faults):
    """{start, stop, step} or {start, stop, num, spacing}; what keys there may be is for the specification's reader."""
    written = []
    for key, value in table.items():
        text = _number(value, units) if key in ENDS else _plain(value, f"{path}.{key}", faults)
        written.append(f"{_key(key)} = {text}")
    return "{" + ", ".join(written) + "}"


def _number(value, units):
    """A number, or a list of them; texts stay, so that they are read in decimal as those of a file."""
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list) and any(isinstance(one, str) for one in value):
        return (
            "["
            + ", ".join(_text(one) if isinstance(one, str) else repr(numbers(one, units).tolist()) for one in value)
            + "]"
        )
    return repr(numbers(value, units).tolist())


def _key(name):
    return name if isinstance(name, str) and re.fullmatch("[A-Za-z0-9_-]+", name) else _text(str(name))


def _text(value):
    return json.dumps(value, ensure_ascii=False)


def _plain(value, path, faults):
    """A text, a truth, a whole number or a float as TOML writes it."""
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, Integral):
        return repr(int(value)) if abs(value) < 10**18 else "1000000000000000000"
    try:
        return repr(numbers(value, "1").item())
    except ValueError as error:
        faults.add(path, str(error))
        return '""'


def _designs(designs, faults):
    """Lines of [[designs]]: mappings of a name and the parameters of each."""
    if not isinstance(designs, (list, tuple)):
        faults.add("designs", f"found {described(designs)}; give a list of dictionaries, each with its name")
        return []
    lines = []
    for k, design in enumerate(designs):
        lines.append("[[designs]]")
        if not isinstance(design, Mapping):
            faults.add(f"designs[{k}]", f"found {described(design)}; give a dictionary with a name and parameters")
            continue
        for key, value in design.items():
            path = f"designs[{k}].{key}"
            text = _parameter(key, value, faults, path) if key in PARAMETERS else _plain(value, path, faults)
            lines += [] if text is None else [f"{_key(key)} = {text}"]
    return lines

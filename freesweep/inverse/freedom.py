"""What may change, read as a person gives it: ranges, lists of what can be bought, ties, profiles with free knots."""

import itertools
import math
import re

import numpy as np

from ..atlas.schema import PARAMETERS, SHAPE
from ..description.actuator import Actuator
from ..description.along import Profile
from ..description.elastomer import ELASTOMERS
from ..description.families import FAMILIES, followed, given_by
from ..description.faults import ActuatorError
from ..description.given import described, numbers
from ..description.material_library import material
from ..sweep.axis import outside
from .space import CONSTANTS, LOADS, Space
from .wishes import DESIGN

TIE = re.compile(r"\s*(-?)\s*(?:((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*\*\s*)?([a-z_0-9]+)\s*", re.ASCII)
KNOTTED = ("alpha", "beta", "wall", "radius")  # what may vary along the tube by free knots
MOST_CHOICES = 10_000  # of all lists together: each is looked at


class _Free:
    """What was read so far of what is free; it grows."""

    def __init__(self):
        self.names, self.low, self.high, self.ties, self.knots = [], [], [], {}, {}
        self.lists = []  # of lists of dicts, name -> value

    def span(self, name, held):
        """The ends of all values of a parameter (n,), of what is not free that which is ``held``."""
        own = [k for k, each in enumerate(self.names) if each.partition("[")[0] == name]
        ends = [end for k in own for end in (self.low[k], self.high[k])]
        for row in (row for rows in self.lists for row in rows):
            ends += [row[name]] if name in row else []
            ends += [getattr(row["material"], name)] if name in CONSTANTS and "material" in row else []
        return ends or [held[name]]


def read(template, free, faults):
    """The :class:`Space` of a ``template`` and what is ``free``; None after noting faults."""
    if not isinstance(template, Actuator):
        faults.append(f"template: found {described(template)}; give an Actuator")
        return None
    if given_by(template) != followed(template):
        faults.append(
            "template: its two families have one angle, as if they were one; give angles that differ, or beta=None"
        )
        return None
    if not isinstance(free, dict) or not free:
        faults.append(
            f"free: found {described(free)}; give a dict such as {{'alpha': (0, 85), 'radius': (3e-3, 12e-3)}}"
        )
        return None
    before, found = len(faults), _Free()
    absent, seen = set(FAMILIES) - set(given_by(template)), []
    for key, given in free.items():
        parts = _parts(key, absent, seen, faults)
        if parts:
            _read_one(key, parts, given, free, found, absent, faults)
    _check_constants(template.material, seen, faults)
    held = _held(template, absent)
    for name, (factor, other) in found.ties.items():
        wrong = [outside(name, factor * end, factor * end) for end in found.span(other, held)]
        if all(wrong):
            faults.append(f"free[{name!r}]: found {free[name]!r}, which gives {wrong[0].removeprefix('found ')}")
    count = math.prod(len(rows) for rows in found.lists)
    if count > MOST_CHOICES:
        faults.append(f"free: the lists make {count} choices; at most {MOST_CHOICES} are looked at")
    if not found.names and not found.lists and len(faults) == before:
        faults.append("free: nothing is free; give a range such as (0, 85), or a list of what can be bought")
    if len(faults) > before:
        return None
    choices = [{k: v for part in parts for k, v in part.items()} for parts in itertools.product(*found.lists)]
    low, high = np.array(found.low), np.array(found.high)
    return Space(template, tuple(found.names), low, high, found.ties, choices, found.knots, held)


def _held(template, absent):
    """The numbers of a template, without those of families that it has not."""
    lines = template.design()  # the first line is that of the one family, if there are not two
    held = lines | {name: lines["alpha"] for name in given_by(template)[:1]}
    held = {name: value for name, value in held.items() if name not in absent}
    return held | {name: getattr(template, name) for name in SHAPE}


def _parts(key, absent, seen, faults):
    """The parameters that a ``key`` names, those ``seen`` before among others; none after noting a fault."""
    parts = [part.strip() for part in key.split(",")] if isinstance(key, str) else [key]
    unknown = [part for part in parts if part not in (*DESIGN, *LOADS, "material")]
    if unknown:
        can = ", ".join((*DESIGN, "material", *LOADS))
        found = repr(unknown[0])[:60] if isinstance(key, str) else described(key)
        faults.append(f"free: found {found}; what may be free is {can}")
        return []
    if missing := absent.intersection(parts):
        faults.append(
            f"free[{key!r}]: the template has no family {missing.pop()}; give it an angle there, or leave this out"
        )
        return []
    if twice := [part for k, part in enumerate(parts) if part in (*seen, *parts[:k])]:
        faults.append(f"free[{key!r}]: {twice[0]} is free twice; keep one of both")
        return []
    seen += parts
    return parts


def _read_one(key, parts, given, free, found, absent, faults):
    """Read what is ``given`` of one key."""
    if isinstance(given, list):
        found.lists.append([dict(zip(parts, row)) for row in _read_list(key, parts, given, faults)])
    elif key == "material" or len(parts) > 1:
        example = "['ecoflex-00-30', 'natural-latex']" if key == "material" else "[(4.76e-3, 1.59e-3), ...]"
        faults.append(f"free[{key!r}]: found {described(given)}; give a list of what can be bought, such as {example}")
    elif isinstance(given, Profile):
        _read_profile(key, given, found, faults)
    elif isinstance(given, str):
        _read_tie(key, given, free, found, absent, faults)
    elif (pair := _read_range(key, given, faults)) is not None:
        found.names.append(key)
        found.low.append(pair[0])
        found.high.append(pair[1])


def _check_constants(rubber, seen, faults):
    """Constants of a rubber that no rubber has together, or that are given twice."""
    own = [name for name in CONSTANTS if name in seen]
    if own and "material" in seen:
        faults.append(f"free: found material and {', '.join(own)}; a rubber has its constants, so keep one of both")
        return
    has = {name for name in CONSTANTS if name in own or getattr(rubber, name) != 0.0}
    if own and "c01" in has and has & {"c20", "c30"}:
        faults.append(
            f"free: found {', '.join(own)} of a {type(rubber).__name__}; a rubber has c10 and c01 (MooneyRivlin), or c10,"
            " c20 and c30 (Yeoh): leave the others out, or give the template such a rubber"
        )


def _read_range(key, given, faults):
    try:
        pair = numbers(given, PARAMETERS[key].units)
    except ValueError as error:
        faults.append(f"free[{key!r}]: {error}")
        return None
    if pair.shape != (2,) or not np.all(np.isfinite(pair)) or not pair[0] < pair[1]:
        faults.append(
            f"free[{key!r}]: found {described(given)}; give (lowest, highest), the first below the second, a list of what"
            " can be bought, or a tie such as '-alpha'"
        )
        return None
    wrong = [fault for end, each in zip(pair.tolist(), given) if (fault := outside(key, end, each))]
    faults += [f"free[{key!r}]: {fault}" for fault in wrong]
    return None if wrong else pair.tolist()


def _read_profile(key, given, found, faults):
    if key not in KNOTTED:
        faults.append(f"free[{key!r}]: only {', '.join(KNOTTED)} may vary along the tube where they are free")
    elif not given.is_free:
        faults.append(
            f"free[{key!r}]: its knots are given; give a number of knots, and between, or put it in the template"
        )
    elif (pair := _read_range(key, given.between, faults)) is not None:
        found.knots[key] = given.knots
        found.names += [f"{key}[{k}]" for k in range(given.knots)]
        found.low += [pair[0]] * given.knots
        found.high += [pair[1]] * given.knots


def _read_tie(key, given, free, found, absent, faults):
    match = TIE.fullmatch(given)
    other = None if match is None else match[3]
    if other not in DESIGN:
        faults.append(
            f"free[{key!r}]: found {given!r}; a tie is a parameter, or a number times one: '-alpha', '0.3*radius'"
        )
    elif isinstance(free.get(other), str):
        faults.append(f"free[{key!r}]: tied to {other!r}, which is tied itself; tie it to what is free")
    elif other in absent:
        faults.append(f"free[{key!r}]: tied to {other!r}, a family that the template has not; give it an angle there")
    elif (own := PARAMETERS[key].units) != (its := PARAMETERS[other].units):
        faults.append(f"free[{key!r}]: found {given!r}; what is in [{own}] cannot follow what is in [{its}]")
    elif isinstance(free.get(other), Profile) and key not in KNOTTED:
        faults.append(
            f"free[{key!r}]: tied to {other!r}, whose profile is free; only {', '.join(KNOTTED)} may vary along the tube"
        )
    else:
        found.ties[key] = (-1.0 if match[1] else 1.0) * float(match[2] or 1.0), other


def _read_list(key, parts, given, faults):
    """Rows of values (parts,), each once."""
    if not given:
        faults.append(f"free[{key!r}]: an empty list; give what can be bought")
        return []
    before, read = len(faults), []
    for row in given:
        row = row if len(parts) > 1 else (row,)
        if not isinstance(row, (tuple, list)) or len(row) != len(parts):
            faults.append(f"free[{key!r}]: found {described(row)}; give {len(parts)} values each")
            continue
        values = tuple(_read_value(f"free[{key!r}]", part, value, faults) for part, value in zip(parts, row))
        if values not in read:
            read.append(values)
    return read if len(faults) == before else []


def _read_value(where, part, value, faults):
    """A rubber, or a number in the unit of the parameter ``part``; None after noting a fault."""
    try:
        if part == "material":
            return value if isinstance(value, ELASTOMERS) else material(value)
        number = numbers(value, PARAMETERS[part].units)
    except (ActuatorError, ValueError) as error:
        faults += [f"{where}: {text}" for text in getattr(error, "faults", [str(error)])]
        return None
    if number.ndim:
        faults.append(f"{where}: found {described(value)}; give one number of {part} in [{PARAMETERS[part].units}]")
        return None
    if fault := outside(part, number.item(), value):
        faults.append(f"{where}: {fault}")
        return None
    return number.item()

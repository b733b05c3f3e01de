"""Named designs of a sweep: a list of prototypes, which need not form a grid."""

import numpy as np

from ..atlas.schema import HELD, LOADS, PARAMETERS, SHAPE, YEOH
from ..description.families import FAMILIES, is_none
from ..description.units import shown
from . import axis
from .faults import Faults
from .rubber import SYNONYMS

AT_REST = {"held_length_ratio": 1.0, "held_rotation": 0.0}
DEFAULTS = {"fiber_extension": 1.0, "c01": 0.0, "force": 0.0, "torque": 0.0} | AT_REST  # fiber_radius: the inner radius
DEFAULTS |= dict.fromkeys((*YEOH, *SHAPE), 0.0)
OWN = tuple(name for name in PARAMETERS if name != "pressure")  # what may differ between designs
ELSEWHERE = SYNONYMS | {
    "pressure": "all designs share the pressures; give them in [axes] or [load]",
    "energy": "it belongs in [actuator] and cannot differ between designs",
    "material": "it belongs in [actuator]; designs of different rubbers give c10 and c01, or c10, c20 and c30",
}
ALL_ALIKE = (
    "is none; designs of one sweep have the same families: give none in [actuator], for all of them, and designs with such a"
    " family a sweep of their own"
)
HOME = {name: "load" if name in (*LOADS, *HELD) else "actuator" for name in PARAMETERS}


def read_designs(faults: Faults, tables, given: dict, fixed: dict) -> dict | None:
    """Names and columns of the designs, for Sweep.designs; None after noting that there are no tables.

    ``given`` maps parameters to where they are given, and gains those of the designs; ``fixed`` loses them.
    """
    if not isinstance(tables, list) or not tables or not all(isinstance(table, dict) for table in tables):
        faults.add("designs", f"found {shown(tables)}, must be tables: write [[designs]] above each design")
        return None
    names, rows = {}, []
    for i, table in enumerate(tables):
        path = f"designs[{i}]"
        faults.unknown_keys(table, ("name", *OWN), path, ELSEWHERE)
        name = table.get("name")
        if not isinstance(name, str) or not name.strip():
            faults.add(f"{path}.name", "is missing; give each design a name of its own")
        elif faults.line(f"{path}.name", name) in names:
            faults.add(f"{path}.name", f"{shown(name)} is also the name of designs[{names[name]}]; names must differ")
        else:
            names[name] = i
        for key in FAMILIES:
            if key in table and is_none(table[key]):
                faults.add(f"{path}.{key}", ALL_ALIKE)
        own = {key: table[key] for key in OWN if key in table and not (key in FAMILIES and is_none(table[key]))}
        rows.append({key: axis.value(faults, f"{path}.{key}", key, given) for key, given in own.items()})
    return {"names": tuple(names), "columns": _columns(faults, rows, given, fixed)}


def _columns(faults, rows, given, fixed):
    """Arrays, shape (designs,); a design that lacks a parameter takes its fixed value or default."""
    columns = {}
    for key in OWN:
        lacking = [i for i, row in enumerate(rows) if key not in row]
        if len(lacking) == len(rows):
            continue
        if given.get(key) == f"axes.{key}":
            faults.add(f"designs.{key}", f"given twice, also as axes.{key}; remove one")
        elif key in given and not lacking:
            faults.add(f"designs.{key}", f"every design gives it, so {given[key]} is never used; remove that")
        elif key not in given and lacking and key not in DEFAULTS:
            faults.add(
                f"designs[{lacking[0]}].{key}",
                f"is missing, but other designs give it; give it in every design or, for the rest, in [{HOME[key]}]",
            )
        given[key] = f"designs.{key}"
        column = [row.get(key, fixed.get(key, DEFAULTS.get(key))) for row in rows]
        columns[key] = np.array(column, dtype=float)  # None, after a fault, becomes NaN
        columns[key].setflags(write=False)
        fixed.pop(key, None)
    return columns

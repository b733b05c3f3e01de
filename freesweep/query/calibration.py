"""How much larger than its estimate an error may be: measured by the atlas itself, kept in its attributes.

The estimate is what the next order would add, and a share of the bounds of what is stored, which hold but are far from
sharp. Where the grid resolves the physics well it is sharp; where not, it falls short by factors that the measurement finds:
one for each decade of the estimate relative to the value, where all nodes that tell it are there, where some are holes, as
those on the other side of where fibers go slack, and where most is told from what fills these. Each piece of an axis has a
scale of its own, measured as well: where nodes are too few says nothing of where they are not.
"""

import json
from typing import NamedTuple

import numpy as np

ATTRIBUTE = "interpolation_measured"
TOLERANCE = "interpolation_tolerance"
ESTIMATES = 8  # which estimates were measured: of others, factors say nothing
DEFAULT_TOLERANCE = 1e-4
DECADES = np.arange(-11, -2)  # edges of the classes, log10 of estimate over value
CLASSES = len(DECADES) + 1
MOST_CELLS = 1000  # nodes of a table at most whose cells have factors of their own
RANKS = 100  # of the pieces of an axis at most: of longer ones some beside each other share one
CLEAR, NEAR_HOLES, FILLED = range(LYING := 3)  # told from nodes that are there; not all; more from what was put in
UNMEASURED = 12.0  # factor of an atlas that was not measured, or of a class with too few samples


class Factors(NamedTuple):
    """Of one variable: ``classes`` (LYING, CLASSES), by how it lies to holes, the share of stored ``bound`` that counts,
    ``scales`` (d, RANKS) of what the next order would add, and what share ``cells`` (nodes,) of a small table need of all
    that; (0,) where none has its own.
    """

    classes: np.ndarray
    bound: float
    scales: np.ndarray
    cells: np.ndarray = np.empty(0)


def ranks(count) -> np.ndarray:
    """Which rank the pieces of an axis with ``count`` nodes have, (count,)."""
    return (np.arange(count) * min(1.0, RANKS / count)).astype(int)


def cautious(count) -> Factors:
    """Factors of a variable over ``count`` axes that was not measured: bounds hold as they are."""
    return Factors(np.full((LYING, CLASSES), UNMEASURED), 1.0 / UNMEASURED, np.ones((count, RANKS)))


def factors(data, name, axes=(), nodes=0) -> Factors:
    """What was measured of one variable over ``axes``, by their names, with so many ``nodes``; else cautious numbers."""
    found = read(data).get("variables", {})
    try:
        found = found[name]
        numbers, share = np.array(found["factors"], float), float(found["bound"])
        scales = np.ones((len(axes), RANKS))
        for own, axis in zip(scales, axes):
            known = found["scales"].get(axis, [])
            own[: len(known)] = known
        cells = np.array(found.get("cells", []), float)
        sound = numbers.shape == (LYING, CLASSES) and share > 0.0 and len(cells) in (0, nodes)
        if sound and all(np.all(each > 0.0) for each in (numbers, scales, cells)):
            return Factors(numbers, share, scales, cells)
    except (AttributeError, KeyError, TypeError, ValueError):
        pass
    return cautious(len(axes))


def read(data) -> dict:
    """What the atlas measured of itself; empty if nothing, or if it was measured with other estimates than these."""
    try:
        found = json.loads(data.attrs.get(ATTRIBUTE, "{}"))
    except (TypeError, ValueError):
        return {}
    if not isinstance(found, dict) or not isinstance(found.get("variables", {}), dict):
        return {}
    return found if found.get("estimates") == ESTIMATES else {}


def tolerance(data) -> float:
    """Largest stated error of an answer, relative: lengths and volumes; ten times that for angles, loads, energies."""
    return float(data.attrs.get(TOLERANCE, DEFAULT_TOLERANCE))


def describe_measured(data) -> list:
    """Lines that tell what an atlas measured of itself."""
    found = read(data)
    if not found.get("variables"):
        return ["", "between its nodes", "  not measured: stated errors are cautious"]
    shares = ", ".join(f"{family.replace('_', ' ')} {share:.1%}" for family, share in found.get("answered", {}).items())
    lines = [
        "",
        f"between its nodes, against {found['designs']:,} random designs solved exactly",
        f"  answered within the tolerance {tolerance(data):g} (angles, loads, energies: ten times that): {shares}",
        f"  {'relative error of the answered':<34}{'designs':>9}{'answered':>10}{'median':>10}{'99 %':>10}{'worst':>10}",
    ]
    for name, measured in found["variables"].items():
        for region, row in measured["regions"].items():
            title = name if region == "all" else f"  region {region}"
            numbers = "".join(f"{'-' if number is None else format(number, '.1e'):>10}" for number in row[2:5])
            lines.append(f"  {title:<34}{row[0]:>9,}{row[1]:>10.1%}{numbers}")
    return lines

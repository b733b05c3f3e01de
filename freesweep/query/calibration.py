"""How much larger than its estimate an interpolation error may be: measured by the atlas itself, kept in its attributes.

The estimate is what the next order would add. Where the grid resolves the physics well it is sharp; where not, it falls
short by factors that the measurement finds: one for each decade of the estimate relative to the value. Stored bounds hold
everywhere but are far from sharp; the measurement says which share of them the errors reach.
"""

import json
from typing import NamedTuple

import numpy as np

ATTRIBUTE = "interpolation_measured"
TOLERANCE = "interpolation_tolerance"
DEFAULT_TOLERANCE = 1e-4
DECADES = np.arange(-9, -2)  # edges of the classes, log10 of estimate over value
UNMEASURED = 12.0  # factor of an atlas that was not measured, or of a class with too few samples


class Factors(NamedTuple):
    """Of one variable: factors (classes,) of the interpolation's estimate, and the share of stored bounds that is true."""

    classes: np.ndarray
    bound: float


def factors(data, name) -> Factors:
    """What was measured of one variable, else cautious numbers."""
    found = read(data).get("variables", {}).get(name, {})
    try:
        numbers = np.array(found["factors"], float)
        share = float(found["bound"])
        if numbers.shape == (len(DECADES) + 1,) and np.all(numbers > 0.0) and share > 0.0:
            return Factors(numbers, share)
    except (KeyError, TypeError, ValueError):
        pass
    return Factors(np.full(len(DECADES) + 1, UNMEASURED), 1.0)


def read(data) -> dict:
    """What the atlas measured of itself; empty if nothing."""
    try:
        found = json.loads(data.attrs.get(ATTRIBUTE, "{}"))
    except (TypeError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


def stated(factors: Factors, estimate, bound, size):
    """Stated errors (n,) from estimates of the interpolation and bounds of what was stored."""
    return factors.classes[classes(estimate, size)] * estimate + factors.bound * bound


def classes(estimate, size) -> np.ndarray:
    """Class of each estimate (n,) by its size relative to the value's."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.digitize(np.log10(np.maximum(estimate / size, 1e-300)), DECADES)


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

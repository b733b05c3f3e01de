"""An atlas measures itself: random designs between its nodes are solved exactly and compared with what it would answer."""

import json

import numpy as np

from .. import closed_form
from ..scaling import ACCURACIES
from ..status import VALUED
from . import calibration
from .answer import Inquiry
from .calibration import DECADES, UNMEASURED
from .family import FAMILIES
from .query import Reader
from .reference import ALPHA, BETA
from .refine import exact_answers

SEED = 20260101
MOST, LEAST, EACH = 20_000, 200, 40  # designs: at most, at least, and one for so many nodes
HELD_SHARE = 8  # held states cost more: so much fewer designs
SHARPER = 1e-2  # accuracy of the exact solutions, relative to that of the atlas
FEW = 200.0  # factors go beyond what was seen, the more the fewer designs were seen
BEYOND = 5e-4  # share of the designs of a class that may need more
SMALLEST, LEAST_SHARE = 0.3, 0.01  # of all factors, and of all shares of stored bounds
LITTLE = 0.1  # of the bound: an estimate that interpolation adds little
ENOUGH = 200  # designs of a class that speak for it
REGIONS = ("I", "IIa", "IIb")


def measure(data, designs=None) -> dict:
    """Attributes to store with an atlas' dataset: what :func:`measured` finds, as text."""
    found = measured(data, designs)
    return {calibration.ATTRIBUTE: json.dumps(found)} if found else {}


def measured(data, designs=None) -> dict:
    """Compare answers with exact solutions at random designs, drawn evenly over the whole grid.

    Returns ``designs`` (how many), ``answered`` (share by family) and ``variables``: name -> ``factors`` of the error
    estimate, ``bound`` (share of stored bounds that is true) and ``regions``: name -> [designs, share answered, median,
    99 %, worst error of the answered, median of stated over true error]; errors are relative to the value (small
    rotations to 0.1 degree, small loads to a hundredth of pi r^2 P).
    """
    reader = Reader(data)
    if not reader.frame.uniform_along_x:
        return {}
    answered, variables = {}, {}
    count = designs or int(np.clip(data["status"].size // EACH, LEAST, MOST))
    for key, family in FAMILIES.items():
        names = [name for name in family.variables if name in data]
        if key == "limit" or not names or not reader.table(key).names:
            continue
        own = max(count // HELD_SHARE, LEAST) if key.startswith("blocked") else count
        drawn = _draw(reader, reader.table(key), own)
        share, results = _family(reader, key, names, drawn)
        answered[key] = share
        variables |= results
    return {"designs": count, "seed": SEED, "answered": answered, "variables": variables}


def _draw(reader, table, count):
    """Axis -> (count,) random values over the ranges of a table's axes, and what the atlas fixes."""
    draw = np.random.default_rng(SEED)
    values = {}
    for axis in table.axes[: len(table.names)]:
        if axis.name == "design":
            values["design"] = draw.integers(len(axis.nodes), size=count).astype(float)
        else:
            values[axis.name] = draw.uniform(axis.values[0], axis.values[-1], count)
    return reader.complete(values, count)


def _family(reader, key, names, values):
    table = reader.table(key)
    inquiry = Inquiry(table, values)
    inquiry.flags()
    places = np.flatnonzero(inquiry.valued & ~inquiry.exact)
    accuracy = max(SHARPER * reader.frame.accuracy, ACCURACIES[0])
    exact = exact_answers(reader, key, inquiry.points[places], names, accuracy)
    solved = np.isin(exact[table.family.status], VALUED)
    good, kept = np.ones(len(places), bool), {}
    for name in names:
        value, estimate, bound = inquiry.estimate(name)
        size = inquiry.natural_size(name, value)[places]
        value, estimate, bound = value[places], estimate[places], bound[places]
        error = np.where(solved, np.abs(value - exact[name]), np.inf)
        factors = calibrate(error, estimate, bound, size)
        stated = calibration.stated(factors, estimate, bound, size)
        good &= stated <= reader.tolerance * (10.0 if inquiry.is_loose(name) else 1.0) * size
        kept[name] = (error, stated, size, factors)
        if name != "mid_radius":  # the flags ask for it
            table.forget(name)
    answered = np.zeros(inquiry.size, bool)
    answered[places[good]] = True
    regions, results = _regions(inquiry), {}
    for name, (error, stated, size, factors) in kept.items():
        rows = {}
        for region in ("all", *REGIONS):
            where = np.ones(inquiry.size, bool) if region == "all" else regions == region
            if where.any():
                pick = where[places] & good
                rows[region] = _row(int(where.sum()), answered[where].mean(), error[pick], stated[pick], size[pick])
        numbers = [float(f"{factor:.3g}") for factor in factors.classes]
        results[name] = {"factors": numbers, "bound": float(f"{factors.bound:.3g}"), "regions": rows}
    return float(answered.mean()), results


def calibrate(error, estimate, bound, size) -> calibration.Factors:
    """The least factors with which stated errors hold, with a margin: (n,) errors and what they are told from.

    Stored bounds are cautious: the share of them that is true shows where interpolation adds little.
    """
    classes = calibration.classes(estimate, size)
    factors, share = np.full(len(DECADES) + 1, UNMEASURED), LEAST_SHARE
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(2):
            needed = np.maximum(error - share * bound, 0.0) / estimate
            factors = _by_class(needed, classes)
            left = np.maximum(error - factors[classes] * estimate, 0.0) / bound
            plain = left[np.isfinite(left) & (estimate < LITTLE * bound)]
            if len(plain) < ENOUGH:
                return calibration.Factors(_by_class(np.maximum(error - bound, 0.0) / estimate, classes), 1.0)
            share = min(max(_high(plain), LEAST_SHARE), 1.0)
    return calibration.Factors(factors, share)


def _by_class(needed, classes):
    """The largest but a few of each class; classes with few designs ask their neighbours."""
    factors = np.full(len(DECADES) + 1, UNMEASURED)
    for k in range(len(factors)):
        for reach in range(len(factors)):
            mine = needed[(np.abs(classes - k) <= reach) & np.isfinite(needed)]
            if len(mine) >= ENOUGH:
                factors[k] = max(SMALLEST, _high(mine))
                break
    return factors


def _high(numbers):
    """The largest but five in ten thousand, and more where few designs cannot have met the worst."""
    return (1.0 + FEW / len(numbers)) * np.quantile(numbers, 1.0 - BEYOND)


def _regions(inquiry):
    regions = closed_form.region(inquiry.points[:, ALPHA], inquiry.points[:, BETA])
    return np.where(regions == "AF", "IIa", np.where(regions == "LM", "IIb", regions))


def _row(count, share, error, stated, size):
    if not len(error):
        return [count, 0.0, None, None, None, None]
    relative = error / size
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.median(stated / error)
    numbers = [share, *np.quantile(relative, [0.5, 0.99, 1.0]), ratio if np.isfinite(ratio) else 0.0]
    return [count, *(float(f"{number:.3g}") for number in numbers)]

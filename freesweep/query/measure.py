"""An atlas measures itself: random designs between its nodes are solved exactly and compared with what it would answer."""

import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from .. import closed_form
from ..scaling import ACCURACIES
from ..status import VALUED
from . import calibration, errors
from .answer import Inquiry
from .calibrate import calibrate, piece_scales
from .family import FAMILIES, FAMILY_OF
from .query import Reader
from .reference import ALPHA, BETA
from .refine import exact_answers

SEED = 20260101
MOST, LEAST, EACH = 40_000, 10_000, 40  # designs: at most, at least, and one for so many nodes
FEWEST, FEW = 2_000, 10_000  # at least, and at most, of physical tubes, which take a thousand times as long
FEWEST_BODIES = 500  # of bodies, each of which is followed along and solved by itself
HELD_SHARE, SLACK_SHARE = (
    2,
    4,
)  # held states cost more, shares and tensions are solved for once more: so much fewer designs
SHARPER = 1e-2  # accuracy of the exact solutions, relative to that of the atlas
LOOSE_SHARPER = 1.0  # where fibers go slack digits are dear, and what lies between nodes errs by far more
REGIONS = ("I", "IIa", "IIb")


def measure(data, designs=None) -> dict:
    """Attributes to store with an atlas' dataset: what :func:`measured` finds, as text."""
    found = measured(data, designs)
    return {calibration.ATTRIBUTE: json.dumps(found)} if found else {}


def measured(data, designs=None) -> dict:
    """Compare answers with exact solutions at random designs, drawn evenly over the whole grid.

    Returns ``designs`` (how many), ``answered`` (share by family) and ``variables``: name -> ``factors``, ``bound`` and
    ``scales`` of the error's estimate (see :class:`calibration.Factors`) and ``regions``: name -> [designs, share answered,
    median, 99 %, worst error of the answered, median of stated over true error]; errors are relative to the value (small
    rotations to 0.1 degree, small loads to a hundredth of pi r^2 P).
    """
    reader = Reader(data)
    if not reader.frame.in_numbers:
        return {}
    answered, variables = {}, {}
    least, most = (FEWEST, FEW) if reader.frame.model.is_physical else (LEAST, MOST)
    if reader.frame.bodies is not None:
        least, most = FEWEST_BODIES, FEWEST
    count = designs or int(np.clip(data["status"].size // EACH, least, most))
    for key, family in FAMILIES.items():
        names = [name for name in family.variables if name in data and FAMILY_OF[name] == key]
        names.sort(key=lambda name: name != "mid_radius")
        if key == "limit" or not names or not reader.table(key).names:
            continue
        again = key.endswith("slack") or key == "tension"
        own = count // (HELD_SHARE if key.startswith("blocked") else SLACK_SHARE if again else 1)
        drawn = _draw(reader, reader.table(key), own)
        share, results = _family(reader, key, names, drawn)
        answered[key] = share
        variables |= results
    head = {"designs": count, "seed": SEED, "estimates": calibration.estimates(data)}
    return head | {"answered": answered, "variables": variables}


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
    sharper = LOOSE_SHARPER if reader.frame.model.is_loose else SHARPER
    accuracy = max(sharper * reader.frame.accuracy, ACCURACIES[0])
    exact = exact_answers(reader, key, inquiry.points[places], names, accuracy)
    solved = np.isin(exact[FAMILIES[key].answer_status], VALUED)
    with ThreadPoolExecutor(table.together) as pool:
        kept = dict(
            zip(names, pool.map(lambda name: _compare(inquiry, name, places, exact[name], solved, reader), names))
        )
    good = np.ones(len(places), bool)
    for _, stated, _, allowed, _ in kept.values():
        good &= stated <= allowed
    answered = np.zeros(inquiry.size, bool)
    answered[places[good]] = True
    regions, results = _regions(inquiry), {}
    for name, (error, stated, size, _, factors) in kept.items():
        rows = {}
        for region in ("all", *REGIONS):
            where = np.ones(inquiry.size, bool) if region == "all" else regions == region
            if where.any():
                pick = where[places] & good
                rows[region] = _row(int(where.sum()), answered[where].mean(), error[pick], stated[pick], size[pick])
        axes = {axis.name: row.tolist() for axis, row in zip(table.axes, factors.scales) if np.any(row != 1.0)}
        found = {"factors": factors.classes.tolist(), "bound": factors.bound, "scales": axes}
        results[name] = found | {"regions": rows}
    return float(answered.mean()), results


def _compare(inquiry, name, places, exact, solved, reader):
    """``(error, stated error, size, allowed error, factors)`` of one variable at ``places`` (k,) where it is compared."""
    scales = piece_scales(inquiry, name, places, np.where(solved, exact, np.nan))
    value, estimate, bound, beside = inquiry.estimate(name, scales)
    size = inquiry.natural_size(name, value)[places]
    value, estimate, bound, beside = value[places], estimate[places], bound[places], beside[places]
    allowed = reader.tolerance * (10.0 if inquiry.is_loose(name) else 1.0) * size
    error = np.where(solved, np.abs(value - exact), np.inf)
    factors = calibrate(error, estimate, bound, size, beside, allowed)._replace(scales=scales)
    inquiry.table.forget(name)
    return error, errors.stated(factors, estimate, bound, size, beside), size, allowed, factors


def _regions(inquiry):
    if len(inquiry.table.predictor.families) < 2:
        return np.full(inquiry.size, "")
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

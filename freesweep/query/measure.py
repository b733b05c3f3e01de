"""An atlas measures itself: random designs between its nodes are solved exactly and compared with what it would answer."""

import functools
import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from .. import closed_form
from ..scaling import ACCURACIES
from ..status import NOT_CONVERGED, VALUED
from . import calibration, errors, exact
from .answer import Inquiry
from .calibrate import calibrate, cell_factors, piece_scales
from .family import FAMILIES, FAMILY_OF
from .query import Reader
from .reference import ALPHA, BETA
from .refine import solved_states, told_of
from .table import MUCH, TOGETHER

SEED = 20260101
MOST, EACH = 40_000, 40  # designs: at most, and one for so many nodes
FEW, LEAST, FOR_EACH = 6_000, 10_000, 2  # at least, and at least of more than a few nodes, so many for each
BODIES = 500, 2_000  # at least and at most of bodies, each of which is followed along and solved by itself
HELD_SHARE = 2  # held states cost more: so much fewer designs
DOUBTFUL = 0.1  # of the allowed error: how much an exact number may leave open of itself
SHARPER = (1e-2, 0.1, 1.0)  # accuracies of the exact solutions, relative to the atlas': the first that vectors reach
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
    nodes, of_bodies = data["status"].size, reader.frame.bodies is not None
    least, most = BODIES if of_bodies else (int(np.clip(FOR_EACH * nodes, FEW, LEAST)), MOST)
    count = designs or int(np.clip(nodes // EACH, least, most))
    kinds = {}  # of states that are solved: their families
    for key, family in FAMILIES.items():
        names = [name for name in family.variables if name in data and FAMILY_OF[name] == key]
        if names and key != "limit":
            kinds.setdefault(family.kind, {})[key] = sorted(names, key=lambda name: name != "mid_radius")
    exact.load()  # no thread shall import what others compile with
    with ThreadPoolExecutor(TOGETHER if data["status"].size <= MUCH else 1) as pool:
        found = list(pool.map(lambda families: _of_kind(reader, families, count), kinds.values()))
    found = {key: result for own in found for key, result in own.items()}
    found = {key: found[key] for key in FAMILIES if key in found}
    head = {"designs": count, "seed": SEED, "estimates": calibration.ESTIMATES}
    return head | {
        "answered": {key: share for key, (share, _) in found.items()},
        "variables": {name: result for _, results in found.values() for name, result in results.items()},
    }


def _of_kind(reader, families, count):
    """Share answered and what was measured of the variables (key -> names) of ``families`` that tell of the same states."""
    found, solved = {}, {}
    for key, names in families.items():
        table = reader.table(key)
        if not table.names:
            continue
        inquiry = Inquiry(table, _draw(reader, table, count // (HELD_SHARE if key.startswith("blocked") else 1)))
        solve = functools.partial(_solved, reader, key, inquiry, solved)
        found[key] = _family(reader, key, names, inquiry, solve)
    return found


def _solved(reader, key, inquiry, known):
    """Exact states (n,) by name where numbers are given: those ``known`` by the axes that they vary in, and which of them,
    with those that are found for it: of other families fewer may have been given.
    """
    inquiry.flags()
    found, done = known.setdefault(tuple(inquiry.table.names), ({}, np.zeros(inquiry.size, bool)))
    left = inquiry.valued & ~inquiry.exact & ~done
    if left.any() or not found:
        _solve(reader, key, inquiry, np.flatnonzero(left), found)
        done |= left
    return found


def _solve(reader, key, inquiry, left, found):
    """Put exact states at the places ``left`` (k,) into what is ``found``, (n,) by name: what vectors do not find is not
    solved, but for held physical tubes, of which they know nothing.
    """
    thorough = reader.frame.model.is_physical and key.startswith("blocked")
    for sharper in SHARPER:
        accuracy = max(sharper * reader.frame.accuracy, ACCURACIES[0])
        states = solved_states(reader, key, inquiry.points[left], accuracy, thorough)
        for name, array in states.items():
            found.setdefault(
                name, np.full(inquiry.size, np.nan if array.dtype.kind == "f" else NOT_CONVERGED, array.dtype)
            )
            found[name][left] = array
        left = left[states["status"] == NOT_CONVERGED]


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


def _family(reader, key, names, inquiry, solve):
    """Share answered of one family, and what was measured of its variables, beside exact states that ``solve()`` gives.

    These are solved while the first tables are made.
    """
    table = inquiry.table
    with ThreadPoolExecutor(1) as aside, ThreadPoolExecutor(table.together) as pool:
        solving = aside.submit(solve)

        def compare(name):
            interpolated = inquiry.interpolated(name)
            states = solving.result()
            places = np.flatnonzero(inquiry.valued & ~inquiry.exact)
            exact = told_of(reader, key, [name], states)
            solved = np.isin(exact[FAMILIES[key].answer_status][places], VALUED)
            own = exact[name][places], exact[f"{name}_error"][places]
            return _compare(inquiry, name, places, *own, solved, interpolated, reader.tolerance)

        kept = dict(zip(names, pool.map(compare, names)))
    table.release()
    places = np.flatnonzero(inquiry.valued & ~inquiry.exact)
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
                pick = where[places] & good & np.isfinite(error)  # what was solved
                rows[region] = _row(int(where.sum()), answered[where].mean(), error[pick], stated[pick], size[pick])
        of_axes = zip(table.axes, table.ranks, factors.scales)
        axes = {axis.name: row[: own.max() + 1].tolist() for axis, own, row in of_axes if np.any(row != 1.0)}
        found = {"factors": factors.classes.tolist(), "bound": factors.bound, "scales": axes}
        found |= {"cells": factors.cells.tolist()} if len(factors.cells) else {}
        results[name] = found | {"regions": rows}
    return float(answered.mean()), results


@np.errstate(all="ignore")  # where there is no number there is nothing to compare
def _compare(inquiry, name, places, exact, open_of_exact, solved, interpolated, tolerance):
    """``(error, stated error, size, allowed error, factors)`` of one variable at ``places`` (k,) where it is compared.

    Where the ``exact`` number itself leaves much open of what is allowed, as of tensions at clamped ends, that is no error
    of the atlas.
    """
    inquiry = inquiry.of(name)
    scales = piece_scales(inquiry, name, interpolated, places, np.where(solved, exact, np.nan))
    value, estimate, bound, beside = inquiry.estimate(name, scales, interpolated)
    size = inquiry.natural_size(name, value)[places]
    value, estimate, bound, beside = value[places], estimate[places], bound[places], beside[places]
    allowed = tolerance * (10.0 if inquiry.is_loose(name) else 1.0) * size
    left_open = np.where(open_of_exact > DOUBTFUL * allowed, open_of_exact, 0.0)
    error = np.where(solved, np.maximum(np.abs(value - exact) - left_open, 0.0), np.inf)
    factors = calibrate(error, estimate, bound, size, beside, allowed)._replace(scales=scales)
    stated, cell = errors.stated(factors, estimate, bound, size, beside), inquiry.cell[places]
    factors = factors._replace(cells=cell_factors(error, stated, cell, inquiry.table.size))
    inquiry.table.forget(name)
    return error, errors.stated(factors, estimate, bound, size, beside, cell), size, allowed, factors


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

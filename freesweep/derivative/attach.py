"""Derivatives of a Dataset's outputs, put beside them."""

import warnings
from functools import cache

import numpy as np

from .. import status
from ..description.splines import SENSITIVITY
from ..scaling import SLACK
from .equilibrium import NotFound
from .request import attributes
from .rest import is_at_rest

GUESS = 1e-6  # accuracy of shapes to begin from: with 1e-4 some that stretch twentyfold are lost
SAME, BOUNDS = 1e-7, 4.0  # scaled, and in bounds: by how much a state may differ from the one that was found
RULE, OF_RULE = (
    1e-5,
    10.0,
)  # scaled: what sums over a thick wall may differ by, of which a body has several rules; in bounds
# scaled, likewise, of a buckled tube: meshes hold its fronts where they are, and derivatives hang on that; in bounds: that
# part of the error does not fall as the others do, 9 times was the most of 34
FRONTS, OF_FRONTS = 1e-10, 15.0
MANY = 64  # states for which it is worth to compile vectors
LOST = "derivatives: {count} of {all} states were not met again on meshes of their own; theirs are NaN"


def shapes_of(asked, solve, finer=0):
    """Stretches (states, places) at the places of what is ``asked``: from ``solve(stations, accuracy)``."""
    places, tube = asked.places(finer), asked.tube
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # who asks has been warned
        shapes = solve(np.minimum(places * tube.length, tube.length), GUESS)
    return shapes["deformed_radius"].values.reshape(-1, len(places)) / tube.fiber_surface_at(places)


def attach(result, asked, loads, solve, target=None):
    """Add derivatives to a ``result``: ``loads``, name -> array over its dimensions (those of ``status``), in SI units;
    ``solve(stations, accuracy)`` gives shapes to begin from; ``target``: what is held, like the loads.
    """
    dims, shape = result["status"].dims, result["status"].shape
    todo = np.flatnonzero(np.isin(result["status"].values, status.VALUED))
    loads = {name: np.ravel(value)[todo] for name, value in loads.items()}
    target = None if target is None else np.ravel(target)[todo]
    known = np.array([np.ravel(result[name].values)[todo] for name in asked.outputs])
    near = np.array([np.ravel(result[f"{name}_error"].values)[todo] for name in asked.outputs])
    values, bounds = asked.cylinders(loads, target, known)
    units = asked.units(loads)
    same = _are_same(asked.first, (values, bounds), known, near, units)
    values[..., ~same] = bounds[..., ~same] = np.nan
    left = np.flatnonzero(~same)
    if asked.is_alike and len(left) and is_worth_vectors(len(left)):
        found = asked.states(
            {name: value[left] for name, value in loads.items()}, None if target is None else target[left],
            [np.ravel(one)[todo][left] for one in (result["mid_radius"].values, _is_limp(result))],
        )  # fmt: skip
        done = _are_same(asked.first, found, known[:, left], near[:, left], units[:, left])
        values[..., left[done]], bounds[..., left[done]] = (array[..., done] for array in found)
        same[left[done]] = True
    shapes, lost = cache(lambda finer: shapes_of(asked, solve, finer)), 0
    for i in np.flatnonzero(~same):
        own, held = _at(loads, i), None if target is None else float(target[i])
        rest = is_at_rest(own, asked.held, held, asked.tube)
        try:
            found = asked.at_rest(own) if rest else asked.state(own, held, lambda finer, i=i: shapes(finer)[todo[i]])
            found = tuple(array[..., None] for array in found)
            here = slice(i, i + 1)
            given = asked.first, found, known[:, here], near[:, here], units[:, here]
            if not np.all(_are_same(*given, FRONTS if asked.is_buckled else SAME)):
                if not (asked.tube.is_thick and asked.tube.varies and np.all(_are_same(*given, RULE))):
                    raise NotFound
                was, unit = (array[: asked.first, here] for array in (known, units))
                off = np.max(np.abs(found[0][: asked.first, 0] - was) / np.maximum(np.abs(was), unit))
                found = found[0], found[1] + OF_RULE * off * np.abs(found[0])
            if asked.is_buckled:
                found = found[0], OF_FRONTS * found[1]
        except NotFound:
            lost += 1
            continue
        values[..., i], bounds[..., i] = found[0][..., 0], found[1][..., 0]
    if lost:
        warnings.warn(LOST.format(count=lost, all=len(todo)), stacklevel=4)
    bounds += SENSITIVITY * asked.error * np.abs(values)
    off = ~_fit((values, bounds), known, near, asked.units(loads))
    off[: asked.first] = False
    values[off.nonzero()[0], :, off.nonzero()[1]] = bounds[off.nonzero()[0], :, off.nonzero()[1]] = np.nan
    units = {name: result[name].attrs["units"] for name in asked.outputs}
    return result.assign(dict(_variables(asked, values, bounds, units, todo, dims, shape)))


def is_worth_vectors(count):
    """Whether so many states are worth the compiler's time, or it was spent already."""
    from ..interpret import is_at_hand
    from ..solver.lanes.responses import differentiate_lanes

    return count >= MANY or is_at_hand(differentiate_lanes)


def _is_limp(result):
    """Where some family of fibers goes slack along a part."""
    shares = (result[name].values for name in SLACK if name in result)
    return np.any([(share > 0.0) & (share < 1.0) for share in shares], axis=0)


def _at(loads, i):
    return {name: float(value[i]) for name, value in loads.items()}


def _are_same(first, *given):
    """Which states (n,) have those of the ``first`` outputs that are known."""
    return np.all(_fit(*given)[:first], axis=0)


def _fit(found, known, near, units, same=SAME):
    """Which outputs (outputs, n) are those that are ``known``, about within both bounds, or ``same`` units: where one of a
    thousand is too small, that is no other state.
    """
    values, bounds = found[0][:, 0], found[1][:, 0]
    return (np.abs(values - known) <= BOUNDS * (near + bounds) + same * units) | np.isnan(known)


def _variables(asked, values, bounds, units, todo, dims, shape):
    """(name, variable) of each derivative and its bound; ``units`` of outputs by name."""
    whole = np.full((2, *values.shape[:2], int(np.prod(shape))), np.nan)
    whole[0][..., todo], whole[1][..., todo] = values, bounds
    for i, output in enumerate(asked.outputs):
        for j, name in enumerate(asked.parameters):
            one, about = f"d_{output}_d_{name}", attributes(output, name, asked.tube, units[output])
            value, bound = (array[i, 1 + j].reshape(shape) for array in whole)
            yield one, (dims, value, about)
            yield f"{one}_error", (dims, bound, about | {"long_name": f"error bound of {one}"})

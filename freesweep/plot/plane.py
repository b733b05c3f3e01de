"""A variable of a dataset on the two quadrants of fiber angles: everything but alpha and beta chosen, symmetry used.

Swapping alpha and beta changes nothing; negating both mirrors the tube, so rotation and torque change sign. A node of
the two quadrants that the dataset does not store is taken from its mirror images, if one of them is stored; one that lies
between the nodes of an image, whose steps are other ones where the axes change places, is taken linear between them, as
contours are.
"""

from typing import NamedTuple

import numpy as np

from ..atlas import schema
from ..status import OK, OUTSIDE, VALUED
from .between import between
from .choice import DESIGN, check_name, choose, dimensions, read_selection

ALPHA, BETA = (0.0, 90.0), (-90.0, 90.0)  # the two quadrants of Figure 1-2 [degree]
ODD = ("rotation", "locked_rotation", "blocked_torque", "ideal_blocked_torque")  # change sign in the mirror
POLE_ON_AF = ("blocked_torque", "ideal_blocked_torque")
NO_VALUE = -1  # solved, and yet no number: no limit pressure was met
SAME_ANGLE = 1e-4  # [degree]: nodes closer than this are one


class Plane(NamedTuple):
    """A variable over two axes, called ``names``, everything in stored units: nodes of shapes (n,) and (m,); ``values``,
    masked where there is none, and ``reason``, both of shape (m, n); masks of the ``parts`` between which no contour may
    run; ``point`` holds the parameters that were chosen.
    """

    names: tuple
    x: np.ndarray
    y: np.ndarray
    values: np.ma.MaskedArray
    reason: np.ndarray
    parts: list
    point: dict


def status_of(variable: str) -> str:
    """Name of the status that says why a value of ``variable`` is missing."""
    own = f"{variable}_status"
    return own if own in schema.STATUS_OF else "locked_status" if variable.startswith("locked_") else "status"


def plane(dataset, variable: str, select: dict, kinds: bool = False) -> Plane:
    """``variable`` of an xarray Dataset at ``select`` (name: value in stored units), between nodes as a query answers there.

    ``kinds``: its values are flags, between which there is nothing: the nearest node's are taken.
    What is not selected: the largest pressure, the force and torque nearest zero, the middle of anything else. Raises
    ValueError for names that are unknown, values that are no numbers, and a dataset without a plane of angles.
    """
    select = read_selection(select)
    missing = [name for name in ("alpha", "beta") if dataset.sizes.get(name, 0) < 2]
    if missing:
        sizes = ", ".join(f"{name} ({size})" for name, size in dataset.sizes.items()) or "none"
        raise ValueError(
            f"a map needs alpha and beta as dimensions of two nodes or more; {' and '.join(missing)} "
            f"{'is' if len(missing) == 1 else 'are'} not (dimensions: {sizes})"
        )
    on_plane = [name for name in schema.VARIABLES if name in dataset and {"alpha", "beta"} <= set(dataset[name].dims)]
    check_name(variable, on_plane, "variable")
    check_name(status_of(variable), dataset.data_vars, "status variable")

    dataset = between(dataset, variable, select, ("alpha", "beta"))
    point, index = choose(dataset, select, ("alpha", "beta"))
    values, others = (_sheet(dataset[name], index) for name in (variable, schema.EXCHANGED.get(variable, variable)))
    status = _sheet(dataset[status_of(variable)], index)
    free = schema.VARIABLES[variable].without
    turns = any(point.get(name, 0.0) != 0.0 and name not in free for name in ("torque", "held_rotation"))
    alpha, beta, values, status = _unfold(dataset, values, others, status, variable in ODD, turns, kinds)

    point = point.only(lambda name: name not in free)
    return _plane(("alpha", "beta"), alpha, beta, values, status, variable, point)


def section(dataset, variable: str, x: str, y: str, select: dict, kinds: bool = False) -> Plane:
    """``variable`` over any two axes of a dataset, else as :func:`plane`; over both angles it is that plane."""
    if {x, y} == {"alpha", "beta"}:
        return plane(dataset, variable, select, kinds)
    select = read_selection(select)
    known = [name for name in schema.VARIABLES if name in dataset]
    check_name(variable, known, "variable")
    check_name(status_of(variable), dataset.data_vars, "status variable")
    axes = [name for name in dimensions(dataset) if name in dataset[variable].dims and dataset.sizes[name] > 1]
    for name in (x, y):
        check_name(name, [axis for axis in axes if axis != DESIGN], f"axis of {variable} with two nodes or more")
    if x == y:
        raise ValueError(f"a map needs two different axes, found {x} twice")
    dataset = between(dataset, variable, select, (x, y))
    point, index = choose(dataset, select, (x, y))
    order = [np.argsort(dataset[name].values.astype(float)) for name in (y, x)]
    values, status = (_sheet(dataset[name], index, (y, x))[np.ix_(*order)] for name in (variable, status_of(variable)))
    free = schema.VARIABLES[variable].without
    point = point.only(lambda name: name not in free)
    nodes = [dataset[name].values.astype(float)[at] for name, at in zip((x, y), reversed(order))]
    return _plane((x, y), *nodes, values, status, variable, point)


def _plane(names, x, y, values, status, variable, point):
    none = ~np.isfinite(values)
    if variable != "limit_pressure":  # which has a value just where the state has none
        none |= ~np.isin(status, VALUED)
    reason = np.where(none & np.isin(status, VALUED), NO_VALUE, status)
    if variable == "limit_pressure":
        reason[~none] = OK
    return Plane(names, x, y, np.ma.array(values, mask=none), reason, _parts(names, x, y, variable, point), point)


def _parts(names, x, y, variable, point):
    """Masks (m, n) between which no contour may run: DF is degenerate where fibers may push, or are locked, and a blocked
    torque has a pole on AF.
    """
    grid = dict(zip(names, np.meshgrid(x, y)))
    whole = np.ones((y.size, x.size), bool)
    alpha, beta = (grid.get(name, point.get(name)) for name in ("alpha", "beta"))
    if alpha is None or beta is None:
        return [whole]
    # what the families exchange there jumps, and no locked shape is there
    crossed = point.model.is_loose and variable not in schema.EXCHANGED and not variable.startswith("locked_")
    parts = [whole] if crossed else [whole & (alpha > beta), whole & (alpha < beta)]
    if variable in POLE_ON_AF:
        parts = [part & half for part in parts for half in (alpha > -beta, alpha < -beta)]
    return parts


def _sheet(array, index, names=("beta", "alpha")):
    chosen = array.isel({name: at for name, at in index.items() if name in array.dims})
    return chosen.transpose(*names).values


def _unfold(dataset, values, others, status, odd, turns, kinds):
    """Nodes, values and status on the two quadrants; ``others`` are the values where the families change places, ``turns``:
    a torque is applied, the mirror would reverse it.
    """
    a, b = (dataset[name].values.astype(float) for name in ("alpha", "beta"))
    images = [(a, b, values, status), (b, a, others.T, status.T)]
    if not turns:
        sign = -1.0 if odd else 1.0
        images += [(-x, -y, sign * v, s) for x, y, v, s in images]
    alpha = _nodes([image[0] for image in images], ALPHA)
    beta = _nodes([image[1] for image in images], BETA)
    if min(alpha.size, beta.size) < 2:
        raise ValueError("the dataset has fewer than two nodes of alpha or beta in 0..90 and -90..90 degrees")
    full = np.full((beta.size, alpha.size), np.nan)
    reason = np.full(full.shape, OUTSIDE)
    for around in (_at, _around):
        for x, y, v, s in images:
            columns, rows = around(alpha, x), around(beta, y)
            take = (rows.inside[:, None] & columns.inside) & (reason == OUTSIDE)
            found, why = _mixed(v, s, rows, columns, kinds)
            full, reason = np.where(take, found, full), np.where(take, why, reason)
    return alpha, beta, full, reason


def _nodes(axes, window):
    """The stored nodes in the window, and beyond their range those of the images."""
    inside = [np.unique(axis[(axis >= window[0]) & (axis <= window[1])]) for axis in axes]
    nodes = inside[0]
    for other in inside[1:]:
        if nodes.size:
            other = other[(other < nodes[0] - SAME_ANGLE) | (other > nodes[-1] + SAME_ANGLE)]
        nodes = np.union1d(nodes, other)
    return nodes + 0.0  # no negative zero


class Around(NamedTuple):
    """For each node the places of two ``stored`` ones around it, the share of the second, and whether there are such."""

    below: np.ndarray
    above: np.ndarray
    share: np.ndarray
    inside: np.ndarray


def _at(nodes, stored):
    """The stored nodes that are these."""
    distance = np.abs(nodes[:, None] - stored)
    nearest = distance.argmin(axis=1)
    return Around(nearest, nearest, np.zeros(len(nodes)), distance.min(axis=1) < SAME_ANGLE)


def _around(nodes, stored):
    """The stored nodes below and above these."""
    order = np.argsort(stored)
    after = np.clip(np.searchsorted(stored[order], nodes - SAME_ANGLE), 1, len(order) - 1)
    below, above = order[after - 1], order[after]
    share = (nodes - stored[below]) / (stored[above] - stored[below])
    exact = np.abs(nodes - stored[above]) < SAME_ANGLE
    return Around(below, above, np.where(exact, 1.0, share), exact | ((share >= 0.0) & (share < 1.0)))


def _mixed(values, status, rows, columns, kinds):
    """Values linear between the nodes around, or of ``kinds`` the nearest; the status of the worst node that counts."""
    shape = (len(rows.share), len(columns.share))
    found, why, most = np.zeros(shape), np.full(shape, OK), np.zeros(shape)
    for row, v in ((rows.below, 1.0 - rows.share), (rows.above, rows.share)):
        for column, w in ((columns.below, 1.0 - columns.share), (columns.above, columns.share)):
            weight, place = v[:, None] * w, np.ix_(row, column)
            counts = weight > 0.0
            if kinds:
                found = np.where(weight > most, values[place], found)
                most = np.maximum(weight, most)
            else:
                found = found + np.where(counts, weight * values[place], 0.0)
            worse = counts & (np.isin(why, VALUED) & ((status[place] > why) | ~np.isin(status[place], VALUED)))
            why = np.where(worse, status[place], why)
    return found, why

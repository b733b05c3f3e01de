"""A dataset at values between its nodes, as a query of the atlas answers them: plots show what was asked."""

from itertools import product
from numbers import Real

import numpy as np

from ..atlas.schema import EXCHANGED, status_of
from ..status import NOT_INTERPOLABLE, VALUED
from .choice import DESIGN, choose, dimensions

EXACT = 1e-2  # stated error of what is drawn, relative: a step of the colour bar is larger
SAME = 1e-9  # relative: nearer to a node than that, the node is meant
TUBE = {"alpha", "beta", "length", "radius", "wall", "c10"}  # coordinates of tubes that do not vary along x


def between(dataset, variable: str, select: dict, across):
    """The dataset with what concerns ``variable`` interpolated to the values of ``select`` that are no nodes of its axes.

    Those axes become single values; ``across`` names the axes that are drawn, along which nothing is interpolated. Where a
    neighbouring node has failed, its status stands. A dataset that a query cannot answer is given back as it is.
    """
    asked = {name: float(value) for name, value in select.items() if _is_between(dataset, name, value)}
    if not asked or set(asked) & set(across) or "x" in dataset.sizes or not set(dataset.coords) >= TUBE:
        return dataset
    from ..query.family import FAMILIES, FAMILY_OF, IDEAL
    from ..query.query import Reader

    if FAMILY_OF.get(variable, "limit") == "limit" and variable not in IDEAL:
        return dataset
    rest = {name: value for name, value in select.items() if name not in asked}
    _, index = choose(dataset, rest, (*across, *asked))
    part = dataset.isel(index)
    names = [name for name in dimensions(part) if name not in asked]
    nodes = [np.arange(part.sizes[name]) if name == DESIGN else part[name].values for name in names]
    shape = tuple(len(one) for one in nodes)
    grid = {name: array.astype(float).ravel() for name, array in zip(names, np.meshgrid(*nodes, indexing="ij"))}
    size = int(np.prod(shape))
    values = grid | {name: np.full(size, value) for name, value in asked.items()}
    reader = Reader(part)
    wanted = [variable]
    if variable in EXCHANGED:  # the other family's is its mirror image; the flags are those of a state's other numbers
        wanted += [EXCHANGED[variable], "mid_radius"]
    found = reader.answer(values, size, wanted, tolerance=EXACT, sure=False)
    if variable in FAMILY_OF:
        found[status_of(variable)] = found[FAMILIES[FAMILY_OF[variable]].answer_status]
    made = part.isel(dict.fromkeys(asked, 0)).assign_coords(
        {name: part[name].isel({name: 0}).copy(data=value) for name, value in asked.items()}
    )
    kept = {name: array.reshape(shape) for name, array in found.items() if name in part}
    made = made[list(kept)]
    for name, array in kept.items():
        dims = [each for each in names if each in made[name].dims]
        array = array[tuple(slice(None) if each in dims else 0 for each in names)]
        if name.endswith("status"):
            array = _with_failures(part[name], asked, dims, array)
        made[name] = (dims, array, dict(part[name].attrs))
    return made


def _is_between(dataset, name, value):
    """Whether a value lies between two nodes of a numeric axis."""
    if name == DESIGN or name not in dataset.dims or name not in dataset.coords or not isinstance(value, Real):
        return False
    nodes = dataset[name].values.astype(float)
    near = np.abs(nodes - value).min() <= SAME * np.abs(nodes).max()
    return not near and nodes.min() < value < nodes.max()


def _with_failures(stored, asked, dims, status):
    """The statuses of the nodes around where those have no number, those of answers elsewhere."""
    own = {name: value for name, value in asked.items() if name in stored.dims}
    after = {name: int(np.searchsorted(stored[name].values, value)) for name, value in own.items()}
    shown = np.where(np.isin(status, VALUED), status, NOT_INTERPOLABLE)
    for sides in product((0, 1), repeat=len(own)):
        corner = stored.isel({name: after[name] - side for name, side in zip(own, sides)}).transpose(*dims).values
        shown = np.where(np.isin(corner, VALUED), shown, corner)
    return shown

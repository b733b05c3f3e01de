"""The slice of an atlas that becomes a table: its axes, what it holds there, its slopes."""

import math

import numpy as np

from ..atlas.schema import PARAMETERS, attributes
from ..atlas.store import Atlas
from ..description.given import described, numbers
from ..description.options import read_switch
from ..query.faults import QueryError, unknown
from ..query.query import check_names

MOST_ROWS = 5_000_000  # of one table
SAME = 1e-12  # relative: nearer to a node than that, the node is meant
DERIVED = "derivatives of the interpolant, without a bound"


def chosen(atlas: Atlas, variables, derivatives, at: dict):
    """The Dataset of ``variables`` over those axes that ``at`` does not give as single values.

    An axis that ``at`` leaves out stands with its own nodes; numbers at nodes are the stored ones, between them those of a
    query. ``derivatives``: those of each variable by each axis, too. Raises :class:`QueryError`.
    """
    given, at, faults = at, dict(at), []
    atlas = _of_design(atlas, at, faults)
    names = check_names(atlas._reader, variables)
    derivatives = read_switch("derivatives", derivatives, faults)
    if faults:
        raise QueryError(faults)
    frame = atlas._reader.frame
    values = {}
    for name in atlas._reader.needed(names):
        values[name] = _numbers(name, at.pop(name), faults) if name in at else frame.values[name]
    for name, value in at.items():  # of one value, or of no use to these variables
        if name not in frame.values:
            faults.append(unknown("axis", name, frame.asked))
        else:
            values[name] = _numbers(name, value, faults)
    if not faults and (rows := math.prod(np.size(value) for value in values.values())) > MOST_ROWS:
        faults.append(f"{rows:,} rows, at most {MOST_ROWS:,} make a table; give fewer values of its axes")
    if faults:
        raise QueryError(faults)
    found = _answers(atlas, names, values, {name: value for name, value in given.items() if isinstance(value, str)})
    axes = [name for name, value in values.items() if np.ndim(value) and name in found.dims]
    if derivatives:
        found = found.assign(_slopes(atlas, names, values, axes))
    order = [name for name in values if name in found.dims]
    single = {
        name: atlas.data[name].squeeze()
        for name in PARAMETERS
        if name in atlas.data.coords and atlas.data[name].size == 1
    }
    found = found.assign_coords(
        {name: one.drop_vars(one.coords) for name, one in single.items() if name not in found.coords}
    )
    kept = {
        name: atlas.data.attrs[name]
        for name in ("title", "source", "specification_sha256", "energy")
        if name in atlas.data.attrs
    }
    return found.transpose(*order).assign_attrs(kept)


def _of_design(atlas, at, faults):
    """The atlas of one of its named designs, if it has any."""
    if "design" not in atlas.data.dims:
        return atlas
    names = atlas.data["design"].values.tolist()
    if "design" not in at and len(names) > 1:
        faults.append(f"design: is missing; the atlas holds {', '.join(names)}")
        return atlas
    name = at.pop("design", names[0])
    if not isinstance(name, str) or name not in names:
        faults.append(unknown("design", name, names))
        return atlas
    return Atlas(atlas.data.isel(design=names.index(name)).drop_vars("design"), atlas.path)


def _numbers(name, value, faults):
    """A number, or an axis of them in ascending order."""
    try:
        array = numbers(value, PARAMETERS[name].units)
    except ValueError as error:
        faults.append(f"{name}: {error}")
        return np.zeros(0)
    if array.ndim > 1 or array.size == 0 or not np.all(np.isfinite(array)) or np.any(np.diff(np.ravel(array)) <= 0.0):
        faults.append(
            f"{name}: found {described(value)}; give a number, or ascending numbers in [{PARAMETERS[name].units}]"
        )
    return array


def _answers(atlas, names, values, texts):
    """What is stored where all coordinates are nodes, else what a query answers; ``texts``: values with their units."""
    import xarray as xr

    axes = {name: xr.DataArray(value, dims=name) if np.ndim(value) else float(value) for name, value in values.items()}
    found = atlas.query(names, **axes | texts).load()
    stored = atlas.data
    places = {}
    for name, value in values.items():
        if name not in stored.dims:
            continue
        nodes, asked = stored[name].values, np.atleast_1d(value)
        near = np.abs(nodes[:, None] - asked).argmin(axis=0)
        on = np.abs(nodes[near] - asked) <= SAME * np.abs(nodes).max()
        places[name] = (np.flatnonzero(on), near[on])
    if any(len(own) == 0 for own, _ in places.values()):
        return found
    for name in (name for name in found.data_vars if name in stored):
        dims, array = found[name].dims, found[name].values.copy()
        nodes = stored[name].isel({dim: places[dim][1] for dim in stored[name].dims})
        nodes = nodes.isel({dim: 0 for dim in nodes.dims if dim not in dims})  # given as a single value
        lacking = {dim: len(places[dim][1]) for dim in dims if dim not in nodes.dims}  # what is the same all along
        nodes = nodes.drop_vars(nodes.coords).expand_dims(lacking).transpose(*dims)
        array[np.ix_(*(places[dim][0] for dim in dims))] = nodes.values
        found[name] = (dims, array, found[name].attrs)
    return found


def _slopes(atlas, names, values, axes):
    """``d_<variable>_d_<axis>`` by name."""
    found = {}
    for name in names:
        ask = atlas.interpolator(name)
        own = list(ask.axes)
        missing = [axis for axis in own if axis not in values]
        if missing:
            raise QueryError([f"{axis}: is missing" for axis in missing])
        varying = [axis for axis in own if axis in axes]
        grid = dict(zip(varying, np.meshgrid(*(values[axis] for axis in varying), indexing="ij")))
        _, slopes = ask(*(grid.get(axis, float(np.ravel(values[axis])[0])) for axis in own), gradient=True)
        for axis in varying:
            above, below = attributes(name)["units"], PARAMETERS[axis].units
            below = f"({below})" if " " in below else below
            found[f"d_{name}_d_{axis}"] = (
                varying,
                slopes[own.index(axis)],
                {
                    "units": above if below == "1" else f"{above}/{below}",
                    "long_name": f"d {name} / d {axis}",
                    "comment": DERIVED,
                },
            )
    return found

"""Reads the keywords of a question: one for each axis, numbers or arrays that broadcast; every fault in one error."""

import math
from dataclasses import dataclass

import numpy as np

from ..atlas.schema import PARAMETERS
from ..description.given import numbers
from ..report import quantity, shown_in
from .faults import QueryError, unknown

MAX_POINTS = 100_000_000  # of one question: 16 GB of answers for ten variables


@dataclass(frozen=True)
class Question:
    """``values``: axis -> (n,) numbers; ``single``: the axes given as one number; ``dims``, ``shape`` and ``coordinates``
    (name -> (dims, array)) are those of the answer; ``texts``: what was given as text, with its unit.
    """

    values: dict
    single: frozenset
    dims: tuple
    shape: tuple
    coordinates: dict
    texts: dict

    @property
    def size(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    def shown(self, name, value) -> str:
        """A number of an axis in the unit in which it was asked, or in an everyday one."""
        units = PARAMETERS[name].units
        return quantity(value, units, shown_in([(self.texts.get(name, ""), units)]))


def read_question(given: dict, frame, needed) -> Question:
    """The question that keywords ``given`` make to an atlas' ``frame``; the axes ``needed`` must be among them.

    Raises :class:`QueryError`.
    """
    faults = []
    for name in given:
        if name in frame.dims and name not in frame.values:
            faults.append(
                f"{name}: it is what a design does, not what it is; freesweep.design finds those that do it:"
                f" design(template, free={{'alpha': (0, 85)}}, goals=[Goal({name!r}, {given[name]!r:.40}, pressure=...)])"
            )
        elif name not in frame.values:
            faults.append(unknown("axis", name, frame.asked))
        elif name in frame.by_design:
            faults.append(f"{name}: each design has its own; ask by design")
    for name in needed:
        if name not in given:
            unit = PARAMETERS[name].units if name in PARAMETERS else "1"
            plain = "" if unit == "1" else f" (a plain number is in {unit})"
            faults.append(f"{name}: is missing; {_span(frame, name)}, so give a value{plain}")
    arrays = {}
    for name in (name for name in given if name in frame.asked):
        array = _numbers(faults, name, given[name], frame)
        if array is not None:
            arrays[name] = array
    if faults:
        raise QueryError(faults)
    texts = {name: value for name, value in given.items() if isinstance(value, str) and name != "design"}
    return _broadcast(arrays, {*frame.values, *frame.dims, "x"}, texts)


def _span(frame, name):
    values = frame.values[name]
    if name not in PARAMETERS:
        return "the atlas holds several"
    low, high = (quantity(values[k], PARAMETERS[name].units) for k in (0, -1))
    return f"the atlas holds {low} to {high}"


def _numbers(faults, name, value, frame):
    """``(dims or None, array)`` of one keyword; None after noting a fault."""
    dims = getattr(value, "dims", None) if type(value).__module__.startswith("xarray") else None
    if dims is not None and not hasattr(value, "values"):
        faults.append(f"{name}: found {type(value).__name__}; give a number, an array or a DataArray")
        return None
    if name == "design":
        return _designs(faults, dims, value.values if dims is not None else value, frame)
    try:
        return dims, numbers(value, PARAMETERS[name].units)
    except ValueError as error:
        faults.append(f"{name}: {error}")
        return None


def _designs(faults, dims, value, frame):
    names = frame.values["design"].tolist()
    try:
        array = np.asarray(value)
    except Exception:  # ragged lists, foreign array types
        array = np.array(None)
    if array.dtype.kind != "U":
        faults.append("design: found no text; give a name or an array of names")
        return None
    wrong = sorted(set(array.ravel().tolist()) - set(names))
    if wrong:
        faults.append(unknown("design", wrong[0], names))
        return None
    places = {name: k for k, name in enumerate(names)}
    index = np.array([places[name] for name in array.ravel().tolist()], float).reshape(array.shape)
    return dims, index


def _broadcast(arrays, taken, texts):
    """NumPy's rules among plain arrays, xarray's (by name) among DataArrays, plain arrays with a dimension of their own."""
    plain = {name: array for name, (dims, array) in arrays.items() if dims is None and array.ndim > 0}
    try:
        shape = np.broadcast_shapes(*(array.shape for array in plain.values()))
    except ValueError:
        found = ", ".join(f"{name} {array.shape}" for name, array in plain.items())
        raise QueryError([f"the arrays do not broadcast: {found}; give equal lengths, or DataArrays"]) from None
    if len(plain) == 1 and len(shape) == 1:
        own = tuple(plain)
    else:
        own = ("point",) if len(shape) == 1 else tuple(f"point_{k}" for k in range(len(shape)))
    sizes = dict(zip(own, shape))
    faults = []
    for name, (dims, array) in arrays.items():
        for dim, size in zip(dims or (), array.shape):
            if not isinstance(dim, str) or (dim in taken and arrays.get(dim, (None,))[0] != (dim,)):
                faults.append(f"{name}: its dimension {dim!r:.40} has the name of something else here; rename it")
            if sizes.setdefault(dim, size) != size:
                faults.append(f"{name}: its dimension {dim!r} has {size} values where another array's has {sizes[dim]}")
    points = math.prod(sizes.values())
    if points > MAX_POINTS:
        faults.append(f"{points:,} points, at most {MAX_POINTS:,} are answered at once; ask in parts")
    if faults:
        raise QueryError(faults)
    values, coordinates = {}, {}
    order = tuple(sizes)
    for name, (dims, array) in arrays.items():
        mine = own[len(own) - array.ndim :] if dims is None else tuple(dims)
        kept = [k for k, dim in enumerate(mine) if array.shape[k] == sizes[dim]]  # NumPy stretches lengths of one
        array = array.reshape([array.shape[k] for k in kept])
        mine = tuple(mine[k] for k in kept)
        coordinates[name] = (mine, array)
        if array.ndim == 0:
            values[name] = np.full(points, float(array))
            continue
        turned = array.transpose([mine.index(dim) for dim in order if dim in mine])
        side = [sizes[dim] if dim in mine else 1 for dim in order]
        values[name] = np.ascontiguousarray(np.broadcast_to(turned.reshape(side), tuple(sizes.values()))).ravel()
    single = frozenset(name for name, (_, array) in arrays.items() if array.ndim == 0)
    return Question(values, single, order, tuple(sizes.values()), coordinates, texts)

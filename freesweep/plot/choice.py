"""Which nodes of a dataset a plot shows: everything but the drawn dimensions is chosen, and can be named."""

import difflib
from numbers import Real

import numpy as np

from ..atlas import schema

DESIGN = "design"  # a dimension of names, not of numbers
HELD = ("deformed_length", "rotation")  # outputs that are coordinates of a held state


def check_name(name: str, available, what: str) -> None:
    """Raises ValueError that lists ``available``, and names the nearest, if ``name`` is not among them."""
    available = sorted(available)
    if name not in available:
        near = difflib.get_close_matches(str(name), available, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ValueError(f"no {what} {name!r}{hint} (available: {', '.join(available) or 'none'})")


def dimensions(dataset) -> list:
    """Dimensions that a plot may run along: parameters, held quantities, named designs."""
    known = (*schema.PARAMETERS, *HELD, DESIGN)
    return [str(name) for name in dataset.sizes if name in known]


def choose(dataset, select: dict, across) -> tuple[dict, dict]:
    """Parameters of the point (stored units), and the index along each dimension that is not in ``across``.

    ``select`` maps a name to a number, the nearest node being taken, or ``design`` to its name. What is not selected: the
    largest pressure; the force, torque and held rotation nearest zero; the first design; the middle of anything else.
    Raises ValueError for names that are unknown and values that are no numbers.
    """
    known = (*schema.PARAMETERS, *HELD, DESIGN)
    names = [name for name in known if name in dataset.coords and name not in across]
    for name, value in select.items():
        check_name(name, names, "dimension")
        if name != DESIGN and (isinstance(value, bool) or not isinstance(value, Real) or not np.isfinite(value)):
            raise ValueError(f"{name} must be one finite number [{schema.attributes(name)['units']}], not {value!r}")
    index = {name: _node(dataset, name, select) for name in names if name in dataset.dims}
    point = {}
    for name in names:
        coordinate = dataset[name].isel({dim: index[dim] for dim in dataset[name].dims if dim in index})
        if coordinate.ndim == 0:
            point[name] = str(coordinate.values) if name == DESIGN else float(coordinate)
    return point, index


def _node(dataset, name, select):
    nodes = dataset[name].values
    if name == DESIGN:
        wanted = select.get(name, nodes[0])
        check_name(wanted, nodes.tolist(), "design")
        return nodes.tolist().index(wanted)
    nodes = nodes.astype(float)
    if name in select:
        return int(np.abs(nodes - select[name]).argmin())
    if name == "pressure":
        return int(nodes.argmax())
    if name in (*schema.LOADS, "held_rotation"):
        return int(np.abs(nodes).argmin())
    return int(np.argsort(nodes)[nodes.size // 2])

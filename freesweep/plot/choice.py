"""Which nodes of a dataset a plot shows: everything but the drawn dimensions is chosen, and can be named."""

import difflib
import warnings
from numbers import Real

import numpy as np

from ..atlas import schema
from ..description.given import numbers
from ..description.tube_model import MODELS, model_of
from .display import USUAL, describe

DESIGN = "design"  # a dimension of names, not of numbers
SAME = 1e-6  # relative: what counts as the value asked for
HELD = ("deformed_length", "rotation")  # outputs that are coordinates of a held state


class Point(dict):
    """What is shown: name -> value [stored units]; ``missed``: name -> value asked for where it is another; the ``model`` of
    its tubes.
    """

    model = MODELS["source"]

    def __init__(self, *values):
        super().__init__(*values)
        self.missed = dict(getattr(values[0], "missed", {})) if values else {}
        self.model = getattr(values[0], "model", self.model) if values else self.model

    def __or__(self, others):
        point = Point(self)
        point.update(others)
        return point

    def words(self, names=None):
        """Parameters in words, the usual ones left out."""
        shown = {
            name: self[name] for name in self if (names is None or name in names) and USUAL.get(name) != self[name]
        }
        near = {name: f"\u00a0(nearest\u00a0to\u00a0{describe(name, asked).split(chr(160), name.count('_') + 1)[1]})"
                for name, asked in self.missed.items()}  # fmt: skip
        return [describe(name, value) + near.get(name, "") for name, value in shown.items()]

    def only(self, keep):
        """The parameters for which ``keep(name)`` is true."""
        point = Point({name: value for name, value in self.items() if keep(name)})
        point.missed = {name: value for name, value in self.missed.items() if keep(name)}
        point.model = self.model
        return point


def read_selection(select: dict) -> dict:
    """Values by name with their units read, where they are numbers; raises ValueError with every fault."""
    faults, read = [], {}
    for name, value in select.items():
        known = name in schema.PARAMETERS or name in HELD
        try:
            array = numbers(value, schema.attributes(name)["units"]) if known and not isinstance(value, bool) else None
        except ValueError as error:
            faults.append(f"{name}: {error}")
            continue
        read[name] = value if array is None or array.ndim else array.item()
    if faults:
        raise ValueError("; ".join(faults))
    return read


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

    ``select`` maps a name to a number, the nearest node being taken (``missed``), or ``design`` to its name. What is not
    selected: the largest pressure; the force, torque and held rotation nearest zero; the first design; the middle of
    anything else.
    Raises ValueError for names that are unknown and values that are no numbers.
    """
    known = (*schema.PARAMETERS, *HELD, DESIGN)
    names = [name for name in known if name in dataset.coords and name not in across]
    for name, value in select.items():
        check_name(name, names, "dimension")
        if name != DESIGN and (isinstance(value, bool) or not isinstance(value, Real) or not np.isfinite(value)):
            raise ValueError(f"{name} must be one finite number [{schema.attributes(name)['units']}], not {value!r}")
    index = {name: _node(dataset, name, select) for name in names if name in dataset.dims}
    point = Point()
    point.model = model_of(dataset.attrs)
    for name in names:
        coordinate = dataset[name].isel({dim: index[dim] for dim in dataset[name].dims if dim in index})
        if coordinate.ndim == 0:
            point[name] = str(coordinate.values) if name == DESIGN else float(coordinate)
            if name in select and name != DESIGN and abs(point[name] - select[name]) > SAME * abs(select[name]):
                point.missed[name] = float(select[name])
    return point, index


def warn_missed(point: Point) -> None:
    """A warning, at the call of the public function that calls this, where others than the values asked for are shown."""
    if point.missed:
        near = (f"{describe(name, point[name])} for {describe(name, asked)}" for name, asked in point.missed.items())
        text = f"drawn at the nearest values that the file holds: {', '.join(near)}"
        warnings.warn(text.replace("\u00a0", " "), stacklevel=3)


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

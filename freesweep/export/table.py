"""A table about to be written: axes, variables, what is fixed, each with its unit."""

from dataclasses import dataclass

import numpy as np

from ..status import STATUSES


class ExportError(ValueError):
    """A slice that a format cannot hold; ``faults`` lists why."""

    def __init__(self, faults):
        self.faults = list(faults)
        super().__init__("\n".join(["cannot write this table:", *(f"  - {fault}" for fault in self.faults)]))


@dataclass(frozen=True)
class Grid:
    """``axes`` and ``columns`` by name: arrays, shape (n,) and that of all axes; ``fixed``: single numbers, with ``units``.

    ``words`` are the long names, ``attrs`` where the numbers come from.
    """

    axes: dict
    columns: dict
    fixed: dict
    units: dict
    words: dict
    attrs: dict

    @property
    def shape(self) -> tuple:
        """Sizes of the axes."""
        return tuple(len(array) for array in self.axes.values())

    @property
    def values(self) -> list:
        """Names of columns that are quantities with a stated error."""
        return [name for name in self.columns if f"{name}_error" in self.columns]

    @property
    def statuses(self) -> list:
        """Names of columns that say why a number is missing."""
        return [name for name in self.columns if name.endswith("status")]


def grid_of(found) -> Grid:
    """The table of a Dataset whose dimensions are axes."""
    axes = {name: found[name].values for name in found.dims}
    first = {name: found[name] for name in found.dims}
    columns = {}
    for name, variable in found.data_vars.items():
        missing = {dim: found.sizes[dim] for dim in found.dims if dim not in variable.dims}
        array = variable.expand_dims(missing).transpose(*found.dims) if missing else variable.transpose(*found.dims)
        columns[name] = np.ascontiguousarray(array.values)
    fixed = {
        name: float(value) for name, value in found.coords.items() if value.ndim == 0 and value.dtype.kind in "fiu"
    }
    known = {**first, **found.data_vars, **{name: found[name] for name in fixed}}
    units = {name: one.attrs.get("units", "") for name, one in known.items()}
    words = {name: one.attrs.get("comment", one.attrs.get("long_name", name)) for name, one in known.items()}
    return Grid(axes, columns, fixed, units, words, dict(found.attrs))


def meanings() -> dict:
    """Status -> what it means, for the readers of a table."""
    return {status.value: status.meaning for status in STATUSES}

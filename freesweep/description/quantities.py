"""Types of what people give: quantities are numbers, texts with units ("4.76 mm") or what carries units and can convert."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, Union

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

    from .along import Profile


class CarriesUnits(Protocol):
    """A quantity of another library (astropy, pint, unyt)."""

    def to(self, unit: Any, /) -> Any:
        """The same in another unit."""
        ...


Quantity: TypeAlias = float | np.number[Any] | str | CarriesUnits
# one or several; xarray is not loaded for its name
Quantities: TypeAlias = Union[Quantity, Sequence[Any], np.ndarray[Any, Any], "xr.DataArray"]
Along: TypeAlias = Union[
    Quantity, Sequence[Sequence[Quantity]], Callable[[Any], Any], "Profile"
]  # a number or a profile
Names: TypeAlias = str | Sequence[str] | None
Path: TypeAlias = str | PathLike[str]

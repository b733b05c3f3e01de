"""Results as a table of pandas: a row for each state, whatever the stations along the tube."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..description.faults import ActuatorError
from ..description.given import described

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def to_dataframe(results: xr.Dataset) -> pd.DataFrame:
    """The scalar outputs of a Dataset, or of an atlas' ``data``, as a pandas DataFrame with a row for each state.

    Profiles along ``x`` are left out (``results.to_dataframe()`` of xarray repeats each state for every station), a single
    state makes one row. Units stand in ``frame.attrs["units"]``. Raises :class:`ActuatorError`.
    """
    import xarray as xr

    if not isinstance(results, xr.Dataset):
        raise ActuatorError([f"results: found {described(results)}; give a Dataset of freesweep"])
    points = results.drop_dims("x") if "x" in results.dims else results
    if points.dims:
        frame = points.to_dataframe()
    else:
        frame = points.expand_dims("state").to_dataframe().reset_index(drop=True)
    frame.attrs = {
        "units": {name: one.attrs["units"] for name, one in points.variables.items() if "units" in one.attrs}
    }
    return frame

"""Tolerances of manufacture: how far each output spreads, and which tolerance matters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .derivative.extremes import EXTREMES
from .derivative.request import SHAPE, parameters, unit_of
from .description.actuator import Actuator
from .description.faults import ActuatorError
from .description.given import described, read_number
from .description.quantities import Quantity
from .description.unit_warnings import tolerance_doubts, warn_of
from .statics import LOADS, inflate

if TYPE_CHECKING:
    import xarray as xr


def tolerance(
    tube: Actuator,
    pressure: Quantity,
    force: Quantity = 0.0,
    torque: Quantity = 0.0,
    *,
    accuracy: float = 1e-6,
    **tolerances: Quantity,
) -> xr.Dataset:
    """The standard deviation of each output of :func:`freesweep.inflate`, to first order in independent ``tolerances``.

    Parameters
    ----------
    tube, pressure, force, torque, accuracy : as of :func:`freesweep.inflate`
    tolerances : the standard deviation of any parameter, by name, in its unit: ``alpha=1.0`` [degree], ``wall=5e-5`` [m],
        ``c10=5e3`` or ``pressure_tolerance=500`` [Pa]; those of the loads are named with ``_tolerance`` behind. A
        profile moves by the same amount all along

    Returns the Dataset of ``inflate`` with, of each scalar output, ``<output>_deviation`` and its ``_error``, and
    ``<output>_share``, along ``parameter``: the share of its variance that each tolerance makes; NaN where nothing moves it.
    Raises :class:`ActuatorError`.
    """
    import xarray as xr

    if not isinstance(tube, Actuator):
        raise ActuatorError([f"tube: found {described(tube)}; give an Actuator"])
    keys = {f"{name}_tolerance" if name in LOADS else name: name for name in parameters(tube, LOADS)}
    faults = [f"{key}: not a parameter here; choose from {', '.join(keys)}" for key in tolerances if key not in keys]
    if not tolerances:
        faults.append(f"tolerances: none is given; name some of {', '.join(keys)}")
    spread = {
        keys[key]: read_number(key, value, unit_of(keys[key], tube), faults, least=0.0)
        for key, value in tolerances.items()
        if key in keys
    }
    if faults:
        raise ActuatorError(faults)
    warn_of(tolerance_doubts(tube.design(), spread), stacklevel=2)
    names = list(spread)
    found = inflate(tube, pressure, force, torque, accuracy=accuracy, derivatives=names)
    for output in (*SHAPE, *EXTREMES):
        each = [found[f"d_{output}_d_{name}"] * spread[name] for name in names]
        bound = [found[f"d_{output}_d_{name}_error"] * spread[name] for name in names]
        variance = sum(one**2 for one in each)
        deviation, about = np.sqrt(variance), found[output].attrs
        found[f"{output}_deviation"] = deviation.assign_attrs(about, long_name=f"standard deviation of {output}")
        # a length of a vector: it changes by no more than that of the vector's change
        doubt = np.sqrt(sum(one**2 for one in bound))
        found[f"{output}_deviation_error"] = doubt.assign_attrs(about, long_name=f"error bound of {output}_deviation")
        shares = xr.concat([one**2 / variance.where(variance > 0.0) for one in each], "parameter")
        found[f"{output}_share"] = shares.assign_attrs(units="1", long_name=f"share of the variance of {output}")
    return found.assign_coords(parameter=names).drop_vars([one for one in found.variables if one.startswith("d_")])

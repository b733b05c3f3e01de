"""Loads, held quantities and stations as a person gives them, checked: numbers or 1-D arrays, every fault listed."""

import numpy as np

from ..scaling import ACCURACIES
from .actuator import Actuator
from .faults import ActuatorError
from .given import described, numbers, read_column, read_number
from .unit_warnings import load_doubts, warn_of

STATIONS = 201


def read_load(name, value, unit, faults, **domain):
    """The load as a float or a 1-D float array; None after noting what is wrong; ``domain`` as of ``read_column``."""
    array = read_column(name, value, unit, faults, **domain)
    return array.item() if array is not None and array.ndim == 0 else array


def each_once(axes):
    """``(axes, at)`` of numbers and arrays by name: each value once, and of arrays that repeat one, which is where."""
    once, at = dict(axes), {}
    for name in (name for name, value in axes.items() if np.ndim(value) == 1):
        values, index = np.unique(axes[name], return_inverse=True)
        if len(values) < len(index):
            once[name], at[name] = values, index
    return once, at


def read_stations(tube, x, accuracy, faults):
    """Stations as an array [m], and the accuracy; raises if there are faults."""
    if not isinstance(tube, Actuator):
        raise ActuatorError([f"tube: found {described(tube)}; give an Actuator", *faults])
    accuracy = read_number("accuracy", accuracy, "1", faults, positive=True)
    if accuracy is not None and not ACCURACIES[0] <= accuracy <= ACCURACIES[1]:
        faults.append(f"accuracy: found {accuracy:g}; give a value from {ACCURACIES[0]:g} to {ACCURACIES[1]:g}")
    stations = np.linspace(0.0, tube.length, STATIONS)
    if x is not None:
        try:
            stations = np.atleast_1d(numbers(x, "m"))
        except ValueError as error:
            faults.append(f"x: {error}")
        inside = np.all((stations >= 0.0) & (stations <= tube.length * (1.0 + 1e-12)))
        if stations.ndim != 1 or stations.size == 0 or not inside or np.any(np.diff(stations) <= 0.0):
            asked = f"give ascending stations from 0 to the undeformed length {tube.length:g} m, in [m]"
            faults.append(f"x: {asked}; found {described(x)}")
    if faults:
        raise ActuatorError(faults)
    return np.minimum(stations, tube.length), accuracy


def warn_of_loads(tube, stacklevel=3, **loads):
    """Warn of loads that look like slips of units for this tube."""
    design = tube.design()
    own = {name: design[name] for name in ("alpha", "beta", "length", "radius", "wall", "c10")}
    warn_of(load_doubts(own, loads), stacklevel)

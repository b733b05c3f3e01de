"""Loads, held quantities and stations as a person gives them, checked: numbers or 1-D arrays, every fault listed."""

import numpy as np

from .actuator import Actuator, ActuatorError, number_fault
from .scaling import ACCURACIES

STATIONS = 201


def read_load(name, value, unit, faults):
    """The load as a float or a 1-D float array; what is wrong with it goes to ``faults``."""
    if np.ndim(value) == 0 and not isinstance(value, np.ndarray):
        fault = number_fault(name, value, unit)
        faults += [fault] if fault else []
        return None if fault else float(value)
    try:
        array = np.asarray(value)
    except ValueError:  # ragged
        array = np.array(None)
    if array.dtype.kind not in "iuf":
        faults.append(f"{name}: found {value!r:.60}; give a number or a 1-D array of numbers in [{unit}]")
        return None
    array = array.astype(float)
    if array.ndim == 0:
        return read_load(name, array.item(), unit, faults)
    if array.ndim != 1 or array.size == 0 or not np.all(np.isfinite(array)):
        faults.append(
            f"{name}: found an array of shape {array.shape}; give finite numbers in one dimension, in [{unit}]"
        )
        return None
    if len(np.unique(array)) != array.size:
        faults.append(f"{name}: a value is given twice; give each once")
        return None
    return array


def read_stations(tube, x, accuracy, faults):
    """Stations as an array [m]; raises if there are faults."""
    if not isinstance(tube, Actuator):
        raise ActuatorError([f"tube: found {type(tube).__name__}; give an Actuator"])
    fault = number_fault("accuracy", accuracy, "1", positive=True)
    if not fault and not ACCURACIES[0] <= accuracy <= ACCURACIES[1]:
        fault = f"accuracy: found {accuracy:g}; give a value from {ACCURACIES[0]:g} to {ACCURACIES[1]:g}"
    faults += [fault] if fault else []
    if x is None:
        stations = np.linspace(0.0, tube.length, STATIONS)
    else:
        try:
            stations = np.atleast_1d(np.asarray(x, dtype=float))
        except (TypeError, ValueError):
            stations = np.array([np.nan])
        inside = np.all((stations >= 0.0) & (stations <= tube.length * (1.0 + 1e-12)))
        if stations.ndim != 1 or stations.size == 0 or not inside or np.any(np.diff(stations) <= 0.0):
            faults.append(f"x: give ascending stations from 0 to the undeformed length {tube.length:g} m, in [m]")
    if faults:
        raise ActuatorError(faults)
    return stations

"""What the model says of a measured state: exact solutions at the bench's pressures, loads and held quantities."""

import numpy as np

from ..holding import blocked_force, blocked_torque
from ..statics import inflate
from .measured import BENCHES, Measurement


def predicted(measurement: Measurement, tube, accuracy) -> np.ndarray:
    """Measured quantities as the model of ``tube`` has them (n, measured), NaN where it has no state."""
    load = next((name for name in measurement.measured if name in BENCHES), None)
    if load is None:
        names, solve, usable = ("force", "torque"), inflate, np.full(len(measurement), True)
    else:
        names = BENCHES[load].imposed
        solve, usable = {"force": blocked_force, "torque": blocked_torque}[load], measurement.pressure > 0.0
    states = np.column_stack([measurement.pressure, *(measurement.imposed(name) for name in names)])
    out = np.full((len(measurement), len(measurement.measured)), np.nan)
    along = 0  # the solvers take a product of loads: solve along the column that leaves the fewest others
    fewest = np.inf
    for column in (0, 1):
        others = len(np.unique(np.delete(states, column, axis=1), axis=0))
        if others < fewest:
            along, fewest = column, others
    rest = np.delete(states, along, axis=1)
    for other in np.unique(rest[usable], axis=0):
        here = np.flatnonzero(usable & np.all(rest == other, axis=1))
        values, back = np.unique(states[here, along], return_inverse=True)
        arguments = np.insert(other.astype(object), along, None)
        arguments[along] = values
        solved = solve(tube, *arguments, x=0.0, accuracy=accuracy)
        for k, name in enumerate(measurement.measured):
            out[here, k] = solved[name].values[back]
    return out


def continued(measurement: Measurement, tube, found) -> np.ndarray:
    """``found`` with its gaps filled, so that a search can cross them: no result, but a steady continuation of results.

    A blocked force ends where the wall would have to be pushed, at ``-pi r0^2 P``; other quantities take the value of the
    nearest pressure that has a state, or that of the undeformed tube.
    """
    found = found.copy()
    rest = {"deformed_length": tube.length, "mid_radius": tube.fiber_surface}
    for k, name in enumerate(measurement.measured):
        gaps, states = np.isnan(found[:, k]), np.flatnonzero(~np.isnan(found[:, k]))
        for i in np.flatnonzero(gaps):
            if name == "force":
                found[i, k] = -np.pi * tube.fiber_surface**2 * measurement.pressure[i]
            elif len(states):
                nearest = states[np.argmin(np.abs(measurement.pressure[states] - measurement.pressure[i]))]
                found[i, k] = found[nearest, k]
            else:
                found[i, k] = rest.get(name, 0.0)
    return found

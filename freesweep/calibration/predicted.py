"""What the model says of measured states, as the bench would have read it: exact solutions, in vectors where they can be."""

import itertools
from typing import NamedTuple

import numpy as np

from ..holding import blocked_force, blocked_torque
from ..statics import inflate
from .measured import BENCHES, Measurement
from .parameters import Setup
from .states import Forces, free_states, held_torques, model_of, points_of, rough_states

ACCURACY = 1e-8  # of the scalar solver, scaled
SETTLED_AFTER = 2  # corrections of short tubes: the second is that of the force which the first one changed


class Asked(NamedTuple):
    """States of one measurement for one set of parameters: pressures and what the bench imposed, of the tube that works."""

    setup: Setup
    pressure: np.ndarray  # [Pa], above the threshold
    imposed: dict  # name -> (n,)


class Predictor:
    """Predicts all measurements, and remembers what helps to predict those of parameters that hardly differ."""

    def __init__(self, measurements):
        self.measurements = measurements
        starts = np.concatenate([[0], np.cumsum([len(m) for m in measurements])])
        self.rows = [np.arange(a, b) for a, b in itertools.pairwise(starts)]
        forces = [m.force if "force" in m.measured else np.zeros(len(m)) for m in measurements]
        self.forces = Forces(np.concatenate(forces))

    def predict(self, many, rough=False) -> list:
        """For each list of setups in ``many``: the model's (n, measured) of each measurement, NaN where it has no state.

        ``rough``: uniform membranes stand for physical tubes.
        """
        asked = [[self._asked(m, setup) for m, setup in zip(self.measurements, setups)] for setups in many]
        found = [[np.full((len(m), len(m.measured)), np.nan) for m in self.measurements] for _ in many]
        groups = {}
        for t, states in enumerate(asked):
            for k, state in enumerate(states):
                key = self._group(k, state)
                if key is None:
                    found[t][k][:] = scalar(self.measurements[k], state)
                else:
                    groups.setdefault(key, []).append((t, k))
        for key, members in groups.items():
            self._solve_group(key, members, asked, found, rough)
        for t, states in enumerate(asked):
            for k, state in enumerate(states):
                _as_read(self.measurements[k], state.setup, found[t][k])
        return found

    def settle(self, setups):
        """Correct, as a fit does, what vectors miss of short tubes with these ``setups``, and with some hardly other."""
        for _ in range(SETTLED_AFTER):
            self.predict([setups])
            self.refresh(setups)

    def refresh(self, setups) -> float:
        """Correct what vectors miss of short tubes, and of pushes; the largest change of a force that makes [N]."""
        largest = 0.0
        for k, (measurement, setup) in enumerate(zip(self.measurements, setups)):
            state = self._asked(measurement, setup)
            key = self._group(k, state)
            if key is not None and key[0] == "force":
                points = _points(measurement, state)
                largest = max(largest, self.forces.refresh(points, key[1], key[2], self.rows[k]))
        return largest

    def _asked(self, measurement, setup):
        load = next((name for name in measurement.measured if name in BENCHES), None)
        names = ("force", "torque") if load is None else BENCHES[load].imposed
        imposed = {name: measurement.imposed(name) for name in names}
        if "deformed_length" in imposed:
            imposed["deformed_length"] = _working_length(measurement, setup)
        return Asked(setup, np.maximum(measurement.pressure - setup.threshold, 0.0), imposed)

    def _group(self, k, state):
        """What is solved in one call: kind, energy and model; None: state by state."""
        tube, measured = state.setup.tube, self.measurements[k].measured
        load = next((name for name in measured if name in BENCHES), None)
        if tube.varies or (load is not None and len(measured) > 1):
            return None
        return load or "free", tube.energy, model_of(tube), () if load else measured

    def _solve_group(self, key, members, asked, found, rough):
        kind, energy, model, names = key
        points = np.concatenate([_points(self.measurements[k], asked[t][k]) for t, k in members])
        if rough and model.is_physical:
            values = rough_states(kind, points, names)
        elif kind == "free":
            values = free_states(points, energy, model, names)
        elif kind == "torque":
            values = held_torques(points, energy, model)[:, None]
        else:
            own = np.concatenate([self.rows[k] for _, k in members])
            values = self.forces.solve(points, energy, model, own, not rough)[:, None]
        cuts = np.cumsum([len(self.measurements[k]) for _, k in members])[:-1]
        for (t, k), part in zip(members, np.split(values, cuts)):
            found[t][k][:] = part


def _working_length(measurement, setup):
    """Lengths at which the bench held the part that works [m] (n,)."""
    given = measurement.tube.length
    if measurement.deformed_length is None:
        length = np.full(len(measurement), setup.length)
    elif measurement.length_as == "contraction":
        length = measurement.deformed_length * (setup.length / given)
    elif measurement.length_as == "stroke":
        length = measurement.deformed_length + (setup.length - given)
    else:
        length = measurement.deformed_length
    return np.maximum(length - setup.dead, 1e-3 * given)


def _as_read(measurement, setup, values):
    """Turn lengths of the part that works into what the bench would have read, in terms of the length given."""
    if "deformed_length" not in measurement.measured:
        return
    column, given = measurement.measured.index("deformed_length"), measurement.tube.length
    values[:, column] += setup.dead
    if measurement.length_as == "contraction":
        values[:, column] *= given / setup.length
    elif measurement.length_as == "stroke":
        values[:, column] += given - setup.length


def _points(measurement, state):
    tube, imposed = state.setup.tube, dict(state.imposed)
    if "deformed_length" in imposed:
        imposed["held"] = imposed.pop("deformed_length") / tube.length
    elif "rotation" in imposed:
        imposed["held"] = imposed.pop("rotation")
    return points_of(tube, state.pressure, **imposed)


def scalar(measurement: Measurement, state: Asked) -> np.ndarray:
    """Measured quantities of the tube that works (n, measured), by the public functions: for profiles, and for what else
    is measured where something is held.
    """
    load = next((name for name in measurement.measured if name in BENCHES), None)
    tube, solve = state.setup.tube, {None: inflate, "force": blocked_force, "torque": blocked_torque}[load]
    states = np.column_stack([state.pressure, *state.imposed.values()])
    out = np.full((len(measurement), len(measurement.measured)), np.nan)
    along = 0  # the solvers take a product of loads: solve along the column that leaves the fewest others
    fewest = np.inf
    for column in (0, 1):
        others = len(np.unique(np.delete(states, column, axis=1), axis=0))
        if others < fewest:
            along, fewest = column, others
    rest = np.delete(states, along, axis=1)
    for other in np.unique(rest, axis=0):
        here = np.flatnonzero(np.all(rest == other, axis=1))
        values, back = np.unique(states[here, along], return_inverse=True)
        arguments = np.insert(other.astype(object), along, None)
        arguments[along] = values
        solved = solve(tube, *arguments, x=0.0, accuracy=ACCURACY)
        for k, name in enumerate(measurement.measured):
            out[here, k] = solved[name].values[back]
    return out


def continued(measurement: Measurement, setup: Setup, found) -> np.ndarray:
    """``found`` with its gaps filled, so that a search can cross them: no result, but a steady continuation of results.

    A blocked force ends where the wall would have to be pushed, at ``-pi r0^2 P``; other quantities take the value of the
    nearest pressure that has a state, or that of the undeformed tube.
    """
    found = found.copy()
    rest = {"deformed_length": measurement.tube.length, "mid_radius": setup.tube.fiber_surface}
    for k, name in enumerate(measurement.measured):
        gaps, states = np.isnan(found[:, k]), np.flatnonzero(~np.isnan(found[:, k]))
        for i in np.flatnonzero(gaps):
            if name == "force":
                found[i, k] = -np.pi * setup.tube.fiber_surface**2 * max(measurement.pressure[i] - setup.threshold, 0.0)
            elif len(states):
                nearest = states[np.argmin(np.abs(measurement.pressure[states] - measurement.pressure[i]))]
                found[i, k] = found[nearest, k]
            else:
                found[i, k] = rest.get(name, 0.0)
    return found

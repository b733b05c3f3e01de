"""The least-squares problem of a calibration: parameters, and the residuals that they leave."""

import warnings
from dataclasses import fields, replace

import numpy as np

from ..actuator import ActuatorError
from .predicted import continued, predicted

EXTENSION = "fiber_extension"
PERCENT = 0.01  # extensions are searched in percent, material constants in units of the first guess: all near 1
LARGEST_EXTENSION = 20.0  # [%]
# of constants, in units of the first guess; 0 for others
LEAST = {"c10": 1e-4, "c1": 1e-4, "c2": -np.inf, "c3": -np.inf}
SCAN = 3.0 ** np.arange(-3.0, 4.0)  # times the first guess of all constants
SCAN_EXTENSION = (0.0, 0.5, 1.0)  # [%]
STEP = 1e-3  # of differences: their truncation, 1e-3 or 1e-6 if central, is far above the solver's error over it
AT_BOUND = 1e-6  # above a bound: the search stays inside
PULL = 0.1  # weight of a relative change in the residuals: it holds what the data do not tell, and nothing else
ACCURACY = 1e-8  # of the solver, scaled


class Problem:
    """What is fitted (``names``), and the residuals of the measurements for values ``theta`` of it, all near 1."""

    def __init__(self, measurements, names, own_extension):
        self.measurements = measurements
        material = measurements[0].tube.material
        self.constants = tuple(name for name in names if name != EXTENSION)
        first_constant = material.constants[0]
        self.unit = getattr(material, first_constant)
        tubes = [_bare(m.tube) for m in measurements]
        distinct = [tube for k, tube in enumerate(tubes) if tube not in tubes[:k]]
        extended = EXTENSION in names
        self.which = [distinct.index(tube) if own_extension else 0 for tube in tubes]  # each measurement's extension
        count = (max(self.which) + 1) * extended
        numbered = [f"{EXTENSION}_{k + 1}" for k in range(count)] if count > 1 else [EXTENSION] * count
        self.names = (*self.constants, *numbered)
        guess = [getattr(material, name) / self.unit for name in self.constants]
        first = [m.tube.fiber_extension for m in measurements]
        guess += [(first[self.which.index(k)] - 1.0) / PERCENT for k in range(count)]
        self.guess = np.array(guess)
        self.low = np.array([LEAST.get(name, 0.0) for name in (*self.constants, *[EXTENSION] * count)])
        self.high = np.array([np.inf] * len(self.constants) + [LARGEST_EXTENSION] * count)
        self.scales = np.array([self.unit] * len(self.constants) + [PERCENT] * count)
        self.offsets = np.array([0.0] * len(self.constants) + [1.0] * count)
        self.quantity = np.concatenate([np.tile(m.measured, len(m)) for m in measurements])
        self.measured = np.concatenate(
            [np.column_stack([getattr(m, name) for name in m.measured]).ravel() for m in measurements]
        )
        given = [
            np.column_stack([m.sigma.get(name, np.full(len(m), np.nan)) for name in m.measured]) for m in measurements
        ]
        self.sigma = np.concatenate([array.ravel() for array in given])

    def tubes(self, theta):
        """The actuator of each measurement with the parameters ``theta`` (p,)."""
        constants = dict(zip(self.constants, (theta * self.scales).tolist()))
        extensions = (1.0 + PERCENT * theta[len(self.constants) :]).tolist()
        made = []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the wall: said once, where the tube was made
            for measurement, k in zip(self.measurements, self.which):
                tube = measurement.tube
                changes = {EXTENSION: extensions[k]} if extensions else {}
                made.append(
                    replace(
                        tube, material=replace(tube.material, largest_stretch=None, source="", **constants), **changes
                    )
                )
        return made

    def model(self, theta):
        """What the model says (values,), continued over its gaps, and where it has a state (values,)."""
        try:
            tubes = self.tubes(theta)
        except ActuatorError:  # fibers that cannot meet the clamped ends
            return np.full(len(self.measured), np.nan), np.zeros(len(self.measured), bool)
        found = [predicted(m, tube, ACCURACY) for m, tube in zip(self.measurements, tubes)]
        filled = [continued(m, tube, array) for m, tube, array in zip(self.measurements, tubes, found)]
        return np.concatenate([a.ravel() for a in filled]), np.isfinite(np.concatenate([a.ravel() for a in found]))

    def derivative(self, theta, model=None):
        """Derivative of the model (values, p): central differences, or, beside the ``model`` at theta, forward ones."""
        columns = []
        for k in range(len(theta)):
            step = STEP * max(abs(theta[k]), 0.1)
            ends = [theta.copy(), theta.copy()]
            ends[0][k] = max(theta[k] - step, self.low[k]) if model is None else theta[k]
            ends[1][k] = theta[k] + step
            before = self.model(ends[0])[0] if model is None else model
            after = self.model(ends[1])[0]
            columns.append((after - before) / (ends[1][k] - ends[0][k]))
        return np.nan_to_num(np.column_stack(columns))

    def solve(self, theta, home, sigma, rows):
        """Least squares from ``theta`` on the ``rows`` (values,) that count, pulled ever so weakly toward ``home``."""
        from scipy.optimize import least_squares

        pull = PULL / np.maximum(np.abs(home), 1.0)
        last = {}

        def residuals(at):
            last[at.tobytes()] = self.model(at)[0]
            return np.append(((last[at.tobytes()] - self.measured) / sigma)[rows], pull * (at - home))

        def slopes(at):
            derivative = self.derivative(at, last[at.tobytes()])
            return np.vstack([(derivative / sigma[:, None])[rows], np.diag(pull)])

        inside = np.clip(theta, self.low + 1e-9, self.high - 1e-9)
        found = least_squares(residuals, inside, slopes, (self.low, self.high), xtol=1e-9, ftol=1e-11, gtol=1e-12)
        return np.where(found.x - self.low < AT_BOUND, self.low, found.x)

    def start(self, sigma):
        """The best of a coarse scan around the first guess."""
        factors = SCAN if self.constants else [1.0]
        constants, extension = np.split(self.guess, [len(self.constants)])
        extensions = [extension] + [np.full_like(extension, e) for e in SCAN_EXTENSION if np.any(extension != e)]
        best, least = self.guess, np.inf
        for factor in factors:
            for extension in extensions:
                trial = np.concatenate([factor * constants, extension])
                misfit = np.sum(((self.model(trial)[0] - self.measured) / sigma) ** 2)
                if misfit < least:
                    best, least = trial, misfit
        return best


def _bare(tube):
    """What tells actuators apart: all that is not fitted."""
    values = {item.name: getattr(tube, item.name) for item in fields(tube) if item.name not in ("material", EXTENSION)}
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in values.items()}

"""The least-squares problem of a calibration: parameters, and the residuals that they leave."""

import numpy as np

from ..description.actuator import ActuatorError
from .parameters import EXTENSION, Parameters
from .predicted import Predictor, continued

SCAN = 3.0 ** np.arange(-3.0, 4.0)  # times the first guess of all constants
SCAN_EXTENSION = (0.0, 0.5, 1.0)  # [%]
STEP = 1e-3  # of differences: their truncation, 1e-3 or 1e-6 if central, is far above the solver's error over it
AT_BOUND = 1e-6  # above a bound: the search stays inside
PULL = 0.1  # weight of a relative change in the residuals: it holds what the data do not tell, and nothing else
CORRECTIONS = 4  # rounds of correcting what vectors miss, at most
NO_BETTER = 1e-3  # of chi square for each value: no reason to leave the first guess
SMALL = 0.05  # of a standard uncertainty: no such correction matters


class Problem:
    """The ``parameters``, and the residuals of the measurements for values ``theta`` of them, all near 1."""

    def __init__(self, parameters: Parameters):
        self.parameters = parameters
        self.measurements = measurements = parameters.measurements
        self.names = parameters.labels
        self.low, self.high = parameters.low, parameters.high
        self.predictor = Predictor(measurements)
        self.quantity = np.concatenate([np.tile(m.measured, len(m)) for m in measurements])
        self.measured = _flat(measurements, lambda m, name: getattr(m, name))
        self.slack = _flat(measurements, lambda m, name: m.slack & (name == "force")).astype(bool)
        self.sigma = _flat(measurements, lambda m, name: m.sigma.get(name, np.full(len(m), np.nan)))

    def models(self, thetas, rough=False):
        """What the model says (t, values), continued over its gaps, and where it has states (t, values), of each theta."""
        filled = np.full((len(thetas), len(self.measured)), np.nan)
        there = np.zeros(filled.shape, bool)
        many, rows = [], []
        for k, theta in enumerate(thetas):
            try:
                many.append(self.parameters.setups(theta))
                rows.append(k)
            except ActuatorError:  # fibers that cannot meet the clamped ends
                continue
        for k, setups, found in zip(rows, many, self.predictor.predict(many, rough)):
            full = [continued(m, setup, array) for m, setup, array in zip(self.measurements, setups, found)]
            filled[k] = np.concatenate([array.ravel() for array in full])
            there[k] = np.isfinite(np.concatenate([array.ravel() for array in found]))
        return filled, there

    def model(self, theta):
        """The same of one theta: (values,) and (values,)."""
        filled, there = self.models([theta])
        return filled[0], there[0]

    def residuals(self, model, there):
        """Model less measured (values,): a slack muscle is met by all that does not pull, and by no state at all."""
        found = model - self.measured
        return np.where(self.slack, np.where(there, np.maximum(found, 0.0), 0.0), found)

    def counted(self, there):
        """Which values count (values,): where the model has a state, and slack ones."""
        return there | self.slack

    def derivative(self, theta, model=None):
        """Derivative of the residuals (values, p): central differences, or, beside the ``model`` at theta, forward ones."""
        ends = []
        for k in range(len(theta)):
            step = STEP * max(abs(theta[k]), 0.1)
            pair = [theta.copy(), theta.copy()]
            pair[0][k] = max(theta[k] - step, self.low[k])
            pair[1][k] = min(theta[k] + step, self.high[k])
            if model is not None:
                pair[int(pair[1][k] <= theta[k])] = theta.copy()  # forward, but at an upper bound
                pair = pair if pair[1][k] > pair[0][k] else pair[::-1]
            ends += pair
        filled, _ = self.models(ends)
        columns = []
        for k in range(len(theta)):
            span = ends[2 * k + 1][k] - ends[2 * k][k]
            columns.append((filled[2 * k + 1] - filled[2 * k]) / span if span != 0.0 else np.zeros(len(self.measured)))
        return np.nan_to_num(np.column_stack(columns))

    def sloped(self, slopes, model, there):
        """Derivative of residuals (values, p) from that of the model: slack muscles count where the model pulls."""
        return np.where((self.slack & ~(there & (model > self.measured)))[:, None], 0.0, slopes)

    def solve(self, theta, home, sigma, rows, fixed=()):
        """Least squares from ``theta`` on the ``rows`` (values,) that count, pulled ever so weakly toward ``home``.

        Priors are residuals of their own; parameters ``fixed`` stay.
        """
        for _ in range(CORRECTIONS):
            theta = self._solve(theta, home, sigma, rows, fixed)
            self.model(theta)
            change = self.predictor.refresh(self.parameters.setups(theta))
            forces = sigma[self.quantity == "force"]
            if change <= SMALL * np.min(forces, initial=np.inf):
                break
        return theta

    def _solve(self, theta, home, sigma, rows, fixed):
        from scipy.optimize import least_squares

        pull = PULL / np.maximum(np.abs(home), 1.0)
        prior = self.parameters
        free = np.array([k for k in range(len(theta)) if k not in fixed])
        last = {}

        def whole(at):
            full = theta.copy()
            full[free] = at
            return full

        def residuals(at):
            full = whole(at)
            last[at.tobytes()] = self.model(full)
            found = self.residuals(*last[at.tobytes()]) / sigma
            return np.concatenate([found[rows], (pull * (full - home))[free], (full - prior.mean) / prior.sigma])

        def slopes(at):
            full = whole(at)
            model, there = last[at.tobytes()]
            found = self.sloped(self.derivative(full, model), model, there) / sigma[:, None]
            return np.vstack([found[rows], np.diag(pull)[free], np.diag(1.0 / prior.sigma)])[:, free]

        inside = np.clip(theta, self.low + 1e-9, self.high - 1e-9)[free]
        bounds = (self.low[free], self.high[free])
        found = least_squares(residuals, inside, slopes, bounds, xtol=1e-8, ftol=1e-10, gtol=1e-12)
        at = whole(found.x)
        at = np.where(at - self.low < AT_BOUND, self.low, at)
        return np.where(self.high - at < AT_BOUND, self.high, at)

    def start(self, sigma):
        """The best of a coarse scan around the first guess."""
        guess = self.parameters.start
        constants = np.array([one.name in self.parameters.material.constants for one in self.parameters.all])
        extensions = np.array([one.name == EXTENSION for one in self.parameters.all])
        trials = []
        for factor in SCAN if constants.any() else [1.0]:
            scaled = np.where(constants, factor * guess, guess)
            trials.append(scaled)
            if extensions.any():
                trials += [np.where(extensions, e, scaled) for e in SCAN_EXTENSION]
        trials = [np.clip(trial, self.low, self.high) for trial in trials]
        models = self.models(trials, rough=True)
        misfits = [np.sum((self.residuals(*found) / sigma) ** 2) for found in zip(*models)]
        misfits = np.where(np.isfinite(misfits), misfits, np.inf)
        if not np.isfinite(misfits).any():
            return np.clip(guess, self.low, self.high)
        good = [t for t, misfit in zip(trials, misfits) if misfit <= np.min(misfits) + NO_BETTER * len(self.measured)]
        return min(good, key=lambda trial: np.sum(np.abs(trial - guess)))


def _flat(measurements, of):
    """A number for each measured value (values,), by the measurement and the quantity's name."""
    return np.concatenate([np.column_stack([of(m, name) for name in m.measured]).ravel() for m in measurements])

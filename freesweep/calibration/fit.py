"""Material constants and fiber extension from measured curves, by least squares on the exact model.

With r the residuals over their standard uncertainties and J their derivative along the parameters, the covariance of the
parameters is (J^T J)^-1. Where no uncertainties are given, that of each measured quantity is estimated from its scatter
about the fit, and the fit is made again with it. Intervals are Student's, for the degrees of freedom that are left.
"""

from dataclasses import dataclass

import numpy as np

from ..actuator import ActuatorError
from ..options import read_switch
from .identify import covariance_of, notes_of, relative
from .measured import Measurement, read_names
from .problem import EXTENSION, Problem

FIRST_SIGMA = 0.01  # of the range of what was measured
ROUNDS = 12  # of estimating uncertainties and fitting again
SETTLED = 0.03  # relative change of an uncertainty that ends the rounds
LEAST_SCATTER = 1e-6  # of what was measured: no bench is better


@dataclass(frozen=True, eq=False)
class Calibration:
    """What :func:`calibrate` found.

    names : of the parameters (p,); fiber extensions of the actuators' own are numbered as these first come
    values, covariance, intervals : (p,), (p, p), (p, 2) at 95 % confidence, in [Pa] and [1]; infinite where data are blind
    tubes : the actuator of each measurement, with what was found
    predicted : the model's (n, measured) for each measurement, NaN where it has no state
    sigma : standard uncertainty by measured quantity: as given (root mean square), or estimated from the scatter
    condition : ratio of the best to the worst seen combination of relative changes of the parameters
    chi_square : weighted squared residuals per degree of freedom; near 1 where the model fits the uncertainties given
    notes : what a reader has to know, in sentences
    """

    names: tuple
    values: np.ndarray
    covariance: np.ndarray
    intervals: np.ndarray
    measurements: tuple
    tubes: tuple
    predicted: tuple
    sigma: dict
    condition: float
    chi_square: float
    notes: tuple

    @property
    def standard_errors(self) -> np.ndarray:
        """Standard uncertainties of the parameters (p,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def correlation(self) -> np.ndarray:
        """Correlation of the parameters (p, p); NaN where an uncertainty is infinite."""
        with np.errstate(invalid="ignore"):
            return self.covariance / np.outer(self.standard_errors, self.standard_errors)

    @property
    def material(self):
        """The material with the constants found."""
        return self.tubes[0].material


def calibrate(measurements, fit=None, *, own_extension=False) -> Calibration:
    """Fit material constants and fiber extension to measured curves.

    Parameters
    ----------
    measurements : a :class:`Measurement` or several, of one or more actuators of one material: curves of length, rotation,
        force or torque, mixed as they come
    fit : names of what is fitted: the material's constants (c10, c01) and fiber_extension; default: all of them. What is not
        fitted stays as each measurement's actuator has it
    own_extension : whether each actuator has a fiber extension of its own (how tightly it was wound); default: one for all

    A coarse scan around the first guess (the actuators' own numbers) precedes the fit. States for which the model has no
    solution at what was found (blocked forces at low pressure, where the fibers are not taut yet) do not count. C10 and C01
    are hardly separable from one curve: ``notes`` and the covariance say how well. Returns a :class:`Calibration`. Raises
    :class:`ActuatorError`.
    """
    measurements, names, own_extension = _checked(measurements, fit, own_extension)
    problem = Problem(measurements, names, own_extension)
    if len(problem.measured) <= len(problem.names):
        counts = f"{len(problem.measured)} values cannot tell {len(problem.names)} parameters"
        raise ActuatorError([f"measurements: {counts}; give more, or fit fewer"])
    quantities = dict.fromkeys(problem.quantity.tolist())
    unknown = [name for name in quantities if np.any(np.isnan(problem.sigma[problem.quantity == name]))]
    sigma = problem.sigma.copy()
    for name in unknown:
        here = problem.quantity == name
        span = max(np.ptp(problem.measured[here]), FIRST_SIGMA * np.max(np.abs(problem.measured[here])), 1e-12)
        sigma[here] = FIRST_SIGMA * span
    theta = home = problem.start(sigma)
    rows = np.full(len(problem.measured), True)
    for _ in range(ROUNDS):
        theta = problem.solve(theta, home, sigma, rows)
        model, there = problem.model(theta)
        changed = np.any(there != rows) and there.sum() > len(theta)
        rows = there if changed else rows
        slopes = problem.derivative(theta, model) / sigma[:, None]
        settled = not changed
        for name in unknown:
            here = rows & (problem.quantity == name)
            scatter = _scatter(model - problem.measured, slopes, rows, here)
            scatter = max(
                scatter, LEAST_SCATTER * np.max(np.abs(problem.measured[problem.quantity == name]), initial=1e-9)
            )
            settled &= abs(scatter / sigma[problem.quantity == name][0] - 1.0) < SETTLED
            sigma[problem.quantity == name] = scatter
        if settled:
            break
    return _result(problem, theta, model, sigma, rows, bool(unknown))


def _scatter(residuals, slopes, rows, here):
    """Standard uncertainty from residuals: the parameters take their share of the degrees of freedom."""
    if not here.any():
        return 0.0
    left, values, _ = np.linalg.svd(slopes[rows], full_matrices=False)
    leverage = np.zeros(len(rows))
    leverage[rows] = np.sum(left[:, values > 1e-8 * max(values[0], 1e-300)] ** 2, axis=1)
    freedom = max(here.sum() - leverage[here].sum(), 0.5)
    return np.sqrt(np.sum(residuals[here] ** 2) / freedom)


def _checked(measurements, fit, own_extension):
    """Measurements as a tuple, the names to fit, and whether each actuator has an extension of its own."""
    if not isinstance(measurements, (list, tuple)):
        measurements = (measurements,)
    strangers = [
        f"measurements: found {type(m).__name__}; give Measurement objects"
        for m in measurements
        if not isinstance(m, Measurement)
    ]
    if strangers or not measurements:
        raise ActuatorError(strangers or ["measurements: found none; give one or more"])
    materials = {type(m.tube.material) for m in measurements}
    faults = []
    own_extension = read_switch("own_extension", own_extension, faults)
    if len(materials) > 1:
        faults.append(
            f"measurements: materials differ in kind, {' and '.join(sorted(t.__name__ for t in materials))}; give one"
        )
    known = [*measurements[0].tube.material.constants, EXTENSION]
    names = known if fit is None else read_names("fit", fit, faults)
    faults += [f"fit: found {name!r:.40}; choose among {', '.join(known)}" for name in names if name not in known]
    if not names and not faults:
        faults.append(f"fit: nothing to fit; choose among {', '.join(known)}")
    if faults:
        raise ActuatorError(faults)
    return tuple(measurements), [name for name in known if name in names], own_extension


def _effects(problem, derivative, rows):
    """Largest change of what was measured, as a share of the largest of its kind, per unit of each parameter (p,)."""
    effects = np.zeros(derivative.shape[1])
    for name in set(problem.quantity.tolist()):
        here = rows & (problem.quantity == name)
        size = np.max(np.abs(problem.measured[here]), initial=1e-300)
        effects = np.maximum(effects, np.max(np.abs(derivative[here]), axis=0, initial=0.0) / size)
    return effects


def _result(problem, theta, model, sigma, rows, estimated):
    from scipy.stats import t as student

    freedom = max(int(rows.sum()) - len(theta), 1)
    derivative = problem.derivative(theta)
    slopes = (derivative / sigma[:, None])[rows]
    residuals = ((model - problem.measured) / sigma)[rows]
    scaled, condition = covariance_of(slopes, theta, _effects(problem, derivative, rows) * relative(theta))
    covariance = scaled * np.outer(problem.scales, problem.scales)
    values = problem.offsets + problem.scales * theta
    half = student.ppf(0.975, freedom) * np.sqrt(np.diag(covariance))
    there = np.where(rows, model, np.nan)
    cuts = np.cumsum([len(m) * len(m.measured) for m in problem.measurements])[:-1]
    parts = [part.reshape(len(m), -1) for m, part in zip(problem.measurements, np.split(there, cuts))]
    found = {
        "names": problem.names,
        "values": values,
        "covariance": covariance,
        "intervals": np.column_stack([values - half, values + half]),
        "measurements": problem.measurements,
        "tubes": tuple(problem.tubes(theta)),
        "predicted": tuple(parts),
        "sigma": {
            name: float(np.sqrt(np.mean(sigma[problem.quantity == name] ** 2)))
            for name in dict.fromkeys(problem.quantity.tolist())
        },
        "condition": condition,
        "chi_square": float(residuals @ residuals) / freedom,
    }
    at_bound = [name for name, value, low in zip(problem.names, theta, problem.low) if value == low]
    return Calibration(**found, notes=notes_of(found, int((~rows).sum()), at_bound, estimated))

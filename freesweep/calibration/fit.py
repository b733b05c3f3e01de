"""Material constants and fiber extension from measured curves, by least squares on the exact model.

With r the residuals over their standard uncertainties and J their derivative along the parameters, the covariance of the
parameters is (J^T J)^-1. Where no uncertainties are given, that of each measured quantity is estimated from its scatter
about the fit, and the fit is made again with it; what that costs is in the covariance, too (:mod:`scatter`). Intervals are
Student's, for the degrees of freedom that are left.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..description.actuator import ActuatorError
from ..description.quantities import Names
from .asked import checked
from .calibration import Calibration, calibration_of
from .fitted import fitted
from .measured import Measurement
from .parameters import Parameters
from .problem import Problem
from .scatter import scatter_of

FIRST_SIGMA = 0.01  # of the range of what was measured
ROUNDS = 12  # of estimating uncertainties and fitting again
SETTLED = 0.03  # relative change of an uncertainty that ends the rounds
TOLD = 2.0  # standard errors by which a constant has to stand clear of 0
NOTHING = 1e-3  # of the first guess of a constant
LEAST_SCATTER = 1e-6  # of what was measured: no bench is better


def calibrate(
    measurements: Measurement | Sequence[Measurement],
    fit: Names = None,
    *,
    own_extension: bool = False,
    bounds: Mapping[str, Any] | None = None,
    priors: Mapping[str, Any] | None = None,
    ties: Mapping[str, str] | None = None,
    **known: Any,
) -> Calibration:
    """Fit any scalar of the actuator to measured curves.

    Parameters
    ----------
    measurements : a :class:`Measurement` or several, of one or more actuators of one material: curves of length, rotation,
        force or torque, mixed as they come
    fit : names of what is fitted: the material's constants (c10, c01), fiber_extension, alpha, beta, length, radius, wall,
        fiber_radius, and of the bench dead_length, the part of the length that does not work [m], and threshold_pressure,
        below which nothing does [Pa]. What is not fitted stays as each measurement's actuator has it. Default: constants and
        fiber_extension, with c01 tied to c10 unless the data tell both
    own_extension : whether each actuator has a fiber extension of its own (how tightly it was wound); default: one for all.
        Of the other scalars, actuators that were given one value share it; others are numbered
    bounds : ``{"wall": ("1 mm", "2 mm")}``, where they are searched
    priors, known : what is known before, with its standard uncertainty: ``priors={"alpha": (30, 1)}``, or ``alpha=(30, 1)``,
        is an angle known to a degree; such a parameter is fitted
    ties : ``{"beta": "-alpha", "c01": "0.5*c10"}``; where alpha is fitted and beta is its mirror image, it stays that

    A coarse scan around the first guess (the actuators' own numbers) precedes the fit. Loops are averaged; forces of exactly
    0 are slack muscles. Other states for which the model has no solution at what was found do not count. Residuals are
    tested: where the model does not fit, ``notes`` say so and the intervals are widened. Returns a :class:`Calibration`.
    Raises :class:`ActuatorError`.
    """
    asked = checked(measurements, fit, own_extension, bounds, priors, ties, known)
    found = _found(asked)
    material = asked.measurements[0].tube.material
    loose = material.constants == ("c10", "c01") and "c01" not in asked.ties and "c10" in asked.names
    if loose and (_vanished(found) or (fit is None and not _both_told(found))):
        ratio = material.c01 / material.c10
        tied = asked._replace(
            names=[name for name in asked.names if name != "c01"],
            ties=asked.ties | {"c01": (ratio, "c10")},
            notes=(*asked.notes, f"c01 = {ratio:.3g} c10, as in the first guess: the data do not tell both"),
        )
        found = _found(tied)
    return found


def _vanished(found):
    """Whether the first constant ended at next to nothing: no rubber is."""
    return bool(found.values[found.names.index("c10")] <= NOTHING * found.measurements[0].tube.material.c10)


def _both_told(found):
    """Whether both constants of a rubber stand clear of nothing."""
    index = [found.names.index(name) for name in ("c10", "c01")]
    with np.errstate(invalid="ignore"):
        return bool(np.all(found.values[index] > TOLD * found.standard_errors[index]))


def _found(asked):
    """The calibration of what was :class:`.asked.Asked`."""
    parameters = Parameters(
        asked.measurements, asked.names, asked.own_extension, asked.bounds, asked.priors, asked.ties
    )
    problem = Problem(parameters)
    known = int(np.isfinite(parameters.sigma).sum())
    if len(problem.measured) + known <= len(problem.names):
        counts = f"{len(problem.measured)} values cannot tell {len(problem.names)} parameters"
        raise ActuatorError([f"measurements: {counts}; give more, or fit fewer"])
    quantities = dict.fromkeys(problem.quantity.tolist())
    unknown = [name for name in quantities if np.any(np.isnan(problem.sigma[problem.quantity == name]))]
    sigma = problem.sigma.copy()
    spans = {name: _span(problem.measured[problem.quantity == name]) for name in quantities}
    for name in unknown:
        sigma[problem.quantity == name] = FIRST_SIGMA * spans[name]
    theta = home = problem.start(sigma)
    rows = np.full(len(problem.measured), True)
    for _ in range(ROUNDS):
        theta = problem.solve(theta, home, sigma, rows)
        model, there = problem.model(theta)
        counted = problem.counted(there)
        changed = np.any(counted != rows) and counted.sum() > len(theta)
        rows = counted if changed else rows
        slopes = problem.sloped(problem.derivative(theta, model), model, there) / sigma[:, None]
        settled = not changed
        for name in unknown:
            here = rows & (problem.quantity == name)
            others = [sigma[problem.quantity == other] / spans[other] for other in quantities if other != name]
            elsewhere = spans[name] * np.sqrt(np.mean(np.concatenate(others) ** 2)) if others else 0.0
            scatter = scatter_of(problem.residuals(model, there), slopes, rows, here, 1.0 / parameters.sigma, elsewhere)
            least = LEAST_SCATTER * np.max(np.abs(problem.measured[problem.quantity == name]), initial=1e-9)
            scatter = max(scatter, least)
            settled &= abs(scatter / sigma[problem.quantity == name][0] - 1.0) < SETTLED
            sigma[problem.quantity == name] = scatter
        if settled:
            break
    return calibration_of(fitted(problem, theta, home, sigma, rows, unknown), asked.notes)


def _span(measured):
    """Range of what was measured."""
    return max(np.ptp(measured), FIRST_SIGMA * np.max(np.abs(measured)), 1e-12)

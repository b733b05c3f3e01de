"""Material constants and fiber extension from measured curves, by least squares on the exact model.

With r the residuals over their standard uncertainties and J their derivative along the parameters, the covariance of the
parameters is (J^T J)^-1. Where no uncertainties are given, that of each measured quantity is estimated from its scatter
about the fit, and the fit is made again with it; what that costs is in the covariance, too (:mod:`scatter`). Intervals are
Student's, for the degrees of freedom that are left.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..description.actuator import Actuator, ActuatorError
from ..description.elastomer import MooneyRivlin, Yeoh
from ..description.given import described
from ..description.options import read_switch
from ..description.quantities import Names, Quantities
from .branches import hysteresis_of, mean_of_loops
from .identify import covariance_of, notes_of, relative
from .judge import judge
from .likelihood import profile_intervals
from .measured import Measurement, read_names
from .parameters import EXTENSION, Parameters, known_names, read_pairs, read_ties
from .problem import Problem
from .scatter import estimated, scatter_of

if TYPE_CHECKING:
    import xarray as xr

FIRST_SIGMA = 0.01  # of the range of what was measured
ROUNDS = 12  # of estimating uncertainties and fitting again
SETTLED = 0.03  # relative change of an uncertainty that ends the rounds
TOLD = 2.0  # standard errors by which a constant has to stand clear of 0
NOTHING = 1e-3  # of the first guess of a constant
LEAST_SCATTER = 1e-6  # of what was measured: no bench is better


@dataclass(frozen=True, eq=False)
class Calibration:
    """What :func:`calibrate` found.

    names : of the parameters (p,); fiber extensions of the actuators' own are numbered as these first come
    values, covariance, intervals : (p,), (p, p) of noise, (p, 2) at 95 %, in [Pa, 1, degree, m]; infinite where blind
    tubes : the actuator of each measurement, with what was found
    predicted : the model's (n, measured) for each measurement, NaN where it has no state
    sigma : standard uncertainty by measured quantity: as given (root mean square), or estimated from the scatter
    condition : ratio of the best to the worst seen combination of relative changes of the parameters
    chi_square : weighted squared residuals per degree of freedom; near 1 where the model fits the uncertainties given
    notes : what a reader has to know, in sentences
    profile_intervals : (p, 2) at 95 % from the profile likelihood: other parameters are fitted anew at each value
    fits : whether the residuals look like noise; where they do not, intervals are widened for it, ``widening`` times (p,)
    leave_one_out : root mean square misfit by quantity of curves, each by a fit to all others (NaN: there are none)
    hysteresis : half of what parts the branches of loops, root mean square, by quantity
    dead_length, threshold_pressure : of the bench [m, Pa]
    quantile : Student's, of the intervals; ``parameters`` : how theta becomes actuators
    """

    names: tuple[str, ...]
    values: np.ndarray
    covariance: np.ndarray
    intervals: np.ndarray
    measurements: tuple[Measurement, ...]
    tubes: tuple[Actuator, ...]
    predicted: tuple[Any, ...]
    sigma: dict[str, float]
    condition: float
    chi_square: float
    notes: tuple[str, ...]
    profile_intervals: np.ndarray | None = None
    fits: bool = True
    widening: np.ndarray | None = None
    leave_one_out: dict[str, float] = field(default_factory=dict)
    hysteresis: dict[str, float] = field(default_factory=dict)
    dead_length: float = 0.0
    threshold_pressure: float = 0.0
    quantile: float = 1.96
    parameters: object = field(default=None, repr=False)

    def band(self, quantity: str, pressure: Quantities, *, actuator: int = 0, **imposed: Quantities) -> "xr.Dataset":
        """What the bench would read in a load case, with the band in which 95 % of readings are expected, as a Dataset.

        ``quantity`` is deformed_length, rotation, force ... under ``pressure`` [Pa] and what is ``imposed`` (force, torque,
        deformed_length, contraction, stroke, rotation), as in a :class:`Measurement`, number or array, on the actuator of
        the measurement of that place. Raises :class:`ActuatorError`.
        """
        from .band import band_of

        return band_of(self, quantity, pressure, actuator, **imposed)

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
    def material(self) -> MooneyRivlin | Yeoh:
        """The material with the constants found."""
        return self.tubes[0].material


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
    asked = _checked(measurements, fit, own_extension, bounds, priors, ties, known)
    found = _fitted(asked)
    material = asked.measurements[0].tube.material
    loose = material.constants == ("c10", "c01") and "c01" not in asked.ties and "c10" in asked.names
    if loose and (_vanished(found) or (fit is None and not _both_told(found))):
        ratio = material.c01 / material.c10
        tied = asked._replace(
            names=[name for name in asked.names if name != "c01"],
            ties=asked.ties | {"c01": (ratio, "c10")},
            notes=(*asked.notes, f"c01 = {ratio:.3g} c10, as in the first guess: the data do not tell both"),
        )
        found = _fitted(tied)
    return found


class _Asked(NamedTuple):
    """What was asked for, checked."""

    measurements: tuple
    names: list
    own_extension: bool
    bounds: dict
    priors: dict
    ties: dict
    notes: tuple


def _vanished(found):
    """Whether the first constant ended at next to nothing: no rubber is."""
    return bool(found.values[found.names.index("c10")] <= NOTHING * found.measurements[0].tube.material.c10)


def _both_told(found):
    """Whether both constants of a rubber stand clear of nothing."""
    index = [found.names.index(name) for name in ("c10", "c01")]
    with np.errstate(invalid="ignore"):
        return bool(np.all(found.values[index] > TOLD * found.standard_errors[index]))


def _fitted(asked):
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
    sigma, spans = (
        problem.sigma.copy(),
        {name: _span(problem.measured[problem.quantity == name]) for name in quantities},
    )
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
    return _result(problem, theta, home, sigma, rows, unknown, asked.notes)


def _span(measured):
    """Range of what was measured."""
    return max(np.ptp(measured), FIRST_SIGMA * np.max(np.abs(measured)), 1e-12)


def _checked(measurements, fit, own_extension, bounds, priors, ties, known):
    """What was asked for; raises :class:`ActuatorError`."""
    if not isinstance(measurements, (list, tuple)):
        measurements = (measurements,)
    strangers = [
        f"measurements: found {type(m).__name__}; give Measurement objects"
        for m in measurements
        if not isinstance(m, Measurement)
    ]
    if strangers or not measurements:
        raise ActuatorError(strangers or ["measurements: found none; give one or more"])
    material = measurements[0].tube.material
    materials = {type(m.tube.material) for m in measurements}
    faults = []
    own_extension = read_switch("own_extension", own_extension, faults)
    if len(materials) > 1:
        faults.append(
            f"measurements: materials differ in kind, {' and '.join(sorted(t.__name__ for t in materials))}; give one"
        )
    allowed, usual = known_names(material), [*material.constants, EXTENSION]
    names = usual if fit is None else list(read_names("fit", fit, faults))
    faults += [f"fit: found {name!r:.40}; choose among {', '.join(allowed)}" for name in names if name not in allowed]
    if priors is not None and not isinstance(priors, dict):
        faults.append(f"priors: found {described(priors)}; give a dict such as {{'alpha': (30, 1)}}")
        priors = None
    bounds = read_pairs("bounds", bounds, material, faults)
    priors = read_pairs("priors", {**(priors or {}), **known}, material, faults, positive=True)
    ties = read_ties(ties, material, faults)
    names += [base for base in dict.fromkeys(_base(name, allowed) for name in priors) if base not in names]
    names = [name for name in names if name not in ties]
    if not names and not faults:
        faults.append(f"fit: nothing to fit; choose among {', '.join(allowed)}")
    if faults:
        raise ActuatorError(faults)
    averaged, notes = [], []
    for measurement in measurements:
        mean, note = mean_of_loops(measurement)
        averaged.append(mean)
        notes += [*measurement.notes, *([note] if note else [])]
    order = [name for name in allowed if name in names]
    return _Asked(tuple(averaged), order, own_extension, bounds, priors, ties, tuple(notes))


def _base(name, allowed):
    return name if name in allowed else name.rstrip("0123456789").removesuffix("_")


def _effects(problem, derivative, rows):
    """Largest change of what was measured, as a share of the largest of its kind, per unit of each parameter (p,)."""
    effects = np.zeros(derivative.shape[1])
    for name in set(problem.quantity.tolist()):
        here = rows & (problem.quantity == name)
        size = np.max(np.abs(problem.measured[here]), initial=1e-300)
        effects = np.maximum(effects, np.max(np.abs(derivative[here]), axis=0, initial=0.0) / size)
    return effects


def _result(problem, theta, home, sigma, rows, unknown, notes):
    from scipy.stats import t as student

    parameters = problem.parameters
    model, there = problem.model(theta)
    residuals = problem.residuals(model, there)
    derivative = problem.sloped(problem.derivative(theta), model, there)
    known = 1.0 / parameters.sigma
    active = rows & (~problem.slack | (there & (residuals > 0.0)))
    freedom = max(int(active.sum()) + int((known > 0.0).sum()) - len(theta), 1)
    slopes = np.vstack([(derivative / sigma[:, None])[rows], np.diag(known)])
    effects = np.maximum(_effects(problem, derivative, rows) * relative(theta), known)
    scaled, condition = covariance_of(slopes, theta, effects)
    weighed = (residuals / sigma)[rows]
    chi_square = float(weighed @ weighed + np.sum(((theta - parameters.mean) * known) ** 2)) / freedom
    judged = judge(problem, theta, home, residuals, derivative, sigma, rows, active, unknown, chi_square, freedom)
    freedom = judged.freedom
    values = parameters.values(theta)
    each, whole = np.full(len(theta), float(freedom)), scaled
    if unknown and judged.fits:
        each, added = estimated(derivative / sigma[:, None], scaled, problem.quantity, unknown, active, freedom)
        whole = scaled + added
    covariance = whole * np.outer(parameters.unit, parameters.unit)
    with np.errstate(invalid="ignore"):
        widening = judged.widening * np.sqrt(np.nan_to_num(np.diag(whole) / np.diag(scaled), nan=1.0))
    quantiles = student.ppf(0.975, each)
    half = quantiles * np.sqrt(np.diag(covariance)) * judged.widening
    intervals = parameters.within(np.column_stack([values - half, values + half]))
    profiled = profile_intervals(problem, theta, sigma, rows, scaled, widening, quantiles)
    shown_there = np.where(rows & there, model, np.nan)
    cuts = np.cumsum([len(m) * len(m.measured) for m in problem.measurements])[:-1]
    parts = [part.reshape(len(m), -1) for m, part in zip(problem.measurements, np.split(shown_there, cuts))]
    setups = parameters.setups(theta)
    found = {
        "names": problem.names,
        "values": values,
        "covariance": covariance,
        "intervals": intervals,
        "measurements": problem.measurements,
        "tubes": tuple(setup.tube for setup in setups),
        "predicted": tuple(parts),
        "sigma": {
            name: float(np.sqrt(np.mean(sigma[problem.quantity == name] ** 2)))
            for name in dict.fromkeys(problem.quantity.tolist())
        },
        "condition": condition,
        "chi_square": chi_square,
        "profile_intervals": parameters.within(parameters.offset[:, None] + parameters.unit[:, None] * profiled),
        "fits": judged.fits,
        "widening": judged.widening,
        "leave_one_out": judged.leave_one_out,
        "hysteresis": hysteresis_of(problem.measurements),
        "quantile": float(student.ppf(0.975, freedom)),
        "parameters": parameters,
        "dead_length": setups[0].dead,
        "threshold_pressure": setups[0].threshold,
    }
    at_bound = {
        name: "smallest" if value == low else "largest"
        for name, value, low, high in zip(problem.names, theta, problem.low, problem.high)
        if value in (low, high)
    }
    left_out = int((~rows).sum())
    said = notes_of(found, left_out, at_bound, bool(unknown))
    return Calibration(**found, notes=(*judged.notes, *said, *notes))

"""What a calibration found: parameters, how exactly they are known, and what the bench reads by them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..description.actuator import Actuator
from ..description.elastomer import MooneyRivlin, Yeoh
from ..description.quantities import Quantities
from .branches import hysteresis_of
from .fitted import Fitted
from .identify import covariance_of, notes_of, relative
from .judge import Judged, judge
from .likelihood import profile_intervals
from .measured import Measurement
from .scatter import estimated

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


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
    notes : in sentences: the verdict, and the typical misfit as a share of the range measured; what a reader has to know
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

    def __repr__(self):
        """What the shell prints."""
        from .report import table

        return table(self)

    def band(self, quantity: str, pressure: Quantities, *, actuator: int = 0, **imposed: Quantities) -> xr.Dataset:
        """What the bench would read in a load case, with the band in which 95 % of readings are expected, as a Dataset.

        ``quantity`` is deformed_length, rotation, force ... under ``pressure`` [Pa] and what is ``imposed`` (force, torque,
        deformed_length, contraction, stroke, rotation), as in a :class:`Measurement`, number or array, on the actuator of
        the measurement of that place. Raises :class:`ActuatorError`.
        """
        from .band import band_of

        return band_of(self, quantity, pressure, actuator, **imposed)

    def picture(self) -> Figure:
        """Each measured curve with the model's and its band, and what is left below; ``freesweep.plot.style.save`` keeps it.

        Dots: what was measured (rings: slack muscles); lines: the model; bands: where 95 % of readings are expected.
        """
        from .picture import picture

        return picture(self)

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


class _Spread(NamedTuple):
    """How exactly parameters are known: their covariance in units of theta, where the size of the noise is taken for known,
    and where it is not; Student's quantiles (p,); and the condition of the slopes.
    """

    scaled: np.ndarray
    covariance: np.ndarray
    quantiles: np.ndarray
    condition: float


def calibration_of(fit: Fitted, notes) -> Calibration:
    """What a fit tells, and the ``notes`` on what it was made from."""
    from scipy.stats import t as student

    problem, parameters = fit.problem, fit.problem.parameters
    judged = judge(fit)
    spread = _spread(fit, judged)
    values = parameters.values(fit.theta)
    covariance = spread.covariance * np.outer(parameters.unit, parameters.unit)
    half = spread.quantiles * np.sqrt(np.diag(covariance)) * judged.widening
    with np.errstate(invalid="ignore"):
        widening = judged.widening * np.sqrt(
            np.nan_to_num(np.diag(spread.covariance) / np.diag(spread.scaled), nan=1.0)
        )
    profiled = profile_intervals(problem, fit.theta, fit.sigma, fit.rows, spread.scaled, widening, spread.quantiles)
    setups = parameters.setups(fit.theta)
    found = {
        "names": problem.names,
        "values": values,
        "covariance": covariance,
        "intervals": parameters.within(np.column_stack([values - half, values + half])),
        "measurements": problem.measurements,
        "tubes": tuple(setup.tube for setup in setups),
        "predicted": _predicted(fit),
        "sigma": {name: float(np.sqrt(np.mean(fit.sigma[problem.quantity == name] ** 2))) for name in fit.quantities},
        "condition": spread.condition,
        "chi_square": fit.chi_square(),
        "profile_intervals": parameters.within(parameters.offset[:, None] + parameters.unit[:, None] * profiled),
        "fits": judged.fits,
        "widening": judged.widening,
        "leave_one_out": judged.leave_one_out,
        "hysteresis": hysteresis_of(problem.measurements),
        "quantile": float(student.ppf(0.975, judged.freedom)),
        "parameters": parameters,
        "dead_length": setups[0].dead,
        "threshold_pressure": setups[0].threshold,
    }
    said = notes_of(found, int((~fit.rows).sum()), _at_bound(fit), bool(fit.unknown))
    return Calibration(**found, notes=(judged.verdict, *said, *notes))


def _spread(fit: Fitted, judged: Judged) -> _Spread:
    """How exactly the parameters are known, by the slopes at the fit."""
    from scipy.stats import t as student

    slopes = np.vstack([fit.slopes[fit.rows], np.diag(fit.known)])
    effects = np.maximum(_effects(fit) * relative(fit.theta), fit.known)
    scaled, condition = covariance_of(slopes, fit.theta, effects)
    each, whole = np.full(len(fit.theta), float(judged.freedom)), scaled
    if fit.unknown and judged.fits:
        quantity = fit.problem.quantity
        each, added = estimated(fit.slopes, scaled, quantity, fit.unknown, fit.active, judged.freedom)
        whole = scaled + added
    return _Spread(scaled, whole, student.ppf(0.975, each), condition)


def _effects(fit: Fitted):
    """Largest change of what was measured, as a share of the largest of its kind, per unit of each parameter (p,)."""
    effects = np.zeros(len(fit.theta))
    for name in fit.quantities:
        here = fit.rows & (fit.problem.quantity == name)
        size = np.max(np.abs(fit.problem.measured[here]), initial=1e-300)
        effects = np.maximum(effects, np.max(np.abs(fit.derivative[here]), axis=0, initial=0.0) / size)
    return effects


def _predicted(fit: Fitted):
    """What the model says of each measurement, (n, measured) each; NaN where it has no state."""
    measurements, shown = fit.problem.measurements, np.where(fit.rows & fit.there, fit.model, np.nan)
    cuts = np.cumsum([len(m) * len(m.measured) for m in measurements])[:-1]
    return tuple(part.reshape(len(m), -1) for m, part in zip(measurements, np.split(shown, cuts)))


def _at_bound(fit: Fitted):
    """Parameters that ended at the end of where they are searched: name -> which end."""
    problem = fit.problem
    return {
        name: "smallest" if value == low else "largest"
        for name, value, low, high in zip(problem.names, fit.theta, problem.low, problem.high)
        if value in (low, high)
    }

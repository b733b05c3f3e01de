"""What a calibrated actuator will do in any load case, and how far that can be trusted."""

import numpy as np

from ..description.faults import ActuatorError
from ..description.given import read_column
from ..description.options import read_choice
from .measured import COLUMNS, Measurement
from .predicted import Predictor

STEP = 0.3  # standard errors: of the differences that carry them over
PUSH = -1e9  # [N]: whoever asks for a band may ask where the tube pushes
DUMMY = {"deformed_length": 0.9, "rotation": 0.0, "mid_radius": 1.0, "force": PUSH, "torque": 1.0}


def band_of(found, quantity, pressure, actuator=0, **imposed):
    """See :meth:`freesweep.Calibration.band`."""
    faults = []
    read_choice("quantity", quantity, tuple(COLUMNS), faults)
    pressure = read_column("pressure", pressure, "Pa", faults, least=0.0)
    if not isinstance(actuator, int) or not 0 <= actuator < len(found.measurements):
        faults.append(
            f"actuator: found {actuator!r:.40}; give 0 to {len(found.measurements) - 1}, a measurement's place"
        )
    if faults:
        raise ActuatorError(faults)
    own = found.measurements[actuator]
    count = max(np.size(pressure), *(np.size(value) for value in imposed.values()), 1)
    dummy = np.full(count, DUMMY[quantity] * (own.tube.length if quantity == "deformed_length" else 1.0))
    asked = Measurement(own.tube, pressure, **imposed, **{quantity: dummy}, measured=quantity)
    predictor, parameters = Predictor([asked]), found.parameters
    errors = found.standard_errors / parameters.unit
    known = np.flatnonzero(np.isfinite(errors) & (errors > 0.0))
    theta = (found.values - parameters.offset) / parameters.unit
    points = [theta]
    for k in known:
        for sign in (-1.0, 1.0):
            point = theta.copy()
            point[k] = np.clip(point[k] + sign * STEP * errors[k], parameters.low[k], parameters.high[k])
            points.append(point)
    setups = [[parameters.setups(point)[actuator]] for point in points]
    predictor.settle(setups[0])
    values = np.array([each[0][:, 0] for each in predictor.predict(setups)])
    spans = np.array([points[2 * i + 2][k] - points[2 * i + 1][k] for i, k in enumerate(known)])
    slopes = (values[2::2] - values[1::2]) / spans[:, None] if len(known) else np.zeros((0, count))
    widened = found.covariance / np.outer(parameters.unit, parameters.unit)
    widened = widened * np.outer(found.widening, found.widening)
    variance = np.einsum("ki,kl,li->i", slopes, widened[np.ix_(known, known)], slopes)
    half = found.quantile * np.sqrt(variance + found.sigma.get(quantity, 0.0) ** 2) + found.hysteresis.get(
        quantity, 0.0
    )
    return _dataset(quantity, asked, imposed, values[0], half)


def _dataset(quantity, asked, imposed, value, half):
    import xarray as xr

    units = {"units": COLUMNS[quantity]}
    coordinates = {"pressure": ("state", asked.pressure, {"units": "Pa"})}
    for name in COLUMNS:
        if getattr(asked, name) is not None and name != quantity:
            coordinates[name] = "state", getattr(asked, name), {"units": COLUMNS[name]}
    data = {
        quantity: ("state", value, units),
        f"{quantity}_low": ("state", value - half, units),
        f"{quantity}_high": ("state", value + half, units),
    }
    comment = "where 95 % of single readings are expected: parameters, scatter and hysteresis together"
    return xr.Dataset(data, coordinates, {"comment": comment})

"""A calibration as text for people, and as a Dataset."""

import numpy as np

from ..report import SHOWN, aligned
from .measured import COLUMNS


def table(found) -> str:
    """Parameters with uncertainties, what was measured and how well it is met, and what a reader has to know."""
    rows = [["parameter", "value", "standard error", "95 % interval"]]
    for name, value, error, (low, high) in zip(found.names, found.values, found.standard_errors, found.intervals):
        scale, unit = (1e-6, " MPa") if name.startswith("c") else (1.0, "")
        digits = _digits(value * scale, error * scale)
        rows.append(
            [
                name,
                f"{value * scale:.{digits}f}{unit}",
                f"{error * scale:.2g}{unit}",
                _interval(low * scale, high * scale, digits),
            ]
        )
    lines = [*aligned(rows), ""]
    rows = [["measured", "values", "counted", "standard uncertainty", "largest misfit"]]
    for name, sigma in found.sigma.items():
        unit, scale = SHOWN[COLUMNS[name]]
        misfit = np.concatenate(
            [residuals[name] for residuals in map(_residuals, found.measurements, found.predicted) if name in residuals]
        )
        counted = np.isfinite(misfit)
        largest = np.max(np.abs(misfit[counted]), initial=0.0) * scale
        rows.append(
            [name, str(len(misfit)), str(counted.sum()), f"{sigma * scale:.3g} {unit}", f"{largest:.3g} {unit}"]
        )
    lines += [*aligned(rows), "", *(f"- {note}" for note in found.notes), "", repr(found.material)]
    return "\n".join(lines)


def _residuals(measurement, predicted):
    return {name: predicted[:, k] - getattr(measurement, name) for k, name in enumerate(measurement.measured)}


def _digits(value, error):
    """Decimals that show two digits of the error."""
    if not 0.0 < error < np.inf:
        return 6
    return int(np.clip(1 - np.floor(np.log10(error)), 0, 8))


def _interval(low, high, digits):
    return f"{low:.{digits}f} to {high:.{digits}f}" if np.isfinite(low) else "the data do not tell"


def to_dataset(found):
    """Parameters, covariance, and measured beside predicted values, one state after the other, as an xarray Dataset."""
    import xarray as xr

    states = {"curve": np.concatenate([np.full(len(m), k, np.int32) for k, m in enumerate(found.measurements)])}
    units = {"curve": "1", "pressure": "Pa"}
    states["pressure"] = np.concatenate([m.pressure for m in found.measurements])
    for name in found.sigma:
        empty = [np.full(len(m), np.nan) for m in found.measurements]
        pairs = [(getattr(m, name), p[:, m.measured.index(name)]) if name in m.measured else (e, e)
                 for m, p, e in zip(found.measurements, found.predicted, empty)]  # fmt: skip
        states[f"measured_{name}"], states[f"predicted_{name}"] = (np.concatenate(column) for column in zip(*pairs))
        units |= {f"measured_{name}": COLUMNS[name], f"predicted_{name}": COLUMNS[name]}
    data = {name: ("state", array, {"units": units[name]}) for name, array in states.items()}
    data["value"] = ("parameter", found.values, {"comment": "constants in Pa, fiber extensions in 1"})
    data["standard_error"] = ("parameter", found.standard_errors)
    data["interval"] = (("parameter", "bound"), found.intervals, {"long_name": "95 % confidence interval"})
    data["covariance"] = (("parameter", "other_parameter"), found.covariance)
    names = np.array(found.names)
    result = xr.Dataset(data, {"parameter": names, "other_parameter": names, "bound": np.array(["low", "high"])})
    result.attrs = {
        "title": "calibration", "notes": "\n".join(found.notes),
        "condition": found.condition, "chi_square": found.chi_square,
        **{f"curve_{k}": repr(tube) for k, tube in enumerate(found.tubes)},
    }  # fmt: skip
    return result

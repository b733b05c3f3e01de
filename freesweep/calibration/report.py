"""A calibration as text for people, and as a Dataset."""

import numpy as np

from ..report import SHOWN, aligned, shown_in
from .measured import COLUMNS

KEPT = {"alpha": "degree", "beta": "degree", "threshold_pressure": "Pa"}  # in these, of parameters
KEPT |= dict.fromkeys(("length", "radius", "wall", "fiber_radius", "dead_length"), "m")
CONSTANTS = "constants"  # of rubbers: megapascals, unless pressures were given in what is no multiple of a pascal
USUAL = SHOWN | {CONSTANTS: ("MPa", 1e-6)}
SAME = 1e-3  # of an interval's width: ends that differ by less are the same


def shown_as(asked) -> dict:
    """Units of a report, as :func:`freesweep.report.shown_in` finds them."""
    shown = shown_in(asked)
    _, scale = shown["Pa"]
    return USUAL | shown | ({} if np.log10(scale).is_integer() else {CONSTANTS: shown["Pa"]})


def table(found, shown=USUAL) -> str:
    """Parameters with uncertainties, what was measured and how well it is met, and what a reader has to know."""
    lines = [*aligned(rows_of(found, shown)), "", *aligned(told_rows(found, shown)), ""]
    lines += [*(f"- {note}" for note in found.notes), "", repr(found.material)]
    return "\n".join(lines)


def unit_of(name, shown=USUAL) -> tuple:
    """Unit in which a parameter is shown, and its scale."""
    kept = kept_in(name)
    return shown[kept] if kept else ("", 1.0)


def kept_in(name) -> str | None:
    """Unit in which a parameter is kept, ``CONSTANTS``, or None."""
    base = name.rstrip("0123456789").removesuffix("_") if "_" in name else name
    return KEPT.get(base, CONSTANTS if name.startswith("c") else None)


def rows_of(found, shown=USUAL) -> list:
    """Parameters, with a profile interval where it differs from the linearised one."""
    profiled = found.profile_intervals
    with np.errstate(invalid="ignore"):  # of what data do not tell
        moved = np.max(np.abs(profiled - found.intervals), axis=1)
        apart = moved > SAME * np.ptp(found.intervals, axis=1)
    heads = ["parameter", "value", "standard error", "95 % interval"]
    rows = [[*heads, "by profile likelihood"] if apart.any() else heads]
    for k, (name, value, error) in enumerate(zip(found.names, found.values, found.standard_errors)):
        unit, scale = unit_of(name, shown)
        unit = f" {unit}" if unit else ""
        digits = _digits(value * scale, error * scale)
        row = [name, f"{value * scale:.{digits}f}{unit}", f"{error * scale:.2g}{unit}"]
        row.append(_interval(*(found.intervals[k] * scale), digits))
        if apart.any():
            row.append(_interval(*(profiled[k] * scale), digits) if apart[k] else "the same")
        rows.append(row)
    return rows


def told_rows(found, shown=USUAL) -> list:
    """What was measured and how well it is met, by quantity."""
    heads = ["measured", "values", "counted", "standard uncertainty", "largest misfit", "unseen curves"]
    rows = [[*heads, "half of a loop"] if found.hysteresis else heads]
    for name, sigma in found.sigma.items():
        unit, scale = shown[COLUMNS[name]]
        misfit = np.concatenate(
            [residuals[name] for residuals in map(_residuals, found.measurements, found.predicted) if name in residuals]
        )
        counted = np.isfinite(misfit)
        largest = np.max(np.abs(misfit[counted]), initial=0.0) * scale
        unseen = found.leave_one_out.get(name, np.nan) * scale
        row = [name, str(len(misfit)), str(counted.sum()), f"{sigma * scale:.3g} {unit}", f"{largest:.3g} {unit}"]
        row.append(f"{unseen:.3g} {unit}" if np.isfinite(unseen) else "one curve only")
        if found.hysteresis:
            row.append(f"{found.hysteresis[name] * scale:.3g} {unit}" if name in found.hysteresis else "-")
        rows.append(row)
    return rows


def _residuals(measurement, predicted):
    found = {name: predicted[:, k] - getattr(measurement, name) for k, name in enumerate(measurement.measured)}
    if "force" in found:  # a slack muscle is missed by what pulls only
        found["force"] = np.where(measurement.slack, np.fmax(found["force"], 0.0), found["force"])
    return found


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
    data["profile_interval"] = (("parameter", "bound"), found.profile_intervals, {"long_name": "by profile likelihood"})
    data["covariance"] = (("parameter", "other_parameter"), found.covariance)
    names = np.array(found.names)
    result = xr.Dataset(data, {"parameter": names, "other_parameter": names, "bound": np.array(["low", "high"])})
    result.attrs = {
        "title": "calibration", "notes": "\n".join(found.notes),
        "condition": found.condition, "chi_square": found.chi_square, "fits": int(found.fits),
        **{f"curve_{k}": repr(tube) for k, tube in enumerate(found.tubes)},
    }  # fmt: skip
    return result

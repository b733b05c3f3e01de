"""What was found, solved at full accuracy, as a Dataset; and in one sentence."""

from typing import NamedTuple

import numpy as np

from ..atlas.schema import PARAMETERS
from ..status import STATUSES, VALUED
from .misfit import Misfit
from .predict import predict
from .wishes import DESIGN, UNITS

ACCURACY = 1e-7
FIGHT = -0.3  # cosine of two gradients: goals that pull against each other
NOTHING = 1e-6  # tolerances that a goal changes over all that is free: it cannot be moved
FIELDS = (*DESIGN, "pressure", "force", "torque")


class Found(NamedTuple):
    """Candidates: a Dataset along ``candidate``, and the actuator of each."""

    data: object
    tubes: list


def gather(misfit: Misfit, u, choice, slopes, objectives=0) -> Found:
    """The candidates at points u (n, p), in the order given."""
    import xarray as xr

    space, wishes = misfit.space, misfit.wishes
    tubes = [space.actuator(one, k) for one, k in zip(u, choice)]
    found = predict(space, wishes, u, choice, ACCURACY)
    residuals = misfit.residuals(found.values)
    columns = space.columns(u, choice)
    asked, last = misfit.goals, len(wishes) - objectives
    low, high = (np.array([getattr(wish, end) for wish in wishes]) for end in ("low", "high"))
    kept = (found.values >= low - found.bounds) & (found.values <= high + found.bounds)
    met = np.abs(residuals) <= 1.0 + found.bounds / misfit.tolerances
    data = {
        name: ("candidate", columns[name], {"units": PARAMETERS[name].units})
        for name in FIELDS
        if name in columns and (np.any(columns[name] != 0.0) or name in space.names)
    }
    for name, count in space.knots.items():
        own = [k for k, each in enumerate(space.names) if each.startswith(f"{name}[")]
        data[name] = (("candidate", "knot"), space.values(u)[:, own], {"units": PARAMETERS[name].units})
        data[f"{name}_place"] = ("knot", np.linspace(0.0, 1.0, count), {"units": "1"})
    data |= {
        "goal_value": (("candidate", "goal"), found.values[:, :asked]),
        "goal_error": (("candidate", "goal"), found.bounds[:, :asked]),
        "goal_missed": (("candidate", "goal"), np.where(np.isfinite(residuals), residuals, np.nan)[:, :asked]),
        "goal_met": (("candidate", "goal"), met[:, :asked]),
        "goal_low": ("goal", [wish.low for wish in wishes[:asked]]),
        "goal_high": ("goal", [wish.high for wish in wishes[:asked]]),
        "goal_tolerance": ("goal", misfit.tolerances[:asked]),
        "slope": (("candidate", "goal", "parameter"), _slopes(misfit, slopes)[:, :asked]),
        "status": (("candidate",), _worst(found.status[:, :last])),
        "met": (("candidate",), np.all(met[:, :asked], axis=1) & np.all(kept[:, asked:last], axis=1)),
        "misfit": (("candidate",), np.sqrt(np.sum(residuals[:, :last] ** 2, axis=1))),
        "python": (("candidate",), [f"fs.{tube!r}".replace("material=", "material=fs.") for tube in tubes]),
    }
    if last > asked:
        data |= {
            "limit_value": (("candidate", "limit"), found.values[:, asked:last]),
            "limit_error": (("candidate", "limit"), found.bounds[:, asked:last]),
            "limit_kept": (("candidate", "limit"), kept[:, asked:last]),
            "limit_low": ("limit", [wish.low for wish in wishes[asked:last]]),
            "limit_high": ("limit", [wish.high for wish in wishes[asked:last]]),
        }
    if objectives:
        data["objective"] = (("candidate", "minimized"), found.values[:, last:])
        data["objective_error"] = (("candidate", "minimized"), found.bounds[:, last:])
    coordinates = {
        "candidate": np.arange(len(u)),
        "goal": [wish.title for wish in wishes[:asked]],
        "parameter": list(space.names),
    }
    if last > asked:
        coordinates["limit"] = [wish.title for wish in wishes[asked:last]]
    if objectives:
        coordinates["minimized"] = [wish.title for wish in wishes[last:]]
    result = xr.Dataset(data, coordinates)
    result["goal_missed"].attrs["long_name"] = "tolerances by which a goal is missed"
    result["slope"].attrs["long_name"] = "change of the goal's output by one unit of what is free"
    result["status"].attrs = {
        "flag_values": [status.value for status in STATUSES], "flag_meanings": " ".join(s.meaning for s in STATUSES)
    }  # fmt: skip
    result.attrs = {"title": f"designs from {space.template!r}", "summary": sentence(misfit, result, u, slopes)}
    return Found(result, tubes)


def _worst(status):
    """The largest status of a candidate's states that says there is no value, else 0."""
    return np.max(np.where(np.isin(status, VALUED), 0, status), axis=1, initial=0)


def _slopes(misfit, slopes):
    """From tolerances along the unit box to units of output per unit of parameter."""
    space = misfit.space
    return slopes * misfit.tolerances[:, None] / np.where(space.high > space.low, space.high - space.low, 1.0)


def sentence(misfit: Misfit, result, u, slopes) -> str:
    """How many candidates do it; if none: what the nearest one misses, and which goals fight."""
    count = int(np.sum(result["met"].values))
    if count:
        return f"{count} of {len(u)} candidates meet every goal and keep every limit"
    missed = np.abs(result["goal_missed"].values[0])
    worst = int(np.argmax(np.nan_to_num(missed, nan=np.inf)))
    wish, value = misfit.wishes[worst], result["goal_value"].values[0, worst]
    wanted = _range(wish)
    unit = UNITS.get(wish.output) or PARAMETERS[wish.output].units
    said = (
        f"no design that is allowed does it; the nearest one has {wish.title} of {value:.6g} {unit} instead of {wanted}"
    )
    if not np.any(missed > 1.0):
        broken = [str(name) for name, kept in zip(result["limit"].values, result["limit_kept"].values[0]) if not kept]
        return f"no design that is allowed meets the goals and keeps the limits: {', '.join(broken)}"
    if np.all(np.abs(slopes[0][worst]) < NOTHING * max(missed[worst], 1.0)):
        return f"{said}: nothing that is free changes it"
    pulls = slopes[0] * result_signs(misfit, result)[:, None]
    for other in np.argsort(-missed):
        a, b = pulls[worst], pulls[other]
        size = np.linalg.norm(a) * np.linalg.norm(b)
        if other != worst and missed[other] > 0.0 and size > 0.0 and a @ b < FIGHT * size:
            return f"{said}: it fights with {misfit.wishes[other].title}"
    held = [
        f"{name} at {end:g} {PARAMETERS[name.partition('[')[0]].units}"
        for name, at, pull, low, high in zip(
            misfit.space.names, u[0], pulls[worst], misfit.space.low, misfit.space.high
        )
        for end, stops in ((low, at <= 0.0 and pull > 0.0), (high, at >= 1.0 and pull < 0.0))
        if stops
    ]
    return f"{said}: the bounds {', '.join(held)} stop it" if held else said


def result_signs(misfit, result):
    """The sense in which each wish is missed (w,): 1 where the value is too large."""
    signs = np.zeros(len(misfit.wishes))
    signs[: misfit.goals] = np.sign(np.nan_to_num(result["goal_missed"].values[0]))
    return signs


def _range(wish):
    unit = UNITS.get(wish.output) or PARAMETERS[wish.output].units
    if wish.low == wish.high:
        return f"{wish.low:g} {unit}"
    if np.isinf(wish.high):
        return f"at least {wish.low:g} {unit}"
    if np.isinf(wish.low):
        return f"at most {wish.high:g} {unit}"
    return f"{wish.low:g} to {wish.high:g} {unit}"

"""What was found, solved at full accuracy, as a Dataset; and in one sentence."""

from typing import NamedTuple

import numpy as np

from ..atlas.schema import PARAMETERS
from ..atlas.schema import attributes as variable_attributes
from ..description.python_line import python_line
from ..status import STATUSES, VALUED
from .deviation import deviations
from .misfit import Misfit
from .predict import predict
from .wishes import DESIGN
from .words import sentence

ACCURACY = 1e-7
SEEMS = 2.0  # tolerances: who misses no more may do it
FIELDS = (*DESIGN, "pressure", "force", "torque")


class Found(NamedTuple):
    """Candidates: a Dataset along ``candidate``, and the actuator of each."""

    data: object
    tubes: list


def gather(misfit: Misfit, u, choice, near, slopes, tolerances=None, objectives=0) -> Found:
    """The candidates at points u (n, p), ``near`` which that was predicted, in the order given, but without objectives those
    first that do it, and of these those in which no family is slack, or would push; without those in which some state is
    unstable, if others do it. ``tolerances`` of manufacture, if any, spread what they do.
    """
    import xarray as xr

    space, wishes = misfit.space, misfit.wishes
    found = _solved(misfit, u, choice, near)
    asked, last = misfit.goals, len(wishes) - objectives
    residuals, met, kept = _judged(misfit, found)
    done = np.all(met[:, :asked], axis=1) & np.all(kept[:, asked:last], axis=1)
    stands = ~np.any(found.falls, axis=1)
    if np.any(done):
        order = np.arange(len(u)) if objectives else np.lexsort((done & (found.slack > 0), ~done))
        if np.any(done & stands):  # what the smallest disturbance ends is no answer where another one is
            order = order[(stands | ~done)[order]]
        u, choice, slopes, found = u[order], choice[order], slopes[order], found.part(order)
        residuals, met, kept, done, stands = (each[order] for each in (residuals, met, kept, done, stands))
    tubes = [space.actuator(one, k) for one, k in zip(u, choice)]
    columns, worst = space.columns(u, choice), _worst(found.status[:, :last])
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
        "status": (("candidate",), worst),
        "stable": (("candidate",), (stands & (worst == 0)).astype(np.int8), variable_attributes("stable")),
        "slack_fiber": (("candidate",), found.slack, variable_attributes("slack_fiber")),
        "met": (("candidate",), done),
        "misfit": (("candidate",), np.sqrt(np.sum(residuals[:, :last] ** 2, axis=1))),
        "python": (("candidate",), [python_line(tube) for tube in tubes]),
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
    if tolerances:
        spreads = deviations(tubes, wishes[:last], columns, tolerances)
        data["goal_spread"] = (("candidate", "goal"), spreads[:, :asked])
        if last > asked:
            data["limit_spread"] = (("candidate", "limit"), spreads[:, asked:])
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
    for name in ("goal_spread", "limit_spread"):
        if name in result:
            result[name].attrs["long_name"] = "standard deviation under the given tolerances"
    result["status"].attrs = {
        "flag_values": [status.value for status in STATUSES], "flag_meanings": " ".join(s.meaning for s in STATUSES)
    }  # fmt: skip
    result.attrs = {
        "title": f"designs from {space.template!r}",
        "summary": sentence(misfit, result, residuals[0], u, slopes),
        "fibers": "loose" if space.template.is_loose else "bonded",
    }
    return Found(result, tubes)


def _solved(misfit, u, choice, near):
    """What the candidates do. What holds physical tubes is dear to make sure of, as their own way from rest may lead
    elsewhere than the loads beside it: so of those that seem to do it, and of the first.
    """
    space, wishes = misfit.space, misfit.wishes
    if space.is_source or not misfit.is_quick:
        return predict(space, wishes, u, choice, ACCURACY, sure=True)
    found = predict(space, wishes, u, choice, ACCURACY, thorough=misfit.is_dear, near=near)
    missed = [np.nan_to_num(np.abs(misfit.residuals(each.values)), nan=np.inf) for each in (near, found)]
    seem = np.all(np.minimum(*missed) <= SEEMS, axis=1)
    seem[:1] = True
    sure = predict(space, wishes, u[seem], choice[seem], ACCURACY, sure=True)
    for own, other in zip(found, sure):
        own[seem] = other
    return found


def _judged(misfit, found):
    """Residuals of all wishes, which of them are met as goals, and which are kept as limits, (n, wishes) each."""
    low, high = (np.array([getattr(wish, end) for wish in misfit.wishes]) for end in ("low", "high"))
    residuals = misfit.residuals(found.values)
    met = np.abs(residuals) <= 1.0 + found.bounds / misfit.tolerances
    return residuals, met, (found.values >= low - found.bounds) & (found.values <= high + found.bounds)


def _worst(status):
    """The largest status of a candidate's states that says there is no value, else 0."""
    return np.max(np.where(np.isin(status, VALUED), 0, status), axis=1, initial=0)


def _slopes(misfit, slopes):
    """From tolerances along the unit box to units of output per unit of parameter."""
    space = misfit.space
    return slopes * misfit.tolerances[:, None] / np.where(space.high > space.low, space.high - space.low, 1.0)

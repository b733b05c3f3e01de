"""What was found, solved at full accuracy, as a Dataset; and in one sentence."""

from typing import NamedTuple

import numpy as np

from ..atlas.schema import PARAMETERS
from ..atlas.schema import attributes as variable_attributes
from ..description.material_library import name_of
from ..description.python_line import python_line
from ..status import VALUED, status_attributes
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


class _Looked(NamedTuple):
    """Designs at points ``u`` (n, p) with ``choice`` (n,), ``slopes`` of the residuals of their wishes and what is
    ``found``: residuals, whether wishes are met as goals and kept as limits (n, wishes), all of them (n,), and whether all
    states stand the smallest disturbance.
    """

    u: np.ndarray
    choice: np.ndarray
    slopes: np.ndarray
    found: object
    residuals: np.ndarray
    met: np.ndarray
    kept: np.ndarray
    done: np.ndarray
    stands: np.ndarray

    def part(self, order):
        """Some of them, in that order."""
        rest = (each[order] for each in (self.residuals, self.met, self.kept, self.done, self.stands))
        return _Looked(self.u[order], self.choice[order], self.slopes[order], self.found.part(order), *rest)


class _Wishes(NamedTuple):
    """A ``group`` of the wishes, "goal" or "limit", ``own`` among all, each by what says that it is ``fulfilled``."""

    group: str
    own: slice
    fulfilled: str


def gather(misfit: Misfit, u, choice, near, slopes, tolerances=None, objectives=0) -> Found:
    """The candidates at points u (n, p), ``near`` which that was predicted, in the order given, but without objectives those
    first that do it, and of these those in which no family is slack, or would push; without those in which some state is
    unstable, if others do it. ``tolerances`` of manufacture, if any, spread what they do.
    """
    import xarray as xr

    space, asked, last = misfit.space, misfit.goals, len(misfit.wishes) - objectives
    looked = _best_first(_looked(misfit, u, choice, near, slopes, last), objectives)
    tubes = [space.actuator(one, k) for one, k in zip(looked.u, looked.choice)]
    columns = space.columns(looked.u, looked.choice)
    goals, limits = _Wishes("goal", slice(0, asked), "goal_met"), _Wishes("limit", slice(asked, last), "limit_kept")
    groups = [goals, limits] if last > asked else [goals]
    data = _of_designs(space, looked, columns) | _of_wishes(misfit, looked, goals)
    data |= _of_candidates(misfit, looked, tubes, last)
    data |= _of_wishes(misfit, looked, limits) if last > asked else {}
    if objectives:
        data["objective"] = (("candidate", "minimized"), looked.found.values[:, last:])
        data["objective_error"] = (("candidate", "minimized"), looked.found.bounds[:, last:])
    if tolerances:
        spreads = deviations(tubes, misfit.wishes[:last], columns, tolerances)
        about = {"long_name": "standard deviation under the given tolerances"}
        data |= {f"{each.group}_spread": (("candidate", each.group), spreads[:, each.own], about) for each in groups}
    coordinates = {"candidate": np.arange(len(tubes)), "parameter": list(space.names)}
    coordinates |= {each.group: [wish.title for wish in misfit.wishes[each.own]] for each in groups}
    if objectives:
        coordinates["minimized"] = [wish.title for wish in misfit.wishes[last:]]
    result = xr.Dataset(data, coordinates)
    result.attrs = {
        "title": f"designs from {space.template!r}",
        "summary": sentence(misfit, result, looked.residuals[0], looked.u, looked.slopes),
        "fibers": "loose" if space.template.is_loose else "bonded",
    }
    return Found(result, tubes)


def _looked(misfit, u, choice, near, slopes, last):
    """Designs solved and judged by their goals and limits, ``last`` wishes and what is minimized behind them."""
    found = _solved(misfit, u, choice, near)
    residuals, met, kept = _judged(misfit, found)
    done = np.all(met[:, : misfit.goals], axis=1) & np.all(kept[:, misfit.goals : last], axis=1)
    return _Looked(u, choice, slopes, found, residuals, met, kept, done, ~np.any(found.falls, axis=1))


def _best_first(looked, objectives):
    """In the order of :func:`gather`."""
    done, stands = looked.done, looked.stands
    if not np.any(done):
        return looked
    order = np.arange(len(done)) if objectives else np.lexsort((done & (looked.found.slack > 0), ~done))
    if np.any(done & stands):  # what the smallest disturbance ends is no answer where another one is
        order = order[(stands | ~done)[order]]
    return looked.part(order)


def _of_designs(space, looked, columns):
    """Variables that say what the candidates are: numbers that are free or not nothing, profiles by their knots, and what
    was chosen from a list of rubbers.
    """
    data = {
        name: ("candidate", columns[name], {"units": PARAMETERS[name].units})
        for name in FIELDS
        if name in columns and (np.any(columns[name] != 0.0) or name in space.names)
    }
    for name, count in space.knots.items():
        own = [k for k, each in enumerate(space.names) if each.startswith(f"{name}[")]
        data[name] = (("candidate", "knot"), space.values(looked.u)[:, own], {"units": PARAMETERS[name].units})
        data[f"{name}_place"] = ("knot", np.linspace(0.0, 1.0, count), {"units": "1"})
    if "material" in space.choices[0]:
        data["material"] = ("candidate", [name_of(space.choices[k]["material"]) for k in looked.choice.tolist()])
    return data


def _of_wishes(misfit, looked, wishes):
    """Variables of a group of wishes, but those that only goals have."""
    group, own, fulfilled = wishes
    dims, is_goal, known = ("candidate", group), group == "goal", misfit.wishes[own]
    data = {
        f"{group}_value": (dims, looked.found.values[:, own]),
        f"{group}_error": (dims, looked.found.bounds[:, own]),
    }
    if is_goal:
        missed = np.where(np.isfinite(looked.residuals), looked.residuals, np.nan)[:, own]
        data["goal_missed"] = (dims, missed, {"long_name": "tolerances by which a goal is missed"})
    data[fulfilled] = (dims, (looked.met if is_goal else looked.kept)[:, own])
    data[f"{group}_low"] = (group, [wish.low for wish in known])
    data[f"{group}_high"] = (group, [wish.high for wish in known])
    if is_goal:
        about = {"long_name": "change of the goal's output by one unit of what is free"}
        data["goal_tolerance"] = ("goal", misfit.tolerances[own])
        data["slope"] = ((*dims, "parameter"), _slopes(misfit, looked.slopes)[:, own], about)
    return data


def _of_candidates(misfit, looked, tubes, last):
    """Variables that say of each candidate as a whole what becomes of it."""
    worst = _worst(looked.found.status[:, :last])
    falls = {"stable": looked.stands & (worst == 0), "slack_fiber": looked.found.slack}
    return {
        "status": ("candidate", worst, status_attributes()),
        **{name: ("candidate", flag.astype(np.int8), variable_attributes(name)) for name, flag in falls.items()},
        "met": ("candidate", looked.done),
        "misfit": ("candidate", np.sqrt(np.sum(looked.residuals[:, :last] ** 2, axis=1))),
        "python": ("candidate", [python_line(tube) for tube in tubes]),
    }


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

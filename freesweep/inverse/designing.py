"""Inverse design: the tubes that do what is wished for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atlas.store import Atlas
from ..description.actuator import Actuator
from ..description.families import FAMILIES, given_by
from ..description.faults import ActuatorError
from ..description.given import described
from ..description.options import read_count
from ..description.quantities import Names
from ..description.unit_warnings import tolerance_doubts, warn_of
from ..report import SHOWN
from . import freedom, wishes
from .candidates import Found, gather
from .deviation import WORKING, read_tolerances
from .from_atlas import tells
from .in_units import titled
from .least import beaten, front, least, multipliers
from .look import glanced, look, spread, with_dear
from .misfit import make
from .polish import polish
from .space import LOADS
from .unit_doubts import doubts_of
from .wishes import Goal, Limit
from .words import NONE, prices

if TYPE_CHECKING:
    import xarray as xr

STARTS = 3  # for each candidate that is asked for
DIFFERENT = 0.01  # of the unit box's diagonal: nearer ones are the same candidate
MISSED = 1.0  # tolerances


def design(
    template: Actuator,
    free: Mapping[str, Any],
    goals: Goal | Sequence[Goal],
    limits: Limit | Sequence[Limit] = (),
    minimize: Names = None,
    count: int = 10,
    atlas: Atlas | None = None,
    seed: int = 0,
    tolerances: Mapping[str, Any] | None = None,
) -> xr.Dataset:
    """Tubes that do what is wished for, the best ones first.

    Parameters
    ----------
    template : an :class:`Actuator`, whose parameters hold where nothing else is free
    free : name -> what may change: ``(lowest, highest)`` in the units of the API, or texts with units; a list of what can be
        bought (``"radius,wall": [(4.76e-3, 1.59e-3), ...]``, ``"material": ["ecoflex-00-30", ...]``); a tie
        (``"beta": "-alpha"``); a :class:`Profile`. ``pressure``, ``force``, ``torque`` may be free, too
    goals : list of :class:`Goal`; ``limits`` : list of :class:`Limit`
    minimize : an output in a state (a ``Goal`` without value is none: give ``Limit("strain_energy", at_most=..., ...)`` as
        its state), or the name of a parameter; two of them: the candidates are their Pareto front
    count : candidates, at most
    atlas : an :class:`freesweep.Atlas` to ask in the first look, where it holds such tubes: it makes the look of physical
        tubes as wide as that of the source's
    seed : of the first look; the same seed gives the same candidates
    tolerances : standard deviations of manufacture by the names of parameters (``{"alpha": 1.0, "wall": 5e-5}``): adds
        ``goal_spread`` and ``limit_spread``, the standard deviation of what each candidate does

    Returns a Dataset along ``candidate``: parameters by name, ``goal_value``, ``goal_error`` (bound), ``goal_met``,
    ``limit_value``, ``limit_kept``, ``misfit`` (root of the sum of squares, in tolerances), ``slope`` (change of each
    goal's output by what is free), ``status``, ``stable``, ``met``, ``python`` (the line that makes it);
    ``attrs["summary"]`` says in a sentence whether it can be done and, if not, what stands against it. Their order: those
    that meet everything first, of these those without a family that is slack or would push (``slack_fiber``); the others by
    ``misfit``. With one thing to minimize: the least first; with two: along their front. A candidate in which some state is
    unstable is given only where no other does it. Raises :class:`ActuatorError` for invalid input, and warns of numbers that
    look like slips of units.
    """
    return find(template, free, goals, limits, minimize, count, atlas, seed, tolerances).data


def find(
    template, free, goals, limits=(), minimize=None, count=10, atlas=None, seed=0, tolerances=None, shown=SHOWN
) -> Found:  # fmt: skip
    """The same, with the actuators of the candidates; what is said is in units as they are ``shown``."""
    faults = []
    space = freedom.read(template, free, faults)
    asked = wishes.read("goals", goals, Goal, faults)
    kept = wishes.read("limits", () if limits is None else limits, Limit, faults)
    if isinstance(goals, (list, tuple)) and not goals and minimize is None:
        faults.append("goals: none; give what the tube shall do, or something to minimize")
    objectives = _objectives(minimize, faults)
    count = read_count("count", count, faults)
    if atlas is not None and not isinstance(atlas, Atlas):
        faults.append(f"atlas: found {described(atlas)}; give what freesweep.open_atlas opens, or None")
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
        faults.append(f"seed: found {described(seed)}; give a whole number, 0 or more")
    allowed = read_tolerances(tolerances, template, faults) if space is not None else {}
    known = [*asked, *kept, *objectives]
    faults += [] if space is None else _without_a_state(template, free, known)
    if faults:
        raise ActuatorError(faults)
    doubts = [*doubts_of(space, [*asked, *kept]), *_idle(free, known)]
    doubts += tolerance_doubts(template.design(), allowed)
    misfit = make(space, asked, kept)._replace(shown=shown)
    if atlas is not None and not tells(atlas, glanced(misfit)):
        doubts.append("the atlas holds none of these tubes, or tells nothing that is wished for: it was not asked")
        atlas = None
    warn_of(doubts, stacklevel=3)
    first = misfit._replace(left_out=[])  # what a disturbance ends is no answer, unless there is no other
    made = _searched(first, objectives, count, seed, atlas, allowed)
    is_done = made is not None and np.any(made.data["met"].values)
    hopeless = made is not None and any(wish.kind == "every" for wish in misfit.wishes)  # it has to be stable
    if first.left_out and not is_done and not hopeless:
        other = _searched(misfit, objectives, count, seed, atlas, allowed)
        if other is not None and (made is None or np.any(other.data["met"].values)):
            made = other
    if made is None:
        if fault := space.no_tube():
            raise ActuatorError([f"free: no design that it allows is a tube: {fault}"])
        titles = ", ".join(titled(wish.title, shown) for wish in misfit.wishes)
        raise ActuatorError([f"goals, limits: {NONE} has all the states in which they count: {titles}"])
    if notes := [note for one in (*_several(goals), *_several(limits)) for note in one.notes()]:
        made.data.attrs["notes"] = "\n".join(notes)
    return made


def _several(given):
    return given if isinstance(given, (list, tuple)) else () if given is None else (given,)


def _searched(misfit, objectives, count, seed, atlas, allowed):
    """Candidates, None where no design has all the states in which goals and limits count."""
    u, choice = look(misfit, STARTS * count, seed, atlas, bool(objectives))
    # not all that lists name goes together
    real = [misfit.space.actuator_or_none(one, k) is not None for one, k in zip(u, choice)]
    u, choice = u[real], choice[real]
    if len(u) == 0:
        return None
    misfit = with_dear(misfit, u, choice)
    u, found, residuals, slopes = polish(misfit, u, choice)
    if objectives:
        return _with_least(misfit, objectives, u, choice, residuals, count, allowed)
    cost = np.nan_to_num(np.sum(residuals**2, axis=1), nan=np.inf)
    best = spread(misfit.space, u, choice, _order(cost), count, DIFFERENT)
    return gather(misfit, u[best], choice[best], found.part(best), slopes[best], allowed)


def _order(cost):
    """Designs that meet everything keep the order of the look; the others follow by what they miss."""
    return np.argsort(np.where(cost <= MISSED, 0.0, cost), kind="stable")


def _needs_pressure(wish):
    return wish.kind not in ("design", "limit", "every") and "pressure" not in dict(wish.conditions)


def _without_a_state(template, free, known):
    """Faults of the wishes ``known`` that count in no state of such tubes."""
    absent = set(FAMILIES) - set(given_by(template))
    found = [f"{w.output}: is wished for, a family that the template has not" for w in known if w.output in absent]
    if "pressure" not in free:
        titles = [wish.title for wish in known if _needs_pressure(wish)]
        found += [f"{title}: give its pressure, or let 'pressure' be free" for title in titles]
        if any(wish.output == "pressure" for wish in known):
            found.append(
                "pressure: is wished for, but each state has its own; let 'pressure' be free, or leave that out"
            )
    return found


def _idle(free, known):
    """Sentences on loads that are free, and in no state of the wishes ``known``, as each gives its own."""
    for name in (name for key in free for name in map(str.strip, key.split(",")) if name in LOADS):
        works = (name in WORKING[wish.kind] and name not in dict(wish.conditions) for wish in known)
        if not any(works) and not any(wish.output == name for wish in known if wish.kind == "design"):
            yield f"free[{name!r}] changes nothing: each goal and limit has its own {name}, or is none of a state under it"


def _objectives(minimize, faults):
    """What is to be least, as wishes without a range."""
    given = list(minimize) if isinstance(minimize, (list, tuple)) else [] if minimize is None else [minimize]
    found = []
    for k, one in enumerate(given):
        if isinstance(one, (Goal, Limit)):
            found += [wish._replace(low=-np.inf, high=np.inf) for wish in one.wishes(faults, f"minimize[{k}]")]
        elif isinstance(one, str) and one in (*wishes.DESIGN, "pressure"):
            found.append(wishes.Wish(one, (), -np.inf, np.inf, np.nan, one))
        else:
            can = ", ".join((*wishes.DESIGN, "pressure"))
            faults.append(
                f"minimize: found {described(one)}; give one of {can}, or an output in a state as a Limit of any range"
            )
    if len(found) > 2:
        faults.append(f"minimize: found {len(found)} numbers; one, or two for a front between them")
    elif len({wish.title for wish in found}) < len(found):
        faults.append(f"minimize: found {found[0].title} twice; give it once, or two of which each has its price")
    return found


def _first(values, choice, count):
    """Rows from which the least is looked for: the first ones, and those that have the least ``values`` (n, objectives) so
    far, of all and of each choice.
    """
    order = np.argsort(values[:, 0], kind="stable")
    firsts = order[np.sort(np.unique(choice[order], return_index=True)[1])]
    return np.unique(np.concatenate([np.arange(min(count, len(order))), order[:STARTS], firsts[: count + STARTS]]))


def _with_least(misfit, objectives, u, choice, residuals, count, tolerances):
    """Candidates among those that do it with the least of the objectives."""
    number = len(objectives)
    good = np.all(np.abs(np.nan_to_num(residuals, nan=np.inf)) <= MISSED, axis=1)
    if not np.any(good):
        best = _order(np.nan_to_num(np.sum(residuals**2, axis=1), nan=np.inf))[:count]
        _, found, _, slopes = polish(misfit, u[best], choice[best])
        return gather(misfit, u[best], choice[best], found, slopes, tolerances)
    u, choice = u[good], choice[good]
    whole = misfit._replace(
        wishes=[*misfit.wishes, *objectives], tolerances=np.append(misfit.tolerances, [1.0] * number)
    )
    values = whole.at(u, choice)[0].values[:, -number:]
    rows = _first(values, choice, count)
    u, choice, values = u[rows], choice[rows], values[rows]
    scale = np.maximum(np.max(np.abs(values), axis=0, initial=0.0, where=np.isfinite(values)), 1e-300)
    if number == 2:
        u, choice = front(whole, u, choice, count, scale)
    else:
        u = least(whole, u, choice, number, scale)
    found, residuals = whole.at(u, choice)
    slopes = whole.slopes(u, choice, found)
    missed = np.any(np.abs(residuals[:, :-number]) > MISSED, axis=1)
    order = np.lexsort((found.values[:, -number], missed))
    if number == 2:
        behind = beaten(np.where(missed[:, None], np.inf, found.values[:, -2:]), scale)
        order = order[~behind[order]]
    best = spread(misfit.space, u, choice, order, count, DIFFERENT)
    made = gather(whole, u[best], choice[best], found.part(best), slopes[best], tolerances, number)
    result = made.data
    if number == 1:
        costs = [multipliers(whole, u[i], slopes[i], found.values[i], number) for i in best]
        span = misfit.space.high - misfit.space.low
        asked = misfit.goals
        result["goal_price"] = (("candidate", "goal"), np.array([price[0][:asked] for price in costs]))
        if len(misfit.wishes) > asked:
            result["limit_price"] = (("candidate", "limit"), np.array([price[0][asked:] for price in costs]))
        result["bound_price"] = (("candidate", "parameter"), np.array([price[1] / span for price in costs]))
        for name in ("goal_price", "limit_price", "bound_price"):
            if name in result:
                result[name].attrs["long_name"] = "change of what is minimized by one unit of what holds it"
        result.attrs["prices"] = prices(result, whole.wishes, misfit.space.names, misfit.shown)
    return made

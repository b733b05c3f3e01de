"""A wide look at all designs that are allowed, and starts in each basin."""

import numpy as np

from .from_atlas import ask, told
from .misfit import LOOKING, Misfit
from .wishes import HELD

ALIKE, ONE_BY_ONE = 4096, 128  # designs of a first look: in vectors, or each by itself; the choices share them
DEAR, DEAR_STARTS = 16, 3  # the same, and starts, where vectors tell no state of any
LEAST = 32  # of each choice
MOST_EACH = 48  # choices of which each has a start
DEARNESS = {"force": 1, "torque": 2}  # of what is looked at later
FEWER, ENOUGH = 4, 256  # of so many times fewer designs, but not of less
APART = 0.12  # of the unit box's diagonal: starts nearer than that lie in one basin
BOUNDED = 1e4  # tolerances beyond which a wish is simply missed: rough looks compare designs that are close


def look(misfit: Misfit, count, seed, atlas=None, each=False):
    """Starts for :func:`polish`: points (s, p) and their choices (s,), the best ones first, each in a basin of its own. With
    an ``atlas`` it is that which is asked, as far as it can tell. ``each``: of each choice one, too.
    """
    from scipy.stats import qmc

    space, misfit = misfit.space, glanced(misfit)
    free, choices = len(space.names), len(space.choices)
    if free == 0:
        return np.zeros((choices, 0)), np.arange(choices)
    known = [] if atlas is None else told(atlas, misfit)
    most = ALIKE if misfit.is_quick or any(known) else ONE_BY_ONE
    if misfit.is_quick and not space.is_source:  # what holds one is sought by many states
        most //= 1 + sum(wish.kind in HELD for wish in misfit.wishes)
    shown = np.random.default_rng(seed).permutation(choices)[: most // LEAST]
    total = int(np.ceil(np.log2(max(most, LEAST * len(shown)))))
    draws = qmc.Sobol(free, seed=np.random.default_rng(seed)).random_base2(total)
    choice = shown[np.arange(len(draws)) % len(shown)]
    if any(known):
        values = ask(atlas, misfit.wishes, space.columns(draws, choice), known)
        residuals = np.where(known, misfit.residuals(values), 0.0)
    else:
        residuals = by_and_by(misfit, draws, choice)
        none = not np.any(np.all(np.isfinite(residuals), axis=1))
        if none and not misfit.left_out:  # else there are states, but none that stand
            if not space.is_source:  # each by itself, for seconds
                few, count = max(DEAR, len(shown)), min(count, DEAR_STARTS)
                draws, choice = draws[:few], choice[:few]
            residuals = one_by_one(misfit, draws, choice, count)
    order = best(residuals)
    picked = spread(space, draws, choice, order, count, APART)
    if each:
        firsts = order[np.sort(np.unique(choice[order], return_index=True)[1])][:MOST_EACH]
        picked = np.concatenate([picked, np.setdiff1d(firsts, picked)])
    return draws[picked], choice[picked]


def best(residuals):
    """Rows of ``residuals`` (n, wishes) that have all of them, the least missed first, each by what half of all miss."""
    goals = np.abs(residuals)
    middles = np.array([np.median(some[np.isfinite(some)]) if np.any(np.isfinite(some)) else 0.0 for some in goals.T])
    scale = np.where(middles > 0.0, middles, 1.0)
    cost = np.sum(np.minimum(goals / scale, BOUNDED) ** 2, axis=1)
    known = np.flatnonzero(np.isfinite(cost))
    return known[np.argsort(cost[known], kind="stable")]


def by_and_by(misfit: Misfit, u, choice):
    """Residuals (n, wishes) of a rough look. What is dear, as what holds physical tubes, is looked at where they do best in
    what is not; NaN elsewhere.
    """
    dear = np.array([0 if misfit.space.is_source else DEARNESS.get(wish.output, 0) for wish in misfit.wishes])
    residuals, rows = np.full((len(u), len(dear)), np.nan), np.arange(len(u))
    for now in np.unique(dear):
        asked = np.flatnonzero(dear == now)
        residuals[np.ix_(rows, asked)] = part(misfit, asked).at(u[rows], choice[rows], LOOKING, False)[1]
        told = best(residuals[rows][:, dear <= now])
        rows = rows[told[: max(len(rows) // FEWER, ENOUGH)]]
    return residuals


def one_by_one(misfit: Misfit, u, choice, count):
    """Residuals (n, wishes), as vectors tell none of them: of dear ones a few at a time, until ``count`` are known."""
    residuals = np.full((len(u), len(misfit.wishes)), np.nan)
    for rows in np.array_split(np.arange(len(u)), 1 if misfit.space.is_source else max(len(u) // count, 1)):
        residuals[rows] = misfit.at(u[rows], choice[rows], LOOKING)[1]
        if np.count_nonzero(np.all(np.isfinite(residuals), axis=1)) >= count:
            break
    return residuals


def with_dear(misfit: Misfit, u, choice) -> Misfit:
    """The misfit that says whether vectors tell no state of any of these starts."""
    if misfit.space.is_source or not misfit.is_quick:
        return misfit
    _, residuals = misfit.at(u, choice, thorough=False)
    return misfit._replace(is_dear=not np.any(np.all(np.isfinite(residuals), axis=1)))


def glanced(misfit: Misfit) -> Misfit:
    """The misfit of which a curve is seen by its ends and its middle only."""
    curves = {}
    for k, wish in enumerate(misfit.wishes):
        names = tuple(name for name, _ in wish.conditions)
        curves.setdefault((k < misfit.goals, wish.output, names), []).append(k)
    kept = sorted({k for own in curves.values() for k in (own[0], own[len(own) // 2], own[-1])})
    return part(misfit, kept)


def part(misfit: Misfit, kept) -> Misfit:
    """The misfit of some of its wishes."""
    return misfit._replace(
        wishes=[misfit.wishes[k] for k in kept],
        goals=sum(k < misfit.goals for k in kept),
        tolerances=misfit.tolerances[kept],
    )


def spread(space, u, choice, order, count, apart):
    """The first of ``order`` that are ``apart`` from each other, up to ``count``; symmetric copies are the same design."""
    picked, mirrored = [], space.mirrored(u)
    reach = apart * np.sqrt(max(u.shape[1], 1))  # where nothing is open, a choice is one design
    for i in order:
        others = [j for j in picked if choice[j] == choice[i]]
        near = [u[others] - u[i], mirrored[others] - u[i]] if others else []
        if all(np.all(~(np.linalg.norm(way, axis=1) < reach)) for way in near):
            picked.append(int(i))
        if len(picked) == count:
            break
    return np.array(picked, int)

"""From starts into their basins: Levenberg and Marquardt's method between bounds, all designs at once."""

import numpy as np

from ..query.exact import MESHES
from .misfit import Misfit
from .predict import Predicted

ROUNDS = {False: 120, True: 40}  # in all; where states are dear
LATER = 12  # after a design met everything, where they are, or vectors do not tell them
DAMPING, LESS, MORE, MOST = 1e-3, 0.2, 5.0, 1e9  # of the diagonal; after a step that helps, and one that does not
DONE = 1e-3  # tolerances: closer is close enough
STILL = 1e-9  # of the cost: no more is won
LARGEST = 0.2  # of the unit box, in one step
SHORTER, LONGER = 0.5, 2.0  # the largest step, after one that did not help, of that; and after one that did


def polish(misfit: Misfit, u, choice):
    """Points (s, p) at the bottom of the basins of ``u``; with ``(what is predicted, residuals, slopes)`` there. States that
    vectors cannot tell are dear: designs on their way there stop as soon as one meets everything.
    """
    u, count, free = u.copy(), len(u), u.shape[1]
    dear_ones, on_meshes = not misfit.space.is_source, np.zeros(len(u), bool)
    if dear_ones:
        found, residuals = misfit.at(u, choice, thorough=not misfit.is_quick)
    else:
        found, residuals = _told(misfit, u, choice, on_meshes)
    slopes = misfit.slopes(u, choice, found, on_meshes)
    cost, damping, reach = _cost(residuals), np.full(count, DAMPING), np.full(count, LARGEST)
    active = np.isfinite(cost) & (free > 0)
    spent = 0  # rounds since a design met everything
    for _ in range(ROUNDS[dear_ones]):
        active &= (np.sqrt(cost) > DONE) & (damping < MOST)
        if np.any(cost <= DONE**2):
            active &= (spent < LATER) | ~(dear_ones | on_meshes)
            spent += 1
        rows = np.flatnonzero(active)
        if len(rows) == 0:
            break
        ahead = np.array([_ahead(u[i], residuals[i], slopes[i], damping[i], reach[i]) for i in rows])
        if dear_ones:
            near = misfit.ahead(found.part(rows), slopes[rows], ahead - u[rows])
            trial, missed = misfit.at(ahead, choice[rows], thorough=False, near=near)
        else:
            own = on_meshes[rows]
            trial, missed = _told(misfit, ahead, choice[rows], own)
            on_meshes[rows] = own
        new = _cost(missed)
        better = new < cost[rows]
        damping[rows] *= np.where(better, LESS, MORE)
        step = np.max(np.abs(ahead - u[rows]), axis=1)
        reach[rows] = np.where(better, np.minimum(LONGER * reach[rows], LARGEST), SHORTER * step)
        won = rows[better]
        active[won] = new[better] < cost[won] * (1.0 - STILL)
        u[won], residuals[won], cost[won] = ahead[better], missed[better], new[better]
        for own, other in zip(found, trial):
            own[won] = other[better]
        if len(won):
            slopes[won] = misfit.slopes(u[won], choice[won], trial.part(better), on_meshes[won])
    return u, found, residuals, slopes


def _told(misfit, u, choice, on_meshes):
    """``(what is predicted, residuals)`` at points of the source's tubes, by vectors; ``on_meshes`` (n,) where vectors left
    a design without a state, which is marked: meshes take a thousandth of a second, vectors search a tenth of one in vain.
    """
    quick = np.flatnonzero(~on_meshes)
    parts = [misfit.at(u[quick], choice[quick], thorough=False)] if len(quick) else []
    if len(quick):
        found, missed = parts[0]
        on_meshes[quick] = ~np.isfinite(_cost(missed)) & ~np.any(found.falls, axis=1)
        told = ~on_meshes[quick]
        parts, quick = [(found.part(told), missed[told])], quick[told]
    dear = np.flatnonzero(on_meshes)
    if len(dear):
        parts.append(misfit.at(u[dear], choice[dear], thorough=MESHES))
    order = np.argsort(np.concatenate([quick, dear]))
    found = Predicted(*(np.concatenate(arrays)[order] for arrays in zip(*(part for part, _ in parts))))
    return found, np.concatenate([missed for _, missed in parts])[order]


def _cost(residuals):
    return np.where(np.all(np.isfinite(residuals), axis=1), np.sum(residuals**2, axis=1), np.inf)


def _ahead(u, residuals, slopes, damping, reach):
    """A step of the damped normal equations, along what is not held by a bound, at most of a length ``reach``."""
    slopes = np.nan_to_num(slopes) * (residuals != 0.0)[:, None]  # a range that is kept asks for nothing
    gradient = slopes.T @ residuals
    free = ~(((u <= 0.0) & (gradient > 0.0)) | ((u >= 1.0) & (gradient < 0.0)))
    step = np.zeros_like(u)
    if np.any(free):
        matrix = slopes[:, free].T @ slopes[:, free]
        size = np.trace(matrix)
        damped = matrix + np.diag(damping * (np.diag(matrix) + 1e-9 * size) + 1e-300)
        step[free] = -np.linalg.lstsq(damped, gradient[free], rcond=None)[0]
    return np.clip(u + step * min(1.0, reach / max(np.max(np.abs(step)), 1e-300)), 0.0, 1.0)

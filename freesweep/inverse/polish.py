"""From starts into their basins: Levenberg and Marquardt's method between bounds, all designs at once."""

import numpy as np

from .misfit import Misfit

ROUNDS = {False: 120, True: 40}  # in all; where states are dear
LATER = 12  # after a design met everything, where they are
DAMPING, LESS, MORE, MOST = 1e-3, 0.2, 5.0, 1e9  # of the diagonal; after a step that helps, and one that does not
DONE = 1e-3  # tolerances: closer is close enough
STILL = 1e-9  # of the cost: no more is won
LARGEST = 0.2  # of the unit box, in one step
PATIENCE = 3  # steps of a design, one after the other, to dear states that did not help: then no more of these
SHORTER, LONGER = 0.5, 2.0  # the largest step, after one that did not help, of that; and after one that did


def polish(misfit: Misfit, u, choice):
    """Points (s, p) at the bottom of the basins of ``u``; with ``(what is predicted, residuals, slopes)`` there. States that
    vectors cannot tell are dear: they end a step as soon as one design meets everything.
    """
    u, count, free = u.copy(), len(u), u.shape[1]
    dear_ones = not misfit.space.is_source
    found, residuals = misfit.at(u, choice, thorough=not dear_ones or not misfit.is_quick)
    slopes = misfit.slopes(u, choice, found)
    cost, damping, reach = _cost(residuals), np.full(count, DAMPING), np.full(count, LARGEST)
    active = np.isfinite(cost) & (free > 0)
    in_vain = np.zeros(count, int)  # dear steps
    spent = 0  # rounds since a design met everything
    for _ in range(ROUNDS[dear_ones]):
        active &= (np.sqrt(cost) > DONE) & (damping < MOST)
        if dear_ones and np.any(cost <= DONE**2):
            active &= spent < LATER
            spent += 1
        rows = np.flatnonzero(active)
        if len(rows) == 0:
            break
        ahead = np.array([_ahead(u[i], residuals[i], slopes[i], damping[i], reach[i]) for i in rows])
        near = misfit.ahead(found.part(rows), slopes[rows], ahead - u[rows])
        trial, missed = misfit.at(ahead, choice[rows], thorough=False, near=near)
        new = _cost(missed)
        dear = np.flatnonzero(~np.isfinite(new) & ~np.any(trial.falls, axis=1) & (in_vain[rows] < PATIENCE))
        if misfit.space.is_source and len(dear) and np.all(cost > DONE**2):
            again, missed[dear] = misfit.at(ahead[dear], choice[rows[dear]])
            for own, other in zip(trial, again):
                own[dear] = other
            new[dear] = _cost(missed[dear])
        better = new < cost[rows]
        in_vain[rows[dear]] += 1
        in_vain[rows[better]] = 0
        damping[rows] *= np.where(better, LESS, MORE)
        step = np.max(np.abs(ahead - u[rows]), axis=1)
        reach[rows] = np.where(better, np.minimum(LONGER * reach[rows], LARGEST), SHORTER * step)
        won = rows[better]
        active[won] = new[better] < cost[won] * (1.0 - STILL)
        u[won], residuals[won], cost[won] = ahead[better], missed[better], new[better]
        for own, other in zip(found, trial):
            own[won] = other[better]
        if len(won):
            slopes[won] = misfit.slopes(u[won], choice[won], trial.part(better))
    return u, found, residuals, slopes


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

"""Intervals from the profile likelihood: a parameter is moved, the others fitted anew, until chi square has risen by t^2."""

import numpy as np

ROUNDS = 6  # of finding the end of an interval
CHORDS = 2  # of fitting the others anew, with the derivative at the best fit
ALIKE = 0.1  # relative difference of an end from the linearised one that is none
FARTHEST = 6.0  # times the linearised half width


def profile_intervals(problem, theta, sigma, rows, covariance, widening, quantile):
    """Intervals (p, 2) of theta, made wider by ``widening`` (p,); those of the linearised covariance where it tells the
    same, or where data are blind.
    """
    errors = np.sqrt(np.diag(covariance))
    half = quantile * errors * widening
    found = np.column_stack([theta - half, theta + half])
    ends = [(k, sign) for k in range(len(theta)) for sign in (-1.0, 1.0) if np.isfinite(errors[k]) and errors[k] > 0.0]
    if not ends:
        return found
    prior = problem.parameters
    model, there = problem.model(theta)
    slopes = problem.sloped(problem.derivative(theta, model), model, there) / sigma[:, None]
    jacobian = np.vstack([slopes[rows], np.diag(1.0 / prior.sigma)])

    def chi(points):
        """Residuals of each point, weighed."""
        filled, there = problem.models(points)
        return [
            np.append((problem.residuals(m, t) / sigma)[rows], (point - prior.mean) / prior.sigma)
            for m, t, point in zip(filled, there, points)
        ]

    (base,) = chi([theta])
    least = base @ base
    direction = [covariance[:, k] / covariance[k, k] for k, _ in ends]  # the others follow
    quantile = np.array([quantile[k] for k, _ in ends])
    scale = quantile.copy()  # in standard errors
    wanted = quantile**2
    done = np.zeros(len(ends), bool)
    for _ in range(ROUNDS):
        points = []
        for (k, sign), way, size in zip(ends, direction, scale):
            point = np.clip(theta + sign * size * errors[k] * way, problem.low, problem.high)
            points.append(point)
        for _ in range(CHORDS):
            weighed = chi(points)
            points = [_anew(p, k, w, jacobian, problem) for p, (k, _), w in zip(points, ends, weighed)]
        rise = np.array([min(w @ w, v @ v) - least for w, v in zip(weighed, chi(points))])
        with np.errstate(all="ignore"):
            ratio = np.sqrt(wanted / np.maximum(rise, 1e-12))
        ratio = np.where(np.isfinite(rise), np.clip(ratio, 0.4, 2.5), 0.4)
        done |= np.abs(ratio - 1.0) < 0.3 * ALIKE
        if np.all(np.abs(ratio - 1.0) < ALIKE):
            scale = np.where(done, scale, scale * ratio)
            break
        scale = np.where(done, scale, np.minimum(scale * ratio, FARTHEST * quantile))
    for (k, sign), size, usual in zip(ends, scale, quantile):
        if abs(size / usual - 1.0) > ALIKE:
            end = theta[k] + sign * size * errors[k] * widening[k]
            found[k, int(sign > 0.0)] = end
    return np.clip(found, problem.low[:, None], problem.high[:, None])


def _anew(point, k, weighed, jacobian, problem):
    """The point with all but parameter k moved to where the linearised residuals are least."""
    others = np.arange(len(point)) != k
    if not others.any():
        return point
    step = np.linalg.lstsq(jacobian[:, others], -np.nan_to_num(weighed), rcond=1e-10)[0]
    moved = point.copy()
    moved[others] += step
    return np.clip(moved, problem.low, problem.high)

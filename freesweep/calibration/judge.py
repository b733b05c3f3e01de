"""Whether residuals look like noise, and how much less the data tell where they do not.

Noise scatters from one state of a curve to the next; what a model lacks bends along the curve. Within each curve a low
polynomial takes what bends; what is left is noise, or what replicates and loops say of it. The test is Fisher's: bends
over noise. A second one counts runs of one sign. How parameters change when a curve k is left out needs no new fits: to
first order it is then missed by ``(1 - H_kk)^-1 r_k``, H the hat matrix. By how much it is missed does: a fit may move far.
"""

from typing import NamedTuple

import numpy as np

from .branches import curves_of

LEVEL = 0.01  # chance of calling a fitting model wrong, of each of two tests
DEGREE = 2  # of polynomials along a curve
FEW = 4  # noise degrees of freedom below which Fisher's test is not made
LEAST_FREEDOM = 3  # of intervals that were widened
MUCH = 0.05  # of the largest number: by how much a bench may scatter where nothing tells its noise
NO_NOISE = 1e-5  # of the largest number: residuals below it are the solver's


class Judged(NamedTuple):
    """What the residuals say: factors of standard errors (p,), degrees of freedom, misfit of unseen curves by quantity."""

    fits: bool
    widening: np.ndarray
    freedom: float
    leave_one_out: dict
    notes: tuple


def judge(problem, theta, home, residuals, derivative, sigma, rows, active, unknown, chi_square, freedom) -> Judged:
    """Judge a fit of the ``rows`` that count by its residuals and their derivative (values, p)."""
    curve, along = _curves(problem)
    weighed, slopes = residuals / sigma, derivative / sigma[:, None]
    known = np.diag(1.0 / problem.parameters.sigma)
    left = _left_out(weighed, slopes, known, curve, active)
    missed, unseen = {}, _unseen(problem, theta, home, sigma, rows, curve, active)
    for name in dict.fromkeys(problem.quantity.tolist()):
        own = active & (problem.quantity == name)
        some = unseen[own & np.isfinite(unseen)]
        missed[name] = float(np.sqrt(np.mean(some**2))) if len(some) else np.nan
    reasons = _reasons(problem, residuals, sigma, curve, along, active, unknown, chi_square, freedom, len(theta))
    largest = max((np.max(np.abs(problem.measured[problem.quantity == n]), initial=0.0) for n in missed), default=1.0)
    if not reasons or np.max(np.abs(residuals[active]), initial=0.0) <= NO_NOISE * largest:
        return Judged(True, np.ones(len(theta)), freedom, missed, ())
    correlation = _correlation(weighed, curve, along, active)
    together = (1.0 + correlation) / (1.0 - correlation)  # states that bend together count as fewer
    factor = together * max(chi_square, 1.0)
    plain = np.sqrt(np.maximum(np.diag(left.covariance), 1e-300))
    widening = np.maximum(np.sqrt(factor), left.jackknife / plain)
    own = max(min(freedom, int(active.sum()) / together - len(theta)), LEAST_FREEDOM)
    sentence = (
        f"the model does not fit: {'; '.join(reasons)}. Something else is at work (another model of the tube, a parameter"
        f" that is not fitted, the bench); intervals are widened for it, {np.max(widening):.3g} times at most"
    )
    return Judged(False, widening, own, missed, (sentence,))


def _unseen(problem, theta, home, sigma, rows, curve, active):
    """Residuals (values,) of each curve by a fit to all others; NaN where these do not tell the parameters."""
    found, known = np.full(len(curve), np.nan), int(np.isfinite(problem.parameters.sigma).sum())
    for k in np.unique(curve[active]):
        others = rows & (curve != k)
        if not others.any() or others.sum() + known < len(theta):
            continue
        other = problem.solve(theta, home, sigma, others)
        own = curve == k
        found[own] = problem.residuals(*problem.model(other))[own]
    problem.model(theta)
    problem.predictor.refresh(problem.parameters.setups(theta))
    return found


def _curves(problem):
    """Number of the curve of each value (values,), over all measurements and quantities, and the place along it."""
    curve, along, count = [], [], 0
    for measurement in problem.measurements:
        own, swept = curves_of(measurement)
        at = measurement.pressure if swept == "pressure" else measurement.imposed(swept)
        each = len(measurement.measured)
        numbers = own[:, None] * each + np.arange(each)
        curve.append((count + numbers).ravel())
        along.append(np.repeat(at, each))
        count += (own.max() + 1) * each
    return np.concatenate(curve), np.concatenate(along)


class _Left(NamedTuple):
    covariance: np.ndarray
    jackknife: np.ndarray  # standard errors (p,) by leaving out curves


def _left_out(weighed, slopes, known, curve, active):
    """How the parameters change where a curve is left out, to first order."""
    normal = slopes[active].T @ slopes[active] + known**2
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
    covariance = np.linalg.pinv(normal / np.outer(scale, scale), hermitian=True, rcond=1e-12) / np.outer(scale, scale)
    changes = []
    for k in np.unique(curve[active]):
        own = np.flatnonzero(active & (curve == k))
        hat = slopes[own] @ covariance @ slopes[own].T
        left = np.linalg.lstsq(np.eye(len(own)) - hat, weighed[own], rcond=1e-9)[0]
        changes.append(covariance @ slopes[own].T @ left)
    count = len(changes)
    changes = np.array(changes) if count else np.zeros((1, slopes.shape[1]))
    jackknife = np.sqrt((count - 1.0) / max(count, 1) * np.sum((changes - changes.mean(axis=0)) ** 2, axis=0))
    return _Left(covariance, jackknife)


def _reasons(problem, residuals, sigma, curve, along, active, unknown, chi_square, freedom, parameters):
    """Why the residuals are no noise, in words."""
    from scipy.stats import chi2, f, norm

    reasons = []
    for name in dict.fromkeys(problem.quantity.tolist()):
        own = active & (problem.quantity == name)
        share = parameters * own.sum() / max(active.sum(), 1)
        ratio, chance = _bent(residuals, curve, along, own, share)
        other_noise = _other_noise(problem, name)
        if chance < LEVEL:
            reasons.append(
                f"along its curves the residuals of {name} bend {np.sqrt(ratio):.2g} times as much as they scatter"
            )
            continue
        for what, (variance, count) in other_noise.items():
            spread = np.sum(residuals[own] ** 2) / max(own.sum() - share, 1.0)
            if count >= FEW and variance > 0.0 and f.sf(spread / variance, own.sum() - share, count) < LEVEL:
                reasons.append(f"{name} is missed by {np.sqrt(spread / variance):.2g} times the noise that {what} show")
                break
        told = np.isfinite(chance) or any(count >= FEW for _, count in other_noise.values())
        missed = np.sqrt(np.mean(residuals[own] ** 2)) / np.max(np.abs(problem.measured[own])) if own.any() else 0.0
        if name in unknown and not told and missed > MUCH:
            reasons.append(f"{name} is missed by {missed:.0%} of its largest, and too few values tell of any noise")
        z = _runs(residuals, curve, along, own)
        if norm.sf(z) < LEVEL:
            reasons.append(f"the residuals of {name} keep their sign along the curves, in too few runs")
    ratio, chance = _bent(residuals / sigma, curve, along, active, parameters)
    if not reasons and chance < LEVEL:
        reasons.append(f"along all curves together residuals bend {np.sqrt(ratio):.2g} times as much as they scatter")
    if not unknown and chi2.sf(chi_square * freedom, freedom) < LEVEL:
        reasons.append(f"the data are missed by {np.sqrt(chi_square):.3g} times the uncertainties given")
    return reasons


def _bent(residuals, curve, along, own, parameters):
    """How much more residuals bend than scatter, as a ratio of variances, and the chance of that in mere noise; infinite
    where too few values tell.
    """
    from scipy.stats import f

    bends, bend_freedom, noise, noise_freedom = _bends(residuals, curve, along, own)
    bend_freedom -= parameters
    if bend_freedom < 1.0 or noise_freedom < FEW or noise <= 0.0:
        return 1.0, np.inf
    ratio = bends / bend_freedom / (noise / noise_freedom)
    return ratio, f.sf(ratio, bend_freedom, noise_freedom)


def _bends(residuals, curve, along, own):
    """Sum of squares that low polynomials along the curves take, and what they leave, with degrees of freedom."""
    bends = noise = 0.0
    taken = left = 0
    for k in np.unique(curve[own]):
        rows = np.flatnonzero(own & (curve == k))
        x, y = along[rows], residuals[rows]
        degree = min(DEGREE, len(np.unique(x)) - 2, len(rows) // 2 - 1)
        if degree < 0:
            continue
        basis = np.polynomial.legendre.legvander((2.0 * x - x.min() - x.max()) / max(np.ptp(x), 1e-300), degree)
        smooth = basis @ np.linalg.lstsq(basis, y, rcond=None)[0]
        bends, noise = bends + np.sum(smooth**2), noise + np.sum((y - smooth) ** 2)
        taken, left = taken + degree + 1, left + len(rows) - degree - 1
    return bends, taken, noise, left


def _other_noise(problem, name):
    """Variance of the noise and degrees of freedom, as replicates and the two branches of loops show it."""
    squares = count = bends = turns = 0.0
    for measurement in problem.measurements:
        if name not in measurement.measured:
            continue
        given = ("deformed_length", "rotation", "force", "torque")
        imposed = [getattr(measurement, other) for other in given if other not in measurement.measured]
        settings = [measurement.pressure, *(array for array in imposed if array is not None)]
        _, which = np.unique(np.round(np.column_stack(settings), 12), axis=0, return_inverse=True)
        for k in np.unique(which):
            values = getattr(measurement, name)[which.ravel() == k]
            squares, count = squares + np.sum((values - values.mean()) ** 2), count + len(values) - 1
        half = measurement.half_width.get(name, np.empty(0))
        if np.isfinite(half).sum() >= FEW + 2:  # second differences of a smooth loop are noise: six variances each
            second = np.diff(half[np.isfinite(half)], 2)
            bends, turns = bends + np.sum(second**2) / 6.0, turns + len(second)
    found = {}
    if count:
        found["replicates"] = squares / count, count
    if turns:
        found["the branches of loops"] = bends / turns, turns / 2.0
    return found


def _signs(residuals, curve, along, own):
    """Signs of each curve's residuals along it."""
    for k in np.unique(curve[own]):
        rows = np.flatnonzero(own & (curve == k))
        rows = rows[np.argsort(along[rows], kind="stable")]
        yield np.sign(residuals[rows])


def _runs(residuals, curve, along, own):
    """How many standard deviations the number of runs is below that of noise (Wald and Wolfowitz)."""
    short = variance = 0.0
    for signs in _signs(residuals, curve, along, own):
        plus, minus = float(np.sum(signs > 0.0)), float(np.sum(signs < 0.0))
        n = plus + minus
        if plus and minus and n > 2:
            product = 2.0 * plus * minus
            short += product / n + 1.0 - (1.0 + np.count_nonzero(np.diff(signs[signs != 0.0])))
            variance += product * (product - n) / (n * n * (n - 1.0))
    return short / np.sqrt(variance) if variance > 0.0 else 0.0


def _correlation(weighed, curve, along, active):
    """Correlation of neighbours along curves, 0 to 0.9."""
    product = square = 0.0
    for k in np.unique(curve[active]):
        rows = np.flatnonzero(active & (curve == k))
        rows = rows[np.argsort(along[rows], kind="stable")]
        product += np.sum(weighed[rows][1:] * weighed[rows][:-1])
        square += np.sum(weighed[rows] ** 2) * (len(rows) - 1) / max(len(rows), 1)
    return float(np.clip(product / square, 0.0, 0.9)) if square > 0.0 else 0.0

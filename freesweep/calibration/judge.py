"""Whether residuals look like noise, and how much less the data tell where they do not.

Noise scatters from one state of a curve to the next; what a model lacks bends along the curve. Within each curve a low
polynomial takes what bends; what is left is noise, or what replicates and loops say of it. The test is Fisher's: bends
over noise. A second one counts runs of one sign. How parameters change when a curve k is left out needs no new fits: to
first order it is then missed by ``(1 - H_kk)^-1 r_k``, H the hat matrix. By how much it is missed does: a fit may move far.
"""

from typing import NamedTuple

import numpy as np

from .fitted import Curves, Fitted
from .misfit import verdict_of
from .noise import FEW, bent, correlation, other_noise, too_few_runs

LEVEL = 0.01  # chance of calling a fitting model wrong, of each of two tests
LEAST_FREEDOM = 3  # of intervals that were widened
MUCH = 0.05  # of the largest number: by how much a bench may scatter where nothing tells its noise
NO_NOISE = 1e-5  # of the largest number: residuals below it are the solver's


class Judged(NamedTuple):
    """What the residuals say: factors of standard errors (p,), degrees of freedom, misfit of unseen curves by quantity, and
    the verdict in words.
    """

    fits: bool
    widening: np.ndarray
    freedom: float
    leave_one_out: dict
    verdict: str


def judge(fit: Fitted) -> Judged:
    """Judge a fit by its residuals and their derivative."""
    curves, measured = fit.curves(), fit.problem.measured
    left = _left_out(fit, curves)
    missed, unseen = {}, _unseen(fit, curves)
    for name in fit.quantities:
        own = fit.of(name)
        some = unseen[own & np.isfinite(unseen)]
        missed[name] = float(np.sqrt(np.mean(some**2))) if len(some) else np.nan
    reasons = _reasons(fit, curves)
    largest = max((np.max(np.abs(measured[fit.problem.quantity == n]), initial=0.0) for n in missed), default=1.0)
    if not reasons or np.max(np.abs(fit.residuals[fit.active]), initial=0.0) <= NO_NOISE * largest:
        return Judged(True, np.ones(len(fit.theta)), fit.freedom, missed, verdict_of(fit, curves, ()))
    alike = correlation(fit.weighed, *curves, fit.active)
    together = (1.0 + alike) / (1.0 - alike)  # states that bend together count as fewer
    factor = together * max(fit.chi_square(), 1.0)
    plain = np.sqrt(np.maximum(np.diag(left.covariance), 1e-300))
    widening = np.maximum(np.sqrt(factor), left.jackknife / plain)
    own = max(min(fit.freedom, int(fit.active.sum()) / together - len(fit.theta)), LEAST_FREEDOM)
    verdict = (
        f"{verdict_of(fit, curves, reasons)}. Something else is at work (another model of the tube, a parameter that is not"
        f" fitted, the bench); intervals are widened for it, {np.max(widening):.3g} times at most"
    )
    return Judged(False, widening, own, missed, verdict)


def _unseen(fit, curves):
    """Residuals (values,) of each curve by a fit to all others; NaN where these do not tell the parameters."""
    problem, count = fit.problem, len(fit.theta)
    found, known = np.full(len(curves.number), np.nan), int(np.isfinite(problem.parameters.sigma).sum())
    for k in np.unique(curves.number[fit.active]):
        own = curves.number == k
        others = fit.rows & ~own
        if not others.any() or others.sum() + known < count:
            continue
        other = problem.solve(fit.theta, fit.home, fit.sigma, others)
        found[own] = problem.residuals(*problem.model(other))[own]
    problem.model(fit.theta)
    problem.predictor.refresh(problem.parameters.setups(fit.theta))
    return found


class _Left(NamedTuple):
    covariance: np.ndarray
    jackknife: np.ndarray  # standard errors (p,) by leaving out curves


def _left_out(fit, curves):
    """How the parameters change where a curve is left out, to first order."""
    weighed, slopes, active = fit.weighed, fit.slopes, fit.active
    known = np.diag(fit.known)
    normal = slopes[active].T @ slopes[active] + known**2
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
    covariance = np.linalg.pinv(normal / np.outer(scale, scale), hermitian=True, rcond=1e-12) / np.outer(scale, scale)
    changes = []
    for k in np.unique(curves.number[active]):
        own = np.flatnonzero(active & (curves.number == k))
        hat = slopes[own] @ covariance @ slopes[own].T
        left = np.linalg.lstsq(np.eye(len(own)) - hat, weighed[own], rcond=1e-9)[0]
        changes.append(covariance @ slopes[own].T @ left)
    count = len(changes)
    changes = np.array(changes) if count else np.zeros((1, slopes.shape[1]))
    jackknife = np.sqrt((count - 1.0) / max(count, 1) * np.sum((changes - changes.mean(axis=0)) ** 2, axis=0))
    return _Left(covariance, jackknife)


def _reasons(fit: Fitted, curves: Curves) -> list:
    """Why the residuals are no noise, in words."""
    from scipy.stats import chi2

    reasons = [reason for name in fit.quantities for reason in _reasons_of(fit, curves, name)]
    ratio, chance = bent(fit.weighed, *curves, fit.active, len(fit.theta))
    if not reasons and chance < LEVEL:
        reasons.append(f"along all curves together residuals bend {np.sqrt(ratio):.2g} times as much as they scatter")
    chi_square = fit.chi_square()
    if not fit.unknown and chi2.sf(chi_square * fit.freedom, fit.freedom) < LEVEL:
        reasons.append(f"the data are missed by {np.sqrt(chi_square):.3g} times the uncertainties given")
    return reasons


def _reasons_of(fit, curves, name):
    """Why those of one quantity are none."""
    from scipy.stats import f, norm

    reasons, own, residuals = [], fit.of(name), fit.residuals
    share = len(fit.theta) * own.sum() / max(fit.active.sum(), 1)
    ratio, chance = bent(residuals, *curves, own, share)
    if chance < LEVEL:
        return [f"along its curves the residuals of {name} bend {np.sqrt(ratio):.2g} times as much as they scatter"]
    others = other_noise(fit.problem, name)
    for what, (variance, count) in others.items():
        spread = np.sum(residuals[own] ** 2) / max(own.sum() - share, 1.0)
        if count >= FEW and variance > 0.0 and f.sf(spread / variance, own.sum() - share, count) < LEVEL:
            reasons.append(f"{name} is missed by {np.sqrt(spread / variance):.2g} times the noise that {what} show")
            break
    told = np.isfinite(chance) or any(count >= FEW for _, count in others.values())
    missed = np.sqrt(np.mean(residuals[own] ** 2)) / np.max(np.abs(fit.problem.measured[own])) if own.any() else 0.0
    if name in fit.unknown and not told and missed > MUCH:
        reasons.append(f"{name} is missed by {missed:.0%} of its largest, and too few values tell of any noise")
    if norm.sf(too_few_runs(residuals, *curves, own)) < LEVEL:
        reasons.append(f"the residuals of {name} keep their sign along the curves, in too few runs")
    return reasons

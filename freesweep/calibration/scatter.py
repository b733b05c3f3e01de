"""Standard uncertainties that are estimated from scatter about the fit, and what it costs that they are only estimated.

With slopes J weighed by them, ``N_q = J_q^T J_q`` of each measured quantity q, ``C = (sum of N_q)^-1``, and n_q degrees of
freedom left to q, the logarithm of its variance errs by the root of 2/n_q. Two consequences (Kenward and Roger 1997):

    weights that err move the parameters:    Lambda = sum of 2/n_q C (N_q - N_q C N_q) C
    C is least where it errs low:            their covariance is C + 2 Lambda, not C

and each parameter's quantile is Student's with the degrees of freedom of its own variance (Satterthwaite).
"""

from typing import NamedTuple

import numpy as np

LEAST_LEFT, ENOUGH_LEFT = 0.5, 3.0  # degrees of freedom: that are divided by; from which on scatter speaks for itself
FEWEST = 2.0  # of a parameter


def scatter_of(residuals, slopes, rows, here, pull, elsewhere=0.0):
    """Standard uncertainty from residuals: the parameters take their share of the degrees of freedom. Where they take nearly
    all, residuals vanish and tell nothing: what scatters ``elsewhere``, in the same unit, counts for what is missing.
    """
    active = here & np.any(slopes != 0.0, axis=1) if np.any(slopes[here]) else here  # not what hangs slack, and is met
    if not active.any():
        return 0.0
    left, values, _ = np.linalg.svd(np.vstack([slopes[rows], np.diag(pull)]), full_matrices=False)
    leverage = np.zeros(len(rows))
    leverage[rows] = np.sum(left[: rows.sum(), values > 1e-8 * max(values[0], 1e-300)] ** 2, axis=1)
    freedom = max(active.sum() - leverage[active].sum(), 0.0)
    missing = max(ENOUGH_LEFT - freedom, 0.0) if elsewhere > 0.0 else 0.0
    squares = np.sum(residuals[active] ** 2) + missing * elsewhere**2
    return np.sqrt(squares / max(freedom + missing, LEAST_LEFT))


class Estimated(NamedTuple):
    """What follows for the parameters (p,) from estimated uncertainties."""

    freedoms: np.ndarray  # degrees of freedom of each one's variance
    added: np.ndarray  # (p, p): to the covariance


def estimated(slopes, covariance, quantity, unknown, active, most) -> Estimated:
    """Of weighed ``slopes`` (values, p), of which those ``active`` count; ``unknown``: quantities whose uncertainty is
    estimated; ``most`` degrees of freedom in all.
    """
    told = np.where(np.isfinite(covariance), covariance, 0.0)
    variance = np.maximum(np.diag(told), 1e-300)
    spread, added = np.zeros(len(told)), np.zeros_like(told)
    for name in unknown:
        own = active & (quantity == name)
        normal = slopes[own].T @ slopes[own]
        left = max(own.sum() - np.trace(told @ normal), 1.0)
        spread += (np.diag(told @ normal @ told) / variance) ** 2 / left
        added += 4.0 / left * told @ (normal - normal @ told @ normal) @ told
    return Estimated(np.clip(1.0 / np.maximum(spread, 1e-12), FEWEST, most), added)

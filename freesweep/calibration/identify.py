"""What data can tell of parameters and what they cannot, in numbers and in sentences."""

import numpy as np

UNSEEN = 1e-6  # relative effect of a parameter that no bench, nor the solver, can tell
CORRELATED = 0.95  # from here on two parameters are called hardly separable
MISFIT = 2.0  # chi square per degree of freedom from which the model is said to miss the data


def covariance_of(slopes, theta, effects):
    """``(J^T J)^-1`` (p, p), infinite in parameters to which the data are blind, and the condition of J.

    ``effects`` (p,) are the largest relative changes of what was measured, per relative change of each parameter.
    The condition is that of relative changes: columns of J times the parameters (a parameter near 0 counts as 1 % of 1).
    """
    weights = relative(theta)
    seen = effects > UNSEEN
    _, values, right = np.linalg.svd((slopes * weights)[:, seen], full_matrices=False)
    inverse = right.T / np.maximum(values, UNSEEN * values[0]) if seen.any() else np.zeros((0, 0))
    covariance = np.zeros((len(theta), len(theta)))
    covariance[np.ix_(seen, seen)] = inverse @ inverse.T
    covariance *= np.outer(weights, weights)
    covariance[~seen, ~seen] = np.inf
    return covariance, float(values[0] / values[-1]) if seen.all() and values[-1] > 0.0 else np.inf


def relative(theta):
    """What a relative change of each parameter is a share of (p,)."""
    return np.maximum(np.abs(theta), 0.01)


def notes_of(found, left_out, at_bound, estimated):
    """Sentences on how far the numbers of a calibration can be trusted."""
    names, values, covariance = found["names"], found["values"], found["covariance"]
    errors = np.sqrt(np.diag(covariance))
    notes = []
    blind = [name for name, error in zip(names, errors) if not np.isfinite(error)]
    if blind:
        notes.append(
            f"the data do not tell {' nor '.join(blind)}: what was measured does not depend on it; leave it out of the fit,"
            " or add a curve of another kind"
        )
    for i in range(len(names)):
        for k in range(i):
            if names[i] in blind or names[k] in blind:
                continue
            correlation = covariance[i, k] / (errors[i] * errors[k])
            if abs(correlation) >= CORRELATED:
                notes.append(_hardly_separable(names, values, covariance, k, i, correlation))
    if not notes and len(names) > 1:
        largest = np.max(np.abs(covariance / np.outer(errors, errors) - np.eye(len(names))))
        notes.append(f"the parameters are separable: the largest correlation of two of them is {largest:.2f}")
    for name, end in at_bound.items():
        way = "lower" if end == "smallest" else "higher"
        why = "which physics does not allow" if name.startswith("c") else "which its bounds do not allow"
        notes.append(f"{name} ended at its {end} value: the data would have it {way}, {why}; do not trust the others")
    if left_out:
        notes.append(
            f"{left_out} measured value{'s' * (left_out > 1)} did not count: at the parameters found, the model has no state"
            " there (at low pressure the fibers are not taut yet; beyond a limit pressure the branch has ended)"
        )
    if not estimated and found["chi_square"] > MISFIT:
        notes.append(
            f"the model misses the data by {np.sqrt(found['chi_square']):.3g} times the uncertainties given: something else"
            " is at work, or they are too small; standard errors do not cover that, intervals do"
        )
    return tuple(notes)


def _hardly_separable(names, values, covariance, i, k, correlation):
    """The combination of two parameters that the data do tell."""
    share = -covariance[i, k] / covariance[k, k]
    told = values[i] + share * values[k]
    error = np.sqrt(max(covariance[i, i] + 2.0 * share * covariance[i, k] + share**2 * covariance[k, k], 0.0))
    sentence = f"{names[i]} and {names[k]} are hardly separable from these data (correlation {correlation:.4f})"
    if names[i].startswith("c") and names[k].startswith("c"):
        sentence += (
            f": what they do tell is {names[i]} {'+' if share >= 0 else '-'} {abs(share):.3g} {names[k]} ="
            f" {told * 1e-6:.4g} MPa, within {error * 1e-6:.2g} MPa (standard)"
        )
    return sentence + "; fix one of them, or add curves of other fiber angles or loads"

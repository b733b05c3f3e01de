"""What residuals along curves, replicates and the branches of loops tell of the noise of a bench."""

import numpy as np

DEGREE = 2  # of polynomials along a curve
FEW = 4  # noise degrees of freedom below which Fisher's test is not made


def bent(residuals, curve, along, own, parameters):
    """How much more residuals bend than scatter, as a ratio of variances, and the chance of that in mere noise; infinite
    where too few values tell.
    """
    from scipy.stats import f

    bends, bend_freedom, noise, noise_freedom = bends_and_noise(residuals, curve, along, own)
    bend_freedom -= parameters
    if bend_freedom < 1.0 or noise_freedom < FEW or noise <= 0.0:
        return 1.0, np.inf
    ratio = bends / bend_freedom / (noise / noise_freedom)
    return ratio, f.sf(ratio, bend_freedom, noise_freedom)


def bends_and_noise(residuals, curve, along, own):
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


def other_noise(problem, name):
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


def too_few_runs(residuals, curve, along, own):
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


def correlation(weighed, curve, along, active):
    """Correlation of neighbours along curves, 0 to 0.9."""
    product = square = 0.0
    for k in np.unique(curve[active]):
        rows = np.flatnonzero(active & (curve == k))
        rows = rows[np.argsort(along[rows], kind="stable")]
        product += np.sum(weighed[rows][1:] * weighed[rows][:-1])
        square += np.sum(weighed[rows] ** 2) * (len(rows) - 1) / max(len(rows), 1)
    return float(np.clip(product / square, 0.0, 0.9)) if square > 0.0 else 0.0

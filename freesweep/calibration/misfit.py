"""By how much a fit misses what was measured, in words: beside what is known of the noise, as shares of its range."""

import numpy as np

from .noise import FEW, bends_and_noise, other_noise

LEAST = 0.001  # [%]: less is the solver's
FLAT = 0.01  # of the largest number: what ranges over less is measured by that itself


def verdict_of(fit, curves, reasons) -> str:
    """Whether the model fits, why not if there are ``reasons``, and by how much each quantity is missed."""
    noises = {name: noise_of(fit, curves, name) for name in fit.quantities if fit.of(name).any()}
    if reasons:
        verdict = f"the model does not fit: {'; '.join(reasons)}"
    elif all(noise for noise in noises.values()):
        verdict = "the model fits: what is left looks like noise"
    else:
        verdict = "nothing speaks against the model, but too few values tell what of the misfit is noise"
    return f"{verdict}. Typically {'; '.join(_missed(fit, name, noise) for name, noise in noises.items())}"


def noise_of(fit, curves, name) -> str:
    """What is known of the noise of a quantity, as a sentence; "" where nothing is."""
    _, size, _ = range_of(fit, name)
    own = fit.of(name)
    if name not in fit.unknown:
        return f"given as {_percent(np.sqrt(np.mean(fit.sigma[own] ** 2)), size)}"
    for what, (variance, count) in other_noise(fit.problem, name).items():
        if count >= FEW:
            return f"{what} scatter by {_percent(np.sqrt(variance), size)}"
    _, _, noise, freedom = bends_and_noise(fit.residuals, *curves, own)
    return f"it scatters about smooth curves by {_percent(np.sqrt(noise / freedom), size)}" if freedom >= FEW else ""


def range_of(fit, name):
    """``(words, size, typical misfit)`` of a quantity: what a misfit is a share of, and its root mean square."""
    own = fit.of(name)
    measured, misfit = fit.problem.measured[own], np.sqrt(np.mean(fit.residuals[own] ** 2))
    largest = np.max(np.abs(measured))
    is_flat = np.ptp(measured) <= FLAT * largest
    return ("of itself", max(largest, 1e-300), misfit) if is_flat else ("of its range", np.ptp(measured), misfit)


def _missed(fit, name, noise):
    words, size, misfit = range_of(fit, name)
    said = f"{name} is missed by {_percent(misfit, size)} {words}"
    return f"{said} ({noise})" if noise else said


def _percent(value, size):
    share = 100.0 * value / size
    return f"{share:.2g} %" if share >= LEAST else f"less than {LEAST:g} %"

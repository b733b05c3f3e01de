"""Errors that answers state, from estimates and what the atlas measured of them (see :mod:`calibration`)."""

import numpy as np

from .calibration import DECADES

EDGES = 10.0**DECADES  # of the classes, relative to the value


def stated(factors, estimate, bound, size, beside, cell=None):
    """Stated errors (n,) from estimates of the interpolation and bounds of what was stored; ``beside``: how they lie to
    holes; ``cell`` (n,): in which they lie.
    """
    total = estimate + factors.bound * bound
    found = factors.classes[np.asarray(beside, int), classes(total, size)] * total
    return found * factors.cells[cell] if len(factors.cells) else found


def classes(estimate, size) -> np.ndarray:
    """Class of each estimate (n,) by its size relative to the value's."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = estimate / size
    return np.searchsorted(EDGES, np.where(ratio >= 0.0, ratio, 0.0), side="right")

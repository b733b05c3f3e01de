"""Errors that answers state, from estimates and what the atlas measured of them (see :mod:`calibration`)."""

import numpy as np

from ..jit import entry_point
from .calibration import DECADES

EDGES = 10.0**DECADES  # of the classes, relative to the value


def stated(factors, estimate, bound, size, beside):
    """Stated errors (n,) from estimates of the interpolation and bounds of what was stored; ``beside`` holes or not."""
    errors = np.empty(len(estimate))
    _stated(factors.classes, factors.bound, EDGES, estimate, bound, size, beside, errors)
    return errors


def classes(estimate, size) -> np.ndarray:
    """Class of each estimate (n,) by its size relative to the value's."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.searchsorted(EDGES, np.nan_to_num(estimate / size, nan=0.0), side="right")


@entry_point
def _stated(factors, share, edges, estimates, bounds, sizes, beside, errors):
    for k in range(len(errors)):
        total = estimates[k] + share * bounds[k]
        kind, ratio = 0, total / sizes[k]
        while kind < len(edges) and ratio >= edges[kind]:
            kind += 1
        errors[k] = factors[1 if beside[k] else 0, kind] * total

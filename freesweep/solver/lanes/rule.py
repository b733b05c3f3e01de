"""The rule of Clenshaw and Curtis for a vector of designs, and how much it may miss.

The coefficients of a function's expansion in Chebyshev polynomials tell: a share of the last ones, and less where they fall
fast, among themselves and from those in the middle.
"""

from math import sqrt

import numpy as np

from ...jit import kernel
from .vector import get, spread

LAST = 16  # places 0 to LAST
_ANGLES = np.pi * np.arange(LAST + 1) / LAST
_BASIS = np.polynomial.chebyshev.chebvander(-np.cos(_ANGLES), LAST)
PLACES = 0.5 - 0.5 * np.cos(_ANGLES)
WEIGHTS = np.linalg.solve(_BASIS.T, [0.0 if k % 2 else 1.0 / (1.0 - k * k) for k in range(LAST + 1)])
_COEFFICIENTS = np.linalg.inv(_BASIS)
_INTEGRALS = np.polynomial.chebyshev.chebint(_COEFFICIENTS, lbnd=-1)
# up to the place of a row, for the number at the place of a column
UP_TO = np.ascontiguousarray(0.5 * np.polynomial.chebyshev.chebval(-np.cos(_ANGLES), _INTEGRALS).T)
# coefficients in the middle, and the last two pairs
LEVELS = np.ascontiguousarray(_COEFFICIENTS[[LAST // 2 - 1, LAST // 2, *range(LAST - 3, LAST + 1)]])
MISSED = 0.05  # of the largest of the last coefficients, where they hardly fall
FALLS = 2.5  # how far they are below those in the middle, and fall, tells more
TINY = 1e-300


@kernel
def level(row, first):
    """The larger one of two coefficients of the function in a row."""
    one, other = spread(0.0), spread(0.0)
    for k in range(LAST + 1):
        one, other = one + LEVELS[first, k] * get(row, k), other + LEVELS[first + 1, k] * get(row, k)
    return max(abs(one), abs(other))


@kernel
def missed_on_the_way(row):
    """What the sum up to a place of a row may miss: more than that of the whole, in which much of it cancels."""
    return MISSED * max(level(row, 2), level(row, 4))


@kernel
def summed(row):
    """Sum of a row by the rule, and what it may miss."""
    total = spread(0.0)
    for k in range(LAST + 1):
        total = total + WEIGHTS[k] * get(row, k)
    middle, before, last = level(row, 0), level(row, 2), level(row, 4)
    most = max(before, last)
    share, fallen = most / max(middle, TINY), last / max(before, TINY)
    falls = FALLS * max(sqrt(share * sqrt(share)), fallen * fallen)
    return total, MISSED * most * min(falls, 1.0)

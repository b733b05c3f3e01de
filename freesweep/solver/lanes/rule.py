"""The rule of Clenshaw and Curtis for a vector of designs, and how much it may miss.

A function's coefficients in Chebyshev polynomials tell. The sum of all misses little of those that follow the last, and
takes those twice as far for a constant: both are taken to fall on as they do from the middle of the known ones to the last.
Of 58,660 sums of random states whose ends may stand upright, in one piece and in two, 5 missed more, by up to 4.4 times.
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
LATE, EARLY = (np.ascontiguousarray(_COEFFICIENTS[k : k + 4]) for k in (LAST - 3, LAST // 2 - 3))
MISSED = 0.05  # of the largest of the last coefficients: what a sum up to any place may miss
NEXT, FOLDED = 0.05, 5.0  # shares of coefficients that follow, and of those twice as far, in what a sum misses
LEAST = 1e-300


@kernel
def largest(row, coefficients):
    """The largest of four of a row's coefficients."""
    most = spread(0.0)
    for i in range(4):
        total = spread(0.0)
        for k in range(LAST + 1):
            total = total + coefficients[i, k] * get(row, k)
        most = max(most, abs(total))
    return most


@kernel
def missed_within(row):
    """What a sum of the row up to any place of it may miss."""
    return MISSED * largest(row, LATE)


@kernel
def missed_by(row):
    """What the sum of the whole row may miss: coefficients that follow fall on as they do from the middle to the last."""
    last, middle = largest(row, LATE), largest(row, EARLY)
    fallen = min(last / (middle + LEAST), 1.0)
    root = sqrt(fallen)
    return last * root * (NEXT + FOLDED * fallen)


@kernel
def summed(row):
    """Sum of a row by the rule, and what it may miss."""
    total = spread(0.0)
    for k in range(LAST + 1):
        total = total + WEIGHTS[k] * get(row, k)
    return total, missed_by(row)

"""The rule of Clenshaw and Curtis for a vector of designs, and how much it may miss.

A function's coefficients in Chebyshev polynomials tell: from the last known ones on they are taken to fall as they do from
the middle of the known ones to the last, and of each that follows the rule misses a known part ALIASED, little of the first
and all of those twice as far, which it takes for a constant. Where they fall ever slower, as where ends stand upright, they
are more than that: SAFETY.
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
COEFFICIENTS = np.linalg.inv(_BASIS)  # of a row in Chebyshev polynomials, and those of its sum up to a place
INTEGRALS = 0.5 * np.polynomial.chebyshev.chebint(COEFFICIENTS, lbnd=-1)
# up to the place of a row, for the number at the place of a column
UP_TO = np.ascontiguousarray(np.polynomial.chebyshev.chebval(-np.cos(_ANGLES), INTEGRALS).T)
LATE, EARLY = (np.ascontiguousarray(COEFFICIENTS[k - 2 : k + 1]) for k in (LAST, LAST // 2))
MISSED = 0.05  # of the largest of the last coefficients: what a sum up to any place may miss
_FOLLOWING = np.arange(LAST + 2, 4 * LAST, 2)
_TAKEN_FOR = LAST - np.abs(_FOLLOWING % (2 * LAST) - LAST)  # at the rule's places they are the same
ALIASED = np.abs(1.0 / (1.0 - _FOLLOWING**2) - 1.0 / (1.0 - _TAKEN_FOR**2))[::-1].copy()
SAFETY = 25.0
LEAST = 1e-300


@kernel
def largest(row, coefficients):
    """The largest of some of a row's coefficients."""
    most = spread(0.0)
    for i in range(len(coefficients)):
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
    """What the sum of the whole row may miss."""
    last = largest(row, LATE)
    fallen = sqrt(sqrt(min(last / (largest(row, EARLY) + LEAST), 1.0)))  # from one that follows to the next
    total = spread(0.0)
    for k in range(len(ALIASED)):
        total = total * fallen + ALIASED[k]
    return SAFETY * last * fallen * sqrt(fallen) * total


@kernel
def summed(row):
    """Sum of a row by the rule, and what it may miss."""
    total = spread(0.0)
    for k in range(LAST + 1):
        total = total + WEIGHTS[k] * get(row, k)
    return total, missed_by(row)

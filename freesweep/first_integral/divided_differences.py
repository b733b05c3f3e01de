"""Arithmetic of divided differences: how a formula changes between two places, without subtracting nearly equal numbers.

A :class:`Divided` stands for a function f of q of which five numbers are known, as arrays: f(u) and f'(u) at a base u, f(q),
and the divided differences f[u,q] = (f(q) - f(u))/(q - u) and f[u,u,q] = (f[u,q] - f'(u))/(q - u). Sums, products,
quotients and square roots of such functions are again known at all five, by rules that hold for q = u too, where
f[u,u,u] = f''(u)/2.
"""

import numpy as np


class Divided:
    """One function of q: ``base`` f(u), ``slope`` f'(u), ``here`` f(q), ``first`` f[u,q], ``second`` f[u,u,q]."""

    __slots__ = ("base", "first", "here", "second", "slope")

    def __init__(self, base, slope, here, first, second):
        self.base, self.slope, self.here, self.first, self.second = base, slope, here, first, second

    @classmethod
    def of(cls, base, here):
        """The function f(q) = q."""
        return cls(base, 1.0, here, 1.0, 0.0)

    def __add__(self, other):
        if not isinstance(other, Divided):
            return Divided(self.base + other, self.slope, self.here + other, self.first, self.second)
        return Divided(
            self.base + other.base, self.slope + other.slope, self.here + other.here, self.first + other.first,
            self.second + other.second,
        )  # fmt: skip

    def __mul__(self, other):
        if not isinstance(other, Divided):
            parts = (self.base, self.slope, self.here, self.first, self.second)
            return Divided(*(part * other for part in parts))
        return Divided(
            self.base * other.base,
            self.slope * other.base + self.base * other.slope,
            self.here * other.here,
            self.first * other.here + self.base * other.first,
            self.second * other.here + self.slope * other.first + self.base * other.second,
        )

    def __sub__(self, other):
        return self + other * -1.0

    __radd__, __rmul__ = __add__, __mul__

    def inverse(self):
        """The function 1/f."""
        base, here = 1.0 / self.base, 1.0 / self.here
        slope = -self.slope * base * base
        first = -self.first * base * here
        return Divided(base, slope, here, first, -(self.second * base + self.first * slope) * here)

    def root(self):
        """The function sqrt(f)."""
        base, here = np.sqrt(self.base), np.sqrt(self.here)
        slope = 0.5 * self.slope / base
        first = self.first / (base + here)
        return Divided(base, slope, here, first, (self.second - slope * first) / (base + here))

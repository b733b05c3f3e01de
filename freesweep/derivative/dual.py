"""Dual numbers: a value and its exact partial derivatives, carried through plain arithmetic (forward mode).

Values are arrays over cells, (m,) with m = 1 for what is the same all along; ``parts`` are (parameters, m), or None of what
depends on no parameter. Comparisons are those of the values, which have to agree in all cells: a kernel branches once.
"""

import numpy as np


class Dual:
    """A value with its partial derivatives."""

    __slots__ = ("parts", "value")

    def __init__(self, value, parts=None):
        self.value, self.parts = value, parts

    def __add__(self, other):
        if not isinstance(other, Dual):
            return Dual(self.value + other, self.parts)
        if self.parts is None or other.parts is None:
            return Dual(self.value + other.value, other.parts if self.parts is None else self.parts)
        return Dual(self.value + other.value, self.parts + other.parts)

    def __mul__(self, other):
        if not isinstance(other, Dual):
            return Dual(self.value * other, None if self.parts is None else self.parts * other)
        value = self.value * other.value
        if self.parts is None:
            return Dual(value, None if other.parts is None else other.parts * self.value)
        if other.parts is None:
            return Dual(value, self.parts * other.value)
        return Dual(value, self.parts * other.value + other.parts * self.value)

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self):
        return Dual(-self.value, None if self.parts is None else -self.parts)

    def __sub__(self, other):
        return self + (-other)

    def __rsub__(self, other):
        return (-self) + other

    def __truediv__(self, other):
        return self * (1.0 / other)

    def __rtruediv__(self, other):
        inverse = 1.0 / self.value
        return Dual(inverse, None if self.parts is None else -self.parts * inverse * inverse) * other

    def __pow__(self, power):
        return _along(self, self.value**power, power * self.value ** (power - 1))

    def __gt__(self, other):
        return _all_or_none(self.value > value_of(other))

    def __ge__(self, other):
        return _all_or_none(self.value >= value_of(other))

    def __lt__(self, other):
        return _all_or_none(self.value < value_of(other))

    def __le__(self, other):
        return _all_or_none(self.value <= value_of(other))

    def __array_ufunc__(self, ufunc, method, *inputs, **named):
        if method != "__call__" or named or ufunc not in _UFUNCS:
            return NotImplemented
        return _UFUNCS[ufunc](*inputs)

    def take(self, some):
        """The value in ``some`` cells."""
        if np.size(self.value) == 1:
            return self
        alike = self.parts is None or self.parts.shape[1] == 1
        return Dual(self.value[some], self.parts if alike else self.parts[:, some])


def value_of(number):
    """The value of a number that may be dual."""
    return number.value if isinstance(number, Dual) else number


def _along(x, value, slope):
    return Dual(value, None if x.parts is None else x.parts * slope)


def _all_or_none(found):
    if np.all(found):
        return True
    if np.any(found):
        raise ValueError("a kernel would branch one way in some cells, another way in others")
    return False


def _pick(first, other, which):
    """``first`` in cells ``which``, ``other`` elsewhere."""
    value = np.where(which, value_of(first), value_of(other))
    parts = [
        number.parts if isinstance(number, Dual) and number.parts is not None else 0.0 for number in (first, other)
    ]
    return Dual(value, None if all(np.ndim(part) == 0 for part in parts) else np.where(which, *parts))


def select(which, first, other):
    """``first`` where ``which`` is true, in each cell."""
    return _pick(first, other, which)


def sqrt(x):
    """Square root; where it is 0, what is the root of stays 0."""
    if not isinstance(x, Dual):
        return np.sqrt(x)
    root = np.sqrt(x.value)
    return _along(x, root, 0.5 / np.where(root > 0.0, root, np.inf))


def maximum(first, other):
    """The larger one in each cell."""
    if not isinstance(first, Dual) and not isinstance(other, Dual):
        return np.maximum(first, other)
    return _pick(first, other, value_of(first) >= value_of(other))


def minimum(first, other):
    """The smaller one in each cell."""
    if not isinstance(first, Dual) and not isinstance(other, Dual):
        return np.minimum(first, other)
    return _pick(first, other, value_of(first) <= value_of(other))


def absolute(x):
    """Absolute value."""
    return _along(x, np.abs(x.value), np.sign(x.value)) if isinstance(x, Dual) else np.abs(x)


def _tan(x):
    tangent = np.tan(x.value)
    return _along(x, tangent, 1.0 + tangent * tangent)


_UFUNCS = {
    np.add: lambda a, b: b + a,
    np.subtract: lambda a, b: (-b) + a,
    np.multiply: lambda a, b: b * a,
    np.divide: lambda a, b: (1.0 / b) * a,
    np.radians: lambda x: x * np.radians(1.0),
    np.degrees: lambda x: x * np.degrees(1.0),
    np.tan: _tan,
    np.sin: lambda x: _along(x, np.sin(x.value), np.cos(x.value)),
    np.arcsin: lambda x: _along(x, np.arcsin(x.value), 1.0 / np.sqrt(1.0 - x.value**2)),
    np.sqrt: sqrt,
    np.maximum: maximum,
}  # where the array, or the number of NumPy's, comes first

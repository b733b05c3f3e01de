"""Counts the arithmetic of the physics by running it on expressions instead of numbers."""

from types import FunctionType

from ..solver.load import Load

OPERATIONS = ("+", "-", "*", "/", "sqrt")  # signs, minima and maxima are not counted


class Expression:
    """A value that remembers how it was made; the same operation on the same values is the same expression."""

    def __init__(self, known, operation, *parts):
        self.known, self.operation, self.parts = known, operation, parts

    def _make(self, operation, *parts):
        key = (operation, *(id(part) if isinstance(part, Expression) else part for part in parts))
        if key not in self.known:
            self.known[key] = Expression(self.known, operation, *parts)
        return self.known[key]

    def __add__(self, other):
        return self._make("+", self, other)

    def __radd__(self, other):
        return self._make("+", other, self)

    def __sub__(self, other):
        return self._make("-", self, other)

    def __rsub__(self, other):
        return self._make("-", other, self)

    def __mul__(self, other):
        return self._make("*", self, other)

    def __rmul__(self, other):
        return self._make("*", other, self)

    def __truediv__(self, other):
        return self._make("/", self, other)

    def __rtruediv__(self, other):
        return self._make("/", other, self)

    def __neg__(self):
        return self._make("negative", self)


def _plain(module, **replaced):
    """The functions of a module of kernels as plain Python, with some names replaced."""
    names = dict(vars(module)) | replaced
    for name, value in vars(module).items():
        if hasattr(value, "py_func"):
            names[name] = FunctionType(value.py_func.__code__, names, name, value.py_func.__defaults__)
    return names


def density_flops(module) -> int:
    """Additions, multiplications, divisions and roots of ``module.density`` at one point of a mesh.

    What is used twice counts once, what is not used or does not depend on the point not at all: as a compiler leaves it.
    """
    known = {}

    def sqrt(value):
        return value._make("sqrt", value)

    def either(*values):
        return next(value for value in values if isinstance(value, Expression))._make("either", *values)

    density = _plain(module, sqrt=sqrt, min=either, max=either)["density"]
    y, v, load = Expression(known, "y"), Expression(known, "v"), Load(1.01, (0.5,), (1.0,), 1.0, 0.1, 0.1, 1.0)
    todo, seen, flops = list(density(y, v, (0.1, 0.6, 0.7), load)), set(), 0
    while todo:
        value = todo.pop()
        if isinstance(value, Expression) and id(value) not in seen:
            seen.add(id(value))
            flops += value.operation in OPERATIONS
            todo += value.parts
    return flops

"""A part of an atlas' grid as it is stored: its variables over the axes of a table, read when they are asked for."""

import numpy as np


class Part:
    """``data`` over the axes ``names``, of each the nodes of its ``box`` (first, last + 1); ``shape`` is that of the table,
    whose kernels see axes of their own behind them.
    """

    def __init__(self, data, names, box, shape):
        self.data, self.names, self.box, self.shape = data, names, box, tuple(shape)
        self._stored, self._errors = {}, {}

    def grid(self, name) -> np.ndarray:
        """A stored variable (nodes,), read anew."""
        variable = self.data[name]
        part = {name: slice(*self.box[name]) if name in self.names else 0 for name in variable.dims}
        array = np.asarray(variable.isel(part).values)
        array = array[tuple(slice(None) if name in variable.dims else None for name in self.names)]
        array = array.reshape(array.shape + (1,) * (len(self.shape) - array.ndim))
        return np.ascontiguousarray(np.broadcast_to(array, self.shape)).ravel()

    def bounds(self, name) -> np.ndarray:
        """The bounds of a variable (nodes,), read anew; zero where the atlas holds none."""
        bound = f"{name}_error"
        return self.grid(bound) if bound in self.data else np.zeros(np.prod(self.shape), np.float32)

    def stored(self, name) -> np.ndarray:
        """The numbers of the atlas, bit for bit (nodes,), kept."""
        if name not in self._stored:
            self._stored[name] = self.grid(name)
        return self._stored[name]

    def errors(self, name) -> np.ndarray:
        """Their bounds (nodes,), kept."""
        if name not in self._errors:
            self._errors[name] = self.bounds(name)
        return self._errors[name]

    def forget(self, *names):
        """Let go of what is kept of some variables, of all without names."""
        for kept in (self._stored, self._errors):
            for name in names or list(kept):
                kept.pop(name, None)

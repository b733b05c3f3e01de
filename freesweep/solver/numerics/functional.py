"""What the numerics, which know no tube, are handed of the functional ``J = sum h L(y_mid, slope)``."""

from typing import Any, NamedTuple


class Functional(NamedTuple):
    """The ``density`` of :mod:`newton`, the ``conjugate`` of :mod:`held`, ``integrands`` and ``scales`` of :mod:`nested`."""

    density: Any
    conjugate: Any
    integrands: Any
    scales: Any

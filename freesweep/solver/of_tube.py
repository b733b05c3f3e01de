"""Where physics and numerics meet: the functional of a pressurised tube."""

from ..jit import kernel
from .numerics.functional import Functional
from .physics import lagrangian


@kernel
def of_tube():
    """What the numerics are handed."""
    return Functional(lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales)

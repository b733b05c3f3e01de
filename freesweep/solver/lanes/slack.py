"""Fibers that would have to push, of :mod:`freesweep.solver.along.slack`, for a vector of the source's tubes."""

from ...jit import kernel
from ..along.axial import axial_stretch
from ..along.slack import TENSIONLESS
from ..physics import lagrangian
from .vector import get, mask_of


@kernel
def pushing(y, n, cell, load):
    """Masks: where the alpha, and where the beta family would have to push, somewhere along half a tube, on n cells."""
    allowed = -TENSIONLESS * (load.p + abs(load.f))
    alpha, beta = mask_of(0), mask_of(0)
    _, _, constant = lagrangian.uniform_tube(get(y, n), cell, load)
    for j in range(n + 1):
        here = get(y, j)
        s = axial_stretch(here, constant, cell, load)
        tension_alpha, tension_beta = lagrangian.fiber_multipliers(here, s, cell, load)
        alpha, beta = alpha | (tension_alpha < allowed), beta | (tension_beta < allowed)
    return alpha, beta

"""Fibers that would have to push, or are slack, of :mod:`freesweep.solver.along.slack`, for a vector of designs."""

from ...jit import kernel
from ..along.axial import axial_stretch
from ..along.slack import NOTHING, TENSIONLESS, TENSIONLESS_END
from ..cells import nothing_yet, of_length
from ..physics import lagrangian, physical
from ..physics.wall import has_any_family, has_two_families, may_go_slack
from .vector import get, mask_of


@kernel
def pushing(x, y, n, cell, load):
    """Masks: where the alpha, and where the beta family would have to push, or is slack, somewhere along half a tube."""
    return _pushing(x, y, n, cell, load, load[2])


@kernel
def _pushing(x, y, n, cell, load, wall):
    if len(wall) > 1:
        return of_physical(x, y, n, cell, load)
    allowed = -TENSIONLESS * (load[3] + abs(load[4]))
    alpha, beta = mask_of(0), mask_of(0)
    _, _, constant = lagrangian.uniform_tube(get(y, n), cell, load)
    for j in range(n + 1):
        here = get(y, j)
        s = axial_stretch(here, constant, cell, load)
        tension_alpha, tension_beta = lagrangian.fiber_multipliers(here, s, cell, load)
        alpha, beta = alpha | (tension_alpha < allowed), beta | (tension_beta < allowed)
    return alpha, beta


@kernel
def of_physical(x, y, n, cell, load):
    """:func:`pushing` of physical tubes: in each cell, and at the clamped end."""
    least, at_end = -TENSIONLESS * (load[3] + abs(load[4])), -TENSIONLESS_END * (load[3] + abs(load[4]))
    if may_go_slack(load[2]):
        least = at_end = NOTHING + 0.0 * least
    alpha, beta, near = mask_of(0), mask_of(0), nothing_yet(0.0 * least)
    for j in range(n):
        h, rise = get(x, j + 1) - get(x, j), get(y, j + 1) - get(y, j)
        middle, v = 0.5 * (get(y, j) + get(y, j + 1)), rise / h
        tension_alpha, tension_beta, near = physical.tensions(middle, v, cell, load, near)
        alpha, beta = alpha | (tension_alpha < least), beta | (tension_beta < least)
        if j == 0:
            _, L_y, L_v, _, _, _ = lagrangian.density(middle, v, of_length(cell, h), load)
            _, _, tension_alpha, tension_beta = lagrangian.at_flux(get(y, 0), 0.5 * h * L_y - L_v, cell, load)
            alpha, beta = alpha | (tension_alpha < at_end), beta | (tension_beta < at_end)
    if not has_two_families(load[2]):  # what is not there is not slack
        beta = mask_of(0)
    if not has_any_family(load[2]):
        alpha = mask_of(0)
    return alpha, beta

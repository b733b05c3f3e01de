"""Fibers that would have to push, of :mod:`freesweep.solver.slack`, for a vector of designs."""

from ...jit import kernel
from .. import lagrangian
from ..slack import TENSIONLESS, TENSIONLESS_END
from .vector import get, mask_of


@kernel
def pushing(x, y, n, cell, load):
    """Masks: where the alpha, and where the beta family would have to push somewhere along half a tube."""
    size = load[3] + abs(load[4])
    alpha, beta = mask_of(0), mask_of(0)
    x_left, y_left = get(x, 0), get(y, 0)
    for j in range(-1, n):
        share = TENSIONLESS
        if j < 0:  # the clamped end itself, with the slope carried on from the two cells next to it
            share = TENSIONLESS_END
            h, h_after = get(x, 1) - x_left, get(x, 2) - get(x, 1)
            near, after = (get(y, 1) - y_left) / h, (get(y, 2) - get(y, 1)) / h_after
            v, middle = near + (near - after) * h / (h + h_after), y_left
        else:
            x_right, y_right = get(x, j + 1), get(y, j + 1)
            v, middle = (y_right - y_left) / (x_right - x_left), 0.5 * (y_left + y_right)
            x_left, y_left = x_right, y_right
        room = v * v < 1.0 + lagrangian.kinematics(middle, cell, load)[3]
        tension_alpha, tension_beta = lagrangian.fiber_multipliers(middle, v, cell, load)
        allowed = -share * size
        alpha, beta = alpha | (room & (tension_alpha < allowed)), beta | (room & (tension_beta < allowed))
    return alpha, beta

"""Blocked force and torque of inextensible fibers in closed form, with rounding bounds and statuses."""

import numpy as np

from . import closed_form, status

EPSILON = np.finfo(float).eps
NAMES = ("ideal_blocked_force", "ideal_blocked_torque")


def ideal_blocked(name, alpha, beta, radius, pressure):
    """``(value, bound, status)`` of one of NAMES [N or N m] (Eqs. 2.16, 2.19); arrays broadcast, angles in degrees."""
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    product = ta * tb
    # rounding of the tangents, and what is left of it in their product and sum
    of_ta, of_tb = (
        2.0 * EPSILON * (np.abs(t) + np.abs(np.radians(a)) * (1.0 + t * t)) for t, a in ((ta, alpha), (tb, beta))
    )
    of_product = np.abs(ta) * of_tb + np.abs(tb) * of_ta
    force = name == "ideal_blocked_force"
    with np.errstate(divide="ignore", invalid="ignore"):
        if force:
            relative = 2.0 * of_product / product**2
        else:
            relative = of_product / np.abs(ta + tb) + np.abs(2.0 + product) * (of_ta + of_tb) / (ta + tb) ** 2
    value = (closed_form.blocked_force if force else closed_form.blocked_torque)(alpha, beta, radius, pressure)
    solved = np.isfinite(value)
    failed = np.where((product > 0.0) & force, status.COMPRESSED, status.HELD_IMPOSSIBLE)
    codes = np.where(solved, status.OK, np.where(alpha == beta, status.DEGENERATE, failed))
    scale = np.pi * radius**2 * pressure * (1.0 if force else radius)
    bound = scale * np.where(solved, relative, 0.0) + 8.0 * EPSILON * (scale + np.abs(value))
    return value, np.where(solved, bound, np.nan), codes

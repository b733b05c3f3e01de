"""Blocked force and torque of inextensible fibers: formulas, evaluated where an atlas holds them, never interpolated."""

import numpy as np

from ..description.impossible import APART, LARGEST_ANGLE
from ..description.tube_model import fiber_surface
from ..ideal import ideal_blocked
from ..status import INVALID, OK, OUTSIDE
from .locate import NEAR

USED = ("alpha", "beta", "radius", "wall", "fiber_radius", "pressure")
IMAGES = ((1.0, False), (1.0, True), (-1.0, False), (-1.0, True))  # (sign of both angles, whether exchanged)


def ideal_answer(frame, name, values) -> dict:
    """Name -> (n,) of one variable, its error and its status at ``values``: axis -> (n,)."""
    used = [key for key in USED if key != "wall" or frame.fiber_share > 0.0]
    own = {key: values[key] for key in used if key in values}
    for key in (key for key in used if key in frame.by_design):
        own[key] = frame.values[key][values["design"].astype(int)]
    alpha, beta, pressure = own["alpha"], own["beta"], own["pressure"]
    with np.errstate(all="ignore"):
        value, error, status = ideal_blocked(name, alpha, beta, fiber_surface(own, frame.model), pressure)
        apart, widest = np.abs(alpha - beta), np.maximum(np.abs(alpha), np.abs(beta))
    close = (apart < APART) & (apart > 0.0)
    status = np.where(close | (widest >= LARGEST_ANGLE), INVALID, status)
    inside = np.ones(alpha.shape, bool)
    for key in own:
        if key not in ("alpha", "beta"):
            inside &= _within(own[key], frame.ranges[key])
    if {"alpha", "beta"} <= set(frame.asked):
        ranges = frame.ranges["alpha"], frame.ranges["beta"]
        inside &= np.any(
            [
                _within(sign * (beta if swap else alpha), ranges[0])
                & _within(sign * (alpha if swap else beta), ranges[1])
                for sign, swap in IMAGES
            ],
            axis=0,
        )
    status = np.where(inside, status, OUTSIDE)
    for array in own.values():
        status = np.where(np.isnan(array), INVALID, status)
    given = status == OK
    return {
        name: np.where(given, value, np.nan),
        f"{name}_error": np.where(given, error, np.nan),
        f"{name}_status": status.astype(np.int8),
    }


def _within(array, span):
    slack = NEAR * max(abs(span[0]), abs(span[1]))
    return (array >= span[0] - slack) & (array <= span[1] + slack)

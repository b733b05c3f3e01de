"""Outputs that are wished for, from those that a state has."""

import numpy as np

from ..closed_form import uniform_state
from ..description.strain import largest_principal
from ..status import VALUED

PLACES = 33  # stretches looked at between the end and the middle
FOLLOWING = ("stroke", "length_change", "outer_radius")  # from what a state has


def output(name, kind, found, design):
    """``(value, bound)`` of an output; ``found`` as the solvers give it, ``design`` name -> numbers; arrays broadcast."""
    if kind == "limit":
        none = np.isnan(found["limit_pressure"]) & np.isin(found["status"], VALUED)
        return np.where(none, np.inf, found["limit_pressure"]), np.where(none, 0.0, found["limit_pressure_error"])
    value = derived(name, found, design)
    if name == "stroke":
        return value, found["deformed_length_error"] / design["length"]
    if name == "length_change":
        return value, found["deformed_length_error"]
    if name == "outer_radius" and "outer_radius" not in found:
        bound = found["mid_radius_error"]
        with np.errstate(invalid="ignore"):
            wider = derived(name, {"mid_radius": found["mid_radius"] + bound}, design)
        return value, np.maximum(np.abs(wider - value), bound)
    if name == "largest_stretch" and "largest_stretch" not in found:
        bound = found["mid_radius_error"]
        with np.errstate(invalid="ignore"):
            wider = _largest_stretch(found["mid_radius"] + bound, design)
        return value, np.abs(wider - value) + bound / design["fiber_radius"]
    return value, found[f"{name}_error"]


def derived(name, found, design):
    """An output from those ``found``, in plain arithmetic: of arrays, or of dual numbers."""
    if name == "stroke":
        return 1.0 - found["deformed_length"] / design["length"]
    if name == "length_change":
        return found["deformed_length"] - design["length"]
    if name == "outer_radius" and "outer_radius" not in found:
        return _outer_radius(found["mid_radius"], design)
    if name == "largest_stretch" and "largest_stretch" not in found:
        return _largest_stretch(found["mid_radius"], design)
    return found[name]


def _largest_stretch(middle, design):
    """The largest principal stretch of such a tube's wall, on its inner and outer surface: fibers that are bonded leave no
    choice of stretch and twist where the circumferential stretch is one of those between the end's and the middle's.
    """
    rf, places = design["fiber_radius"], np.linspace(0.0, 1.0, PLACES)[:, None]
    y = 1.0 + places * (middle / rf - 1.0)
    axial, twist, *_ = uniform_state(design["alpha"], design["beta"], y, design["fiber_extension"])
    found = 0.0
    for rho in (design["radius"], design["radius"] + design["wall"]):
        with np.errstate(invalid="ignore"):
            r = np.sqrt(y**2 + ((rho / rf) ** 2 - 1.0) / axial)
        found = np.maximum(found, largest_principal(axial, r * rf / rho, r * twist))
    return np.max(found, axis=0)


def _outer_radius(middle, design):
    """The largest outer radius of a tube that bulges or necks in its middle: the wall keeps its volume, ``r_o^2 = r^2 +
    (r_o0^2 - r_0^2)/lambda_1`` outside the fibers (theory, section 11).
    """
    ta, tb = np.tan(np.radians(design["alpha"])), np.tan(np.radians(design["beta"]))
    h, d, gg = 0.5 * (ta + tb), 0.5 * (ta - tb), design["fiber_extension"] ** 2
    r0 = design["fiber_radius"]
    outside = (design["radius"] + design["wall"]) ** 2 - r0**2

    def outer(r):
        q = (r / r0) ** 2
        squared = gg * (1.0 + h * h + d * d) - d * d * q - gg * gg * h * h / q  # lambda_1^2, Eqs. 2.3, 2.4
        return np.sqrt(r * r + outside / np.sqrt(squared))

    with np.errstate(invalid="ignore"):
        return np.maximum(outer(middle), outer(r0))

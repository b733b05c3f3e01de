"""Closed forms of the uniform tube: locked state, blocked force and torque, regions of the design space.

Angles in degrees, arrays broadcast, units are read as everywhere (:mod:`freesweep.description.given`). With
H = (tan(alpha) + tan(beta))/2 and D = (tan(alpha) - tan(beta))/2::

    y_L^2 = (A + sqrt(A^2 - 3 gamma^4 D^2 H^2))/(3 D^2),   A = gamma^2 (1 + H^2 + D^2)       (Eq. 2.12)
    tan(alpha') tan(beta') = -2                                                               the locked manifold
    F_blocked = -pi r0^2 P (1 + 2/(tan(alpha) tan(beta)))                                     (Eq. 2.16)
    M_blocked =  pi r0^3 P (2 + tan(alpha) tan(beta))/(tan(alpha) + tan(beta))                (Eqs. 2.19, 2.20)

The forces are positive in tension: opposite to Eq. 2.11, as in the source's plots. Where a formula has a pole or no
meaning (a straight fiber cannot stretch; alpha = -beta cannot rotate; region I has no blocked force) the result is NaN.

What is held undeformed strains no wall, so both blocked loads hold for thick walls, too, with r0 the radius of the fibers.
Of threads that cannot push they hold where both families pull (:func:`held_shares`): ``fibers="loose"`` gives NaN elsewhere,
where the tube deforms and only the held state (``freesweep.blocked_torque``) tells. The locked uniform tube is the same.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from .description.faults import ActuatorError
from .description.given import numbers
from .description.options import read_choice
from .description.quantities import Quantities
from .description.tube_model import FIBERS

Formula = TypeVar("Formula", bound=Callable[..., Any])

UNITS = {
    **{"alpha": "degree", "beta": "degree", "fiber_extension": "1", "stretch": "1"},
    **{"length": "m", "radius": "m", "wall": "m", "pressure": "Pa", "c10": "Pa", "c01": "Pa"},
}
REGIONS = ("AF", "DF", "I", "IIa", "IIb", "LM")
HELD = ("rotation", "length")
ROUNDING = 1e-12  # of the pressure: a family without tension does not push
ANGLE_TOLERANCE = 1e-9  # [degree] and, for the product of tangents, relative: what counts as lying on a line


def _formula(function: Formula) -> Formula:
    """Let a formula take numbers as every public function does; raises :class:`ActuatorError` with every fault."""
    signature = inspect.signature(function)

    @functools.wraps(function)
    def formula(*given, **named):
        bound = signature.bind(*given, **named)
        faults, shapes = [], {}
        for name in bound.arguments.keys() & UNITS.keys():
            try:
                array = numbers(bound.arguments[name], UNITS[name])
                bound.arguments[name], shapes[name] = array[()], array.shape
            except ValueError as error:
                faults.append(f"{name}: {error}")
        try:
            np.broadcast_shapes(*shapes.values())
        except ValueError:
            found = ", ".join(f"{name} {shape}" for name, shape in sorted(shapes.items()) if shape)
            faults.append(f"the arrays do not broadcast: {found}; give equal lengths")
        if "held" in bound.arguments:
            read_choice("held", bound.arguments["held"], HELD, faults)
        if "fibers" in bound.arguments:
            read_choice("fibers", bound.arguments["fibers"], FIBERS, faults)
        if "energy" in bound.arguments:
            read_choice("energy", bound.arguments["energy"], ("full", "principal"), faults)
        if faults:
            raise ActuatorError(sorted(faults))
        with np.errstate(all="ignore"):  # poles, and what has no meaning: NaN or infinite
            return function(*bound.args, **bound.kwargs)

    return formula


def _tangents(alpha, beta):
    alpha, beta = np.broadcast_arrays(np.asarray(alpha, float), np.asarray(beta, float))
    return np.tan(np.radians(alpha)), np.tan(np.radians(beta))


@_formula
def locked_stretch(alpha: Quantities, beta: Quantities, fiber_extension: Quantities = 1.0) -> Any:
    """Circumferential stretch of the locked uniform tube [-]; NaN on the line alpha = beta."""
    ta, tb = _tangents(alpha, beta)
    half_sum, half_difference = 0.5 * (ta + tb), 0.5 * (ta - tb)
    g2 = np.asarray(fiber_extension, float) ** 2
    a = g2 * (1.0 + half_sum**2 + half_difference**2)
    root = np.sqrt(np.maximum(a**2 - 3.0 * (g2 * half_difference * half_sum) ** 2, 0.0))
    stretch = np.sqrt((a + root) / (3.0 * half_difference**2))
    return np.where(_on(alpha, beta), np.nan, stretch)


def _on(alpha, beta):
    return np.abs(np.subtract(alpha, beta)) < ANGLE_TOLERANCE


@_formula
def uniform_state(
    alpha: Quantities, beta: Quantities, stretch: Quantities, fiber_extension: Quantities = 1.0
) -> tuple[Any, Any, Any, Any]:
    """Axial stretch [-], twist [radian per radius of undeformed length] and deformed angles [degree] of a uniform tube.

    Eqs. 2.3 and 2.4 solved for a circumferential ``stretch``; returns ``(axial_stretch, twist, alpha', beta')``.
    """
    ta, tb = _tangents(alpha, beta)
    half_sum, half_difference = 0.5 * (ta + tb), 0.5 * (ta - tb)
    g2 = np.asarray(fiber_extension, float) ** 2
    y2 = np.asarray(stretch, float) ** 2
    twist = half_sum * (g2 / y2 - 1.0)
    squared = g2 * (1.0 + half_sum**2 + half_difference**2) - half_difference**2 * y2 - g2**2 * half_sum**2 / y2
    axial = np.sqrt(np.where(squared >= 0.0, squared, np.nan))
    y = np.sqrt(y2)
    return (
        axial,
        twist,
        np.degrees(np.arctan2(y * (ta + twist), axial)),
        np.degrees(np.arctan2(y * (tb + twist), axial)),
    )


@_formula
def locked_angles(alpha: Quantities, beta: Quantities, fiber_extension: Quantities = 1.0) -> tuple[Any, Any]:
    """Fiber angles of the locked uniform tube [degree], ``(alpha', beta')``: a point of the locked manifold."""
    return uniform_state(alpha, beta, locked_stretch(alpha, beta, fiber_extension), fiber_extension)[2:]


@_formula
def locked_manifold(alpha: Quantities) -> Any:
    """The beta [degree] that makes ``tan(alpha) tan(beta) = -2``: such a design does not move under pressure."""
    return np.degrees(np.arctan(-2.0 / np.tan(np.radians(np.asarray(alpha, float)))))


@_formula
def blocked_force(
    alpha: Quantities, beta: Quantities, radius: Quantities, pressure: Quantities, fibers: str = "bonded"
) -> Any:
    """Force [N] that keeps the length at pressure [Pa] with the ends free to rotate (Eq. 2.16); ``radius`` is that of
    the fibers [m].

    ``fibers``: "loose" threads pull wherever there is such a force.
    """
    ta, tb = _tangents(alpha, beta)
    product = ta * tb
    force = -np.pi * np.asarray(radius) ** 2 * pressure * (1.0 + 2.0 / product)
    return np.where((product < 0.0) & ~_on(alpha, beta) & _hold(alpha, beta, "length", fibers), force, np.nan)


@_formula
def blocked_torque(
    alpha: Quantities, beta: Quantities, radius: Quantities, pressure: Quantities, fibers: str = "bonded"
) -> Any:
    """Torque [N m] that keeps the rotation at pressure [Pa] with the length free (Eqs. 2.19, 2.20); ``radius`` of the fibers
    [m].

    ``fibers``: with "loose" threads NaN where one family would have to push, that is unless one angle is above, the other
    below 54.7 degrees in size.
    """
    ta, tb = _tangents(alpha, beta)
    torque = np.pi * np.asarray(radius) ** 3 * pressure * (2.0 + ta * tb) / (ta + tb)
    on_af = np.abs(np.add(alpha, beta)) < ANGLE_TOLERANCE
    return np.where(~on_af & ~_on(alpha, beta) & _hold(alpha, beta, "rotation", fibers), torque, np.nan)


def _hold(alpha, beta, held, fibers):
    """Whether fibers hold an undeformed tube so."""
    return True if fibers == "bonded" else np.minimum(*held_shares(alpha, beta, held)) >= -ROUNDING


@_formula
def held_shares(alpha: Quantities, beta: Quantities, held: str = "rotation") -> tuple[Any, Any]:
    """How both families share the pressure where an undeformed tube's ``held`` "rotation" or "length" is blocked.

    Returns the multipliers of both constraints over the pressure [-], ``(alpha's, beta's)``: a family's tension is
    ``2 pi r0^2 P`` times its own, over the cosine of its angle; negative, it would have to push. NaN where nothing is
    blocked in closed form.
    """
    ta, tb = _tangents(alpha, beta)
    if held == "length":
        shares = 1.0 / (ta * (ta - tb)), 1.0 / (tb * (tb - ta))
        open_ = ta * tb >= 0.0
    else:
        shares = (1.0 - 0.5 * tb**2) / (ta**2 - tb**2), (0.5 * ta**2 - 1.0) / (ta**2 - tb**2)
        open_ = np.abs(np.add(alpha, beta)) < ANGLE_TOLERANCE
    return tuple(np.where(open_ | _on(alpha, beta), np.nan, share) for share in shares)


@_formula
def critical_pressure(
    alpha: Quantities,
    beta: Quantities,
    length: Quantities,
    radius: Quantities,
    wall: Quantities,
    c10: Quantities,
    c01: Quantities = 0.0,
    energy: str = "full",
) -> Any:
    """Pressure [Pa] from which a cylinder whose rotation is held buckles: its first mode is antisymmetric.

    Of a membrane with bonded fibers at ``radius``. Lengths in [m], constants in [Pa]; infinite where it never does. Linear
    stability of y = 1 under Eq. 2.20, where nothing is strained: of a Yeoh rubber only c1 counts, given as ``c10``. No safe
    limit: stable buckled states may exist below it, down to ``least_buckled_pressure`` of ``blocked_torque(...,
    buckled=True)``.
    """
    ta, tb = _tangents(alpha, beta)
    half_sum, half_difference, q = 0.5 * (ta + tb), 0.5 * (ta - tb), ta * tb
    area = ((radius + wall) ** 2 - radius**2) / radius**2
    sheared = half_sum**2 if energy == "full" else 0.0
    stiffness = 8.0 * (1.0 + c01 / c10) * (1.0 + q + q**2 + sheared)
    bracket = 8.0 + 4.0 * half_sum**2 - 8.0 * half_difference**2 - q**2 - (2.0 * np.pi * radius / length) ** 2
    return np.where(bracket > 0.0, c10 * area * stiffness / bracket, np.inf)[()]


@_formula
def region(alpha: Quantities, beta: Quantities) -> Any:
    """Name of the region of the design space (Figure 1-2) as an array of strings, one of REGIONS.

    AF: alpha = -beta; DF: alpha = beta; LM: the locked manifold; I: swells, first longer, then shorter, rotating; IIa:
    swells, shortens, rotates; IIb: thins, lengthens, rotates. A straight fiber (tan = 0) counts to region I.
    """
    ta, tb = _tangents(alpha, beta)
    product = ta * tb
    on_af = np.abs(np.add(alpha, beta)) < ANGLE_TOLERANCE
    on_lm = np.abs(product + 2.0) < 2.0 * ANGLE_TOLERANCE
    return np.select(
        [_on(alpha, beta), on_lm, on_af, product >= 0.0, product > -2.0], ["DF", "LM", "AF", "I", "IIa"], default="IIb"
    )

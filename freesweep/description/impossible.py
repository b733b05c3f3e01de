"""What is impossible of an actuator whose fields are each fine alone."""

import math

import numpy as np

from .families import followed, given_by, is_one
from .profiles import together
from .tube_model import FEW_PRINCIPAL, FIBER_PLACES

LARGEST_ANGLE = 90.0  # [degree], excluded: the fibers would be hoops
SMALLEST_DIFFERENCE = 0.5  # [degree] of alpha and beta: below it the locked shape has no finite size
APART = SMALLEST_DIFFERENCE * (1.0 - 1e-9)  # what rounding may leave of it, as a search along that border needs


def impossible(tube) -> list:
    """Faults of numbers that are each fine alone."""
    faults = [
        f"{name}: found {angle[np.argmax(np.abs(angle))]:g} degree; it has to lie between -90 and 90, both excluded"
        for name, angle in ((name, tube.profile(name).samples()) for name in given_by(tube))
        if not np.all(np.abs(angle) < LARGEST_ANGLE)
    ]
    if len(followed(tube)) < 2:
        faults += [FEW_PRINCIPAL] * (tube.energy == "principal")
    if len(given_by(tube)) == 2 and not (tube.is_loose and is_one(tube)):
        faults += _too_close(tube)
    if tube.is_body:
        if isinstance(tube.fiber_radius, float):
            faults.append(
                f"fiber_radius: found {tube.fiber_radius:g} m, but the radius varies; choose one of"
                f" {', '.join(map(repr, FIBER_PLACES))}"
            )
        return faults
    outer = tube.radius + float(np.min(tube.profile("wall").samples()))
    if isinstance(tube.fiber_radius, float) and not tube.radius <= tube.fiber_radius <= outer * (1.0 + 1e-12):
        faults.append(
            f"fiber_radius: found {tube.fiber_radius:g} m; the fibers lie between the inner and the outer radius,"
            f" {tube.radius:g} to {outer:g} m"
        )
    if not faults and len(followed(tube)) == 2 and not tube.clamped_stretch() > 0.0:
        faults.append(
            f"fiber_extension: with {tube.fiber_extension:g} these fibers cannot meet the clamped ends, whose radius"
            " stays; reduce it or the angles"
        )
    return faults


def _too_close(tube):
    """Faults of two families that are nearly one somewhere."""
    alpha, beta = together(tube.profile("alpha"), tube.profile("beta"))
    closest = np.argmin(np.abs(alpha - beta))
    if alpha[closest] == beta[closest]:
        return [
            f"alpha, beta: both are {alpha[closest]:g} degree (line DF of Figure 1-2): one fiber family leaves the"
            f" locked shape free; choose angles at least {SMALLEST_DIFFERENCE:g} degree apart, or beta=None, or loose"
            " fibers that share the angle all along"
        ]
    if abs(alpha[closest] - beta[closest]) < APART or len(set(np.sign(alpha - beta))) > 1:
        return [
            f"alpha, beta: {alpha[closest]:g} and {beta[closest]:g} degree are less than {SMALLEST_DIFFERENCE:g} degree"
            " apart, or cross along the tube: nearly one fiber family somewhere, without a finite locked shape;"
            " keep alpha above beta all along, or below"
        ]
    return []


def clamped_stretch(alpha, beta, fiber_extension):
    """G at y = 1 [-] for fiber angles in [degree]; where it is not positive, clamped ends cannot be met."""
    ta, tb = math.tan(math.radians(alpha)), math.tan(math.radians(beta))
    half_sum, half_difference = 0.5 * (ta + tb), 0.5 * (ta - tb)
    g2 = fiber_extension * fiber_extension
    return 1.0 + (g2 - 1.0) * (1.0 + half_difference**2 - g2 * half_sum**2)

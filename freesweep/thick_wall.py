"""What the thin wall leaves out: its effect on small deformations of the uniform tube.

The model charges all of the wall with the strain at the fibers. Of a thick wall, which keeps its volume, the layer of the
undeformed radius rho (in units of the fibers' radius) has at small strains, with L = tan(alpha) tan(beta) the axial strain
per hoop strain at the fibers and H = (tan(alpha) + tan(beta))/2::

    w(rho^2) ~ 4 A^2/rho^4 + 3 L^2 + 4 H^2 rho^2,   A = 1 + L/2     (the last term: shear of the twist, energy "full")

A pressure deforms the tube in inverse proportion to the sum of w over the wall; near the locked shape, which no wall
changes, less is wrong.
"""

import numpy as np

THIN = 0.1  # of wall over radius: up to here the effect is that of other things a designer does not know


def softer(alpha, beta, radius, wall, fiber_radius, energy):
    """How much more a thick wall deforms at small pressure than a thin one, as a ratio [-]; angles [degree], lengths [m]."""
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    hoop, axial, shear = 4.0 * (1.0 + 0.5 * ta * tb) ** 2, 3.0 * (ta * tb) ** 2, (ta + tb) ** 2 * (energy == "full")
    inner, outer = (radius / fiber_radius) ** 2, ((radius + wall) / fiber_radius) ** 2
    thick = hoop * (1.0 / inner - 1.0 / outer) + axial * (outer - inner) + 0.5 * shear * (outer**2 - inner**2)
    return (outer - inner) * (hoop + axial + shear) / thick


def thin_wall_attributes(tube) -> dict:
    """Attributes of an answer whose tube has a wall thicker than a tenth of its radius somewhere; none for others."""
    share = np.linspace(0.0, 1.0, 33)
    alpha, beta = tube.angles(share)
    wall = tube.profile("wall").at(share)
    thickness = float(wall.max() / tube.radius)
    if thickness <= THIN or tube.is_thick:
        return {}
    ratios = softer(alpha, beta, tube.radius, wall, tube.fiber_surface, tube.energy)
    worst = float(ratios[np.argmax(np.abs(np.log(ratios)))])
    return {
        "thin_wall_ratio": worst,
        "thin_wall_note": f"wall/radius {thickness:.2g}: this model takes a thin wall; a thick one deforms {worst:.3g} times"
        " as much at small pressure, and much the same near the locked shape",
    }

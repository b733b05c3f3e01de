"""Bodies of revolution: a tube whose undeformed radius varies along its axis is, at each place, the tube of that radius.

With the radius R(x) of the fiber surface, in units of the reference radius as all lengths, its slope R' = dR/dx along the
axis, and ``e = sqrt(1 + R'^2)``, the length of the undeformed meridian per dx (theory, section 12)::

    y = r/R,   w = (dr/dx)/e = (R' y + R v)/e        circumferential stretch, and the slope along the meridian
    J = integral of  e R^2 l(y, w) dx                l: the density of the tube of radius 1 with this place's angles, wall
                                                     a/R^2 and loads p, f/R^2, m/R^3

so the integrands are s -> e s, y^2 s -> e R^2 y^2 s, psi -> e psi/R, energy -> e R^2 a w; at rest y = 1, w = R'/e, s = 1/e.
The chain rule gives the derivatives along y and v from those along y and w; flux = -L_v is R^3 times the tube's. So here is
a change of variables and nothing else: from a body to the tube (:func:`as_tube`), and from what any density says of that
tube, membrane or thick wall, bonded or loose fibers, back to the body (``of_...``).

``cell`` is (H, D, a/R^2, R, R', inner): six numbers, ``inner`` the squared inner radius over R^2, 0 for a membrane; three
are a tube's own, to which none of this does anything.
"""

from math import sqrt

from ...jit import kernel
from ..load import Load, under


@kernel
def as_tube(y, v, cell, load):
    """``(cell, slope, load)`` of the tube of radius 1."""
    if len(cell) == 3:
        return cell, v, load
    R, square = cell[3], cell[3] * cell[3]
    w = (cell[4] * y + R * v) / sqrt(1.0 + cell[4] * cell[4])
    wall = own_wall(cell, load.wall)
    own = Load(load.gamma, load.rubber, wall, load.p, load.f / square, load.m / (square * R), load.e)
    return (cell[0], cell[1], cell[2]), w, own


@kernel
def own_wall(cell, wall):
    """The wall at this place."""
    if len(wall) == 1:
        return wall
    return wall[0], cell[5], wall[2]


@kernel
def own_direction(cell, direction):
    """A change of the load as the tube of radius 1 has it."""
    if len(cell) == 3:
        return direction
    square = cell[3] * cell[3]
    return under(direction, direction.p, direction.f / square, direction.m / (square * cell[3]))


@kernel
def own_flux(cell, flux):
    """The flux as the tube of radius 1 has it."""
    if len(cell) == 3:
        return flux
    return flux / (cell[3] * cell[3] * cell[3])


@kernel
def sizes(cell):
    """``(e, R, R')``."""
    return sqrt(1.0 + cell[4] * cell[4]), cell[3], cell[4]


@kernel
def of_partials(cell, partials):
    """The tube's ``(room, l_y, l_w, l_yy, l_yw, l_ww)`` as derivatives of the body's density along y and v."""
    if len(cell) == 3:
        return partials
    e, R, rise = sizes(cell)
    room, l_y, l_w, l_yy, l_yw, l_ww = partials
    w_y, w_v, all_of_it = rise / e, R / e, e * R * R
    return (
        room, all_of_it * (l_y + w_y * l_w), all_of_it * w_v * l_w,
        all_of_it * (l_yy + 2.0 * w_y * l_yw + w_y * w_y * l_ww), all_of_it * w_v * (l_yw + w_y * l_ww),
        all_of_it * w_v * w_v * l_ww,
    )  # fmt: skip


@kernel
def of_integrals(cell, integrals):
    """The tube's axial length, volume, twist, strain energy and kind as the body's per dx."""
    if len(cell) == 3:
        return integrals
    e, R, _ = sizes(cell)
    s, volume, twist, energy, kind = integrals
    return e * s, e * R * R * volume, e * twist / R, e * R * R * energy, kind


@kernel
def of_conjugate(cell, conjugate):
    """The tube's ``(c, c_y, c_w, c_mu)`` as the body's along y and v."""
    if len(cell) == 3:
        return conjugate
    e, R, rise = sizes(cell)
    c, c_y, c_w, c_mu = conjugate
    all_of_it = e * R * R
    return all_of_it * c, all_of_it * (c_y + rise / e * c_w), R * R * R * c_w, all_of_it * c_mu


@kernel
def of_uniform(cell, uniform):
    """``(sqrt(G), T sqrt(G), L)`` of the cylinder of this place's radius."""
    if len(cell) == 3:
        return uniform
    stretch, pull, at_rest = uniform
    square = cell[3] * cell[3]
    return stretch, square * pull, square * at_rest


@kernel
def of_multipliers(cell, first, alpha, beta):
    """The multipliers of both families in the reference tube's units, behind what stands before them."""
    if len(cell) == 3:
        return first, alpha, beta
    square = cell[3] * cell[3]
    return first, square * alpha, square * beta

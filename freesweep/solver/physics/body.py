"""Bodies of revolution: a tube whose undeformed radius varies along its axis is, at each place, the tube of that radius.

With the radius R(x) of the fiber surface, in units of the reference radius as all lengths, its slope R' = dR/dx along the
axis, and ``e = sqrt(1 + R'^2)``, the length of the undeformed meridian per dx (theory, section 12)::

    y = r/R,   w = (dr/dx)/e = (R' y + R v)/e        circumferential stretch, and the slope along the meridian
    J = integral of  e R^2 l(y, w) dx                l: the density of the tube of radius 1 with this place's angles, wall
                                                     a/R^2 and loads p, f/R^2, m/R^3

so the integrands are s -> e s, y^2 s -> e R^2 y^2 s, psi -> e psi/R, energy -> e R^2 a w; at rest y = 1, w = R'/e, s = 1/e.
The chain rule gives the derivatives along y and v from those along y and w. Whatever l is, membrane or thick wall, bonded or
loose fibers, is unchanged; flux = -L_v is R^3 times the tube's.

``cell`` is (H, D, a/R^2, R, R', inner): six numbers, ``inner`` the squared inner radius over R^2, 0 for a membrane; three
are a tube's own.
"""

from math import sqrt

from ...jit import kernel
from . import membrane, physical


@kernel
def of_cell(cell):
    """Local numbers of the tube, and (e, R, R')."""
    return (cell[0], cell[1], cell[2]), sqrt(1.0 + cell[4] * cell[4]), cell[3], cell[4]


@kernel
def own_load(cell, load, wall):
    """The load and the wall as the tube of radius 1 has them."""
    square = cell[3] * cell[3]
    return load[0], load[1], own_wall(cell, wall), load[3], load[4] / square, load[5] / (square * cell[3]), load[6]


@kernel
def own_wall(cell, wall):
    """The wall at this place."""
    if len(wall) == 1:
        return wall
    return wall[0], cell[5], wall[2]


@kernel
def slope(y, v, cell):
    """The slope along the undeformed meridian."""
    return (cell[4] * y + cell[3] * v) / sqrt(1.0 + cell[4] * cell[4])


@kernel
def of_tube(y, w, point, load, wall):
    """``(room, l_y, l_w, l_yy, l_yw, l_ww)``."""
    if len(wall) == 1:
        return membrane.density(y, w, point, load)
    return physical.density(y, w, point, load)


@kernel
def tube_integrands(y, w, point, load, wall):
    """The integrands of the tube of radius 1."""
    if len(wall) == 1:
        return membrane.integrands(y, w, point, load)
    return physical.integrands(y, w, point, load)


@kernel
def tube_conjugate(y, w, point, load, direction, wall):
    """The conjugate of the tube of radius 1."""
    if len(wall) == 1:
        return membrane.conjugate(y, w, point, load, direction)
    return physical.conjugate(y, w, point, load, direction)


@kernel
def tube_at_slope(y, w, point, load, wall):
    """Room and multipliers of the tube of radius 1."""
    if len(wall) == 1:
        return membrane.at_slope(y, w, point, load)
    return physical.at_slope(y, w, point, load)


@kernel
def tube_at_flux(y, flux, point, load, wall):
    """State and multipliers of the tube of radius 1."""
    if len(wall) == 1:
        return membrane.at_flux(y, flux, point, load)
    return physical.at_flux(y, flux, point, load)


@kernel
def own_direction(cell, direction):
    """A change of the load as the tube of radius 1 has it."""
    if len(cell) == 3:
        return direction
    square = cell[3] * cell[3]
    return (
        direction[0], direction[1], direction[2], direction[3], direction[4] / square, direction[5] / (square * cell[3]),
        direction[6],
    )  # fmt: skip


@kernel
def as_tube(y, v, cell, load):
    """``(cell, slope, load)`` of the tube of radius 1; three numbers are a tube's own."""
    if len(cell) == 3:
        return cell, v, load
    return (cell[0], cell[1], cell[2]), slope(y, v, cell), own_load(cell, load, load[2])


@kernel
def of_partials(cell, partials):
    """The tube's ``(room, l_y, l_w, l_yy, l_yw, l_ww)`` as derivatives of the body's density along y and v."""
    if len(cell) == 3:
        return partials
    _, e, R, rise = of_cell(cell)
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
    _, e, R, _ = of_cell(cell)
    s, volume, twist, energy, kind = integrals
    return e * s, e * R * R * volume, e * twist / R, e * R * R * energy, kind


@kernel
def of_conjugate(cell, conjugate):
    """The tube's ``(c, c_y, c_w, c_mu)`` as the body's along y and v."""
    if len(cell) == 3:
        return conjugate
    _, e, R, rise = of_cell(cell)
    c, c_y, c_w, c_mu = conjugate
    all_of_it = e * R * R
    return all_of_it * c, all_of_it * (c_y + rise / e * c_w), R * R * R * c_w, all_of_it * c_mu


@kernel
def density(y, v, cell, load):
    """``(room, L_y, L_v, L_yy, L_yv, L_vv)``."""
    tube, w, own = as_tube(y, v, cell, load)
    return of_partials(cell, of_tube(y, w, tube, own, load[2]))


@kernel
def integrands(y, v, cell, load):
    """Axial length, volume, twist, strain energy per dx, and the kind."""
    tube, w, own = as_tube(y, v, cell, load)
    return of_integrals(cell, tube_integrands(y, w, tube, own, load[2]))


@kernel
def conjugate(y, v, cell, load, direction):
    """``(c, c_y, c_v, c_mu)``."""
    tube, w, own = as_tube(y, v, cell, load)
    return of_conjugate(cell, tube_conjugate(y, w, tube, own, own_direction(cell, direction), load[2]))


@kernel
def uniform_tube(y, cell, load):
    """``(sqrt(G), T sqrt(G), L)`` of the cylinder of this place's radius."""
    own, square = own_load(cell, load, load[2]), cell[3] * cell[3]
    stretch, pull, at_rest = tube_uniform(y, (cell[0], cell[1], cell[2]), own, load[2])
    return stretch, square * pull, square * at_rest


@kernel
def tube_uniform(y, point, load, wall):
    """:func:`uniform_tube` of the tube of radius 1."""
    if len(wall) == 1:
        return membrane.uniform_tube(y, point, load)
    return physical.uniform_tube(y, point, load)


@kernel
def at_slope(y, v, cell, load):
    """``(room of the slope, tau alpha, tau beta)``, the multipliers in the reference tube's units."""
    own, square = own_load(cell, load, load[2]), cell[3] * cell[3]
    room, alpha, beta = tube_at_slope(y, slope(y, v, cell), (cell[0], cell[1], cell[2]), own, load[2])
    return room, square * alpha, square * beta


@kernel
def at_flux(y, flux, cell, load):
    """``(psi, G - 1, tau alpha, tau beta)`` where the flux -L_v is known."""
    own, square = own_load(cell, load, load[2]), cell[3] * cell[3]
    psi, G_1, alpha, beta = tube_at_flux(y, flux / (square * cell[3]), (cell[0], cell[1], cell[2]), own, load[2])
    return psi, G_1, square * alpha, square * beta

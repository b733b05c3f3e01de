"""The physics that the solver sees: one density of a pressurised tube and its fibers, at one point.

    L(y, v) = (p y^2 + f) s - e a w + m psi

of the source's tube (:mod:`membrane`, where everything is written down) or of the physical one (:mod:`physical`: a thick
wall, threads that cannot push). Which it is, is told by what ``load`` = (gamma, rubber, wall, p, f, m, e) carries:
``wall`` is (k,), or (k, inner, threads). ``cell`` is a point, three numbers (H, D, a), six of a body of revolution, which is
a change of variables (:mod:`body`); or it is a cell of a mesh (:mod:`..cells`), whose density, where fibers may go slack, is
its mean along the cell (:mod:`over_cell`). The length of a tuple is known when code is made: no kind of tube or cell costs
another one anything.
"""

from math import sqrt

from ...jit import kernel
from ..cells import as_expected, expecting, passed_on, point_of
from ..load import fibers_alone
from . import body, membrane, over_cell, physical
from .fibers import spares
from .first_integral import at_level, level_of, summed  # noqa: F401
from .membrane import (  # noqa: F401
    DRAWN_IN,
    ENERGY_ROUNDING,
    LAST_STEP,
    NO_ROOM,
    ROUNDING,
    WORK_STEP,
    fiber_multipliers,
    kinematics,
    locked_stretch,
    scales,
    strain_energy,
)
from .wall import has_two_families

LONGER = 1e-9  # relative: more than rounding, of lengths that the fibers allow


@kernel
def clamped(cell, gamma, wall):
    """G at the clamped ends, positive where fibers can meet them; fewer families than two always can."""
    if has_two_families(wall):
        return 1.0 + kinematics(1.0, cell, fibers_alone(gamma))[3]
    return 1.0 + 0.0 * cell[0]


@kernel
def drawn_in(cell, load):
    """The stretch below 1 from which a tube counts as drawn in."""
    if has_two_families(load.wall):
        return membrane.drawn_in(cell, load)
    return 1.0 - DRAWN_IN + 0.0 * cell[0]


@kernel
def longest(cell, gamma, wall):
    """The largest meridional stretch that the fibers allow, whatever pulls."""
    if has_two_families(wall):
        return membrane.longest(cell, gamma)
    t = cell[0] + cell[1]
    return gamma * sqrt(1.0 + t * t) + spares(wall)[0]


@kernel
def density(y, v, cell, load):
    """``(room, L_y, L_v, L_yy, L_yv, L_vv)``; a state is admissible where ``room`` is positive. Behind them, what is handed
    on, where something was handed to the cell.
    """
    return _density(y, v, cell, load, load.wall)


@kernel
def _density(y, v, cell, load, wall):
    if len(wall) == 1:
        return passed_on(cell, _density_at(y, v, point_of(cell), load, wall))
    if len(cell) == 3:
        return _density_at(y, v, cell, load, wall)
    if len(cell) == 6:
        return _density_at(y, v, cell, load, wall)
    return as_expected(cell, over_cell.density(y, v, expecting(y, cell), load))


@kernel
def _density_at(y, v, point, load, wall):
    tube, w, own = body.as_tube(y, v, point, load)
    if len(wall) == 1:
        return body.of_partials(point, membrane.density(y, w, tube, own))
    return body.of_partials(point, physical.density(y, w, tube, own))


@kernel
def density_beside(y, v, point, load, near):
    """:func:`density` of a tube that is the same all along, looked for from what a neighbour handed on; and what is handed
    on.
    """
    return _density_beside(y, v, point, load, near, load.wall)


@kernel
def _density_beside(y, v, point, load, near, wall):
    if len(wall) == 1:
        return membrane.density(y, v, point, load), membrane.handed_on(y, v, point, load)
    return physical.density_beside(y, v, point, load, near)


@kernel
def integrands(y, v, cell, load):
    """What the outputs integrate: axial length s, volume y^2 s, twist psi, strain energy a w; and the kind of state. Behind
    them, what is handed on, where something was handed to the cell.
    """
    return _integrands(y, v, cell, load, load.wall)


@kernel
def _integrands(y, v, cell, load, wall):
    if len(wall) == 1:
        return passed_on(cell, _integrands_at(y, v, point_of(cell), load, wall))
    if len(cell) == 3:
        return _integrands_at(y, v, cell, load, wall)
    if len(cell) == 6:
        return _integrands_at(y, v, cell, load, wall)
    return as_expected(cell, over_cell.integrands(y, v, expecting(y, cell), load))


@kernel
def _integrands_at(y, v, point, load, wall):
    tube, w, own = body.as_tube(y, v, point, load)
    if len(wall) == 1:
        return body.of_integrals(point, membrane.integrands(y, w, tube, own))
    return body.of_integrals(point, physical.integrands(y, w, tube, own))


@kernel
def conjugate(y, v, cell, load, direction):
    """``(c, c_y, c_v, c_mu)`` with c = dL/dmu along a change of load: what is held when that load is unknown."""
    return _conjugate(y, v, cell, load, direction, load.wall)


@kernel
def _conjugate(y, v, cell, load, direction, wall):
    if len(wall) == 1:
        return _conjugate_at(y, v, point_of(cell), load, direction, wall)
    if len(cell) == 3:
        return _conjugate_at(y, v, cell, load, direction, wall)
    if len(cell) == 6:
        return _conjugate_at(y, v, cell, load, direction, wall)
    return over_cell.conjugate(y, v, expecting(y, cell), load, direction)


@kernel
def _conjugate_at(y, v, point, load, direction, wall):
    tube, w, own = body.as_tube(y, v, point, load)
    change = body.own_direction(point, direction)
    if len(wall) == 1:
        return body.of_conjugate(point, membrane.conjugate(y, w, tube, own, change))
    return body.of_conjugate(point, physical.conjugate(y, w, tube, own, change))


@kernel
def uniform_tube(y, point, load):
    """``(sqrt(G), T sqrt(G), L)`` at slope 0: meridional stretch and resultant, and the density itself."""
    return _uniform_tube(y, point, load, load.wall)


@kernel
def _uniform_tube(y, point, load, wall):
    tube, _, own = body.as_tube(y, 0.0, point, load)
    if len(wall) == 1:
        return body.of_uniform(point, membrane.uniform_tube(y, tube, own))
    return body.of_uniform(point, physical.uniform_tube(y, tube, own))


@kernel
def at_slope(y, v, point, load):
    """``(room of the slope, tau alpha, tau beta)``, the multipliers of both families."""
    return _at_slope(y, v, point, load, load.wall)


@kernel
def _at_slope(y, v, point, load, wall):
    tube, w, own = body.as_tube(y, v, point, load)
    if len(wall) == 1:
        return body.of_multipliers(point, *membrane.at_slope(y, w, tube, own))
    return body.of_multipliers(point, *physical.at_slope(y, w, tube, own))


@kernel
def at_flux(y, flux, point, load):
    """``(psi, G - 1, tau alpha, tau beta)`` where the flux T v/s is known, and not the slope."""
    return _at_flux(y, flux, point, load, load.wall)


@kernel
def _at_flux(y, flux, point, load, wall):
    tube, _, own = body.as_tube(y, 0.0, point, load)
    along = body.own_flux(point, flux)
    if len(wall) == 1:
        psi, G_1, alpha, beta = membrane.at_flux(y, along, tube, own)
    else:
        psi, G_1, alpha, beta = physical.at_flux(y, along, tube, own)
    G_1, alpha, beta = body.of_multipliers(point, G_1, alpha, beta)
    return psi, G_1, alpha, beta

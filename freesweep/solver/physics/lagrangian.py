"""The physics that the solver sees: one density of a pressurised tube with two fiber families, at one point.

    L(y, v) = (p y^2 + f) s - e a w + m psi

of the source's tube (:mod:`membrane`, where everything is written down) or of the physical one (:mod:`physical`: a thick
wall, threads that cannot push). Which it is, is told by what ``load`` = (gamma, rubber, wall, p, f, m, e) carries:
``wall`` is (k,), or (k, inner, loose). ``cell`` = (H, D, a) is a point of a tube, six numbers are one of a body of
revolution (:mod:`body`); with the length h of a cell of a mesh behind, the density is that of the cell (:mod:`over_cell`);
with what the cell before handed on behind that, what the next one may have is answered, too. The length of a tuple is known
when code is made: none is for the others.
"""

from ...jit import kernel
from ..cells import nothing_yet
from . import body, membrane, over_cell, physical
from .membrane import (  # noqa: F401
    DRAWN_IN,
    ENERGY_ROUNDING,
    LAST_STEP,
    NO_ROOM,
    ROUNDING,
    WORK_STEP,
    drawn_in,
    fiber_multipliers,
    kinematics,
    locked_stretch,
    longest,
    scales,
    strain_energy,
)


@kernel
def alone(y, cell):
    """A cell with its length behind, to which nothing was handed on."""
    return (*cell, nothing_yet(0.0 * y))


@kernel
def density(y, v, cell, load):
    """``(room, L_y, L_v, L_yy, L_yv, L_vv)``; a state is admissible where ``room`` is positive."""
    return _density(y, v, cell, load, load[2])


@kernel
def _density(y, v, cell, load, wall):
    if len(wall) == 1:
        return _thin_density(y, v, cell, load)
    if len(cell) == 3:
        return physical.density(y, v, cell, load)
    if len(cell) == 6:
        return body.density(y, v, cell, load)
    if len(cell) == 4:
        return over_cell.density(y, v, alone(y, cell), load)[:6]
    if len(cell) == 7:
        return over_cell.density(y, v, alone(y, cell), load)[:6]
    return over_cell.density(y, v, cell, load)


@kernel
def _thin_density(y, v, cell, load):
    if len(cell) == 8:
        return (*body.density(y, v, (cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]), load), cell[7])
    if len(cell) > 5:
        return body.density(y, v, (cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]), load)
    if len(cell) == 5:
        return (*membrane.density(y, v, (cell[0], cell[1], cell[2]), load), cell[4])
    return membrane.density(y, v, (cell[0], cell[1], cell[2]), load)


@kernel
def uniform_tube(y, cell, load):
    """``(sqrt(G), T sqrt(G), L)`` at slope 0: meridional stretch and resultant, and the density itself."""
    return _uniform_tube(y, cell, load, load[2])


@kernel
def _uniform_tube(y, cell, load, wall):
    if len(cell) > 3:
        return body.uniform_tube(y, cell, load)
    if len(wall) == 1:
        return membrane.uniform_tube(y, cell, load)
    return physical.uniform_tube(y, cell, load)


@kernel
def integrands(y, v, cell, load):
    """What the outputs integrate: axial length s, volume y^2 s, twist psi, strain energy a w; and the kind of state."""
    return _integrands(y, v, cell, load, load[2])


@kernel
def _integrands(y, v, cell, load, wall):
    if len(wall) == 1:
        return _thin_integrands(y, v, cell, load)
    if len(cell) == 3:
        return physical.integrands(y, v, cell, load)
    if len(cell) == 6:
        return body.integrands(y, v, cell, load)
    if len(cell) == 4:
        return over_cell.integrands(y, v, alone(y, cell), load)[:5]
    if len(cell) == 7:
        return over_cell.integrands(y, v, alone(y, cell), load)[:5]
    return over_cell.integrands(y, v, cell, load)


@kernel
def _thin_integrands(y, v, cell, load):
    if len(cell) == 8:
        return (*body.integrands(y, v, (cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]), load), cell[7])
    if len(cell) > 5:
        return body.integrands(y, v, (cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]), load)
    if len(cell) == 5:
        return (*membrane.integrands(y, v, (cell[0], cell[1], cell[2]), load), cell[4])
    return membrane.integrands(y, v, (cell[0], cell[1], cell[2]), load)


@kernel
def conjugate(y, v, cell, load, direction):
    """``(c, c_y, c_v, c_mu)`` with c = dL/dmu along a change of load: what is held when that load is unknown."""
    return _conjugate(y, v, cell, load, direction, load[2])


@kernel
def _conjugate(y, v, cell, load, direction, wall):
    if len(wall) == 1:
        return _thin_conjugate(y, v, cell, load, direction)
    if len(cell) == 3:
        return physical.conjugate(y, v, cell, load, direction)
    if len(cell) == 6:
        return body.conjugate(y, v, cell, load, direction)
    return over_cell.conjugate(y, v, alone(y, cell), load, direction)


@kernel
def _thin_conjugate(y, v, cell, load, direction):
    if len(cell) > 4:
        return body.conjugate(y, v, (cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]), load, direction)
    return membrane.conjugate(y, v, (cell[0], cell[1], cell[2]), load, direction)


@kernel
def at_slope(y, v, cell, load):
    """``(room of the slope, tau alpha, tau beta)``, the multipliers of both families."""
    return _at_slope(y, v, cell, load, load[2])


@kernel
def _at_slope(y, v, cell, load, wall):
    if len(cell) > 3:
        return body.at_slope(y, v, cell, load)
    if len(wall) == 1:
        return membrane.at_slope(y, v, cell, load)
    return physical.at_slope(y, v, cell, load)


@kernel
def at_flux(y, flux, cell, load):
    """``(psi, G - 1, tau alpha, tau beta)`` where the flux T v/s is known, and not the slope."""
    return _at_flux(y, flux, cell, load, load[2])


@kernel
def _at_flux(y, flux, cell, load, wall):
    if len(cell) > 3:
        return body.at_flux(y, flux, cell, load)
    if len(wall) == 1:
        return membrane.at_flux(y, flux, cell, load)
    return physical.at_flux(y, flux, cell, load)

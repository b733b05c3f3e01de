"""What a cell of a mesh has at one place, r from its middle, where the :class:`physical.State` is known.

A function that another one is given stands in another module: Numba takes its own module's for an address of this process,
and keeps no such machine code on disk.
"""

from ...jit import kernel
from . import body, physical


@kernel
def partials_at(at, y, v, r, point, load, direction):
    """``(L_y, L_v, L_yy, L_yv, L_vv)`` of the place r from the middle, as what the cell is differentiated by."""
    _, w, own = body.as_tube(y, v, point, load)
    _, by_y, by_v, by_yy, by_yv, by_vv = body.of_partials(point, physical.partials(at, y, w, own))
    return by_y, by_v + r * by_y, by_yy, by_yv + r * by_yy, by_vv + 2.0 * r * by_yv + r * r * by_yy


@kernel
def integrands_at(at, y, v, r, point, load, direction):
    """Axial length, volume, twist, strain energy, and the kind."""
    tube, _, own = body.as_tube(y, v, point, load)
    return body.of_integrals(point, physical.integrals(at, y, tube, own))


@kernel
def conjugate_at(at, y, v, r, point, load, direction):
    """``(c, c_y, c_v, c_mu)`` as of :func:`physical.conjugate`, as what the cell is differentiated by; and a place kept."""
    _, w, _ = body.as_tube(y, v, point, load)
    c, c_y, c_v, c_mu = body.of_conjugate(point, physical.along(at, y, w, body.own_direction(point, direction)))
    return c, c_y, c_v + r * c_y, c_mu, 0.0 * c

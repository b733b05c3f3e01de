"""Changes of the active set of loose fibers that no mesh shows: between the clamped end and the middle of the first cell."""

from ...jit import kernel
from .. import lagrangian
from ..physical import kind_of
from .vector import get, mask_of


@kernel
def hidden(x, y, cell, load):
    """Where the kind of the first cell is not that at the clamped end."""
    return _hidden(x, y, cell, load, load[2])


@kernel
def _hidden(x, y, cell, load, wall):
    if len(wall) == 1:
        return mask_of(0)
    return at_end(x, y, cell, load)


@kernel
def at_end(x, y, cell, load):
    """:func:`hidden` of physical tubes."""
    if not load[2][2] > 0.0:
        return mask_of(0)
    h, v, middle = (
        get(x, 1) - get(x, 0),
        (get(y, 1) - get(y, 0)) / (get(x, 1) - get(x, 0)),
        0.5 * (get(y, 0) + get(y, 1)),
    )
    _, L_y, L_v, _, _, _ = lagrangian.density(middle, v, cell, load)
    _, alpha, beta = lagrangian.at_slope(middle, v, cell, load)
    _, _, alpha_end, beta_end = lagrangian.at_flux(get(y, 0), 0.5 * h * L_y - L_v, cell, load)
    first, end = kind_of(alpha > 0.0, beta > 0.0), kind_of(alpha_end > 0.0, beta_end > 0.0)
    return abs(first - end) > 0.5

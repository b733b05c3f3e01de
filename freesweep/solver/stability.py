"""Stability of a held state: the second variation on the whole tube, whichever half of it was solved."""

from ..jit import kernel
from . import held, lagrangian, newton
from .course import fill

ROUNDING = 4e-15  # of the sum over a fine mesh


@kernel
def unstable_directions(x, y, n, base, tube, load, direction, held_size, full, work):
    """Directions, symmetric or not, in which the energy falls while the held integral stays; and by how much the rounding
    of that integral, of size ``held_size`` but for what changes with y, moves its multiplier.

    ``full`` is scratch of shape (3, > 2 n), for the whole tube where only half of it was solved.
    """
    course, edges, cells, free, _, _ = tube
    count = 2 * n if free else n
    for i in range(n + 1):
        full[0, i], full[1, i] = x[i], y[i]
        if free:
            full[0, count - i], full[1, count - i] = 2.0 * x[n] - x[i], y[i]
    own = fill(course, edges, x, n, base, cells)  # half a tube is the same all along: one row
    g, d, e, inverse, b, response = work[0], work[1], work[2], work[3], work[8], work[9]
    for i in range(count + 1):
        work[7, i] = 0.0
    newton.assemble(lagrangian.density, full[0], full[1], count, own, load, False, work[7], work[6], g, d, e)
    negative = newton.factor(d, e, 1, count - 1, inverse)
    held.hold(lagrangian.conjugate, full[0], full[1], count, own, load, direction, b)
    newton.substitute(inverse, e, 1, count - 1, b, response)
    sigma = 0.0
    size = held_size
    for i in range(1, count):
        sigma += b[i] * response[i]
        size += abs(b[i])
    return negative - (1 if sigma < 0.0 else 0), ROUNDING * size / abs(sigma)

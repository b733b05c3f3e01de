"""Whether a state can be: the wall's tension, and the second variation of a held one on the whole tube, whichever half of it
was solved.
"""

from ..jit import kernel
from .cells import cell_at, level
from .numerics import held, newton
from .numerics.properties_along import fill
from .physics import lagrangian

ROUNDING = 4e-15  # of the sum over a fine mesh
PUSHED = 0.02  # share of its largest part to which the resultant p y^2 + f has fallen where a branch ends in it


@kernel
def pushed(y, cells, load):
    """Whether the meridional resultant p r^2 + f has all but vanished somewhere."""
    for i in range(len(y)):
        r = y[i] * level(y[i], cell_at(cells, i))[1]
        part = load.p * r * r
        if part + load.f < PUSHED * max(abs(part), abs(load.f)):
            return True
    return False


@kernel
def unstable_directions(x, y, n, base, tube, load, direction, held_size, is_wave, work):
    """Directions, symmetric or not, in which the energy falls while the held integral stays; and by how much the rounding
    of that integral, of size ``held_size`` but for what changes with y, moves its multiplier.

    Where half a tube was solved, its symmetric directions move the middle, its antisymmetric ones hold it and leave the
    integral as it is. Of these ``is_wave`` knows that there are none: y' of a tube that is the same all along is a Jacobi
    field, and where it vanishes in the middle alone, Sturm's theorem tells what a mesh may not see, as a wave between long
    uniform parts is moved along by next to nothing.
    """
    course, edges, cells, free, _, _ = tube
    own = fill(course, edges, x, n, base, cells)
    system, b, response = newton.system_in(work), work[8], work[9]
    d, e, inverse = system.d, system.e, system.inverse
    for i in range(n + 1):
        system.least[i] = 0.0
    newton.assemble(lagrangian.density, x, y, n, own, load, False, system)
    negative = newton.factor(d, e, 1, n - 1, inverse)
    last = n if free else n - 1
    if free:
        negative = newton.factor(d, e, 1, n, inverse) + (0 if is_wave else negative)
    _, k = held.hold(lagrangian.conjugate, x, y, n, own, load, direction, b)
    newton.substitute(inverse, e, 1, last, b, response)
    whole = 2.0 if free else 1.0
    sigma, size = whole * k, held_size
    for i in range(1, last + 1):
        sigma += whole * b[i] * response[i]
        size += whole * abs(b[i])
    return negative - (1 if sigma < 0.0 else 0), ROUNDING * size / abs(sigma)

"""Tubes that stay the undeformed cylinder under their loads, as blocked ones often do: derivatives in closed form.

The density is the same all along, and does not change with the sign of the slope; so a parameter moves the stretch y = 1 by

    L_vv dy'' = L_yy dy + L_ytheta,    dy = 0 at both ends,    k^2 = L_yy / L_vv,    K = k l / 2
    dy = c (1 - cosh k (x - l/2) / cosh K),    c = -L_ytheta / L_yy    in the mean: c (1 - tanh K / K)

with the tangent and the cosine where k^2 < 0: only what is held keeps such a tube from buckling, in waves that meshes would
have to resolve.
"""

import numpy as np

from .dual import Dual
from .physics import BY_V, BY_Y, OWN

STRAIGHT = 1e-8  # of the loads that balance


def at_cylinder(physics, count):
    """Outputs as dual numbers over ``count`` states, those of the loads of ``physics``, by name; and where (count,) they
    are: where the loads leave a cylinder as it is, and there are some.
    """
    ones, parts = np.ones(count), np.zeros((2, OWN + len(physics.parameters), 1))
    parts[0, BY_Y], parts[1, BY_V] = 1.0, 1.0
    y, v = Dual(ones, parts[0]), Dual(0.0 * ones, parts[1])
    _, L_y, L_v = physics.local(y, v, 0.5 * ones)
    rows, (cell, load) = _parts(L_y, count), physics.properties(0.5 * ones)
    size = sum(_size(number) for number in (load.p, load.f, load.m)) * (1.0 + _size(cell[0]) ** 2 + _size(cell[1]) ** 2)
    length = physics.length
    with np.errstate(all="ignore"):
        k2 = rows[BY_Y] / _parts(L_v, count)[BY_V]
        far = 0.5 * length.value * np.sqrt(np.abs(k2))
        mean, middle = (
            np.where(k2 > 0.0, np.tanh(far), np.tan(far)) / far,
            1.0 / np.where(k2 > 0.0, np.cosh(far), np.cos(far)),
        )
        moved = -rows / rows[BY_Y]
        there = (np.abs(L_y.value) <= STRAIGHT * size) & np.isfinite(k2) & np.isfinite(mean)
    moved[:OWN] = 0.0
    made = []
    for q in physics.integrands(y, v, 0.5 * ones):
        own = _parts(q, count)
        by = own + own[BY_Y] * moved * (1.0 - mean)
        by[:OWN] = 0.0
        made.append(length * Dual(np.broadcast_to(q.value, count), by))
    return physics.outputs(made, Dual(ones, moved * (1.0 - middle)), half=False), there


def _parts(number, count):
    return np.broadcast_to(number.parts, (len(number.parts), count)).copy()


def _size(number):
    return np.abs(number.value if isinstance(number, Dual) else number)

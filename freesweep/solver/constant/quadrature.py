"""The integrals along the meridian of a tube with a neck, by quadrature; nodes are doubled as the meshes of
:mod:`..numerics.nested` are.
"""

from math import exp

from ...jit import kernel
from ..numerics import error_bounds
from ..physics import lagrangian

ROWS = 4  # quadratures, each with twice the nodes of the one before
CAUTION = 2.0  # times the bounds: their third order is not quite nothing
ROUNDING = 2e-10  # scaled: what the uniform stretch's last digit makes near the middle


@kernel
def integrate(cell, load, u, rate, half, total, nodes, curve, row):
    """Integrals along the ``curve``, and from its end at ``total`` on along the uniform tube, which the middle approaches as
    exp(-rate x).
    """
    length, volume, twist, energy = 0.0, 0.0, 0.0, 0.0
    for k in range(nodes):
        h = curve[0, k + 1] - curve[0, k]
        s, v, t, w, _ = lagrangian.integrands(curve[4, k], 0.0, cell, load)
        length += h * s * curve[3, k]
        volume += h * v * curve[3, k]
        twist += h * t
        energy += h * w
    s, v, t, w, _ = lagrangian.integrands(u, 0.0, cell, load)
    rest = half - total
    row[0], row[1], row[2], row[3] = length + rest * s, volume + rest * v, twist + rest * t, energy + rest * w
    row[error_bounds.MIDDLE], row[error_bounds.MULTIPLIER] = u + (curve[1, nodes] - u) * exp(-rate * rest), 0.0


@kernel
def finish(table, out):
    """Values and bounds from the quadratures; the largest scaled bound."""
    largest = CAUTION * error_bounds.extrapolate(table, ROWS - 1, out[2], out[3], False, out[0], out[1])
    for k in range(error_bounds.OUTPUTS):
        out[1, k] = CAUTION * out[1, k] + ROUNDING * out[2, k]
    return largest

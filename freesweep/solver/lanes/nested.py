"""What nested meshes are made with, for a vector of designs: derivatives of the source's tubes take them (:mod:`slopes`)."""

from ...jit import kernel
from ..physics import lagrangian
from . import mesh
from .vector import get, put, spread

OUTPUTS = 5  # length, volume, twist, energy, middle stretch
MIDDLE = 4
LANE_DOUBLINGS = 6  # of the base mesh
EARLY = 2.2  # of bounds that no third extrapolation confirms


@kernel
def integrate(x, y, n, cell, load, row):
    """Integrals over the tube on one mesh, and the stretch in the middle."""
    length, volume, twist, energy = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    x_left, y_left = get(x, 0), get(y, 0)
    for j in range(n):
        x_right, y_right = get(x, j + 1), get(y, j + 1)
        h = x_right - x_left
        s, v, t, w, _ = lagrangian.integrands(0.5 * (y_left + y_right), (y_right - y_left) / h, cell, load)
        length = length + h * s
        volume = volume + h * v
        twist = twist + h * t
        energy = energy + h * w
        x_left, y_left = x_right, y_right
    put(row, 0, length)
    put(row, 1, volume)
    put(row, 2, twist)
    put(row, 3, energy)
    put(row, 4, y_left)


@kernel
def foresee(half_x, half_y, x, y, n, fine_x, fine_y, change, both):
    """First guess on twice as many cells: the solution on n cells, carried on by the change from n/2 cells, which doubling
    the cells will repeat at a quarter.
    """
    for i in range(n // 2 + 1):
        put(change, i, 0.25 * (get(y, 2 * i) - get(half_y, i)))
    mesh.prolong(half_x, change, n // 2, x, both)
    for i in range(n + 1):
        put(both, i, get(both, i) + get(y, i))
    mesh.prolong(x, both, n, fine_x, fine_y)

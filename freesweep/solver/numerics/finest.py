"""The three finest meshes of a solved state, as the solver leaves them in scratch of shape (5, > 2 n): (x, y) of the last in
rows 0, 1, of the two before, one behind the other, in rows 2, 4. Row 3 holds, for each of them, by how much its pressure,
force and torque differ from the load at last: where something is held, the multiplier changes from mesh to mesh; and the
relative error that Newton's last steps left.
"""

from ...jit import kernel
from ..load import under

MESHES = 3
LEFT = 3 * MESHES  # the place of that error


@kernel
def mesh_of(which, n, fine):
    """Nodes and shape of the finest mesh (0), the one before (1), of n cells, and the one before that (2)."""
    if which == 0:
        return fine[0, 0 : 2 * n + 1], fine[1, 0 : 2 * n + 1]
    if which == 1:
        return fine[2, 0 : n + 1], fine[4, 0 : n + 1]
    return fine[2, n + 1 : n + 2 + n // 2], fine[4, n + 1 : n + 2 + n // 2]


@kernel
def load_of(which, load, fine):
    """The load of one of the meshes."""
    k = 3 * which
    return under(load, load.p + fine[3, k], load.f + fine[3, k + 1], load.m + fine[3, k + 2])


@kernel
def leave_loads(multipliers, level, multiplier, direction, left, fine):
    """Loads of the meshes from their ``multipliers`` of a direction, the finest's at ``level``, and the one at last."""
    fine[3, LEFT] = left
    for which in range(MESHES):
        change, k = multipliers[level - which] - multiplier, 3 * which
        fine[3, k], fine[3, k + 1], fine[3, k + 2] = change * direction.p, change * direction.f, change * direction.m

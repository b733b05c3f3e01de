"""What a shape looks like along the tube: node values of the finest meshes, extrapolated."""

from . import lagrangian
from .jit import kernel


@kernel
def store_profile(profile, base_cells, doublings, cells, load, fine):
    """Write node, stretch, axial position and twist (in radii and radians, from the end) into ``profile``, (4, m).

    The nodes are those of the finer but one mesh; values on it and on the finest extrapolate to fourth order. Returns
    the number of nodes; 0 where ``m`` is 0.
    """
    if profile.shape[1] == 0:
        return 0
    n = base_cells << (doublings - 1)
    x2, y2, x1, y1 = fine[0], fine[1], fine[2], fine[3]
    last = len(cells) - 1
    near, far, near_twist, far_twist = 0.0, 0.0, 0.0, 0.0
    for k in range(n + 1):
        if k > 0:
            h = x1[k] - x1[k - 1]
            s, _, twist, _ = lagrangian.integrands(
                0.5 * (y1[k - 1] + y1[k]), (y1[k] - y1[k - 1]) / h, cells[min(k - 1, last)], load
            )
            near += h * s
            near_twist += h * twist
            for j in range(2 * k - 2, 2 * k):
                h = x2[j + 1] - x2[j]
                s, _, twist, _ = lagrangian.integrands(
                    0.5 * (y2[j] + y2[j + 1]), (y2[j + 1] - y2[j]) / h, cells[min(j, last)], load
                )
                far += h * s
                far_twist += h * twist
        profile[0, k] = x1[k]
        profile[1, k] = (4.0 * y2[2 * k] - y1[k]) / 3.0
        profile[2, k] = (4.0 * far - near) / 3.0
        profile[3, k] = (4.0 * far_twist - near_twist) / 3.0
    return n + 1

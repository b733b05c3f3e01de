"""Fibers that would have to push: where a state relies on them, physics does not stand behind it."""

from ..jit import kernel
from . import lagrangian
from .course import fill
from .mesh import cell_at

TENSIONLESS = 1e-9  # of the load: a fiber family without tension does not push
TENSIONLESS_END = 1e-3  # at a clamped end, where the slope is carried on from the cells beside


@kernel
def slack_fibers(x, y, n, base, tube, load):
    """Bit 1: the alpha family would have to push somewhere; bit 2: the beta family."""
    course, edges, cells, free, _, _ = tube
    own = fill(course, edges, x, n, base, cells)
    flag = 0
    for j in range(-1, n + 1):
        if 0 <= j < n:
            v, middle = (y[j + 1] - y[j]) / (x[j + 1] - x[j]), 0.5 * (y[j] + y[j + 1])
        elif j == n and free:
            continue
        else:  # a clamped end itself, with the slope carried on from the two cells next to it
            i, k = (0, 1) if j < 0 else (n - 1, n - 2)
            near, after = (y[i + 1] - y[i]) / (x[i + 1] - x[i]), (y[k + 1] - y[k]) / (x[k + 1] - x[k])
            h = x[i + 1] - x[i]
            v, middle = near + (near - after) * h / (h + x[k + 1] - x[k]), y[0 if j < 0 else n]
        cell = cell_at(own, min(max(j, 0), n - 1))
        if v * v < 1.0 + lagrangian.kinematics(middle, cell, load)[3]:
            alpha, beta = lagrangian.fiber_multipliers(middle, v, cell, load)
            least = -(TENSIONLESS if 0 <= j < n else TENSIONLESS_END) * (load[3] + abs(load[4]))
            flag |= (1 if alpha < least else 0) | (2 if beta < least else 0)
    return flag

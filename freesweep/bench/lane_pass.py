"""The cost of a Newton pass on vectors of designs, as sweeps make it."""

import numpy as np

from ..jit import kernel
from ..solver.lanes.newton import eliminate, substitute
from ..solver.lanes.pack import aligned
from ..solver.lanes.vector import WIDTH, get, mask_of, spread
from ..solver.load import Load
from ..solver.physics import lagrangian
from .peak import CELLS, LOAD, PASSES, RUBBER, TUBE, median_time

EXTRA = 47  # flops of a cell beside its density: lanes.newton.eliminate, substitute


@kernel
def lane_passes(count, x, y, columns, work):
    """That many Newton passes at the same state."""
    n = len(x) - 1
    cell = (get(columns, 0), get(columns, 1), get(columns, 2))
    load = Load(
        get(columns, 3), (get(columns, 4),), (get(columns, 5),), get(columns, 6), get(columns, 7), get(columns, 8),
        get(columns, 9),
    )  # fmt: skip
    rest, none = spread(0.0), mask_of(0)
    for _ in range(count):
        last = eliminate(lagrangian.density, x, y, work[0], rest, none, n, True, cell, load, work[1], work[2], work[3])[
            4
        ]
        substitute(y, work[0], rest, n, none, work[1], work[2], work[3], last)


def lane_cell_time(repeats=5) -> float:
    """Seconds for one cell of one design in one Newton pass on vectors."""
    shapes, work, columns = aligned(2, CELLS + 1), aligned(4, CELLS + 2), aligned(1, 10)[0]
    work[:] = 0.0
    x = np.linspace(0.0, 10.0, CELLS + 1)
    shapes[0], shapes[1] = x[:, None], 1.0 + 0.2 * (1.0 - np.exp(-x))[:, None]
    columns[:] = np.array([*TUBE, LOAD[0], RUBBER[0], *LOAD[2], *LOAD[3:]])[:, None]
    return median_time(lane_passes, repeats, shapes[0], shapes[1], columns, work) / (PASSES * CELLS * WIDTH)

"""The cost of the density at one place in vectors of designs, as sweeps ask it."""

import numpy as np

from ..jit import kernel
from ..solver.lanes.pack import aligned
from ..solver.lanes.vector import WIDTH, get, put, spread
from ..solver.load import Load
from ..solver.physics import lagrangian
from .peak import CELLS, LOAD, PASSES, RUBBER, TUBE, median_time

EXTRA = 6  # flops of a place beside its density: its derivatives are added up


@kernel
def lane_densities(count, y, columns, total):
    """That many times the density at all places."""
    cell = (get(columns, 0), get(columns, 1), get(columns, 2))
    load = Load(
        get(columns, 3), (get(columns, 4),), (get(columns, 5),), get(columns, 6), get(columns, 7), get(columns, 8),
        get(columns, 9),
    )  # fmt: skip
    for _ in range(count):
        for i in range(len(y)):
            room, L_y, L_v, L_yy, L_yv, L_vv = lagrangian.density(get(y, i), spread(0.1), cell, load)
            put(total, 0, get(total, 0) + (room + L_y + L_v + L_yy + L_yv + L_vv))


def lane_density_time(repeats=5) -> float:
    """Seconds for the density of one design at one place, in vectors."""
    y, columns, total = aligned(1, CELLS)[0], aligned(1, 10)[0], aligned(1, 1)[0]
    y[:] = 1.0 + 0.2 * (1.0 - np.exp(-np.linspace(0.0, 10.0, CELLS)))[:, None]
    columns[:] = np.array([*TUBE, LOAD[0], RUBBER[0], *LOAD[2], *LOAD[3:]])[:, None]
    return median_time(lane_densities, repeats, y, columns, total) / (PASSES * CELLS * WIDTH)

"""The one path of loads on which a free state lies, whatever pressures are asked for (theory, section 7).

From the undeformed cylinder pressure, force, torque and fiber extension - 1 rise in proportion, to the full loads at the
*settling pressure*; from there the pressure alone rises or falls. Without loads and extension
there is the pressure only.

The settling pressure is the least at which the way there holds: twice what balances an axial compression, so that the
meridional resultant p y^2 + f stays a tension while the tube is drawn in to 0.7; and as large as the torque and the fibers'
extension in their own units, so that neither turns or swells a tube that has no pressure to keep it round. A tube that is
pulled needs none: the weight is hung on first.
"""

import numpy as np

from .branch import FORCE, GAMMA, TORQUE


def is_loaded(problems) -> np.ndarray:
    """Whether each problem has loads or extended fibers: (n,) of bool."""
    return (problems[:, FORCE] != 0.0) | (problems[:, TORQUE] != 0.0) | (problems[:, GAMMA] != 1.0)


def settling_pressure(problems) -> np.ndarray:
    """Pressure p = P/C10 at which each problem's loads have come to their full size: (n,)."""
    return np.maximum.reduce(
        [2.0 * np.maximum(-problems[:, FORCE], 0.0), np.abs(problems[:, TORQUE]), problems[:, GAMMA] ** 2 - 1.0]
    )

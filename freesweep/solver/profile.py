"""What a shape looks like along the tube: values at stations, from the node values of the finest meshes."""

from math import sqrt

from . import lagrangian
from .jit import kernel
from .mesh import cell_at

FIELDS = 7  # stretch, axial position, twist, tangents of the deformed angles, fiber multipliers
STENCIL = 6  # nodes of the interpolating polynomial: its error is of sixth order, the node values' of fourth


@kernel
def extrapolate_nodes(base_cells, doublings, cells, load, fine, nodes):
    """Stretch, axial position and twist at the nodes of the finer but one mesh, to fourth order; their number.

    ``nodes`` is (3, m), in radii and radians from the end.
    """
    n = base_cells << (doublings - 1)
    x2, y2, x1, y1 = fine[0], fine[1], fine[2], fine[4]
    near, far, near_twist, far_twist = 0.0, 0.0, 0.0, 0.0
    for k in range(n + 1):
        if k > 0:
            h = x1[k] - x1[k - 1]
            s, _, twist, _ = lagrangian.integrands(
                0.5 * (y1[k - 1] + y1[k]), (y1[k] - y1[k - 1]) / h, cell_at(cells, k - 1), load
            )
            near += h * s
            near_twist += h * twist
            for j in range(2 * k - 2, 2 * k):
                h = x2[j + 1] - x2[j]
                s, _, twist, _ = lagrangian.integrands(
                    0.5 * (y2[j] + y2[j + 1]), (y2[j + 1] - y2[j]) / h, cell_at(cells, j), load
                )
                far += h * s
                far_twist += h * twist
        nodes[0, k] = (4.0 * y2[2 * k] - y1[k]) / 3.0
        nodes[1, k] = (4.0 * far - near) / 3.0
        nodes[2, k] = (4.0 * far_twist - near_twist) / 3.0
    return n + 1


@kernel
def weights(x, first, at, value, slope):
    """Lagrange weights of STENCIL nodes from ``first`` on, for the value and for the slope at ``at``."""
    for i in range(STENCIL):
        value[i], slope[i] = 1.0, 0.0
        for k in range(STENCIL):
            if k != i:
                gap = x[first + i] - x[first + k]
                slope[i] = slope[i] * (at - x[first + k]) / gap + value[i] / gap
                value[i] *= (at - x[first + k]) / gap


@kernel
def at_stations(stations, base_cells, doublings, cells, load, fine, nodes, profile):
    """Write the FIELDS at each of ``stations`` (distance from the end in radii, ascending) into ``profile`` (FIELDS, m).

    Fields: stretch, axial position [radius], twist [rad], tan(alpha'), tan(beta'), and the multipliers of both families.
    """
    count = extrapolate_nodes(base_cells, doublings, cells, load, fine, nodes)
    x = fine[2]
    value, slope = nodes[3], nodes[4]
    gamma = load[0]
    j = 0
    for i in range(len(stations)):
        while j < count - 2 and x[j + 1] < stations[i]:
            j += 1
        first = min(max(j - STENCIL // 2 + 1, 0), count - STENCIL)
        weights(x, first, stations[i], value, slope)
        y, v, z, twist = 0.0, 0.0, 0.0, 0.0
        for k in range(STENCIL):
            y += value[k] * nodes[0, first + k]
            v += slope[k] * nodes[0, first + k]
            z += value[k] * nodes[1, first + k]
            twist += value[k] * nodes[2, first + k]
        cell = cell_at(cells, j)
        psi, _, _, G_1, _, _ = lagrangian.kinematics(y, cell, load)
        meridional = sqrt(1.0 + G_1)
        v = min(max(v, -(1.0 - 1e-12) * meridional), (1.0 - 1e-12) * meridional)
        profile[0, i], profile[1, i], profile[2, i] = y, z, twist
        profile[3, i] = y * (cell[0] + cell[1] + psi) / meridional
        profile[4, i] = y * (cell[0] - cell[1] + psi) / meridional
        alpha, beta = lagrangian.fiber_multipliers(y, v, cell, load)
        profile[5, i], profile[6, i] = gamma * alpha, gamma * beta


@kernel
def rest_profile(stations, cell, profile):
    """The FIELDS of the undeformed tube."""
    for i in range(len(stations)):
        profile[0, i], profile[1, i], profile[2, i] = 1.0, stations[i], 0.0
        profile[3, i], profile[4, i] = cell[0] + cell[1], cell[0] - cell[1]
        profile[5, i], profile[6, i] = 0.0, 0.0

"""What a shape looks like along the tube: values at stations, from the node values of the finest meshes."""

from math import sqrt

from ..jit import kernel
from . import lagrangian
from .course import at_point, fill
from .mesh import cell_at

FIELDS = 7  # stretch, axial position, twist, tangents of the deformed angles, fiber multipliers
STENCIL = 6  # nodes of the interpolating polynomial: its error is of sixth order, the node values' of fourth


@kernel
def extrapolate_nodes(base_cells, doublings, tube, load, fine, nodes):
    """Stretch, axial position and twist at the nodes of the finer but one mesh, to fourth order; their number.

    ``nodes`` is (3, m), in radii and radians from the end.
    """
    n = base_cells << (doublings - 1)
    course, edges, cells, _, _, _ = tube
    for mesh in range(2):  # the coarser one, then the finer
        count = n << mesh
        x, y = (fine[2], fine[4]) if mesh == 0 else (fine[0], fine[1])
        own = fill(course, edges, x, count, base_cells, cells)
        share = -1.0 / 3.0 if mesh == 0 else 4.0 / 3.0
        length, twist = 0.0, 0.0
        for j in range(count + 1):
            if j > 0:
                h = x[j] - x[j - 1]
                s, _, t, _ = lagrangian.integrands(
                    0.5 * (y[j - 1] + y[j]), (y[j] - y[j - 1]) / h, cell_at(own, j - 1), load
                )
                length += h * s
                twist += h * t
            k = j >> mesh
            if j == k << mesh:
                nodes[0, k] = share * y[j] + (nodes[0, k] if mesh > 0 else 0.0)
                nodes[1, k] = share * length + (nodes[1, k] if mesh > 0 else 0.0)
                nodes[2, k] = share * twist + (nodes[2, k] if mesh > 0 else 0.0)
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
def at_stations(stations, base_cells, doublings, tube, load, fine, nodes, profile):
    """Write the FIELDS at each of ``stations`` (distance from the end in radii, ascending) into ``profile`` (FIELDS, m).

    Fields: stretch, axial position [radius], twist [rad], tan(alpha'), tan(beta'), and the multipliers of both families.
    """
    extrapolate_nodes(base_cells, doublings, tube, load, fine, nodes)
    course, edges, _, _, _, _ = tube
    x = fine[2]
    value, slope = nodes[3], nodes[4]
    gamma = load[0]
    factor = 1 << (doublings - 1)
    segment, j = 0, 0
    for i in range(len(stations)):
        # a station on a jump belongs to the segment before it
        while segment < len(edges) - 2 and x[edges[segment + 1] * factor] < stations[i]:
            segment += 1
        low, high = edges[segment] * factor, edges[segment + 1] * factor
        j = max(j, low)
        while j < high - 1 and x[j + 1] < stations[i]:
            j += 1
        first = min(max(j - STENCIL // 2 + 1, low), high + 1 - STENCIL)
        weights(x, first, stations[i], value, slope)
        y, v, z, twist = 0.0, 0.0, 0.0, 0.0
        for k in range(STENCIL):
            y += value[k] * nodes[0, first + k]
            v += slope[k] * nodes[0, first + k]
            z += value[k] * nodes[1, first + k]
            twist += value[k] * nodes[2, first + k]
        cell = at_point(course, segment, (stations[i] - x[low]) / (x[high] - x[low]))
        psi, _, _, G_1, _, _ = lagrangian.kinematics(y, cell, load)
        meridional = sqrt(1.0 + G_1)
        v = min(max(v, -(1.0 - 1e-12) * meridional), (1.0 - 1e-12) * meridional)
        profile[0, i], profile[1, i], profile[2, i] = y, z, twist
        profile[3, i] = y * (cell[0] + cell[1] + psi) / meridional
        profile[4, i] = y * (cell[0] - cell[1] + psi) / meridional
        alpha, beta = lagrangian.fiber_multipliers(y, v, cell, load)
        profile[5, i], profile[6, i] = gamma * alpha, gamma * beta

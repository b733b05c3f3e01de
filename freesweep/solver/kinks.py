"""Where the density changes its kind inside a cell: what the midpoint misses there, and how it moves the solution.

Across a place xi where L is C1 but not C2, L_y, L_v and the integrands bend: their slopes along the tube jump by D. Between
the middles of two cells lies one node, at the distance delta from xi; up to there a midpoint takes the wrong side for
granted, and the integral of what bends lacks ``D delta^2/2``. That has no order: on nested meshes it is now more, now less,
and for a node close to xi the same on all of them, so that no extrapolation sees it. It is added here, to the integrals and,
as a force on the node, to the equations, whose solution moves by H^-1 times that. The rest falls with the cube of the cell.
"""

from ..jit import kernel
from . import mesh

BISECTIONS = 30


@kernel
def is_edge(j, n, edges):
    """Whether node ``j`` of n cells parts two segments, whose densities differ anyway."""
    base = edges[len(edges) - 1]
    for s in range(1, len(edges) - 1):
        if j * base == edges[s] * n:
            return True
    return False


@kernel
def between(x, y, j, share, cells):
    """Stretch, slope and cell, a ``share`` of the way from the middle of the cell before node ``j`` to that behind."""
    before, after = (y[j] - y[j - 1]) / (x[j] - x[j - 1]), (y[j + 1] - y[j]) / (x[j + 1] - x[j])
    low, high = 0.5 * (y[j - 1] + y[j]), 0.5 * (y[j] + y[j + 1])
    one, other = mesh.cell_at(cells, j - 1), mesh.cell_at(cells, j)
    cell = (
        one[0] + share * (other[0] - one[0]), one[1] + share * (other[1] - one[1]), one[2] + share * (other[2] - one[2])
    )  # fmt: skip
    return low + share * (high - low), before + share * (after - before), cell


@kernel
def place(integrands, x, y, j, kind, cells, load):
    """Where the ``kind`` of the cell before node ``j`` ends, on the way to the middle of the one behind."""
    low, high = 0.0, 1.0
    for _ in range(BISECTIONS):
        share = 0.5 * (low + high)
        here, v, cell = between(x, y, j, share, cells)
        if integrands(here, v, cell, load)[4] == kind:
            low = share
        else:
            high = share
    first, last = 0.5 * (x[j - 1] + x[j]), 0.5 * (x[j] + x[j + 1])
    return first + low * (last - first)


@kernel
def slopes(density, integrands, x, y, j, cells, load):
    """Slopes along the tube, from the middle of cell j to that of the next, of L_y, L_v and the four integrands."""
    h, then = x[j + 1] - x[j], x[j + 2] - x[j + 1]
    way = 0.5 * (h + then)
    here, v, cell = 0.5 * (y[j] + y[j + 1]), (y[j + 1] - y[j]) / h, mesh.cell_at(cells, j)
    there, u, other = 0.5 * (y[j + 1] + y[j + 2]), (y[j + 2] - y[j + 1]) / then, mesh.cell_at(cells, j + 1)
    _, a_y, a_v, _, _, _ = density(here, v, cell, load)
    _, b_y, b_v, _, _, _ = density(there, u, other, load)
    a, b = integrands(here, v, cell, load), integrands(there, u, other, load)
    return (
        (b_y - a_y) / way, (b_v - a_v) / way, (b[0] - a[0]) / way, (b[1] - a[1]) / way, (b[2] - a[2]) / way,
        (b[3] - a[3]) / way,
    )  # fmt: skip


@kernel
def lacking(density, integrands, x, y, n, edges, j, kind, cells, load):
    """What L_y, L_v and the four integrals lack at node ``j``, where cells of this ``kind`` end, as a tuple, xi last;
    nothing where no slopes can be seen, or segments meet.
    """
    if not 2 <= j < n - 1 or is_edge(j, n, edges):
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, x[j]
    xi = place(integrands, x, y, j, kind, cells, load)
    left = slopes(density, integrands, x, y, j - 2, cells, load)
    right = slopes(density, integrands, x, y, j, cells, load)
    half = 0.5 * (xi - x[j]) * (xi - x[j])
    return (
        half * (right[0] - left[0]), half * (right[1] - left[1]), half * (right[2] - left[2]), half * (right[3] - left[3]),
        half * (right[4] - left[4]), half * (right[5] - left[5]), xi,
    )  # fmt: skip


@kernel
def missed(density, integrands, x, y, n, edges, cells, load, force):
    """What the four integrals lack, as a tuple, and the gradient of J, into ``force``."""
    length, volume, twist, energy, before = 0.0, 0.0, 0.0, 0.0, -1.0
    for i in range(n + 1):
        force[i] = 0.0
    for j in range(n):
        here, v, cell = 0.5 * (y[j] + y[j + 1]), (y[j + 1] - y[j]) / (x[j + 1] - x[j]), mesh.cell_at(cells, j)
        kind = integrands(here, v, cell, load)[4]
        if kind != before and j > 0:
            by_y, by_v, s, volume_of, turn, w, xi = lacking(density, integrands, x, y, n, edges, j, before, cells, load)
            length += s
            volume += volume_of
            twist += turn
            energy += w
            force[j] += by_y
            i = j - 1 if xi < x[j] else j
            by_v /= x[i + 1] - x[i]
            force[i] -= by_v
            force[i + 1] += by_v
        before = kind
    return length, volume, twist, energy

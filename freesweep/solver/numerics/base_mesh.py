"""The base mesh of nested ones: its nodes moved to where the solution bends, and where no mesh hides a change of kind; and
the finer meshes, each cell of which is halved.
"""

from ...jit import kernel
from . import kinks, newton
from . import mesh as grading
from .properties_along import fill


@kernel
def adapt(functional, x, y, n, tube, load, work):
    """Move the nodes of the base mesh to where the solution bends, and carry the solution over, eased where that leaves a
    cell no room; returns whether it is admissible there.
    """
    course, edges, cells, free, _, _ = tube
    density, integrands = functional.density, functional.integrands
    own = fill(course, edges, x, n, n, cells)
    cosine, rate, nodes, new_x, new_y, least = work[1], work[2], work[3], work[4], work[5], work[7]
    for s in range(len(edges) - 1):  # each segment keeps its nodes: the jumps between them stay on the mesh
        a, b = edges[s], edges[s + 1]
        here = own[a:b] if len(own) > 1 else own
        symmetric = free and s == len(edges) - 2
        grading.turning(integrands, x[a : b + 1], y[a : b + 1], b - a, symmetric, here, load, work, rate)
        grading.node_density(x[a : b + 1], b - a, rate, nodes)
        grading.regrade(x[a : b + 1], y[a : b + 1], nodes, b - a, b - a, new_x[a : b + 1], new_y[a : b + 1], work[6])
    own = fill(course, edges, new_x, n, n, cells)
    fits = newton.admissible(density, new_x, new_y, n, own, load)
    if free and not fits:
        grading.least_between(x, cosine, n, new_x, least)
        grading.ease(integrands, new_x, new_y, n, least, own, load)
        fits = newton.admissible(density, new_x, new_y, n, own, load)
    for i in range(n + 1):
        x[i], y[i] = new_x[i], new_y[i]
    return fits


@kernel
def move_on(density, room, tube, hidden, found, level, load, kept):
    """Move the base mesh, so that it does not hide where the kind of cell changes, see :mod:`kinks`; its nodes and shape
    before are ``kept``. Whether all cells have room then; else it is as it was.
    """
    x, y, n, edges = room.x, room.y, len(room.x) - 1, tube.edges
    for i in range(n + 1):
        kept[0, i], kept[1, i] = x[i], y[i]
    kinks.move_on(x, y, edges, hidden, found, level - 3)
    fits = newton.admissible(density, x, y, n, fill(tube.course, edges, x, n, n, tube.cells), load)
    for i in range(n + 1):
        x[i], y[i] = (x[i], y[i]) if fits else (kept[0, i], kept[1, i])
    return fits


@kernel
def split(x, n, edges, factor, out):
    """A finer mesh: each cell of the base mesh in ``factor``, smoothly within each segment."""
    for s in range(len(edges) - 1):
        a, b = edges[s], edges[s + 1]
        grading.split(x[a : b + 1], b - a, factor, out[a * factor : b * factor + 1])


@kernel
def foresee(fine, n, work):
    """First guess in row 1 of ``fine`` on twice as many cells, whose nodes are in row 0: the solution on n cells (rows 2,
    4), carried on by the change from n/2 cells (row 3), which doubling the cells will repeat at a quarter.
    """
    half_x, change, both = work[0], work[1], work[2]
    for i in range(n // 2 + 1):
        half_x[i] = fine[2, 2 * i]
        change[i] = 0.25 * (fine[4, 2 * i] - fine[3, i])
    grading.prolong(half_x, change, n // 2, fine[2], both)
    for i in range(n + 1):
        both[i] += fine[4, i]
    grading.prolong(fine[2], both, n, fine[0], fine[1])


@kernel
def go_finer(x, n, edges, doublings, fine, work):
    """Nodes and first guess of the next finer mesh in rows 0, 1 of ``fine``, which hold the solution on this one, after so
    many ``doublings`` of the base mesh ``x``; row 3 holds that on the coarser one, which becomes the last of three.
    """
    count = n << doublings
    for i in range(count // 2 + 1):
        fine[2, count + 1 + i], fine[4, count + 1 + i] = fine[0, 2 * i], fine[3, i]
    for i in range(count + 1):
        fine[2, i], fine[4, i] = fine[0, i], fine[1, i]
    split(x, n, edges, 2 << doublings, fine[0])
    foresee(fine, count, work)
    for i in range(count + 1):
        fine[3, i] = fine[4, i]

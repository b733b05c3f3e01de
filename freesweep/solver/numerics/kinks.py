"""Where the kind of cell changes along a mesh, and base meshes that do not hide how far from there they have it.

A mesh has a change of kind at a node, the nearest one as a rule, and results err by how far off that is. From mesh to mesh
it is another share of a cell, so the results differ, and tell. But a change close by a node of the coarsest mesh all of them
have at that node: they converge, to fourth order, as if it were there. Then nodes are moved on by a third of a cell: on all
finer meshes that change is a third or two thirds of a cell from a node.
"""

from ...jit import kernel

MOST = 8  # changes that are looked for; two or four is what a tube has
MESHES = 4  # that outputs and bounds are extrapolated from
STEP = 1.0 / 3.0  # of a cell


@kernel
def forget(changes, count):
    """Leave the first ``count`` changes of a mesh."""
    for k in range(count, MOST):
        changes[k] = 0.0


@kernel
def has(changes, place):
    """Whether a change is there."""
    found = False
    for k in range(MOST):
        found = found or changes[k] == place
    return found


@kernel
def hidden(changes, level, edges):
    """The place, in cells of the base mesh, of a change that the meshes up to this ``level`` have at one node; 0: there is
    none. ``changes`` (levels, MOST) are shares of the cells. Where a segment ends the kind may jump.
    """
    base = edges[len(edges) - 1]
    for k in range(MOST):
        place = changes[level, k]
        stays = place > 0.0
        for before in range(1, MESHES):
            stays = stays and has(changes[level - before], place)
        for edge in edges:
            stays = stays and place != edge / base
        if stays:
            return place * base
    return 0.0


@kernel
def move_on(x, y, edges, place, doublings):
    """Move the nodes of a base mesh beside a ``place`` by STEP of a cell of the mesh so many doublings finer, less the
    nearer they are to where their segment ends; y is carried over, linearly.
    """
    for s in range(len(edges) - 1):
        a, b = edges[s], edges[s + 1]
        if a < place < b and b > a + 1:
            node = min(max(int(place + 0.5), a + 1), b - 1)
            step, left, right, at = STEP * (x[node + 1] - x[node]) / (1 << doublings), x[a], x[b], x[node]
            for k in range(a + 1, b):
                here = x[k]
                move = step * ((here - left) / (at - left) if k <= node else (right - here) / (right - at))
                y[k] += move * (y[k + 1] - y[k]) / (x[k + 1] - here)
                x[k] = here + move

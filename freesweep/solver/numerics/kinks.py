"""Where the kind of cell changes along a mesh, and base meshes that do not hide how far from there they have it.

A mesh has a change of kind at a node, the nearest one, or in a cell, and results err by how far it is from a node. From
mesh to mesh that is another share of a cell, so the results differ, and tell. But a change close by a node of the coarsest
mesh is close by it on all: they converge, to fourth order, as if it were there. Then nodes are moved on until it is a third
of a cell from one: on finer meshes it is a third or two thirds of a cell from a node.
"""

from ...jit import kernel

MOST = 8  # changes that are looked for; two or four is what a tube has
MESHES = 4  # that outputs and bounds are extrapolated from
STEP = 1.0 / 3.0  # of a cell
REACH = 4  # cells to both sides of a change, in which nodes are moved, too: the less the farther
CLOSE = 1e-9  # shares of the cells that are one


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
        found = found or abs(changes[k] - place) < CLOSE
    return found


@kernel
def find(changes, level, edges, hidden):
    """How many changes the meshes up to this ``level`` have at one node. ``changes`` (levels, MOST) are shares of the cells.
    Written to ``hidden`` (2, MOST): these nodes, and by how much the finest mesh has the change behind, both in cells of the
    base mesh. Where a segment ends the kind may jump.
    """
    base, count, finest = edges[len(edges) - 1], 0, changes[level]
    step = 1.0 / (base << (level - 1))
    for k in range(MOST):
        place = finest[k]
        stays = place > 0.0
        for before in range(1, MESHES):
            stays = stays and has(changes[level - before], place)
        for edge in edges:
            stays = stays and abs(place - edge / base) > CLOSE
        if stays:
            behind, ahead = has(finest, place + step), has(finest, place - step)
            hidden[0, count] = place * base
            hidden[1, count] = 0.5 * step * base * ((1.0 if behind else 0.0) - (1.0 if ahead else 0.0))
            count += 1
    return count


@kernel
def move_on(x, y, edges, hidden, count, doublings):
    """Move the nodes of a base mesh beside ``count`` hidden changes, so that these are STEP of a cell of the mesh so many
    doublings finer from one; y is carried over, linearly.
    """
    last = 0
    for i in range(count):
        node = int(hidden[0, i] + 0.5)
        for s in range(len(edges) - 1):
            a, b = edges[s], edges[s + 1]
            if a < node < b and node != last:
                step = (hidden[1, i] + STEP / (1 << doublings)) * (x[node + 1] - x[node])
                left, right = min(REACH, node - a), min(REACH, b - node)
                for k in range(node - left + 1, node + right):
                    move = step * (1.0 - (node - k) / left if k <= node else 1.0 - (k - node) / right)
                    y[k] += move * (y[k + 1] - y[k]) / (x[k + 1] - x[k])
                    x[k] += move
                last = node

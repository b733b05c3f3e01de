"""The stretch in the middle of a long tube, as the layer at its end tells it.

In the middle a long tube is all but uniform, of stretch u; what is left there of the layer is no more than a mesh makes of
it, as cells longer than a layer reflect it, or damp it in one step. Where a thousandth of it is left the mesh still
follows it, and from there on it falls as the linear equation says, ``k^2 = L_yy/L_vv`` at u::

    y - u = (y_node - u)/cosh(k (half - x_node))

At the same node of all nested meshes this falls to second order in the cells, like every other output.
"""

from math import exp, sqrt

from ...jit import kernel

NEAR = 1e-3  # share of the layer that is left at the node
LONG = 1e-3  # and in the middle, at most: else the last node tells its stretch
# of what is left in the middle; times the change of k^2 from u to the node: it is not linear there
MISSED, BENT = 0.005, 0.5
ALLOWED = 0.1  # of the accuracy may be missed
STEPS = 6  # of Newton's method, from the stretch of the last node to u
NOT_LONG = -1


@kernel
def uniform(density, y, cell, load):
    """``(u, k)`` of the uniform tube near stretch ``y``; k = 0 if there is none."""
    u, step, k = y, 1.0, 0.0
    for _ in range(STEPS):
        room, L_y, _, L_yy, _, L_vv = density(u, 0.0, cell, load)
        if not (room > 0.0 and L_yy < 0.0):
            return y, 0.0
        step = L_y / L_yy
        u -= step
        k = sqrt(L_yy / L_vv)
    return (u, k) if abs(step) < 1e-12 * u else (y, 0.0)


@kernel
def node(density, x, y, n, cell, load, accuracy):
    """``(node, u)``: the last node of an even number where NEAR of the layer is left, if a tube is long enough; else
    NOT_LONG.
    """
    u, k = uniform(density, y[n], cell, load)
    if not k > 0.0:
        return NOT_LONG, u
    most = abs(y[0] - u)
    i = n - n % 2
    while i > 0 and not abs(y[i] - u) > NEAR * most:
        i -= 2
    rest, missed = left(density, x[i], y[i], x[n], u, k, cell, load)
    return (i if rest <= LONG * most and missed <= ALLOWED * accuracy else NOT_LONG), u


@kernel
def left(density, at, y, half, u, k, cell, load):
    """What is left of the layer in the middle, and how much of that may be missed."""
    z = exp(-k * (half - at))
    rest = abs(y - u) * 2.0 * z / (1.0 + z * z)
    _, _, _, L_yy, _, L_vv = density(y, 0.0, cell, load)
    return rest, rest * (MISSED + BENT * abs(L_yy / (L_vv * k * k) - 1.0))


@kernel
def stretch(density, x, y, n, base_node, base, u, cell, load):
    """``(stretch in the middle, what may be missed)`` on a mesh of n cells, by the node and the uniform stretch that the
    base mesh, of ``base`` cells, has told.
    """
    if base_node == NOT_LONG:
        return y[n], 0.0
    i = base_node * n // base
    u, k = uniform(density, u, cell, load)
    if not k > 0.0:
        return y[n], u
    rest, missed = left(density, x[i], y[i], x[n], u, k, cell, load)
    return (u + rest if y[i] > u else u - rest), missed

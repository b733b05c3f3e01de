"""How a free state of a tube answers to a change of what it depends on, for a vector of designs, on one mesh.

``J = sum h L(y_mid, slope)`` is stationary in the nodes' stretches y. Where a parameter changes, ``J_yy dy = -J_ytheta``:
the Hessian is factored once, and each parameter costs one substitution. ``J_ytheta`` and what the outputs change by are
those of the solver's own density, run on tangents (:mod:`tangent`); a change of length scales the mesh.
"""

from math import sqrt

from ...jit import kernel
from ..physics import lagrangian
from .inlined import inlined
from .nested import MIDDLE
from .tangent import change_of, join, value_of
from .vector import WIDTH, get, put, select, spread

density, integrands = inlined(lagrangian.density), inlined(lagrangian.integrands)


@kernel
def factor(x, y, n, cell, load, ratio, inverse):
    """-J_yy of a free tube, factored as in :func:`newton.eliminate`: off-diagonal over pivot, and 1/pivot, of each node."""
    below, d_left, x_left, y_left = spread(0.0), spread(0.0), get(x, 0), get(y, 0)
    for j in range(n):
        x_right, y_right = get(x, j + 1), get(y, j + 1)
        h = x_right - x_left
        _, _, _, L_yy, L_yv, L_vv = lagrangian.density(0.5 * (y_left + y_right), (y_right - y_left) / h, cell, load)
        corner, stiff = 0.25 * h * L_yy, L_vv / h
        e = stiff - corner
        if j > 0:
            per_pivot = 1.0 / (d_left - corner + L_yv - stiff - below)
            below = e * e * per_pivot
            put(ratio, j, e * per_pivot)
            put(inverse, j, per_pivot)
        d_left = -corner - L_yv - stiff
        x_left, y_left = x_right, y_right
    put(inverse, n, 1.0 / (d_left - below))


@kernel
def respond(x, y, n, cell, load, longer, ratio, inverse, moved):
    """What the nodes of a mesh move by, into ``moved``, as ``cell`` and ``load``, tangents, change; the tube grows
    ``longer``, 1 with the relative change of its length.
    """
    carried, g_left, still = spread(0.0), spread(0.0), spread(0.0)
    x_left, y_left = get(x, 0), get(y, 0)
    for j in range(n):
        x_right, y_right = get(x, j + 1), get(y, j + 1)
        h = (x_right - x_left) * longer
        _, L_y, L_v, _, _, _ = density(join(0.5 * (y_left + y_right), still), (y_right - y_left) / h, cell, load)
        half, flux = change_of(0.5 * h * L_y), change_of(L_v)
        if j > 0:
            b = g_left - half + flux - carried
            carried = get(ratio, j) * b
            put(moved, j, get(inverse, j) * b)
        g_left = -half - flux
        x_left, y_left = x_right, y_right
    ahead = (g_left - carried) * get(inverse, n)
    put(moved, n, -ahead)
    for k in range(1, n):
        i = n - k
        ahead = get(moved, i) - get(ratio, i) * ahead
        put(moved, i, -ahead)
    put(moved, 0, still)


@kernel
def change(x, y, moved, n, cell, load, longer, row):
    """What the integrals over the tube change by, and the stretch of the last node, into ``row`` (OUTPUTS, WIDTH)."""
    length, volume, twist, energy = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    x_left, y_left = get(x, 0), join(get(y, 0), get(moved, 0))
    for j in range(n):
        x_right, y_right = get(x, j + 1), join(get(y, j + 1), get(moved, j + 1))
        h = (x_right - x_left) * longer
        s, v, t, w, _ = integrands(0.5 * (y_left + y_right), (y_right - y_left) / h, cell, load)
        length = length + change_of(h * s)
        volume = volume + change_of(h * v)
        twist = twist + change_of(h * t)
        energy = energy + change_of(h * w)
        x_left, y_left = x_right, y_right
    put(row, 0, length)
    put(row, 1, volume)
    put(row, 2, twist)
    put(row, 3, energy)
    put(row, MIDDLE, change_of(y_left))


@kernel
def middle(x, y, moved, n, base, u, cell, load, longer, long, share, room, row):
    """The stretch in the middle of ``long`` tubes, as :mod:`..numerics.middle` tells it, changes by what goes into ``row``:
    ``u + (y_node - u)/cosh(depth)`` with ``depth = k (half - x_node)``.
    """
    still, flat = spread(0.0), join(spread(0.0), spread(0.0))
    _, L_y, _, L_yy, _, _ = density(join(u, still), flat, cell, load)
    even = join(u, -change_of(L_y) / value_of(L_yy))
    _, _, _, L_yy, _, L_vv = density(even, flat, cell, load)
    k = sqrt(L_yy / L_vv)
    for lane in range(WIDTH):
        i = int(room[0, lane]) * n // base
        room[2, lane], room[3, lane], room[4, lane] = x[i, lane], y[i, lane], moved[i, lane]
    depth = k * ((get(x, n) - get(room, 2)) * longer)
    falls = sqrt(max(1.0 - share * share, 0.0)) * share  # of 1/cosh
    left = join(get(room, 3), get(room, 4)) - even
    changed = change_of(even) + share * change_of(left) - falls * change_of(depth) * value_of(left)
    put(row, MIDDLE, select(long, changed, get(row, MIDDLE)))

"""The last resort for a tube that is the same all along: the integrals along its meridian itself, by quadrature.

Where the fibers' extension, a force or a torque leave the clamped end hardly any meridional stretch, the tube stands there
so upright that a difference of node values, divided by the size of a cell, has no digit to spare for the axial stretch s.
The first integral gives s without any difference (:mod:`meridian`). Nodes are doubled as the meshes of
:mod:`..numerics.nested` are.
"""

from math import exp, sqrt

from ...jit import kernel
from ..guide import cell_along
from ..numerics import finest, nested
from ..physics import lagrangian
from ..status import INACCURATE, NOT_CONVERGED, OK
from . import meridian, shape_beside

DEEP = 17.0  # e-folds from end to middle: from there on integrals are those of a tube without end, to exp(-34)
MEETS_HALF = 1e-13  # relative
STILL = 1e-12  # |y - 1| of the middle: nothing moves
ROWS = 4  # quadratures, each with twice the nodes of the one before
END_SHARE = 0.1  # of the distance from the end over which the meridional stretch there doubles
UPRIGHT = 0.1  # cosine of the meridian's angle in the first cell: below it meshes' errors know no order
CAUTION = 2.0  # times the bounds: their third order is not quite nothing
ROUNDING = 2e-10  # scaled: what the uniform stretch's last digit makes near the middle


@kernel
def integrate(cell, load, u, rate, half, total, nodes, curve, row):
    """Integrals along the ``curve``, and from its end at ``total`` on along the uniform tube, which the middle approaches as
    exp(-rate x).
    """
    length, volume, twist, energy = 0.0, 0.0, 0.0, 0.0
    for k in range(nodes):
        h = curve[0, k + 1] - curve[0, k]
        s, v, t, w, _ = lagrangian.integrands(curve[4, k], 0.0, cell, load)
        length += h * s * curve[3, k]
        volume += h * v * curve[3, k]
        twist += h * t
        energy += h * w
    s, v, t, w, _ = lagrangian.integrands(u, 0.0, cell, load)
    rest = half - total
    row[0], row[1], row[2], row[3] = length + rest * s, volume + rest * v, twist + rest * t, energy + rest * w
    row[nested.MIDDLE], row[nested.MULTIPLIER] = u + (curve[1, nodes] - u) * exp(-rate * rest), 0.0


@kernel
def finish(table, out):
    """Values and bounds from the quadratures; the largest scaled bound."""
    largest = CAUTION * nested.extrapolate(table, ROWS - 1, out[2], out[3], 0.0, False, out[0], out[1])
    for k in range(nested.OUTPUTS):
        out[1, k] = CAUTION * out[1, k] + ROUNDING * out[2, k]
    return largest


@kernel
def solve(tube, near, load, base, accuracy, space):
    """The state whose middle is about ``near``, as :func:`..numerics.nested.solve` leaves it: ``(status, doublings)``
    of ``base``
    cells. NOT_CONVERGED where there is none.
    """
    return _solve(tube.course, tube, near, load, base, accuracy, space)


@kernel
def _solve(course, tube, near, load, base, accuracy, space):
    if course.ndim > 4:  # a body has no first integral
        return NOT_CONVERGED, 0
    cell, half, curve, table, out = cell_along(tube, 0.0), tube.places[1], space.curve, space.table, space.out
    u, top, rate = shape_beside.stationary(cell, load, near), near, 0.0
    layered = u == u
    if layered:
        _, _, _, L_yy, _, L_vv = lagrangian.density(u, 0.0, cell, load)
        top, rate = u, sqrt(L_yy / L_vv)
    if not abs(top - 1.0) > STILL:
        return NOT_CONVERGED, 0
    _, _, _, G_1, G_y, _ = lagrangian.kinematics(1.0, cell, load)
    crowding = min(meridian.CROWDING, END_SHARE * (1.0 + G_1) / (abs(G_y) * abs(top - 1.0)))
    nodes, total = base << nested.MAX_DOUBLINGS, half
    for k in range(ROWS):
        count, row = nodes >> (ROWS - 1 - k), table[k]
        if layered:
            total = meridian.meet(cell, load, u, half, DEEP, MEETS_HALF, count, crowding, curve)
        else:
            u = shape_beside.fit_near(cell, load, near, half, MEETS_HALF, count, crowding, curve)
        if not total > 0.0 or not u > 0.0:
            return NOT_CONVERGED, 0
        integrate(cell, load, u, rate, half, min(total, half), count, curve, row)
        if k >= ROWS - finest.MESHES:
            x, y = finest.mesh_of(ROWS - 1 - k, nodes // 2, space.fine)
            for i in range(count + 1):
                x[i], y[i] = curve[0, i], curve[1, i]
            x[count] = half
        if not shape_beside.is_near(row[nested.MIDDLE], near):
            return NOT_CONVERGED, 0
    scales, floors = lagrangian.scales(table[ROWS - 1], cell, load, half, nested.SMALLEST_TOLERANCE)
    for k in range(nested.OUTPUTS):
        out[2, k], out[3, k] = scales[k], floors[k]
    largest = finish(table, out)
    finest.leave_loads(table[:, nested.MULTIPLIER], ROWS - 1, 0.0, load, finest.NO_MESH, space.fine)
    return (OK if largest <= accuracy else INACCURATE), nested.MAX_DOUBLINGS


@kernel
def end_cosine(x, y, tube, load):
    """Cosine of the meridian's angle in the first cell."""
    v = (y[1] - y[0]) / (x[1] - x[0])
    s = lagrangian.integrands(0.5 * (y[0] + y[1]), v, cell_along(tube, 0.0), load)[0]
    return s / sqrt(s * s + v * v)


@kernel
def sharpen(tube, load, accuracy, space, status, doublings):
    """``(status, doublings)`` of a state that meshes have solved, or of its quadrature where its ends are too upright for
    them.
    """
    if end_cosine(space.x, space.y, tube, load) < UPRIGHT:
        near, base = space.out[0, nested.MIDDLE], len(space.x) - 1
        better, levels = solve(tube, near, load, base, accuracy, space)
        if better != NOT_CONVERGED:
            return better, levels
    return status, doublings

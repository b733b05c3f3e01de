"""The meridian of a tube that is the same all along, by quadrature of its first integral: a first guess of any steepness.

Where nothing varies along x, ``L - y' L_y'`` is the same at every place; T = p y^2 + f, F = T sqrt(G), U(y) = L(y, 0)::

    R = U(y_m) - U(y),   y'^2 = G R (2 F + R)/(F + R)^2,   cosine of the meridian's angle = F/(F + R)

R comes from integrating U' = L_y, which loses no digit near the middle y_m, and x from integrating dy/y', in the variable
theta of ``|y_m - y| = scale (cosh(theta) - 1)``, which runs evenly through an end layer. Distances crowd at the clamped end.
"""

from math import acosh, cosh, exp, log, log1p, sinh, sqrt

import numpy as np

from ...jit import kernel
from ..guide import cell_along
from ..numerics import mesh, newton
from ..numerics.properties_along import fill
from ..physics import lagrangian

NODES = 160  # along the curve: a guess need be good to a hundredth only
DEEPEST = 20.0  # e-folds from end to middle; beyond them the middle is the uniform stretch
CROWDING = 0.01  # of an e-fold: the distances at the clamped end, if not less
TAYLOR, TAYLOR_STEP = 1e-6, 1e-4  # share of y up to which a difference of U' has too few digits; of that for U'''
ROOT_STEPS = 60
HALF_FITS = 1e-5  # relative
STEEP = 0.5  # cosine of the meridian's angle
MOST_SHIFT = 0.1  # of what is left of the tube


@kernel
def slopes_at(cell, load, top, sign):
    """First, second and third derivative of U at ``top``, ``sign`` times toward it."""
    step = TAYLOR_STEP * top
    _, L_y, _, L_yy, _, _ = lagrangian.density(top, 0.0, cell, load)
    before, after = (
        lagrangian.density(top - step, 0.0, cell, load)[3],
        lagrangian.density(top + step, 0.0, cell, load)[3],
    )
    return sign * L_y, L_yy, sign * (after - before) / (2.0 * step)


@kernel
def gained(cell, load, top, sign, way, slopes):
    """Change of the drive ``sign U'`` on a ``way`` from ``top`` on toward the end, to the last digit."""
    first, second, third = slopes
    if way < TAYLOR * top:
        return way * (0.5 * third * way - second)
    return sign * lagrangian.density(top - sign * way, 0.0, cell, load)[1] - first


@kernel
def trace(cell, load, top, drive_at_top, gap, scale, nodes, crowding, curve):
    """Half a tube whose middle lies ``gap`` short of ``top``, where U' toward it is ``drive_at_top``, however small: rows of
    ``curve`` (5, > nodes) take x, y at the ``nodes`` from the clamped end on, sine and cosine of the meridian's angle in the
    cells between, and y there. Returns x of the middle, NaN where no such shape is an equilibrium.
    """
    x, y, sine, cosine, between = curve[0], curve[1], curve[2], curve[3], curve[4]
    sign = 1.0 if top >= 1.0 else -1.0
    reach = abs(top - 1.0) - gap
    slopes = slopes_at(cell, load, top, sign)
    end = acosh(1.0 + reach / scale)
    crowd = end + log((1.0 + crowding - exp(-end)) / crowding)
    theta, z, drive, R = 0.0, 0.0, 0.0, 0.0
    for k in range(nodes, -1, -1):
        before, z_before, drive_before = theta, z, drive
        from_end = log1p(crowding * (exp(crowd * k / nodes) - 1.0) / (1.0 + crowding))
        theta = end - from_end if k < nodes else 0.0
        z = scale * 2.0 * sinh(0.5 * theta) ** 2
        y[k] = top - sign * (gap + z)
        drive = drive_at_top + gained(cell, load, top, sign, gap + z, slopes)
        if k == nodes:
            continue
        middle = 0.5 * (theta + before)
        z_middle = scale * 2.0 * sinh(0.5 * middle) ** 2
        share = (z_middle - z_before) / (z - z_before)
        R_middle = R + (z_middle - z_before) * (drive_before + 0.5 * share * (drive - drive_before))
        R += 0.5 * (z - z_before) * (drive_before + drive)
        at = top - sign * (gap + z_middle)
        between[k] = at
        room = 1.0 + lagrangian.kinematics(at, cell, load)[3]
        T = load.p * at * at + load.f
        if not (R_middle > 0.0 and room > 0.0 and T > 0.0 and at > 0.0):
            return np.nan
        F = T * sqrt(room)
        cosine[k] = F / (F + R_middle)
        sine[k] = sign * sqrt(R_middle * (2.0 * F + R_middle)) / (F + R_middle)
        x[k] = (theta - before) * scale * sinh(middle) / (sqrt(room) * abs(sine[k]))  # length of the cell, for now
    total = 0.0
    for k in range(nodes):
        h = x[k]
        x[k] = total
        total += h
    x[nodes], y[0] = total, 1.0
    return total


@kernel
def scaled(curve, half, nodes):
    """Let x of the middle, which is close to it, be ``half``; the number of cells."""
    share = half / curve[0, nodes]
    for k in range(nodes + 1):
        curve[0, k] *= share
    return nodes


@kernel
def lengthened(curve, half, nodes):
    """Go on as the uniform tube to ``half``; the number of cells."""
    if not half > curve[0, nodes] * (1.0 + HALF_FITS):
        return scaled(curve, half, nodes)
    curve[0, nodes + 1], curve[1, nodes + 1] = half, curve[1, nodes]
    curve[2, nodes], curve[3, nodes] = 0.0, 1.0
    return nodes + 1


@kernel
def meet(cell, load, u, half, deep, tolerance, nodes, crowding, curve):
    """Trace the tube whose middle lies at ``half``, toward the uniform stretch ``u``; x of that middle, less than half where
    more than ``deep`` e-folds lie before it, NaN where there is none.

    ``|u - y| = gap cosh(theta)``: x of the middle grows with the e-folds.
    """
    reach = abs(u - 1.0)
    low, high = 0.0, deep
    gap = reach / cosh(high)
    total = trace(cell, load, u, 0.0, gap, gap, nodes, crowding, curve)
    if not total > half:
        return total
    miss_low, miss_high = -half, total - half
    folds = 0.0
    for _ in range(ROOT_STEPS):
        folds = (low * miss_high - high * miss_low) / (miss_high - miss_low)
        gap = reach / cosh(folds)
        total = trace(cell, load, u, 0.0, gap, gap, nodes, crowding, curve)
        miss = total - half
        if not abs(miss) > tolerance * half:
            break
        if miss > 0.0:
            high, miss_high, miss_low = folds, miss, 0.5 * miss_low
        else:
            low, miss_low, miss_high = folds, miss, 0.5 * miss_high
    return total


@kernel
def fit(cell, load, u, half, nodes, curve):
    """The curve with ``half`` as x of the middle, toward the uniform stretch ``u``; its number of cells, 0 for none."""
    total = meet(cell, load, u, half, DEEPEST, HALF_FITS, nodes, CROWDING, curve)
    if not total > 0.0:
        return 0
    return lengthened(curve, half, nodes) if total <= half else scaled(curve, half, nodes)


@kernel
def spread(curve, count, cell, load, n, x, y, work):
    """Mesh and shape on n cells from a ``curve`` of ``count`` cells: nodes where it bends, slopes that leave room."""
    mesh.bends(curve[0], curve[2], curve[3], count, True, work[0])
    mesh.node_density(curve[0], count, work[0], work[1])
    mesh.regrade(curve[0], curve[1], work[1], count, n, x, y, work[2])
    j, shift = 0, 0.0
    for i in range(n):
        h, middle = x[i + 1] - x[i], 0.5 * (x[i] + x[i + 1])
        while j < count - 2 and 0.5 * (curve[0, j + 1] + curve[0, j + 2]) < middle:
            j += 1
        here, after = 0.5 * (curve[0, j] + curve[0, j + 1]), 0.5 * (curve[0, j + 1] + curve[0, j + 2])
        share = min(max((middle - here) / (after - here), 0.0), 1.0)
        cosine = curve[3, j] + share * (curve[3, j + 1] - curve[3, j])
        work[0, i] = cosine
        if cosine < STEEP and shift < MOST_SHIFT * (
            x[n] - x[i]
        ):  # there the last digits of the slope count: to each rise its length
            room = lagrangian.integrands(0.5 * (y[i] + y[i + 1]), 0.0, (cell[0], cell[1], cell[2]), load)[0]
            shift += abs(y[i + 1] - y[i]) / (room * sqrt(1.0 - cosine * cosine)) - h
            work[1, i] = shift
        else:
            work[1, i] = shift * (x[n] - x[i + 1]) / (x[n] - x[i])
            shift = work[1, i]
    for i in range(n - 1):
        x[i + 1] += work[1, i]


@kernel
def start(tube, u, load, x, y, curve, work):
    """As :func:`guide.start`, for a tube that is the same all along: mesh and first shape; whether there is one."""
    cell = cell_along(tube, 0.0)
    n = len(x) - 1
    if not abs(u[0] - 1.0) > 1e-12:
        return False
    count = fit(cell, load, u[0], tube.places[1], NODES, curve)
    if count == 0:
        return False
    own = fill(tube.course, tube.edges, x, n, n, tube.cells)
    spread(curve, count, cell, load, n, x, y, work)
    mesh.ease(lagrangian.integrands, x, y, n, work[0], own, load)
    return newton.admissible(lagrangian.density, x, y, n, own, load)

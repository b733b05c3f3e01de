"""The meridian of a tube that is the same all along, by quadrature of its first integral.

Where nothing varies along x, ``L - y' L_y'`` is the same at every place; T = p y^2 + f, F = T sqrt(G), U(y) = L(y, 0)::

    R = U(y_m) - U(y),   y'^2 = G R (2 F + R)/(F + R)^2,   cosine of the meridian's angle = F/(F + R)

R comes from integrating U' = L_y, which loses no digit near the middle y_m, and x from integrating dy/y', in the variable
theta of ``|y_m - y| = scale (cosh(theta) - 1)``, which runs evenly through an end layer. Distances crowd at the clamped end.
"""

from math import acosh, exp, log, log1p, sinh, sqrt

import numpy as np

from ...jit import kernel
from ..physics import lagrangian

TAYLOR, TAYLOR_STEP = 1e-6, 1e-4  # share of y up to which a difference of U' has too few digits; of that for U'''


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

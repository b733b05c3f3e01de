"""The uniform physical tube: a thick wall, threads that cannot push. What :mod:`uniform_tube` is to the source's tube.

At slope 0 the density of :mod:`freesweep.solver.physics.physical` knows meridional stretch and twist already; what is
left is the circumferential stretch at which it is stationary. It is continuous in the loads, with a kink where a family
goes slack.
"""

import functools
import math

from ..jit import entry_point, kernel
from ..solver.load import Load
from ..solver.physics.fibers import both_reach, multipliers, taut_twist
from ..solver.physics.physical import density, kind_of, place
from ..solver.physics.wall import has_two_families, slopes, stored
from .reference import (
    ALPHA,
    BETA,
    C01,
    C10,
    C20,
    C30,
    EXTENSION,
    FIBERS,
    FORCE,
    HELD,
    LENGTH,
    LENGTH_HELD,
    LOADED,
    LOCKED,
    OF_STRETCH,
    PRESSURE,
    RADIUS,
    ROTATION_HELD,
    TAUT,
    TORQUE,
    WALL,
)  # fmt: skip
from .uniform_tube import locked_squared_stretch

MARCH, REMAINS = 60, 0.8  # steps in search of a bracket, and what each leaves of the way to where the fibers end
STEPS = 80  # of Newton's method inside it; between two active sets, where L_y all but jumps, of halving
LAST_STEP = 1e-13  # of the stretch
FAR = 8.0  # of the stretch: balloons are past their limit long before
LEAST = 1e-6  # of G, where fibers leave nothing
MOONEY_RIVLIN, YEOH = (C01,), (C01, C20, C30)


@kernel
def rubber_at(point, columns):
    """What the solver takes as a rubber: constants over C10."""
    if len(columns) == 1:
        return (point[columns[0]] / point[C10],)
    return point[columns[0]] / point[C10], point[columns[1]] / point[C10], point[columns[2]] / point[C10]


@kernel
def problem(point, thick, loose, columns):
    """``(cell, load)`` of a point (17,), as the solver takes them."""
    ta, tb = math.tan(math.radians(point[ALPHA])), math.tan(math.radians(point[BETA]))
    r, c10, within = point[FIBERS], point[C10], point[RADIUS] / point[FIBERS]
    area = ((point[RADIUS] + point[WALL]) / r) ** 2 - within * within
    wall, square = (1.0, within * within * thick, loose), math.pi * r * r * c10
    loads = point[PRESSURE] / c10, point[FORCE] / square, point[TORQUE] / (square * r)
    return (0.5 * (ta + tb), 0.5 * (ta - tb), area), Load(
        point[EXTENSION], rubber_at(point, columns), wall, *loads, 1.0
    )


@kernel
def longest(cell, gamma, wall, outward):
    """The stretch at which taut fibers end: the larger one, or the smaller, which loose ones do not know; of fewer than two
    families that at which a search does.
    """
    if not has_two_families(wall):
        return FAR if outward else 0.0
    h, d, g2 = cell[0], cell[1], gamma * gamma
    total = g2 * (1.0 + h * h + d * d)
    root = math.sqrt(max(total * total - 4.0 * g2 * g2 * d * d * h * h, 0.0))
    if outward:
        return math.sqrt(0.5 * (total + root)) / abs(d)
    return 0.0 if wall[2] > 0.0 else g2 * abs(h) * math.sqrt(2.0 / (total + root))


@kernel
def stretch(cell, load):
    """The first stationary point met from y = 1; NaN if there is none."""
    room, start, _, _, _, _ = density(1.0, 0.0, cell, load)
    if start == 0.0 or (load.p == 0.0 and load.f == 0.0 and load.m == 0.0 and load.gamma == 1.0):
        return 1.0
    if not (room > 0.0 and abs(start) > 0.0):
        return math.nan
    end = longest(cell, load.gamma, load.wall, start > 0.0)
    inner, outer, share, before, value = 1.0, 1.0, 1.0, start, start
    for _ in range(MARCH):
        share *= REMAINS
        outer = end + (1.0 - end) * share
        room, value, _, _, _, _ = density(outer, 0.0, cell, load)
        if not (room > 0.0 and value * start > 0.0):
            break
        inner, before = outer, value
    if not (room > 0.0 and value * start <= 0.0):
        return math.nan
    y = inner + (outer - inner) * before / (before - value)
    for _ in range(STEPS):
        _, value, _, slope, _, _ = density(y, 0.0, cell, load)
        if value == 0.0:
            break
        if value * start > 0.0:
            inner = y
        else:
            outer = y
        new = y - value / slope
        if not min(inner, outer) <= new <= max(inner, outer):
            new = 0.5 * (inner + outer)
        change = abs(new - y)
        y = new
        if change <= LAST_STEP * y:
            break
    return y


@kernel
def held_stretch(kind, point, cell, gamma):
    """The stretch of bonded fibers that are locked, or whose length or rotation is held; NaN if there is none."""
    h, d, g2 = cell[0], cell[1], gamma * gamma
    if kind == LOCKED:
        return math.sqrt(locked_squared_stretch(h, d, gamma))
    if kind == LENGTH_HELD:  # as in :mod:`reference`
        middle = g2 * (1.0 + h * h + d * d) - point[HELD] ** 2
        root = math.sqrt(max(middle * middle - 4.0 * g2 * g2 * d * d * h * h, 0.0))
        return math.sqrt((middle + root) / (2.0 * d * d) if d * d > h * h else 2.0 * g2 * g2 * h * h / (middle + root))
    square = g2 / (1.0 + math.radians(point[HELD]) * point[FIBERS] / (point[LENGTH] * h))
    return math.sqrt(square) if square > 0.0 else math.nan


@kernel
def uniform(kind, point, thick, loose, columns, out):
    """The uniform state of a kind at a point (17,) into ``out`` (UNIFORM,), as :func:`reference.uniform` has it."""
    cell, load = problem(point, thick, loose, columns)
    (h, d, area), (gamma, rubber, wall, p, f, m, _) = cell, load
    for k in range(len(out)):
        out[k] = math.nan
    out[0], out[1], out[2] = h, h * h - d * d, area
    held = kind == LENGTH_HELD or kind == ROTATION_HELD
    if d == 0.0 or not (kind == LOADED or kind == LOCKED or (held and loose == 0.0)):
        return
    y = math.nan
    if kind == LOADED:
        y = stretch(cell, load)
    else:
        y = held_stretch(kind, point, cell, gamma)
    if not y > 0.0:
        return
    gg = gamma * gamma
    G_1, psi, taut_alpha, taut_beta = both_reach(y, h, d, gg, gg - 1.0), taut_twist(y, h, gg), True, True
    if kind == LOADED and p * y * y + f > 0.0:
        _, G_1, psi, taut_alpha, taut_beta = place(y, 0.0, p * y * y + f, cell, load)
    if not G_1 > -1.0:
        return
    s = math.sqrt(1.0 + G_1)
    out[3], out[4], out[5], out[6] = y * y, s, psi, stored(y, G_1, psi, area, rubber, wall) / area
    if kind == LOADED and loose == 0.0 and p * y * y + f > 0.0:  # bonded fibers may push
        taut_alpha, taut_beta = pulling(y, p * y * y + f, G_1, psi, cell, load)
    out[TAUT] = kind_of(taut_alpha, taut_beta)
    if not held:
        return
    t = gg / (y * y)
    psi_y, s_y = -2.0 * h * t / y, (-d * d * y + h * h * gg * t / y) / s
    W_y, W_G, W_p, W_yy, _, _, _, _, _ = slopes(y, G_1, psi, area, rubber, wall)
    along = W_y + 2.0 * s * s_y * W_G + psi_y * W_p
    T, T_y = p * y * y, 2.0 * p * y
    out[8] = OF_STRETCH * y * abs(W_yy)
    if kind == LENGTH_HELD:
        out[7] = -(T_y * s + T * s_y - along + m * psi_y) / s_y
        out[8] /= abs(s_y)
    else:
        out[7] = -(T_y * s + (T + f) * s_y - along) / psi_y
        out[8] /= abs(psi_y)


@kernel
def pulling(y, pull, G_1, psi, cell, load):
    """Which of two bonded families do not push, where the axial resultant is ``pull``."""
    _, W_G, W_p, _, _, _, _, _, _ = slopes(y, G_1, psi, cell[2], load.rubber, load.wall)
    alpha, beta = multipliers(y, math.sqrt(1.0 + G_1), psi, (True, True), cell, pull, load.m, W_G, W_p)
    return alpha >= 0.0, beta >= 0.0


@functools.partial(entry_point, others=("solver",))
def physical_states(kind, points, thick, loose, columns, out):
    """:func:`uniform` of points (n, 17) into ``out`` (n, UNIFORM); ``thick`` and ``loose``: 0.0 or 1.0; ``columns`` of the
    rubber's constants: MOONEY_RIVLIN or YEOH.
    """
    for k in range(len(points)):
        uniform(kind, points[k], thick, loose, columns, out[k])

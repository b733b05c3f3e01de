"""How the density of a physical tube bends at one place, along all that it depends on, for a vector of designs.

With the multipliers a, b of the families that are taut the density is what ``M = T s - e W + m psi - a g_a - b g_b`` is at
the G and psi that fibers and wall settle at (:mod:`..physics.physical`). Where a number changes these answer so that the
constraints stay met and M stationary, a linear system of which the inverse is known in closed form for each kind of state::

    (dG, dpsi) = -inverse (M_G, M_psi by the number; g_a, g_b by it)
    L_ij = M_ij + M_iG G_j + M_ipsi psi_j + G_i (M_jG + M_GG G_j + M_Gpsi psi_j) + psi_i (...)

Loads stand in L by what they are conjugate to: by f, p, m and e it is s, y^2 s, psi and -W. Walls change by a layer at
either surface. By the tangents t_a and t_b of the angles each family changes by itself.
"""

from math import sqrt
from typing import NamedTuple

from ...jit import kernel
from ..either import isnt, select
from ..physics.fibers import is_taut
from ..physics.wall import layer, rises, slopes, stored
from .vector import put, spread

NUMBERS = 12
FAR = 1e8  # from a rubber's constant: what does not hang on it is rounding there
# what a place answers to, beside its stretch and slope; the loads last
T_ALPHA, T_BETA, GAMMA, AREA, INNER, RATIO, SECOND, THIRD, FORCE, PRESSURE, TORQUE, WEIGHT = range(NUMBERS)
LOADS = 4  # the last of them
BY_Y, BY_V = 0, NUMBERS  # rows of the bends of L along y and v, of each number
YY, YV, VV = range(2 * NUMBERS, 2 * NUMBERS + 3)
OF_LOADS = (
    VV + 1
)  # rows of the bends along a load, of each number that is no load, and of f, p and m; then L by each load
ROWS = OF_LOADS + LOADS * NUMBERS + LOADS


class Family(NamedTuple):
    """A family of fibers at one place: whether it is taut; tan(angle), undeformed and as the twist leaves it; multiplier,
    0 of a slack one; and its constraint's derivative by psi.
    """

    taut: bool
    t: float
    on: float
    pull: float
    turn: float


class Place(NamedTuple):
    """Derivatives of M at one place, and of the G and psi that it settles at by y; 1/s, y^2; slopes of W by G and psi; and
    the :func:`inverse`.
    """

    M_yG: float
    M_yp: float
    M_vG: float
    M_GG: float
    M_Gp: float
    M_pp: float
    G_y: float
    p_y: float
    per_s: float
    yy: float
    W_G: float
    W_p: float
    inverse: tuple


@kernel
def family(taut, t, multiplier, psi, yy):
    """The :class:`Family` of an angle."""
    on = t + psi
    return Family(taut, t, on, select(taut, multiplier, spread(0.0)), 2.0 * yy * on)


@kernel
def inverse(alpha, beta, M_GG, M_Gp, M_pp):
    """The seven numbers of ``-(dG, dpsi)`` by (M_G, M_psi, g_a, g_b): ``(GG, Gpsi, psipsi, Ga, psia, Gb, psib)``."""
    taut_alpha, taut_beta, turn_a, turn_b = alpha.taut, beta.taut, alpha.turn, beta.turn
    both, none = taut_alpha & taut_beta, isnt(taut_alpha | taut_beta)
    zero = 0.0 * M_GG
    apart = 1.0 / (turn_a - turn_b)
    turn = select(taut_alpha, turn_a, turn_b)
    cross = M_Gp - turn * M_GG
    bend = 1.0 / select(both, 1.0, turn * (turn * M_GG - 2.0 * M_Gp) + M_pp)
    det = 1.0 / select(none, M_GG * M_pp - M_Gp * M_Gp, 1.0)
    GG = select(both, zero, select(none, M_pp * det, turn * turn * bend))
    Gp = select(both, zero, select(none, -M_Gp * det, -turn * bend))
    pp = select(both, zero, select(none, M_GG * det, bend))
    G_one, p_one = 1.0 + turn * cross * bend, -cross * bend
    G_a = select(both, -turn_b * apart, select(taut_alpha, G_one, zero))
    p_a = select(both, apart, select(taut_alpha, p_one, zero))
    G_b = select(both, turn_a * apart, select(none | taut_alpha, zero, G_one))
    p_b = select(both, -apart, select(none | taut_alpha, zero, p_one))
    return GG, Gp, pp, G_a, p_a, G_b, p_b


@kernel
def by_surfaces(y, G_1, psi, cell, load):
    """Derivatives ``(W, W_y, W_G, W_psi)`` of the wall's energy by its area, and by the square of its inner radius."""
    if load.wall[3] == 1:
        w, w_y, w_G, w_p, _, _, _, _, _, _ = layer(1.0 + 0.0 * y, y, G_1, psi, load.rubber, load.wall[0])
        zero = 0.0 * y
        return (w, w_y, w_G, w_p), (zero, zero, zero, zero)
    inside, outside = load.wall[1], load.wall[1] + cell[2]
    w, w_y, w_G, w_p, _, _, _, _, _, _ = layer(outside, y, G_1, psi, load.rubber, load.wall[0])
    i, i_y, i_G, i_p, _, _, _, _, _, _ = layer(inside, y, G_1, psi, load.rubber, load.wall[0])
    return (w, w_y, w_G, w_p), (w - i, w_y - i_y, w_G - i_G, w_p - i_p)


@kernel
def by_rubber(y, G_1, psi, area, rubber, wall, W, V):
    """Derivatives ``(W, W_y, W_G, W_psi)`` by each of three constants, 0 of those that the rubber does not have, of a wall
    of the energy W, whose slopes are V.
    """
    far, zero = spread(FAR), spread(0.0)
    none = zero, zero, zero, zero
    own = by_constant(rises(y, G_1, psi, area, (rubber[0] + far, *rubber[1:]), wall), W, V)
    if len(rubber) == 1:
        return own, none, none
    return (
        own,
        by_constant(rises(y, G_1, psi, area, (rubber[0], rubber[1] + far, rubber[2]), wall), W, V),
        by_constant(rises(y, G_1, psi, area, (rubber[0], rubber[1], rubber[2] + far), wall), W, V),
    )


@kernel
def by_constant(there, W, V):
    """Derivatives by a constant, in which energies are linear, from what they are FAR from here."""
    return (there[0] - W) / FAR, (there[1] - V[0]) / FAR, (there[2] - V[1]) / FAR, (there[3] - V[2]) / FAR


@kernel
def answer(inverse, M_G, M_p, c_a, c_b):
    """``(dG, dpsi)`` of a number along which M's slopes by G and psi change by ``M_G``, ``M_p``, the constraints by c."""
    GG, Gp, pp, G_a, p_a, G_b, p_b = inverse
    return -(GG * M_G + Gp * M_p + G_a * c_a + G_b * c_b), -(Gp * M_G + pp * M_p + p_a * c_a + p_b * c_b)


@kernel
def enter(k, dG, dp, M_y, M_G, M_p, W_by, here, rows):
    """Write what number k, no load, changes: slopes of L along y and v, and what loads are conjugate to."""
    M_yG, M_yp, M_vG, M_GG, M_Gp, M_pp, G_y, p_y, per_s, yy, W_G, W_p, _ = here
    half = 0.5 * per_s * dG
    pull_G, pull_p = M_G + M_GG * dG + M_Gp * dp, M_p + M_Gp * dG + M_pp * dp
    put(rows, BY_Y + k, M_y + M_yG * dG + M_yp * dp + G_y * pull_G + p_y * pull_p)
    put(rows, BY_V + k, M_vG * dG)
    put(rows, OF_LOADS + k, half)
    put(rows, OF_LOADS + NUMBERS + k, yy * half)
    put(rows, OF_LOADS + 2 * NUMBERS + k, dp)
    put(rows, OF_LOADS + 3 * NUMBERS + k, -(W_by + W_G * dG + W_p * dp))


@kernel
def bends(y, v, cosine, at, cell, load, rows):
    """Write all second derivatives of the density at one place, and its first ones by the loads, to ``rows`` (ROWS,
    WIDTH); ``at`` is the :class:`..physics.first_integral.Level` there.
    """
    G_1, psi = at.G_1, at.psi
    W, V = stored(y, G_1, psi, cell[2], load.rubber, load.wall), slopes(y, G_1, psi, cell[2], load.rubber, load.wall)
    s, (taut_alpha, taut_beta) = sqrt(1.0 + G_1) * cosine, is_taut(at.kind)
    alpha = family(taut_alpha, cell[0] + cell[1], at.a, psi, y * y)
    beta = family(taut_beta, cell[0] - cell[1], at.b, psi, y * y)
    here = by_shape(y, v, s, 1.0 + G_1, alpha, beta, load, V, rows)
    by_fibers(y, load.gamma, alpha, beta, here, rows)
    by_walls(y, at, cell, load, W, V, here, rows)
    by_loads(here, rows)
    put(rows, ROWS - 4, s)
    put(rows, ROWS - 3, here.yy * s)
    put(rows, ROWS - 2, psi)
    put(rows, ROWS - 1, -W)


@kernel
def by_shape(y, v, s, G, alpha, beta, load, V, rows):
    """Write the derivatives by y and v, of their slopes and of those by the loads; returns the :class:`Place`, of a wall
    whose slopes are V.
    """
    e, yy, zero = load.e, y * y, spread(0.0)
    W_y, W_G, W_p, W_yy, W_yG, W_yp, W_GG, W_Gp, W_pp = V
    T, i, a, b = load.p * yy + load.f, 1.0 / s, alpha.pull, beta.pull
    turned, squared = a * alpha.on + b * beta.on, a * alpha.on * alpha.on + b * beta.on * beta.on
    M_yy = 2.0 * load.p * s - e * W_yy - 2.0 * squared
    M_yG, M_yp = load.p * y * i - e * W_yG, -e * W_yp - 4.0 * y * turned
    flat = -v * i
    M_vG = -0.5 * T * flat * i * i
    M_GG, M_Gp, M_pp = -0.25 * T * i * i * i - e * W_GG, -e * W_Gp, -e * W_pp - 2.0 * yy * (a + b)
    settled = inverse(alpha, beta, M_GG, M_Gp, M_pp)
    G_y, p_y = answer(settled, M_yG, M_yp, 2.0 * y * alpha.on * alpha.on, 2.0 * y * beta.on * beta.on)
    G_v, p_v = answer(settled, M_vG, zero, zero, zero)
    L_yy = M_yy + 2.0 * (M_yG * G_y + M_yp * p_y) + (M_GG * G_y + 2.0 * M_Gp * p_y) * G_y + M_pp * p_y * p_y
    put(rows, YY, L_yy)
    put(rows, YV, 2.0 * load.p * y * flat + M_vG * G_y)
    put(rows, VV, -T * G * i * i * i + M_vG * G_v)
    s_y, s_v = 0.5 * i * G_y, 0.5 * i * G_v + flat
    put(rows, BY_Y + FORCE, s_y)
    put(rows, BY_V + FORCE, s_v)
    put(rows, BY_Y + PRESSURE, yy * s_y + 2.0 * y * s)
    put(rows, BY_V + PRESSURE, yy * s_v)
    put(rows, BY_Y + TORQUE, p_y)
    put(rows, BY_V + TORQUE, p_v)
    put(rows, BY_Y + WEIGHT, -(W_y + W_G * G_y + W_p * p_y))
    put(rows, BY_V + WEIGHT, -(W_G * G_v + W_p * p_v))
    return Place(M_yG, M_yp, M_vG, M_GG, M_Gp, M_pp, G_y, p_y, i, yy, W_G, W_p, settled)


@kernel
def by_fibers(y, gamma, alpha, beta, here, rows):
    """:func:`enter` tan(angle) of both families, and their extension."""
    yy, gg, zero = here.yy, gamma * gamma, spread(0.0)
    M_p, c = -2.0 * yy * alpha.pull, alpha.turn - 2.0 * gg * alpha.t
    dG, dp = answer(here.inverse, zero, M_p, c, zero)
    enter(T_ALPHA, dG, dp, -4.0 * y * alpha.pull * alpha.on, zero, M_p, zero, here, rows)
    M_p, c = -2.0 * yy * beta.pull, beta.turn - 2.0 * gg * beta.t
    dG, dp = answer(here.inverse, zero, M_p, zero, c)
    enter(T_BETA, dG, dp, -4.0 * y * beta.pull * beta.on, zero, M_p, zero, here, rows)
    longer = -2.0 * gamma * (1.0 + alpha.t * alpha.t), -2.0 * gamma * (1.0 + beta.t * beta.t)
    dG, dp = answer(here.inverse, zero, zero, longer[0], longer[1])
    enter(GAMMA, dG, dp, zero, zero, zero, zero, here, rows)


@kernel
def by_walls(y, at, cell, load, W, V, here, rows):
    """:func:`enter` the surfaces and the rubber's constants of a wall of the energy W, whose slopes are V."""
    by_c, by_2, by_3 = by_rubber(y, at.G_1, at.psi, cell[2], load.rubber, load.wall, W, V)
    by_area, by_inner = by_surfaces(y, at.G_1, at.psi, cell, load)
    by_wall(AREA, by_area, load.e, here, rows)
    if load.wall[3] > 1:
        by_wall(INNER, by_inner, load.e, here, rows)
    by_wall(RATIO, by_c, load.e, here, rows)
    if len(load.rubber) > 1:
        by_wall(SECOND, by_2, load.e, here, rows)
        by_wall(THIRD, by_3, load.e, here, rows)


@kernel
def by_wall(k, changed, e, here, rows):
    """:func:`enter` a number on which only the wall's energy depends, and its slopes, as ``changed`` tells."""
    W_by, W_y, W_G, W_p = changed
    M_G, M_p = -e * W_G, -e * W_p
    dG, dp = answer(here.inverse, M_G, M_p, 0.0 * M_G, 0.0 * M_G)
    enter(k, dG, dp, -e * W_y, M_G, M_p, W_by, here, rows)


@kernel
def by_loads(here, rows):
    """Write what force, pressure and torque change of what loads are conjugate to."""
    i, yy, zero = here.per_s, here.yy, spread(0.0)
    dG, dp = answer(here.inverse, 0.5 * i, zero, zero, zero)
    half = 0.5 * i * dG
    by_load(FORCE, half, dp, dG, here, rows)
    by_load(PRESSURE, yy * half, yy * dp, yy * dG, here, rows)
    dG, dp = answer(here.inverse, zero, spread(1.0), zero, zero)
    by_load(TORQUE, 0.5 * i * dG, dp, dG, here, rows)


@kernel
def by_load(k, half, dp, dG, here, rows):
    """Write what load k changes of what loads are conjugate to."""
    put(rows, OF_LOADS + k, half)
    put(rows, OF_LOADS + NUMBERS + k, here.yy * half)
    put(rows, OF_LOADS + 2 * NUMBERS + k, dp)
    put(rows, OF_LOADS + 3 * NUMBERS + k, -(here.W_G * dG + here.W_p * dp))

"""How a place of known stretch and resultant answers to all numbers, for a vector of designs.

Along a tube the level of its first integral is the same (:mod:`..physics.first_integral`). With the multipliers a, b of the
families that are taut it is, at the G and psi that fibers and wall settle at, ::

    level = K = R sqrt(G) - e W + m psi - a g_a - b g_b,    K_G = K_psi = 0,    g = 0 of taut families

so a change of the level, of the stretch or of a number moves the resultant by what K's own derivatives tell,

    sqrt(G) dR = dlevel - K_y dy - K_number

and G and psi by a linear system of which the inverse is known in closed form for each kind of state::

    (dG, dpsi) = -inverse (K_G, K_psi by the change; g_a, g_b by it)

Walls change by a layer at either surface. By the tangents t_a and t_b of the angles each family changes by itself.
"""

from math import sqrt
from typing import NamedTuple

from ...jit import kernel
from ..either import isnt, select
from ..physics.fibers import is_taut
from ..physics.wall import energy, layer, rises
from .vector import get, put, spread

NUMBERS = 11
FAR = 2.0**27  # from a rubber's constant: what does not hang on it is rounding there
# what a place answers to, beside its stretch and level; the loads last
T_ALPHA, T_BETA, GAMMA, AREA, INNER, RATIO, SECOND, THIRD, FORCE, PRESSURE, TORQUE = range(NUMBERS)
# rows of each: what K, T = p y^2 + f, K_y, K_G, K_psi change by; G and psi at a fixed resultant; the wall's energy
BY_K, BY_T, BY_KY, BY_KG, BY_KP, BY_G, BY_PSI, BY_W, ROWS = range(9)


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
    """A place: stretch y, y^2, T, resultant R and R - T; sqrt(G) and 1/sqrt(G); twist rate; W and its slopes; derivatives
    of K; what G and psi change by with R, and with y; the :func:`inverse`, and both families.
    """

    y: float
    yy: float
    T: float
    R: float
    beyond: float
    s: float
    per_s: float
    psi: float
    W: float
    W_y: float
    W_G: float
    W_p: float
    K_y: float
    K_yy: float
    K_yG: float
    K_yp: float
    K_GG: float
    K_Gp: float
    K_pp: float
    G_R: float
    p_R: float
    G_y: float
    p_y: float
    inverse: tuple
    alpha: Family
    beta: Family


@kernel
def family(taut, t, multiplier, psi, yy):
    """The :class:`Family` of an angle."""
    on = t + psi
    return Family(taut, t, on, select(taut, multiplier, spread(0.0)), 2.0 * yy * on)


@kernel
def inverse(alpha, beta, K_GG, K_Gp, K_pp):
    """The seven numbers of ``-(dG, dpsi)`` by (K_G, K_psi, g_a, g_b): ``(GG, Gpsi, psipsi, Ga, psia, Gb, psib)``."""
    taut_alpha, taut_beta, turn_a, turn_b = alpha.taut, beta.taut, alpha.turn, beta.turn
    both, none = taut_alpha & taut_beta, isnt(taut_alpha | taut_beta)
    zero = 0.0 * K_GG
    apart = 1.0 / (turn_a - turn_b)
    turn = select(taut_alpha, turn_a, turn_b)
    cross = K_Gp - turn * K_GG
    bend = 1.0 / select(both, 1.0, turn * (turn * K_GG - 2.0 * K_Gp) + K_pp)
    det = 1.0 / select(none, K_GG * K_pp - K_Gp * K_Gp, 1.0)
    GG = select(both, zero, select(none, K_pp * det, turn * turn * bend))
    Gp = select(both, zero, select(none, -K_Gp * det, -turn * bend))
    pp = select(both, zero, select(none, K_GG * det, bend))
    G_one, p_one = 1.0 + turn * cross * bend, -cross * bend
    G_a = select(both, -turn_b * apart, select(taut_alpha, G_one, zero))
    p_a = select(both, apart, select(taut_alpha, p_one, zero))
    G_b = select(both, turn_a * apart, select(none | taut_alpha, zero, G_one))
    p_b = select(both, -apart, select(none | taut_alpha, zero, p_one))
    return GG, Gp, pp, G_a, p_a, G_b, p_b


@kernel
def answer(inverse, K_G, K_p, c_a, c_b):
    """``(dG, dpsi)`` of a change by which K's slopes by G and psi change by ``K_G``, ``K_p``, the constraints by c."""
    GG, Gp, pp, G_a, p_a, G_b, p_b = inverse
    return -(GG * K_G + Gp * K_p + G_a * c_a + G_b * c_b), -(Gp * K_G + pp * K_p + p_a * c_a + p_b * c_b)


@kernel
def place_at(y, beyond, at, cell, load):
    """The :class:`Place` of a stretch, of which R - T is ``beyond``, ``at`` its :class:`..physics.first_integral.Level`."""
    G_1, psi, e, yy = at.G_1, at.psi, load.e, y * y
    V = energy(y, G_1, psi, cell[2], load.rubber, load.wall)
    W, W_y, W_G, W_p, W_yy, W_yG, W_yp, W_GG, W_Gp, W_pp = V
    s, (taut_alpha, taut_beta) = sqrt(1.0 + G_1), is_taut(at.kind)
    alpha = family(taut_alpha, cell[0] + cell[1], at.a, psi, yy)
    beta = family(taut_beta, cell[0] - cell[1], at.b, psi, yy)
    T, i, a, b = load.p * yy + load.f, 1.0 / s, alpha.pull, beta.pull
    R = T + beyond
    turned, squared = a * alpha.on + b * beta.on, a * alpha.on * alpha.on + b * beta.on * beta.on
    K_GG, K_Gp, K_pp = -0.25 * R * i * i * i - e * W_GG, -e * W_Gp, -e * W_pp - 2.0 * yy * (a + b)
    K_yG, K_yp = -e * W_yG, -e * W_yp - 4.0 * y * turned
    settled = inverse(alpha, beta, K_GG, K_Gp, K_pp)
    G_R, p_R = -0.5 * i * settled[0], -0.5 * i * settled[1]
    G_y, p_y = answer(settled, K_yG, K_yp, 2.0 * y * alpha.on * alpha.on, 2.0 * y * beta.on * beta.on)
    return Place(
        y, yy, T, R, beyond, s, i, psi, W, W_y, W_G, W_p, -e * W_y - 2.0 * y * squared, -e * W_yy - 2.0 * squared,
        K_yG, K_yp, K_GG, K_Gp, K_pp, G_R, p_R, G_y, p_y, settled, alpha, beta,
    )  # fmt: skip


@kernel
def turned(here, by_y, by_G, by_p, dG, dp, dR):
    """What K_y changes by, of a change of its own derivatives by y, G and psi, as these answer with dG and dpsi, and the
    resultant with dR.
    """
    pull_G = by_G + here.K_GG * dG + here.K_Gp * dp + 0.5 * here.per_s * dR
    pull_p = by_p + here.K_Gp * dG + here.K_pp * dp
    return by_y + here.K_yG * dG + here.K_yp * dp + here.G_y * pull_G + here.p_y * pull_p


@kernel
def enter(row, changed, settled, dW):
    """Write what a number changes: K and K's derivatives ``changed`` (K, K_y, K_G, K_psi), as which G and psi have
    ``settled``, and the wall's energy. T it leaves.
    """
    K, K_y, K_G, K_p = changed
    put(row, BY_K, K)
    put(row, BY_KY, K_y)
    put(row, BY_KG, K_G)
    put(row, BY_KP, K_p)
    put(row, BY_G, settled[0])
    put(row, BY_PSI, settled[1])
    put(row, BY_W, dW)


@kernel
def by_numbers(here, at, cell, load, rows):
    """Write to ``rows`` (NUMBERS, ROWS, WIDTH) what all numbers change at a place."""
    zero, one = spread(0.0), spread(1.0)
    by_fibers(load.gamma, here, rows)
    by_walls(at, cell, load, here, rows)
    put(rows[FORCE], BY_T, one)  # all else of both is 0, as rows begin
    put(rows[PRESSURE], BY_T, here.yy)
    _, Gp, pp, _, _, _, _ = here.inverse
    enter(rows[TORQUE], (here.psi, zero, zero, one), (-Gp, -pp), zero)


@kernel
def by_fibers(gamma, here, rows):
    """:func:`enter` tan(angle) of both families, and their extension."""
    y, alpha, beta, gg, zero = here.y, here.alpha, here.beta, gamma * gamma, spread(0.0)
    _, Gp, pp, G_a, p_a, G_b, p_b = here.inverse
    c = alpha.turn - 2.0 * gg * alpha.t
    K = -alpha.pull * c, -4.0 * y * alpha.pull * alpha.on, zero, -2.0 * here.yy * alpha.pull
    enter(rows[T_ALPHA], K, (-(Gp * K[3] + G_a * c), -(pp * K[3] + p_a * c)), zero)
    c = beta.turn - 2.0 * gg * beta.t
    K = -beta.pull * c, -4.0 * y * beta.pull * beta.on, zero, -2.0 * here.yy * beta.pull
    enter(rows[T_BETA], K, (-(Gp * K[3] + G_b * c), -(pp * K[3] + p_b * c)), zero)
    longer = -2.0 * gamma * (1.0 + alpha.t * alpha.t), -2.0 * gamma * (1.0 + beta.t * beta.t)
    K = -(alpha.pull * longer[0] + beta.pull * longer[1]), zero, zero, zero
    enter(rows[GAMMA], K, (-(G_a * longer[0] + G_b * longer[1]), -(p_a * longer[0] + p_b * longer[1])), zero)


@kernel
def by_walls(at, cell, load, here, rows):
    """:func:`enter` the surfaces and the rubber's constants of a wall."""
    by_area, by_inner = by_surfaces(here, at, cell, load)
    by_wall(rows[AREA], by_area, load.e, here)
    if load.wall[3] > 1:
        by_wall(rows[INNER], by_inner, load.e, here)
    by_c, by_2, by_3 = by_rubber(here, at, cell[2], load.rubber, load.wall)
    by_wall(rows[RATIO], by_c, load.e, here)
    if len(load.rubber) > 1:
        by_wall(rows[SECOND], by_2, load.e, here)
        by_wall(rows[THIRD], by_3, load.e, here)


@kernel
def by_wall(row, changed, e, here):
    """:func:`enter` a number on which only the wall's energy depends, and its slopes, as ``changed`` tells."""
    W, W_y, W_G, W_p = changed
    GG, Gp, pp, _, _, _, _ = here.inverse
    enter(row, (-e * W, -e * W_y, -e * W_G, -e * W_p), (e * (GG * W_G + Gp * W_p), e * (Gp * W_G + pp * W_p)), W)


@kernel
def by_surfaces(here, at, cell, load):
    """Derivatives ``(W, W_y, W_G, W_psi)`` of the wall's energy by its area, and by the square of its inner radius."""
    y, G_1, psi = here.y, at.G_1, at.psi
    if load.wall[3] == 1:
        zero, share = 0.0 * y, 1.0 / cell[2]
        return (here.W * share, here.W_y * share, here.W_G * share, here.W_p * share), (zero, zero, zero, zero)
    inside, outside = load.wall[1], load.wall[1] + cell[2]
    w, w_y, w_G, w_p, _, _, _, _, _, _ = layer(outside, y, G_1, psi, load.rubber, load.wall[0])
    i, i_y, i_G, i_p, _, _, _, _, _, _ = layer(inside, y, G_1, psi, load.rubber, load.wall[0])
    return (w, w_y, w_G, w_p), (w - i, w_y - i_y, w_G - i_G, w_p - i_p)


@kernel
def by_rubber(here, at, area, rubber, wall):
    """Derivatives ``(W, W_y, W_G, W_psi)`` by each of three constants, 0 of those that the rubber does not have."""
    y, G_1, psi, far, zero = here.y, at.G_1, at.psi, spread(FAR), spread(0.0)
    none = zero, zero, zero, zero
    own = by_constant(rises(y, G_1, psi, area, (rubber[0] + far, *rubber[1:]), wall), here)
    if len(rubber) == 1:
        return own, none, none
    return (
        own,
        by_constant(rises(y, G_1, psi, area, (rubber[0], rubber[1] + far, rubber[2]), wall), here),
        by_constant(rises(y, G_1, psi, area, (rubber[0], rubber[1], rubber[2] + far), wall), here),
    )


@kernel
def by_constant(there, here):
    """Derivatives by a constant, in which energies are linear, from what they are FAR from here."""
    W, W_y, W_G, W_p = there
    return (W - here.W) / FAR, (W_y - here.W_y) / FAR, (W_G - here.W_G) / FAR, (W_p - here.W_p) / FAR


@kernel
def settled_by(row, here, dy, dR):
    """``(dG, dpsi, dW)`` of a number, where it moves the stretch by dy and the resultant by dR."""
    dG = get(row, BY_G) + here.G_R * dR + here.G_y * dy
    dp = get(row, BY_PSI) + here.p_R * dR + here.p_y * dy
    return dG, dp, get(row, BY_W) + here.W_y * dy + here.W_G * dG + here.W_p * dp

"""A place along a tube that is the same all along, from the level of its first integral.

Where nothing varies along x, ``L - v L_v`` is the same at every place. With the resultant R = T/cosine of the
meridian's angle, in place of T, G and psi are those of a uniform tube (the slope enters by R alone), and ::

    level = R sqrt(G) - e W(y, G, psi) + m psi,    R^2 - T^2 = (T v/s)^2 = L_v^2

The density of a uniform tube grows with its resultant by sqrt(G), and R follows from it without any derivative. Bonded
fibers leave G and psi no choice. Where loose ones do, and they are not yet known exactly, R is least at those that are
right, so that Newton's method for them (:mod:`relaxed`) goes on as if R were given.
"""

from math import sqrt
from typing import NamedTuple

from ...jit import kernel
from ..either import isnt, select, some
from . import membrane
from .fibers import BOTH_TAUT, axial, both_reach, given_at, holds, is_taut, lacking, multipliers, taut_twist
from .physical import LEAST, NO_ROOM, kind_of, place, place_beside
from .relaxed import beside, resultant
from .wall import energy, has_two_families, least_square, may_go_slack, rises, stored

LEVELS, CLOSE = 12, 1e-13  # of Newton's method for R alone, and how exactly it meets


class Level(NamedTuple):
    """What is known of a place: room, the resultant R, how R - T rises with y; G - 1, twist rate; which families are
    taut, and their multipliers, of a slack one about what it would push by, were it as long as it is wound; and e W.
    """

    room: float
    R: float
    rise: float
    G_1: float
    psi: float
    kind: float
    a: float
    b: float
    weighed: float


@kernel
def levelled(y, level, cell, load):
    """``(R, G - 1, psi, taut alpha, taut beta)``, whatever the neighbours are. The density is convex in R: from the
    second step on Newton's method comes from above.
    """
    given = given_at(y, 0.0 * y, cell, load)
    R = max(load.p * y * y + load.f, NO_ROOM)
    _, G_1, psi, alpha, beta = place(y, 0.0 * y, R, cell, load)
    going = y > 0.0
    for _ in range(LEVELS):
        better = resultant(
            level, given, axial(1.0 + G_1, 0.0), psi, stored(y, G_1, psi, given.area, given.rubber, given.wall)
        )
        change = abs(better - R)
        R = select(going, better, R)
        going = going & (change > CLOSE * R)
        if not some(going):
            break
        _, wide, twist, with_alpha, with_beta = place(y, 0.0 * y, R, cell, load)
        G_1, psi = select(going, wide, G_1), select(going, twist, psi)
        alpha, beta = (going & with_alpha) | (isnt(going) & alpha), (going & with_beta) | (isnt(going) & beta)
    return R, G_1, psi, alpha, beta


@kernel
def at_level(y, level, cell, load, near):
    """The :class:`Level` at one point, from what a neighbour handed on."""
    return _at_level(y, level, cell, load, near, load.wall)


@kernel
def _at_level(y, level, cell, load, near, wall):
    if len(wall) == 1:
        return level_of_membrane(y, level, cell, load)
    return level_of_wall(y, level, cell, load, near)


@kernel
def level_of_membrane(y, level, cell, load):
    """:func:`at_level` of the source's tube."""
    psi, psi_y, _, G_1, G_y, _ = membrane.kinematics(y, cell, load)
    w, w_y, _ = membrane.strain_energy(y, cell, load)
    p, m, area, G = load.p, load.m, load.e * cell[2], 1.0 + G_1
    s = sqrt(max(G, NO_ROOM))
    R = max((level + area * w - m * psi) / s, NO_ROOM)
    L_y = 2.0 * p * y * s + 0.5 * R * G_y / s - area * w_y + m * psi_y
    alpha, beta = membrane.multipliers(y, R / s, cell, load)
    return Level(min(G, p * y * y + load.f), R, -L_y / s, G_1, psi, BOTH_TAUT + 0.0 * y, alpha, beta, area * w)


@kernel
def level_of_wall(y, level, cell, load, near):
    """:func:`at_level` of a physical tube: where both families are taut, as bonded ones are, nothing has to be looked
    for.
    """
    wall = load.wall
    if has_two_families(wall):
        if not may_go_slack(wall):
            return level_if_taut(y, level, cell, load)
        taut = (near[0] < 0.0) | (near[0] == BOTH_TAUT)  # from other neighbours it is found where both go taut
        if not some(taut):
            return level_where_slack(y, level, cell, load, near)
        at = level_if_taut(y, level, cell, load)
        taut = taut & holds(at.a, at.R) & holds(at.b, at.R)
        if not some(isnt(taut)):
            return at
        slack = level_where_slack(y, level, cell, load, near)
        return Level(
            select(taut, at.room, slack.room), select(taut, at.R, slack.R), select(taut, at.rise, slack.rise),
            select(taut, at.G_1, slack.G_1), select(taut, at.psi, slack.psi), select(taut, at.kind, slack.kind),
            select(taut, at.a, slack.a), select(taut, at.b, slack.b), select(taut, at.weighed, slack.weighed),
        )  # fmt: skip
    return level_where_slack(y, level, cell, load, near)


@kernel
def level_if_taut(y, level, cell, load):
    """:func:`at_level` where both families are taut, or bonded."""
    H, D, gg, m, area = cell[0], cell[1], load.gamma * load.gamma, load.m, load.e * cell[2]
    psi, G_1 = taut_twist(y, H, gg), max(both_reach(y, H, D, gg, gg - 1.0), LEAST - 1.0)
    W, W_y, W_G, W_p = rises(y, G_1, psi, area, load.rubber, load.wall)
    s = sqrt(1.0 + G_1)
    i = 1.0 / s
    R, both = max((level + W - m * psi) * i, NO_ROOM), y == y
    a, b = multipliers(y, s, psi, (both, both), cell, R, m, W_G, W_p)
    ta, tb = H + D + psi, H - D + psi
    L_y = 2.0 * load.p * y * s - W_y - 2.0 * y * (a * ta * ta + b * tb * tb)
    room = room_of(y, 1.0 + G_1, load)
    return Level(room, R, -L_y * i, G_1, psi, BOTH_TAUT + 0.0 * y, a, b, W)


@kernel
def room_of(y, G, load):
    """What is positive where a place may be."""
    room = min(min(G - LEAST, y), load.p * y * y + load.f)
    return min(room, least_square(y, max(G, NO_ROOM), load.wall))


@kernel
def level_where_slack(y, level, cell, load, near):
    """:func:`at_level` where families may be slack."""
    H, D, gg, wall, still = cell[0], cell[1], load.gamma * load.gamma, load.wall, 0.0 * y
    given = given_at(y, still, cell, load)
    known, kind, G_1, psi, dG, dpsi, W, R, weighed = beside(given, (level, level), near)
    alpha, beta = is_taut(kind)
    lost = isnt(known)
    if some(lost):
        other, wide, twist, with_alpha, with_beta = levelled(y, level, cell, load)
        R, G_1, psi = select(lost, other, R), select(lost, wide, G_1), select(lost, twist, psi)
        dG, dpsi = select(lost, still, dG), select(lost, still, dpsi)
        alpha, beta = (lost & with_alpha) | (known & alpha), (lost & with_beta) | (known & beta)
        told = energy(y, G_1, psi, given.area, given.rubber, given.wall)
        whole, V = told[0], told[1:]
        weighed = select(lost, whole, weighed)
        W = (
            select(lost, V[0], W[0]), select(lost, V[1], W[1]), select(lost, V[2], W[2]), select(lost, V[3], W[3]),
            select(lost, V[4], W[4]), select(lost, V[5], W[5]), select(lost, V[6], W[6]), select(lost, V[7], W[7]),
            select(lost, V[8], W[8]),
        )  # fmt: skip
    W_y, W_G, W_p, _, W_yG, W_yp, W_GG, W_Gp, W_pp = W
    weighed = weighed + (W_G + 0.5 * W_GG * dG + W_Gp * dpsi) * dG + (W_p + 0.5 * W_pp * dpsi) * dpsi
    s = sqrt(max(1.0 + G_1, NO_ROOM))
    i = 1.0 / s
    a, b = multipliers(y, s, psi, (alpha, beta), cell, R, load.m, W_G, W_p)
    ta, tb = H + D + psi, H - D + psi
    turned, squared = a * ta + b * tb, a * ta * ta + b * tb * tb
    # the changes that are not made yet do something where one family is taut, or none
    t = select(alpha, ta, tb)
    along, K_GG = select(alpha | beta, 2.0 * y * t * t, 0.0), -0.25 * R * i * i * i - W_GG
    L_y = 2.0 * load.p * y * s - W_y - 2.0 * y * squared
    L_y = L_y + (load.p * y * i - W_yG - along * K_GG) * dG + (along * W_Gp - W_yp - 4.0 * y * turned) * dpsi
    more, both = K_GG * dG - W_Gp * dpsi, alpha & beta
    G_1, psi = G_1 + dG, psi + dpsi
    push_a, push_b = still, still
    if may_go_slack(wall):
        lack_a, lack_b = lacking(y, G_1, psi, H, D, gg, wall)
        bends = K_GG, -W_Gp, -W_pp - 2.0 * y * y * (a + b)
        push_a, push_b = pushes(y, (max(lack_a, 0.0), max(lack_b, 0.0)), (ta, tb), alpha | beta, t, bends)
        push_b = push_b if has_two_families(wall) else -lack_b  # what is not there never pulls
    a = select(alpha, a + select(both, 0.0, more), push_a)
    b = select(beta, b + select(both, 0.0, more), push_b)
    G = 1.0 + G_1
    return Level(room_of(y, G, load), R, -L_y * i, G_1, psi, kind_of(alpha, beta), a, b, weighed)


@kernel
def pushes(y, lacks, tangents, one, t, bends):
    """Multipliers of both families, of one that ``lacks`` something of being taut, were it wound by so much more: to first
    order, so that what it pulls by goes on behind the place where it goes slack. ``one`` where the other one is taut, and
    ``t`` its tan(angle) as the twist leaves it, those of both the ``tangents``; ``bends`` second derivatives of what is
    maximized.
    """
    K_GG, K_Gp, K_pp = bends
    square = 2.0 * y * y
    ca, cb, c = square * tangents[0], square * tangents[1], square * t  # -dG/dpsi of what stays as it is wound
    along = c * c * K_GG - 2.0 * c * K_Gp + K_pp
    apart = 1.0 / (ca - cb)
    stiff_a = stiff_b = along * apart * apart
    if some(isnt(one)):
        det = K_GG * K_pp - K_Gp * K_Gp
        stiff_a = select(one, stiff_a, det / (ca * ca * K_GG - 2.0 * ca * K_Gp + K_pp))
        stiff_b = select(one, stiff_b, det / (cb * cb * K_GG - 2.0 * cb * K_Gp + K_pp))
    return lacks[0] * stiff_a, lacks[1] * stiff_b


@kernel
def level_of(y, cell, load, near):
    """``(level, G - 1, twist rate, energy W of the wall)`` where the meridian has no slope."""
    return _level_of(y, cell, load, near, load.wall)


@kernel
def _level_of(y, cell, load, near, wall):
    if len(wall) == 1:
        psi, _, _, G_1, _, _ = membrane.kinematics(y, cell, load)
        return membrane.uniform_tube(y, cell, load)[2], G_1, psi, energy_of(y, G_1, psi, cell, load, wall)
    T = load.p * y * y + load.f
    _, G_1, psi, dG, dpsi, _, _, _ = place_beside(y, 0.0 * y, T, cell, load, near)
    G_1, psi = G_1 + dG, psi + dpsi
    level = (
        T * sqrt(max(1.0 + G_1, NO_ROOM)) - stored(y, G_1, psi, load.e * cell[2], load.rubber, load.wall) + load.m * psi
    )
    return level, G_1, psi, energy_of(y, G_1, psi, cell, load, wall)


@kernel
def energy_of(y, G_1, psi, cell, load, wall):
    """Energy W of the wall."""
    if len(wall) == 1:
        return cell[2] * membrane.strain_energy(y, cell, load)[0]
    return stored(y, G_1, psi, cell[2], load.rubber, load.wall)


@kernel
def summed(at, y, cosine, cell, load):
    """``(s, y^2 s, psi, W)`` of a place, whose meridian has that cosine."""
    s, counts = sqrt(max(1.0 + at.G_1, NO_ROOM)) * cosine, load.e > 0.0
    W = at.weighed / select(counts, load.e, 1.0)
    if some(isnt(counts)):
        W = select(counts, W, energy_of(y, at.G_1, at.psi, cell, load, load.wall))
    return s, y * y * s, at.psi, W

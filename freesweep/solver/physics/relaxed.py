"""Fibers at one point: meridional stretch and twist rate that the fibers leave a wall, by the circumferential stretch.

A fiber family with t = tan(angle) allows (theory, sections 2 and 10)::

    g_i = G + y^2 (t_i + psi)^2 - gamma^2 (1 + t_i^2) <= 0,   i = a, b

Bonded fibers hold both as equalities, and push where a multiplier is negative. Loose ones are threads: G and psi are then
where ``T s - W + m psi`` is largest, ``s = sqrt(G - v^2)``, which is strictly concave (W convex): one maximum. For a given
psi only one family can be taut, that which is the nearer; beyond the twist rate of both taut it is one family, before it the
other. So the signs of the two slopes there tell which side to go to, if any, and on a side the slope along psi, ::

    F(psi) = m - W_psi - 2 y^2 mu (t + psi),   mu = max(T/(2 s) - W_G, 0),

falls all along: Newton's method between bounds finds its root. Where ``mu`` is 0 the family is slack, too, and G is where
``T/(2 s) = W_G``.

A family that is not there is one whose threads are longer than their winding without end (:func:`spares`): it never
carries. One family alone is called alpha, whatever its name; one that is bonded is taut everywhere, pushed or not. A tube
without threads is a balloon.

Along a tube neighbours are alike: what is known of one point is the first guess of the next (:func:`beside`). As there is
one maximum, a place where no taut family is pushed and no slack one overreached is the one, however it was come to.
"""

from math import sqrt
from typing import NamedTuple

from ...jit import in_place, kernel
from ..either import isnt, select, some
from .fibers import (
    ALPHA_TAUT,
    BETA_TAUT,
    BOTH_TAUT,
    CLOSE,
    CRAMPED,
    ITERATIONS,
    NO_ROOM,
    NONE_TAUT,
    axial,
    both_reach,
    free_point,
    holds,
    most_taut,
    multipliers,
    pulled,
    reach,
    slopes_at,
    spares,
    spread_of,
    taut_twist,
)
from .wall import NONE, ONE_BONDED, energy, has_two_families, narrowest

NEARBY = 8  # looks from a neighbour's place; two do nearly always, four where a family goes slack


class Limp(NamedTuple):
    """G - 1 and psi that nothing holds, where they are ``known``; and where that is what is sought, as ``none`` is taut."""

    G_1: float
    psi: float
    known: bool
    none: bool


@kernel
def along_twist(given, T, psi, t):
    """On the side of one family: ``(F, F_psi, taut)``, the first two of the same positive factor."""
    G_1 = reach(given.y, psi, t, given.gg - 1.0)
    W, s = slopes_at(given, G_1, psi), axial(1.0 + G_1, given.v)
    F, F_p = pulled(given, T, psi, t, s, W)
    return F, F_p, 0.5 * T / s >= W[1]


@kernel
def is_between(at, near, far, side):
    """Whether ``at`` lies on the way from ``near`` to ``far``."""
    return ((at - near) * side >= 0.0) & ((far - at) * side >= 0.0)


@kernel
def is_loose(given, sides, G_1, psi):
    """Where no family is reached; ``sides`` are tan(angle) of the right one, beyond the twist of both taut, and the left."""
    stretch = given.gg - 1.0
    return G_1 <= min(reach(given.y, psi, sides[0], stretch), reach(given.y, psi, sides[1], stretch))


@kernel
def sides_of(y, H, D, wall):
    """tan(angle) of the family that is the nearer beyond the twist of both taut, (right), and before it, (left)."""
    if has_two_families(wall):
        return H + abs(D), H - abs(D)
    return H + D, H + D


@kernel
def bracket(given, t, side, low, psi):
    """Twist rates ``(near, far)`` between which one family ends on a ``side`` of that of both taut, ``psi``."""
    stretch = given.gg - 1.0
    width = sqrt(max(stretch * (1.0 + t * t) + t * t - low, 0.0)) / given.y
    edge = -t - side * width
    return select((edge - psi) * side > 0.0, edge, psi), -t + side * width


@in_place
def search(given, T, sides, side, t, ends, at, low, limp, going):
    """``(psi, what nothing holds)`` on the ``side`` of the family t, from a first guess between the ``ends``: F has the sign
    of the side at the near one, the other at the far one.
    """
    y, v, stretch = given.y, given.v, given.gg - 1.0
    bonded = y == y if given.wall[2] == ONE_BONDED else y < y
    near, far = ends
    unit = abs(far - near)
    for _ in range(ITERATIONS):
        F, F_p, taut = along_twist(given, T, at, t)
        taut = taut | bonded
        fresh = going & isnt(taut) & isnt(limp.known)
        if some(fresh):
            freed, turned = free_point(given, T, reach(y, at, t, stretch), at, low, fresh)
            free_1, free_psi = select(fresh, freed, limp.G_1), select(fresh, turned, limp.psi)
            none = limp.none | fresh & is_loose(given, sides, free_1, free_psi)
            limp, going = Limp(free_1, free_psi, limp.known | fresh, none), going & isnt(none)
        before = select(taut, F, limp.psi - at) * side > 0.0  # where the family is slack, that point tells the side
        near, far = select(going & before, at, near), select(going & isnt(before), at, far)
        new = at - F / F_p
        new = select((F_p < 0.0) & is_between(new, near, far, side), new, 0.5 * (near + far))
        to_G_1 = reach(y, new, t, stretch)
        unsettled = abs(to_G_1 - reach(y, at, t, stretch)) > CLOSE * max(1.0 + to_G_1 - v * v, NO_ROOM)
        change, at = abs(new - at), select(going, new, at)
        going = going & ((change > CLOSE * unit) | unsettled)
        if not some(going):
            break
    return at, limp


@kernel
def settle(given, T):
    """``(room, G - 1, psi, taut alpha, taut beta)``: where loose fibers leave the wall.

    ``room`` is that of the widest G beyond v^2, or beyond where the innermost layer would reach the axis.
    """
    y, v, H, D, gg, m, _, _, wall = given
    stretch, always, never = gg - 1.0, y == y, y < y
    single, bonded = never if has_two_families(wall) else always, always if wall[2] == ONE_BONDED else never
    low, widest, psi, best = spread_of(given)
    room = widest - low
    inside = (room > 0.0) & (y > 0.0)
    if wall[2] == NONE:
        free_1, free_psi = free_point(given, T, low + 1.0, psi, low, inside)
        return room, free_1, free_psi, never, never
    right, left = sides = sides_of(y, H, D, wall)
    G_1 = both_reach(y, H, D, gg, stretch) if has_two_families(wall) else reach(y, psi, right, stretch)
    if not some(inside):
        return room, G_1, psi, isnt(inside), isnt(inside)

    reached = G_1 > low
    here = select(reached, G_1, widest)
    W, s = slopes_at(given, here, psi), axial(1.0 + here, v)
    mu = 0.5 * T / s - W[1]
    held = reached & ((mu >= 0.0) | bonded)
    twice = 2.0 * y * y * mu
    beyond, short = m - W[2] - twice * (right + psi) > 0.0, m - W[2] - twice * (left + psi) < 0.0
    side = select(held, select(beyond, 1.0, -1.0), select(best > psi, 1.0, -1.0))
    both = isnt(inside & (isnt(held) | beyond | short | single))
    known = inside & reached & isnt(held)
    limp = Limp(here, psi, known, known & both)
    if some(known):
        free_1, free_psi = free_point(given, T, here, psi, low, known)
        limp = Limp(free_1, free_psi, known, known & is_loose(given, sides, free_1, free_psi))
        side = select(known, select(free_psi > psi, 1.0, -1.0), side)
    going = isnt(both | limp.none)
    if not some(going):
        return room, select(limp.none, limp.G_1, G_1), select(limp.none, limp.psi, psi), both, both

    t = select(side > 0.0, right, left)
    near, far = bracket(given, t, side, low, psi)
    F, F_p = pulled(given, T, psi, t, s, W)
    ahead, roomy = psi - F / F_p, G_1 - low > CRAMPED * room
    at = select(held & (F_p < 0.0) & is_between(ahead, near, far, side), ahead, select(roomy, psi, best))
    at = select(known, limp.psi, at)
    at = select(is_between(at, near, far, side), at, 0.5 * (near + far))
    at, limp = search(given, T, sides, side, t, (near, far), at, low, limp, going)
    one = isnt(both | limp.none)
    G_1 = select(one, reach(y, at, t, stretch), select(limp.none, limp.G_1, G_1))
    first = (side > 0.0) & (D > 0.0) | (side < 0.0) & isnt(D > 0.0) | single
    return room, G_1, select(one, at, select(limp.none, limp.psi, psi)), both | one & first, both | one & isnt(first)


@kernel
def resultant(level, given, s, psi, W):
    """The resultant T under which the density of a uniform tube, ``T sqrt(G) - W + m psi``, has that level. Of all G and
    psi it is least at those that the fibers take under it: what they are off counts by its square.
    """
    return max((level + W - given.m * psi) * (1.0 / s), NO_ROOM)


@kernel
def under(pull, given, G_1, psi, s):
    """``(the resultant that is meant by pull, W, its slopes)``: (T,), that one, without W; (level, level), the one of that
    level, where the slope is 0.
    """
    if len(pull) == 1:
        return pull[0], 0.0 * given.y, slopes_at(given, G_1, psi)
    told = energy(given.y, G_1, psi, given.area, given.rubber, given.wall)
    return resultant(pull[0], given, s, psi, told[0]), told[0], told[1:]


@kernel
def first_look(given, near):
    """``(which families are taut, both, t, G - 1, psi)``, as a neighbour's go on; t = tan(angle) where one is taut."""
    y, v, H, D, gg, _, _, _, wall = given
    stretch = gg - 1.0
    kind = select(near[0] >= 0.0, near[0], most_taut(wall))
    on, steeper = y - near[1], v - near[2]
    psi, G_1 = near[3] + on * near[4] + steeper * near[5], near[6] + on * near[7] + steeper * near[8]
    both, t = kind == BOTH_TAUT, H + select(kind == ALPHA_TAUT, D, -D)
    G_1 = select(kind == NONE_TAUT, G_1, reach(y, psi, t, stretch))
    return kind, both, t, select(both, both_reach(y, H, D, gg, stretch), G_1), select(both, taut_twist(y, H, gg), psi)


@kernel
def newton_step(given, T, kind, t, G_1, psi, s, W):
    """``(dG, dpsi, F_psi)``: a step of Newton's method where one family is taut, or none; 0 where both are."""
    y, still = given.y, 0.0 * given.y
    both, none = kind == BOTH_TAUT, kind == NONE_TAUT
    one = isnt(both | none)
    _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = W
    F, F_p = pulled(given, T, psi, t, s, W)
    dpsi = select(one, -F / F_p, still)
    dG = select(one, reach(y, psi + dpsi, t, given.gg - 1.0) - G_1, still)
    if some(none):
        i = 1.0 / s
        rise, turn, bend = 0.5 * T * i - W_G, given.m - W_p, 0.25 * T * i * i * i + W_GG
        per = 1.0 / (bend * W_pp - W_Gp * W_Gp)
        dpsi = select(none, (bend * turn - W_Gp * rise) * per, dpsi)
        dG = select(none, (W_pp * rise - W_Gp * turn) * per, dG)
    return dG, dpsi, F_p


@kernel
def overreached(given, kind, G_1, psi):
    """``(where a slack family is overreached, which are taut then)``; of two of them it is the nearer."""
    stretch, (spare_alpha, spare_beta) = given.gg - 1.0, spares(given.wall)
    slack_alpha = reach(given.y, psi, given.H + given.D, stretch) + spare_alpha - G_1
    slack_beta = reach(given.y, psi, given.H - given.D, stretch) + spare_beta - G_1
    nearer = select(slack_alpha < slack_beta, ALPHA_TAUT, BETA_TAUT)
    over = select(kind == ALPHA_TAUT, slack_beta, select(kind == BETA_TAUT, slack_alpha, min(slack_alpha, slack_beta)))
    more = isnt(kind == BOTH_TAUT) & (over < 0.0)
    return more, select(more, select(kind == NONE_TAUT, nearer, BOTH_TAUT), kind)


@kernel
def beside(given, pull, near):
    """Newton's method for G and psi from what a neighbour handed on, ``near`` = (which families are taut, or -1 where
    nothing is known, y, v, psi, psi_y, psi_v, G - 1, G_y, G_v), under a ``pull`` (:func:`under`). A family that would have
    to push goes slack, a slack one that is overreached goes taut; where none does any more, this is the maximum.

    Returns ``(known, which families are taut, G - 1, psi, dG, dpsi, slopes of W, the resultant, W of a level)``. The last
    change, which is too small to look once more, is not yet made.
    """
    y, v, H, D, gg, m, _, _, wall = given
    stretch, low, still = gg - 1.0, max(v * v, narrowest(y, wall)) - 1.0, 0.0 * y
    both_psi, both_G_1 = taut_twist(y, H, gg), both_reach(y, H, D, gg, stretch)
    kind, both, t, G_1, psi = first_look(given, near)
    known, bonded = y > 0.0, y == y if wall[2] == ONE_BONDED else y < y
    dpsi, dG, going, W = still, still, known, (still, still, still, still, still, still, still, still, still)
    T, whole = still + pull[0], still
    for _ in range(NEARBY):
        known = known & (isnt(going) | (G_1 > low))
        going = going & known
        if not some(going):
            break
        s, before = axial(1.0 + G_1, v), kind
        T, whole, W = under(pull, given, G_1, psi, s)
        a, b = multipliers(y, s, psi, (both, both), (H, D), T, m, W[1], W[2])
        kind = select(
            both,
            select(holds(a, T), ALPHA_TAUT, NONE_TAUT) + select(holds(b, T), BETA_TAUT, NONE_TAUT),
            select(holds(0.5 * T * (1.0 / s) - W[1], T) | bonded, kind, NONE_TAUT),
        )
        both, none = kind == BOTH_TAUT, kind == NONE_TAUT
        t = H + select(kind == ALPHA_TAUT, D, -D)
        wider, further, F_p = newton_step(given, T, kind, t, G_1, psi, s, W)
        dG, dpsi = select(going, wider, dG), select(going, further, dpsi)
        known = known & (isnt(going & isnt(both | none)) | (F_p < 0.0))
        to_psi, to_G_1 = psi + dpsi, G_1 + dG
        more, then = overreached(given, kind, to_G_1, to_psi)
        last = (abs(then - kind) < 0.5) & (y * abs(dpsi) < CLOSE) & (abs(dG) < CLOSE * s * s)
        kind = select(going, then, before)
        going = going & isnt(last)
        both, t = kind == BOTH_TAUT, H + select(kind == ALPHA_TAUT, D, -D)
        to_G_1 = select(both, both_G_1, select(more & none, reach(y, to_psi, t, stretch), to_G_1))
        psi, G_1 = select(going, select(both, both_psi, to_psi), psi), select(going, to_G_1, G_1)
    return known & isnt(going), kind, G_1, psi, dG, dpsi, W, T, whole

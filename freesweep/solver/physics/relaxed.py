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

from ...jit import kernel
from ..either import isnt, select, some
from .wall import LOOSE, NONE, ONE_BONDED, has_two_families, narrowest, slopes, stored

ITERATIONS = 60  # five do nearly always
CLOSE = 1e-7  # of the unit of what is sought: the next step of Newton's method is its square
SHORT = 0.1  # share of the way to the edge of the domain that a step in G leaves; none is longer in the other direction
LONG = 1.0  # largest step of y psi
CRAMPED = 0.2  # share of the largest room below which both-taut is no place to start from
NO_ROOM = 1e-30  # stands for G - v^2 where that is negative
NEARBY = 8  # looks from a neighbour's place; two do nearly always, four where a family goes slack
NONE_TAUT, ALPHA_TAUT, BETA_TAUT, BOTH_TAUT = 0.0, 1.0, 2.0, 3.0
ENDLESS = 1e300  # longer than anything


@kernel
def taut_twist(y, H, gg):
    """Twist rate of both families taut (Eqs. 2.3, 2.4)."""
    return H * (gg / (y * y) - 1.0)


@kernel
def reach(y, psi, t, stretch):
    """G - 1 up to which a family is not taut; ``stretch`` is gamma^2 - 1."""
    return stretch * (1.0 + t * t) - (y * (t + psi) - t) * (y * (t + psi) + t)


@kernel
def both_reach(y, H, D, gg, stretch):
    """G - 1 of both families taut."""
    return stretch + ((y - 1.0) * (y + 1.0) - stretch) * (H * H * gg / (y * y) - D * D)


@kernel
def spares(wall):
    """By how much G - 1 may be more than the winding of each family allows, (alpha, beta): without end of one that is not
    there.
    """
    if len(wall) == 1:
        return 0.0, 0.0
    return (0.0 if wall[2] < NONE else ENDLESS), (0.0 if wall[2] <= LOOSE else ENDLESS)


@kernel
def most_taut(wall):
    """All families that there are, as one number."""
    return BOTH_TAUT if wall[2] <= LOOSE else ALPHA_TAUT if wall[2] < NONE else NONE_TAUT


@kernel
def axial(G, v):
    """Axial stretch s."""
    return sqrt(max(G - v * v, NO_ROOM))


@kernel
def free_point(y, G_1, psi, low, v, T, m, area, rubber, wall, todo):
    """``(G - 1, psi)`` that nothing holds, from a first guess above ``low``. Only where it is to do. Newton's method is one
    along the meridional stretch q = sqrt(G): a thick wall's W is convex in that, not in G.
    """
    least = sqrt(1.0 + low)
    for _ in range(ITERATIONS):
        _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = slopes(y, G_1, psi, area, rubber, wall)
        q, s = sqrt(1.0 + G_1), axial(1.0 + G_1, v)
        rise, turn, cross = q * (T / s - 2.0 * W_G), m - W_p, 2.0 * q * W_Gp
        bend = abs(T * v * v / (s * s * s) + 2.0 * W_G + 4.0 * q * q * W_GG)
        cross = select(bend * W_pp > cross * cross, cross, 0.0)  # far off the step is one along q, and one along psi
        det = bend * W_pp - cross * cross
        wider, further = (W_pp * rise - cross * turn) / det, (bend * turn - cross * rise) / det
        most = (1.0 - SHORT) * (q - least)
        share = min(min(most / max(abs(wider), NO_ROOM), LONG / max(y * abs(further), NO_ROOM)), 1.0)
        G_1 = select(todo, G_1 + share * wider * (2.0 * q + share * wider), G_1)
        psi = select(todo, psi + share * further, psi)
        todo = todo & ((q * abs(wider) >= CLOSE * s * s) | (y * abs(further) >= CLOSE))
        if not some(todo):
            break
    return G_1, psi


@kernel
def pulled(y, psi, t, s, T, m, W_G, W_p, W_GG, W_Gp, W_pp):
    """``(F, F_psi)`` where the family is taut, both times s."""
    b = 2.0 * y * y * (t + psi)  # -dG/dpsi
    b_p = 2.0 * y * y
    rest = m - W_p + b * W_G
    rest_p = -(W_pp - b * W_Gp) + b_p * W_G + b * (W_Gp - b * W_GG)
    return s * rest - 0.5 * T * b, -0.5 * b / s * rest + s * rest_p - 0.5 * T * b_p


@kernel
def along_twist(y, psi, t, stretch, v, T, m, area, rubber, wall):
    """On the side of one family: ``(F, F_psi, taut)``, the first two of the same positive factor."""
    G_1 = reach(y, psi, t, stretch)
    _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = slopes(y, G_1, psi, area, rubber, wall)
    s = axial(1.0 + G_1, v)
    F, F_p = pulled(y, psi, t, s, T, m, W_G, W_p, W_GG, W_Gp, W_pp)
    return F, F_p, 0.5 * T / s >= W_G


@kernel
def is_between(at, near, far, side):
    """Whether ``at`` lies on the way from ``near`` to ``far``."""
    return ((at - near) * side >= 0.0) & ((far - at) * side >= 0.0)


@kernel
def lacking(y, G_1, psi, H, D, gg, wall):
    """By how much ``G_1`` would have to grow for the threads of each family to be taut, (alpha, beta)."""
    spare_alpha, spare_beta = spares(wall)
    stretch = gg - 1.0
    return reach(y, psi, H + D, stretch) + spare_alpha - G_1, reach(y, psi, H - D, stretch) + spare_beta - G_1


@kernel
def spread_of(y, v, H, D, gg, wall):
    """``(low, widest, psi, best)``: bounds of G - 1, the twist of both taut and that at which G may be widest; of fewer
    families than two one where there is much room.
    """
    stretch = gg - 1.0
    low = max(v * v, narrowest(y, wall)) - 1.0
    if not has_two_families(wall):
        best, still = -(H + D) + 0.0 * y, 0.0 * y
        widest = reach(y, best, H + D, stretch) + spares(wall)[0]
        return low, widest, select(reach(y, still, H + D, stretch) - low > CRAMPED * (widest - low), still, best), best
    psi = taut_twist(y, H, gg)
    # beyond the twist of both taut (to the right) alpha is the nearer if D > 0; its reach is widest at psi = -t
    right, left = H + abs(D), H - abs(D)
    best = min(max(psi, -right), -left)
    apart = (psi < -right) | (psi > -left)
    side = select(psi < -right, right, left)
    return low, select(apart, reach(y, best, side, stretch), both_reach(y, H, D, gg, stretch)), psi, best


@kernel
def is_taut(kind):
    """Which families are taut, alpha and beta, from one number."""
    return (kind == ALPHA_TAUT) | (kind == BOTH_TAUT), (kind == BETA_TAUT) | (kind == BOTH_TAUT)


@kernel
def under(pull, y, G_1, psi, m, area, rubber, wall):
    """The resultant that is meant by ``pull``: (T,), that one; (level, level), the one under which the density of a uniform
    tube, ``T sqrt(G) - W + m psi``, has that level. Of all G and psi it is least at those that the fibers take under it:
    what they are off counts by its square.
    """
    if len(pull) == 1:
        return pull[0]
    return max((pull[0] + stored(y, G_1, psi, area, rubber, wall) - m * psi) / axial(1.0 + G_1, 0.0 * y), NO_ROOM)


@kernel
def beside(y, v, H, D, gg, pull, m, area, rubber, wall, near):
    """Newton's method for G and psi from what a neighbour handed on, ``near`` = (which families are taut, or -1 where
    nothing is known, y, v, psi, psi_y, psi_v, G - 1, G_y, G_v), under a ``pull`` (:func:`under`). A family that would have
    to push goes slack, a slack one that is overreached goes taut; where none does any more, this is the maximum.

    Returns ``(known, which families are taut, G - 1, psi, dG, dpsi, slopes of W, the resultant)``. The last change, which is
    too small to look once more, is not yet made.
    """
    stretch, low, still = gg - 1.0, max(v * v, narrowest(y, wall)) - 1.0, 0.0 * y
    spare_alpha, spare_beta = spares(wall)
    kind = select(near[0] >= 0.0, near[0], most_taut(wall))
    on, steeper = y - near[1], v - near[2]
    both_psi, both_G_1 = taut_twist(y, H, gg), both_reach(y, H, D, gg, stretch)
    psi, G_1 = near[3] + on * near[4] + steeper * near[5], near[6] + on * near[7] + steeper * near[8]
    both, t = kind == BOTH_TAUT, H + select(kind == ALPHA_TAUT, D, -D)
    G_1 = select(both, both_G_1, select(kind == NONE_TAUT, G_1, reach(y, psi, t, stretch)))
    psi = select(both, both_psi, psi)
    known, bonded = y > 0.0, y == y if wall[2] == ONE_BONDED else y < y
    dpsi, dG, going, W = still, still, known, (still, still, still, still, still, still, still, still, still)
    T = still + pull[0]
    for _ in range(NEARBY):
        known = known & (isnt(going) | (G_1 > low))
        going = going & known
        if not some(going):
            break
        W = slopes(y, G_1, psi, area, rubber, wall)
        _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = W
        s, before, T = axial(1.0 + G_1, v), kind, under(pull, y, G_1, psi, m, area, rubber, wall)
        a, b = multipliers(y, s, psi, both, both, H, D, T, m, W_G, W_p)
        total = 0.5 * T / s - W_G
        kind = select(
            both,
            select(a >= 0.0, ALPHA_TAUT, NONE_TAUT) + select(b >= 0.0, BETA_TAUT, NONE_TAUT),
            select((total >= 0.0) | bonded, kind, NONE_TAUT),
        )
        both, none = kind == BOTH_TAUT, kind == NONE_TAUT
        one, t = isnt(both | none), H + select(kind == ALPHA_TAUT, D, -D)
        F, F_p = pulled(y, psi, t, s, T, m, W_G, W_p, W_GG, W_Gp, W_pp)
        known = known & (isnt(going & one) | (F_p < 0.0))
        dpsi = select(one, -F / F_p, still)
        dG = select(one, reach(y, psi + dpsi, t, stretch) - G_1, still)
        if some(none):
            twist, bend = m - W_p, 0.25 * T / (s * s * s) + W_GG
            det = bend * W_pp - W_Gp * W_Gp
            dpsi = select(none, (bend * twist - W_Gp * total) / det, dpsi)
            dG = select(none, (W_pp * total - W_Gp * twist) / det, dG)
        to_psi, to_G_1 = psi + dpsi, G_1 + dG
        slack_alpha = reach(y, to_psi, H + D, stretch) + spare_alpha - to_G_1
        slack_beta = reach(y, to_psi, H - D, stretch) + spare_beta - to_G_1
        nearer = select(slack_alpha < slack_beta, ALPHA_TAUT, BETA_TAUT)
        over = select(
            kind == ALPHA_TAUT, slack_beta, select(kind == BETA_TAUT, slack_alpha, min(slack_alpha, slack_beta))
        )
        more = isnt(both) & (over < 0.0)
        then = select(more, select(none, nearer, BOTH_TAUT), kind)
        last = (abs(then - before) < 0.5) & (y * abs(dpsi) < CLOSE) & (abs(dG) < CLOSE * s * s)
        kind = select(going, then, before)
        going = going & isnt(last)
        both, t = kind == BOTH_TAUT, H + select(kind == ALPHA_TAUT, D, -D)
        to_G_1 = select(both, both_G_1, select(more & none, reach(y, to_psi, t, stretch), to_G_1))
        psi, G_1 = select(going, select(both, both_psi, to_psi), psi), select(going, to_G_1, G_1)
    return known & isnt(going), kind, G_1, psi, dG, dpsi, W, T


@kernel
def settle(y, v, H, D, gg, T, m, area, rubber, wall):
    """``(room, G - 1, psi, taut alpha, taut beta)``: where loose fibers leave the wall.

    ``room`` is that of the widest G beyond v^2, or beyond where the innermost layer would reach the axis.
    """
    stretch, right, left = gg - 1.0, H + abs(D), H - abs(D)
    always, never = y == y, y < y
    single, bonded = never if has_two_families(wall) else always, always if wall[2] == ONE_BONDED else never
    low, widest, psi, best = spread_of(y, v, H, D, gg, wall)
    G_1, room = both_reach(y, H, D, gg, stretch), widest - low
    inside = (room > 0.0) & (y > 0.0)
    if wall[2] == NONE:
        free_1, free_psi = free_point(y, low + 1.0, psi, low, v, T, m, area, rubber, wall, inside)
        return room, free_1, free_psi, never, never
    if not has_two_families(wall):
        right = left = H + D
        G_1 = reach(y, psi, right, stretch)
    if not some(inside):
        return room, G_1, psi, isnt(inside), isnt(inside)

    reached, roomy = G_1 > low, G_1 - low > CRAMPED * room
    here = select(reached, G_1, widest)
    _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = slopes(y, here, psi, area, rubber, wall)
    s = axial(1.0 + here, v)
    mu = 0.5 * T / s - W_G
    held = reached & ((mu >= 0.0) | bonded)
    twice = 2.0 * y * y * mu
    beyond, short = m - W_p - twice * (right + psi) > 0.0, m - W_p - twice * (left + psi) < 0.0
    side = select(held, select(beyond, 1.0, -1.0), select(best > psi, 1.0, -1.0))
    both = isnt(inside & (isnt(held) | beyond | short | single))
    free_1, free_psi, known = here, psi, inside & reached & isnt(held)
    none = known & both
    if some(known):
        free_1, free_psi = free_point(y, here, psi, low, v, T, m, area, rubber, wall, known)
        none = known & (free_1 <= min(reach(y, free_psi, right, stretch), reach(y, free_psi, left, stretch)))
        side = select(known, select(free_psi > psi, 1.0, -1.0), side)
    going = isnt(both | none)
    if not some(going):
        return room, select(none, free_1, G_1), select(none, free_psi, psi), both, both

    t = select(side > 0.0, right, left)
    width = sqrt(max(stretch * (1.0 + t * t) + t * t - low, 0.0)) / y
    far = -t + side * width  # F has the sign of the side near both taut, the other there
    edge = -t - side * width
    near = select((edge - psi) * side > 0.0, edge, psi)
    unit = abs(far - near)
    F, F_p = pulled(y, psi, t, s, T, m, W_G, W_p, W_GG, W_Gp, W_pp)
    ahead = psi - F / F_p
    at = select(held & (F_p < 0.0) & is_between(ahead, near, far, side), ahead, select(roomy, psi, best))
    at = select(known, free_psi, at)
    at = select(is_between(at, near, far, side), at, 0.5 * (near + far))
    for _ in range(ITERATIONS):
        F, F_p, taut = along_twist(y, at, t, stretch, v, T, m, area, rubber, wall)
        taut = taut | bonded
        limp = going & isnt(taut)
        fresh = limp & isnt(known)
        if some(fresh):
            freed, turned = free_point(y, reach(y, at, t, stretch), at, low, v, T, m, area, rubber, wall, fresh)
            free_1, free_psi, known = select(fresh, freed, free_1), select(fresh, turned, free_psi), known | fresh
            none = none | fresh & (free_1 <= min(reach(y, free_psi, right, stretch), reach(y, free_psi, left, stretch)))
            going = going & isnt(none)
        before = select(taut, F, free_psi - at) * side > 0.0  # where the family is slack, that point tells the side
        near, far = select(going & before, at, near), select(going & isnt(before), at, far)
        new = at - F / F_p
        new = select((F_p < 0.0) & is_between(new, near, far, side), new, 0.5 * (near + far))
        to_G_1 = reach(y, new, t, stretch)
        unsettled = abs(to_G_1 - reach(y, at, t, stretch)) > CLOSE * max(1.0 + to_G_1 - v * v, NO_ROOM)
        change, at = abs(new - at), select(going, new, at)
        going = going & ((change > CLOSE * unit) | unsettled)
        if not some(going):
            break
    one = isnt(both | none)
    G_1 = select(one, reach(y, at, t, stretch), select(none, free_1, G_1))
    first = (side > 0.0) & (D > 0.0) | (side < 0.0) & isnt(D > 0.0) | single
    return room, G_1, select(one, at, select(none, free_psi, psi)), both | one & first, both | one & isnt(first)


@kernel
def multipliers(y, s, psi, taut_alpha, taut_beta, H, D, T, m, W_G, W_p):
    """Multipliers of both families, 0 of a slack one."""
    total = 0.5 * T / s - W_G
    difference = ((m - W_p) / (2.0 * y * y) - total * (H + psi)) / D
    both = taut_alpha & taut_beta
    return (
        select(both, 0.5 * (total + difference), select(taut_alpha, total, 0.0)),
        select(both, 0.5 * (total - difference), select(taut_beta, total, 0.0)),
    )

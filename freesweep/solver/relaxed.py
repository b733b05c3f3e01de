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
"""

from math import sqrt

from ..jit import kernel
from .wall import energy, narrowest

ITERATIONS = 60  # five do nearly always
CLOSE = 1e-9  # of the unit of what is sought: the next step of Newton's method is its square
SHORT = 0.1  # share of the way to the edge of the domain that a step in G leaves
CRAMPED = 0.2  # share of the largest room below which both-taut is no place to start from
NO_ROOM = 1e-30  # stands for G - v^2 where that is negative


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
def axial(G, v):
    """Axial stretch s."""
    return sqrt(max(G - v * v, NO_ROOM))


@kernel
def free_stretch(y, psi, G_1, low, v, T, area, rubber, wall):
    """G - 1 that nothing holds, between ``low`` and ``G_1``, at which T/(2 s) < W_G; and dG/dpsi there."""
    change, slope = 1.0, 0.0
    for _ in range(ITERATIONS):
        _, _, W_G, _, _, _, _, W_GG, W_Gp, _ = energy(y, G_1, psi, area, rubber, wall)
        s = axial(1.0 + G_1, v)
        bend = 0.25 * T / (s * s * s) + W_GG
        slope = -W_Gp / bend
        change = (0.5 * T / s - W_G) / bend
        G_1 = max(G_1 + change, low + SHORT * (G_1 - low))
        if abs(change) < CLOSE * (1.0 + G_1):
            break
    return G_1, slope


@kernel
def along_twist(y, psi, t, stretch, low, v, T, m, area, rubber, wall):
    """On the side of one family: ``(F, F_psi, taut, G - 1)``, both of the same positive factor."""
    G_1 = reach(y, psi, t, stretch)
    _, _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = energy(y, G_1, psi, area, rubber, wall)
    s = axial(1.0 + G_1, v)
    if 0.5 * T / s >= W_G:
        b = 2.0 * y * y * (t + psi)  # -dG/dpsi
        b_p = 2.0 * y * y
        rest = m - W_p + b * W_G
        rest_p = -(W_pp - b * W_Gp) + b_p * W_G + b * (W_Gp - b * W_GG)
        return s * rest - 0.5 * T * b, -0.5 * b / s * rest + s * rest_p - 0.5 * T * b_p, True, G_1
    G_1, slope = free_stretch(y, psi, G_1, low, v, T, area, rubber, wall)
    _, _, _, W_p, _, _, _, _, W_Gp, W_pp = energy(y, G_1, psi, area, rubber, wall)
    return m - W_p, -(W_pp + W_Gp * slope), False, G_1


@kernel
def settle(y, v, H, D, gg, T, m, area, rubber, wall):
    """``(room, G - 1, psi, taut alpha, taut beta)``: where loose fibers leave the wall.

    ``room`` is that of the widest G beyond v^2, or beyond where the innermost layer would reach the axis.
    """
    stretch = gg - 1.0
    psi, G_1 = taut_twist(y, H, gg), both_reach(y, H, D, gg, stretch)
    low = max(v * v, narrowest(y, wall)) - 1.0
    # beyond the twist of both taut (to the right) alpha is the nearer if D > 0; its reach is widest at psi = -t
    right, left = (H + D, H - D) if D > 0.0 else (H - D, H + D)
    widest, best = G_1, psi
    if psi < -right:
        widest, best = reach(y, -right, right, stretch), -right
    elif psi > -left:
        widest, best = reach(y, -left, left, stretch), -left
    room = widest - low
    if not (room > 0.0 and y > 0.0):
        return room, G_1, psi, True, True
    side, roomy = 0.0, G_1 - low > CRAMPED * room
    if G_1 > low:
        _, _, W_G, W_p, _, _, _, _, _, _ = energy(y, G_1, psi, area, rubber, wall)
        s = axial(1.0 + G_1, v)
        mu = 0.5 * T / s - W_G
        if mu >= 0.0:
            twice = 2.0 * y * y * mu
            if m - W_p - twice * (right + psi) > 0.0:
                side = 1.0
            elif m - W_p - twice * (left + psi) < 0.0:
                side = -1.0
            else:
                return room, G_1, psi, True, True
        else:
            free, _ = free_stretch(y, psi, G_1, low, v, T, area, rubber, wall)
            _, _, _, W_p, _, _, _, _, _, _ = energy(y, free, psi, area, rubber, wall)
            if m == W_p:
                return room, free, psi, False, False
            side = 1.0 if m > W_p else -1.0
    else:
        side = 1.0 if best > psi else -1.0
    t = right if side > 0.0 else left
    width = sqrt(stretch * (1.0 + t * t) + t * t - low) / y
    near, far = psi, -t + side * width  # F has the sign of the side here, the other there
    if (-t - side * width - near) * side > 0.0:
        near = -t - side * width
    unit = abs(far - near)
    at = psi if roomy else best
    if (at - near) * side < 0.0 or (far - at) * side < 0.0:
        at = 0.5 * (near + far)
    taut = True
    for _ in range(ITERATIONS):
        F, F_p, taut, G_1 = along_twist(y, at, t, stretch, low, v, T, m, area, rubber, wall)
        if F * side > 0.0:
            near = at
        else:
            far = at
        new = at - F / F_p
        if not (F_p < 0.0 and (new - near) * side >= 0.0 and (far - new) * side >= 0.0):
            new = 0.5 * (near + far)
        change = abs(new - at)
        at = new
        if change <= CLOSE * unit:
            break
    G_1 = reach(y, at, t, stretch)
    if not taut:
        G_1, _ = free_stretch(y, at, G_1, low, v, T, area, rubber, wall)
    alpha = taut and ((side > 0.0) == (D > 0.0))
    return room, G_1, at, alpha, taut and not alpha


@kernel
def multipliers(y, s, psi, taut_alpha, taut_beta, H, D, T, m, W_G, W_p):
    """Multipliers of both families, 0 of a slack one."""
    total = 0.5 * T / s - W_G
    if taut_alpha and taut_beta:
        difference = ((m - W_p) / (2.0 * y * y) - total * (H + psi)) / D
        return 0.5 * (total + difference), 0.5 * (total - difference)
    return (total if taut_alpha else 0.0), (total if taut_beta else 0.0)

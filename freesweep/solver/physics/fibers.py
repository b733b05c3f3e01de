"""What fibers allow at one point: reach, twist rate and multipliers of both families, and what nothing holds."""

from math import sqrt
from typing import NamedTuple

from ...jit import kernel
from ..either import select, some
from .wall import LOOSE, NONE, has_two_families, narrowest, slopes

ITERATIONS = 60  # five do nearly always
CLOSE = 1e-7  # of the unit of what is sought: the next step of Newton's method is its square
SHORT = 0.1  # share of the way to the edge of the domain that a step in G leaves; none is longer in the other direction
LONG = 1.0  # largest step of y psi
CRAMPED = 0.2  # share of the largest room below which both-taut is no place to start from
FAINT = (
    1e-9  # of the resultant: a family that would have to push by less stays taut beside the place where it goes slack
)
NO_ROOM = 1e-30  # stands for G - v^2 where that is negative
NONE_TAUT, ALPHA_TAUT, BETA_TAUT, BOTH_TAUT = 0.0, 1.0, 2.0, 3.0
ENDLESS = 1e300  # longer than anything


class Given(NamedTuple):
    """What is given at one point: circumferential stretch, slope; H, D and gamma^2 of the fibers; torque; section, rubber
    and ``load.wall``.
    """

    y: float
    v: float
    H: float
    D: float
    gg: float
    m: float
    area: float
    rubber: tuple
    wall: tuple


@kernel
def given_at(y, v, cell, load):
    """What is given at one point of a tube."""
    return Given(y, v, cell[0], cell[1], load.gamma * load.gamma, load.m, load.e * cell[2], load.rubber, load.wall)


@kernel
def slopes_at(given, G_1, psi):
    """Slopes of the wall's energy, as of :func:`.wall.slopes`."""
    return slopes(given.y, G_1, psi, given.area, given.rubber, given.wall)


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
def free_point(given, T, G_1, psi, low, todo):
    """``(G - 1, psi)`` that nothing holds, from a first guess above ``low``. Only where it is to do. Newton's method is one
    along the meridional stretch q = sqrt(G): a thick wall's W is convex in that, not in G.
    """
    y, v, least = given.y, given.v, sqrt(1.0 + low)
    for _ in range(ITERATIONS):
        _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = slopes_at(given, G_1, psi)
        q, s = sqrt(1.0 + G_1), axial(1.0 + G_1, v)
        rise, turn, cross = q * (T / s - 2.0 * W_G), given.m - W_p, 2.0 * q * W_Gp
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
def pulled(given, T, psi, t, s, W):
    """``(F, F_psi)`` where the family is taut, both times s; W are the slopes there."""
    _, W_G, W_p, _, _, _, W_GG, W_Gp, W_pp = W
    b = 2.0 * given.y * given.y * (t + psi)  # -dG/dpsi
    b_p = 2.0 * given.y * given.y
    rest = given.m - W_p + b * W_G
    rest_p = -(W_pp - b * W_Gp) + b_p * W_G + b * (W_Gp - b * W_GG)
    return s * rest - 0.5 * T * b, -0.5 * b * (1.0 / s) * rest + s * rest_p - 0.5 * T * b_p


@kernel
def lacking(y, G_1, psi, H, D, gg, wall):
    """By how much ``G_1`` would have to grow for the threads of each family to be taut, (alpha, beta)."""
    spare_alpha, spare_beta = spares(wall)
    stretch = gg - 1.0
    return reach(y, psi, H + D, stretch) + spare_alpha - G_1, reach(y, psi, H - D, stretch) + spare_beta - G_1


@kernel
def spread_of(given):
    """``(low, widest, psi, best)``: bounds of G - 1, the twist of both taut and that at which G may be widest; of fewer
    families than two one where there is much room.
    """
    y, v, H, D, gg, _, _, _, wall = given
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
def holds(multiplier, T):
    """Whether a family pulls, or all but does."""
    return multiplier >= -FAINT * T


@kernel
def is_taut(kind):
    """Which families are taut, alpha and beta, from one number."""
    return (kind == ALPHA_TAUT) | (kind == BOTH_TAUT), (kind == BETA_TAUT) | (kind == BOTH_TAUT)


@kernel
def multipliers(y, s, psi, taut, cell, T, m, W_G, W_p):
    """Multipliers of both families, alpha and beta, 0 of one that is not ``taut``."""
    total = 0.5 * T * (1.0 / s) - W_G
    difference = (0.5 * (m - W_p) * (1.0 / (y * y)) - total * (cell[0] + psi)) * (1.0 / cell[1])
    both = taut[0] & taut[1]
    return (
        select(both, 0.5 * (total + difference), select(taut[0], total, 0.0)),
        select(both, 0.5 * (total - difference), select(taut[1], total, 0.0)),
    )

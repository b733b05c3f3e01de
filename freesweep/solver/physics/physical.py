"""The density of tubes with a thick wall, loose fibers, or both, and its partial derivatives at one point.

    L(y, v) = max over (G, psi) of  T sqrt(G - v^2) - e W(y, G, psi) + m psi,   T = p y^2 + f

with W of :mod:`wall`, and G and psi as the fibers allow (:mod:`relaxed`); bonded fibers leave no choice of them. G and psi
have no derivatives along the tube, so they are eliminated point by point: first derivatives of L are those at fixed (G, psi)
of ``T s - e W + m psi - sum mu_i g_i``, whose second ones (``K``) give those of L along ``(1, dG/dy, dpsi/dy)``, from the
stationarity system of the families that are taut. L is C1 and piecewise C2.

Functions and arguments as in :mod:`membrane`; ``wall`` = load.wall is (k, inner, threads); ``near`` is what the neighbouring
cell handed on, see :func:`relaxed.beside`.
"""

from math import sqrt
from typing import NamedTuple

from ...jit import kernel
from ..cells import nothing_yet
from ..either import isnt, select, some
from .fibers import (
    ALPHA_TAUT,
    BETA_TAUT,
    BOTH_TAUT,
    NONE_TAUT,
    both_reach,
    given_at,
    is_taut,
    multipliers,
    slopes_at,
    spread_of,
    taut_twist,
)
from .relaxed import beside, settle
from .wall import least_square, leaves_choice, lies_inside, slopes, stored

NO_ROOM = 1e-30  # as in :mod:`membrane`
LEAST = 1e-6  # of G: where a state is refused, its numbers stay finite


class State(NamedTuple):
    """What lies behind L at one point: room, axial stretch, G - 1, twist rate, slopes of L; second derivatives K of what is
    maximized; derivatives of G and psi; which families are taut, their multipliers, and tan(angle) as the twist leaves it.
    """

    room: float
    s: float
    G_1: float
    psi: float
    L_y: float
    L_v: float
    K_yy: float
    K_yG: float
    K_yp: float
    K_vG: float
    K_GG: float
    K_Gp: float
    K_pp: float
    G_y: float
    psi_y: float
    G_v: float
    psi_v: float
    kind: float
    a: float
    b: float
    ta: float
    tb: float


@kernel
def kind_of(taut_alpha, taut_beta):
    """Which families are taut, as one number."""
    return select(taut_alpha, ALPHA_TAUT, NONE_TAUT) + select(taut_beta, BETA_TAUT, NONE_TAUT)


@kernel
def place(y, v, T, cell, load):
    """``(room, G - 1, psi, taut alpha, taut beta)`` at one point under the resultant T; see :func:`relaxed.settle`."""
    H, D, gg, wall = cell[0], cell[1], load.gamma * load.gamma, load.wall
    if wall[2] > 0.0:
        room, G_1, psi, alpha, beta = settle(given_at(y, v, cell, load), max(T, NO_ROOM))
        return min(room, T), max(G_1, LEAST - 1.0), psi, alpha, beta
    psi, G_1 = taut_twist(y, H, gg), both_reach(y, H, D, gg, gg - 1.0)
    room, least = min(1.0 + G_1 - v * v, T), least_square(y, max(1.0 + G_1, NO_ROOM), wall)
    bonded = y == y
    return select(lies_inside(wall), min(room, least), room), max(G_1, LEAST - 1.0), psi, bonded, bonded


@kernel
def place_beside(y, v, T, cell, load, near):
    """:func:`place` from a neighbour's, as far as that leads.

    Returns ``(room, G - 1, psi, dG, dpsi, taut alpha, taut beta, slopes of W)``; the last changes are not made yet, and too
    small to look once more.
    """
    given, zero = given_at(y, v, cell, load), 0.0 * y
    if not load.wall[2] > 0.0:
        room, G_1, psi, alpha, beta = place(y, v, T, cell, load)
        return room, G_1, psi, zero, zero, alpha, beta, slopes_at(given, G_1, psi)
    low, widest, _, _ = spread_of(given)
    room = min(widest - low, T)
    known, kind, G_1, psi, dG, dpsi, W, _, _ = beside(given, (max(T, NO_ROOM),), near)
    alpha, beta = is_taut(kind)
    if some(isnt(known)):
        other, width, twist, with_alpha, with_beta = place(y, v, T, cell, load)
        V = slopes_at(given, width, twist)
        room, G_1, psi = select(known, room, other), select(known, G_1, width), select(known, psi, twist)
        dG, dpsi = select(known, dG, zero), select(known, dpsi, zero)
        alpha, beta = (known & alpha) | (isnt(known) & with_alpha), (known & beta) | (isnt(known) & with_beta)
        W = (
            select(known, W[0], V[0]), select(known, W[1], V[1]), select(known, W[2], V[2]), select(known, W[3], V[3]),
            select(known, W[4], V[4]), select(known, W[5], V[5]), select(known, W[6], V[6]), select(known, W[7], V[7]),
            select(known, W[8], V[8]),
        )  # fmt: skip
    return room, G_1, psi, dG, dpsi, alpha, beta, W


@kernel
def state(y, v, cell, load, near):
    """The :class:`State` at one point."""
    H, D, gg = cell[0], cell[1], load.gamma * load.gamma
    p, m = load.p, load.m
    T, T_y = p * y * y + load.f, 2.0 * p * y
    room, G_1, psi, dG, dpsi, taut_alpha, taut_beta, W = place_beside(y, v, T, cell, load, near)
    W_y, W_G, W_p, W_yy, W_yG, W_yp, W_GG, W_Gp, W_pp = W
    s = sqrt(max(1.0 + G_1 - v * v, NO_ROOM))
    i = 1.0 / s
    i3 = i * i * i
    a, b = multipliers(y, s, psi, (taut_alpha, taut_beta), cell, T, m, W_G, W_p)
    ta, tb = H + D + psi, H - D + psi
    turned, squared = a * ta + b * tb, a * ta * ta + b * tb * tb
    L_y, L_v = T_y * s - W_y - 2.0 * y * squared, -T * v * i
    K_yy = 2.0 * p * s - W_yy - 2.0 * squared
    K_yG = 0.5 * T_y * i - W_yG
    K_yp = -W_yp - 4.0 * y * turned
    K_vG = 0.5 * T * v * i3
    K_GG = -0.25 * T * i3 - W_GG
    K_Gp = -W_Gp
    K_pp = -W_pp - 2.0 * y * y * (a + b)
    ratio, both = gg * (1.0 / (y * y)) / y, taut_alpha & taut_beta
    psi_y, G_y = -2.0 * H * ratio, -2.0 * D * D * y + 2.0 * gg * H * H * ratio
    psi_v = G_v = 0.0 * y
    if some(isnt(both)):
        t = select(taut_alpha, ta, tb)
        c, k = 2.0 * y * y * t, 2.0 * y * t * t  # dG = -c dpsi - k dy
        bend = c * c * K_GG - 2.0 * c * K_Gp + K_pp
        turn_y, turn_v = -(K_yp - c * K_yG - k * K_Gp + k * c * K_GG) / bend, c * K_vG / bend
        wide_y, wide_v = -k - c * turn_y, -c * turn_v
        none = isnt(taut_alpha | taut_beta)
        if some(none):
            det = K_GG * K_pp - K_Gp * K_Gp
            wide_y, turn_y = (
                select(none, (K_Gp * K_yp - K_pp * K_yG) / det, wide_y),
                select(none, (K_Gp * K_yG - K_GG * K_yp) / det, turn_y),
            )
            wide_v, turn_v = select(none, -K_pp * K_vG / det, wide_v), select(none, K_Gp * K_vG / det, turn_v)
        psi_y, G_y = select(both, psi_y, turn_y), select(both, G_y, wide_y)
        psi_v, G_v = select(both, 0.0, turn_v), select(both, 0.0, wide_v)
        # what the changes that are not made yet do, to first order; the multiplier changes, too
        pulls = select(none, 0.0, k)
        L_y = L_y + select(both, 0.0, (K_yG - pulls * K_GG) * dG + (K_yp - pulls * K_Gp) * dpsi)
        L_v = L_v + select(both, 0.0, K_vG * dG)
    G_1, psi = G_1 + dG, psi + dpsi
    s = sqrt(max(1.0 + G_1 - v * v, NO_ROOM))
    kind = kind_of(taut_alpha, taut_beta)
    return State(
        room, s, G_1, psi, L_y, L_v, K_yy, K_yG, K_yp, K_vG, K_GG, K_Gp, K_pp, G_y, psi_y, G_v, psi_v, kind, a, b, ta, tb
    )  # fmt: skip


@kernel
def handed_on(at, y, v, load):
    """What the next cell may start from; bonded fibers leave it no choice."""
    if not leaves_choice(load.wall):
        return nothing_yet(0.0 * y)
    kind = select(at.room > 0.0, at.kind, -1.0)
    return kind, y, v, at.psi, at.psi_y, at.psi_v, at.G_1, at.G_y, at.G_v


@kernel
def partials(at, y, v, load):
    """``(room, L_y, L_v, L_yy, L_yv, L_vv)``."""
    T = load.p * y * y + load.f
    L_yy = (
        at.K_yy
        + 2.0 * (at.K_yG * at.G_y + at.K_yp * at.psi_y)
        + (at.K_GG * at.G_y + 2.0 * at.K_Gp * at.psi_y) * at.G_y
        + at.K_pp * at.psi_y * at.psi_y
    )
    L_yv = -2.0 * load.p * y * v / at.s + at.K_vG * at.G_y
    L_vv = -T * (1.0 + at.G_1) / (at.s * at.s * at.s) + at.K_vG * at.G_v
    return at.room, at.L_y, at.L_v, L_yy, L_yv, L_vv


@kernel
def density(y, v, cell, load):
    """``(room, L_y, L_v, L_yy, L_yv, L_vv)``."""
    return partials(state(y, v, cell, load, nothing_yet(0.0 * y)), y, v, load)


@kernel
def density_beside(y, v, cell, load, near):
    """:func:`density` from a neighbour's, and what is handed on."""
    at = state(y, v, cell, load, near)
    return partials(at, y, v, load), handed_on(at, y, v, load)


@kernel
def uniform_tube(y, cell, load):
    """``(sqrt(G), T sqrt(G), L)`` at slope 0."""
    y = y + 0.0 * cell[0]  # a number beside a vector stands for all of it
    T = load.p * y * y + load.f
    _, G_1, psi, _, _ = place(y, 0.0, T, cell, load)
    s = sqrt(max(1.0 + G_1, NO_ROOM))
    pull = T * s
    return s, pull, pull - stored(y, G_1, psi, load.e * cell[2], load.rubber, load.wall) + load.m * psi


@kernel
def integrals(at, y, cell, load):
    """Axial length s, volume y^2 s, twist psi, strain energy W; and which families are taut."""
    return at.s, y * y * at.s, at.psi, stored(y, at.G_1, at.psi, cell[2], load.rubber, load.wall), at.kind


@kernel
def integrands(y, v, cell, load):
    """:func:`integrals` at one point."""
    _, G_1, psi, taut_alpha, taut_beta = place(y, v, load.p * y * y + load.f, cell, load)
    s = sqrt(max(1.0 + G_1 - v * v, NO_ROOM))
    return s, y * y * s, psi, stored(y, G_1, psi, cell[2], load.rubber, load.wall), kind_of(taut_alpha, taut_beta)


@kernel
def conjugate(y, v, cell, load, direction):
    """``(c, c_y, c_v, c_mu)`` with c = dL/dmu along a change of load; loose fibers let G and psi change with it."""
    return along(state(y, v, cell, load, nothing_yet(0.0 * y)), y, v, direction)


@kernel
def along(at, y, v, direction):
    """:func:`conjugate` where the :class:`State` is known."""
    T, T_y, m = direction.p * y * y + direction.f, 2.0 * direction.p * y, direction.m
    pull, c_mu = 0.5 * T / at.s, 0.0
    if at.kind == NONE_TAUT:
        det = at.K_GG * at.K_pp - at.K_Gp * at.K_Gp
        c_mu = (2.0 * at.K_Gp * pull * m - at.K_pp * pull * pull - at.K_GG * m * m) / det
    elif at.kind != BOTH_TAUT:
        b = 2.0 * y * y * (at.ta if at.kind == ALPHA_TAUT else at.tb)
        rise = m - b * pull
        c_mu = -rise * rise / (b * b * at.K_GG - 2.0 * b * at.K_Gp + at.K_pp)
    return (
        T * at.s + m * at.psi,
        T_y * at.s + pull * at.G_y + m * at.psi_y,
        pull * (at.G_v - 2.0 * v) + m * at.psi_v,
        c_mu,
    )


@kernel
def tensions(y, v, cell, load, near):
    """Multipliers of both families, and what is handed on."""
    at = state(y, v, cell, load, near)
    return at.a, at.b, handed_on(at, y, v, load)


@kernel
def at_slope(y, v, cell, load):
    """``(G - v^2, tau alpha, tau beta)``: the room of the slope, and the multipliers of both families."""
    T = load.p * y * y + load.f
    room, G_1, psi, taut_alpha, taut_beta = place(y, v, T, cell, load)
    _, W_G, W_p, _, _, _, _, _, _ = slopes(y, G_1, psi, load.e * cell[2], load.rubber, load.wall)
    s = sqrt(max(1.0 + G_1 - v * v, NO_ROOM))
    a, b = multipliers(y, s, psi, (taut_alpha, taut_beta), cell, T, load.m, W_G, W_p)
    return room, a, b


@kernel
def at_flux(y, flux, cell, load):
    """``(psi, G - 1, tau alpha, tau beta)`` where the flux q = T v/s is known and not the slope, which an upright meridian
    has no digits for: T/s is sqrt(T^2 + q^2)/sqrt(G), as at slope 0 under that resultant.
    """
    T = load.p * y * y + load.f
    pull = sqrt(T * T + flux * flux)
    _, G_1, psi, taut_alpha, taut_beta = place(y, 0.0, pull, cell, load)
    _, W_G, W_p, _, _, _, _, _, _ = slopes(y, G_1, psi, load.e * cell[2], load.rubber, load.wall)
    s = sqrt(max(1.0 + G_1, NO_ROOM))
    a, b = multipliers(y, s, psi, (taut_alpha, taut_beta), cell, pull, load.m, W_G, W_p)
    return psi, G_1, a, b

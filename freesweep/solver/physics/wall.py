"""The wall at one point: strain energy of its layers, and all first and second partial derivatives.

Three independent numbers deform a tube: the circumferential stretch ``y`` of the fiber surface (radius 1), the squared
meridional stretch ``G`` and the twist rate ``psi``. The wall is incompressible, so its layer of the undeformed radius rho
has, exactly in a uniform tube and as a layered membrane elsewhere (theory, section 11)::

    q   = r^2 = y^2 + (rho^2 - 1)/sqrt(G)
    I1  = G + q/rho^2 + k q psi^2 + rho^2/(G q)
    I2  = G q/rho^2 + rho^2/q + (1 + k rho^2 psi^2)/G
    W   = integral over rho^2 of w(I1, I2),  w as in :mod:`membrane`

A membrane is the one layer rho = 1 of the weight a = rho_o^2 - rho_i^2. A thick wall of Mooney and Rivlin's rubber is
summed exactly (:mod:`mooney_wall`), that of another at Gauss points. Its integrand is a rational function of rho^2 with
poles at 0, where q vanishes, and at infinity. With p the nearer one of the first two, g^2 = (rho_i^2 - p) (rho_o^2 - p)::

    rho^2 = p + g ((1 + t)/(1 - t))^2,    |t| <= (1 - r^2)/(1 + r^2),    r^8 = (rho_i^2 - p)/(rho_o^2 - p)

has poles on the unit circle only, far from a wall of any thickness: a rule of n points errs as ``((1 - r)/(1 + r))^(2 n)``.

``wall`` is (k, inner, threads): ``inner`` = rho_i^2, or 0 for a membrane; ``threads`` says which families of fibers there
are, and whether they may push (:mod:`relaxed`). In vectors of designs it is (k, inner, threads, layers, mean of 1/rho^2),
the third and fourth the same for all of them.
"""

from math import sqrt

import numpy as np

from ...jit import kernel
from ..either import isnt, select, some
from ..load import Load
from . import mooney_wall
from .membrane import excess, yeoh_slope
from .mooney_wall import Section, mean_reciprocals

BONDED, LOOSE, ONE_LOOSE, ONE_BONDED, NONE = 0.0, 1.0, 2.0, 3.0, 4.0  # threads: two families, one, none
MEMBRANE, FEWEST, MOST = 1, 2, 32  # Gauss points; the most where r_o^2 is up to 70,000 r_i^2
MISSED = 1e-14  # of the energy: what they may leave; walls whose holes close lose five digits of it
NARROWER = 3  # power of the ratio of a wall's squared radii that most loads leave; where less is left, MOST serve
NO_ROOM = 1e-30  # stands for what is left of it where there is none
_RULES = [np.polynomial.legendre.leggauss(n) for n in range(FEWEST, MOST + 1)]
PLACES, WEIGHTS = (np.concatenate(rows) for rows in zip(*_RULES))  # all rules in a row
_RATES = MISSED ** (-0.5 / np.arange(FEWEST, MOST + 1))
LEAST = np.append([0.0, 0.0], ((_RATES - 1.0) / (_RATES + 1.0)) ** 4)  # r^4 that so many points sum, by their number


@kernel
def leaves_choice(wall):
    """Whether fibers leave the wall a choice of stretch and twist: then the density is no linear function of the loads."""
    if len(wall) == 1:
        return False
    return wall[2] > BONDED


@kernel
def has_two_families(wall):
    """Whether there are two families of fibers."""
    if len(wall) == 1:
        return True
    return wall[2] <= LOOSE


@kernel
def has_any_family(wall):
    """Whether there are fibers."""
    if len(wall) == 1:
        return True
    return wall[2] < NONE


@kernel
def may_go_slack(wall):
    """Whether some family of fibers is there and cannot push: then the density has corners."""
    if len(wall) == 1:
        return False
    return (wall[2] == LOOSE) | (wall[2] == ONE_LOOSE)


@kernel
def with_bonded_fibers(load):
    """The load on the same tube whose two families may push, if they are loose."""
    return Load(load.gamma, load.rubber, _bonded(load.wall), load.p, load.f, load.m, load.e)


@kernel
def _bonded(wall):
    if len(wall) == 1:
        return wall
    threads = BONDED if wall[2] == LOOSE else wall[2]
    if len(wall) == 3:
        return wall[0], wall[1], threads
    return wall[0], wall[1], threads, wall[3], wall[4]


@kernel
def points(inner, area):
    """How many Gauss points a wall from rho^2 = ``inner`` to ``inner + area`` needs, under most loads."""
    ratio = inner / (inner + area)
    r = sqrt(sqrt(sqrt(ratio**NARROWER)))
    rate = (1.0 + r) / (1.0 - r)
    left, n = MISSED * rate * rate, 1
    while left < 1.0 and n < MOST:
        left *= rate * rate
        n += 1
    return max(n, FEWEST)


@kernel
def layers(area, wall):
    """As how many layers a wall counts; walls in vectors know that of themselves."""
    if len(wall) > 3:
        return wall[3]
    return points(wall[1], area) if (wall[1] > 0.0) & (area > 0.0) else MEMBRANE  # locked, the wall does not count


@kernel
def reciprocal(area, inner):
    """Mean of 1/rho^2; ``inner`` is 0 of a membrane."""
    thick = inner > 0.0
    square, half = select(thick, inner + 0.5 * area, 1.0), select(thick, 0.5 * area, 0.0)
    return mean_reciprocals(square, half, (square - half) * (square + half))[0]


@kernel
def section(area, wall):
    """The :class:`Section` of a wall; those in vectors know the mean of 1/rho^2 of themselves."""
    thick = wall[1] > 0.0
    d, half = select(thick, wall[1] + 0.5 * area - 1.0, 0.0), select(thick, 0.5 * area, 0.0)
    return Section(area, wall[0], d, half, wall[4] if len(wall) > 3 else reciprocal(area, wall[1]))


@kernel
def first_place(n):
    """Where the rule of n points begins in PLACES."""
    return (n * (n - 1) - FEWEST * (FEWEST - 1)) // 2


@kernel
def needs_most(near, far, count):
    """Where a rule of ``count`` points does not sum a wall between two roots of rho^2 - p."""
    return near < LEAST[count] * far


@kernel
def lies_inside(wall):
    """Whether there is wall inside the surface of the fibers."""
    return (wall[1] > 0.0) & (wall[1] < 1.0)


@kernel
def least_square(y, G, wall):
    """r^2 sqrt(G) of the innermost layer, which has to be positive; where the fibers lie inside, that is their own."""
    return y * y * sqrt(G) + select(lies_inside(wall), wall[1] - 1.0, 0.0)


@kernel
def narrowest(y, wall):
    """G below which the innermost layer would reach the axis."""
    root = select(lies_inside(wall), 1.0 - wall[1], 0.0) * (1.0 / (y * y))
    return root * root


@kernel
def layer(square, y, G_1, psi, rubber, k):
    """Of the layer at rho^2 = ``square``: ``(w, w_y, w_G, w_psi, w_yy, w_yG, w_ypsi, w_GG, w_Gpsi, w_psipsi)``."""
    c = rubber[0]
    G = 1.0 + G_1
    e = 1.0 / G
    root = sqrt(e)
    q = y * y + (square - 1.0) * root
    z = 1.0 / q
    i = 1.0 / square
    n = k * psi * psi
    x = square * z * e  # rho^2/(G q), the squared stretch across the wall
    b = ((y - 1.0) * (y + 1.0) - (square - 1.0) * root * G_1 / (1.0 / root + 1.0)) * i  # q/rho^2 - 1
    first = excess(G_1, b, x) + q * n
    # I1 and I2 along q, G and psi, each by itself
    first_q, first_G, first_p = i + n - x * z, 1.0 - x * e, 2.0 * k * q * psi
    first_qq, first_qG, first_GG = 2.0 * x * z * z, x * z * e, 2.0 * x * e * e
    first_qp, first_pp = 2.0 * k * psi, 2.0 * k * q
    sheared = 1.0 + square * n
    second = excess(-G_1 * e, -b * square * z, G * q * i) + square * n * e
    second_q, second_G, second_p = G * i - square * z * z, q * i - sheared * e * e, 2.0 * k * square * psi * e
    second_qq, second_qG, second_GG = 2.0 * square * z * z * z, i, 2.0 * sheared * e * e * e
    second_Gp, second_pp = -second_p * e, 2.0 * k * square * e

    slope, bend, w = yeoh_slope(rubber, first), 0.0, first
    if len(rubber) > 1:
        bend = 2.0 * rubber[1] + 6.0 * rubber[2] * first
        w = first * (1.0 + first * (rubber[1] + rubber[2] * first))
    w_q, w_G, w_p = slope * first_q + c * second_q, slope * first_G + c * second_G, slope * first_p + c * second_p
    w_qq = slope * first_qq + bend * first_q * first_q + c * second_qq
    w_qG = slope * first_qG + bend * first_q * first_G + c * second_qG
    w_GG = slope * first_GG + bend * first_G * first_G + c * second_GG
    w_qp = slope * first_qp + bend * first_q * first_p
    w_Gp = bend * first_G * first_p + c * second_Gp
    w_pp = slope * first_pp + bend * first_p * first_p + c * second_pp
    q_y = 2.0 * y
    q_G = -0.5 * (square - 1.0) * root * e
    q_GG = -1.5 * q_G * e
    return (
        w + c * second, w_q * q_y, w_G + w_q * q_G, w_p, w_qq * q_y * q_y + 2.0 * w_q, (w_qG + w_qq * q_G) * q_y, w_qp * q_y,
        w_GG + 2.0 * w_qG * q_G + w_qq * q_G * q_G + w_q * q_GG, w_Gp + w_qp * q_G, w_pp,
    )  # fmt: skip


@kernel
def sums_exactly(rubber, wall):
    """Whether the rubber is Mooney's and Rivlin's: one of three constants, where it is not in a vector, may be."""
    if len(wall) > 3:
        return False
    return (rubber[1] == 0.0) & (rubber[2] == 0.0)


@kernel
def energy(y, G_1, psi, area, rubber, wall):
    """``(W, W_y, W_G, W_psi, W_yy, W_yG, W_ypsi, W_GG, W_Gpsi, W_psipsi)`` of the whole wall; ``G_1`` is G - 1."""
    if len(rubber) > 1:
        if isnt(sums_exactly(rubber, wall)):
            return of_any(y, G_1, psi, area, rubber, wall)
    own = section(area, wall)
    known = mooney_wall.known(y, G_1, own)
    c = rubber[0]
    return (mooney_wall.energy(y, G_1, psi, c, own, known), *mooney_wall.slopes_of(y, G_1, psi, c, own, known))


@kernel
def stored(y, G_1, psi, area, rubber, wall):
    """W alone."""
    if len(rubber) > 1:
        if isnt(sums_exactly(rubber, wall)):
            return of_any(y, G_1, psi, area, rubber, wall)[0]
    return mooney_wall.stored(y, G_1, psi, rubber[0], section(area, wall))


@kernel
def slopes(y, G_1, psi, area, rubber, wall):
    """The derivatives of :func:`energy`, without W."""
    if len(rubber) > 1:
        if isnt(sums_exactly(rubber, wall)):
            return of_any(y, G_1, psi, area, rubber, wall)[1:]
    return mooney_wall.slopes(y, G_1, psi, rubber[0], section(area, wall))


@kernel
def rises(y, G_1, psi, area, rubber, wall):
    """``(W, W_y, W_G, W_psi)``."""
    if len(rubber) > 1:
        if isnt(sums_exactly(rubber, wall)):
            return of_any(y, G_1, psi, area, rubber, wall)[:4]
    return mooney_wall.rises(y, G_1, psi, rubber[0], section(area, wall))


@kernel
def of_any(y, G_1, psi, area, rubber, wall):
    """:func:`energy`, layer by layer: by as many as the wall counts, by MOST where a load has made it thick."""
    k, inner = wall[0], wall[1]
    square, one, count = 1.0 + 0.0 * area, area, 0
    W = W_y = W_G = W_p = W_yy = W_yG = W_yp = W_GG = W_Gp = W_pp = 0.0 * area
    if some(area > 0.0):  # locked, the wall does not count
        count = layers(area, wall)
    p = max(1.0 - y * y * sqrt(1.0 + G_1), 0.0)  # the nearer pole
    near, far = sqrt(max(inner - p, NO_ROOM)), sqrt(max(inner + area - p, NO_ROOM))
    size, both, many = near * far, sqrt(near) + sqrt(far), needs_most(near, far, count)
    reach = area / ((near + far) * both * both)
    for rule in range(2 if some(many) else 1):
        own, taken = (count, isnt(many)) if rule == 0 else (MOST, many)
        at = first_place(own)
        for j in range(own):
            if count > 1:
                t = reach * PLACES[at + j]
                i = 1.0 / (1.0 - t)
                h = (1.0 + t) * i
                square, one = p + size * h * h, 4.0 * size * reach * WEIGHTS[at + j] * h * i * i
            one = select(taken, one, 0.0)
            w, w_y, w_G, w_p, w_yy, w_yG, w_yp, w_GG, w_Gp, w_pp = layer(square, y, G_1, psi, rubber, k)
            W += one * w
            W_y += one * w_y
            W_G += one * w_G
            W_p += one * w_p
            W_yy += one * w_yy
            W_yG += one * w_yG
            W_yp += one * w_yp
            W_GG += one * w_GG
            W_Gp += one * w_Gp
            W_pp += one * w_pp
    return W, W_y, W_G, W_p, W_yy, W_yG, W_yp, W_GG, W_Gp, W_pp

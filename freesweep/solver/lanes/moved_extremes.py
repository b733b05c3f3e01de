"""How the largest outer radius and stretch, and the least pulls, of half a tube change as numbers do, for a vector of
designs.

The level of the first integral, with a stretch y, tells all of a place. So what is largest along the tube is largest over
y, from the end's 1 to that of the middle; where it is, it changes as it does at that very stretch, or, in the middle, at the
one that moves.

Multipliers follow what keeps K stationary (:mod:`second`): of taut families ::

    da + db = d(K_G),    da g_a,psi + db g_b,psi = d(K_psi)    at constant multipliers
"""

from math import sqrt

from ...jit import kernel
from ..along.places import principal_square
from ..either import isnt, select, some
from ..physics import lagrangian
from . import slack_ends
from .moved_middle import DEPTH, OF_LEVEL, OF_Y
from .outputs import pulled
from .second import place_at
from .vector import HUGE, get, put, spread

PULL_ALPHA, PULL_BETA, OUTER, STRETCH, FIELDS = range(5)  # less multipliers; squares
# of each field: the largest so far, the stretches before it, there and behind it, whether that is still to come; what may be
# handed on there
BEST, BEFORE, AT, BEHIND, COMING, KIND, PSI, WIDE, SEEN = range(9)
TOGETHER = 1e-12  # relative: by how much one place may have less, and be the largest as well
STEPS, CLOSE, SMOOTH = 24, 1e-11, 1e-5  # to where a slope vanishes, of a strain; what it leaves, of a field
NAN = float("nan")


@kernel
def values(y, at, inner, cell, load):
    """The fields at a place; ``inner`` is the squared radius of the wall's inner surface."""
    return (
        -pulled(at.a, load), -pulled(at.b, load), y * y + (inner + cell[2] - 1.0) / sqrt(1.0 + at.G_1),
        max(
            principal_square(y, at.G_1, at.psi, inner), principal_square(y, at.G_1, at.psi, inner + cell[2])
        ),
    )  # fmt: skip


@kernel
def begin(seen):
    """Nothing is seen yet, (fields, SEEN, WIDTH)."""
    for field in range(FIELDS):
        for k in range(SEEN):
            put(seen[field], k, spread(0.0))
        put(seen[field], BEST, spread(-HUGE))


@kernel
def see(within, y, before, at, inner, cell, load, seen):
    """Look at a place, in the lanes that have it; ``before`` is the stretch of the one before it."""
    told = values(y, at, inner, cell, load)
    for field in range(FIELDS):
        row, value = seen[field], told[field]
        more, coming = within & (value > get(row, BEST)), within & (get(row, COMING) > 0.5)
        put(row, BEHIND, select(more | coming, y, get(row, BEHIND)))
        put(row, COMING, select(more, 1.0, select(within, 0.0, get(row, COMING))))
        put(row, BEST, select(more, value, get(row, BEST)))
        put(row, BEFORE, select(more, before, get(row, BEFORE)))
        put(row, AT, select(more, y, get(row, AT)))
        put(row, KIND, select(more, at.kind, get(row, KIND)))
        put(row, PSI, select(more, at.psi, get(row, PSI)))
        put(row, WIDE, select(more, at.G_1, get(row, WIDE)))


@kernel
def pulls_by(here, dy, dG, dp, dR, by_G, by_p):
    """What both multipliers change by with the stretch, G, psi and R, where K_G and K_psi change by themselves, too."""
    along = by_G + here.K_yG * dy + here.K_GG * dG + here.K_Gp * dp + 0.5 * here.per_s * dR
    turned = by_p + here.K_yp * dy + here.K_Gp * dG + here.K_pp * dp
    alpha, beta, zero = here.alpha, here.beta, spread(0.0)
    both = alpha.taut & beta.taut
    first = (turned - beta.turn * along) / select(both, alpha.turn - beta.turn, 1.0)
    return (
        select(both, first, select(alpha.taut, along, zero)), select(both, along - first, select(beta.taut, along, zero)),
    )  # fmt: skip


@kernel
def principal_by(y, s, psi, rho):
    """:func:`..along.places.principal_square` and its derivatives by y, G, psi and rho: ``(value, ...)``."""
    per_s, per_rho, G = 1.0 / s, 1.0 / rho, s * s
    r = y * y + (rho - 1.0) * per_s
    r_y, r_G, r_rho = 2.0 * y, -0.5 * (rho - 1.0) * per_s * per_s * per_s, per_s
    h, k = r * per_rho, r * psi * psi
    h_y, h_G, h_rho = r_y * per_rho, r_G * per_rho, (r_rho - h) * per_rho
    k_y, k_G, k_p, k_rho = r_y * psi * psi, r_G * psi * psi, 2.0 * r * psi, r_rho * psi * psi
    apart, both = G - h, G + h
    root = sqrt(apart * apart + k * (k + 2.0 * both))
    i = 1.0 / select(root > 0.0, root, 1.0)
    by_h, by_k, by_G = 0.5 + 0.5 * (k - apart) * i, 0.5 + 0.5 * (k + both) * i, 0.5 + 0.5 * (k + apart) * i
    within, across = 0.5 * (both + k + root), 1.0 / (G * h)
    thick = across > within
    a_h, a_G = -across / h, -across / G
    return (
        select(thick, across, within), select(thick, a_h * h_y, by_h * h_y + by_k * k_y),
        select(thick, a_G + a_h * h_G, by_G + by_h * h_G + by_k * k_G), select(thick, spread(0.0), by_k * k_p),
        select(thick, a_h * h_rho, by_h * h_rho + by_k * k_rho),
    )  # fmt: skip


@kernel
def change(field, here, inner, area, move, by_G, by_p, of_inner, of_area):
    """What a field changes by with ``move``: (dy, dG, dpsi, dR), where surfaces move by themselves, too."""
    dy, dG, dp, dR = move
    if field == OUTER:
        i = here.per_s
        return 2.0 * here.y * dy + (of_inner + of_area) * i - 0.5 * (inner + area - 1.0) * i * i * i * dG
    if field == STRETCH:
        one, two = principal_by(here.y, here.s, here.psi, inner), principal_by(here.y, here.s, here.psi, inner + area)
        wide = two[0] > one[0]
        return (
            select(wide, two[1], one[1]) * dy + select(wide, two[2], one[2]) * dG + select(wide, two[3], one[3]) * dp
            + select(wide, two[4] * (of_inner + of_area), one[4] * of_inner)
        )  # fmt: skip
    alpha, beta = pulls_by(here, dy, dG, dp, dR, by_G, by_p)
    return -alpha if field == PULL_ALPHA else -beta


@kernel
def along(here, dy):
    """``(dy, dG, dpsi, dR)`` along the tube, where nothing else changes."""
    dR = -here.K_y * here.per_s * dy
    return dy, here.G_y * dy + here.G_R * dR, here.p_y * dy + here.p_R * dR, dR


@kernel
def place_of(y, level, near, cell, load):
    """``(Level, Place)`` at a stretch."""
    at = lagrangian.at_level(y, level, cell, load, near)
    return at, place_at(y, at.R - load.p * y * y - load.f, at, cell, load)


@kernel
def steepness(field, here, inner, area):
    """How a field changes with the stretch along the tube."""
    zero = spread(0.0)
    return change(field, here, inner, area, along(here, 1.0 + zero), zero, zero, zero, zero)


@kernel
def place_where(field, ends, mid, inner, cell, load, seen):
    """``(y, whether that is the middle, where it is one, what may be handed on)`` of the place at which a field is largest;
    ``ends`` are the fields at the end and in the middle.
    """
    zero, row = spread(0.0), seen[field]
    best, first, last = get(row, BEST), ends[0][field], ends[1][field]
    inside = best > max(first, last)
    near = get(row, KIND), get(row, AT), zero, get(row, PSI), zero, zero, get(row, WIDE), zero, zero
    middle, fine = isnt(inside) & (last >= first), inside | isnt(inside)
    y = select(inside, get(row, AT), select(middle, mid.y, 1.0))
    alike = isnt(inside) & (abs(first - last) <= TOGETHER * abs(first)) & (abs(first) > 0.0)  # all along
    slack = inside & (best == 0.0) if field < OUTER else isnt(fine)  # it pulls nowhere there
    going = inside & isnt(slack)
    if some(going):
        behind = select(get(row, COMING) > 0.5, mid.y, get(row, BEHIND))
        far, last = select(going, get(row, BEFORE), 1.0), select(going, behind, 1.0)
        of_far = steepness(field, place_of(far, mid.level, near, cell, load)[1], inner, cell[2])
        of_last = steepness(field, place_of(last, mid.level, near, cell, load)[1], inner, cell[2])
        going, small = going & (of_far * of_last < 0.0), CLOSE * abs(mid.y - 1.0)
        fine, t, slope = isnt(inside) | slack | going, last, zero
        for i in range(STEPS):
            new = select(going, slack_ends.trial(i, far, last, of_far, of_last, going), t)
            moved, t = abs(new - t), new
            going = going & (moved > small)
            slope = steepness(field, place_of(t, mid.level, near, cell, load)[1], inner, cell[2])
            if not some(going):
                break
            far, of_far = slack_ends.narrowed(slope, far, last, of_far, of_last)
            last, of_last = t, slope
        y = select(inside & isnt(slack) & fine, t, y)
        smooth = abs(slope * (mid.y - 1.0)) <= SMOOTH * abs(best)
        fine = fine & (isnt(inside) | slack | smooth)
    return y, middle, fine & isnt(alike), near


@kernel
def moves(j, m, of_length, middle, own):
    """``(what the stretch at the place changes by, what the level does, sizes of both)`` with number j, or, ``of_length``,
    with that of the half; the depth of the middle moves by ``m``.
    """
    deep, zero = own.middle[DEPTH], spread(0.0)
    counts = 0.0 if of_length else 1.0
    still_y, still = counts * get(own.middle[j], OF_Y), counts * get(own.middle[j], OF_LEVEL)
    on_y, on = m * get(deep, OF_Y), m * get(deep, OF_LEVEL)
    return select(middle, still_y + on_y, zero), still + on, (abs(still_y) + abs(on_y), abs(still) + abs(on))

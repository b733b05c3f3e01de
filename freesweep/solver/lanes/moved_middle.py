"""How the middle of half a tube changes as numbers do, and the depth of it, for a vector of designs: what :mod:`moved` sums
beside.

With a number the middle moves as a long tube's does, which is uniform there: by as much as keeps the drive toward it what it
is. With the depth it moves by what it lies deeper.
"""

from ...jit import kernel
from ..cells import nothing_yet
from ..either import select
from ..physics import lagrangian
from .second import (
    BY_G,
    BY_K,
    BY_KG,
    BY_KP,
    BY_KY,
    BY_PSI,
    BY_T,
    NUMBERS,
    PRESSURE,
    by_numbers,
    place_at,
    settled_by,
    turned,
)
from .vector import get, put, spread

LOADS = 4  # what is summed: s, y^2 s, psi and W, less what these are in the middle, behind the length
DEPTH, OWN = NUMBERS, NUMBERS + 1  # rows behind those of the numbers: by the depth of the middle; the sums themselves
# rows of the middle: its stretch, level, rise of R - T and how that bends; what is summed
OF_Y, OF_LEVEL, OF_RISE, OF_BEND, OF_LOADS = range(5)
MIDDLE = OF_LOADS + LOADS
ASIDE, LESS = 1e-4, 1e-2  # of the middle's stretch, of its strain: as far from there the bend of R - T is looked at


@kernel
def move_middle(mid, here, at, cell, load, half, own):
    """Write what the middle, the place ``here``, changes by with each number, and its depth, to the ``middle`` rows; behind
    them what is summed there. Returns how the drive toward it grows with its stretch.
    """
    y, s = here.y, here.s
    pull = 2.0 * load.p * y
    drive = -here.K_y - pull * s  # what the level falls by with the stretch
    dG, dp = here.G_y + here.G_R * pull, here.p_y + here.p_R * pull
    slope = rise_along(here, spread(1.0), pull, load)
    dy = (mid.y - 1.0) * 2.0 * mid.q * (1.0 + mid.q) * mid.whole / (1.0 - mid.q)
    put(own.middle[DEPTH], OF_RISE, slope * dy)
    W = here.W_y * dy + here.W_G * dG * dy + here.W_p * dp * dy
    enter_middle(own.middle[DEPTH], dy, -drive * dy, dG * dy, dp * dy, W, here)
    to = own.middle[OWN]
    put(to, OF_LOADS, s)
    put(to, OF_LOADS + 1, here.yy * s)
    put(to, OF_LOADS + 2, here.psi)
    put(to, OF_LOADS + 3, here.W)
    move_by_numbers(here, at, cell, load, max(slope, here.T / (half * half * s * s)), slope, own)
    bend_middle(mid, at, cell, load, own)
    return slope


@kernel
def move_by_numbers(here, at, cell, load, fall, slope, own):
    """Write what the middle changes by with each number: its stretch by what the number does to the drive toward it, over
    by how much that would ``fall`` with the stretch.
    """
    y, s, pull = here.y, here.s, 2.0 * load.p * here.y
    drive = -here.K_y - pull * s
    by_numbers(here, at, cell, load, own.rows)
    for k in range(len(own.used)):
        j = own.used[k]
        row, to, dT = own.rows[j], own.middle[j], get(own.rows[j], BY_T)
        G, psi = get(row, BY_G) + here.G_R * dT, get(row, BY_PSI) + here.p_R * dT
        rise = rise_by(j, row, here, 0.0 * y, dT, G, psi, load)
        dy = -rise / fall
        G, psi, W = settled_by(row, here, dy, dT + pull * dy)
        put(to, OF_RISE, rise + slope * dy)
        enter_middle(to, dy, s * dT + get(row, BY_K) - drive * dy, G, psi, W, here)


@kernel
def bend_middle(mid, at, cell, load, own):
    """Write by how much the bend of R - T in the middle, ``at`` its level, changes: what its rise does a little to both
    sides of it, or to the one on which the same families pull.
    """
    aside, none = min(ASIDE * mid.y, LESS * abs(1.0 - mid.y)), nothing_yet(0.0 * mid.y)
    below = lagrangian.at_level(mid.y - aside, mid.level, cell, load, none)
    above = lagrangian.at_level(mid.y + aside, mid.level, cell, load, none)
    alike, alike_above, zero = below.kind == at.kind, above.kind == at.kind, 0.0 * mid.y
    share = select(alike & alike_above, 0.5, 1.0) / aside
    before, behind = select(alike, -share, zero), select(alike_above, share, zero)
    for j in range(OWN):
        put(own.middle[j], OF_BEND, -(before + behind) * get(own.middle[j], OF_RISE))
    bend_by(before, mid.y - aside, below, cell, load, own)
    bend_by(behind, mid.y + aside, above, cell, load, own)


@kernel
def bend_by(share, y, at, cell, load, own):
    """Add a ``share`` of how the rise of R - T changes at a stretch that is as far from that of the middle as ever."""
    here = place_at(y, at.R - load.p * y * y - load.f, at, cell, load)
    by_numbers(here, at, cell, load, own.rows)
    for k in range(len(own.used)):
        j = own.used[k]
        row, of = own.rows[j], own.middle[j]
        dy = get(of, OF_Y)
        dR = (get(of, OF_LEVEL) - here.K_y * dy - get(row, BY_K)) * here.per_s
        G, psi, _ = settled_by(row, here, dy, dR)
        put(of, OF_BEND, get(of, OF_BEND) + share * rise_by(j, row, here, dy, dR, G, psi, load))
    of = own.middle[DEPTH]
    dy = get(of, OF_Y)
    dR = (get(of, OF_LEVEL) - here.K_y * dy) * here.per_s
    put(of, OF_BEND, get(of, OF_BEND) + share * rise_along(here, dy, dR, load))


@kernel
def rise_by(j, row, here, dy, dR, G, psi, load):
    """How the rise of R - T along the stretch changes with a number, which moves that and the resultant, G and psi."""
    K_y, K_G, K_p = get(row, BY_KY), get(row, BY_KG), get(row, BY_KP)
    bent = turned(here, K_y + here.K_yy * dy, K_G + here.K_yG * dy, K_p + here.K_yp * dy, G, psi, dR)
    bent = (0.5 * here.K_y * G * here.per_s * here.per_s - bent) * here.per_s
    return bent - 2.0 * load.p * dy - of_pressure(j) * 2.0 * here.y


@kernel
def rise_along(here, dy, dR, load):
    """The same where no number changes."""
    G, psi = here.G_R * dR + here.G_y * dy, here.p_R * dR + here.p_y * dy
    bent = turned(here, here.K_yy * dy, here.K_yG * dy, here.K_yp * dy, G, psi, dR)
    return (0.5 * here.K_y * G * here.per_s * here.per_s - bent) * here.per_s - 2.0 * load.p * dy


@kernel
def of_pressure(j):
    """1 of the pressure, 0 of other numbers."""
    return 1.0 if j == PRESSURE else 0.0


@kernel
def enter_middle(to, dy, level, G, psi, W, here):
    """Write what the middle's stretch, level and G, psi and W there change by, and so what is summed."""
    s = 0.5 * G * here.per_s
    put(to, OF_Y, dy)
    put(to, OF_LEVEL, level)
    put(to, OF_LOADS, s)
    put(to, OF_LOADS + 1, here.yy * s + 2.0 * here.y * here.s * dy)
    put(to, OF_LOADS + 2, psi)
    put(to, OF_LOADS + 3, W)

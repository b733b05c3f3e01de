"""Half a tube that is the same all along, told by its middle, and one place of it, for a vector of designs.

Toward the uniform stretch u the layer at an end falls as exp(-depth), to meet that of the other end in the middle::

y = u - (u - 1) (z + q^2/z)/(1 + q^2),    z = exp(-depth),    q = exp(-depth of the middle)

The level of the first integral is that of the middle's uniform tube, and tells the resultant R = T/cosine of the
meridian's angle (:mod:`..physics.first_integral`) at any other stretch. With it x along the tube, and all that is
summed along it, are integrals of smooth functions of the depth ::

dx/d(depth) = dy/d(depth) / (sqrt(G) sine),   sine^2 = (R - T)(R + T)/R^2

between the places where families go slack. Near the middle R - T has no digits: there it follows from its slope, which
has twice as many. Depths are counted from 0 to 1, finer where the layer begins.
"""

from math import exp, log, sqrt
from typing import NamedTuple

from ...jit import kernel
from ..cells import nothing_yet
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from .vector import WIDTH, get, put, select, spread

DEEPEST = 24.0  # where nothing is left of the layer
EVEN, LEAST_EVEN = 6.0, 0.15  # depth up to which equal steps do; the least share of equal steps
CERTAIN, NOISE = 1e-8, 1e-10  # shares of R, and of what it is the difference of, from which R - T is more than rounding
APART = 1e-6  # of 2 q |u - 1|: difference of two stretches that has digits
MEETS = 1e-9  # of q: as near to the middle as counts as there
LEAST_RATE = 1e-12
ALMOST = 0.99  # of one
# depths of a middle that is given: behind a turning point of the uniform tube there is none
SHALLOW, DEPTHS = 0.01, 30.0


class Middle(NamedTuple):
    """Uniform stretch u, rate of the layer, depth of the middle, q, 1/(1 + q^2); stretch and level there, and how x
    grows with the depth; first and second derivative of R - T by y; sqrt(G), twist rate and energy of the wall;
    by how much y^2 sqrt(G) and those are more where the tube is uniform, behind the deepest layer; and what the middle
    hands on.
    """

    u: float
    rate: float
    depth: float
    q: float
    whole: float
    y: float
    level: float
    per_depth: float
    rise: float
    bend: float
    s: float
    psi: float
    energy: float
    uniform: tuple
    near: tuple


class Uniform(NamedTuple):
    """Stretch of a uniform tube, L_yy and L_vv, sqrt(G), twist rate and energy, and what is handed on."""

    u: float
    L_yy: float
    L_vv: float
    s: float
    psi: float
    energy: float
    near: tuple


class Place(NamedTuple):
    """Stretch and :class:`..physics.first_integral.Level` of a place, cosine of the meridian's angle there, how x grows
    with the share t of the depth, and by what share R falls short of T: none in the middle, less before it; R - T, and
    exp(-depth).
    """

    y: float
    at: tuple
    cosine: float
    per_share: float
    short: float
    beyond: float
    z: float


@kernel
def fallen(depth, scratch):
    """exp(-depth)."""
    put(scratch, 0, depth)
    for lane in range(WIDTH):
        scratch[0, lane] = exp(-scratch[0, lane])
    return get(scratch, 0)


@kernel
def deep(t, depth):
    """``(depth at the share t, its derivative)`` of the ``depth`` of the middle."""
    even = max(1.0 - depth / EVEN, LEAST_EVEN)
    return depth * t * (even + (1.0 - even) * t * t), depth * (even + 3.0 * (1.0 - even) * t * t)


@kernel
def uniform_at(u, cell, load):
    """The :class:`Uniform` tube of that stretch."""
    zero = spread(0.0)
    (_, _, _, L_yy, _, L_vv), near = lagrangian.density_beside(u, zero, cell, load, nothing_yet(zero))
    _, G_1, psi, energy = lagrangian.level_of(u, cell, load, near)
    return Uniform(u, L_yy, L_vv, sqrt(1.0 + G_1), psi, energy, near)


@kernel
def rate_of(uniform):
    """Rate of the layer toward it."""
    return sqrt(max(uniform.L_yy / uniform.L_vv, LEAST_RATE))


@kernel
def middle(uniform, depth, cell, load, scratch):
    """The :class:`Middle` at that depth toward a :class:`Uniform` tube."""
    u, L_yy, _, s_u, psi_u, energy_u, near = uniform
    zero, q = spread(0.0), fallen(depth, scratch)
    whole = 1.0 / (1.0 + q * q)
    away = (1.0 - u) * 2.0 * q * whole
    y = u + away
    (_, L_y, _, own_yy, _, _), near = lagrangian.density_beside(y, zero, cell, load, near)
    level, G_1, psi, energy = lagrangian.level_of(y, cell, load, near)
    far = abs(away) > APART
    per_away = 1.0 / select(far, away, 1.0)
    T, s = load.p * y * y + load.f, sqrt(1.0 + G_1)
    mean_yy, s_y = select(far, L_y * per_away, L_yy), select(far, (s - s_u) * per_away, 0.0)  # on the way from u
    rise = -mean_yy * away / s
    return Middle(
        u, rate_of(uniform), depth, q, whole, y, level, sqrt(max(-T / (s * mean_yy), 0.0)), rise,
        -(own_yy + 2.0 * rise * s_y) / s, s, psi, energy,
        behind(u, s_u, psi_u, energy_u, y, s, psi, energy), near,
    )  # fmt: skip


@kernel
def middle_at(y, cell, load, half, scratch):
    """``(Middle, how much too far it is)`` of a tube whose middle has the stretch ``y``: where the drive toward it
    falls with the stretch, the uniform stretch u is where it would be none. Too far by -1 is where there is no drive
    left.

    Half the tube grows with the logarithm of the drive; what is counted is the drive, as a share of that at which half
    a tube is ``half`` long: evenly with it, through none.
    """
    zero = spread(0.0)
    (_, L_y, _, L_yy, _, L_vv), near = lagrangian.density_beside(y, zero, cell, load, nothing_yet(zero))
    level, G_1, psi, energy = lagrangian.level_of(y, cell, load, near)
    T, s, reach = load.p * y * y + load.f, sqrt(1.0 + G_1), 1.0 - y
    rise, fall = -L_y / s, max(-L_yy, -L_vv / (half * half)) / s
    part = fall * reach / rise
    driven = part > 0.0
    part = select(driven, part, 1.0)
    depth = min(max(logarithm(1.0 + part + sqrt(part * (part + 2.0)), scratch), SHALLOW), DEPTHS)
    q = fallen(depth, scratch)
    whole, gap = 1.0 / (1.0 + q * q), reach * 2.0 * q / ((1.0 - q) * (1.0 - q))
    per_depth = sqrt(max(gap * T / select(driven, rise, 1.0), 0.0)) / s
    rate = sqrt(fall * s / -L_vv)
    far = min(max(rate * half, 1.0), DEEPEST)
    least = fall * reach * 2.0 / (1.0 / fallen(far, scratch) - 2.0)
    u = select(depth >= ALMOST * DEEPEST, y - gap, y)  # of others it is but a number
    _, G_u, psi_u, energy_u = lagrangian.level_of(u, cell, load, near)
    return Middle(
        y - gap, select(driven, 1.0 / select(driven, per_depth, 1.0), rate), depth, q, whole, y, level, per_depth, rise,
        -(L_yy + rise * near[7] / s) / s, s, psi, energy, behind(u, sqrt(1.0 + G_u), psi_u, energy_u, y, s, psi, energy),
        near,
    ), driven, rise / least - 1.0  # fmt: skip


@kernel
def behind(u, s_u, psi_u, energy_u, y, s, psi, energy):
    """By how much s, y^2 s, psi and the energy are more in the uniform tube than in the middle."""
    return s_u - s, u * u * s_u - y * y * s, psi_u - psi, energy_u - energy


@kernel
def logarithm(number, scratch):
    """The logarithm of lanes."""
    put(scratch, 0, number)
    for lane in range(WIDTH):
        scratch[0, lane] = log(scratch[0, lane])
    return get(scratch, 0)


@kernel
def work_of(u, cell, load, half, near, at_end):
    """``(what tells states that are as much work, from 0 to 1, what is handed on of the end)``: which families are taut at
    the end, and in the middle; of states that are alike in this, the depth of the middle. ``near`` is handed on in the
    middle, ``at_end`` at the end under another load.
    """
    return _work_of(u, cell, load, half, near, at_end, load.wall)


@kernel
def _work_of(u, cell, load, half, near, at_end, wall):
    zero, one = spread(0.0), spread(1.0)
    (_, _, _, L_yy, _, L_vv), near = lagrangian.density_beside(u, zero, cell, load, near)
    deep = min(sqrt(L_yy / L_vv) * half / DEEPEST, 1.0)
    if len(wall) == 1:
        return deep, at_end
    if not may_go_slack(wall):
        return deep, at_end
    _, at_end = lagrangian.density_beside(one, zero, cell, load, at_end)
    return (4.0 * at_end[0] + near[0] + ALMOST * deep) / 16.0, at_end


@kernel
def look(t, mid, cell, load, near, scratch):
    """The :class:`Place` at the share t of the depth."""
    depth, per_share = deep(t, mid.depth)
    return look_down(depth, per_share, mid, cell, load, near, scratch)


@kernel
def look_down(depth, per_share, mid, cell, load, near, scratch):
    """The :class:`Place` at a ``depth``, which grows with some share by ``per_share``."""
    z = fallen(depth, scratch)
    inside = z - mid.q > MEETS * mid.q
    over = mid.whole * select(inside, (z - mid.q) / z, 0.0)
    on = (1.0 - mid.u) * over * (z - mid.q)  # from the middle's stretch
    y = mid.y + on
    at = lagrangian.at_level(y, mid.level, cell, load, near)
    T = load.p * y * y + load.f
    beyond = at.R - T
    short = select(inside, -beyond / at.R, 0.0)
    near_by = on * (2.0 / 3.0 * mid.rise + at.rise / 3.0 + mid.bend * on / 6.0)
    certain = CERTAIN * at.R + NOISE * (abs(mid.level) + abs(load.m * at.psi))
    beyond = select(beyond > certain, beyond, max(near_by, 0.0))
    sine = sqrt(beyond * (beyond + 2.0 * T)) / (T + beyond)
    turned = inside & (sine > 0.0)
    rise = abs(1.0 - mid.u) * over * (z + mid.q)  # of y by the depth
    per_depth = select(turned, rise / (sqrt(1.0 + at.G_1) * select(turned, sine, 1.0)), mid.per_depth)
    return Place(y, at, T / (T + beyond), per_depth * per_share, short, beyond, z)


@kernel
def handed_on(y, at, near, wall):
    """What the next place may start from: (kind, y, v, psi, psi_y, psi_v, G - 1, G_y, G_v), rises as from the one
    before.
    """
    return _handed_on(y, at, near, wall)


@kernel
def _handed_on(y, at, near, wall):
    if len(wall) == 1:
        return near
    zero = spread(0.0)
    alike = (at.kind == near[0]) & (abs(y - near[1]) > APART)
    per_y = 1.0 / select(alike, y - near[1], 1.0)
    psi_y = select(alike, (at.psi - near[3]) * per_y, zero)
    G_y = select(alike, (at.G_1 - near[6]) * per_y, zero)
    return select(at.room > 0.0, at.kind, -1.0), y, zero, at.psi, psi_y, zero, at.G_1, G_y, zero

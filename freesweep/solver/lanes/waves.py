"""Halves of waves of tubes that are the same all along, each told by its middle, for a vector of them: how long it is,
its level, and all that it adds to a tube. What buckled tubes are made of (:mod:`..by_waves`).

A wave runs from y = 1 to its middle and back. A deep middle is told by its depth (:mod:`meridian`), which may be any
number: from where a layer has no digits left on, what it has more is uniform. A shallow one is told by its stretch. The
torque may be told by its center: the stretch between those of both middles at which a uniform tube is one under it, if not
a stable one.
"""

import numpy as np

from ...jit import entry_point, kernel
from ..cells import nothing_yet
from ..load import under
from ..numerics.nested import SMALLEST_TOLERANCE
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from ..problem import FORCE, GAMMA, PHYSICAL, SOURCE
from ..problem import TORQUE as OWN_TORQUE
from .meridian import DEEPEST, fallen, logarithm, middle, middle_at, uniform_at
from .outputs import DX, FLOOR, WITHIN, finish
from .pack import COLUMNS, LENGTH, OUTPUTS, PRESSURE, Kind, aligned, enter, loads
from .profile import chosen
from .quadrature import stationary, sum_parts, there
from .sums import TOLD, make_room, scan
from .vector import WIDTH, bits, get, isnt, put, select, spread

# what is given of half a wave: the loads on it, of which the torque may be told by its center, and its middle
GIVEN = (PRESSURE, FORCE, GAMMA, OWN_TORQUE)
STRETCH, DEEP = len(GIVEN), len(GIVEN) + 1
# what is told of it: outputs, their bounds, and how much of these is rounding; its length, and what may be missing
# of that; level of the first integral, and how fast it rises with the middle's number, the depth or the stretch; uniform
# stretch and depth of the middle
BOUNDS, FLOORS = OUTPUTS, 2 * OUTPUTS
X, DOUBT, LEVEL, RISE, UNIFORM, DEPTH, ABOVE, TORQUE = range(3 * OUTPUTS, 3 * OUTPUTS + 8)
# L_yy and L_vv of the center; G at the clamped ends, positive where fibers meet them; families that would have to push
BEND, STIFFNESS, CLAMPED, SLACK = range(TORQUE + 1, TORQUE + 5)
COUNT = SLACK + 1
ALONG, ALONG_BOUNDS = COUNT, COUNT + TOLD - OUTPUTS  # numbers of a physical tube's places, and their bounds
LAST_DIGITS, FAINTEST = 17.0, 1e-6  # depth of a layer as high as 1 whose stretch has eight digits; the least height
ROUNDING = 1e-8  # of a layer: what that of R - T makes of its length
NEXT_TO_NOTHING = 300.0  # depth at which a layer is a number still


@kernel
def balanced(center, cell, load):
    """The load with the torque that makes a uniform tube of that stretch one."""
    free = under(load, load.p, load.f, 0.0 * center)
    _, L_y, _, _, _, _ = lagrangian.density(center, 0.0 * center, cell, free)
    return under(load, load.p, load.f, -L_y / lagrangian.kinematics(center, cell, load)[1])


@kernel
def measure(first, depth, cell, load, quarter, pieces, room, out, told):
    """Tell halves of waves, whose middles have about the uniform stretch ``first`` and that ``depth``, or, where it is NaN,
    the stretch ``first``; ``quarter`` is about how long they are. Returns masks: (it is one, alpha pushed somewhere, beta).
    """
    zero, numbers, scratch = spread(0.0), room.numbers, room.scratch
    known = depth == depth
    u, met = stationary(first, cell, load, known)
    deepest = min(LAST_DIGITS + logarithm(max(abs(1.0 - u), FAINTEST), scratch), DEEPEST)
    given = select(known, depth, deepest)
    shallow, driven, _ = middle_at(first, cell, load, quarter, scratch)
    mid = chosen(known, middle(uniform_at(u, cell, load), min(given, deepest), cell, load, scratch), shallow)
    _, limp, middle_limp, doubts, fine, short = scan(
        pieces, mid, cell, load, room.rows, room.ends, room.counts, room.starts, scratch
    )
    valid = ((known & met) | (isnt(known) & driven)) & fine & (short <= 0.0)
    fine, pushed, unsure = sum_parts(pieces, mid, cell, load, valid, room)
    if may_go_slack(load.wall):
        alpha, beta = there(limp, load.wall)
    else:
        (alpha, beta), middle_limp, doubts = pushed
    rest = max(given - deepest, 0.0) / mid.rate
    x = get(numbers[0], DX) + rest
    finish(mid, rest, zero, zero, rest, cell, load, x, middle_limp, doubts, unsure, numbers, scratch, out)
    outputs = get(out[0], 0), get(out[0], 1), get(out[0], 2), get(out[0], 3), get(out[0], 4)
    _, rounding = lagrangian.scales(outputs, cell, load, x, SMALLEST_TOLERANCE)
    for k in range(OUTPUTS):
        put(told, k, outputs[k])
        put(told, BOUNDS + k, get(out[1], k))
        put(told, FLOORS + k, FLOOR * rounding[k])
    left = fallen(min(2.0 * max(given - deepest, 0.0), NEXT_TO_NOTHING), scratch)
    by_depth = 2.0 * mid.q * (1.0 - mid.q * mid.q) * mid.whole * mid.whole * left
    put(told, RISE, abs(mid.rise) * mid.s * select(known, abs(1.0 - mid.u) * by_depth, 1.0))
    put(told, X, x)
    strain = mid.q * (mid.u - 1.0)
    put(told, DOUBT, get(numbers[1], WITHIN) + ROUNDING / mid.rate * min(ROUNDING / (2.0 * strain * strain), 1.0))
    put(told, LEVEL, mid.level)
    put(told, UNIFORM, mid.u)
    put(told, DEPTH, mid.depth)
    put(told, ABOVE, mid.level - lagrangian.level_of(spread(1.0), cell, load, nothing_yet(zero))[0])
    if len(load.wall) > 1:
        for k in range(OUTPUTS, TOLD):
            put(told, ALONG + k - OUTPUTS, get(out[0], k))
            put(told, ALONG_BOUNDS + k - OUTPUTS, get(out[1], k))
    return valid & fine, alpha, beta


@kernel
def measure_many(problem, given, centered, kind, pieces, told):
    """:func:`measure` halves of waves of the tube of one ``problem``, in so many ``pieces``. Rows of ``given`` (n, 6) are
    pressure, force, fiber extension, torque, or, if ``centered``, its center, stretch, and depth or NaN; those of ``told``
    (n, COUNT or more) take what is told, NaN where it is none.
    """
    many = told.shape[1]
    room, out, small = make_room(), aligned(2, 16), aligned(3, COLUMNS + many)
    columns, start, own = small[0], small[1], small[2]
    for group in range(0, len(given), WIDTH):
        count = min(WIDTH, len(given) - group)
        for lane in range(WIDTH):
            row = group + min(lane, count - 1)
            enter(lane, problem, columns)
            for k in range(len(GIVEN)):
                columns[GIVEN[k], lane] = given[row, k]
            for k in range(2):
                start[k, lane] = given[row, STRETCH + k]
        cell, _, load = loads(columns, kind.constants, kind.walls, kind.layers)
        center = get(columns, OWN_TORQUE) if centered else spread(1.0)
        if centered:
            load = balanced(center, cell, load)
        valid, alpha, beta = measure(
            get(start, 0), get(start, 1), cell, load, 0.5 * get(columns, LENGTH), pieces, room, out, own
        )
        _, _, _, L_yy, _, L_vv = lagrangian.density(center, spread(0.0), cell, load)
        put(own, TORQUE, load.m)
        put(own, BEND, L_yy)
        put(own, STIFFNESS, L_vv)
        put(own, CLAMPED, lagrangian.clamped(cell, load.gamma, load.wall))
        for lane in range(count):
            row = group + lane
            for k in range(many):
                told[row, k] = own[k, lane] if TORQUE <= k < SLACK or (bits(valid) >> lane) & 1 else np.nan
            told[row, SLACK] = ((bits(alpha) >> lane) & 1) | (((bits(beta) >> lane) & 1) << 1)


@entry_point
def measure_waves(problem, given, centered, constants, pieces, told):
    """:func:`measure_many` of the source's tubes."""
    measure_many(problem, given, centered, Kind(constants, SOURCE, 1), pieces, told)


@entry_point
def measure_physical_waves(problem, given, centered, constants, layers, pieces, told):
    """:func:`measure_many` of physical tubes."""
    measure_many(problem, given, centered, Kind(constants, PHYSICAL, layers), pieces, told)

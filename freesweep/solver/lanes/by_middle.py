"""Half tubes of given stretch in the middle, for a vector of designs: how much too long each is, and all that is told
of it. What branches are made of (:mod:`..by_middle`).
"""

import numpy as np

from ...jit import entry_point, kernel
from ..numerics.nested import SMALLEST_TOLERANCE
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from ..problem import FORCE, GAMMA, PHYSICAL, SOURCE, TORQUE
from . import slack_ends
from .meridian import ALMOST, DEEPEST, fallen, middle_at
from .outputs import DX, FLOOR, WITHIN, finish, unmet
from .pack import COLUMNS, LENGTH, PRESSURE, WEIGHT, aligned, enter, loads
from .sums import between_ends, find_ends, make_room, scan
from .vector import WIDTH, bits, get, isnt, mask_of, put, select, spread

OF_LOAD = PRESSURE, FORCE, TORQUE, GAMMA, WEIGHT  # the columns of a load
# what is told beside outputs: three numbers, then by what four of them are measured, and what is rounding of their bounds
SCALED = 4
MISS, DOUBT, SLACK, SCALES = range(4)
FLOORS = SCALES + SCALED
COUNT = FLOORS + SCALED
ROUNDING = 1e-15  # of the drive at an end, of which little is left in the middle


@kernel
def measure(y, cell, load, half, active, pieces, room, out, told):
    """What is told of half tubes whose middles have the stretch ``y``, in the ``active`` lanes: outputs, and what sums
    may miss, to ``out`` as :func:`.quadrature.solve` does; to ``told`` (COUNT, WIDTH) how much the drive of the middle
    is too large for a tube of that ``half`` length (:func:`.meridian.middle_at`), what may be missing of that, and by
    what outputs are measured. Returns masks: (alpha slack or pushed somewhere, beta).
    """
    zero, numbers, scratch = spread(0.0), room.numbers, room.scratch
    mid, driven, lack = middle_at(y, cell, load, half, scratch)
    active = active & driven
    _, (alpha, beta), middle_limp, doubts, valid, short = scan(
        pieces, mid, cell, load, room.rows, room.ends, room.counts, room.starts, scratch
    )
    active = active & valid
    parts, unsure = find_ends(mid, cell, load, active, room.ends, room.counts, room.starts, room.edges, scratch)
    fine, pushed = between_ends(parts, pieces, room.edges, mid, cell, load, room.rows, numbers, scratch)
    fine = fine & (unsure < slack_ends.ENOUGH)
    if not may_go_slack(load.wall):
        (alpha, beta), middle_limp, doubts = pushed
    miss = half - get(numbers[0], DX)
    grown = fallen(-min(max(min(mid.rate * miss, DEEPEST - mid.depth), -DEEPEST), DEEPEST), scratch)
    deep = (mid.depth >= DEEPEST) & (miss >= 0.0)  # what is left of the tube is as its middle
    lack = select(driven, select(short > 0.0, -1.0 - short, select(deep, 0.0, grown - 1.0)), min(lack, -1.0))
    put(told, MISS, select(driven & isnt(valid), np.nan, lack))
    doubt = select(deep, 0.0, unmet(mid, zero, get(numbers[1], WITHIN)) * mid.rate + ROUNDING / (mid.q * abs(1.0 - y)))
    doubt = select(fine, doubt, np.inf)
    put(told, DOUBT, select(driven & valid, doubt, 0.0))
    rest = select(mid.depth >= ALMOST * DEEPEST, max(miss, 0.0), 0.0)  # uniform; a state may lie where that begins
    finish(
        mid, rest, zero, zero, rest, cell, load, half, middle_limp, doubts, unsure, numbers, scratch, out
    )  # fmt: skip
    outputs = get(out[0], 0), get(out[0], 1), get(out[0], 2), get(out[0], 3), get(out[0], 4)
    scale, rounding = lagrangian.scales(outputs, cell, load, half, SMALLEST_TOLERANCE)
    put(told, SCALES, scale[0])
    put(told, SCALES + 1, scale[1])
    put(told, SCALES + 2, scale[2])
    put(told, SCALES + 3, scale[3])
    put(told, FLOORS, FLOOR * rounding[0])
    put(told, FLOORS + 1, FLOOR * rounding[1])
    put(told, FLOORS + 2, FLOOR * rounding[2])
    put(told, FLOORS + 3, FLOOR * rounding[3])
    return alpha, beta


@kernel
def measure_many(problems, owners, given, middles, constants, walls, layers, pieces, values, bounds, told):
    """:func:`measure` half of each tube ``problems[owners[i]]`` under the load ``given[i]``, the columns
    OF_LOAD, whose middle has the stretch ``middles[i]``, in so many ``pieces``; other arguments as of
    :func:`.free.solve`. Rows of ``values``, ``bounds`` and ``told`` (n, COUNT) take what is told.
    """
    room, out, small = make_room(), aligned(2, 16), aligned(3, COLUMNS)
    columns, start, own = small[0], small[1], small[2]
    for group in range(0, len(owners), WIDTH):
        count = min(WIDTH, len(owners) - group)
        for lane in range(WIDTH):
            row = group + min(lane, count - 1)
            enter(lane, problems[owners[row]], columns)
            start[0, lane] = middles[row]
            for k in range(len(OF_LOAD)):
                columns[OF_LOAD[k], lane] = given[row, k]
        cell, _, load = loads(columns, constants, walls, layers)
        alpha, beta = measure(
            get(start, 0), cell, load, get(columns, LENGTH), mask_of((1 << count) - 1), pieces, room, out, own
        )
        for lane in range(count):
            row = group + lane
            for k in range(values.shape[1]):
                values[row, k], bounds[row, k] = out[0, k, lane], out[1, k, lane]
            for k in range(COUNT):
                told[row, k] = own[k, lane]
            told[row, SLACK] = ((bits(alpha) >> lane) & 1) | (((bits(beta) >> lane) & 1) << 1)


@entry_point
def measure_lanes(problems, owners, given, middles, constants, pieces, values, bounds, told):
    """:func:`measure_many` of the source's tubes."""
    measure_many(problems, owners, given, middles, constants, SOURCE, 1, pieces, values, bounds, told)


@entry_point
def measure_physical(problems, owners, given, middles, constants, layers, pieces, values, bounds, told):
    """:func:`measure_many` of physical tubes."""
    measure_many(problems, owners, given, middles, constants, PHYSICAL, layers, pieces, values, bounds, told)

"""What is told of a state, for a vector of designs: outputs, of a physical tube the numbers of :mod:`..along.places`,
and their bounds, from the :mod:`sums` along half of it.
"""

from math import sqrt

from ...jit import kernel
from ..along import places
from ..numerics.nested import SMALLEST_TOLERANCE
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from .meridian import fallen
from .pack import OUTPUTS
from .vector import get, put, select, some, spread

SUMS = DX, LENGTH, VOLUME, TWIST, ENERGY = range(5)
# behind the SUMS: lengths without a pull of both families, the largest of four rows, and what the length summed up to any
# place may miss
SLACK, WORST, WITHIN = 5, 7, 11
STEEPEST = 3.0  # how much faster than evenly the depth may grow with its share
FLOOR = 200.0  # times the rounding of a mesh: sums along few places, of which some hardly know R - T
FAINT = 1e-8  # of a layer: what the rounding of R - T makes of its length


@kernel
def pulled(multiplier, load):
    """What a family pulls by: one that cannot push not less than 0."""
    return max(multiplier, 0.0) if may_go_slack(load.wall) else multiplier


@kernel
def unmet(mid, miss, missed):
    """How much of half the tube's length may be missing, of which sums may have ``missed`` some: the shallower the middle,
    the fewer places have no digit of R - T.
    """
    strain = mid.q * (mid.u - 1.0)
    return missed + abs(miss) + FAINT / mid.rate * min(FAINT / (2.0 * strain * strain), 1.0)


@kernel
def by_depth(mid):
    """By what share of themselves the strain of the middle, and what is summed beside it, change with the depth: at the end
    of a layer they fall as it does, and in a short tube the strain is as the square of its length.
    """
    return 3.0 * mid.q * (1.0 + mid.q) * mid.whole / (1.0 - mid.q)


@kernel
def finish(mid, miss, moved, placed, behind, cell, load, half, middle_limp, doubts, unsure, numbers, scratch, out):
    """Write outputs, numbers and bounds, where the strain may have ``moved`` by that share of itself, and that of any place,
    the middle itself, too, by the share ``placed``; what lies ``behind`` the deepest layer is uniform. Returns the largest
    scaled bound of the outputs, rounding left out.
    """
    sums, missed = numbers[0], numbers[1]
    rest = fallen(mid.rate * miss, scratch)  # how much of what is left of the layer is left in the middle itself
    outputs = (
        half * mid.s + get(sums, LENGTH) + behind * mid.uniform[0],
        half * mid.y * mid.y * mid.s + get(sums, VOLUME) + behind * mid.uniform[1],
        half * mid.psi + get(sums, TWIST) + behind * mid.uniform[2],
        half * mid.energy + get(sums, ENERGY) + behind * mid.uniform[3],
        mid.u + (mid.y - mid.u) * rest,
    )  # fmt: skip
    errors = (
        get(missed, LENGTH) + moved * abs(get(sums, LENGTH)),
        get(missed, VOLUME) + moved * abs(get(sums, VOLUME)),
        get(missed, TWIST) + moved * abs(get(sums, TWIST)),
        get(missed, ENERGY) + moved * abs(get(sums, ENERGY)),
        abs(1.0 - mid.y) * placed * rest,
    )  # fmt: skip
    scale, floors = lagrangian.scales(outputs, cell, load, half, SMALLEST_TOLERANCE)
    floor = FLOOR * floors[0], FLOOR * floors[1], FLOOR * floors[2], FLOOR * floors[3], FLOOR * floors[4]
    largest = max(
        max(max(errors[0] / scale[0], errors[1] / scale[1]), max(errors[2] / scale[2], errors[3] / scale[3])), errors[4]
    )
    record(out, 0, outputs, errors, floor)
    tell_places(mid, miss, behind, placed, cell, load, half, (middle_limp, doubts, unsure), numbers, out, load.wall)
    return largest


@kernel
def tell_places(mid, miss, behind, moved, cell, load, half, seen, numbers, out, wall):
    """Write the numbers of a physical tube's places; of what is ``seen`` of slack families: (limp in the middle, lengths in
    doubt, by how much an end may be off).
    """
    if len(wall) == 1:
        return
    (middle_limp, doubts, unsure), sums, missed = seen, numbers[0], numbers[1]
    size = load.p + abs(load.f)
    share_a = (get(sums, SLACK) + select(middle_limp[0], miss, 0.0)) / half
    share_b = (get(sums, SLACK + 1) + select(middle_limp[1], miss, 0.0)) / half
    doubt = (get(missed, DX) + STEEPEST * unsure * mid.depth / mid.rate) / half
    worst = worst_of(mid, behind, cell, load, sums)
    least_a, least_b = places.pulls(pulled(0.0 - worst[0], load), pulled(0.0 - worst[1], load), cell, load)
    off_a, off_b = places.pulls(get(missed, WORST), get(missed, WORST + 1), cell, load)
    outer, strain = sqrt(worst[2]), sqrt(worst[3])
    faint, least, none = (FLOOR * places.ROUNDING + moved) * size, spread(places.ROUNDING), spread(0.0)
    record(
        out, OUTPUTS,
        (share_a, share_b, least_a, least_b, outer, strain),
        (
            doubt + (doubts[0] + get(missed, SLACK)) / half, doubt + (doubts[1] + get(missed, SLACK + 1)) / half,
            off_a + faint + moved * abs(least_a), off_b + faint + moved * abs(least_b),
            0.5 * get(missed, WORST + 2) / outer + 3.0 * abs(1.0 - mid.y) * moved,
            0.5 * get(missed, WORST + 3) / strain + 3.0 * moved * (strain - 1.0),
        ),
        (least, least, none, none, places.ROUNDING * outer, places.ROUNDING * strain),
    )  # fmt: skip


@kernel
def worst_of(mid, behind, cell, load, sums):
    """The largest of what each place tells, WORST and on: that of the ``sums``, or, where something lies ``behind`` the
    deepest layer, of the uniform tube there.
    """
    most = get(sums, WORST), get(sums, WORST + 1), get(sums, WORST + 2), get(sums, WORST + 3)
    deep = behind > 0.0
    if not some(deep):
        return most
    there = told_of(mid.u, lagrangian.at_level(mid.u, mid.level, cell, load, mid.near), cell, load)
    return (
        select(deep, max(most[0], there[0]), most[0]), select(deep, max(most[1], there[1]), most[1]),
        select(deep, max(most[2], there[2]), most[2]), select(deep, max(most[3], there[3]), most[3]),
    )  # fmt: skip


@kernel
def told_of(y, at, cell, load):
    """Of a place of a physical tube what families push by, and the squares of outer radius and of the wall's stretch."""
    return (
        0.0 - pulled(at.a, load), 0.0 - pulled(at.b, load), places.outer_square(y, at.G_1, cell, load.wall),
        places.strain_square(y, at.G_1, at.psi, cell, load.wall),
    )  # fmt: skip


@kernel
def record(out, first, numbers, errors, floors):
    """Numbers and bounds, from a row on."""
    for k in range(len(numbers)):
        put(out[0], first + k, numbers[k])
        put(out[1], first + k, errors[k] + floors[k])

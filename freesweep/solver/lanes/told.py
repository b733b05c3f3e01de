"""What is told of a state's derivatives, for a vector of designs, from what :mod:`moved` summed: values, and what they
may miss.

With X what the length of half a tube grows by, Y what a sum does, by a number at a fixed depth of the middle, or by that
depth (D), what an output changes by is ::

    Q_number = half q_number + Y_number - (half q_D + Y_D) X_number/X_D,    Q_half = q + (half q_D + Y_D)/X_D

q what it is in the middle, per length. What is missed is what rules miss of the sums; what half a tube is not as long as it
is; where families go slack; and rounding. A long tube is uniform in the middle, which no depth moves.
"""

from math import exp, sqrt

from ...jit import kernel
from ..physics.wall import has_two_families, may_go_slack
from .meridian import DEEPEST
from .moved import MISSED, SUM
from .moved_middle import DEPTH, LOADS, OF_LOADS, OF_Y, OWN
from .second import NUMBERS
from .vector import get, put, select

OUTPUTS = LOADS + 1
TOLD = NUMBERS + 2  # of each: itself, its derivatives by the numbers, and by the length
SAFETY, WRONG, LEFT = 10.0, 20.0, 4.0  # times what rules miss, and what is wrong
BEHIND = 2.0 * DEEPEST * exp(-DEEPEST)  # of a layer, in the middle of a long tube
ENDS, ROUNDING, NOISE = 4e-9, 1e-11, 3e-10  # of where ends of slack lie, of numbers, of how R - T moves near the middle
CLOSE = 1e-10  # of the strain in the middle, that may be wrong
# of a shear modulus: what the resultant misses where fibers settle by Newton's method, times the places it does so at
FOLLOWED, TINY = 3e-11, 1e-300


@kernel
def missed_of_bend(mid, load):
    """By what share R - T may be wrong, of which the tube bends, in the mean along it: the less it bends the more so."""
    if has_two_families(load.wall) and not may_go_slack(load.wall):
        return 0.0 * mid.y
    on, T = 1.0 - mid.y, load.p * mid.y * mid.y + load.f
    beyond = abs(on * (mid.rise + 0.5 * mid.bend * on))  # R - T at the end, about
    return FOLLOWED / sqrt(max(beyond * T, TINY))


@kernel
def tell(mid, far, off, loose, load, half, own, out):
    """Write what is told: ``out`` (2, OUTPUTS TOLD, WIDTH), values and what they may miss. Where it is ``far`` to the middle
    it is uniform; ``off`` is by what share what hangs on the depth of the middle is wrong. Where ``loose``, a family
    goes slack along the tube. Returns (where it is far, 1/(how half a tube grows with the depth), what is unsure, where
    slack ends, by what share the depth is wrong).
    """
    depth = own.summed[DEPTH]
    per = 1.0 / select(far, 1.0, get(depth, SUM))
    missed = SAFETY * get(own.summed[OWN], MISSED) * abs(per)  # of the depth, as the length is
    hangs = select(far, 1.0, min(LEFT * mid.depth * mid.q, 1.0))
    off = off + select(far, 0.0, missed / mid.depth * hangs)
    unsure, ends = WRONG * off + select(far, BEHIND, 0.0) + NOISE, select(loose, ENDS, 0.0)
    unsure = unsure + missed_of_bend(mid, load)
    for n in range(LOADS):
        tell_load(n, far, per, unsure, ends, half, own, out)
    first = TOLD * LOADS
    put(out[0], first, mid.y)
    deeper, of_depth = get(own.middle[DEPTH], OF_Y), SAFETY * get(depth, MISSED) * abs(per)
    put(out[1], first, CLOSE * abs(1.0 - mid.y) + ROUNDING + select(far, 0.0, missed * abs(deeper)))
    for k in range(len(own.used)):
        j = own.used[k]
        moved, missed = depth_by(j, far, per, ends, own)
        still, on = get(own.middle[j], OF_Y), moved * deeper
        put(out[0], first + 1 + j, still + on)
        put(out[1], first + 1 + j, missed * abs(deeper) + unsure * (abs(still) + abs(on)))
    on = select(far, 0.0, deeper * per)
    put(out[0], first + TOLD - 1, on)
    behind = select(far, BEHIND * abs(1.0 - mid.y) * mid.rate, 0.0)
    put(out[1], first + TOLD - 1, abs(on) * (of_depth + unsure + WRONG * off * mid.depth / hangs) + behind)
    return far, per, unsure, ends, off / hangs


@kernel
def depth_by(j, far, per, ends, own):
    """How the depth of the middle moves with a number, and what that may miss."""
    depth, one = own.summed[DEPTH], own.summed[j]
    moved = -get(one, SUM) * per
    missed = SAFETY * (get(one, MISSED) + abs(moved) * get(depth, MISSED)) * abs(per) + 2.0 * ends * abs(moved)
    return select(far, 0.0, moved), select(far, 0.0, missed)


@kernel
def tell_load(n, far, per, unsure, ends, half, own, out):
    """Write what load n is conjugate to, and its derivatives."""
    depth, base = own.summed[DEPTH], own.summed[OWN]
    here = get(own.middle[OWN], OF_LOADS + n)
    value, missed = half * here + get(base, SUM + 1 + n), SAFETY * get(base, MISSED + 1 + n)
    at = TOLD * n
    put(out[0], at, value)
    deep = get(own.middle[DEPTH], OF_LOADS + n)
    grown = half * deep + get(depth, SUM + 1 + n)
    size = half * abs(deep) + abs(get(depth, SUM + 1 + n))
    of_grown = SAFETY * get(depth, MISSED + 1 + n)
    of_depth = SAFETY * get(depth, MISSED) * abs(per)
    unsure_here = unsure - NOISE + ROUNDING
    put(out[1], at, missed + unsure_here * half * abs(here) + (unsure_here + ends) * abs(get(base, SUM + 1 + n)))
    for k in range(len(own.used)):
        j = own.used[k]
        moved, unknown = depth_by(j, far, per, ends, own)
        still, bent = half * get(own.middle[j], OF_LOADS + n), get(own.summed[j], SUM + 1 + n)
        put(out[0], at + 1 + j, still + bent + moved * grown)
        missed = SAFETY * get(own.summed[j], MISSED + 1 + n) + abs(moved) * of_grown + unknown * abs(grown)
        missed = missed + ends * (abs(bent) + abs(moved * get(depth, SUM + 1 + n)))
        put(out[1], at + 1 + j, missed + unsure * (abs(still) + abs(bent) + abs(moved) * size))
    on = select(far, 0.0, grown * per)
    put(out[0], at + TOLD - 1, here + on)
    missed = (of_grown + abs(grown) * of_depth) * abs(per)
    put(out[1], at + TOLD - 1, select(far, 0.0, missed + unsure * size * abs(per)) + unsure * abs(here))

"""Free states of tubes that are the same all along by quadrature of their first integral, for a vector of designs: no
mesh, no Newton's method but that for what loose fibers leave the wall at one place.

A state is one number, the depth of its middle (:mod:`meridian`), at which half a tube is as long as it is: the secant
finds it, first by one rule along the whole depth, then by the :mod:`sums` of all parts. :mod:`outputs` makes of these what
is told. That goes along the secant, too: of two trials, one of which is close, follows what would be told of the right one.
"""

from typing import NamedTuple

from ...jit import kernel
from ..cells import nothing_yet
from ..guide import FAR_FROM
from ..physics import lagrangian
from ..physics.uniform_tube import FAR
from ..physics.wall import has_any_family, has_two_families, may_go_slack
from . import slack_ends
from .meridian import DEEPEST, middle, rate_of, uniform_at
from .outputs import DX, WITHIN, by_depth, finish, unmet
from .sums import between_ends, find_ends, scan
from .vector import get, isnt, mask_of, put, select, some, spread

FITS = 16  # trials for the depth of the middle
ROUGH, CLOSE = 3e-3, 3e-10  # shares of the strain that may be wrong there
MUCH = 1e-2  # of the accuracy asked for
NEARER, BENT = 0.1, 25.0  # a trial is close that misses so much less than one before: what is told bends by both shares
STEPS, MET = 8, 1e-12  # to the uniform stretch, relative
SHORTEST, LONGEST = 0.3, 3.0  # of a depth: the next one


class Seen(NamedTuple):
    """What a look along the depth tells of both families: limp somewhere, limp in the middle, lengths in doubt."""

    limp: tuple
    middle: tuple
    doubts: tuple


@kernel
def next_depth(wrong, depth, miss, before, slope):
    """``(depth, (depth, miss) before, slope)`` of one more trial of the secant in the lanes that are wrong."""
    moved = depth - before[0]
    steeper = (miss - before[1]) / select(moved == 0.0, 1.0, moved)
    slope = select(wrong & (steeper < 0.0) & (abs(moved) > 0.0), steeper, slope)
    trial = depth - miss / slope
    trial = min(max(trial, SHORTEST * depth), min(LONGEST * depth, DEEPEST))
    before = select(wrong, depth, before[0]), select(wrong, miss, before[1])
    return select(wrong, trial, depth), before, slope


@kernel
def let_go(mid, cell, load, half):
    """Where the middle misses a uniform stretch that draws the tube in, though its end is far: that is another branch."""
    drawn, missed = mid.u < lagrangian.drawn_in(cell, load), mid.y - mid.u > FAR_FROM * (1.0 - mid.u)
    return drawn & missed & (mid.rate * half > FAR)


@kernel
def stationary(u, cell, load, active):
    """``(u, lanes where it is met)``: the uniform stretch near one that is all but it."""
    zero, near, todo = spread(0.0), nothing_yet(spread(0.0)), active
    for _ in range(STEPS):
        (_, L_y, _, L_yy, _, _), near = lagrangian.density_beside(u, zero, cell, load, near)
        change = L_y / L_yy
        u = select(todo, u - change, u)
        todo = todo & (abs(change) > MET * u)
        if not some(todo):
            break
    return u, active & isnt(todo)


@kernel
def off_by(mid, miss, straight):
    """By what share of itself what hangs on the strain is wrong where half a tube is not as long as it is. What is left
    behind the deepest middle, or that of a ``straight`` tube, is uniform.
    """
    long = (straight | (mid.depth >= DEEPEST)) & (miss >= 0.0)
    return select(long, 0.0, abs(miss) * mid.rate * by_depth(mid))


@kernel
def look_along(pieces, mid, cell, load, room):
    """``(length, what is Seen, lanes that may be)`` of a :func:`scan`."""
    total, limp, middle_limp, doubts, valid, _ = scan(
        pieces, mid, cell, load, room.rows, room.ends, room.counts, room.starts, room.scratch
    )
    return total, Seen(limp, middle_limp, doubts), valid


@kernel
def sum_parts(pieces, mid, cell, load, moved, room):
    """Sum all parts, to the room's ``numbers``; in the lanes that have ``moved`` their ends are looked for. Returns ``(lanes
    that may be, what is Seen of fibers that may push, by how much an end that was looked for may be off)``.
    """
    parts, unsure = find_ends(mid, cell, load, moved, room.ends, room.counts, room.starts, room.edges, room.scratch)
    valid, seen = between_ends(parts, pieces, room.edges, mid, cell, load, room.rows, room.numbers, room.scratch)
    return (unsure < slack_ends.ENOUGH) & valid, Seen(*seen), unsure


@kernel
def tell(mid, miss, left, seen, unsure, cell, load, half, room, out):
    """Write what is told of a state (:mod:`outputs`) whose half is missed by so much, of which so much is ``left`` to be
    wrong by; returns the largest scaled bound.
    """
    share = by_depth(mid)
    moved = share * min(mid.rate * unmet(mid, left, get(room.numbers[1], DX)), 1.0)
    placed = share * min(mid.rate * unmet(mid, left, get(room.numbers[1], WITHIN)), 1.0)
    behind = select(mid.depth >= DEEPEST, max(miss, 0.0), 0.0)
    limp, doubts = seen.middle, seen.doubts
    return finish(
        mid, miss, moved, placed, behind, cell, load, half, limp, doubts, unsure, room.numbers, room.scratch, out
    )


@kernel
def keep(where, told, kept):
    """What was ``told`` (n, WIDTH) in some lanes, to what is ``kept`` (n, WIDTH) of a trial before."""
    for k in range(len(kept)):
        put(kept, k, select(where, get(told, k), get(kept, k)))


@kernel
def along_secant(onward, kept, told):
    """What is ``told`` (n, WIDTH), so many times ``onward`` what it differs by from what was ``kept`` of a trial before."""
    for k in range(len(kept)):
        here = get(told, k)
        put(told, k, here + select(onward == 0.0, 0.0, onward * (here - get(kept, k))))


@kernel
def there(limps, wall):
    """``(alpha, beta)``: what is not there is not slack."""
    none = mask_of(0)
    return limps[0] if has_any_family(wall) else none, limps[1] if has_two_families(wall) else none


@kernel
def roughly(uniform, depth, straight, cell, load, half, active, pieces, room):
    """``(Middle, miss, (depth, miss) before, slope, what is Seen, lanes that may be)`` by one rule along the whole depth:
    the secant, from a guess of the depth.
    """
    none, zero, slope = mask_of(0), spread(0.0), -1.0 / rate_of(uniform)
    before, settled, miss = (depth, half), none, zero
    seen = Seen((none, none), (none, none), (zero, zero))
    mid = middle(uniform, depth, cell, load, room.scratch)
    for _ in range(FITS):
        total, seen, valid = look_along(pieces, mid, cell, load, room)
        active, miss = active & valid, half - total
        settled = settled | (active & (off_by(mid, miss, straight) <= ROUGH))
        wrong = active & isnt(settled)
        if not some(wrong):
            break
        depth, before, slope = next_depth(wrong, depth, miss, before, slope)
        mid = middle(uniform, depth, cell, load, room.scratch)
    return mid, miss, before, slope, seen, active & settled


@kernel
def solve(start, cell, load, half, active, pieces, accuracy, room, out):
    """Solve the ``active`` lanes from their ``start``, (about the uniform stretch, about the depth of the middle or NaN),
    all rules in so many ``pieces``. ``out`` (2, > 11, WIDTH) takes the outputs, of physical tubes the numbers of
    :mod:`..along.places`, and their bounds. Returns masks, and uniform stretch and depth of the middle: ``(found, met, alpha
    slack or pushed somewhere, beta, (u, depth))``, met what is found to the accuracy.
    """
    u, active = stationary(start[0], cell, load, active)
    uniform, none, allowed = uniform_at(u, cell, load), mask_of(0), min(CLOSE, MUCH * accuracy)
    straight = u == 1.0
    guess = select(start[1] > 0.0, start[1], min(rate_of(uniform) * half, DEEPEST))
    mid, miss, before, slope, seen, active = roughly(uniform, guess, straight, cell, load, half, active, pieces, room)
    ended = mask_of(slack_ends.lanes_with(room.counts, 0))
    wrong, moved = active & isnt(straight), active
    found, tried, off, left, unsure, between = none, none, spread(0.0), miss, spread(0.0), none
    for fine in range(FITS):
        last = mid.depth
        depth, before, slope = next_depth(wrong, last, miss, before, slope)
        mid, reopened = middle(uniform, depth, cell, load, room.scratch), wrong & ended
        held = slack_ends.reopen(abs(depth - last) / depth, reopened, mid, cell, load, room)
        active = active & (held | isnt(reopened))
        if fine > 0:
            moved = wrong
        else:
            before = select(ended, depth, before[0]), before[1]  # the one rule along all parts tells no slope
        valid, pushed, doubt = sum_parts(pieces, mid, cell, load, moved, room)
        active, unsure = active & valid, select(moved, doubt, unsure)
        if not may_go_slack(load.wall):
            seen = pushed
        miss = half - get(room.numbers[0], DX)
        between = tried & (abs(miss) < NEARER * abs(before[1]))
        bent, now_off = select(between, min(BENT * off, 1.0), 1.0), off_by(mid, miss, straight)
        left, wrong = bent * abs(miss), active & (bent * now_off > allowed)
        found = active & isnt(wrong)
        if not some(wrong):
            break
        tell(mid, miss, left, seen, unsure, cell, load, half, room, out)
        keep(wrong, out[0], room.kept)
        tried, off = tried | wrong, select(wrong, now_off, off)
    largest = tell(mid, miss, left, seen, unsure, cell, load, half, room, out)
    onward = select(found & between, miss / select(between, before[1] - miss, 1.0), 0.0)
    along_secant(onward, room.kept, out[0])
    met = found & (largest <= accuracy) & isnt(let_go(mid, cell, load, half))
    alpha, beta = there(seen.limp, load.wall)
    return found, met, alpha, beta, (u, mid.depth + onward * (mid.depth - before[0]))

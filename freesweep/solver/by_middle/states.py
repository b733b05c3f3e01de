"""What is told of a branch between its points: turning points, and the states that are asked for."""

import numpy as np

from .question import ALONG, FAINT, MOST_TRIES, ROUGH, STILL, across, ask, beside, slope_of, widening

CAUTION, STANDS_OUT = 2.0, 4.0  # times what a miss changes, and by what a turning point stands out from its neighbours
CLOSE_BY = 4.0 * STILL
SLIGHT, LEAST_ASIDE = 1e-3, 1e-13  # a miss, and a stretch, by which a state is moved to see what changes
GOLDEN, PEAK_STEPS, FLAT, THIN = 0.381966, 40, 1e-9, 1e-7  # to a turning point; how exactly share and stretch are met
NEEDLE = 1e-5  # of a pressure: how far off a limit may be where meridians end between the places that are looked at
NUDGE, NUDGES = 0.01, 4  # of the way between the outer ones of three points
NEAR = 1e-2  # of the way between two points: where a state is looked for first


def middle_at(share, near, far):
    """The stretch in the middle at a ``share`` of the way, between two points of the branch, as exactly as they are."""
    met = yield from met_at(
        share, near, far, near.middle + part_of(share, near, far) * (far.middle - near.middle), ALONG
    )
    return None if met is None else met[0]


def part_of(share, near, far):
    """How far between two points a share of the way is met."""
    return (share - near.share) / (far.share - near.share)


def met_at(share, near, far, first, tries, aside=None):
    """``(middle, answer, other)`` at a ``share`` of the way, near a ``first`` guess of the stretch in the middle, see
    :func:`crossing`; it is looked for ``aside`` first.
    """
    reach = abs(far.middle - near.middle) + abs(far.share - near.share)
    left = -near.left if far.share > near.share else near.left  # to the left of what rises stretches are smaller
    ends = abs(near.middle - first), abs(far.middle - first)  # beside a top there is another state behind it
    distances = sorted([*ends, *widening(NEAR * reach if aside is None else aside, 2.0 * reach)])
    met = yield from beside(lambda t: (first + t, share), left, distances, tries=tries)
    return None if met is None else (first + met[0], met[1], (first + met[2][0], met[2][1]))


def state_at(share, near, far, accuracy):
    """``(what is told, bounds, largest of the bounds by which accuracy counts)`` of the state at a ``share`` of the way,
    between two points of the branch; None where it is not met, as at a jump of the miss. What no try tells to the
    ``accuracy`` is told by the last that tells it at all.
    """
    first, stays, aside = near.middle + part_of(share, near, far) * (far.middle - near.middle), None, None
    for fineness in range(MOST_TRIES):
        tries = range(fineness, fineness + 1), np.inf
        met = yield from met_at(share, near, far, first, tries, aside)
        if met is None:  # just before a turning point a coarse rule has none
            continue
        middle, answer, other = met
        told, slope = answer.outputs, slope_of(middle, answer, other)
        if abs(middle - 1.0) < CLOSE_BY and abs(other[0] - 1.0) < CLOSE_BY:  # on both sides of no strain
            bounds = told.bounds + np.abs(other[1].outputs.values - told.values)
        elif not abs(answer.miss) <= max(ROUGH * abs(middle - 1.0), FAINT * answer.doubt):
            continue
        else:
            moved = min(SLIGHT * abs(middle - 1.0) / slope, SLIGHT * abs(far.middle - near.middle))
            beside = yield from ask(middle + max(moved, LEAST_ASIDE), share, tries)
            change = np.abs(beside.outputs.values - told.values) / max(abs(beside.miss - answer.miss), 1e-300)
            bounds = told.bounds + CAUTION * change * (abs(answer.miss) + answer.doubt)
        finer = min(
            fineness + 1, MOST_TRIES - 1
        )  # a rule may be surer than it is right where a meridian stands upright
        finer = yield from ask(middle, share, (range(finer, finer + 1), np.inf))
        bounds = np.maximum(bounds, np.abs(finer.outputs.values - told.values))
        largest = np.max((bounds[: len(told.scales)] - told.floors) / told.scales)
        if largest <= ROUGH:
            stays = told, bounds, largest
        if largest <= accuracy:
            break
        first, aside = middle, max(FAINT * answer.doubt / slope, LEAST_ASIDE)
    return stays


def turning_point(points, sense):
    """``(share, bound, point)`` of the largest share, in this ``sense``, of a branch that passes three ``points``, the
    middle one of which lies farther than the others.

    At a turning point the branch runs across the way: to each stretch between the outer points belongs one share.
    """
    a, b, c = (point.middle for point in points)
    above = points[1].left if c > a else -points[1].left  # to the left of what runs to larger stretches
    fa, fb, fc = (sense * point.share for point in points)
    reach = max(abs(fb - fa), abs(fb - fc)) + FLAT
    known, doubts, jumps = [], {}, False
    for t, f in ((a, fa), (b, fb), (c, fc)):
        met = yield from across(t, sense * f, above, reach)
        share, doubts[t], jumped = met if met is not None else (sense * f, reach, False)
        jumps = jumps or jumped
        known.append(sense * share)
    fa, fb, fc = known
    for trial in range(PEAK_STEPS):
        left, right = (b - a) * (fb - fc), (b - c) * (fb - fa)
        t = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right) if left != right else b
        if not min(a, c) < t < max(a, c) or abs(t - b) < FLAT or trial % 3 == 2:
            t = b + GOLDEN * ((c - b) if abs(c - b) > abs(b - a) else (a - b))
        t, met = yield from clear(t, sense * fb, above, reach, NUDGE * (c - a))
        if met is None:
            break
        share, doubts[t], jumped = met
        jumps = jumps or jumped
        if sense * share > fb:
            (a, fa), (c, fc) = ((a, fa), (b, fb)) if (t - b) * (c - b) < 0.0 else ((b, fb), (c, fc))
            b, fb = t, sense * share
        elif (t - b) * (c - b) > 0.0:
            c, fc = t, sense * share
        else:
            a, fa = t, sense * share
        if max(fb - fa, fb - fc) < FLAT or abs(c - a) < THIN:
            break
    bound = max(doubts[a], doubts[b], doubts[c]) + STANDS_OUT * max(fb - fa, fb - fc, 0.0)
    bound += NEEDLE * abs(fb) * (1.0 - abs(fb)) if jumps else 0.0
    return sense * fb, bound, points[1]._replace(middle=b, share=sense * fb)


def clear(middle, share, above, reach, nudge):
    """A stretch near that of the ``middle``, and what :func:`across` tells of it: some places are in more doubt than
    others, as fibers go slack now here, now there between those that are summed.
    """
    best = middle, None
    for k in range(NUDGES):
        met = yield from across(middle + k * nudge, share, above, reach)
        if met is not None and (best[1] is None or met[1] < best[1][1]):
            best = middle + k * nudge, met
        if met is None or met[1] < FLAT:
            break
    return best

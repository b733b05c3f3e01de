"""A branch in two numbers: the stretch in the middle, and the share of a way along which loads change.

What a state is comes from whoever is asked: these functions are generators that yield a :class:`Question` and are sent a
:class:`Answer`, so that many branches are followed side by side, their questions answered together (:mod:`many_branches`).
To each pair of numbers belongs by how much it misses being a state; a branch is where that is 0. Along it the gradient of
the miss stays on one side: of two close branches the other has it on the other side, so that no step lands there unseen.
"""

from math import hypot, isnan
from typing import NamedTuple

import numpy as np

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.01, 0.05, 1e-8  # along the branch
STRAY, CALM = 0.3, 0.1  # of a step: how far beside it the branch may lie, and up to where the next one is longer
LONGER, MOST_STEPS = 1.6, 3000
NEAR, NEARER, TRIALS = 1e-5, 1e-11, 14  # a miss that is none along the branch, and of a state that is asked for
ROUGH = 1e-2  # of a miss: a doubt that a step may have
SLIGHT = 1e-3  # of a miss, by which a state is moved to see what changes
BEGINNINGS = 1e-3, 1e-5, 1e-7  # strains from which on a branch is followed
LEAST_SHARE, FASTER = 1e-9, 3.0  # of the way, where it is looked for, and how much farther each time
STILL = 1e-9  # strain beside which the middle is not looked at: the miss is a ratio of two small numbers there
PEAK_STEPS, FLAT = 24, 1e-10  # to a turning point, and how exactly its load is met
CAUTION = 2.0  # times what a miss changes
TRIES = 4
ALL = range(TRIES)


class Question(NamedTuple):
    """A stretch in the middle, a share of the way, and how fine the answer shall be: the number of its try."""

    middle: float
    share: float
    fineness: int


class Answer(NamedTuple):
    """By how much a question misses being a state (NaN: no tube at all), what may be missing of that, and the rest, which is
    nobody's business here but that of who asked.
    """

    miss: float
    doubt: float
    values: np.ndarray
    bounds: np.ndarray
    scales: np.ndarray
    slack: int


class Point(NamedTuple):
    """A state of a branch: stretch in the middle, share of the way; unit vector along the branch, and how the miss changes to
    the left of it.
    """

    middle: float
    share: float
    along: tuple
    slope: float


def ask(middle, share, tries=ALL):
    """The answer, from the first of the ``tries`` that leaves little doubt."""
    if abs(middle - 1.0) < STILL:
        middle = 1.0 + (STILL if middle >= 1.0 else -STILL)
    answer = None
    for fineness in tries:
        answer = yield Question(middle, share, fineness)
        if not answer.doubt > ROUGH:
            break
    return answer


def zero_on_line(middle, share, toward, reach, step, near, tries=ALL):
    """``(distance, slope, answer)`` of the place of a line, from a point ``toward`` a unit vector and back, not farther than
    ``reach``, where nothing is missed; None where it is not met. ``step`` is a first guess of the distance.
    """
    low = high = None  # (distance, miss) on both sides
    before, at, found = None, 0.0, None
    for trial in range(TRIALS):
        answer = yield from ask(middle + at * toward[0], share + at * toward[1], tries)
        miss = answer.miss
        if isnan(miss):
            if before is None:
                return None
            at = 0.5 * (at + before[0])  # half as far
            continue
        if before is not None and at != before[0] and miss != before[1]:
            found = at, (miss - before[1]) / (at - before[0]), answer
            if abs(miss) <= near or abs(at - before[0]) <= 1e-15 * (1.0 + abs(at)):
                return found
        low, high = ((at, miss), high) if miss < 0.0 else (low, (at, miss))
        if before is None or at == before[0] or miss == before[1]:
            ahead = at + step
        else:
            ahead = at - miss * (at - before[0]) / (miss - before[1])
        if low is not None and high is not None:
            least, most = min(low[0], high[0]), max(low[0], high[0])
            if not least < ahead < most:
                ahead = 0.5 * (least + most)
        else:
            ahead = min(max(ahead, at - 0.5 * reach), at + 0.5 * reach)
            if abs(ahead) > reach:
                return None
        before, at = (at, miss), ahead
    return None


def begin():
    """The first :class:`Point` of a branch from rest, where the load is small enough to have one state only; None where no
    strain is seen on the way.
    """
    for strain in BEGINNINGS:
        for middle in (1.0 + strain, 1.0 - strain):
            share, before = LEAST_SHARE, 0.0
            while share <= 1.0:
                answer = yield from ask(middle, share)
                if answer.miss >= 0.0:
                    break
                before, share = share, FASTER * share
            else:
                continue
            size = hypot(middle - 1.0, share)
            met = yield from zero_on_line(middle, share, (0.0, 1.0), share - before, 0.5 * (before - share), NEAR)
            if met is not None:
                distance, slope, _ = met
                share += distance
                size = hypot(middle - 1.0, share)
                along = (middle - 1.0) / size, share / size
                return Point(middle, share, along, slope * along[0])
    return None


def advance(here, step):
    """``(point, step)``: the next :class:`Point` of a branch and how long the step after it may be; no point where no step
    leads on.
    """
    while step > SMALLEST_STEP:
        (right, up) = here.along
        left = -up, right
        ahead = here.middle + step * right, here.share + step * up
        met = yield from zero_on_line(*ahead, left, STRAY * step, 1e-3 * step, NEAR)
        if met is not None and met[1] * here.slope > 0.0:
            distance, slope, _ = met
            chord = step * right + distance * left[0], step * up + distance * left[1]
            size = hypot(*chord)
            turned = 2.0 * chord[0] / size - right, 2.0 * chord[1] / size - up  # the tangent of a parabola
            whole = hypot(*turned)
            point = Point(here.middle + chord[0], here.share + chord[1], (turned[0] / whole, turned[1] / whole), slope)
            return point, min(step * (LONGER if abs(distance) < CALM * step else 1.0), LARGEST_STEP)
        step *= 0.5
    return None, step


def turning_point(points, sense):
    """``(share, bound, point)`` of the largest share, in this ``sense``, of a branch that passes three ``points``, the middle
    one of which lies farther than the others; None where it is not found.
    """
    near, top, far = points
    best, step, doubt = top, 0.0, 0.0
    for trial in range(PEAK_STEPS):
        (a, fa), (b, fb), (c, fc) = ((p.middle, sense * p.share) for p in (near, best, far))
        left, right = (b - a) * (fb - fc), (b - c) * (fb - fa)
        vertex = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right) if left != right else b
        inside = min(a, c) < vertex < max(a, c)
        if not inside or abs(vertex - b) < 1e-3 * abs(c - a) or trial % 4 == 3:
            vertex = b + 0.38 * ((c - b) if abs(c - b) > abs(b - a) else (a - b))
        met = yield from zero_on_line(vertex, best.share, (0.0, 1.0), abs(far.share - near.share) + LARGEST_STEP, 0.0, NEAR)
        if met is None:
            return None
        distance, slope, answer = met
        point = Point(vertex, best.share + distance, (sense, 0.0), slope)
        gain = sense * (point.share - best.share)
        doubt = (answer.doubt + NEAR) / abs(slope)
        if gain > 0.0:
            near, far = (near, best) if (vertex - b) * (c - b) < 0.0 else (best, far)
            best = point
        elif (vertex - b) * (c - b) > 0.0:
            far = point
        else:
            near = point
        if max(abs(near.share - best.share), abs(far.share - best.share)) < FLAT:
            break
    apart = max(abs(near.share - best.share), abs(far.share - best.share))
    return best.share, doubt + apart, best


def state_at(share, near, far, accuracy):
    """``(answer, bounds)`` of the state at a ``share`` of the way, between two points of the branch; None where it is not met.
    What no try tells to the ``accuracy`` is told by the last.
    """
    apart = far.middle - near.middle
    part = (share - near.share) / (far.share - near.share)
    first, reach, stays = near.middle + part * apart, abs(apart) + STRAY * abs(far.share - near.share), None
    for fineness in range(TRIES):
        tries = range(fineness, fineness + 1)
        met = yield from zero_on_line(first, share, (1.0, 0.0), reach, 0.01 * apart, NEARER, tries)
        if met is None or not met[1] * near.along[1] * near.slope < 0.0:
            return stays
        distance, slope, answer = met
        first = first + distance
        aside = min(SLIGHT / abs(slope), 0.1 * reach)
        other = yield from ask(first + aside, share, tries)
        change = (other.values - answer.values) / (other.miss - answer.miss)
        bounds = answer.bounds + CAUTION * np.abs(change) * (abs(answer.miss) + answer.doubt)
        stays = answer, bounds
        if np.max(bounds[: len(answer.scales)] / answer.scales) <= accuracy:
            break
    return stays

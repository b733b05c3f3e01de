"""A branch in two numbers: the stretch in the middle, and the share of a way along which loads change.

What a state is comes from whoever is asked: these functions are generators that yield a :class:`Question` and are sent an
:class:`Answer`, so that many branches are followed side by side, their questions answered together (:mod:`many_branches`).

To each pair of numbers belongs by how much it misses being a state, times the strain in the middle, a smooth number; a branch
is where that is none. To its left it is of one sign all along, to its right of the other. From a point of it the branch goes on
where the sign changes on a circle: round a corner, where fibers go slack, or a fold as sharp as a needle no less than where
it is smooth, and never to another branch beside it, which has its signs the other way round.
"""

from math import atan2, cos, exp, hypot, isnan, pi, sin
from typing import NamedTuple

import numpy as np

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.01, 0.05, 1e-5  # radius of the circle
SHORT_STEP = 1e-3  # up to which a branch may turn by any angle: round a corner
STRAY, CALM = 0.3, 0.1  # turns of a step [radian]: above the first it is shortened, below the second doubled
SHORTER = 0.3
SPREAD = 0.01, 3.0  # angles at which the change of sign is looked for: the first, and how much wider each time
SMALL = 0.1  # of the step before: a step for which a point has to be known to rounding
SHARP = 1e-3  # angle, and share of a first load, up to which a branch need be known along it
MOST_STEPS = 2000
CLOSE = 1e-11  # a miss that is none
MOST_HALVINGS, ROUNDING = 60, 4e-16  # of a bracket, and its width where it ends
ROUGH, FAINT = 1e-2, 0.1  # doubt of a miss that a step may have; share of a doubt that cannot be told from none
SLIGHT, LEAST_ASIDE = 1e-3, 1e-13  # a miss, and a stretch, by which a state is moved to see what changes
CAUTION = 2.0  # times what a miss changes
BEGINNINGS = 1e-3, 1e-5, 1e-7  # strains from which on a branch is followed
LEAST_SHARE, FASTER = 1e-9, 3.0  # of the way, where it is looked for, and how much farther each time
STILL = 1e-9  # strain beside which the middle is not looked at: the miss is a ratio of two small numbers there
GOLDEN, PEAK_STEPS, FLAT = 0.381966, 40, 1e-9  # to a turning point, and how exactly its load is met
TRIES = 4
ALONG, SHARPLY = (range(TRIES), ROUGH), (range(TRIES), 1e-7)  # tries, and a doubt that needs no more of them


class Question(NamedTuple):
    """A stretch in the middle, a share of the way, and how fine the answer shall be: the number of its try."""

    middle: float
    share: float
    fineness: int


class Answer(NamedTuple):
    """By how much a question misses being a state (NaN: no tube at all), and what may be missing of that, both times the
    strain; outputs, what may be missing of them, and by what they are measured; families that are slack.
    """

    miss: float
    doubt: float
    values: np.ndarray
    bounds: np.ndarray
    scales: np.ndarray
    slack: int


class Point(NamedTuple):
    """A state of a branch: stretch in the middle, share of the way; direction [radian] and length of the step that led there,
    how fast the direction turns, and the sign of the miss to the left.
    """

    middle: float
    share: float
    chord: float
    step: float
    turn: float
    left: float


def ask(middle, share, tries=ALONG):
    """The answer, from the first of the ``tries`` that leaves so little doubt."""
    if abs(middle - 1.0) < STILL:
        middle = 1.0 + (STILL if middle >= 1.0 else -STILL)
    answer = None
    for fineness in tries[0]:
        answer = yield Question(middle, share, fineness)
        if not answer.doubt > tries[1]:
            break
    strain = middle - 1.0
    return answer._replace(miss=answer.miss * strain, doubt=answer.doubt * abs(strain))


def crossing(place, low, high, width=0.0, tries=ALONG):
    """``(t, answer, other)`` where the miss changes its sign along ``place(t)``, a stretch and a share, between two pairs of a
    t and its answer, as exactly as that ``width``; ``other`` is a pair beside it. None where the way there leads through what
    is no tube.

    By the regula falsi of Illinois; a bracket that it does not halve is halved.
    """
    weights, wide = [1.0, 1.0], abs(high[0] - low[0])
    for trial in range(MOST_HALVINGS):
        below, above = weights[0] * low[1].miss, weights[1] * high[1].miss
        t = (low[0] * above - high[0] * below) / (above - below)
        if trial % 3 == 2:
            if abs(high[0] - low[0]) > 0.5 * wide or not min(low[0], high[0]) < t < max(low[0], high[0]):
                t = 0.5 * (low[0] + high[0])
            wide = abs(high[0] - low[0])
        answer = yield from ask(*place(t), tries)
        if isnan(answer.miss):
            return None
        same = answer.miss * low[1].miss > 0.0
        other = low if abs(low[1].miss) < abs(high[1].miss) else high
        if same:
            low, weights = (t, answer), [1.0, 0.5 * weights[1]]
        else:
            high, weights = (t, answer), [0.5 * weights[0], 1.0]
        none = max(CLOSE * abs(place(t)[0] - 1.0), FAINT * answer.doubt)
        if abs(answer.miss) <= none or abs(high[0] - low[0]) <= max(width, ROUNDING * (1.0 + abs(t))):
            break
    return t, answer, other


def advance(here, step):
    """``(here, point, step)``: the point, as exactly as was needed, the next one of the branch, and how long the step after it
    may be; no next one where what lies ahead is no tube.
    """
    sharp = False
    while True:
        fresh = here.step == 0.0
        toward = here.chord + 0.5 * here.turn * (here.step + step)

        def place(angle, here=here, step=step, toward=toward):
            return here.middle * exp(step * cos(toward + angle)), here.share + step * sin(toward + angle)

        angle = yield from leaves(here, place, pi if step <= SHORT_STEP else 0.5 * pi if fresh else STRAY)
        if angle is not None:
            smooth = abs(angle) < STRAY and not fresh
            turn = (toward + angle - here.chord) / (0.5 * (here.step + step)) if smooth else 0.0
            point = Point(*place(angle), toward + angle, step, turn, here.left)
            return here, point, min(2.0 * step if fresh or abs(angle) < CALM else step, LARGEST_STEP)
        if step <= SMALLEST_STEP:
            return here, None, step
        step *= SHORTER if step > SHORT_STEP / SHORTER or step <= SHORT_STEP else SHORT_STEP / step
        if not sharp and not fresh and step < SMALL * here.step:
            here, sharp = (yield from sharpened(here)), True


def goes_on(points, sense):
    """Whether the last step of a branch led on, in this ``sense``; where it hardly did, its ends are first made exact."""
    here, there = points[-2:]
    if abs(there.share - here.share) < 4.0 * SHARP * (here.step + there.step):
        points[-2], points[-1] = (yield from sharpened(here)), (yield from sharpened(there))
    return sense * points[-1].share > sense * points[-2].share


def sharpened(here):
    """The same point, to rounding."""

    def place(t):
        return here.middle * exp(-t * sin(here.chord)), here.share + t * cos(here.chord)

    far = 2.0 * SHARP * here.step
    low, high = (-far, (yield from ask(*place(-far)))), (far, (yield from ask(*place(far))))
    if not low[1].miss * high[1].miss < 0.0:
        return here
    met = yield from crossing(place, low, high)
    return here if met is None else here._replace(middle=place(met[0])[0], share=place(met[0])[1])


def leaves(here, place, widest):
    """The angle, not wider than the ``widest``, at which a branch leaves a circle round ``here``; None where it is not met."""
    answer = yield from ask(*place(0.0))
    if isnan(answer.miss):
        return None
    rightward = answer.miss * here.left > 0.0  # the branch lies to the right
    angle, before = SPREAD[0], (0.0, answer)
    while True:
        angle = min(angle, widest)
        t = -angle if rightward else angle
        answer = yield from ask(*place(t))
        if isnan(answer.miss):
            return None
        if (answer.miss * here.left > 0.0) != rightward:
            break
        if angle == widest:
            return None
        before, angle = (t, answer), SPREAD[1] * angle
    met = yield from crossing(place, before, (t, answer), SHARP)
    return None if met is None else met[0]


def begin():
    """The first :class:`Point` of a branch from rest, where the load is small enough to have one state only; None where no
    strain is seen on the way.
    """
    for strain in BEGINNINGS:
        for middle in (1.0 + strain, 1.0 - strain):
            share, before = LEAST_SHARE, None
            while share <= 1.0:
                answer = yield from ask(middle, share)
                if answer.miss * (middle - 1.0) >= 0.0:
                    break
                before, share = (share, answer), FASTER * share
            else:
                continue
            if before is None:
                continue
            met = yield from crossing(lambda t, middle=middle: (middle, t), before, (share, answer), SHARP * share)
            if met is not None:
                share = met[0]
                return Point(middle, share, atan2(share, middle - 1.0), hypot(share, middle - 1.0), 0.0, 1.0)
    return None


def turning_point(points, sense):
    """``(share, bound, point)`` of the largest share, in this ``sense``, of a branch that passes three ``points``, the middle
    one of which lies farther than the others; None where it is not found.

    At a turning point the branch runs across the way: to each stretch between the outer points belongs one share.
    """
    (a, fa), (b, fb), (c, fc) = ((point.middle, sense * point.share) for point in points)
    doubt, reach = 0.0, max(abs(fb - fa), abs(fb - fc)) + FLAT
    for trial in range(PEAK_STEPS):
        left, right = (b - a) * (fb - fc), (b - c) * (fb - fa)
        t = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right) if left != right else b
        if not min(a, c) < t < max(a, c) or abs(t - b) < FLAT or trial % 3 == 2:
            t = b + GOLDEN * ((c - b) if abs(c - b) > abs(b - a) else (a - b))
        met = yield from across(t, sense * fb, sense, reach)
        if met is None:
            break
        share, own = met
        if sense * share > fb + own + doubt:  # what hardly differs is no larger
            doubt = own
            (a, fa), (c, fc) = ((a, fa), (b, fb)) if (t - b) * (c - b) < 0.0 else ((b, fb), (c, fc))
            b, fb = t, sense * share
        elif (t - b) * (c - b) > 0.0:
            c, fc = t, sense * share
        else:
            a, fa = t, sense * share
        if max(fb - fa, fb - fc) < FLAT or abs(c - a) < SMALLEST_STEP:
            break
    return sense * fb, doubt + max(fb - fa, fb - fc, 0.0), points[1]._replace(middle=b, share=sense * fb)


def across(middle, share, sense, reach):
    """``(share, doubt)`` of the state whose middle has that stretch, nearest to a ``share``, not farther than ``reach``."""

    def place(t):
        return middle, share + t

    answer = yield from ask(middle, share, SHARPLY)
    distance, first = FAINT**3 * reach, (0.0, answer)
    while distance < 4.0 * reach and not isnan(answer.miss):
        for t in (-sense * distance, sense * distance):
            other = yield from ask(*place(t), SHARPLY)
            if other.miss * answer.miss < 0.0:
                met = yield from crossing(place, first, (t, other), tries=SHARPLY)
                if met is None:
                    return None
                t, found, (aside, beside) = met
                slope = abs((found.miss - beside.miss) / (t - aside)) if found.miss != beside.miss else np.inf
                return share + t, (found.doubt + abs(found.miss)) / slope + FLAT * FAINT
        distance *= SPREAD[1]
    return None


def middle_at(share, near, far):
    """The stretch in the middle at a ``share`` of the way, between two points of the branch, as exactly as they are."""
    met = yield from met_at(share, near, far, near.middle + part_of(share, near, far) * (far.middle - near.middle), ALONG)
    return None if met is None else met[0]


def part_of(share, near, far):
    """How far between two points a share of the way is met."""
    return (share - near.share) / (far.share - near.share)


def met_at(share, near, far, first, tries, aside=None):
    """``(middle, answer, other)`` at a ``share`` of the way, near a ``first`` guess of the stretch in the middle, see
    :func:`crossing`; it is looked for ``aside`` first.
    """
    reach = abs(far.middle - near.middle) + abs(far.share - near.share)
    distance = SPREAD[0] * reach if aside is None else aside
    rising = 1.0 if far.share > near.share else -1.0

    def place(t):
        return first + t, share

    answer = yield from ask(*place(0.0), tries)
    before, below = (0.0, answer), answer.miss * near.left * rising > 0.0  # to the left of what rises stretches are smaller
    while distance < 2.0 * reach:
        t = distance if below else -distance
        answer = yield from ask(*place(t), tries)
        if (answer.miss * near.left * rising > 0.0) != below:
            met = yield from crossing(place, before, (t, answer), tries=tries)
            return None if met is None else (first + met[0], met[1], (first + met[2][0], met[2][1]))
        before, distance = (t, answer), SPREAD[1] * distance
    return None


def state_at(share, near, far, accuracy):
    """``(answer, bounds)`` of the state at a ``share`` of the way, between two points of the branch; None where it is not met.
    What no try tells to the ``accuracy`` is told by the last.
    """
    middle, stays, aside = near.middle + part_of(share, near, far) * (far.middle - near.middle), None, None
    for fineness in range(TRIES):
        tries = range(fineness, fineness + 1), np.inf
        met = yield from met_at(share, near, far, middle, tries, aside)
        if met is None:
            return stays
        middle, answer, (beside, other) = met
        slope = abs((other.miss - answer.miss) / (beside - middle)) if other.miss != answer.miss else np.inf
        moved = max(min(SLIGHT * abs(middle - 1.0) / slope, SLIGHT * abs(far.middle - near.middle)), LEAST_ASIDE)
        other = yield from ask(middle + moved, share, tries)
        change = np.abs(other.values - answer.values) / max(abs(other.miss - answer.miss), 1e-300)
        bounds = answer.bounds + CAUTION * change * (abs(answer.miss) + answer.doubt)
        stays = answer, bounds
        if np.max(bounds[: len(answer.scales)] / answer.scales) <= accuracy:
            break
        aside = max(FAINT * answer.doubt / slope, LEAST_ASIDE)
    return stays

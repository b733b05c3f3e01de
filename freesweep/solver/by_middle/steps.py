"""A branch, step by step, in the two numbers of :mod:`question`.

To its left the miss is of one sign all along, to its right of the other. From a point of it the branch goes on where
the sign changes on a circle: round a corner, where fibers go slack, or a fold as sharp as a needle no less than where
it is smooth, and never to another branch beside it, which has its signs the other way round.
"""

from itertools import pairwise
from math import atan2, cos, exp, hypot, log, pi, sin
from typing import NamedTuple

from .question import SHARPLY, WIDER, ask, beside, crossing, sign_of, widening

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.01, 0.05, 1e-5  # radius of the circle
SHORT_STEP = 1e-3  # up to which a branch may turn by any angle: round a corner
STRAY, CALM = 0.3, 0.1  # turns of a step [radian]: above the first it is shortened, below the second doubled
SHORTER = 0.3
SPREAD = 0.01  # the first angle at which the change of sign is looked for
KEPT = 5  # points, of which the last may tell that the first lay farther
SMALL = 0.1  # of the step before: a step for which a point has to be known to rounding
SHARP, EXACT = 1e-3, 1e-8  # of a step: how well a point, or a first load, need be known along a branch; where it counts
FLAT = 4.0  # times what a point may be off: a change of the share that says nothing
MOST_STEPS = 2000
BENT = 0.2  # from one step to the next [radian], from which on a snap may hide in it
LEVEL, LOOKS = 0.3, 4  # change of the share by the step, below which a snap may hide in one; parts that are looked at
ASIDE, BARELY = 0.1, 1 / 16  # how far beside it the branch has to be: of the step, and of what the share changes on it
UNEVEN = 4.0  # times what the share changes on another part
NOTHING_LESS = 1e-8  # of a step: by how much a branch need fall back to turn
BEGINNINGS = 1e-3, 1e-5, 1e-7  # strains from which on a branch is followed
LEAST_SHARE, EARLY = 1e-9, 0.05  # of the way, where it is looked for, and up to where it has hardly begun
ARRIVED, TURNED, LOST = range(3)


class Point(NamedTuple):
    """A state of a branch: stretch in the middle, share of the way; direction [radian] and length of the step that led
    there, how fast the direction turns, and the sign of the miss to the left. A first point has no step; its direction
    is one from which that of the branch is less than a right angle away. An ``exact`` one is known all but to rounding.
    """

    middle: float
    share: float
    chord: float
    step: float
    turn: float
    left: float
    exact: bool = False


def begin():
    """The first :class:`Point` of a branch from rest, where the load is small enough to have one state only; None where
    no strain is seen on the way.
    """
    first = None
    for strain in BEGINNINGS:
        for middle in (1.0 + strain, 1.0 - strain):
            share = yield from strained(middle)
            if share is not None and (first is None or share < first.share):
                first = Point(middle, share, atan2(share, middle - 1.0), hypot(share, middle - 1.0), 0.0, 1.0)
                if share < EARLY:
                    return first
    return first


def strained(middle):
    """The share of the way at which a middle is first strained that much; None where it never is."""
    share, before = LEAST_SHARE, None
    while share <= 1.0:
        answer = yield from ask(middle, share)
        if answer.miss * (middle - 1.0) >= 0.0:
            break
        before, share = (share, answer), WIDER * share
    else:
        return None
    if before is None:
        return None
    met = yield from crossing(lambda t: (middle, t), before, (share, answer), SHARP * share)
    return None if met is None else met[0]


def follow(point, sense, far, answer):
    """Follow a branch from a point on in this ``sense``, until the share ``far`` is passed; ``answer(here, there)``
    answers what is asked for on each step. Returns ``(ARRIVED, TURNED or LOST, the last points)``: where
    the branch has TURNED three, between the outer ones of which its turning point lies.
    """
    step, points = FIRST_STEP, [point]
    for _ in range(MOST_STEPS):
        if len(points) > 1 and 0.0 <= sense * points[-1].share - far < FLAT * SHARP * points[-1].step:
            points[-1] = yield from sharpened(points[-1])
        if len(points) > 1 and sense * points[-1].share >= far:
            return ARRIVED, points
        points[-1], ahead, longer = yield from advance(points[-1], step)
        if ahead is None:
            return LOST, points
        points = [*points[1 - KEPT :], ahead]
        if (yield from goes_on(points, sense)):
            inner = yield from looked_between(points)
            if (turned := turns_between([*points[:-2][-1:], *inner], sense)) is not None:
                return TURNED, turned
            if is_uneven(inner) and SHORTER * ahead.step > SMALLEST_STEP:
                points, step = points[:-1], SHORTER * ahead.step
                continue
            yield from answer(*points[-2:])
            step = longer
        elif len(points) > 2:
            return TURNED, (yield from around_top(points, sense))
        else:  # a turning point has a point before it
            points, step = points[:1], SHORTER * step
            if step < SMALLEST_STEP:
                return LOST, points
    return LOST, points


def advance(here, step):
    """``(here, point, step)``: the point, as exactly as was needed, the next one of the branch, and how long the step
    after it may be; no next one where what lies ahead is no tube.
    """
    sharp = False
    while True:
        fresh = here.step == 0.0
        toward = here.chord + 0.5 * here.turn * (here.step + step)

        def place(angle, here=here, step=step, toward=toward):
            return here.middle * exp(step * cos(toward + angle)), here.share + step * sin(toward + angle)

        widest = pi if step <= SHORT_STEP else 0.5 * pi if fresh else STRAY
        met = yield from beside(place, here.left, widening(SPREAD, widest), SHARP)
        if met is not None:
            angle = met[0]
            smooth = abs(angle) < STRAY and not fresh
            turn = (toward + angle - here.chord) / (0.5 * (here.step + step)) if smooth else 0.0
            point = Point(*place(angle), toward + angle, step, turn, here.left)
            return here, point, min(2.0 * step if fresh or abs(angle) < CALM else step, LARGEST_STEP)
        if step <= SMALLEST_STEP:
            return here, None, step
        step *= SHORTER if step > SHORT_STEP / SHORTER or step <= SHORT_STEP else SHORT_STEP / step
        if not sharp and not fresh and step < SMALL * here.step:
            here, sharp = (yield from sharpened(here)), True


def around_top(points, sense):
    """The three of the ``points``, made exact, of which the middle one has the largest share in this ``sense``."""
    exact = []
    for point in reversed(points):
        exact.append((yield from sharpened(point)))
        if len(exact) > 2 and sense * exact[-2].share > sense * exact[-1].share:
            break
    return exact[:-4:-1]


def goes_on(points, sense):
    """Whether the last step of a branch led on, in this ``sense``; where it hardly did, its ends are first made exact."""
    here, there = points[-2:]
    if abs(there.share - here.share) < FLAT * SHARP * (here.step + there.step):
        points[-2], points[-1] = (yield from sharpened(here)), (yield from sharpened(there))
    return sense * points[-1].share > sense * points[-2].share


def looked_between(points):
    """The last step of a branch, as its two ends where nothing hides between; else as points of the branch beside even ones
    of its chord, in which a small snap would show; one end alone where it has none beside.
    """
    if (yield from runs_beside(*points[-2:])):
        return points[-2:]
    here, there = points[-2:]
    points[-2], points[-1] = here, there = (yield from sharpened(here)), (yield from sharpened(there))
    length = hypot(*apart(here, there))
    inner = [here]
    for k in range(1, LOOKS):
        place = place_beside(here, there, k / LOOKS)
        distances = widening(SHARP * length, STRAY * length)
        met = yield from beside(place, there.left, distances, EXACT * length, SHARPLY)
        if met is None:
            return [there]
        middle, share = place(met[0])
        inner.append(there._replace(middle=middle, share=share))
    return [*inner, there]


def apart(here, there):
    """How far apart two points are: logarithm of the stretch, share."""
    return log(there.middle / here.middle), there.share - here.share


def place_beside(here, there, part):
    """A stretch and a share, by how far they lie to the left of where an even turn passes a part of the chord."""
    wide, high = apart(here, there)
    length = hypot(wide, high)
    bulge = 0.5 * there.turn * part * (1.0 - part) * length**2  # to the right

    def place(t):
        off = (t - bulge) / length
        return here.middle * exp(part * wide - off * high), here.share + part * high + off * wide

    return place


def runs_beside(here, there):
    """Whether a snap has no room in the last step: the branch passes between two places to both sides of its middle; where
    it hardly leads on or bends, of each of its parts, so close that the share changes on all of them.
    """
    rise = abs(there.share - here.share)
    plain = rise > LEVEL * there.step and not abs(there.chord - here.chord) > BENT
    aside = ASIDE * there.step if plain else min(ASIDE * there.step, BARELY * rise)
    if aside < SHARP * there.step:  # by which its ends may be off
        return False
    for part in (0.5,) if plain else (k / LOOKS for k in range(1, LOOKS)):
        place = place_beside(here, there, part)
        for t in (aside, -aside):
            if there.left * t * (yield from sign_of(*place(t))) <= 0.0:
                return False
    return True


def turns_between(inner, sense):
    """Three points, of which the middle one is the first that no one behind it passes; None where each one passes the
    one before it.
    """
    for k in range(1, len(inner) - 1):
        if sense * inner[k + 1].share < sense * inner[k].share - NOTHING_LESS * inner[k + 1].step:
            return inner[k - 1 : k + 2]
    return None


def is_uneven(inner):
    """Whether a step hardly leads on in a part of it, beside others, or bends there; or nothing is known of its parts."""
    if len(inner) < 2:
        return True
    steps = [(there.middle - here.middle, there.share - here.share) for here, there in pairwise(inner)]
    bends = [abs(atan2(a * d - b * c, a * c + b * d)) for (a, b), (c, d) in pairwise(steps)]
    rises = [abs(rise) for _, rise in steps]
    return max(rises) > UNEVEN * min(rises) or (max(bends, default=0.0) > STRAY and inner[-1].step > SHORT_STEP)


def sharpened(here):
    """The same point, all but to rounding."""
    if here.exact:
        return here

    def place(t):
        return here.middle * exp(-t * sin(here.chord)), here.share + t * cos(here.chord)

    far = 2.0 * SHARP * here.step
    met = yield from beside(place, here.left, (far, 2.0 * far), EXACT * here.step, SHARPLY)
    middle, share = place(0.0 if met is None else met[0])
    return here._replace(middle=middle, share=share, exact=True)

"""A branch, step by step, in the two numbers of :mod:`question`.

To its left the miss is of one sign all along, to its right of the other. From a point of it the branch goes on where
the sign changes on a circle: round a corner, where fibers go slack, or a fold as sharp as a needle no less than where
it is smooth, and never to another branch beside it, which has its signs the other way round.
"""

from math import atan2, cos, exp, hypot, isnan, log, pi, sin
from typing import NamedTuple

from .question import SHARPLY, TRIES, WIDER, ask, crossing

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
LEVEL, LOOKS = 0.3, 4  # change of the share by the step, below which a snap may hide in one; places that are looked at
UNEVEN = 4.0  # times as steep as at a dip between is a step that is looked at again in shorter ones
ASIDE, CLEAR = 0.02, 0.01  # of a step: how far beside a place its miss is compared; of that: a doubt that says nothing
BEGINNINGS = 1e-3, 1e-5, 1e-7  # strains from which on a branch is followed
LEAST_SHARE, EARLY = 1e-9, 0.05  # of the way, where it is looked for, and up to where it has hardly begun
ARRIVED, TURNED, LOST = range(3)


class Point(NamedTuple):
    """A state of a branch: stretch in the middle, share of the way; direction [radian] and length of the step that led
    there, how fast the direction turns, and the sign of the miss to the left. A first point has no step; its direction
    is one from which that of the branch is less than a right angle away.
    """

    middle: float
    share: float
    chord: float
    step: float
    turn: float
    left: float


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
            shorter = SHORTER * ahead.step
            if may_hide(points) and shorter > SMALLEST_STEP and (yield from hides_a_snap(points, sense)):
                points, step = points[:-1], shorter
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


def leaves(here, place, widest):
    """The angle, not wider than the ``widest``, at which a branch leaves a circle round ``here``; None where it is not
    met.
    """
    answer = yield from ask(*place(0.0))
    if isnan(answer.miss):
        return None
    rightward = answer.miss * here.left > 0.0  # the branch lies to the right
    angle, before = SPREAD, (0.0, answer)
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
        before, angle = (t, answer), WIDER * angle
    met = yield from crossing(place, before, (t, answer), SHARP)
    return None if met is None else met[0]


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


def may_hide(points):
    """Whether the last step of a branch hardly leads on, or bends: only there a snap may hide in it."""
    here, there = points[-2:]
    return abs(there.share - here.share) <= LEVEL * there.step or abs(there.chord - here.chord) > BENT


def hides_a_snap(points, sense):
    """Whether the branch falls back somewhere on the last step, or all but does, as far as looks at even places tell."""
    here, there = points[-2:]
    wide, high = log(there.middle / here.middle), there.share - here.share
    climbs = []
    for k in range(LOOKS):
        part = (k + 0.5) / LOOKS
        bulge = 0.5 * there.turn * part * (1.0 - part) * there.step  # of a branch that turns evenly, beside its chord
        place = here.middle * exp(part * wide + bulge * high), here.share + part * high - bulge * wide
        climb = yield from climb_beside(*place, there)
        if climb is None:
            return False
        climbs.append(sense * climb)
    low = min(climbs)
    dips = 0 < climbs.index(low) < LOOKS - 1
    return low < 0.0 or (dips and max(climbs) > UNEVEN * low)


def climb_beside(middle, share, there):
    """The sine of the angle at which the share rises along the branch, where it passes beside a place on the step that led
    ``there``; None where it does not, or there is no tube. The gradient of the miss is normal to the branch.
    """
    far = ASIDE * there.step
    tries, doubt = range(TRIES), CLEAR * far
    here = yield from ask(middle, share, (tries, doubt))
    tries = tries[min(here.fineness, TRIES - 1) :], doubt
    right, above = (yield from ask(middle * exp(far), share, tries)), (yield from ask(middle, share + far, tries))
    across, along = (right.miss - here.miss) / far, (above.miss - here.miss) / far
    size = hypot(across, along)
    beside = size > 0.0 and abs(here.miss) < size * there.step
    return -there.left * across / size if beside else None


def sharpened(here):
    """The same point, all but to rounding."""

    def place(t):
        return here.middle * exp(-t * sin(here.chord)), here.share + t * cos(here.chord)

    far = 2.0 * SHARP * here.step
    low, high = (-far, (yield from ask(*place(-far), SHARPLY))), (far, (yield from ask(*place(far), SHARPLY)))
    if not low[1].miss * high[1].miss < 0.0:
        return here
    met = yield from crossing(place, low, high, EXACT * here.step, SHARPLY)
    return here if met is None else here._replace(middle=place(met[0])[0], share=place(met[0])[1])

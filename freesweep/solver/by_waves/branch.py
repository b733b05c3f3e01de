"""Branches of waves, step by step in the numbers of :mod:`waves`; that of buckled states from where it leaves the straight
tube.
"""

from typing import NamedTuple

import numpy as np

from ..by_middle.many import PIECES
from ..lanes import waves
from ..problem import GAMMA, LENGTH, H
from .waves import Look

AMPLITUDES = 3e-3, 1e-3, 3e-4, 1e-4, 3e-5  # of the smaller wave, tried in turn: steep fibers soon leave the sine
FIRST_STEP, LARGEST_STEP, SMALLEST_STEP, MOST_STEPS = 0.05, 0.5, 1e-6, 2000
SHORTER, LONGER = 0.4, 1.6
EVEN, BENT = 0.99, 0.9  # cosines of the angle by which a branch turns on a step that may be longer next, or is too long
FIRST_PART, SMALLEST_PART = 0.05, 1e-3  # of fiber extension and rotation, by which they are raised at once
APART = 1.2  # times as far from 1 are middles from which it is tried again
ASIDE = 0.3  # of a step: how far from its tangent it may end
# a wave that is none: here the branch comes back to the straight tube; one that is next to none
FAINTEST, FAINT = 1e-6, 1e-3
ALONG, FINEST = PIECES[2], PIECES[-1]  # in which a wave is summed along the branch, at first and at most
ROUGH = 1e-4  # of the length: sums that are known no better need more pieces


class Point(NamedTuple):
    """A place of the branch: the look at it, and the direction (w + 2,) in which it goes on, by weights."""

    look: Look
    toward: np.ndarray

    @property
    def pressure(self):
        return self.look.pair.pressure


def critical(asked):
    """``(center, pressure, whether longer fibers meet the clamped ends)`` of the uniform tube of the rotation held that a
    wave as long as the tube makes unstable; a pressure that is not positive: never.
    """
    problem = asked.problem
    center = problem[GAMMA] / np.sqrt(1.0 + 2.0 * asked.turn / (problem[H] * problem[LENGTH]))
    told = asked.ask(np.array([[p, *asked.loads([center, 0.0])[1:], center, np.nan] for p in (1.0, 2.0)]), 1)
    lost = (
        told[:, waves.BEND] + told[:, waves.STIFFNESS] * (2.0 * np.pi / problem[LENGTH]) ** 2
    )  # linear in the pressure
    return center, 1.0 - lost[0] / (lost[1] - lost[0]), told[0, waves.CLAMPED] > 0.0


def begin(asked, center):
    """The first :class:`Point`; None where that is not met.

    Without fiber extension, and with no rotation, both waves are next to none where the straight cylinder is lost. From
    there, or from farther on, both are raised, while the smaller wave stays, to where the center lies elsewhere; and the
    branch is gone back to where one wave is next to none.
    """
    straight, small = asked.part(0.0), 1 if center >= 1.0 else 0
    point = straighten(straight, small)
    if point is None or center == 1.0:
        return point
    tried, along = FAINT, np.zeros(4)
    along[small] = 1.0
    for _, _, there, _ in follow(straight, point):
        if there.look.pair.near > tried:
            tried = APART * there.look.pair.near
            look = raised(asked, there.look, along)
            if look is not None:
                return turned_round(asked, Point(look, toward(look, along)))
    return None


def straighten(straight, small):
    """The first :class:`Point` of a tube whose center is y = 1."""
    along = np.zeros(4)
    along[small] = 1.0
    _, pressure, _ = critical(straight)
    for amplitude in AMPLITUDES if pressure > 0.0 else ():
        number = np.log(amplitude)
        pair = straight.train([number, number, 1.0, np.log(pressure)])
        solved = straight.solve(pair, along, number, ALONG)
        if solved is not None:
            return Point(solved[0], toward(solved[0], along))
    return None


def turned_round(asked, point):
    """The last :class:`Point` before a wave is next to none, where the branch is followed back from this one."""
    last = point._replace(toward=-point.toward)
    for _, _, ahead, _ in follow(asked, last):
        if ahead.look.pair.near < FAINT:
            break
        last = ahead
    return last._replace(toward=-last.toward)


def raised(asked, look, along):
    """The look at the tube with the whole fiber extension and rotation, from one without, along numbers that keep the one
    that ``along`` says; None where that is not come to.
    """
    share, step, before = 0.0, FIRST_PART, None
    while share < 1.0:
        ahead = min(share + step, 1.0)
        pair = look.pair
        if before is not None:
            pair = pair.moved((pair.numbers - before[1].pair.numbers) * (ahead - share) / (share - before[0]))
        solved = asked.part(ahead).solve(pair, along, along @ look.pair.numbers, ALONG)
        if solved is None:
            step *= SHORTER
            if step < SMALLEST_PART:
                return None
            continue
        before, look, share, step = (share, look), solved[0], ahead, LONGER * step
        pair = asked.part(share).retold(look)
        if pair is not look.pair:  # whose numbers are others
            before, look = None, asked.part(share).look(pair, ALONG)
            if look is None:
                return None
    return look


def toward(look, before):
    """The direction of the branch at a look that leads on from the one before."""
    direction = look.given(look.pair.weights)
    return direction if direction @ before > 0.0 else -direction


def step(asked, here, length, pieces):
    """The next :class:`Point` of the branch, a step of that length from this one; None where it is too long."""
    pair = here.look.pair
    weights = pair.weights
    guess = pair.moved(length * here.toward / weights)
    along = here.toward * weights
    solved = asked.solve(guess, along, along @ guess.numbers, pieces)
    if solved is None:
        return None
    look, _ = solved
    aside = np.abs((look.pair.numbers - guess.numbers) * weights).max()
    point = Point(look, toward(look, here.toward * look.pair.weights / weights))
    return point if point.toward @ here.toward > BENT and aside < ASIDE * length else None


def follow(asked, point):
    """Yield the steps of the branch from a point on, ``(here, length, there, pieces)``, until it ends or is lost."""
    length, pieces = FIRST_STEP, ALONG
    for _ in range(MOST_STEPS):
        ahead = step(asked, point, length, pieces)
        if ahead is None:
            length *= SHORTER
            if length < SMALLEST_STEP:
                return
            continue
        if ahead.look.told[:, waves.DOUBT].sum() > ROUGH * asked.half and pieces < FINEST:
            pieces *= 4
            if (look := asked.look(point.look.pair, pieces)) is None:
                return
            point = point._replace(look=look)
            continue
        yield point, length, ahead, pieces
        if ahead.look.pair.near < FAINTEST:
            return
        if ahead.toward @ point.toward > EVEN:
            length = min(LONGER * length, LARGEST_STEP)
        pair = asked.retold(ahead.look)
        if pair is not ahead.look.pair:
            look = asked.look(pair, pieces)
            if look is not None:
                ahead = Point(look, toward(look, ahead.toward))
        point = ahead

"""The branch of buckled states, from where it leaves the straight tube, step by step in the numbers of :mod:`waves`."""

from typing import NamedTuple

import numpy as np

from ..lanes import waves
from ..problem import GAMMA, LENGTH, H
from .waves import CENTER, PRESSURE, Look, Pair

AMPLITUDES = 3e-3, 1e-3, 3e-4, 1e-4, 3e-5  # of the smaller wave, tried in turn: steep fibers soon leave the sine
FIRST_STEP, LARGEST_STEP, SMALLEST_STEP, MOST_STEPS = 0.05, 0.5, 1e-6, 2000
SHORTER, LONGER = 0.4, 1.6
EVEN, BENT = 0.99, 0.9  # cosines of the angle by which a branch turns on a step that may be longer next, or is too long
ASIDE = 0.3  # of a step: how far from its tangent it may end
FAINTEST = 1e-6  # a wave that is none: here the branch comes back to the straight tube
ALONG, FINEST = 4, 256  # pieces in which a wave is summed along the branch, at first and at most
ROUGH = 1e-4  # of the length: sums that are known no better need more pieces
HALVINGS, MET = 60, 1e-9  # of a step, to a place on it, and the share of the step that is none


class Point(NamedTuple):
    """A place of the branch: the look at it, and the direction (4,) in which it goes on, by weights."""

    look: Look
    toward: np.ndarray

    @property
    def pressure(self):
        return self.look.pair.pressure


def critical(asked):
    """``(center, pressure, torque)`` of the uniform tube of the rotation held that a wave as long as the tube makes
    unstable; a pressure that is not positive: never.
    """
    problem = asked.problem
    center = problem[GAMMA] / np.sqrt(1.0 + 2.0 * asked.turn / (problem[H] * problem[LENGTH]))
    told = asked.ask(np.array([[p, center, center, np.nan] for p in (1.0, 2.0)]), 1)
    lost = told[:, waves.BEND] + told[:, waves.STIFFNESS] * (2.0 * np.pi / problem[LENGTH]) ** 2  # linear in the pressure
    pressure = 1.0 - lost[0] / (lost[1] - lost[0])
    torque = told[0, waves.TORQUE] + (pressure - 1.0) * (told[1, waves.TORQUE] - told[0, waves.TORQUE])
    return center, pressure, torque


def begin(asked, center, pressure):
    """The first :class:`Point`: where the smaller wave is next to none; None where that is not met."""
    off, small = abs(center - 1.0), 1 if center >= 1.0 else 0
    for amplitude in AMPLITUDES:
        numbers = np.array([np.log(amplitude), np.log(amplitude), center, np.log(pressure)])
        numbers[1 - small] = np.log(amplitude + 2.0 * off)
        along = np.zeros(4)
        along[small] = 1.0
        solved = asked.solve(Pair(numbers, np.zeros(2, bool), np.ones(2)), along, numbers[small], ALONG)
        if solved is not None:
            return Point(solved[0], toward(solved[0], along))
    return None


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
            along = np.zeros(4)
            along[PRESSURE] = 1.0
            look = asked.look(pair, pieces)
            if look is not None:
                ahead = Point(look, toward(look, ahead.toward))
        point = ahead


def met(asked, here, length, pieces, missed):
    """The :class:`Point` of a step at which ``missed(point)`` changes its sign, by the regula falsi of Illinois; None where
    the step has none.
    """
    low, high, point, kept = (0.0, missed(here)), None, None, 0
    point = step(asked, here, length, pieces)
    if point is None:
        return None
    high = length, missed(point)
    if high[1] == 0.0 or low[1] == 0.0:
        return point if high[1] == 0.0 else here
    if high[1] * low[1] > 0.0:
        return None
    weights = [1.0, 1.0]
    for _ in range(HALVINGS):
        below, above = weights[0] * low[1], weights[1] * high[1]
        at = (low[0] * above - high[0] * below) / (above - below)
        point = step(asked, here, at, pieces)
        if point is None:
            return None
        miss = missed(point)
        if miss * low[1] > 0.0:
            low, weights, kept = (at, miss), [1.0, 0.5 * weights[1] if kept == 1 else 1.0], 1
        else:
            high, weights, kept = (at, miss), [0.5 * weights[0] if kept == -1 else 1.0, 1.0], -1
        if miss == 0.0 or abs(high[0] - low[0]) < MET * length:
            break
    return point

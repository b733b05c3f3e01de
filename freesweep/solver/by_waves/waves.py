"""A tube as two waves: four numbers, three conditions.

A tube that is the same all along has one level of its first integral. Where it passes y = 1 inside, it is two free tubes,
a swollen one and a thinned one, of one level and under one load. Four numbers tell it: one for the middle of each wave,
the center (:mod:`..lanes.waves`), which tells the torque, and the pressure. Three conditions hold: the levels are the
same, both lengths add up to the tube's, and both twists to what is held. Fronts that are steep beyond any mesh, and
parts that are long and uniform, are ordinary here.

Conditions are smooth but for rounding: their slopes are told by differences.
"""

from typing import NamedTuple

import numpy as np

from ..lanes import waves
from ..problem import GAMMA, LENGTH, MOONEY_RIVLIN, SECOND, THIRD, YEOH

LEVEL, HALF, TURN = range(3)  # conditions: of levels, of half the length, of half the twist
CENTER, PRESSURE = 2, 3  # among the numbers, behind those of the middles
TORQUE = 4  # among the values, behind length, volume, twist and energy
SIDES = (1.0, -1.0)  # of the swollen wave, and of the thinned one
SIGNS = np.array([-1.0, 1.0, 1.0])  # of what the second wave adds to the conditions
# for slopes: little of a deep middle's length is known better than to 1e-8 of a layer
SHALLOW_STEP, DEEP_STEP = 1e-6, 3e-5
OFF_CENTER = 100.0  # times more is the center moved, of the way from it to the middles
DEEP_ENOUGH, TOO_SHALLOW = 3.0, 1.5  # depths from which on a middle is told by its depth, and by its stretch again
# Newton's steps: their number, where they end; end, if they no longer get shorter; are lost
TRIES, CLOSE, STILL, FAR = 12, 1e-10, 1e-4, 1.0
SHORTER, SLIGHT = 0.3, 1e-3
DEPTHS, MANY = 3.0, 10.0  # weight of a depth, which counts by itself from there on
COUNTED = [waves.LEVEL, waves.X, 2]  # in the conditions, of what is told


class Pair(NamedTuple):
    """Two waves: their ``numbers`` (4,), which of them are ``deep`` (2,), whose number is the depth of the middle, not the
    logarithm of its distance from 1, and of those about the ``uniform`` stretch (2,).
    """

    numbers: np.ndarray
    deep: np.ndarray
    uniform: np.ndarray

    def moved(self, change):
        """The pair whose numbers differ by so much."""
        return self._replace(numbers=self.numbers + change)

    @property
    def pressure(self):
        """Of which the number is the logarithm."""
        return float(np.exp(self.numbers[PRESSURE]))

    @property
    def near(self):
        """How far the nearer of both middles is from 1, at most 1."""
        apart = np.where(self.deep, np.abs(self.uniform - 1.0), np.exp(np.where(self.deep, 0.0, self.numbers[:2])))
        return min(np.min(apart), 1.0)

    @property
    def weights(self):
        """By which changes of the numbers count as alike."""
        middles = np.where(self.deep, DEPTHS / np.maximum(self.numbers[:2], MANY), 1.0)
        return np.array([*middles, 5.0 / self.near, 5.0])

    @property
    def steps(self):
        """By how much the numbers are changed to see what that changes."""
        load = DEEP_STEP if self.deep.any() else SHALLOW_STEP
        middles = np.where(self.deep, DEEP_STEP * np.maximum(self.numbers[:2], 1.0), SHALLOW_STEP)
        return np.array([*middles, min(OFF_CENTER * load, SLIGHT) * self.near, load])

    def row(self, numbers, wave):
        """What is asked about one wave of other numbers: pressure, center, stretch, depth."""
        number = numbers[wave]
        about = (self.uniform[wave], number) if self.deep[wave] else (1.0 + SIDES[wave] * np.exp(number), np.nan)
        return np.exp(numbers[PRESSURE]), numbers[CENTER], *about


class Look(NamedTuple):
    """What is known of a pair: by how much it misses the conditions (3,), what that rises by with the numbers (3, 4);
    length, volume, twist and energy of half the tube, and the torque, (5,) and (5, 4); what is told of both waves (2, n).
    """

    pair: Pair
    miss: np.ndarray
    slopes: np.ndarray
    values: np.ndarray
    rises: np.ndarray
    told: np.ndarray

    @property
    def unstable(self):
        """Directions in which the energy falls while the rotation is held.

        The slope y' vanishes in both middles. By Sturm's theorem one direction is unstable under a given torque where the
        tube's waves get longer as their level rises, else two. That a rotation is held takes one away where it falls as
        the torque rises, along states of one length.
        """
        level, half, _ = self.slopes / np.abs(self.slopes[:, :CENTER]).max(axis=1)[:, None]
        longer = level[0] * half[1] - level[1] * half[0]
        slopes = self.slopes[:, :PRESSURE] / np.abs(self.slopes[:, :PRESSURE]).max(axis=1)[:, None]
        turns = np.linalg.det(slopes) * longer * self.rises[TORQUE, CENTER]
        return (1 if longer > 0.0 else 2) - (1 if turns < 0.0 else 0)

    def given(self, weights):
        """How the numbers may change together: the direction (4,) of the branch, times the ``weights``."""
        slopes = self.slopes / weights
        return np.linalg.svd(slopes / np.abs(slopes).max(axis=1)[:, None])[2][-1]


class Waves:
    """What is asked about one tube's waves."""

    def __init__(self, problem, target):
        self.problem, self.half, self.turn = problem, 0.5 * problem[LENGTH], 0.5 * target
        self.constants = YEOH if np.any(problem[[SECOND, THIRD]] != 0.0) else MOONEY_RIVLIN

    def part(self, share):
        """The same tube with that share of its fiber extension and of the rotation held."""
        problem = self.problem.copy()
        problem[GAMMA] = 1.0 + share * (problem[GAMMA] - 1.0)
        return Waves(problem, 2.0 * share * self.turn)

    def ask(self, given, pieces):
        """Rows (n, COUNT) of what is told of halves of waves."""
        told = np.full((len(given), waves.COUNT), np.nan)
        waves.measure_waves(self.problem, given, self.constants, pieces, told)
        return told

    def look(self, pair, pieces):
        """The :class:`Look` at a pair, sums in so many ``pieces``; None where one wave is none."""
        steps, given = pair.steps, []
        for wave in range(2):
            for k in (None, wave, CENTER, PRESSURE):
                for sign in (1.0, -1.0) if k is not None else (0.0,):
                    numbers = pair.numbers.copy()
                    if k is not None:
                        numbers[k] += sign * steps[k]
                    given.append(pair.row(numbers, wave))
        told = self.ask(np.array(given), pieces)
        if not np.all(np.isfinite(told)):
            return None
        both = told.reshape(2, 7, -1)
        counted = both[:, :, COUNTED]
        miss = counted[0, 0] + SIGNS * counted[1, 0] - (0.0, self.half, self.turn)
        values = np.array([*(both[0, 0, :4] + both[1, 0, :4]), both[0, 0, waves.TORQUE]])
        slopes, rises = np.empty((3, 4)), np.zeros((5, 4))
        for wave, sign in enumerate((1.0, SIGNS)):
            slopes[:, wave] = sign * (counted[wave, 1] - counted[wave, 2]) / (2.0 * steps[wave])
            rises[:4, wave] = (both[wave, 1, :4] - both[wave, 2, :4]) / (2.0 * steps[wave])
            by_number = 1.0 if pair.deep[wave] else np.exp(pair.numbers[wave])
            slopes[LEVEL, wave] = SIDES[wave] * by_number * both[wave, 0, waves.RISE]
        for k, at in ((CENTER, 3), (PRESSURE, 5)):
            change = both[:, at] - both[:, at + 1]
            slopes[:, k] = (change[0, COUNTED] + SIGNS * change[1, COUNTED]) / (2.0 * steps[k])
            rises[:4, k] = (change[0] + change[1])[:4] / (2.0 * steps[k])
            rises[TORQUE, k] = change[0, waves.TORQUE] / (2.0 * steps[k])
        return Look(pair, miss, slopes, values, rises, both[:, 0])

    def solve(self, pair, along, value, pieces):
        """The :class:`Look` at the pair near this one that meets the conditions, and of which ``along`` times the numbers is
        the ``value``, and the last change that was made, (4,); None where Newton's method does not come to it.
        """
        weights, last = pair.weights, np.inf
        for _ in range(TRIES):
            look = self.look(pair, pieces)
            if look is None:
                return None
            rows = np.vstack([look.slopes, along]) / weights
            size = np.abs(rows).max(axis=1)
            missed = np.append(look.miss, along @ pair.numbers - value)
            if not np.all(np.isfinite(rows)) or not size.min() > 0.0:
                return None
            try:
                change = -np.linalg.solve(rows / size[:, None], missed / size)
            except np.linalg.LinAlgError:
                return None
            largest = np.abs(change).max()
            if largest < CLOSE or (largest < STILL and largest > SHORTER * last):
                return look, change / weights
            if not largest < FAR:
                return None
            last, pair = largest, Pair(
                pair.numbers + change / weights, pair.deep, np.where(pair.deep, look.told[:, waves.UNIFORM], pair.uniform)
            )  # fmt: skip
        return None

    def retold(self, look):
        """The pair of a look, its middles told by what suits them: the depth or the stretch."""
        numbers, deep, uniform = (array.copy() for array in look.pair)
        for wave, side in enumerate(SIDES):
            depth, about = look.told[wave, [waves.DEPTH, waves.UNIFORM]]
            if deep[wave] and depth < TOO_SHALLOW:
                deep[wave], numbers[wave] = False, np.log(abs(look.told[wave, 4] - 1.0))
            elif not deep[wave] and depth > DEEP_ENOUGH:
                row = np.array([[look.pair.pressure, numbers[CENTER], about, depth]])
                about = self.ask(row, 1)[0, waves.UNIFORM]
                part = 1.0 - side * np.exp(numbers[wave]) / (about - 1.0)  # of the way from there to 1
                if 0.0 < part < 1.0 / np.cosh(TOO_SHALLOW):
                    deep[wave], numbers[wave], uniform[wave] = True, np.arccosh(1.0 / part), about
        return Pair(numbers, deep, uniform) if np.any(deep != look.pair.deep) else look.pair

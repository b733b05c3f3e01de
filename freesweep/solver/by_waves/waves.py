"""A tube as waves: one number for each, and two for the load; one condition less.

A tube that is the same all along has one level of its first integral. Where it passes y = 1 inside, it is free tubes,
swollen ones and thinned ones, of one level and under one load; those of one kind are alike. A number for the middle of each
kind, one for the torque and one for how much of the other loads there is tell it. Conditions hold: all lengths add up to the
tube's, all twists to what is held, and levels are the same. Fronts that are steep beyond any mesh, and parts that are long
and uniform, are ordinary here.

A buckled tube is one wave of each kind; its torque is told by its center (:mod:`..lanes.waves`). A held tube that is its
own mirror image is a body and a neck towards each end (:mod:`.held`); its torque is told by itself.

Conditions are smooth but for rounding: their slopes are told by differences.
"""

from typing import NamedTuple

import numpy as np

from ..along.places import LEAST_ALPHA, OUTER
from ..batch import MIDDLE, OUTPUTS, kinds_of
from ..lanes import waves
from ..lanes.sums import TOLD
from ..problem import FORCE, GAMMA, LENGTH
from .train import CENTER, PRESSURE, Train

HALF, TURN, LEVEL = range(3)  # conditions: of half the length, of half the twist, and of levels
SIDES = np.array([1.0, -1.0])  # of a swollen wave, and of a thinned one
TORQUE = 4  # among the values, behind length, volume, twist and energy
DEEP_ENOUGH, TOO_SHALLOW = 3.0, 1.5  # depths from which on a middle is told by its depth, and by its stretch again
# Newton's steps: their number, where they end; end, if they no longer get shorter; are lost
TRIES, CLOSE, STILL, FAR = 12, 1e-10, 1e-4, 1.0
SHORTER = 0.3
COUNTED = [waves.X, 2, waves.LEVEL]  # in the conditions, of what is told


class Look(NamedTuple):
    """What is known of a train: by how much it misses the conditions (w + 1,), what that rises by with the numbers
    (w + 1, w + 2); length, volume, twist and energy of half the tube, and the torque, (5,) and (5, w + 2); what is told of
    its waves (w, n), and how many halves of each half the tube has (w,).
    """

    pair: Train
    miss: np.ndarray
    slopes: np.ndarray
    values: np.ndarray
    rises: np.ndarray
    told: np.ndarray
    counts: np.ndarray

    @property
    def unstable(self):
        """Directions in which the energy falls while the rotation is held.

        The slope y' vanishes in all middles. By Sturm's theorem as many directions are unstable under a given torque as
        the tube has waves, but one, and one more where its waves do not get longer as their level rises. That a rotation
        is held takes one away where it falls as the torque rises, along states of one length.
        """
        kinds = len(self.counts)
        longer = np.sum(self.slopes[HALF, :kinds] / self.by_level)
        at_length = np.delete(self.slopes[:, : kinds + 1], TURN, axis=0)
        moved = np.append(-np.linalg.solve(at_length[:, :kinds], at_length[:, kinds]), 1.0)
        turns = (self.slopes[TURN, : kinds + 1] @ moved) * self.rises[TORQUE, CENTER]
        return int(self.counts.sum()) - (1 if longer > 0.0 else 0) - (1 if turns < 0.0 else 0)

    @property
    def by_level(self):
        """How the levels of the waves rise with their numbers (w,)."""
        middles = np.where(self.pair.deep, 0.0, self.pair.numbers[:CENTER])
        return np.where(self.pair.deep, 1.0, np.exp(middles)) * self.told[:, waves.RISE]

    @property
    def along(self):
        """Numbers of a physical tube's places (:mod:`..along.places`), and their bounds: shares of its length are means, the
        least pull and what is largest are that of some wave.
        """
        if self.told.shape[1] == waves.COUNT:
            return np.empty((2, 0))
        each, missed = np.split(self.told[:, waves.ALONG :], 2, axis=1)
        parts = self.counts * self.told[:, waves.X]
        parts = parts / parts.sum()
        numbers = [
            *(parts @ each[:, :LEAST_ALPHA]),
            *each[:, LEAST_ALPHA:OUTER].min(axis=0),
            *each[:, OUTER:].max(axis=0),
        ]
        return np.array([numbers, [*(parts @ missed[:, :LEAST_ALPHA]), *missed[:, LEAST_ALPHA:].max(axis=0)]])

    def given(self, weights):
        """How the numbers may change together: the direction (w + 2,) of the branch, times the ``weights``."""
        slopes = self.slopes / weights
        return np.linalg.svd(slopes / np.abs(slopes).max(axis=1)[:, None])[2][-1]


class Waves:
    """What is asked about one tube's waves: of a buckled one, one swollen and one thinned."""

    counts, order, centered = np.ones(2), (0, 1), True

    def __init__(self, problem, target):
        self.problem, self.half, self.turn = problem, 0.5 * problem[LENGTH], 0.5 * target
        ((_, _, self.kind, _),) = kinds_of(problem[None])
        physical = len(self.kind) > 1
        self.measure = waves.measure_physical_waves if physical else waves.measure_waves
        self.columns = waves.COUNT + (2 * (TOLD - OUTPUTS) if physical else 0)

    def part(self, share):
        """The same tube with that share of its fiber extension and of the rotation held."""
        problem = self.problem.copy()
        problem[GAMMA] = 1.0 + share * (problem[GAMMA] - 1.0)
        return type(self)(problem, 2.0 * share * self.turn)

    def train(self, numbers):
        """A train whose middles are told by their stretches."""
        return Train(np.array(numbers), np.zeros(2, bool), np.ones(2), SIDES, True)

    def loads(self, numbers):
        """Pressure, force, fiber extension, and the torque's center or the torque."""
        return np.exp(numbers[PRESSURE]), self.problem[FORCE], self.problem[GAMMA], numbers[CENTER]

    def ask(self, given, pieces):
        """Rows (n, ...) of what is told of halves of waves."""
        told = np.full((len(given), self.columns), np.nan)
        self.measure(self.problem, given, self.centered, *self.kind, pieces, told)
        return told

    def look(self, pair, pieces):
        """The :class:`Look` at a train, sums in so many ``pieces``; None where one wave is none."""
        kinds, steps, given = len(pair.deep), pair.steps, []
        for wave in range(kinds):
            for k in (None, wave, CENTER, PRESSURE):
                for sign in (1.0, -1.0) if k is not None else (0.0,):
                    numbers = pair.numbers.copy()
                    if k is not None:
                        numbers[k] += sign * steps[k]
                    given.append((*self.loads(numbers), *pair.about(numbers, wave)))
        told = self.ask(np.array(given), pieces)
        if not np.all(np.isfinite(told)):
            return None
        each, counts = told.reshape(kinds, 7, -1), self.counts
        counted, sums = each[:, :, COUNTED], np.einsum("k,kij->ij", counts, each[:, :, :TORQUE])
        both = np.einsum("k,kij->ij", counts, counted)[:, :LEVEL]
        levels = counted[0, :, LEVEL] - counted[1:, :, LEVEL]
        miss = np.array([*(both[0] - (self.half, self.turn)), *levels[:, 0]])
        values = np.array([*sums[0], each[0, 0, waves.TORQUE]])
        slopes, rises = np.zeros((kinds + 1, kinds + 2)), np.zeros((5, kinds + 2))
        for wave in range(kinds):
            slopes[:LEVEL, wave] = (
                counts[wave] * (counted[wave, 1, :LEVEL] - counted[wave, 2, :LEVEL]) / (2.0 * steps[wave])
            )
            rises[:TORQUE, wave] = (
                counts[wave] * (each[wave, 1, :TORQUE] - each[wave, 2, :TORQUE]) / (2.0 * steps[wave])
            )
        for k, at in ((CENTER, 3), (PRESSURE, 5)):
            slopes[:LEVEL, k] = (both[at] - both[at + 1]) / (2.0 * steps[k])
            slopes[LEVEL:, k] = (levels[:, at] - levels[:, at + 1]) / (2.0 * steps[k])
            rises[:TORQUE, k] = (sums[at] - sums[at + 1]) / (2.0 * steps[k])
            rises[TORQUE, k] = (each[0, at, waves.TORQUE] - each[0, at + 1, waves.TORQUE]) / (2.0 * steps[k])
        look = Look(pair, miss, slopes, values, rises, each[:, 0], counts)
        slopes[LEVEL:, 0] = look.by_level[0]
        for wave in range(1, kinds):
            slopes[LEVEL + wave - 1, wave] = -look.by_level[wave]
        return look

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
            uniform = np.where(pair.deep, look.told[:, waves.UNIFORM], pair.uniform)
            last, pair = largest, pair.moved(change / weights)._replace(uniform=uniform)
        return None

    def retold(self, look):
        """The train of a look, its middles told by what suits them: the depth or the stretch."""
        pair = look.pair
        numbers, deep, uniform = pair.numbers.copy(), pair.deep.copy(), pair.uniform.copy()
        for wave, side in enumerate(pair.sides):
            depth, about = look.told[wave, [waves.DEPTH, waves.UNIFORM]]
            if deep[wave] and depth < TOO_SHALLOW:
                deep[wave], numbers[wave] = False, np.log(abs(look.told[wave, MIDDLE] - 1.0))
            elif not deep[wave] and depth > DEEP_ENOUGH:
                about = self.ask(np.array([[*self.loads(numbers), about, depth]]), 1)[0, waves.UNIFORM]
                part = 1.0 - side * np.exp(numbers[wave]) / (about - 1.0)  # of the way from there to 1
                if 0.0 < part < 1.0 / np.cosh(TOO_SHALLOW):
                    deep[wave], numbers[wave], uniform[wave] = True, np.arccosh(1.0 / part), about
        return pair._replace(numbers=numbers, deep=deep, uniform=uniform) if np.any(deep != pair.deep) else pair

"""The numbers that tell a train of waves, by what changes of them count, and by which their slopes are told."""

from typing import NamedTuple

import numpy as np

CENTER, PRESSURE = -2, -1  # among the numbers, behind those of the middles
# for slopes: little of a deep middle's length is known better than to 1e-8 of a layer
SHALLOW_STEP, DEEP_STEP = 1e-6, 3e-5
OFF_CENTER, SLIGHT = 100.0, 1e-3  # times more is the center moved, of the way from it to the middles; at most
DEPTHS, MANY = 3.0, 10.0  # weight of a depth, which counts by itself from there on


class Train(NamedTuple):
    """A train of waves of w kinds: its ``numbers`` (w + 2,), which kinds are ``deep`` (w,), whose number is the depth of the
    middle, not the logarithm of its distance from 1, those about the ``uniform`` stretch (w,); the ``sides`` (w,) on
    which they are; and whether the torque is told by its center.
    """

    numbers: np.ndarray
    deep: np.ndarray
    uniform: np.ndarray
    sides: np.ndarray
    centered: bool

    def moved(self, change):
        """The train whose numbers differ by so much."""
        return self._replace(numbers=self.numbers + change)

    @property
    def pressure(self):
        """Of which the number is the logarithm."""
        return float(np.exp(self.numbers[PRESSURE]))

    @property
    def apart(self):
        """How far the middles are from 1 (w,), at most 1."""
        shallow = np.exp(np.where(self.deep, 0.0, self.numbers[:CENTER]))
        return np.minimum(np.where(self.deep, np.abs(self.uniform - 1.0), shallow), 1.0)

    @property
    def near(self):
        """How far the nearest of the middles is from 1."""
        return np.min(self.apart)

    @property
    def aside(self):
        """How far off a torque's number makes much of a difference: to the nearest middle a center's, to the farthest one
        its own.
        """
        return self.near if self.centered else np.max(self.apart)

    @property
    def weights(self):
        """By which changes of the numbers count as alike."""
        middles = np.where(self.deep, DEPTHS / np.maximum(self.numbers[:CENTER], MANY), 1.0)
        return np.array([*middles, 5.0 / self.aside, 5.0])

    @property
    def steps(self):
        """By how much the numbers are changed to see what that changes."""
        load = DEEP_STEP if self.deep.any() else SHALLOW_STEP
        middles = np.where(self.deep, DEEP_STEP * np.maximum(self.numbers[:CENTER], 1.0), SHALLOW_STEP)
        torque = min(OFF_CENTER * load, SLIGHT) if self.centered else load
        return np.array([*middles, torque * self.aside, load])

    def about(self, numbers, wave):
        """Stretch and depth by which the middle of a wave is asked about, of other numbers."""
        number = numbers[wave]
        if self.deep[wave]:
            return self.uniform[wave], number
        return 1.0 + self.sides[wave] * np.exp(number), np.nan

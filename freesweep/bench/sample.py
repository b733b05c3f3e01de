"""The designs that every method of the benchmark solves, and what their errors are measured against."""

from typing import NamedTuple

import numpy as np

from ..first_integral.tube import SOLVED, solve
from ..first_integral.uniform import Tubes, stretch

PRESSURES = (0.05, 3.0)  # P/C10
ENOUGH = 95.0  # percent of the equilibria that an error speaks of


class Sample(NamedTuple):
    """Random designs (n,) as ``problems`` (n, 11), all at the same ``pressures`` (m,) P/C10."""

    problems: np.ndarray
    pressures: np.ndarray

    @property
    def size(self) -> int:
        """Number of equilibria."""
        return len(self.problems) * len(self.pressures)

    def listed(self):
        """``(problems, first, pressures)`` as the kernels take them."""
        first = np.arange(len(self.problems) + 1, dtype=np.int64) * len(self.pressures)
        return self.problems, first, np.tile(self.pressures, len(self.problems))

    def some(self, count):
        """The first designs."""
        return self._replace(problems=self.problems[:count])

    def tubes(self):
        """All equilibria as the quadrature takes them."""
        repeated = np.repeat(self.problems, len(self.pressures), axis=0).T
        h, d, area, gamma, ratio, shear, force, torque, length, second, third = repeated
        pressure = np.tile(self.pressures, len(self.problems))
        return Tubes(
            h, d, area, gamma, ratio, shear, pressure, force, torque, np.ones_like(h), 0.5 * length, second, third
        )


def sample(designs=200, pressures=20, seed=0) -> Sample:
    """Alpha 5..80, beta -80..80 degrees, length/radius 8..60, wall/radius 0.1..0.5, C01/C10 = 0.5; no loads."""
    rng = np.random.default_rng(seed)
    alpha, beta = rng.uniform(5.0, 80.0, designs), rng.uniform(-80.0, 80.0, designs)
    beta = np.where(np.abs(alpha - beta) < 0.5, -beta, beta)  # one fiber family: no problem to solve
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    wall, one = rng.uniform(0.1, 0.5, designs), np.ones(designs)
    problems = np.column_stack(
        [0.5 * (ta + tb), 0.5 * (ta - tb), wall * (2.0 + wall), one, 0.5 * one, one, 0.0 * one, 0.0 * one,
         rng.uniform(8.0, 60.0, designs), 0.0 * one, 0.0 * one]
    )  # fmt: skip
    return Sample(problems, np.linspace(*PRESSURES, pressures))


class Reference(NamedTuple):
    """Half tubes' length, volume and rotation (n, 3) by quadrature of the first integral, and undeformed half lengths."""

    values: np.ndarray
    half: np.ndarray
    stretch: np.ndarray  # of the uniform tube: y at the middle of a long one

    def errors(self, values) -> np.ndarray:
        """Largest error (n,) of ``values`` (n, 3 or more) in length, per undeformed length, and in rotation, per radian or
        relative beyond one.
        """
        miss = np.abs(values[:, :3] - self.values)
        turn = np.maximum(0.5, np.abs(self.values[:, 2]))
        return np.maximum(miss[:, 0] / self.half, miss[:, 2] / turn)


def reference(chosen) -> Reference:
    """Of a sample; raises RuntimeError if the quadrature, whose own error is 1e-11, leaves a point open."""
    tubes = chosen.tubes()
    found = solve(tubes)
    if np.any(found.reason != SOLVED):
        raise RuntimeError(f"{np.count_nonzero(found.reason != SOLVED)} reference points are not solved")
    u, _ = stretch(tubes)
    return Reference(0.5 * found.values[:, :3], tubes.half, np.sqrt(u))


def typical(errors) -> float:
    """What ENOUGH percent of the errors do not exceed; a point without a result counts as infinitely wrong."""
    errors = np.where(np.isfinite(errors), errors, np.inf)
    return float(np.percentile(errors, ENOUGH, method="higher")) if len(errors) else np.inf

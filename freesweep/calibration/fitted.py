"""A fit at its end: what all that is told of it follows from."""

from typing import NamedTuple

import numpy as np

from .branches import curves_of
from .problem import Problem


class Curves(NamedTuple):
    """Of each measured value (values,): the number of its curve, over all measurements and quantities, and its place along
    it.
    """

    number: np.ndarray
    along: np.ndarray


class Fitted(NamedTuple):
    """Parameters ``theta`` (p,), found from ``home`` on those ``rows`` (values,) that count, each with its standard
    uncertainty ``sigma``, which is estimated of the quantities ``unknown``.

    ``model`` and ``there``: what it says, and where it has a state; ``residuals`` and their ``derivative`` (values, p), in
    the units of what was measured; ``active``: rows that hang slack, and are met, left out.
    """

    problem: Problem
    theta: np.ndarray
    home: np.ndarray
    sigma: np.ndarray
    rows: np.ndarray
    unknown: list
    model: np.ndarray
    there: np.ndarray
    residuals: np.ndarray
    derivative: np.ndarray
    active: np.ndarray

    @property
    def known(self):
        """How exactly priors know each parameter: one over its standard uncertainty (p,)."""
        return 1.0 / self.problem.parameters.sigma

    @property
    def weighed(self):
        """Residuals over their standard uncertainties (values,)."""
        return self.residuals / self.sigma

    @property
    def slopes(self):
        """The derivative of these (values, p)."""
        return self.derivative / self.sigma[:, None]

    @property
    def quantities(self):
        """Names of what was measured, as they come."""
        return list(dict.fromkeys(self.problem.quantity.tolist()))

    @property
    def freedom(self):
        """Degrees of freedom that are left."""
        return max(int(self.active.sum()) + int((self.known > 0.0).sum()) - len(self.theta), 1)

    def chi_square(self):
        """Weighed squared residuals, and squared distances from what was known, per degree of freedom."""
        weighed, apart = self.weighed[self.rows], (self.theta - self.problem.parameters.mean) * self.known
        return float(weighed @ weighed + np.sum(apart**2)) / self.freedom

    def of(self, name):
        """Which values (values,) of a quantity count."""
        return self.active & (self.problem.quantity == name)

    def curves(self) -> Curves:
        """The curve of each value."""
        curve, along, count = [], [], 0
        for measurement in self.problem.measurements:
            own, swept = curves_of(measurement)
            at = measurement.pressure if swept == "pressure" else measurement.imposed(swept)
            each = len(measurement.measured)
            numbers = own[:, None] * each + np.arange(each)
            curve.append((count + numbers).ravel())
            along.append(np.repeat(at, each))
            count += (own.max() + 1) * each
        return Curves(np.concatenate(curve), np.concatenate(along))


def fitted(problem, theta, home, sigma, rows, unknown) -> Fitted:
    """The fit of a ``problem`` that ended at ``theta``."""
    model, there = problem.model(theta)
    residuals = problem.residuals(model, there)
    derivative = problem.sloped(problem.derivative(theta), model, there)
    active = rows & (~problem.slack | (there & (residuals > 0.0)))
    return Fitted(problem, theta, home, sigma, rows, unknown, model, there, residuals, derivative, active)

"""The ways along which a tube's loads change, by their share (:mod:`..load_path`)."""

from typing import NamedTuple

from ..problem import AREA, FORCE, GAMMA, TORQUE

REST = 0.0, 0.0, 0.0, 1.0, 1.0  # pressure, force, torque, fiber extension, weight of the wall's energy


class Way(NamedTuple):
    """Pressure, force, torque, fiber extension and weight of the wall's energy at the begin of a way, and what they
    change by on it. A way of pressure has none at its begin and no end: it comes to its ``unit`` half way.
    """

    origin: tuple
    change: tuple
    unit: float

    def load_at(self, share):
        """The load at a share of the way."""
        first, *others = [start + share * change for start, change in zip(self.origin, self.change)]
        return self.unit * share / (1.0 - share) if self.unit else first, *others

    def share_of(self, pressure):
        """Where a way of pressure meets a ``pressure``."""
        return pressure / (pressure + self.unit)

    def pressure_for(self, share, bound):
        """``(pressure, its bound)`` at a share that is known to a ``bound``."""
        return self.load_at(share)[0], self.unit * bound / (1.0 - share) ** 2


def ways_of(problem, settled):
    """``(way of the loads, way of the pressure)`` of a problem whose loads have settled at that pressure."""
    f, m, gamma, area = (float(problem[k]) for k in (FORCE, TORQUE, GAMMA, AREA))
    rise = Way(REST, (float(settled), f, m, gamma - 1.0, 0.0), 0.0)
    return rise, Way((0.0, f, m, gamma, 1.0), (0.0, 0.0, 0.0, 0.0, 0.0), max(float(settled), area))


def fading(problem):
    """The way to a locked shape: the wall fades."""
    return Way(REST, (1.0, 0.0, 0.0, float(problem[GAMMA]) - 1.0, -1.0), 0.0)

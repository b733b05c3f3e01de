"""Which closed form stands behind the numbers of an atlas: that of its tubes' model, but for the clamped ends."""

from typing import NamedTuple

import numpy as np

from ..description.local import Bodies
from ..description.tube_model import TubeModel
from . import bodies, reference, slack


class Predictor(NamedTuple):
    """The uniform tubes of a ``model`` whose energy is ``energy``; of ``bodies`` those that they are locally."""

    model: TubeModel
    energy: str
    bodies: Bodies | None = None

    @property
    def shear(self) -> float:
        """Whether twisting shears the wall: 1.0 or 0.0."""
        return 0.0 if self.energy == "principal" else 1.0

    def states(self, kind, points) -> np.ndarray:
        """Uniform states of a kind at points (n, 17): (n, UNIFORM), of bodies (n, BODY)."""
        if self.bodies is not None:
            return bodies.states(kind, points, self.bodies, lambda local: self._tubes(kind, local))
        return self._tubes(kind, points)

    def terms(self, variable, points, states):
        """What :mod:`reference` takes as the terms of a variable; None: its own."""
        return None if self.bodies is None else bodies.terms(variable, points, states)

    def restore(self, variable, points, states, *arrays):
        """As :func:`reference.restore_all`."""
        reference.restore_all(variable, points, states, *arrays, self.terms(variable, points, states))

    def end_effects(self, variable, kind, points, states, *arrays):
        """As :func:`reference.end_effects`."""
        reference.end_effects(variable, kind, points, states, *arrays, self.terms(variable, points, states))

    def _tubes(self, kind, points):
        if self.model.is_physical:
            return self.physical(kind, points)
        found = np.empty((len(points), reference.UNIFORM))
        reference.uniform_states(kind, points, self.shear, found)
        return found

    def physical(self, kind, points) -> np.ndarray:
        """The same by the kernel of physical tubes, which knows the source's, too."""
        from .physical_tube import physical_states

        found = np.empty((len(points), reference.UNIFORM))
        physical_states(kind, points, *self._physical(points), found)
        return found

    def _physical(self, points):
        """What kernels of :mod:`physical_tube` take a model for, and the columns of the rubbers' constants."""
        from .physical_tube import MOONEY_RIVLIN, YEOH

        columns = YEOH if np.any(points[:, [reference.C20, reference.C30]] != 0.0) else MOONEY_RIVLIN
        return float(self.model.is_thick), float(self.model.is_loose), columns

    def middles(self, points, mid_radius) -> np.ndarray:
        """``(meridional stretch, stretch, twist rate)`` (n, 3) of physical tubes under pressure where they are that wide."""
        from .physical_tube import middles

        found = np.empty((len(points), 3))
        middles(points, mid_radius, *self._physical(points), found)
        return found

    def outer_radius(self, points, mid_radius, estimate, bound) -> tuple:
        """``(value, estimate, bound)`` of the largest outer radius (n,) [m] of physical tubes under pressure, from those of
        the radius in the middle.
        """
        from .physical_tube import outer_radius

        found, missed = np.empty((3, len(points))), np.empty((3, len(points)))
        for k, middle in enumerate((mid_radius, mid_radius + estimate, mid_radius + bound)):
            outer_radius(points, middle, *self._physical(points), found[k], missed[k])
        return found[0], np.abs(found[1] - found[0]) + missed[0], np.abs(found[2] - found[0])

    def slack_families(self, points, states, mid_radius) -> np.ndarray:
        """Flags (n,) of :func:`slack.slack_families` at points (n, 17), from the radius in the middle (n,) [m]."""
        told = np.empty(len(points), np.uint8)
        if self.bodies is not None:  # no first integral
            told[:] = slack.UNKNOWN
        elif not self.model.is_physical:
            slack.slack_families(points, states, mid_radius, self.shear, told)
        else:
            from .physical_tube import slack_somewhere

            slack_somewhere(points, mid_radius, *self._physical(points), told)
        return told

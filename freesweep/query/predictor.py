"""Which closed form stands behind the numbers of an atlas: that of its tubes' model, but for the clamped ends."""

from typing import NamedTuple

import numpy as np

from ..description.families import FAMILIES, lines_of
from ..description.local import Bodies
from ..description.tube_model import THREADS, TubeModel
from . import bodies, reference, slack


def tell_families(told, families):
    """Put the tension of the line that was followed, the last but one of what is ``told`` (..., TOLD), in the places of the
    ``families``.
    """
    line = told[..., -2].copy()
    for k, name in enumerate(FAMILIES, -2):
        told[..., k] = line * (1.0 / len(families) if name in families else 0.0)


class Predictor(NamedTuple):
    """The uniform tubes of a ``model`` whose energy is ``energy``; of ``bodies`` those that they are locally."""

    model: TubeModel
    energy: str
    bodies: Bodies | None = None
    families: tuple = FAMILIES

    @property
    def is_physical(self) -> bool:
        """Whether the tubes are more than the source's, or have fewer families."""
        return self.model.is_physical or len(self.families) < 2

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
        if self.is_physical:
            return self.physical(kind, points)
        found = np.empty((len(points), reference.UNIFORM))
        reference.uniform_states(kind, points, self.shear, found)
        return found

    def physical(self, kind, points) -> np.ndarray:
        """The same by the kernel of physical tubes, which knows the source's, too."""
        from .physical_tube import physical_states

        found = np.empty((len(points), reference.UNIFORM))
        for some, own, what, few in self._kinds(points):
            part = np.empty((len(own), reference.UNIFORM))
            physical_states(kind, own, *what, part)
            if few:  # what the ends add to the rotation does not vanish where a line beside the fibers mirrors them
                part[:, 0] = 1.0
            found[some] = part
        return found

    def _kinds(self, points):
        """``(which points, their lines, what kernels of :mod:`physical_tube` take a model for, whether there are fewer than
        two families)`` of each kind of tubes among the points: of loose families that share an angle there is one.
        """
        from .physical_tube import MOONEY_RIVLIN, YEOH

        columns = YEOH if np.any(points[:, [reference.C20, reference.C30]] != 0.0) else MOONEY_RIVLIN
        lines = lines_of(points[:, reference.ALPHA], points[:, reference.BETA], self.families, self.model.is_loose)
        if lines.single.any():
            points = points.copy()
            points[:, reference.ALPHA], points[:, reference.BETA] = lines.alpha, lines.beta
        codes = np.unique(lines.threads)
        for code in codes.tolist():
            some = slice(None) if len(codes) == 1 else lines.threads == code
            yield some, points[some], (float(self.model.is_thick), code, columns), code > THREADS[2, "loose"]

    def middles(self, points, mid_radius) -> np.ndarray:
        """``(meridional stretch, stretch, twist rate)`` (n, 3) of physical tubes under pressure where they are that wide."""
        from .physical_along import middles

        found = np.empty((len(points), 3))
        for some, own, what, _ in self._kinds(points):
            part = np.empty((len(own), 3))
            middles(own, mid_radius[some], *what, part)
            found[some] = part
        return found

    def worst_places(self, points, mid_radius, estimate, bound) -> tuple:
        """``(value, estimate, bound)``, (TOLD, n) each, of what :data:`.family.TOLD` names in its order, of physical tubes
        under pressure, from those of the radius in the middle.
        """
        from .physical_along import TOLD, worst_places

        found, missed = np.empty((len(points), 3, TOLD)), np.empty((len(points), TOLD))
        beside = mid_radius[:, None] + np.stack([estimate, bound], axis=1)
        for some, own, what, few in self._kinds(points):
            part, lacks = np.empty((len(own), 3, TOLD)), np.empty((len(own), TOLD))
            worst_places(own, mid_radius[some], beside[some], *what, part, lacks)
            if few:
                tell_families(part, self.families), tell_families(lacks, self.families)
            found[some], missed[some] = part, lacks
        found, missed = np.moveaxis(found, 0, -1), missed.T
        # of what lies at a clamped end, and is known but for it, or is 0
        size = np.pi * points[:, reference.FIBERS] ** 2 * points[:, reference.PRESSURE]
        rounding = np.finfo(float).eps * np.maximum(np.abs(found[0]), (np.arange(TOLD) > 1)[:, None] * size)
        return found[0], np.abs(found[1] - found[0]) + missed, np.abs(found[2] - found[0]) + rounding

    def slack_families(self, points, states, mid_radius) -> np.ndarray:
        """Flags (n,) of :func:`slack.slack_families` at points (n, 17), from the radius in the middle (n,) [m]."""
        told = np.full(len(points), slack.UNKNOWN, np.uint8)
        if self.bodies is not None:  # no first integral
            return told
        if not self.is_physical:
            slack.slack_families(points, states, mid_radius, self.shear, told)
            return told
        from .physical_along import slack_somewhere

        for some, own, what, few in self._kinds(points):
            part = np.full(len(own), slack.UNKNOWN, np.uint8)
            if not few:
                slack_somewhere(own, mid_radius[some], *what, part)
            told[some] = part
        return told

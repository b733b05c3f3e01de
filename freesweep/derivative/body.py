"""A body of revolution as dual numbers: at each place the tube of its own radius (:mod:`freesweep.solver`'s body, theory
section 12). With R and R' in units of the fiber surface at x = 0, and ``e = sqrt(1 + R'^2)``::

    w = (R' y + R v)/e,    L = e R^2 l(y, w),    L_y = e R^2 (l_y + R'/e l_w),    L_v = R^3 l_w

with l the density of that tube under the same loads.
"""

import numpy as np

from .dual import sqrt
from .physics import outputs_of


class Body:
    """As :class:`freesweep.derivative.physics.Physics`, of a body whose tubes ``own`` knows."""

    def __init__(self, own):
        self.own, self.tube, self.parameters = own, own.tube, own.parameters
        self.reference, self.length = own.design["fiber_radius"], own.length

    def _radii(self, share):
        """R, R' and e."""
        course, seed = self.own.course, self.own.seed
        R = course.at(share, seed)["fiber_radius"] / self.reference
        rise = course.rise(share, seed) / self.own.design["length"]
        return R, rise, sqrt(rise * rise + 1.0)

    def local(self, y, v, share):
        """``(room, L_y, L_v)`` in all cells, at their middles."""
        R, rise, e = self._radii(share)
        room, l_y, l_w = self.own.local(y, (rise * y + R * v) / e, share)
        return room, R * R * (e * l_y + rise * l_w), R * R * R * l_w

    def integrands(self, y, v, share):
        """What the outputs integrate, in the cells of which :meth:`local` was asked last."""
        R, rise, e = self._radii(share)
        s, volume, twist, energy = self.own.integrands(y, (rise * y + R * v) / e, share)
        return e * s, e * R * R * volume, e * twist / R, e * R * R * energy

    def meridian(self, y, v, share):
        """Slope of the meridian, and axial stretch, in all cells."""
        R, rise, e = (number.value for number in self._radii(share))
        return self.own.meridian(y, (rise * y + R * v) / e, share)

    def begin(self, other):
        """Take over from another one of the same state what helps to find it."""
        self.own.begin(other.own)

    def kinks(self, segments, cells=slice(None)):
        """As of :class:`freesweep.derivative.physics.Physics`."""
        return self.own.kinks(segments, cells)

    def rest_integrals(self):
        """What the outputs integrate, of the undeformed body."""
        square, _ = self.own.course.squares(self.own.seed)
        none = 0.0 * self.length
        return [self.length, self.length * square / (self.reference * self.reference), none, none]

    def outputs(self, integrals, middle, half):
        """The outputs in SI units and degrees from dimensionless dual numbers of all of the body."""
        course, seed, design = self.own.course, self.own.seed, self.own.design
        _, inside = course.squares(seed)
        scales = {"mid_radius": course.at(0.5, seed)["fiber_radius"]}
        numbers = [*(0.5 * integral for integral in integrals), middle]
        return outputs_of(design, numbers, scales, np.pi * design["length"] * inside)

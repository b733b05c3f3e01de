"""What varies along a tube, at any places x/l, as dual numbers of what was given: the same rules as
:mod:`freesweep.description.revolution` has for numbers. A profile moves by the same amount all along.
"""

import numpy as np

from ..description.along import rule_of
from ..description.families import followed
from ..description.given import numbers
from ..description.profiles import as_profile
from ..description.revolution import gauss, resolved, shape, shape_slope
from .dual import Dual, sqrt

ANGLES = ("alpha", "beta")


def lines_of(tube) -> dict:
    """Which family's angle each line moves with that the solver follows: line -> family, None of a line beside one."""
    return dict(zip(ANGLES, (*followed(tube), None, None)))


class Course:
    """Angles, wall and radius along a ``tube`` that varies; ``places`` x/l where pieces meet."""

    def __init__(self, tube, places):
        self.tube, self.places = tube, np.asarray(places) / places[-1]
        self.parts, self.given = resolved(tube), as_profile(tube.radius, "m")

    def at(self, share, seed) -> dict:
        """Angles [degree], wall, of a body radius and fiber radius [m], too: name -> dual numbers (n,) at places x/l inside
        of segments; ``seed(name, values)`` makes them dual.
        """
        lines = [
            (*names, line) for names, line in zip(lines_of(self.tube).items(), (self.parts.first, self.parts.second))
        ]
        if not self.tube.is_body:
            wall = {"wall": seed("wall", self.parts.wall.at(share))}
            return wall | {name: seed(family, line.at(share)) for name, family, line in lines}
        inner, wall, fibers = self._walls(share, seed)
        first = self._walls(0.0, seed)[2]
        found = {"radius": inner, "wall": wall, "fiber_radius": fibers}
        for name, family, line in lines:
            if family and (text := rule_of(family, getattr(self.tube, family))):
                start = np.sin(np.radians(seed(family, numbers(text, "degree").item())))
                found[name] = np.degrees(np.arcsin(start * first / fibers))
            else:
                found[name] = seed(family, line.at(share))
        return found

    def first_surface(self, seed):
        """Radius of the fibers of a body at x = 0 [m]: what lengths are measured by."""
        return self._walls(0.0, seed)[2]

    def rise(self, share, seed):
        """Slope dR/d(x/l) of a body's fiber surface [m]."""
        taper, bulge = self._shape(seed)
        along = shape(share, taper, bulge) * self.given.slope_at(share)
        along = along + seed("radius", self.given.at(share)) * shape_slope(share, taper, bulge)
        if not rule_of("wall", self.tube.wall):
            return along
        inner, wall, _ = self._walls(share, seed)
        outer = inner + wall
        return along * (1.0 + self.tube.fiber_share * (inner / outer - 1.0))

    def squares(self, seed):
        """Means along a body of the squared fiber radius, and of that less the squared inner radius [m2]."""
        share, weight = gauss(self.parts.profiles)
        inner, _, fibers = self._walls(share, seed)
        square = fibers * fibers
        return mean(square, weight), mean(square - inner * inner, weight)

    def _shape(self, seed):
        """Taper and bulge [-]."""
        return seed("taper", self.tube.taper), seed("bulge", self.tube.bulge)

    def _inner(self, share, seed):
        """Inner radius of a body [m]: what is given moves, and is shaped then."""
        return seed("radius", self.given.at(share)) * shape(share, *self._shape(seed))

    def _walls(self, share, seed):
        """Inner radius, wall and fiber radius of a body [m]."""
        inner, part = self._inner(share, seed), self.tube.fiber_share
        if text := rule_of("wall", self.tube.wall):
            first = self._inner(0.0, seed)
            outside = first + seed("wall", numbers(text, "m").item())
            wall = sqrt(inner * inner + outside * outside - first * first) - inner
            return inner, wall, inner + part * wall
        thinnest = float(np.min(self.parts.wall.samples())) if part else 0.0
        return inner, seed("wall", self.parts.wall.at(share)), inner + part * seed("wall", thinnest)


def mean(number, weight):
    """The sum over places (n,) of a dual number, each with its weight."""
    value = np.atleast_1d(weight @ np.broadcast_to(number.value, len(weight)))
    if number.parts is None:
        return Dual(value)
    return Dual(value, np.broadcast_to(number.parts, (len(number.parts), len(weight))) @ weight[:, None])

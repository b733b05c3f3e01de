"""Bodies of revolution: what follows from an inner radius that varies along the axis.

The radius may be given along the tube; a taper and a bulge change what is given::

    radius(x) = given(x) (1 - taper x/l) (1 + bulge sin^2(pi x/l))

so a taper is the share by which the far end is slimmer than the near one, a bulge that by which the middle is wider than
without it; a bulge leaves the ends as they are, and their slopes.

The fibers lie a part of the wall outside the inner radius, on a surface R(x); a wall that varies counts where it is
thinnest, unless it follows the radius ("constant volume": the section stays that at x = 0). Along that surface::

    geodesic winding (Clairaut)   sin(angle) = R(0) sin(angle_0)/R
    constant volume               (radius + wall)^2 - radius^2 = that at x = 0

Where sin(angle) would pass 1 a geodesic turns back: there is no such body.
"""

from typing import NamedTuple

import numpy as np

from .along import rule_of
from .families import followed, other_line
from .given import numbers
from .profiles import Along, ProfileError, as_profile, is_profile

GAUSS = np.polynomial.legendre.leggauss(20)
PANELS = 64  # of each segment, for volumes: of smooth profiles exact to rounding


class Derived(Along):
    """A quantity that follows from others: ``rule(low, high, share)`` gives its values, ``slope`` its derivative by x/l."""

    def __init__(self, rule, parents, slope=None):
        self.within, self.slope = rule, slope
        self.breaks = np.unique(np.concatenate([parent.breaks for parent in parents]))
        self.function = next((parent.function for parent in parents if parent.function), None)


class Resolved(NamedTuple):
    """All that varies along a tube, [degree] and [m]: the lines that the solver follows, of which some are ``families``,
    wall and inner radius; ``fibers`` is the radius at which they lie, None of a tube.
    """

    families: tuple
    first: Along
    second: Along
    wall: Along
    radius: Along
    fibers: Along | None
    scale: tuple  # length and reference radius [m], whether the wall is thick

    @property
    def profiles(self):
        """Those whose bends and jumps count."""
        return (self.first, self.second, self.wall) + ((self.radius,) if self.fibers else ())

    def named(self, name) -> Along:
        """That of the parameter ``name``; the second of two families of one angle is the first."""
        if name in ("wall", "radius"):
            return getattr(self, name)
        return self.second if self.families[1:] == (name,) else self.first

    def numbers(self, low, high, share):
        """H, D, the section over the squared fiber radius, (3, n); of a body R, dR/dx and the inner radius squared, too."""
        ta, tb = (np.tan(np.radians(angle.within(low, high, share))) for angle in (self.first, self.second))
        length, reference, thick = self.scale
        inner, wall = self.radius.within(low, high, share), self.wall.within(low, high, share)
        surface = reference if self.fibers is None else self.fibers.within(low, high, share)
        found = [0.5 * (ta + tb), 0.5 * (ta - tb), ((inner + wall) ** 2 - inner**2) / surface**2]
        if self.fibers is not None:
            rise = self.fibers.slope(low, high, share) / length
            found += [surface / reference, rise, (inner / surface) ** 2 * float(thick)]
        return np.stack(found)


def is_body(tube) -> bool:
    """Whether the inner radius of a ``tube`` varies."""
    return is_profile(tube.radius) or tube.taper != 0.0 or tube.bulge != 0.0


def inner_radius(tube) -> Along:
    """Inner radius [m] along a ``tube``, with its taper and its bulge."""
    given = as_profile(tube.radius, "m")
    if tube.taper == 0.0 and tube.bulge == 0.0:
        return given

    def width(low, high, share):
        return given.within(low, high, share) * shape(low + (high - low) * share, tube.taper, tube.bulge)

    def slope(low, high, share):
        at = low + (high - low) * share
        own = given.slope(low, high, share) * shape(at, tube.taper, tube.bulge)
        return own + given.within(low, high, share) * shape_slope(at, tube.taper, tube.bulge)

    return Derived(width, [given], slope)


def shape(share, taper, bulge):
    """Radius at shares x/l of the length over what is given there [-]; arrays broadcast."""
    return (1.0 - taper * share) * (1.0 + bulge * np.sin(np.pi * share) ** 2)


def shape_slope(share, taper, bulge):
    """Its derivative by x/l."""
    swollen = 1.0 + bulge * np.sin(np.pi * share) ** 2
    return np.pi * bulge * np.sin(2.0 * np.pi * share) * (1.0 - taper * share) - taper * swollen


def resolved(tube) -> Resolved:
    """What varies along a ``tube``, with its rules resolved. Raises :class:`ProfileError`."""
    radius = inner_radius(tube)
    body, wall = is_body(tube), _wall(tube.wall, radius)
    fibers = None
    if body:
        part = tube.fiber_share
        if rule_of("wall", tube.wall):
            fibers = Derived(
                lambda low, high, share: radius.within(low, high, share) + part * wall.within(low, high, share), [radius],
                lambda low, high, share: radius.slope(low, high, share) + part * wall.slope(low, high, share),
            )  # fmt: skip
        else:
            inside = part * float(np.min(wall.samples())) if part else 0.0
            fibers = Derived(lambda low, high, share: radius.within(low, high, share) + inside, [radius], radius.slope)
    families = followed(tube)
    lines = [_angle(name, getattr(tube, name), fibers) for name in families] or [as_profile(0.0, "degree")]
    if len(lines) == 1:
        lines.append(_beside(lines[0]))
    reference = float(fibers.at(0.0)[0]) if body else tube.fiber_surface
    return Resolved(families, *lines, wall, radius, fibers, (tube.length, reference, body and tube.is_thick))


def _wall(value, radius):
    text = rule_of("wall", value)
    if text is None:
        return as_profile(value, "m")
    first = float(radius.at(0.0)[0])
    section = (first + numbers(text, "m").item()) ** 2 - first**2

    def thickness(low, high, share):
        inner = radius.within(low, high, share)
        return section / (np.sqrt(inner**2 + section) + inner)

    def slope(low, high, share):
        inner = radius.within(low, high, share)
        return (inner / np.sqrt(inner**2 + section) - 1.0) * radius.slope(low, high, share)

    return Derived(thickness, [radius], slope)


def _angle(name, value, fibers):
    text = rule_of(name, value)
    if text is None:
        return as_profile(value, "degree")
    first, start = float(fibers.at(0.0)[0]), np.sin(np.radians(numbers(text, "degree").item()))

    def angle(low, high, share):
        sine = start * first / fibers.within(low, high, share)
        if np.any(np.abs(sine) >= 1.0):
            k = int(np.argmax(np.abs(sine) >= 1.0))  # the first
            at = low + (high - low) * np.ravel(share)[k]
            raise ProfileError(
                f"{name}: the geodesic that starts at {text} turns back before x/l = {at:.3g}, where the radius of the"
                f" fibers is {1e3 * np.ravel(fibers.within(low, high, share))[k]:.4g} mm; it needs more than"
                f" {1e3 * abs(start) * first:.4g} mm; start it steeper along the axis, or widen the body there"
            )
        return np.degrees(np.arcsin(sine))

    return Derived(angle, [fibers])


def _beside(line):
    """The second line of a tube with fewer than two families."""

    def angle(low, high, share):
        return np.degrees(np.arctan(other_line(np.tan(np.radians(line.within(low, high, share))))))

    return Derived(angle, [line])


def wall_volume_inside(tube) -> float:
    """Undeformed volume between cavity and fiber surface [m3]: an incompressible wall keeps it."""
    parts = resolved(tube)
    share, weight = gauss(parts.profiles)
    return np.pi * tube.length * float(weight @ (parts.fibers.at(share) ** 2 - parts.radius.at(share) ** 2))


def gauss(profiles):
    """Places x/l inside of the pieces between which profiles bend or jump, and their weights, to integrate along a tube."""
    breaks = np.unique(np.concatenate([profile.breaks for profile in profiles]))
    share = (np.arange(PANELS)[:, None] + 0.5 + 0.5 * GAUSS[0]).ravel() / PANELS
    weight, widths = np.tile(0.5 * GAUSS[1], PANELS) / PANELS, np.diff(breaks)[:, None]
    return (breaks[:-1, None] + widths * share).ravel(), (widths * weight).ravel()

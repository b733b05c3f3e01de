"""What decides whether a tube fits, and lasts: the largest and the least along it, from its profiles.

An incompressible layer of the undeformed radius rho has, under the meridional stretch lambda, the radius

    r(rho)^2 = y^2 + (rho^2 - r_f^2)/lambda,   y the deformed and r_f the undeformed radius of the fiber surface

and the stretches, in the surface, of ``[[r/rho, r psi], [0, lambda]]``; across it rho/(r lambda). The meridional stretch and
the twist rate psi follow from the angles of the fibers: ``y (tan alpha - tan beta)/(r_f lambda)`` is the difference of their
tangents after deformation. Families without tension, or that would have to push, are slack: over which share of the
undeformed length, and how hard they would push.
"""

import numpy as np

from .description.loads import STATIONS
from .description.stations import breaks_of, shares_of
from .description.strain import largest_principal

FAMILIES = ("alpha", "beta")
# of the length: what stands for both sides of a place where segments meet, and places in layers, thin at low pressures
NEAR = np.append(1e-10, np.geomspace(1e-6, 0.8 / (STATIONS - 1), 40))
ROUNDING = 1e-14  # of a share, a sum of lengths
UNEVEN = 10.0  # times as far as on the other side of a station: no parabola is laid through the three


def with_own(tube, stations):
    """The stations that are asked for [m], and those at which the worst is looked for, ascending, each once."""
    return np.union1d(stations, _own(tube))


def _own(tube):
    """Evenly spaced stations, and ever closer ones toward the places from which layers begin: clamped ends, of a tube that
    is the same all along the near one, and where profiles jump or bend, these too. Of thick walls kernels find the worst.
    """
    even = np.linspace(0.0, tube.length, STATIONS)
    if tube.is_thick:
        return even
    begins = breaks_of(tube) if tube.varies else np.zeros(1)
    near = np.concatenate([begins[:, None] - NEAR, begins[:, None] + NEAR], axis=1).ravel()
    return np.union1d(even, tube.length * near[(near > 0.0) & (near < 1.0)])


def worst_places(tube, profiles, stations, slack_fiber) -> dict:
    """``outer_radius`` [m], ``largest_stretch``, ``slack_alpha``, ``slack_beta`` (0..1), ``least_tension_alpha`` and
    ``least_tension_beta`` [N] with their ``_error``, from ``profiles`` (name -> array over loads and ``stations``).
    """
    own = np.searchsorted(stations, _own(tube))
    x = stations[own]
    part = {name: array[..., own] for name, array in profiles.items()}
    along, found = (x, _apart(tube, x)), {}
    for name, function in (("outer_radius", _outer_radius), ("largest_stretch", _largest_stretch)):
        found |= _largest(name, *_with_error(function, tube, part, shares_of(tube, x)), *along)
    for bit, family in enumerate(FAMILIES, 1):
        tension, error = part[f"fiber_tension_{family}"], part[f"fiber_tension_{family}_error"]
        top = _top(-tension)
        least = _largest(f"least_tension_{family}", -tension, top, _taken(error, top)[..., 0], *along)
        found |= {name: value if name.endswith("_error") else -value for name, value in least.items()}
        found |= _share(f"slack_{family}", tension, (slack_fiber & bit) > 0, x)
    return found


def _kinematics(tube, deformed_radius, alpha_deformed, beta_deformed, share):
    """``(meridional stretch, twist rate [1/m])`` from profiles [m, degree]."""
    (ta, tb), (a, b) = np.tan(np.radians(tube.lines(share))), np.tan(np.radians([alpha_deformed, beta_deformed]))
    surface = tube.fiber_surface_at(share)
    y = deformed_radius / surface
    meridional = y * (ta - tb) / (a - b)
    return meridional, (meridional * a / y - ta) / surface


def _layer(surface, deformed_radius, meridional, rho):
    """Radius of a layer [m]; ``surface`` is that of the fibers."""
    return np.sqrt(deformed_radius**2 + (rho**2 - surface**2) / meridional)


def _inner(tube, share):
    """Undeformed inner radius [m]."""
    return tube.profile("radius").at(share) if tube.is_body else tube.radius


def _outer_radius(tube, y, alpha, beta, share):
    meridional, _ = _kinematics(tube, y, alpha, beta, share)
    outer = _inner(tube, share) + tube.profile("wall").at(share)
    return _layer(tube.fiber_surface_at(share), y, meridional, outer)


def _largest_stretch(tube, y, alpha, beta, share):
    inner = _inner(tube, share)
    surfaces = inner, inner + tube.profile("wall").at(share)
    return np.maximum(*(largest_principal(*_strained(tube, y, alpha, beta, share, rho)) for rho in surfaces))


def _strained(tube, y, alpha, beta, share, rho):
    """``(meridional, hoop, shear)`` of the layer of the undeformed radius ``rho``."""
    meridional, twist = _kinematics(tube, y, alpha, beta, share)
    r = _layer(tube.fiber_surface_at(share), y, meridional, rho)
    return meridional, r / rho, r * twist


def strained_layers(tube, profiles, stations) -> list:
    """``(meridional, hoop, shear)`` of the layers that a tube's model strains, of a thick wall the first and the last, along
    ``profiles`` (name -> array over loads and ``stations``); a twist that has no energy strains nothing.
    """
    share = shares_of(tube, stations)
    inner = _inner(tube, share)
    thick = inner, inner + tube.profile("wall").at(share)
    at = [profiles[name] for name in ("deformed_radius", "alpha_deformed", "beta_deformed")]
    with np.errstate(invalid="ignore", divide="ignore"):
        layers = [
            _strained(tube, *at, share, rho) for rho in (thick if tube.is_thick else (tube.fiber_surface_at(share),))
        ]
    return [(meridional, hoop, shear * (tube.energy == "full")) for meridional, hoop, shear in layers]


def _with_error(function, tube, part, share):
    """A function of the profiles along the tube, and its bound from theirs where it is largest."""
    names = ("deformed_radius", "alpha_deformed", "beta_deformed")
    at = [part[name] for name in names]
    with np.errstate(invalid="ignore", divide="ignore"):
        value = function(tube, *at, share)
        top = _top(value)
        here, where, error = [_taken(one, top) for one in at], share[top], 0.0
        for k, name in enumerate(names):
            moved = [one + _taken(part[f"{name}_error"], top) if j == k else one for j, one in enumerate(here)]
            error = error + np.abs(function(tube, *moved, where) - _taken(value, top))
    return value, top, error[..., 0]


def _top(value):
    """Where the last axis is largest: (..., 1)."""
    return np.argmax(np.nan_to_num(value, nan=-np.inf), axis=-1)[..., None]


def _taken(array, place):
    return np.take_along_axis(array, place, axis=-1)


def _apart(tube, x):
    """Which stations [m] but the first and the last have a neighbour on the other side of a jump or bend, or lie on it."""
    breaks = tube.length * breaks_of(tube)[1:-1]
    return np.any((x[:-2, None] <= breaks) & (breaks < x[2:, None]), axis=1)


def _largest(name, value, top, error, x, apart):
    """The largest along the last axis, near ``top`` with this ``error``: that of the parabola through three stations ``x``,
    and what a curve may pass it by, as its bend changes about there, at a corner by all of it.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        bends = np.where(apart, 0.0, np.diff(value, n=2, axis=-1))
        near = _taken(bends, np.clip(top - 1 + np.arange(-2, 3), 0, len(x) - 3))
        missed = np.minimum(np.max(np.abs(np.diff(near, axis=-1)), axis=-1), 0.5 * np.max(np.abs(near), axis=-1))
        at = np.clip(top, 1, len(x) - 2) + np.arange(-1, 2)
        widths, steps = np.diff(x[at], axis=-1), np.diff(_taken(value, at), axis=-1)
        rise, fall = np.moveaxis(steps / widths, -1, 0)
        before, behind = np.moveaxis(widths, -1, 0)
        slope, bend = (rise * behind + fall * before) / (before + behind), (rise - fall) / (before + behind)
        above = 0.25 * slope * slope / bend
        even = np.maximum(before, behind) < UNEVEN * np.minimum(before, behind)
        smooth = (top[..., 0] == at[..., 1]) & np.logical_not(apart[at[..., 1] - 1]) & even & (bend > 0.0)
    inside = (top[..., 0] > 0) & (top[..., 0] < len(x) - 1)  # at an end nothing lies beyond
    value = _taken(value, top)[..., 0] + np.where(smooth, above, 0.0)
    return {name: value, f"{name}_error": error + np.where(inside, missed, 0.0)}


def _share(name, tension, somewhere, x):
    """Share of the length without a pull; between two stations the end of it lies where the pull is drawn on to zero, and at
    most at the other one.
    """
    slack = (tension <= 0.0) & somewhere[..., None]
    widths = np.diff(x) / (x[-1] - x[0])
    before, after = tension[..., :-1], tension[..., 1:]
    opens, closes = slack[..., :-1] & ~slack[..., 1:], ~slack[..., :-1] & slack[..., 1:]
    beyond = np.concatenate([tension[..., 2:], 2.0 * after[..., -1:] - before[..., -1:]], axis=-1)
    behind = np.concatenate([2.0 * before[..., :1] - after[..., :1], tension[..., :-2]], axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        pushes = np.where(opens, before < 0.0, after < 0.0)  # bonded fibers: the line between the two crosses zero
        open_at = np.where(pushes, -before / (after - before), 1.0 - after / (beyond - after))
        close_at = np.where(pushes, after / (after - before), 1.0 - before / (behind - before))
    part = np.where(slack[..., :-1] & slack[..., 1:], 1.0, 0.0)
    part = np.where(opens, np.clip(np.nan_to_num(open_at), 0.0, 1.0), part)
    part = np.where(closes, np.clip(np.nan_to_num(close_at), 0.0, 1.0), part)
    doubt = np.where(opens | closes, np.maximum(part, 1.0 - part), 0.0)
    unknown = np.isnan(tension).any(axis=-1)
    share = np.where(np.all(part == 1.0, axis=-1), 1.0, np.clip(np.sum(part * widths, axis=-1), 0.0, 1.0))  # sums round
    return {
        name: np.where(unknown, np.nan, share),
        f"{name}_error": np.where(unknown, np.nan, doubt @ widths + ROUNDING * share),
    }

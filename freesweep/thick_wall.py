"""What the thin wall leaves out: its effect on small deformations of the uniform tube.

The model charges all of the wall with the strain at the fibers. Of a thick wall, which keeps its volume, the layer of the
undeformed radius rho (in units of the fibers' radius) has at small strains, with the axial strain e, the growth A of the
cavity, half of its volume's strain, and the twist rate psi::

    w(rho^2) ~ 4 A^2/rho^4 + 3 e^2 + psi^2 rho^2     (the last term: shear of the twist, energy "full")

Each family of fibers holds ``e + t^2 (A - e/2) + t psi = 0``, t = tan(angle). Two leave one way to deform: with L =
tan(alpha) tan(beta) and H = (tan(alpha) + tan(beta))/2 it is A = 1 + L/2, e = L, psi = 2 H per hoop strain at the fibers,
and a pressure deforms the tube in inverse proportion to the sum of w over the wall. Fewer leave more: the pressure makes
``2 p A - W`` largest. Near the locked shape, which no wall changes, less is wrong.
"""

import numpy as np

from .atlas.schema import SHAPE
from .description.families import families_of
from .description.local import Bodies, profile_of, rules_of
from .description.tube_model import fiber_surface, model_of

NOTES = ("thin_wall_ratio", "thin_wall_note")
DESIGN = ("alpha", "beta", "radius", "wall", "fiber_radius")
SHARE = np.linspace(0.0, 1.0, 33)  # places along a tube
FEW = dict(
    zip((*DESIGN, *SHAPE), (33, 33, 5, 9, 5, 3, 3))
)  # of an axis' values, the ends among them: enough to tell a size
THIN = 0.1  # of wall over radius: up to here the effect is that of other things a designer does not know


def softer(alpha, beta, radius, wall, fiber_radius, energy):
    """How much more a thick wall deforms at small pressure than a thin one, as a ratio [-]; angles [degree], lengths [m].
    NaN for a family that there is not, beta first.
    """
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    hoop, axial, shear = 4.0 * (1.0 + 0.5 * ta * tb) ** 2, 3.0 * (ta * tb) ** 2, (ta + tb) ** 2 * (energy == "full")
    inner, outer = (radius / fiber_radius) ** 2, ((radius + wall) / fiber_radius) ** 2
    if np.all(np.isnan(beta)):
        area = outer - inner
        thin = growth(ta, area, area, area)
        return growth(ta, 1.0 / inner - 1.0 / outer, area, 0.5 * (outer**2 - inner**2)) / thin
    thick = hoop * (1.0 / inner - 1.0 / outer) + axial * (outer - inner) + 0.5 * shear * (outer**2 - inner**2)
    return (outer - inner) * (hoop + axial + shear) / thick


def growth(tangent, hoop, axial, shear):
    """A per pressure of one family of fibers, or none (NaN): where ``2 p A - 4 A^2 hoop - 3 e^2 axial - psi^2 shear`` is
    largest with ``e (1 - t^2/2) + A t^2 + psi t = 0``.
    """
    free = 1.0 / (4.0 * hoop)
    coupled = tangent**2 / (4.0 * hoop)
    held = tangent**4 / (4.0 * hoop) + (1.0 - 0.5 * tangent**2) ** 2 / (3.0 * axial) + tangent**2 / shear
    return free - np.where(np.isnan(tangent), 0.0, coupled**2 / held)


def thin_wall_attributes(tube) -> dict:
    """Attributes of an answer whose tube has a wall thicker than a tenth of its radius somewhere; none for others."""
    if tube.is_thick:
        return {}
    alpha, beta = tube.angles(SHARE)
    if not tube.has_two_families:  # the single one first
        alpha, beta = np.where(np.isnan(alpha), beta, alpha), np.full(len(SHARE), np.nan)
    radius = tube.profile("radius").at(SHARE) if tube.is_body else tube.radius
    return attributes_of(alpha, beta, radius, tube.profile("wall").at(SHARE), tube.fiber_surface_at(SHARE), tube.energy)


def attributes_of(alpha, beta, radius, wall, fiber_radius, energy) -> dict:
    """Attributes of what holds such tubes, arrays that broadcast, if some have a thick wall: [degree, m]."""
    with np.errstate(all="ignore"):  # absurd sizes, which others refuse
        thickness = np.divide(wall, radius)
    largest = np.max(thickness, initial=0.0, where=np.isfinite(thickness))
    if not largest > THIN:
        return {}
    with np.errstate(all="ignore"):
        ratios = softer(alpha, beta, radius, wall, fiber_radius, energy)
    ratios = ratios[np.isfinite(ratios) & (thickness > THIN)]
    if not ratios.size:
        return {}
    low, high = ratios.min(), ratios.max()
    times = " to ".join(dict.fromkeys((f"{low:.3g}", f"{high:.3g}")))
    up_to = "up to " if np.ptp(thickness) > 0.0 else ""
    note = (
        f"wall/radius {up_to}{largest:.2g}: this model takes a thin wall; a thick one deforms {times} times as much at small"
        " pressure, and much the same near the locked shape"
    )
    return dict(zip(NOTES, (float(max(low, high, key=lambda ratio: abs(np.log(ratio)))), note)))


def grid_attributes(data) -> dict:
    """Attributes of an atlas' Dataset, of which coordinates and attributes count, if some of its tubes have a thick wall."""
    import xarray as xr

    if model_of(data.attrs).is_thick:
        return {}
    arrays = {name: data[name] for name in (*DESIGN, *SHAPE) if name in data.coords}
    families = families_of(data.attrs)
    if len(families) < 2:  # the single one first
        own = arrays.pop(families[0], None) if families else None
        arrays |= {"alpha": xr.DataArray(np.nan) if own is None else own, "beta": xr.DataArray(np.nan)}
    profiles = {name: found for name in DESIGN if (found := profile_of(data.attrs, name)) is not None}
    arrays |= {name: xr.DataArray(profile.at(SHARE), dims="x") for name, profile in profiles.items()}
    few = {
        name: array.isel({name: _some(len(array), FEW[name])}) for name, array in arrays.items() if name in array.dims
    }
    arrays |= {name: array.reset_coords(drop=True) for name, array in (arrays | few).items()}
    model = model_of(data.attrs)
    thinnest = arrays | {"wall": arrays["wall"].min("x") if "wall" in profiles else arrays["wall"]}
    if "radius" in profiles or set(SHAPE) & set(arrays):
        bodies, near = Bodies(model, rules_of(data.attrs)), None
        if "radius" in profiles:
            near = profiles["radius"].at(0.0)[0]
        arrays = bodies.at(thinnest, xr.DataArray(SHARE, dims="x"), near) | {name: arrays[name] for name in profiles}
    else:
        arrays["fiber_radius"] = fiber_surface(thinnest, model)
    alpha, beta, radius, wall, fibers = (array.values for array in xr.broadcast(*(arrays[name] for name in DESIGN)))
    inside = (fibers >= radius) & (fibers <= (radius + wall) * (1.0 + 1e-12))  # others are no tubes
    return attributes_of(
        alpha[inside], beta[inside], radius[inside], wall[inside], fibers[inside], data.attrs["energy"]
    )


def _some(count, most):
    """Places among ``count``, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))

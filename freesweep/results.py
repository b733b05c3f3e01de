"""From what the kernels return for one actuator to a Dataset in SI units and degrees."""

import warnings

import numpy as np

from . import status
from .atlas.schema import PROFILES, attributes
from .description.families import beyond_a_point, told, told_slack
from .description.revolution import wall_volume_inside as wall_volume_of_body
from .description.stations import shares_of
from .description.strain import warn_beyond_range
from .scaling import ALONG, OF_MEMBRANES, OUTPUTS, SLACK, output_scales, wall_volume_inside
from .worst_places import strained_layers, with_own, worst_places


def dataset(tube, axes, stations, found, without=()):
    """The Dataset of one actuator.

    ``axes`` maps each dimension to its numbers, a single number to a scalar coordinate; ``found`` maps ``status``,
    ``stable``, ``slack_fiber``, ``values``, ``bounds`` and ``fields`` to arrays over the axes, the last also over the
    stations of :func:`with_own`; ``extra``, if there, to further variables: name -> (dimensions, array). ``without`` names
    outputs that are coordinates here.
    """
    import xarray as xr

    names = tuple(axes)
    data = {name: (names, found[name].astype(np.int8)) for name in ("status", "stable")}
    scale, inside = output_scales(tube.design()), wall_volume_inside(tube.design())
    if tube.is_body:
        scale["mid_radius"], inside = tube.fiber_surface_at(0.5).item(), wall_volume_of_body(tube)
    for k, name in enumerate(OUTPUTS):
        if name in without:
            continue
        value = found["values"][..., k] * scale[name]
        data[name] = (names, value - inside if name == "volume" else value)
        data[f"{name}_error"] = (names, found["bounds"][..., k] * scale[name])
    data |= found.get("extra", {})
    every = with_own(tube, stations)
    along = profiles(tube, found["fields"], found["values"], found["bounds"], every)
    layers, worst = strained_layers(tube, along, every), worst_places(tube, along, every, found["slack_fiber"])
    if found["values"].shape[-1] > len(OUTPUTS):  # the kernels looked at every cell
        for name in ALONG if tube.is_thick else OF_MEMBRANES:
            k = len(OUTPUTS) + ALONG.index(name)
            worst[name], worst[f"{name}_error"] = (found[of][..., k] * scale[name] for of in ("values", "bounds"))
        for name in SLACK:
            worst[name] = np.clip(worst[name], 0.0, 1.0)  # sums of lengths are rounded
    slack = beyond_a_point(found["slack_fiber"], *(worst[name] for name in SLACK))
    worst, along = told(tube, worst), told(tube, along)
    data["slack_fiber"] = (names, told_slack(tube, slack).astype(np.int8))
    data |= {name: (names, array) for name, array in worst.items()}
    data |= {name: ((*names, "x"), array[..., np.searchsorted(every, stations)]) for name, array in along.items()}
    coordinates = {name: ((name,), np.atleast_1d(value)) for name, value in axes.items()} | {"x": (("x",), stations)}
    single = {name for name, value in axes.items() if np.ndim(value) == 0}
    result = xr.Dataset(
        {name: _kept(name, *given, single) for name, given in data.items()},
        {name: _kept(name, *given, single) for name, given in coordinates.items()},
    )
    if np.any(result["status"] == status.NOT_CONVERGED):
        warnings.warn(status.STATUSES[status.NOT_CONVERGED].sentence, stacklevel=4)
    if not np.any(np.isinf(axes["pressure"])):  # the locked shape is that of any material
        warn_beyond_range(tube.material, layers, stacklevel=5)
    return result


def _kept(name, dims, array, single):
    """A variable without the ``single`` dimensions, of one number each, and its attributes. Of a Dataset, once it is made,
    xarray would take as long for both as all else takes.
    """
    index = tuple(0 if dim in single else slice(None) for dim in dims)
    return tuple(dim for dim in dims if dim not in single), array[index], attributes(name)


def near_stations(tube, stations, whole):
    """``(unique, index)``: stations as the kernels take them, in radii, and where each station's result is found.

    Of a tube that is the same all along, half was solved (unless the ``whole``): a station belongs to its nearer end.
    """
    near = np.clip(np.minimum(stations, tube.length - stations), 0.0, None)
    near = shares_of(tube, stations) * tube.length if whole else near
    return np.unique(near / tube.fiber_surface, return_inverse=True)


def profiles(tube, fields, values, bounds, stations):
    """Profiles along x and their bounds from the kernels' fields; where only half was solved (``fields`` says so), the far
    half mirrors.
    """
    share = shares_of(tube, stations)
    alpha, beta = tube.lines(share)
    r = tube.fiber_surface
    fields, whole = fields
    mirrored = (share > 0.5) & (not whole)
    tension = 2.0 * np.pi * r**2 * tube.material.c10
    units = (
        tube.fiber_surface_at(share), r, np.degrees(1.0), np.degrees(1.0), np.degrees(1.0),
        tension / np.cos(np.radians(alpha)), tension / np.cos(np.radians(beta)),
    )  # fmt: skip
    whole_tube = {1: 0, 2: 2}  # what grows along the tube, and which output it grows to
    found = {}
    for k, (name, unit) in enumerate(zip(PROFILES, units)):
        value, bound = fields[..., k, :], fields[..., len(PROFILES) + k, :]
        if k in whole_tube:
            end = whole_tube[k]
            value = np.where(mirrored, 2.0 * values[..., end, None] - value, value)
            bound = np.where(mirrored, 2.0 * bounds[..., end, None] + bound, bound)
        found[name], found[f"{name}_error"] = unit * value, unit * bound
    return found

"""The rubber of a sweep by name, and which of its states leave the range of its constants."""

import warnings

import numpy as np

from ..faults import ActuatorError
from ..material_library import material
from ..strain import largest_stretch

CONSTANTS = ("c10", "c01")


def read_material(faults, actuator, given) -> dict:
    """Constants [Pa] of ``material = "..."`` in [actuator], by parameter; nothing if it is not there, or faulty."""
    if "material" not in actuator:
        return {}
    for name in CONSTANTS:
        if name in given:
            faults.add(given[name], "actuator.material names the rubber; remove one of the two")
    try:
        rubber = material(actuator["material"])
    except ActuatorError as error:
        faults.add("actuator.material", error.faults[0].removeprefix("material: "))
        given["c10"] = "actuator.material"
        return {}
    constants = {name: getattr(rubber, name) for name in CONSTANTS}
    given |= dict.fromkeys(constants, "actuator.material")
    return constants


def rubber_attributes(sweep) -> dict:
    """Attributes of an atlas that say where its constants come from and how far they hold."""
    if not sweep.material:
        return {}
    rubber = material(sweep.material)
    return {"material": sweep.material, "material_source": rubber.source, "largest_stretch": rubber.largest_stretch}


def warn_beyond_range(dataset):
    """Warn if states of an atlas stretch their wall beyond what its rubber is known for."""
    limit = dataset.attrs.get("largest_stretch")
    if limit is not None and (count := beyond_range(dataset, limit)):
        warnings.warn(
            f"{count:,} states stretch the wall by more than {limit:g}, to which the constants of"
            f" {dataset.attrs['material']} are known to hold",
            stacklevel=3,
        )


def beyond_range(dataset, limit) -> int:
    """Number of states of an atlas whose wall is stretched beyond ``limit`` at half length; read slice by slice."""
    radius = dataset["mid_radius"]
    along = radius.dims[0] if radius.dims else None
    parts = (dataset.isel({along: [k]}) for k in range(radius.sizes[along])) if along else (dataset,)
    return sum(_beyond(part, limit) for part in parts)


def _beyond(part, limit):
    fibers = part["fiber_radius" if "fiber_radius" in part else "radius"]
    stretch, alpha, beta, extension = (
        array.values
        for array in _broadcast(part["mid_radius"] / fibers, part["alpha"], part["beta"], part["fiber_extension"])
    )
    with np.errstate(invalid="ignore"):
        return int(np.sum(largest_stretch(alpha, beta, stretch, extension, part.attrs["energy"]) > limit))


def _broadcast(*arrays):
    import xarray as xr

    return xr.broadcast(*arrays)

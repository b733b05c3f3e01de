"""The rubber of a sweep: its constants, by name or one by one, and which of its states leave their range."""

import warnings

import numpy as np

from ..atlas.schema import SHAPE, YEOH
from ..description.elastomer import convex_to
from ..description.families import families_of
from ..description.faults import ActuatorError
from ..description.local import Bodies, profile_of, rules_of
from ..description.material_library import material
from ..description.strain import invariant, largest_principal, membrane
from ..description.tube_model import fiber_surface, model_of

CONSTANTS = ("c10", "c01", "c20", "c30")
SYNONYMS = {f"c{k}": f"Yeoh's C{k} is c{k}0 here, as in other reduced polynomials" for k in (1, 2, 3)}


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
    constants = {name: value for name, value in constants.items() if value != 0.0 or name in ("c10", "c01")}
    given |= dict.fromkeys(constants, "actuator.material")
    return constants


def check_rubber(faults, values, axes, given):
    """Refuses rubbers with both a c01 and constants of Yeoh's; ``values`` are numbers, or columns of designs or axes."""

    def there(name):
        found = np.asarray(values.get(name, 0.0)) != 0.0
        return np.any(found) if name in axes else found

    if all(name in given for name in ("c01", "c20")) or all(name in given for name in ("c01", "c30")):
        if np.any(there("c01") & (there("c20") | there("c30"))):
            faults.add(given["c01"], "a Yeoh rubber, with c20 or c30, has no c01; remove one of the two")


def rubber_attributes(sweep) -> dict:
    """Attributes of an atlas that say where its constants come from and how far they hold."""
    if not sweep.material:
        return {}
    rubber = material(sweep.material)
    return {"material": sweep.material, "material_source": rubber.source, "largest_stretch": rubber.largest_stretch}


def warn_beyond_range(dataset, stacklevel=3):
    """Warn if states of an atlas strain their wall beyond what its rubber is known for, or is convex to."""
    limit = dataset.attrs.get("largest_stretch")
    if limit is not None and (count := beyond_range(dataset, limit)):
        warnings.warn(
            f"{count:,} states stretch the wall by more than {limit:g}, to which the constants of"
            f" {dataset.attrs['material']} are known to hold",
            stacklevel=stacklevel,
        )
    if count := beyond_convexity(dataset):
        warnings.warn(
            f"{count:,} states strain the wall beyond where its Yeoh energy is convex (c20 or c30 is negative): no rubber"
            " behaves so there",
            stacklevel=stacklevel,
        )


def beyond_range(dataset, limit) -> int:
    """Number of states of an atlas whose wall is stretched beyond ``limit`` at half length; read slice by slice."""
    return sum(int(np.sum(_strained(part, largest_principal) > limit)) for part in _slices(dataset))


def beyond_convexity(dataset) -> int:
    """Number of states of an atlas whose wall is strained beyond where its Yeoh energy is convex."""
    if not any(name in dataset.coords and np.any(dataset[name].values < 0.0) for name in YEOH):
        return 0
    count = 0
    for part in _slices(dataset):
        c10, c20, c30 = (part[name] if name in part.coords else 0.0 for name in ("c10", *YEOH))
        strain, *constants = _broadcast(
            _strained(part, invariant), *(c + 0.0 * part["mid_radius"] for c in (c10, c20, c30))
        )
        count += int(np.sum(strain.values > convex_to(*(c.values for c in constants))))
    return count


def _slices(dataset):
    """The atlas, a place of its first dimension at a time."""
    radius = dataset["mid_radius"]
    along = radius.dims[0] if radius.dims else None
    return (dataset.isel({along: [k]}) for k in range(radius.sizes[along])) if along else (dataset,)


def _strained(part, measure):
    """A ``measure`` of the strain at half length, NaN where there is no state."""
    own = {name: _middle(part, name) for name in ("alpha", "beta", "radius", "wall", "fiber_extension")}
    own |= {name: part[name] for name in ("fiber_radius", *SHAPE) if name in part.coords}
    model = model_of(part.attrs)
    profile = profile_of(part.attrs, "radius")
    if profile is not None or set(SHAPE) & set(own):
        near = None if profile is None else profile.at(0.0)[0]
        own = Bodies(model, rules_of(part.attrs)).at(own, 0.5, near)
    own["fiber_radius"] = fiber_surface(own, model)
    if model.is_physical or len(families_of(part.attrs)) < 2:
        return _of_physical(part, own, model, measure)
    arrays = _broadcast(part["mid_radius"] / own["fiber_radius"], own["alpha"], own["beta"], own["fiber_extension"])
    stretch, *rest = (array.values for array in arrays)
    with np.errstate(invalid="ignore"):
        return arrays[0].copy(data=measure(*membrane(*rest[:2], stretch, rest[2], part.attrs["energy"])))


def _of_physical(part, own, model, measure):
    """The same of physical tubes: the largest of the layers that the model strains."""
    from ..query.predictor import Predictor
    from ..query.reference import COLUMNS

    columns = {name: own.get(name, part.coords.get(name, 0.0)) for name in COLUMNS}
    radius, *others = _broadcast(part["mid_radius"], *(0.0 * part["mid_radius"] + one for one in columns.values()))
    points = np.stack([other.values.ravel() for other in others], axis=-1)
    at = dict(zip(COLUMNS, points.T))
    meridional, stretch, twist = (
        Predictor(model, part.attrs["energy"], families=families_of(part.attrs))
        .middles(points, radius.values.ravel())
        .T
    )
    inner, fibers = at["radius"], at["fiber_radius"]
    layers = []
    with np.errstate(invalid="ignore", divide="ignore"):
        for rho in (inner, inner + at["wall"]) if model.is_thick else (fibers,):
            r = np.sqrt(stretch**2 + ((rho / fibers) ** 2 - 1.0) / meridional)
            layers.append(measure(meridional, r * fibers / rho, r * twist))
        return radius.copy(data=np.max(layers, axis=0).reshape(radius.shape))


def _middle(part, name):
    """A parameter of the tubes; of a profile the value at half length, of a wall where it is thinnest, as fibers lie."""
    import xarray as xr

    profile = profile_of(part.attrs, name)
    if profile is None:
        return part[name] if name in part.coords else xr.DataArray(np.nan)  # no such family
    return xr.DataArray(profile.samples().min() if name == "wall" else profile.at(0.5)[0])


def _broadcast(*arrays):
    import xarray as xr

    return xr.broadcast(*arrays)

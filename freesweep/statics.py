"""Statics of one actuator: the locked shape, and inflation under force and torque. Results are xarray Datasets."""

import warnings

import numpy as np

from . import profiles, status
from .actuator import Actuator, ActuatorError, number_fault
from .atlas.schema import PROFILES, attributes
from .scaling import ACCURACIES, OUTPUTS, output_scales, problem_rows, wall_volume_inside

STATIONS = 201
BASE_CELLS = 96  # four times a sweep's: profiles are wanted as exact as scalars
LOADS = ("force", "torque", "pressure")


def lock(tube: Actuator, *, x=None, accuracy=1e-6):
    """The locked shape: largest volume that the fibers allow, whatever the wall (Eq. 2.12).

    Parameters
    ----------
    tube : the actuator
    x : stations of the profiles [m], distances from the fixed end before deformation, ascending; default 201
    accuracy : scaled error bound to reach, for every scalar output

    Returns a Dataset of scalars, their ``_error`` bounds and profiles along ``x``; fiber tensions per pressure [N/Pa].
    Raises :class:`ActuatorError` for invalid input.
    """
    stations = _stations(tube, x, accuracy, [])
    dataset = _solve(tube, {"force": 0.0, "torque": 0.0, "pressure": np.inf}, stations, accuracy)
    dataset = dataset.drop_vars(["limit_pressure", "limit_pressure_error", "limit_found", *LOADS])
    for name in ("fiber_tension_alpha", "fiber_tension_beta"):
        # the kernel's locked state is that of the pressure c10
        dataset[name] = dataset[name] / tube.material.c10
        dataset[name].attrs = attributes(name)
        dataset[name].attrs.update(units="N/Pa", long_name=f"{PROFILES[name][1]} per pressure")
    return dataset


def inflate(tube: Actuator, pressure, force=0.0, torque=0.0, *, x=None, accuracy=1e-6):
    """Equilibrium under pressure, axial force and torque (Eqs. 2.11, 2.15, 2.18).

    Parameters
    ----------
    tube : the actuator
    pressure, force, torque : number or 1-D array [Pa, N, N m]; an array makes a dimension of that name. Force is positive
        in tension, torque toward growing rotation
    x, accuracy : as in :func:`lock`

    Returns a Dataset. What physics forbids is NaN with a ``status``: beyond ``limit_pressure`` the branch that starts at
    the undeformed cylinder has ended. Raises :class:`ActuatorError` for invalid input.
    """
    faults = []
    loads = {}
    for name, value, unit in (("force", force, "N"), ("torque", torque, "N m"), ("pressure", pressure, "Pa")):
        loads[name] = _load(name, value, unit, faults)
    if "pressure" in loads and loads["pressure"] is not None and np.any(np.asarray(loads["pressure"]) < 0.0):
        faults.append("pressure: found a negative value; the model needs 0 or more (vacuum is another problem)")
    stations = _stations(tube, x, accuracy, faults)
    return _solve(tube, loads, stations, accuracy)


def _load(name, value, unit, faults):
    """The load as a float or a 1-D float array; what is wrong with it goes to ``faults``."""
    if np.ndim(value) == 0 and not isinstance(value, np.ndarray):
        fault = number_fault(name, value, unit)
        faults += [fault] if fault else []
        return None if fault else float(value)
    try:
        array = np.asarray(value)
    except ValueError:  # ragged
        array = np.array(None)
    if array.dtype.kind not in "iuf":
        faults.append(f"{name}: found {value!r:.60}; give a number or a 1-D array of numbers in [{unit}]")
        return None
    array = array.astype(float)
    if array.ndim == 0:
        return _load(name, array.item(), unit, faults)
    if array.ndim != 1 or array.size == 0 or not np.all(np.isfinite(array)):
        faults.append(
            f"{name}: found an array of shape {array.shape}; give finite numbers in one dimension, in [{unit}]"
        )
        return None
    if len(np.unique(array)) != array.size:
        faults.append(f"{name}: a value is given twice; give each once")
        return None
    return array


def _stations(tube, x, accuracy, faults):
    """Stations as an array [m]; raises if there are faults."""
    if not isinstance(tube, Actuator):
        raise ActuatorError([f"tube: found {type(tube).__name__}; give an Actuator"])
    fault = number_fault("accuracy", accuracy, "1", positive=True)
    if not fault and not ACCURACIES[0] <= accuracy <= ACCURACIES[1]:
        fault = f"accuracy: found {accuracy:g}; give a value from {ACCURACIES[0]:g} to {ACCURACIES[1]:g}"
    faults += [fault] if fault else []
    if x is None:
        stations = np.linspace(0.0, tube.length, STATIONS)
    else:
        try:
            stations = np.atleast_1d(np.asarray(x, dtype=float))
        except (TypeError, ValueError):
            stations = np.array([np.nan])
        inside = np.all((stations >= 0.0) & (stations <= tube.length * (1.0 + 1e-12)))
        if stations.ndim != 1 or stations.size == 0 or not inside or np.any(np.diff(stations) <= 0.0):
            faults.append(f"x: give ascending stations from 0 to the undeformed length {tube.length:g} m, in [m]")
    if faults:
        raise ActuatorError(faults)
    return stations


def _solve(tube, loads, stations, accuracy):
    """Solve for the product of the loads, and put the results into a Dataset."""
    import xarray as xr

    from .solver.branch import walk_many
    from .solver.profile import FIELDS

    shape = tuple(np.size(loads[name]) for name in LOADS)
    force, torque = (grid.ravel() for grid in np.meshgrid(loads["force"], loads["torque"], indexing="ij"))
    pressure = np.atleast_1d(np.asarray(loads["pressure"], float))
    order = np.argsort(pressure)
    count, steps = len(force), len(pressure)
    design = {name: np.full(count, value) for name, value in tube.design().items()}
    rows = problem_rows(design | {"force": force, "torque": torque}, tube.energy)
    if tube.varies:
        try:
            course, edges, places = profiles.course(tube)
        except profiles.ProfileError as error:
            raise ActuatorError([f"alpha, beta, wall: {error}"]) from None
        near = stations / tube.fiber_surface
    else:
        course, edges, places = np.zeros((0, 1, 3, 4)), np.array([0, BASE_CELLS]), np.zeros(2)
        near = np.clip(np.minimum(stations, tube.length - stations), 0.0, None) / tube.fiber_surface
    unique = np.unique(near)
    values, bounds = np.empty((count * steps, 5)), np.empty((count * steps, 5))
    codes, slack = np.empty(count * steps, np.int64), np.empty(count * steps, np.int64)
    limits, fields = np.empty((count, 2)), np.empty((count * steps, FIELDS, len(unique)))
    first = np.arange(count + 1, dtype=np.int64) * steps
    walk_many(
        rows, first, np.tile(pressure[order] / tube.material.c10, count), course, edges, places, float(accuracy), values,
        bounds, codes, slack, limits, unique, fields,
    )  # fmt: skip

    back = np.argsort(order)

    def grid(array):
        """From the kernels' order to that of the loads as given."""
        return array.reshape(count, steps, *array.shape[1:])[:, back].reshape(*shape, *array.shape[1:])

    codes, values, bounds, slack = grid(codes), grid(values), grid(bounds), grid(slack)
    fields = grid(fields)[..., np.searchsorted(unique, near)]
    data = dict(zip(("status", "slack_fiber", "stable"), (codes, slack, np.isin(codes, status.VALUED))))
    data = {name: (LOADS, array.astype(np.int8)) for name, array in data.items()}
    scale = output_scales(tube.design())
    for k, name in enumerate(OUTPUTS):
        value = values[..., k] * scale[name]
        data[name] = (LOADS, value - wall_volume_inside(tube.design()) if name == "volume" else value)
        data[f"{name}_error"] = (LOADS, bounds[..., k] * scale[name])
    limits = limits.reshape(*shape[:2], 2) * tube.material.c10
    data["limit_pressure"], data["limit_pressure_error"] = (LOADS[:2], limits[..., 0]), (LOADS[:2], limits[..., 1])
    data["limit_found"] = (LOADS[:2], np.isfinite(limits[..., 0]).astype(np.int8))
    whole = {"axial_position": values[..., 0], "twist": values[..., 2]}
    mirrored = (stations > 0.5 * tube.length) & (not tube.varies)
    at_rest = _at_rest(tube, loads, stations)
    for name, array in _profiles(tube, fields, mirrored, whole, stations / tube.length).items():
        array = np.where(at_rest[..., None], _rest(tube, stations)[name], array)
        data[name] = ((*LOADS, "x"), array)
    coordinates = {name: (name, np.atleast_1d(loads[name])) for name in LOADS} | {"x": ("x", stations)}
    dataset = xr.Dataset(data, coordinates)
    dataset = dataset.isel({name: 0 for name in LOADS if np.ndim(loads[name]) == 0})
    for name in dataset.variables:
        dataset[name].attrs = attributes(name)
    dataset.attrs = {"title": repr(tube), "energy": tube.energy, "accuracy": float(accuracy)}
    _warn(dataset)
    return dataset


def _at_rest(tube, loads, stations):
    """Where nothing is applied: the undeformed cylinder, by definition."""
    force, torque, pressure = np.meshgrid(*(loads[name] for name in LOADS), indexing="ij")
    return (force == 0.0) & (torque == 0.0) & (pressure == 0.0)


def _rest(tube, stations):
    """Profiles of the undeformed tube."""
    alpha, beta = tube.angles(stations / tube.length)
    zero = np.zeros_like(stations)
    return {
        "deformed_radius": zero + tube.fiber_surface,
        "axial_position": stations,
        "twist": zero,
        "alpha_deformed": alpha,
        "beta_deformed": beta,
        "fiber_tension_alpha": zero,
        "fiber_tension_beta": zero,
    }


def _profiles(tube, fields, mirrored, whole, share):
    """Profiles in SI units and degrees; the far half of a tube that is the same all along mirrors the near one."""
    alpha, beta = tube.angles(share)
    r = tube.fiber_surface
    z = np.where(mirrored, 2.0 * whole["axial_position"][..., None] - fields[..., 1, :], fields[..., 1, :])
    twist = np.where(mirrored, 2.0 * whole["twist"][..., None] - fields[..., 2, :], fields[..., 2, :])
    tension = 2.0 * np.pi * r**2 * tube.material.c10
    return {
        "deformed_radius": r * fields[..., 0, :],
        "axial_position": r * z,
        "twist": np.degrees(twist),
        "alpha_deformed": np.degrees(np.arctan(fields[..., 3, :])),
        "beta_deformed": np.degrees(np.arctan(fields[..., 4, :])),
        "fiber_tension_alpha": tension / np.cos(np.radians(alpha)) * fields[..., 5, :],
        "fiber_tension_beta": tension / np.cos(np.radians(beta)) * fields[..., 6, :],
    }


def _warn(dataset):
    if np.any(dataset["status"] == status.NOT_CONVERGED):
        warnings.warn(status.STATUSES[status.NOT_CONVERGED].sentence, stacklevel=4)

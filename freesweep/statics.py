"""Statics of one actuator: the locked shape, and inflation under force and torque. Results are xarray Datasets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import status
from .derivative.request import asked_of
from .description.actuator import Actuator
from .description.faults import ActuatorError
from .description.loads import each_once, read_load, read_stations, warn_of_loads
from .description.profiles import ProfileError
from .description.quantities import Names, Quantities
from .description.splines import SENSITIVITY, follow, widened
from .description.stations import shares_of
from .results import dataset, near_stations
from .scaling import problem_rows
from .thick_wall import thin_wall_attributes
from .worst_places import FAMILIES, with_own

if TYPE_CHECKING:
    import xarray as xr

BASE_CELLS = 96  # four times a sweep's: profiles are wanted as exact as scalars
LOADS = ("force", "torque", "pressure")
UNLOCKED = (
    "tube: fibers of fewer than two angles leave the shape free, which grows with the pressure without end (line DF of"
    " Figure 1-2): there is no locked shape; use inflate"
)


def lock(
    tube: Actuator, *, x: Quantities | None = None, accuracy: float = 1e-6, derivatives: Names = None
) -> xr.Dataset:
    """The locked shape: largest volume that the fibers allow, whatever the wall (Eq. 2.12).

    Parameters
    ----------
    tube : the actuator
    x : stations of the profiles [m], distances from the fixed end before deformation, ascending; default 201
    accuracy : scaled error bound to reach, for every scalar output, and every profile at every station
    derivatives : "all", or names of the actuator's parameters (``alpha``, ``beta``, ``length``, ``radius``, ``wall``,
        ``fiber_extension``, the rubber's constants, ``fiber_radius`` if it is a number): adds the exact derivative of each
        scalar output with respect to each, ``d_<output>_d_<parameter>`` in their units (per degree for angles), with its
        ``_error``. A profile's is that of the same change all along

    Returns a Dataset of scalars and profiles along ``x`` with their ``_error`` bounds; fiber tensions per pressure [N/Pa].
    Raises :class:`ActuatorError` for invalid input.
    """
    faults = []
    names = asked_of(tube, derivatives, faults)
    if isinstance(tube, Actuator) and not tube.has_two_families:
        faults.append(UNLOCKED)
    stations, accuracy = read_stations(tube, x, accuracy, faults)
    loads = {"force": 0.0, "torque": 0.0, "pressure": np.inf}
    result = _solve(tube, loads, stations, accuracy)
    for name in (f"{what}_{family}" for what in ("fiber_tension", "least_tension") for family in FAMILIES):
        # the kernel's locked state is that of the pressure c10
        for one in (name, f"{name}_error"):
            scaled = result.variables[one]  # to put in another would take longer than to solve the tube
            scaled.values = scaled.values / tube.material.c10
            scaled.attrs |= {"units": "N/Pa", "long_name": f"{scaled.attrs['long_name']} per pressure"}
    result = _differentiated(result, tube, names, loads, accuracy)
    return result.drop_vars(["limit_pressure", "limit_pressure_error", "limit_found", *LOADS])


def inflate(
    tube: Actuator,
    pressure: Quantities,
    force: Quantities = 0.0,
    torque: Quantities = 0.0,
    *,
    x: Quantities | None = None,
    accuracy: float = 1e-6,
    derivatives: Names = None,
) -> xr.Dataset:
    """Equilibrium under pressure, axial force and torque (Eqs. 2.11, 2.15, 2.18).

    Parameters
    ----------
    tube : the actuator
    pressure, force, torque : number or 1-D array [Pa, N, N m]; an array makes a dimension of that name, in its order (what
        stands there twice is solved once). Force is positive in tension, torque toward growing rotation
    x, accuracy, derivatives : as in :func:`lock`; of the loads, too: ``pressure``, ``force``, ``torque``

    Returns a Dataset. What physics forbids is NaN with a ``status``: beyond ``limit_pressure`` the branch that starts at
    the undeformed cylinder has ended. Where the wall is thicker than a tenth of the radius, the attributes
    ``thin_wall_ratio`` and ``thin_wall_note`` say what the thin wall of the model leaves out. Raises
    :class:`ActuatorError` for invalid input.
    """
    faults = []
    loads = {
        "force": read_load("force", force, "N", faults),
        "torque": read_load("torque", torque, "N m", faults),
        "pressure": read_load("pressure", pressure, "Pa", faults, least=0.0),
    }
    names = asked_of(tube, derivatives, faults, LOADS)
    stations, accuracy = read_stations(tube, x, accuracy, faults)
    warn_of_loads(tube, **loads)
    loads, at = each_once(loads)
    return _differentiated(_solve(tube, loads, stations, accuracy), tube, names, loads, accuracy).isel(at)


def _differentiated(result, tube, names, loads, accuracy):
    """A result with its derivatives by the parameters ``names``, if there are any."""
    if not names:
        return result
    from .derivative.asked import Asked
    from .derivative.attach import attach

    course, error = read_course(tube, accuracy) if tube.varies else (None, 0.0)
    asked = Asked(tube, names, accuracy, course, error)
    dims = result["status"].dims
    grid = dict(zip(dims, np.meshgrid(*(loads[name] for name in dims), indexing="ij")))
    one = result["status"].shape
    at = {name: grid[name] if name in grid else np.full(one, loads[name]) for name in LOADS}
    return attach(result, asked, at, lambda stations, guess: _solve(tube, loads, stations, guess))


def _solve(tube, loads, stations, accuracy):
    """Solve for the product of the loads, and put the results into a Dataset."""
    from .solver.batch import uniform, walk_all

    shape = tuple(np.size(loads[name]) for name in LOADS)
    force, torque = (grid.ravel() for grid in np.meshgrid(loads["force"], loads["torque"], indexing="ij"))
    pressure = np.atleast_1d(np.asarray(loads["pressure"], float))
    order = np.argsort(pressure)
    count, steps = len(force), len(pressure)
    design = {name: np.full(count, value) for name, value in tube.design().items()}
    rows = problem_rows(design | {"force": force, "torque": torque}, tube.energy, tube.is_thick, tube.threads)
    whole, error = tube.varies, 0.0
    if tube.varies:
        course, error = read_course(tube, accuracy)
    else:
        course = uniform(BASE_CELLS)
    every = with_own(tube, stations)
    unique, index = near_stations(tube, every, whole)
    first = np.arange(count + 1, dtype=np.int64) * steps
    pressures = np.tile(pressure[order] / tube.material.c10, count)
    walks = walk_all(rows, first, pressures, course, accuracy - SENSITIVITY * error, unique, soon=True)

    back = np.argsort(order)

    def grid(array):
        """From the kernels' order to that of the loads as given."""
        return array.reshape(count, steps, *array.shape[1:])[:, back].reshape(*shape, *array.shape[1:])

    fields = grid(walks.profiles)[..., index]
    force, torque, pressure = np.meshgrid(*(loads[name] for name in LOADS), indexing="ij")
    at_rest = (force == 0.0) & (torque == 0.0) & (pressure == 0.0)
    fields[at_rest] = undeformed(tube, every, whole)
    limits = np.stack([walks.limits[:, 0], widened(walks.limits[:, 0], walks.limits[:, 1], error)], axis=-1)
    limits = limits.reshape(*shape[:2], 2) * tube.material.c10
    found = {
        "status": grid(walks.status),
        "stable": np.isin(grid(walks.status), status.VALUED),  # the walk keeps to stable states
        "slack_fiber": grid(walks.slack),
        "values": grid(walks.values),
        "bounds": grid(widened(walks.values, walks.bounds, error)),
        "fields": (fields, whole),
        "extra": {
            "limit_pressure": (LOADS[:2], limits[..., 0]),
            "limit_pressure_error": (LOADS[:2], limits[..., 1]),
            "limit_found": (LOADS[:2], np.isfinite(limits[..., 0]).astype(np.int8)),
        },
    }
    result = dataset(tube, {name: loads[name] for name in LOADS}, stations, found)
    result.attrs = {"title": repr(tube), "energy": tube.energy, "accuracy": accuracy}
    if tube.is_loose:
        result.attrs["fibers"] = "loose"
    if not np.any(np.isinf(loads["pressure"])):  # the locked shape does not see the wall
        result.attrs |= thin_wall_attributes(tube)
    return result


def undeformed(tube, stations, whole):
    """Fields of the undeformed tube: stretch 1, the stations themselves, no twist, no tension, no error."""
    alpha, beta = tube.lines(shares_of(tube, stations))
    # half of a tube was solved: the far half's position is mirrored back later
    far = (stations > 0.5 * tube.length) & (not whole)
    near = np.where(far, tube.length - stations, stations) / tube.fiber_surface
    zero = np.zeros_like(stations)
    values = [zero + 1.0, near, zero, np.radians(alpha), np.radians(beta), zero, zero]
    return np.stack([*values, *(zero for _ in values)])


def read_course(tube, accuracy):
    """The course along a tube that varies, as the kernels take it, and its error; raises :class:`ActuatorError`."""
    try:
        return follow(tube, accuracy)
    except ProfileError as fault:
        raise ActuatorError([f"alpha, beta, wall, radius: {fault}"]) from None

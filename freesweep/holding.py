"""Blocked force and blocked torque: the deformed length or the rotation of the free end is held (Eqs. 2.16 - 2.22).

Where several states are possible, the one given lies on the branch that begins without load: pressure, the load that is
given and fiber extension - 1 rise in proportion while the undeformed length (no rotation) is held, then what is held changes
to the value asked for. Where the wall would have to be pushed on that way, the loads rise with nothing held, then the length
or rotation found is changed to the value asked for: ``held_path`` says so.
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from .derivative.request import asked_of
from .description.actuator import Actuator
from .description.faults import ActuatorError
from .description.given import numbers
from .description.loads import read_load, read_stations, warn_of_loads
from .description.options import read_switch
from .description.profiles import SENSITIVITY, widened
from .description.quantities import Names, Quantities
from .results import dataset, near_stations
from .scaling import problem_rows
from .statics import inflate, is_solved_whole, read_course, undeformed
from .thick_wall import thin_wall_attributes
from .worst_places import with_own

if TYPE_CHECKING:
    import xarray as xr

HALF_CELLS = 48  # of half a tube that is the same all along
MANY = 200  # states among which it is worth to look first for those that nothing holds
CORRECTION_STATIONS = 2001


BOTH_HELD = (
    "length and rotation are held both: force and torque are then not separately determined, only"
    " F = -pi r^2 P (1 + 2/(tan alpha tan beta)) + M (tan alpha + tan beta)/(r tan alpha tan beta); hold one, give the load"
    " that works on the other"
)


def blocked_force(
    tube: Actuator,
    pressure: Quantities,
    deformed_length: Quantities | None = None,
    torque: Quantities = 0.0,
    *,
    rotation: None = None,
    x: Quantities | None = None,
    accuracy: float = 1e-6,
    derivatives: Names = None,
) -> "xr.Dataset":
    """The axial force that holds the deformed length, the free end being free to rotate (Eqs. 2.16, 2.18).

    Parameters
    ----------
    tube : the actuator; any profile and fiber extension
    pressure, torque : number or 1-D array [Pa, N m]
    deformed_length : held length [m], number or 1-D array (a force-stroke curve); default: the undeformed length
    rotation : None; a held rotation beside the held length is refused, with the reason
    x, accuracy, derivatives : as in :func:`freesweep.lock`; of ``pressure``, ``torque`` and ``deformed_length``, too. The
        undeformed length that is held by default changes with ``length``, one that is given does not

    Returns a Dataset with ``force`` [N], positive in tension, on the coordinate ``deformed_length``, and what else deforms.
    Where the wall would have to be pushed (an undeformed tube of region I, low pressure with fiber extension) there is no
    result: status 3. Without pressure a stretched tube has a force, too.
    Raises :class:`ActuatorError`.
    """
    if rotation is not None:
        raise ActuatorError([f"rotation: {BOTH_HELD}"])
    held = tube.length if deformed_length is None and isinstance(tube, Actuator) else deformed_length
    arguments = tube, "deformed_length", held, "torque", torque, "force", pressure, x, accuracy
    return _hold(*arguments, derivatives=derivatives, tied=deformed_length is None)


def blocked_torque(
    tube: Actuator,
    pressure: Quantities,
    rotation: Quantities = 0.0,
    force: Quantities = 0.0,
    *,
    deformed_length: None = None,
    buckled: bool = False,
    x: Quantities | None = None,
    accuracy: float = 1e-6,
    derivatives: Names = None,
) -> "xr.Dataset":
    """The torque that holds the rotation of the free end, the length being free (Eqs. 2.19, 2.20).

    Parameters
    ----------
    tube : the actuator; any profile and fiber extension, but alpha = -beta has no rotation to hold
    pressure, force : number or 1-D array [Pa, N]
    rotation : held rotation [degree], number or 1-D array (a torque-rotation curve)
    deformed_length : None; a held length beside the held rotation is refused, with the reason
    buckled : beyond the critical pressure (:func:`freesweep.closed_form.critical_pressure`) the straight cylinder is
        unstable; True gives the stable, shorter, antisymmetric state beside it: the source's "blocked deformation". Many
        tubes have one below the critical pressure, too, which a disturbance may lead to: a safe limit is
        ``least_buckled_pressure`` [Pa], the least at which the buckled branch has a state. Where there is none: status 4
    x, accuracy, derivatives : as in :func:`freesweep.lock`; of ``pressure``, ``force`` and ``rotation``, too

    Returns a Dataset with ``torque`` [N m], positive toward growing rotation, on the coordinate ``rotation``. ``stable``
    counts every mode of the whole tube while the rotation stays held. Raises :class:`ActuatorError`.
    """
    if deformed_length is not None:
        raise ActuatorError([f"deformed_length: {BOTH_HELD}"])
    faults = []
    buckled = read_switch("buckled", buckled, faults)
    if faults:
        raise ActuatorError(faults)
    if isinstance(tube, Actuator):
        alpha, beta = tube.angles(np.linspace(0.0, 1.0, 257))
        single = np.where(np.isnan(alpha), beta, alpha)  # not a number where there is none
        if np.all(alpha == -beta) or not (tube.has_two_families or np.any(np.abs(single) > 0.0)):
            raise ActuatorError(
                [
                    "rotation: a tube with alpha = -beta does not rotate, nor does one of straight fibers alone or without"
                    " any, so no torque holds it; use blocked_force"
                ]
            )
        if buckled and (tube.threads > 0.0 or tube.is_thick):
            raise ActuatorError(
                ["buckled: solved for membranes with bonded fibers only; others leave the cylinder without"]
            )
        if buckled and tube.varies:
            raise ActuatorError(["buckled: only a tube that is the same all along has a straight state to buckle from"])
    return _hold(tube, "rotation", rotation, "force", force, "torque", pressure, x, accuracy, buckled, derivatives)


def _hold(
    tube, held_name, held, load_name, load, unknown, pressure, x, accuracy, buckled=False, derivatives=None, tied=False
):  # fmt: skip
    from .interpret import at_once
    from .solver.along.profile import FIELDS
    from .solver.batch import uniform
    from .solver.halves import in_two_halves
    from .solver.held.held_state import HELD_LENGTH, HELD_ROTATION
    from .solver.held.held_states import hold_many
    from .solver.hold_batch import refuse
    from .solver.problem import wall_columns
    from .solver.status import OK, PENDING

    faults = []
    units = {"deformed_length": "m", "rotation": "degree", "force": "N", "torque": "N m", "pressure": "Pa"}
    domains = {"pressure": {"least": 0.0}, "deformed_length": {"positive": True}}
    axes = {
        name: read_load(name, value, units[name], faults, **domains.get(name, {}))
        for name, value in ((held_name, held), (load_name, load), ("pressure", pressure))
    }
    names = asked_of(tube, derivatives, faults, ("pressure", load_name), held_name)
    stations, accuracy = read_stations(tube, x, accuracy, faults)
    warn_of_loads(tube, **{name: axes[name] for name in (load_name, "pressure")}, stacklevel=4)
    grid = np.meshgrid(*axes.values(), indexing="ij")
    shape, count = grid[0].shape, grid[0].size
    targets, others, pressures = (array.ravel() for array in grid)
    r, c10 = tube.fiber_surface, tube.material.c10
    design = {name: np.full(1, value) for name, value in tube.design().items()}
    row = problem_rows(
        design | {"force": np.zeros(1), "torque": np.zeros(1)}, tube.energy, tube.is_thick, tube.threads
    )[0]
    whole, error = is_solved_whole(tube) or buckled, 0.0
    if tube.varies:
        solved, error = read_course(tube, accuracy)
    else:
        solved = in_two_halves(row, HALF_CELLS) if whole else uniform(HALF_CELLS)
    every = with_own(tube, stations)
    unique, index = near_stations(tube, every, whole)
    values, bounds = np.full((2, count, 6), np.nan)
    codes = np.full(count, PENDING)
    stable, slack, paths = np.zeros((3, count), np.int64)
    least = np.full((count, 2), np.nan)
    fields = np.full((count, FIELDS, len(unique)), np.nan)
    held_is_length = held_name == "deformed_length"
    states = (
        pressures / c10, others / (np.pi * r ** (3 if held_is_length else 2) * c10),
        targets / r if held_is_length else np.radians(targets), HELD_LENGTH if held_is_length else HELD_ROTATION,
    )  # fmt: skip
    if count >= MANY and not whole:
        refuse(row, *states, codes)
    arguments = (
        row[None], wall_columns(row), np.array([0, count]), *states, bool(buckled), *solved,
        accuracy - SENSITIVITY * error, values, bounds, codes, stable, slack, paths, least, unique, fields,
    )  # fmt: skip
    if not at_once(np.count_nonzero(codes == PENDING), hold_many, hold_many, *arguments):
        hold_many(*arguments)
    bounds = widened(values, bounds, error)
    profiles = fields.reshape(*shape, FIELDS, -1)[..., index]
    if tube.varies:  # whose angles at rest the kernels do not know
        at_rest = (codes == OK) & (pressures == 0.0) & (others == 0.0) & (values[:, 5] == 0.0)
        profiles[at_rest.reshape(shape)] = undeformed(tube, every, whole)
    scale = np.pi * r ** (2 if held_is_length else 3) * c10
    found = {
        "status": codes.reshape(shape),
        "stable": stable.reshape(shape),
        "slack_fiber": slack.reshape(shape),
        "values": values[:, :5].reshape(*shape, 5),
        "bounds": bounds[:, :5].reshape(*shape, 5),
        "fields": (profiles, whole),
        "extra": {
            unknown: (tuple(axes), values[:, 5].reshape(shape) * scale),
            f"{unknown}_error": (tuple(axes), bounds[:, 5].reshape(shape) * scale),
        },
    }
    if buckled:
        found["extra"] |= {
            name: (tuple(axes), least[:, k].reshape(shape) * c10)
            for k, name in enumerate(("least_buckled_pressure", "least_buckled_pressure_error"))
        }
    else:
        found["extra"]["held_path"] = tuple(axes), paths.astype(np.int8).reshape(shape)
    result = dataset(tube, axes, stations, found, without=(held_name,))
    result.attrs = {"title": repr(tube), "energy": tube.energy, "accuracy": accuracy, "buckled": int(buckled)}
    if tube.is_loose:
        result.attrs["fibers"] = "loose"
    result.attrs |= thin_wall_attributes(tube)
    if not buckled and np.any(result["held_path"] == 1):
        result.attrs["comment"] = (
            "held_path: the way from rest with the undeformed length or rotation held ends elsewhere, or the wall would have"
            " to be pushed on it; some states were found from the free one"
        )
    if not names:
        return result
    from .derivative.asked import Asked
    from .derivative.attach import attach

    asked = Asked(
        tube,
        names,
        accuracy,
        solved if tube.varies else None,
        error,
        held_name,
        unknown,
        tied,
        buckled,
    )
    at = [array.reshape(result["status"].shape) for array in (pressures, others, targets)]
    loads = {"pressure": at[0], load_name: at[1], unknown: result[unknown].values}

    def again(x, guess):
        return _hold(tube, held_name, held, load_name, load, unknown, pressure, x, guess, buckled)

    return attach(result, asked, loads, again, at[2])


def corrected_torque(tube: Actuator, pressure: Quantities) -> Any:
    """Blocked torque with the source's superposed contraction [N m] (Eqs. 2.21, 2.22); ``pressure`` number or array [Pa].

    For a straight family and another (alpha = 0): the stretch y_c of the McKibben muscle (Eq. 2.15) at angle beta and the
    same pressure takes the place of 1, ``M = -P int (V_y - dV_y'/dx) dx / int delta_y dx`` at y = y_c. It tends to Eq. 2.20
    as the pressure falls. The exact held state is ``blocked_torque(..., buckled=True)``. Raises :class:`ActuatorError`.
    """
    from scipy.interpolate import CubicSpline

    if not isinstance(tube, Actuator) or tube.varies or tube.alpha != 0.0 or not tube.has_two_families:
        raise ActuatorError(["tube: the source's correction is for alpha = 0 and a constant beta"])
    muscle = Actuator(
        alpha=tube.beta, beta=-tube.beta, length=tube.length, radius=tube.radius, wall=tube.wall,
        material=tube.material, fiber_radius=tube.fiber_surface, energy=tube.energy, model="source",
    )  # fmt: skip
    stations = (
        0.5 * tube.length * (1.0 - np.cos(np.linspace(0.0, np.pi, CORRECTION_STATIONS)))
    )  # dense in the end layers
    shape = inflate(muscle, pressure, x=stations)["deformed_radius"] / tube.fiber_surface
    xi = stations / tube.fiber_surface
    tb = np.tan(np.radians(tube.beta))
    half_sum, half_difference = 0.5 * tb, -0.5 * tb
    y = CubicSpline(xi, shape.values, axis=-1)
    stretch, slope = y(xi), y(xi, 1)
    squared = 1.0 + half_sum**2 + half_difference**2 - half_difference**2 * stretch**2 - half_sum**2 / stretch**2
    s = np.sqrt(squared - slope**2)
    squared_y = -2.0 * half_difference**2 * stretch + 2.0 * half_sum**2 / stretch**3
    volume_y = CubicSpline(xi, 2.0 * stretch * s + stretch**2 * squared_y / (2.0 * s), axis=-1).integrate(xi[0], xi[-1])
    volume_v = -(stretch**2) * slope / s
    twist_y = CubicSpline(xi, -2.0 * half_sum / stretch**3, axis=-1).integrate(xi[0], xi[-1])
    ends = volume_v[..., -1] - volume_v[..., 0]
    return -numbers(pressure, "Pa") * np.pi * tube.fiber_surface**3 * (volume_y - ends) / twist_y

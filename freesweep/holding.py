"""Blocked force and blocked torque: the deformed length or the rotation of the free end is held (Eqs. 2.16 - 2.22).

Where several states are possible, the one given lies on the branch that begins without load: pressure, the load that is
given and fiber extension - 1 rise in proportion while the undeformed length (no rotation) is held, then what is held changes
to the value asked for. Where the wall, or loose fibers while the tube is straight, would have to be pushed on that way, or
it leads nowhere, the loads rise with nothing held, then the length or rotation found is changed to the value asked for:
``held_path`` says so. A tube that would snap without is pulled, or turned, as its loads rise, and let go to that value.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .description.actuator import Actuator
from .description.faults import ActuatorError
from .description.given import numbers
from .description.options import read_switch
from .description.quantities import Names, Quantities
from .held_states import hold
from .statics import inflate

if TYPE_CHECKING:
    import xarray as xr

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
) -> xr.Dataset:
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
    given = {"deformed_length": held, "torque": torque, "pressure": pressure}
    return hold(tube, given, x, accuracy, derivatives=derivatives, tied=deformed_length is None)


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
) -> xr.Dataset:
    """The torque that holds the rotation of the free end, the length being free (Eqs. 2.19, 2.20).

    Parameters
    ----------
    tube : the actuator; any profile and fiber extension, but alpha = -beta has no rotation to hold if fibers are bonded
    pressure, force : number or 1-D array [Pa, N]
    rotation : held rotation [degree], number or 1-D array (a torque-rotation curve)
    deformed_length : None; a held length beside the held rotation is refused, with the reason
    buckled : beyond the critical pressure (:func:`freesweep.closed_form.critical_pressure`) the straight cylinder is
        unstable; True gives the stable, shorter, antisymmetric state beside it: the source's "blocked deformation". Many
        tubes have one below the critical pressure, too, which a disturbance may lead to: a safe limit is
        ``least_buckled_pressure`` [Pa], the least at which the buckled branch has a state. Below it there is none: status
        4. With a strong rotation held its beginning may not be met: status 6 (4 of 110 random tubes, 0 of 150 without)
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
        turns = tube.is_loose or np.any(alpha != -beta)  # of loose fibers one family goes slack
        if not (turns if tube.has_two_families else np.any(np.abs(single) > 0.0)):
            raise ActuatorError(
                [
                    "rotation: a tube of bonded fibers with alpha = -beta does not rotate, nor does one of straight fibers"
                    " alone or without any, so no torque holds it; use blocked_force"
                ]
            )
        if buckled and (tube.threads > 0.0 or tube.is_thick):
            raise ActuatorError(
                ["buckled: solved for membranes with bonded fibers only; others leave the cylinder without"]
            )
        if buckled and tube.varies:
            raise ActuatorError(["buckled: only a tube that is the same all along has a straight state to buckle from"])
    return hold(tube, {"rotation": rotation, "force": force, "pressure": pressure}, x, accuracy, buckled, derivatives)


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

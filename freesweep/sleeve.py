"""Chapter 3: an actuator wound as a helix around an arm, taken as a string without bending stiffness.

With its ends fixed to the sleeve the actuator keeps its length and its number of turns, so its tension T is the blocked
force. A helix of radius r at the angle a from the arm's axis has the curvature sin^2(a)/r, and presses with ::

    T sin(a)/r       per length of hoop, that is of the arm's circumference      (Eq. 3.4)
    T sin^2(a)/r     per length of the actuator                                  (Eq. 3.4 drops one sine)
    T sin(a) tan(a)/(2 pi r^2)    as mean pressure over the height that is wound

Forces measured on a sleeve (Figure 3-13) are lower than these by almost half: a load on its side reduces what a blocked
actuator pulls with, and no model here knows it. Take the values for upper bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .description.actuator import Actuator
from .description.faults import ActuatorError
from .description.given import described, numbers, read_number
from .description.quantities import Quantities, Quantity

if TYPE_CHECKING:
    import xarray as xr

MEASURED = (
    "string model: measured loads are lower by almost half (Figure 3-13), as a side load reduces the blocked force"
)


@dataclass(frozen=True, kw_only=True)
class Helix:
    """An actuator wound around an arm.

    ``length`` of the actuator and ``height`` of the winding along the arm in [m], ``height`` < ``length``; ``turns`` > 0,
    any number. Raises :class:`ActuatorError`, which lists every fault.
    """

    length: float
    height: float
    turns: float

    if TYPE_CHECKING:  # what may be given is more than what is kept

        def __init__(self, *, length: Quantity, height: Quantity, turns: Quantity) -> None: ...

    def __post_init__(self):
        faults = []
        for name, unit in {"length": "m", "height": "m", "turns": "1"}.items():
            object.__setattr__(self, name, read_number(name, getattr(self, name), unit, faults, positive=True))
        if not faults and not self.height < self.length:
            faults.append(
                f"height: found {self.height:g} m; an actuator of {self.length:g} m winds less high than that"
            )
        if faults:
            raise ActuatorError(faults)

    @classmethod
    def around(cls, radius: Quantity, length: Quantity, height: Quantity) -> Helix:
        """The helix of an actuator of a ``length`` on an arm of a ``radius``, both ends a ``height`` apart [m].

        The source takes the arm's radius; add the actuator's outer radius for its middle line. Raises
        :class:`ActuatorError`.
        """
        faults = []
        radius, length, height = (
            read_number(name, value, "m", faults, positive=True)
            for name, value in (("radius", radius), ("length", length), ("height", height))
        )
        if faults:
            raise ActuatorError(faults)
        hoops = max((length - height) * (length + height), 0.0) ** 0.5
        turns = (
            hoops / (2.0 * np.pi * radius) if hoops > 0.0 else 1.0
        )  # too high a winding is refused whatever its turns
        return cls(length=length, height=height, turns=turns)

    @property
    def radius(self) -> float:
        """Radius [m] that the length leaves with the ends and the number of turns fixed (Eq. 3.1)."""
        return ((self.length - self.height) * (self.length + self.height)) ** 0.5 / (2.0 * np.pi * self.turns)

    @property
    def angle(self) -> float:
        """Angle of the actuator from the arm's axis [degree]."""
        return float(np.degrees(np.arccos(self.height / self.length)))

    def shortened(self, length: Quantity) -> Helix:
        """The helix of the same ends and turns once its actuator has another ``length`` [m]: its radius follows."""
        return Helix(length=length, height=self.height, turns=self.turns)

    def hoop_load(self, force: Quantities) -> Any:
        """Line load on the arm per length of hoop [N/m] for a tension [N], Eq. 3.4. Slack where ``force`` < 0: 0."""
        return _tension(force) * self._sine / self.radius

    def line_load(self, force: Quantities) -> Any:
        """Line load on the arm per length of the actuator [N/m] for a tension [N]. Slack where ``force`` < 0: 0."""
        return self.hoop_load(force) * self._sine

    def pressure(self, force: Quantities) -> Any:
        """Mean pressure on the arm over the height that is wound [Pa] for a tension [N]."""
        return self.normal_force(force) / (2.0 * np.pi * self.radius * self.height)

    def normal_force(self, force: Quantities) -> Any:
        """Sum of all forces normal to the arm [N], whatever their direction around it, for a tension [N]."""
        return self.line_load(force) * self.length

    def friction_force(self, force: Quantities, coefficient: Quantity) -> Any:
        """Largest load along the arm [N] that static friction takes up, for a tension [N] and a ``coefficient`` [-].

        The tension is the same all along: friction along the winding (a capstan's) is left out. Raises
        :class:`ActuatorError`.
        """
        faults = []
        coefficient = read_number("coefficient", coefficient, "1", faults, least=0.0)
        if faults:
            raise ActuatorError(faults)
        return coefficient * self.normal_force(force)

    @property
    def _sine(self):
        return 2.0 * np.pi * self.turns * self.radius / self.length


def _tension(force):
    """A string cannot push: it is slack."""
    try:
        return np.maximum(numbers(force, "N"), 0.0)[()]
    except ValueError as error:
        raise ActuatorError([f"force: {error}"]) from None


def constriction(
    tube: Actuator, helix: Helix, pressure: Quantities, *, friction: Quantity = 0.0, accuracy: float = 1e-6
) -> xr.Dataset:
    """What an actuator wound around an arm presses with (sections 3.3 and 3.4).

    Parameters
    ----------
    tube : the actuator; its blocked force at the helix's length (:func:`freesweep.blocked_force`) is the tension
    helix : its winding
    pressure : in the actuator, number or 1-D array [Pa]
    friction : coefficient of static friction between sleeve and arm [-]
    accuracy : as in :func:`freesweep.lock`

    Returns a Dataset with ``force`` [N], ``hoop_load`` and ``line_load`` [N/m], ``arm_pressure`` [Pa], ``friction_force``
    [N], their ``_error`` bounds and ``status``. The bounds are those of the string model; measured loads are lower by almost
    half (Figure 3-13). Raises :class:`ActuatorError`.
    """
    from .holding import blocked_force

    faults = [] if isinstance(helix, Helix) else [f"helix: found {described(helix)}; give a Helix"]
    friction = read_number("friction", friction, "1", faults, least=0.0)
    if faults:
        raise ActuatorError(faults)
    blocked = blocked_force(tube, pressure, helix.length, x=0.0, accuracy=accuracy)
    result = blocked[["force", "force_error", "status", "stable", "slack_fiber"]].drop_vars("x", errors="ignore")
    for name, of, units, long_name in (
        ("hoop_load", helix.hoop_load, "N/m", "load on the arm per length of hoop (Eq. 3.4)"),
        ("line_load", helix.line_load, "N/m", "load on the arm per length of the actuator"),
        ("arm_pressure", helix.pressure, "Pa", "mean pressure on the arm"),
        (
            "friction_force",
            lambda force: helix.friction_force(force, friction),
            "N",
            "load along the arm held by friction",
        ),
    ):
        result[name] = (blocked["force"].dims, of(blocked["force"].values), {"units": units, "long_name": long_name})
        bound = of(blocked["force_error"].values)
        result[f"{name}_error"] = (
            blocked["force"].dims,
            bound,
            {"units": units, "long_name": f"error bound of {name}"},
        )
    result.attrs |= {
        "comment": MEASURED, "helix_angle": helix.angle, "helix_radius": helix.radius, "helix_turns": helix.turns,
    }  # fmt: skip
    return result

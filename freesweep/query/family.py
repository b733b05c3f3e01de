"""Families of variables: those that share a status, flags and a kind of uniform state behind them."""

from typing import NamedTuple

from . import reference as r


class Family(NamedTuple):
    """``variables`` maps names to variables of :mod:`reference`; ``status`` and ``flag`` are the names stored beside,
    ``answered`` the status of an answer where it is one of its own.
    """

    kind: int
    variables: dict
    status: str | None
    flag: str | None = None
    answered: str | None = None

    @property
    def answer_status(self) -> str:
        """The status beside an answer."""
        return self.answered or self.status


_SHAPE = {
    "deformed_length": r.DEFORMED_LENGTH,
    "rotation": r.ROTATION,
    "mid_radius": r.MID_RADIUS,
    "volume": r.VOLUME,
    "strain_energy": r.ENERGY,
}


def _slack(prefix):
    return {f"{prefix}slack_alpha": r.SLACK_ALPHA, f"{prefix}slack_beta": r.SLACK_BETA}


FAMILIES = {
    "state": Family(r.LOADED, _SHAPE | {"outer_radius": r.OUTER_RADIUS}, "status", "stable"),
    "slack": Family(r.LOADED, _slack(""), "status", answered="slack_status"),
    "locked_slack": Family(r.LOCKED, _slack("locked_"), "locked_status", answered="locked_slack_status"),
    "locked": Family(r.LOCKED, {f"locked_{name}": variable for name, variable in _SHAPE.items()}, "locked_status"),
    "blocked_force": Family(
        r.LENGTH_HELD, {"blocked_force": r.HOLDING_FORCE}, "blocked_force_status", "blocked_force_stable"
    ),
    "blocked_torque": Family(
        r.ROTATION_HELD, {"blocked_torque": r.HOLDING_TORQUE}, "blocked_torque_status", "blocked_torque_stable"
    ),
    "limit": Family(r.NONE, {"limit_pressure": r.PLAIN}, None, "limit_found", "limit_pressure_status"),
}
FAMILY_OF = {name: key for key, family in FAMILIES.items() for name in family.variables}


def family_of(key, of_bodies) -> Family:
    """A family of an atlas of tubes, or ``of_bodies`` of revolution."""
    family = FAMILIES[key]
    if not of_bodies:
        return family
    variables = {name: r.BODY_RADIUS if kind == r.MID_RADIUS else kind for name, kind in family.variables.items()}
    return family._replace(variables=variables)


IDEAL = ("ideal_blocked_force", "ideal_blocked_torque")  # closed forms: evaluated, never interpolated

MIRRORED = ("rotation", "locked_rotation", "blocked_torque", "ideal_blocked_torque")  # turn round with both angles
LOOSE = (  # ten times the tolerance of lengths
    r.ROTATION, r.ENERGY, r.HOLDING_FORCE, r.HOLDING_TORQUE, r.SLACK_ALPHA, r.SLACK_BETA,
)  # fmt: skip
TOLD_FROM = {"outer_radius": "mid_radius"}  # in closed form

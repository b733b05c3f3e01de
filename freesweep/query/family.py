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


TOLD = {  # from the radius in the middle, by the first integral
    "outer_radius": r.OUTER_RADIUS,
    "largest_stretch": r.LARGEST_STRETCH,
    "least_tension_alpha": r.LEAST_TENSION_ALPHA,
    "least_tension_beta": r.LEAST_TENSION_BETA,
}
SLACK_FLAGS = {r.SLACK_ALPHA: 4, r.SLACK_BETA: 8}  # of nodes, beside which families pull in the middle: slack somewhere
TOLD_FROM = dict.fromkeys(TOLD, "mid_radius")
PULLS = ("least_tension_alpha", "least_tension_beta")  # less well than the others
TABLE_OF = {"tension": "state"}  # families that are told from another's table

FAMILIES = {
    "state": Family(r.LOADED, _SHAPE | TOLD, "status", "stable"),
    "tension": Family(r.LOADED, {name: TOLD[name] for name in PULLS}, "status", answered="tension_status"),
    "slack": Family(r.LOADED, _slack(""), "status", answered="slack_status"),
    "locked_slack": Family(r.LOCKED, _slack("locked_"), "locked_status", answered="locked_slack_status"),
    "locked": Family(r.LOCKED, {f"locked_{name}": variable for name, variable in _SHAPE.items()}, "locked_status"),
    "blocked_force": Family(
        r.LENGTH_HELD, {"blocked_force": r.HOLDING_FORCE}, "blocked_force_status", "blocked_force_stable"
    ),
    "blocked_torque": Family(
        r.ROTATION_HELD, {"blocked_torque": r.HOLDING_TORQUE}, "blocked_torque_status", "blocked_torque_stable"
    ),
    "blocked_force_slack": Family(
        r.LENGTH_HELD, _slack("blocked_force_"), "blocked_force_status", answered="blocked_force_slack_status"
    ),
    "blocked_torque_slack": Family(
        r.ROTATION_HELD, _slack("blocked_torque_"), "blocked_torque_status", answered="blocked_torque_slack_status"
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
    r.ROTATION, r.ENERGY, r.HOLDING_FORCE, r.HOLDING_TORQUE, r.SLACK_ALPHA, r.SLACK_BETA, r.LARGEST_STRETCH,
    r.LEAST_TENSION_ALPHA, r.LEAST_TENSION_BETA,
)  # fmt: skip

"""One table of everything a dataset holds: name, units, long name, and in which parameters it varies.

Datasets of single actuators and atlases share it. A parameter that takes several values is a dimension; one with a single
value is a scalar coordinate. Every output, scalar or along x, has ``<name>_error`` beside it, a bound that holds.
"""

from typing import NamedTuple

from ..status import flag_attributes, status_attributes


class Parameter(NamedTuple):
    """What goes in: the undeformed design and its load."""

    units: str
    long_name: str


PARAMETERS = {
    "alpha": Parameter("degree", "angle of the first fiber family from the axis"),
    "beta": Parameter("degree", "angle of the second fiber family from the axis"),
    "length": Parameter("m", "undeformed length"),
    "radius": Parameter("m", "undeformed inner radius"),
    "taper": Parameter("1", "share by which the far end of the undeformed radius is slimmer than the near one"),
    "bulge": Parameter("1", "share by which a smooth bulge widens the undeformed radius at half length"),
    "wall": Parameter("m", "undeformed wall thickness"),
    "fiber_radius": Parameter("m", "radius at which the fibers lie"),
    "fiber_extension": Parameter("1", "stretch of the fibers at any pressure"),
    "c10": Parameter("Pa", "first constant of the rubber, Mooney-Rivlin or Yeoh"),
    "c01": Parameter("Pa", "second Mooney-Rivlin constant"),
    "c20": Parameter("Pa", "second Yeoh constant"),
    "c30": Parameter("Pa", "third Yeoh constant"),
    "force": Parameter("N", "axial force applied by the surroundings, positive in tension"),
    "torque": Parameter("N m", "torque applied by the surroundings, positive toward growing rotation"),
    "held_length": Parameter("m", "deformed length that the blocked force holds"),
    "held_length_ratio": Parameter("1", "deformed length that the blocked force holds, in undeformed lengths"),
    "held_rotation": Parameter("degree", "rotation of the free end that the blocked torque holds"),
    "pressure": Parameter("Pa", "gauge pressure"),
}
HELD_LENGTHS = ("held_length", "held_length_ratio")
HELD = (*HELD_LENGTHS, "held_rotation")
LOADS = ("force", "torque", "pressure")
YEOH = ("c20", "c30")  # 0 where a dataset has none
SHAPE = ("taper", "bulge")  # the same
MATERIAL = ("wall", "c10", "c01", *YEOH)


class Variable(NamedTuple):
    """What comes out."""

    units: str
    long_name: str
    without: tuple = ()  # parameters it does not vary in


_SHAPE = {
    "deformed_length": ("m", "length"),
    "rotation": ("degree", "rotation of the free end"),
    "mid_radius": ("m", "radius of the fiber surface at half length"),
    "volume": ("m3", "volume of the cavity"),
}

_SLACK = {  # of physical tubes
    "slack_alpha": ("1", "share of the length without a pull in the first family"),
    "slack_beta": ("1", "share of the length without a pull in the second family"),
}
_ALONG = _SLACK | {
    "least_tension_alpha": ("N", "least tension of the whole first family, negative where it would have to push"),
    "least_tension_beta": ("N", "least tension of the whole second family, negative where it would have to push"),
    "outer_radius": ("m", "largest outer radius along the tube"),
    "largest_stretch": ("1", "largest stretch of the wall"),
}

VARIABLES = {
    **{name: Variable(units, f"{long_name} under pressure", HELD) for name, (units, long_name) in _SHAPE.items()},
    "strain_energy": Variable("J", "strain energy of the wall", HELD),
    **{name: Variable(units, long_name, HELD) for name, (units, long_name) in _ALONG.items()},
    "limit_pressure": Variable("Pa", "pressure at which the branch ends", (*HELD, "pressure")),
    **{
        f"locked_{name}": Variable(units, f"{long_name}, locked", (*LOADS, *HELD, *MATERIAL))
        for name, (units, long_name) in _SHAPE.items()
    },
    "locked_strain_energy": Variable("J", "strain energy of the wall, locked", (*LOADS, *HELD)),
    **{
        f"locked_{name}": Variable(units, f"{long_name}, locked", (*LOADS, *HELD, *MATERIAL))
        for name, (units, long_name) in _SLACK.items()
    },
    "blocked_force": Variable("N", "force that holds the length, free to rotate", ("force", "held_rotation")),
    "blocked_torque": Variable("N m", "torque that holds the rotation, length free", ("torque", *HELD_LENGTHS)),
    **{
        f"{held}_{name}": Variable(units, f"{long_name}, {what} held", without)
        for held, what, without in (
            ("blocked_force", "length", ("force", "held_rotation")),
            ("blocked_torque", "rotation", ("torque", *HELD_LENGTHS)),
        )
        for name, (units, long_name) in _SLACK.items()
    },
    "ideal_blocked_force": Variable(
        "N", "blocked force of inextensible fibers (Eq. 2.16)", ("length", *MATERIAL, "force", "torque", *HELD)
    ),
    "ideal_blocked_torque": Variable(
        "N m", "blocked torque of inextensible fibers (Eq. 2.19)", ("length", *MATERIAL, "force", "torque", *HELD)
    ),
}

STATES = {"locked_": "locked", "blocked_force_": "length held", "blocked_torque_": "rotation held"}  # by prefix

EXCHANGED = {  # what becomes what where the fiber families change places
    f"{name}_{one}": f"{name}_{other}"
    for name in ("slack", "locked_slack", "blocked_force_slack", "blocked_torque_slack", "least_tension")
    for one, other in (("alpha", "beta"), ("beta", "alpha"))
}

STATUS_OF = {
    "status": ("status of the equilibrium", HELD),
    "locked_status": ("status of the locked state", VARIABLES["locked_strain_energy"].without),
    "blocked_force_status": ("status of the blocked force", VARIABLES["blocked_force"].without),
    "blocked_torque_status": ("status of the blocked torque", VARIABLES["blocked_torque"].without),
    "ideal_blocked_force_status": (
        "status of the blocked force of inextensible fibers",
        VARIABLES["ideal_blocked_force"].without,
    ),
    "ideal_blocked_torque_status": (
        "status of the blocked torque of inextensible fibers",
        VARIABLES["ideal_blocked_torque"].without,
    ),
}
FLAG_OF = {
    "stable": ("whether the equilibrium is stable, where there is one", HELD),
    "slack_fiber": ("fiber family that would have to push somewhere", HELD),
    "blocked_force_stable": ("whether the tube of held length is stable", VARIABLES["blocked_force"].without),
    "blocked_torque_stable": ("whether the tube of held rotation is stable", VARIABLES["blocked_torque"].without),
    "limit_found": (
        "whether a limit pressure was met, where a branch was followed",
        VARIABLES["limit_pressure"].without,
    ),
}

HELD_ALONE = {  # which no atlas stores
    "held_path": Variable("1", "way by which the held state was found"),
    "least_buckled_pressure": Variable("Pa", "least pressure at which the buckled branch has a state"),
}

PROFILES = {
    "deformed_radius": ("m", "radius of the fiber surface"),
    "axial_position": ("m", "axial position after deformation"),
    "twist": ("degree", "rotation from the fixed end"),
    "alpha_deformed": ("degree", "angle of the first fiber family after deformation"),
    "beta_deformed": ("degree", "angle of the second fiber family after deformation"),
    "fiber_tension_alpha": ("N", "tension of the whole first family"),
    "fiber_tension_beta": ("N", "tension of the whole second family"),
}


# xarray writes long names beside axes, and breaks them after 30 characters, the unit among them
SHORT = {
    **{"alpha": "fiber angle alpha", "beta": "fiber angle beta", "x": "distance from fixed end"},
    **{"taper": "taper of the radius", "bulge": "bulge of the radius"},
    **{"fiber_radius": "radius of the fibers", "fiber_extension": "stretch of the fibers"},
    **{"c10": "first rubber constant", "c01": "second Mooney constant"},
    **{"force": "axial force", "torque": "torque", "held_length": "held length", "held_rotation": "held rotation"},
    "held_length_ratio": "held/undeformed length",
    **{"deformed_length": "length", "rotation": "rotation", "mid_radius": "radius at half length", "volume": "volume"},
    **{"strain_energy": "strain energy", "limit_pressure": "limit pressure"},
    **{"locked_deformed_length": "locked length", "locked_rotation": "locked rotation"},
    **{"locked_mid_radius": "locked radius", "locked_volume": "locked volume"},
    "locked_strain_energy": "locked strain energy",
    **{"locked_slack_alpha": "locked slack share, alpha", "locked_slack_beta": "locked slack share, beta"},
    **{"blocked_force": "blocked force", "blocked_torque": "blocked torque"},
    "blocked_force_slack_alpha": "slack of alpha, length held",
    "blocked_force_slack_beta": "slack of beta, length held",
    "blocked_torque_slack_alpha": "slack of alpha, rotation held",
    "blocked_torque_slack_beta": "slack of beta, rotation held",
    **{"ideal_blocked_force": "ideal blocked force", "ideal_blocked_torque": "ideal blocked torque"},
    **{"outer_radius": "outer radius", "largest_stretch": "stretch of the wall"},
    **{"slack_alpha": "slack share of family alpha", "slack_beta": "slack share of family beta"},
    "least_tension_alpha": "least tension of alpha",
    "least_tension_beta": "least tension of beta",
    **{"held_path": "way to the held state", "least_buckled_pressure": "least buckled pressure"},
    **{"deformed_radius": "fiber radius", "axial_position": "axial position", "twist": "rotation along x"},
    **{"alpha_deformed": "deformed alpha", "beta_deformed": "deformed beta"},
    **{"fiber_tension_alpha": "tension of family alpha", "fiber_tension_beta": "tension of family beta"},
}


def plain(name: str) -> str:
    """What a variable is of its own state, under pressure or one of STATES."""
    for prefix in STATES:
        name = name.removeprefix(prefix)
    return name


def without(name: str) -> tuple:
    """The parameters that a variable of an atlas, or its bound, does not vary in."""
    of = name.removesuffix("_error")
    return STATUS_OF[of][1] if of in STATUS_OF else FLAG_OF[of][1] if of in FLAG_OF else VARIABLES[of].without


def absent(name, fibers_lie) -> tuple:
    """The same in an atlas whose fibers do not lie at the inner radius, if ``fibers_lie`` elsewhere: then the wall decides
    with them which designs are valid, or how large they are.
    """
    return tuple(each for each in without(name) if each != "wall" or not fibers_lie)


def status_of(name) -> str:
    """The variable that says where another has numbers."""
    if name == "limit_pressure":
        return "limit_found"
    of = name.partition("_slack_")[0]
    if f"{of}_status" in STATUS_OF:
        return f"{of}_status"
    return "locked_status" if name.startswith("locked_") else "status"


def attributes(name: str) -> dict:
    """CF attributes of any variable or coordinate that a dataset may hold."""
    if name.removesuffix("_error") in PARAMETERS and name not in PARAMETERS:
        of = PARAMETERS[name.removesuffix("_error")]
        return {"units": of.units, "long_name": f"error bound of {name.removesuffix('_error')}"}
    if name in PARAMETERS:
        return {"units": PARAMETERS[name].units, **_named(name, PARAMETERS[name].long_name)}
    if name == "x":
        return {"units": "m", **_named(name, "distance from the fixed end before deformation")}
    if name in PROFILES:
        units, long_name = PROFILES[name]
        return {"units": units, **_named(name, long_name)}
    if name in STATUS_OF:
        return {"long_name": STATUS_OF[name][0], **status_attributes()}
    if name in FLAG_OF:
        kind = "stable" if name.endswith("stable") else name
        return {"long_name": FLAG_OF[name][0], **flag_attributes(kind)}
    if name == "held_path":
        return {"long_name": HELD_ALONE[name].long_name, **flag_attributes(name)}
    if name.endswith("_error"):
        of = name.removesuffix("_error")
        units = PROFILES[of][0] if of in PROFILES else (VARIABLES | HELD_ALONE)[of].units
        return {"units": units, "long_name": f"error bound of {of}"}
    of = (VARIABLES | HELD_ALONE)[name]
    return {"units": of.units, **_named(name, of.long_name)}


def _named(name, text):
    """A long name that is no longer than an axis of a plot, and the rest of what is to say as a comment."""
    return {"long_name": SHORT[name], "comment": text} if name in SHORT else {"long_name": text}

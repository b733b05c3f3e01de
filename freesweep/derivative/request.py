"""What derivatives may be asked for, and how each is named and measured."""

import numpy as np

from ..atlas.schema import PARAMETERS, VARIABLES
from ..atlas.schema import SHAPE as OF_BODIES
from ..description.actuator import Actuator
from ..description.elastomer import Yeoh
from ..description.families import FAMILIES, followed, given_by
from ..description.given import described
from ..description.tube_model import MODELS
from ..scaling import PULLS, SLACK

SHAPE = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")
DESIGN = ("alpha", "beta", "length", "radius", "wall", "fiber_extension")
LITTLE = 1e-2  # of the work of the loads, whose rounding the energy of a hardly strained wall carries
ANGLE = 57.3  # [degree], what angles and rotations are measured by


def constants(material) -> dict:
    """Names of a rubber's constants as it has them -> as a design has them."""
    return dict(zip(material.constants, ("c10", "c20", "c30") if isinstance(material, Yeoh) else ("c10", "c01")))


def place_of_fibers(tube):
    """One of FIBER_PLACES, or a radius [m]."""
    return MODELS[tube.model].fiber_radius if tube.fiber_radius is None else tube.fiber_radius


def parameters(tube, loads=(), held=None) -> tuple:
    """Names of all parameters of a tube and its loads, and of what is ``held``."""
    own = ("fiber_radius",) if not isinstance(place_of_fibers(tube), str) else ()
    own += OF_BODIES if tube.is_body else ()
    there = [name for name in DESIGN if name not in FAMILIES or name in given_by(tube)]
    return (*there, *own, *constants(tube.material), *loads, *(() if held is None else (held,)))


def read_derivatives(value, allowed, faults):
    """The names asked for, each once: "all", one name or several; None after noting every fault."""
    if value is None:
        return ()
    if isinstance(value, str):
        if value == "all":
            return allowed
        value = [value]
    try:
        names = list(value)
    except TypeError:
        names = [value]
    unknown = [name for name in names if not (isinstance(name, str) and name in allowed)]
    for name in unknown:
        faults.append(f"derivatives: found {described(name)}; choose from {', '.join(allowed)}, or 'all'")
    return None if unknown else tuple(dict.fromkeys(names))


def asked_of(tube, value, faults, loads=(), held=None):
    """:func:`read_derivatives` of what a tube, if it is one, has; nothing where ``value`` is None."""
    if value is None or not isinstance(tube, Actuator):
        return ()
    if given_by(tube) != followed(tube):
        faults.append(
            "derivatives: found two families of one angle, which part or go on as one where an angle changes; leave one of"
            " them out (beta=None), or ask for angles that differ"
        )
        return ()
    return read_derivatives(value, parameters(tube, loads, held), faults)


def unit_of(name, tube) -> str:
    """Unit of an output or a parameter."""
    of = constants(tube.material).get(name, name)
    return PARAMETERS[of].units if of in PARAMETERS else VARIABLES[of].units


def attributes(output, parameter, tube, above) -> dict:
    """Attributes of ``d_<output>_d_<parameter>``, of an output in the unit ``above``."""
    below = unit_of(parameter, tube)
    below = f"({below})" if " " in below else below
    units = above if below == "1" else f"{above}/{below}"
    return {"units": units, "long_name": f"derivative of {output} with respect to {parameter}"}


def measures(tube, loads) -> dict:
    """What each output and parameter is measured by, by name; loads may be arrays."""
    design = tube.design()
    r, c10 = design["fiber_radius"], design["c10"]
    area = np.pi * r**2
    own = np.where(np.isfinite(loads["pressure"]), loads["pressure"], c10)
    pressure = np.maximum.reduce(
        [own, np.abs(loads["force"]) / area, np.abs(loads["torque"]) / (area * r), 1e-3 * c10 + 0.0 * own]
    )
    natural = {
        "deformed_length": tube.length, "rotation": ANGLE, "mid_radius": r, "volume": area * tube.length,
        "strain_energy": LITTLE * pressure * area * tube.length, "outer_radius": r, "largest_stretch": 1.0,
        **dict.fromkeys(PULLS, np.where(np.isfinite(loads["pressure"]), pressure, 1.0) * area), **dict.fromkeys(SLACK, 1.0),
        "pressure": pressure, "force": pressure * area, "torque": pressure * area * r,
        "alpha": ANGLE, "beta": ANGLE, "fiber_extension": 1.0, **dict.fromkeys(OF_BODIES, 1.0),
        **{name: c10 for name in constants(tube.material)},
    }  # fmt: skip
    return natural | {name: design[name] for name in ("length", "radius", "wall", "fiber_radius")}


def sizes(tube, loads, outputs, parameters, values):
    """What each output, and each of its derivatives, is measured by: (outputs, 1 + parameters); ``values`` (outputs,); of
    many states (..., n).
    """
    natural, values = measures(tube, loads), np.abs(values)
    above = np.array([np.maximum(natural[name], value) for name, value in zip(outputs, values)])
    below = [np.broadcast_to(one, values.shape[1:]) for one in (1.0, *(natural[name] for name in parameters))]
    return above[:, None] / np.array(below)

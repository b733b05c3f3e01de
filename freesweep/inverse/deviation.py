"""How far what candidates do spreads under tolerances of manufacture, to first order in exact derivatives."""

import warnings

import numpy as np

from ..derivative.dual import Dual
from ..derivative.extremes import EXTREMES
from ..derivative.physics import OWN
from ..derivative.request import SHAPE, constants, parameters, place_of_fibers, unit_of
from ..derivative.table import rows_of
from ..description.given import described, read_number
from ..description.tube_model import FIBER_PLACES, fiber_place
from .outputs import FOLLOWING, derived
from .predict import state_of
from .singles import states_of
from .space import LOADS
from .wishes import HELD

ACCURACY = 1e-6
WORKING = {
    "free": LOADS,
    "locked": (),
    "force": ("pressure", "torque"),
    "torque": ("pressure", "force"),
    "limit": LOADS[1:],
    "design": (),
    "every": (),
}  # by the kind of a wish, the loads under which its state is


def read_tolerances(given, template, faults) -> dict:
    """Standard deviations by the names of parameters, in SI units and degrees."""
    if given is None:
        return {}
    allowed = parameters(template, LOADS)
    if not isinstance(given, dict):
        faults.append(f"tolerances: found {described(given)}; give a dict such as {{'alpha': 1.0, 'wall': 5e-5}}")
        return {}
    unknown = [name for name in given if name not in allowed]
    faults += [f"tolerances: found {described(name)}; choose from {', '.join(allowed)}" for name in unknown]
    return {
        name: read_number(f"tolerances: {name}", value, unit_of(name, template), faults, least=0.0)
        for name, value in given.items()
        if name in allowed
    }


def deviations(tubes, wishes, columns, tolerances) -> np.ndarray:
    """Standard deviations (tubes, wishes) of what is wished for; NaN where no derivative is known: of limit pressures and
    stiffnesses, and where there is no state. ``columns`` hold
    the loads of each tube, by name.
    """
    found = np.full((len(tubes), len(wishes)), np.nan)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said where the candidates were solved
        for i, tube in enumerate(tubes):
            loads = {name: float(columns[name][i]) for name in LOADS}
            seen = {}
            for k, wish in enumerate(wishes):
                known = wish.output in (*SHAPE, *EXTREMES, *FOLLOWING, *HELD, *tube.design(), "pressure")
                if wish.kind != "limit" and known:
                    found[i, k] = _deviation(tube, wish, loads, tolerances, seen)
    return found


def _deviation(tube, wish, loads, tolerances, seen):
    names = list(tolerances)
    design = _design(tube, loads, names)
    if wish.kind == "design":
        number = design[wish.output]
    else:
        if (state := state_of(wish)) not in seen:
            seen[state] = _state(tube, state, loads, names)
        number = derived(wish.output, seen[state], design)
    slopes = rows_of({"one": number}, ["one"], len(names))[0, 1:, 0]
    return np.sqrt(np.sum((slopes * list(tolerances.values())) ** 2))


def _design(tube, loads, names):
    """A tube's parameters and loads as dual numbers of ``names``."""
    own = {of: name for name, of in constants(tube.material).items()}  # as a design has them -> as the rubber does
    design = {name: _dual(value, names, own.get(name, name)) for name, value in (tube.design() | loads).items()}
    if (place := place_of_fibers(tube)) in FIBER_PLACES:
        design["fiber_radius"] = fiber_place(place, design["radius"], design["wall"])
    return design


def _dual(value, names, name):
    parts = np.zeros((OWN + len(names), 1))
    if name in names:
        parts[OWN + names.index(name)] = 1.0
    return Dual(np.array([value]), parts)


def _state(tube, state, loads, names):
    """Outputs of a state as dual numbers of ``names``."""
    given = loads | dict(state.conditions)
    rest = tuple((name, value) for name, value in state.conditions if name != "pressure")
    asked = [name for name in names if name in parameters(tube, WORKING[state.kind])]
    found = states_of(tube, state.kind, rest, [given["pressure"]], given, 0.0, accuracy=ACCURACY, derivatives=asked)
    made = {}
    for output in (*SHAPE, *EXTREMES, state.kind):
        if output in found.data_vars:
            parts = np.zeros((OWN + len(names), 1))
            for name in asked:
                parts[OWN + names.index(name)] = found[f"d_{output}_d_{name}"].item()
            made[output] = Dual(np.array([found[output].item()]), parts)
    if state.kind == "force":  # what is held does not spread, but with the length that is held by default
        held = given.get("deformed_length")
        made["deformed_length"] = _dual(tube.length if held is None else held, names, "length" if held is None else "")
    return made

"""A calibration as TOML, with units as everywhere::

[data]
files = ["lengths.csv", "forces.csv"]       # beside this file
measured = ["force"]
[actuator]                                  # first guesses of what is fitted, the truth of the rest
alpha = "28 deg"                            # beta = -alpha where it is left out
length = "200 mm"
radius = "5 mm"
wall = "1 mm"
model = "physical"                          # wall_model, fibers, fiber_radius, energy, material or constants too
[fit]
parameters = ["c10", "fiber_extension", "dead_length"]
own_extension = false
[priors]
alpha = [28, 1]                             # known to a degree: fitted with that
[bounds]
wall = ["0.9 mm", "1.1 mm"]
[ties]
c01 = "0.5*c10"
"""

from pathlib import Path

from ..atlas.schema import PARAMETERS
from ..description.elastomer import rubber_of
from ..description.faults import ActuatorError
from ..description.given import numbers
from ..description.material_library import material
from ..sweep import toml_guard
from .csv_file import FIRST_GUESS, TUBE, WORDS, read_measurements, units_of_files

CONSTANTS = ("c10", "c01", "c20", "c30")
SECTIONS = {
    "data": ("files", "measured"), "actuator": (*TUBE, *WORDS, "energy", "material", *CONSTANTS),
    "fit": ("parameters", "own_extension"), "priors": None, "bounds": None, "ties": None,
}  # fmt: skip


def read_case(path) -> tuple:
    """Measurements, and arguments of :func:`freesweep.calibrate`; raises FileNotFoundError, or :class:`ActuatorError`."""
    document = toml_guard.load(toml_guard.read_text(path), str(path))
    faults = [f"{key}: unknown; a calibration has {', '.join(SECTIONS)}" for key in document if key not in SECTIONS]
    for key, allowed in SECTIONS.items():
        if not isinstance(document.get(key, {}), dict):
            faults.append(f"{key}: write [{key}]")
        elif allowed:
            unknown = [name for name in document.get(key, {}) if name not in allowed]
            faults += [f"{key}.{name}: unknown; it has {', '.join(allowed)}" for name in unknown]
    if faults:
        raise ActuatorError([f"{path}: {fault}" for fault in faults])
    data, actuator, fit = (dict(document.get(key, {})) for key in ("data", "actuator", "fit"))
    files = data.get("files", [])
    files = [Path(path).parent / name for name in ([files] if isinstance(files, str) else files)]
    if not files:
        faults.append('data.files: is missing; name CSV files, as in files = ["lengths.csv"]')
    rubber = _rubber(actuator, faults)
    if "alpha" in actuator and "beta" not in actuator:
        actuator["beta"] = _mirrored(actuator["alpha"], faults)
    if faults:
        raise ActuatorError([f"{path}: {fault}" for fault in faults])
    measurements = read_measurements(files, measured=data.get("measured", ()), material=rubber, **actuator)
    asked = {key: document[key] for key in ("priors", "bounds", "ties") if key in document}
    asked |= {"own_extension": fit["own_extension"]} if "own_extension" in fit else {}
    return measurements, asked | {"fit": fit.get("parameters")}


def units_asked(path) -> list:
    """Pairs of a text and the unit in which its kind is kept, of all that a case and its files give with units."""
    document = toml_guard.load(toml_guard.read_text(path), str(path))
    given = document.get("actuator", {})
    files = document["data"]["files"]
    pairs = units_of_files(Path(path).parent / name for name in ([files] if isinstance(files, str) else files))
    return pairs + [(given[name], PARAMETERS[name].units) for name in TUBE if isinstance(given.get(name), str)]


def _mirrored(angle, faults):
    try:
        return -numbers(angle, "degree").item()
    except ValueError as error:
        faults.append(f"actuator.alpha: {error}")
        return None


def _rubber(actuator, faults):
    """Takes the rubber out of what describes the actuator."""
    name = actuator.pop("material", None)
    constants = {key: actuator.pop(key) for key in CONSTANTS if key in actuator}
    try:
        if name is not None:
            return material(name)
        if not constants:
            return FIRST_GUESS
        return rubber_of(**{key: numbers(value, "Pa").item() for key, value in constants.items()})
    except (ActuatorError, ValueError, TypeError) as error:
        faults += [f"actuator: {fault}" for fault in getattr(error, "faults", [str(error)])]
        return None

"""Reads wishes from TOML, with units as everywhere::

[actuator]                          # what holds where nothing else is free, as in a sweep
length = "150 mm"
wall = "1.59 mm"
material = "dragon-skin-30"         # or c10, c01; c20, c30
model = "source"                    # fibers, wall_model, fiber_radius, energy too
[free]
alpha = {start = "0 deg", stop = "85 deg"}
beta = "-alpha"                     # a tie
"radius,wall" = [["4.76 mm", "1.59 mm"], ["6.35 mm", "0.8 mm"]]        # what can be bought
# alpha = {start = "0 deg", stop = "85 deg", knots = 5}                # a profile along the tube
[[goals]]
output = "rotation"
value = "90 deg"                    # or a path, "force-stroke.csv", or at_least, at_most, between = ["80 deg", "100 deg"]
pressure = "100 kPa"
tolerance = "1 deg"
[[limits]]
output = "outer_radius"
at_most = "7.5 mm"
pressure = "100 kPa"
[tolerances]                        # of manufacture: standard deviations
alpha = "1 deg"
[search]
minimize = "radius"                 # or {output = "strain_energy", pressure = "100 kPa"}, or two of them
count = 10
seed = 0
"""

from dataclasses import fields
from pathlib import Path

from ..atlas.schema import PARAMETERS
from ..description.actuator import Actuator
from ..description.along import Profile
from ..description.elastomer import rubber_of
from ..description.faults import ActuatorError
from ..description.given import numbers
from ..description.material_library import material
from ..report import SHOWN
from ..sweep import toml_guard
from .curve_file import is_path
from .space import CONSTANTS
from .wishes import CONDITIONS, UNITS, Goal, Limit, _Asked

PLACES = {"alpha": 40.0, "beta": -20.0, "length": 0.1, "radius": 5e-3, "wall": 1e-3}  # of what is free, until it is not
KINDS = {"actuator": dict, "free": dict, "goals": list, "limits": list, "tolerances": dict, "search": dict}
SECTIONS = ("title", *KINDS)
SEARCH = ("minimize", "count", "seed")


def read(path) -> dict:
    """Arguments of :func:`freesweep.design` from a file; raises FileNotFoundError, or :class:`ActuatorError`."""
    document = toml_guard.load(toml_guard.read_text(path), str(path))
    faults = [f"{key}: unknown; a wish has {', '.join(SECTIONS)}" for key in document if key not in SECTIONS]
    tables = {}
    for key, kind in (
        ("actuator", dict),
        ("free", dict),
        ("goals", list),
        ("limits", list),
        ("tolerances", dict),
        ("search", dict),
    ):
        tables[key] = document.get(key, kind())
        if not isinstance(tables[key], kind) or (
            kind is list and not all(isinstance(one, dict) for one in tables[key])
        ):
            faults.append(f"{key}: write [{key}]" if kind is dict else f"{key}: write [[{key}]]")
            tables[key] = kind()
    free = {key: _free(value, f"free.{key}", faults) for key, value in tables["free"].items()}
    tube = _actuator(tables["actuator"], free, faults)
    beside = Path(path).parent
    goals = [_asked(Goal, _found(one, beside), f"goals[{k}]", faults) for k, one in enumerate(tables["goals"])]
    limits = [_asked(Limit, one, f"limits[{k}]", faults) for k, one in enumerate(tables["limits"])]
    search = tables["search"]
    faults += [f"search.{key}: unknown; it has {', '.join(SEARCH)}" for key in search if key not in SEARCH]
    minimize = _minimize(search.get("minimize"), faults)
    if faults:
        raise ActuatorError([f"{path}: {fault}" for fault in faults])
    more = {key: search[key] for key in ("count", "seed") if key in search}
    more |= {"tolerances": tables["tolerances"]} if tables["tolerances"] else {}
    return {"template": tube, "free": free, "goals": goals, "limits": limits, "minimize": minimize} | more


def units_asked(path) -> list:
    """Pairs of a text and the unit in which its kind is kept, of what a file of wishes gives with units: of the actuator
    first, then of what is free, goals and limits.
    """
    document = toml_guard.load(toml_guard.read_text(path), str(path))
    given = [*document.get("actuator", {}).items(), *document.get("free", {}).items()]
    given = [(name, value) for name, value in given if name not in CONSTANTS]  # a rubber's: no pressures of a table
    kept = {name: parameter.units for name, parameter in PARAMETERS.items()} | CONDITIONS
    for one in (*document.get("goals", []), *document.get("limits", [])):
        unit = UNITS.get(one["output"], kept.get(one["output"]))
        given += [(name, one[name]) for name in CONDITIONS if name in one]
        given += [(unit, one[name]) for name in ("value", "at_least", "at_most", "between", "tolerance") if name in one]
    pairs = []
    for name, value in given:
        ends = value.values() if isinstance(value, dict) else value if isinstance(value, list) else [value]
        pairs += [(text, kept.get(name, name)) for text in ends if isinstance(text, str)]
    return [(text, unit) for text, unit in pairs if unit in SHOWN and not is_path(text)]


def _free(value, where, faults):
    if not isinstance(value, dict):
        return value
    if not {"start", "stop"} <= set(value) <= {"start", "stop", "knots"}:
        faults.append(f"{where}: give start and stop, and knots for a profile")
        return (0.0, 1.0)
    pair = value["start"], value["stop"]
    if "knots" not in value:
        return pair
    try:
        return Profile(value["knots"], pair)
    except ActuatorError as error:
        faults += [f"{where}: {fault}" for fault in error.faults]
        return pair


def _actuator(given, free, faults):
    """The template; what is free needs no value there."""
    parts = {part.strip() for key in free for part in str(key).split(",")}
    known = {field.name for field in fields(Actuator)} - {"material"}
    allowed = known | {"material", *CONSTANTS}
    faults += [f"actuator.{key}: unknown; it has {', '.join(sorted(allowed))}" for key in given if key not in allowed]
    faults += [f"actuator.{name}: is missing, and not free" for name in PLACES if name not in {*given, *parts}]
    values = {key: value for key, value in given.items() if key in known}
    if "material" in given and (own := [name for name in CONSTANTS if name in given]):
        faults.append(
            f"actuator.material: found beside {', '.join(own)}; a rubber has its constants, so keep one of both"
        )
    try:
        if "material" in given:
            rubber = material(given["material"])
        else:
            own = {name: numbers(given[name], "Pa").item() for name in CONSTANTS if name in given}
            if "c10" not in own and not {"c10", "material"} & parts:
                faults.append("actuator.c10: is missing; give constants, or material = a name of the library")
            rubber = rubber_of(**({"c10": 1e5} | own))
        if not faults:
            return Actuator(**(PLACES | values), material=rubber)
    except (ActuatorError, ValueError) as error:
        faults += [f"actuator: {fault}" for fault in getattr(error, "faults", [str(error)])]
    return None


def _found(given, folder):
    """The same with the path of a curve as it is seen from the file of wishes."""
    return given | {"value": folder / given["value"]} if is_path(given.get("value")) else given


def _asked(kind, given, where, faults):
    names = [field.name for field in fields(_Asked)]
    unknown = [key for key in given if key not in names]
    faults += [f"{where}.{key}: unknown; it has {', '.join(names)}" for key in unknown]
    if "output" not in given:
        faults.append(f"{where}.output: is missing")
    if unknown or "output" not in given:
        return None
    try:
        return kind(**given)
    except ActuatorError as error:
        faults += [f"{where}: {fault.partition(': ')[2] or fault}" for fault in error.faults]
        return None


def _minimize(given, faults):
    """What [search] says is to be least: names, or tables of an output and its state."""
    several = given if isinstance(given, list) else [given]
    found = []
    for one in several:
        if isinstance(one, dict):
            made = _asked(Limit, {"at_most": float("1e12")} | one, "search.minimize", faults)
            found += [made] if made is not None else []
        elif one is not None:
            found.append(one)
    return found or None

"""Reads a sweep from TOML: what is fixed, what varies, and every fault of the text in one error.

    title = "What this sweep is for"
    [actuator]                  # fixed values of the design, with units; plain numbers are SI and degrees
    wall = "1.59 mm"            # alpha, beta, wall, radius may vary along the tube: [[0, "30 deg"], [0.5, "40 deg"],
                                # [1, "30 deg"]], pairs of x/l and value; a repeated x/l is a jump, but of the radius;
                                # {knots = [[0, "5 mm"], [0.5, "8 mm"], [1, "5 mm"]], smooth = true}: a spline
    taper = 0.2                 # the far end is slimmer than the near one by that share, and the middle wider by that of
    bulge = "10 %"              # bulge: what is given as the radius counts (1 - taper x/l) (1 + bulge sin^2(pi x/l)) times
    alpha = "geodesic 30 deg"   # of such a body, there and in [axes]; and wall = "constant volume 1.5 mm"
    beta = "none"               # no such family; alpha = "none", too: balloons
    c10 = "0.17 MPa"            # and c01, or c20 and c30 of a Yeoh rubber; or material = "dragon-skin-30"
    energy = "full"             # or "principal"
    model = "source"            # or "physical": thick wall, loose fibers outside; or part by part: wall_model, fibers and
    fiber_radius = "middle"     # "inner", "middle", "outer", or a radius, which may vary as other numbers do
    [load]                      # fixed force, torque, pressure, held_length or held_length_ratio, held_rotation
    [axes]                      # what varies: all combinations are solved
    alpha = {start = "0 deg", stop = "85 deg", step = "2.5 deg"}
    length = ["100 mm", "200 mm"]
    pressure = {start = "0 kPa", stop = "300 kPa", num = 41, spacing = "sqrt"}     # or "linear", "log"
    [[designs]]                 # or named designs, each combined with all axes
    name = "A"
    beta = 50
    [solver]
    accuracy = 1e-6
    blocked = true              # blocked force and torque too, with fiber extension and loads
    interpolation_tolerance = 1e-4   # add nodes to the axes until answers between them are that exact (relative, lengths)
    budget = 5_000_000               # or until the grid has that many points

A design takes what it leaves out from [actuator] and [load]. A held length (absolute, or as a ratio to the undeformed one)
asks for the blocked force, a held rotation for the blocked torque; ``blocked = true`` for both, at rest where not given.
"""

import math
from dataclasses import replace
from pathlib import Path

from ..atlas.schema import PARAMETERS, SHAPE, YEOH
from ..description.families import FAMILIES, is_none
from ..description.fields import ENERGIES
from ..description.tube_model import DEFAULT, FEW_PRINCIPAL, FIBER_PLACES, MODELS, word_faults
from ..description.units import shown
from . import along, axis, toml_guard
from .asked import Sweep, shape_of
from .contradictions import check_fibers, check_profiles
from .designs import AT_REST, DEFAULTS, HOME, OWN, read_designs
from .faults import Faults, SpecificationError
from .rubber import SYNONYMS, check_rubber, read_material
from .solver_table import MAX_POINTS, read_accuracy, read_blocked, read_tolerance

__all__ = ["MAX_POINTS", "SpecificationError", "Sweep", "parse", "read_file"]

NONE = "none"  # of a family that there is not
WORDS = ("energy", "model", "wall_model", "fibers")  # of [actuator]
NONE_FOR_ALL = (
    "some of its values are none; an axis is of numbers: give none in [actuator], for all tubes of a sweep, and those with"
    " such a family a sweep of their own"
)
REQUIRED = ("alpha", "beta", "length", "radius", "wall", "c10", "pressure")


def read_file(path: str | Path) -> Sweep:
    """The sweep that a TOML file describes; raises FileNotFoundError or, with every fault, SpecificationError."""
    return parse(toml_guard.read_text(path), str(path))


def parse(text: str, name: str = "specification") -> Sweep:
    """The sweep that a TOML text describes; raises SpecificationError, under ``name``, with every fault."""
    document = toml_guard.load(text, name)
    faults = Faults(name)
    elsewhere = {key: f"it belongs in [{home}] or [axes]" for key, home in HOME.items()}
    sections = ("title", "actuator", "load", "axes", "designs", "solver")
    faults.unknown_keys(document, sections, elsewhere=elsewhere | {"design": "designs are written [[designs]]"})
    tables = {key: _table(faults, document, key) for key in ("actuator", "load", "axes", "solver")}
    title = faults.line("title", document.get("title", ""))
    energy = _energy(faults, tables["actuator"])
    model = _model(faults, tables["actuator"], energy)
    accuracy = read_accuracy(faults, tables["solver"])
    tolerance, budget = read_tolerance(faults, tables["solver"])
    given = {}  # parameter: where it is given, faulty or not
    rules = {}  # parameter: word
    fixed, profiles = _fixed(faults, tables, given, rules)
    families = tuple(name for name in FAMILIES if fixed.get(name) != NONE)
    if len(families) < 2 and energy == "principal":
        faults.add(*f"actuator.{FEW_PRINCIPAL}".split(": ", 1))
    fixed = {name: number for name, number in fixed.items() if number != NONE}
    axes = _axes(faults, tables["axes"], given, rules)
    designs = read_designs(faults, document["designs"], given, fixed) if "designs" in document else None
    check_profiles(faults, profiles, fixed, given, families)
    for parameter in REQUIRED:
        if parameter not in given:
            others = ", or in every design" if designs and parameter in OWN else ""
            faults.add(parameter, f"is missing; give it in [{HOME[parameter]}] or [axes]{others}")
    blocked, at_rest = read_blocked(faults, tables["solver"], given)
    absent = set(AT_REST) - set(at_rest) | set(YEOH) | set(SHAPE)
    defaults = {key: number for key, number in DEFAULTS.items() if key not in absent}
    fixed = {key: defaults.get(key) if key not in given else fixed.get(key) for key in PARAMETERS}
    fixed = {key: number for key, number in fixed.items() if number is not None}
    values = fixed | axes | (designs or {}).get("columns", {})
    check_fibers(faults, values)
    check_rubber(faults, values, axes, given)
    points = math.prod(shape_of(axes, designs))
    if points > MAX_POINTS:
        faults.add(
            "axes",
            f"{points:,} points ({8 * points:,} bytes a variable), at most {MAX_POINTS:,} are allowed; "
            "use coarser axes or several sweeps",
        )
    faults.check()
    rubber = tables["actuator"].get("material", "")
    if "fiber_radius" in values:
        model = model._replace(fiber_radius="inner")  # it is not asked for
    found = Sweep(
        title, energy, fixed, axes, designs, accuracy, text, blocked, profiles, tolerance, budget, rubber, model, rules,
        families,
    )  # fmt: skip
    return found if found.is_of_bodies else replace(found, rules={})  # of a tube a rule is the number it gives


def _table(faults, document, key):
    table = document.get(key, {})
    if not isinstance(table, dict):
        faults.add(key, f"found {shown(table)}, must be a table: write [{key}] on a line of its own")
        return {}
    return table


def _energy(faults, actuator):
    energy = actuator.get("energy", "full")
    if energy not in ENERGIES:
        faults.add("actuator.energy", f"found {shown(energy)}, allowed: {', '.join(ENERGIES)}")
    return energy


def _is_place(found):
    return isinstance(found, str) and found in FIBER_PLACES


def _model(faults, actuator, energy):
    """The model of the tubes, of which each part may be given by itself."""
    words = {"model": DEFAULT} | {
        name: actuator[name] for name in ("model", "wall_model", "fibers") if name in actuator
    }
    wrong = word_faults(words["model"], words.get("wall_model"), words.get("fibers"), energy, (energy,))
    for fault in wrong:
        faults.add(*f"actuator.{fault}".split(": ", 1))
    if wrong:
        return MODELS["source"]
    place = {"fiber_radius": actuator["fiber_radius"]} if _is_place(actuator.get("fiber_radius")) else {}
    return MODELS[words.pop("model")]._replace(**words, **place)


def _fixed(faults, tables, given, rules):
    fixed, profiles = {}, {}
    for section in ("actuator", "load"):
        table = tables[section]
        own = [name for name in PARAMETERS if HOME[name] == section]
        elsewhere = SYNONYMS | {name: f"it belongs in [{HOME[name]}]" for name in PARAMETERS}
        faults.unknown_keys(table, [*own, *WORDS, "material"] if section == "actuator" else own, section, elsewhere)
        for name in own:
            if name in table and not (name == "fiber_radius" and _is_place(table[name])):
                given[name] = f"{section}.{name}"
                if name in FAMILIES and is_none(table[name]):
                    fixed[name] = NONE
                elif along.is_profile(name, table[name]):
                    profiles[name] = along.profile(faults, given[name], name, table[name])
                else:
                    number = _unworded(faults, given[name], name, table[name], rules)
                    fixed[name] = axis.value(faults, given[name], name, number)
    fixed |= read_material(faults, tables["actuator"], given)
    return fixed, {name: pairs for name, pairs in profiles.items() if pairs}


def _unworded(faults, path, name, found, rules):
    """What is given without the word of its rule, which goes into ``rules``."""
    rest, rule = along.unworded(faults, path, name, found)
    if rule:
        rules[name] = rule
    return rest


def _axes(faults, table, given, rules):
    faults.unknown_keys(
        table,
        tuple(PARAMETERS),
        "axes",
        SYNONYMS | {name: "it belongs in [actuator] and cannot vary" for name in (*WORDS, "material")},
    )
    axes = {}
    for name in PARAMETERS:
        if name in table:
            if name in given:
                faults.add(f"axes.{name}", f"given twice, also as {given[name]}; remove one")
            given[name] = f"axes.{name}"
            if name in FAMILIES and isinstance(table[name], list) and any(map(is_none, table[name])):
                faults.add(given[name], NONE_FOR_ALL)
                continue
            array = axis.values(faults, given[name], name, _unworded(faults, given[name], name, table[name], rules))
            if array is not None:
                axes[name] = array
    return axes

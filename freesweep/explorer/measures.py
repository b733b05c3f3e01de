"""What the explorer shows of an atlas: measures, in SI units and degrees, and the three systems of units for them."""

from typing import NamedTuple

import numpy as np

from ..atlas.schema import PARAMETERS, attributes
from ..description.tube_model import fiber_surface
from ..description.units import factor
from ..inverse.outputs import output
from ..plot.between import EXACT
from ..query.family import FAMILIES, FAMILY_OF, LOOSE
from ..query.table import HELD_NAMES
from ..status import NOT_INTERPOLABLE, VALUED

ANY = 1e9  # a tolerance: each measure is held to its own, so none hides another
SYSTEMS = ("SI", "mm kPa", "in psi")
COARSE = 1e-3  # stated error, relative, above which a place is marked as coarse
COARSE_STATUS = 10  # of the page alone, after those of freesweep.status
FLOORS = {"degree": 0.1, "1": 1e-2, "%": 1e-2}  # what small numbers are held against
UNITS = {  # kept in -> what each system shows, with a name of the table of units or a factor
    "m": (("m", "m"), ("mm", "mm"), ("in", "in")),
    "Pa": (("Pa", "Pa"), ("kPa", "kPa"), ("psi", "psi")),
    "N": (("N", "N"), ("N", "N"), ("lbf", "lbf")),
    "N m": (("N m", "N m"), ("mN m", "mN m"), ("lbf in", "lbf in")),
    "degree": (("degree", "degree"),) * 3,
    "m3": (("m³", 1.0), ("mL", 1e6), ("in³", 1.0 / 0.0254**3)),
    "J": (("J", 1.0), ("mJ", 1e3), ("lbf in", 1.0 / 0.1129848290276167)),
    "1": (("", 1.0),) * 3,
    "%": (("%", 100.0),) * 3,
}


class Measure(NamedTuple):
    """One quantity: ``source`` is the variable of the atlas that it is made of, ``centre`` what its colours diverge from."""

    name: str
    source: str
    label: str
    unit: str  # kept in; "%": a share, shown in percent
    centre: float | None = None


_LABELS = {
    "rotation": ("Rotation", 0.0),
    "deformed_length": ("Length", None),
    "mid_radius": ("Radius at half length", None),
    "volume": ("Volume of the cavity", None),
    "strain_energy": ("Strain energy", None),
    "limit_pressure": ("Limit pressure", None),
    "blocked_force": ("Blocked force", 0.0),
    "blocked_torque": ("Blocked torque", 0.0),
    "ideal_blocked_force": ("Blocked force, ideal", 0.0),
    "ideal_blocked_torque": ("Blocked torque, ideal", 0.0),
    "outer_radius": ("Outer radius", None),
    "largest_stretch": ("Largest stretch of the wall", None),
    "least_tension_alpha": ("Least tension of alpha", None),
    "least_tension_beta": ("Least tension of beta", None),
    "slack_alpha": ("Slack share of alpha", None),
    "slack_beta": ("Slack share of beta", None),
}
_ORDER = ("rotation", "length_change", "relative_radius", "outer_radius")


def measures_of(reader) -> list:
    """The measures of an atlas' reader, those a designer asks for first in front."""
    found = [_plain(name) for name in reader.names if _is_told(reader, name)]
    for prefix, end in (("", ""), ("locked_", ", locked")):
        if prefix + "deformed_length" in reader.names and "length" in reader.frame.values:
            found.append(
                Measure(f"{prefix}length_change", f"{prefix}deformed_length", f"Change of length{end}", "%", 0.0)
            )
        if prefix + "mid_radius" in reader.names and {"radius", "fiber_radius"} & set(reader.frame.values):
            found.append(
                Measure(f"{prefix}relative_radius", f"{prefix}mid_radius", f"Radius / undeformed{end}", "1", 1.0)
            )
    if "mid_radius" in reader.names and "outer_radius" not in reader.names and _tells_outer_radius(reader.frame):
        found.append(Measure("outer_radius", "mid_radius", "Outer radius", "m"))
    rank = {name: k for k, name in enumerate(_ORDER)}
    return sorted(found, key=lambda one: (rank.get(one.name, len(rank)), one.name.startswith(("locked_", "ideal_"))))


def _is_told(reader, name):
    """Whether a query answers a variable: it varies along the axes of its family (locked energies may along more)."""
    if name not in FAMILY_OF:
        return True
    if FAMILIES[FAMILY_OF[name]].kind in HELD_NAMES.values() and (reader.frame.model.is_loose or "slack" in name):
        return False  # told at nodes only
    first = next(one for one in FAMILIES[FAMILY_OF[name]].variables if one in reader.frame.dims)
    return set(reader.frame.dims[name]) == set(reader.frame.dims[first])


def _plain(name):
    about, end = attributes(name), ", locked" if name.startswith("locked_") else ""
    label, centre = _LABELS.get(name.removeprefix("locked_"), (about["long_name"], None))
    return Measure(name, name, label + end, "%" if "slack" in name else about["units"], centre)


def _tells_outer_radius(frame):
    return frame.uniform_along_x and not frame.model.is_loose


def system_units(unit) -> list:
    """``(name, factor)`` of a kept unit in each of SYSTEMS; shown = factor * kept."""
    return [
        (name, 1.0 / factor(scale, unit) if isinstance(scale, str) else scale)
        for name, scale in UNITS.get(unit, ((unit, 1.0),) * 3)
    ]


class Evaluated(NamedTuple):
    """Values, stated errors and statuses by measure, slack families and stability, all (n,)."""

    value: dict
    error: dict
    status: dict
    slack: np.ndarray
    stable: np.ndarray


def evaluate(reader, values, size, wanted) -> Evaluated:
    """Some measures at ``values`` (axis -> (n,)): interpolated as a query does, stated error up to that of plots."""
    names = list(dict.fromkeys(one.source for one in wanted))
    if "slack_fiber" in reader.frame.dims and not any(FAMILY_OF.get(name) == "state" for name in names):
        names += [name for name in reader.names if FAMILY_OF.get(name) == "state"][:1]
    found = reader.answer(values, size, names, tolerance=ANY, sure=False)
    columns = _columns(reader, values, size)
    made = Evaluated({}, {}, {}, *(found.get(name, np.zeros(size, np.int8)) for name in ("slack_fiber", "stable")))
    for one in wanted:
        value, error = _made(one, found, columns)
        status = found[status_name(one.source)].astype(np.uint8)
        given, size_of = np.isin(status, VALUED), np.maximum(np.abs(value), floor_of(one.unit))
        lost = given & np.isfinite(value) & ~(error <= (10.0 if is_loose(one.source) else 1.0) * EXACT * size_of)
        coarse = given & (error > COARSE * size_of)
        status = np.where(lost, NOT_INTERPOLABLE, np.where(coarse, COARSE_STATUS, status)).astype(np.uint8)
        made.value[one.name], made.error[one.name] = (np.where(lost, np.nan, array) for array in (value, error))
        made.status[one.name] = status
    return made


def floor_of(unit) -> float:
    """What small numbers of a unit are held against."""
    return FLOORS.get(unit, 0.0)


def is_loose(source) -> bool:
    """Whether a variable is held to ten times the tolerance of lengths, as in a query."""
    family = FAMILY_OF.get(source)
    return family is not None and FAMILIES[family].variables[source] in LOOSE


def status_name(source) -> str:
    """The status of a variable in an answer."""
    family = FAMILY_OF.get(source)
    return FAMILIES[family].answer_status if family else f"{source}_status"


def _columns(reader, values, size):
    """All parameters of the designs (n,), what the atlas fixes and what each named design has with it."""
    columns = reader.complete(values, size)
    for name in reader.frame.by_design:
        columns[name] = reader.frame.values[name][columns["design"].astype(int)]
    columns.setdefault("fiber_extension", np.ones(size))
    if reader.frame.bodies is not None:  # whose shape is told at half length
        columns["fiber_radius"] = reader.frame.bodies.at(columns, 0.5)["fiber_radius"]
    elif "radius" in columns:
        columns["fiber_radius"] = fiber_surface(columns, reader.frame.model)
    return {name: array for name, array in columns.items() if name in PARAMETERS}


def _made(one, found, columns):
    """``(value, error)`` of a measure."""
    value, error = found[one.source], found[f"{one.source}_error"]
    if one.name.endswith("length_change"):
        return value / columns["length"] - 1.0, error / columns["length"]
    if one.name.endswith("relative_radius"):
        return value / columns["fiber_radius"], error / columns["fiber_radius"]
    if one.name == "outer_radius" and one.source != one.name:
        return output("outer_radius", "free", found, columns)
    return value, error

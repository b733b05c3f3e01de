"""Answers that an atlas cannot give, solved exactly: all points of a question in one batch for each family."""

import numpy as np

from ..atlas.schema import plain
from ..description.along import written
from ..description.families import FAMILIES as FAMILIES_OF_FIBERS
from ..description.given import numbers
from ..description.local import UNITS
from ..status import NOT_INTERPOLABLE, VALUED
from . import reference
from .answer import Inquiry
from .exact import Tubes, solve
from .family import FAMILIES, FAMILY_OF
from .faults import QueryError

MOST_PROFILES = 10_000  # each is solved on its own
TURNED_COLUMNS = [reference.ALPHA, reference.BETA, reference.TORQUE]


def refine_answers(reader, question, names, found) -> None:
    """Put exact solutions into ``found`` (name -> (n,)) where the status is NOT_INTERPOLABLE."""
    values = reader.complete(question.values, question.size)
    for key, family in FAMILIES.items():
        own = [name for name in names if FAMILY_OF.get(name) == key]
        if not own:
            continue
        todo = np.flatnonzero(found[family.answer_status] == NOT_INTERPOLABLE)
        if not len(todo):
            continue
        if not reader.frame.in_numbers:
            raise QueryError(["refine: the tubes of this atlas have profiles; solve them with freesweep.inflate"])
        points = as_points(reader, key, {name: array[todo] for name, array in values.items()})
        put(found, todo, exact_answers(reader, key, points, own))


def as_points(reader, key, values):
    """Points (n, 17) of one family, as they were asked: ``values`` axis -> (n,)."""
    table = reader.table(key, values)
    inquiry = Inquiry(table, {name: values[name] for name in table.known})
    points = inquiry.points
    exchanged, mirrored = inquiry.marks[:, 5] == 1, inquiry.marks[:, 6] == 1
    points[exchanged, :2] = points[exchanged, 1::-1]
    points[np.ix_(mirrored, TURNED_COLUMNS)] *= -1.0
    if table.family.kind == reference.ROTATION_HELD:
        points[mirrored, reference.HELD] *= -1.0
    return points


def exact_answers(reader, key, points, names, accuracy=None) -> dict:
    """Exact answers of one family at points (n, 17): name -> (n,), as :meth:`Reader.answer` gives them."""
    return told_of(reader, key, names, solved_states(reader, key, points, accuracy))


def solved_states(reader, key, points, accuracy=None, thorough=True) -> dict:
    """States of the kind of a family at points (n, 17), as :func:`exact.solve` gives them."""
    frame, limit = reader.frame, key == "limit"
    accuracy = frame.accuracy if accuracy is None else accuracy
    most = frame.ranges["pressure"][1] if limit else None
    kind = reference.LOADED if limit else FAMILIES[key].kind
    tubes = Tubes(frame.energy, frame.model, frame.families, frame.bodies)
    return solve(kind, points, tubes, accuracy, most, thorough=thorough)


def told_of(reader, key, names, solved) -> dict:
    """What one family tells of states ``solved``: name -> (n,)."""
    family, frame, found = FAMILIES[key], reader.frame, {}
    for name in names:
        of = {"blocked_force": "force", "blocked_torque": "torque"}.get(name, plain(name))
        found[name], found[f"{name}_error"] = solved[of], solved[f"{of}_error"]
    if key == "limit":
        found["limit_found"] = np.isfinite(solved["limit_pressure"]).astype(np.int8)
        known = np.isin(solved["status"], VALUED) | np.isfinite(solved["limit_pressure"])
        found["limit_pressure_status"] = np.where(known, 0, solved["status"]).astype(np.int8)
        return found
    found[family.answer_status] = solved["status"]
    if family.flag in frame.dims:
        found[family.flag] = np.where(np.isin(solved["status"], VALUED), solved["stable"], 0).astype(np.int8)
    if key == "state" and "slack_fiber" in frame.dims:
        found["slack_fiber"] = solved["slack_fiber"]
    return found


def put(found, places, answers) -> None:
    """Write ``answers`` (name -> (k,)) into ``found`` (name -> (n,)) at ``places`` (k,)."""
    for name, array in answers.items():
        if name in found:
            found[name][places] = array


def profiles(reader, question, x):
    """Profiles along the tube at stations ``x`` [m] for each point of a question: a Dataset over its dimensions and ``x``.

    Raises :class:`QueryError`, or ActuatorError for stations outside a tube.
    """
    import xarray as xr

    from ..atlas.schema import PROFILES, attributes
    from ..description.actuator import Actuator
    from ..description.elastomer import rubber_of

    if "state" not in {FAMILY_OF.get(name) for name in reader.names} or not reader.frame.in_numbers:
        raise QueryError(["x: this atlas holds no states under pressure whose profiles could be solved"])
    if question.size > MOST_PROFILES:
        raise QueryError([f"x: {question.size:,} points, at most {MOST_PROFILES:,} with profiles; ask in parts"])
    values = reader.complete(question.values, question.size)
    points = as_points(reader, "state", values)
    try:
        stations = np.atleast_1d(numbers(x, "m"))
    except ValueError as error:
        raise QueryError([f"x: {error}; ascending stations, from 0 to the undeformed length"]) from None
    arrays = {name: np.full((question.size, len(stations)), np.nan) for of in PROFILES for name in (of, f"{of}_error")}
    for k, point in enumerate(points):
        design = dict(zip(reference.COLUMNS, point.tolist()))
        state = _inflated(design, stations, reader.frame, Actuator, rubber_of)
        for name in arrays if state is not None else ():
            arrays[name][k] = state[name].values
    dims = (*question.dims, "x")
    data = {
        name: (dims, array.reshape(*question.shape, len(stations)), attributes(name)) for name, array in arrays.items()
    }
    return xr.Dataset(data, {"x": ("x", stations, attributes("x"))})


def _inflated(design, stations, frame, actuator, material):
    from ..description.actuator import ActuatorError
    from ..statics import inflate

    loads = {name: design.pop(name) for name in ("pressure", "force", "torque")}
    design.pop("held")
    rubber = material(*(design.pop(name) for name in ("c10", "c01", "c20", "c30")))
    if frame.bodies is not None:
        design["fiber_radius"] = frame.model.fiber_radius
        design |= {name: written(name, design[name], UNITS[name]) for name in frame.bodies.rules}
    design |= {name: None for name in FAMILIES_OF_FIBERS if name not in frame.families}
    try:
        parts = {name: getattr(frame.model, name) for name in ("wall_model", "fibers")}
        tube = actuator(**design, material=rubber, energy=frame.energy, model="source", **parts)
    except ActuatorError:
        return None  # no such tube: its status says why
    return inflate(tube, **loads, x=stations)

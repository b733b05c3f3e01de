"""Stored bounds and limit pressures of an atlas, held against those that the solver itself states anew.

A second method finds bounds that do not hold; those a million times too wide hold, too. A bound that meets the accuracy of
the atlas may be any; the others are those of the states solved alone, but for the mesh.
"""

import numpy as np

from ..atlas.schema import SHAPE, plain
from ..description.tube_model import model_of
from ..query import reference
from ..query.exact import CELLS, Tubes, solve
from ..query.family import FAMILIES
from ..scaling import ACCURACIES, ALONG
from .cross_check import compare, ideal

WIDER = 100.0  # times a bound may be another's: one state in a thousand is solved on another mesh
WIDER_THAN_ASKED = 3.0  # times the accuracy a bound may be, rounding among it, where its state is not told inaccurate
ROUNDING = 1e-12  # of a limit pressure
FINER, SHARPER = 4, 1e-2  # times the cells, and the accuracy, of states of physical tubes solved anew


def faults(points) -> list:
    """Sentences on stored bounds and limit pressures that are not the solver's at ``points`` of an atlas."""
    data, found = points.data, []
    accuracy, tubes = float(data.attrs["accuracy"]), Tubes(data.attrs["energy"], model_of(data.attrs), **points.of)
    highest = float(data["pressure"].max()) if "limit_pressure" in data else None
    for key, family in FAMILIES.items():
        # what is seen along a tube is as exact as its places are near, whatever accuracy is asked for
        names = [name for name in family.variables if name in data and plain(name) not in ALONG]
        if key == "limit" or not names:
            continue
        most = highest if key == "state" else None
        anew = solve(family.kind, columns(points, family.kind), tubes, accuracy, most)
        for name in names:
            of = {"blocked_force": "force", "blocked_torque": "torque"}.get(name, name.removeprefix("locked_"))
            found += _of_bounds(name, points, anew[of], anew[f"{of}_error"])
        if most is not None:
            found += _of_limits(points, anew)
    return found


def columns(points, kind):
    """Points (n, 17) as :mod:`freesweep.query.exact` takes them."""
    known = dict(points.column) | {"fiber_radius": points.radius, "held": np.zeros(points.count)}
    known |= {name: points.stored(name) if name in points.data else 0.0 for name in SHAPE}
    if kind == reference.LENGTH_HELD:
        known |= {"force": 0.0 * points.radius, "held": points.target(0) * points.radius / known["length"]}
    elif kind == reference.ROTATION_HELD:
        known |= {"torque": 0.0 * points.radius, "held": np.degrees(points.target(1))}
    return np.column_stack([np.broadcast_to(known[name], points.count) for name in reference.COLUMNS])


def finer(points):
    """Comparisons of ``points`` of physical tubes or bodies, which the second method does not know, with states on a finer
    mesh; and notes, as :func:`.cross_check.resolve` gives them.
    """
    if not points.count:
        return [], ["no point of this atlas has a result"]
    data, found = points.data, []
    accuracy = max(SHARPER * float(data.attrs["accuracy"]), ACCURACIES[0])
    tubes = Tubes(data.attrs["energy"], points.model, **points.of)
    for key, family in FAMILIES.items():
        names = [name for name in family.variables if name in data]
        if key == "limit" or not names:
            continue
        anew = solve(family.kind, columns(points, family.kind), tubes, accuracy, cells=FINER * CELLS)
        for name in names:
            of = {"blocked_force": "force", "blocked_torque": "torque"}.get(name, name.removeprefix("locked_"))
            found.append(compare(points, name, anew[of], anew[f"{of}_error"]))
    found += ideal(points)
    return [compared for compared in found if compared is not None], [
        "not by a second method, which knows cylinders, membranes with bonded fibers, only, but on a mesh"
        f" {FINER} times finer, to an accuracy {1.0 / SHARPER:g} times better"
    ]


def _of_bounds(name, points, value, anew):
    """A sentence if some bounds of a variable are wider than those found ``anew``, and than the accuracy asked for."""
    stored = points.stored(f"{name}_error")
    allowed = float(points.data.attrs["accuracy"]) * _size(name, points, np.abs(value))
    judged = np.isfinite(stored) & np.isfinite(anew)
    with np.errstate(invalid="ignore"):
        wide = judged & (stored > WIDER * anew) & (stored > WIDER_THAN_ASKED * allowed)
    if not wide.any():
        return []
    return [
        f"{name}_error: {np.count_nonzero(wide):,} of {np.count_nonzero(judged):,} bounds are more than {WIDER:g} times as"
        " wide as those solved anew, and miss the accuracy of the atlas"
    ]


def _size(name, points, value):
    """What the accuracy of a variable is counted by: its ``value``, or what the loads would make of it."""
    pressure, r = points.column["pressure"], points.radius
    if name.endswith("rotation"):
        return np.maximum(value, np.degrees(1.0))
    if name.endswith("strain_energy"):
        return np.maximum(value, (pressure + points.column["c10"]) * np.pi * r**2 * points.column["length"])
    if name.startswith("blocked"):
        return np.maximum(value, np.pi * r ** (2 + name.endswith("torque")) * (pressure + points.column["c10"]))
    return value


def _of_limits(points, anew):
    """Sentences on limit pressures that are not there, should not be, or lie elsewhere."""
    limit, bound = points.stored("limit_pressure"), points.stored("limit_pressure_error")
    own, error = anew["limit_pressure"], anew["limit_pressure_error"]
    there, found = np.isfinite(limit), np.isfinite(own)
    with np.errstate(invalid="ignore"):
        apart = np.abs(limit - own) > WIDER * error + ROUNDING * np.abs(own)
        other = there & found & (apart | (np.abs(limit - own) > bound + error))
    told = {"is not there": found & ~there, "is where none is found": there & ~found, "is another": other}
    sentences = [f"limit_pressure: {wrong.sum():,} times it {what}" for what, wrong in told.items() if wrong.any()]
    return sentences + _of_bounds("limit_pressure", points, own, error)

"""Exact solution at points of an atlas, many in one call: the only door from the query to the solver."""

import importlib
import os
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numba import config

from ..description.courses import distinct, followed
from ..description.families import BITS, FAMILIES, beyond_a_point, lines_of
from ..description.impossible import APART, LARGEST_ANGLE
from ..description.local import COURSE
from ..description.splines import SENSITIVITY, widened
from ..description.tube_model import MODELS, TubeModel
from ..scaling import ALONG, OUTPUTS, SLACK, output_scales, problem_rows, wall_volume_inside
from ..solver.status import PENDING
from ..status import DEGENERATE, INVALID, NOT_CONVERGED, VALUED
from . import reference
from .reference import COLUMNS

HELD_KINDS = {  # and what is told of their states
    reference.LENGTH_HELD: ("force", "mid_radius"), reference.ROTATION_HELD: ("torque", "mid_radius")
}  # fmt: skip
CELLS = 24  # of the base mesh, as in sweeps: bounds decide where it is refined
LATER = ("..solver.batch", "..solver.hold_batch", "..solver.lanes.by_middle", "..solver.lanes.held", ".physical_along")
SHARE = 512  # points that one thread solves at a time
FEW, ROUGH = (
    (1, 3),
    1e-5,
)  # tries of vectors that are worth it where a state may be left out; at an accuracy that is rough
MESHES = "meshes"  # how thorough


def load():
    """Import what is imported where it is first needed: no thread may do so while another compiles."""
    for name in LATER:
        importlib.import_module(name, __package__)


class Tubes(NamedTuple):
    """What tubes points are of: their ``energy``, ``model`` and ``families``, without one of which its angle says nothing;
    and which ``bodies``, if they are.
    """

    energy: str
    model: TubeModel = MODELS["source"]
    families: tuple = FAMILIES
    bodies: object = None


def solve(kind, points, tubes, accuracy, largest_pressure=None, cells=CELLS, thorough=True, along=False):
    """States of a kind at points (n, 17) of ``tubes``: name -> (n,) of numbers and ``_error`` bounds, ``status`` and flags,
    on base meshes of so many ``cells``.

    With ``largest_pressure`` [Pa] each design is followed up to there, for its ``limit_pressure``. Not ``thorough``: what
    vectors leave to the scalar kernels, a thousand times dearer, is left out; thorough by MESHES: vectors, which search long
    for held states in vain, are not tried. ``along``: of free states of the source's tubes, too, slack shares and least
    tensions are told, which physical tubes always tell: membranes whose fibers may push are such tubes.
    """
    design = {name: np.ascontiguousarray(points[:, k]) for k, name in enumerate(COLUMNS)}
    lines = lines_of(design["alpha"], design["beta"], tubes.families, tubes.model.is_loose)
    status = _domain(kind, design, lines)
    good = np.flatnonzero(status == NOT_CONVERGED)
    courses, status[good] = _courses(design, good, accuracy, cells, tubes.bodies)
    good = np.flatnonzero(status == NOT_CONVERGED)
    own = {name: column[good] for name, column in design.items()}
    rows, held = _problems(tubes, own, lines, good, along), kind in HELD_KINDS
    pressure = np.full(len(good), np.inf) if kind == reference.LOCKED else own["pressure"] / own["c10"]

    def part(some, followed):
        if held:
            part = {name: column[some] for name, column in own.items()}
            return _held(kind, rows[some], part, accuracy, followed, thorough)
        most = None if largest_pressure is None else largest_pressure / own["c10"][some]
        return _free(rows[some], pressure[some], most, accuracy, followed, thorough or most is not None)

    order = [np.searchsorted(good, some) for some, _ in courses]
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        each = pool.map if len(order) > 1 else map  # a thread for one would cost as much as what it solves
        parts = list(each(part, order, [followed for _, followed in courses]))
    names = HELD_KINDS.get(kind, OUTPUTS)
    names += ALONG if along or tubes.model.is_physical or len(tubes.families) < 2 else ()
    found = {key: np.full(len(points), np.nan) for name in names for key in (name, f"{name}_error")}
    slack, stable = np.zeros((2, len(points)), np.int8)
    found |= {"status": status, "slack_fiber": slack, "stable": stable}
    found |= {key: np.full(len(points), np.nan) for key in ("limit_pressure", "limit_pressure_error")}
    if parts:
        which = np.concatenate(order)
        own = {name: column[which] for name, column in own.items()}
        _put(found, names, kind, good[which], own, tubes.bodies, [np.concatenate(each) for each in zip(*parts)])
        _tell_families(found, slack, lines.single, tubes.families)
    return found


def _domain(kind, design, lines):
    """Statuses (n,) of designs that are in no domain, and where one angle leaves the shape free; of others, unknown yet."""
    status = np.full(len(lines.alpha), NOT_CONVERGED, np.int8)
    apart = np.abs(lines.alpha - lines.beta)
    wide = np.maximum(np.abs(lines.alpha), np.abs(lines.beta)) >= LARGEST_ANGLE
    outer = design["radius"] + design["wall"]
    fibers = (design["fiber_radius"] < design["radius"]) | (design["fiber_radius"] > outer * (1.0 + 1e-12))
    status[((apart < APART) & ~lines.single) | wide | fibers] = INVALID
    status[(apart == 0.0) | (lines.single & (kind == reference.LOCKED))] = DEGENERATE
    return status


def _problems(tubes, own, lines, good, along):
    """Rows of problems of the designs that are ``good``; with ``along``, of tubes that tell what is along them."""
    from ..solver.problem import PROBLEM_SIZE

    of_lines = {"alpha": lines.alpha[good], "beta": lines.beta[good]}
    rows = problem_rows(own | of_lines, tubes.energy, tubes.model.is_thick, lines.threads[good])
    if along and rows.shape[1] == PROBLEM_SIZE:
        rows = np.column_stack([rows, np.zeros((len(rows), 2))])  # no thick wall, two bonded families
    return rows


def _put(found, names, kind, at, own, bodies, parts):
    """Put what the kernels found of designs ``own``, as :func:`_free` and :func:`_held` tell it, at their places."""
    values, bounds, codes, flags, second = parts
    found["status"][at] = codes
    valued = np.isin(codes, VALUED)
    scales, inside = _scales(kind, own), wall_volume_inside(own)
    if bodies is not None:
        scales["mid_radius"], inside = bodies.surface(own)
    for k, name in enumerate(names):
        number = values[:, k] * scales[name]
        if name == "volume":
            number = number - inside
        found[name][at] = np.where(valued, number, np.nan)
        found[f"{name}_error"][at] = np.where(valued, bounds[:, k] * scales[name], np.nan)
    flags = np.where(valued, flags, 0)
    if names[-1] in ALONG:
        flags = beyond_a_point(flags, *(found[name][at] for name in SLACK))
    found["slack_fiber"][at] = flags
    if kind in HELD_KINDS:
        found["stable"][at] = second
    else:
        found["stable"][at] = valued
        found["limit_pressure"][at], found["limit_pressure_error"][at] = (second * own["c10"][:, None]).T


def _tell_families(found, slack, single, families):
    """What was found of the lines as that of the ``families``, where those are fewer than two."""
    slack[single] = (slack[single] & 1) * sum(BITS[name] for name in families)
    for what, share in (("slack", 1.0), ("least_tension", 1.0 / max(len(families), 1))):
        for end in ("", "_error") if f"{what}_alpha" in found else ():
            own = found[f"{what}_alpha{end}"][single]
            for name in FAMILIES:
                found[f"{what}_{name}{end}"][single] = (share if name in families else 0.0) * own


def _courses(design, good, accuracy, cells, bodies):
    """``(points, (course, its error))`` of each course along tubes, of those that are ``good``, and their statuses: of a
    body that there is not INVALID.
    """
    from ..solver.batch import uniform

    status = np.full(len(good), NOT_CONVERGED, np.int8)
    if bodies is None:
        return [(good[k : k + SHARE], (uniform(cells), 0.0)) for k in range(0, len(good), SHARE)], status
    found = []
    each, which = distinct({name: design[name][good] for name in COURSE}, COURSE)
    for k, numbers in enumerate(each):
        course = followed(bodies.tube(numbers.tolist()), accuracy, bool(bodies.rules))
        if course is None:
            status[which == k] = INVALID
            continue
        (rows, edges, places), error = course
        found.append((good[which == k], ((rows, edges * (cells // CELLS), places), error)))
    return found, status


def _scales(kind, own):
    r, c10 = own["fiber_radius"], own["c10"]
    held = {
        reference.LENGTH_HELD: {"force": np.pi * r**2 * c10},
        reference.ROTATION_HELD: {"torque": np.pi * r**3 * c10},
    }
    return output_scales(own) | held.get(kind, {})


def _free(rows, pressure, most, accuracy, followed, thorough):
    """Free states of problems (k, ...), each at its own pressure, and followed to ``most`` (k,) if that is given."""
    from ..solver import batch

    count = len(rows)
    steps = 1 if most is None else 2
    pressures = pressure if most is None else np.column_stack([pressure, np.maximum(most, pressure)]).ravel()
    first = steps * np.arange(count + 1, dtype=np.int64)
    rows, pressures = np.ascontiguousarray(rows), np.ascontiguousarray(pressures)
    tube, error = followed
    if thorough or config.DISABLE_JIT or len(tube[0]):
        walks = batch.walk_all(rows, first, pressures, tube, accuracy - SENSITIVITY * error, soon=True)
    else:
        most = FEW[0] if accuracy > ROUGH else FEW[1]  # what is no state would be tried again in ever more pieces
        walks = batch.walk_by_vectors(rows, first, pressures, accuracy, most)
        walks.status[walks.status == PENDING] = NOT_CONVERGED
    own = slice(0, None, steps)
    bounds, limits = widened(walks.values, walks.bounds, error)[own], walks.limits.copy()
    limits[:, 1] = widened(*limits.T, error)
    return walks.values[own], bounds, walks.status[own], walks.slack[own], limits


def _held(kind, rows, own, accuracy, followed, thorough):
    """Held states of problems (k, ...), each at its own pressure."""
    from ..solver import hold_batch
    from ..solver.held.held_state import HELD_LENGTH, HELD_ROTATION
    from ..solver.problem import LENGTH

    count = len(rows)
    length = kind == reference.LENGTH_HELD
    targets = own["held"] * rows[:, LENGTH] if length else np.radians(own["held"])
    asked = (
        np.ascontiguousarray(rows), targets, HELD_LENGTH if length else HELD_ROTATION, np.arange(count + 1),
        own["pressure"] / own["c10"],
    )  # fmt: skip
    tube, error = followed
    meshes = thorough or len(tube[0]) > 0
    accuracy -= SENSITIVITY * error
    many = hold_batch.EVERY if meshes else 0
    found = hold_batch.hold_all(*asked, tube, accuracy, lanes=thorough != MESHES, soon=meshes, meshes=many)
    found.status[found.status == PENDING] = NOT_CONVERGED
    own = slice(hold_batch.OUTPUTS - 1, None)  # the stretch in the middle, and what is known along the tube
    values = np.column_stack([found.loads, found.states.values[:, own]])
    bounds = widened(values, np.column_stack([found.load_bounds, found.states.bounds[:, own]]), error)
    return values, bounds, found.status, found.states.slack, found.stable

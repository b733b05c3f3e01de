"""Whether an atlas is what was written, and whole: its seal, its specification, its statuses."""

import hashlib
import math
from pathlib import Path

import numpy as np

from ..atlas.content import faulty_codes
from ..atlas.guard import Unsafe, check_file, check_structure
from ..atlas.schema import FLAG_OF, VARIABLES, status_of
from ..atlas.seal import seal_fault
from ..atlas.store import AtlasError, open_atlas
from ..status import BEYOND_LIMIT, VALUED
from ..thick_wall import NOTES, grid_attributes

MANY = 1 << 24  # numbers read at once


def faults(path) -> list:
    """What is wrong with the atlas at ``path``, one sentence each. None: every bit is the one that was written, and the
    content is what the specification in it asks for.

    Raises FileNotFoundError; OSError where the file cannot be read.
    """
    path = Path(path)
    if not path.exists():
        if Path(f"{path}.parts").is_dir():
            return _of_unfinished(path)
        raise FileNotFoundError(f"no atlas at {path}")
    try:
        check_file(path)
        if fault := seal_fault(path):
            return [fault]
        check_structure(path, math.inf)
        atlas = open_atlas(path)
    except (Unsafe, AtlasError) as refusal:
        return [str(refusal)]
    with atlas:
        return [*_of_specification(atlas.data), *_of_content(atlas.data)]


def _of_unfinished(path):
    """What lies there of an atlas that is not made yet."""
    from ..sweep.shards import examine

    whole, faulty = examine(path)
    found = [
        f"it is unfinished: {len(whole):,} whole shards in {path}.parts; the sweep goes on when it is started again"
    ]
    return found + [f"{path.name} is damaged, stale or swapped: the sweep will solve it again" for path in faulty]


def _of_specification(data):
    """Faults of the grid against the specification that the atlas carries."""
    from ..sweep.spec import SpecificationError, parse

    text = data.attrs.get("specification", "")
    if hashlib.sha256(text.encode()).hexdigest() != data.attrs.get("specification_sha256"):
        return ["its specification is not the one whose SHA-256 it carries"]
    try:
        sweep = parse(text)
    except SpecificationError as error:
        return [f"its specification cannot be read: {error}"]
    return [*_of_attributes(data, sweep), *_of_grid(data, sweep)] or _of_note(data)


def _of_attributes(data, sweep):
    """Faults of attributes that follow from the specification: energy and accuracy, the tolerance of answers, profiles."""
    from ..sweep.provenance import FOLLOWING, specified

    wanted = specified(sweep)
    names = {*wanted, *(name for name in data.attrs if name in FOLLOWING)}
    for name in sorted(names):
        found, asked = data.attrs.get(name), wanted.get(name)
        if (found is None) != (asked is None) or not np.array_equal(found, asked):
            yield f"its attribute {name} is {found!r:.40}; its specification says {asked!r:.40}"


def _of_note(data):
    """Faults of what is said of thick walls, against the walls."""
    noted = [data.attrs.get(name) for name in NOTES]
    if any(noted) and not _agree(noted, list(map(grid_attributes(data).get, NOTES))):
        return [f"its note on thick walls, {noted[1]!r:.40}, is not that of its walls"]
    return []


def _agree(noted, own):
    """Whether a ratio and a text are the same, but for the rounding of another machine."""
    numbers = all(isinstance(ratio, float) for ratio in (noted[0], own[0]))
    return numbers and math.isclose(noted[0], own[0], rel_tol=1e-9) and noted[1] == own[1]


def _of_grid(data, sweep):
    """Faults of the axes and of what is fixed."""
    if sweep.interpolation_tolerance is not None:
        return _of_grown_axes(data, sweep)
    wanted = sweep.fixed | sweep.axes | ((sweep.designs or {}).get("columns", {}))
    found = [
        f"{name} is not what its specification asks for"
        for name, values in wanted.items()
        if name not in data.coords or not np.array_equal(data[name].values, values)
    ]
    if dict(data.sizes) != dict(zip(sweep.dims, sweep.shape)):
        found.append(
            f"its axes are {dict(data.sizes)}; its specification asks for {dict(zip(sweep.dims, sweep.shape))}"
        )
    return found


def _of_grown_axes(data, sweep):
    """Faults of a grid whose axes have grown: all nodes asked for must be there, and no other fixed values."""
    found = [
        f"{name} is not what its specification asks for"
        for name, values in (sweep.fixed | sweep.axes).items()
        if name not in data.coords or not np.isin(values, data[name].values).all()
    ]
    if tuple(data.sizes) != sweep.dims:
        found.append(f"its axes are {', '.join(data.sizes)}; its specification asks for {', '.join(sweep.dims)}")
    return found


def _of_content(data):
    """Faults of labels, of values against statuses, and of bounds."""
    found = [*faulty_codes(data, math.inf)]
    for name in (name for name in VARIABLES if name in data):
        judge = status_of(name)
        wrong = unbounded = 0
        for part in _parts(data[name]):
            value, codes, bound = (_part(data, one, part) for one in (name, judge, f"{name}_error"))
            there = np.isfinite(value)
            wrong += np.count_nonzero(there != (codes == 1 if judge in FLAG_OF else _is_valued(codes)))
            unbounded += np.count_nonzero(there != (np.isfinite(bound) & (bound >= 0.0)))
        if wrong:
            found.append(f"{name}: {wrong:,} numbers where its status says none, or none where it says one")
        if unbounded:
            found.append(f"{name}: {unbounded:,} numbers without a bound, or bounds without a number")
    return found + _of_limits(data)


def _of_limits(data):
    """Faults of limit pressures against statuses: below one there are states, beyond it none."""
    if "limit_pressure" not in data:
        return []
    wrong = 0
    for part in _parts(data["status"]):
        names = ("status", "limit_pressure", "limit_pressure_error", "pressure", "force", "torque", "fiber_extension")
        codes, limit, bound, pressure, force, torque, extension = (_part(data, name, part) for name in names)
        wrong += int((_is_valued(codes) & (pressure > limit + bound)).sum())
        wrong += int(((codes == BEYOND_LIMIT) & (pressure < limit - bound)).sum())
        # without loads there is no way to the pressures on which a branch can end
        alone = (force == 0.0) & (torque == 0.0) & (extension == 1.0)
        wrong += int(((codes == BEYOND_LIMIT) & alone & ~np.isfinite(limit)).sum())
    return [f"limit_pressure: {wrong:,} states beyond it, or none below it"] if wrong else []


def _part(data, name, part):
    """A part of a variable, without the coordinates: to compare those takes longer than the numbers do."""
    return data[name].variable.isel(part, missing_dims="ignore")


def _is_valued(codes):
    return codes.copy(data=np.isin(codes.values, VALUED))


def _parts(variable):
    """Slices along the first dimension, of MANY numbers at most where that is possible."""
    if not variable.ndim:
        return [{}]
    rows = max(1, MANY * len(variable) // max(variable.size, 1))
    return [{variable.dims[0]: slice(k, k + rows)} for k in range(0, len(variable), rows)]

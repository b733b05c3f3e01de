"""Whether a dataset that could be read is an atlas: axes, dimensions, units, labels and attributes are those of the schema.

What an atlas says of its own numbers (values against statuses, the grid against its specification) is verify.py's.
"""

import numpy as np

from ..description.tube_model import ATTRIBUTES, FIBER_PLACES, FIBERS, WALL_MODELS, model_of
from .schema import FLAG_OF, PARAMETERS, STATUS_OF, VARIABLES, absent, attributes, status_of

MOST_VALUES = 1_000_000  # of one axis: a specification gives 10 000, and axes may grow
MOST_CODES = 1 << 26  # labels read when an atlas is opened; of a larger one verify reads the rest
READ_AT_ONCE = 1 << 22  # numbers
TEXTS = ("title", "specification", "specification_sha256", "code_sha256", "version", "energy")
ENERGIES = ("full", "principal")
ALWAYS = ("alpha", "beta", "length", "radius", "wall", "c10", "c01", "pressure")  # coordinates, or profiles
MASKS = ("scale_factor", "add_offset", "missing_value", "_Unsigned", "dtype")  # by which readers change numbers
SEVERAL_LINES = ("specification",)
ORDER = ("design", *PARAMETERS)


def faults(data) -> list:
    """What keeps a Dataset from being an atlas, one sentence each."""
    found = [*_of_attributes(data), *_of_axes(data)]
    return found or [*_of_variables(data), *_of_measurement(data)] or _of_codes(data)


def _of_attributes(data):
    for name in TEXTS:
        if not isinstance(data.attrs.get(name), str):
            yield f"its attribute {name} is missing, or no text"
    if data.attrs.get("energy") not in ENERGIES:
        yield f"its strain energy is {data.attrs.get('energy')!r:.40}, known are {', '.join(ENERGIES)}"
    for name, allowed in zip(ATTRIBUTES.values(), (FIBER_PLACES, WALL_MODELS, FIBERS)):
        if (found := data.attrs.get(name, allowed[0])) not in allowed:
            yield f"its attribute {name} is {found!r:.40}, known are {', '.join(allowed)}"
    for name, least in (("accuracy", None), ("interpolation_tolerance", 1.0)):
        number = data.attrs.get(name, least)
        if not (np.isscalar(number) and np.isreal(number) and np.isfinite(number) and number > 0.0):
            yield f"its attribute {name} is missing, or no positive number"
    owners = [("the file", data.attrs), *((name, variable.attrs) for name, variable in data.variables.items())]
    for owner, attrs in owners:
        for name, text in attrs.items():
            plain = "".join(text.split()) if isinstance(text, str) and name in SEVERAL_LINES else text
            if not name.isprintable() or (isinstance(text, str) and not plain.replace(" ", "").isprintable()):
                yield f"attribute {name!r:.60} of {owner!r:.60} has characters that cannot be printed"


def _of_axes(data):
    for name in data.sizes:
        if name not in ORDER:
            yield f"its dimension {name!r:.60} is no axis of an atlas"
        elif name not in data.coords or data[name].dims != (name,):
            yield f"its axis {name} has no values"
    names = {*data.coords}
    for name in ALWAYS:
        if name not in names and f"profile_{name}" not in data.attrs and data.attrs.get(f"family_{name}") != "none":
            yield f"{name} is missing among its coordinates"
    for name in data.coords:
        if name in ORDER:
            yield from _of_coordinate(name, data[name])
        else:
            yield f"its coordinate {name!r:.60} is unknown to this version"


def _of_coordinate(name, coordinate):
    if coordinate.dims not in ((), (name,), ("design",)):
        yield f"{name} varies along {', '.join(coordinate.dims)}"
    elif coordinate.size > MOST_VALUES:
        yield f"{name} has {coordinate.size:,} values, at most {MOST_VALUES:,} are allowed"
    elif name == "design":
        labels = coordinate.values.tolist()
        if not all(isinstance(label, str) and label.isprintable() for label in labels):
            yield "the names of its designs are no printable texts"
        elif len(set(labels)) < len(labels):
            yield "two of its designs have one name"
    elif coordinate.dtype.kind != "f" or not np.all(np.isfinite(coordinate.values)):
        yield f"{name} has values that are no finite numbers"
    elif coordinate.dims == (name,) and not np.all(np.diff(coordinate.values) > 0.0):
        yield f"the values of {name} do not increase"
    yield from _of_units(name, coordinate)


def _of_units(name, variable):
    wanted = attributes(name).get("units") if name != "design" else None
    if wanted is not None and variable.attrs.get("units") != wanted:
        yield f"{name} is in {variable.attrs.get('units')!r:.40}, in atlases it is in {wanted!r}"
    changed = [key for key in MASKS if key in {*variable.attrs, *variable.encoding} and key != "dtype"]
    if changed or variable.attrs.get("dtype"):
        yield f"{name} has the attribute {(changed or ['dtype'])[0]}, by which readers change numbers"


def _of_variables(data):
    numbers = {*VARIABLES, *(f"{name}_error" for name in VARIABLES)}
    codes = {*STATUS_OF, *FLAG_OF}
    for name in ("status", "locked_status"):
        if name not in data.data_vars:
            yield f"{name} is missing"
    for name, variable in data.data_vars.items():
        if name not in numbers | codes:
            yield f"{name!r:.60} is unknown to this version"
            continue
        if variable.dtype.kind not in ("f" if name in numbers else "iu"):
            yield f"{name} is of type {variable.dtype}"
        if variable.dims != dimensions(name, data):
            wanted = ", ".join(dimensions(name, data))
            yield f"{name} varies along {', '.join(variable.dims) or 'nothing'}; in this atlas it has to along {wanted}"
        if name in VARIABLES and f"{name}_error" not in data.data_vars:
            yield f"{name} has no {name}_error"
        if name in VARIABLES and (judge := status_of(name)) not in data.data_vars:
            yield f"{name} has no {judge}"
        yield from _of_units(name, variable)


def dimensions(name, data) -> tuple:
    """The dimensions that a variable has in an atlas with those axes."""
    dropped = absent(name, "fiber_radius" in data.coords or model_of(data.attrs).fiber_radius != "inner")
    return tuple(each for each in ORDER if each in data.sizes and each not in dropped)


def _of_measurement(data):
    from ..query.calibration import ATTRIBUTE, describe_measured

    if ATTRIBUTE in data.attrs:
        try:
            good = all(line.isprintable() for line in describe_measured(data))
        except Exception:  # whatever a text of a stranger makes of it
            good = False
        if not good:
            yield f"its attribute {ATTRIBUTE} is not what an atlas measures of itself"


def _of_codes(data):
    """Labels outside their tables, as far as they are read when an atlas is opened."""
    return [fault for fault, _ in zip(faulty_codes(data, MOST_CODES), range(10))]


def faulty_codes(data, most):
    """Variables with labels outside their tables, one sentence each; ``most`` numbers are read of all together."""
    for name in (name for name in (*STATUS_OF, *FLAG_OF) if name in data.data_vars):
        variable, known = data[name], attributes(name)["flag_values"]
        rows = max(1, READ_AT_ONCE * len(variable) // variable.size) if variable.ndim else 1
        for k in range(0, len(variable) if variable.ndim else 1, rows):
            if most <= 0:
                return
            part = (variable[k : k + rows] if variable.ndim else variable).values
            most -= part.size
            if part.min() < min(known) or part.max() > max(known):
                yield f"{name} has labels outside its table ({min(known)} to {max(known)}): {part.min()} to {part.max()}"
                break

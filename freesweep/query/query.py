"""What an atlas answers at any point: numbers with their stated error, or the status that says why there is none."""

import math
import os
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np

from ..atlas.schema import PARAMETERS, attributes
from ..description.given import described
from ..description.options import read_choice, read_switch
from ..description.tube_model import fiber_surface
from ..report import quantity
from ..status import NOT_INTERPOLABLE, OUTSIDE, status_attributes
from ..thick_wall import DESIGN, NOTES, attributes_of
from . import calibration
from .answer import CUBIC, LINEAR, Inquiry
from .box import Parts
from .family import FAMILIES, FAMILY_OF, IDEAL, TABLE_OF
from .faults import QueryError, unknown
from .grid_axes import Frame
from .ideal import ideal_answer
from .question import read_question
from .similar import SIZES, similar_names
from .table import Table

STATUSES_OF_ANSWERS = {  # that no atlas holds
    "limit_pressure_status": "status of the limit pressure",
    "tension_status": "status of the least tensions",
    "slack_status": "status of the slack shares",
    "locked_slack_status": "status of the slack shares, locked",
    "blocked_force_slack_status": "status of the slack shares, length held",
    "blocked_torque_slack_status": "status of the slack shares, rotation held",
}
CHUNK = 1 << 18  # points answered together: their arrays fit in memory, and many share a cell
ALONE = 1 << 14  # points for which a second thread is not worth its start
NEAR = 1e-12  # relative: what counts as the end of an axis
CURVE = 201  # points of a curve


class Reader:
    """An atlas ready for questions: its tables, made when first needed and kept."""

    def __init__(self, data):
        self.data, self.frame = data, Frame(data)
        self.tolerance = calibration.tolerance(data)
        self.names = [name for name in data.data_vars if name in FAMILY_OF or name in IDEAL]
        self._tables, self._factors, self._attributes = {}, {}, {}

    def table(self, key, values=None) -> Table:
        """The table of a family of variables; with ``values`` (axis -> (n,)) one that serves to answer at them."""
        key = TABLE_OF.get(key, key)
        if key not in self._tables:
            names = self.frame.axes_of(FAMILIES[key].variables)
            whole = SIZES if similar_names(self.frame, FAMILIES[key]) else ()
            self._tables[key] = Parts(lambda box: Table(self.data, self.frame, key, box), self.frame, names, whole)
        return self._tables[key].table(values)

    def factors(self, name) -> calibration.Factors:
        """What was measured of one variable's stated errors."""
        if name not in self._factors:
            names = list(self.frame.axes_of(FAMILIES[FAMILY_OF[name]].variables))
            padding = max(0, 2 - sum(axis != "design" for axis in names))  # axes of the kernels' own
            nodes = math.prod(len(self.frame.values[axis]) for axis in names) << padding
            self._factors[name] = calibration.factors(self.data, name, names + [""] * padding, nodes)
        return self._factors[name]

    def attributes(self, name) -> dict:
        """CF attributes of a variable of an answer."""
        if name not in self._attributes:
            if name in STATUSES_OF_ANSWERS:
                self._attributes[name] = {"long_name": STATUSES_OF_ANSWERS[name], **status_attributes()}
            else:
                self._attributes[name] = attributes(name)
        return self._attributes[name]

    def needed(self, names) -> list:
        """Axes that must be given for some variables."""
        dims = dict.fromkeys(dim for name in names for dim in self.frame.dims[name])
        order = [dim for dim in self.frame.sizes if dim in dims]
        return [name for name in order if len(self.frame.values[name]) > 1]

    def complete(self, values, size) -> dict:
        """``values`` of a question with what the atlas fixes added, axis -> (n,)."""
        full = dict(values)
        for name in self.frame.asked:
            if name not in full and len(self.frame.values[name]) == 1:
                only = 0.0 if name == "design" else float(self.frame.values[name][0])
                full[name] = np.full(size, only)
        return full

    def answer(self, values, size, names, method=CUBIC, tolerance=None, coarse=None, sure=True) -> dict:
        """Name -> (n,) of numbers, errors, statuses and flags; ``values``: axis -> (n,).

        ``coarse``, a list, gets the axes whose nodes lie too far apart for the tolerance: names, and at how many points.
        ``sure``: refuse where it is too close to say whether fibers are slack; pictures take them for taut.
        """
        values = self.complete(values, size)
        tolerance = self.tolerance if tolerance is None else tolerance
        found = {}
        for key in FAMILIES:
            own = [name for name in names if FAMILY_OF.get(name) == key]
            if own:
                found |= self._in_chunks(
                    key, self.table(key, values), values, size, own, method, tolerance, coarse, sure
                )
        for name in names:
            if name in IDEAL:
                found |= ideal_answer(self.frame, name, values)
        return found

    def _in_chunks(self, key, table, values, size, names, method, tolerance, coarse, sure):
        bounds = [*range(0, size, CHUNK), size]
        if ALONE < size <= CHUNK:
            bounds = [0, size // 2, size]
        parts = list(pairwise(bounds)) or [(0, 0)]

        def one(part):
            own = {name: values[name][slice(*part)] for name in table.known}
            return self._answer_chunk(key, table, own, names, method, tolerance, coarse, sure)

        if len(parts) == 1:
            return one(parts[0])
        table.make((*names, *(("mid_radius",) if table.has_slack else ())))  # here, not by the threads of the parts
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            answers = list(pool.map(one, parts))
        return {name: np.concatenate([answer[name] for answer in answers]) for name in answers[0]}

    @np.errstate(all="ignore")  # whatever a file holds: what is no number is refused
    def _answer_chunk(self, key, table, values, names, method, tolerance, coarse, sure):
        inquiry = Inquiry(table, values, method)
        flags = inquiry.flags(sure)
        found, too_large = {}, np.zeros(inquiry.size, bool)
        for name in names:
            value, error = inquiry.answer(name, self.factors)
            exceeds = inquiry.exceeds(name, value, error, tolerance)
            if table.family.status is None:  # that there is no limit pressure is an answer, too
                exceeds &= inquiry.codes != 0
            if coarse is not None:
                inquiry.blame(name, exceeds & ~too_large & inquiry.valued, self.factors(name).scales, coarse)
            too_large |= exceeds
            found[name], found[f"{name}_error"] = value, error
        status = inquiry.status.astype(np.int8)
        valued = inquiry.valued
        status[valued & too_large] = NOT_INTERPOLABLE
        valued &= ~too_large
        for name in found:
            found[name] = np.where(valued, found[name], np.nan)
        for name, flag in flags.items() if key not in TABLE_OF else ():
            found[name] = np.where(valued, flag, 0).astype(np.int8)
        found[FAMILIES[key].answer_status] = status
        return found


def check_names(reader, variables) -> list:
    """The variables of a question; raises :class:`QueryError`."""
    if variables is None:
        return list(reader.names)
    try:
        names = list(dict.fromkeys([variables] if isinstance(variables, str) else variables))
    except Exception:  # no list, or of what has no hash
        raise QueryError([f"variables: found {described(variables)}; give a name or a list of names"]) from None
    faults = [unknown("variable", name, reader.names) for name in names if name not in reader.names]
    if faults or not names:
        raise QueryError(faults or [f"variables: found none; known: {', '.join(reader.names)}"])
    return names


def query(reader, axes, variables=None, method=CUBIC, refine=False, x=None):
    """The Dataset that answers keywords ``axes``: see :meth:`freesweep.Atlas.query`."""
    import xarray as xr

    names = check_names(reader, variables)
    faults = []
    read_choice("method", method, (CUBIC, LINEAR), faults)
    if read_switch("refine", refine, faults) is False and x is not None:
        faults.append("x: an atlas stores no profiles along the tube; refine=True solves for them")
    if faults:
        raise QueryError(faults)
    question = read_question(axes, reader.frame, reader.needed(names))
    coarse = []
    found = reader.answer(question.values, question.size, names, method, coarse=coarse)
    _refuse_single(reader, question, found)
    if refine:
        from .refine import refine_answers

        refine_answers(reader, question, names, found)
    dataset = {
        name: xr.Variable(question.dims, array.reshape(question.shape), reader.attributes(name), fastpath=True)
        for name, array in found.items()
    }
    attrs = {"title": reader.frame.title, "method": method}
    if coarse and not refine:
        counts = Counter()
        for name, count in coarse:
            counts[name] += count
        attrs["too_coarse"] = ", ".join(f"{name} ({count:,})" for name, count in counts.most_common())
    result = xr.Dataset(dataset, _coordinates(reader, question, axes), attrs | _of_thick_walls(reader, question))
    if x is not None:
        from .refine import profiles

        result = xr.merge([result, profiles(reader, question, x)])
    return result


def _of_thick_walls(reader, question):
    """Attributes of an answer for tubes with thick walls."""
    frame, values = reader.frame, reader.complete(question.values, question.size)
    for name in frame.by_design:
        values[name] = frame.values[name][values["design"].astype(int)] if "design" in values else frame.values[name]
    if frame.model.is_thick:
        return {}
    if not frame.uniform_along_x:
        return {key: reader.data.attrs[key] for key in NOTES if key in reader.data.attrs}
    if any(name not in values for name in DESIGN if name in frame.values):
        return {}  # what was asked for does not depend on all of them: the wall is not felt
    values["fiber_radius"] = fiber_surface(values, frame.model)
    return attributes_of(*(values[name] for name in DESIGN), frame.energy)


def curve(reader, along, values, rest):
    """The answers along one axis: see :meth:`freesweep.Atlas.curve`."""
    axes = [name for name in reader.frame.asked if name in reader.frame.ranges]
    if not isinstance(along, str) or along not in reader.frame.ranges or along in reader.frame.by_design:
        raise QueryError([unknown("axis", along, axes)])
    if along in rest:
        raise QueryError([f"{along}: given as a number, too; the curve runs along it"])
    if values is None:
        low, high = reader.frame.ranges[along]
        if not low < high:
            only = quantity(low, PARAMETERS[along].units)
            raise QueryError([f"{along}: the atlas holds only {only}; a curve needs an axis of several values"])
        root = along == "pressure" and low >= 0.0
        values = np.linspace(np.sqrt(low), np.sqrt(high), CURVE) ** 2 if root else np.linspace(low, high, CURVE)
        values[-1] = high
    options = {name: rest[name] for name in ("variables", "method", "refine", "x") if name in rest}
    axes = {name: value for name, value in rest.items() if name not in options}
    return query(reader, {**axes, along: values}, **options)


def _coordinates(reader, question, axes):
    import xarray as xr

    coordinates = {}
    for name, (dims, array) in question.coordinates.items():
        if name == "design":
            array = reader.frame.values["design"][array.astype(int)]
        coordinates[name] = xr.Variable(dims, array, reader.frame.attributes[name], fastpath=True)
    for value in axes.values():  # a DataArray brings the coordinates of its dimensions
        if isinstance(value, xr.DataArray):
            for dim in value.dims:
                if dim in value.coords and dim not in question.coordinates:
                    own = value.coords[dim].variable
                    if not coordinates.setdefault(dim, own).equals(own):
                        raise QueryError([f"{dim}: two arrays have other coordinates along it; align them first"])
    return coordinates


def _refuse_single(reader, question, found):
    """A single number beyond the grid is an error that names the nearest bound: the whole answer would be empty."""
    faults, angles, ranges = [], ("alpha", "beta"), reader.frame.ranges
    given = {name: question.coordinates[name][1].item() for name in sorted(question.single - {"design"})}
    for name, value in given.items():
        low, high = ranges[name]
        slack = NEAR * max(abs(low), abs(high))
        if not np.isfinite(value):
            faults.append(f"{name}: found {value}; give a finite number in [{PARAMETERS[name].units}]")
        elif name not in angles and not low - slack <= value <= high + slack:
            asked, first, last = (question.shown(name, one) for one in (value, low, high))
            nearest = first if value < low else last
            span = f"only {first}" if low == high else f"{first} to {last}, the nearest is {nearest}"
            faults.append(f"{name}: found {asked}; the atlas holds {span}")
    statuses = [array for name, array in found.items() if name.endswith("status")]
    alone = question.single == set(question.values) and {*angles} <= given.keys()
    if alone and not faults and any(array[0] == OUTSIDE for array in statuses):
        at = ", ".join(question.shown(name, given[name]) for name in angles)
        held = "; ".join(f"{name} {' to '.join(question.shown(name, end) for end in ranges[name])}" for name in angles)
        faults.append(
            f"alpha, beta: found {at}; the atlas holds {held}, and neither the exchange of the fiber families nor the"
            " mirror brings the point there"
        )
    if faults:
        raise QueryError(faults)

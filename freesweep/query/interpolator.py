"""A bare callable for loops and optimizers: arrays in, arrays out, gradients on request."""

import operator
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atlas.schema import EXCHANGED, PARAMETERS, SHAPE
from ..description.given import numbers
from ..description.options import read_switch
from ..description.quantities import Quantities
from ..status import INACCURATE, NOT_INTERPOLABLE, OK
from . import reference
from .answer import Inquiry
from .axis import LABEL
from .family import FAMILY_OF, MIRRORED, TOLD, TOLD_FROM
from .faults import QueryError
from .query import check_names
from .similar import SIZES

if TYPE_CHECKING:
    from ..atlas.store import Atlas

CHUNK = 1 << 18  # points answered together: their arrays stay small
STEP = 1e-6  # relative, of central differences of the closed forms (their errors are some 1e-10)


class Interpolator:
    """``f(*values, gradient=False)``: values of ``names`` at numbers or arrays given in the order of ``f.axes``.

    Plain arrays broadcast as in NumPy. Returns an array, shape of the broadcast input, with one axis for the names in front
    unless a single name was asked for. With ``gradient=True`` a pair: values, and derivatives by each of ``f.axes``, which
    make the first axis after that of the names. NaN where :meth:`freesweep.Atlas.query` would give no number. Pickled, it is
    the path of its atlas and the names.
    """

    def __init__(self, atlas: "Atlas", names: str | Sequence[str]) -> None:
        self.atlas, reader = atlas, atlas._reader
        self.single = isinstance(names, str)
        self.names: list[str] = check_names(reader, names)
        wrong = [name for name in self.names if name not in FAMILY_OF]
        if wrong:
            raise QueryError([f"variable {name!r} is a formula: see freesweep.closed_form" for name in wrong])
        self.axes: tuple[str, ...] = tuple(name for name in reader.needed(self.names) if name != "design")
        if "design" in reader.frame.values:
            raise QueryError(["a list of named designs is no grid; use query(design=...)"])
        self.reader = reader
        self._families = {}
        for k, name in enumerate(self.names):
            self._families.setdefault(FAMILY_OF[name], []).append((k, name))
        self._fixed = {
            name: array for name, array in reader.frame.values.items() if name not in self.axes and len(array) == 1
        }

    def __repr__(self):
        return f"<Interpolator of {', '.join(self.names)} over {', '.join(self.axes)}>"

    def __reduce__(self):
        return operator.methodcaller("interpolator", self.names[0] if self.single else self.names), (self.atlas,)

    def __call__(self, *values: Quantities, gradient: bool = False) -> Any:
        """Values, and with ``gradient`` their derivatives; raises :class:`QueryError`."""
        if len(values) != len(self.axes):
            raise QueryError([f"found {len(values)} values; give {len(self.axes)}: {', '.join(self.axes)}"])
        faults = []
        if (gradient := read_switch("gradient", gradient, faults)) is None:
            raise QueryError(faults)
        try:
            read = [numbers(value, PARAMETERS[name].units) for name, value in zip(self.axes, values)]
            arrays = np.broadcast_arrays(*read)
        except ValueError as error:
            raise QueryError([f"{', '.join(self.axes)}: {error}"]) from None
        shape = arrays[0].shape
        flat = {name: np.ascontiguousarray(array).ravel() for name, array in zip(self.axes, arrays)}
        size = arrays[0].size
        for name, array in self._fixed.items():
            flat[name] = np.full(size, array[0])
        found = np.empty((len(self.names), size))
        slopes = np.zeros((len(self.names), len(self.axes), size)) if gradient else None
        for key, own in self._families.items():
            table = self.reader.table(key)
            for begin in range(0, size, CHUNK):
                some = slice(begin, begin + CHUNK)
                part = {name: flat[name][some] for name in table.known}
                self._answer(table, part, own, found[:, some], slopes[..., some] if gradient else None)
        found = found.reshape(len(self.names), *shape)
        result = (found, slopes.reshape(len(self.names), len(self.axes), *shape)) if gradient else (found,)
        result = tuple(array[0] for array in result) if self.single else result
        return result if gradient else result[0]

    @np.errstate(all="ignore")  # whatever a file holds: what is no number is refused
    def _answer(self, table, flat, own, found, slopes):
        inquiry = Inquiry(table, flat)
        too_large = np.zeros(inquiry.size, bool)
        for k, name in own:
            value, error = inquiry.answer(name, self.reader.factors)
            too_large |= inquiry.exceeds(name, value, error, self.reader.tolerance)
            found[k] = value
            if slopes is not None:
                slopes[k] = self._gradient(inquiry, name)
                if name in EXCHANGED:
                    exchanged = inquiry.marks[:, 5] == 1
                    slopes[k] = np.where(exchanged, self._gradient(inquiry, EXCHANGED[name]), slopes[k])
        status = np.where(too_large, NOT_INTERPOLABLE, inquiry.status)
        lost = (status != OK) & (status != INACCURATE)
        for k, _ in own:
            found[k, lost] = np.nan
            if slopes is not None:
                slopes[k][:, lost] = np.nan

    def _gradient(self, inquiry, name):
        """Derivatives (axes, n) of one variable by the axes as they were asked."""
        table, family = inquiry.table, inquiry.table.family
        at = inquiry.of(name)
        effects = at.effects(name, inquiry.orders())
        value = np.empty((3, inquiry.size))
        _restore(table, name, inquiry.points, inquiry.states, effects, value)
        slopes = np.zeros((len(self.axes), inquiry.size))
        exchanged, mirrored = inquiry.marks[:, 5] == 1, inquiry.marks[:, 6] == 1
        for axis, own in zip(table.axes, table.names):
            if axis.kind == LABEL:
                continue
            column = reference.COLUMNS.index(own if own in reference.COLUMNS else "held")
            steps = STEP * (np.abs(inquiry.points[:, column]) + (1.0 if own in SHAPE else STEP))
            # the closed form moves with the point, the end effect along its own cubic
            rate = self._rate(at, name, axis, own, column)
            ends = []
            for sign in (-1.0, 1.0):
                points = inquiry.points.copy()
                points[:, column] += sign * steps
                if own in ("radius", "wall") and table.fixed.fiber_share >= 0.0:
                    share = 1.0 if own == "radius" else table.fixed.fiber_share
                    points[:, reference.FIBERS] += share * sign * steps
                states = table.predictor.states(family.kind, points)
                end = np.empty((3, inquiry.size))
                _restore(table, name, points, states, effects + sign * steps * rate, end)
                ends.append(end[0])
            slope = (ends[1] - ends[0]) / (2.0 * steps)
            if own in ("torque", "held_rotation", "alpha", "beta"):
                slope = np.where(mirrored, -slope, slope)
            if name in MIRRORED:
                slope = np.where(mirrored, -slope, slope)
            other = {"alpha": "beta", "beta": "alpha"}.get(own)
            straight = ~exchanged if other in self.axes else np.ones(inquiry.size, bool)
            slopes[self.axes.index(own), straight] += slope[straight]
            if other in self.axes:
                slopes[self.axes.index(other), exchanged] += slope[exchanged]
        return slopes

    def _rate(self, at, name, axis, own, column):
        """By how much end effects change with one axis (n,)."""
        table, points = at.table, at.points
        if name not in table.similar or own not in SIZES:
            return at.effects(name, at.orders(table.names.index(own))) * axis.rate(points[:, column])
        # of similar tubes the length over the radius counts: both change its logarithm, and that axis is in logarithms
        by_length = at.effects(name, at.orders(table.names.index("length")))
        if own == "length":
            return by_length / points[:, reference.LENGTH]
        return -by_length / points[:, reference.FIBERS]


def _restore(table, name, points, states, effects, out):
    """Values at end effects (n,) into ``out[0]``."""
    nothing = np.zeros(len(effects))
    args = (effects, nothing, nothing, out[0], out[1], out[2])
    table.predictor.restore(table.family.variables[TOLD_FROM.get(name, name)], points, states, *args)
    if name in TOLD_FROM:
        out[0] = table.predictor.worst_places(points, out[0], nothing, nothing)[0][list(TOLD).index(name)]

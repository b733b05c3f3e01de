"""A family of stored variables in memory, ready to be interpolated: end effects, their slopes, the codes of the cells."""

import functools
from concurrent.futures import ThreadPoolExecutor
from threading import Lock
from typing import NamedTuple

import numpy as np

from ..description.families import A_POINT
from ..status import INACCURATE, OK
from . import reference
from .axis import LABEL, make_axis, part_of
from .calibration import ranks
from .cells import Cells
from .family import SLACK_FLAGS, TOLD_FROM, family_of
from .grid import GridPoints, GridStates, Stored
from .locate import Nodes
from .missing_nodes import cell_codes, fill, weights_beyond
from .part import Part
from .placing import HELD_NAMES, packed, placing, whole_axes
from .predictor import Predictor
from .reference import COLUMNS
from .similar import similar_names
from .slopes import tabulate
from .spline import NODE, PLACE

TOGETHER, MUCH = 2, 5_000_000  # variables at a time, in atlases of up to so many nodes: their tables need memory


class Interpolant(NamedTuple):
    """End effects of one variable: ``values`` and slopes (NODE nodes,), and what is known of each cell."""

    values: np.ndarray
    cells: Cells


class Table:
    """One family of an atlas over the axes it varies in.

    ``names`` are those axes, ``known`` all that the family depends on, fixed values among them. The kernels see two axes of
    their own where there are fewer. Arrays of variables are made when they are first asked for. With a ``box`` (axis ->
    (first node, last + 1)) the table is that part of the grid, and only it is read.
    """

    def __init__(self, data, frame, key, box=None):
        self.frame = frame
        self.family = family_of(key, frame.bodies is not None)
        self.predictor = Predictor(frame.model, frame.energy, frame.bodies, frame.families)
        self.names = frame.axes_of(self.family.variables)
        self.similar = similar_names(frame, self.family)
        self.box = {name: (box or {}).get(name, (0, len(frame.values[name]))) for name in self.names}
        whole = whole_axes(frame, self.names, self.family.kind)
        self.ranks = [ranks(len(axis.nodes))[slice(*self.box[axis.name])] for axis in whole]
        self.axes = [part_of(axis, *self.box[axis.name]) for axis in whole]
        self.padding = max(0, 2 - sum(axis.kind != LABEL for axis in self.axes))
        none = [make_axis(f"none {k}", [0.0, 1.0]) for k in range(self.padding)]
        self.axes, self.ranks = self.axes + none, self.ranks + [ranks(len(axis.nodes)) for axis in none]
        self.shape = np.array([len(axis.nodes) for axis in self.axes], np.int64)
        self.strides = np.array([int(np.prod(self.shape[k + 1 :])) for k in range(len(self.shape))], np.int64)
        self.size = int(np.prod(self.shape))
        self.part = Part(data, self.names, self.box, self.shape)
        self.labels = np.array([axis.kind == LABEL for axis in self.axes])
        self.knots, self.windows, self.coordinates = packed(self.axes, self.ranks)
        self.known, self.columns, self.fixed, self.nearest = placing(frame, self.family, self.names)
        self._variables, self._spare, self._states, self._taut = {}, [], None, None
        self._making = {}  # locks of what one thread makes and others may ask for meanwhile
        self.has_flag = self.family.flag in frame.dims
        self.has_slack = key == "state" and "slack_fiber" in frame.dims
        self.tells_slack = reference.SLACK_ALPHA in self.family.variables.values()
        slack = self.part.grid("slack_fiber").astype(np.uint8) << 4 if self.has_slack else np.zeros(self.size, np.uint8)
        self.is_kinked = self.has_slack and self.predictor.is_physical  # numbers have kinks where slack begins or ends
        # of held loose tubes there is no closed form, nor of where held ones are slack
        held = self.family.kind in HELD_NAMES.values()
        self.is_untold = held and (frame.model.is_loose or self.tells_slack)
        self.codes = np.stack([self._codes(), self._beyond_rest(slack) if self.is_kinked else slack])
        self.cells = np.stack([cell_codes(codes, self.shape, self.labels) for codes in self.codes])

    @property
    def nodes(self) -> Nodes:
        """Its nodes, as :func:`.locate.place` takes them."""
        return Nodes(self.knots, self.shape, self.coordinates, self.strides, self.codes, self.cells)

    @functools.cached_property
    def _nodes(self):
        """Nodes of the axes (d, n)."""
        return self.knots[:, :, PLACE].copy()

    @functools.cached_property
    def _beyond(self):
        """What numbers are put in with beyond the last of those that there are."""
        return weights_beyond(self._nodes, self.shape)

    def _codes(self):
        """Status of each node in the low half of a byte, above it the flag that nodes must share to be mixed."""
        status, flag = self.family.status, self.family.flag
        codes = np.zeros(self.size, np.uint8)
        if status:
            codes |= self.part.grid(status).astype(np.uint8)
        if self.has_flag:
            codes |= self.part.grid(flag).astype(np.uint8) << 4
        if self.tells_slack:  # a share is never interpolated from where something is slack to where nothing is
            flags = self._taut_nodes()
            for name, variable in self.family.variables.items():
                flags = flags | (self.part.grid(name) > A_POINT) * np.uint8(SLACK_FLAGS[variable])
            codes |= self._beyond_rest(flags) << 4
        return codes

    def _beyond_rest(self, slack):
        """Flags of slack fibers, at rest those of the least pressure: what is stored there is that nothing pulls."""
        alone = all(not np.any(self.frame.values.get(name, 0.0)) for name in ("force", "torque"))
        if not alone or np.any(self.frame.values.get("fiber_extension", 1.0) != 1.0) or "pressure" not in self.names:
            return slack
        a = self.names.index("pressure")
        if self.axes[a].values[0] != 0.0 or len(self.axes[a].values) == 1:
            return slack
        grid = slack.reshape(self.shape).copy()
        along = np.moveaxis(grid, a, 0)
        along[0] = along[1]
        return grid.ravel()

    def is_number(self, codes):
        """Where codes stand for nodes that hold numbers."""
        if self.family.status is None:
            return codes >> 4 == 1
        return (codes & 15 == OK) | (codes & 15 == INACCURATE)

    def forget(self, name):
        """Let go of the arrays of one variable, of which the largest are used again."""
        for side in self.sides:
            if gone := self._variables.pop((name, side), None):
                self._spare.append(gone.values)
        self.part.forget(name)

    def release(self):
        """Let go of the arrays of all variables."""
        self._variables.clear()
        self._spare.clear()
        self.part.forget()

    def variable(self, name, side) -> Interpolant:
        """One variable, or the one that it is told from, on one of the ``sides`` of where loose fibers go slack."""
        key = TOLD_FROM.get(name, name), side
        with self._making.setdefault(key, Lock()):
            if key not in self._variables:
                self._variables[key] = self._interpolant(*key)
            return self._variables[key]

    def make(self, names):
        """Make what :meth:`variable` tells of several, on all sides, some at a time."""
        each = [
            (one, side) for one in dict.fromkeys(TOLD_FROM.get(name, name) for name in names) for side in self.sides
        ]
        left = [key for key in each if key not in self._variables]
        if len(left) > 1 and self.family.kind != reference.NONE:  # what all of them share is made once
            self.states()
        with ThreadPoolExecutor(self.together) as pool:
            list(pool.map(lambda key: self.variable(*key), left))

    @property
    def together(self):
        """How many variables are made at a time."""
        return TOGETHER if self.size * len(self.sides) <= MUCH else 1

    @np.errstate(all="ignore")  # whatever a file holds
    def _interpolant(self, name, side):
        effects, noise = self._end_effects(name)
        if len(self.sides) > 1:
            effects[self._sides_of_nodes() != side] = np.nan
        holes = np.flatnonzero(~np.isfinite(effects))
        doubt = fill(effects, self.shape, self.strides, self._nodes, self._beyond)
        doubt[holes], noise[holes] = np.maximum(doubt[holes], np.finfo(np.float32).tiny), 0.0
        table = self._spare.pop() if self._spare else np.empty(NODE * self.size)
        tabulate(effects, self.knots, self.windows, self.shape, table)
        return Interpolant(table, Cells(effects, noise, doubt, self.axes, self.knots))

    def states(self) -> GridStates:
        """Uniform states of the grid."""
        with self._making.setdefault("states", Lock()):
            if self._states is None:
                of_tubes = self.family.kind in (reference.LOADED, reference.LOCKED) and self.predictor.bodies is None
                without = ("length",) if of_tubes else ()
                self._states = GridStates(self._points(), self.family.kind, self.predictor, without)
            return self._states

    @functools.cached_property
    def sides(self) -> list:
        """Which families pull in the middle of a long tube, all such codes (as :data:`reference.TAUT`) that there are: where
        it changes, what the ends add has a kink, and nodes on one side say nothing of the other. ``[None]``: no kinks.
        """
        if not self.frame.model.is_loose or self.family.kind != reference.LOADED:
            return [None]
        found = np.unique(self._sides_of_nodes()).tolist()
        return found if len(found) > 1 else [None]

    def side_of(self, states) -> np.ndarray:
        """Which of the ``sides`` points with such uniform states (n, UNIFORM) lie on, (n,)."""
        return np.nan_to_num(states[:, reference.TAUT], nan=3.0).astype(np.uint8)

    def _sides_of_nodes(self):
        return self._beyond_rest(self._taut_nodes())

    def _taut_nodes(self):
        """Which fibers pull in the middle of long tubes (nodes,)."""
        if self._taut is None:
            slabs = range(self.size // int(self.strides[0]))
            self._taut = np.concatenate([self.side_of(self.states().slab(k)) for k in slabs])
        return self._taut

    def _end_effects(self, name):
        """End effects of the stored numbers and their bounds, (nodes,)."""
        stored, errors = self.part.grid(name), self.part.bounds(name)
        if self.family.kind == reference.NONE:
            return np.where(self.is_number(self.codes[0]), stored, np.nan), errors.astype(np.float32)
        effects, noise = np.empty(len(stored)), np.empty(len(stored), np.float32)
        variable, kind = self.family.variables[name], self.family.kind
        terms = np.empty((0, 3))
        if self.predictor.bodies is not None:
            points = self._points().slabs()
            slabs = [self.predictor.terms(variable, some, self.states().slab(k)) for k, some in enumerate(points)]
            terms = np.concatenate(slabs)
        good = self.is_number(self.codes[0])
        # a design of one angle has one family where others have two: what ends add to it says nothing of those beside it
        apart = not {"alpha", "beta"}.isdisjoint(self.names)
        self.states().end_effects(variable, kind, Stored(stored, errors, good, terms), apart, effects, noise)
        return effects, noise

    def _points(self):
        names = ["held" if axis.name in HELD_NAMES else axis.name for axis in self.axes]
        columns = [COLUMNS.index(name) if name in COLUMNS else -1 for name in names]
        return GridPoints(self.axes, columns, self.fixed)

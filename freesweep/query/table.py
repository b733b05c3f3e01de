"""A family of stored variables in memory, ready to be interpolated: end effects, their slopes, the codes of the cells."""

from typing import NamedTuple

import numpy as np

from ..atlas.schema import VARIABLES
from ..status import INACCURATE, OK
from . import reference
from .axis import LABEL, WINDOW, make_axis
from .family import FAMILIES
from .frame import DEFAULTS
from .holes import cell_codes, fill, roughness, slopes, worst_noise
from .reference import COLUMNS, UNIFORM, end_effects, uniform_states

HELD_NAMES = {"held_length": reference.LENGTH_HELD, "held_length_ratio": reference.LENGTH_HELD}
HELD_NAMES |= {"held_rotation": reference.ROTATION_HELD}
TURNED = ("torque", "held_rotation")  # turn round with both angles


class Interpolant(NamedTuple):
    """End effects of one variable: values and slopes (4 nodes,); of each cell bound (nodes,) and roughness (nodes, d)."""

    values: np.ndarray
    noise: np.ndarray
    roughness: np.ndarray


class Table:
    """One family of an atlas over the axes it varies in.

    ``names`` are those axes, ``known`` all that the family depends on, fixed values among them. The kernels see two axes of
    their own where there are fewer. Arrays of variables are made when they are first asked for.
    """

    def __init__(self, data, frame, key):
        self.data, self.frame = data, frame
        self.family = FAMILIES[key]
        some = next(name for name in self.family.variables if name in frame.dims)
        self.names = tuple(name for name in frame.dims[some] if frame.varies(name))
        self.axes = [make_axis(name, frame.values[name]) for name in self.names]
        self.padding = max(0, 2 - sum(axis.kind != LABEL for axis in self.axes))
        self.axes += [make_axis(f"none {k}", [0.0, 1.0]) for k in range(self.padding)]
        self.shape = np.array([len(axis.nodes) for axis in self.axes], np.int64)
        self.strides = np.array([int(np.prod(self.shape[k + 1 :])) for k in range(len(self.shape))], np.int64)
        self.labels = np.array([axis.kind == LABEL for axis in self.axes])
        self.packed = self._packed()
        self._place()
        self.has_flag = self.family.flag in frame.dims
        self.codes, self.cells = self._cells(self._codes())
        self.slack = self.slack_cells = np.empty(0, np.uint8)
        if key == "state" and "slack_fiber" in frame.dims:
            self.slack, self.slack_cells = self._cells(self._grid("slack_fiber").astype(np.uint8) << 4)
        self._variables, self._stored, self._errors = {}, {}, {}

    def _place(self):
        """What :func:`place` has to know of the columns of a question."""
        frame, kind = self.frame, self.family.kind
        without = VARIABLES[next(iter(self.family.variables))].without
        self.known = [
            name for name in frame.asked
            if name in self.names or (name not in without and name != "design" and HELD_NAMES.get(name, kind) == kind)
        ]  # fmt: skip
        self.kinds, self.bounds = np.empty((len(self.known), 3), np.int64), np.empty((len(self.known), 2))
        for j, name in enumerate(self.known):
            column = -1 if name == "design" else COLUMNS.index("held" if name in HELD_NAMES else name)
            axis = self.names.index(name) if name in self.names else -1
            self.kinds[j] = column, axis, name in TURNED
            self.bounds[j] = frame.ranges.get(name, (0.0, 0.0))
        designs = len(frame.values["design"]) if "design" in frame.values else 1
        self.fixed = np.full((designs, len(COLUMNS)), np.nan)
        for column, name in enumerate(COLUMNS):
            if name in frame.values:
                array = frame.values[name]
                self.fixed[:, column] = array if name in frame.by_design else array[0]
            elif name in DEFAULTS:
                self.fixed[:, column] = DEFAULTS[name]
        self.fixed[:, reference.HELD] = 1.0 if kind == reference.LENGTH_HELD else 0.0
        shear = 0.0 if frame.energy == "principal" else 1.0
        by_length = kind == reference.LENGTH_HELD and "held_length" in frame.values
        inner = "fiber_radius" not in frame.values
        self.options = (kind, shear, inner, by_length, self.family.status is not None)

    def _packed(self):
        count, most = len(self.axes), max(len(axis.nodes) for axis in self.axes)
        nodes, first = np.zeros((count, most)), np.zeros((count, most), np.int64)
        left, right, remainder = np.zeros((3, count, most, WINDOW))
        for a, axis in enumerate(self.axes):
            own = slice(0, len(axis.nodes))
            nodes[a, own], first[a, own] = axis.nodes, axis.first
            left[a, own], right[a, own], remainder[a, own] = axis.left, axis.right, axis.remainder
        windows = np.array([axis.window for axis in self.axes], np.int64)
        kinds = np.array([axis.kind for axis in self.axes], np.int64)
        return nodes, self.shape, windows, kinds, first, left, right, remainder

    def _grid(self, name):
        """A stored variable over the axes of the table (nodes,), the kernels' own axes among them."""
        variable = self.data[name]
        array = np.asarray(variable.isel({d: 0 for d in variable.dims if d not in self.names}).values)
        array = np.broadcast_to(array.reshape(array.shape + (1,) * self.padding), self.shape)
        return np.ascontiguousarray(array).ravel()

    def _cells(self, codes):
        cells = np.empty_like(codes)
        cell_codes(codes, self.shape, self.strides, self.labels, cells)
        return codes, cells

    def _codes(self):
        """Status of each node in the low half of a byte, above it the flag that nodes must share to be mixed."""
        status, flag = self.family.status, self.family.flag
        codes = np.zeros(int(np.prod(self.shape)), np.uint8)
        if status:
            codes |= self._grid(status).astype(np.uint8)
        if self.has_flag:
            codes |= self._grid(flag).astype(np.uint8) << 4
        return codes

    def is_number(self, codes):
        """Where codes stand for nodes that hold numbers."""
        if self.family.status is None:
            return codes >> 4 == 1
        return (codes & 15 == OK) | (codes & 15 == INACCURATE)

    def stored(self, name):
        """The numbers of the atlas, bit for bit (nodes,)."""
        if name not in self._stored:
            self._stored[name] = self._grid(name)
        return self._stored[name]

    def errors(self, name):
        """The bounds of the atlas (nodes,); zero where it holds none."""
        if name not in self._errors:
            bound = f"{name}_error"
            self._errors[name] = self._grid(bound) if bound in self.frame.dims else np.zeros(int(np.prod(self.shape)))
        return self._errors[name]

    def forget(self, name):
        """Let go of the arrays of one variable."""
        for kept in (self._variables, self._stored, self._errors):
            kept.pop(name, None)

    def variable(self, name):
        """The :class:`Interpolant` of one variable."""
        if name not in self._variables:
            effects, noise = self._end_effects(name)
            nodes = self.packed[0]
            fill(effects, self.shape, self.strides, nodes)
            table = np.empty((len(effects), 4))
            table[:, 0] = effects
            for column, source, axis in ((1, 0, -1), (2, 0, -2), (3, 2, -1)):
                a = len(self.axes) + axis
                own = self.axes[a]
                widths = np.append(np.diff(own.nodes), 1.0)
                out = np.empty(len(effects))
                values = np.ascontiguousarray(table[:, source])
                slopes(values, self.shape, self.strides, a, own.first, own.left, own.right, widths, out)
                table[:, column] = out
            cells = np.empty(len(noise), np.float32)
            worst_noise(noise, self.shape, self.strides, self.labels, cells)
            rough = np.zeros((len(effects), len(self.axes)), np.float32)
            for a, axis in enumerate(self.axes):
                if axis.kind != LABEL:
                    args = (a, axis.first, axis.remainder, rough)
                    roughness(effects, self.shape, self.strides, self.labels, *args)
            self._variables[name] = Interpolant(table.ravel(), cells, rough)
        return self._variables[name]

    def _end_effects(self, name):
        """End effects of the stored numbers and their bounds, (nodes,), slab by slab along the first axis."""
        stored, errors = self.stored(name), self.errors(name)
        if self.family.kind == reference.NONE:
            return np.where(self.is_number(self.codes), stored, np.nan), errors.astype(float)
        effects, noise = np.empty(len(stored)), np.empty(len(stored))
        slab = int(self.strides[0])
        # what the uniform state does not know is left out of its grid
        shape = tuple(self.shape[1:])
        without = ("length",) if self.family.kind in (reference.LOADED, reference.LOCKED) else ()
        reduced = tuple(1 if axis.name in without else len(axis.nodes) for axis in self.axes[1:])
        which = np.ascontiguousarray(
            np.broadcast_to(np.arange(int(np.prod(reduced)), dtype=np.int64).reshape(reduced), shape)
        ).ravel()
        take = tuple(0 if axis.name in without else slice(None) for axis in self.axes[1:])
        for i in range(int(self.shape[0])):
            points = self._slab_points(i)
            few = points.reshape(*shape, len(COLUMNS))[take].reshape(-1, len(COLUMNS))
            states = np.empty((len(few), UNIFORM))
            uniform_states(self.family.kind, np.ascontiguousarray(few), self.options[1], states)
            own = slice(i * slab, (i + 1) * slab)
            end_effects(
                self.family.variables[name], self.family.kind, points, states, which, stored[own],
                errors[own].astype(float), effects[own], noise[own],
            )  # fmt: skip
        bad = ~self.is_number(self.codes)
        effects[bad], noise[bad] = np.nan, 0.0
        return effects, noise

    def _slab_points(self, index):
        """Points (slab, 15) of the nodes at one index of the first axis."""
        shape = tuple(self.shape[1:])
        values = {self.axes[0].name: self.axes[0].values[index]}
        for a, axis in enumerate(self.axes[1:]):
            side = [1] * len(shape)
            side[a] = -1
            values[axis.name] = axis.values.reshape(side)
        points = np.empty((*shape, len(COLUMNS)))
        points[:] = self.fixed[int(values.get("design", 0))]
        for name, array in values.items():
            if name in COLUMNS or name in HELD_NAMES:
                points[..., COLUMNS.index("held" if name in HELD_NAMES else name)] = array
        _, _, inner, by_length, _ = self.options
        if inner:
            points[..., reference.FIBERS] = points[..., reference.RADIUS]
        if by_length:
            points[..., reference.HELD] /= points[..., reference.LENGTH]
        return points.reshape(-1, len(COLUMNS))

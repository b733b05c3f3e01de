"""Answers of one family of variables at points of an atlas: numbers, stated errors, statuses, flags."""

import numpy as np

from ..atlas.schema import EXCHANGED
from ..status import DEGENERATE, INACCURATE, NOT_INTERPOLABLE, OK
from . import errors, reference, spline
from .calibration import CLEAR, FILLED, NEAR_HOLES
from .cells import BESIDE, DOUBT, NOISE, ROUGH
from .family import LOOSE, MIRRORED, SLACK_FLAGS, TOLD, TOLD_FROM
from .locate import Placed, place
from .missing_nodes import MIXED
from .similar import at_similar
from .slack import UNKNOWN

CUBIC, LINEAR = "cubic", "linear"
SORTED = 2000  # points from which on sorting pays
# [degree]: smaller rotations are held to the tolerance of this one; shares of the length to a hundredth at the usual one
FLOORS = {reference.ROTATION: 0.1, reference.SLACK_ALPHA: 10.0, reference.SLACK_BETA: 10.0}
LOAD_FLOOR = 0.01  # of pi r^2 P, pi r^3 P: the same for blocked force and torque
PULL_FLOOR = 0.1  # of pi r^2 P: the same for the least tension, which is held against what fibers bear elsewhere


class Inquiry:
    """Points of a question placed in one table; ``values``: axis -> (n,), all that the table knows."""

    def __init__(self, table, values, method=CUBIC):
        self.table, self.method = table, method
        asked = np.stack([values[name] for name in table.known], axis=1)
        self.size, d = len(asked), len(table.axes)
        self.points = np.empty((self.size, len(reference.COLUMNS)))
        self.pieces, self.shares = np.zeros((self.size, d), np.int64), np.zeros((self.size, d))
        self.marks = np.empty((self.size, 7), np.int64)
        placed = Placed(self.points, self.pieces, self.shares, self.marks)
        place(asked, table.columns, table.fixed, table.nodes, table.family.status is not None, table.nearest, placed)
        self.states = table.predictor.states(table.family.kind, self.points)
        self.sides = table.side_of(self.states) if len(table.sides) > 1 else None
        self.status, self.codes, self.cell = self.marks[:, 0], self.marks[:, 1], self.marks[:, 3].copy()
        self.node = self.marks[:, 4]
        self.exact = self.node >= 0
        if table.predictor.model.is_loose and table.family.kind != reference.LOCKED:  # one family holds the wall
            self.status[(self.status == DEGENERATE) & ~self.exact] = NOT_INTERPOLABLE
        if table.is_untold:
            self.status[self.valued & ~self.exact] = NOT_INTERPOLABLE
        self.ranks = table.knots[np.arange(d), self.pieces, spline.RANK].astype(np.int64)
        self.order, self._told, self._similar = np.arange(self.size), None, None
        if self.size > SORTED:
            spline.by_cell(self.pieces, table.strides, int(np.prod(table.shape[:-1])), self.order)

    def of(self, name):
        """The inquiry that a variable is interpolated by: this one, or that at similar tubes."""
        if TOLD_FROM.get(name, name) not in self.table.similar:
            return self
        if self._similar is None:
            self._similar = at_similar(self)
            self._similar._similar = self._similar
        return self._similar

    @property
    def valued(self):
        """Where a number is given (n,)."""
        return (self.status == OK) | (self.status == INACCURATE)

    def orders(self, derivative=None):
        """What each axis asks of its weights: values, a slope along one axis, or linear weights."""
        orders = np.full(len(self.table.axes), -1 if self.method == LINEAR else 0, np.int64)
        if derivative is not None:
            orders[derivative] = 1
        return orders

    def effects(self, name, orders, order=None):
        """Interpolated end effects (n,); only at the places ``order`` if they are given."""
        table, found = self.table, np.full(self.size, np.nan)
        order = self.order if order is None else order
        places = table.knots, table.windows, table.labels, table.strides, self.pieces, self.shares
        for side, some in self._by_side(order):
            spline.interpolate(table.variable(name, side).values, *places, some, orders, found)
        return found

    def _by_side(self, order):
        """The places ``order`` (k,) by the sides of the table that they lie on: (side, places)."""
        if len(self.table.sides) == 1:
            return [(self.table.sides[0], order)]
        return [(side, order[self.sides[order] == side]) for side in self.table.sides]

    def known(self, name, places=None):
        """What is known of the cells that places (k,) lie in, (k, ROUGH + d): of all, if none are given."""
        places = self.order if places is None else places
        found = np.zeros((self.size, ROUGH + len(self.table.axes)), np.float32)
        for side, some in self._by_side(places):
            found[some] = self.table.variable(name, side).cells.at(self.cell[some])
        return found

    def doubts(self, name, known):
        """How far end effects may be off for what was put into holes (n,), where it is ``known`` of the cells that any are
        near.
        """
        found = np.zeros(self.size)
        for side, some in self._by_side(np.flatnonzero((known[:, BESIDE] > 0.0) | (known[:, DOUBT] > 0.0))):
            self.table.variable(name, side).cells.doubts(some, self.cell, self.pieces, self.shares, found)
        return found

    def interpolated(self, name):
        """End effects of one variable (n,), what is known of the cells that they lie in (n, ROUGH + d), and how far they
        may be off for what was put into holes (n,).
        """
        if (at := self.of(name)) is not self:
            return at.interpolated(name)
        name = TOLD_FROM.get(name, name)
        known = self.known(name)
        return self.effects(name, self.orders()), known, self.doubts(name, known)

    def estimate(self, name, scales, interpolated=None):
        """``(value, estimate, bound, beside)``: interpolated, what the next order would add, what was stored wrongly, and
        how it lies to holes, as :mod:`calibration` has it; ``scales`` (d, RANKS) of the estimate. What was ``interpolated``
        is taken if it is given.
        """
        if (at := self.of(name)) is not self:
            return at.estimate(name, scales, interpolated)
        if name in TOLD_FROM:
            if self._told is None:  # one calculation tells all of them
                *told, beside = self.estimate(TOLD_FROM[name], scales, interpolated)
                self._told = *self.table.predictor.worst_places(self.points, *told), beside
            *told, beside = self._told
            return *(array[list(TOLD).index(name)] for array in told), beside
        effects, known, doubt = interpolated or self.interpolated(name)
        rest = self.rests(known, scales).sum(axis=1)
        beside = np.where(known[:, BESIDE] > 0.0, np.where(doubt > rest, FILLED, NEAR_HOLES), CLEAR)
        rest += doubt
        if self.method == LINEAR:
            rest += np.abs(effects - self.effects(name, np.zeros(len(self.table.axes), np.int64)))
        noise = known[:, NOISE].astype(float)
        value, estimate, bound = self._restored(name, slice(None), effects, rest, noise)
        if (variable := self.table.family.variables[name]) in SLACK_FLAGS:
            value, estimate = self._share(SLACK_FLAGS[variable], value, estimate)
        return value, estimate, bound, beside

    def _share(self, flag, value, estimate):
        """Shares of the length (n,) where a family is slack, and their estimates: none where none is at any corner of a
        cell, whatever begins beyond it, and windows reach to.
        """
        none = (self.codes != MIXED) & (self.codes >> 4 & flag == 0)
        return np.where(none, 0.0, np.clip(value, 0.0, 1.0)), np.where(none, estimate + np.abs(value), estimate)

    def rests(self, known, scales, places=slice(None)):
        """What the next order would add along each axis (k, d) at some places, from what is ``known`` of their cells.

        Between two nodes what the slopes lack goes with t (1 - t); what the cubic lacks, with its square, is smaller.
        """
        bubble = 4.0 * self.shares[places] * (1.0 - self.shares[places])
        scale = scales[np.arange(scales.shape[0]), self.ranks[places]]
        with np.errstate(invalid="ignore"):  # on a node the unknown says nothing
            return np.where(bubble > 0.0, known[:, ROUGH:] * bubble * scale, 0.0)

    def _restored(self, name, places, effects, rest, noise):
        """``(value, estimate, bound)`` at some places, (k,) each, from end effects, what they lack and their bounds."""
        family, (value, estimate, bound) = self.table.family, np.empty((3, len(effects)))
        args = (self.points[places], self.states[places], effects, rest, noise, value, estimate, bound)
        self.table.predictor.restore(family.variables[name], *args)
        return value, estimate, bound

    def answer(self, name, factors):
        """``(value, error)`` of one variable, (n,) each; stored bits at nodes. NaN where nothing can be said. ``factors``
        gives those of a variable.
        """
        value, error = self._as_stored(name, factors(name))
        exchanged = self.marks[:, 5] == 1
        if name in EXCHANGED and exchanged.any():
            others = self._as_stored(EXCHANGED[name], factors(EXCHANGED[name]))
            value, error = (np.where(exchanged, other, one) for other, one in zip(others, (value, error)))
        return value, error

    def _as_stored(self, name, factors):
        """The same by the order of the families in the table."""
        value, estimate, bound, beside = self.estimate(name, factors.scales)
        error = errors.stated(factors, estimate, bound, self.natural_size(name, value), beside, self.of(name).cell)
        if self.exact.any():
            at = self.node[self.exact]
            value[self.exact], error[self.exact] = self.table.part.stored(name)[at], self.table.part.errors(name)[at]
        if name in MIRRORED:
            value = np.where(self.marks[:, 6] == 1, -value, value) + 0.0
        return value, error

    def natural_size(self, name, value):
        """What an error is relative to, (n,)."""
        variable, size = self.table.family.variables[name], np.abs(value)
        if variable in FLOORS:
            return np.maximum(size, FLOORS[variable])
        if variable in (reference.HOLDING_FORCE, reference.HOLDING_TORQUE):
            power = 2 if variable == reference.HOLDING_FORCE else 3
            load = np.pi * self.points[:, reference.FIBERS] ** power * self.points[:, reference.PRESSURE]
            return np.maximum(size, LOAD_FLOOR * load)
        if variable in (reference.LEAST_TENSION_ALPHA, reference.LEAST_TENSION_BETA):
            area = np.pi * self.points[:, reference.FIBERS] ** 2
            load = area * self.points[:, reference.PRESSURE] + np.abs(self.points[:, reference.FORCE])
            return np.maximum(size, PULL_FLOOR * load)
        return size

    def is_loose(self, name):
        """Whether a variable is held to ten times the tolerance of lengths."""
        return self.table.family.variables[name] in LOOSE

    def exceeds(self, name, value, error, tolerance):
        """Where an answer is no number or its stated error too large to be given (nodes are given as they are)."""
        allowed = tolerance * (10.0 if self.is_loose(name) else 1.0)
        number = np.isfinite(value) & (error >= 0.0)
        return ~number | (~(error <= allowed * self.natural_size(name, value)) & ~self.exact)

    def blame(self, name, refused, scales, coarse):
        """Add to the list ``coarse``: axes, and at how many of the ``refused`` (n,) the estimate is largest along them."""
        if (at := self.of(name)) is not self:
            return at.blame(name, refused, scales, coarse)
        places = np.flatnonzero(refused)
        if not len(places):
            return
        rests = self.rests(self.known(name, places)[places], scales, places)
        worst = np.bincount(rests.argmax(axis=1)[rests.any(axis=1)], minlength=len(self.table.axes))
        coarse.extend((axis.name, count) for axis, count in zip(self.table.axes, worst.tolist()) if count)

    def flags(self, sure=True):
        """Flags (n,) by name; a point at which it is too close to say whether fibers are slack becomes NOT_INTERPOLABLE, or,
        unless ``sure``, is taken for taut.
        """
        table, found = self.table, {}
        if table.has_flag:
            found[table.family.flag] = np.where(self.codes == MIXED, 0, self.codes >> 4 & 1)
        if table.has_slack:
            slack, exchanged = self.marks[:, 2], self.marks[:, 5] == 1
            look = (slack == MIXED) & self.valued
            slack = np.where(slack == MIXED, 0, slack >> 4)
            slack[self.exact] = table.part.stored("slack_fiber")[self.node[self.exact]]
            if look.any():
                places = np.flatnonzero(look)
                effects, nothing = self.effects("mid_radius", self.orders(), places)[places], np.zeros(len(places))
                middle, _, _ = self._restored("mid_radius", places, effects, nothing, nothing)
                told = table.predictor.slack_families(self.points[places], self.states[places], middle)
                slack[places] = np.where(told == UNKNOWN, 0, told)
                if sure:
                    self.status[places[told == UNKNOWN]] = NOT_INTERPOLABLE
            found["slack_fiber"] = np.where(exchanged, (slack & 1) << 1 | slack >> 1 & 1, slack)
        return found

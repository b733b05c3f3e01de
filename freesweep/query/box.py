"""Which part of a grid answers a question: a few points of a large atlas need the nodes around them, not whole variables."""

import math

import numpy as np

from .axis import LABEL
from .ideal import IMAGES
from .locate import NEAR
from .placing import TURNED

MARGIN = 8  # nodes around a piece: its window, the pieces beside it, and what fills their holes
SMALL = 1 << 19  # nodes of a grid that is always read whole
SPARE = 4  # a part must be so much smaller than the whole
WHOLE = 30_000_000  # nodes of the largest grid that many questions in parts lead to reading whole


class Parts:
    """The tables of one family: parts of the grid while few points were asked, then the whole one."""

    def __init__(self, make, frame, names, whole=()):
        """``make(box)`` makes a table; ``names`` are the axes that the family varies in, some of them read ``whole``."""
        self.make, self.frame, self.names = make, frame, [name for name in names if name not in whole]
        self.size = math.prod(len(frame.values[name]) for name in names)
        self.rest = math.prod(len(frame.values[name]) for name in whole)
        self.whole, self.last, self.read = None, None, 0

    def table(self, values=None):
        """The table to ask at ``values``: axis -> (n,); without them the whole one."""
        if self.whole is not None:
            return self.whole
        box = self._box(values) if values is not None and self.size > SMALL else None
        if box is not None and self.last is not None and _lies_in(box, self.last.box):
            return self.last
        nodes = self.rest * math.prod(b - a for a, b in box.values()) if box is not None else self.size
        self.read += nodes
        if SPARE * nodes > self.size or (self.read > self.size and self.size <= WHOLE):
            self.whole, self.last = self.make(None), None
            return self.whole
        self.last = self.make(box)
        return self.last

    def _box(self, values):
        """Axis -> (first node, last + 1) around points; what lies outside the grid does not count."""
        asked = {name: values[name] for name in self.names}
        if {"alpha", "beta"} <= set(values):
            asked |= self._folded(values)
        box = {}
        for name, array in asked.items():
            if name not in self.names:
                continue
            axis = self.frame.axis(name)
            if axis.kind == LABEL:
                continue
            if name in TURNED:
                array = np.concatenate([array, -array])
            inside = np.clip(array[self._within(name, array)], axis.values[0], axis.values[-1])
            least, most = (inside.min(), inside.max()) if len(inside) else (axis.values[0],) * 2
            first = int(np.searchsorted(axis.values, least, side="right")) - 1 - MARGIN
            last = int(np.searchsorted(axis.values, most, side="left")) + 1 + MARGIN
            box[name] = max(first, 0), min(last, len(axis.values))
        return box

    def _folded(self, values):
        """Angles (n,) of the image of each point that lies in the grid: the first, as where points are placed."""
        turned = any(name in values for name in TURNED)
        found = {"alpha": [], "beta": []}
        open_points = np.ones(len(values["alpha"]), bool)
        for sign, swap in IMAGES:
            image = {name: sign * values[other] for name, other in zip(found, ("beta", "alpha") if swap else found)}
            inside = open_points.copy()
            for name, array in image.items():
                inside &= self._within(name, array)
            for name, array in image.items():
                found[name].append(array[inside])
            if not turned:  # else another image may be taken for the sake of the load
                open_points &= ~inside
        return {name: np.concatenate(arrays) for name, arrays in found.items()}

    def _within(self, name, array):
        low, high = self.frame.ranges[name]
        slack = NEAR * max(abs(low), abs(high))
        return (array >= low - slack) & (array <= high + slack)


def _lies_in(box, other):
    """Whether a box with its margins lies in another one."""
    return all(other[name][0] <= a and b <= other[name][1] for name, (a, b) in box.items())

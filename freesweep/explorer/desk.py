"""What the page asks of an atlas, answered: maps, points, pinned designs with their curves, clouds of designs."""

import contextlib
from threading import Lock

import numpy as np

from ..atlas.schema import HELD, LOADS, PARAMETERS
from ..query.family import FAMILY_OF
from ..query.table import MUCH, TOGETHER
from ..status import STATUSES
from .measures import COARSE, COARSE_STATUS, evaluate, measures_of

MOST_CELLS, MOST_CLOUD, MOST_PINS, MOST_CURVE = 400_000, 40_000, 5, 401
COARSE_SENTENCE = f"answered, but the stated error is above {COARSE:.1%} of the value: nodes lie far apart here"


class AskError(ValueError):
    """A question that the page should not have asked."""


class Desk:
    """One atlas, ready to answer the page; everything in SI units and degrees."""

    def __init__(self, atlas):
        self.atlas, self.reader = atlas, atlas._reader
        frame = self.reader.frame
        self.measures = {one.name: one for one in measures_of(self.reader)}
        self.axes = [name for name in frame.sizes if name in PARAMETERS and frame.varies(name)]
        self.labels = frame.values["design"].tolist() if frame.varies("design") and "design" in frame.values else []
        if len(self.axes) < 2 or not self.measures:
            held = ", ".join(f"{name} ({size})" for name, size in frame.sizes.items()) or "one point"
            raise AskError(f"to explore, an atlas needs two axes of numbers or more; this one holds {held}")
        self._making, self._made = Lock(), set()
        self.design_axes = [name for name in self.axes if name not in (*LOADS, *HELD)]

    @property
    def along(self):
        """The axis of the curves: pressure if it varies."""
        return "pressure" if "pressure" in self.axes else self.axes[-1]

    def answer(self, question: dict) -> dict:
        """The answer to one question, by its ``what``. Raises ValueError for what is no question."""
        ways = {"grid": self.grid, "point": self.point, "pins": self.pins, "cloud": self.cloud}
        if not isinstance(question, dict) or question.get("what") not in ways:
            raise AskError(f"unknown question; known: {', '.join(ways)}")
        try:
            return ways[question["what"]](question)
        except (KeyError, TypeError, AttributeError) as error:
            raise AskError(f"{question['what']}: the question lacks {error}") from error

    def grid(self, ask):
        """Measures over two axes, row by row from below: float32; statuses of the first, slack families."""
        x, y = ask["x"], ask["y"]
        for name in (x, y):
            if name not in self.axes:
                raise AskError(f"{name}: no axis of this atlas; known: {', '.join(self.axes)}")
        nx, ny = (_count(ask[key], MOST_CELLS) for key in ("nx", "ny"))
        if nx * ny > MOST_CELLS:
            raise AskError(f"{nx} x {ny} places; at most {MOST_CELLS:,}")
        xs, ys = (np.linspace(*self.reader.frame.ranges[name], count) for name, count in ((x, nx), (y, ny)))
        size = nx * ny
        values = self._at(ask["at"], size)
        values[x], values[y] = np.tile(xs, ny), np.repeat(ys, nx)
        wanted = self._ready(ask["measures"])
        found = evaluate(self.reader, values, size, wanted)
        return {
            "nx": nx, "ny": ny,
            "values": {name: array.astype(np.float32) for name, array in found.value.items()},
            "status": found.status[wanted[0].name], "slack": found.slack,
        }  # fmt: skip

    def point(self, ask):
        """Measures of one design: value, stated error, status."""
        wanted = self._wanted(ask["measures"])
        with self._alone(wanted):
            found = evaluate(self.reader, self._at(ask["at"], 1), 1, wanted)
        return {"measures": _told(found, 0), "slack": int(found.slack[0])}

    def pins(self, ask):
        """Measures of up to five designs, and curves of some of them along one axis, with their errors."""
        pins, along = ask["pins"][:MOST_PINS], self.along
        wanted, shown = self._wanted(ask["measures"]), self._wanted(ask["curves"])
        nodes = self.curve_nodes(_count(ask.get("n", 81), MOST_CURVE))
        if not pins:
            return {"along": along, "nodes": nodes, "pins": [], "curves": []}
        places = [{**ask["at"], **pin} for pin in pins]
        with self._alone(wanted):
            one = evaluate(self.reader, self._stacked(places, 1), len(pins), wanted)
        count = len(nodes)
        values = self._stacked(places, count) | {along: np.tile(nodes, len(pins))}
        with self._alone(shown):
            line = evaluate(self.reader, values, count * len(pins), shown)
        told, curves = [], []
        for k in range(len(pins)):
            told.append({"measures": _told(one, k), "slack": int(one.slack[k])})
            part = slice(k * count, (k + 1) * count)
            curves.append({
                name: {"value": line.value[name][part], "error": line.error[name][part], "slack": line.slack[part]}
                for name in line.value
            })  # fmt: skip
        return {"along": along, "nodes": nodes, "pins": told, "curves": curves}

    def _stacked(self, places, count):
        """Axis -> (places * count,) of several places, each repeated."""
        each = [self._at(at, count) for at in places]
        return {name: np.concatenate([one[name] for one in each]) for name in each[0]}

    def curve_nodes(self, count):
        """Values along the axis of the curves, densest where it begins if that is zero."""
        low, high = self.reader.frame.ranges[self.along]
        if low < 0.0:
            return np.linspace(low, high, count)
        return np.clip(np.linspace(low**0.5, high**0.5, count) ** 2, low, high)  # squares of roots may be rounded out

    def cloud(self, ask):
        """Designs spread evenly over all axes of design, under the loads that are asked for, and what they do."""
        count = _count(ask["n"], MOST_CLOUD)
        values = self._at(ask["at"], count)
        free = {name: self.reader.frame.ranges[name] for name in self.design_axes}
        for name, share in zip(free, even(count, len(free)).T):
            low, high = free[name]
            values[name] = low + (high - low) * share
        found = evaluate(self.reader, values, count, self._ready(ask["measures"]))
        return {
            "designs": {name: values[name] for name in free},
            "values": {name: array.astype(np.float32) for name, array in found.value.items()},
            "slack": found.slack,
        }  # fmt: skip

    def _at(self, at, size):
        """Axis -> (n,) of what is fixed in a question."""
        values = {}
        for name in self.axes:
            number = at.get(name)
            if isinstance(number, bool) or not isinstance(number, int | float) or not np.isfinite(number):
                raise AskError(f"{name}: found {number!r:.40}; give a finite number")
            values[name] = np.full(size, float(number))
        if self.labels:
            label = at.get("design", 0)
            if label not in range(len(self.labels)):
                raise AskError(f"design: found {label!r:.40}; give 0 to {len(self.labels) - 1}")
            values["design"] = np.full(size, float(label))
        return values

    def _wanted(self, names):
        wrong = [name for name in names if name not in self.measures]
        if wrong or not names:
            raise AskError(f"unknown measures {wrong!r:.100}; known: {', '.join(self.measures)}")
        return [self.measures[name] for name in dict.fromkeys(names)]

    def begin(self):
        """Make the tables of what the page shows first, and those that a first pin needs, all of them, unless the atlas is
        large; what fails is told by the question that needs it.
        """
        with contextlib.suppress(Exception):
            self._ready(list(self.measures)[:2])
            if np.prod([float(len(self.reader.frame.values[name])) for name in self.axes]) <= MUCH:
                self.make()

    def _ready(self, names):
        """The same, their whole tables made: once, whoever asks first."""
        wanted = self._wanted(names)
        for source in dict.fromkeys(one.source for one in wanted if one.source in FAMILY_OF):
            if source not in self._made:
                with self._making:
                    self.reader.table(FAMILY_OF[source]).make([source])
                    self._made.add(source)
        return wanted

    def make(self, told=lambda: None):
        """Make the whole tables of all measures; ``told`` is called for each source of one."""
        families = {}
        for source in dict.fromkeys(one.source for one in self.measures.values()):
            families.setdefault(FAMILY_OF.get(source), []).append(source)
        for key, sources in families.items():
            for first in range(0, len(sources), TOGETHER):
                some = sources[first : first + TOGETHER]
                if key is not None:
                    with self._making:
                        self.reader.table(key).make(some)
                        self._made.update(some)
                for _ in some:
                    told()

    def _alone(self, wanted):
        """A lock for what may read from the file; none where whole tables are there already."""
        known = all(one.source in self._made or one.source not in FAMILY_OF for one in wanted)
        return contextlib.nullcontext() if known else self._making


def even(count, dimensions):
    """Points (n, d) in the unit cube, evenly spread: multiples of powers of the root of g^(d+1) = g + 1, modulo one."""
    g = 2.0
    for _ in range(60):
        g = (1.0 + g) ** (1.0 / (dimensions + 1))
    return (0.5 + np.arange(1, count + 1)[:, None] * g ** -np.arange(1.0, dimensions + 1)) % 1.0


def sentences() -> list:
    """Statuses in words: meaning and sentence, by value."""
    here = (one.sentence.replace("refine=True", "'solve exactly'") for one in STATUSES)
    rows = [{"meaning": one.meaning.replace("_", " "), "sentence": words} for one, words in zip(STATUSES, here)]
    assert len(rows) == COARSE_STATUS
    return [*rows, {"meaning": "coarse", "sentence": COARSE_SENTENCE}]


def _count(number, most):
    if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= most:
        raise AskError(f"found {number!r:.40} places; give 1 to {most:,}")
    return number


def _told(found, k):
    return {
        name: {
            "value": float(found.value[name][k]),
            "error": float(found.error[name][k]),
            "status": int(found.status[name][k]),
        }
        for name in found.value
    }

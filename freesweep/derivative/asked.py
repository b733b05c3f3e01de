"""What is asked of one actuator, and how its states are differentiated: in vectors, or one by one."""

import numpy as np

from ..description.families import told
from . import grid
from .along import Course
from .cylinder import at_cylinder
from .equilibrium import Hold
from .extremes import EXTREMES
from .nested import ROUNDING, Task, solve
from .physical import PhysicalTube
from .physics import Physics
from .request import ANGLE, SHAPE, measures, sizes
from .rest import at_rest
from .table import Held, rows_of
from .vectors import differentiated

SHARE, IN_VECTORS = 0.01, 0.1  # of the accuracy asked for: what bounds of derivatives have to meet, scaled
TURNS = 4  # of finding the load that holds in vectors
UNSTRAINED = 1e-9  # of sizes: what a cylinder may differ by from itself


class Asked:
    """What is asked of one actuator: names of ``parameters``; ``held`` and ``unknown``, what is held and the load that does
    it; ``course``: ``(course, edges, places)`` of a tube that varies, with the ``error`` of its splines.
    """

    def __init__(
        self, tube, parameters, accuracy, course=None, error=0.0, held=None, unknown=None, tied=False, whole=False
    ):
        self.tube, self.parameters, self.accuracy, self.error = tube, parameters, accuracy, error
        self.held, self.unknown = held, unknown
        self.course = None if course is None else Course(tube, course[2])
        self.half = self.course is None and not whole
        places = [0.0, 0.5] if self.half else [0.0, 0.5, 1.0]
        self.segments = np.array(places) if self.course is None else self.course.places
        radii = tube.length / tube.fiber_surface
        self.x = grid.first_places(self.segments[:1] if self.half else self.segments, radii, self.half)
        own = [name for name in parameters if name != held]
        self.seeds = own if unknown is None else [unknown, *own]
        self.names = (*SHAPE, *EXTREMES)
        self.holding = None if unknown is None else Held(held, unknown, parameters, self.names, self.seeds, tied)
        self.outputs = self.names if unknown is None else self.holding.outputs
        self.first = len(self.outputs) - len(EXTREMES)  # so many outputs tell a state

    @property
    def is_physical(self):
        """Whether the wall is thick, fibers are loose, or there are fewer than two families."""
        return self.tube.is_thick or self.tube.threads != 0.0

    @property
    def is_buckled(self):
        """Whether all of a tube that is the same all along has to be told."""
        return self.course is None and not self.half

    @property
    def is_alike(self):
        """Whether vectors can do it: a tube that is the same all along, solved by its half."""
        return self.half

    def places(self, finer):
        """Where shapes to begin from have to be known, x/l: of each cell so many times a quarter."""
        return grid.finer(self.x, np.searchsorted(self.x, self.segments), 4**finer)

    def states(self, loads, target, known):
        """Values and bounds (outputs, 1 + parameters, n) of n states in vectors: ``loads`` and what is held, (n,) each;
        ``known``: middle radius [m], and where a family of fibers goes slack along a part.
        """

        def under(loads, seeds):
            design = Physics(self.tube, None, loads, seeds).design
            design["pressure"].value[...] = loads["pressure"]  # infinite, of a locked shape
            natural = measures(self.tube, loads)
            sizes = np.array([np.broadcast_to(natural[name], loads["pressure"].shape) for name in seeds])
            kind = self.tube.is_thick, self.tube.threads
            found = differentiated(
                design, self.tube.energy, sizes, self.names, IN_VECTORS * self.accuracy, *kind, known
            )
            return [np.array([*told(self.tube, dict(zip(self.names, rows))).values()]) for rows in found]

        if self.unknown is None:
            return under(loads, self.seeds)
        rows, bounds = under(loads, self.seeds)
        for _ in range(TURNS):
            value, slope = self.holding.at(rows)
            off = np.abs(target - value) > self.holding.at(bounds)[0]
            if not np.any(off):
                break
            loads = loads | {self.unknown: loads[self.unknown] + np.where(off, (target - value) / slope, 0.0)}
            rows, bounds = under(loads, self.seeds)
        return self.holding.table(loads[self.unknown], rows, bounds)

    def cylinders(self, loads, target, known):
        """As :meth:`states`, of those that stay undeformed, by their ``known`` outputs (outputs, n); NaN of the others."""
        n = known.shape[1]
        natural = {"deformed_length": self.tube.length, "rotation": 0.0, "mid_radius": self.tube.fiber_surface}
        units = natural | {"rotation": ANGLE}
        rows = [(name, row) for name, row in zip(self.outputs, known) if name in natural]
        still = np.all([np.abs(row - natural[name]) <= UNSTRAINED * units[name] for name, row in rows], axis=0)
        found = np.full((2, len(self.outputs), 1 + len(self.parameters), n), np.nan)
        some = np.flatnonzero(still & np.any([loads[name] != 0.0 for name in loads], axis=0))
        if self.tube.threads != 0.0 or not self.is_alike or len(some) == 0:  # others swell or slacken
            return found
        loads = {name: value[some] for name, value in loads.items()}

        def made(seeds):
            outputs, there = at_cylinder(self._physics(loads, seeds), len(some))
            return _with_none(np.where(there, rows_of(outputs, SHAPE, len(seeds)), np.nan))

        if self.unknown is not None:
            value, slope = self.holding.at(made(self.seeds[:1]))
            loads = loads | {self.unknown: loads[self.unknown] + (target[some] - value) / slope}
        rows = made(self.seeds)
        if self.unknown is not None:
            rows, _ = self.holding.table(loads[self.unknown], rows, 0.0 * rows)
        units = sizes(self.tube, loads, self.outputs, self.parameters, rows[:, 0])
        found[0][..., some], found[1][..., some] = rows, ROUNDING * (units + np.abs(rows))
        return found

    def state(self, loads, target, stretches):
        """Values and bounds (outputs, 1 + parameters) of one state whose stretches at :meth:`places` ``stretches(finer)``
        tells.
        """
        hold = None
        if self.unknown is not None:
            unit = float(measures(self.tube, loads)[self.unknown])
            hold = Hold(self.held, self.unknown, target, unit, np.array([loads[self.unknown]]))

        def finish(made, doubts, hold):
            rows = rows_of(made, self.names, len(self.seeds))
            doubts = np.concatenate([0.0 * rows[: len(SHAPE)], doubts])
            if hold is not None:
                rows, doubts = self.holding.table(hold.load, rows, doubts)
            units = sizes(self.tube, loads, self.outputs, self.parameters, rows[:, 0, -1])
            rows = np.moveaxis(rows, -1, 0)
            return rows, np.maximum(np.abs(rows[-1]), units), doubts[..., -1]

        known = self._physics(loads, () if hold is None else self.seeds[:1])
        wanted = self._physics(loads, self.seeds)

        def shape(finer):
            return self.places(finer), stretches(finer)

        task = Task(known, wanted, self.half, self.segments, finish, SHARE * self.accuracy, self.first)
        return solve(task, shape, hold)

    def _physics(self, loads, seeds):
        kind = PhysicalTube if self.is_physical else Physics
        return kind(self.tube, self.course, loads, seeds)

    def at_rest(self, loads):
        """As :meth:`state`, of the undeformed tube, with bounds of 0."""
        wanted = self._physics(loads, self.seeds)
        made = at_rest(wanted, 0.5 * (self.x[1:] + self.x[:-1]), np.diff(self.x), self.half)
        rows = _with_none(rows_of(made, SHAPE, len(self.seeds)))
        found = rows, 0.0 * rows
        if self.unknown is not None:
            found = self.holding.table(np.array([loads[self.unknown]]), *found)
        return tuple(array[..., 0] for array in found)

    def units(self, loads):
        """What outputs are measured by, under loads (n,): (outputs, n)."""
        natural = measures(self.tube, loads)
        return np.array([np.broadcast_to(natural[name], loads["pressure"].shape) for name in self.outputs])


def _with_none(rows):
    """Rows (outputs, ...) of the first outputs, behind them those of extremes, which are not known: places that are alike
    are largest together.
    """
    return np.concatenate([rows, np.full((len(EXTREMES), *rows.shape[1:]), np.nan)])

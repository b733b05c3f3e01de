"""Held states beside known ones, in two numbers: the stretch in the middle, and the load that holds what is held.

To each such pair belongs by how much half a tube misses its length (:mod:`freesweep.solver.lanes.by_middle`), a number that
is all but linear in both, and what is held. Newton's method leads to where nothing is missed of either: also where no free
tube has that load, as the branch along which it changes has turned back. What is held grows with the logarithm of a miss:
so its slope is that along the branch, and it is corrected there only.
"""

from typing import NamedTuple

import numpy as np

from ..description.families import beyond_a_point, lines_of
from ..description.impossible import APART
from ..query.reference import COLUMNS
from ..scaling import ALONG as ALONG_TUBE
from ..scaling import OUTPUTS, SLACK, problem_rows

STEP, ALONG = 1e-5, 3e-3  # differences: of stretch and load, each by its size; along the branch, where sums are rough
SMALLEST = 1e-4, 0.1  # sizes of a strain, and of a load by the pressure's
LEAST = 1e-2  # of c10: a pressure that loads are measured by
STILL = 1e-9  # a strain that is looked at as the least
ON, MET, CLOSE, NONE = 1e-3, 1e-9, 1e-8, 1e-3  # misses by their slopes: of a step along, none; what is held; a miss
WIDEST, MOST = 0.15, 2.0  # of one step: a stretch; a load, by its size
ROUNDS, AGAIN = 24, 8  # steps; after so many slopes are looked at anew
ENOUGH, CLOSER = 16, 1e-8  # steps after which loads need not be so close
UNEVEN, ASTRAY = 30.0, 0.3  # times what a slope was, and of a step along: more tells of other things
BACK = 3  # steps across to a branch beside
PARTS = 1, 2, 4, 16  # pieces of what is summed
VALUE = {"force": 0, "torque": 2}  # columns of what is held: half the length, half the rotation
TOLD = len(OUTPUTS) + len(ALONG_TUBE)  # columns of what is told


class Pair(NamedTuple):
    """A held state (n,): load [N, N m] and its bound, stretch in the middle, slack families; NaN where there is none."""

    load: np.ndarray
    bound: np.ndarray
    middle: np.ndarray
    slack: np.ndarray


class Held:
    """Tubes of a ``kind`` of held states at ``points`` (n, 17), of tubes that are ``own``, a :class:`.vectors.Kind`."""

    def __init__(self, kind, points, own):
        column = {name: np.ascontiguousarray(points[:, k]) for k, name in enumerate(COLUMNS)}
        lines = lines_of(column["alpha"], column["beta"], own.families, own.model.is_loose)
        self.is_tube = lines.single | (np.abs(lines.alpha - lines.beta) >= APART)
        angles = {"alpha": lines.alpha, "beta": np.where(self.is_tube, lines.beta, lines.alpha - 1.0)}
        self.problems = problem_rows(column | angles, own.energy, own.model.is_thick, lines.threads)
        if not (own.model.is_thick or np.any(lines.threads)):
            self.problems = np.column_stack([self.problems, np.zeros((len(points), 2))])
        self.pressure = column["pressure"] / column["c10"]
        self.size = np.maximum(self.pressure, LEAST)
        radius, length = column["fiber_radius"], 0.5 * column["length"] / column["fiber_radius"]
        self.unit = np.pi * radius ** (2 if kind == "force" else 3) * column["c10"] * self.size  # of a load
        self.radius = radius
        self.kind, self.measure = kind, length if kind == "force" else np.ones(len(points))
        self.target = column["held"] * length if kind == "force" else 0.5 * np.radians(column["held"])

    def missed(self, rows, pairs, pieces=1):
        """What pairs (k, 2) of stretch and load miss of some rows, (k, 2): of the length, times the strain, and of what is
        held; what may be missing of that; and slack families.
        """
        from ..solver.batch import kinds_of
        from ..solver.lanes import by_middle
        from ..solver.problem import FORCE, GAMMA, TORQUE

        strain = pairs[:, 0] - 1.0
        strain = np.where(np.abs(strain) < STILL, np.copysign(STILL, strain), strain)
        problems, load = self.problems[rows], pairs[:, 1] * self.size[rows]
        loads = (load, problems[:, TORQUE]) if self.kind == "force" else (problems[:, FORCE], load)
        given = np.column_stack([self.pressure[rows], *loads, problems[:, GAMMA], np.ones(len(rows))])
        values, bounds = np.full((2, len(rows), TOLD), np.nan)
        told = np.full((len(rows), by_middle.COUNT), np.nan)
        with np.errstate(all="ignore"):
            for _, _, kind, some in kinds_of(problems):
                own = np.flatnonzero(some & np.isfinite(pairs).all(axis=1) & (strain > -1.0))
                parts = [np.empty((len(own), array.shape[1])) for array in (values, bounds, told)]
                by_middle.measure_physical(problems, own, given[own], 1.0 + strain[own], *kind, pieces, *parts)
                values[own], bounds[own], told[own] = parts
        column, measure = VALUE[self.kind], self.measure[rows]
        slack = np.nan_to_num(told[:, by_middle.SLACK])
        miss, doubt = told[:, by_middle.MISS] * strain, told[:, by_middle.DOUBT] * np.abs(strain)
        return (
            np.column_stack([miss, (values[:, column] - self.target[rows]) / measure]),
            np.column_stack([doubt, bounds[:, column] / measure]),
            beyond_a_point(slack.astype(np.int8), *values[:, len(OUTPUTS) : len(OUTPUTS) + len(SLACK)].T),
        )


class Slopes:
    """Of what pairs of stretch and load miss: the ways ``across`` a branch and ``along`` it, pairs themselves, (n, 2); how
    fast the miss grows across, and along the branch what is held.
    """

    def __init__(self, count):
        self.across, self.along = np.full((2, count, 2), np.nan)
        self.steep, self.gain = np.full((2, count), np.nan)

    def look(self, held, rows, pairs, missed, pieces=1):
        """Look at those of some rows, at pairs that miss so much."""
        count, strain = len(rows), 1.0 - pairs[:, 0]
        size = np.column_stack([
            np.copysign(np.maximum(np.abs(strain), SMALLEST[0]), strain), np.maximum(np.abs(pairs[:, 1]), SMALLEST[1])
        ])  # fmt: skip
        aside = np.concatenate([pairs + STEP * size * unit for unit in np.eye(2)])
        slope = (held.missed(np.tile(rows, 2), aside, pieces)[0][:, 0].reshape(2, count) - missed[:, 0]) / STEP
        steep = np.hypot(*slope)
        unit = (slope / steep).T
        self.across[rows], self.along[rows] = unit * size, np.column_stack([-unit[:, 1], unit[:, 0]]) * size
        self.steep[rows] = steep
        for _ in range(2):  # the second time truly along the branch
            ahead = held.missed(rows, pairs + ALONG * self.along[rows], pieces)[0]
            off = (ahead[:, 0] - missed[:, 0]) / (steep * ALONG)
            self.along[rows] -= np.where(np.abs(off) < ASTRAY, off, 0.0)[:, None] * self.across[rows]
        self.gain[rows] = (ahead[:, 1] - missed[:, 1]) / ALONG

    def step(self, rows, missed, pairs):
        """Shares (k, 2) of a step across and along from pairs that miss so much: along only from the branch itself."""
        across, along = -missed[:, 0] / self.steep[rows], -missed[:, 1] / self.gain[rows]
        on = np.abs(across) <= np.maximum(ON * np.minimum(np.abs(along), 1.0), MET)
        on |= np.abs(missed[:, 0]) <= NONE * np.abs(pairs[:, 0] - 1.0)
        shares = np.column_stack([across, np.where(on, along, 0.0)])
        moved = np.abs(self.moved(rows, shares))
        far = np.maximum(moved[:, 0] / WIDEST, moved[:, 1] / (MOST * np.maximum(np.abs(pairs[:, 1]), 1.0)))
        return shares / np.maximum(far, 1.0)[:, None]

    def moved(self, rows, shares):
        """The steps (k, 2) of pairs that shares of one make."""
        return shares[:, :1] * self.across[rows] + shares[:, 1:] * self.along[rows]

    def learn(self, rows, shares, before, now):
        """What a step tells: one across how fast the miss grows, one along how far that led from the branch."""
        across = shares[:, 1] == 0.0
        steep = (now[:, 0] - before[:, 0]) / shares[:, 0]
        ratio = steep / self.steep[rows]
        told = across & (ratio > 1.0 / UNEVEN) & (ratio < UNEVEN)
        self.steep[rows[told]] = steep[told]
        off = now[:, 0] / self.steep[rows] / shares[:, 1]
        told = ~across & (np.abs(off) < ASTRAY)
        self.along[rows[told]] -= off[told][:, None] * self.across[rows[told]]


def beside(held: Held, load, middle, accuracy) -> Pair:
    """The held states beside pairs of a ``load`` [N, N m] and a stretch in the ``middle`` (n,), in as many pieces as tell
    them to the ``accuracy``.
    """
    count = len(load)
    found = Pair(*np.full((3, count), np.nan), np.zeros(count, np.int8))
    pairs, slopes = np.column_stack([middle, load / held.unit]), Slopes(count)
    rows = np.flatnonzero(np.isfinite(pairs).all(axis=1) & held.is_tube)
    with np.errstate(all="ignore"):
        for pieces in PARTS:
            rows = _met(held, rows, pairs, slopes, pieces)
            missed, doubt, slack = held.missed(rows, pairs[rows], pieces)
            size = slopes.across[rows, 1] / slopes.steep[rows], slopes.along[rows, 1] / slopes.gain[rows]
            bound = np.sum(np.abs(np.column_stack(size)) * (np.abs(missed) + doubt), axis=1)
            found.load[rows], found.bound[rows] = (array * held.unit[rows] for array in (pairs[rows, 1], bound))
            found.middle[rows], found.slack[rows] = pairs[rows, 0], slack
            rows = rows[bound > accuracy * np.maximum(np.abs(pairs[rows, 1]), 1.0)]
            if len(rows) == 0:
                break
    return found


def _met(held, rows, pairs, slopes, pieces):
    """The rows that come from their ``pairs`` to where nothing is missed, as sums of so many pieces tell."""
    missed, met = np.full((len(pairs), 2), np.nan), []
    missed[rows] = held.missed(rows, pairs[rows], pieces)[0]
    for trial in range(ROUNDS):
        strain = np.maximum(np.abs(pairs[rows, 0] - 1.0), STILL)
        none = (np.abs(missed[rows, 0]) <= NONE * strain) | (np.abs(missed[rows, 0]) <= MET * slopes.steep[rows])
        along = np.abs(missed[rows, 1] / slopes.gain[rows] * slopes.along[rows, 1])
        close = along <= CLOSER * np.maximum(np.abs(pairs[rows, 1]), 1.0) if trial < ENOUGH else np.isfinite(along)
        done = none & (np.abs(missed[rows, 1]) <= CLOSE) & close
        met.append(rows[done])
        rows = rows[~done & np.isfinite(missed[rows]).all(axis=1)]
        if len(rows) == 0:
            break
        if trial % AGAIN == 0:
            slopes.look(held, rows, pairs[rows], missed[rows], pieces)
        shares = slopes.step(rows, missed[rows], pairs[rows])
        rows, shares = (array[np.isfinite(shares).all(axis=1)] for array in (rows, shares))
        pairs[rows] += slopes.moved(rows, shares)
        before, missed[rows] = missed[rows], held.missed(rows, pairs[rows], pieces)[0]
        slopes.learn(rows, shares, before, missed[rows])
    return np.sort(np.concatenate(met))


def load_slopes(held: Held, changed, load, middle, size):
    """How fast the load (n,) of states with that ``middle`` grows with each of several numbers, (n, p): ``changed`` are p
    pairs of tubes (:class:`Held`) whose number is larger, and smaller, by ``size``.
    """
    count = len(load)
    pairs, slopes, grown = (
        np.column_stack([middle, load / held.unit]),
        Slopes(count),
        np.full((count, len(changed)), np.nan),
    )
    with np.errstate(all="ignore"):
        rows = _met(held, np.flatnonzero(np.isfinite(pairs).all(axis=1)), pairs, slopes, 1)
        slopes.look(held, rows, pairs[rows], held.missed(rows, pairs[rows])[0])
        for k, ends in enumerate(changed):
            larger, smaller = (_moved_with(held, other, rows, pairs, slopes) for other in ends)
            grown[rows, k] = (larger - smaller) / (2.0 * size)
    return grown


def _moved_with(held, other, rows, pairs, slopes):
    """The loads of states of some rows of other tubes, near those of the ``held`` ones with these ``pairs``."""
    at = pairs[rows] * np.column_stack([np.ones(len(rows)), (held.unit / other.unit)[rows]])
    missed = other.missed(rows, at)[0]
    for _ in range(BACK):
        across = -missed[:, 0] / slopes.steep[rows]
        shares = np.column_stack([across, 0.0 * across])
        at = at + slopes.moved(rows, shares)
        before, missed = missed, other.missed(rows, at)[0]
        slopes.learn(rows, shares, before, missed)
    along = -missed[:, 1] / slopes.gain[rows]
    at = at + slopes.moved(rows, np.column_stack([0.0 * along, along]))
    return at[:, 1] * other.unit[rows]

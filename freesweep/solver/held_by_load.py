"""Held states of tubes that are the same all along: which force or torque mu gives a free state the length or rotation C
that is held. Of many states at once, by vectors of free ones.

From where the way begins (:mod:`.lanes.held`) C rises with mu, as far as free states are carried along it. mu is found by
the secant; where fibers all but lock the length, C nears the longest tube as 1/mu^2, so that it is the secant of ::

    h = 1/sqrt(longest - C)

The state found, and one beside it, tell how outputs change with mu, and so what the bound of C leaves open of all of them.
"""

from typing import NamedTuple

import numpy as np

from ..interpret import run
from .batch import OUTPUTS, PIECES, kinds_of
from .lanes.held import BEGINNING, HELD, LONGEST, MULTIPLIER, RISE, STRETCH, UNTAUT
from .physics.lagrangian import ROUNDING
from .physics.wall import LOOSE
from .problem import FORCE, PHYSICAL, THREADS, TORQUE, wall_columns
from .status import COMPRESSED, OK, PENDING

TURNS = 30  # solutions of one state, at most; some six do nearly always
LARGEST, FIRST = 4.0, 2.0  # step of mu, and the first one, to the loads
CLOSE, CLOSEST = 0.1, 1e-14  # to the target: share of C's bound, and of C
NEAREST = 1e-6  # share of p from which on the wall may not be pushed
UNSURE = 0.02  # share of the way in C to where the wall would be pushed: so near nothing is decided
SHORTER, LEAST_STEP = 0.3, 1e-3  # where free states are not carried so far
ASIDE, CAUTION = 1e-3, 2.0  # a state beside another, and times what it differs by
CLEAR = 20.0  # times its bounds: a difference of C that tells a slope
ROUGH, LEAST_ACCURACY = 1e-3, 1e-11  # asked of free states, at first and at most
COLUMN = {FORCE: 0, TORQUE: 2}  # of a free state's values


class States(NamedTuple):
    """Free states, one of each row: see :class:`.batch.Walks`."""

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    middles: np.ndarray


def room_for(count, columns) -> States:
    """States that are not there yet."""
    return States(
        *np.full((2, count, columns), np.nan), np.full(count, PENDING), np.zeros(count, np.int64),
        np.full((count, 2), np.nan),
    )  # fmt: skip


class Search:
    """Held states of ``problems`` (n, ...), each under its pressure: half its length or rotation, whose load is the column
    ``unknown`` of a problem, shall be ``targets``.
    """

    def __init__(self, problems, pressures, targets, unknown, accuracy, soon):
        self.problems, self.pressures, self.targets = problems.copy(), pressures, targets
        self.unknown, self.accuracy, self.soon = unknown, accuracy, soon
        self.kinds = [(solve, kind, some) for _, solve, kind, some in kinds_of(problems)]
        self.fine = np.full(len(problems), max(ROUGH, accuracy))
        self.columns = OUTPUTS + (6 if wall_columns(problems) == PHYSICAL else 0)

    def begin(self, found):
        """Write what needs no search to ``found``; returns where others begin."""
        from .lanes import held

        beginnings, some = np.full((len(self.problems), BEGINNING), np.nan), self.pressures > 0.0
        if wall_columns(self.problems) == PHYSICAL:
            some &= self.problems[:, THREADS] <= LOOSE  # of a single family the cylinder leaves the load open
        every = np.flatnonzero(some)
        for _, kind, some in self.kinds:
            start, rows = held.start_lanes if len(kind) == 1 else held.start_physical, every[some[every]]
            given = self.problems, self.pressures, self.targets, rows, self.unknown == FORCE, *kind
            if len(rows):
                run(start, len(rows), self.soon, *given, *found[:4], beginnings)
        known = np.flatnonzero(found.status == OK)
        self.solve(known, found.loads[known], np.ones(len(known)), found.states)
        found.status[known] = found.states.status[known]
        return beginnings

    def move(self, rows, before, after, stretches):
        """The uniform stretches of some rows carried from one multiplier to another; NaN where they are not."""
        from .lanes import held

        carried = np.full((3, len(self.problems)), np.nan)
        carried[:, rows] = before, after, stretches
        for _, kind, some in self.kinds:
            move, own = held.move_lanes if len(kind) == 1 else held.move_physical, rows[some[rows]]
            if len(own):
                given = self.problems, self.pressures, own, self.unknown == FORCE, *kind
                run(move, len(own), self.soon, *given, *carried)
        return carried[2, rows]

    def solve(self, rows, multipliers, stretches, states):
        """The free states of some rows under these multipliers, as exactly as each needs."""
        self.problems[rows, self.unknown] = multipliers
        states.status[rows] = PENDING
        start = np.full(len(self.problems), np.nan)
        start[rows] = stretches
        owners = np.arange(len(self.problems))
        for solve, kind, some in self.kinds:
            for asked in np.unique(self.fine[rows]):
                own = rows[some[rows] & (self.fine[rows] == asked)]
                for pieces in PIECES:
                    left = own[states.status[own] == PENDING]
                    if len(left):
                        given = self.problems, owners, self.pressures, start, left, *kind, pieces, asked
                        run(solve, len(left), self.soon, *given, *states)


def hold_by_load(problems, pressures, targets, unknown, accuracy, found, soon=False):
    """Write the held states that are found by free ones to ``found`` (:class:`.hold_batch.Holds`); others stay PENDING."""
    search = Search(problems, pressures, targets, unknown, accuracy, soon)
    with np.errstate(all="ignore"):
        beginnings = search.begin(found)
        rows = np.flatnonzero((found.status == PENDING) & np.isfinite(beginnings[:, STRETCH]))
        found.paths[rows] = beginnings[rows, UNTAUT] != 0.0
        way = Way(search, rows, beginnings)
        for _ in range(TURNS):
            if not len(way.rows):
                break
            way.step(found)


class Way:
    """Where the search stands, of the rows that are left: the state last come to, the next multiplier, and of both sides
    of the target the nearest multiplier.
    """

    def __init__(self, search, rows, beginnings):
        n = len(search.problems)
        own = beginnings[rows]
        self.search, self.rows = search, rows
        self.states = room_for(n, search.columns)
        self.stretch, self.mu, self.at = (
            beginnings[:, STRETCH].copy(),
            np.full(n, np.nan),
            beginnings[:, MULTIPLIER].copy(),
        )
        self.origin, self.first, self.longest = self.at.copy(), beginnings[:, HELD].copy(), beginnings[:, LONGEST]
        self.low, self.high = np.full(n, -np.inf), np.full(n, np.inf)
        self.before = np.full((2, n), np.nan)  # mu and h of another state
        given = search.problems[:, TORQUE if search.unknown == FORCE else FORCE]
        self.loads = np.maximum(search.pressures, np.abs(given))
        if search.unknown == FORCE:
            self.low = -search.pressures.copy()
        known = rows[np.isfinite(own[:, HELD])]
        c, target = self.first[known], search.targets[known]
        self.before[:, known] = self.at[known], self.height(known, c)
        aim = self.height(known, target) - self.before[1, known]
        rise = beginnings[known, RISE] * (aim / (target - c))
        size = FIRST * self.size(known)
        self.mu[known] = self.at[known] + np.clip(aim / rise, -size, size)
        self.side(known, c)
        free = rows[np.isnan(own[:, HELD])]
        self.mu[free] = self.at[free]
        self.mu[rows] = self.allowed(rows, self.mu[rows])

    def size(self, rows):
        """By what a multiplier is measured."""
        return np.maximum(self.loads[rows], np.abs(self.at[rows]))

    def height(self, rows, c):
        """What the secant is of."""
        return 1.0 / np.sqrt(self.longest[rows] - c) if self.search.unknown == FORCE else c

    def side(self, rows, c):
        """The state come to lies on one side of the target."""
        short = c < self.search.targets[rows]
        self.low[rows[short]] = np.maximum(self.low[rows[short]], self.at[rows[short]])
        self.high[rows[~short]] = np.minimum(self.high[rows[~short]], self.at[rows[~short]])

    def allowed(self, rows, mu):
        """A multiplier nearest to ``mu`` that does not push the wall."""
        if self.search.unknown == TORQUE:
            return mu
        return np.maximum(mu, -(1.0 - NEAREST) * self.search.pressures[rows])

    def step(self, found):
        """Solve the rows that are left once more."""
        search, rows, states = self.search, self.rows, self.states
        carried = search.move(rows, self.at[rows], self.mu[rows], self.stretch[rows])
        came = np.isfinite(carried)
        short = rows[~came]
        self.mu[short] = self.at[short] + SHORTER * (self.mu[short] - self.at[short])
        stuck = np.abs(self.mu[short] - self.at[short]) < LEAST_STEP * self.size(short)
        rows = rows[came]
        search.solve(rows, self.mu[rows], carried[came], states)
        met = states.status[rows] == OK
        rows = rows[met]
        self.stretch[rows] = carried[came][met]
        self.at[rows] = self.mu[rows]
        c, bound = states.values[rows, COLUMN[search.unknown]], states.bounds[rows, COLUMN[search.unknown]]
        missed = search.targets[rows] - c
        self.side(rows, c)
        closed = self.high[rows] - self.low[rows] <= ROUNDING * self.size(rows)
        done = closed | (np.abs(missed) <= np.maximum(CLOSE * bound, CLOSEST * np.abs(c)))
        refused = self.refuse(rows, c, found)
        self.aim(rows, c)
        finer = self.settle(rows[done], found)
        self.rows = np.sort(np.concatenate([short[~stuck], rows[~done & ~refused], finer]))

    def aim(self, rows, c):
        """The next multiplier of rows that came to ``c``."""
        here = self.height(rows, c)
        mu, h = self.before[:, rows]
        self.before[:, rows] = self.at[rows], here
        rise = (here - h) / (self.at[rows] - mu)
        size = LARGEST * self.size(rows)
        ahead = np.clip((self.height(rows, self.search.targets[rows]) - here) / rise, -size, size)
        up = np.where(c < self.search.targets[rows], 1.0, -1.0)
        ahead = self.at[rows] + np.where(rise > 0.0, ahead, up * 0.25 * self.size(rows))
        between = (self.low[rows] < ahead) & (ahead < self.high[rows])
        middle = 0.5 * (self.low[rows] + self.high[rows])
        self.mu[rows] = self.allowed(rows, np.where(between | ~np.isfinite(middle), ahead, middle))

    def refuse(self, rows, c, found):
        """Rows whose wall would have to be pushed: all but without a pull the tube is still too long."""
        if self.search.unknown == TORQUE:
            return np.zeros(len(rows), bool)
        too_long = c - self.search.targets[rows]
        fresh = np.isnan(self.first[rows])
        self.first[rows[fresh]] = c[fresh]
        limp = self.at[rows] <= -(1.0 - 2.0 * NEAREST) * self.search.pressures[rows]
        refused = limp & (too_long > UNSURE * np.abs(self.first[rows] - c))
        found.status[rows[refused]] = COMPRESSED
        return limp & (too_long > 0.0)

    def settle(self, rows, found):
        """Tell the states of rows that have come to what is held; returns those that have to be solved more exactly."""
        if not len(rows):
            return rows
        search, column = self.search, COLUMN[self.search.unknown]
        here, beside = self.states, room_for(len(search.problems), search.columns)
        toward = np.sign(self.origin[rows] - self.at[rows])
        aside = np.where(toward == 0.0, 1.0, toward) * ASIDE * self.size(rows)
        mu = self.at[rows]
        carried = search.move(rows, mu, mu + aside, self.stretch[rows])
        there = rows[np.isfinite(carried)]
        search.solve(there, (mu + aside)[np.isfinite(carried)], carried[np.isfinite(carried)], beside)
        search.problems[rows, search.unknown] = mu
        change = (beside.values[rows] - here.values[rows]) / aside[:, None]
        slope, c = change[:, column], here.values[rows, column]
        unsure = (here.bounds[rows, column] + np.abs(search.targets[rows] - c)) / slope
        size = self.size(rows)
        bound = CAUTION * unsure + ROUNDING * size
        sound = (beside.status[rows] == OK) & (slope > 0.0)
        ready = sound & (bound <= search.accuracy * size)
        own, part = rows[ready], np.flatnonzero(ready)
        rest = ((search.targets[rows] - c) / slope)[part]
        found.loads[own], found.load_bounds[own] = mu[part] + rest, bound[part]
        found.status[own], found.stable[own] = OK, 1
        for one, other in zip(found.states, here):
            one[own] = other[own]
        found.states.values[own] += change[part] * rest[:, None]
        found.states.bounds[own] += np.abs(change[part]) * bound[part][:, None]
        found.beside[0][own] = (mu + aside)[part]
        found.beside[1][own] = beside.middles[own]
        left = sound & ~ready
        again = rows[left]
        most = np.maximum(4.0 * bound / (search.accuracy * size), 10.0)[left]
        search.fine[again] *= 10.0 ** -np.ceil(np.log10(most))
        return again[search.fine[again] >= LEAST_ACCURACY]

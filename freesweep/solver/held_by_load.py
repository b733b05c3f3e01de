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
from .lanes import held
from .lanes.held import AT_CYLINDER, AT_OPPOSITE, BEGINNING, HELD, LONGEST, LOST, MULTIPLIER, RISE, STRETCH, TRIALS
from .physics.lagrangian import ROUNDING
from .physics.wall import LOOSE
from .problem import AREA, FORCE, PHYSICAL, THREADS, TORQUE, wall_columns
from .status import COMPRESSED, HELD_IMPOSSIBLE, OK, PENDING

TURNS = 30  # solutions of one state, at most; some six do nearly always
LARGEST, FIRST = 4.0, 2.0  # step of mu, and the first one, to the loads
CLOSE, NEAR = 0.1, 1e-3  # to the target: shares of C's bound, and of what the accuracy leaves open
NEAREST = 1e-6  # share of p from which on the wall may not be pushed
UNSURE = 0.02  # share of the way in C to where the wall would be pushed: so near nothing is decided
SHORTER, LEAST_STEP = 0.3, 1e-3  # where free states are not carried so far: the next step, and the least to the loads
UNKNOWN = 0.25  # of the loads: a step where no secant is known
ASIDE, CAUTION = 1e-3, 2.0  # a state beside another, and times what it differs by
ROUGH, LEAST_ACCURACY = 1e-3, 1e-10  # asked of free states, at first and at most
FAR = 1e3  # times the loads, or what the wall bears: a length that so much force does not come to is beyond reach
FEW = 2  # tries at what is asked at first
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
        self.rough = np.full(len(problems), max(ROUGH, accuracy))
        self.fine = self.rough.copy()
        self.columns = OUTPUTS + (6 if wall_columns(problems) == PHYSICAL else 0)

    def begin(self, found, trial):
        """Write what needs no search to ``found``; returns where others begin, in one of the :data:`.lanes.held.TRIALS`."""
        beginnings, asked = np.full((len(self.problems), BEGINNING), np.nan), self.pressures > 0.0
        beginnings[:, LOST] = trial
        asked &= found.status == PENDING
        if wall_columns(self.problems) == PHYSICAL:
            asked &= self.problems[:, THREADS] <= LOOSE  # of a single family the cylinder leaves the load open
        every = np.flatnonzero(asked)
        for _, kind, some in self.kinds:
            start, rows = held.start_lanes if len(kind) == 1 else held.start_physical, every[some[every]]
            given = self.problems, self.pressures, self.targets, rows, self.unknown == FORCE, *kind
            if len(rows):
                run(start, len(rows), self.soon, *given, *found[:4], beginnings)
        known = every[found.status[every] == OK]
        self.solve(known, found.loads[known], np.ones(len(known)), found.states, self.rough)
        found.status[known] = found.states.status[known]
        return beginnings

    def move(self, rows, before, after, stretches):
        """The uniform stretches of some rows carried from one multiplier to another; NaN where they are not."""
        carried = np.full((3, len(self.problems)), np.nan)
        carried[:, rows] = before, after, stretches
        for _, kind, some in self.kinds:
            move, own = held.move_lanes if len(kind) == 1 else held.move_physical, rows[some[rows]]
            if len(own):
                given = self.problems, self.pressures, own, self.unknown == FORCE, *kind
                run(move, len(own), self.soon, *given, *carried)
        return carried[2, rows]

    def solve(self, rows, multipliers, stretches, states, fine):
        """The free states of some rows under these multipliers, as exactly as the row asks for in ``fine``."""
        self.problems[rows, self.unknown] = multipliers
        states.status[rows] = PENDING
        start = np.full(len(self.problems), np.nan)
        start[rows] = stretches
        owners = np.arange(len(self.problems))
        for solve, kind, some in self.kinds:
            for asked in np.unique(fine[rows]):
                own = rows[some[rows] & (fine[rows] == asked)]
                for pieces in PIECES[: FEW if asked >= ROUGH else None]:
                    left = own[states.status[own] == PENDING]
                    if len(left):
                        given = self.problems, owners, self.pressures, start, left, *kind, pieces, asked
                        run(solve, len(left), self.soon, *given, *states)


def hold_by_load(problems, pressures, targets, unknown, accuracy, found, soon=False):
    """Write the held states that are found by free ones to ``found`` (:class:`.hold_batch.Holds`); others stay PENDING."""
    search = Search(problems, pressures, targets, unknown, accuracy, soon)
    with np.errstate(all="ignore"):
        begun = np.nan
        for trial in TRIALS:
            beginnings = search.begin(found, trial)
            fresh = np.isfinite(beginnings[:, STRETCH]) & (beginnings[:, MULTIPLIER] != begun)
            rows, begun = np.flatnonzero((found.status == PENDING) & fresh), beginnings[:, MULTIPLIER]
            if len(rows):
                found.paths[rows] = (beginnings[rows, LOST] != 0.0) | (trial != AT_CYLINDER)
                Way(search, rows, beginnings, trial != AT_OPPOSITE).go(found)


class Way:
    """Where the search stands, of the rows that are left: the state last come to, and the nearest on both sides of the
    target (multiplier, uniform stretch); between those the uniform tube needs no carrying. What began with a push, not
    ``pulled``, tells nothing of states that a pull leads to.
    """

    def __init__(self, search, rows, beginnings, pulled):
        n, own = len(search.problems), beginnings[rows]
        self.search, self.rows, self.states = search, rows, room_for(n, search.columns)
        self.begun, self.pulled = rows, pulled
        self.at, self.stretch, self.first = (beginnings[:, k].copy() for k in (MULTIPLIER, STRETCH, HELD))
        self.origin, self.longest = self.at.copy(), beginnings[:, LONGEST]
        self.before, self.sides = np.full((2, n), np.nan), np.full((2, 2, n), np.nan)
        given = search.problems[:, TORQUE if search.unknown == FORCE else FORCE]
        self.loads = np.maximum(search.pressures, np.abs(given))
        self.mu = self.at.copy()
        known = rows[np.isfinite(own[:, HELD])]
        aim = self.height(known, search.targets[known]) - self.height(known, self.first[known])
        rise = beginnings[known, RISE] * (aim / (search.targets[known] - self.first[known]))
        self.keep(known, self.first[known])
        size = FIRST * self.size(known)
        self.mu[known] = self.allowed(known, self.at[known] + np.clip(aim / rise, -size, size))

    def go(self, found):
        """Search until each row has its state, or is given up."""
        for _ in range(TURNS):
            if not len(self.rows):
                break
            self.step(found)
        self.end(found)

    def size(self, rows):
        """By what a multiplier is measured."""
        return np.maximum(self.loads[rows], np.abs(self.at[rows]))

    def height(self, rows, c):
        """What the secant is of."""
        return 1.0 / np.sqrt(self.longest[rows] - c) if self.search.unknown == FORCE else c

    def allowed(self, rows, mu):
        """A multiplier nearest to ``mu`` that does not push the wall."""
        if self.search.unknown == TORQUE:
            return mu
        return np.maximum(mu, -(1.0 - NEAREST) * self.search.pressures[rows])

    def keep(self, rows, c):
        """The state come to is the nearest on its side of the target; it has no other before it."""
        side = (c > self.search.targets[rows]).astype(int)
        self.sides[side, 0, rows], self.sides[side, 1, rows] = self.at[rows], self.stretch[rows]
        self.before[:, rows] = self.at[rows], self.height(rows, c)

    def step(self, found):
        """Solve the rows that are left once more."""
        search, rows, states, column = self.search, self.rows, self.states, COLUMN[self.search.unknown]
        stretch, between = self.carried(rows)
        came, states.status[rows] = np.isfinite(stretch), PENDING
        search.solve(rows[came], self.mu[rows[came]], stretch[came], states, search.fine)
        own, (low, high) = states.middles[rows, 0], np.sort(self.sides[:, 1, rows], axis=0)
        met = (states.status[rows] == OK) & (np.logical_not(between) | ((low <= own) & (own <= high)))
        short = rows[np.logical_not(met)]
        self.sides[:, :, short] = np.nan
        self.mu[short] = self.at[short] + SHORTER * (self.mu[short] - self.at[short])
        far = np.abs(self.mu[short] - self.at[short]) > LEAST_STEP * self.size(short)
        rows = rows[met]
        self.at[rows], self.stretch[rows] = self.mu[rows], own[met]
        c, bound = states.values[rows, column], states.bounds[rows, column]
        missed = search.targets[rows] - c
        self.aim(rows, c)
        near = np.abs(self.mu[rows] - self.at[rows]) <= NEAR * search.accuracy * self.size(rows)
        done = near | (np.abs(missed) <= CLOSE * bound)
        refused = self.refuse(rows, c, found) & np.logical_not(done)
        finer = self.settle(rows[done], found)
        self.rows = np.sort(np.concatenate([short[far], rows[np.logical_not(done | refused)], finer]))

    def end(self, found):
        """Tell of which rows no pull comes to the length that is held."""
        if self.search.unknown == TORQUE:
            return
        rows = self.begun[(found.status[self.begun] == PENDING) & np.isnan(self.sides[1, 0, self.begun])]
        least = FAR * np.maximum(self.loads[rows], self.search.problems[rows, AREA])
        found.status[rows[self.at[rows] > least]] = HELD_IMPOSSIBLE

    def carried(self, rows):
        """Uniform stretches under the next multipliers, NaN where none is come to; and which lie between two known ones."""
        (low, u_low), (high, u_high) = self.sides[:, :, rows]
        part = (self.mu[rows] - low) / (high - low)
        stretch, between = u_low + part * (u_high - u_low), np.isfinite(part)
        beyond = rows[np.logical_not(between)]
        stretch[np.logical_not(between)] = self.search.move(
            beyond, self.at[beyond], self.mu[beyond], self.stretch[beyond]
        )
        return stretch, between

    def aim(self, rows, c):
        """The next multiplier of rows that came to ``c``: by the secant, or half way to the other side."""
        mu, h = self.before[:, rows]
        self.keep(rows, c)
        here, target = self.before[1, rows], self.search.targets[rows]
        rise, size = (here - h) / (self.at[rows] - mu), self.size(rows)
        step = np.clip((self.height(rows, target) - here) / rise, -LARGEST * size, LARGEST * size)
        ahead = self.at[rows] + np.where(rise > 0.0, step, np.where(c < target, 1.0, -1.0) * UNKNOWN * size)
        low, high = self.sides[:, 0, rows]
        outside = (ahead <= low) | (high <= ahead)
        self.mu[rows] = self.allowed(rows, np.where(outside & np.isfinite(low + high), 0.5 * (low + high), ahead))

    def refuse(self, rows, c, found):
        """Rows whose wall would have to be pushed: all but without a pull the tube is still too long."""
        if self.search.unknown == TORQUE:
            return np.zeros(len(rows), bool)
        too_long, fresh = c - self.search.targets[rows], np.isnan(self.first[rows])
        self.first[rows[fresh]] = c[fresh]
        limp = self.at[rows] <= -(1.0 - 2.0 * NEAREST) * self.search.pressures[rows]
        if self.pulled:
            found.status[rows[limp & (too_long > UNSURE * np.abs(self.first[rows] - c))]] = COMPRESSED
        return limp & (too_long > 0.0)

    def settle(self, rows, found):
        """Tell the states of rows that have come to what is held; returns those that have to be solved more exactly."""
        search, here, column = self.search, self.states, COLUMN[self.search.unknown]
        if not len(rows):
            return rows
        mu, size, beside = self.at[rows], self.size(rows), room_for(len(search.problems), search.columns)
        aside = np.where(self.origin[rows] >= mu, 1.0, -1.0) * ASIDE * size
        search.solve(rows, mu + aside, self.stretch[rows], beside, search.rough)
        change, c = (beside.values[rows] - here.values[rows]) / aside[:, None], here.values[rows, column]
        slope, rest = change[:, column], (search.targets[rows] - c) / change[:, column]
        bound = CAUTION * (here.bounds[rows, column] / slope + np.abs(rest)) + ROUNDING * size
        sound = (beside.status[rows] == OK) & (slope > 0.0)
        ready = sound & (bound <= search.accuracy * size)
        own, change, rest, part = rows[ready], change[ready], rest[ready], bound[ready]
        found.loads[own], found.load_bounds[own] = mu[ready] + rest, part
        found.status[own], found.stable[own] = OK, 1
        for one, other in zip(found.states, here):
            one[own] = other[own]
        found.states.values[own] += change * rest[:, None]
        found.states.bounds[own] += np.abs(change) * part[:, None]
        found.beside.loads[own], found.beside.middles[own] = (mu + aside)[ready], beside.middles[own]
        found.beside.parts[own] = part / np.abs(aside[ready])
        left = sound & np.logical_not(ready)
        again = rows[left]
        most = np.maximum(4.0 * bound / (search.accuracy * size), 10.0)[left]
        search.fine[again] *= 10.0 ** -np.ceil(np.log10(most))
        return again[search.fine[again] >= LEAST_ACCURACY]

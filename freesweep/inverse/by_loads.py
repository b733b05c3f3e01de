"""Physical tubes of which something is held, many at a time: vectors solve free ones only, so the load that holds each is
sought among these, by the secant between loads that hold too little and too much.
"""

import numpy as np

from ..query.reference import COLUMNS
from ..status import NOT_CONVERGED, OK, VALUED
from .predict import UNKNOWN
from .wishes import HELD

ROUNDS, FEW, ROUGH = 24, 10, 1e-5  # steps; of a rough look, whose accuracy is not that
LOST, LOST_NEAR = 5, 2  # steps, one after the other, to where no free tube is, which take longest; from a load beside
SLOW = 0.5  # of what was missed: a step that wins less is no step of the secant's, halves the way instead
FIRST = 1e-3  # of the load that the pressure alone makes: the first step
LEAST = 1e-2  # of c10: a pressure that such steps are measured by
NEAR = 0.1  # accuracies: what is held is met so closely, before the last step
ROUNDING = 1e-12  # relative
DEGREES = 57.3  # what a rotation is measured by


class _Search:
    """The search for loads (n,) under which free tubes do what is held, each between loads that do too little and too much:
    the best so far ``at``, by how much it is ``off``, in units of what is held, what is in ``doubt`` of that, and the
    ``slope``; of the state there the slack families and the middle's radius, or, where there is none, its status.
    """

    def __init__(self, kind, points, free, near):
        count, self.load, self.moved = len(points), COLUMNS.index(kind), HELD[kind][0]
        column = {name: points[:, k] for k, name in enumerate(COLUMNS)}
        self.points, self.free, self.near = points, free, near
        self.unit = column["length"] if kind == "force" else np.full(count, DEGREES)
        self.target = column["held"] * (column["length"] if kind == "force" else 1.0)
        size = np.pi * column["fiber_radius"] ** (2 if kind == "force" else 3)
        self.size = size * np.maximum(column["pressure"], LEAST * column["c10"])
        self.at, self.trial = np.nan_to_num(near), np.nan_to_num(near)
        self.off, self.doubt, self.slope, self.radii = np.full((4, count), np.nan)
        self.slack, self.status = np.zeros(count, np.int8), np.full(count, NOT_CONVERGED, np.int8)
        self.low, self.high, self.lost = np.full(count, -np.inf), np.full(count, np.inf), np.zeros(count, int)

    def look(self, rows, loads):
        """What free tubes under these ``loads`` are off, what is in doubt of that, their slack families and radii."""
        own = self.points[rows].copy()
        own[:, self.load] = loads
        found = self.free(own)
        names = (self.moved, f"{self.moved}_error", "slack_fiber", "mid_radius")
        value, bound, flags, radius = (found[name] for name in names)
        self.status[rows] = np.where(np.isin(found["status"], VALUED), NOT_CONVERGED, found["status"])
        return (value - self.target[rows]) / self.unit[rows], bound / self.unit[rows], flags, radius

    def begin(self, rows, like):
        """Look at what is near, or at no load, and choose where to look next: ``like(points)`` is a first step."""
        if len(rows):
            self.off[rows], self.doubt[rows], self.slack[rows], self.radii[rows] = self.look(rows, self.at[rows])
        self.trial = self.at + FIRST * self.size
        if len(far := rows[np.isnan(self.near[rows])]):
            self.trial[far] += np.nan_to_num(like(self.points[far]))
        self.low[self.off < 0.0], self.high[self.off > 0.0] = self.at[self.off < 0.0], self.at[self.off > 0.0]

    def met(self, accuracy):
        """Where what is held is met as closely as the last step needs, (n,)."""
        return (np.abs(self.off) <= NEAR * accuracy) & np.isfinite(self.slope)

    def follow(self, rows, accuracy):
        """Look on until all that can be is met."""
        most = np.where(np.isfinite(self.near), LOST_NEAR, LOST)
        for _ in range(ROUNDS if accuracy < ROUGH else FEW):
            rows = rows[np.isfinite(self.off[rows]) & ~self.met(accuracy)[rows] & (self.lost[rows] < most[rows])]
            if len(rows) == 0:
                break
            self._step(rows)

    def _step(self, rows):
        """One look at each of some rows, and the next trial by the secant, or halfway where that wins little."""
        tried, at, off = self.trial[rows], self.at[rows], self.off[rows]
        miss, bound, flags, radius = self.look(rows, tried)
        self.lost[rows] = np.where(np.isfinite(miss), 0, self.lost[rows] + 1)
        self.low[rows] = np.where(miss < 0.0, np.maximum(self.low[rows], tried), self.low[rows])
        self.high[rows] = np.where(miss > 0.0, np.minimum(self.high[rows], tried), self.high[rows])
        new = (miss - off) / (tried - at)
        rises = np.isfinite(new) & (new > 0.0)
        self.slope[rows[rises]] = new[rises]
        slow = np.abs(miss) > SLOW * np.abs(off)
        better = np.isfinite(miss) & (np.abs(miss) < np.abs(off))
        won = rows[better]
        self.at[won], self.off[won], self.doubt[won] = tried[better], miss[better], bound[better]
        self.slack[won], self.radii[won] = flags[better], radius[better]
        with np.errstate(invalid="ignore"):
            ahead = self.at[rows] - self.off[rows] / self.slope[rows]
            middle = 0.5 * (self.low[rows] + self.high[rows])
            inside = (ahead > self.low[rows]) & (ahead < self.high[rows]) & ~(slow & np.isfinite(middle))
        back = 0.5 * (self.at[rows] + tried)
        ahead = np.where(inside, ahead, np.where(np.isfinite(middle), middle, back))
        self.trial[rows] = np.where(np.isfinite(miss), ahead, back)

    def loads(self):
        """Loads and their bounds (n,): one more step of the secant."""
        with np.errstate(invalid="ignore"):
            return self.at - self.off / self.slope, (self.doubt + np.abs(self.off)) / np.abs(self.slope)


def hold_by_loads(kind, points, free, like, alone, accuracy, two, near):
    """As of :func:`freesweep.query.exact.solve`: the load ``kind`` that holds what ``points`` (n, 17) say, and the middle's
    radius, NaN of tubes that stay straight.

    ``free(points)`` solves free tubes; ``like(points)`` (n,) are loads that hold tubes like these; what is not found
    ``alone(points)`` solves, if it is not None; ``two``: there are two families of fibers;
    ``near`` (n,): loads of designs beside these, NaN of none.
    """
    count = len(points)
    straight = straight_loads(kind, points) if two else np.full(count, np.nan)
    stays = np.isfinite(straight)
    search, rows = _Search(kind, points, free, near), np.flatnonzero(~stays)
    search.begin(rows, like)
    search.follow(rows, accuracy)
    value, bound = search.loads()
    done = stays | search.met(accuracy)
    found = {
        kind: np.where(done, np.where(stays, straight, value), np.nan),
        f"{kind}_error": np.where(done, np.where(stays, ROUNDING * np.abs(straight), bound), np.nan),
        "status": np.where(done, OK, search.status),
        "slack_fiber": np.where(done, search.slack, 0).astype(np.int8),
        "stable": np.full(count, UNKNOWN, np.int8),
        "mid_radius": np.where(done & ~stays, search.radii, np.nan),
    }
    left = np.flatnonzero(~done)
    if alone is not None and len(left):
        other = alone(points[left])
        for name, array in found.items():
            array[left] = other[name]
    return found


def straight_loads(kind, points):
    """Loads (n,) that hold tubes as they are undeformed, where all their fibers pull: those of Eqs. 2.16 and 2.20, whatever
    the wall is; else NaN. No load given leads there beyond the pressure at which such a tube would snap or buckle.
    """
    column = {name: points[:, k] for k, name in enumerate(COLUMNS)}
    ta, tb = np.tan(np.radians(column["alpha"])), np.tan(np.radians(column["beta"]))
    r, natural = column["fiber_radius"], column["held"] == (1.0 if kind == "force" else 0.0)
    p, f, m = column["pressure"], column["force"] / (np.pi * r**2), column["torque"] / (np.pi * r**3)
    with np.errstate(all="ignore"):
        if kind == "force":
            f = ((ta + tb) * m - 2.0 * p) / (ta * tb) - p
        else:
            m = (2.0 * p + (p + f) * ta * tb) / (ta + tb)
        of_alpha, of_beta = (m - tb * (p + f)) / (ta - tb), (ta * (p + f) - m) / (ta - tb)
        there = natural & (of_alpha > 0.0) & (of_beta > 0.0) & (column["fiber_extension"] == 1.0)
    return np.where(there, np.pi * r**2 * f if kind == "force" else np.pi * r**3 * m, np.nan)

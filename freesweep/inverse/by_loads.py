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


def hold_by_loads(kind, points, free, like, alone, accuracy, two, near):
    """As of :func:`freesweep.query.exact.solve`: the load ``kind`` that holds what ``points`` (n, 17) say, and the middle's
    radius, NaN of tubes that stay straight.

    ``free(points)`` solves free tubes; ``like(points)`` (n,) are loads that hold tubes like these; what is not found
    ``alone(points)`` solves, if it is not None; ``two``: there are two families of fibers;
    ``near`` (n,): loads of designs beside these, NaN of none.
    """
    count, load, moved = len(points), COLUMNS.index(kind), HELD[kind][0]
    column = {name: points[:, k] for k, name in enumerate(COLUMNS)}
    unit = column["length"] if kind == "force" else np.full(count, DEGREES)
    target = column["held"] * (column["length"] if kind == "force" else 1.0)
    size = np.pi * column["fiber_radius"] ** (2 if kind == "force" else 3)
    size = size * np.maximum(column["pressure"], LEAST * column["c10"])
    names = (moved, f"{moved}_error", "slack_fiber", "mid_radius")
    at, off, slope = np.nan_to_num(near), np.full(count, np.nan), np.full(count, np.nan)
    doubt, slack, status = np.full(count, np.nan), np.zeros(count, np.int8), np.full(count, NOT_CONVERGED, np.int8)
    radii, lost = np.full(count, np.nan), np.zeros(count, int)
    most = np.where(np.isfinite(near), LOST_NEAR, LOST)

    straight = straight_loads(kind, points) if two else np.full(count, np.nan)
    done = np.isfinite(straight)

    def look(rows, loads):
        own = points[rows].copy()
        own[:, load] = loads
        found = free(own)
        value, bound, flags, radius = (found[name] for name in names)
        status[rows] = np.where(np.isin(found["status"], VALUED), NOT_CONVERGED, found["status"])
        return (value - target[rows]) / unit[rows], bound / unit[rows], flags, radius

    rows = np.flatnonzero(~done)
    if len(rows):
        off[rows], doubt[rows], slack[rows], radii[rows] = look(rows, at[rows])
    trial = at + FIRST * size
    if len(far := rows[np.isnan(near[rows])]):
        trial[far] += np.nan_to_num(like(points[far]))
    low, high = np.where(off < 0.0, at, -np.inf), np.where(off > 0.0, at, np.inf)
    for _ in range(ROUNDS if accuracy < ROUGH else FEW):
        met = (np.abs(off[rows]) <= NEAR * accuracy) & np.isfinite(slope[rows])
        rows = rows[np.isfinite(off[rows]) & ~met & (lost[rows] < most[rows])]
        if len(rows) == 0:
            break
        tried = trial[rows]
        miss, bound, flags, radius = look(rows, tried)
        lost[rows] = np.where(np.isfinite(miss), 0, lost[rows] + 1)
        low[rows] = np.where(miss < 0.0, np.maximum(low[rows], tried), low[rows])
        high[rows] = np.where(miss > 0.0, np.minimum(high[rows], tried), high[rows])
        new = (miss - off[rows]) / (tried - at[rows])
        rises = np.isfinite(new) & (new > 0.0)
        slope[rows[rises]] = new[rises]
        slow = np.abs(miss) > SLOW * np.abs(off[rows])
        better = np.isfinite(miss) & (np.abs(miss) < np.abs(off[rows]))
        won = rows[better]
        at[won], off[won], doubt[won] = tried[better], miss[better], bound[better]
        slack[won], radii[won] = flags[better], radius[better]
        with np.errstate(invalid="ignore"):
            ahead, middle = at[rows] - off[rows] / slope[rows], 0.5 * (low[rows] + high[rows])
            inside = (ahead > low[rows]) & (ahead < high[rows]) & ~(slow & np.isfinite(middle))
        ahead = np.where(inside, ahead, np.where(np.isfinite(middle), middle, 0.5 * (at[rows] + tried)))
        trial[rows] = np.where(np.isfinite(miss), ahead, 0.5 * (at[rows] + tried))
    with np.errstate(invalid="ignore"):
        value = np.where(done, straight, at - off / slope)
        bound = np.where(done, ROUNDING * np.abs(straight), (doubt + np.abs(off)) / np.abs(slope))
        done |= (np.abs(off) <= NEAR * accuracy) & np.isfinite(slope)
    status[done] = OK
    found = {
        kind: np.where(done, value, np.nan), f"{kind}_error": np.where(done, bound, np.nan), "status": status,
        "slack_fiber": np.where(done, slack, 0).astype(np.int8), "stable": np.full(count, UNKNOWN, np.int8),
        "mid_radius": np.where(done & np.isnan(straight), radii, np.nan),
    }  # fmt: skip
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

"""Places on one step of a branch: where it has a pressure, and where its pressure turns."""

import numpy as np

from ..by_middle.states import GOLDEN
from .branch import step
from .waves import PRESSURE

HALVINGS, MET = 60, 1e-9  # to a pressure; the share of a step that is none
LOOKS, FLAT, THIN = 30, 1e-10, 1e-4  # to a turn: how exactly its pressure, and its place, are met


def at_pressure(asked, here, length, pieces, pressure):
    """The point of a step from ``here`` that has a pressure, by the regula falsi of Illinois; None where none has."""

    def missed(point):
        return point.look.pair.numbers[PRESSURE] - np.log(pressure)

    point = step(asked, here, length, pieces)
    if point is None:
        return None
    low, high, weights, kept = (0.0, missed(here)), (length, missed(point)), [1.0, 1.0], 0
    if high[1] == 0.0 or low[1] == 0.0:
        return point if high[1] == 0.0 else here
    if high[1] * low[1] > 0.0:
        return None
    for _ in range(HALVINGS):
        below, above = weights[0] * low[1], weights[1] * high[1]
        at = (low[0] * above - high[0] * below) / (above - below)
        point = step(asked, here, at, pieces)
        if point is None:
            return None
        miss = missed(point)
        if miss * low[1] > 0.0:
            low, weights, kept = (at, miss), [1.0, 0.5 * weights[1] if kept == 1 else 1.0], 1
        else:
            high, weights, kept = (at, miss), [0.5 * weights[0] if kept == -1 else 1.0, 1.0], -1
        if miss == 0.0 or abs(high[0] - low[0]) < MET * length:
            break
    return point


def turn(asked, here, length, there, pieces):
    """``(point, how far from here, by how much it stands out)`` where the pressure turns on a step, by parabolas; None where
    it is not met. Pressures tell, as their slopes have few digits where waves are faint.
    """
    sense = 1.0 if here.toward[PRESSURE] < 0.0 else -1.0
    a, c = (0.0, sense * here.look.pair.numbers[PRESSURE]), (length, sense * there.look.pair.numbers[PRESSURE])
    falls, rises = abs(here.toward[PRESSURE]), abs(there.toward[PRESSURE])
    best, at = None, length * falls / (falls + rises)
    for look in range(LOOKS):
        point = step(asked, here, at, pieces)
        if point is None:
            break
        now = at, sense * point.look.pair.numbers[PRESSURE]
        if best is None:
            b, best = now, point
        elif now[1] < b[1]:
            a, c = (b, c) if at > b[0] else (a, b)
            b, best = now, point
        else:
            a, c = (a, now) if at > b[0] else (now, c)
        stands_out = max(a[1], c[1]) - b[1]
        if stands_out < FLAT or c[0] - a[0] < THIN * length:
            break
        left, right = (b[0] - a[0]) * (b[1] - c[1]), (b[0] - c[0]) * (b[1] - a[1])
        at = b[0] - 0.5 * ((b[0] - a[0]) * left - (b[0] - c[0]) * right) / (left - right) if left != right else b[0]
        if not a[0] < at < c[0] or abs(at - b[0]) < FLAT * length or look % 3 == 2:
            at = b[0] + GOLDEN * ((c[0] - b[0]) if c[0] - b[0] > b[0] - a[0] else (a[0] - b[0]))
    return None if best is None else (best, b[0], stands_out)


def parts(asked, here, length, there, pieces):
    """The step, or both its parts where the pressure turns on it; each with by how much the turn at its end stands out, or
    None.
    """
    if here.toward[PRESSURE] * there.toward[PRESSURE] < 0.0:
        found = turn(asked, here, length, there, pieces)
        if found is not None:
            top, passed, stands_out = found
            return (here, passed, top, pieces, stands_out), (top, length - passed, there, pieces, None)
    return ((here, length, there, pieces, None),)

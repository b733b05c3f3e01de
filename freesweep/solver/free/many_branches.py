"""Physical tubes that are the same all along, on their branches in two numbers (:mod:`two_numbers`): many side by side, whose
questions vectors answer together (:mod:`..lanes.by_middle`).

A tube's ways are those of :mod:`..load_path`: loads rise from rest to their full size, then the pressure alone rises or
falls; for a locked shape the wall fades.
"""

from typing import NamedTuple

import numpy as np

from ..load_path import is_loaded, settling_pressure
from ..problem import AREA, FORCE, GAMMA, LENGTH, TORQUE
from ..stability import PUSHED
from ..status import BEYOND_LIMIT, COMPRESSED, INACCURATE, OK, PENDING
from . import two_numbers


PIECES = 1, 2, 4, 16  # in which each part of a tube is summed, one try after the other


class Way(NamedTuple):
    """Loads along a way, by its share: p, f, m, gamma and weight of the energy at its begin, and what they change by; of a
    way of pressure the unit p/(1 - share) is given.
    """

    origin: np.ndarray
    change: np.ndarray
    unit: float

    def load_at(self, share):
        """Pressure, force, torque, fiber extension and weight of the energy."""
        load = self.origin + share * self.change
        if self.unit:
            load[0] = self.unit * share / (1.0 - share)
        return load

    def share_of(self, pressure):
        """Where a pressure is met."""
        return pressure / (pressure + self.unit)


def ways_of(problem, settled):
    """``(way of the loads, way of the pressure)``."""
    f, m, gamma = problem[FORCE], problem[TORQUE], problem[GAMMA]
    unit = max(settled, problem[AREA])
    rise = Way(np.array([0.0, 0.0, 0.0, 1.0, 1.0]), np.array([settled, f, m, gamma - 1.0, 0.0]), 0.0)
    return rise, Way(np.array([0.0, f, m, gamma, 1.0]), np.zeros(5), unit)


def fading(problem):
    """The way to a locked shape."""
    return Way(np.array([0.0, 0.0, 0.0, 1.0, 1.0]), np.array([1.0, 0.0, 0.0, problem[GAMMA] - 1.0, -1.0]), 0.0)


class Rows(NamedTuple):
    """States of one problem that are asked for, and where they go."""

    pressures: np.ndarray
    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    limit: np.ndarray


def walk(problem, settled, rows, accuracy):
    """Write the states of a problem to its rows, as far as they are PENDING: a generator of (way, question)."""
    lock = [i for i in range(len(rows.status)) if rows.status[i] == PENDING and rows.pressures[i] == np.inf]
    if lock:
        yield from on(fading(problem), locked(lock, rows, accuracy))
    asked = [i for i in range(len(rows.status)) if rows.status[i] == PENDING and np.isfinite(rows.pressures[i])]
    if not asked:
        return
    rise, pressure = ways_of(problem, settled)
    loaded = bool(is_loaded(problem[None])[0])
    if not loaded:
        point = yield from on(pressure, two_numbers.begin())
        if point is not None:
            early = [i for i in asked if pressure.share_of(rows.pressures[i]) < point.share]
            asked = [i for i in asked if i not in early]
            yield from on(pressure, follow(pressure, point, 1.0, asked, rows, accuracy))
        return
    point = yield from on(rise, two_numbers.begin())
    if point is None:
        return
    found, point = yield from on(rise, settle(rise, point))
    if found != OK:
        for i in asked if found != PENDING else ():
            rows.status[i] = found
        return
    for sense in (1.0, -1.0):
        own = [i for i in asked if (rows.pressures[i] - settled) * sense >= 0.0 and rows.status[i] == PENDING]
        if own:
            start = turned_to(point, pressure.share_of(settled), sense)
            yield from on(pressure, follow(pressure, start, sense, own, rows, accuracy))


def on(way, questions):
    """Those questions, with the way that they belong to."""
    answer = None
    while True:
        try:
            question = questions.send(answer)
        except StopIteration as end:
            return end.value
        answer = yield way, question


def turned_to(point, share, sense):
    """The same state as a point of the way of pressure, along which it leads in this ``sense``."""
    upward = two_numbers.Point(point.middle, share, 0.5 * sense * np.pi, 0.0, 0.0, sense)
    return upward


def settle(way, point):
    """``(status, point)``: OK and the state at the end of the way of loads."""
    step, points = two_numbers.FIRST_STEP, [point]
    while points[-1].share < 1.0:
        if len(points) > two_numbers.MOST_STEPS:
            return PENDING, None
        points[-1], ahead, step = yield from two_numbers.advance(points[-1], step)
        if ahead is None:
            return lost(way, points[-1]), None
        points.append(ahead)
        if not (yield from two_numbers.goes_on(points, 1.0)):
            return BEYOND_LIMIT, None
    if len(points) == 1:
        return PENDING, None
    middle = yield from two_numbers.middle_at(1.0, points[-2], points[-1])
    return (PENDING, None) if middle is None else (OK, points[-1]._replace(middle=middle, share=1.0))


def lost(way, point):
    """Why no step leads on from a point: nothing is left to keep the tube round, or nobody knows."""
    load = way.load_at(point.share)
    part = load[0] * point.middle**2
    return COMPRESSED if part + load[1] < PUSHED * max(part, abs(load[1])) else PENDING


def follow(way, point, sense, asked, rows, accuracy):
    """Write the states ``asked`` for of a branch of the pressure, from a point on."""
    shares = {i: way.share_of(rows.pressures[i]) for i in asked}
    far = max(sense * share for share in shares.values())
    step, points = two_numbers.FIRST_STEP, [point]
    while sense * points[-1].share < far or len(points) == 1:
        if len(points) > two_numbers.MOST_STEPS:
            return
        points[-1], ahead, step = yield from two_numbers.advance(points[-1], step)
        if ahead is None:
            status = lost(way, points[-1])
            for i in asked:
                if rows.status[i] == PENDING:
                    rows.status[i] = status
            return
        points.append(ahead)
        goes_on = yield from two_numbers.goes_on(points, sense)
        here, there = points[-2:]
        if not goes_on:
            yield from end_at(way, points, sense, shares, rows, accuracy)
            return
        for i, share in shares.items():
            if rows.status[i] == PENDING and sense * share <= sense * there.share:
                yield from write(share, here, there, i, rows, accuracy)


def write(share, near, far, i, rows, accuracy):
    """Write one state, if it is met."""
    found = yield from two_numbers.state_at(share, near, far, accuracy)
    if found is None:
        return
    answer, bounds = found
    rows.values[i], rows.bounds[i], rows.slack[i] = answer.values, bounds, answer.slack
    good = np.max(bounds[: len(answer.scales)] / answer.scales) <= accuracy
    rows.status[i] = OK if good else INACCURATE


def end_at(way, points, sense, shares, rows, accuracy):
    """What rows still wait for, of a branch that turns back behind the last but one of its ``points``."""
    far = sense * points[-2].share + two_numbers.LARGEST_STEP  # the branch turns nearer than a step
    for i, own in shares.items():
        if rows.status[i] == PENDING and sense * own > far:
            rows.status[i] = BEYOND_LIMIT
    waits = any(rows.status[i] == PENDING for i in shares)
    if len(points) < 3 or not (waits or sense > 0.0):
        return
    found = yield from two_numbers.turning_point(points[-3:], sense)
    if found is None:
        return
    share, bound, top = found
    if sense > 0.0:
        rows.limit[0] = way.load_at(share)[0]
        rows.limit[1] = way.unit * bound / (1.0 - share) ** 2
    for i, own in shares.items():
        if rows.status[i] != PENDING:
            continue
        if sense * own >= sense * share - bound:
            rows.status[i] = BEYOND_LIMIT
        else:
            near = points[-2] if sense * own > sense * points[-2].share else points[-3]
            yield from write(own, near, top, i, rows, accuracy)


def locked(asked, rows, accuracy):
    """Write a locked shape, at the end of the way on which the wall fades."""
    point = yield from two_numbers.begin()
    if point is None:
        return
    step, points = two_numbers.FIRST_STEP, [point]
    while points[-1].share < 1.0:
        points[-1], ahead, step = yield from two_numbers.advance(points[-1], step)
        if ahead is None:
            return
        points.append(ahead)
        if not (yield from two_numbers.goes_on(points, 1.0)):
            return
    if len(points) > 1:
        for i in asked:
            yield from write(1.0, points[-2], points[-1], i, rows, accuracy)


def follow_branches(problems, first, pressures, kinds, accuracy, found):
    """Write what is PENDING of the states ``found`` of physical problems: arguments as of :func:`..batch.walk_all`, ``kinds`` as
    :func:`..batch._kinds` gives them.
    """
    settled, walks = settling_pressure(problems), {}
    for k in range(len(problems)):
        own = slice(first[k], first[k + 1])
        if np.any(found.status[own] == PENDING):
            rows = Rows(pressures[own], found.values[own], found.bounds[own], found.status[own], found.slack[own],
                        found.limits[k])
            walks[k] = walk(problems[k], settled[k], rows, accuracy)
    asked = {k: next(walk_, None) for k, walk_ in walks.items()}
    with np.errstate(all="ignore"):  # of what is no tube nothing can be told
        while asked := {k: request for k, request in asked.items() if request is not None}:
            answers = measured(problems, kinds, asked, found.values.shape[1])
            asked = {k: _sent(walks[k], answer) for k, answer in answers.items()}


def _sent(walk_, answer):
    try:
        return walk_.send(answer)
    except StopIteration:
        return None


def measured(problems, kinds, asked, columns):
    """Answers to the questions ``asked`` of problems, by vectors of those that are alike."""
    from ..lanes import by_middle

    owners = np.array(list(asked), np.int64)
    middles = np.array([question.middle for _, question in asked.values()])
    given = np.array([way.load_at(question.share) for way, question in asked.values()])
    fineness = np.array([question.fineness for _, question in asked.values()])
    answers = {}
    for _, _, kind, some in kinds:
        for fine in np.unique(fineness):
            rows = np.flatnonzero(some[owners] & (fineness == fine))
            if not len(rows):
                continue
            values, bounds = np.empty((len(rows), columns)), np.empty((len(rows), columns))
            told = np.empty((len(rows), by_middle.COUNT))
            by_middle.measure_physical(
                problems, owners[rows], given[rows], middles[rows], *kind, PIECES[fine], values, bounds, told
            )
            for n, row in enumerate(rows.tolist()):
                scales = np.append(told[n, by_middle.SCALES :], 1.0)
                answers[int(owners[row])] = two_numbers.Answer(
                    float(told[n, by_middle.MISS]), float(told[n, by_middle.DOUBT]), values[n], bounds[n], scales,
                    int(told[n, by_middle.SLACK]),
                )
    return answers

"""The branches of many tubes that are the same all along, side by side: the questions of all are answered
together, by vectors (:mod:`..lanes.by_middle`).
"""

from math import pi
from typing import NamedTuple

import numpy as np

from ...interpret import run
from ..load_path import is_loaded, settling_pressure
from ..physics.wall import LOOSE
from ..problem import PROBLEM_SIZE, THREADS
from ..stability import PUSHED
from ..status import BEYOND_LIMIT, COMPRESSED, INACCURATE, OK, PENDING
from .question import Answer, Told
from .states import middle_at, state_at, turning_point
from .steps import ARRIVED, FLAT, LARGEST_STEP, SHARP, TURNED, Point, begin, follow
from .ways import fading, ways_of

PIECES = 1, 2, 4, 16, 64, 256  # in which each part of a tube is summed, one try after the other


class Rows(NamedTuple):
    """States of one problem that are asked for, and where they go: see :func:`..free.free_states.follow_many`."""

    pressures: np.ndarray
    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    limit: np.ndarray

    def waiting(self):
        """Numbers of the rows that are PENDING."""
        return np.flatnonzero(self.status == PENDING).tolist()


def follow_branches(problems, first, pressures, kinds, accuracy, found, soon=False):
    """Write what is PENDING of the states ``found`` of the ``problems``, as far as their branches tell: arguments
    as of :func:`..batch.walk_all`; ``kinds`` are pairs of what all problems of one vector share, and which problems
    those are.
    """
    settled, walks = settling_pressure(problems), {}
    for k in range(len(problems)):
        own = slice(first[k], first[k + 1])
        if np.any(found.status[own] == PENDING):
            rows = Rows(pressures[own], *(array[own] for array in found[:4]), found.limits[k])
            walks[k] = walk(problems[k], settled[k], rows, accuracy)
    with np.errstate(all="ignore"):  # of what is no tube nothing can be told
        asked = {k: next(steps, None) for k, steps in walks.items()}
        while asked := {k: asked_of for k, asked_of in asked.items() if asked_of is not None}:
            answers = answered(problems, kinds, asked, found.values.shape[1], soon)
            asked = {k: _next(walks[k], answer) for k, answer in answers.items()}


def _next(steps, answer):
    try:
        return steps.send(answer)
    except StopIteration:
        return None


def answered(problems, kinds, asked, columns, soon=False):
    """Answers to what is ``asked`` of problems, pairs of a way and a question, by their number."""
    from ..lanes import by_middle

    owners = np.array(list(asked), np.int64)
    middles, _, fineness = np.array([question for _, question in asked.values()]).T
    given = np.array([way.load_at(question.share) for way, question in asked.values()])
    answers = {}
    for kind, some in kinds:
        measure = by_middle.measure_lanes if len(kind) == 1 else by_middle.measure_physical
        for fine in np.unique(fineness).astype(int).tolist():
            rows = np.flatnonzero(some[owners] & (fineness == fine))
            if not len(rows):
                continue
            values, bounds = np.empty((2, len(rows), columns))
            numbers = np.empty((len(rows), by_middle.COUNT))
            own = problems, owners[rows], given[rows], middles[rows], *kind, PIECES[fine], values, bounds, numbers
            run(measure, 0, soon, *own)
            scales, floors = np.ones((len(rows), by_middle.SCALED + 1)), np.zeros((len(rows), by_middle.SCALED + 1))
            scales[:, :-1], floors[:, :-1] = (
                numbers[:, by_middle.SCALES : by_middle.FLOORS],
                numbers[:, by_middle.FLOORS :],
            )
            told = Told(values, bounds, scales, floors, numbers[:, by_middle.SLACK])
            for n, (k, miss, doubt) in enumerate(zip(owners[rows].tolist(), *numbers[:, : by_middle.SLACK].T.tolist())):
                answers[k] = Answer(miss, doubt, fine, told, n)
    return answers


def on(way, steps):
    """The questions of ``steps``, each with the ``way`` that it belongs to."""
    answer = None
    while True:
        try:
            question = steps.send(answer)
        except StopIteration as end:
            return end.value
        answer = yield way, question


def walk(problem, settled, rows, accuracy):
    """Write the rows of a problem whose loads have ``settled`` at that pressure."""
    locked = [i for i in rows.waiting() if rows.pressures[i] == np.inf]
    if locked and (len(problem) == PROBLEM_SIZE or problem[THREADS] <= LOOSE):  # a single family locks nothing
        yield from on(fading(problem), lock(locked, rows, accuracy))
    asked = [i for i in rows.waiting() if rows.pressures[i] < np.inf]
    if not asked:
        return
    rise, pressure = ways_of(problem, settled)
    if not is_loaded(problem[None])[0]:
        point = yield from on(pressure, begin())
        if point is not None:
            later = [i for i in asked if pressure.share_of(rows.pressures[i]) >= point.share]
            yield from on(pressure, along(pressure, point, 1.0, later, rows, accuracy))
        return
    status, middle = yield from on(rise, settle(rise))
    if status != OK:
        rows.status[asked] = status
        return
    for sense in (1.0, -1.0):
        own = [i for i in asked if (rows.pressures[i] - settled) * sense >= 0.0 and rows.status[i] == PENDING]
        start = Point(middle, pressure.share_of(settled), 0.5 * pi * sense, 0.0, 0.0, sense)
        yield from on(pressure, along(pressure, start, sense, own, rows, accuracy))


def nothing(here, there):
    """What is asked for on a step of a way of which the end counts alone."""
    yield from ()


def settle(way):
    """``(status, stretch in the middle)`` at the end of the way of loads."""
    point = yield from begin()
    if point is None:  # less strain than is looked for
        return OK, 1.0
    what, points = yield from follow(point, 1.0, 1.0, nothing)
    around = yield from around_end(what, points)
    if around is None:
        return BEYOND_LIMIT if what == TURNED else lost(way, points[-1]), np.nan
    middle = yield from middle_at(1.0, *around)
    return (PENDING, np.nan) if middle is None else (OK, middle)


def lock(asked, rows, accuracy):
    """Write locked shapes, at the end of the way on which the wall fades."""
    point = yield from begin()
    if point is None:
        return
    around = yield from around_end(*(yield from follow(point, 1.0, 1.0, nothing)))
    if around is not None:
        for i in asked:
            yield from write(1.0, *around, i, rows, accuracy)


def around_end(what, points):
    """Two points of a branch between which its way ends; None where it does not come to that end."""
    if what == ARRIVED:
        return points[-2:]
    if what == TURNED and points[-2].share > 1.0 - LARGEST_STEP:  # does it turn behind the end?
        share, bound, top = yield from turning_point(points, 1.0)
        if share - bound > 1.0:
            return before_top(1.0, points, top, 1.0), top
    return None


def lost(way, point):
    """Why no step leads on from a point: nothing is left to keep the tube round, or nobody knows."""
    pressure, force, *_ = way.load_at(point.share)
    part = pressure * point.middle**2
    return COMPRESSED if part + force < PUSHED * max(part, abs(force)) else PENDING


def along(way, point, sense, asked, rows, accuracy):
    """Write the rows ``asked`` for of a branch of the pressure, from a point on in this ``sense``."""
    if not asked:
        return
    shares = {i: way.share_of(rows.pressures[i]) for i in asked}

    def answer(here, there):
        least = sense * here.share - FLAT * SHARP * (here.step + there.step)  # by which a point may be off
        for i, share in shares.items():
            if rows.status[i] == PENDING and least <= sense * share <= sense * there.share:
                yield from write(share, here, there, i, rows, accuracy)

    what, points = yield from follow(point, sense, max(sense * share for share in shares.values()), answer)
    waiting = {i: share for i, share in shares.items() if rows.status[i] == PENDING}
    if what == TURNED:
        yield from end_at(way, points, sense, waiting, rows, accuracy)
    elif what != ARRIVED:
        rows.status[list(waiting)] = lost(way, points[-1])


def end_at(way, points, sense, shares, rows, accuracy):
    """Write the rows that wait at these ``shares``, of a branch that turns back behind the last but one of its
    ``points``.
    """
    far = sense * points[-2].share + LARGEST_STEP  # it turns nearer than a step
    beyond = [i for i, share in shares.items() if sense * share > far]
    rows.status[beyond] = BEYOND_LIMIT
    if sense < 0.0 and len(beyond) == len(shares):  # a limit pressure is one of rising pressures
        return
    share, bound, top = yield from turning_point(points, sense)
    if sense > 0.0:
        rows.limit[:] = way.pressure_for(share, bound)
    for i, own in shares.items():
        if sense * own >= sense * share - bound:
            rows.status[i] = BEYOND_LIMIT
        else:
            yield from write(own, before_top(own, points, top, sense), top, i, rows, accuracy)


def before_top(share, points, top, sense):
    """Of three points round the ``top`` of a branch the last one before it, and before a ``share``."""
    first, second, _ = points
    passed = (second.middle - top.middle) * (first.middle - top.middle) <= 0.0
    return first if passed or sense * second.share > sense * share else second


def write(share, near, far, i, rows, accuracy):
    """Write the state at a ``share`` between two points to row ``i``, if it is met."""
    found = yield from state_at(share, near, far, accuracy)
    if found is None:
        return
    told, bounds, largest = found
    rows.values[i], rows.bounds[i], rows.slack[i] = told.values, bounds, int(told.slack)
    rows.status[i] = OK if largest <= accuracy else INACCURATE

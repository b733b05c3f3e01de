"""What is told of a state of waves: its numbers, its profiles, and how exactly they are known."""

from typing import NamedTuple

import numpy as np

from ..along.profile import FIELDS, VALUES
from ..batch import draw
from ..by_middle.many import PIECES
from ..lanes import waves
from ..lanes.meridian import DEEPEST
from ..lanes.outputs import FLOOR
from ..numerics.error_bounds import TINY
from ..physics.membrane import ROUNDING
from ..problem import FORCE, LENGTH
from ..problem import TORQUE as OWN_TORQUE
from ..status import INACCURATE, OK
from .branch import ALONG
from .on_step import at_pressure
from .waves import HALF, LEVEL, PRESSURE, TORQUE, TURN

NOISE, SURE = 1e-14, 1e-9  # of a level, its rounding; how well a pressure is known, whatever the waves
OWN_SHARE = 0.3  # of the accuracy: what profiles of known waves may miss
ROUGH, FAINT = 1e-2, 1e-9  # a scaled bound of what is not known; the least energy, of the work of the loads


class State(NamedTuple):
    """Length, volume, twist, energy of half the tube, stretch in the middle, torque, of physical tubes the numbers of
    :mod:`..along.places`, and their bounds; status, families that would have to push, unstable directions, profiles
    (FIELDS, stations).
    """

    values: np.ndarray
    bounds: np.ndarray
    status: int
    slack: int
    unstable: int
    profiles: np.ndarray


def told_of(asked, states, accuracy, stations):
    """The first :class:`State` of the ``states``, finer and finer, that is as accurate as asked for, or the last that is
    known at all; None where none is.
    """
    found = None
    for pieces, look, shifts, bounds in states:
        scales, floors = scales_of(asked, look)
        largest = np.max((bounds - floors) / scales)
        if not largest <= ROUGH:
            continue
        every = np.unique(np.append(stations, asked.half))
        fields, drawn = shape(asked, look, every, accuracy)
        along, missed = look.along
        for k in range(len(shifts)):
            change = np.zeros(len(look.pair.numbers))
            change[k] = shifts[k]
            beside = asked.look(look.pair.moved(change), pieces)
            moved = shape(asked, beside, every, accuracy)[0] if beside is not None else np.full_like(fields, np.nan)
            fields[VALUES:] += np.abs(moved[:VALUES] - fields[:VALUES])
            missed += np.abs(beside.along[0] - along) if beside is not None else np.nan
        own, middle = fields[:, np.searchsorted(every, stations)], fields[:, np.searchsorted(every, asked.half)]
        exact = drawn and max(largest, middle[VALUES], worst_of(own, asked.half)) <= accuracy
        slack = np.bitwise_or.reduce(look.told[:, waves.SLACK].astype(int))
        found = State(
            np.array([*look.values[:TORQUE], middle[0], look.values[TORQUE], *along]),
            np.array([*bounds[:TORQUE], middle[VALUES], bounds[TORQUE], *missed]),
            OK if exact else INACCURATE, slack, look.unstable, own,
        )  # fmt: skip
        if exact:
            break
    return found


def doubts(look):
    """By how much each condition may be off (w + 1,)."""
    told, out = look.told, np.empty(len(look.miss))
    out[LEVEL:] = NOISE * np.abs(told[:, waves.LEVEL]).max()
    out[HALF] = look.counts @ told[:, waves.DOUBT]
    out[TURN] = look.counts @ told[:, waves.BOUNDS + 2]
    return out


def doubt_of_turn(look):
    """How far off a pressure at which the branch turns may be: it alone answers for what the conditions miss."""
    slopes = look.slopes / look.pair.weights
    slopes = slopes / np.abs(slopes).max(axis=1)[:, None]
    missed = doubts(look) / np.abs(look.slopes / look.pair.weights).max(axis=1)
    left = np.linalg.svd(slopes[:, :PRESSURE])[0][:, -1]
    by_pressure = abs(left @ slopes[:, PRESSURE]) * look.pair.weights[PRESSURE]
    return look.pair.pressure * (np.abs(left) @ missed) / by_pressure


def scales_of(asked, look):
    """By what bounds of the values count (5,), and how much of them is rounding."""
    length, volume, turn, energy, torque = look.values
    pressure, force = look.pair.pressure, asked.problem[FORCE]
    work = abs(pressure * volume) + abs(force * length) + abs(torque * turn)
    load = max(pressure, abs(force), abs(torque))
    floors = look.counts @ look.told[:, waves.FLOORS : waves.FLOORS + TORQUE]
    scales = asked.half, volume, max(0.5, abs(turn)), max(abs(energy), FAINT * work), load
    return np.array(scales), np.array([*floors, FLOOR * ROUNDING * load])


def refined(asked, here, length, pieces, pressure):
    """``(pieces, look, how far off its numbers may be (w + 1,), bounds (5,))`` of the state at a pressure on a step, finer
    and finer; nothing where there is none.
    """
    along, number, before = 0.0 * here.toward, np.log(pressure), None
    along[PRESSURE] = 1.0
    point = at_pressure(asked, here, length, pieces, pressure)
    if point is None:
        return
    pair = point.look.pair
    for fine in PIECES[PIECES.index(ALONG) :]:
        solved = asked.solve(pair, along, number, fine)
        if solved is None:
            continue
        look, left = solved
        pair, slopes = look.pair, look.slopes[:, :PRESSURE]
        size = np.abs(slopes).max(axis=1)
        shifts = np.abs(np.linalg.inv(slopes / size[:, None])) @ (doubts(look) / size) + np.abs(left[:PRESSURE])
        bounds = np.abs(look.rises[:, :PRESSURE]) @ shifts
        bounds[:TORQUE] += look.counts @ look.told[:, waves.BOUNDS : waves.BOUNDS + TORQUE]
        bounds[TORQUE] += FLOOR * ROUNDING * abs(look.values[TORQUE])
        if before is not None:
            yield fine, look, shifts, bounds + np.abs(look.values - before)
        before = look.values


def worst_of(fields, half):
    """The largest of the scaled bounds of profiles."""
    if not fields.shape[1]:
        return 0.0
    scales = np.ones((VALUES, 1))
    scales[1], scales[2] = half, max(1.0, np.abs(fields[2]).max())
    scales[5:] = max(np.abs(fields[5:VALUES]).max(), TINY)
    return np.max(fields[VALUES:] / scales)


def shape(asked, look, stations, accuracy):
    """``(FIELDS at the stations, whether each wave alone is as accurate)``: each wave is a free tube, and its own mirror
    image; they stand along the tube in the ``order`` of what is asked.
    """
    fields, good, start, passed = np.empty((FIELDS, len(stations))), True, 0.0, np.zeros(2)
    pair = look.pair
    for wave in asked.order:
        end, last = 2.0 * look.told[wave, waves.X], wave == asked.order[-1]
        own = ((stations > start) | (start == 0.0)) & ((stations <= start + end) | last)
        x = stations[own] - start
        mirrored = x > 0.5 * end
        x, index = np.unique(np.clip(np.where(mirrored, end - x, x), 0.0, 0.5 * end), return_inverse=True)
        problem = asked.problem.copy()
        problem[LENGTH], problem[OWN_TORQUE] = end, look.values[TORQUE]
        depth = min(pair.numbers[wave], DEEPEST)
        middle = (look.told[wave, waves.UNIFORM], depth) if pair.deep[wave] else (look.told[wave, 4], np.nan)
        drawn = np.empty((1, FIELDS, len(x)))
        states = problem[None], np.array([0]), np.array([pair.pressure]), np.array([middle]), np.array([0])
        good = len(x) == 0 or (bool(draw(*states, x, OWN_SHARE * accuracy, drawn, True)[0]) and good)
        drawn, totals = drawn[0][:, index], 2.0 * look.told[wave, [0, 2]]
        drawn[1:3] = passed[:, None] + np.where(mirrored, totals[:, None] - drawn[1:3], drawn[1:3])
        fields[:, own] = drawn
        start, passed = start + end, passed + totals
    return fields, good

"""By how much two numbers miss being a state of a branch: the stretch in the middle, and the share of a way along which
loads change.

What a state is comes from whoever is asked: all functions of this room but those of :mod:`many` are generators that
yield a :class:`Question` and are sent an :class:`Answer`, so that many branches are followed side by side, their
questions answered together. To each pair of numbers belongs by how much it misses being a state, times the strain in
the middle, a smooth number: a branch is where that is none.
"""

from math import copysign, isnan
from typing import NamedTuple

import numpy as np

STILL = 1e-9  # strain beside which the middle is not looked at: the miss is a ratio of two small numbers there
CLOSE = 1e-11  # a miss that is none
FAINT = 0.1  # share of a doubt that cannot be told from none
LEAST_DOUBT = 1e-10  # of a share
MOST_HALVINGS, ROUNDING = 180, 4e-16  # of a bracket, and its width where it ends
TRIES, MOST_TRIES = 4, 6  # along a branch, and for a state
ROUGH = 1e-2  # what is not known to this share of itself is not known
# tries, and a doubt of the miss that needs no more of them: along a branch, where a point counts, and where it turns
ALONG, SHARPLY, FINEST = (range(TRIES), ROUGH), (range(TRIES), 1e-7), (range(TRIES - 1, TRIES), 0.0)
WIDER = 3.0  # times as far away is looked next for a change of sign


class Question(NamedTuple):
    """A stretch in the middle, a share of the way, and how fine the answer shall be: the number of its try."""

    middle: float
    share: float
    fineness: int


class Told(NamedTuple):
    """What is told of tubes whose questions were answered together: outputs (n, k), what may be missing of them, by what
    they are measured, and how much of that is rounding; families that are slack (n,).
    """

    values: np.ndarray
    bounds: np.ndarray
    scales: np.ndarray
    floors: np.ndarray
    slack: np.ndarray


class Answer(NamedTuple):
    """By how much a question misses being a state (NaN: no tube at all), and what may be missing of that, both times
    the strain; how fine it is; and the ``row`` of what is ``told`` of it.
    """

    miss: float
    doubt: float
    fineness: int
    told: Told
    row: int

    @property
    def outputs(self):
        """What is told of this tube alone."""
        return Told(*(array[self.row] for array in self.told))


def ask(middle, share, tries=ALONG):
    """The answer, from the first of the ``tries`` that leaves so little doubt."""
    if abs(middle - 1.0) < STILL:
        middle = 1.0 + (STILL if middle >= 1.0 else -STILL)
    answer = None
    for fineness in tries[0]:
        answer = yield Question(middle, share, fineness)
        if not answer.doubt > tries[1]:
            break
    strain = middle - 1.0
    return Answer(answer.miss * strain, answer.doubt * abs(strain), answer.fineness, answer.told, answer.row)


def sign_of(middle, share):
    """The sign of the miss, from the first try that leaves no doubt of it; 0 where none does, NaN where there is no tube."""
    for fineness in range(TRIES):
        answer = yield from ask(middle, share, (range(fineness, fineness + 1), np.inf))
        if not abs(answer.miss) <= answer.doubt:
            return copysign(1.0, answer.miss) if answer.miss == answer.miss else np.nan
    return 0.0


def crossing(place, low, high, width=0.0, tries=ALONG):
    """``(t, answer, other)`` where the miss changes its sign along ``place(t)``, a stretch and a share, between two
    pairs of a t and its answer, as exactly as that ``width``; ``other`` is a pair on the other side of it. None where the
    way there leads through what is no tube.

    By the regula falsi of Illinois; a bracket that it does not halve is halved.
    """
    weights, wide, replaced = [1.0, 1.0], abs(high[0] - low[0]), None
    finer = max(low[1].fineness, high[1].fineness, tries[0].start)  # what a neighbour needs is not tried in vain
    tries = range(min(finer, tries[0].stop - 1), tries[0].stop), tries[1]
    for trial in range(MOST_HALVINGS):
        left, right = min(low[0], high[0]), max(low[0], high[0])
        below, above = weights[0] * low[1].miss, weights[1] * high[1].miss
        t = (low[0] * above - high[0] * below) / (above - below)
        if trial % 3 == 2:
            if right - left > 0.5 * wide or not left < t < right:
                t = 0.5 * (left + right)
            wide = right - left
        enough = max(width, ROUNDING * (1.0 + abs(t)))
        t = min(max(t, left + 0.5 * enough), right - 0.5 * enough)  # nearer it would not end the search
        answer = yield from ask(*place(t), tries)
        if isnan(answer.miss):
            return None
        side = 0 if answer.miss * low[1].miss > 0.0 else 1  # which end is replaced; of one that stays again half counts
        weights[side], weights[1 - side] = 1.0, 0.5 * weights[1 - side] if side == replaced else 1.0
        replaced = side
        if side == 0:
            low, other = (t, answer), high
        else:
            high, other = (t, answer), low
        none = max(CLOSE * abs(place(t)[0] - 1.0), FAINT * answer.doubt)
        if abs(answer.miss) <= none or abs(high[0] - low[0]) <= enough:
            break
    return t, answer, other


def slope_of(t, answer, other):
    """How fast the miss changes beside a :func:`crossing`."""
    return abs((answer.miss - other[1].miss) / (t - other[0])) if answer.miss != other[1].miss else np.inf


def beside(place, left, distances, width=0.0, tries=ALONG):
    """:func:`crossing` of a branch along ``place(t)``, which leads to its left as t grows, where the miss has the sign
    ``left``; it is looked for at these ``distances`` from t = 0, one farther than the other. None where it is not met.
    """
    before = 0.0, (yield from ask(*place(0.0), tries))
    is_left = before[1].miss * left > 0.0
    for distance in distances:
        if isnan(before[1].miss):
            return None
        t = -distance if is_left else distance
        answer = yield from ask(*place(t), tries)
        if not isnan(answer.miss) and (answer.miss * left > 0.0) != is_left:
            return (yield from crossing(place, before, (t, answer), width, tries))
        before = t, answer
    return None


def widening(first, widest):
    """Distances from the ``first`` to the ``widest``."""
    while first < widest:
        yield first
        first *= WIDER
    yield widest


def across(middle, share, left, reach):
    """``(share, doubt, whether the miss jumps there)`` of the state whose middle has that stretch, beside a ``share``, not
    farther than ``reach``, on a branch above which the miss has the sign ``left``.
    """
    distances = widening(FAINT**3 * reach, 4.0 * reach)
    met = yield from beside(lambda t: (middle, share + t), left, distances, LEAST_DOUBT, FINEST)
    if met is None:
        return None
    t, found, _ = met
    doubt = (found.doubt + abs(found.miss)) / slope_of(*met) + LEAST_DOUBT
    return share + t, doubt, abs(found.miss) > ROUGH * abs(middle - 1.0)

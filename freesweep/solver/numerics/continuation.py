"""Continuation: a branch of equilibria followed in its own arclength, which rises through folds of the load.

Along ``load = origin + mu direction`` a state is (y, mu). Its tangent solves ``H dy + b dmu = 0`` with ``b = dg/dmu``; the
predictor goes a step along it, the corrector (:mod:`bordered`) is Newton's method on the plane through there that is normal
to it. Where an integral is held, its load is one unknown more; what is held may change along the path, too.

Lengths are measured in relative changes of y (root mean square) and of mu, which counts LOAD_SHARE times its own size: so no
list of loads enters, only the branch itself. A step is taken where the chord agrees with the mean of the tangents at its
ends, in every node and in mu: a branch that did something else in between, or another branch, does not.

Knows no tube: a :class:`.functional.Functional` is handed in. ``y[0]`` stays; so does ``y[n]`` unless it is free. Behind the
nodes of a state whose integral is held, ``y[n + 1]`` is nu. Where a branch is left, ``here`` is (mu, the tangent's mu).
"""

import numpy as np

from ...jit import kernel
from .bordered import FOLLOWED, LOST, correct, largest_share
from .path import size_of

CHANGE = 0.05  # largest change of y in one step, relative, and of the load, weighted
FIRST_STEP = 0.2  # of that: nothing is known of the bend yet
LEAST_STEP = 1e-7  # below it the branch is lost
DEFECT = 0.03  # of the larger of two slopes: by which a chord may differ from their mean
BEND, SHORT = 0.6, 5e-4  # and in a bend, where no step makes it less: half their difference, in a step so short
GROWTH = 1.6  # of the step where the defect is small
ROUNDING = 1e-9  # relative: a defect that is none
BISECTIONS = 60
FLAT = 1e-3  # of a tangent that points along the load: a long tube's fold, so sharp that no step leads round it


@kernel
def make_unit(track, n, mu, tangent_mu, path):
    """Let the tangent have length 1; its mu."""
    part = tangent_mu / size_of(mu, path)
    square = part * part
    for i in range(1, track.last + 1):
        square += track.tangent[i] * track.tangent[i] / (n * track.y[i] * track.y[i])
    scale = 1.0 / np.sqrt(square)
    for i in range(len(track.tangent)):
        track.tangent[i] *= scale
    return scale * tangent_mu


@kernel
def longest_step(track, mu, tangent_mu, path):
    """The step in which nothing changes by more than CHANGE, as far as the tangent tells."""
    return CHANGE / max(largest_share(track.y, track.tangent, track.last), abs(tangent_mu) / size_of(mu, path))


@kernel
def step_ahead(functional, track, n, cells, path, here, step, work):
    """The state a ``step`` of arclength ahead, into ``track.next_y`` and ``next_tangent``; returns as :func:`correct`."""
    mu, tangent_mu = here
    unit = size_of(mu, path)
    for i in range(n + 1):
        track.normal[i] = track.tangent[i] / (n * track.y[i] * track.y[i])
    for i in range(len(track.y)):
        track.next_y[i] = track.y[i] + step * track.tangent[i]
    return correct(
        functional, track, track.next_y, mu + step * tangent_mu, n, cells, path, tangent_mu / (unit * unit),
        track.next_tangent, work,
    )  # fmt: skip


@kernel
def defect(track, path, mu, tangent_mu, next_mu, next_tangent_mu, step):
    """By how much a step's chord differs from the mean of its tangents, as a share of the larger one: the largest of y's
    nodes together and of mu.
    """
    change, most = 0.0, 0.0
    for i in range(1, track.last + 1):
        y = track.y[i]
        mean = 0.5 * step * (track.tangent[i] + track.next_tangent[i])
        change = max(change, abs(track.next_y[i] - y - mean) / y)
        most = max(most, step * max(abs(track.tangent[i]), abs(track.next_tangent[i])) / y)
    mean = 0.5 * step * (tangent_mu + next_tangent_mu)
    largest = step * max(abs(tangent_mu), abs(next_tangent_mu))
    rounded = ROUNDING * (abs(mu) + path.floor)
    return max(change / (most + ROUNDING / DEFECT), abs(next_mu - mu - mean) / (largest + rounded / DEFECT))


@kernel
def advance(functional, track, n, cells, path, here, step, work):
    """One step along the branch, as long as the branch allows: ``(status, negative pivots, mu, the tangent's mu, step made,
    step to try next)``; the state is left as :func:`step_ahead` leaves it.
    """
    mu, tangent_mu = here
    step = min(step, longest_step(track, mu, tangent_mu, path))
    while step > LEAST_STEP:
        status, negative, next_mu, next_tangent_mu = step_ahead(functional, track, n, cells, path, here, step, work)
        if status == FOLLOWED:
            wrong = defect(track, path, mu, tangent_mu, next_mu, next_tangent_mu, step)
            if wrong < DEFECT or (path.bends and step < SHORT and wrong < BEND):
                longer = step * (GROWTH if wrong < 0.5 * DEFECT else 1.0)
                return FOLLOWED, negative, next_mu, next_tangent_mu, step, longer
        step *= 0.5
    return LOST, 0, mu, tangent_mu, step, step


@kernel
def between(track, n, mu, tangent_mu, next_mu, next_tangent_mu, step, load, y):
    """A guess of the state at ``load``, between the ends of a step: the cubic through both and their tangents."""
    low, high = 0.0, 1.0
    for _ in range(BISECTIONS):
        t = 0.5 * (low + high)
        here = cubic(t, mu, next_mu, step * tangent_mu, step * next_tangent_mu)
        if (here < load) == (mu < next_mu):
            low = t
        else:
            high = t
    t = 0.5 * (low + high)
    for i in range(len(y)):
        y[i] = cubic(t, track.y[i], track.next_y[i], step * track.tangent[i], step * track.next_tangent[i])


@kernel
def cubic(t, first, last, first_slope, last_slope):
    """Hermite's cubic on 0..1."""
    s = 1.0 - t
    return s * s * ((1.0 + 2.0 * t) * first + t * first_slope) + t * t * ((3.0 - 2.0 * t) * last - s * last_slope)


@kernel
def is_stable(negative, tangent_mu, sense):
    """Whether a state is stable under given loads, on the stretch of a branch along which mu grows in this ``sense``."""
    return negative == 0 and tangent_mu * sense > 0.0


@kernel
def is_flat(mu, tangent_mu, path):
    """Whether the load has all but stopped changing along the branch."""
    return abs(tangent_mu) < FLAT * size_of(mu, path)


@kernel
def last_alike(functional, track, n, cells, path, here, step, sense, stable, work):
    """The last state on a step that is as ``stable``, or not, as its beginning, while its end is not so: bisection in
    arclength. ``(mu, the tangent's mu, step)``; the state is left as :func:`step_ahead` leaves it.

    At a fold mu differs from the fold's by the square of what is left.
    """
    low, high = 0.0, step
    while high - low > ROUNDING * step:
        at = 0.5 * (low + high)
        status, negative, _, now = step_ahead(functional, track, n, cells, path, here, at, work)
        if status == FOLLOWED and is_stable(negative, now, sense) == stable:
            low = at
        else:
            high = at
    _, _, found, now = step_ahead(functional, track, n, cells, path, here, low, work)
    return found, now, low

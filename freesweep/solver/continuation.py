"""Continuation: a branch of equilibria followed in its own arclength, which rises through folds of the load.

Along ``load = origin + mu direction`` a state is (y, mu). Its tangent solves ``H dy + b dmu = 0`` with ``b = dg/dmu``; the
predictor goes a step along it, the corrector is Newton's method on the plane through there that is normal to it, with one
more row in a bordered system::

    [ H    b ] [ dy  ]     [ g ]
    [ n^T  m ] [ dmu ] = - [ 0 ]        (n, m) = tangent, weighted

Lengths are measured in relative changes of y (root mean square) and of mu, which counts LOAD_SHARE times its own size: so no
list of loads enters, only the branch itself. A step is taken where the chord agrees with the mean of the tangents at its
ends, in every node and in mu: a branch that did something else in between, or another branch, does not.

Knows no tube: ``density`` is handed in as to :mod:`newton`. ``y[0]`` is held; so is ``y[n]`` unless it is free.
"""

from typing import NamedTuple

import numpy as np

from ..jit import kernel
from .held import loaded
from .mesh import cell_at, of_length
from .newton import assemble, factor, substitute

LOAD_SHARE = 0.1  # weight of a relative change of the load against one of y: its steps may be that much longer
CHANGE = 0.05  # largest change of y in one step, relative, and of the load, weighted
FIRST_STEP = 0.2  # of that: nothing is known of the bend yet
LEAST_STEP = 1e-7  # below it the branch is lost
DEFECT = 0.03  # of the larger of two slopes: by which a chord may differ from their mean
BEND, SHORT = 0.6, 2e-3  # and in a bend, where no step makes it less: half their difference, in a step so short
GROWTH = 1.6  # of the step where the defect is small
ROUNDING = 1e-9  # relative: a defect that is none
CORRECTIONS = 12  # of Newton's method; three suffice where a step is taken
CORRECTED = 1e-7  # relative: the next correction would be its square
STUCK = 1e-5  # relative: a correction that rounding keeps from falling further
DIFFERENCE = 1e-3  # of the load, to see how the gradient changes with it: exact where it is linear
BISECTIONS = 60
FLAT = 1e-3  # of a tangent that points along the load: a long tube's fold, so sharp that no step leads round it

LOST, FOLLOWED = 0, 1


class Path(NamedTuple):
    """Loads ``origin + mu direction``; ``floor`` is added to |mu| where its size counts. Where the density is only piecewise
    smooth, the branch ``bends`` at once where all cells change their kind together.
    """

    origin: tuple
    direction: tuple
    floor: float
    bends: bool


class Track(NamedTuple):
    """Scratch of one branch, all (n + 1,): mesh, state and tangent here and a step ahead, and the plane's normal; and the
    last node that moves: n where that is a plane of symmetry, else n - 1.
    """

    x: np.ndarray
    y: np.ndarray
    tangent: np.ndarray
    next_y: np.ndarray
    next_tangent: np.ndarray
    normal: np.ndarray
    spare: np.ndarray
    other: np.ndarray
    last: int


@kernel
def size_of(mu, path):
    """By what changes of the multiplier count."""
    return (abs(mu) + path.floor) / LOAD_SHARE


@kernel
def load_slope(density, x, y, n, cells, path, mu, b):
    """``b = dg/dmu``: how the gradient of -J changes along the path."""
    step = DIFFERENCE * (abs(mu) + path.floor)
    low, high = loaded(path.origin, path.direction, mu - step), loaded(path.origin, path.direction, mu + step)
    b[0] = 0.0
    for j in range(n):
        h = x[j + 1] - x[j]
        middle, v = 0.5 * (y[j] + y[j + 1]), (y[j + 1] - y[j]) / h
        cell = of_length(cell_at(cells, j), h)
        _, below_y, below_v, _, _, _ = density(middle, v, cell, low)
        _, above_y, above_v, _, _, _ = density(middle, v, cell, high)
        half, turn = 0.5 * h * (above_y - below_y), above_v - below_v
        b[j] = (b[j] - half + turn) / (2.0 * step)
        b[j + 1] = -half - turn
    b[n] /= 2.0 * step


@kernel
def leading(track, n):
    """The node that counts most on the plane's normal: to hold it keeps what is left of H away from a fold."""
    most, node = 0.0, track.last
    for i in range(1, track.last + 1):
        if abs(track.normal[i]) * track.y[i] > most:
            most, node = abs(track.normal[i]) * track.y[i], i
    return node


@kernel
def correct(density, track, y, mu, n, cells, path, normal_mu, tangent, work):
    """Newton's method on the plane through (y, mu) with the track's normal, y in place; ``tangent`` takes the branch's, of
    length 1 on the normal.

    One node k and mu border the rest of H, which is factored with that node held: at a fold H is singular, the rest is not.
    Returns ``(status, negative pivots of H, mu, the tangent's mu)``.
    """
    g, d, e, inverse, step, room, least, b, of_mu, of_k = (
        work[0], work[1], work[2], work[3], work[4], work[6], work[7], work[8], work[9], work[11]
    )  # fmt: skip
    anchor, anchor_mu, before = work[10], mu, 1e300
    x, normal, last, k = track.x, track.normal, track.last, leading(track, n)
    for i in range(n + 1):
        anchor[i], least[i] = y[i], 0.0
    for _ in range(CORRECTIONS):
        now = loaded(path.origin, path.direction, mu)
        if not assemble(density, x, y, n, cells, now, False, least, room, g, d, e):
            return LOST, 0, mu, 0.0
        load_slope(density, x, y, n, cells, path, mu, b)
        g_k, b_k, d_k, left, right = g[k], b[k], d[k], e[k - 1], e[k]
        g[k] = b[k] = e[k - 1] = e[k] = 0.0
        d[k] = 1.0
        negative = factor(d, e, 1, last, inverse)
        substitute(inverse, e, 1, last, g, step)
        substitute(inverse, e, 1, last, b, of_mu)
        for i in range(n + 1):
            g[i] = 0.0
        if k > 1:
            g[k - 1] = left
        if k < last:
            g[k + 1] = right
        substitute(inverse, e, 1, last, g, of_k)  # dy = -step - of_mu dmu - of_k dy_k elsewhere
        right = right if k < last else 0.0
        below, above = (left if k > 1 else 0.0), right
        row = g_k - below * step[k - 1] - above * step[min(k + 1, n)]
        row_mu = b_k - below * of_mu[k - 1] - above * of_mu[min(k + 1, n)]
        row_k = d_k - below * of_k[k - 1] - above * of_k[min(k + 1, n)]
        negative += 1 if not row_k > 0.0 else 0
        miss, plane_mu, plane_k = normal_mu * (mu - anchor_mu), normal_mu, normal[k]
        for i in range(1, last + 1):
            miss += normal[i] * (y[i] - anchor[i] - (step[i] if i != k else 0.0))
            plane_mu -= normal[i] * of_mu[i] if i != k else 0.0
            plane_k -= normal[i] * of_k[i] if i != k else 0.0
        determinant = row_mu * plane_k - row_k * plane_mu
        change = (row_k * miss - plane_k * row) / determinant
        change_k = (plane_mu * row - row_mu * miss) / determinant
        size = abs(change) / size_of(mu, path)
        mu += change
        for i in range(1, last + 1):
            move = change_k if i == k else -step[i] - change * of_mu[i] - change_k * of_k[i]
            size = max(size, abs(move) / y[i])
            y[i] += move
        if not size < 1.0:
            return LOST, 0, mu, 0.0
        if size < CORRECTED or (size < STUCK and size >= 0.5 * before):
            tangent_mu, tangent_k = -row_k / determinant, row_mu / determinant
            tangent[0] = tangent[n] = 0.0
            for i in range(1, last + 1):
                tangent[i] = tangent_k if i == k else -tangent_mu * of_mu[i] - tangent_k * of_k[i]
            return FOLLOWED, negative, mu, tangent_mu
        before = size
    return LOST, 0, mu, 0.0


@kernel
def make_unit(track, n, mu, tangent_mu, path):
    """Let the tangent have length 1; its mu."""
    part = tangent_mu / size_of(mu, path)
    square = part * part
    for i in range(1, track.last + 1):
        square += track.tangent[i] * track.tangent[i] / (n * track.y[i] * track.y[i])
    scale = 1.0 / np.sqrt(square)
    for i in range(1, track.last + 1):
        track.tangent[i] *= scale
    return scale * tangent_mu


@kernel
def largest_share(track):
    """Largest relative change of y per arclength."""
    largest = 0.0
    for i in range(1, track.last + 1):
        largest = max(largest, abs(track.tangent[i]) / track.y[i])
    return largest


@kernel
def longest_step(track, mu, tangent_mu, path):
    """The step in which nothing changes by more than CHANGE, as far as the tangent tells."""
    return CHANGE / max(largest_share(track), abs(tangent_mu) / size_of(mu, path))


@kernel
def step_ahead(density, track, n, cells, path, mu, tangent_mu, step, work):
    """The state a ``step`` of arclength ahead, into ``track.next_y`` and ``next_tangent``; returns as :func:`correct`."""
    unit = size_of(mu, path)
    for i in range(n + 1):
        track.normal[i] = track.tangent[i] / (n * track.y[i] * track.y[i])
        track.next_y[i] = track.y[i] + step * track.tangent[i]
    return correct(
        density, track, track.next_y, mu + step * tangent_mu, n, cells, path, tangent_mu / (unit * unit), track.next_tangent,
        work,
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
def advance(density, track, n, cells, path, mu, tangent_mu, step, work):
    """One step along the branch, as long as the branch allows: ``(status, negative pivots, mu, the tangent's mu, step made,
    step to try next)``; the state is left as :func:`step_ahead` leaves it.
    """
    step = min(step, longest_step(track, mu, tangent_mu, path))
    while step > LEAST_STEP:
        status, negative, next_mu, next_tangent_mu = step_ahead(
            density, track, n, cells, path, mu, tangent_mu, step, work
        )
        if status == FOLLOWED:
            wrong = defect(track, path, mu, tangent_mu, next_mu, next_tangent_mu, step)
            if wrong < DEFECT or (path.bends and step < SHORT and wrong < BEND):
                return (
                    FOLLOWED,
                    negative,
                    next_mu,
                    next_tangent_mu,
                    step,
                    step * (GROWTH if wrong < 0.5 * DEFECT else 1.0),
                )
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
    for i in range(n + 1):
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
def last_alike(density, track, n, cells, path, mu, tangent_mu, step, sense, stable, work):
    """The last state on a step that is as ``stable``, or not, as its beginning, while its end is not so: bisection in
    arclength. ``(mu, the tangent's mu, step)``; the state is left as :func:`step_ahead` leaves it.

    At a fold mu differs from the fold's by the square of what is left.
    """
    low, high = 0.0, step
    while high - low > ROUNDING * step:
        at = 0.5 * (low + high)
        status, negative, _, now = step_ahead(density, track, n, cells, path, mu, tangent_mu, at, work)
        if status == FOLLOWED and is_stable(negative, now, sense) == stable:
            low = at
        else:
            high = at
    _, _, found, now = step_ahead(density, track, n, cells, path, mu, tangent_mu, low, work)
    return found, now, low

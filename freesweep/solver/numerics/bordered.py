"""The corrector of :mod:`continuation`: Newton's method on a plane, for a shape, the load along its path, and that of what
is held.

With H the Hessian of -J, b = dg/dmu and (n, m) the normal of the plane; where an integral C is held, at a target T(mu), its
load nu is one unknown more, its equation another row, with c = -dC/dy = dg/dnu and k = dC/dnu::

    [ H     b         c ] [ dy  ]     [ g     ]
    [ n^T   m         0 ] [ dmu ] = - [ plane ]
    [ -c^T  C_mu - T' k ] [ dnu ]     [ C - T ]

One node joins the border, so that what is left of H is regular at a fold.
"""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..cells import cell_at, of_length
from .dense import eliminate
from .held import hold
from .newton import assemble, factor, substitute, system_in
from .path import load_at, size_of

CORRECTIONS = 12  # of Newton's method; three suffice where a step is taken
CORRECTED = 1e-7  # relative: the next correction would be its square
STUCK = 1e-5  # relative: a correction that rounding keeps from falling further
BALANCED = 0.01  # of the room that a slope has: what it may still turn by where the meridian is all but upright
DIFFERENCE = (
    1e-3  # of the load, to see how the gradient changes with it, and of a slope's room: exact where it is linear
)
STILL = 1e-8  # of a tangent: a state that stands cannot leave its branch

LOST, FOLLOWED = 0, 1


class Border(NamedTuple):
    """Scratch (> n,) beside the :class:`.newton.System`: the columns c and b; what H makes of them, of_held and of_mu, and
    of node k, of_k; and where the plane lies.
    """

    c: np.ndarray
    b: np.ndarray
    of_mu: np.ndarray
    anchor: np.ndarray
    of_k: np.ndarray
    of_held: np.ndarray


@kernel
def border_in(work):
    """The :class:`Border` in scratch, which needs no trial."""
    return Border(work[5], work[8], work[9], work[10], work[11], work[12])


@kernel
def largest_share(y, tangent, last):
    """Largest relative change of y per arclength."""
    largest = 0.0
    for i in range(1, last + 1):
        largest = max(largest, abs(tangent[i]) / y[i])
    return largest


@kernel
def load_slope(functional, track, y, n, cells, path, mu, b, work):
    """``b = dg/dmu``: how the gradient of -J changes along the path; returns what C and its target do, ``C_mu - T'``."""
    density, conjugate = functional.density, functional.conjugate
    x, room, spare = track.x, system_in(work).room, border_in(work).of_k
    step = DIFFERENCE * (abs(mu) + path.floor)
    low, high = load_at(path, y, n, mu - step), load_at(path, y, n, mu + step)
    b[0] = 0.0
    for j in range(n):
        h, own = x[j + 1] - x[j], step
        middle, v = 0.5 * (y[j] + y[j + 1]), (y[j + 1] - y[j]) / h
        cell = of_length(cell_at(cells, j), h)
        below, above = density(middle, v, cell, low), density(middle, v, cell, high)
        change, allowed = max(abs(above[0] - room[j]), abs(below[0] - room[j])), DIFFERENCE * room[j]
        if change > allowed:
            own *= allowed / change
            below = density(middle, v, cell, load_at(path, y, n, mu - own))
            above = density(middle, v, cell, load_at(path, y, n, mu + own))
        half, turn = 0.25 * h * (above[1] - below[1]) / own, 0.5 * (above[2] - below[2]) / own
        b[j] += turn - half
        b[j + 1] = -half - turn
    if not path.held.any:
        return 0.0
    below, _ = hold(conjugate, x, y, n, cells, low, path.held.unit, spare)
    above, _ = hold(conjugate, x, y, n, cells, high, path.held.unit, spare)
    return (above - below) / (2.0 * step) - path.held.change


@kernel
def is_balanced(x, y, n, last, system):
    """Whether no slope would turn by much of its room if its nodes gave way to what is left of the forces on them: beside an
    upright meridian a change of y that hardly shows is far from small.
    """
    g, d, room, before = system.g, system.d, system.room, 0.0
    for j in range(n):
        after = abs(g[j + 1] / d[j + 1]) if j + 1 <= last else 0.0
        h = x[j + 1] - x[j]
        if not max(before, after) * abs(y[j + 1] - y[j]) < BALANCED * room[j] * h * h:
            return False
        before = after
    return True


@kernel
def leading(track, n):
    """The node that counts most on the plane's normal: to hold it keeps what is left of H away from a fold."""
    most, node = 0.0, track.last
    for i in range(1, track.last + 1):
        if abs(track.normal[i]) * track.y[i] > most:
            most, node = abs(track.normal[i]) * track.y[i], i
    return node


@kernel
def without(inverse, e, last, k, column, out):
    """``out = H'^-1 column`` where H' is H without its row and column k; returns what row k of H makes of it, with the sign
    of an unknown that it is the change of: ``column[k] - H[k] out``.
    """
    left, own = e[k - 1], column[k]
    right = e[k]
    column[k] = e[k - 1] = e[k] = 0.0
    substitute(inverse, e, 1, last, column, out)
    column[k], e[k - 1], e[k], out[k] = own, left, right, 0.0
    return own - (left * out[k - 1] if k > 1 else 0.0) - (right * out[k + 1] if k < last else 0.0)


@kernel
def factor_without(d, e, last, k, inverse):
    """Factors of H without its row and column k; returns its negative pivots."""
    own, left, right = d[k], e[k - 1], e[k]
    d[k], e[k - 1], e[k] = 1.0, 0.0, 0.0
    negative = factor(d, e, 1, last, inverse)
    d[k], e[k - 1], e[k] = own, left, right
    return negative


@kernel
def times(one, other, last):
    """Scalar product of two shapes."""
    total = 0.0
    for i in range(1, last + 1):
        total += one[i] * other[i]
    return total


@kernel
def border(track, n, path, normal_mu, k, off_plane, held_row, work, matrix, right):
    """The equations that node k, nu and mu are left with, into ``matrix`` and ``right`` (3, 2), whose second column is the
    tangent's: of row k of H, of what is held, ``held_row`` = (C - T, dC/dnu, C_mu - T'), and of the plane. Returns how
    many directions that keep what is held are unstable.
    """
    g, d, e, inverse, step, _, _, _ = system_in(work)
    c, b, of_mu, _, of_k, of_held = border_in(work)
    normal, last = track.normal, track.last
    negative = factor_without(d, e, last, k, inverse)
    right[0, 0] = -without(inverse, e, last, k, g, step)
    matrix[0, 2] = without(inverse, e, last, k, b, of_mu)
    for i in range(n + 1):
        g[i] = 0.0
    if k > 1:
        g[k - 1] = e[k - 1]
    if k < last:
        g[k + 1] = e[k]
    matrix[0, 0] = d[k] + without(inverse, e, last, k, g, of_k)
    negative += 1 if not matrix[0, 0] > 0.0 else 0
    matrix[0, 1] = matrix[1, 0] = matrix[1, 2] = matrix[2, 1] = right[1, 0] = right[0, 1] = right[1, 1] = 0.0
    matrix[1, 1], right[2, 1] = 1.0, 1.0
    if path.held.any:
        miss, by_held, by_mu = held_row
        matrix[0, 1] = without(inverse, e, last, k, c, of_held)
        matrix[1, 0], matrix[1, 1] = times(c, of_k, last) - c[k], by_held + times(c, of_held, last)
        matrix[1, 2], right[1, 0] = by_mu + times(c, of_mu, last), -miss - times(c, step, last)
        matrix[2, 1] = -times(normal, of_held, last)
        sigma = matrix[1, 1] + matrix[0, 1] * matrix[0, 1] / matrix[0, 0]  # dC/dnu along the branch
        negative -= 1 if sigma < 0.0 else 0
    matrix[2, 0], matrix[2, 2] = normal[k] - times(normal, of_k, last), normal_mu - times(normal, of_mu, last)
    right[2, 0] = times(normal, step, last) - off_plane
    return negative


@kernel
def correct(functional, track, y, mu, n, cells, path, normal_mu, tangent, work):
    """Newton's method on the plane through (y, mu) with the track's normal, y in place; ``tangent`` takes the branch's, of
    length 1 on the normal.

    One node k, mu and nu border the rest of H, which is factored with that node held: at a fold H is singular, the rest is
    not. Returns ``(status, unstable directions beyond those allowed, mu, the tangent's mu)``.
    """
    system = system_in(work)
    step, least = system.step, system.least
    c, b, of_mu, anchor, of_k, of_held = border_in(work)
    held, last, k, before, anchor_mu = path.held, track.last, leading(track, n), 1e300, mu
    matrix, right = np.empty((3, 3)), np.empty((3, 2))
    for i in range(n + 1):
        anchor[i], least[i], of_held[i] = y[i], 0.0, 0.0
    for _ in range(CORRECTIONS):
        now, held_row = load_at(path, y, n, mu), (0.0, 0.0, 0.0)
        if not assemble(functional.density, track.x, y, n, cells, now, False, system):
            return LOST, 0, mu, 0.0
        balanced = is_balanced(track.x, y, n, last, system)
        by_mu = load_slope(functional, track, y, n, cells, path, mu, b, work)
        if held.any:
            total, by_held = hold(functional.conjugate, track.x, y, n, cells, now, held.unit, c)
            held_row = total - (held.first + mu * held.change), by_held, by_mu
        off_plane = normal_mu * (mu - anchor_mu)
        for i in range(1, last + 1):
            off_plane += track.normal[i] * (y[i] - anchor[i])
        negative = border(track, n, path, normal_mu, k, off_plane, held_row, work, matrix, right)
        eliminate(matrix, right)
        change_k, change_held, change = right[0, 0], right[1, 0], right[2, 0]
        mu += change
        size = abs(change) / size_of(mu, path)
        if held.any:
            y[n + 1] += change_held
            size = max(size, abs(change_held) / max(1.0, abs(y[n + 1])))
        for i in range(1, last + 1):
            move = change_k if i == k else -step[i] - change * of_mu[i] - change_k * of_k[i] - change_held * of_held[i]
            size = max(size, abs(move) / y[i])
            y[i] += move
        if not size < 1.0:
            return LOST, 0, mu, 0.0
        if balanced and (size < CORRECTED or (size < STUCK and size >= 0.5 * before)):
            tangent_k, tangent_held, tangent_mu = right[0, 1], right[1, 1], right[2, 1]
            tangent[0] = tangent[n] = 0.0
            for i in range(1, last + 1):
                other = -tangent_mu * of_mu[i] - tangent_k * of_k[i] - tangent_held * of_held[i]
                tangent[i] = tangent_k if i == k else other
            for i in range(n + 1, len(tangent)):
                tangent[i] = tangent_held
            if held.any and largest_share(y, tangent, last) < STILL * abs(tangent_mu) / size_of(mu, path):
                negative = 0
            return FOLLOWED, max(0, negative - held.allowed), mu, tangent_mu
        before = size
    return LOST, 0, mu, 0.0

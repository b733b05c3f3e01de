"""The numerics: stationary points of ``J = sum h L(y_mid, slope)`` on a mesh, for any scalar density L(y, y').

The functional itself is discretized, on midpoint cells, so the gradient is the discrete Euler-Lagrange equation and the
Hessian is symmetric tridiagonal. A maximum of J is sought: gradient g and Hessian H are those of -J, and H is positive
definite at a maximum. The pivots of its LDL^T factors count the directions in which a state is unstable (Sylvester).

``density(y, v, cell, load) -> (room, L_y, L_v, L_yy, L_yv, L_vv)`` is handed in, which from cell to cell hands on what it
likes (:func:`..cells.behind`); a state is admissible where room > 0 and y > 0. ``y[0]`` is held; so is ``y[n]`` unless
``free`` (a plane of symmetry: the natural condition).
"""

from typing import NamedTuple

import numpy as np

from ...jit import in_place, kernel
from ..cells import behind, cell_at, nothing_yet, of_length

MAX_ITERATIONS = 60  # a warm start takes 1 to 3, a bad first guess at a small angle 25
MAX_HALVINGS = 30  # of one step: below 1e-9 of it nothing is gained
SMALL_STEP = 1e-4  # relative: below it the full step is taken without a search
MIN_ROOM = 0.02  # share of the room of any cell that one step must leave
UNKNOWN = 1e300  # rate of convergence before it was seen
CAUTION = 10.0  # times the rate seen so far

CONVERGED, STALLED, INFEASIBLE = 0, 1, 2


class Mesh(NamedTuple):
    """The first n cells between nodes ``x``; whether the last node is ``free``; and what varies along them."""

    x: np.ndarray
    n: int
    free: bool
    cells: np.ndarray


class System(NamedTuple):
    """Scratch (> n,) of one step: gradient g; Hessian, d on the diagonal and e beside it, and its inverse pivots; step and
    trial; room that cells have, and the least that they may have been left with.
    """

    g: np.ndarray
    d: np.ndarray
    e: np.ndarray
    inverse: np.ndarray
    step: np.ndarray
    trial: np.ndarray
    room: np.ndarray
    least: np.ndarray


@kernel
def system_in(work):
    """The :class:`System` in the first rows of scratch."""
    return System(work[0], work[1], work[2], work[3], work[4], work[5], work[6], work[7])


@in_place
def assemble(density, x, y, n, cells, load, convex, system):
    """Gradient and Hessian of -J on n cells, into the :class:`System`; False if not admissible.

    The room of each cell is written, and refused where it is not above MIN_ROOM of the least. ``convex`` drops
    whatever makes a cell's own Hessian indefinite: far from the solution every step is a descent then.
    """
    g, d, e, room, least = system.g, system.d, system.e, system.room, system.least
    fits = True
    varying = len(cells) > 1
    cell = cell_at(cells, 0)
    g_left, d_left, near = 0.0, 0.0, nothing_yet(0.0)
    for j in range(n):
        if varying:
            cell = cell_at(cells, j)
        h = x[j + 1] - x[j]
        per_h = 1.0 / h
        v = (y[j + 1] - y[j]) * per_h
        middle = 0.5 * (y[j] + y[j + 1])
        space, L_y, L_v, L_yy, L_yv, L_vv, near = density(middle, v, behind(cell, h, near), load)
        fits = fits and space > MIN_ROOM * least[j] and middle > 0.0  # a NaN counts as no room
        room[j] = space
        if convex:
            L_yy = min(L_yy, L_yv * L_yv / L_vv)
        half = 0.5 * h * L_y
        corner = 0.25 * h * L_yy
        stiff = L_vv * per_h
        g[j] = g_left - half + L_v
        d[j] = d_left - corner + L_yv - stiff
        e[j] = stiff - corner
        g_left = -half - L_v
        d_left = -corner - L_yv - stiff
    g[n], d[n] = g_left, d_left
    return fits


@kernel
def admissible(density, x, y, n, cells, load):
    """Whether every cell has room."""
    for j in range(n):
        middle, h = 0.5 * (y[j] + y[j + 1]), x[j + 1] - x[j]
        room = density(middle, (y[j + 1] - y[j]) / h, of_length(cell_at(cells, j), h), load)[0]
        if not (room > 0.0 and middle > 0.0):
            return False
    return True


@kernel
def factor(d, e, first, last, inverse):
    """LDL^T of rows first..last: writes the ``inverse`` pivots, returns how many are negative."""
    negative = 0
    below = 0.0
    for i in range(first, last + 1):
        pivot = d[i] - below
        per_pivot = 1.0 / pivot
        inverse[i] = per_pivot
        below = e[i] * e[i] * per_pivot
        if not pivot > 0.0:
            negative += 1
    return negative


@kernel
def substitute(inverse, e, first, last, b, out):
    """``out = H^-1 b`` with the factors of :func:`factor`."""
    carried = 0.0
    for i in range(first, last + 1):
        value = b[i] - carried
        out[i] = value
        carried = e[i] * value * inverse[i]
    carried = 0.0
    for i in range(last, first - 1, -1):
        carried = (out[i] - (e[i] * carried if i < last else 0.0)) * inverse[i]
        out[i] = carried


@kernel
def settled(size, before, rate, tolerance):
    """Whether the step just made, of relative ``size``, leaves an error below ``tolerance``: quadratic convergence makes
    the next one ``rate size^2``; or rounding keeps it from shrinking.
    """
    return size < SMALL_STEP and (CAUTION * rate * size * size < tolerance or (size < 1e-9 and size > 0.3 * before))


@kernel
def new_rate(rate, size, before):
    """The rate of quadratic convergence, if the two steps show it: neither too long nor lost in rounding."""
    if 1e-12 < size and before < 0.03:
        return size / (before * before)
    return rate


@kernel
def solve(density, y, mesh, load, rate, tolerance, work):
    """Damped Newton from ``y`` (changed in place), to a relative error of ``tolerance``.

    Returns ``(status, negative pivots, rate, error)``; the rate of convergence seen on one mesh serves the next; the last
    step may have left the relative ``error``. ``work`` is scratch of shape (13, > n).
    """
    x, n, free, cells = mesh
    system = system_in(work)
    g, d, e, inverse, step, trial, room, least = system
    first, last = 1, n if free else n - 1
    for i in range(n + 1):
        trial[i], least[i] = y[i], 0.0
    convex, negative, halvings, iterations = False, 0, 0, 0
    size, before, fraction, slope = 1e300, 1e300, 0.0, 0.0
    while iterations < MAX_ITERATIONS and halvings < MAX_HALVINGS:
        admitted = assemble(density, x, trial, n, cells, load, convex, system)
        if iterations == 0 and not admitted:
            return INFEASIBLE, 0, rate, tolerance
        if iterations > 0 and not convex:
            # shorten a long step until its slope says that the valley's floor was not overshot by much
            after = -1.0
            if size >= SMALL_STEP:
                after = 0.0
                for i in range(first, last + 1):
                    after += g[i] * step[i]
            if not admitted or after > -0.9 * slope:
                fraction *= 0.5
                halvings += 1
                for i in range(n + 1):
                    trial[i] = y[i] + fraction * step[i]
                continue
            before = size if fraction == 1.0 and negative == 0 else 1e300
            for i in range(n + 1):
                y[i], least[i] = trial[i], room[i]
        pivots = factor(d, e, first, last, inverse)
        if not convex:
            negative = pivots
            if negative > 0:
                convex = True  # assemble again, at the same state
                continue
        substitute(inverse, e, first, last, g, step)
        step[0] = 0.0
        step[n] = step[n] if free else 0.0
        size, slope, largest = 0.0, 0.0, y[0]
        for i in range(1, n + 1):
            change = -step[i]
            step[i] = change
            trial[i] = y[i] + change
            size = max(size, abs(change))
            largest = max(largest, y[i])
            slope += g[i] * change if i <= last else 0.0
        size /= largest
        rate = new_rate(rate, size, before)
        if negative == 0 and settled(size, before, rate, tolerance):
            for i in range(n + 1):
                y[i] = trial[i]
            return CONVERGED, 0, rate, min(CAUTION * rate * size * size, size)
        fraction, convex, halvings, iterations = 1.0, False, 0, iterations + 1
    return STALLED, 1, rate, tolerance

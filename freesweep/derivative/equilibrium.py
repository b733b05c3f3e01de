"""States on several meshes at once: Newton's method, and how outputs change with each parameter.

``J = sum h L(y_mid, slope)``, as in :mod:`freesweep.solver.numerics.newton`, is stationary in the nodes' stretches y.
Where a parameter changes, ``J_yy dy = -J_ytheta``, one tridiagonal solution, and an output changes by ``Q_theta + Q_y
dy``. Meshes that know nothing of each other are one banded system all the same: NumPy's time is that of its calls.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, solve_banded

from .dual import Dual
from .physics import BY_V, BY_Y, OWN

ITERATIONS, HALVINGS = 40, 30
SMALL, SETTLED = 1e-7, 1e-12  # relative steps: after the first one the next is rounding
MIN_ROOM = 0.02  # of the room of any cell that a step must leave, as in the solver's


class Meshes:
    """Nodes ``x`` (x/l) of meshes one behind the other, each from 0 on; the last node of each is ``free`` or not."""

    def __init__(self, meshes, free):
        self.x = np.concatenate(meshes)
        sizes = [len(mesh) for mesh in meshes]
        self.starts = np.cumsum([0, *sizes[:-1]])
        self.ends = self.starts + sizes - 1
        self.left = np.delete(np.arange(len(self.x)), self.ends)  # node at the left of each cell
        self.first_cells = self.starts - np.arange(len(sizes))
        self.fixed = self.starts if free else np.concatenate([self.starts, self.ends])
        self.middle = self.ends if free else [s + np.argmin(np.abs(m - 0.5)) for s, m in zip(self.starts, meshes)]
        self.step = np.diff(self.x)[self.left]
        self.share = self.x[self.left] + 0.5 * self.step

    def cells(self, mesh):
        """Which cells belong to one of the meshes."""
        first = self.first_cells[mesh]
        return slice(first, first + self.ends[mesh] - self.starts[mesh])

    def to_nodes(self, left, right):
        """What cells give to the nodes at their ends."""
        out = np.zeros((*left.shape[:-1], len(self.x)))
        out[..., self.left] += left
        out[..., self.left + 1] += right
        return out

    def total(self, rows):
        """Sums over the cells of each mesh, (..., meshes)."""
        return np.add.reduceat(rows, self.first_cells, axis=-1)


class Sums(NamedTuple):
    """What meshes sum up: gradient and Hessian of J by the nodes."""

    room: np.ndarray  # (cells,)
    gradient: np.ndarray  # (1 + parameters, nodes): J_y, and J_y by each parameter
    hessian: np.ndarray  # (3, nodes): as LAPACK takes the bands


def _full(number, count, cells):
    """Value and parts of a number over all cells: (1 + count, cells)."""
    out = np.zeros((1 + count, cells))
    if not isinstance(number, Dual):
        out[0] = number
        return out
    out[0] = number.value
    if number.parts is not None:
        out[1:] = number.parts
    return out


def _by_left(rows, step):
    """What cells' numbers change by with the node at their left; ``rows`` (..., 1 + parameters, cells)."""
    return 0.5 * rows[..., 1 + BY_Y, :] - rows[..., 1 + BY_V, :] / step


def _by_right(rows, step):
    return 0.5 * rows[..., 1 + BY_Y, :] + rows[..., 1 + BY_V, :] / step


def _cells(physics, meshes, y):
    """Stretch and slope in the cells as dual numbers, and by how much the tube's length scales the mesh."""
    seeds = np.zeros((2, OWN + len(physics.parameters), 1))
    seeds[0, BY_Y], seeds[1, BY_V] = 1.0, 1.0
    scale = physics.length / physics.length.value
    left, right = y[meshes.left], y[meshes.left + 1]
    slope = (right - left) / (meshes.step * physics.length.value)
    return Dual(0.5 * (right + left), seeds[0]), Dual(slope, seeds[1]) / scale, scale


def sums(physics, meshes, y) -> Sums:
    """Sum over the cells of the meshes."""
    count, n = OWN + len(physics.parameters), len(meshes.step)
    step = meshes.step * physics.length.value
    stretch, slope, scale = _cells(physics, meshes, y)
    room, L_y, L_v = physics.local(stretch, slope, meshes.share)
    half = _full(0.5 * step * scale * L_y, count, n)
    flux = _full(L_v, count, n)
    left, right = half - flux, half + flux
    hessian = np.zeros((3, len(meshes.x)))
    hessian[0, meshes.left + 1] = _by_right(left, step)
    hessian[1] = meshes.to_nodes(_by_left(left, step), _by_right(right, step))
    hessian[2, meshes.left] = _by_left(right, step)
    own = [0, *range(1 + OWN, 1 + count)]
    return Sums(np.broadcast_to(room, n), meshes.to_nodes(left[own], right[own]), hessian)


def responses(found, meshes):
    """How the nodes move with each parameter, (parameters, nodes), after the step to J_y = 0, (nodes,)."""
    bands, right = found.hessian.copy(), -found.gradient
    fixed = meshes.fixed
    bands[1, fixed], right[:, fixed] = 1.0, 0.0
    bands[0, (fixed + 1) % len(meshes.x)] = bands[2, fixed - 1] = 0.0
    moved = solve_banded((1, 1), bands, right.T, overwrite_ab=True, check_finite=False).T
    return moved[1:], moved[0]


class NotFound(Exception):
    """No state of a mesh near the one that is known."""


def equilibrium(physics, meshes, y):
    """The stretches of the nodes, from a guess ``y`` close to them. Raises :class:`NotFound`."""
    before, fraction, room = np.inf, 1.0, np.zeros(len(meshes.step))
    step, halvings = np.zeros_like(y), 0
    for _ in range(ITERATIONS):
        while True:
            trial = y + fraction * step
            with np.errstate(all="ignore"):
                found = sums(physics, meshes, trial)
            if np.all(found.room > MIN_ROOM * room) and np.all(trial > 0.0):
                break
            fraction, halvings = 0.5 * fraction, halvings + 1
            if halvings > HALVINGS:
                raise NotFound
        y, room = trial, found.room
        try:
            _, step = responses(found, meshes)
        except LinAlgError:
            raise NotFound from None
        size = np.max(np.abs(step) / y)
        if not np.isfinite(size):
            raise NotFound
        if size < SMALL and (size < SETTLED or size > 0.3 * before):
            return y + step
        before, fraction, halvings = size, 1.0, 0
    raise NotFound


def outputs(physics, meshes, y):
    """The outputs in SI units and degrees, dual numbers over the meshes with their derivatives by the parameters of
    ``physics``; Raises :class:`NotFound`.
    """
    count, n = OWN + len(physics.parameters), len(meshes.step)
    try:
        moved, _ = responses(sums(physics, meshes, y), meshes)
    except LinAlgError:
        raise NotFound from None
    step = meshes.step * physics.length.value
    stretch, slope, scale = _cells(physics, meshes, y)
    integrands = physics.integrands(stretch, slope, meshes.share)
    own = [0, *range(1 + OWN, 1 + count)]
    rows = np.stack([_full(step * scale * q, count, n) for q in integrands])
    totals = meshes.total(rows[:, own])  # (4, 1 + parameters, meshes)
    by_nodes = _by_left(rows, step)[:, None] * moved[:, meshes.left]
    by_nodes += _by_right(rows, step)[:, None] * moved[:, meshes.left + 1]
    totals[:, 1:] += meshes.total(by_nodes)

    def number(value, by):
        return Dual(value, np.concatenate([np.zeros((OWN, len(value))), by]))

    middle = number(y[meshes.middle], moved[:, meshes.middle])
    return physics.outputs([number(row[0], row[1:]) for row in totals], middle, len(meshes.fixed) == len(meshes.starts))

"""States on several meshes at once: Newton's method, and how outputs change with each parameter.

``J = sum h L(y_mid, slope)``, as in :mod:`freesweep.solver.numerics.newton`, is stationary in the nodes' stretches y.
Where a parameter changes, ``J_yy dy = -J_ytheta``, one tridiagonal solution, and an output changes by ``Q_theta + Q_y
dy``. Meshes that know nothing of each other are one banded system all the same: NumPy's time is that of its calls.

Where an output is held, the load that holds it is one unknown more on each mesh: it changes by what of the output a step
under given loads leaves missing (:mod:`freesweep.solver.numerics.held`).
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, solve_banded

from .dual import Dual
from .physics import BY_V, BY_Y, OWN

ITERATIONS, HALVINGS = 40, 30
SMALL, SETTLED = 1e-7, 1e-12  # relative steps: after the first one the next is rounding
MIN_ROOM = 0.02  # of the room of any cell that a step must leave, as in the solver's


class NotFound(Exception):
    """No state of a mesh near the one that is known."""


class Meshes:
    """Nodes ``x`` (x/l) of meshes one behind the other, each from 0 on; the last node of each is ``free`` or not."""

    def __init__(self, meshes, free):
        self.x = np.concatenate(meshes)
        self.free, sizes = free, [len(mesh) for mesh in meshes]
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

    def nodes(self, mesh):
        """Which nodes do."""
        return slice(self.starts[mesh], self.ends[mesh] + 1)

    def at_nodes(self, numbers):
        """Numbers of the meshes at all nodes."""
        return np.repeat(numbers, self.ends - self.starts + 1)

    def in_cells(self, numbers):
        """Numbers of the meshes in all cells."""
        return np.repeat(numbers, self.ends - self.starts)

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
    left: np.ndarray  # (1 + parts, cells): what each cell gives to the node at its left, the flux through that
    right: np.ndarray  # likewise


def full(number, count, cells):
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


def cells_of(physics, meshes, y):
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
    stretch, slope, scale = cells_of(physics, meshes, y)
    room, L_y, L_v = physics.local(stretch, slope, meshes.share)
    half = full(0.5 * step * scale * L_y, count, n)
    flux = full(L_v, count, n)
    left, right = half - flux, half + flux
    hessian = np.zeros((3, len(meshes.x)))
    hessian[0, meshes.left + 1] = _by_right(left, step)
    hessian[1] = meshes.to_nodes(_by_left(left, step), _by_right(right, step))
    hessian[2, meshes.left] = _by_left(right, step)
    own = [0, *range(1 + OWN, 1 + count)]
    return Sums(np.broadcast_to(room, n), meshes.to_nodes(left[own], right[own]), hessian, left, right)


def responses(found, meshes):
    """How the nodes move with each parameter, (parameters, nodes), after the step to J_y = 0, (nodes,). Raises
    :class:`NotFound`.
    """
    bands, right = found.hessian.copy(), -found.gradient
    fixed = meshes.fixed
    bands[1, fixed], right[:, fixed] = 1.0, 0.0
    bands[0, (fixed + 1) % len(meshes.x)] = bands[2, fixed - 1] = 0.0
    try:
        moved = solve_banded((1, 1), bands, right.T, overwrite_ab=True, check_finite=False).T
    except LinAlgError:
        raise NotFound from None
    return moved[1:], moved[0]


class Hold(NamedTuple):
    """An output that is ``held`` at a ``target``, and the load that does it, ``unknown``, with the ``unit`` that it is
    measured by: its values on the meshes.
    """

    held: str
    unknown: str
    target: float
    unit: float
    load: np.ndarray

    def missing(self, made):
        """How much more of the load it takes on each mesh, from ``made`` outputs that know their derivatives by it."""
        return (self.target - made[self.held].value) / made[self.held].parts[OWN]


def equilibrium(physics, meshes, y, hold=None):
    """The stretches of the nodes, from a guess ``y`` close to them, and what holds them: ``(y, hold)``; the load that is
    unknown is the first parameter of ``physics``, which bears that of the last mesh then. Raises :class:`NotFound`.
    """
    first, unit = meshes.starts, 1.0
    if hold is not None:
        hold = hold._replace(load=np.repeat(hold.load[-1:], len(first)))
        unit = max(hold.unit, abs(hold.load[0]))
    step, room, before = np.zeros_like(y), np.zeros(len(meshes.step)), np.full(len(first), np.inf)
    more = np.zeros(len(first))
    for _ in range(ITERATIONS):
        fraction = np.ones(len(first))
        for _ in range(HALVINGS):
            trial = y + meshes.at_nodes(fraction) * step
            if hold is not None:
                physics.bear(hold.unknown, meshes.in_cells(hold.load + fraction * more))
            with np.errstate(all="ignore"):
                found = sums(physics, meshes, trial)
            fits = np.logical_and.reduceat(found.room > MIN_ROOM * room, meshes.first_cells)
            fits &= np.logical_and.reduceat(trial > 0.0, first)
            if np.all(fits):
                break
            fraction[~fits] *= 0.5
        else:
            raise NotFound
        y, room = trial, found.room
        moved, step = responses(found, meshes)
        if hold is not None:
            hold = hold._replace(load=hold.load + fraction * more)
            more = hold.missing(outputs_after(physics, meshes, y, moved, step))
            step = step + meshes.at_nodes(more) * moved[0]
        size = np.maximum(np.maximum.reduceat(np.abs(step) / y, first), np.abs(more) / unit)
        if not np.all(np.isfinite(size)):
            raise NotFound
        if np.all((size < SMALL) & ((size < SETTLED) | (size > 0.3 * before))):
            if hold is not None:
                hold = hold._replace(load=hold.load + more)
                physics.bear(hold.unknown, hold.load[-1:])
            return y + step, hold
        before = np.where(fraction == 1.0, size, np.inf)
    raise NotFound


def carried(physics, meshes, rows, moved, step):
    """``rows`` (..., 1 + parts, cells) of cells, as nodes move with each parameter, after a ``step``: (..., 1 + parameters,
    cells).
    """
    width = meshes.step * physics.length.value
    all_moved = np.vstack([step, moved])
    found = rows[:, [0, *range(1 + OWN, rows.shape[1])]]
    found += _by_left(rows, width)[:, None] * all_moved[:, meshes.left]
    found += _by_right(rows, width)[:, None] * all_moved[:, meshes.left + 1]
    return found


def outputs_after(physics, meshes, y, moved, step):
    """The outputs, as far as they change in proportion to it, after a ``step``, and how they change as the nodes ``moved``
    with each parameter, in cells of which the sums were asked last.
    """
    count, n = OWN + len(physics.parameters), len(meshes.step)
    width = meshes.step * physics.length.value
    stretch, slope, scale = cells_of(physics, meshes, y)
    integrands = physics.integrands(stretch, slope, meshes.share)
    rows = np.stack([full(width * scale * q, count, n) for q in integrands])
    totals = meshes.total(carried(physics, meshes, rows, moved, step))

    def number(values):
        return Dual(values[0], np.concatenate([np.zeros((OWN, values.shape[1])), values[1:]]))

    middle = np.vstack([step, moved])[:, meshes.middle]
    middle[0] += y[meshes.middle]
    return physics.outputs([number(row) for row in totals], number(middle), meshes.free)

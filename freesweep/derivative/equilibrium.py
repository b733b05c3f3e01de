"""States on several meshes at once: Newton's method, and how outputs change with each parameter.

``J = sum h L(y_mid, slope)``, as in :mod:`freesweep.solver.numerics.newton`, is stationary in the nodes' stretches y.
Where a parameter changes, ``J_yy dy = -J_ytheta``, one tridiagonal solution, and an output changes by ``Q_theta + Q_y
dy``. Meshes that know nothing of each other are one banded system all the same: NumPy's time is that of its calls.

Where an output is held, the load that holds it is one unknown more on each mesh: it changes by what of the output a step
under given loads leaves missing (:mod:`freesweep.solver.numerics.held`).
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, solve_banded

from .dual import Dual
from .extremes import Piece, extremes, fields, unknown
from .physics import BY_V, BY_Y, OWN

ITERATIONS, HALVINGS = 40, 30
SMALL, SETTLED = 1e-7, 1e-12  # relative steps: after the first one the next is rounding
INSIDE = 1e-9  # of half a cell: the profiles at its end
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
            more = hold.missing(_outputs(physics, meshes, y, moved, step))
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


def outputs(physics, meshes, y, ends, segments):
    """The outputs in SI units and degrees, dual numbers over the meshes with their derivatives by the parameters of
    ``physics``, and the doubts of :func:`.extremes.extremes`: between ``ends`` all is smooth, where ``segments`` meet
    profiles jump. Raises :class:`NotFound`.
    """
    found = sums(physics, meshes, y)
    moved, step = responses(found, meshes)
    made = _outputs(physics, meshes, y, moved, step)
    try:
        with np.errstate(all="ignore"):
            pieces = _pieces(physics, meshes, y, (found, moved, step), ends, segments)
            along, doubts = extremes(physics, pieces, segments, 2.0 if meshes.free else 1.0)
    except NotFound:  # where fibers settle at an end
        along, doubts = unknown(len(physics.parameters), len(meshes.starts))
    return made | along, doubts


def _pieces(physics, meshes, y, answers, ends, segments):
    """The :class:`.extremes.Piece` of each mesh between ``ends``, with what :func:`.extremes.fields` tells; those ends are
    places of it, too, where ``segments`` meet. ``answers``: sums, how nodes move, and the last step.
    """
    found, moved, step = answers
    stretch, slope, _ = _cells(physics, meshes, y)
    count = OWN + len(physics.parameters)
    seen = fields(physics, stretch, physics.place(stretch, slope, meshes.share), meshes.share)
    rows = np.stack([_full(one, count, len(meshes.step)) for one in seen])
    fluxes = np.stack([found.left, found.right])
    rows = _carried(physics, meshes, np.concatenate([rows, fluxes]), moved, step)
    cells, nodes, parts = [], [], []
    for mesh in range(len(meshes.starts)):
        x, first = meshes.x[meshes.nodes(mesh)], meshes.cells(mesh).start
        at = [int(np.argmin(np.abs(x - end))) for end in ends]
        for a, b in pairwise(at):
            cells += [first + a, first + b - 1]
            nodes += [meshes.starts[mesh] + a, meshes.starts[mesh] + b]
            parts.append((mesh, slice(first + a, first + b), (x[a], x[b])))
    cells, nodes = np.array(cells), np.array(nodes)
    at_ends = _at_nodes(physics, meshes, y, (rows[-2:], moved, step), cells, nodes)
    pieces = [[] for _ in meshes.starts]
    for k, (mesh, own, (low, high)) in enumerate(parts):
        stay = [end for end, place in ((0, low), (1, high)) if np.any(segments == place)]
        told = np.insert(rows[:-2, :, own], [0, own.stop - own.start], at_ends[..., 2 * k : 2 * k + 2], axis=-1)
        x = np.concatenate([[low], meshes.share[own], [high]])
        beside = np.clip(np.arange(own.start - 1, own.stop + 1), own.start, own.stop - 1)
        keep = slice(0 if 0 in stay else 1, None if 1 in stay else -1)
        pieces[mesh].append(Piece(x[keep], told[..., keep], (low, high), beside[keep]))
    return pieces


def _at_nodes(physics, meshes, y, answers, cells, nodes):
    """What :func:`.extremes.fields` tells of nodes, (fields, 1 + parameters, nodes), by the flux through them, which a cell
    beside each tells: its first node, or its last one, in turn.
    """
    fluxes, moved, step = answers
    none = np.zeros((OWN, len(nodes)))

    def number(values):
        return Dual(values[0], np.concatenate([none, values[1:]]))

    flux = np.where(np.arange(len(nodes)) % 2 == 0, fluxes[0][:, cells], fluxes[1][:, cells])
    all_moved = np.vstack([y + step, moved])[:, nodes]
    share = meshes.x[nodes] + INSIDE * (meshes.share[cells] - meshes.x[nodes])
    stretch = number(all_moved)
    here, count = physics.in_cells(cells), OWN + len(physics.parameters)
    seen = fields(here, stretch, here.at_flux(stretch, number(flux), share), share)
    return np.stack([_full(one, count, len(nodes)) for one in seen])[:, [0, *range(1 + OWN, 1 + count)]]


def _carried(physics, meshes, rows, moved, step):
    """``rows`` (..., 1 + parts, cells) of cells, as nodes move with each parameter, after a ``step``: (..., 1 + parameters,
    cells).
    """
    width = meshes.step * physics.length.value
    all_moved = np.vstack([step, moved])
    found = rows[:, [0, *range(1 + OWN, rows.shape[1])]]
    found += _by_left(rows, width)[:, None] * all_moved[:, meshes.left]
    found += _by_right(rows, width)[:, None] * all_moved[:, meshes.left + 1]
    return found


def _outputs(physics, meshes, y, moved, step):
    """The outputs, as far as they change in proportion to it, after a ``step``, and how they change as the nodes ``moved``
    with each parameter, in cells of which the sums were asked last.
    """
    count, n = OWN + len(physics.parameters), len(meshes.step)
    width = meshes.step * physics.length.value
    stretch, slope, scale = _cells(physics, meshes, y)
    integrands = physics.integrands(stretch, slope, meshes.share)
    rows = np.stack([_full(width * scale * q, count, n) for q in integrands])
    totals = meshes.total(_carried(physics, meshes, rows, moved, step))

    def number(values):
        return Dual(values[0], np.concatenate([np.zeros((OWN, values.shape[1])), values[1:]]))

    middle = np.vstack([step, moved])[:, meshes.middle]
    middle[0] += y[meshes.middle]
    return physics.outputs([number(row) for row in totals], number(middle), meshes.free)

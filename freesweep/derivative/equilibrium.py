"""One state on one mesh: Newton's method, and how its outputs change with each parameter.

``J = sum h L(y_mid, slope)``, as in :mod:`freesweep.solver.newton`, is stationary in the nodes' stretches y. Where a
parameter changes, ``J_yy dy = -J_ytheta``, one tridiagonal solution, and an output changes by ``Q_theta + Q_y dy``. Where
an integral C is held, its load mu is one more parameter, and ``C_theta + C_mu dmu = target_theta``.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, solve_banded

from .dual import Dual
from .physics import BY_V, BY_Y, OWN

ITERATIONS, HALVINGS = 40, 30
SMALL, SETTLED = 1e-7, 1e-12  # relative steps: after the first one the next is rounding
MIN_ROOM = 0.02  # of the room of any cell that a step must leave, as in the solver's


class Sums(NamedTuple):
    """What a mesh sums up: gradient and Hessian of J by the nodes, and the outputs with theirs."""

    room: np.ndarray  # (cells,)
    gradient: np.ndarray  # (1 + parameters, nodes): J_y, and J_y by each parameter
    hessian: np.ndarray  # (3, nodes): as LAPACK takes the bands
    integrals: np.ndarray  # (4, 1 + parameters)
    by_nodes: np.ndarray  # (4, nodes)


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


def _to_nodes(left, right):
    """What cells give to the nodes at their ends."""
    out = np.zeros((*left.shape[:-1], left.shape[-1] + 1))
    out[..., :-1] += left
    out[..., 1:] += right
    return out


def _by_left(rows, step):
    """What cells' numbers change by with the node at their left; ``rows`` (..., 1 + parameters, cells)."""
    return 0.5 * rows[..., 1 + BY_Y, :] - rows[..., 1 + BY_V, :] / step


def _by_right(rows, step):
    return 0.5 * rows[..., 1 + BY_Y, :] + rows[..., 1 + BY_V, :] / step


def sums(physics, x, y) -> Sums:
    """Sum over the cells of a mesh with nodes ``x`` (x/l)."""
    count, n = OWN + len(physics.parameters), len(x) - 1
    seeds = np.zeros((2, count, 1))
    seeds[0, BY_Y], seeds[1, BY_V] = 1.0, 1.0
    length = physics.length.value
    step = np.diff(x) * length
    stretch = Dual(0.5 * (y[1:] + y[:-1]), seeds[0])
    scale = physics.length / length
    slope = Dual(np.diff(y) / step, seeds[1]) / scale
    room, L_y, L_v, integrands = physics.local(stretch, slope, 0.5 * (x[1:] + x[:-1]))
    half = _full(0.5 * step * scale * L_y, count, n)
    flux = _full(L_v, count, n)
    left, right = half - flux, half + flux
    hessian = np.zeros((3, n + 1))
    hessian[0, 1:] = _by_right(left, step)
    hessian[1] = _to_nodes(_by_left(left, step), _by_right(right, step))
    hessian[2, :-1] = _by_left(right, step)
    own = [0, *range(1 + OWN, 1 + count)]
    rows = np.stack([_full(step * scale * q, count, n) for q in integrands])
    by_nodes = _to_nodes(_by_left(rows, step), _by_right(rows, step))
    return Sums(
        np.broadcast_to(room, n), _to_nodes(left[own], right[own]), hessian, rows[:, own].sum(axis=2), by_nodes
    )  # fmt: skip


def responses(found, free):
    """How the nodes move with each parameter, (parameters, nodes), after the step to J_y = 0, (nodes,)."""
    last = found.gradient.shape[1] - (0 if free else 1)
    bands = found.hessian[:, 1:last].copy()
    moved = np.zeros(found.gradient.shape)
    moved[:, 1:last] = solve_banded((1, 1), bands, -found.gradient[:, 1:last].T, check_finite=False).T
    return moved[1:], moved[0]


class NotFound(Exception):
    """No state of a mesh near the one that is known."""


def equilibrium(physics, x, y, free, held=None):
    """The stretches of the nodes, and the load that holds, from a guess ``y`` close to them.

    ``held``: ``(output, target)``: the output held at a number, by the load that is the one parameter of ``physics``. Raises
    :class:`NotFound`.
    """
    before, fraction, room = np.inf, 1.0, np.zeros(len(x) - 1)
    mu = None if held is None else physics.load
    step, change, halvings = np.zeros_like(y), 0.0, 0
    for _ in range(ITERATIONS):
        while True:
            trial = y + fraction * step
            if held is not None:
                physics.load = mu + fraction * change
            with np.errstate(all="ignore"):
                found = sums(physics, x, trial)
            if np.all(found.room > MIN_ROOM * room) and np.all(trial > 0.0):
                break
            fraction, halvings = 0.5 * fraction, halvings + 1
            if halvings > HALVINGS:
                raise NotFound
        y, room = trial, found.room
        mu = None if held is None else physics.load
        try:
            moved, step = responses(found, free)
        except LinAlgError:
            raise NotFound from None
        if held is not None:
            name, target = held
            total = outputs(physics, x, y, free, found, moved)[name]
            slope = total.parts[OWN, 0]
            own = found.by_nodes @ step
            lag = physics.outputs([Dual(v) for v in own], 0.0, free)[name].value[0]
            change = float((target - total.value[0] - lag) / slope)
            step = step + moved[0] * change
        size = np.max(np.abs(step) / y)
        if held is not None:
            size = max(size, abs(change) / max(physics.unit, abs(mu)))
        if not np.isfinite(size):
            raise NotFound
        if size < SMALL and (size < SETTLED or size > 0.3 * before):
            break
        before, fraction, halvings = size, 1.0, 0
    else:
        raise NotFound
    if held is not None:
        physics.load = mu + change
    return y + step


def outputs(physics, x, y, free, found, moved):
    """The outputs in SI units and degrees, each with its total derivatives by the parameters of ``physics``."""
    totals = found.integrals.copy()
    totals[:, 1:] += found.by_nodes @ moved.T
    middle = len(y) - 1 if free else int(np.argmin(np.abs(x - 0.5)))

    def number(value, by):
        parts = np.zeros((OWN + len(by), 1))
        parts[OWN:, 0] = by
        return Dual(np.array([value]), parts)

    return physics.outputs([number(row[0], row[1:]) for row in totals], number(y[middle], moved[:, middle]), free)

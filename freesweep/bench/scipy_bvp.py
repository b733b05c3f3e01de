"""The peer: SciPy's collocation solver ``solve_bvp``, given every advantage.

The Euler-Lagrange equation in canonical form, ``y' = v(y, q)``, ``q' = L_y(y, v)`` with ``q = L_y'``, on half of the tube;
analytic Jacobians; right-hand sides compiled by Numba; each pressure starts from the one before, on 17 nodes graded by
the width of the end layer. Its uniform stretches are given to it for nothing, and its rate is that of the median
equilibrium, which does not count how long it takes to fail.
"""

import time
from math import sqrt

import numpy as np
from scipy.integrate import solve_bvp

from ..jit import kernel
from ..solver.load import Load
from ..solver.physics import lagrangian

NODES, COLD_NODES = 17, 65  # of a warm start, and of the first pressure
MOST_NODES = 1000  # where it has not converged by then, it does not converge with 20 000 either
GRADING, LEAST = 0.2, 1e-3  # of the mesh: see layer_mesh
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)  # for the outputs, on each interval of its mesh


@kernel
def fill(y, q, cell, load, rates, jacobian):
    """Rates (2, n) and their Jacobian (2, 2, n)."""
    for i in range(len(y)):
        G = 1.0 + lagrangian.kinematics(y[i], cell, load)[3]
        T = load.p * y[i] * y[i] + load.f
        v = -q[i] * sqrt(max(G, 1e-30)) / sqrt(T * T + q[i] * q[i])
        _, L_y, _, L_yy, L_yv, L_vv = lagrangian.density(y[i], v, cell, load)
        v_y, v_q = -L_yv / L_vv, 1.0 / L_vv
        rates[0, i], rates[1, i] = v, L_y
        jacobian[0, 0, i], jacobian[0, 1, i] = v_y, v_q
        jacobian[1, 0, i], jacobian[1, 1, i] = L_yy + L_yv * v_y, L_yv * v_q


@kernel
def momenta(y, v, cell, load, q):
    """``q = L_y'`` (n,) of a shape."""
    for i in range(len(y)):
        q[i] = lagrangian.density(y[i], v[i], cell, load)[2]


@kernel
def layer_rate(stretch, cell, load):
    """How fast the end layer decays [1/r0]."""
    _, _, _, L_yy, _, L_vv = lagrangian.density(stretch, 0.0, cell, load)
    return sqrt(L_yy / L_vv)


@kernel
def integrals(y, q, weights, cell, load, out):
    """Length, volume and rotation of half a tube."""
    for i in range(len(y)):
        G = 1.0 + lagrangian.kinematics(y[i], cell, load)[3]
        T = load.p * y[i] * y[i] + load.f
        v = -q[i] * sqrt(G) / sqrt(T * T + q[i] * q[i])
        s, volume, psi, _, _ = lagrangian.integrands(y[i], v, cell, load)
        out[0] += weights[i] * s
        out[1] += weights[i] * volume
        out[2] += weights[i] * psi


def layer_mesh(rate, length, nodes):
    """Nodes that crowd in the end layer."""
    rest = max(np.exp(-min(GRADING * rate * length, 700.0)), LEAST)
    x = -np.log1p(-np.linspace(0.0, 1.0, nodes) * (1.0 - rest))
    return x * (length / x[-1])


def solve_all(chosen, stretches, tolerance):
    """Half tubes' length, volume, rotation (n, 3) of a sample, NaN where ``solve_bvp`` gives up, and median seconds."""
    results, taken = np.full((chosen.size, 3), np.nan), np.empty(chosen.size)
    row = 0
    for problem in chosen.problems:
        cell, half, solution = tuple(problem[:3]), 0.5 * problem[8], None
        for p in chosen.pressures:
            rubber = problem[4], problem[9], problem[10]
            load = Load(problem[3], rubber, (problem[5],), p, problem[6], problem[7], 1.0)
            begun = time.thread_time()
            found = _solve(cell, load, half, stretches[row], solution, tolerance)
            if found.status == 0:
                solution = found.sol
                results[row] = _outputs(found, cell, load)
            taken[row] = time.thread_time() - begun
            row += 1
    return results, float(np.median(taken))


def _solve(cell, load, half, stretch, before, tolerance):
    rate = layer_rate(stretch, cell, load)
    x = layer_mesh(rate, half, COLD_NODES if before is None else NODES)
    if before is None:
        decay = min(rate, 0.9 / max(abs(stretch - 1.0), 1e-9))
        z = np.array([1.0 + (stretch - 1.0) * (1.0 - np.exp(-decay * x)), 0.0 * x])
        momenta(z[0], decay * (stretch - z[0]), cell, load, z[1])
    else:
        z = before(x)

    def rates(x, z):
        out, jacobian = np.empty((2, len(x))), np.empty((2, 2, len(x)))
        fill(z[0], z[1], cell, load, out, jacobian)
        return out

    def slopes(x, z):
        out, jacobian = np.empty((2, len(x))), np.empty((2, 2, len(x)))
        fill(z[0], z[1], cell, load, out, jacobian)
        return jacobian

    with np.errstate(all="ignore"):  # a trial step may leave the domain
        return solve_bvp(rates, _ends, x, z, fun_jac=slopes, bc_jac=_end_slopes, tol=tolerance, max_nodes=MOST_NODES)


def _ends(left, right):
    return np.array([left[0] - 1.0, right[1]])


def _end_slopes(left, right):
    return np.array([[1.0, 0.0], [0.0, 0.0]]), np.array([[0.0, 0.0], [0.0, 1.0]])


def _outputs(found, cell, load):
    h = np.diff(found.x)
    places = (found.x[:-1, None] + h[:, None] * 0.5 * (POINTS + 1.0)).ravel()
    z, out = found.sol(places), np.zeros(3)
    integrals(z[0], z[1], (0.5 * h[:, None] * WEIGHTS).ravel(), cell, load, out)
    return out

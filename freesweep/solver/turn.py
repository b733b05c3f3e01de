"""Close to a turning point of a way: where it lies, to the last digits that meshes give, and the states just before it.

Each mesh has its own turning point, and some have none of the states that others have. So a mesh is asked for its largest
share of the way, and for the share at which the stretch of one node has a value: both are as smooth in the size of cells as
any output, extrapolate like it, and have a bound. Whether the state asked for, at share 1, is there follows from numbers,
not from whether some step converged.
"""

from math import sqrt

import numpy as np

from ..jit import kernel
from . import held, lagrangian, mesh, nested, newton, pinned
from .march import LARGEST_CHANGE, top
from .status import INACCURATE, NOT_CONVERGED, OK

CLEAR = 0.1  # bound of a turning point over its distance from the share asked for: it need not be known better
SHARE_ROUNDING = 1e-11  # of a share
NEAR = 0.05  # of the way behind its end: as far a turning point is looked for where no mesh holds the state
APPROACHES = 6  # to the share asked for


@kernel
def on_nested_meshes(x, y, tube, way, k, value, t, mu, bend, accuracy, fine, work, table, out):
    """From a point on the base mesh (x, y, t, mu): the extreme share of the way, with ``bend`` = d^2t/dy_k^2, or, where
    ``bend`` is 0, the share at which y_k has the ``value``, with the outputs there.

    Returns ``(whether it was found, share, its bound, doublings, largest scaled bound of outputs, unstable directions)``.
    """
    n, shares = len(x) - 1, np.empty(nested.MAX_DOUBLINGS + 2)
    turning = bend != 0.0
    level, count, xs, ys, unstable, largest = 1, n, x, y, 0, 0.0
    base_t, base_mu = t, mu
    while True:
        node = k * count // n
        status, unstable, mu, t, _, share = pinned.solve(
            xs, ys, count, n, tube, way, node, ys[node] if turning else value, t, mu,
            max(nested.STEP_SHARE * accuracy, nested.SMALLEST_TOLERANCE), work,
        )  # fmt: skip
        if status != newton.CONVERGED:
            return False, t, 0.0, level, 0.0, unstable
        if turning:
            found, t, mu, _ = top(
                xs, ys, count, n, tube, way, node, t, mu, share / work[12, node], bend, -np.sign(bend), work
            )
            if not found:
                return False, t, 0.0, level, 0.0, unstable
        shares[level] = t
        own, load = pinned.at_share(way, tube, xs, count, n, t)
        now, row = held.loaded(load, way[4], mu), table[level]
        nested.integrate(lagrangian.integrands, xs, ys, count, own, now, row)
        row[nested.MIDDLE], row[nested.MULTIPLIER] = ys[tube[4] * count // n], mu
        if level == 1:
            base_t, base_mu = t, mu
            level, count = 0, n // 2
            xs, ys = fine[2], fine[3]
            for i in range(count + 1):
                xs[i], ys[i] = x[2 * i], y[2 * i]
            continue
        if level >= 3:
            first = (4.0 * shares[level - 2] - shares[level - 3]) / 3.0
            second = (4.0 * shares[level - 1] - shares[level - 2]) / 3.0
            third = (4.0 * shares[level] - shares[level - 1]) / 3.0
            bound = nested.SAFETY * max(abs(third - second) / 15.0, abs(second - first) / 225.0) + SHARE_ROUNDING
            out[2], out[3] = lagrangian.scales(row, mesh.largest(own), now, x[n] - x[0], nested.SMALLEST_TOLERANCE)
            unit = max(abs(way[4][4]), abs(way[4][5]))
            out[2, nested.MULTIPLIER] /= max(unit, 1.0)
            out[3, nested.MULTIPLIER] /= unit
            largest = nested.extrapolate(table, level, out[2], out[3], 0.0, False, out[0], out[1])
            good = bound < CLEAR * abs(third - 1.0) if turning else largest <= accuracy
            if good or level == nested.MAX_DOUBLINGS + 1:
                return True, third, bound, level - 1, largest, unstable
        if level == 0:
            level, t, mu = 1, base_t, base_mu
            for i in range(n + 1):
                fine[0, i], fine[1, i] = x[i], y[i]
        count = n << (level - 1)
        for i in range(count + 1):
            fine[2, i], fine[4, i] = fine[0, i], fine[1, i]
        level, count = level + 1, 2 * count
        nested.split(x, n, tube[1], 1 << (level - 1), fine[0])
        nested.foresee(fine, count // 2, work)
        for i in range(count // 2 + 1):
            fine[3, i] = fine[4, i]
        xs, ys = fine[0], fine[1]


@kernel
def before(x, y, tube, way, k, side, limit, mu, bend, accuracy, fine, work, table, out):
    """The state at share 1, just before the turning point at share ``limit``; ``side`` (1 or -1) is where y_k was less or
    more on the way there, and ``y`` a point beside it. Returns ``(status, doublings, unstable directions)``.
    """
    n, t = len(x) - 1, limit
    value, rise = y[k] - side * sqrt(2.0 * (limit - 1.0) / -bend), side * sqrt(2.0 * (limit - 1.0) * -bend)
    last, last_t, last_out = y[k], limit, np.zeros(nested.OUTPUTS)
    for attempt in range(APPROACHES):
        status, _, mu, t, _, _ = pinned.solve(x, y, n, n, tube, way, k, value, t, mu, nested.SMALLEST_TOLERANCE, work)
        if status != newton.CONVERGED:
            break
        found, t, bound, doublings, largest, unstable = on_nested_meshes(
            x, y, tube, way, k, value, t, mu, 0.0, accuracy, fine, work, table, out
        )
        if not found:
            break
        if attempt > 0 and abs(t - 1.0) <= bound:
            for j in range(nested.OUTPUTS):
                slope = abs(out[0, j] - last_out[j]) / max(abs(t - last_t), bound)
                out[1, j] += slope * (bound + abs(t - 1.0))
                largest = max(largest, out[1, j] / out[2, j])
            return (OK if largest <= accuracy else INACCURATE), doublings, unstable
        if attempt > 0 and abs(value - last) > 0.0:
            rise = (t - last_t) / (value - last)
        last, last_t = value, t
        for j in range(nested.OUTPUTS):
            last_out[j] = out[0, j]
        step = (1.0 - t) / rise
        value += min(max(step, -LARGEST_CHANGE * value), LARGEST_CHANGE * value)
    return NOT_CONVERGED, 0, 0

"""The stable, antisymmetric state beside the unstable straight cylinder: the source's "blocked deformation"."""

from math import pi, sin

from ..jit import inlined, kernel
from . import held, lagrangian, newton
from .course import at_point, fill
from .march import EVERY, even_mesh, march
from .status import HELD_IMPOSSIBLE, NOT_CONVERGED, OK

AMPLITUDES = (0.02, 0.04, 0.08, 0.15, 0.25, 0.35)  # of the antisymmetric mode, tried in turn
LOWERING, LOWERINGS = 0.97, 40  # of the pressure, until the buckled state is found; then up again
BUCKLED = 1e-4  # |y - 1| from which a state counts as buckled


@kernel
def opposed(y):
    """Whether one half swells and the other thins: a mesh may hold other shapes, too, that are unstable."""
    n = len(y) - 1
    return (y[n // 4] - 1.0) * (y[n - n // 4] - 1.0) < 0.0


@inlined
def buckle(x, y, tube, load, direction, mu, target, work):
    """A stable state beside the straight cylinder, swollen in its first half; returns ``(status, multiplier)``."""
    course, edges, cells, free, _, places = tube
    n = len(x) - 1
    for amplitude in AMPLITUDES:
        even_mesh(x, places, edges)
        for i in range(n + 1):
            y[i] = 1.0 + amplitude * sin(2.0 * pi * x[i] / x[n])
        status, unstable, trial, _ = held.solve_held(
            lagrangian.density, lagrangian.conjugate, x, y, n, free, fill(course, edges, x, n, n, cells), load, direction,
            mu, target, 1e-11, newton.MAX_ITERATIONS, work,
        )  # fmt: skip
        largest = 0.0
        for i in range(n + 1):
            largest = max(largest, abs(y[i] - 1.0))
        if status == newton.CONVERGED and unstable == 0 and largest > BUCKLED and opposed(y):
            if y[n // 4] < 1.0:  # the mirror image is as good a state: keep to one of the two
                for i in range(n // 2):
                    y[i], y[n - i] = y[n - i], y[i]
            return OK, trial
    return HELD_IMPOSSIBLE, mu


@inlined
def buckled_at(x, y, tube, course, load, attempts, direction, mu, target, work):
    """The buckled state at ``load``: found at a lower pressure, close above the critical one where the mode is small, and
    followed up from there. ``attempts`` are (first, end) in powers of LOWERING. Returns ``(status, multiplier)``.
    """
    own, failed = tube[0], HELD_IMPOSSIBLE
    cell = at_point(own, 0, 0.0)
    for attempt in range(attempts[0], attempts[1]):
        lower = (load[0], load[1], load[2], load[3] * LOWERING**attempt, load[4], load[5], load[6])
        status, found = buckle(x, y, tube, lower, direction, mu, target, work)
        failed = NOT_CONVERGED if status == OK else failed
        if status == OK and attempt > 0:
            status, found, _ = march(
                x, y, tube, course, cell, False, lower, load, 0.0, direction, found, target, target, EVERY, work
            )
        if status == OK and opposed(y):
            return OK, found
    return failed, mu

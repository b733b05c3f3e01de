"""Whether the uniform tube leads to a state without a turning point: where it does, whatever way a state was found on,
it is the one.
"""

from ...jit import entry_point, kernel
from ..load import Load, at_pressure
from ..physics import lagrangian, uniform_tube
from ..problem import AREA, FORCE, GAMMA, LENGTH, TORQUE, D, H, rubber_of, wall_of


@kernel
def reached(u, cell, start, end, half):
    """``(stretch, whether it was reached)`` of the uniform tube, from one load to another."""
    u, part = uniform_tube.follow(lagrangian.density, u, cell, start, end, half, lagrangian.drawn_in(cell, end))
    return u, part == 1.0


@entry_point
def carried_many(problems, walls, settled, first, pressures, carried):
    """Write to ``carried`` (n,) whether each state's uniform tube leads to it: arguments as of
    :func:`.free_states.follow_many`. A locked shape is one of its kind.
    """
    for k in range(len(problems)):
        problem = problems[k]
        cell, half = (problem[H], problem[D], problem[AREA]), 0.5 * problem[LENGTH]
        f, m, gamma = problem[FORCE], problem[TORQUE], problem[GAMMA]
        start = Load(1.0, rubber_of(problem), wall_of(problem, walls), 0.0, 0.0, 0.0, 1.0)
        u, on = 1.0, True
        if f != 0.0 or m != 0.0 or gamma != 1.0:
            full = Load(gamma, start.rubber, start.wall, settled[k], f, m, 1.0)
            u, on = reached(u, cell, start, full, half)
            start = full
        for i in range(first[k], first[k + 1]):
            p = pressures[i]
            carried[i] = p == float("inf") or (on and reached(u, cell, start, at_pressure(start, p), half)[1])

"""The columns of a problem: what one design is, dimensionless (``freesweep.scaling`` makes them)."""

from ..jit import kernel

PROBLEM_SIZE = 11
H, D, AREA, GAMMA, RATIO, SHEAR, FORCE, TORQUE, LENGTH, SECOND, THIRD = range(PROBLEM_SIZE)
INNER, THREADS = PROBLEM_SIZE, PROBLEM_SIZE + 1  # of physical tubes only; the threads as in :mod:`.physics.wall`
SOURCE, PHYSICAL = (SHEAR,), (SHEAR, INNER, THREADS)  # columns of a wall
MOONEY_RIVLIN, YEOH = (RATIO,), (RATIO, SECOND, THIRD)  # columns of a rubber's constants, over C10


@kernel
def rubber_of(problem):
    """What :mod:`.physics.lagrangian` takes as a rubber: C01/C10, C2/C1, C3/C1."""
    return problem[RATIO], problem[SECOND], problem[THIRD]


def wall_columns(problems):
    """Columns of the walls of rows of problems."""
    return SOURCE if problems.shape[-1] == PROBLEM_SIZE else PHYSICAL


@kernel
def wall_of(problem, columns):
    """What :mod:`.physics.lagrangian` takes as a wall: (k,), or (k, inner, threads)."""
    if len(columns) == 1:
        return (problem[columns[0]],)
    return problem[columns[0]], problem[columns[1]], problem[columns[2]]

"""The columns of a problem: what one design is, dimensionless (``freesweep.scaling`` makes them)."""

from ..jit import kernel

PROBLEM_SIZE = 11
H, D, AREA, GAMMA, RATIO, SHEAR, FORCE, TORQUE, LENGTH, SECOND, THIRD = range(PROBLEM_SIZE)
MOONEY_RIVLIN, YEOH = (RATIO,), (RATIO, SECOND, THIRD)  # columns of a rubber's constants, over C10


@kernel
def rubber_of(problem):
    """What :mod:`lagrangian` takes as a rubber: C01/C10, C2/C1, C3/C1."""
    return problem[RATIO], problem[SECOND], problem[THIRD]

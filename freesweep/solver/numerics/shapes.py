"""Whether two shapes, each on a mesh of its own, are one."""

import numpy as np

from ...jit import kernel

MESH_CHANGE = 0.03  # relative difference of a shape from one mesh to the next


@kernel
def extremes(y, middle):
    """What tells one shape from another: stretch in the middle, least and largest."""
    return y[middle], np.min(y), np.max(y)


@kernel
def differ(one, other):
    """Whether two shapes, told by their extremes, differ by more than meshes do."""
    return max(abs(one[0] - other[0]), max(abs(one[1] - other[1]), abs(one[2] - other[2]))) > MESH_CHANGE * one[2]

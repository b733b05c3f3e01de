"""What an atlas fixes of points, and what follows from the rest of them."""

from typing import NamedTuple

import numpy as np

from ..jit import kernel
from .reference import FIBERS, HELD, LENGTH, RADIUS, WALL


class Fixed(NamedTuple):
    """``numbers`` (designs, 17) that are fixed of a point; ``fiber_share`` of the wall is inside the fibers (-1: their
    radius is given); whether what is held is given ``by_length``, not by its share of the undeformed one.
    """

    numbers: np.ndarray
    fiber_share: float
    by_length: bool


@kernel
def complete(point, fixed):
    """Put into a ``point`` (17,) what follows from what is there."""
    share = fixed.fiber_share
    if share >= 0.0:
        point[FIBERS] = point[RADIUS] + (share * point[WALL] if share > 0.0 else 0.0)
    if fixed.by_length:
        point[HELD] /= point[LENGTH]

"""What the free states of a tube are found with, and what they are written to."""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..numerics import error_bounds, nested
from ..numerics.path import Track
from .fold import FINEST


class Space(NamedTuple):
    """Scratch: a :class:`..numerics.nested.Room`, with a mesh and shape of its own (n + 1,); and curves, and uniform
    stretches along the tube.
    """

    fine: np.ndarray
    work: np.ndarray
    table: np.ndarray
    curve: np.ndarray
    out: np.ndarray
    x: np.ndarray
    y: np.ndarray
    u: np.ndarray


class Room(NamedTuple):
    """What a branch is followed with: scratch, the branch, and one on finer meshes."""

    space: Space
    track: Track
    roomy: Track


class Rows(NamedTuple):
    """States of one design: see :func:`.free_states.walk`."""

    pressures: np.ndarray
    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray
    stations: np.ndarray
    profiles: np.ndarray


@kernel
def make_space(base, places):
    """Scratch for a base mesh of ``base`` cells, and uniform stretches at so many ``places``."""
    size = (base << nested.MAX_DOUBLINGS) + 2
    return Space(
        np.zeros((5, size)), np.zeros((13, size)), np.zeros((nested.MAX_DOUBLINGS + 2, error_bounds.OUTPUTS)),
        np.zeros((5, size)), np.zeros((4, error_bounds.OUTPUTS)), np.zeros(base + 1), np.zeros(base + 1),
        np.zeros(places),
    )  # fmt: skip


@kernel
def make_track(base, free, held):
    """Scratch of a branch on ``base`` cells, whose last node is a plane of symmetry or stays, with something held or not."""
    nodes, state = np.zeros((4, base + 1)), np.zeros((4, base + (2 if held else 1)))
    return Track(
        nodes[0], state[0], state[1], state[2], state[3], nodes[1], nodes[2], nodes[3], base if free else base - 1
    )


@kernel
def make_room(base, free, held, places):
    """Scratch for a base mesh of so many cells, as of :func:`make_track`, and uniform stretches at so many ``places``."""
    return Room(make_space(base, places), make_track(base, free, held), make_track(FINEST * base, free, held))

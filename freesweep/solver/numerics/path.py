"""What a branch is followed along, and with: a path of loads, what is held on it, and scratch for its states."""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from ..load import NO_CHANGE, Load, loaded

LOAD_SHARE = 0.1  # weight of a relative change of the load against one of y: its steps may be that much longer


class Held(NamedTuple):
    """What is held along a path, if anything is: the integral conjugate to the load ``unit``, at ``T = first + mu change``.
    So many unstable directions that keep it are ``allowed``.
    """

    unit: tuple
    first: float
    change: float
    any: bool
    allowed: int


NOTHING = Held(NO_CHANGE, 0.0, 0.0, False, 0)


class Path(NamedTuple):
    """Loads ``origin + mu direction``; ``floor`` is added to |mu| where its size counts. Where the density is only piecewise
    smooth, the branch ``bends`` at once where all cells change their kind together.
    """

    origin: Load
    direction: Load
    floor: float
    bends: bool
    held: Held = NOTHING


class Track(NamedTuple):
    """Scratch of one branch, (n + 1,): mesh ``x``, the plane's ``normal``, two to spare; (n + 1,), with nu behind (n + 2,):
    state and tangent here and a step ahead; and the last node that moves: n where that is a plane of symmetry, else n - 1.
    """

    x: np.ndarray
    y: np.ndarray
    tangent: np.ndarray
    next_y: np.ndarray
    next_tangent: np.ndarray
    normal: np.ndarray
    spare: np.ndarray
    other: np.ndarray
    last: int


@kernel
def size_of(mu, path):
    """By what changes of the multiplier count."""
    return (abs(mu) + path.floor) / LOAD_SHARE


@kernel
def held_load(path, y, n):
    """nu, the load of what is held; 0 where nothing is."""
    return y[n + 1] if path.held.any else 0.0


@kernel
def load_at(path, y, n, mu):
    """The whole load of a state."""
    return loaded(loaded(path.origin, path.direction, mu), path.held.unit, held_load(path, y, n))

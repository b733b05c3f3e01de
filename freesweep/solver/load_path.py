"""The one path of loads on which a free state lies, whatever pressures are asked for (theory, section 7).

From the undeformed cylinder pressure, force, torque and fiber extension - 1 rise in proportion, to the full loads at the
*settling pressure*; from there the pressure alone rises or falls. Without loads and extension
there is the pressure only.

The settling pressure is the least at which the way there holds: twice what balances an axial compression, so that the
meridional resultant p y^2 + f stays a tension while the tube is drawn in to 0.7; and as large as the torque and the fibers'
extension in their own units, so that neither turns or swells a tube that has no pressure to keep it round. A tube that is
pulled needs none: the weight is hung on first.
"""

from typing import NamedTuple

import numpy as np

from .problem import FORCE, GAMMA, TORQUE


def is_loaded(problems) -> np.ndarray:
    """Whether each problem has loads or extended fibers: (n,) of bool."""
    return (problems[:, FORCE] != 0.0) | (problems[:, TORQUE] != 0.0) | (problems[:, GAMMA] != 1.0)


def settling_pressure(problems) -> np.ndarray:
    """Pressure p = P/C10 at which each problem's loads have come to their full size: (n,)."""
    return np.maximum.reduce(
        [2.0 * np.maximum(-problems[:, FORCE], 0.0), np.abs(problems[:, TORQUE]), problems[:, GAMMA] ** 2 - 1.0]
    )


NEXT_TO_NOTHING = 1e-14  # of the torque: a pressure for none
MISSED = 1e-7  # of every output: what that changes, a layer at each clamped end as wide as its root


def next_to_nothing(problems, first, pressures):
    """``(pressures, replaced)``: a tube that only torque works on is limp, its end layers have no length. Its state is the
    limit of falling pressures, and solved at one that is next to nothing.
    """
    only_torque = (problems[:, FORCE] == 0.0) & (problems[:, TORQUE] != 0.0)
    if not np.any(only_torque):
        return pressures, np.zeros(len(pressures), bool)
    owners = np.repeat(np.arange(len(problems)), np.diff(first))
    replaced = only_torque[owners] & (pressures == 0.0)
    return np.where(replaced, NEXT_TO_NOTHING * np.abs(problems[owners, TORQUE]), pressures), replaced


class Legs(NamedTuple):
    """Walks of one direction of pressure each: two of a loaded problem, up and down from its settled state."""

    owners: np.ndarray  # (walks,) the problem of each
    upward: np.ndarray  # (walks,) of bool
    first: np.ndarray  # (walks + 1,)
    pressures: np.ndarray  # (steps,) on the way, the settled state's first
    rows: np.ndarray  # (steps,) which state that is; -1 for a settled state, which nobody asked for


def legs(problems, first, pressures) -> Legs:
    """Split states, problem k's from ``first[k]`` to ``first[k + 1]`` at ascending ``pressures``, into walks."""
    loaded, settled = is_loaded(problems), settling_pressure(problems)
    owners = np.repeat(np.arange(len(problems)), np.diff(first))
    falls = loaded[owners] & (pressures < settled[owners])
    walks, index = np.unique(2 * owners + falls, return_inverse=True)
    hidden = np.flatnonzero(loaded[walks // 2])
    walk = np.concatenate([index, hidden])
    pressure = np.concatenate([pressures, settled[walks[hidden] // 2]])
    rows = np.concatenate([np.arange(len(pressures)), np.full(len(hidden), -1)])
    order = np.lexsort((rows, np.where(walks[walk] % 2, -pressure, pressure), walk))
    starts = np.searchsorted(walk[order], np.arange(len(walks) + 1))
    return Legs(walks // 2, walks % 2 == 0, starts, pressure[order], rows[order])

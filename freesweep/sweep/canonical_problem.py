"""From designs to dimensionless problems that are the same wherever the physics is.

Length, radius, pressure and material enter only through ratios, of a thick wall both its radii; swapping the fiber families
changes nothing, and negating both angles mirrors rotation and torque. A tube that varies is solved as it is.
"""

from typing import NamedTuple

import numpy as np

from ..description.actuator import APART, LARGEST_ANGLE, SMALLEST_DIFFERENCE
from ..description.profiles import as_profile, together
from ..scaling import problem_rows
from ..status import DEGENERATE, INVALID, OK

H, D, FORCE, TORQUE = 0, 1, 6, 7  # columns of a problem
# after them: two of physical tubes, 0 of others; what is held; radius if the wall varies; block of materials; shape
PHYSICAL, TARGET, SIZE, BLOCK, TAPER, BULGE, COLUMNS = 11, 13, 14, 15, 16, 17, 18
KEPT_BITS = 43  # of 52: rounding differs by the way units were given (13 digits)


class Reduced(NamedTuple):
    """Designs (n,) reduced: ``rows`` (n, COLUMNS), status known before anything is solved, what was turned to get there."""

    status: np.ndarray
    rows: np.ndarray
    swapped: np.ndarray
    mirrored: np.ndarray


def reduced(design, sweep, kind) -> Reduced:
    """The problems of designs (name -> column) for one ``kind`` of state: "free", "blocked_force", "blocked_torque"."""
    design = dict(design)
    zeros = np.zeros_like(design["radius"])
    if kind == "blocked_force":
        design["force"] = zeros
    elif kind == "blocked_torque":
        design["torque"] = zeros
    rows = np.zeros((len(zeros), COLUMNS))
    problems = problem_rows(design, sweep.energy, sweep.model.is_thick, sweep.model.is_loose)
    rows[:, : problems.shape[1]] = problems
    rows[:, TARGET] = _target(design, kind)
    rows[:, TAPER], rows[:, BULGE] = design.get("taper", 0.0), design.get("bulge", 0.0)
    if sweep.varies:
        rows[:, SIZE] = design["fiber_radius"] if {"wall", "radius"} & set(sweep.profiles) else 0.0
        return Reduced(known_status(design, sweep), rows + 0.0, zeros > 0.0, zeros > 0.0)
    odd = [H, D, TARGET if kind == "blocked_torque" else TORQUE]
    return Reduced(known_status(design, sweep), *canonical(rows, odd))


def _target(design, kind):
    """Held length in radii or held rotation in radians, of the whole tube; 0 where nothing is held."""
    if kind == "blocked_torque":
        return np.radians(design["held_rotation"])
    if kind == "free":
        return 0.0
    if "held_length" in design:
        return design["held_length"] / design["fiber_radius"]
    return design["held_length_ratio"] * (design["length"] / design["fiber_radius"])


def known_status(design, sweep) -> np.ndarray:
    """DEGENERATE or INVALID where no solution has to be tried, else OK."""
    profiles = sweep.profiles
    alpha, beta = design["alpha"], design["beta"]
    apart, largest = np.abs(alpha - beta), np.maximum(np.abs(alpha), np.abs(beta))
    if "alpha" in profiles or "beta" in profiles:
        apart, largest = _along(alpha, beta, profiles)
    wall = design["wall"]
    if "wall" in profiles:
        wall = as_profile(profiles["wall"]).samples().min()
    fibers, outer = design["fiber_radius"], design["radius"] + wall
    invalid = (apart < APART) | (largest >= LARGEST_ANGLE)
    if not sweep.is_of_bodies:  # of those it is given by a word
        invalid |= (fibers < design["radius"]) | (fibers > outer * (1.0 + 1e-12))
    return np.where(apart == 0.0, DEGENERATE, np.where(invalid, INVALID, OK))


def _along(alpha, beta, profiles):
    """Difference of the angles along each tube, 0 only where they are equal all along, and the largest angle."""
    pairs, index = np.unique(np.column_stack([alpha, beta]), axis=0, return_inverse=True)
    apart, largest = np.empty(len(pairs)), np.empty(len(pairs))
    for k, pair in enumerate(pairs):
        a, b = together(*(as_profile(profiles.get(name, value)) for name, value in zip(("alpha", "beta"), pair)))
        crossing = len(set(np.sign(a - b))) > 1
        apart[k] = 0.5 * SMALLEST_DIFFERENCE if crossing else np.abs(a - b).min()
        largest[k] = max(np.abs(a).max(), np.abs(b).max())
    return apart[index], largest[index]


def canonical(rows, odd):
    """Problems with D > 0 and H >= 0, and which designs were exchanged or mirrored; ``odd`` columns change sign with H."""
    # a McKibben muscle has no side of its own; its torque has
    mirrored = (rows[:, H] < 0.0) | ((rows[:, H] == 0.0) & (rows[:, odd[-1]] < 0.0))
    rows[np.ix_(mirrored, odd)] *= -1.0
    swapped = rows[:, D] < 0.0
    rows[swapped, D] *= -1.0
    return rows + 0.0, swapped, mirrored  # + 0.0: no negative zeros


def significant(array):
    """Rounded to the KEPT_BITS leading bits of each number's fraction."""
    drop = 52 - KEPT_BITS
    bits = np.ascontiguousarray(array, dtype=float).view(np.int64)
    return (((bits + (1 << (drop - 1))) >> drop) << drop).view(float)

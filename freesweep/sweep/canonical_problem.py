"""From designs to dimensionless problems that are the same wherever the physics is.

Length, radius, pressure and material enter only through ratios, of a thick wall both its radii; swapping the fiber families
changes nothing, and negating both angles mirrors rotation and torque. A tube that varies is solved as it is.
"""

from typing import NamedTuple

import numpy as np

from ..description.families import FAMILIES, lines_of
from ..description.impossible import APART, LARGEST_ANGLE, SMALLEST_DIFFERENCE
from ..description.profiles import as_profile, together
from ..scaling import problem_rows
from ..status import DEGENERATE, INVALID, OK

H, D, FORCE, TORQUE = 0, 1, 6, 7  # columns of a problem
# after them: two of physical tubes, 0 of others; what is held; radius if the wall varies; block of materials; shape
PHYSICAL, THREADS, TARGET, SIZE, BLOCK, TAPER, BULGE, COLUMNS = 11, 12, 13, 14, 15, 16, 17, 18
KEPT_BITS = 43  # of 52: rounding differs by the way units were given (13 digits)


class Reduced(NamedTuple):
    """Designs (n,) reduced: ``rows`` (n, COLUMNS), status known before anything is solved, what was turned to get there."""

    status: np.ndarray
    rows: np.ndarray
    swapped: np.ndarray
    mirrored: np.ndarray
    single: np.ndarray  # whether there are fibers of one angle only, or none


def reduced(design, sweep, kind) -> Reduced:
    """The problems of designs (name -> column) for one ``kind`` of state: "free", "blocked_force", "blocked_torque"."""
    design = dict(design)
    zeros = np.zeros_like(design["radius"])
    if kind == "blocked_force":
        design["force"] = zeros
    elif kind == "blocked_torque":
        design["torque"] = zeros
    rows = np.zeros((len(zeros), COLUMNS))
    status, single = known_status(design, sweep)
    lines, turned = _lines(design, sweep, single)
    angles = {"alpha": lines.alpha, "beta": lines.beta}
    problems = problem_rows(design | angles, sweep.energy, sweep.model.is_thick, lines.threads)
    rows[:, : problems.shape[1]] = problems
    rows[:, TARGET] = _target(design, kind)
    rows[:, TAPER], rows[:, BULGE] = design.get("taper", 0.0), design.get("bulge", 0.0)
    if sweep.varies:
        rows[:, SIZE] = design["fiber_radius"] if {"wall", "radius"} & set(sweep.profiles) else 0.0
        return Reduced(status, rows + 0.0, zeros > 0.0, zeros > 0.0, single)
    odd = [H, D, TARGET if kind == "blocked_torque" else TORQUE]
    return Reduced(status, *canonical(rows, odd, single, turned), single)


def _lines(design, sweep, single):
    """The lines that the solver follows of designs, and which designs of ``single`` families lean the other way: of those
    it is the mirror image's, as lines beside a family do not turn with it.
    """
    own = [design[name] for name in sweep.families] or [np.zeros_like(design["radius"])]
    turned = single & (own[0] < 0.0)
    alpha, beta = (np.where(turned, -angle, angle) for angle in (own[0], own[-1]))
    names = FAMILIES[: len(sweep.families)]  # a single one comes first
    return lines_of(alpha, beta, names, sweep.model.is_loose, single), turned


def _target(design, kind):
    """Held length in radii or held rotation in radians, of the whole tube; 0 where nothing is held."""
    if kind == "blocked_torque":
        return np.radians(design["held_rotation"])
    if kind == "free":
        return 0.0
    if "held_length" in design:
        return design["held_length"] / design["fiber_radius"]
    return design["held_length_ratio"] * (design["length"] / design["fiber_radius"])


def known_status(design, sweep) -> tuple:
    """DEGENERATE or INVALID where no solution has to be tried, else OK; and whether there are fewer than two families."""
    profiles, few = sweep.profiles, len(sweep.families) < 2
    alpha, beta = (design.get(name, design.get(other)) for name, other in (FAMILIES, FAMILIES[::-1]))
    if alpha is None:  # no fibers at all
        alpha = beta = np.zeros_like(design["radius"])
    apart, largest = np.abs(alpha - beta), np.maximum(np.abs(alpha), np.abs(beta))
    if "alpha" in profiles or "beta" in profiles:
        apart, largest = _along(alpha, beta, profiles, (sweep.families * 2)[:2] if few else FAMILIES)
    wall = design["wall"]
    if "wall" in profiles:
        wall = as_profile(profiles["wall"]).samples().min()
    fibers, outer = design["fiber_radius"], design["radius"] + wall
    invalid = ((apart < APART) & (apart > 0.0)) | (largest >= LARGEST_ANGLE)
    if not sweep.is_of_bodies:  # of those it is given by a word
        invalid |= (fibers < design["radius"]) | (fibers > outer * (1.0 + 1e-12))
    single = (apart == 0.0) & (few or sweep.model.is_loose)
    status = np.where((apart == 0.0) & ~single, DEGENERATE, np.where(invalid, INVALID, OK))
    return status, single


def _along(alpha, beta, profiles, names):
    """Difference of the angles along each tube, 0 only where they are equal all along, and the largest angle."""
    pairs, index = np.unique(np.column_stack([alpha, beta]), axis=0, return_inverse=True)
    apart, largest = np.empty(len(pairs)), np.empty(len(pairs))
    for k, pair in enumerate(pairs):
        a, b = together(*(as_profile(profiles.get(name, value)) for name, value in zip(names, pair)))
        crossing = len(set(np.sign(a - b))) > 1
        apart[k] = 0.5 * SMALLEST_DIFFERENCE if crossing else np.abs(a - b).min()
        largest[k] = max(np.abs(a).max(), np.abs(b).max())
    return apart[index], largest[index]


def canonical(rows, odd, single, turned):
    """Problems with D > 0 and H >= 0, and which designs were exchanged or mirrored; ``odd`` columns change sign with H. Of
    ``single`` families those that are ``turned`` are mirrored in their lines already.
    """
    # a McKibben muscle has no side of its own; its torque has
    mirrored = (rows[:, H] < 0.0) | ((rows[:, H] == 0.0) & (rows[:, odd[-1]] < 0.0))
    mirrored &= ~single
    rows[np.ix_(mirrored, odd)] *= -1.0
    rows[turned, odd[-1]] *= -1.0
    mirrored |= turned
    swapped = rows[:, D] < 0.0
    rows[swapped, D] *= -1.0
    return rows + 0.0, swapped, mirrored  # + 0.0: no negative zeros


def significant(array):
    """Rounded to the KEPT_BITS leading bits of each number's fraction."""
    drop = 52 - KEPT_BITS
    bits = np.ascontiguousarray(array, dtype=float).view(np.int64)
    return (((bits + (1 << (drop - 1))) >> drop) << drop).view(float)

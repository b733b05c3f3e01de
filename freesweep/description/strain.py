"""How far a wall is strained, and a warning where its constants are not known, or cannot be, to hold."""

import warnings

import numpy as np

from ..closed_form import uniform_state
from .elastomer import convex_to


def largest_stretch(alpha, beta, stretch, fiber_extension=1.0, energy="full"):
    """Largest principal stretch of the wall [-] where its circumferential stretch is ``stretch`` (theory of Eq. 2.5).

    Fiber angles in [degree]; arrays broadcast. The fibers decide the meridional stretch and the twist; "full": the twist
    shears the wall. The thickness keeps the volume.
    """
    along, around, across, twist = _squares(alpha, beta, stretch, fiber_extension)
    if energy == "full":  # of the in-plane tensor [[G + y^2 psi^2, y^2 psi], [y^2 psi, y^2]]
        half_trace = 0.5 * (along + around * (1.0 + twist**2))
        larger = half_trace + np.sqrt(np.maximum(half_trace**2 - along * around, 0.0))
    else:
        larger = np.maximum(along, around)
    return np.sqrt(np.maximum(larger, across))


def first_invariant(alpha, beta, stretch, fiber_extension=1.0, energy="full"):
    """I1 - 3 of the wall [-]; arguments as of :func:`largest_stretch`."""
    along, around, across, twist = _squares(alpha, beta, stretch, fiber_extension)
    return along + around * (1.0 + (energy == "full") * twist**2) + across - 3.0


def _squares(alpha, beta, stretch, fiber_extension):
    """Squared stretches along, around and across the wall, and the dimensionless twist."""
    stretch = np.asarray(stretch, float)
    axial, twist, *_ = uniform_state(alpha, beta, stretch, fiber_extension)
    along, around = axial**2, stretch**2
    return along, around, 1.0 / (along * around), twist


def warn_beyond_range(tube, result, stacklevel):
    """Warn if a Dataset of one actuator holds states that strain its wall beyond what its material is known for, or beyond
    where a Yeoh energy is convex.
    """
    rubber = tube.material
    known = np.inf if rubber.largest_stretch is None else rubber.largest_stretch
    convex = float(convex_to(rubber.c10, rubber.c20, rubber.c30)) if tube.has_two_families else np.inf
    if known < np.inf and (reached := _reached(tube, result, largest_stretch)) > known:
        warnings.warn(
            f"the wall is stretched {reached:.3g} times, but the constants of its material are known to hold to {known:.3g}",
            stacklevel=stacklevel,
        )
    if convex < np.inf and (reached := _reached(tube, result, first_invariant)) > convex:
        warnings.warn(
            f"the wall is strained to I1 - 3 = {reached:.3g}, but {rubber!r} is convex only up to {convex:.3g}: no rubber"
            " behaves so beyond it",
            stacklevel=stacklevel,
        )


def _reached(tube, result, measure):
    """The largest ``measure`` of the strain of any state of a Dataset, at half length or a station; of a tube whose fibers
    do not decide it alone the largest stretch of its layers.
    """
    if not tube.has_two_families:
        stretch = result["largest_stretch"].values
        return float(np.max(stretch, initial=0.0, where=np.isfinite(stretch)))
    reached = 0.0
    at_middle, share = [angle.item() for angle in tube.angles(0.5)], result["x"].values / tube.length
    for name, angles, place in (("mid_radius", at_middle, 0.5), ("deformed_radius", tube.angles(share), share)):
        stretch = result[name].values / tube.fiber_surface_at(place)
        found = measure(*angles, stretch, tube.fiber_extension, tube.energy)
        reached = max(reached, float(np.max(found, initial=0.0, where=np.isfinite(found))))
    return reached

"""How far a wall is stretched, and a warning where its constants are not known to hold."""

import warnings

import numpy as np

from .closed_form import uniform_state


def largest_stretch(alpha, beta, stretch, fiber_extension=1.0, energy="full"):
    """Largest principal stretch of the wall [-] where its circumferential stretch is ``stretch`` (theory of Eq. 2.5).

    Fiber angles in [degree]; arrays broadcast. The fibers decide the meridional stretch and the twist; "full": the twist
    shears the wall. The thickness keeps the volume.
    """
    stretch = np.asarray(stretch, float)
    axial, twist, *_ = uniform_state(alpha, beta, stretch, fiber_extension)
    along, around = axial**2, stretch**2
    across = 1.0 / (along * around)
    if energy == "full":  # of the in-plane tensor [[G + y^2 psi^2, y^2 psi], [y^2 psi, y^2]]
        half_trace = 0.5 * (along + around * (1.0 + twist**2))
        larger = half_trace + np.sqrt(np.maximum(half_trace**2 - along * around, 0.0))
    else:
        larger = np.maximum(along, around)
    return np.sqrt(np.maximum(larger, across))


def warn_beyond_range(tube, result, stacklevel):
    """Warn if a Dataset of one actuator holds states that stretch its wall beyond what its material is known for."""
    limit = tube.material.largest_stretch
    if limit is None:
        return
    reached = 0.0
    at_middle = [angle.item() for angle in tube.angles(0.5)]
    along = tube.angles(result["x"].values / tube.length)
    for name, angles in (("mid_radius", at_middle), ("deformed_radius", along)):
        stretch = result[name].values / tube.fiber_surface
        found = largest_stretch(*angles, stretch, tube.fiber_extension, tube.energy)
        reached = max(reached, float(np.max(found, initial=0.0, where=np.isfinite(found))))
    if reached > limit:
        warnings.warn(
            f"the wall is stretched {reached:.3g} times, but the constants of its material are known to hold to {limit:.3g}",
            stacklevel=stacklevel,
        )

"""How far a wall is strained, and a warning where its constants are not known, or cannot be, to hold.

A layer of the wall is stretched, in its surface, by ``[[hoop, shear], [0, meridional]]``; its thickness keeps the volume.
"""

import warnings

import numpy as np

from ..closed_form import uniform_state
from .elastomer import convex_to


def largest_principal(meridional, hoop, shear):
    """Largest principal stretch of a layer [-]."""
    half_trace, area = 0.5 * (meridional**2 + hoop**2 + shear**2), meridional * hoop
    larger = half_trace + np.sqrt(np.maximum(half_trace**2 - area**2, 0.0))
    return np.maximum(np.sqrt(larger), 1.0 / area)


def invariant(meridional, hoop, shear):
    """I1 - 3 of a layer [-]."""
    return meridional**2 + hoop**2 + shear**2 + (meridional * hoop) ** -2.0 - 3.0


def largest_stretch(alpha, beta, stretch, fiber_extension=1.0, energy="full"):
    """Largest principal stretch of the wall [-] where its circumferential stretch is ``stretch`` (theory of Eq. 2.5).

    Fiber angles in [degree]; arrays broadcast. The fibers decide the meridional stretch and the twist; "full": the twist
    shears the wall. The thickness keeps the volume.
    """
    return largest_principal(*membrane(alpha, beta, stretch, fiber_extension, energy))


def membrane(alpha, beta, stretch, fiber_extension, energy):
    """How a membrane with bonded fibers is strained at slope 0; a twist without energy strains nothing."""
    stretch = np.asarray(stretch, float)
    axial, twist, *_ = uniform_state(alpha, beta, stretch, fiber_extension)
    return axial, stretch, stretch * twist * (energy == "full")


def warn_beyond_range(rubber, layers, stacklevel):
    """Warn if states strain a wall beyond what its ``rubber`` is known for, or beyond where a Yeoh energy is convex;
    ``layers`` are (meridional, hoop, shear), arrays each, of those layers that are strained most.
    """
    known = np.inf if rubber.largest_stretch is None else rubber.largest_stretch
    convex = float(convex_to(rubber.c10, rubber.c20, rubber.c30))
    if known < np.inf and (reached := _reached(layers, largest_principal)) > known:
        warnings.warn(
            f"the wall is stretched {reached:.3g} times, but the constants of its material are known to hold to {known:.3g}",
            stacklevel=stacklevel,
        )
    if convex < np.inf and (reached := _reached(layers, invariant)) > convex:
        warnings.warn(
            f"the wall is strained to I1 - 3 = {reached:.3g}, but {rubber!r} is convex only up to {convex:.3g}: no rubber"
            " behaves so beyond it",
            stacklevel=stacklevel,
        )


def _reached(layers, measure):
    """The largest ``measure`` of any layer."""
    with np.errstate(invalid="ignore", divide="ignore"):
        found = [measure(*layer) for layer in layers]
    return max(float(np.max(one, initial=0.0, where=np.isfinite(one))) for one in found)

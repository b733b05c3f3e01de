"""The undeformed tube, to which no end layer belongs: a first pressure, force or torque moves each place by itself.

There ``L_yy dy = -L_ytheta`` in each cell. At rest the fibers' extension does not count, by definition; so where it is not 1
a first load finds the tube swollen at once, and no derivative by it exists. Nor is there one where fibers are loose:
whether they go slack depends on the load's sign; or of a body, whose meridian is inclined: a first load moves its ends and
its bends at once, in layers of no width.
"""

import numpy as np

from .dual import Dual
from .physics import BY_Y, OWN

LOADS = ("pressure", "force", "torque", "deformed_length", "rotation")


def is_at_rest(loads, held, target, tube):
    """Whether a state is the undeformed tube."""
    none = all(value == 0.0 for value in loads.values())
    return none and (held is None or target == (tube.length if held == "deformed_length" else 0.0))


def at_rest(physics, share, widths, half):
    """The outputs as dual numbers; ``widths`` of cells in x/l."""
    ones, count = np.ones_like(share), OWN + len(physics.parameters)
    made = [float(np.sum(widths)) * integral for integral in physics.rest_integrals()]
    middle = 0.0 * physics.length + 1.0
    first = [k for k, name in enumerate(physics.parameters) if name in LOADS]
    if not first:
        return physics.outputs(made, middle, half)
    parts = np.zeros((4 + 1, count, 1))
    if physics.tube.is_loose or physics.tube.fiber_extension != 1.0 or physics.tube.is_body:
        parts[:, [OWN + k for k in first]] = np.nan
    else:
        seeds = np.zeros((count, 1))
        seeds[BY_Y] = 1.0
        y, v = Dual(ones, seeds), Dual(0.0 * ones)
        _, L_y, _ = physics.local(y, v, share)
        integrands = physics.integrands(y, v, share)
        slopes = np.broadcast_to(L_y.parts, (count, len(share)))
        for k in first:
            moved = -slopes[OWN + k] / slopes[BY_Y]
            for i, q in enumerate(integrands):
                by_y = np.broadcast_to(q.parts, (count, len(share)))[BY_Y]
                parts[i, OWN + k, 0] = physics.length.value[0] * np.sum(widths * by_y * moved)
            parts[4, OWN + k, 0] = np.interp(0.5, share, moved)
    made = [number + Dual(np.zeros(1), part) for number, part in zip(made, parts)]
    return physics.outputs(made, middle + Dual(np.zeros(1), parts[4]), half)

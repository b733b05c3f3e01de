"""Held states: the force that keeps a length, or the torque that keeps a rotation, as the root of the quadrature.

``kind`` is 0 where a length is held by a force, 1 where a rotation is held by a torque. Inextensible tubes held at their
undeformed length or rotation stay straight cylinders, q = 1, under the load that makes U'(1) = 0, which is linear in it, as
long as their wall is pulled.
"""

import numpy as np

from .tube import ROUNDING, STILL, Quadrature
from .uniform import density, stationary

LOADS = ("force", "torque")
PANELS = 30
FIRST_STEP = 1e-5  # relative, of the load, for the first slope
FAR = 0.5  # relative: how far from the load given to look
ITERATIONS = 15


def held_stretch(tubes, kind, target):
    """q of the uniform tube that has the length or rotation: G = (length per length)^2, or psi = rotation per length."""
    gg = tubes.gamma**2
    if kind == 1:
        return gg / (1.0 + target / (2.0 * tubes.half * tubes.H))
    # D^2 q^2 - b q + gamma^4 H^2 = 0
    b = gg * (1.0 + tubes.H**2 + tubes.D**2) - (target / (2.0 * tubes.half)) ** 2
    larger = (b + np.sqrt(b**2 - 4.0 * (tubes.D * gg * tubes.H) ** 2)) / (2.0 * tubes.D**2)
    smaller = (gg * tubes.H) ** 2 / (tubes.D**2 * larger)
    # inextensible and undeformed, the two are 1 and H^2/D^2
    return np.where(np.abs(tubes.H) < np.abs(tubes.D), larger, smaller)


def cylinder_load(tubes, kind, q):
    """The load that makes the uniform tube stationary at q."""
    name = LOADS[kind]
    without = density(tubes._replace(**{name: np.zeros_like(q)}), q, q).slope
    return -without / (density(tubes._replace(**{name: np.ones_like(q)}), q, q).slope - without)


def blocked(tubes, kind, target, near):
    """``(load, error)`` (n,) of held states whose force or torque is about ``near``; NaN where there is none to be found.

    ``target``: the whole tube's deformed length in radii, or its rotation in radians.
    """
    name = LOADS[kind]
    load, error = np.full(len(near), np.nan), np.full(len(near), np.nan)
    with np.errstate(all="ignore"):
        guess = held_stretch(tubes, kind, target)
        straight = np.abs(guess - 1.0) < 100.0 * STILL
        cylinders = tubes.at(straight)
        found = cylinder_load(cylinders, kind, np.ones(np.count_nonzero(straight)))
        pull = cylinders.pressure + (found if kind == 0 else cylinders.force)
        load[straight] = np.where(pull > 0.0, found, np.nan)  # a straight wall that is pushed is no state
        todo = np.flatnonzero(~straight)
        tube, start, wanted, about = tubes.at(todo), guess[todo], target[todo], near[todo]
        if todo.size:

            def miss(value, panels=PANELS):
                now = tube._replace(**{name: value})
                quadrature = Quadrature(now, stationary(now, start))
                return quadrature.integrate(quadrature.folds(panels), panels)[:, 2 * kind] - wanted

            scale = np.maximum(np.abs(about), tube.pressure)
            before, value = about + FIRST_STEP * scale, about
            missed, missing = miss(before), miss(value)
            slope = (missed - missing) / (before - value)
            for _ in range(ITERATIONS):  # secants
                step = np.where(missing == 0.0, 0.0, -missing / slope)
                if not np.any(np.abs(step) > 1e-13 * scale):
                    break
                before, missed, value = value, missing, value + np.clip(step, -0.3 * scale, 0.3 * scale)
                missing = miss(value)
                far = np.abs(value - before) > 1e-9 * scale  # else their difference is rounding
                slope = np.where(far, (missing - missed) / (value - before), slope)
            rounding = ROUNDING * np.maximum(2.0 * tube.half, np.abs(wanted))
            own = (np.abs(miss(value, 2 * PANELS)) + rounding) / np.abs(slope)
            found = (np.abs(step) < 1e-9 * scale) & (np.abs(value - about) < FAR * scale)
            load[todo], error[todo] = np.where(found, value, np.nan), own
    error[straight] = 0.0
    return load, error + ROUNDING * np.maximum(np.abs(load), tubes.pressure)

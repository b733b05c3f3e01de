"""The closed form that stands behind each stored variable, and the scale of what the clamped ends add to it.

A stored number is ``offset + scale * end_effect``, or ``offset + base * exp(scale * end_effect)``. The uniform tube carries
the poles (blocked force at straight fibers, blocked torque at alpha = -beta), the swelling near alpha = beta and the
lengthening near 90 degrees. The scale vanishes where the ends change nothing: the end effect is a smooth number near one,
and small values stay relatively exact. Rotation carries H, every change of shape q - 1, the energy that of the uniform wall.
Volumes and the middle's radius, which the ends may change by decades, are taken as logarithms.
"""

import math

import numpy as np

from ..jit import entry_point, kernel
from .uniform_tube import energy, kinematics, locked_squared_stretch, squared_stretch

# columns of a point: one design and its load, in SI units and degrees; HELD: length ratio [1] or rotation [degree]
COLUMNS = (
    "alpha", "beta", "length", "radius", "wall", "fiber_radius", "fiber_extension", "c10", "c01", "force", "torque",
    "pressure", "held", "c20", "c30", "taper", "bulge",
)  # fmt: skip
ALPHA, BETA, LENGTH, RADIUS, WALL, FIBERS, EXTENSION, C10, C01, FORCE, TORQUE, PRESSURE, HELD, C20, C30 = range(15)
TAPER, BULGE = 15, 16

NONE, LOADED, LOCKED, LENGTH_HELD, ROTATION_HELD = range(5)  # kinds of states; and variables:
PLAIN, DEFORMED_LENGTH, VOLUME, ROTATION, ENERGY, MID_RADIUS, HOLDING_FORCE, HOLDING_TORQUE = range(8)
SLACK_ALPHA, SLACK_BETA = range(8, 10)
BODY_RADIUS = 10  # the middle's of a body, which does not only lack something (:mod:`.bodies`)
OUTER_RADIUS, LARGEST_STRETCH, LEAST_TENSION_ALPHA, LEAST_TENSION_BETA = range(11, 15)  # told from the middle's radius

UNIFORM = 10  # numbers that describe a uniform state: H, ta tb, a, q, sqrt(G), psi, w, multiplier, its rounding, and
TAUT = 9  # which fibers of a physical tube pull: 0 none, 1 alpha, 2 beta, 3 both
TINY = 1e-5  # what the middle of a long tube lacks is not told from nothing below it, of its swelling
CANCELLATION = 1e-15  # of the energy of a unit of strain
ROUNDING = 1e-13  # of a value, and of the closed form
OF_RADIUS = 1e-15  # the same in the middle, whose stretch is the root itself: no large numbers cancel
OF_STRETCH = 3e-15  # of q, against fifty digits: what is told of q - 1 at small loads is no more exact than that
LEAST = 1e-7  # q - 1 or H below it: what the ends add cannot be told from rounding


@kernel
def rubber_at(point):
    """C01, C20, C30 over C10 at a point (17,)."""
    return point[C01] / point[C10], point[C20] / point[C10], point[C30] / point[C10]


@kernel
def uniform(kind, point, shear, out):
    """The uniform state of a kind at a point (17,) into ``out`` (UNIFORM,); NaN where there is none."""
    ta, tb = math.tan(math.radians(point[ALPHA])), math.tan(math.radians(point[BETA]))
    h, d, gamma = 0.5 * (ta + tb), 0.5 * (ta - tb), point[EXTENSION]
    r, c10 = point[FIBERS], point[C10]
    area = ((point[RADIUS] + point[WALL]) ** 2 - point[RADIUS] ** 2) / (r * r)
    rubber, p = rubber_at(point), point[PRESSURE] / c10
    f, m = point[FORCE] / (math.pi * r * r * c10), point[TORQUE] / (math.pi * r * r * r * c10)
    for k in range(UNIFORM):
        out[k] = math.nan
    out[0], out[1], out[2] = h, ta * tb, area
    q = math.nan
    if kind == NONE or d == 0.0:
        return
    if kind == LOADED:
        q = squared_stretch((h, d, area, gamma, rubber, shear, f, m), p)
    elif kind == LOCKED:
        q = locked_squared_stretch(h, d, gamma)
    elif kind == LENGTH_HELD:  # G(q) = ratio^2: the root that is 1 for inextensible fibers at rest
        g2 = gamma * gamma
        middle = g2 * (1.0 + h * h + d * d) - point[HELD] ** 2
        root = math.sqrt(max(middle * middle - 4.0 * g2 * g2 * d * d * h * h, 0.0))
        q = (middle + root) / (2.0 * d * d) if d * d > h * h else 2.0 * g2 * g2 * h * h / (middle + root)
    elif kind == ROTATION_HELD:
        q = gamma * gamma / (1.0 + math.radians(point[HELD]) * r / (point[LENGTH] * h))
    if not q > 0.0:
        return
    state = kinematics(q, h, d, gamma)
    w, w1, w2 = energy(q, state, rubber, shear)
    if not state[0] > 0.0:
        return
    s = math.sqrt(state[0])
    s1 = 0.5 * state[1] / s
    out[3], out[4], out[5], out[6] = q, s, state[3], w
    out[8] = OF_STRETCH * q * area * abs(w2)
    if kind == LENGTH_HELD:
        out[8] /= abs(s1)
        out[7] = -(p * (s + q * s1) - area * w1 + m * state[4]) / s1
    elif kind == ROTATION_HELD:
        out[8] /= abs(state[4])
        out[7] = -(p * s + (p * q + f) * s1 - area * w1) / state[4]


@kernel
def reference(variable, point, u):
    """``(offset, base, scale)`` of a variable where the uniform state is ``u``; SI units, degrees."""
    r, length = point[FIBERS], point[LENGTH]
    q = u[3]
    if variable == PLAIN:
        return 0.0, 0.0, 1.0
    if variable == SLACK_ALPHA or variable == SLACK_BETA:  # a long tube is all middle; its ends are some radii long
        pulls = u[TAUT] == 3.0 or u[TAUT] == (1.0 if variable == SLACK_ALPHA else 2.0)
        return (0.0 if pulls else 1.0) if u[TAUT] >= 0.0 else math.nan, 0.0, r / length
    swelling = q - 1.0
    if variable == DEFORMED_LENGTH:
        return length * u[4], 0.0, r * swelling
    if variable == ROTATION:
        return math.degrees(length / r * u[5]), 0.0, math.degrees(u[0] * swelling)
    if variable == ENERGY:
        stored = math.pi * r * r * point[C10] * u[2] * u[6]
        return stored * length, 0.0, stored * r
    if variable == VOLUME:
        inside = math.pi * (r * r - point[RADIUS] ** 2) * length  # an incompressible wall keeps its volume
        return -inside, math.pi * r * r * length * q * u[4], (math.sqrt(q) - 1.0) * r / length
    if variable == MID_RADIUS:  # what the middle lacks falls off exponentially with the length
        wider = r * (math.sqrt(q) - 1.0)
        return r + wider * (1.0 + TINY), -wider, 1.0 if wider != 0.0 else 0.0
    # poles divided out: blocked force times ta tb, blocked torque times ta + tb
    if variable == HOLDING_FORCE:
        force = math.pi * r * r * point[C10]
        return force * u[7], 0.0, force / u[1]
    torque = math.pi * r * r * r * point[C10]
    return torque * u[7], 0.0, torque / u[0]


@entry_point
def uniform_states(kind, points, shear, out):
    """:func:`uniform` of points (n, 17) into ``out`` (n, UNIFORM)."""
    for k in range(len(points)):
        uniform(kind, points[k], shear, out[k])


@entry_point
def references(variable, points, states, terms):
    """:func:`reference` of points (n, 17) with uniform states (n, UNIFORM) into ``terms`` (n, 3)."""
    for k in range(len(points)):
        terms[k, 0], terms[k, 1], terms[k, 2] = reference(variable, points[k], states[k])


def restore_all(variable, points, states, effects, rests, noise, values, estimates, bounds, terms=None):
    """From interpolated end effects (n,), what the next order would add and their bounds, to values and theirs, (n,) each.

    ``points`` (n, 17) with uniform states (n, UNIFORM); ``terms`` (n, 3), if they are not those of :func:`references`.
    """
    if terms is None:
        terms = np.empty((len(points), 3))
        references(variable, points, states, terms)
    _restore(variable, points, states, terms, effects, rests, noise, values, estimates, bounds)


def end_effects(variable, kind, points, states, stored, errors, effects, noise, terms=None):
    """Stored numbers (n,) and their bounds as end effects and their bounds, (n,); NaN where the neighbours have to say."""
    if terms is None:
        terms = np.empty((len(points), 3))
        references(variable, points, states, terms)
    # arrays that may not be written to, as those of a file, are a type of their own
    states, stored, errors = (np.require(array, requirements="W") for array in (states, stored, errors))
    _end_effects(variable, kind, points, states, terms, stored, errors, effects, noise)


@entry_point
def _restore(variable, points, states, terms, effects, rests, noise, values, estimates, bounds):
    for k in range(len(effects)):
        offset, base, scale = terms[k, 0], terms[k, 1], terms[k, 2]
        part = base * math.exp(scale * effects[k]) if base != 0.0 else scale * effects[k]
        slope = scale * part if base != 0.0 else scale
        value, rounding = offset + part, ROUNDING
        estimate = abs(slope) * rests[k]
        if base != 0.0:
            estimate = abs(part) * math.expm1(min(abs(scale) * rests[k], 50.0))
        r, length = points[k, FIBERS], points[k, LENGTH]
        if variable == MID_RADIUS:  # below TINY what the middle lacks is a guess, which may be wrong by all of it
            lack = abs(math.exp(effects[k]) - TINY)
            estimate += abs(base) * lack / (1.0 + lack / TINY)
            rounding = OF_RADIUS
        elif variable == ROTATION:
            estimate += OF_STRETCH * math.degrees(length / r * abs(states[k, 0]))
        elif variable == ENERGY and (states[k, 3] != 1.0 or points[k, PRESSURE] != 0.0):
            # invariants less three: of a tube near rest little is left
            stiffness = points[k, C10] + points[k, C01]
            estimate += CANCELLATION * stiffness * math.pi * r * r * states[k, 2] * length
        elif variable == HOLDING_FORCE or variable == HOLDING_TORQUE:
            estimate += math.pi * r * r * points[k, C10] * states[k, 8] * (1.0 if variable == HOLDING_FORCE else r)
        values[k], bounds[k] = value, abs(base if variable == MID_RADIUS else slope) * noise[k]
        estimates[k] = estimate + rounding * (abs(value) + abs(offset) + abs(base))


@entry_point
def _end_effects(variable, kind, points, states, terms, stored, errors, effects, noise):
    for k in range(len(stored)):
        term = terms[k, 0], terms[k, 1], terms[k, 2]
        args = points[k, PRESSURE], states[k, 0], states[k, 3], term, stored[k], errors[k]
        effects[k], noise[k] = end_effect(variable, kind, *args)


@kernel
def end_effect(variable, kind, pressure, turn, q, term, stored, error):
    """One end effect and its bound, where the uniform state has H = ``turn`` and q; ``term`` is :func:`reference`'s."""
    offset, base, scale = term
    slack = variable == SLACK_ALPHA or variable == SLACK_BETA
    shape = variable != PLAIN and variable != HOLDING_FORCE and variable != HOLDING_TORQUE and not slack
    effect, bound = math.nan, 0.0
    if kind == LOADED and pressure == 0.0 and q == 1.0 and shape:
        # at rest; the width of the end layer goes with the square root of pressure
        effect = math.log(TINY) if variable == MID_RADIUS else 0.0
    elif kind == LOADED and pressure == 0.0 and q == 1.0 and slack:
        effect = math.nan  # nothing pulls, and nothing is slack: there is no telling what comes with the least load
    elif not (shape and abs(q - 1.0) < LEAST) and not (variable == ROTATION and abs(turn) < LEAST):
        slope = scale
        if base == 0.0:
            effect = (stored - offset) / scale
        else:
            part = (stored - offset) / base
            effect = math.log(part) / scale if part > 0.0 else math.nan
            slope = base if variable == MID_RADIUS else scale * part * base
        bound = error / abs(slope)
        if not (math.isfinite(effect) and math.isfinite(bound)):
            effect, bound = math.nan, 0.0
    return effect, bound

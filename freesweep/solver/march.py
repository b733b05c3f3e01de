"""The ways to a held state: small steps of the load, of what is held, and of the course along the tube."""

from math import sqrt

import numpy as np

from ..jit import inlined, kernel
from . import guide, held, lagrangian, newton
from .climb import largest_drift, pushed, regraded
from .course import fill
from .status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK
from .uniform import between

STEP, SMALLEST_STEP = 0.1, 1e-6  # of a march, as share of the way that is behind where it begins at a share of the load
LARGEST_STEP_CHANGE = 0.05  # relative change of y in one step of a march
TOLERANCE, NEWTON_ITERATIONS = 1e-10, 25  # of states on the way
MARCH_STEPS, MARCH_WORK = 600, 1_500_000  # steps of a march at least; as many more as that work allows, in cells
NO_SNAP, FASTER = (
    1e-4,
    4.0,
)  # relative change of y, and times what the step before foretells: more may be another branch
STILL = 1e-9  # relative change of y below which a state stands, and cannot have jumped
TURNED_NEAR = 1e-3  # of the way: a turning point so close is what stopped the steps
FIRST_SHARE = 1.0 / 32.0  # of the load: small enough for a single state
EVERY = 1 << 30  # unstable directions allowed: any number
WALL_ONLY = 60  # halvings of the load, until the wall's stiffness prevails


@kernel
def cylinder_multiplier(cell, load, direction):
    """The multiplier that makes y = 1 an equilibrium of a tube that is ``cell`` all along."""
    return -lagrangian.density(1.0, 0.0, cell, load)[1] / lagrangian.conjugate(1.0, 0.0, cell, load, direction)[1]


@kernel
def blend(course, cell, t, out):
    """The course a fraction ``t`` of the way from a tube that is ``cell`` all along."""
    for s in range(course.shape[0]):
        for piece in range(course.shape[1]):
            for k in range(3):
                for power in range(4):
                    start = cell[k] if power == 0 else 0.0
                    out[s, piece, k, power] = start + t * (course[s, piece, k, power] - start)


@kernel
def march(x, y, tube, course, cell, blending, start, end, share, direction, mu, first, target, allowed, work):
    """From load ``start`` with ``first`` held to load ``end`` with ``target`` held, beginning at a ``share`` of that way;
    where it is ``blending``, also from a tube that is ``cell`` all along to ``course``. ``tube`` holds the course that is
    changed on the way. States that move are taken only with as many unstable directions as are ``allowed``.

    Returns ``(status, multiplier, share reached)``. At a turning point the shape changes as the root of the way that is
    left: the inverse square of its speed falls in a straight line to zero there. That, or a state that is unstable however
    small the step, is BEYOND_LIMIT; where the steps die out elsewhere, the solver has failed: NOT_CONVERGED.
    """
    own, edges, cells, free, _, _ = tube
    n = len(x) - 1
    kept_x, kept_y, kept_mu = np.empty(n + 1), np.empty(n + 1), mu
    t, step = share, share if share > 0.0 else STEP
    at, slowness, turn = share, 0.0, 1e300  # middle of the last step, 1/speed^2 there, turning point foretold
    for _ in range(max(MARCH_STEPS, MARCH_WORK // n)):
        for i in range(n + 1):
            kept_x[i], kept_y[i] = x[i], y[i]
        ahead = min(1.0, t + step)
        if blending:
            blend(course, cell, ahead, own)
        load = between(start, end, ahead)
        status, unstable, mu, _ = held.solve_held(
            lagrangian.density, lagrangian.conjugate, x, y, n, free, fill(own, edges, x, n, n, cells), load, direction,
            kept_mu, first + ahead * (target - first), TOLERANCE, NEWTON_ITERATIONS, work,
        )  # fmt: skip
        drift = largest_drift(y, kept_y)
        most = max(NO_SNAP, FASTER * (ahead - t) / sqrt(slowness)) if slowness > 0.0 else LARGEST_STEP_CHANGE
        solved = status == newton.CONVERGED and drift < min(most, LARGEST_STEP_CHANGE)
        if solved and (unstable <= allowed or drift < STILL):
            middle, before = 0.5 * (t + ahead), slowness
            slowness = (ahead - t) / max(drift, 1e-300)
            slowness *= slowness
            if slowness < before:
                turn = middle + slowness * (middle - at) / (before - slowness)
            t, at, step, kept_mu = ahead, middle, (1.6 if drift < 0.5 * LARGEST_STEP_CHANGE else 1.0) * step, mu
            regraded(x, y, n, tube, held.loaded(load, direction, mu), work)
            if t < 1.0:
                continue
            if blending:
                blend(course, cell, 1.0, own)
            return OK, mu, 1.0
        for i in range(n + 1):
            x[i], y[i] = kept_x[i], kept_y[i]
        step *= 0.5
        way = t if share > 0.0 else 1.0
        if step < SMALLEST_STEP * way:
            if pushed(y, held.loaded(between(start, end, t), direction, kept_mu)):
                return COMPRESSED, kept_mu, t
            return (BEYOND_LIMIT if solved or abs(turn - t) < TURNED_NEAR * way else NOT_CONVERGED), kept_mu, t
    return NOT_CONVERGED, kept_mu, t


@kernel
def even_mesh(x, places, edges):
    """Equal cells within each segment."""
    for s in range(len(edges) - 1):
        a, b = edges[s], edges[s + 1]
        for i in range(a, b + 1):
            x[i] = places[s] + (places[s + 1] - places[s]) * (i - a) / (b - a)


@kernel
def begin(x, y, tube):
    """The straight cylinder, on equal cells."""
    even_mesh(x, tube[5], tube[1])
    for i in range(len(x)):
        y[i] = 1.0


@kernel
def small_share(tube, load, direction):
    """A share of the load so small that the wall's stiffness prevails everywhere: the held state is the only one."""
    share = FIRST_SHARE
    for _ in range(WALL_ONLY):
        small, sound = between((1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0), load, share), True
        for k in range(guide.PLACES):
            cell = guide.cell_along(tube, k / (guide.PLACES - 1))
            now = held.loaded(small, direction, cylinder_multiplier(cell, small, direction))
            sound = sound and not lagrangian.density(1.0, 0.0, cell, now)[3] >= 0.0  # not a number: no twist
        if sound:
            break
        share *= 0.5
    return 0.5 * share


@inlined
def from_rest(x, y, tube, course, cell, load, direction, natural, allowed, work):
    """The state at ``load`` on the branch that begins without load: pressure, the other load and fiber extension - 1 rise
    in proportion while the ``natural`` length or rotation, the undeformed one, is held.

    A small share of the load has one state only: there the tube is blended from one that is ``cell`` all along. Returns
    ``(status, multiplier, share of the load reached)``.
    """
    begin(x, y, tube)
    rest = (1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0)
    share = small_share(tube, load, direction)
    small = between(rest, load, share)
    mu = cylinder_multiplier(cell, small, direction)
    first = lagrangian.conjugate(1.0, 0.0, cell, small, direction)[0] * x[len(x) - 1]
    status, mu, _ = march(x, y, tube, course, cell, True, small, small, 0.0, direction, mu, first, natural, EVERY, work)
    if status != OK:
        return status, mu, 0.0
    return march(x, y, tube, course, cell, False, rest, load, share, direction, mu, natural, natural, allowed, work)

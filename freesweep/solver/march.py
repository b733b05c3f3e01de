"""The ways to a held state: from one point to the next along the branch, through no turning point.

Each step follows the tangent, and pins what moves fastest along it (:mod:`pinned`): the share of the way or the stretch of
one node. So the branch is regular where the share turns back; that point is found to rounding, whichever steps led to it.
"""

import numpy as np

from ..jit import kernel
from . import guide, held, lagrangian, nested, newton, pinned
from .pinned import BY_SHARE
from .shapes import largest_drift
from .stability import pushed
from .status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK
from .uniform import between

STEP, SMALLEST_STEP, GROWTH = 0.1, 1e-6, 1.6  # share of the way that is behind where it begins at a share of the load
LARGEST_CHANGE = 0.05  # relative change of y in one step
STRAY, NO_SNAP = 0.3, 1e-4  # of a step, relative to y: what the tangent may miss; more may be another branch
TOLERANCE = 1e-10  # of states on the way
MARCH_STEPS, MARCH_WORK = 600, 1_500_000  # steps at least; as many more as that work allows, in cells
STILL = 1e-9  # relative change of y below which a state stands, and cannot have jumped
FIRST_SHARE = 1.0 / 32.0  # of the load: small enough for a single state
EVERY = 1 << 30  # unstable directions allowed: any number
WALL_ONLY = 60  # halvings of the load, until the wall's stiffness prevails
TOP_STEPS, PROBE, AT_TOP = 25, 1e-3, 1e-6  # of the search for a turning point; relative changes of the pinned stretch
ARRIVAL_STEPS, ARRIVED = 30, 1e-11
NO_TURN = (BY_SHARE, 0.0, 1.0)


@kernel
def cylinder_multiplier(cell, load, direction):
    """The multiplier that makes y = 1 an equilibrium of a tube that is ``cell`` all along."""
    return -lagrangian.density(1.0, 0.0, cell, load)[1] / lagrangian.conjugate(1.0, 0.0, cell, load, direction)[1]


@kernel
def fastest(y, tangent, n):
    """The even node, which coarser meshes share, whose stretch changes most along a tangent; and its relative change."""
    node, most = 2, 0.0
    for i in range(2, n + 1, 2):
        change = abs(tangent[i]) / y[i]
        if change > most:
            node, most = i, change
    return node, most


@kernel
def top(x, y, n, base, tube, way, k, t, mu, rise, bend, sense, work):
    """The turning point of the share near a point where dt/dy_k is ``rise``; ``bend`` is d^2t/dy_k^2, 0 if not known. It is
    the largest share (``sense`` 1) or the least (-1).

    Returns ``(whether it was found, share, mu, bend)``, with a point beside it in ``y``.
    """
    step = sense * np.sign(rise) * PROBE * y[k] if bend == 0.0 else -rise / bend
    for _ in range(TOP_STEPS):
        step = min(max(step, -LARGEST_CHANGE * y[k]), LARGEST_CHANGE * y[k])
        before, value = rise, y[k] + step
        for i in range(n + 1):
            y[i] += step * work[12, i] / work[12, k] if i != k else 0.0
        status, _, mu, t, _, share = pinned.solve(x, y, n, base, tube, way, k, value, t, mu, TOLERANCE, work)
        if status != newton.CONVERGED:
            return False, t, mu, bend
        rise = share / work[12, k]
        if bend == 0.0 or abs(step) > AT_TOP * value:
            bend = (rise - before) / step
        if not sense * bend < 0.0:
            return False, t, mu, bend
        if abs(rise) < AT_TOP * value * abs(bend):
            return True, t - 0.5 * rise * rise / bend, mu, bend
        step = -rise / bend
    return False, t, mu, bend


@kernel
def halt(x, y, n, base, tube, way, k, t, mu, share, until, work):
    """From a point where node ``k`` was pinned and the tangent's part of t is ``share``, to that at share ``until``."""
    for _ in range(ARRIVAL_STEPS):
        if abs(t - until) < ARRIVED:
            return True, mu
        rise = share / work[12, k]
        step = min(max((until - t) / rise, -LARGEST_CHANGE * y[k]), LARGEST_CHANGE * y[k])
        value = y[k] + step
        for i in range(n + 1):
            y[i] += step * work[12, i] / work[12, k] if i != k else 0.0
        status, _, mu, t, _, share = pinned.solve(x, y, n, base, tube, way, k, value, t, mu, TOLERANCE, work)
        if status != newton.CONVERGED:
            break
    return False, mu


@kernel
def march(x, y, tube, way, share, until, mu, allowed, work):
    """Along a ``way`` (:func:`pinned.at_share`) from ``share`` to ``until``. States that move are taken only with as many
    unstable directions as are ``allowed``.

    Returns ``(status, multiplier, share reached, turn)``: BEYOND_LIMIT at a turning point of the share, of which ``turn`` is
    (node k, d^2t/dy_k^2, whether y_k rose (1) or fell (-1) before it), or, with NO_TURN, before a state that is unstable
    however small the step; where the steps die out elsewhere, the solver has failed: NOT_CONVERGED.
    """
    n = len(x) - 1
    kept_x, kept_y, along, guess = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    t, step = share, share if share > 0.0 else STEP
    status, unstable, mu, t, by_mu, by_t = pinned.solve(x, y, n, n, tube, way, BY_SHARE, t, t, mu, TOLERANCE, work)
    if status != newton.CONVERGED:
        return NOT_CONVERGED, mu, t, NO_TURN
    sign = 1.0 if by_t >= 0.0 else -1.0
    for _ in range(max(MARCH_STEPS, MARCH_WORK // n)):
        kept_mu, kept_t, by_mu, by_t = mu, t, sign * by_mu, sign * by_t
        for i in range(n + 1):
            kept_x[i], kept_y[i], along[i] = x[i], y[i], sign * work[12, i]
        solved, moves = False, True
        while True:
            k, most = fastest(kept_y, along, n)
            k = BY_SHARE if by_t >= most else k
            ahead = min(step, LARGEST_CHANGE / max(most, 1e-300))
            if k == BY_SHARE:
                ahead = min(ahead, (until - kept_t) / by_t)
            for i in range(n + 1):
                x[i], y[i] = kept_x[i], kept_y[i] + ahead * along[i]
            mu, t = kept_mu + ahead * by_mu, kept_t + ahead * by_t
            t = until if k == BY_SHARE and until - t < ARRIVED else t
            own, load = pinned.at_share(way, tube, x, n, n, t)
            if newton.admissible(lagrangian.density, x, y, n, own, held.loaded(load, way[4], mu)):
                nested.regrade(
                    lagrangian.density, lagrangian.integrands, x, y, n, tube, held.loaded(load, way[4], mu), work
                )
            for i in range(n + 1):
                guess[i] = y[i]
            expected, value = t, t if k == BY_SHARE else y[k]
            status, unstable, mu, t, new_mu, new_t = pinned.solve(
                x, y, n, n, tube, way, k, value, t, mu, TOLERANCE, work
            )
            drift = ahead * most
            near = STRAY * (drift if k == BY_SHARE else ahead) + NO_SNAP
            solved = status == newton.CONVERGED and largest_drift(y, guess) < near and abs(t - expected) < near
            if solved:
                dot = new_t * by_t
                for i in range(n + 1):
                    dot += work[12, i] * along[i] / (y[i] * y[i] * n)
                sign = 1.0 if dot >= 0.0 else -1.0
                turned = sign * new_t <= 0.0
                if turned and k != BY_SHARE:
                    found, t, mu, bend = top(x, y, n, n, tube, way, k, t, mu, new_t / work[12, k], 0.0, 1.0, work)
                    if found and t >= until:  # back to the side it came from
                        for i in range(n + 1):
                            x[i], y[i] = kept_x[i], kept_y[i]
                        step = 0.25 * ahead
                        if step > SMALLEST_STEP:
                            continue
                    if found:
                        return BEYOND_LIMIT, mu, t, (k, bend, 1.0 if along[k] > 0.0 else -1.0)
                    solved = False
                moves = drift >= STILL
                if solved and not turned and (unstable <= allowed or not moves):
                    break
            step = 0.5 * ahead
            if step < SMALLEST_STEP * (kept_t if share > 0.0 else 1.0):
                for i in range(n + 1):
                    x[i], y[i] = kept_x[i], kept_y[i]
                own, load = pinned.at_share(way, tube, x, n, n, kept_t)
                if pushed(y, own, held.loaded(load, way[4], kept_mu)):
                    return COMPRESSED, kept_mu, kept_t, NO_TURN
                return (BEYOND_LIMIT if solved else NOT_CONVERGED), kept_mu, kept_t, NO_TURN
        by_mu, by_t = new_mu, new_t
        step = (GROWTH if largest_drift(y, guess) < 0.2 * near else 1.0) * ahead
        if k == BY_SHARE and ahead * most < 0.5 * LARGEST_CHANGE:
            step = GROWTH * ahead
        if t >= until:
            if k == BY_SHARE:
                return OK, mu, until, NO_TURN
            found, mu = halt(x, y, n, n, tube, way, k, t, mu, new_t, until, work)
            return (OK if found else NOT_CONVERGED), mu, until, NO_TURN
    return NOT_CONVERGED, mu, t, NO_TURN


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


@kernel
def from_rest(x, y, tube, course, cell, load, direction, natural, allowed, work):
    """The state at ``load`` on the branch that begins without load: pressure, the other load and fiber extension - 1 rise
    in proportion while the ``natural`` length or rotation, the undeformed one, is held.

    A small share of the load has one state only: there the tube is blended from one that is ``cell`` all along. Returns
    as :func:`march`, and the way.
    """
    begin(x, y, tube)
    rest = (1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0)
    share = small_share(tube, load, direction)
    small = between(rest, load, share)
    mu = cylinder_multiplier(cell, small, direction)
    first = lagrangian.conjugate(1.0, 0.0, cell, small, direction)[0] * x[len(x) - 1]
    blended = (small, small, first, natural, direction, True, course, cell, True)
    way = (rest, load, natural, natural, direction, True, course, cell, False)
    status, mu, t, turn = march(x, y, tube, blended, 0.0, 1.0, mu, EVERY, work)
    if status != OK:
        return status, mu, 0.0, turn, way
    pinned.blend(course, cell, 1.0, tube[0])
    status, mu, t, turn = march(x, y, tube, way, share, 1.0, mu, allowed, work)
    return status, mu, t, turn, way


@kernel
def from_free(x, y, tube, course, cell, load, direction, target, allowed, work):
    """The state at ``load`` on the branch that begins with nothing held: pressure, the other load and fiber extension - 1
    rise in proportion, then the length or rotation found is changed to the ``target``. Returns as :func:`from_rest`.
    """
    n = len(x) - 1
    rest = (1.0, load[1], load[2], 0.0, 0.0, 0.0, 1.0)
    nothing = (rest, load, 0.0, 0.0, direction, False, course, cell, False)
    scratch = np.empty((2, 1 if course.shape[0] == 1 and course.shape[1] == 1 else guide.PLACES))
    part = guide.begin(tube, load, scratch[0], scratch[1], x, y)
    if not part > 0.0:
        return NOT_CONVERGED, 0.0, 0.0, NO_TURN, nothing
    status, mu, t, turn = march(x, y, tube, nothing, part, 1.0, 0.0, 0, work)
    own, now = pinned.at_share(nothing, tube, x, n, n, 1.0)
    first, _ = held.hold(lagrangian.conjugate, x, y, n, own, now, direction, work[8])
    way = (load, load, first, target, direction, True, course, cell, False)
    if status != OK:
        return status, 0.0, 0.0, NO_TURN, way
    status, mu, t, turn = march(x, y, tube, way, 0.0, 1.0, 0.0, allowed, work)
    return status, mu, t, turn, way

"""Held states: the deformed length or the rotation of the free end is given, the force or the torque that keeps it unknown.

The state meant is the one on the branch that begins without load: pressure, the other load and fiber extension - 1 rise in
proportion while the undeformed length (no rotation) is held, then what is held changes to its target; the multiplier
follows in small steps. The straight cylinder y = 1 of a tube that is the same all along is an equilibrium on this way under
the load that makes L_y(1, 0) = 0: there the march begins at once. A tube that varies goes all of it (``march.from_rest``);
only where its wall would have to be pushed on the way, it is blended from a straight one at the load asked for.

Beyond a critical pressure of blocked torque the cylinder is unstable (its first mode is antisymmetric); ``buckled``
starts from that mode instead, and takes the stable state beside it.
"""

import numpy as np

from ..jit import entry_point, kernel
from . import guide, held, lagrangian, nested, newton
from .branch import GAMMA, SHEAR, rubber_of
from .climb import pushed
from .march import LOWERINGS, begin, buckled_at, cylinder_multiplier, from_rest, march
from .profile import FIELDS, at_stations
from .slack import slack_fibers
from .stability import unstable_directions
from .status import COMPRESSED, HELD_IMPOSSIBLE, INACCURATE, NOT_CONVERGED, OK

HELD_LENGTH, HELD_ROTATION = 0, 1
RAISES = 40  # of the pressure by a half, until the wall of the starting cylinder is under tension


@kernel
def find(problem, p, other, target, kind, buckled, course, tube, accuracy, space, out):
    """One held state; returns ``(status, unstable directions, doublings, multiplier, load)``."""
    fine, work, table, shapes = space[0], space[1], space[2], space[4]
    _, edges, _, _, _, places = tube
    base = edges[len(edges) - 1]
    x, y = shapes[0, : base + 1], shapes[1, : base + 1]
    total = places[len(places) - 1]
    gamma = problem[GAMMA]
    force, torque = (0.0, other) if kind == HELD_LENGTH else (other, 0.0)
    rubber, shear = rubber_of(problem), problem[SHEAR]
    load = (gamma, rubber, shear, p, force, torque, 1.0)
    unit = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0) if kind == HELD_LENGTH else (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    # a place whose cylinder can carry the load, at a higher pressure if it must be
    start, cell, raised = load, guide.cell_along(tube, 0.5), False
    for attempt in range(RAISES * guide.PLACES):
        share = ((attempt // RAISES) * 0.5 / (guide.PLACES - 1) + 0.5) % 1.0
        cell = guide.cell_along(tube, share)
        higher = p * 1.5 ** (attempt % RAISES)
        start = (gamma, rubber, shear, higher, force, torque, 1.0)
        mu = cylinder_multiplier(cell, start, unit)
        at_start = held.loaded(start, unit, mu)
        raised = lagrangian.density(1.0, 0.0, cell, at_start)[0] > 0.0
        if raised or (course.shape[0] == 1 and attempt == RAISES - 1):
            break
    # a straight fiber cannot stretch: whatever the force, the length stays (the pole of Eq. 2.16)
    if course.shape[0] == 1 and lagrangian.conjugate(1.0, 0.0, cell, load, unit)[1] == 0.0:
        return HELD_IMPOSSIBLE, 0, 0, 0.0, load
    if not raised:
        return COMPRESSED, 0, 0, 0.0, load
    scale = max(abs(mu), p)
    direction = tuple_times(unit, scale)
    mu /= scale
    begin(x, y, tube)
    first = lagrangian.conjugate(1.0, 0.0, cell, start, unit)[0] * total * scale
    wanted = target * scale
    found, regrades = OK, 1
    varying = course.shape[0] > 1 or course.shape[1] > 1
    for tries in range(2):  # a buckled shape that no mesh holds is come to from a lower pressure
        if buckled:
            found, mu = buckled_at(x, y, tube, course, load, (tries, LOWERINGS), direction, mu, wanted, work)
        else:
            if varying:
                natural = total * scale if kind == HELD_LENGTH else 0.0
                found, mu = from_rest(x, y, tube, course, cell, load, direction, natural, wanted, work)
            if not varying or found == COMPRESSED:
                begin(x, y, tube)
                mu = cylinder_multiplier(cell, start, direction)
                found, mu = march(
                    x, y, tube, course, cell, True, start, start, direction, mu, first, wanted, 1e-10, work
                )
                if found == OK and start[3] != p:
                    found, mu = march(
                        x, y, tube, course, cell, False, start, load, direction, mu, wanted, wanted, 1e-10, work
                    )
        if found != OK:
            return found, 0, 0, 0.0, load
        status, _, doublings, _ = nested.solve(
            lagrangian.density, lagrangian.conjugate, lagrangian.integrands, lagrangian.scales, x, y, tube, load,
            nested.HELD, direction, wanted, mu, regrades, accuracy, fine, work, table, out,
        )  # fmt: skip
        if status == newton.CONVERGED or status == nested.UNREACHED or not buckled:
            break
    if status != newton.CONVERGED and status != nested.UNREACHED:
        vanishing = pushed(y, held.loaded(load, direction, mu))
        return (COMPRESSED if vanishing else NOT_CONVERGED), 0, 0, 0.0, load
    now = held.loaded(load, direction, out[0, nested.MULTIPLIER])
    if not now[3] + now[4] > 0.0:  # at the clamped ends, where y = 1
        return COMPRESSED, 0, 0, 0.0, load
    unstable = unstable_directions(fine[0], fine[1], base << doublings, base, tube, now, direction, space[5], work)
    out[0, nested.MULTIPLIER] *= scale
    out[1, nested.MULTIPLIER] *= scale
    return (OK if status == newton.CONVERGED else INACCURATE), unstable, doublings, mu, now


@kernel
def tuple_times(values, factor):
    """A load direction times a number."""
    return (0.0, 0.0, 0.0, 0.0, factor * values[4], factor * values[5], 0.0)


@entry_point
def hold_many(
    problem, pressures, others, targets, kind, buckled, course, edges, places, accuracy, values, bounds, status, stable,
    slack, stations, profiles,
):  # fmt: skip
    """Held states of one design, for arrays of pressure, of the load that is not unknown, and of the held quantity.

    The n-th entries belong together. ``targets`` are in radii (deformed length) or radians, of the whole tube; a tube that
    is the same all along is solved by half (``edges`` and ``places`` of one segment), unless ``buckled``. ``values`` and
    ``bounds`` are (n, 6): length, volume, twist, energy of half the tube, stretch in the middle, multiplier.
    """
    base = edges[len(edges) - 1]
    size = (base << nested.MAX_DOUBLINGS) + 2
    half = len(places) == 2
    middle = base if half else edges[np.argmin(np.abs(places - 0.5 * places[len(places) - 1]))]
    cells = np.zeros((1 if half and course.shape[1] == 1 else size, 3))
    space = (
        np.zeros((5, size)), np.zeros((13, 2 * size)), np.zeros((nested.MAX_DOUBLINGS + 2, nested.OUTPUTS)),
        np.zeros((5, size)), np.zeros((2, base + 1)), np.zeros((3, 2 * size)),
    )  # fmt: skip
    out = np.zeros((4, nested.OUTPUTS))
    for i in range(len(pressures)):
        for k in range(6):
            values[i, k], bounds[i, k] = np.nan, np.nan
        for j in range(len(stations)):
            for k in range(FIELDS):
                profiles[i, k, j] = np.nan
        slack[i], stable[i] = 0, 0
        tube = (course.copy(), edges, cells, half, middle, places)
        target = 0.5 * targets[i] if half else targets[i]
        status[i], unstable, doublings, _, now = find(
            problem, pressures[i], others[i], target, kind, buckled, course, tube, accuracy, space, out
        )
        if status[i] == OK or status[i] == INACCURATE:
            for k in range(6):
                share = 0.5 if not half and k < 4 else 1.0
                values[i, k], bounds[i, k] = share * out[0, k], share * out[1, k]
            stable[i] = 1 if unstable == 0 else 0
            slack[i] = slack_fibers(space[0][0], space[0][1], base << doublings, base, tube, now)
            if len(stations) > 0:
                at_stations(stations, base, doublings, tube, now, space[0], space[3], profiles[i])

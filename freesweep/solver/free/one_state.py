"""One free state, from a guess close to it, on nested meshes; near a fold by what is conjugate to the
pressure.

Close to a fold meshes differ in whether they have a state at a pressure at all. Held instead is the volume, which rises
through the fold, and made such that the extrapolated pressure is the one asked for.
"""

import numpy as np

from ...jit import kernel
from ..along.drawing import draw
from ..along.profile import FIELDS
from ..along.slack import look_along
from ..load import by
from ..numerics import error_bounds, held, nested, newton
from ..numerics.held import NOTHING, Target
from ..numerics.properties_along import fill
from ..numerics.shapes import differ, extremes
from ..of_tube import of_tube
from ..physics import lagrangian
from ..status import INACCURATE, NOT_CONVERGED, OK

ROOT_STEPS, ROOT = 40, 1e-9  # of the pressure, relative
REGRADES, COLD = 1, 3  # of the base mesh, from a good guess and from a rough one


@kernel
def solve(space, tube, load, target, regrades, accuracy):
    """:func:`..numerics.nested.solve` from the guess in ``space``: ``(status, doublings)``, and that the state is stable."""
    status, unstable, doublings = nested.solve(of_tube(), space, tube, load, target, 1.0, regrades, accuracy)
    solved = status == newton.CONVERGED or status == nested.UNREACHED
    if not solved or unstable > 0:
        return NOT_CONVERGED, doublings
    return (OK if status == newton.CONVERGED else INACCURATE), doublings


@kernel
def cold(space, tube, load, accuracy):
    """The state at ``load``, from a rough guess: where there is one only."""
    return solve(space, tube, load, NOTHING, COLD, accuracy)


@kernel
def plain(space, tube, load, accuracy):
    """The state at ``load`` that the guess all but is."""
    guess = extremes(space.y, tube.middle)
    status, doublings = solve(space, tube, load, NOTHING, REGRADES, accuracy)
    return (NOT_CONVERGED if differ(guess, extremes(space.y, tube.middle)) else status), doublings


@kernel
def near_fold(room, tube, path, pressure, first, limit, accuracy):
    """The state at ``pressure``, between one at the pressure ``first``, in the room's track, and a fold at ``limit`` whose
    shape is a step ahead there; as :func:`plain`. The error of the pressure that was met enters the bounds.
    """
    space, track, n = room.space, room.track, len(room.space.x) - 1
    course, edges, cells, _, _, _ = tube
    own = fill(course, edges, track.x, n, n, cells)
    direction = by(pressure, 0.0, 0.0)
    low, _ = held.hold(lagrangian.conjugate, track.x, track.y, n, own, path.origin, direction, space.work[8])
    high, _ = held.hold(lagrangian.conjugate, track.x, track.next_y, n, own, path.origin, direction, space.work[8])
    start, whole = low, high - low
    miss_low, miss_high, gap = first / pressure - 1.0, limit / pressure - 1.0, 1.0
    values, slope, last = space.curve[0], space.curve[1], 1.0
    status, doublings = NOT_CONVERGED, 0
    for made in range(ROOT_STEPS):
        target = (low * miss_high - high * miss_low) / (miss_high - miss_low)
        if made % 3 == 2:  # a parabola's flat top holds the secant up
            target = 0.5 * (low + high)
        share = (target - start) / whole
        for i in range(n + 1):
            space.x[i], space.y[i] = track.x[i], track.y[i] + share * (track.next_y[i] - track.y[i])
        guess = extremes(space.y, tube.middle)
        status, doublings = solve(space, tube, path.origin, Target(direction, target, True), REGRADES, accuracy)
        if status == NOT_CONVERGED or differ(guess, extremes(space.y, tube.middle)):
            return NOT_CONVERGED, doublings
        gap = space.out[0, error_bounds.MULTIPLIER] - 1.0
        for k in range(error_bounds.OUTPUTS):
            if made > 0 and gap != last:
                slope[k] = abs((space.out[0, k] - values[k]) / (gap - last))
            values[k] = space.out[0, k]
        last = gap
        if abs(gap) < ROOT and made > 1:
            break
        if gap > 0.0:
            high, miss_high = target, gap
        else:
            low, miss_low = target, gap
    if not abs(gap) < np.sqrt(ROOT):
        return NOT_CONVERGED, doublings
    doubt, largest = abs(gap) + space.out[1, error_bounds.MULTIPLIER], 0.0
    for k in range(error_bounds.OUTPUTS - 1):
        space.out[1, k] += slope[k] * doubt
        largest = max(largest, space.out[1, k] / space.out[2, k])
    return (OK if largest <= accuracy else INACCURATE), doublings


@kernel
def record(space, tube, load, status, doublings, accuracy, rows, i):
    """Write a state, or why there is none, to row ``i``."""
    rows.status[i] = status
    if status != OK and status != INACCURATE:
        return
    base = len(space.x) - 1
    for k in range(5):
        share = 1.0 if k == error_bounds.MIDDLE else 0.5  # of half the tube
        rows.values[i, k], rows.bounds[i, k] = share * space.out[0, k], share * space.out[1, k]
    rows.slack[i] = look_along(
        space.fine, base << doublings, base, tube, load, space.work, rows.values[i, 5:], rows.bounds[i, 5:]
    )
    if len(rows.stations) > 0:
        drawn = draw(
            rows.stations, base, doublings, tube, load, space.fine, space.curve, space.work, accuracy, rows.profiles[i]
        )
        rows.status[i] = status if drawn else INACCURATE


@kernel
def blank(rows, i):
    """No value in row ``i`` yet."""
    rows.slack[i] = 0
    for k in range(rows.values.shape[1]):
        rows.values[i, k], rows.bounds[i, k] = np.nan, np.nan
    for j in range(len(rows.stations)):
        for k in range(FIELDS):
            rows.profiles[i, k, j] = np.nan

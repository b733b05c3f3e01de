"""The uniform tube: one number instead of a shape, followed along a straight line in load space.

It is the guide of the walk: where the uniform stretch is carried from one load to the next without a turning point, so is
the tube with clamped ends, and its stretch lies between 1 and the uniform one. Where it is not, the walk goes slowly.
"""

from .jit import kernel

FIRST_STEP = 0.25  # of the way from one load to the other
SMALLEST_STEP = 1e-7  # below it the path is taken to end in a turning point
LARGEST_CHANGE = 0.15  # relative change of the stretch in one step; a jump to another branch is larger
ITERATIONS = 12


@kernel
def between(start, end, t):
    """The load a fraction ``t`` of the way from ``start`` to ``end``."""
    return (
        start[0] + t * (end[0] - start[0]),
        end[1],
        end[2],
        start[3] + t * (end[3] - start[3]),
        start[4] + t * (end[4] - start[4]),
        start[5] + t * (end[5] - start[5]),
        end[6],
    )


@kernel
def follow(density, u, cell, start, end):
    """Carry the uniform stretch ``u`` from load ``start`` to ``end``; returns it and the fraction reached (1: all)."""
    t, step = 0.0, FIRST_STEP
    while t < 1.0:
        ahead = min(1.0, t + step)
        load = between(start, end, ahead)
        trial, before, arrived = u, 1e300, False
        for _ in range(ITERATIONS):
            room, L_y, _, L_yy, _, _ = density(trial, 0.0, cell, load)
            if not (room > 0.0 and L_yy < 0.0):
                break
            change = -L_y / L_yy
            trial += change
            if not abs(trial - u) < LARGEST_CHANGE * u:
                break
            if abs(change) < 1e-13 * u or (abs(change) < 1e-10 * u and abs(change) >= 0.5 * before):
                arrived = True
                break
            before = abs(change)
        if arrived:
            t, u, step = ahead, trial, 2.0 * step
        else:
            step *= 0.5
            if step < SMALLEST_STEP:
                break
    return u, t

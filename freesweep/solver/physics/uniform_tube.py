"""The uniform tube: one number instead of a shape. Near rest it is the guide of a branch's first state; vectors follow it
along straight lines in load space (:mod:`..lanes.first_guess`).
"""

from ...jit import kernel
from ..load import Load

LARGEST_CHANGE = 0.15  # relative change of the stretch in one step; a jump to another branch is larger
ITERATIONS = 30  # five do nearly always
SCAN = 0.015  # relative change of the stretch between two looks at the slope
SECANTS, CLOSE = 24, 3e-2  # for the load of a stretch; share of L_y at the bounds that is as good as nothing
FAR = 8.0  # end layers per half tube, up to which clamped ends may turn back a tube that is drawn in
SMALL_STRAIN = 0.02  # where a branch begins: there the wall has one state only


@kernel
def between(start, end, t):
    """The load a fraction ``t`` of the way from ``start`` to ``end``."""
    return Load(
        start.gamma + t * (end.gamma - start.gamma),
        end.rubber,
        end.wall,
        start.p + t * (end.p - start.p),
        start.f + t * (end.f - start.f),
        start.m + t * (end.m - start.m),
        end.e,
    )


@kernel
def near_rest(density, cell, load):
    """``(stretch, whether it is met within SMALL_STRAIN)`` of the uniform tube. L is concave: where L_yy jumps, as fibers go
    slack, halving does.
    """
    u, least, most = 1.0, 1.0 - SMALL_STRAIN, 1.0 + SMALL_STRAIN
    for _ in range(ITERATIONS):
        room, L_y, _, L_yy, _, _ = density(u, 0.0, cell, load)
        if not (room > 0.0 and L_yy < 0.0):
            return u, False
        least, most = (u, most) if L_y > 0.0 else (least, u)
        new = u - L_y / L_yy
        change, u = new - u, (new if least <= new <= most else 0.5 * (least + most))
        if abs(change) < 1e-10 * u:
            break
    return u, abs(u - 1.0) < (1.0 - 1e-6) * SMALL_STRAIN

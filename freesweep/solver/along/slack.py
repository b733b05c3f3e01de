"""Fibers that would have to push: where a state relies on them, physics does not stand behind it."""

from ...jit import kernel
from ..cells import cell_at
from ..numerics.properties_along import at_point, fill
from ..physics import lagrangian
from ..physics.wall import has_any_family, has_two_families, may_go_slack
from .axial import axial_stretch, flux_at, is_alike

NOTHING = 1e-300  # the multiplier of a slack family is 0
TENSIONLESS = 1e-9  # of the load: a fiber family without tension does not push
TENSIONLESS_END = 1e-4  # at the clamped end of a tube that varies, whose flux is of second order here


@kernel
def pushing(alpha, beta, share, load):
    """Bit 1: the alpha family, of this multiplier, would have to push at a place, or is slack; bit 2: the beta family. What
    is not there is not slack.
    """
    wall = load[2]
    least = NOTHING if may_go_slack(wall) else -share * (load[3] + abs(load[4]))
    return (1 if has_any_family(wall) and alpha < least else 0) | (2 if has_two_families(wall) and beta < least else 0)


@kernel
def slack_fibers(x, y, n, base, tube, load):
    """:func:`pushing` anywhere along a tube."""
    course, edges, cells, _, _, _ = tube
    flag = 0
    if is_alike(course):
        cell = at_point(course, 0, 0.0)
        constant = lagrangian.uniform_tube(y[n], cell, load)[2]
        for j in range(n + 1):
            alpha, beta = lagrangian.fiber_multipliers(y[j], axial_stretch(y[j], constant, cell, load), cell, load)
            flag |= pushing(alpha, beta, TENSIONLESS, load)
        return flag
    own = fill(course, edges, x, n, base, cells)
    for j in range(n):
        v, middle, cell = (y[j + 1] - y[j]) / (x[j + 1] - x[j]), 0.5 * (y[j] + y[j + 1]), cell_at(own, j)
        room, alpha, beta = lagrangian.at_slope(middle, v, cell, load)
        if room > 0.0:
            flag |= pushing(alpha, beta, TENSIONLESS, load)
    for j in (0, n):
        cell = at_point(course, 0 if j == 0 else course.shape[0] - 1, 0.0 if j == 0 else 1.0)
        flux = flux_at(x, y, j, n, own, load)
        _, _, alpha, beta = lagrangian.at_flux(y[j], flux, cell, load)
        flag |= pushing(alpha, beta, TENSIONLESS_END, load)
    return flag

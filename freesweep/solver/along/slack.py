"""Fibers that would have to push: where a state relies on them, physics does not stand behind it. Of physical tubes also
the numbers of :mod:`places`, from the three finest meshes of a solved state.
"""

import numpy as np

from ...jit import kernel
from ..cells import cell_at, nothing_yet
from ..numerics.finest import load_of, mesh_of
from ..numerics.properties_along import at_point, fill
from ..physics import lagrangian
from ..physics.wall import has_any_family, has_two_families, may_go_slack
from . import places
from .axial import axial_stretch, flux_at, is_alike

NOTHING = 1e-300  # the multiplier of a slack family is 0
TENSIONLESS = 1e-9  # of the load: a fiber family without tension does not push
TENSIONLESS_END = 1e-4  # at the clamped end of a tube that varies, whose flux is of second order here


@kernel
def pushing(alpha, beta, share, load):
    """Bit 1: the alpha family, of this multiplier, would have to push at a place, or is slack; bit 2: the beta family. What
    is not there is not slack.
    """
    wall = load.wall
    least = NOTHING if may_go_slack(wall) else -share * (load.p + abs(load.f))
    return (1 if has_any_family(wall) and alpha < least else 0) | (2 if has_two_families(wall) and beta < least else 0)


@kernel
def look_along(fine, n, base, tube, load, seen, numbers, bounds):
    """:func:`pushing` anywhere along a tube, whose finest meshes are ``fine``, the last of n cells. Of a physical one
    ``numbers`` and ``bounds``, as many as there is room for, take those of :mod:`places`; ``seen`` (ROWS, > n + 1) is
    scratch.
    """
    return _look_along(fine, n, base, tube, load, seen, numbers, bounds, load.wall)


@kernel
def _look_along(fine, n, base, tube, load, seen, numbers, bounds, wall):
    if len(wall) == 1:
        return slack_fibers(fine[0], fine[1], n, base, tube, load)
    flag, apart = see(fine[0], fine[1], n, base, tube, load_of(0, load, fine), seen)
    if len(numbers) > 0:
        found, shares = peaks(seen, n, base, tube.edges, apart, load), without_pulls(seen, n, load)
        finer, other = again(1, n, base, fine, tube, load, seen, found)
        coarse, first = again(2, n, base, fine, tube, load, seen, found)
        largest = (found[0][0], found[1][0], found[2][0], found[3][0]), finer, coarse
        told, missed = places.together((shares, other, first), largest, doubts(found), load)
        for k in range(len(numbers)):
            numbers[k], bounds[k] = told[k], missed[k]
    return flag


@kernel
def again(which, n, base, fine, tube, load, seen, found):
    """:func:`at_peaks` and :func:`without_pulls` of one of the two meshes before that of n cells."""
    x, y = mesh_of(which, n // 2, fine)
    cells = len(x) - 1
    _, apart = see(x, y, cells, base, tube, load_of(which, load, fine), seen)
    return at_peaks(seen, cells, base, tube.edges, apart, load, found), without_pulls(seen, cells, load)


@kernel
def see(x, y, n, base, tube, load, seen):
    """Write what :mod:`places` looks at along a physical tube to the rows of ``seen``; returns the flag, and what is largest
    where segments end: pulls, their sign turned round, and squares.
    """
    course, edges, cells, symmetric, _, _ = tube
    own, size, near, flag = fill(course, edges, x, n, base, cells), load.p + abs(load.f), nothing_yet(0.0), 0
    loose, any_family, both = may_go_slack(load.wall), has_any_family(load.wall), has_two_families(load.wall)
    least, at_ends = (NOTHING if loose else -TENSIONLESS * size), (NOTHING if loose else -TENSIONLESS_END * size)
    for k in range(n + 2):
        j = min(max(k - 1, 0), n - 1)
        if k == 0 or k == n + 1:
            node = min(k, n)
            cell = at_point(course, 0 if k == 0 else course.shape[0] - 1, 0.0 if k == 0 else 1.0)
            flux = 0.0 if symmetric and k > 0 else flux_at(x, y, node, n, own, load)
            alpha, beta, others = places.at_end(y[node], flux, cell, load)
            place, below = x[node], at_ends
        else:
            v, place, below = (y[j + 1] - y[j]) / (x[j + 1] - x[j]), 0.5 * (x[j] + x[j + 1]), least
            alpha, beta, others, near = places.inside(0.5 * (y[j] + y[j + 1]), v, cell_at(own, j), load, near)
        seen[places.PLACE, k], seen[places.ALPHA, k], seen[places.BETA, k] = place, alpha - below, beta - below
        seen[places.PULL_ALPHA, k], seen[places.PULL_BETA, k] = -others[0], -others[1]
        seen[places.SQUARE, k], seen[places.STRAIN, k] = others[2], others[3]
        flag |= (1 if any_family and alpha < below else 0) | (2 if both and beta < below else 0)
    return flag, where_segments_end(x, y, n, base, tube, own, load, seen)


@kernel
def where_segments_end(x, y, n, base, tube, own, load, seen):
    """What is largest at the ends of a tube, as ``seen``, and at those of its segments, seen from both sides."""
    course, edges, _, _, _, _ = tube
    a, b = (
        max(seen[places.PULL_ALPHA, 0], seen[places.PULL_ALPHA, n + 1]),
        max(seen[places.PULL_BETA, 0], seen[places.PULL_BETA, n + 1]),
    )
    square = max(seen[places.SQUARE, 0], seen[places.SQUARE, n + 1])
    strain = max(seen[places.STRAIN, 0], seen[places.STRAIN, n + 1])
    for s in range(1, course.shape[0]):
        node = int(edges[s] * (n / base))
        flux = flux_at(x, y, node, n, own, load)
        for side in range(2):
            _, _, others = places.at_end(y[node], flux, at_point(course, s - 1 + side, 1.0 - side), load)
            a, b = max(a, -others[0]), max(b, -others[1])
            square, strain = max(square, others[2]), max(strain, others[3])
    return a, b, square, strain


@kernel
def without_pulls(seen, n, load):
    """``(share of alpha, its doubt, share of beta, its doubt)`` of n cells and both ends."""
    x, faint, loose = seen[places.PLACE], places.FAINT * (load.p + abs(load.f)), may_go_slack(load.wall)
    a, b, last = seen[places.ALPHA], seen[places.BETA], n + 1
    total, found = x[last] - x[0], (0.0, 0.0, 0.0, 0.0)
    for i in range(last):
        before, beyond, h = max(i - 1, 0), min(i + 2, last), (x[i + 1] - x[i]) / total
        h_before = (x[i] - x[before]) / total if i > 0 else h
        h_beyond = (x[beyond] - x[i + 1]) / total if i < n else h
        steps = h_before, h, h_beyond, faint, loose
        part_a, doubt_a = places.without_pull(a[before], a[i], a[i + 1], a[beyond], *steps)
        part_b, doubt_b = places.without_pull(b[before], b[i], b[i + 1], b[beyond], *steps)
        found = found[0] + part_a, found[1] + doubt_a, found[2] + part_b, found[3] + doubt_b
    return found


@kernel
def peaks(seen, n, base, edges, apart, load):
    """Of pulls, their sign turned, and of squares: what :func:`places.highest` finds along n cells, if it is larger than
    ``apart``, what they are where segments end (segment -1).
    """
    none, last = 0.0 if may_go_slack(load.wall) else np.inf, len(edges) - 1
    a, b = (apart[0], 0.0, -1, 0.0, apart[0]), (apart[1], 0.0, -1, 0.0, apart[1])
    widest, most = (apart[2], 0.0, -1, 0.0, apart[2]), (apart[3], 0.0, -1, 0.0, apart[3])
    for s in range(last):
        first, end = int(edges[s] * (n / base)) + 1, int(edges[s + 1] * (n / base))
        a = places.highest(seen[places.PLACE], seen[places.PULL_ALPHA], first, end, s, none, a)
        b = places.highest(seen[places.PLACE], seen[places.PULL_BETA], first, end, s, none, b)
        widest = places.highest(seen[places.PLACE], seen[places.SQUARE], first, end, s, np.inf, widest)
        most = places.highest(seen[places.PLACE], seen[places.STRAIN], first, end, s, np.inf, most)
    return a, b, widest, most


@kernel
def doubts(found):
    """By how much each of :func:`peaks` may be missed."""
    a, b, widest, most = found
    return (
        max(a[3], a[4] - a[0]),
        max(b[3], b[4] - b[0]),
        max(widest[3], widest[4] - widest[0]),
        max(most[3], most[4] - most[0]),
    )


@kernel
def at_peaks(seen, n, base, edges, apart, load, found):
    """What the rows of :func:`peaks` are along n cells where these were ``found`` to be largest on other ones."""
    none = 0.0 if may_go_slack(load.wall) else np.inf
    a = at_peak(seen, places.PULL_ALPHA, n, base, edges, apart[0], none, found[0])
    b = at_peak(seen, places.PULL_BETA, n, base, edges, apart[1], none, found[1])
    widest = at_peak(seen, places.SQUARE, n, base, edges, apart[2], np.inf, found[2])
    most = at_peak(seen, places.STRAIN, n, base, edges, apart[3], np.inf, found[3])
    return a, b, widest, most


@kernel
def at_peak(seen, row, n, base, edges, apart, ceiling, found):
    _, place, s, _, _ = found
    if s < 0:
        return apart
    first, end = int(edges[s] * (n / base)) + 1, int(edges[s + 1] * (n / base))
    return min(places.at_place(seen[places.PLACE], seen[row], first, end, place), ceiling)


@kernel
def slack_fibers(x, y, n, base, tube, load):
    """:func:`pushing` anywhere along a tube of the source's."""
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

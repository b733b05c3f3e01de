"""Fibers that would have to push, or are slack, of :mod:`freesweep.solver.along.slack`, for a vector of designs; of physical
tubes also the numbers of :mod:`freesweep.solver.along.places`.
"""

from ...jit import kernel
from ..along import places
from ..along.axial import axial_stretch
from ..along.slack import NOTHING, TENSIONLESS, TENSIONLESS_END
from ..cells import nothing_yet, of_length
from ..physics import lagrangian
from ..physics.wall import cannot_push, has_any_family, has_two_families, may_go_slack
from .vector import get, mask_of, put, select, spread


@kernel
def look_along(x, y, n, coarse_x, coarse_y, cell, load, seen, out, first, ready):
    """Masks: where the alpha, and where the beta family would have to push, or is slack, somewhere along half a tube, on its
    finest mesh of n cells. Of physical tubes ``out`` (2, > first + 5, WIDTH) takes the numbers of :mod:`..along.places`
    and their bounds in the lanes that are ``ready``, from the row ``first`` on; ``seen`` (ROWS, > n + 1, WIDTH) is
    scratch.
    """
    return _look_along(x, y, n, coarse_x, coarse_y, cell, load, seen, out, first, ready, load.wall)


@kernel
def _look_along(x, y, n, coarse_x, coarse_y, cell, load, seen, out, first, ready, wall):
    if len(wall) == 1:
        return pushing(x, y, n, cell, load)
    alpha, beta = see(x, y, n, cell, load, seen)
    sharp = summed(seen, n + 2, load)
    see(coarse_x, coarse_y, n // 2, cell, load, seen)
    numbers, bounds = places.together(sharp, summed(seen, n // 2 + 2, load), load)
    for k in range(len(numbers)):
        put(out[0], first + k, select(ready, numbers[k], get(out[0], first + k)))
        put(out[1], first + k, select(ready, bounds[k], get(out[1], first + k)))
    return alpha, beta


@kernel
def pushing(x, y, n, cell, load):
    """The masks of the source's tubes."""
    allowed = -TENSIONLESS * (load.p + abs(load.f))
    alpha, beta = mask_of(0), mask_of(0)
    _, _, constant = lagrangian.uniform_tube(get(y, n), cell, load)
    for j in range(n + 1):
        here = get(y, j)
        s = axial_stretch(here, constant, cell, load)
        tension_alpha, tension_beta = lagrangian.fiber_multipliers(here, s, cell, load)
        alpha, beta = alpha | (tension_alpha < allowed), beta | (tension_beta < allowed)
    return alpha, beta


@kernel
def see(x, y, n, cell, load, seen):
    """Write what :mod:`..along.places` looks at along half a physical tube to the rows of ``seen``; returns the masks."""
    least, at_end = -TENSIONLESS * (load.p + abs(load.f)), -TENSIONLESS_END * (load.p + abs(load.f))
    if cannot_push(load.wall):
        least = at_end = NOTHING + 0.0 * least
    alpha, beta, near = mask_of(0), mask_of(0), nothing_yet(0.0 * least)
    for k in range(n + 2):
        j = min(max(k - 1, 0), n - 1)
        h, rise = get(x, j + 1) - get(x, j), get(y, j + 1) - get(y, j)
        middle, v, place, below = 0.5 * (get(y, j) + get(y, j + 1)), rise / h, 0.5 * (get(x, j) + get(x, j + 1)), least
        if k == 0:
            _, L_y, L_v, _, _, _ = lagrangian.density(middle, v, of_length(cell, h), load)
            of_alpha, of_beta, others = places.at_end(get(y, 0), 0.5 * h * L_y - L_v, cell, load)
            place, below = get(x, 0), at_end
        elif k == n + 1:
            of_alpha, of_beta, others = places.at_end(get(y, n), spread(0.0), cell, load)
            place = get(x, n)
        else:
            of_alpha, of_beta, others, near = places.inside(middle, v, cell, load, near)
        alpha, beta = alpha | (of_alpha < below), beta | (of_beta < below)
        put(seen[places.PLACE], k, place)
        put(seen[places.ALPHA], k, of_alpha - below)
        put(seen[places.BETA], k, of_beta - below)
        put(seen[places.PULL_ALPHA], k, others[0])
        put(seen[places.PULL_BETA], k, others[1])
        put(seen[places.SQUARE], k, others[2])
        put(seen[places.STRAIN], k, others[3])
    if not has_two_families(load.wall):  # what is not there is not slack
        beta = mask_of(0)
    if not has_any_family(load.wall):
        alpha = mask_of(0)
    return alpha, beta


@kernel
def summed(seen, count, load):
    """As :func:`freesweep.solver.along.slack.summed`."""
    x, a, b = seen[places.PLACE], seen[places.ALPHA], seen[places.BETA]
    pull_a, pull_b, squares, strains = (
        seen[places.PULL_ALPHA], seen[places.PULL_BETA], seen[places.SQUARE], seen[places.STRAIN]
    )  # fmt: skip
    faint, loose, last = places.FAINT * (load.p + abs(load.f)), may_go_slack(load.wall), count - 1
    total, zero = get(x, last) - get(x, 0), spread(0.0)
    share_a, doubt_a, share_b, doubt_b = zero, zero, zero, zero
    least_a, least_b = (min(get(pull_a, 0), get(pull_a, last)), zero), (min(get(pull_b, 0), get(pull_b, last)), zero)
    widest, most = (max(get(squares, 0), get(squares, last)), zero), (max(get(strains, 0), get(strains, last)), zero)
    for i in range(last):
        before, beyond = max(i - 1, 0), min(i + 2, last)
        h = (get(x, i + 1) - get(x, i)) / total
        h_before, h_beyond = h, h
        if i > 0:
            h_before = (get(x, i) - get(x, before)) / total
        if i < count - 2:
            h_beyond = (get(x, beyond) - get(x, i + 1)) / total
        part, doubt = places.without_pull(
            get(a, before), get(a, i), get(a, i + 1), get(a, beyond), h_before, h, h_beyond, faint, loose
        )
        share_a, doubt_a = share_a + part, doubt_a + doubt
        part, doubt = places.without_pull(
            get(b, before), get(b, i), get(b, i + 1), get(b, beyond), h_before, h, h_beyond, faint, loose
        )
        share_b, doubt_b = share_b + part, doubt_b + doubt
        if i > 0:
            least_a = places.least(get(pull_a, i - 1), get(pull_a, i), get(pull_a, i + 1), *least_a, loose)
            least_b = places.least(get(pull_b, i - 1), get(pull_b, i), get(pull_b, i + 1), *least_b, loose)
            widest = places.widest(get(squares, i - 1), get(squares, i), get(squares, i + 1), *widest)
            most = places.widest(get(strains, i - 1), get(strains, i), get(strains, i + 1), *most)
    return (share_a, doubt_a, share_b, doubt_b), least_a, least_b, widest, most

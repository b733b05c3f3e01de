"""What a physical tube is like along its length: over which share of it a family is slack, or would have to push, and how
hard, how wide it gets, and how far its wall is stretched.

Looked at are places along the deformed shape: its ends, those of its segments, where what varies jumps or bends, and the
middles of its cells. Between these, what is largest has the parabola through three of them; coarser meshes are asked at
the place that the finest one finds, as the largest of their own may be of a wave that dies out with finer cells. Where a
family pulls at one place and not at the next, its pull ends where it meets zero: on the line between both if fibers may
push; if not, on the line through the two nearest places at which it pulls. What is told of one place is told of vectors of
designs, too.
"""

from math import sqrt

from ...jit import kernel
from ..either import isnt, select
from ..numerics.error_bounds import TINY
from ..numerics.properties_along import at_point
from ..physics import body, lagrangian, over_cell

# shares without a pull, the least pulls [2 pi r0^2 C10], the largest outer radius and stretch of the wall
NUMBERS = SLACK_ALPHA, SLACK_BETA, LEAST_ALPHA, LEAST_BETA, OUTER, STRETCH = range(6)
# rows of what is seen: multipliers less the least that counts as a pull, pulls with their sign turned round, squares of
# outer radius and stretch
ROWS = PLACE, ALPHA, BETA, PULL_ALPHA, PULL_BETA, SQUARE, STRAIN = range(7)
DOUBT = 0.5  # of the way between two places: how far off the end of a pull may be
FAINT = 1e-6  # of the load: less of a pull may be none
CURVED = 0.125  # of a second difference: by how much a smooth curve passes its samples, or the middle of a chord
FALLEN = 1.5  # times what two meshes differ by: what the finer one may be off, if errors fall by less than half
ROUNDING = 1e-12
SAMPLES = 32  # of a wall, along each of its segments


@kernel
def outer_square(y, G_1, cell, wall):
    """Squared radius of the outermost layer of a thick wall, whose undeformed one is inner + a; a membrane is one layer."""
    if len(cell) == 3:
        return y * y + select(wall[1] > 0.0, wall[1] + cell[2] - 1.0, 0.0) / sqrt(1.0 + G_1)
    return cell[3] * cell[3] * (y * y + select(cell[5] > 0.0, cell[5] + cell[2] - 1.0, 0.0) / sqrt(1.0 + G_1))


@kernel
def principal_square(y, G_1, psi, rho_square):
    """Squared largest stretch of the layer of that squared undeformed radius, in radii of the fibers: in its surface it is
    stretched by [[r/rho, r psi], [0, sqrt(G)]], and across it by what keeps the volume.
    """
    r_square = y * y + (rho_square - 1.0) / sqrt(1.0 + G_1)
    hoop, sheared = r_square / rho_square, r_square * psi * psi
    both, apart = 1.0 + G_1 + hoop, 1.0 + G_1 - hoop  # of what is stretched alike all ways the root is of nothing
    widened = both + sheared + sqrt(apart * apart + sheared * (sheared + 2.0 * both))
    return max(0.5 * widened, 1.0 / ((1.0 + G_1) * hoop))


@kernel
def strain_square(y, G_1, psi, cell, wall):
    """Squared largest stretch of a thick wall's first and last layers; a membrane is one layer."""
    if len(cell) == 3:
        inner = wall[1]
    else:
        inner = cell[5]
    first, last = select(inner > 0.0, inner, 1.0), select(inner > 0.0, inner + cell[2], 1.0)
    return max(principal_square(y, G_1, psi, first), principal_square(y, G_1, psi, last))


@kernel
def pulls(alpha, beta, cell, load):
    """Tensions of both families, of the whole circumference [2 pi r0^2 C10], from their multipliers."""
    ta, tb = cell[0] + cell[1], cell[0] - cell[1]
    return load.gamma * alpha * sqrt(1.0 + ta * ta), load.gamma * beta * sqrt(1.0 + tb * tb)


@kernel
def inside(y, v, cell, load, near):
    """In the middle of a cell: ``(multipliers of both families, their tensions, squares of outer radius and stretch, what is
    handed on)``.
    """
    at, near = over_cell.look(y, v, cell, load, near)
    square, alpha, beta = body.of_multipliers(cell, outer_square(y, at.G_1, cell, load.wall), at.a, at.b)
    strain = strain_square(y, at.G_1, at.psi, cell, load.wall)
    return alpha, beta, (*pulls(alpha, beta, cell, load), square, strain), near


@kernel
def at_end(y, flux, cell, load):
    """The same at an end, where the flux is known; a plane of symmetry has none."""
    psi, G_1, alpha, beta = lagrangian.at_flux(y, flux, cell, load)
    squares = outer_square(y, G_1, cell, load.wall), strain_square(y, G_1, psi, cell, load.wall)
    return alpha, beta, (*pulls(alpha, beta, cell, load), *squares)


@kernel
def without_pull(before, here, there, beyond, h_before, h, h_beyond, faint, loose):
    """``(length without a pull between two places a distance h apart, how much of it is in doubt)``, from multipliers less
    the least pull there and at the places before and beyond.
    """
    none_here, none_there, zero = here < 0.0, there < 0.0, 0.0 * here
    ends, begins = isnt(none_here) & none_there, none_here & isnt(none_there)
    pull, push = select(ends, here, there), -select(ends, there, here)
    if loose:
        rise = select(ends, (before - here) / h_before, (beyond - there) / h_beyond)
        left = select(rise > 0.0, pull / max(rise, TINY), h)
    else:
        rise = 1.0 + zero
        left = h * pull / max(pull + push, TINY)
    part = select(none_here & none_there, h + zero, select(ends | begins, h - min(left, h), zero))
    doubt = select(rise > 0.0, DOUBT * h, h + zero)
    unsure = isnt(none_here | none_there) & (max(here, there) < faint)
    return part, select(ends | begins, doubt, select(unsure, h + zero, zero))


@kernel
def bent(row, j, first, last):
    """Second difference of a row at place j, or at the next one that has two neighbours from ``first`` to ``last``."""
    j = min(max(j, first + 1), last - 1)
    return row[j - 1] - 2.0 * row[j] + row[j + 1]


@kernel
def parabola(x, row, k):
    """``(slope, bend)``, at place k, of the parabola through it and its neighbours: row + slope t - bend t^2 / 2."""
    before, behind = x[k] - x[k - 1], x[k + 1] - x[k]
    rise, fall = (row[k] - row[k - 1]) / before, (row[k + 1] - row[k]) / behind
    return (rise * behind + fall * before) / (before + behind), 2.0 * (rise - fall) / (before + behind)


@kernel
def top_beside(x, row, j, first, last):
    """``(place, number)`` of the top of the parabola through a place and its neighbours, at an end of the segment through
    the three next to it, if that is in the segment and higher than what is there.
    """
    k = min(max(j, first + 1), last - 1)
    slope, bend = parabola(x, row, k)
    if not bend > 0.0:
        return x[j], row[j]
    end = 0.5 * (x[k] - x[k - 1] if j < k else x[k + 1] - x[k])  # from the middle of a cell to the segment's end
    top = slope / bend
    number = row[k] + 0.5 * slope * top
    if x[first] - end <= x[k] + top <= x[last] + end and number > row[j]:
        return x[k] + top, number
    return x[j], row[j]


@kernel
def at_place(x, row, first, last, place):
    """What a row has at a place of the segment from ``first`` to ``last``, by the parabola through the next three places."""
    k = first + 1
    while k < last - 1 and place > 0.5 * (x[k] + x[k + 1]):
        k += 1
    slope, bend = parabola(x, row, k)
    t = place - x[k]
    return row[k] + t * (slope - 0.5 * bend * t)


@kernel
def missing(row, j, first, last):
    """What a curve may pass the parabola by, at the largest of its samples: as its bend changes about there, at a corner
    between two samples by all of it; at most half the largest second difference.
    """
    a, b, c, d, e = (
        bent(row, j - 2, first, last), bent(row, j - 1, first, last), bent(row, j, first, last),
        bent(row, j + 1, first, last), bent(row, j + 2, first, last),
    )  # fmt: skip
    change = max(max(abs(b - a), abs(c - b)), max(abs(d - c), abs(e - d)))
    return min(change, 0.5 * max(max(abs(a), abs(b)), max(max(abs(c), abs(d)), abs(e))))


@kernel
def highest(x, row, first, last, segment, ceiling, found):
    """``(number, place, segment, by how much it may be missed, what it may be at most)`` of the largest that was ``found``
    with a row of places ``first`` to ``last`` more, of one segment; never above the ``ceiling``, which is reached where
    the row has it.
    """
    best, at, where, missed, most = found
    for j in range(first, last + 1):
        if row[j] >= row[max(j - 1, first)] and row[j] >= row[min(j + 1, last)]:
            met = row[j] >= ceiling
            place, number = top_beside(x, row, j, first, last)
            top, doubt = min(number, ceiling), 0.0 if met else missing(row, j, first, last)
            if top > best:
                best, at, where, missed = top, place, segment, doubt
            # a cell's middle is that of a chord, below what an end of a segment is compared with; two meshes mend that
            chord = 0.0 if met else CURVED * abs(bent(row, j, first, last))
            most = max(most, min(top + doubt + chord, ceiling))
    return best, at, where, missed, most


@kernel
def differ(one, two, three):
    """By what the two finest of three meshes differ; the difference before it, of which errors of second order leave a
    quarter, guards against its passing through zero.
    """
    return max(abs(one - two), 0.25 * abs(two - three))


@kernel
def root(one, two, three, missed):
    """``(value, bound)`` of the root of a largest square, from three meshes, the finest first, which may miss so much."""
    a, b, c = sqrt(one), sqrt(two), sqrt(three)
    return (4.0 * a - b) / 3.0, FALLEN * differ(a, b, c) + 0.5 * missed / a + ROUNDING * a


@kernel
def lowest(one, two, three, missed, size):
    """The same of a least pull, told with its sign turned, where the load is ``size``."""
    return (two - 4.0 * one) / 3.0, FALLEN * differ(one, two, three) + missed + ROUNDING * size


@kernel
def together(shares, largest, missed, load):
    """``(numbers, bounds)`` from three meshes, the finest first: ``(alpha, its doubt, beta, its doubt)`` of the shares, and
    what is largest of pulls, their sign turned, and of squares, as it may be ``missed`` by the finest.
    """
    size, one, two, three = load.p + abs(load.f), shares[0], shares[1], shares[2]
    first, second, third = largest
    pull_a, bound_a = lowest(first[0], second[0], third[0], missed[0], size)
    pull_b, bound_b = lowest(first[1], second[1], third[1], missed[1], size)
    outer, apart = root(first[2], second[2], third[2], missed[2])
    stretch, strained = root(first[3], second[3], third[3], missed[3])
    return (
        (one[0], one[2], pull_a, pull_b, outer, stretch),
        (
            one[1] + FALLEN * differ(one[0], two[0], three[0]) + ROUNDING * one[0],
            one[3] + FALLEN * differ(one[2], two[2], three[2]) + ROUNDING * one[2],
            bound_a, bound_b, apart, strained,
        ),
    )  # fmt: skip


@kernel
def square_at(course, segment, k, wall):
    """Outer radius squared of the undeformed tube at one of the SAMPLES along a segment."""
    return outer_square(1.0, 0.0, at_point(course, segment, k / SAMPLES), wall)


@kernel
def rest(course, wall, numbers, bounds):
    """The numbers of the undeformed tube: nothing pulls, and nothing is slack."""
    if len(wall) == 1:
        return
    most, missed = 0.0, 0.0
    for segment in range(course.shape[0]):
        for k in range(SAMPLES + 1):
            inner = min(max(k, 1), SAMPLES - 1)  # a curve bends at its ends as beside them
            before, middle, after = (
                square_at(course, segment, inner - 1, wall), square_at(course, segment, inner, wall),
                square_at(course, segment, inner + 1, wall),
            )  # fmt: skip
            here = square_at(course, segment, k, wall)
            if here > most:
                most, missed = here, CURVED * abs(before - 2.0 * middle + after)
    for k in range(len(numbers)):
        numbers[k], bounds[k] = (sqrt(most), 0.5 * missed / sqrt(most)) if k == OUTER else (0.0, 0.0)
    if len(numbers) > STRETCH:
        numbers[STRETCH] = 1.0

"""What a physical tube is like along its length: over which share of it a family is slack, or would have to push, and how
wide it gets.

Looked at are places along the deformed shape: its ends, and the middles of its cells. Where a family pulls at one place and
not at the next, its pull ends where it meets zero: on the line between both if fibers may push; if not, on the line through
the two nearest places at which it pulls. One body for floats and for vectors of designs.
"""

from math import sqrt

from ...jit import kernel
from ..either import isnt, select
from ..numerics.properties_along import at_point
from ..physics import body, lagrangian, over_cell

NUMBERS = SLACK_ALPHA, SLACK_BETA, OUTER = range(3)  # shares without a pull, and the largest outer radius
PLACE, ALPHA, BETA, SQUARE = range(4)  # rows of what is seen: multipliers less the least pull, outer radius squared
DOUBT = 0.5  # of the way between two places: how far off the end of a pull may be
FAINT = 1e-6  # of the load: less of a pull may be none
CURVED = 0.125  # of a second difference: by how much a curve passes the largest of its samples
FALLEN = 1.1  # times what two meshes differ by: what the finer one's extrapolation may be off, if errors fall by half
ROUNDING = 1e-12
SAMPLES = 32  # of a wall, along each of its segments
SMALLEST = 1e-30


@kernel
def outer_square(y, G_1, cell, wall):
    """Squared radius of the outermost layer of a thick wall, whose undeformed one is inner + a; a membrane is one layer."""
    if len(cell) == 3:
        return y * y + select(wall[1] > 0.0, wall[1] + cell[2] - 1.0, 0.0) / sqrt(1.0 + G_1)
    return cell[3] * cell[3] * (y * y + select(cell[5] > 0.0, cell[5] + cell[2] - 1.0, 0.0) / sqrt(1.0 + G_1))


@kernel
def inside(y, v, cell, load, near):
    """In the middle of a cell: ``(multipliers of both families, outer radius squared, what is handed on)``."""
    at, near = over_cell.look(y, v, cell, load, near)
    square, alpha, beta = body.of_multipliers(cell, outer_square(y, at.G_1, cell, load.wall), at.a, at.b)
    return alpha, beta, square, near


@kernel
def at_end(y, flux, cell, load):
    """The same at an end, where the flux is known; a plane of symmetry has none."""
    _, G_1, alpha, beta = lagrangian.at_flux(y, flux, cell, load)
    return alpha, beta, outer_square(y, G_1, cell, load.wall)


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
        left = select(rise > 0.0, pull / max(rise, SMALLEST), h)
    else:
        rise = 1.0 + zero
        left = h * pull / max(pull + push, SMALLEST)
    part = select(none_here & none_there, h + zero, select(ends | begins, h - min(left, h), zero))
    doubt = select(rise > 0.0, DOUBT * h, h + zero)
    unsure = isnt(none_here | none_there) & (max(here, there) < faint)
    return part, select(ends | begins, doubt, select(unsure, h + zero, zero))


@kernel
def widest(before, here, there, most, missed):
    """``(most, missed)`` with one more place between two others: the largest square so far, and what lies above it."""
    wider = here > most
    curved = CURVED * abs(before - 2.0 * here + there)
    return select(wider, here, most), select(wider, curved, missed)


@kernel
def together(fine, coarse):
    """``(numbers, bounds)`` from those of two meshes, each ``(alpha, its doubt, beta, its doubt, most, missed)``."""
    outer, other = sqrt(fine[4]), sqrt(coarse[4])
    return (
        (fine[0], fine[2], (4.0 * outer - other) / 3.0),
        (
            fine[1] + abs(fine[0] - coarse[0]) + ROUNDING * fine[0],
            fine[3] + abs(fine[2] - coarse[2]) + ROUNDING * fine[2],
            FALLEN * abs(outer - other) + 0.5 * fine[5] / outer + ROUNDING * outer,
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

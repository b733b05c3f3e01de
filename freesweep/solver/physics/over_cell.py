"""The density of a cell of a mesh: its mean along the cell, where loose fibers make it bend.

A midpoint stands for a cell as long as the density is smooth there. Where the active set of loose fibers changes, L is only
C1, and between two families that hold one after the other lies a stretch as narrow as one likes in which both do: L_y all
but jumps. Along a cell y is linear, so the mean of L over it is::

    L(y, v) = 1/h integral of L(y + r v, v) dr,   r from -h/2 to h/2

by Gauss's two points on each part of the cell in which the same families are taut: L is smooth there. r is the share of L_v
that moves the place. It is one more functional, with all its derivatives, so Newton's method and the nested meshes take it
as they take others.

A family's pull, or how much it lacks of being taut, ends on the line through the two nearest places that are of one kind. An
error there is of second order in the cell's length, and counts by its square.

``cell`` is that of :mod:`lagrangian` with the length h of the cell behind, and what the cell before handed on, where fibers
are looked for first; these functions hand on, last, what the next one may have. A body's radius and its slope are those of
the cell's middle.
"""

from typing import NamedTuple

from ...jit import kernel
from ..cells import MIXED, point_of
from ..either import select, some
from . import body, in_a_cell, physical
from .fibers import is_taut, lacking
from .wall import may_go_slack

GAUSS = 0.28867513459481287  # of a cell: the two points lie so far from its middle
SMALLEST = 1e-300


class Cell(NamedTuple):
    """A cell of a mesh: stretch in its middle, slope, the tube's point there, length, load, and its change."""

    y: float
    v: float
    point: tuple
    h: float
    load: tuple
    direction: tuple


@kernel
def plus(total, weight, part):
    """Five sums, with one part more."""
    return (
        total[0] + weight * part[0],
        total[1] + weight * part[1],
        total[2] + weight * part[2],
        total[3] + weight * part[3],
        total[4] + weight * part[4],
    )


@kernel
def chosen(where, yes, no):
    """Five numbers of one kind or the other."""
    return (
        select(where, yes[0], no[0]),
        select(where, yes[1], no[1]),
        select(where, yes[2], no[2]),
        select(where, yes[3], no[3]),
        select(where, yes[4], no[4]),
    )


@kernel
def parts_of(cell):
    """``(the cell as a point, its length, what the cell before handed on)``."""
    if len(cell) == 5:
        return point_of(cell), cell[3], cell[4]
    return point_of(cell), cell[6], cell[7]


@kernel
def look(y, v, point, load, near):
    """``(State, what is handed on)`` of the tube that is there."""
    tube, w, own = body.as_tube(y, v, point, load)
    at = physical.state(y, w, tube, own, near)
    return at, physical.handed_on(at, y, w, own)


@kernel
def pulls(at, y, point, load):
    """Of both families: the multiplier, or, negative, how much G - 1 lacks of making the threads taut."""
    alpha, beta = is_taut(at.kind)
    short_alpha, short_beta = lacking(y, at.G_1, at.psi, point[0], point[1], load.gamma * load.gamma, load.wall)
    return select(alpha, at.a, -short_alpha), select(beta, at.b, -short_beta)


@kernel
def line(r, at, s, by):
    """Where the line through ``at`` in r and ``by`` in s, of one sign, meets zero."""
    rise = by - at
    return r - at * (s - r) / select(abs(rise) > SMALLEST, rise, SMALLEST)


@kernel
def between(first, middle, last, left, right):
    """Where a pull ends or begins between ``left`` and ``right``, from what it is there and in the ``middle``, 0."""
    zero = 0.0 * left
    early = middle * last > 0.0
    at = select(early, line(zero, middle, right, last), line(left, first, zero, middle))
    return min(max(at, select(early, left, zero)), select(early, zero, right))


@kernel
def beyond(first, last, left, right, h):
    """``(where, whether)`` a pull ends or begins outside of ``left`` and ``right``, which are of one kind."""
    at = line(left, first, right, last)
    return at, (first * last > 0.0) & (abs(at) < 0.5 * h)


@kernel
def along_the_cell(part, y, v, cell, load, direction):
    """``(least room, the mean of part's five numbers, its kind, which is MIXED where it changes, what is handed on)``.

    ``part(State, y, v, r, point, load, direction)`` is of the place r from the middle, as the cell has it.
    """
    point, h, before = parts_of(cell)
    zero = 0.0 * y
    if not may_go_slack(load.wall):
        at, near = look(y, v, point, load, before)
        return at.room, part(at, y, v, 0.0, point, load, direction), at.kind, near
    right = GAUSS * h
    left = -right
    one, near = look(y + left * v, v, point, load, before)
    two, last = look(y + right * v, v, point, load, near)
    nothing = (zero, zero, zero, zero, zero)
    whole = plus(nothing, 0.5, part(one, y + left * v, v, left, point, load, direction))
    whole = plus(whole, 0.5, part(two, y + right * v, v, right, point, load, direction))
    room = min(one.room, two.room)
    alpha, beta = pulls(one, y + left * v, point, load)
    alpha_last, beta_last = pulls(two, y + right * v, point, load)
    at_alpha, ends_alpha = beyond(alpha, alpha_last, left, right, h)
    at_beta, ends_beta = beyond(beta, beta_last, left, right, h)
    apart_alpha, apart_beta = alpha * alpha_last <= 0.0, beta * beta_last <= 0.0
    if some(apart_alpha | apart_beta):
        here, _ = look(y, v, point, load, near)
        alpha_here, beta_here = pulls(here, y, point, load)
        at_alpha = select(apart_alpha, between(alpha, alpha_here, alpha_last, left, right), at_alpha)
        at_beta = select(apart_beta, between(beta, beta_here, beta_last, left, right), at_beta)
    ends_alpha, ends_beta = ends_alpha | apart_alpha, ends_beta | apart_beta
    changes = ends_alpha | ends_beta
    if some(changes):
        low = select(ends_alpha, at_alpha, select(ends_beta, at_beta, zero))  # others in a vector just go along
        high = select(ends_beta, at_beta, low)
        low, high = min(low, high), max(low, high)
        own = Cell(y, v, point, h, load, direction)
        total, least = of_part(part, -0.5 * h, low, nothing, room, own, near)
        if some(changes & (high > low)):
            total, least = of_part(part, low, high, total, least, own, near)
        total, least = of_part(part, high, 0.5 * h, total, least, own, last)
        whole, room = chosen(changes, total, whole), select(changes, least, room)
    return room, whole, select(changes, MIXED, one.kind), last


@kernel
def of_part(part, begin, end, total, room, cell, near):
    """Five sums and the least room with the part of the cell from ``begin`` to ``end``."""
    y, v, point, h, load, direction = cell
    half, middle = GAUSS * (end - begin), 0.5 * (begin + end)
    weight = 0.5 * (end - begin) / h
    for k in range(2):
        r = middle + (2.0 * k - 1.0) * half
        here, near = look(y + r * v, v, point, load, near)
        total = plus(total, weight, part(here, y + r * v, v, r, point, load, direction))
        room = min(room, here.room)
    return total, room


@kernel
def density(y, v, cell, load):
    """``(room, L_y, L_v, L_yy, L_yv, L_vv, what is handed on)``: room is the least along the cell."""
    room, partials, _, near = along_the_cell(in_a_cell.partials_at, y, v, cell, load, load)
    return (room, *partials, near)


@kernel
def integrands(y, v, cell, load):
    """Axial length, volume, twist, strain energy; the kind of the cell; and what is handed on."""
    _, (s, volume, twist, energy, _), kind, near = along_the_cell(in_a_cell.integrands_at, y, v, cell, load, load)
    return s, volume, twist, energy, kind, near


@kernel
def conjugate(y, v, cell, load, direction):
    """``(c, c_y, c_v, c_mu)`` of :func:`physical.conjugate`."""
    _, (c, c_y, c_v, c_mu, _), _, _ = along_the_cell(in_a_cell.conjugate_at, y, v, cell, load, direction)
    return c, c_y, c_v, c_mu

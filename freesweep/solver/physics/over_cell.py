"""The density of a cell of a mesh: its mean along the cell, where loose fibers make it bend.

A midpoint stands for a cell as long as the density is smooth there. Where the active set of loose fibers changes, L is only
C1, and between two families that hold one after the other lies a stretch as narrow as one likes in which both do: L_y all
but jumps. Along a cell y is linear, so the mean of L over it is::

    L(y, v) = 1/h integral of L(y + r v, v) dr,   r from -h/2 to h/2

by Simpson's rule, on four panels where its three points are not of one kind; r is the share of L_v that moves the place. It
is one more functional, with all its derivatives, so Newton's method and the nested meshes take it as they take others.

``cell`` is that of :mod:`lagrangian` with the length h of the cell behind, and what the cell before handed on, where fibers
are looked for first; these functions hand on, last, what the next one may have. A body's radius and its slope are those of
the cell's middle.
"""

from ...jit import kernel
from ..cells import point_of
from ..either import select, some
from . import body, in_a_cell, physical
from .wall import may_go_slack

EIGHTHS = 8  # of a cell lie between the points of the finer rule
MIXED = 4.0  # beside the kinds of :mod:`relaxed`


@kernel
def along_cell(k, h):
    """``(place from the middle, weight in 24ths)`` of point k of the finer rule, from 0 to EIGHTHS."""
    return h * (k / EIGHTHS - 0.5), 4.0 if k % 2 == 1 else 2.0


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
def mean(changes, ends, middle, between):
    """Simpson's rule, on four panels where the kind ``changes``: the points ``between`` are weighted already."""
    sixth, part = 1.0 / 6.0, 1.0 / 24.0
    coarse = plus(ends, 4.0, middle)
    fine = plus(plus(ends, 2.0, middle), 1.0, between)
    return (
        select(changes, part * fine[0], sixth * coarse[0]),
        select(changes, part * fine[1], sixth * coarse[1]),
        select(changes, part * fine[2], sixth * coarse[2]),
        select(changes, part * fine[3], sixth * coarse[3]),
        select(changes, part * fine[4], sixth * coarse[4]),
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
def along_the_cell(part, y, v, cell, load, direction):
    """``(least room, the mean of part's five numbers, its kind, which is MIXED where it changes, what is handed on)``.

    ``part(State, y, v, r, point, load, direction)`` is of the place r from the middle, as the cell has it.
    """
    point, h, before = parts_of(cell)
    at, near = look(y, v, point, load, before)
    middle, zero = part(at, y, v, 0.0, point, load, direction), 0.0 * y
    if not may_go_slack(load.wall):
        return at.room, middle, at.kind, near
    room, ends, between, changes = at.room, (zero, zero, zero, zero, zero), (zero, zero, zero, zero, zero), y > y
    for k in range(0, EIGHTHS + 1, EIGHTHS):
        r, _ = along_cell(k, h)
        here, _ = look(y + r * v, v, point, load, near)
        ends = plus(ends, 1.0, part(here, y + r * v, v, r, point, load, direction))
        room, changes = min(room, here.room), changes | (abs(here.kind - at.kind) > 0.5)
    if some(changes):
        last, least = near, room
        for k in range(1, EIGHTHS):
            if 2 * k == EIGHTHS:
                continue
            r, weight = along_cell(k, h)
            here, last = look(y + r * v, v, point, load, last)
            between = plus(between, weight, part(here, y + r * v, v, r, point, load, direction))
            least = min(least, here.room)
        room = select(changes, least, room)
    return room, mean(changes, ends, middle, between), select(changes, MIXED, at.kind), near


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

"""The density of a cell of a mesh: its mean along the cell, where loose fibers make it bend.

A midpoint stands for a cell as long as the density is smooth there. Where the active set of loose fibers changes, L is only
C1, and between two families that hold one after the other lies a stretch as narrow as one likes in which both do: L_y all
but jumps. Along a cell y is linear, so the mean of L over it is::

    L(y, v) = 1/2 integral of L(y + r v, v) dr/(h/2),   r from -h/2 to h/2

by Simpson's rule, on PANELS panels where its three points are not of one kind; r is the share of L_v that moves the place.
It is one more functional, with all its derivatives, so Newton's method and the nested meshes take it as they take others.

``cell`` is that of :mod:`lagrangian` with the length h of the cell behind; a body's radius and its slope are those of the
cell's middle.
"""

from ..jit import kernel
from . import body
from .either import select, some

HUGE = 1e300
PANELS = 4  # of a cell in which the kind changes
MIXED = 4.0  # beside the kinds of :mod:`physical`


@kernel
def point_of(cell):
    """The cell's numbers without its length; and half of that."""
    if len(cell) == 4:
        return (cell[0], cell[1], cell[2]), 0.5 * cell[3]
    return (cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]), 0.5 * cell[6]


@kernel
def weight(k, panels):
    """Share of point k of Simpson's rule."""
    return (1.0 if k == 0 or k == 2 * panels else 4.0 if k % 2 == 1 else 2.0) / (6.0 * panels)


@kernel
def density(y, v, cell, load):
    """``(room, L_y, L_v, L_yy, L_yv, L_vv)``: room is the least along the cell."""
    point, half = point_of(cell)
    if not load[2][2] > 0.0:
        return body.partials(y, v, point, load)[:6]
    coarse, changes, panels = (y, y, y, y, y, y), y > y, 1
    while True:
        room, L_y, L_v = HUGE + 0.0 * y, 0.0 * y, 0.0 * y
        L_yy, L_yv, L_vv, before = 0.0 * y, 0.0 * y, 0.0 * y, -1.0 + 0.0 * y
        for k in range(2 * panels + 1):
            part, r = weight(k, panels), half * (k / panels - 1.0)
            space, by_y, by_v, by_yy, by_yv, by_vv, kind = body.partials(y + r * v, v, point, load)
            room = min(room, space)
            L_y += part * by_y
            L_v += part * (by_v + r * by_y)
            L_yy += part * by_yy
            L_yv += part * (by_yv + r * by_yy)
            L_vv += part * (by_vv + 2.0 * r * by_yv + r * r * by_yy)
            if panels == 1 and k > 0:
                changes = changes | (abs(kind - before) > 0.5)
            before = kind
        if panels > 1:
            break
        coarse = room, L_y, L_v, L_yy, L_yv, L_vv
        if not some(changes):
            return coarse
        panels = PANELS
    return (
        select(changes, room, coarse[0]), select(changes, L_y, coarse[1]), select(changes, L_v, coarse[2]),
        select(changes, L_yy, coarse[3]), select(changes, L_yv, coarse[4]), select(changes, L_vv, coarse[5]),
    )  # fmt: skip


@kernel
def integrands(y, v, cell, load):
    """Axial length, volume, twist, strain energy; and the kind of the cell, which is MIXED where it changes in it."""
    point, half = point_of(cell)
    coarse, changes, panels = body.integrands(y, v, point, load), y > y, 1
    if not load[2][2] > 0.0:
        return coarse
    middle = coarse[4]
    while True:
        s, volume, twist, energy = 0.0 * y, 0.0 * y, 0.0 * y, 0.0 * y
        for k in range(2 * panels + 1):
            part, r = weight(k, panels), half * (k / panels - 1.0)
            s_here, volume_here, twist_here, energy_here, kind = body.integrands(y + r * v, v, point, load)
            s += part * s_here
            volume += part * volume_here
            twist += part * twist_here
            energy += part * energy_here
            changes = changes | (abs(kind - middle) > 0.5)
        if panels > 1:
            break
        coarse = s, volume, twist, energy, middle
        if not some(changes):
            return coarse
        panels = PANELS
    return (
        select(changes, s, coarse[0]), select(changes, volume, coarse[1]), select(changes, twist, coarse[2]),
        select(changes, energy, coarse[3]), select(changes, MIXED, middle),
    )  # fmt: skip


@kernel
def conjugate(y, v, cell, load, direction):
    """``(c, c_y, c_v, c_mu)`` of :func:`physical.conjugate`."""
    point, half = point_of(cell)
    panels = 1
    if not load[2][2] > 0.0:
        return body.conjugate(y, v, point, load, direction)
    middle = body.integrands(y, v, point, load)[4]
    for k in range(2):
        kind = body.integrands(y + (2.0 * k - 1.0) * half * v, v, point, load)[4]
        if kind != middle:
            panels = PANELS
    c, c_y, c_v, c_mu = 0.0, 0.0, 0.0, 0.0
    for k in range(2 * panels + 1):
        part, r = weight(k, panels), half * (k / panels - 1.0)
        here, by_y, by_v, by_mu = body.conjugate(y + r * v, v, point, load, direction)
        c += part * here
        c_y += part * by_y
        c_v += part * (by_v + r * by_y)
        c_mu += part * by_mu
    return c, c_y, c_v, c_mu

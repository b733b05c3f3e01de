"""What a cell of a mesh hands to the density: the point of the tube on it, and, where the density asks for them, the cell's
length and what the cell before it handed on. To the numerics it is a tuple that they pass through.

Three numbers are a point of a tube of one radius, six of a body of revolution; behind them may follow the length (4, 7), and
behind that what was handed on (5, 8). Which it is stands in the tuple's length, known when kernels are compiled.
"""

from ..jit import kernel

MIXED = 4.0  # the kind of a cell in which the kind changes; others are those of :mod:`.physics.fibers`


@kernel
def cell_at(cells, j):
    """What varies along the tube, in cell j: a row of three numbers, of a body two such rows; a single one holds for all."""
    k = min(j, len(cells) - 1)
    if cells.ndim == 2:
        return cells[k, 0], cells[k, 1], cells[k, 2]
    return cells[k, 0, 0], cells[k, 0, 1], cells[k, 0, 2], cells[k, 1, 0], cells[k, 1, 1], cells[k, 1, 2]


@kernel
def point_of(cell):
    """The point of the tube that a cell stands for."""
    if len(cell) > 5:
        return cell[0], cell[1], cell[2], cell[3], cell[4], cell[5]
    return cell[0], cell[1], cell[2]


@kernel
def of_length(cell, h):
    """The cell, with its length behind."""
    if len(cell) == 3:
        return cell[0], cell[1], cell[2], h
    return cell[0], cell[1], cell[2], cell[3], cell[4], cell[5], h


@kernel
def rise(y, v, cell):
    """dr/dx of the deformed meridian."""
    if len(cell) == 3:
        return v
    return cell[4] * y + cell[3] * v


@kernel
def level(y, cell):
    """``(v, radius)``: the slope v at which the deformed meridian runs along the axis; dr/dx grows by the radius times v."""
    if len(cell) == 3:
        return 0.0, 1.0
    return -cell[4] * y / cell[3], cell[3]


@kernel
def behind(cell, h, near):
    """The cell, with its length and what the cell before it handed on."""
    if len(cell) == 3:
        return cell[0], cell[1], cell[2], h, near
    return cell[0], cell[1], cell[2], cell[3], cell[4], cell[5], h, near


@kernel
def nothing_yet(zero):
    """What is handed on to a first cell: what the numbers mean is the density's own affair, the first is not negative."""
    return zero - 1.0, zero, zero, zero, zero, zero, zero, zero, zero


@kernel
def expecting(y, cell):
    """A cell with its length behind, to which nothing may have been handed on, as one to which something was."""
    if len(cell) == 4:
        return (*cell, nothing_yet(0.0 * y))
    if len(cell) == 7:
        return (*cell, nothing_yet(0.0 * y))
    return cell


@kernel
def as_expected(cell, answer):
    """An answer whose last entry is handed on, as ``cell`` expects it: with that entry or without."""
    if len(cell) == 4:
        return answer[:-1]
    if len(cell) == 7:
        return answer[:-1]
    return answer


@kernel
def passed_on(cell, answer):
    """An answer with nothing of its own to hand on, as ``cell`` expects it: what was handed to it goes on."""
    if len(cell) == 5:
        return (*answer, cell[4])
    if len(cell) == 8:
        return (*answer, cell[7])
    return answer


@kernel
def largest_sizes(cells):
    """The largest sizes of what varies along the tube."""
    one = cell_at(cells, 0)
    a, b, c = abs(one[0]), abs(one[1]), abs(one[2])
    for j in range(1, len(cells)):
        one = cell_at(cells, j)
        a, b, c = max(a, abs(one[0])), max(b, abs(one[1])), max(c, abs(one[2]))
    return a, b, c

"""What varies along a tube: three numbers per cell, from cubics over equal pieces of each segment.

``course`` is (segments, pieces, 3, 4): coefficients of 1, t, t^2, t^3 with t from 0 to 1 in each piece. A segment ends
where a number jumps or bends; ``edges`` holds the nodes of the base mesh at which segments begin and end, (segments + 1).
A tube that is the same all along has one segment of one piece, and one row of cells.

A body of revolution (:mod:`..physics.body`) has two rows of three numbers, its course an axis more, (segments, pieces,
2, 3, 4), as have its cells. How many axes an array has is known when code is made: none is for the other kind.
"""

from typing import NamedTuple

import numpy as np

from ...jit import kernel

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)  # exact for the square of a cubic
GAUSS_POINTS, GAUSS_WEIGHTS = 0.5 + 0.5 * _POINTS, 0.5 * _WEIGHTS


class Tube(NamedTuple):
    """What varies along a tube, and where: its course and the nodes of the base mesh at its edges; room for the cells of a
    mesh; whether only half of it is solved, whose last node is a plane of symmetry; the node of the base mesh in the
    middle of the whole tube; and where segments begin and end along what is solved.
    """

    course: np.ndarray
    edges: np.ndarray
    cells: np.ndarray
    half: bool
    middle: int
    places: np.ndarray


@kernel
def make_cells(course, count):
    """Room for the cells of a mesh."""
    if course.ndim == 4:
        return np.zeros((count, 3))
    return np.zeros((count, 2, 3))


@kernel
def of_problems(course):
    """A course that :func:`seat` writes to, where there is none."""
    if course.ndim == 4:
        return np.zeros((1, 1, 3, 4))
    return course


@kernel
def seat(course, problem):
    """Write what a tube that is the same all along has: H, D and the section."""
    if course.ndim == 4:
        for k in range(3):
            course[0, 0, k, 0] = problem[k]


@kernel
def cubic(a, t):
    """The polynomial of rising powers."""
    return a[0] + t * (a[1] + t * (a[2] + t * a[3]))


@kernel
def write(course, segment, piece, t, cells, j):
    """Write row ``j`` of cells."""
    if course.ndim == 4:
        for k in range(3):
            cells[j, k] = cubic(course[segment, piece, k], t)
    else:
        for row in range(2):
            for k in range(3):
                cells[j, row, k] = cubic(course[segment, piece, row, k], t)


@kernel
def fill(course, edges, x, n, base, cells):
    """The rows of ``cells`` of a mesh of n cells, nested in a base mesh of ``base`` cells: one for each cell, or one."""
    segments, pieces = course.shape[0], course.shape[1]
    if segments == 1 and pieces == 1:
        write(course, 0, 0, 0.0, cells, 0)
        return cells[:1]
    factor = n / base  # a half, or a power of two
    for s in range(segments):
        first, last = int(edges[s] * factor), int(edges[s + 1] * factor)
        per_length = pieces / (x[last] - x[first])
        for j in range(first, last):
            at = (0.5 * (x[j] + x[j + 1]) - x[first]) * per_length
            piece = min(int(at), pieces - 1)
            write(course, s, piece, at - piece, cells, j)
    return cells[:n]


@kernel
def at_point(course, segment, share):
    """The numbers at a ``share`` (0 to 1) of one segment: three, of a body six."""
    pieces = course.shape[1]
    at = share * pieces
    piece = min(max(int(at), 0), pieces - 1)
    t = at - piece
    if course.ndim == 4:
        a, b, c = course[segment, piece, 0], course[segment, piece, 1], course[segment, piece, 2]
        return cubic(a, t), cubic(b, t), cubic(c, t)
    a, b = course[segment, piece, 0], course[segment, piece, 1]
    return cubic(a[0], t), cubic(a[1], t), cubic(a[2], t), cubic(b[0], t), cubic(b[1], t), cubic(b[2], t)


@kernel
def turns(course):
    """Whether a tube rotates somewhere: not where alpha = -beta all along."""
    for s in range(course.shape[0]):
        for piece in range(course.shape[1]):
            for power in range(4):
                if first_number(course, s, piece, power) != 0.0:
                    return True
    return False


@kernel
def first_number(course, segment, piece, power):
    """A coefficient of H."""
    if course.ndim == 4:
        return course[segment, piece, 0, power]
    return course[segment, piece, 0, 0, power]


@kernel
def volume(course, places):
    """Undeformed volume inside the fiber surface, over pi times the reference radius cubed."""
    total = places[len(places) - 1]
    if course.ndim == 5:
        total = 0.0
        pieces = course.shape[1]
        for s in range(course.shape[0]):
            for piece in range(pieces):
                for k in range(4):
                    R = cubic(course[s, piece, 1, 0], GAUSS_POINTS[k])
                    total += GAUSS_WEIGHTS[k] * R * R * (places[s + 1] - places[s]) / pieces
    return total

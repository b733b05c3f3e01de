"""What varies along the tube: three numbers per cell, from cubics over equal pieces of each segment.

``course`` is (segments, pieces, 3, 4): coefficients of 1, t, t^2, t^3 with t from 0 to 1 in each piece. A segment ends
where a number jumps or bends; ``edges`` holds the nodes of the base mesh at which segments begin and end, (segments + 1).
A tube that is the same all along has one segment of one piece, and one row of cells.
"""

from ..jit import kernel


@kernel
def fill(course, edges, x, n, base, cells):
    """The rows of ``cells`` of a mesh of n cells, nested in a base mesh of ``base`` cells: one for each cell, or one."""
    segments, pieces = course.shape[0], course.shape[1]
    if segments == 1 and pieces == 1:
        for k in range(3):
            cells[0, k] = course[0, 0, k, 0]
        return cells[:1]
    factor = n / base  # a half, or a power of two
    for s in range(segments):
        first, last = int(edges[s] * factor), int(edges[s + 1] * factor)
        per_length = pieces / (x[last] - x[first])
        for j in range(first, last):
            at = (0.5 * (x[j] + x[j + 1]) - x[first]) * per_length
            piece = min(int(at), pieces - 1)
            t = at - piece
            for k in range(3):
                a = course[s, piece, k]
                cells[j, k] = a[0] + t * (a[1] + t * (a[2] + t * a[3]))
    return cells[:n]


@kernel
def copy(course, out):
    """Make ``out`` the same course."""
    for s in range(course.shape[0]):
        for piece in range(course.shape[1]):
            for k in range(3):
                for power in range(4):
                    out[s, piece, k, power] = course[s, piece, k, power]


@kernel
def at_point(course, segment, share):
    """The three numbers at a ``share`` (0 to 1) of one segment."""
    pieces = course.shape[1]
    at = share * pieces
    piece = min(max(int(at), 0), pieces - 1)
    t = at - piece
    a, b, c = course[segment, piece, 0], course[segment, piece, 1], course[segment, piece, 2]
    return (
        a[0] + t * (a[1] + t * (a[2] + t * a[3])),
        b[0] + t * (b[1] + t * (b[2] + t * b[3])),
        c[0] + t * (c[1] + t * (c[2] + t * c[3])),
    )

"""Tubes that are the same all along, as meshes take them: each by itself, whole, with a node in the middle."""

import numpy as np

from .problem import LENGTH


def in_two_halves(problem, cells):
    """``(course, edges, places)`` of the tube of one problem, of so many cells in each half."""
    course = np.zeros((2, 1, 3, 4))
    course[:, 0, :, 0] = problem[:3]
    return course, np.arange(3) * cells, np.arange(3) * 0.5 * problem[LENGTH]


def one_by_one(problems, first, tube, by_halves=False):
    """``(problems, rows, first, tube)`` as kernels take them, two slices among them: of all problems together, or of each.

    ``tube`` is their (course, edges, places), without a course where they do not vary; ``by_halves``: all are
    solved at once then, each up to its plane of symmetry: a whole one may leave its symmetric branch unseen.
    """
    course, edges, _ = tube
    if len(course) or by_halves:
        yield slice(None), slice(None), first, tube
        return
    for k, (begin, end) in enumerate(zip(first[:-1].tolist(), first[1:].tolist())):
        own = in_two_halves(problems[k], int(edges[-1]))
        yield slice(k, k + 1), slice(begin, end), np.array([0, end - begin]), own

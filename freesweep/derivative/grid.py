"""Meshes of places x/l: graded by a shape, with nodes where segments meet, and split into nested ones."""

from itertools import pairwise

import numpy as np

from ..solver.numerics import mesh
from .twins import twin

FIRST, GROWTH, EVEN = 2e-5, 1.1, 200  # nodes from each end: the first, in radii, each so much farther; and even ones
CELLS, LEAST_CELLS = 32, 12  # of the coarsest mesh, and of each of its segments
_bends, _density, _regrade, _split = map(twin, (mesh.bends, mesh.node_density, mesh.regrade, mesh.split))


def first_places(places, radii, half):
    """Places x/l that resolve end layers of any width, on both sides of where segments meet (``places``); a tube is
    ``radii`` long, and half of it is enough where it is symmetric.
    """
    most = 0.5 if half else 1.0
    steps = FIRST / radii * GROWTH ** np.arange(0, int(np.log(radii / FIRST) / np.log(GROWTH)) + 1)
    found = [np.linspace(0.0, most, EVEN + 1), np.asarray(places)]
    for place in places:
        found += [place + steps] + ([] if half else [place - steps])
    x = np.unique(np.concatenate(found))
    x = x[(x >= 0.0) & (x <= most)]
    apart = np.concatenate([[True], np.diff(x) > 0.3 * FIRST / radii])
    keep = apart | np.isin(x, places) | (x == most)
    return x[keep]


def graded(x, sine, cosine, segments, free):
    """``(nodes, edges)`` of a mesh that follows a shape, told by the meridian's angle in the cells of ``x``; ``segments``
    are the places where pieces begin and end, ``edges`` their nodes.
    """
    at = np.searchsorted(x, segments)
    pieces, weight = [], []
    for k, (a, b) in enumerate(pairwise(at)):
        rate, density = np.zeros(b - a), np.zeros(b - a)
        _bends(x[a : b + 1], sine[a:b], cosine[a:b], b - a, free and k == len(at) - 2, rate)
        _density(x[a : b + 1], b - a, rate, density)
        pieces.append(density)
        weight.append(np.sum(np.sqrt(rate) * np.diff(x[a : b + 1])))
    shares = np.array(weight) / max(np.sum(weight), 1e-300)
    lengths = np.diff(segments) / (segments[-1] - segments[0])
    counts = np.maximum(LEAST_CELLS, np.round(CELLS * (0.7 * shares + 0.3 * lengths)).astype(int))
    nodes, edges = [np.zeros(0)], [0]
    for k, (a, b) in enumerate(pairwise(at)):
        n = counts[k]
        new_x, ones = np.zeros(n + 1), np.ones(max(b - a, n) + 1)
        _regrade(x[a : b + 1], ones, pieces[k], b - a, n, new_x, ones.copy(), ones.copy())
        nodes.append(new_x if k == len(counts) - 1 else new_x[:-1])
        edges.append(edges[-1] + n)
    return np.concatenate(nodes), np.array(edges)


def least_between(x, values, nodes):
    """Least of the ``values`` of all cells of ``x`` with which each cell of another mesh shares some length."""
    first = np.searchsorted(x, nodes[:-1], side="right") - 1
    behind = np.searchsorted(x, nodes[1:], side="left")
    return np.minimum.reduceat(np.append(values, np.inf), np.stack([first, behind], axis=1).ravel())[::2]


def finer(x, edges, factor):
    """Nodes of the nested mesh in which every cell is split into ``factor``."""
    out = np.zeros((len(x) - 1) * factor + 1)
    for a, b in pairwise(edges):
        _split(x[a : b + 1], b - a, factor, out[a * factor : b * factor + 1])
    return out

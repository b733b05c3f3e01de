"""How the largest and the least along a tube change, and the shares of it along which fibers are slack, on meshes.

What is told of the middles of cells (outer radius, largest stretch, tensions) changes there as nodes move. Between pieces'
ends it is smooth: a polynomial through a few cells tells it at any place. Where it is largest, it changes as it does at
that very place: either its slope vanishes there, or it is an end, which stays. A share ends where a tension, seen from the
side on which it pulls, meets zero: that place moves by what the tension changes, over its slope. What is largest just there
has a corner, and changes as it moves, too.
"""

from functools import cache
from itertools import pairwise

import numpy as np

from ..description.families import FAMILIES, followed, given_by
from .dual import Dual, maximum, sqrt
from .physics import OWN
from .twins import twin

EXTREMES = (
    "outer_radius", "largest_stretch", "least_tension_alpha", "least_tension_beta", "slack_alpha", "slack_beta",
)  # fmt: skip
OUTER, STRETCH, PULLS = 0, 1, 2  # rows of what is looked at; tensions come last
STENCIL = 6  # cells of a polynomial
TIED, TOGETHER = 1e-5, 1e-12  # relative: by how much another piece, or place, may have less, and be the largest as well
HALVINGS, REAL = 60, 1e-9  # of the way to a root; what an imaginary part leaves


@cache
def _stretched():
    """Squared largest stretch of a layer."""
    from ..solver.along import places

    return twin(places.principal_square)


def fields(physics, y, place, share):
    """Outer radius [m], largest stretch and tensions of both lines [N], of a locked shape [N/Pa], where the stretch is
    ``y``: dual numbers. ``place``: G - 1, twist rate and these tensions there.
    """
    G_1, psi, tensions = place
    inner, outer, fibers = physics.surfaces(share)
    s = sqrt(G_1 + 1.0)
    wide = sqrt(y * y * fibers * fibers + (outer * outer - fibers * fibers) / s)
    layers = [_stretched()(y, G_1, psi, (rho / fibers) ** 2) for rho in (inner, outer)]
    return wide, sqrt(maximum(*layers)), *tensions


class Piece:
    """A part of a mesh between two places, in which all is smooth: ``rows`` (fields, 1 + parameters, n) at places ``x``,
    middles of ``cells``, and its ends where these stay, at the cells beside. ``moves``: what both ends move by, (1 +
    parameters,), None of those that stay.
    """

    def __init__(self, x, rows, ends, cells, moves=(None, None)):
        self.x, self.rows, self.ends, self.cells, self.moves = x, rows, ends, cells, moves

    def near(self, field, k):
        """The polynomial through a field at the few of its places beside place k."""
        count = min(STENCIL, len(self.x))
        first = min(max(k - count // 2 + 1, 0), len(self.x) - count)
        return Curve(self.x[first : first + count], self.rows[field][:, first : first + count])

    def only(self, which):
        """The part of it at some of its places."""
        return Piece(self.x[which], self.rows[..., which], self.ends, self.cells[which], self.moves)

    def at_moving_ends(self, field, k):
        """``(place, (1 + parameters,))`` of a field at the ends that move, if its place k is beside one."""
        made = []
        for end, move, beside in zip(self.ends, self.moves, (0, len(self.x) - 1)):
            if move is not None and k == beside:
                value, slope = self.near(field, k).at(end)
                made.append((end, value + slope[0] * move))
        return made

    def largest(self, field, sign):
        """``sign`` times the field, where that is largest, (1 + parameters,); how differently other places change that have
        as much; and how large it is, counted as ends are.

        Middles of cells err in another way than ends do, where a polynomial through middles tells by how much.
        """
        inside = (self.x > self.ends[0]) & (self.x < self.ends[1])
        inner = self.only(inside) if np.count_nonzero(inside) > 1 else self
        x, own, last = inner.x, sign * inner.rows[field], len(inner.x) - 1
        k = int(np.argmax(own[0]))
        low, high = x[k - 1] if k > 0 else self.ends[0], x[k + 1] if k < last else self.ends[1]
        curve = inner.near(field, k)
        made = [(place, sign * curve.at(place)[0]) for place in (x[k], *curve.turns(low, high))]
        made += [(place, sign * value) for place, value in inner.at_moving_ends(field, k)]
        place, best = max(made, key=lambda one: one[1][0])
        ends = [(at, sign * self.rows[field][:, at]) for at in np.flatnonzero(~inside)] if inner is not self else []
        gap = 0.0
        if ends:
            at, there = min(ends, key=lambda end: abs(self.x[end[0]] - place))
            gap = there[0] - sign * inner.near(field, 0 if at == 0 else last).at(self.x[at])[0][0]
        counted = best[0] + gap
        own, sizes = (
            np.column_stack([own, *(there for _, there in ends)]),
            [*(own[0] + gap), *(one[0] for _, one in ends)],
        )
        for _, there in ends:
            best, counted = (there, there[0]) if there[0] >= counted else (best, counted)
        alike = own[:, np.array(sizes) >= counted - TOGETHER * abs(counted)]
        return best, np.max(np.abs(alike - best[:, None]), axis=1, initial=0.0), counted


class Curve:
    """The polynomial through ``rows`` (1 + parameters, m) at places ``x`` (m,)."""

    def __init__(self, x, rows):
        self.middle, self.size = x.mean(), np.ptp(x)
        self.series = np.linalg.solve(np.vander((x - self.middle) / self.size, increasing=True), rows.T)

    def at(self, x):
        """Value and slope at a place, of each."""
        t, powers = (x - self.middle) / self.size, np.arange(len(self.series))
        return t**powers @ self.series, powers[1:] * t ** powers[:-1] / self.size @ self.series[1:]

    def turns(self, low, high):
        """Places between two others at which the slope of the value vanishes."""
        steep = np.polynomial.polynomial.polyder(self.series[:, 0])
        bent = np.any(steep[1:]) and np.all(np.isfinite(steep))
        roots = np.polynomial.polynomial.polyroots(steep) if bent else np.zeros(0)
        places = roots[np.abs(np.imag(roots)) < REAL].real * self.size + self.middle
        return places[(places > low) & (places < high)]

    def root(self, low, high):
        """The place between two others, at which signs differ, where the value vanishes."""
        sign = np.sign(self.at(low)[0][0])
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if np.sign(self.at(middle)[0][0]) == sign else (low, middle)
        return 0.5 * (low + high)


def largest(field, pieces, sign=1.0):
    """What is largest along a mesh of a field, times a ``sign``, with its derivatives (1 + parameters,); and how differently
    other pieces change that have nearly as much.
    """
    tops = [piece.largest(field, sign) for piece in pieces]
    best = max(tops, key=lambda top: top[2])[0]
    tied = [np.abs(one - best) + doubt for one, doubt, _ in tops if one[0] >= best[0] - TIED * abs(best[0])]
    return best, np.max(tied, axis=0)


def pulls_in(taut, pieces):
    """Whether a loose family, ``taut`` (cells,), pulls in each piece."""
    return [bool(taut[piece.cells[len(piece.cells) // 2]]) for piece in pieces]


def moving(field, taut, pieces, segments):
    """What each place between two pieces moves by, (1 + parameters,) each, where a loose family goes slack, None at others:
    ``field`` is that of its tension, ``taut`` (cells,).
    """
    found = []
    for (before, one), (behind, other) in pairwise(zip(pieces, pulls_in(taut, pieces))):
        place = before.ends[1]
        if one == other or np.any(segments == place):  # where profiles jump, it stays
            found.append(None)
            continue
        own = before if one else behind
        own = own.only(taut[own.cells])  # a node may not be where it ends yet
        value, slope = own.near(field, len(own.x) - 1 if one else 0).at(place)
        found.append(-value / slope[0])
    return found


def slack_of_loose(taut, pieces, moves):
    """Share of a mesh along which a loose family is slack, with its derivatives, from the ``moves`` of where it ends."""
    pulls, total = pulls_in(taut, pieces), np.zeros(pieces[0].rows.shape[1])
    for piece, pull in zip(pieces, pulls):
        total[0] += 0.0 if pull else piece.ends[1] - piece.ends[0]
    for pull, move in zip(pulls, moves):
        if move is not None:
            total -= move if pull else -move
    return total


def slack_of_bonded(field, pieces):
    """The same of a bonded family, which would have to push there."""
    total = np.zeros(pieces[0].rows.shape[1])
    for piece in pieces:
        pulled = piece.rows[field, 0] > 0.0
        total[0] += (0.0 if pulled[-1] else piece.ends[1]) - (0.0 if pulled[0] else piece.ends[0])
        for k in np.flatnonzero(pulled[1:] != pulled[:-1]):
            curve = piece.near(field, k)
            place = curve.root(piece.x[k], piece.x[k + 1])
            value, slope = curve.at(place)
            moved = -value / slope[0]
            moved[0] = place
            total += -moved if pulled[k] else moved
    return total


def extremes(physics, pieces, segments, whole):
    """What :data:`EXTREMES` name, dual numbers over the meshes, and in which doubt each is, (extremes, 1 + parameters,
    meshes), from the ``pieces`` of each mesh; ``segments`` are where profiles jump, the tube ``whole`` times as long.
    """
    tube, count = physics.tube, pieces[0][0].rows.shape[1]
    lines, given = len(followed(tube)), given_by(tube)
    table = np.zeros((len(pieces), len(EXTREMES), 2, count))
    for found, own in zip(table, pieces):
        moves = []
        if tube.is_loose:
            moves = [moving(PULLS + line, physics.settled[2 + line], own, segments) for line in range(lines)]
        for (before, behind), *all_moves in zip(pairwise(own), *moves):
            move = next((move for move in all_moves if move is not None), None)
            before.moves, behind.moves = (before.moves[0], move), (move, behind.moves[1])
        found[0], found[1] = largest(OUTER, own), largest(STRETCH, own)
        for k, family in enumerate(FAMILIES):
            if lines == 0 or family not in given:
                continue
            line = k if lines == 2 else 0
            if tube.is_loose:
                found[4 + k, 0] = whole * slack_of_loose(physics.settled[2 + line], own, moves[line])
            else:
                found[4 + k, 0] = whole * slack_of_bonded(PULLS + line, own)
            if not tube.is_loose or found[4 + k, 0, 0] == 0.0:
                least, found[2 + k, 1] = largest(PULLS + line, own, -1.0)
                found[2 + k, 0] = -least / (1.0 if lines == 2 else len(given))
    made = np.moveaxis(table, 0, -1)
    none = np.zeros((OWN, len(pieces)))
    numbers = [Dual(one[0, 0], np.concatenate([none, one[0, 1:]])) for one in made]
    return dict(zip(EXTREMES, numbers)), made[:, 1]


def unknown(parameters, meshes):
    """As of :func:`extremes`, of what is not known."""
    doubts = np.full((len(EXTREMES), 1 + parameters, meshes), np.nan)
    return {name: Dual(doubts[0, 0], np.full((OWN + parameters, meshes), np.nan)) for name in EXTREMES}, doubts

"""One axis of an atlas as the kernels take it: a coordinate in which the physics is smooth, and weights at its nodes.

Cubic Hermite pieces between the nodes, with slopes from the five nearest ones (fourth order): once continuously
differentiable, local, and a ninth of the error of cubics through four nodes. Nodes that lie far off for the pieces at hand
say little of a slope and may spoil it. The coordinate is the square root of a pressure (end layers give P^1.5 near zero),
the logarithm of a size, else the value itself.
"""

from dataclasses import dataclass, replace

import numpy as np

WINDOW = 6  # nodes that a piece knows
SLOPE = 5  # nodes that a slope knows at most
FEWEST = 4  # and at least, however far they lie
ROUNDING = 1e-9  # of widths: equal pieces are that far from equal
SQRT, LOG, LINEAR, LABEL = 0, 1, 2, 3
# how far off they may lie, in pieces as the wider one beside the slope's node: along pressures and angles tubes change
# from one kind to another, along sizes what the ends add has no such places, and all five nodes pay at the ends, too
FAR = {SQRT: 3.0, LINEAR: 3.0, LOG: 4.0}
SIZES = ("length", "radius", "wall", "fiber_radius", "c10")


@dataclass(frozen=True)
class Axis:
    """Nodes (n,) in the unit of the atlas, the coordinate's kind, and per piece i (from node i to i + 1):

    ``first`` (n,) where its window begins; ``left`` and ``right`` (n, 6) slopes at its ends times its width, as weights of
    the window's nodes; ``remainder`` (n, 6): weights of what the next order would add in the middle of the piece. ``bend``:
    the node across which no window reaches; 0: there is none.
    """

    name: str
    values: np.ndarray
    kind: int
    nodes: np.ndarray
    first: np.ndarray
    left: np.ndarray
    right: np.ndarray
    remainder: np.ndarray
    bend: int = 0

    def forward(self, values):
        """The axis' coordinate at ``values``."""
        return (
            np.sqrt(values) if self.kind == SQRT else np.log(values) if self.kind == LOG else np.asarray(values, float)
        )

    def back(self, nodes):
        """Values at places of the axis' coordinate."""
        return nodes**2 if self.kind == SQRT else np.exp(nodes) if self.kind == LOG else nodes

    def rate(self, values):
        """Derivative of the axis' coordinate by its value, at ``values`` (n,)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return (
                0.5 / np.sqrt(values)
                if self.kind == SQRT
                else 1.0 / values
                if self.kind == LOG
                else np.ones(len(values))
            )

    @property
    def window(self) -> int:
        """How many nodes a piece knows."""
        return 1 if self.kind == LABEL else min(WINDOW, len(self.nodes))


def make_axis(name: str, values) -> Axis:
    """The axis of a parameter with two nodes or more, or of labels (``design``)."""
    count = len(values)
    if name == "design":
        nodes, zero = np.arange(count, dtype=float), np.zeros((count, WINDOW))
        return Axis(name, nodes, LABEL, nodes, np.arange(count), zero, zero, zero)
    values = np.asarray(values, float)
    kind = LINEAR
    if name == "pressure" and values[0] >= 0.0:
        kind = SQRT
    elif name in SIZES and values[0] > 0.0:
        kind = LOG
    nodes = np.sqrt(values) if kind == SQRT else np.log(values) if kind == LOG else values.copy()
    window = min(WINDOW, count)
    first = np.clip(np.arange(count) - WINDOW // 2 + 1, 0, count - window)
    left, right, remainder = np.zeros((3, count, WINDOW))
    for i in range(count - 1):
        places = np.arange(first[i], first[i] + window)
        width = nodes[i + 1] - nodes[i]
        left[i, :window] = width * _slope(nodes, i, places, FAR[kind])
        right[i, :window] = width * _slope(nodes, i + 1, places, FAR[kind])
        middle = 0.125 * (left[i] - right[i])
        middle[i - first[i] : i - first[i] + 2] += 0.5
        remainder[i, :window] = (
            _better(nodes[places], i - first[i], left[i, :window], right[i, :window]) - middle[:window]
        )
    return Axis(name, values, kind, nodes, first, left, right, remainder)


def bent(axis: Axis, value) -> Axis:
    """The axis without windows across the node with that ``value``, where numbers have a kink; as it is, if there are too
    few nodes on either side for windows of their own, or no such node.
    """
    at = np.flatnonzero(axis.values == value)
    if not len(at) or not WINDOW - 1 <= at[0] <= len(axis.nodes) - WINDOW:
        return axis
    bend = int(at[0])
    below, above = make_axis(axis.name, axis.values[: bend + 1]), make_axis(axis.name, axis.values[bend:])
    weights = {
        name: np.concatenate([getattr(below, name)[:-1], getattr(above, name)])
        for name in ("left", "right", "remainder")
    }
    return replace(axis, first=np.concatenate([below.first[:-1], above.first + bend]), **weights, bend=bend)


def part_of(axis: Axis, start, stop) -> Axis:
    """Nodes ``start`` to ``stop`` of an axis; pieces whose window lies among them keep it, others have one that does."""
    if stop - start == len(axis.nodes):
        return axis
    part = make_axis(axis.name, axis.values[start:stop])
    kept = np.arange(start, stop - 1)
    kept = kept[(axis.first[kept] >= start) & (axis.first[kept] + axis.window <= stop)]
    first, weights = part.first.copy(), [array.copy() for array in (part.left, part.right, part.remainder)]
    first[kept - start] = axis.first[kept] - start
    for mine, whole in zip(weights, (axis.left, axis.right, axis.remainder)):
        mine[kept - start] = whole[kept]
    return replace(part, first=first, left=weights[0], right=weights[1], remainder=weights[2])


def _better(x, here, left, right):
    """Weights of nodes ``x`` in the middle of the piece from the one ``here`` to the next: of a polynomial of another order
    than what the slopes at its ends, with these weights, make of them.

    It knows all nodes but the farthest. What knows as many on either side tells nothing of an error where the fourth
    derivative is zero, as if there were no fifth.
    """
    known = np.stack([left, right]) != 0.0
    known[:, here : here + 2] = True
    middle = 0.5 * (x[here] + x[here + 1])
    kept = np.ones(len(x), bool)
    if known.all() or (known[0] != known[1]).any():  # else both slopes may know just those: nothing would be told
        kept[np.argmax(np.abs(x - middle))] = False
    weights = np.zeros(len(x))
    weights[kept] = lagrange(x[kept], middle)
    return weights


def _slope(nodes, i, places, far):
    """Weights, one for each of ``places``, of the slope at node i from the nodes nearest to it, up to ``far`` pieces off."""
    count = min(SLOPE, len(nodes))
    start = min(max(i - count // 2, 0), len(nodes) - count)
    near = np.arange(start, start + count)
    away = np.abs(nodes[near] - nodes[i])
    beside = np.diff(nodes[max(i - 1, 0) : i + 2]).max()
    kept = away <= np.maximum(far * (1.0 + ROUNDING) * beside, np.sort(away)[min(FEWEST, count) - 1])
    near = near[kept]
    weights = np.zeros(len(places))
    x, here = nodes[near], int(np.flatnonzero(near == i)[0])
    for j in range(len(near)):
        others = [k for k in range(len(near)) if k != j]
        if j == here:
            weight = np.sum(1.0 / (x[here] - x[others]))
        else:
            rest = [k for k in others if k != here]
            weight = np.prod((x[here] - x[rest]) / (x[j] - x[rest])) / (x[j] - x[here])
        weights[near[j] - places[0]] = weight
    return weights


def lagrange(x, at):
    """Weights of the polynomial through all nodes ``x`` at one place."""
    return np.array([np.prod([(at - x[k]) / (x[j] - x[k]) for k in range(len(x)) if k != j]) for j in range(len(x))])

"""Labels beside points so that none covers another, or a point: where points crowd, farther off, with a line to theirs;
points that lie on one another have one label, "1, 3, 4".
"""

from typing import NamedTuple

import numpy as np

from . import style

POINTS_OF_INCH = 72.0
MARK = 3.5  # [point]: half of what a mark takes
SAME = 3.0  # [point]: marks nearer than that to each other are one
NEAR = 1.0  # [point] between a mark and its label
LEADER = 0.5  # [point] width of a line to a point
RINGS = (0.0, 7.0, 14.0, 22.0, 32.0, 44.0, 58.0)  # [point] farther off
WAYS = ((1, 1), (1, -1), (-1, 1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1))  # to where a label may go, the best first


class Box(NamedTuple):
    """What is taken in a picture [point]: its middle, and half of its size."""

    middle: np.ndarray
    half: np.ndarray

    def overlap(self, other):
        """The area that both take."""
        both = self.half + other.half - np.abs(self.middle - other.middle)
        return float(np.prod(np.maximum(both, 0.0)))

    def beyond(self, other):
        """By how much it reaches out of another one."""
        return float(np.sum(np.maximum(np.abs(self.middle - other.middle) + self.half - other.half, 0.0)))


def label_points(ax, points, texts, colours) -> list:
    """Label ``points`` (n, 2) of an Axes whose limits are set; returns the annotations."""
    points = np.asarray(points, float)
    ax.figure.draw_without_rendering()  # where the layout puts the axes
    scale = POINTS_OF_INCH / ax.figure.dpi
    places = scale * ax.transData.transform(points)
    (left, low), (right, high) = scale * ax.get_window_extent().get_points()
    room = Box(np.array([left + right, low + high]) / 2.0, np.array([right - left, high - low]) / 2.0)
    taken, made = [Box(place, np.full(2, MARK)) for place in places], []
    for group in _groups(places):
        colour = colours[group[0]] if len({colours[k] for k in group}) == 1 else style.INK
        said = ax.annotate(
            ", ".join(texts[k] for k in group), points[group[0]], (0.0, 0.0), textcoords="offset points", color=colour,
            ha="center", va="center", annotation_clip=False,
        )  # fmt: skip
        half = 0.5 * scale * np.array(said.get_window_extent().size)
        offset, is_far = _free_place(places[group[0]], half, taken, room)
        said.set_position(offset)
        taken.append(Box(places[group[0]] + offset, half))
        made.append(said)
        if is_far:
            ax.annotate(
                "", points[group[0]], offset - np.sign(offset) * half, textcoords="offset points",
                arrowprops={"arrowstyle": "-", "color": colour, "linewidth": LEADER, "shrinkA": 0, "shrinkB": MARK},
            )  # fmt: skip
    return made


def _groups(places):
    """Numbers of points that lie on one another, each group in order."""
    left, found = list(range(len(places))), []
    while left:
        first, *others = left
        near = [k for k in others if np.max(np.abs(places[k] - places[first])) < SAME]
        found.append([first, *near])
        left = [k for k in others if k not in near]
    return found


def _free_place(place, half, taken, room):
    """``(offset, whether it wants a line)`` of a label from its point: the nearest where nothing is taken, else where it
    covers least.
    """
    tried = []
    for ring in RINGS:
        for way in WAYS:
            offset = (half + MARK + NEAR + ring) * np.array(way)
            box = Box(place + offset, half)
            cost = sum(box.overlap(other) for other in taken) + box.beyond(room)
            if cost == 0.0:
                return offset, ring > 0.0
            tried.append((cost, ring > 0.0, offset))
    _, is_far, offset = min(tried, key=lambda each: each[0])
    return offset, is_far

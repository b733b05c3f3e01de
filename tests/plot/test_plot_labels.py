"""Labels of points cover neither each other nor a point, and points that lie on one another have one."""

import itertools

import numpy as np
import pytest
from matplotlib.figure import Figure

from freesweep.plot import style
from freesweep.plot.labels import MARK, POINTS_OF_INCH, label_points


def labelled(points, colours=None):
    """An Axes with labelled points, their labels, and the boxes of both (n, 2, 2) in pixels."""
    figure = Figure((3.0, 3.0), layout="constrained")
    ax = figure.subplots()
    ax.plot(*np.transpose(points), "o", markersize=5)
    ax.set(xlim=(0.0, 90.0), ylim=(-90.0, 0.0), xlabel="alpha")
    said = label_points(ax, points, [str(k) for k in range(len(points))], colours or [style.QUIET] * len(points))
    figure.draw_without_rendering()
    boxes = np.array([each.get_window_extent().get_points() for each in said])
    half = MARK * figure.dpi / POINTS_OF_INCH
    marks = ax.transData.transform(points)[:, None, :] + np.array([[-half], [half]])
    return ax, said, boxes, marks


def covers(one, other):
    """Whether two boxes share more than an edge."""
    return np.all(np.minimum(one[1], other[1]) - np.maximum(one[0], other[0]) > 0.5)


@pytest.mark.parametrize("spread", [4.0, 12.0, 40.0])
@pytest.mark.parametrize("seed", range(4))
def test_labels_of_points_that_crowd_stand_apart(spread, seed):
    points = np.array([45.0, -45.0]) + spread * np.random.default_rng(seed).uniform(-1.0, 1.0, (10, 2))
    ax, said, boxes, marks = labelled(points)
    assert sorted(", ".join(each.get_text() for each in said).split(", ")) == [str(k) for k in range(10)]
    assert not any(covers(a, b) for a, b in itertools.combinations(boxes, 2))
    assert not any(covers(box, mark) for box in boxes for mark in marks)
    (left, low), (right, high) = ax.get_window_extent().get_points()
    assert np.all((boxes[:, 0] >= [left - 0.5, low - 0.5]) & (boxes[:, 1] <= [right + 0.5, high + 0.5]))


def test_points_on_one_another_have_one_label_and_crowded_ones_a_line():
    points = [(10.0, -10.0), (10.0, -10.0), (60.0, -60.0), (10.1, -10.0)]
    _, said, *_ = labelled(points, ["red", "blue", "red", "red"])
    assert [each.get_text() for each in said] == ["0, 1, 3", "2"]
    assert [each.get_color() for each in said] == [style.INK, "red"]
    crowd = [(45.0 + 4.0 * i, -45.0 + 4.0 * j) for i in range(3) for j in range(3)]
    ax, said, *_ = labelled(crowd)
    lines = [each for each in ax.texts if not each.get_text()]
    assert len(said) == 9
    assert 0 < len(lines) < 9
    assert all(line.xy in crowd for line in lines)

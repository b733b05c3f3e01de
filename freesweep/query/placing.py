"""Where points of a question lie in a table: its axes with their knots, the columns of a question, and what is fixed."""

from typing import NamedTuple

import numpy as np

from ..atlas.schema import VARIABLES
from . import reference
from .axis import LABEL, WINDOW, bent
from .fixed import Fixed
from .grid_axes import DEFAULTS
from .locate import CLOSEST, Columns
from .reference import COLUMNS
from .spline import FIRST, KNOT, LEFT, PLACE, RANK, RIGHT, WIDTH

HELD_NAMES = {"held_length": reference.LENGTH_HELD, "held_length_ratio": reference.LENGTH_HELD}
HELD_NAMES |= {"held_rotation": reference.ROTATION_HELD}
STRAIGHT = ("alpha", "beta")  # axes that have a family of straight fibers where they are 0
TURNED = ("torque", "held_rotation")  # turn round with both angles


class Placing(NamedTuple):
    """What :func:`.locate.place` has to know: names of the ``columns`` of a question, all that the family depends on, fixed
    values among them; and how near to one angle its two families may come.
    """

    known: list
    columns: Columns
    fixed: Fixed
    nearest: float


def whole_axes(frame, names, kind) -> list:
    """The axes of a family. Of loose fibers a kink lies where one family is straight: on one side of it clamped ends leave
    some slack. The two inner axes have one slope at each node, and are taken as they are.
    """
    whole = [frame.axis(name) for name in names]
    outer = len(whole) - (2 if sum(axis.kind != LABEL for axis in whole) > 1 else 1)
    if not frame.model.is_loose or kind not in (reference.LOADED, reference.LOCKED):
        return whole
    return [bent(axis, 0.0) if k < outer and axis.name in STRAIGHT else axis for k, axis in enumerate(whole)]


def placing(frame, family, names) -> Placing:
    """Of a family that varies in the axes ``names``."""
    kind = family.kind
    without = VARIABLES[next(iter(family.variables))].without
    known = [
        name for name in frame.asked
        if name in names or (name not in without and name != "design" and HELD_NAMES.get(name, kind) == kind)
    ]  # fmt: skip
    kinds, bounds = np.empty((len(known), 3), np.int64), np.empty((len(known), 2))
    for j, name in enumerate(known):
        column = -1 if name == "design" else COLUMNS.index("held" if name in HELD_NAMES else name)
        kinds[j] = column, names.index(name) if name in names else -1, name in TURNED
        bounds[j] = frame.ranges.get(name, (0.0, 0.0))
    columns = kinds[:, 0].tolist()
    angles = [columns.index(column) if column in columns else -1 for column in (reference.ALPHA, reference.BETA, -1)]
    # of loose fibers one family holds the wall on either side of where both have one angle
    nearest = 0.0 if frame.model.is_loose and kind == reference.LOADED else CLOSEST
    return Placing(known, Columns(kinds, bounds, *angles), _fixed(frame, kind), nearest)


def _fixed(frame, kind) -> Fixed:
    designs = len(frame.values["design"]) if "design" in frame.values else 1
    fixed = np.full((designs, len(COLUMNS)), np.nan)
    for column, name in enumerate(COLUMNS):
        if name in frame.values:
            array = frame.values[name]
            fixed[:, column] = array if name in frame.by_design else array[0]
        elif name in DEFAULTS:
            fixed[:, column] = DEFAULTS[name]
    fixed[:, reference.HELD] = 1.0 if kind == reference.LENGTH_HELD else 0.0
    by_length = kind == reference.LENGTH_HELD and "held_length" in frame.values
    return Fixed(fixed, float(frame.fiber_share), bool(by_length))


def packed(axes, ranks) -> tuple:
    """Knots (d, n, KNOT), sizes of the windows and kinds (d,): what :mod:`.spline` knows of the axes."""
    knots = np.zeros((len(axes), max(len(axis.nodes) for axis in axes), KNOT))
    for own, axis, rank in zip(knots, axes, ranks):
        count = len(axis.nodes)
        own[:count, RANK], own[:count, PLACE], own[:count, FIRST] = rank, axis.nodes, axis.first
        own[: count - 1, WIDTH] = np.diff(axis.nodes)
        own[:count, LEFT : LEFT + WINDOW], own[:count, RIGHT : RIGHT + WINDOW] = axis.left, axis.right
    windows = np.array([axis.window for axis in axes], np.int64)
    return knots, windows, np.array([axis.kind for axis in axes], np.int64)

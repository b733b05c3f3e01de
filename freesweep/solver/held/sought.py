"""Which held state is sought, in terms of the solver; what nothing has to be solved for; and what became of it."""

from typing import NamedTuple

import numpy as np

from ...jit import kernel
from .. import guide
from ..load import Load, at_pressure, by, loaded
from ..physics import lagrangian
from ..physics.lagrangian import LONGER
from ..physics.wall import may_go_slack
from ..problem import GAMMA, rubber_of, wall_of
from ..status import COMPRESSED, HELD_IMPOSSIBLE, INACCURATE, OK, PENDING
from .ways import cylinder_multiplier

HELD_LENGTH, HELD_ROTATION = 0, 1
FROM_REST, FROM_FREE = 0, 1
WITHOUT_PRESSURE = 0.1  # times the wall's section: the pressure that is gone to first where none is asked for
CYLINDER = 3  # numbers of a cell, of which a body has more
MIRROR_OFFSET, MIRROR_TOLERANCE = 0.37, 1e-12  # places off jumps; of H, D and the section


class Asked(NamedTuple):
    """A held state that is asked for: the columns of its wall; the pressure, and the load that is not unknown; and what is
    held, HELD_LENGTH or HELD_ROTATION, at which target.
    """

    walls: tuple
    p: float
    other: float
    target: float
    kind: int


class Sought(NamedTuple):
    """A held state: its load, but for what holds it; ``with_pressure``, the same where there is none, and whether there the
    wall of the straight cylinder ``cell`` is under tension: it ``stands``. The load ``unit`` holds the integral, in units
    of ``scale``; it is ``natural`` undeformed, and ``wanted``.
    """

    load: tuple
    with_pressure: tuple
    cell: tuple
    stands: bool
    unit: tuple
    scale: float
    natural: float
    wanted: float
    varies: bool


class Found(NamedTuple):
    """What became of it: of a state its unstable directions, doublings of the mesh, and whole load; else the share reached
    of the way that ended, and whether that is certain, so that no finer mesh has to confirm it; and which way it was.
    """

    status: int
    unstable: int
    doublings: int
    load: tuple
    reached: float
    sure: bool
    path: int


@kernel
def unit_of(kind, scale):
    """The load that holds."""
    return by(0.0, scale, 0.0) if kind == HELD_LENGTH else by(0.0, 0.0, scale)


@kernel
def load_of(problem, asked):
    """The load but for what holds."""
    force, torque = (0.0, asked.other) if asked.kind == HELD_LENGTH else (asked.other, 0.0)
    return Load(problem[GAMMA], rubber_of(problem), wall_of(problem, asked.walls), asked.p, force, torque, 1.0)


@kernel
def valued(status):
    """Whether a state was found."""
    return status == OK or status == INACCURATE


@kernel
def failed(status, load):
    """No state, for certain."""
    return Found(status, 0, 0, load, 0.0, True, FROM_REST)


@kernel
def longest_along(tube, load):
    """The largest meridional stretch that the fibers allow, which no finite force reaches: of straight fibers that of the
    undeformed length (the pole of Eq. 2.16). Infinite where it varies along the tube, or the meridian is longer than that.
    """
    course = tube.course
    if course.shape[2] > CYLINDER:
        return np.inf
    places = 1 if course.shape[0] == 1 and course.shape[1] == 1 else guide.PLACES
    most = lagrangian.longest(guide.cell_along(tube, 0.5), load.gamma, load.wall)
    for k in range(places):
        here = lagrangian.longest(guide.cell_along(tube, (k + MIRROR_OFFSET) / places), load.gamma, load.wall)
        if abs(here - most) > LONGER * most:
            return np.inf
    return most


@kernel
def refused(load, target, kind, tube):
    """COMPRESSED or HELD_IMPOSSIBLE where nothing has to be solved to know it, else PENDING."""
    cell, course, places = guide.cell_along(tube, 0.5), tube.course, tube.places
    varies = course.shape[0] > 1 or course.shape[1] > 1
    # no load turns what has alpha = -beta, unless fibers go slack
    if (
        kind == HELD_ROTATION
        and not (varies or may_go_slack(load.wall))
        and lagrangian.conjugate(1.0, 0.0, cell, load, unit_of(kind, 1.0))[1] == 0.0
    ):
        return HELD_IMPOSSIBLE
    if kind == HELD_LENGTH and target >= (1.0 - LONGER) * places[len(places) - 1] * longest_along(tube, load):
        return HELD_IMPOSSIBLE
    if kind == HELD_ROTATION and not load.p + load.f > 0.0:  # at the clamped ends
        return COMPRESSED
    return PENDING


@kernel
def describe(load, target, kind, tube):
    """What is sought. A place is chosen whose cylinder can carry the load."""
    course, places = tube.course, tube.places
    varies = course.shape[0] > 1 or course.shape[1] > 1
    cell, unit = guide.cell_along(tube, 0.5), unit_of(kind, 1.0)
    there = at_pressure(load, load.p if load.p > 0.0 or kind == HELD_ROTATION else WITHOUT_PRESSURE * cell[2])
    multiplier, stands = 0.0, False
    for attempt in range(guide.PLACES if varies else 1):
        cell = guide.cell_along(tube, (attempt * 0.5 / (guide.PLACES - 1) + 0.5) % 1.0)
        multiplier = cylinder_multiplier(cell, there, unit)
        stands = (
            abs(multiplier) < np.inf and lagrangian.density(1.0, 0.0, cell, loaded(there, unit, multiplier))[0] > 0.0
        )
        if stands:
            break
    scale = max(there.p, abs(load.f), abs(load.m))
    if abs(multiplier) < np.inf:
        scale = max(scale, abs(multiplier))
    natural = places[len(places) - 1] * scale if kind == HELD_LENGTH else 0.0
    return Sought(load, there, cell, stands, unit_of(kind, scale), scale, natural, target * scale, varies)


@kernel
def mirrored(tube):
    """Whether a tube is its own mirror image."""
    same = True
    for k in range(guide.PLACES):
        share = (k + MIRROR_OFFSET) / guide.PLACES
        one, other = guide.cell_along(tube, share), guide.cell_along(tube, 1.0 - share)
        for i in range(len(one)):
            same = same and abs(one[i] - other[i]) < MIRROR_TOLERANCE * max(1.0, abs(one[i]))
    return same

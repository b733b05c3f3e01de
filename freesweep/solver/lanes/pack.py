"""Designs in and out of lanes: scalar work, done one lane at a time."""

from math import sqrt
from typing import NamedTuple

import numpy as np

from ...jit import entry_point, kernel
from ..along.places import OUTER, STRETCH
from ..load import Load, at_pressure
from ..physics import lagrangian
from ..physics.wall import FEWEST, layers, reciprocal
from ..problem import (
    AREA,
    FORCE,
    GAMMA,
    INNER,
    LENGTH,
    RATIO,
    SECOND,
    SHEAR,
    THIRD,
    THREADS,
    TORQUE,
    D,
    H,
    wall_of,
)
from ..status import COMPRESSED, INVALID, OK
from .vector import WIDTH, get

OUTPUTS = 5  # length, volume, twist, energy, stretch in the middle
# H, D, area, gamma, c, shear, f, m, half length, c2, c3, inner, threads; pressure, pressure before, weight of the energy
COLUMNS = THREADS + 4
PRESSURE, BEFORE, WEIGHT = range(THREADS + 1, COLUMNS)
LINE = 64  # bytes: arrays of lanes begin on a cache line


class Kind(NamedTuple):
    """What is the same for all tubes in a vector: columns of their rubbers' constants, MOONEY_RIVLIN or YEOH, those of their
    walls, SOURCE or PHYSICAL, and as how many layers walls count. Each kind has machine code of its own.
    """

    constants: tuple
    walls: tuple
    layers: int


class Asked(NamedTuple):
    """States (n,) that are asked for: row i is that of ``problems[owners[i]]`` under ``pressures[i]``, looked for from
    ``starts[i]``; rows in the given ``order`` share vectors.
    """

    problems: np.ndarray
    owners: np.ndarray
    pressures: np.ndarray
    starts: np.ndarray
    order: np.ndarray


class Told(NamedTuple):
    """What is told of states: see :func:`..free.free_states.follow_many`."""

    values: np.ndarray
    bounds: np.ndarray
    status: np.ndarray
    slack: np.ndarray


@kernel
def aligned(rows, size):
    """Zeros of shape (rows, size, WIDTH) that begin on a cache line."""
    count = rows * size * WIDTH
    room = np.zeros(count + LINE // 8)
    skipped = (-(room.ctypes.data // 8)) % (LINE // 8)
    return room[skipped : skipped + count].reshape((rows, size, WIDTH))


@kernel
def rubber_in(columns, constants):
    """The rubbers in the lanes: as many of C01/C10, C2/C1, C3/C1 as there are ``constants``, (RATIO,) or three columns."""
    if len(constants) == 1:
        return (get(columns, RATIO),)
    return get(columns, RATIO), get(columns, SECOND), get(columns, THIRD)


@kernel
def wall_in(columns, walls, count):
    """The walls in the lanes, of the columns SOURCE or PHYSICAL; those count as ``count`` layers, and all of them have loose
    fibers, or none.
    """
    if len(walls) == 1:
        return (get(columns, SHEAR),)
    inner = get(columns, INNER)
    return get(columns, SHEAR), inner, columns[THREADS, 0], count, reciprocal(get(columns, AREA), inner)


@entry_point
def count_layers(problems, walls, out):
    """As how many layers the wall of each of the physical tubes counts: one that is summed exactly is like any other."""
    for k in range(len(problems)):
        exact = problems[k, SECOND] == 0.0 and problems[k, THIRD] == 0.0
        count = layers(problems[k, AREA], wall_of(problems[k], walls))
        out[k] = min(count, FEWEST) if exact else count


@kernel
def loads(columns, constants, walls, count):
    """What the density takes: ``(cell, load before, load now)``."""
    cell = (get(columns, H), get(columns, D), get(columns, AREA))
    gamma, wall = get(columns, GAMMA), wall_in(columns, walls, count)
    rubber = rubber_in(columns, constants)
    f, m, e = get(columns, FORCE), get(columns, TORQUE), get(columns, WEIGHT)
    now = Load(gamma, rubber, wall, get(columns, PRESSURE), f, m, e)
    return cell, at_pressure(now, get(columns, BEFORE)), now


@kernel
def enter(lane, problem, columns):
    """Put a design into a lane, without load."""
    for i in range(len(problem)):
        columns[i, lane] = problem[i]
    columns[LENGTH, lane] = 0.5 * problem[LENGTH]
    columns[PRESSURE, lane], columns[BEFORE, lane], columns[WEIGHT, lane] = 1.0, 0.0, 1.0


@kernel
def lock(lane, columns):
    """Leave nothing in a lane but pressure: what a locked shape bears."""
    columns[FORCE, lane], columns[TORQUE, lane], columns[WEIGHT, lane] = 0.0, 0.0, 0.0


@kernel
def is_clamped(problem, walls):
    """Whether the fibers leave the clamped ends any meridional stretch; ``walls``: as of :class:`Kind`."""
    cell = problem[H], problem[D], problem[AREA]
    return lagrangian.clamped(cell, problem[GAMMA], wall_of(problem, walls)) > 0.0


@kernel
def settle(p, problem, clamped, row, told):
    """What needs no solving: an unpressed tube, one that is pushed, one that is not valid. Whether that is so."""
    values, bounds, status = told.values, told.bounds, told.status
    f, m = problem[FORCE], problem[TORQUE]
    if not (p >= 0.0 and clamped):
        status[row] = INVALID
    elif p == 0.0 and f == 0.0 and m == 0.0:
        half = 0.5 * problem[LENGTH]
        status[row] = OK
        for k in range(values.shape[1]):
            values[row, k], bounds[row, k] = 0.0, 0.0
        values[row, 0], values[row, 1], values[row, 4] = half, half, 1.0
        if values.shape[1] > OUTPUTS:
            values[row, OUTPUTS + OUTER] = sqrt(problem[INNER] + problem[AREA]) if problem[INNER] > 0.0 else 1.0
            values[row, OUTPUTS + STRETCH] = 1.0
    elif not p + f > 0.0 and not p == np.inf:
        status[row] = COMPRESSED
    else:
        return False
    return True


@kernel
def record(met, alpha, beta, rows, out, told):
    """Write what was found in the lanes that are met."""
    values, bounds, status, slack = told
    for lane in range(WIDTH):
        row = rows[lane]
        if (met >> lane) & 1:
            status[row] = OK
            slack[row] = ((alpha >> lane) & 1) | (((beta >> lane) & 1) << 1)
            for k in range(values.shape[1]):
                values[row, k], bounds[row, k] = out[0, k, lane], out[1, k, lane]

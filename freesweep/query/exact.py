"""Exact solution at points of an atlas, many in one call: the only door from the query to the solver."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..actuator import LARGEST_ANGLE, SMALLEST_DIFFERENCE
from ..scaling import OUTPUTS, output_scales, problem_rows, wall_volume_inside
from ..status import DEGENERATE, INVALID, NOT_CONVERGED, VALUED
from . import reference
from .reference import COLUMNS

CELLS = 24  # of the base mesh, as in sweeps: bounds decide where it is refined
SHARE = 512  # points that one thread solves at a time


def solve(kind, points, energy, accuracy, largest_pressure=None):
    """States of a kind at points (n, 15): name -> (n,) of numbers and ``_error`` bounds, ``status`` and flags.

    With ``largest_pressure`` [Pa] each design is followed up to there, for its ``limit_pressure``.
    """
    count = len(points)
    design = {name: np.ascontiguousarray(points[:, k]) for k, name in enumerate(COLUMNS)}
    status = np.full(count, NOT_CONVERGED, np.int8)
    apart = np.abs(design["alpha"] - design["beta"])
    wide = np.maximum(np.abs(design["alpha"]), np.abs(design["beta"])) >= LARGEST_ANGLE
    outer = design["radius"] + design["wall"]
    fibers = (design["fiber_radius"] < design["radius"]) | (design["fiber_radius"] > outer * (1.0 + 1e-12))
    status[(apart < SMALLEST_DIFFERENCE * (1.0 - 1e-12)) | wide | fibers] = INVALID
    status[apart == 0.0] = DEGENERATE
    good = np.flatnonzero(status == NOT_CONVERGED)
    own = {name: column[good] for name, column in design.items()}
    rows = problem_rows(own, energy) if len(good) else np.zeros((0, 11))
    held = kind in (reference.LENGTH_HELD, reference.ROTATION_HELD)
    names = ("force",) if kind == reference.LENGTH_HELD else ("torque",) if held else OUTPUTS
    found = {key: np.full(count, np.nan) for name in names for key in (name, f"{name}_error")}
    slack, stable, limits = np.zeros(count, np.int8), np.zeros(count, np.int8), np.full((count, 2), np.nan)
    pressure = np.full(len(good), np.inf) if kind == reference.LOCKED else own["pressure"] / own["c10"]

    def part(begin):
        some = slice(begin, begin + SHARE)
        if held:
            return _held(kind, rows[some], {name: column[some] for name, column in own.items()}, accuracy)
        most = None if largest_pressure is None else largest_pressure / own["c10"][some]
        return _free(rows[some], pressure[some], most, accuracy)

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        parts = list(pool.map(part, range(0, len(good), SHARE)))
    if parts:
        values, bounds, codes, flags, second = (np.concatenate(arrays) for arrays in zip(*parts))
        status[good] = codes
        valued = np.isin(codes, VALUED)
        scales = _scales(kind, own)
        for k, name in enumerate(names):
            number = values[:, k] * scales[name]
            if name == "volume":
                number = number - wall_volume_inside(own)
            found[name][good] = np.where(valued, number, np.nan)
            found[f"{name}_error"][good] = np.where(valued, bounds[:, k] * scales[name], np.nan)
        slack[good] = np.where(valued, flags, 0)
        if held:
            stable[good] = second
        else:
            stable[good] = valued
            limits[good] = second * own["c10"][:, None]
    found |= {"status": status, "slack_fiber": slack, "stable": stable}
    found |= {"limit_pressure": limits[:, 0], "limit_pressure_error": limits[:, 1]}
    return found


def _scales(kind, own):
    r, c10 = own["fiber_radius"], own["c10"]
    if kind == reference.LENGTH_HELD:
        return {"force": np.pi * r**2 * c10}
    if kind == reference.ROTATION_HELD:
        return {"torque": np.pi * r**3 * c10}
    return output_scales(own)


def _free(rows, pressure, most, accuracy):
    """Free states of rows (k, 11), each at its own pressure, and followed to ``most`` (k,) if that is given."""
    from ..solver.batch import uniform, walk_all

    count = len(rows)
    steps = 1 if most is None else 2
    pressures = pressure if most is None else np.column_stack([pressure, np.maximum(most, pressure)]).ravel()
    first = steps * np.arange(count + 1, dtype=np.int64)
    walks = walk_all(
        np.ascontiguousarray(rows), first, np.ascontiguousarray(pressures), uniform(CELLS), accuracy, soon=True
    )
    own = slice(0, None, steps)
    return walks.values[own], walks.bounds[own], walks.status[own], walks.slack[own], walks.limits


def _held(kind, rows, own, accuracy):
    """Held states, one design after the other; at zero pressure nothing has to be held."""
    from ..interpret import at_once
    from ..solver.find import HELD_LENGTH, HELD_ROTATION
    from ..solver.hold import hold_many
    from ..solver.status import HELD_IMPOSSIBLE

    count = len(rows)
    values, bounds = np.full((count, 1), np.nan), np.full((count, 1), np.nan)
    codes, slack, stable = (np.zeros(count, np.int64) for _ in range(3))
    length = kind == reference.LENGTH_HELD
    for k in range(count):
        one = {name: column[k] for name, column in own.items()}
        r, c10 = one["fiber_radius"], one["c10"]
        other = one["torque"] / (np.pi * r**3 * c10) if length else one["force"] / (np.pi * r**2 * c10)
        target = one["held"] * one["length"] / r if length else np.radians(one["held"])
        if one["pressure"] == 0.0 and other == 0.0 and target == (one["length"] / r if length else 0.0):
            values[k], bounds[k], stable[k] = 0.0, 0.0, 1
            continue
        if not length and rows[k, 0] == 0.0:
            codes[k] = HELD_IMPOSSIBLE
            continue
        course = np.zeros((1, 1, 3, 4))
        course[0, 0, :, 0] = rows[k, :3]
        value, bound = np.empty((1, 6)), np.empty((1, 6))
        code, safe, loose = (np.empty(1, np.int64) for _ in range(3))
        arguments = (
            rows[k], np.array([one["pressure"] / c10]), np.array([other]), np.array([target]),
            HELD_LENGTH if length else HELD_ROTATION, False, course, np.array([0, CELLS]),
            np.array([0.0, 0.5 * one["length"] / r]), accuracy, value, bound, code, safe, loose, np.empty(0),
            np.empty((1, 7, 0)),
        )  # fmt: skip
        if not at_once(1, hold_many, hold_many, *arguments):
            hold_many(*arguments)
        values[k], bounds[k], codes[k], stable[k] = value[0, 5], bound[0, 5], code[0], safe[0]
    return values, bounds, codes, slack, stable

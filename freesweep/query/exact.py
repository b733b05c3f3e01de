"""Exact solution at points of an atlas, many in one call: the only door from the query to the solver."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numba import config

from ..description.actuator import APART, LARGEST_ANGLE
from ..description.tube_model import MODELS
from ..scaling import ALONG, OUTPUTS, output_scales, problem_rows, wall_volume_inside
from ..solver.status import PENDING
from ..status import DEGENERATE, INVALID, NOT_CONVERGED, VALUED
from . import reference
from .reference import COLUMNS

CELLS = 24  # of the base mesh, as in sweeps: bounds decide where it is refined
SHARE = 512  # points that one thread solves at a time


def solve(kind, points, energy, accuracy, largest_pressure=None, model=MODELS["source"], cells=CELLS, thorough=True):
    """States of a kind at points (n, 15) of tubes of a ``model``: name -> (n,) of numbers and ``_error`` bounds, ``status``
    and flags, on base meshes of so many ``cells``.

    With ``largest_pressure`` [Pa] each design is followed up to there, for its ``limit_pressure``. Not ``thorough``: what
    vectors leave to the scalar kernels, a thousand times dearer, is left out.
    """
    count = len(points)
    design = {name: np.ascontiguousarray(points[:, k]) for k, name in enumerate(COLUMNS)}
    status = np.full(count, NOT_CONVERGED, np.int8)
    apart = np.abs(design["alpha"] - design["beta"])
    wide = np.maximum(np.abs(design["alpha"]), np.abs(design["beta"])) >= LARGEST_ANGLE
    outer = design["radius"] + design["wall"]
    fibers = (design["fiber_radius"] < design["radius"]) | (design["fiber_radius"] > outer * (1.0 + 1e-12))
    status[(apart < APART) | wide | fibers] = INVALID
    status[apart == 0.0] = DEGENERATE
    good = np.flatnonzero(status == NOT_CONVERGED)
    own = {name: column[good] for name, column in design.items()}
    rows = problem_rows(own, energy, model.is_thick, model.is_loose)
    held = kind in (reference.LENGTH_HELD, reference.ROTATION_HELD)
    names = ("force",) if kind == reference.LENGTH_HELD else ("torque",) if held else OUTPUTS
    names += ALONG if model.is_physical and not held else ()
    found = {key: np.full(count, np.nan) for name in names for key in (name, f"{name}_error")}
    slack, stable, limits = np.zeros(count, np.int8), np.zeros(count, np.int8), np.full((count, 2), np.nan)
    pressure = np.full(len(good), np.inf) if kind == reference.LOCKED else own["pressure"] / own["c10"]

    def part(begin):
        some = slice(begin, begin + SHARE)
        if held:
            part = {name: column[some] for name, column in own.items()}
            return _held(kind, rows[some], part, accuracy, cells, thorough)
        most = None if largest_pressure is None else largest_pressure / own["c10"][some]
        return _free(rows[some], pressure[some], most, accuracy, cells, thorough or most is not None)

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


def _free(rows, pressure, most, accuracy, cells, thorough):
    """Free states of problems (k, ...), each at its own pressure, and followed to ``most`` (k,) if that is given."""
    from ..solver import batch

    count = len(rows)
    steps = 1 if most is None else 2
    pressures = pressure if most is None else np.column_stack([pressure, np.maximum(most, pressure)]).ravel()
    first = steps * np.arange(count + 1, dtype=np.int64)
    rows, pressures = np.ascontiguousarray(rows), np.ascontiguousarray(pressures)
    if thorough or config.DISABLE_JIT:
        walks = batch.walk_all(rows, first, pressures, batch.uniform(cells), accuracy, soon=True)
    else:
        walks = batch._nothing(rows, len(pressures), batch.NOTHING)
        batch._walk_lanes(rows, first, pressures, cells, accuracy, batch.NOTHING, walks)
        walks.status[walks.status == PENDING] = NOT_CONVERGED
    own = slice(0, None, steps)
    return walks.values[own], walks.bounds[own], walks.status[own], walks.slack[own], walks.limits


def _held(kind, rows, own, accuracy, cells, thorough):
    """Held states of problems (k, ...), each at its own pressure."""
    from ..solver import hold_batch
    from ..solver.batch import uniform
    from ..solver.held.held_state import HELD_LENGTH, HELD_ROTATION
    from ..solver.problem import LENGTH, PROBLEM_SIZE

    count = len(rows)
    length = kind == reference.LENGTH_HELD
    targets = own["held"] * rows[:, LENGTH] if length else np.radians(own["held"])
    asked = (
        np.ascontiguousarray(rows), targets, HELD_LENGTH if length else HELD_ROTATION, np.arange(count + 1),
        own["pressure"] / own["c10"],
    )  # fmt: skip
    if thorough or config.DISABLE_JIT:
        found = hold_batch.hold_all(*asked, uniform(cells), accuracy, soon=True)
    else:
        found = hold_batch._pending(count)
        if rows.shape[1] == PROBLEM_SIZE:  # vectors hold the source's tubes only
            hold_batch._hold_lanes(*asked, cells, accuracy, found)
        found.status[found.status == PENDING] = NOT_CONVERGED
    return found.values[:, None], found.bounds[:, None], found.status, np.zeros(count, np.int64), found.stable

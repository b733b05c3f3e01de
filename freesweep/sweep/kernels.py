"""The machine code that a sweep needs, at hand before its threads would wait for each other to compile it."""

from threading import Timer

import numpy as np

from ..atlas.schema import YEOH
from ..scaling import problem_rows
from .jobs import in_order
from .plan import Job
from .solve import solve_shard

TYPICAL = {
    **{"alpha": 40.0, "beta": -20.0, "length": 20.0, "radius": 1.0, "fiber_radius": 1.0, "wall": 0.3},
    **{"c10": 1.0, "c01": 0.0, "force": 0.0, "torque": 0.0, "fiber_extension": 1.0},
}  # a tube that every kernel solves in no time, in its own radii and C10
PRESSURE = 0.1
PATIENCE = 3.0  # [s]: what takes longer is compiled, not loaded


def load(kinds, sweep, progress=False):
    """Compile, or load from disk, the kernels that begin every shard of such kinds of states: each solves one of them.

    Tubes that are the same all along begin with vectors of designs, and those with the family of their rubber; the scalar
    kernels, which some sweeps never need, are left to the thread that first does.
    """
    waiting = Timer(PATIENCE, print, ["compiling the kernels: up to a minute, once for each version"])
    jobs = (
        (_typical(kind, rubber), sweep.accuracy, not sweep.profiles) for kind in kinds for rubber in _rubbers(sweep)
    )
    if progress:
        waiting.start()
    try:
        for _ in in_order(solve_shard, jobs, 1):  # not here: LLVM calls back, and forgets an interrupt that comes then
            pass
    finally:
        waiting.cancel()


def _rubbers(sweep):
    """Constants, over C10, of one rubber of each family in a sweep: Yeoh's, Mooney and Rivlin's."""
    given = sweep.fixed | sweep.axes | (sweep.designs or {}).get("columns", {})
    cubic = [np.asarray(given[name]) for name in YEOH if name in given]
    if any(np.any(values != 0.0) for values in cubic):
        yield {"c20": 0.1}
    if all(np.any(values == 0.0) for values in cubic):
        yield {}


def _typical(kind, constants):
    """A job of one state, held at rest if its kind is held."""
    row = problem_rows({name: np.array([value]) for name, value in (TYPICAL | constants).items()}, "full")
    target = np.array([TYPICAL["length"] if kind == "blocked_force" else 0.0])
    return Job(kind, row, target, np.array([0, 1]), np.array([PRESSURE]), [], np.zeros(1, np.int64))

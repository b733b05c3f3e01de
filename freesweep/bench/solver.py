"""The benchmark of the solver: what it does per second beside its peers, with which errors, and how it scales."""

import os
import platform
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from .models import models
from .sample import Reference, reference, sample, typical

WANTED = 1e-6  # the error at which methods are compared: 95 % of the equilibria
ACCURACIES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
BASE_CELLS = 24
ROUNDS = 16  # samples for each thread, when threads are compared
SIZES = {  # designs, pressures, designs on which SciPy's tolerance is chosen, repeats
    False: (200, 20, 30, 5),
    True: (12, 5, 3, 1),
}


def measure(quick=False, say=lambda text: None) -> dict:
    """All figures of the benchmark as plain numbers: rates in equilibria per second, errors as in Reference.errors.

    ``quick`` takes few designs, for a first look; ``say`` is told what is being done.
    """
    designs, pressures, few, repeats = SIZES[quick]
    chosen = sample(designs, pressures)
    say("reference: quadrature of the first integral")
    quadrature, exact = _median(lambda: reference(chosen), 1)
    say("this solver")
    timer = _Timer(chosen, exact, repeats)
    _solve(chosen.some(1), WANTED)  # compiles, or loads what is compiled
    _scalar(chosen.some(1), WANTED, BASE_CELLS)
    rows = [timer.row("this solver", f"accuracy {WANTED:g}", lambda: _solve(chosen, WANTED))]
    equal = next((a for a in ACCURACIES if typical(exact.errors(_solve(chosen, a))) <= WANTED), ACCURACIES[-1])
    rows.append(timer.row("this solver, equal error", f"accuracy {equal:g}", lambda: _solve(chosen, equal)))
    rows.append(timer.row("its scalar kernel", f"accuracy {WANTED:g}", lambda: _scalar(chosen, WANTED, BASE_CELLS)))
    say("SciPy's solve_bvp")
    rows.append(_scipy(timer, few))
    rows.append(
        {"method": "first integral, NumPy", "setting": "the reference", "rate": chosen.size / quadrature}
        | {"error": 0.0, "largest": 0.0, "failed": 0, "threads": 1}
    )
    peer = rows[3]["rate"]
    for row in rows:
        row["times_scipy"] = row["rate"] / peer
    if not quick:  # other kernels, which take half a minute to compile
        say("models")
    asked = [] if quick else models(chosen, WANTED, lambda run: _median(run, repeats))
    say("scaling")
    return {
        "designs": designs, "pressures": pressures, "repeats": repeats, "machine": _machine(), "rows": rows,
        "threads": _threads(chosen, repeats), "grid": _grid(designs, pressures, repeats),
        "accuracy": [timer.row("", f"{a:g}", lambda a=a: _solve(chosen, a)) for a in ACCURACIES[1::2]],
        "cells": [timer.row("", str(n), lambda n=n: _scalar(chosen, 1e-2, n)) for n in (12, 24, 48, 96)],
        "newton_passes": _newton_passes(repeats), "models": asked,
    }  # fmt: skip


class _Timer:
    """Times one method on the sample, and judges it."""

    def __init__(self, chosen, exact, repeats):
        self.chosen, self.exact, self.repeats = chosen, exact, repeats

    def row(self, method, setting, run):
        """Rate, errors and number of failures of ``run``, which returns values (n, >= 3)."""
        seconds, values = _median(run, self.repeats)
        return self.judged(method, setting, self.chosen.size / seconds, values)

    def judged(self, method, setting, rate, values):
        """The same of values found at a known rate."""
        errors = self.exact.errors(values)
        return {
            "method": method, "setting": setting, "rate": rate, "error": typical(errors[np.isfinite(errors)]),
            "largest": float(np.max(errors, initial=0.0, where=np.isfinite(errors))),
            "failed": int(np.count_nonzero(~np.isfinite(errors))), "threads": 1,
        }  # fmt: skip


def _median(run, repeats, clock=time.thread_time):
    """Median seconds of ``run`` on one core, whatever else runs on the machine, and what it returned."""
    taken, found = [], None
    for _ in range(repeats):
        begun = clock()
        found = run()
        taken.append(clock() - begun)
    return float(np.median(taken)), found


def _solve(chosen, accuracy):
    """The sample by what a sweep calls."""
    from ..sweep.plan import FREE, Job
    from ..sweep.solve import solve_shard

    problems, first, pressures = chosen.listed()
    nothing = np.zeros(len(problems))
    return solve_shard(Job(FREE, problems, nothing, first, pressures, [], nothing), accuracy)[0]["values"]


def _scalar(chosen, accuracy, cells):
    """The sample by the kernel of one float at a time."""
    from ..solver.batch import uniform, walk_all

    return walk_all(*chosen.listed(), uniform(cells), accuracy, lanes=False).values


def _scipy(timer, few):
    """``solve_bvp`` at the loosest tolerance that reaches the wanted error on a few designs."""
    from .scipy_bvp import solve_all

    chosen, exact = timer.chosen, timer.exact
    part = chosen.some(few)
    mine = Reference(*(column[: part.size] for column in exact))
    for tolerance in TOLERANCES:
        values, _ = solve_all(part, mine.stretch, tolerance)
        solved = np.isfinite(values[:, 0])
        if typical(mine.errors(values)[solved]) <= WANTED:
            break
    values, seconds = solve_all(chosen, exact.stretch, tolerance)
    return timer.judged("SciPy solve_bvp", f"tol {tolerance:g}", 1.0 / seconds, values)


def _threads(chosen, repeats):
    """Rates of 1, 2, 4, ... threads up to one for each core, on equal samples: others are not equally hard."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    counts = sorted({*(2**k for k in range(20) if 2**k < cores), cores})
    seconds = {count: [] for count in counts}
    for _ in range(3 * repeats):  # in turns: a machine's pace drifts
        for count in counts:
            with ThreadPoolExecutor(count) as pool:
                begun = time.perf_counter()
                list(pool.map(lambda one: _solve(one, WANTED), [chosen] * (count * ROUNDS)))
                seconds[count].append((time.perf_counter() - begun) / (count * ROUNDS))
    return [{"threads": count, "rate": chosen.size / float(np.median(seconds[count]))} for count in counts]


def _grid(designs, pressures, repeats):
    """Rates of a quarter of the designs, of all, and of four times as many."""
    found = []
    for count in (max(1, designs // 4), designs, 4 * designs):
        chosen = sample(count, pressures)
        seconds, _ = _median(lambda: _solve(chosen, WANTED), repeats)  # noqa: B023
        found.append({"equilibria": chosen.size, "rate": chosen.size / seconds})
    return found


def _newton_passes(repeats):
    """Cost of a cell in a Newton pass, and of a place in vectors of designs, beside the machine's peak."""
    from ..solver.lanes.vector import WIDTH
    from ..solver.physics import membrane
    from .flops import density_flops
    from .lane_density import EXTRA as OF_VECTORS
    from .lane_density import lane_density_time
    from .peak import EXTRA, cell_time, peak

    density, most = density_flops(membrane), peak(repeats=repeats)
    found = []
    for designs, flops, seconds in (
        (1, density + EXTRA, cell_time(repeats)),
        (WIDTH, density + OF_VECTORS, lane_density_time(repeats)),
    ):
        found.append(
            {"designs": designs, "flops_per_cell": flops, "seconds_per_cell": seconds, "peak_flops_per_second": most}
            | {"share_of_peak": flops / seconds / most}
        )
    return found


def _machine():
    """What was measured on."""
    import numba
    import scipy

    from .peak import vector_width

    return {
        "processor": _processor(), "cores": os.cpu_count(), "doubles_per_vector": vector_width(),
        "python": platform.python_version(), "numba": numba.__version__, "numpy": np.__version__,
        "scipy": scipy.__version__,
    }  # fmt: skip


def _processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()

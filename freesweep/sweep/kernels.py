"""The machine code that a sweep needs, at hand before its threads would wait for each other to compile it.

What does not lie on disk yet is compiled by two processes side by side, as Numba's lock lets only one thread of a process
compile: about half the work each.
"""

import contextlib
import os
import subprocess
import sys
from pathlib import Path
from threading import Timer

import numpy as np

from ..atlas.schema import YEOH
from ..description.tube_model import THREADS
from ..scaling import problem_rows
from .duration import entry_points, is_held_aside
from .estimate import is_measured
from .jobs import in_order
from .plan import Job
from .solve import BASE_CELLS, solve_shard

TYPICAL = {
    **{"alpha": 40.0, "beta": -20.0, "length": 20.0, "radius": 1.0, "fiber_radius": 1.0, "wall": 0.3},
    **{"c10": 1.0, "c01": 0.0, "force": 0.0, "torque": 0.0, "fiber_extension": 1.0},
}  # a tube that every kernel solves in no time, in its own radii and C10
PRESSURE = 0.1
ASIDE = 0.01  # shortening and rotation [radian] of one that is held, but not at rest
PATIENCE = 3.0  # [s]: what takes this process longer is compiled, not loaded
CHILD = (
    "import os, sys; sys.path[:] = sys.argv[1].split(os.pathsep);"
    "from freesweep.sweep import kernels; kernels.compile_idle(sys.argv[2:])"
)
SOLVING = ("solve_lanes", "solve_physical")
THE_REST = (
    "carry_lanes",
    "carry_physical",
    "measure_lanes",
    "measure_physical",
    "start_lanes",
    "start_physical",
    "move_lanes",
    "move_physical",
    "query",
    "physical_states",
)  # takes another process about as long
ANSWERS = "interpolate"  # of the query's kernels one of the last that is compiled


def load(kinds, sweep, progress=False):
    """Compile, or load from disk, the kernels that begin every shard of such kinds of states: each solves one of them.

    Tubes that are the same all along begin with vectors of designs, and those with the family of their rubber; the scalar
    kernels, which most sweeps never need, are left to the thread that first does. What the atlas will measure itself with
    is compiled as well, where other processes can do it.
    """
    rubbers = list(_rubbers(sweep))
    if missing := _missing(kinds, sweep):
        if progress:
            print("compiling the kernels in two processes, once for each version: half a minute")
        _compile_aside(missing, rubbers)
    jobs = ((_typical(kind, rubber, sweep), sweep.accuracy) for kind in kinds for rubber in rubbers)
    waiting = Timer(PATIENCE, print, ["compiling the kernels, once for each version: a minute"])
    if progress and not missing:
        waiting.start()
    try:
        for _ in in_order(solve_shard, jobs, 1):  # not here: LLVM calls back, and forgets an interrupt that comes then
            pass
    finally:
        waiting.cancel()


def _missing(kinds, sweep):
    """Which entry points of those that two processes share do not lie on disk; none where nothing can be kept there."""
    needed = {name for kind in kinds for name in entry_points(kind, sweep)}
    missing, stored = needed.intersection(SOLVING + THE_REST) - _stored("solver"), _stored("query")
    if is_measured(sweep) and not sweep.varies:
        missing |= {"query"} if ANSWERS not in stored else set()
        missing |= {"physical_states"} - stored if sweep.is_physical else set()
    return missing


def of_measuring(sweep) -> tuple:
    """What :func:`compile_idle` loads, and does not compile, of the kernels with which an atlas measures itself."""
    names = {ANSWERS: "query"} | ({"physical_states": "physical_states"} if sweep.is_physical else {})
    if not is_measured(sweep) or sweep.varies or not names.keys() <= _on_disk("query"):
        return ()
    return (*names.values(), *_families(_rubbers(sweep)))


def _stored(room):
    """Names of the entry points of a room whose machine code lies on disk, and all of them where none can."""
    from numba import config

    from ..jit import cache_folder

    folder = cache_folder(room)
    if folder is None or config.DISABLE_JIT or not _can_keep(folder):  # each process compiles for itself, or nothing is
        return {*SOLVING, *THE_REST, ANSWERS}
    return _on_disk(room)


def _on_disk(room):
    """Names of the entry points of a room whose machine code lies on disk."""
    from ..jit import cache_folder
    from ..kernel_cache import compiled

    return {name.rpartition(".")[2] for name in compiled(cache_folder(room))}


def _can_keep(folder):
    """Whether a folder takes files."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


def _compile_aside(missing, rubbers):
    """Let two other processes compile what is ``missing``; what they could not do is left to this one."""
    families = _families(rubbers)
    with contextlib.ExitStack() as running, contextlib.suppress(OSError):
        children = []
        for part in (SOLVING, THE_REST):
            if own := missing.intersection(part):
                words = [sys.executable, "-c", CHILD, os.pathsep.join(sys.path), *families, *own]
                silent = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
                children.append(running.enter_context(subprocess.Popen(words, **silent)))
                running.callback(children[-1].kill)
        for child in children:
            child.wait()


def _families(rubbers):
    return ["Yeoh" if rubber else "Mooney-Rivlin" for rubber in rubbers]


def compile_idle(words):
    """Compile the entry points named among the ``words``, for the families of rubbers among them; no state is solved."""
    from ..query.idle import compile_kernels, compile_physical
    from ..solver.lanes.by_middle import measure_lanes, measure_physical
    from ..solver.lanes.free import carry_lanes, carry_physical, solve_lanes, solve_physical
    from ..solver.lanes.held import move_lanes, move_physical, start_lanes, start_physical
    from ..solver.problem import MOONEY_RIVLIN, PROBLEM_SIZE
    from ..solver.problem import YEOH as YEOH_COLUMNS

    numbers, whole, states = np.empty(0), np.empty(0, np.int64), np.empty((0, 5))
    problems, first = np.empty((0, PROBLEM_SIZE)), np.zeros(1, np.int64)
    held = problems, numbers, numbers, whole, True
    for name, constants in (("Mooney-Rivlin", MOONEY_RIVLIN), ("Yeoh", YEOH_COLUMNS)):
        if name not in words:
            continue
        if "carry_physical" in words:
            carry_physical(problems, first, numbers, whole, constants, 1, states, states, whole, numbers, numbers)
        if "solve_physical" in words:
            solve_physical(
                problems, whole, numbers, numbers, whole, constants, 1, 1, 1.0, states, states, whole, whole, states
            )
        if "measure_physical" in words:
            measure_physical(problems, whole, states, numbers, constants, 1, 1, states, states, states)
        if "physical_states" in words:
            compile_physical(constants)
        if "carry_lanes" in words:
            carry_lanes(problems, first, numbers, whole, constants, states, states, whole, numbers, numbers)
        if "solve_lanes" in words:
            solve_lanes(
                problems, whole, numbers, numbers, whole, constants, 1, 1.0, states, states, whole, whole, states
            )
        if "measure_lanes" in words:
            measure_lanes(problems, whole, states, numbers, constants, 1, states, states, states)
        if "start_lanes" in words:
            start_lanes(*held, constants, numbers, numbers, whole, whole, states)
        if "start_physical" in words:
            start_physical(*held, constants, 1, numbers, numbers, whole, whole, states)
        if "move_lanes" in words:
            move_lanes(problems, numbers, whole, True, constants, numbers, numbers, numbers)
        if "move_physical" in words:
            move_physical(problems, numbers, whole, True, constants, 1, numbers, numbers, numbers)
    if "query" in words:
        compile_kernels()


def _rubbers(sweep):
    """Constants, over C10, of one rubber of each family in a sweep: Yeoh's, Mooney and Rivlin's."""
    given = sweep.fixed | sweep.axes | (sweep.designs or {}).get("columns", {})
    cubic = [np.asarray(given[name]) for name in YEOH if name in given]
    if any(np.any(values != 0.0) for values in cubic):
        yield {"c20": 0.1}
    if all(np.any(values == 0.0) for values in cubic):
        yield {}


def _typical(kind, constants, sweep):
    """A job of one state of a sweep's model, held if its kind is held, at rest if all of them are; of a tube that varies if
    the sweep's do, if only in name.
    """
    design = {name: np.array([value]) for name, value in (TYPICAL | constants).items()}
    fibers = "loose" if sweep.model.is_loose else "bonded"
    row = problem_rows(design, "full", sweep.model.is_thick, THREADS[len(sweep.families), fibers])
    aside = ASIDE if is_held_aside(sweep) else 0.0
    target = np.array([TYPICAL["length"] * (1.0 - aside) if kind == "blocked_force" else -aside])
    courses = []
    if sweep.varies:
        halves = np.zeros((2, 1, 3, 4))
        halves[:, 0, :, 0] = row[0, :3]
        if sweep.is_of_bodies:
            halves = np.stack([halves, np.zeros_like(halves)], axis=2)
            halves[:, 0, 1, 0, 0] = 1.0
        courses = [((halves, np.arange(3) * BASE_CELLS, np.linspace(0.0, TYPICAL["length"], 3)), 0.0)]
    return Job(kind, row, target, np.array([0, 1]), np.array([PRESSURE]), courses, np.zeros(1, np.int64))

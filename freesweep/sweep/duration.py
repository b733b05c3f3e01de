"""How long a sweep will take: from a sample of its problems, or, for a small one, from what is typical.

Sampling needs Numba and machine code, half a second to load: more than a small sweep is worth.
"""

import time

import numpy as np

from . import designs
from .plan import FREE

VARYING = 1e-3  # [s] of a state, on one core, where tubes vary; where they do not, of each kind:
TYPICAL = {FREE: 5e-6} | dict.fromkeys(("blocked_force", "blocked_torque"), 3e-4)
PHYSICAL = {FREE: 2e-5} | dict.fromkeys(("blocked_force", "blocked_torque"), 2e-3)
BOTH = {FREE: 7e-3} | dict.fromkeys(("blocked_force", "blocked_torque"), 5e-2)  # of physical tubes that vary
COMPARED = 25.0  # [s] in which an atlas of bodies measures itself, each solved for it
FOLLOWED = 6e-3  # [s] of each tube that varies: its course is made of splines
OTHER = 6e-6  # [s] of each grid point: the atlas is made, compressed, and measures itself
LITTLE = 600.0  # [s] up to which it is not worth a sample, which takes more than a second
AT_REST = {"force": 0.0, "torque": 0.0, "fiber_extension": 1.0}
MUCH = 0.1  # share of the whole time, below which a kind of states is worth no sample
SAMPLE_SECONDS, SAMPLES = 0.05, 64  # of each kind of state
TOGETHER = 32  # problems that are solved at once, as vectors need them


def entry_points(kind, sweep) -> tuple:
    """Names of the solver's entry points for a kind of states: those of vectors, where there are any, else of meshes."""
    if sweep.varies:
        return ("follow_many",) if kind == FREE else ("hold_many",)
    if kind == FREE:
        words = ("carry", "solve", "measure") if is_loaded(sweep) else ("carry", "solve")  # loaded, branches turn
    else:
        words = ("start", "move", "solve") if is_held_aside(sweep) else ("start", "solve")
    return tuple(f"{word}_{'physical' if sweep.is_physical else 'lanes'}" for word in words)


def is_loaded(sweep) -> bool:
    """Whether there are forces, torques or extended fibers in a sweep."""
    given = _given(sweep)
    return any(np.any(np.asarray(given[name]) != rest) for name, rest in AT_REST.items() if name in given)


def is_held_aside(sweep) -> bool:
    """Whether what is held in a sweep is no straight cylinder, or need not be."""
    given, at_rest = _given(sweep), designs.AT_REST
    moved = any(np.any(np.asarray(given[name]) != rest) for name, rest in at_rest.items() if name in given)
    return sweep.is_physical or is_loaded(sweep) or "held_length" in given or moved


def _given(sweep):
    return sweep.fixed | sweep.axes | (sweep.designs or {}).get("columns", {})


def time_of(sweep, tables, equilibria, sizes, threads, measured) -> str:
    """In words; ``equilibria`` of each kind, and their ``tables``, without any if they are too many to be compared;
    ``sizes``: designs of each; ``measured``: whether the atlas measures itself.
    """
    own = PHYSICAL if sweep.is_physical else TYPICAL
    each = {kind: VARYING if sweep.varies else own[kind] for kind in equilibria}
    if sweep.varies:
        bodies = {kind: tables[kind].count if tables else size for kind, size in sizes.items()}
        own = BOTH if sweep.is_physical else each
        each = {kind: own[kind] + FOLLOWED * bodies[kind] / max(equilibria[kind], 1) for kind in each}
    sampled = bool(tables) and _seconds(sweep, equilibria, each, 1) > LITTLE and _is_compiled(equilibria, sweep)
    if sampled:
        together = 1 if sweep.varies else TOGETHER
        share = {kind: each[kind] * count for kind, count in equilibria.items()}
        for kind in (kind for kind in share if share[kind] > MUCH * sum(share.values())):
            each[kind] = _sample(tables[kind], sweep.accuracy, together)
    took = _seconds(sweep, equilibria, each, threads)
    if measured and sweep.is_of_bodies and not sweep.profiles:
        took += COMPARED / threads
    for unit, size in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0), ("seconds", 1.0)):
        if took > 2.0 * size:
            words = f"about {took / size:.0f} {unit}"
            break
    else:
        words = "a few seconds"
    return f"{words} on {threads} thread{'s' * (threads > 1)}" + (
        "" if sampled else ", a guess before anything is solved"
    )


def _seconds(sweep, equilibria, each, threads):
    return (sum(each[kind] * count for kind, count in equilibria.items()) + OTHER * sweep.points) / threads


def _is_compiled(kinds, sweep):
    """Whether the kernels of such kinds of states lie on disk: a dry run compiles nothing."""
    from ..jit import cache_folder
    from ..kernel_cache import compiled

    needed = {name for kind in kinds for name in entry_points(kind, sweep)}
    return needed <= {stem.rpartition(".")[2] for stem in compiled(cache_folder("solver"))}


def _sample(table, accuracy, together):
    """Seconds of one equilibrium on one core, whatever else the machine does."""
    from .solve import solve_shard

    solve_shard(table.job(0, min(1, table.count)), accuracy)  # loads the machine code
    begun, solved = time.thread_time(), 0
    for a in np.random.default_rng(0).integers(max(table.count, 1), size=min(SAMPLES, table.count)).tolist():
        solved += len(solve_shard(table.job(a, min(a + together, table.count)), accuracy)[0])
        if time.thread_time() - begun > SAMPLE_SECONDS:
            break
    return (time.thread_time() - begun) / max(solved, 1)

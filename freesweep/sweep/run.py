"""Run a sweep: shards of distinct problems on threads, resumed after any interruption, collected into an atlas."""

import os
import platform
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from itertools import pairwise
from pathlib import Path

import numpy as np

from ..atlas.store import Atlas, AtlasError, open_atlas, save_atlas
from ..status import STATUSES
from .collect import collect
from .identity import fingerprint, identify
from .plan import plan as make_plan
from .shards import BLOCKED, FIELDS, Shards, SweepError
from .spec import Sweep, read_file

SHARD_EQUILIBRIA = 8192  # a fraction of a second of work: what an interruption can cost, for each thread
BASE_CELLS = 24


def run_sweep(spec, out, *, threads=None, progress=True, overwrite=False) -> Atlas:
    """Solve a sweep and store its atlas.

    Parameters
    ----------
    spec : path of a TOML specification, or a :class:`freesweep.sweep.spec.Sweep`
    out : path of the atlas to make
    threads : how many threads solve; default: one for each core. The result does not depend on it
    progress : show a bar and a summary
    overwrite : replace an atlas that was made from another specification

    An interrupted run goes on where it stopped when it is started again. Returns the opened :class:`Atlas`. Raises
    SpecificationError, :class:`SweepError`, EnvironmentFault.
    """
    begun = time.perf_counter()
    sweep = spec if isinstance(spec, Sweep) else read_file(spec)
    out = Path(out)
    if threads is not None and threads < 1:
        raise ValueError(f"threads: found {threads}; give 1 or more, or None for one on each core")
    identity = identify(sweep)
    if out.exists() and not overwrite and (atlas := _finished(out, identity)):
        Shards(out, identity).clear()
        if progress:
            print(f"{out} is complete already, from this specification and this code")
        return atlas
    plan = make_plan(sweep)
    parts = split(plan)
    shards = Shards(out, identity | {"plan_sha256": fingerprint(plan, parts)})
    if overwrite:
        shards.clear(only_others=True)
    done = shards.open()
    results = _solve_all(plan, parts, done, shards, (sweep.accuracy, sweep.blocked), threads or _cores(), progress)
    solving = time.perf_counter() - begun
    dataset = collect(sweep, plan, results)
    dataset.attrs = {
        "title": sweep.title,
        "Conventions": "CF-1.11",
        "source": f"freesweep {identity['version']}",
        "specification": sweep.text,
        **identity,
        "started": shards.started,
        "energy": sweep.energy,
        "accuracy": sweep.accuracy,
        "distinct_problems": len(plan.problems),
        "distinct_equilibria": plan.equilibria,
        "python": platform.python_version(),
        "numpy": np.__version__,
    }
    save_atlas(dataset, out)
    shards.clear()
    atlas = open_atlas(out)
    if progress:
        print(summary(atlas, plan, solving, time.perf_counter() - begun))
    return atlas


def _finished(out, identity):
    """The atlas at ``out`` if it is this sweep's; raises if it is another's."""
    try:
        atlas = open_atlas(out)
    except AtlasError as error:
        raise SweepError(f"{error}; choose another output, or overwrite it") from error
    for key, wanted in identity.items():
        if (found := atlas.data.attrs.get(key)) != wanted:
            atlas.close()
            raise SweepError(
                f"{out} exists and its {key} differs: {found!r:.80} there, {wanted!r:.80} now; choose another output,"
                " or overwrite it"
            )
    return atlas


def split(plan):
    """Shards of whole problems: a list of (first, last + 1)."""
    edges, last = [0], 0
    for k in range(1, len(plan.problems) + 1):
        if plan.first[k] - last >= SHARD_EQUILIBRIA or k == len(plan.problems):
            edges.append(k)
            last = plan.first[k]
    return list(pairwise(edges))


def solve_shard(problems, first, pressures, accuracy, blocked=False):
    """Solve some problems: the results of the kernels as a dictionary of arrays."""
    from ..solver.branch import walk_many

    count = len(pressures)
    results = {
        "values": np.empty((count, 5)),
        "bounds": np.empty((count, 5)),
        "status": np.empty(count, np.int64),
        "slack": np.empty(count, np.int64),
        "limits": np.empty((len(problems), 2)),
    }
    no_stations, no_profiles = np.empty(0), np.empty((count, 0, 0))
    walk_many(
        problems, first - first[0], pressures, np.empty((0, 1, 3, 4)), np.array([0, BASE_CELLS]), np.zeros(2), accuracy,
        *(results[name] for name in FIELDS), no_stations, no_profiles,
    )  # fmt: skip
    if blocked:
        from ..solver.block import block_many

        results |= {"blocked": np.empty((count, 2)), "blocked_bounds": np.empty((count, 2))}
        results |= {"blocked_status": np.empty((count, 2), np.int64), "blocked_stable": np.empty((count, 2), np.int64)}
        block_many(
            problems, first - first[0], pressures, BASE_CELLS, accuracy, *(results[name] for name in BLOCKED)
        )  # fmt: skip
    return {name: array.astype(np.int8) if array.dtype == np.int64 else array for name, array in results.items()}


def _solve_all(plan, parts, done, shards, asked, threads, progress):
    """Results of all shards, those found on disk among them, in order."""
    from ..jit import is_compiled

    if progress and not is_compiled("solver"):
        print("compiling the kernels: half a minute, once for each version")
    none = (plan.problems[:0], plan.first[:1], plan.pressures[:0])
    empty = solve_shard(*none, *asked)  # compiles, or loads what is compiled
    todo = [index for index in range(len(parts)) if index not in done]
    finished = sum(int(plan.first[parts[index][1]] - plan.first[parts[index][0]]) for index in done)
    bar = _bar(plan.equilibria, finished, progress)
    pool = ThreadPoolExecutor(threads)
    try:
        running = {}
        while todo or running:
            while todo and len(running) < 2 * threads:
                index = todo.pop(0)
                a, b = parts[index]
                job = (
                    plan.problems[a:b],
                    plan.first[a : b + 1],
                    plan.pressures[plan.first[a] : plan.first[b]],
                    *asked,
                )
                running[pool.submit(solve_shard, *job)] = index
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                index = running.pop(future)
                done[index] = future.result()
                shards.save(index, done[index])
                bar.update(len(done[index]["status"]))
    finally:
        pool.shutdown(cancel_futures=True)
        bar.close()
    ordered = [done[index] for index in range(len(parts))] or [empty]
    return {name: np.concatenate([part[name] for part in ordered]) for name in empty}


def _bar(total, finished, progress):
    from tqdm import tqdm

    return tqdm(
        total=total,
        initial=finished,
        unit=" equilibria",
        unit_scale=True,
        disable=not progress,
        dynamic_ncols=True,
        leave=True,
    )


def _cores():
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def summary(atlas, plan, solving, total) -> str:
    """What was done, failures grouped by status, once."""
    lines = [
        f"{atlas.data['status'].size:,} grid points, {plan.equilibria:,} distinct equilibria of {len(plan.problems):,}"
        f" distinct problems, {total:.1f} s ({solving:.1f} s solving)"
    ]
    sentences = {status.meaning: status.sentence for status in STATUSES}
    lines += [f"  {count:>12,}  {meaning}: {sentences[meaning]}" for meaning, count in atlas.status_counts().items()]
    return "\n".join([*lines, f"  {atlas.path}"])

"""What a sweep will need: bytes of memory and disk, and time. Refused before it starts where there is not enough."""

import math
import os
import shutil
import time
from pathlib import Path

import numpy as np

from ..atlas.files import EnvironmentFault, space
from ..atlas.schema import HELD, VARIABLES
from .collect import groups
from .plan import FREE, plan
from .records import LIMIT, state

BASE_MEMORY = 400_000_000  # [bytes] of the program, its kernels and a few shards
DESIGN_MEMORY = 72  # [bytes] of each design while a plan is made
SHRINKS = 0.9  # of the numbers when they are compressed, at least
MOST_PLANNED = 2_000_000  # designs that a dry run compares: some seconds
SAMPLE_SECONDS, SAMPLES = 1.0, 256


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def designs(sweep) -> int:
    """Designs of the largest table of a sweep's plan."""
    sizes = dict(zip(sweep.dims, sweep.shape))
    kinds = [HELD, *(VARIABLES[kind].without for kind in sweep.blocked)]
    return max(
        math.prod(size for name, size in sizes.items() if name not in (*without, "pressure")) for without in kinds
    )


def memory(sweep) -> int:
    """Bytes of memory, at most."""
    return BASE_MEMORY + DESIGN_MEMORY * designs(sweep)


def check_memory(sweep):
    """Refuse a sweep whose plan does not fit into this machine; raises EnvironmentFault."""
    if not hasattr(os, "sysconf"):
        return
    there = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if memory(sweep) > there:
        raise EnvironmentFault(
            f"{designs(sweep):,} designs need {memory(sweep):,} bytes of memory, this machine has {there:,};"
            " split the sweep"
        )


def disk(sweep, tables) -> tuple:
    """Bytes of the shards while a sweep runs, and of its atlas, at most."""
    shards = sum(table.equilibria * state(kind).itemsize for kind, table in tables.items())
    shards += tables[FREE].count * LIMIT.itemsize
    steps = len(tables[FREE].pressure)
    numbers = sum(
        group.grid.size * (steps if group.pressure else 1) * sum(dtype.itemsize for dtype in group.variables.values())
        for group in groups(sweep, tables, dict.fromkeys(tables))
    )
    return shards, int(SHRINKS * numbers) + 1_000_000


def check_disk(sweep, tables, out, done=()) -> int:
    """Bytes of the atlas; raises EnvironmentFault if there is not room for what is still to be written."""
    shards, atlas = disk(sweep, tables)
    here = sum(path.stat().st_size for path in done.values()) if done else 0
    needed = max(shards - here, 0) + atlas
    if needed > shutil.disk_usage(Path(out).parent).free:
        raise EnvironmentFault(f"cannot begin {out}: {space(Path(out).parent, needed)}")
    return atlas


def seconds(sweep, tables, threads):
    """Estimated time of the solver [s], from a sample of the problems; None where the kernels are still to be compiled."""
    from ..jit import is_compiled
    from .solve import solve_shard

    if not is_compiled("solver"):
        return None
    total = 0.0
    for table in tables.values():
        solve_shard(table.job(0, 0), sweep.accuracy)  # loads the machine code
        begun, solved = time.perf_counter(), 0
        for a in np.random.default_rng(0).integers(max(table.count, 1), size=min(SAMPLES, table.count)).tolist():
            solved += len(solve_shard(table.job(a, a + 1), sweep.accuracy)[0])
            if time.perf_counter() - begun > SAMPLE_SECONDS:
                break
        total += (time.perf_counter() - begun) * table.equilibria / max(solved, 1)
    return total / threads


def dry_run(sweep, out, threads=None) -> str:
    """What a sweep will solve, need and take, in words; of a very large one, what can be said at once."""
    check_memory(sweep)
    lines = [sweep.title] if sweep.title else []
    if designs(sweep) > MOST_PLANNED:
        lines += [f"{sweep.points:,} grid points, too many to be compared at once -> {out}"]
        return "\n".join([*lines, f"memory: {memory(sweep) / 1e6:,.0f} MB at most"])
    tables = plan(sweep)
    shards, atlas = disk(sweep, tables)
    lines.append(f"{sweep.points:,} grid points, {tables[FREE].equilibria:,} distinct equilibria -> {out}")
    lines += [
        f"{kind.replace('_', ' ')}: {table.grid.size * len(table.pressure):,} grid points, {table.equilibria:,} held states"
        for kind, table in tables.items()
        if kind != FREE
    ]
    lines.append(f"memory: {memory(sweep) / 1e6:,.0f} MB at most")
    folder = Path(out).parent
    free = f"{shutil.disk_usage(folder).free / 1e6:,.0f} MB free" if folder.is_dir() else f"there is no folder {folder}"
    lines.append(f"disk: {atlas / 1e6:,.1f} MB at most, {shards / 1e6:,.1f} MB more while it runs; {free}")
    took = seconds(sweep, tables, threads or cores())
    lines.append(
        "time: not known before the kernels are compiled, in the first sweep" if took is None else _spell(took)
    )
    return "\n".join(lines)


def _spell(took):
    for unit, size in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if took > 2.0 * size:
            return f"time: about {took / size:.1f} {unit}"
    return f"time: about {took:.0f} seconds" if took > 2.0 else "time: a few seconds"

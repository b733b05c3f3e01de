"""What a sweep will need: bytes of memory and disk, and time. Refused before it starts where there is not enough."""

import math
import os
import shutil
from pathlib import Path

from ..atlas.files import EnvironmentFault, space
from .collect import groups
from .duration import time_of
from .plan import FREE, kinds, plan
from .records import LIMIT, state
from .shard_file import MOST_KEPT

BASE_MEMORY = 400_000_000  # [bytes] of the program, its kernels and what is solved at the time
DESIGN_MEMORY = 80  # [bytes] of each design while a plan is made
LEAST_MEASURED, MOST_MEASURED = 2, 15_000_000  # points of an atlas that measures itself
LEAST_OF_BODIES = 5_000  # the same of bodies, each of which is followed for it
MEASURING, POINT_MEMORY = 200_000_000, 110  # [bytes] of its kernels, and of each point in a table
TWO_TABLES = 5_000_000  # points up to which it makes two at a time
SHRINKS = 0.9  # of the numbers when they are compressed, at least
FILE = 1_000_000  # [bytes] of an atlas without its numbers, at most
MOST_PLANNED = 200_000  # designs that a dry run compares: a third of a second


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def grids(sweep) -> dict:
    """Designs of each kind of state: kind -> count."""
    sizes = dict(zip(sweep.dims, sweep.shape))
    return {
        kind: math.prod(size for name, size in sizes.items() if name not in (*without, "pressure"))
        for kind, without in kinds(sweep).items()
    }


def is_measured(sweep) -> bool:
    """Whether the atlas compares its answers between the nodes with exact ones when it is made."""
    least = LEAST_OF_BODIES if sweep.is_of_bodies else LEAST_MEASURED
    return least <= sweep.points <= MOST_MEASURED


def memory(sweep) -> int:
    """Bytes of memory, at most."""
    points = max(sweep.points, 2 * min(sweep.points, TWO_TABLES))
    measuring = MEASURING + POINT_MEMORY * points if is_measured(sweep) else 0
    return BASE_MEMORY + max(DESIGN_MEMORY * max(grids(sweep).values()) + MOST_KEPT, measuring)


def check_memory(sweep):
    """Refuse a sweep whose plan does not fit into this machine; raises EnvironmentFault."""
    if not hasattr(os, "sysconf"):
        return
    there = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if memory(sweep) > there:
        raise EnvironmentFault(
            f"{max(grids(sweep).values()):,} designs need {memory(sweep):,} bytes of memory, this machine has {there:,};"
            " split the sweep"
        )


def disk(sweep, equilibria) -> tuple:
    """Bytes of the shards while a sweep runs, and of its atlas, at most; ``equilibria`` of each kind."""
    shards = (
        sum(count * state(kind, sweep.is_physical).itemsize for kind, count in equilibria.items())
        + grids(sweep)[FREE] * LIMIT.itemsize
    )
    steps = len(sweep.axes.get("pressure", [0.0]))
    numbers = sum(
        group.grid.size * (steps if group.pressure else 1) * sum(dtype.itemsize for dtype in group.variables.values())
        for group in groups(sweep)
    )
    return shards, int(SHRINKS * numbers) + FILE


def check_disk(sweep, equilibria, out, done) -> int:
    """Bytes of the atlas; raises EnvironmentFault if there is no room for what is still to be written."""
    shards, atlas = disk(sweep, equilibria)
    needed = max(shards - sum(path.stat().st_size for path in done.values()), 0) + atlas
    if needed > shutil.disk_usage(Path(out).parent).free:
        raise EnvironmentFault(f"cannot begin {out}: {space(Path(out).parent, needed)}")
    return atlas


def dry_run(sweep, out, threads=None) -> str:
    """What a sweep will solve, need and take, in words; of a large one, at most."""
    check_memory(sweep)
    steps = len(sweep.axes.get("pressure", [0.0]))
    tables = plan(sweep) if sum(grids(sweep).values()) <= MOST_PLANNED else {}
    equilibria = {
        kind: tables[kind].equilibria if tables else size * (steps + (kind == FREE))
        for kind, size in grids(sweep).items()
    }
    most = "" if tables else "at most "
    lines = [sweep.title] if sweep.title else []
    problems = tables[FREE].count if tables else grids(sweep)[FREE]
    lines.append(
        f"{sweep.points:,} grid points, {most}{equilibria[FREE]:,} distinct equilibria of {problems:,} distinct problems"
        f" -> {out}"
    )
    lines += [
        f"{kind.replace('_', ' ')}: {grids(sweep)[kind] * steps:,} grid points, {most}{count:,} held states"
        for kind, count in equilibria.items()
        if kind != FREE
    ]
    if sweep.interpolation_tolerance is not None:
        lines.append(f"axes grow for interpolation_tolerance, to {sweep.budget:,} grid points at most")
    shards, atlas = disk(sweep, equilibria)
    folder = Path(out).parent
    free = f"{shutil.disk_usage(folder).free / 1e6:,.0f} MB free" if folder.is_dir() else f"there is no folder {folder}"
    lines += [
        f"memory: {memory(sweep) / 1e6:,.0f} MB at most",
        f"disk: {atlas / 1e6:,.1f} MB at most, {shards / 1e6:,.1f} MB more while it runs; {free}",
        f"time: {time_of(sweep, tables, equilibria, grids(sweep), threads or cores(), is_measured(sweep))}",
    ]
    return "\n".join(lines)

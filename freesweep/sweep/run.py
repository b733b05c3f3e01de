"""Run a sweep: shards of distinct problems on threads, resumed after any interruption, collected into an atlas."""

from __future__ import annotations

import contextlib
import os
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from ..atlas.store import Atlas, AtlasError, open_atlas
from ..atlas.write import AtlasWriter, packed, parts
from ..description.given import described
from ..description.options import read_count, read_path, read_switch
from ..description.quantities import Path
from ..description.unit_warnings import warn_of
from ..status import STATUSES
from . import estimate, kernels
from .atlas_name import named_otherwise
from .changes import changes
from .collect import groups
from .grid import coordinates
from .identity import fingerprint, identify
from .jobs import bar, in_order
from .meanwhile import make_ready
from .plan import plan as make_plan
from .provenance import provenance
from .records import Records, state
from .refine_axes import graded
from .remote import solve_remotely
from .rubber import warn_beyond_range
from .shard_file import Contents
from .shards import Shards, SweepError
from .solve import solve_shard
from .spec import Sweep, read_file
from .unit_doubts import doubts_of

SHARD_EQUILIBRIA = 8192  # a second of work or less: what an interruption can cost, for each thread
# of a held state, of tubes that vary, of physical ones: in those of a free state of others
HELD_COST, VARYING_COST, PHYSICAL_COST = 32, 8, 16


def run_sweep(
    spec: Path | Sweep,
    out: Path,
    *,
    threads: int | None = None,
    executor: Any = None,
    progress: bool = True,
    overwrite: bool = False,
) -> Atlas:
    """Solve a sweep and store its atlas.

    Parameters
    ----------
    spec : path of a TOML specification, or a :class:`freesweep.sweep.spec.Sweep`
    out : path of the atlas to make
    threads : how many threads solve; default: one for each core. The result does not depend on it
    executor : a ``concurrent.futures.Executor`` that solves instead, such as ``client.get_executor()`` of Dask. Its workers
        have to see the folder of ``out`` under the same path; the bits are the same
    progress : show a bar and a summary
    overwrite : replace an atlas that was made from another specification

    An interrupted run goes on where it stopped when it is started again. Memory does not grow with the grid but for some
    whole numbers of each design. Returns the opened :class:`Atlas`. Raises SpecificationError, :class:`SweepError`,
    EnvironmentFault.
    """
    return run(spec, out, threads, executor, progress, overwrite, stacklevel=3)


def run(spec, out, threads, executor, progress, overwrite, stacklevel, modules=(), look=None) -> Atlas:
    """What :func:`run_sweep` does; warnings name the line ``stacklevel`` calls above.

    ``modules`` are imported while it solves, and ``look(data)`` is called beside the rest with the Dataset before it is an
    atlas, if the atlas measures itself; nobody hears of a fault there.
    """
    begun = time.perf_counter()
    spec, out, threads, progress, overwrite = _read(spec, out, threads, executor, progress, overwrite)
    sweep = spec if isinstance(spec, Sweep) else read_file(spec)
    warn_of(doubts_of(sweep), stacklevel)
    identity, shards = identify(sweep), Shards(out)
    if atlas := _complete(out, identity, sweep.text, overwrite, progress):
        shards.tidy(identity)
        return atlas
    estimate.check_memory(sweep)
    shards.hold()
    try:
        if atlas := _complete(out, identity, sweep.text, overwrite, progress):  # another process was faster
            shards.clear()
            return atlas
        sweep = graded(sweep, print if progress else lambda _: None)
        tables = make_plan(sweep)
        split_up = {kind: split(table, sweep) for kind, table in tables.items()}
        done = shards.open(identity | {"plan_sha256": fingerprint(tables, split_up)}, sweep.text, overwrite)
        needed = estimate.check_disk(sweep, {kind: table.equilibria for kind, table in tables.items()}, out, done)
        threads = threads or estimate.cores()
        todo = [
            (kind, k, a, b) for kind, own in split_up.items() for k, (a, b) in enumerate(own) if (kind, k) not in done
        ]
        if executor is None:
            kernels.load(dict.fromkeys(kind for kind, *_ in todo), sweep, progress)
        with ThreadPoolExecutor(1) as aside:  # begun when nothing else is imported or loaded
            aside.submit(make_ready, sweep, modules)
            records = _solve_all(sweep, tables, split_up, todo, done, shards, threads, executor, progress)
        solved = time.perf_counter()
        lost = _lost(tables, split_up, done)
        attrs = provenance(sweep, tables, identity, shards.started) | ({"not_solved": lost} if lost else {})
        try:
            _write(sweep, tables, records, out, attrs, needed, threads, progress, overwrite, look)
        except FileExistsError:  # it appeared meanwhile, perhaps from the same sweep on a network disk
            if not (atlas := _complete(out, identity, sweep.text, overwrite, False)):
                raise
            atlas.close()
        shards.clear()
    finally:
        shards.release()
    atlas = open_atlas(out)
    if lost:
        warnings.warn(
            f"{lost}; their status is not_converged, sweep again with overwriting to try anew", stacklevel=stacklevel
        )
    warn_beyond_range(atlas.data, stacklevel + 1)
    if progress:
        now = time.perf_counter()
        print(summary(atlas, tables, solved - begun, now - begun))
    return atlas


def _read(spec, out, threads, executor, progress, overwrite):
    """What was asked for, checked; raises :class:`SweepError` with every fault."""
    faults = []
    if not isinstance(spec, Sweep):
        spec = read_path("spec", spec, "a TOML specification, or a Sweep", faults)
    out = read_path("out", out, "the atlas to make", faults)
    faults += [] if out is None else named_otherwise(out)
    if threads is not None:
        threads = read_count("threads", threads, faults)
    if executor is not None and not callable(getattr(type(executor), "submit", None)):
        faults.append(f"executor: found {described(executor)}; give a concurrent.futures.Executor, or None for threads")
    progress = read_switch("progress", progress, faults)
    overwrite = read_switch("overwrite", overwrite, faults)
    if faults:
        raise SweepError("\n  - ".join(["faults in what was given:", *faults]))
    return spec, out, threads, progress, overwrite


def _complete(out, identity, text, overwrite, progress):
    """The atlas at ``out`` if it is this sweep's already; raises if it is another's that is not to be overwritten."""
    if os.path.lexists(out) and not out.is_file():
        raise SweepError(f"{out} is a folder or a device, or a link to nothing; give the name of the atlas to make")
    if overwrite or not out.exists():
        return None
    try:
        atlas = open_atlas(out)
    except AtlasError as error:
        raise SweepError(f"{error}; choose another output, or overwrite it") from error
    for key, wanted in identity.items():
        if (found := atlas.data.attrs.get(key)) != wanted:
            changed = changes(atlas.data.attrs.get("specification"), text) if key == "specification_sha256" else ""
            atlas.close()
            raise SweepError(
                f"{out} exists and its {key} differs: {found!r:.80} there, {wanted!r:.80} now{changed}; choose another"
                " output, or overwrite it"
            )
    if progress:
        print(f"{out} is complete already, from this specification and this code")
    return atlas


def split(table, sweep):
    """Shards of whole problems: a list of (first, last + 1)."""
    cost = PHYSICAL_COST if sweep.is_physical else VARYING_COST if sweep.varies else 1
    cost *= 1 if table.kind == "free" else HELD_COST
    size = max(1, SHARD_EQUILIBRIA // cost)
    found, a = [], 0
    while a < table.count:
        b = int(np.searchsorted(table.first, table.first[a] + size))
        found.append((a, min(b, table.count)))
        a = found[-1][1]
    return found


def _solve_all(sweep, tables, split_up, todo, done, shards, threads, executor, progress):
    """Records of all shards, those found on disk among them: kind -> Records; ``done`` gets the file of each that is to do,
    or None.
    """
    total = sum(table.equilibria for table in tables.values())
    left = sum(int(tables[kind].first[b] - tables[kind].first[a]) for kind, _, a, b in todo)
    if executor is None:
        solved = _solve_here(tables, todo, shards, sweep.accuracy, threads)
    else:
        solved = solve_remotely(executor, tables, todo, shards, sweep.accuracy)
    with bar(total, total - left, " equilibria", progress) as shown, contextlib.closing(solved):
        for key, path, count in solved:
            done[key] = path
            shown.update(count)
    contents = Contents(shards.plan)
    return {
        kind: Records(
            state(kind, sweep.is_physical),
            own,
            tables[kind].first,
            [done[kind, k] for k in range(len(own))],
            contents,
        )
        for kind, own in split_up.items()
    }


def _solve_here(tables, todo, shards, accuracy, threads):
    """Solve shards on threads: (kind, index), file, states, as they are done."""

    def run(kind, index, a, b):
        states, limits = solve_shard(tables[kind].job(a, b), accuracy)
        return (kind, index), shards.save(kind, index, states, limits), len(states)

    yield from in_order(run, todo, threads)


def _lost(tables, split_up, done):
    """Which shards killed their workers, in words; "": none."""
    parts = [(kind, *split_up[kind][k]) for (kind, k), path in done.items() if path is None]
    states = sum(int(tables[kind].first[b] - tables[kind].first[a]) for kind, a, b in parts)
    where = ", ".join(f"{kind} {a} to {b - 1}" for kind, a, b in parts[:20])
    return f"{states:,} states of problems that killed their workers: {where}" if parts else ""


def _write(sweep, tables, records, out, attrs, needed, threads, progress, overwrite, look):
    """The atlas, chunk by chunk: made and compressed on threads, written here; ``look(data)`` while it measures itself."""
    made = groups(sweep)
    steps = max(len(tables["free"].pressure), 1)
    sizes = dict(zip(sweep.dims, sweep.shape))
    dimensions = {id(group): (*group.grid.dimensions, *["pressure"] * group.pressure) for group in made}
    variables = {name: (dimensions[id(group)], dtype) for group in made for name, dtype in group.variables.items()}

    def run(group, shape, offset, first, last):
        inner = steps if group.pressure else 1
        arrays = group.arrays(tables, records, np.arange(first // inner, last // inner))
        return [(name, offset, packed(array, shape) if shape else array[0, 0]) for name, array in arrays.items()]

    shapes = [(group, [sizes[name] for name in dimensions[id(group)]]) for group in made]
    jobs = ((group, shape, *part) for group, shape in shapes for part in parts(shape))
    total = sum(1 for _, shape in shapes for _ in parts(shape))
    with AtlasWriter(out, sizes, coordinates(sweep), variables, attrs, needed) as writer:
        with bar(total, 0, " parts", progress) as shown:
            for chunks in in_order(run, jobs, threads):
                for chunk in chunks:
                    writer.put(*chunk)
                shown.update(1)
        for each in records.values():
            each.contents.forget()
        if estimate.is_measured(sweep):
            from ..query.measure import measure

            if progress:
                print("comparing answers between the nodes with exact ones")
            with writer.dataset() as data, ThreadPoolExecutor(1) as aside:
                if look:
                    aside.submit(look, data)
                with writer.misread():
                    found = measure(data)
            writer.describe(found)
        writer.publish(replace=overwrite)


def summary(atlas, tables, solving, total) -> str:
    """What was done, failures grouped by status, once."""
    equilibria, problems = (
        sum(numbers) for numbers in zip(*((table.equilibria, table.count) for table in tables.values()))
    )
    lines = [
        f"{atlas.data['status'].size:,} grid points, {equilibria:,} distinct equilibria of {problems:,}"
        f" distinct problems, {total:.1f} s ({solving:.1f} s solving)"
    ]
    sentences = {status.meaning: status.sentence for status in STATUSES}
    for kind in tables:
        name = "status" if kind == "free" else f"{kind}_status"
        lines += [f"  {kind.replace('_', ' ')}"] if kind != "free" else []
        counts = atlas.status_counts(name).items()
        lines += [f"  {count:>12,}  {meaning}: {sentences[meaning]}" for meaning, count in counts]
    if note := atlas.data.attrs.get("thin_wall_note"):
        lines.append(f"  note: {note}")
    return "\n".join([*lines, f"  {atlas.path}"])

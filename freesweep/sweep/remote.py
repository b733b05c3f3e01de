"""Shards solved by the workers of an executor: each writes its own into the folder that all share, and returns its name.

A worker that dies costs the time of its shard: the executor gives it to another one. Two workers that solve one shard write
the same bytes under the same name. A shard that kills whoever takes it stays without records, and its states end as
``not_converged``.
"""

import sys
import time
from concurrent.futures import BrokenExecutor, CancelledError
from pathlib import Path

from ..atlas.files import EnvironmentFault
from .identity import code_sha256
from .jobs import as_done
from .shard_file import key_of, save
from .shards import SweepError
from .solve import solve_shard

IN_FLIGHT = 512  # shards that are handed to an executor at a time, 100 kB each or so; it may have as many workers
VISIBLE = 10.0  # [s] until a file that was written elsewhere is seen on a network disk


def solve_remotely(executor, tables, todo, shards, accuracy):
    """Solve shards ``todo`` of (kind, index, first, last + 1); gives (kind, index), file or None, states."""
    folder, code = str(shards.folder.resolve()), code_sha256()

    def begin(kind, index, a, b):
        return executor.submit(solve_and_save, folder, shards.plan, code, kind, index, tables[kind].job(a, b), accuracy)

    for (kind, index, a, b), future in as_done(begin, todo, IN_FLIGHT):
        count = int(tables[kind].first[b] - tables[kind].first[a])
        try:
            path = _found(shards, kind, index, future.result())
        except (BrokenExecutor, CancelledError) as error:
            raise EnvironmentFault(
                f"the executor gave up ({type(error).__name__}: {error}): its workers or its scheduler ended; what was"
                " finished is kept, the same sweep goes on from there"
            ) from error
        except Exception as error:
            if not _killed_its_worker(error):
                raise
            path = None
        yield (kind, index), path, count


def solve_and_save(folder, plan, code, kind, index, job, accuracy) -> str:
    """What a worker does: solve one shard, store it, and return the name of its file."""
    if code_sha256() != code:
        raise SweepError(
            "a worker runs other code than this process: install the same versions of freesweep, Numba and Python"
            f" everywhere (Python {sys.version.split()[0]} there)"
        )
    states, limits = solve_shard(job, accuracy)
    return save(Path(folder), plan, kind, index, states, limits).name


def _found(shards, kind, index, name):
    """The file that a worker has written, held against its name."""
    path = shards.folder / name
    until = time.monotonic() + VISIBLE
    while not path.exists():
        if time.monotonic() > until:
            raise EnvironmentFault(
                f"a worker wrote {name} into {shards.folder}, but it is not there: all machines have to share that folder,"
                " under one path"
            )
        time.sleep(0.1)
    if key_of(path, shards.plan) != (kind, index):
        raise EnvironmentFault(f"{path} is not what a worker wrote: other bytes are read here; check the shared disk")
    return path


def _killed_its_worker(error) -> bool:
    """Whether Dask gave a task up because worker after worker ended in it."""
    scheduler = sys.modules.get("distributed.scheduler")
    return scheduler is not None and isinstance(error, scheduler.KilledWorker)

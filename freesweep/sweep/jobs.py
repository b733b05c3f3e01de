"""Jobs on threads or on any executor, a few begun at a time; interrupted, what is not begun is given up."""

import time
from collections import deque
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

GIVING_UP = 1.0  # [s]: of Dask, each takes a message there and back
AHEAD = 4  # jobs for each thread that are begun or waited for


def in_order(function, jobs, threads):
    """Results of ``function(*job)`` from threads, in the order of the jobs."""
    jobs, running = iter(jobs), deque()
    pool = ThreadPoolExecutor(threads)
    try:
        while True:
            while len(running) < AHEAD * threads and (job := next(jobs, None)) is not None:
                running.append(pool.submit(function, *job))
            if not running:
                return
            yield running.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)


def as_done(begin, jobs, most):
    """``(job, its future)`` as they are done; ``begin(*job)`` gives a future, ``most`` are begun at a time.

    Interrupted, what is not begun is given up, as far as there is time: what runs on does no harm.
    """
    jobs, running = iter(jobs), {}
    try:
        while True:
            while len(running) < most and (job := next(jobs, None)) is not None:
                running[begin(*job)] = job
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                yield running.pop(future), future
    finally:
        until = time.monotonic() + GIVING_UP
        for future in running:
            if time.monotonic() < until:
                future.cancel()


def bar(total, finished, unit, progress):
    """A progress bar, or nothing that is seen."""
    from tqdm.auto import tqdm

    return tqdm(
        total=total,
        initial=finished,
        unit=unit,
        unit_scale=True,
        disable=not progress,
        dynamic_ncols=True,
        leave=True,
    )

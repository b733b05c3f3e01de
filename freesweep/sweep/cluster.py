"""Dask for ``freesweep sweep --dask``: a cluster on this machine for as long as a sweep takes, or one that is there."""

import contextlib
import logging
import os
import re
import signal

from ..atlas.files import EnvironmentFault

PATIENCE = 20  # [s] for a scheduler to answer
CLOSING = 2  # [s] until a connection is given up
SCHEMES = ("tcp", "tls", "ucx", "ws", "wss")


@contextlib.contextmanager
def executor_of(address="", workers=None, say=lambda text: None):
    """An executor on the scheduler at ``address``; "": on ``workers`` processes of this machine, that end with it.

    Raises ValueError for what is no address; :class:`EnvironmentFault` where Dask is missing or nobody answers.
    """
    if address and not re.fullmatch(rf"({'|'.join(SCHEMES)})://[^\s/]+:\d+/?", address):
        raise ValueError(f"--dask: found {address!r:.80}; give the address of a scheduler, such as tcp://host:8786")
    try:
        from distributed import Client, LocalCluster
    except ImportError as error:
        raise EnvironmentFault(
            f"--dask needs Dask, which is not installed ({error}); pip install 'freesweep[dask]'"
        ) from error
    cluster = None
    if not address:
        # silence_logs ends with the cluster, but connections to its killed workers are missed a moment later
        for handler in logging.getLogger("distributed").handlers:
            handler.setLevel(logging.CRITICAL)
        cluster = LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None,
            silence_logs=logging.CRITICAL,
        )  # fmt: skip
    try:
        client = _client(Client, address or cluster)
        if address and not client.ncores():
            say(f"{address} has no workers yet: the sweep waits for them")
        try:
            yield client.get_executor(pure=False)
        finally:
            with contextlib.suppress(OSError, TimeoutError):
                client.close(timeout=CLOSING)
    finally:
        if cluster is not None:
            _stop(cluster)


def _stop(cluster):
    """End a cluster of this machine at once: a worker that is killed in its shard loses nothing that was finished."""
    for nanny in cluster.workers.values():
        nanny.close_gracefully()  # it does not start its worker again
        if nanny.pid is not None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(nanny.pid, signal.SIGKILL)
    with contextlib.suppress(OSError, TimeoutError):
        cluster.close(timeout=CLOSING)


def _client(kind, address):
    try:
        return kind(address, timeout=PATIENCE)
    except (OSError, TimeoutError) as error:
        raise EnvironmentFault(f"no Dask scheduler answers at {address} within {PATIENCE} s: {error}") from error

"""Ctrl-C, SIGTERM and SIGHUP: a sweep ends within seconds, says so and goes on from there, even if nothing hears them."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from grids import CHILD_ENVIRONMENT, make
from shards import SHARD, SWEEP, same_bits

from freesweep.cli import INTERRUPTED
from freesweep.cli.interrupt import SENTENCE

CHILD = """
import ctypes, signal, sys, threading, time
from freesweep.cli import interrupt, main
from freesweep.sweep import kernels, run
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in what a shell runs in the background
where, library = sys.argv[3], ctypes.CDLL(None)
run.SHARD_EQUILIBRIA, solve = int(sys.argv[4]), run.solve_shard
interrupt.PATIENCE = 60.0 if where == "between shards" else 0.5
def deaf():
    "As the compiler or a long kernel: no signal is heard, and it does not end."
    mutex = ctypes.create_string_buffer(256)
    library.pthread_mutex_init(mutex, None)
    library.pthread_mutex_lock(mutex)
    print("at work", flush=True)
    library.pthread_mutex_lock(mutex)
def slow(*job):
    if where == "between shards":
        print("at work", flush=True)
        time.sleep(0.2)
    elif run.Shards.stored:
        deaf()
    return solve(*job)
def save(self, *shard, save=run.Shards.save):
    run.Shards.stored = True
    return save(self, *shard)
run.Shards.stored, run.Shards.save, run.solve_shard = False, save, slow
if where == "in the main thread":
    kernels.load = lambda *_: deaf()
sys.exit(main(["sweep", sys.argv[1], "-o", sys.argv[2], "--quiet", "--threads", "1"]))
"""


@pytest.mark.usefixtures("small_shards")
@pytest.mark.parametrize(
    ("sent", "where"),
    [
        (signal.SIGHUP, "between shards"),
        (signal.SIGINT, "between shards"),
        (signal.SIGKILL, "between shards"),
        (signal.SIGTERM, "in a shard"),
        (signal.SIGINT, "in the main thread"),
    ],
)
def test_a_stopped_sweep_says_so_and_goes_on(sent, where, reference, tmp_path):
    (tmp_path / "spec.toml").write_text(SWEEP.text)
    out = tmp_path / "atlas.nc"
    child = subprocess.Popen(
        [sys.executable, "-P", "-c", CHILD, str(tmp_path / "spec.toml"), str(out), where, str(SHARD)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=CHILD_ENVIRONMENT,
    )  # fmt: skip
    try:
        child.stdout.readline()
        if where == "between shards":
            child.stdout.readline()  # the first shard is stored
        child.send_signal(sent)
        _, error = child.communicate(timeout=60)
    finally:
        child.kill()
    if sent == signal.SIGKILL:
        assert child.returncode == -sent
    else:
        assert child.returncode == INTERRUPTED
        assert error == f"{SENTENCE}\n"
    assert not out.exists()
    assert bool(list(Path(f"{out}.parts").glob("free-*.bin"))) == (where != "in the main thread")
    same_bits(reference, make(out, SWEEP))

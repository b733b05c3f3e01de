"""Sweeps on executors, Dask's among them: the same shards, the same bits, whoever dies."""

import importlib.util
import json
import logging
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool

import numpy as np
import pytest
from commands import refused
from grids import CHILD_ENVIRONMENT, make, only
from shards import SHARD, SWEEP, same_bits

from freesweep import open_atlas
from freesweep.atlas.files import EnvironmentFault
from freesweep.cli import BAD_INPUT, DONE, ENVIRONMENT, main
from freesweep.status import NOT_CONVERGED
from freesweep.sweep import cluster, remote
from freesweep.sweep.shards import SweepError

needs_dask = pytest.mark.skipif(importlib.util.find_spec("distributed") is None, reason="Dask is not installed")
pytestmark = pytest.mark.usefixtures("small_shards")


class Answering:
    """An executor whose futures are done at once, with what ``answer(function, *job)`` gives or raises."""

    def __init__(self, answer):
        self.answer, self.given = answer, 0

    def submit(self, function, *job):
        self.given += 1
        future = Future()
        try:
            future.set_result(self.answer(function, *job))
        except Exception as error:
            future.set_exception(error)
        return future


def test_an_executor_gives_the_same_bits(reference, tmp_path):
    with ThreadPoolExecutor(2) as pool:
        same_bits(reference, make(tmp_path / "atlas.nc", SWEEP, executor=pool))
    only(tmp_path, "atlas.nc")


def test_a_task_that_is_done_twice_changes_nothing(reference, tmp_path):
    def twice(function, *job):
        assert function(*job) == function(*job)  # the same bytes have the same name
        return function(*job)

    same_bits(reference, make(tmp_path / "atlas.nc", SWEEP, executor=Answering(twice)))
    only(tmp_path, "atlas.nc")


def test_what_workers_finished_is_kept_when_the_executor_ends(reference, tmp_path):
    def ending(function, *job):
        if executor.given > 3:
            raise BrokenProcessPool("a process ended")
        return function(*job)

    executor = Answering(ending)
    with pytest.raises(EnvironmentFault, match=r"the executor gave up \(BrokenProcessPool: a process ended\)"):
        make(tmp_path / "atlas.nc", SWEEP, executor=executor)
    assert len(list((tmp_path / "atlas.nc.parts").glob("free-*.bin"))) == 3
    executor = Answering(lambda function, *job: function(*job))
    same_bits(reference, make(tmp_path / "atlas.nc", SWEEP, executor=executor))
    assert 0 < executor.given < 10


def test_a_worker_without_the_folder_or_with_other_code_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(remote, "VISIBLE", 0.0)
    (tmp_path / "elsewhere").mkdir()
    elsewhere = Answering(lambda function, _, *job: function(str(tmp_path / "elsewhere"), *job))
    with pytest.raises(EnvironmentFault, match="but it is not there: all machines have to share that folder"):
        make(tmp_path / "atlas.nc", SWEEP, executor=elsewhere)
    other = Answering(lambda function, folder, plan, _, *job: function(folder, plan, "other", *job))
    with pytest.raises(SweepError, match="a worker runs other code"):
        make(tmp_path / "atlas.nc", SWEEP, executor=other)

    def changing(function, folder, *job):
        name = function(folder, *job)
        with open(f"{folder}/{name}", "r+b") as file:
            file.write(b"\xff")
        return name

    with pytest.raises(EnvironmentFault, match="is not what a worker wrote"):
        make(tmp_path / "atlas.nc", SWEEP, executor=Answering(changing))


def test_a_shard_that_kills_its_workers_ends_as_a_status(reference, tmp_path, monkeypatch):
    class KilledError(Exception):
        pass

    def killing(function, *job):
        if job[3:5] == ("free", 1):
            raise KilledError
        return function(*job)

    monkeypatch.setattr(remote, "_killed_its_worker", lambda error: isinstance(error, KilledError))
    with pytest.warns(
        UserWarning, match=r"12 states of problems that killed their workers: free \d+ to \d+; their status"
    ):
        found = make(tmp_path / "atlas.nc", SWEEP, executor=Answering(killing))
    unsolved_as_status(found, reference)


def unsolved_as_status(found, reference):
    lost = found["status"] == NOT_CONVERGED
    assert 0 < np.count_nonzero(lost) < lost.size // 2
    assert "killed their workers" in found.attrs["not_solved"]
    for name in ("rotation", "volume", "volume_error"):
        assert np.all(np.isnan(found[name].values[lost]))
        assert np.array_equal(found[name].values[~lost], reference[name].values[~lost], equal_nan=True)
    assert np.any(found["locked_status"] == NOT_CONVERGED)


# --- Dask itself, in a process of its own

SCRIPT = """
import json, os, signal, sys
from distributed import Client, LocalCluster
from freesweep.cli import main
from freesweep.sweep import run
from freesweep.sweep.spec import parse

def suicide(*_):
    os.kill(os.getpid(), signal.SIGKILL)

class Disturbed:
    def __init__(self, client, at=None, poison=None):
        self.client, self.at, self.poison, self.given = client, at, poison, 0
        self.executor = client.get_executor(pure=False)
    def submit(self, function, *job):
        self.given += 1
        if self.given == self.at:
            os.kill(min(self.client.run(os.getpid).values()), signal.SIGKILL)
        return self.executor.submit(suicide if job[3:5] == self.poison else function, *job)

if __name__ == "__main__":
    folder, sweep = sys.argv[1], parse(sys.stdin.read())
    run.SHARD_EQUILIBRIA = int(sys.argv[2])
    run.solve_remotely.__globals__["IN_FLIGHT"] = 4
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local, Client(local) as client,
    ):
        before = client.run(os.getpid)
        run.run_sweep(sweep, f"{folder}/killed.nc", executor=Disturbed(client, at=7), progress=False).close()
        restarted = set(before.values()) != set(client.run(os.getpid).values())
        if sys.argv[3] == "poison":
            poisoned = Disturbed(client, poison=("free", 1))
            run.run_sweep(sweep, f"{folder}/poisoned.nc", executor=poisoned, progress=False).close()
        words = ["-o", f"{folder}/command.nc", "--quiet", "--dask", local.scheduler_address]
        print(json.dumps([restarted, main(["sweep", f"{folder}/spec.toml", *words])]), flush=True)
        os._exit(0)  # workers end with it, at once
"""


def on_dask(folder, *more):
    """Runs the script; what it says on standard error."""
    (folder / "script.py").write_text(SCRIPT)
    (folder / "spec.toml").write_text(SWEEP.text)
    done = subprocess.run(
        [sys.executable, "-P", str(folder / "script.py"), str(folder), str(SHARD), *more],
        input=SWEEP.text, capture_output=True, text=True, timeout=300,
        env=CHILD_ENVIRONMENT | {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) == [True, DONE]
    assert not list(folder.glob("*.parts"))
    return done.stderr


@needs_dask
def test_a_dask_worker_that_is_killed_costs_no_bit(reference, tmp_path):
    """Two workers, one of them killed in the middle; then the command on the same workers."""
    on_dask(tmp_path, "")
    for name in ("killed", "command"):
        with open_atlas(tmp_path / f"{name}.nc") as atlas:
            same_bits(reference, atlas.data.load())


@needs_dask
@pytest.mark.long
def test_dask_gives_up_a_shard_that_kills_every_worker(reference, tmp_path):
    assert "states of problems that killed their workers" in on_dask(tmp_path, "poison")
    with open_atlas(tmp_path / "poisoned.nc") as atlas:
        unsolved_as_status(atlas.data.load(), reference)


def test_a_missing_extra_and_a_wrong_address_are_one_line(tmp_path, monkeypatch, capsys):
    (tmp_path / "spec.toml").write_text(SWEEP.text)
    words = ("sweep", str(tmp_path / "spec.toml"), "-o", str(tmp_path / "atlas.nc"))
    for address in ("localhost", "tcp://host", "file:///etc:1"):
        error = refused(capsys, *words, "--dask", address, code=BAD_INPUT)
        assert f"found {address!r}; give the address of a scheduler, such as tcp://host:8786" in error
    monkeypatch.setitem(sys.modules, "distributed", None)
    error = refused(capsys, *words, "--dask", code=ENVIRONMENT)
    assert error.count("\n") == 1
    assert "pip install 'freesweep[dask]'" in error


@needs_dask
def test_a_scheduler_that_does_not_answer_is_one_line(tmp_path, monkeypatch, capsys):
    (tmp_path / "spec.toml").write_text(SWEEP.text)
    monkeypatch.setattr(cluster, "PATIENCE", 1)
    error = refused(capsys, "sweep", str(tmp_path / "spec.toml"), "--dask", "tcp://127.0.0.1:1", code=ENVIRONMENT)
    assert "no Dask scheduler answers at tcp://127.0.0.1:1 within 1 s" in error


@needs_dask
def test_a_cluster_of_ones_own_is_silent_also_while_it_ends(monkeypatch):
    """Its workers are killed when they are needed no more: what Dask says of that helps nobody."""
    import distributed

    handler = logging.StreamHandler()
    monkeypatch.setattr(logging.getLogger("distributed"), "handlers", [handler])

    def none(**_):
        raise OSError("no cluster")

    monkeypatch.setattr(distributed, "LocalCluster", none)
    with pytest.raises(OSError, match="no cluster"), cluster.executor_of():
        pass
    assert handler.level == logging.CRITICAL


@needs_dask
@pytest.mark.long
def test_the_command_starts_a_cluster_of_its_own(reference, tmp_path):
    (tmp_path / "spec.toml").write_text(SWEEP.text)
    words = [
        "sweep",
        str(tmp_path / "spec.toml"),
        "-o",
        str(tmp_path / "atlas.nc"),
        "--quiet",
        "--dask",
        "--threads",
        "2",
    ]
    done = subprocess.run(
        [sys.executable, "-m", "freesweep", *words], capture_output=True, text=True, env=CHILD_ENVIRONMENT, timeout=300
    )
    assert (done.returncode, done.stdout, done.stderr) == (DONE, "", "")
    with open_atlas(tmp_path / "atlas.nc") as atlas:
        same_bits(reference, atlas.data.load())
    assert main([*words[:4], "--quiet"]) == DONE

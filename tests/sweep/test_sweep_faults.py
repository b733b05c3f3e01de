"""Every call that stores something fails, once or for ever, or lies: nothing is lost, nothing half is accepted."""

import errno
import os
import signal
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest
from commands import refused
from grids import CHILD_ENVIRONMENT, make, spec
from shards import same_bits

from freesweep.atlas import files
from freesweep.atlas.files import EnvironmentFault
from freesweep.atlas.seal import seal_fault
from freesweep.atlas.write import chunks_of, packed, parts
from freesweep.cli import DONE, ENVIRONMENT, main
from freesweep.sweep import estimate, run, shard_file
from freesweep.sweep.plan import plan
from freesweep.sweep.records import FREE_STATE, LIMIT
from freesweep.sweep.shards import Shards, SweepError
from freesweep.sweep.spec import parse

AXES = {"alpha": [-20.0, 40.0], "beta": [-50.0, 20.0, 70.0], "pressure": [0.0, 1e5]}
SWEEP = parse(spec(AXES))
CALLS = ("pwrite", "fsync", "replace", "link", "fchmod", "close", "open", "pread")


class Disk:
    """The module ``os`` to files.py, of which calls of one name fail from the n-th on: once, or for ever; or lie."""

    def __init__(self, call, moment, kind, code=errno.ENOSPC):
        self.call, self.moment, self.kind, self.code, self.count = call, moment, kind, code, 0

    def __getattr__(self, name):
        real = getattr(os, name)
        return real if name != self.call else lambda *given: self._do(real, *given)

    def _do(self, real, *given):
        self.count += 1
        struck = self.count == self.moment or (self.kind == "for ever" and self.count > self.moment)
        if not struck:
            return real(*given)
        if self.kind == "short":
            return real(given[0], given[1][: max(1, len(given[1]) // 2)], given[2])
        if self.kind == "lost":
            return len(given[1])
        if self.kind == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if self.call == "close":
            real(*given)
        raise OSError(self.code, os.strerror(self.code))


@pytest.fixture(autouse=True)
def _small_shards(monkeypatch):
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", 6)


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    return make(tmp_path_factory.mktemp("reference") / "atlas.nc", SWEEP)


def moments(call, tmp_path, monkeypatch, count):
    """Some of the calls of one name that a sweep makes, the first and the last among them."""
    disk = Disk(call, 0, "once")
    with monkeypatch.context() as patch:
        patch.setattr(files, "os", disk)
        make(tmp_path / "counted.nc", SWEEP, threads=1)
    return sorted({int(k) for k in np.linspace(1, disk.count, count)})


def struck(out, call, moment, kind, monkeypatch, code=errno.ENOSPC):
    with monkeypatch.context() as patch:
        patch.setattr(files, "os", Disk(call, moment, kind, code))
        return make(out, SWEEP, threads=1)


@pytest.mark.parametrize("call", CALLS)
def test_a_full_disk_costs_nothing_but_a_sentence(call, reference, tmp_path, monkeypatch):
    for k, moment in enumerate(moments(call, tmp_path, monkeypatch, 4)):
        folder = tmp_path / str(moment)
        folder.mkdir()
        out = folder / "atlas.nc"
        with pytest.raises(
            EnvironmentFault, match=r"cannot write .*No space left on device; [\d,]+ bytes needed, [\d,]+ free"
        ):
            struck(out, call, moment, ("once", "for ever")[k % 2], monkeypatch)
        assert not list(folder.glob(".*.part"))
        assert not out.exists() or seal_fault(out) is None
        same_bits(reference, make(out, SWEEP))
        assert [path.name for path in folder.iterdir()] == ["atlas.nc"]


@pytest.mark.long
@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO])
@pytest.mark.parametrize("kind", ["once", "for ever"])
@pytest.mark.parametrize("call", CALLS)
def test_every_call_may_fail(call, kind, code, reference, tmp_path, monkeypatch):
    for moment in moments(call, tmp_path, monkeypatch, 1000):
        folder = tmp_path / str(moment)
        folder.mkdir()
        out = folder / "atlas.nc"
        with pytest.raises(EnvironmentFault, match=os.strerror(code)):
            struck(out, call, moment, kind, monkeypatch, code)
        assert not out.exists() or seal_fault(out) is None
        same_bits(reference, make(out, SWEEP))
        assert [path.name for path in folder.iterdir()] == ["atlas.nc"]


KILLS = """
import os, sys
from pathlib import Path
import pytest
from freesweep.atlas import files
from freesweep.sweep import run
from grids import make
from test_sweep_faults import CALLS, Disk, SWEEP, moments
from shards import same_bits
run.SHARD_EQUILIBRIA = 6
folder = Path(sys.argv[1])
reference = make(folder / "whole.nc", SWEEP)
for call in CALLS:
    counted = folder / call
    counted.mkdir()
    every = moments(call, counted, pytest.MonkeyPatch(), int(sys.argv[2]))
    for moment in every:
        out = folder / f"{call}{moment}.nc"
        if not (child := os.fork()):
            files.os = Disk(call, moment, "kill")
            make(out, SWEEP, threads=1)
            os._exit(0)
        _, how = os.waitpid(child, 0)
        assert os.WIFSIGNALED(how) and os.WTERMSIG(how) == 9, (call, moment, how)
        same_bits(reference, make(out, SWEEP))
        assert [path.name for path in folder.glob(f"*{out.name}*")] == [out.name], (call, moment)
        out.unlink()
    print(call, len(every), flush=True)
"""


@pytest.mark.long
def test_killed_in_every_call(tmp_path):
    """Killed in each write, fsync, rename, change of mode, close and opening of a folder; then the sweep goes on."""
    here = os.pathsep.join([CHILD_ENVIRONMENT["PYTHONPATH"], os.path.dirname(__file__)])
    done = subprocess.run(
        [sys.executable, "-P", "-c", KILLS, str(tmp_path), "1000"],
        capture_output=True, text=True, env=CHILD_ENVIRONMENT | {"PYTHONPATH": here},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert [line.split()[0] for line in done.stdout.splitlines()] == [*CALLS]


UNREAD = """
import sys
from pathlib import Path
import pytest
from freesweep.sweep import run
from test_sweep_faults import moments, struck
run.SHARD_EQUILIBRIA = 6
folder, patch = Path(sys.argv[1]), pytest.MonkeyPatch()
for moment in moments("pread", folder, patch, 40):
    with pytest.raises(OSError, match="cannot write"):
        struck(folder / f"{moment}.nc", "pread", moment, "for ever", patch)
    print(moment)
"""


def test_a_disk_that_cannot_be_read_does_not_end_the_process_by_a_signal(tmp_path):
    """What HDF5 failed to open, and kept, it closed after Python's end: exit code 139, whatever had been told."""
    here = os.pathsep.join([CHILD_ENVIRONMENT["PYTHONPATH"], os.path.dirname(__file__)])
    done = subprocess.run(
        [sys.executable, "-P", "-c", UNREAD, str(tmp_path)],
        capture_output=True, text=True, env=CHILD_ENVIRONMENT | {"PYTHONPATH": here},
    )  # fmt: skip
    assert len(done.stdout.split()) == 40, done.stderr
    assert done.returncode == 0


def test_short_writes_are_completed(reference, tmp_path, monkeypatch):
    for moment in moments("pwrite", tmp_path, monkeypatch, 6):
        out = tmp_path / f"{moment}.nc"
        same_bits(reference, struck(out, "pwrite", moment, "short", monkeypatch))
        assert seal_fault(out) is None


def test_a_disk_that_loses_a_write_is_found_out(reference, tmp_path, monkeypatch):
    for moment in moments("pwrite", tmp_path, monkeypatch, 6):
        out = tmp_path / f"{moment}.nc"
        with pytest.raises(EnvironmentFault, match="other bytes are read back than were written"):
            struck(out, "pwrite", moment, "lost", monkeypatch)
        assert not out.exists()
        same_bits(reference, make(out, SWEEP))


def test_the_faults_would_be_seen_if_nobody_looked(tmp_path, monkeypatch):
    """The control: without reading back, lost writes do make atlases that differ, or cannot be read.

    Of what an atlas that measures itself writes in the end, some losses make HDF5 end the process.
    """
    monkeypatch.setattr("freesweep.sweep.estimate.is_measured", lambda _: False)
    reference = make(tmp_path / "reference.nc", SWEEP)
    monkeypatch.setattr("freesweep.atlas.write.AtlasWriter._is_as_written", lambda _: True)
    differ = 0
    for moment in moments("pwrite", tmp_path, monkeypatch, 40)[-12:-1]:
        try:
            same_bits(reference, struck(tmp_path / f"{moment}.nc", "pwrite", moment, "lost", monkeypatch))
        except Exception:
            differ += 1
        except AssertionError:
            differ += 1
    assert differ > 3


def test_a_full_disk_is_one_line_and_an_exit_code(tmp_path, monkeypatch, capsys):
    (tmp_path / "spec.toml").write_text(SWEEP.text)
    words = ("sweep", str(tmp_path / "spec.toml"), "-o", str(tmp_path / "atlas.nc"), "--quiet")
    with monkeypatch.context() as patch:
        patch.setattr(files, "os", Disk("pwrite", 3, "for ever"))
        error = refused(capsys, *words, code=ENVIRONMENT)
    assert error.startswith("freesweep: cannot write ")
    assert error.count("\n") == 1
    with monkeypatch.context() as patch:
        patch.setattr(estimate.shutil, "disk_usage", lambda _: type("Usage", (), {"free": 1000}))
        error = refused(capsys, *words, code=ENVIRONMENT)
    assert "cannot begin" in error
    assert "1,000 free" in error
    assert main(list(words)) == DONE


def test_a_sweep_that_needs_more_disk_than_there_is_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(estimate.shutil, "disk_usage", lambda _: type("Usage", (), {"free": 1000}))
    with pytest.raises(EnvironmentFault, match=r"cannot begin .*atlas\.nc: [\d,]+ bytes needed, 1,000 free"):
        make(tmp_path / "atlas.nc", SWEEP)
    assert not list(tmp_path.iterdir())


def test_a_sweep_that_needs_more_memory_than_there_is_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(estimate.os, "sysconf", lambda _: 1000)
    with pytest.raises(EnvironmentFault, match=r"6 designs need [\d,]+ bytes of memory, this machine has 1,000,000"):
        make(tmp_path / "atlas.nc", SWEEP)
    assert not list(tmp_path.iterdir())


def test_one_writer_at_a_time(reference, tmp_path):
    out = tmp_path / "atlas.nc"
    other = Shards(out)
    other.hold()
    with pytest.raises(SweepError, match=r"another process is sweeping into .*atlas\.nc; wait for it"):
        make(out, SWEEP)
    assert (tmp_path / "atlas.nc.parts").exists()
    other.release()
    same_bits(reference, make(out, SWEEP))


# --- memory


@pytest.mark.parametrize("shape", [(3,), (7, 5), (1, 70_000), (3, 70_000), (9, 11, 1000), (2, 300, 400), (100_000, 3)])
def test_chunks_cover_a_variable_once(shape):
    chunks = chunks_of(shape)
    whole = [size == chunk for size, chunk in zip(shape, chunks)]
    assert np.prod(chunks) <= 1 << 16
    found = np.zeros(np.prod(shape), int)
    for offset, first, last in parts(shape):
        assert np.ravel_multi_index(offset, shape) == first
        found[first:last] += 1
    assert np.all(found == 1)
    cut = len(whole) - whole[::-1].index(False) - 1 if not all(whole) else 0
    assert all(chunk == 1 for chunk in chunks[:cut])  # a chunk is one run of numbers
    assert len(packed(np.zeros(last - first), shape)) > 0


def peak(function):
    """Largest memory that numpy held meanwhile [bytes]."""
    tracemalloc.start()
    try:
        function()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def grid_of(designs, pressures):
    side = round(designs**0.5)
    axes = {
        "alpha": np.linspace(1.0, 80.0, side).tolist(),
        "beta": np.linspace(-80.0, -1.03, side).tolist(),
        "pressure": np.linspace(0.0, 1e5, pressures).tolist(),
    }
    return parse(spec(axes))


def test_a_plan_holds_a_few_numbers_for_each_design():
    assert peak(lambda: plan(grid_of(250_000, 1))) < 40e6 + estimate.DESIGN_MEMORY * 250_000


def test_memory_does_not_grow_with_the_grid(tmp_path, monkeypatch):
    """Solving left out: what is planned, stored and collected."""

    def unsolved(job, _):
        return np.ones(len(job.pressures), FREE_STATE), np.zeros(len(job.problems), LIMIT)

    monkeypatch.setattr(run, "solve_shard", unsolved)
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", 8192)
    monkeypatch.setattr(shard_file, "MOST_KEPT", 1 << 20)
    monkeypatch.setattr(estimate, "MOST_MEASURED", 0)  # tables for answers between the nodes are another matter
    made = {
        count: peak(
            lambda count=count: run.run_sweep(grid_of(count, 400), tmp_path / f"{count}.nc", threads=1, progress=False)
        )
        for count in (289, 961)
    }
    points = 961 * 400
    assert made[961] < 1.3 * made[289]
    assert made[961] < 63 * points  # less than the atlas itself, uncompressed

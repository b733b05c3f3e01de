"""A sweep's files: whole or absent, the same bits by any way, refused where they are not its own."""

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from grids import CHILD_ENVIRONMENT, SMALL, make, only, spec
from shards import SHARD, SWEEP, same_bits

from freesweep import Atlas, run_sweep
from freesweep.sweep import run
from freesweep.sweep.changes import changes
from freesweep.sweep.shards import SweepError
from freesweep.sweep.spec import parse

pytestmark = pytest.mark.usefixtures("small_shards")

CHILD = """
import os, signal, sys
from freesweep.sweep import run, shards
from freesweep.sweep.spec import parse
out, moment = sys.argv[1], int(sys.argv[2])
rename, done = os.replace, []
def kill(*_):
    os.kill(os.getpid(), signal.SIGKILL)
def replace(source, target):
    if str(target).startswith(out):  # Numba's cache renames files too
        done.append(target)
    kill() if len(done) == moment else rename(source, target)
os.replace = replace
if moment == 0:
    shards.Shards.clear = kill
run.SHARD_EQUILIBRIA = int(sys.argv[3])
run.run_sweep(parse(sys.stdin.read()), out, threads=2, progress=False)
"""


def test_the_number_of_threads_does_not_change_a_bit(reference, tmp_path):
    assert np.isfinite(reference["rotation"]).any()
    for threads in (2, 5):
        same_bits(reference, make(tmp_path / f"{threads}.nc", SWEEP, threads=threads))
    only(tmp_path, "2.nc", "5.nc")


def test_the_size_of_the_shards_does_not_change_a_bit(reference, tmp_path, monkeypatch):
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", 8192)
    same_bits(reference, make(tmp_path / "one.nc", SWEEP))


@pytest.mark.parametrize("moment", [1, 2, 6, 0])
def test_a_killed_sweep_goes_on_to_the_same_bits(moment, reference, tmp_path, monkeypatch):
    """Killed before the n-th file is in place (1: the manifest), or (0) when only clearing up is left."""
    out = tmp_path / "atlas.nc"
    child = subprocess.run(
        [sys.executable, "-P", "-c", CHILD, str(out), str(moment), str(SHARD)],
        input=SWEEP.text,
        text=True,
        capture_output=True,
        timeout=300,
        env=CHILD_ENVIRONMENT,
    )
    assert child.returncode == -signal.SIGKILL, child.stderr
    assert out.exists() == (moment == 0)
    if moment > 2:
        there = len(list(Path(f"{out}.parts").glob("free-*.bin")))
        assert there in (moment - 2, moment - 3)  # the other thread may have been about to put its own in place
        solved, solve = [], run.solve_shard
        monkeypatch.setattr(run, "solve_shard", lambda *job: solved.append(len(job[0].problems)) or solve(*job))
        same_bits(reference, make(out, SWEEP))
        assert 0 < sum(solved) < reference.attrs["distinct_problems"]
    else:
        same_bits(reference, make(out, SWEEP))


@pytest.mark.parametrize("left", ["atlas.nc.parts", ".atlas.nc.freesweep-abcdefgh.part"])
def test_what_a_killed_run_left_is_cleared(left, tmp_path):
    sweep = parse(spec(SMALL))
    out = tmp_path / "atlas.nc"
    make(out, sweep)
    if left.endswith("parts"):
        (tmp_path / left).mkdir()
    else:
        (tmp_path / left).write_bytes(b"half")
        out.unlink()
    make(out, sweep)
    only(tmp_path, "atlas.nc")


def interrupted(out, sweep, shards, monkeypatch):
    """Begin a sweep and stop it when so many shards are stored."""
    save, count = run.Shards.save, []

    def stop(self, *shard):
        if len(count) == shards:
            raise KeyboardInterrupt
        count.append(shard)
        return save(self, *shard)

    with monkeypatch.context() as patch:
        patch.setattr(run.Shards, "save", stop)
        with pytest.raises(KeyboardInterrupt):
            make(out, sweep)
    return sorted(Path(f"{out}.parts").glob("free-*.bin"))


@pytest.mark.parametrize("damage", ["one bit", "cut", "empty"])
def test_a_damaged_shard_is_solved_again(damage, reference, tmp_path, monkeypatch):
    stored = interrupted(tmp_path / "atlas.nc", SWEEP, 3, monkeypatch)
    assert len(stored) == 3
    content = bytearray(stored[1].read_bytes())
    content[len(content) // 2] ^= 1
    stored[1].write_bytes({"one bit": content, "cut": content[:100], "empty": b""}[damage])
    same_bits(reference, make(tmp_path / "atlas.nc", SWEEP))
    only(tmp_path, "atlas.nc")


def test_shards_of_another_size_are_not_mixed_in(reference, tmp_path, monkeypatch):
    interrupted(tmp_path / "atlas.nc", SWEEP, 3, monkeypatch)
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", SHARD // 3)
    with pytest.raises(SweepError, match="whose plan_sha256 differs"):
        make(tmp_path / "atlas.nc", SWEEP)
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", SHARD)
    same_bits(reference, make(tmp_path / "atlas.nc", SWEEP))


def test_shards_of_another_specification_are_refused_by_name(tmp_path, monkeypatch):
    out = tmp_path / "atlas.nc"
    before = interrupted(out, SWEEP, 1, monkeypatch)
    says = r"parts holds an unfinished sweep whose specification_sha256 differs: .* now \(changed: actuator\.length, axes\."
    with pytest.raises(SweepError, match=says):
        make(out, parse(spec(SMALL)))
    assert sorted(Path(f"{out}.parts").glob("free-*.bin")) == before
    other = run.identify(SWEEP) | {"code_sha256": "other"}
    monkeypatch.setattr(run, "identify", lambda sweep: other)
    with pytest.raises(SweepError, match=r"whose code_sha256 differs: .* there, 'other' now"):
        make(out, SWEEP)


def test_an_unfinished_sweep_without_a_shard_stands_in_nobodys_way(reference, tmp_path):
    """As one leaves it that is killed while kernels are compiled."""
    left = run.Shards(tmp_path / "atlas.nc")
    left.hold()
    left.open({"plan_sha256": "other", "specification_sha256": "other"}, "title = 'other'")
    left._let_go()
    same_bits(reference, make(tmp_path / "atlas.nc", SWEEP))
    only(tmp_path, "atlas.nc")


@pytest.mark.parametrize(
    ("before", "says"),
    [
        ('[axes]\nalpha = [1, 2]\n"odd key" = 1', " (changed: title, axes.alpha, axes.'odd key')"),
        ('# more words\ntitle = "A"\naxes.alpha = [1]', " (changed: comments, or how it is written)"),
        ("\n".join(f"a{k} = 1" for k in range(9)), " (changed: title, axes.alpha, a0, a1, a2, a3 and 5 more)"),
        ("title = ", ""),
        (None, ""),
    ],
)
def test_what_was_changed_in_a_specification_is_named(before, says):
    assert changes(before, 'title = "A"\n[axes]\nalpha = [1]') == says


def test_a_finished_atlas_is_used_again_and_never_overwritten_unasked(tmp_path, monkeypatch, capsys):
    out, sweep = tmp_path / "atlas.nc", parse(spec(SMALL))
    first = make(out, sweep)
    stamp = out.stat().st_mtime_ns
    with monkeypatch.context() as patch:
        patch.setattr(run, "solve_shard", None)  # nothing may be solved
        with run_sweep(sweep, out) as atlas:
            assert isinstance(atlas, Atlas)
            assert first.identical(atlas.data.load())
    assert "is complete already" in capsys.readouterr().out
    other = parse(spec(SMALL, title="Another"))
    with pytest.raises(
        SweepError, match=r"its specification_sha256 differs: .* now \(changed: title\); choose another"
    ):
        make(out, other)
    assert out.stat().st_mtime_ns == stamp
    assert make(out, other, overwrite=True).attrs["title"] == "Another"
    only(tmp_path, "atlas.nc")

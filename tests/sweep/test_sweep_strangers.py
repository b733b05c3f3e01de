"""What others have beside a sweep's output, or put there, stays as it is; what changed on disk is not collected."""

import errno
import json
import os

import pytest
from commands import refused
from grids import SMALL, make, only, spec
from shards import same_bits
from test_sweep_faults import Disk

from freesweep.atlas import files
from freesweep.atlas.files import EnvironmentFault
from freesweep.cli import ENVIRONMENT
from freesweep.sweep import run, shard_file, shards
from freesweep.sweep.shards import SweepError
from freesweep.sweep.spec import parse

AXES = {"alpha": [-20.0, 40.0], "beta": [-50.0, 20.0, 70.0], "pressure": [0.0, 1e5]}
SWEEP, OTHER = parse(spec(AXES)), parse(spec(SMALL))


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    return make(tmp_path_factory.mktemp("reference") / "atlas.nc", SWEEP)


@pytest.fixture(autouse=True)
def _small_shards(monkeypatch):
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", 6)


def before_collecting(monkeypatch, act):
    """Do something once all shards are saved, before the first is collected."""
    write = run._write

    def acting(*given):
        act()
        return write(*given)

    monkeypatch.setattr(run, "_write", acting)


@pytest.mark.parametrize("place", [40, -8])
def test_a_shard_that_changed_between_save_and_collection_is_not_collected(place, reference, tmp_path, monkeypatch):
    """Eight bytes of one shard: no atlas is made of them, and the same sweep solves that part again."""
    out = tmp_path / "atlas.nc"

    def change():
        path = sorted((tmp_path / "atlas.nc.parts").glob("free-*.bin"))[1]
        content = bytearray(path.read_bytes())
        start = place % len(content)
        content[start : start + 8] = bytes(byte ^ 1 for byte in content[start : start + 8])
        path.write_bytes(content)

    with monkeypatch.context() as patch:
        before_collecting(patch, change)
        with pytest.raises(
            EnvironmentFault, match=r"free-000001-\w+\.bin: other bytes are read back than were written"
        ):
            make(out, SWEEP)
    assert not out.exists()
    solved, solve = [], run.solve_shard
    monkeypatch.setattr(run, "solve_shard", lambda *job: solved.append(job) or solve(*job))
    same_bits(reference, make(out, SWEEP))
    assert len(solved) == 1
    only(tmp_path, "atlas.nc")


@pytest.mark.parametrize("most", [0, 1 << 27])
def test_the_memory_for_shards_does_not_change_a_bit(most, reference, tmp_path, monkeypatch):
    monkeypatch.setattr(shard_file, "MOST_KEPT", most)
    same_bits(reference, make(tmp_path / "atlas.nc", SWEEP))


@pytest.mark.parametrize("links", [True, False], ids=["with hard links", "without"])
def test_an_output_that_appears_while_a_sweep_runs_is_kept(links, reference, tmp_path, monkeypatch):
    out = tmp_path / "atlas.nc"

    def none(*_):
        raise OSError(errno.EPERM, os.strerror(errno.EPERM))

    with monkeypatch.context() as patch:
        if not links:
            patch.setattr(files.os, "link", none)
        before_collecting(patch, lambda: out.write_text("precious"))
        with pytest.raises(SweepError, match=r"atlas\.nc is no readable netCDF4 file.*choose another output"):
            make(out, SWEEP)
        assert out.read_text() == "precious"
        only(tmp_path, "atlas.nc", "atlas.nc.parts")  # what was solved is kept
        out.unlink()
    with monkeypatch.context() as patch:
        if not links:
            patch.setattr(files.os, "link", none)
        same_bits(reference, make(out, SWEEP))
    only(tmp_path, "atlas.nc")


def test_the_same_atlas_from_another_machine_is_taken(reference, tmp_path, monkeypatch):
    """On a network disk without locks two processes may make one atlas: the first one's stays."""
    out, elsewhere = tmp_path / "atlas.nc", tmp_path / "elsewhere" / "atlas.nc"
    elsewhere.parent.mkdir()
    make(elsewhere, SWEEP)
    before_collecting(monkeypatch, lambda: elsewhere.rename(out))
    same_bits(reference, make(out, SWEEP))
    only(tmp_path, "atlas.nc", "elsewhere")


def test_overwriting_replaces_what_appeared(reference, tmp_path, monkeypatch):
    out = tmp_path / "atlas.nc"
    before_collecting(monkeypatch, lambda: out.write_text("given up"))
    same_bits(reference, make(out, SWEEP, overwrite=True))


STRANGE = {
    "atlas.nc.parts/notes.txt": "mine",
    "atlas.nc.parts/manifest.json.old": "{}",
    "atlas.nc.parts/my-data.bin": "mine",
    "atlas.nc.parts/free-000001-cafe.bin": "mine",
    "atlas.nc.parts/lock": "mine",
    "atlas.nc.parts/.freesweep.part": "mine",
    "atlas.nc.parts/deep/free-000001.bin": "mine",
    ".atlas.nc.backup.part": "mine",
    ".atlas.nc.original.part": "mine",
    ".other.nc.freesweep-abcdefgh.part": "of another sweep",
}


@pytest.mark.parametrize("overwrite", [False, True])
def test_files_of_others_stay(overwrite, reference, tmp_path):
    for name, text in STRANGE.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    out = tmp_path / "atlas.nc"
    if overwrite:  # an unfinished sweep and an atlas of another specification
        with pytest.MonkeyPatch.context() as patch:
            before_collecting(patch, lambda: 1 / 0)
            with pytest.raises(ZeroDivisionError):
                make(out, OTHER)
        out.write_text("given up")
    for _ in range(2):  # the second finds it complete
        same_bits(reference, make(out, SWEEP, overwrite=overwrite))
        there = [path for path in tmp_path.rglob("*") if path.is_file() and path != out]
        assert {str(path.relative_to(tmp_path)): path.read_text() for path in there} == STRANGE


def test_a_manifest_of_another_program_is_neither_read_nor_removed(tmp_path):
    folder = tmp_path / "atlas.nc.parts"
    folder.mkdir()
    for text in (json.dumps({"name": "a browser's extension"}), "[1]", "\x00"):
        (folder / "manifest.json").write_text(text)
        with pytest.raises(SweepError, match=r"manifest\.json is damaged, or not of a sweep"):
            make(tmp_path / "atlas.nc", OTHER)
        assert (folder / "manifest.json").read_text() == text
    only(folder, "manifest.json")


@pytest.mark.parametrize("name", ["a[1].nc", "*.nc", "what?.nc"])
def test_a_name_is_no_pattern(name, tmp_path):
    out, others = tmp_path / name, tmp_path / ".x.nc.freesweep-abcdefgh.part"
    others.write_text("of another sweep")
    left = tmp_path / f".{name}.freesweep-abcdefgh.part"
    left.write_text("half")
    make(out, OTHER)
    only(tmp_path, name, others.name)


def test_a_link_is_not_followed(tmp_path, capsys):
    elsewhere, out = tmp_path / "elsewhere", tmp_path / "atlas.nc"
    elsewhere.mkdir()
    (elsewhere / "free-notes.bin").write_text("mine")
    (tmp_path / "atlas.nc.parts").symlink_to(elsewhere)
    with pytest.raises(SweepError, match=r"atlas\.nc\.parts is a link"):
        make(out, OTHER)
    only(elsewhere, "free-notes.bin")
    (tmp_path / "atlas.nc.parts").unlink()
    out.symlink_to(tmp_path / "nothing.nc")
    with pytest.raises(SweepError, match="a link to nothing"):
        make(out, OTHER)


def test_an_unfinished_sweep_of_another_specification_outlives_a_complete_atlas(tmp_path, monkeypatch):
    """Begun over a complete atlas and interrupted; the first specification again finds its atlas and leaves the shards."""
    out = tmp_path / "atlas.nc"
    make(out, OTHER)
    with monkeypatch.context() as patch:
        before_collecting(patch, lambda: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            make(out, SWEEP, overwrite=True)
    there = sorted(path.name for path in (tmp_path / "atlas.nc.parts").iterdir())
    assert len(there) > 3
    make(out, OTHER)
    assert sorted(path.name for path in (tmp_path / "atlas.nc.parts").iterdir()) == there


@pytest.mark.parametrize("code", [errno.EIO, errno.EMFILE, errno.EROFS, errno.ENOENT])
def test_a_shard_that_cannot_be_read_is_a_fault_of_the_environment(code, reference, tmp_path, monkeypatch, capsys):
    (tmp_path / "spec.toml").write_text(SWEEP.text)
    out = tmp_path / "atlas.nc"
    words = ("sweep", str(tmp_path / "spec.toml"), "-o", str(out), "--quiet")
    read = shard_file.Path.read_bytes

    def failing(path):
        if path.suffix == ".bin":
            raise OSError(code, os.strerror(code))
        return read(path)

    for _ in range(2):  # when it is collected, and when the sweep is begun again
        with monkeypatch.context() as patch:
            patch.setattr(shard_file.Path, "read_bytes", failing)
            error = refused(capsys, *words, code=ENVIRONMENT)
        assert f"cannot read {out}.parts/free-00000" in error
        assert os.strerror(code) in error
    same_bits(reference, make(out, SWEEP))


def test_a_lock_that_cannot_be_looked_at_is_a_fault_of_the_environment(tmp_path, monkeypatch, capsys):
    (tmp_path / "spec.toml").write_text(OTHER.text)

    monkeypatch.setattr(shards, "os", Disk("fstat", 1, "for ever", errno.EIO))
    out = str(tmp_path / "atlas.nc")
    assert "Input/output error" in refused(capsys, "sweep", str(tmp_path / "spec.toml"), "-o", out, code=ENVIRONMENT)

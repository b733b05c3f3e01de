"""Machine code on disk: the very bytes that were written are loaded, and whatever else is there is compiled anew."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from grids import CHILD_ENVIRONMENT
from numba.core.caching import IndexDataCacheFile

from freesweep import interpret, jit, kernel_cache


def invert(numbers):
    for i in range(len(numbers)):
        numbers[i] = 1.0 / numbers[i]


invert.__module__ = "freesweep.query.axis"  # kernels live in a room, and their files name a module


@pytest.fixture(autouse=True)
def _fresh_installation(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def inverted():
    """Whether a new process, as it were, took the kernel from the disk; that it computes what it should is checked."""
    entry, numbers = jit.entry_point(invert), np.array([1.0, 4.0])
    entry(numbers)
    np.testing.assert_array_equal(numbers, [1.0, 0.25])
    return sum(entry.stats.cache_hits.values()) == 1


def files():
    return [path for path in Path(jit.cache_folder("query")).iterdir()]


def flipped(place):
    def flip(path):
        content = bytearray(path.read_bytes())
        content[int(place * len(content))] ^= 16
        path.write_bytes(content)

    return flip


DAMAGE = {
    "empty": lambda path: path.write_bytes(b""),
    "cut": lambda path: path.write_bytes(path.read_bytes()[:-1]),
    "removed": lambda path: path.unlink(),
    "a folder": lambda path: (path.unlink(), path.mkdir()),
    "of zeros": lambda path: path.write_bytes(bytes(path.stat().st_size)),
    **{f"a bit flipped at {place}": flipped(place) for place in (0.0, 0.2, 0.5, 0.8, 0.999)},
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_file_is_a_miss_and_is_replaced(damage):
    assert not inverted()
    assert inverted()
    (path,) = files()
    DAMAGE[damage](path)
    assert not inverted()
    assert inverted() == (damage != "a folder")


def test_whole_bytes_that_llvm_refuses_are_a_miss(monkeypatch):
    def broken(*_):
        raise RuntimeError("LLVM: broken object")

    assert not inverted()
    monkeypatch.setattr(kernel_cache.CompileResult, "_rebuild", broken)
    assert not inverted()


def test_numba_alone_would_load_a_damaged_file(tmp_path):
    """The control: an empty index, as after a power cut, is an error to Numba's own cache."""
    cache = IndexDataCacheFile(str(tmp_path), "kernel", "stamp")
    cache.save("types", "machine code")
    next(tmp_path.glob("*.nbi")).write_bytes(b"")
    with pytest.raises(EOFError):
        cache.load("types")


def test_files_are_of_one_processor_and_types():
    entry = jit.entry_point(invert)
    for kind in (np.float64, np.float32):
        entry(np.ones(2, kind))
    assert len(files()) == 2
    assert kernel_cache.compiled(jit.cache_folder("query")) == {"freesweep.query.axis.invert"}
    entry.recompile()  # as Numba forgets what was compiled


def test_a_full_disk_costs_only_the_time(monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(kernel_cache.os, "fsync", full)
    assert not inverted()
    assert files() == []
    assert not inverted()


def test_without_a_home_nothing_is_kept(monkeypatch, capsys):
    """No HOME and no entry for this user, as in a container run under a number."""
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.delenv("HOME", raising=False)
    monkeypatch.setattr("pwd.getpwuid", lambda _: {}["nobody"])
    assert jit.cache_folder("query") is None
    assert not inverted()
    monkeypatch.setattr(interpret, "_spent", {})
    entry = jit.entry_point(invert)
    assert not interpret.at_once(interpret.FEW + 1, entry, entry, np.ones(1))
    assert "in each process, for there is no folder to keep them in" in capsys.readouterr().err


def test_a_command_needs_no_home(tmp_path):
    script = (
        "import pwd, sys; sys.argv[1:] = ['lock', *'--alpha 30 --beta -30 --length 100mm --radius 5mm --wall 1mm'.split()]\n"
        "def nobody(number): raise KeyError(number)\n"
        "pwd.getpwuid = nobody\n"
        "from freesweep.cli import main; sys.exit(main())"
    )
    without = {name: text for name, text in CHILD_ENVIRONMENT.items() if name not in ("HOME", "XDG_CACHE_HOME")}
    done = subprocess.run(
        [sys.executable, "-P", "-c", script], env=without, capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert "67.77193" in done.stdout
    assert os.listdir(tmp_path) == []

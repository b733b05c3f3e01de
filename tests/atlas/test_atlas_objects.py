"""Atlases as objects: unsealed ones give one warning, pickled ones are a path, and no lock is needed to read one."""

import concurrent.futures
import errno
import gc
import multiprocessing
import os
import pickle
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from commands import refused, run
from grids import CHILD_ENVIRONMENT, SMALL, make, spec

import freesweep as fs
from freesweep.atlas import guard, netcdf
from freesweep.atlas.files import EnvironmentFault
from freesweep.cli import ENVIRONMENT
from freesweep.sweep.spec import parse

AXES = {"alpha": [20.0, 25.0, 30.0, 35.0], "beta": [-50.0, -45.0, -40.0], "pressure": [0.0, 5e4, 1e5]}
AT = {"alpha": np.array([25.0, 31.0]), "beta": -45.0, "pressure": 5e4}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("objects") / "atlas.nc"
    make(path, parse(spec(AXES)))
    return path


# --- seals


def with_attribute(path):
    with h5py.File(path, "r+") as file:
        file.attrs["note"] = "checked by hand"


def with_number(path):
    with h5py.File(path, "r+") as file:
        file["c01"][()] = 2e5


def joined(path):
    with xr.open_dataset(path) as data:
        both = xr.concat([data.isel(alpha=[0, 1]), data.isel(alpha=[2, 3])], "alpha", data_vars="minimal").load()
    both.to_netcdf(path, engine="netcdf4")


@pytest.mark.parametrize("edit", [with_attribute, with_number, joined])
def test_an_edited_atlas_is_said_to_be_one_once(edit, path, tmp_path, capsys):
    edited = tmp_path / "edited.nc"
    shutil.copyfile(path, edited)
    edit(edited)
    gc.collect()
    with pytest.warns(fs.UnsealedWarning, match=r"edited\.nc has no seal") as said:
        atlas = fs.open_atlas(edited)
    assert len(said) == 1
    with atlas:
        atlas.query(**AT)  # where warnings are errors
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fs.UnsealedWarning)
        fs.open_atlas(edited).close()
    assert run("info", str(edited)) == 0
    out, err = capsys.readouterr()
    assert out.count("has no seal") == 1
    assert err == ""


def test_a_sealed_atlas_says_where_to_ask(path, capsys):
    with fs.open_atlas(path):
        pass
    assert run("info", str(path)) == 0
    assert "freesweep verify holds it against every bit" in capsys.readouterr().out


# --- pickles


def ask(atlas, interpolator):
    """What a worker answers."""
    return atlas.query(**AT)["rotation"].values, interpolator(AT["alpha"], -45.0, 5e4, gradient=True)


def same(found, wanted):
    assert np.isfinite(wanted[0]).any()
    assert found[0].tobytes() == wanted[0].tobytes()
    assert [array.tobytes() for array in found[1]] == [array.tobytes() for array in wanted[1]]


def test_pickled_atlases_and_interpolators_are_a_path_and_names(path, monkeypatch):
    cloudpickle = pytest.importorskip("cloudpickle")
    monkeypatch.chdir(path.parent)
    with fs.open_atlas(path.name) as atlas:  # a relative path, that means nothing elsewhere
        for names in ("rotation", ["rotation", "volume"]):
            f = atlas.interpolator(names)
            wanted = ask(atlas, f)
            monkeypatch.chdir("/")
            for dumps in (pickle.dumps, cloudpickle.dumps):
                content = dumps((atlas, f))
                assert len(content) < 1000
                same(ask(*pickle.loads(content)), wanted)
            monkeypatch.chdir(path.parent)
        first, second = (pickle.loads(pickle.dumps(atlas)) for _ in range(2))
        assert first is second  # its tables are made once in a process
        first.close()


def test_a_spawned_process_answers_with_the_same_bits(path):
    with fs.open_atlas(path) as atlas:
        f = atlas.interpolator("rotation")
        wanted = ask(atlas, f)
        context = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(1, context) as pool:
            found = pool.submit(ask, atlas, f).result()
    same(found, wanted)


# --- locks, and other faults of the machine

SHIM = "#include <errno.h>\nint flock(int file, int how) { errno = ENOLCK; return -1; }\n"
CHILD = """
import xarray
from freesweep.cli import main
assert main(["sweep", "spec.toml", "--quiet"]) == 0
assert main(["verify", "spec.nc"]) == 0
try:
    xarray.open_dataset("spec.nc", engine="netcdf4")
except OSError as error:
    print("the control:", error)
"""


@pytest.mark.skipif(not shutil.which("cc") or sys.platform != "linux", reason="no compiler of C for the shim")
def test_a_file_system_without_locks_serves(tmp_path):
    """As some network disks: flock gives ENOLCK to whoever asks, the HDF5 libraries among them."""
    (tmp_path / "shim.c").write_text(SHIM)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", tmp_path / "shim.so", tmp_path / "shim.c"], check=True)
    (tmp_path / "spec.toml").write_text(spec(SMALL))
    environment = CHILD_ENVIRONMENT | {"LD_PRELOAD": str(tmp_path / "shim.so")}
    done = subprocess.run(
        [sys.executable, "-P", "-c", CHILD], env=environment, cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "every bit" in done.stdout
    assert "the control: [Errno -101] NetCDF: HDF error" in done.stdout


def test_an_atlas_in_memory_is_the_same(path, monkeypatch):
    with fs.open_atlas(path) as atlas:
        wanted, answer = atlas.data.load(), atlas.query(**AT)
    monkeypatch.setattr(netcdf, "_has_locks", lambda _: False)
    with fs.open_atlas(path) as atlas:
        assert atlas.query(**AT).identical(answer)
        assert atlas.data.load().identical(wanted)


@pytest.mark.parametrize("code", [errno.EIO, errno.EMFILE, errno.ESTALE, errno.EROFS])
def test_a_disk_that_fails_makes_no_bad_file(code, path, monkeypatch, capsys):
    def failing(*_, **__):
        raise OSError(code, os.strerror(code))

    for place, name in ((guard, "damaged_heap"), (netcdf, "dataset"), (Path, "open")):
        with monkeypatch.context() as patch:
            patch.setattr(place, name, failing)
            assert os.strerror(code) in refused(capsys, "info", str(path), code=ENVIRONMENT)
            with pytest.raises(OSError, match=os.strerror(code)) as caught:
                fs.open_atlas(path)
            assert name == "open" or isinstance(caught.value, EnvironmentFault)


def test_a_file_that_breaks_off_while_it_is_used_is_one_line(path, monkeypatch, capsys):
    def failing(*_):
        raise RuntimeError("NetCDF: HDF error")

    monkeypatch.setattr(fs.Atlas, "status_counts", failing)
    assert "freesweep verify FILE says whether it is damaged" in refused(capsys, "info", str(path), code=ENVIRONMENT)

"""Atlas files: written whole or not at all, opened only if they are atlases."""

import errno
import os
from pathlib import Path

import pytest
import xarray as xr
from grids import SMALL, make, only, spec

from freesweep import open_atlas
from freesweep.atlas import files
from freesweep.atlas.files import EnvironmentFault
from freesweep.atlas.store import AtlasError
from freesweep.sweep.shards import SweepError
from freesweep.sweep.spec import parse


def test_a_file_that_is_no_atlas_is_not_replaced(tmp_path):
    out = tmp_path / "notes.nc"
    out.write_text("precious")
    with pytest.raises(SweepError, match="is no readable netCDF4 file"):
        make(out, parse(spec(SMALL)))
    assert out.read_text() == "precious"


def test_a_failed_write_leaves_the_old_file_and_says_what_is_needed(tmp_path, monkeypatch):
    out, sweep = tmp_path / "atlas.nc", parse(spec(SMALL))
    make(out, sweep)
    before, rename = out.read_bytes(), os.replace

    def full(source, target):
        if Path(target) == out:
            raise OSError(errno.ENOSPC, "No space left on device")
        rename(source, target)

    with monkeypatch.context() as patch:
        patch.setattr(files.os, "replace", full)
        with pytest.raises(
            EnvironmentFault, match=r"cannot write .*atlas\.nc: No space left on device; [\d,]+ bytes needed"
        ):
            make(out, sweep, overwrite=True)
    assert out.read_bytes() == before
    only(tmp_path, "atlas.nc", "atlas.nc.parts")  # what was solved is kept, nothing half-written
    assert {path.suffix for path in Path(f"{out}.parts").iterdir()} == {".bin", ".json", ".lock"}


def test_a_missing_folder_is_a_fault_of_the_environment(tmp_path):
    with pytest.raises(EnvironmentFault, match=r"cannot make the folder .*absent"):
        make(tmp_path / "absent" / "atlas.nc", parse(spec(SMALL)))


def test_only_atlases_are_opened(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"no atlas at .*; make one with: freesweep sweep SPEC -o none\.nc"):
        open_atlas(tmp_path / "none.nc")
    text, other, newer = (tmp_path / f"{name}.nc" for name in ("text", "other", "newer"))
    text.write_text("no netCDF")
    xr.Dataset({"status": 1}).to_netcdf(other, engine="netcdf4")
    xr.Dataset({"status": 1}, attrs={"freesweep_format": "2"}).to_netcdf(newer, engine="netcdf4")
    for path, says in ((text, "is no readable netCDF4 file"), (other, "found format None"), (newer, "format '2'")):
        with pytest.raises(AtlasError, match=says) as caught:
            open_atlas(path)
        assert str(path) in str(caught.value)
    make(tmp_path / "atlas.nc", parse(spec(SMALL)))
    cut = tmp_path / "cut.nc"
    cut.write_bytes((tmp_path / "atlas.nc").read_bytes()[:5000])
    with pytest.raises(AtlasError, match=r"cut\.nc is no readable"):
        open_atlas(cut)

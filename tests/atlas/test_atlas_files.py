"""Atlas files: written whole or not at all, opened only if they are atlases."""

import errno
import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from commands import refused, run
from grids import SMALL, make, only, spec

from freesweep import open_atlas
from freesweep.atlas import files
from freesweep.atlas.files import EnvironmentFault
from freesweep.atlas.store import AtlasError
from freesweep.atlas.write import packed
from freesweep.sweep.shards import SweepError
from freesweep.sweep.spec import parse

TUBE = ("--alpha", "30", "--beta", "-30", "--length", "192 mm", "--radius", "4.76 mm", "--wall", "1.59 mm")


def test_a_file_that_is_no_atlas_is_not_replaced(tmp_path):
    out = tmp_path / "notes.nc"
    out.write_text("precious")
    with pytest.raises(SweepError, match="is no readable netCDF4 file"):
        make(out, parse(spec(SMALL)))
    assert out.read_text() == "precious"


def test_states_of_one_actuator_are_called_what_they_are(tmp_path, capsys):
    path = tmp_path / "kept.nc"
    assert run("lock", *TUBE, "-o", str(path)) == 0
    capsys.readouterr()
    assert "holds states of one actuator" in refused(capsys, "info", str(path))
    with pytest.raises(AtlasError, match="freesweep plot curve draws them"):
        open_atlas(path)


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


def test_noise_is_stored_and_the_rest_deflated_in_streams_that_the_netcdf_library_reads(tmp_path):
    import zlib

    import h5py
    import netCDF4

    draw, shape = np.random.default_rng(1), (1 << 15,)
    smooth = 1.0 + 1e-3 * draw.random(shape)  # its first bytes change little, the others are noise
    for values, least, most in ((smooth, 0.62, 0.70), (np.tile(smooth[:261], 126)[: shape[0]], 0.0, 0.02)):
        content = packed(values, shape)
        plain = zlib.decompress(content)
        assert np.array_equal(np.frombuffer(plain, np.uint8).reshape(8, -1).T.ravel(), values.view(np.uint8))
        assert least < len(content) / values.nbytes < most
        with netCDF4.Dataset(tmp_path / "one.nc", "w") as file:
            file.createDimension("x", *shape)
            file.createVariable("v", "f8", ("x",), compression="zlib", shuffle=True, chunksizes=shape, fill_value=False)
        with h5py.File(tmp_path / "one.nc", "r+") as file:
            file["v"].id.write_direct_chunk((0,), content)
        with netCDF4.Dataset(tmp_path / "one.nc") as file:
            assert np.array_equal(file["v"][:], values)

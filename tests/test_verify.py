"""Verification of atlases: no bit of a file, and no piece of its content, can change unseen."""

import numpy as np
import pytest
import xarray as xr
from commands import refused, run
from grids import GRID, SMALL, make, spec

from freesweep import open_atlas
from freesweep.atlas.seal import SIZE, seal_fault, sealed
from freesweep.atlas.store import AtlasError, save_atlas
from freesweep.sweep.spec import parse
from freesweep.verify import faults

SMALLER = GRID | {"force": [-0.4, 0.0], "torque": [0.0], "c10": [0.1e6]}


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    """An atlas with degenerate designs, compressed walls and blocked states, and its path."""
    path = tmp_path_factory.mktemp("verify") / "atlas.nc"
    make(path, parse(spec(SMALLER) + "\n[solver]\nblocked = true"))
    return path


def changed(atlas, tmp_path, change):
    """The faults of an atlas whose dataset was changed before it was written and sealed."""
    with open_atlas(atlas) as opened:
        data = opened.data.load()
    save_atlas(change(data), tmp_path / "changed.nc")
    return faults(tmp_path / "changed.nc")


def test_an_atlas_as_written_is_whole_and_other_readers_open_it(atlas, capsys):
    assert faults(atlas) == []
    assert run("verify", str(atlas)) == 0
    assert "every bit" in capsys.readouterr().out
    with xr.open_dataset(atlas, decode_times=False) as data:  # a plain reader sees no seal
        assert np.isfinite(data["rotation"]).any()


def test_every_flipped_bit_and_every_truncation_is_found(atlas, tmp_path):
    content, path, rng = atlas.read_bytes(), tmp_path / "flipped.nc", np.random.default_rng(7)
    places = {*rng.integers(len(content), size=850).tolist(), *range(len(content) - SIZE, len(content)), 0}
    for place in sorted(places):
        flipped = bytearray(content)
        flipped[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(flipped)
        assert faults(path), place
    for length in [0, 1, SIZE - 1, SIZE, len(content) - 1, len(content) - SIZE, *rng.integers(len(content), size=60)]:
        path.write_bytes(content[:length])
        assert faults(path), length
    path.write_bytes(content + b"\n")
    assert faults(path)
    path.write_bytes(content)  # the control: what is not changed is not refused
    assert faults(path) == []


def test_a_flipped_bit_never_crashes_the_reader(atlas, tmp_path):
    content, path, rng = atlas.read_bytes(), tmp_path / "flipped.nc", np.random.default_rng(8)
    refusals = 0
    for place in rng.integers(len(content), size=120):
        flipped = bytearray(content)
        flipped[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(flipped)
        try:
            with open_atlas(path) as opened:
                opened.data.load()
        except (AtlasError, OSError, RuntimeError, ValueError, KeyError, UnicodeDecodeError):
            refusals += 1
    assert 0 < refusals <= 120


def test_the_command_refuses_with_a_reason(atlas, tmp_path, capsys):
    assert "no atlas at" in refused(capsys, "verify", str(tmp_path / "none.nc"))
    path = tmp_path / "cut.nc"
    path.write_bytes(atlas.read_bytes()[:-100])
    assert "does not end in a seal" in refused(capsys, "verify", str(path))
    content = bytearray(atlas.read_bytes())
    content[2000] ^= 16
    path.write_bytes(content)
    assert "not those that were written" in refused(capsys, "verify", str(path))
    path.write_bytes(sealed(b"no netCDF"))
    assert seal_fault(path) is None
    assert "is no readable netCDF4 file" in refused(capsys, "verify", str(path))


def test_a_sealed_file_of_other_content_is_found(atlas, tmp_path):
    def with_value(data):
        data["rotation"].values.flat[np.flatnonzero(data["status"].values.ravel() != 0)[0]] = 1.0
        return data

    assert any("rotation: 1 numbers where its status says none" in f for f in changed(atlas, tmp_path, with_value))

    def without_bound(data):
        data["locked_volume_error"].values.flat[np.flatnonzero(data["locked_status"].values.ravel() == 0)[0]] = np.nan
        return data

    assert changed(atlas, tmp_path, without_bound) == [
        "locked_volume: 1 numbers without a bound, or bounds without a number"
    ]

    def other_axis(data):
        return data.assign_coords(alpha=[*data["alpha"].values[:2], 30.000000000001])

    assert changed(atlas, tmp_path, other_axis) == ["alpha is not what its specification asks for"]
    assert "axes" in str(changed(atlas, tmp_path, lambda data: data.isel(pressure=slice(0, 2))))
    other = spec(SMALL)
    assert changed(atlas, tmp_path, lambda data: data.assign_attrs(specification=other)) == [
        "its specification is not the one whose SHA-256 it carries"
    ]
    assert changed(atlas, tmp_path, lambda data: data.drop_vars("rotation_error")) == ["rotation lacks rotation_error"]
    assert changed(atlas, tmp_path, lambda data: data) == []

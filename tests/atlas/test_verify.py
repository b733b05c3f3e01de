"""Verification of atlases: no bit of a file, and no piece of its content, can change unseen."""

import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from commands import refused, run
from grids import CHILD_ENVIRONMENT, GRID, SMALL, make, spec, store

from freesweep import open_atlas
from freesweep.atlas.seal import SIZE, seal_fault, sealed
from freesweep.sweep import run as sweep_run
from freesweep.sweep.spec import parse
from freesweep.verification.cross_check import draw, resolve
from freesweep.verification.restate import faults as restated
from freesweep.verification.verify import faults

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
    store(change(data), tmp_path / "changed.nc")
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


READER = """
import faulthandler, random, sys
from pathlib import Path
from freesweep.atlas.store import AtlasError, open_atlas
from freesweep.verification.verify import faults
content, path, draw, tally = Path(sys.argv[1]).read_bytes(), Path(sys.argv[2]), random.Random(8), [0, 0, 0]
for _ in range(int(sys.argv[3])):
    changed, place = bytearray(content), draw.randrange(len(content))
    kind = draw.choice(["bit", "bit", "bit", "bytes", "cut", "moved"])
    if kind == "bit":
        changed[place] ^= 1 << draw.randrange(8)
    elif kind == "bytes":
        changed[place : place + 8] = draw.choice([b"\\xff" * 8, bytes(8), draw.randbytes(8)])
    elif kind == "cut":
        del changed[place:]
    else:
        other = draw.randrange(len(content))
        changed[place : place + 64] = content[other : other + 64]
    path.write_bytes(changed)
    print(kind, place, flush=True)
    faulthandler.dump_traceback_later(60, exit=True)  # the HDF5 library may not end
    tally[2] += not faults(path) and changed != content
    try:
        with open_atlas(path) as opened:
            opened.data.load()
        tally[0] += 1
    except (AtlasError, OSError, RuntimeError, ValueError):  # what is read after opening may be refused by HDF5 itself
        tally[1] += 1
print(*tally)
"""


@pytest.mark.parametrize("count", [24, pytest.param(1000, marks=pytest.mark.long)])
def test_a_changed_atlas_never_crashes_the_reader(count, atlas, tmp_path):
    """Bits, runs of bytes, cuts: read in a process of its own, without a look at the seal, and verified."""
    done = subprocess.run(
        [sys.executable, "-P", "-c", READER, str(atlas), str(tmp_path / "changed.nc"), str(count)],
        capture_output=True, text=True, env=CHILD_ENVIRONMENT,
    )  # fmt: skip
    *places, tally = done.stdout.splitlines() or [""]
    assert done.returncode == 0, (places[-1:], done.stderr)
    opened, refused_, unnoticed = map(int, tally.split())
    assert opened + refused_ == count
    assert refused_ > count // 4
    assert unnoticed == 0


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
    assert "does not begin as an HDF5 file" in refused(capsys, "verify", str(path))


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
        return data.assign_coords(alpha=data["alpha"] * [1.0, 1.0, 1.000000000001])

    assert changed(atlas, tmp_path, other_axis) == ["alpha is not what its specification asks for"]
    assert "axes" in str(changed(atlas, tmp_path, lambda data: data.isel(pressure=slice(0, 2))))
    other = spec(SMALL)
    assert changed(atlas, tmp_path, lambda data: data.assign_attrs(specification=other)) == [
        "its specification is not the one whose SHA-256 it carries"
    ]
    assert changed(atlas, tmp_path, lambda data: data.drop_vars("rotation_error"))[0].endswith(
        "rotation has no rotation_error"
    )
    assert changed(atlas, tmp_path, lambda data: data) == []


def test_attributes_are_held_against_the_specification(atlas, tmp_path):
    """Sealed anew with another energy, a laxer accuracy or tolerance, a profile or a rubber that nobody asked for."""
    for name, value in {
        "energy": "principal",
        "accuracy": 1e-3,
        "interpolation_tolerance": 1e-2,
        "title": "A better sweep",
        "profile_wall": [0.0, 1e-3, 1.0, 2e-3],
        "largest_stretch": 9.0,
    }.items():
        (fault,) = changed(atlas, tmp_path, lambda data, name=name, value=value: data.assign_attrs({name: value}))
        assert fault.startswith(f"its attribute {name} is ")
    for name, value in {"thin_wall_ratio": 1.0, "thin_wall_note": "wall/radius 0.03"}.items():
        (fault,) = changed(atlas, tmp_path, lambda data, name=name, value=value: data.assign_attrs({name: value}))
        assert fault.startswith("its note on thick walls, ")


def test_bounds_that_were_widened_are_found_by_solving_anew(atlas, tmp_path, capsys):
    """Sealed anew with bounds of which a second method finds nothing wrong: they hold."""
    with open_atlas(atlas) as opened:
        data = opened.data.load()
    assert restated(draw(data, 40)) == []
    names = [name for name in data if name.endswith("_error") and not name.startswith(("ideal", "limit"))]
    store(data.assign({name: (data[name] * 1e7).assign_attrs(data[name].attrs) for name in names}), tmp_path / "a.nc")
    assert faults(tmp_path / "a.nc") == []
    assert run("verify", str(tmp_path / "a.nc"), "--resolve", "40") == 2
    told = capsys.readouterr().err
    for name in ("deformed_length", "blocked_force", "locked_rotation"):
        assert f"{name}_error: " in told
    (found,) = restated(draw(data.assign(rotation_error=data["rotation_error"] * 1e7), 40))
    assert found.startswith("rotation_error: ")


def test_limit_pressures_are_held_against_statuses_and_solved_anew(tmp_path):
    axes = {"alpha": [60.0, 61.0], "pressure": [1e5, 2e5, 3e5]}
    text = spec(axes, fixed={"beta": 55.0, "length": 0.1904, "c01": 8.5e4}, energy="principal")
    data = make(tmp_path / "atlas.nc", parse(text))
    assert data["limit_found"].all()
    assert faults(tmp_path / "atlas.nc") == []

    def times(factor):
        limit = data["limit_pressure"] * factor
        return data.assign(limit_pressure=limit.assign_attrs(data["limit_pressure"].attrs))

    for factor in (0.5, 2.0):
        store(times(factor), tmp_path / "changed.nc")
        assert faults(tmp_path / "changed.nc") == ["limit_pressure: 2 states beyond it, or none below it"]

    def error(factor, wider):
        bound = data["limit_pressure_error"] * wider
        return times(factor).assign(limit_pressure_error=bound.assign_attrs(data["limit_pressure_error"].attrs))

    assert restated(draw(data, 100)) == []
    (fault,) = restated(draw(error(1.0, 1e6), 100))
    assert fault.startswith("limit_pressure_error: 4 of 4 bounds are more than 100 times as wide")
    assert "limit_pressure: 4 times it is another" in restated(draw(error(1.0 + 1e-5, 1e6), 100))
    none = data["limit_pressure"].where(False).assign_attrs(data["limit_pressure"].attrs)
    removed = data.assign(
        limit_pressure=none, limit_pressure_error=none.assign_attrs(data["limit_pressure_error"].attrs)
    )
    removed["limit_found"] = (data["limit_found"] * 0).assign_attrs(data["limit_found"].attrs)
    store(removed, tmp_path / "changed.nc")
    assert faults(tmp_path / "changed.nc") == ["limit_pressure: 2 states beyond it, or none below it"]
    assert "limit_pressure: 4 times it is not there" in restated(draw(removed, 100))
    for factor, broken in ((1.0, 0), (1.0 + 1e-5, 4)):
        compared = {compared.name: compared for compared in resolve(draw(times(factor), 100))[0]}
        assert compared["limit_pressure"].broken.sum() == broken


def test_shards_of_an_unfinished_sweep_are_held_against_their_names(tmp_path, monkeypatch, capsys):
    """A flipped bit, a cut, two exchanged shards, one of another plan: each is found, and solved again."""
    axes = {"alpha": [10.0, 20.0, 30.0, 40.0, 50.0], "beta": [-35.0], "pressure": [2e4]}
    out, other = tmp_path / "atlas.nc", tmp_path / "other.nc"
    monkeypatch.setattr(sweep_run, "SHARD_EQUILIBRIA", 2)  # one problem each
    wanted = make(tmp_path / "whole.nc", parse(spec(axes)))

    def interrupted(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(sweep_run, "_write", interrupted)
        for path, own in ((out, axes), (other, axes | {"beta": [-36.0]})):
            with pytest.raises(KeyboardInterrupt):
                make(path, parse(spec(own)))
    shards, others = (sorted((tmp_path / f"{name}.parts").glob("free-*.bin")) for name in ("atlas.nc", "other.nc"))
    assert len(shards) == len(others) == 5
    assert faults(out) == [
        f"it is unfinished: 5 whole shards in {out}.parts; the sweep goes on when it is started again"
    ]
    content = [path.read_bytes() for path in shards]
    assert len({len(one) for one in content}) == 1
    shards[0].write_bytes(bytes([content[0][0] ^ 1]) + content[0][1:])
    shards[1].write_bytes(content[1][:-1])
    # the name of one number on the bytes and the digest of another
    swapped = shards[2].with_name(f"free-000003-{shards[2].stem.rsplit('-', 1)[1]}.bin")
    shards[3].unlink()
    shards[2].rename(swapped)
    (shards[4].parent / others[4].name).write_bytes(others[4].read_bytes())
    found = faults(out)
    assert "1 whole shards" in found[0]
    assert sorted(line.split(" ")[0] for line in found[1:]) == sorted(
        [shards[0].name, shards[1].name, swapped.name, others[4].name]
    )
    assert "damaged, stale or swapped" in refused(capsys, "verify", str(out))
    assert make(out, parse(spec(axes))).identical(
        wanted.assign_attrs(started=make(out, parse(spec(axes))).attrs["started"])
    )
    assert faults(out) == []

"""Tables for other programs: what their readers read is what the atlas says."""

import csv
import importlib.util
import io
import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from blocks import BLOCK
from commands import refused, run

import freesweep as fs
from freesweep.export.table import ExportError
from freesweep.query.faults import QueryError

PAGE = (Path(__file__).parents[2] / "docs" / "export.md").read_text(encoding="utf-8")
C_PROGRAM = re.search(r"^```c\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)[1]
FORCE = "blocked_force"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page's names after its blocks ran, in a folder with the files that they made."""
    folder, names = tmp_path_factory.mktemp("export"), {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for block in BLOCK.finditer(PAGE):
            code, expected = block.groups()
            out = io.StringIO()
            names["print"] = lambda *words, out=out: print(*words, file=out)
            exec(compile("\n" * PAGE[: block.start(1)].count("\n") + code, "export.md", "exec"), names)
            assert out.getvalue() == (expected or "")
    yield names | {"folder": folder}
    names["atlas"].close()


def test_every_row_of_the_text_is_a_state_of_the_atlas(page):
    stored = page["atlas"].data[FORCE]
    rows = list(csv.DictReader((page["folder"] / "muscle.csv").read_text().splitlines()))
    assert len(rows) == stored.size
    for row in rows:
        at = {name: float(row[key]) for name, key in (("held_length_ratio",) * 2, ("pressure", "pressure [Pa]"))}
        assert float(row[f"{FORCE} [N]"]) == stored.sel(at).item()
        assert float(row["length [m]"]) == 0.192
        assert 0.0 < float(row[f"{FORCE}_error [N]"]) < 1e-3
    held = json.loads((page["folder"] / "muscle.json").read_text())
    assert np.array_equal(held["variables"][FORCE]["values"], stored)
    assert held["fixed"]["fiber_extension"] == {
        "units": "1",
        "long_name": "stretch of the fibers at any pressure",
        "values": 1.005,
    }


def test_arrays_carry_axes_units_and_errors(page):
    plain, matlab = page["plain"], page["matlab"]
    assert dict(plain["units"])["pressure"] == "Pa"
    assert matlab["units"]["pressure"].item()[0] == "Pa"
    for name in ("pressure", "held_length_ratio", FORCE, f"{FORCE}_error", f"{FORCE}_status"):
        assert np.array_equal(plain[name], page["atlas"].data[name]), name
        assert np.array_equal(np.squeeze(matlab[name]), page["atlas"].data[name]), name


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler here")
def test_a_c_program_reads_the_header(page):
    folder = page["folder"]
    (folder / "main.c").write_text(C_PROGRAM)
    flags = ("-std=c99", "-pedantic", "-Wall", "-Werror")
    subprocess.run(["cc", *flags, "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
    found = float(subprocess.run(["./main"], cwd=folder, check=True, capture_output=True).stdout)
    linear = page["atlas"].data[FORCE].interp(held_length_ratio=0.95, pressure=110e3).item()
    assert found == pytest.approx(linear, abs=1e-4)


def test_the_simulink_script_holds_the_table_column_by_column(page):
    text = (page["folder"] / "muscle.m").read_text()
    values, sizes = re.search(rf"muscle_{FORCE}.Table.Value = reshape\(\[(.*?)\], \[(.*?)\]\);", text).groups()
    table = np.reshape(np.array(values.split(), float), [int(one) for one in sizes.split()], order="F")
    assert np.array_equal(table, page["atlas"].data[FORCE])
    assert f"muscle_{FORCE}.Breakpoints(2).Unit = 'Pa';" in text
    for told in (text, (page["folder"] / "muscle.h").read_text()):
        assert re.search(r"^\W*fiber_extension = 1\.005$", told, re.MULTILINE)


@pytest.mark.skipif(importlib.util.find_spec("mujoco") is None, reason="MuJoCo's Python package is not installed")
def test_a_weight_on_the_muscle_of_mujoco_rests_where_inflate_says(page):
    import mujoco

    found, expected = page["lengths"](mujoco, str(page["folder"] / "muscle.xml"))
    assert 0.88 * 0.192 < expected < 0.192
    assert found == pytest.approx(expected, abs=2e-5)  # between nodes 3.84 mm apart


def test_between_nodes_the_table_is_what_a_query_says(page):
    at = {"held_length_ratio": [0.9, 0.95], "pressure": [1.0e5, 1.1e5]}
    with pytest.warns(UserWarning, match="blocked_force_status: rows without a number, of 4: 1 not_interpolable"):
        page["atlas"].export(page["folder"] / "between.npz", variables=FORCE, derivatives=True, **at)
    table = np.load(page["folder"] / "between.npz")
    asked = page["atlas"].query(FORCE, **{name: xr.DataArray(values, dims=name) for name, values in at.items()})
    assert np.array_equal(table[FORCE][:, 1], asked[FORCE].values[:, 1], equal_nan=True)
    step = {"held_length_ratio": 1e-4, "pressure": 10.0}
    for name, by in step.items():
        low, high = ({"held_length_ratio": 0.95, "pressure": 1.1e5} | {name: at[name][1] + s * by} for s in (-1, 1))
        ends = [page["atlas"].query(FORCE, **point) for point in (low, high)]
        slope = (ends[1][FORCE] - ends[0][FORCE]).item() / (2 * by)
        assert table[f"d_{FORCE}_d_{name}"][1, 1] == pytest.approx(slope, rel=1e-3)
    assert dict(table["units"])[f"d_{FORCE}_d_pressure"] == "N/Pa"


def test_what_cannot_be_a_table_is_told(page):
    atlas, folder = page["atlas"], page["folder"]
    with pytest.raises(ExportError, match=r"the suffix '.txt' names no format"):
        atlas.export(folder / "muscle.txt")
    with pytest.raises(QueryError, match=r"presure(.|\n)*beta: expects an angle"):
        atlas.export(folder / "muscle.csv", variables=FORCE, presure=1e5, beta="1 mm")
    with pytest.raises(ExportError, match="give held_length or held_length_ratio and pressure"):
        atlas.export(folder / "other.xml", variables=FORCE, pressure=1e5)
    assert not (folder / "other.xml").exists()


def test_the_shell_writes_the_same_table(page, capsys):
    atlas, out = page["folder"] / "muscle.nc", page["folder"] / "shell.csv"
    assert run("export", str(atlas), "-o", str(out), "--variable", FORCE, "--at", "pressure=100 kPa:160 kPa:4") == 0
    capsys.readouterr()
    assert out.read_bytes() == (page["folder"] / "muscle.csv").read_bytes()
    told = refused(capsys, "export", str(atlas), "--to", "csv", "--at", "pressure=1 mm", "length", "radius=1:2")
    assert all(text in told for text in ("expects a pressure", "give NAME=VALUE", "give START:STOP:COUNT"))


def test_a_frame_has_a_row_for_each_state(page):
    frame = page["frame"]
    assert frame.index.name == "pressure"
    assert "deformed_radius" not in frame
    single = fs.to_dataframe(fs.lock(page["tube"]))
    assert single.shape[0] == 1
    with pytest.raises(fs.ActuatorError, match="give a Dataset"):
        fs.to_dataframe(3)

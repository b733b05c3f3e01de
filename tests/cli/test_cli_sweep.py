"""Sweeps and atlases on the command line: files, words, exit codes; never a traceback."""

import re

import pytest
from commands import refused, run
from grids import spec

from freesweep import run_sweep
from freesweep.cli import DONE, ENVIRONMENT, INTERRUPTED
from freesweep.sweep import duration
from freesweep.sweep.shards import SweepError
from freesweep.sweep.spec import parse
from freesweep.sweep.unit_doubts import doubts_of

TINY = spec(
    {"alpha": [0.0, 20.0, 40.0], "beta": [-40.0, -20.0, 20.0], "pressure": [0.0, 2e4, 5e4]}, title="A tiny sweep"
)


@pytest.fixture(autouse=True)
def _somewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def specification(tmp_path):
    path = tmp_path / "tiny.toml"
    path.write_text(TINY)
    return str(path)


def test_from_a_specification_to_a_map(specification, tmp_path, capsys):
    assert run("sweep", specification, "-o", "tiny.nc", "--map", "first.svg", "--threads", "1") == DONE
    out, err = capsys.readouterr()
    assert "27 grid points" in out
    assert "degenerate" in out
    assert "Traceback" not in err
    assert run("info", "tiny.nc") == DONE
    text = capsys.readouterr().out
    for part in (
        "A tiny sweep",
        "axes",
        "pressure",
        "0 kPa .. 50 kPa",
        "deformed_length",
        "[m]",
        "statuses",
        "provenance",
    ):
        assert part in text, part
    assert run("info", "tiny.nc", "--specification") == DONE
    assert capsys.readouterr().out == TINY + "\n"
    assert run("plot", "map", "tiny.nc", "--variable", "deformed_length", "--at", "pressure=50 kPa") == DONE
    assert capsys.readouterr().out == "tiny-deformed_length.png\n"
    assert (tmp_path / "tiny-deformed_length.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (tmp_path / "first.svg").read_text()[:1000]
    made = {"tiny.toml", "tiny.nc", "first.svg", "tiny-deformed_length.png"}
    assert {path.name for path in tmp_path.iterdir()} == made


def test_a_sweep_names_its_atlas_after_the_specification_and_may_be_quiet(specification, tmp_path, capsys):
    assert run("sweep", specification, "--quiet") == DONE
    assert capsys.readouterr() == ("", "")
    assert (tmp_path / "tiny.nc").exists()
    (tmp_path / "tiny.toml").write_text(TINY.replace("tiny sweep", "changed sweep"))
    assert "specification_sha256 differs" in refused(capsys, "sweep", specification, "--quiet")
    assert run("sweep", specification, "--quiet", "--overwrite") == DONE


def test_a_dry_run_says_what_would_be_solved_and_makes_nothing(specification, tmp_path, capsys):
    assert run("sweep", specification, "--dry-run") == DONE
    # six of nine designs are different: 0/20 and 20/40 occur twice, 20/20 is degenerate; three pressures and locked
    says = ["A tiny sweep", "27 grid points, 24 distinct equilibria of 6 distinct problems -> tiny.nc"]
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == says
    assert [line.split(":")[0] for line in lines[2:]] == ["memory", "disk", "time"]
    assert re.fullmatch(r"disk: 1\.0 MB at most, 0\.0 MB more while it runs; [\d,]+ MB free", lines[3])
    assert [path.name for path in tmp_path.iterdir()] == ["tiny.toml"]


def test_a_dry_run_of_a_large_sweep_samples_the_compiled_kernels(specification, monkeypatch, capsys):
    """And takes what is typical where nothing is compiled, or the sweep is small."""
    assert run("sweep", specification, "--quiet") == DONE  # compiled by now

    def says():
        code = run("sweep", specification, "--dry-run", "--threads", "1")
        return code, capsys.readouterr().out.splitlines()[-1]

    guess = "time: a few seconds on 1 thread, a guess before anything is solved"
    assert says() == (DONE, guess)
    monkeypatch.setattr(duration, "LITTLE", 0.0)
    monkeypatch.setattr(
        duration, "entry_points", lambda *_: ("solve_lanes",)
    )  # the scalar one may not have been needed yet
    assert says() == (DONE, guess.split(",")[0])
    monkeypatch.setattr(duration, "entry_points", lambda *_: ("none_of_that_name",))
    assert says() == (DONE, guess)


def test_every_fault_of_a_specification_is_listed(tmp_path, capsys):
    text = (
        TINY.replace("length = 0.1", 'length = "1 kPa"').replace("c10", "c11").replace("[0.0, 20.0, 40.0]", "[20, 0]")
    )
    (tmp_path / "bad.toml").write_text(text)
    err = refused(capsys, "sweep", "bad.toml")
    for key in ("bad.toml: 4 faults", "actuator.length: ", "actuator.c11: ", "axes.alpha: ", "c10: is missing"):
        assert key in err, key
    assert [path.name for path in tmp_path.iterdir()] == ["bad.toml"]


def test_files_that_are_absent_or_no_atlas_are_refused(specification, tmp_path, capsys):
    assert "there is no specification 'none.toml'" in refused(capsys, "sweep", "none.toml")
    for command in (["info"], ["plot", "map"]):
        assert "no atlas at none.nc" in refused(capsys, *command, "none.nc")
        assert "no readable netCDF4 file" in refused(capsys, *command, specification)
    (tmp_path / "tiny.nc").write_text("precious")
    assert "choose another output" in refused(capsys, "sweep", specification)
    assert (tmp_path / "tiny.nc").read_text() == "precious"


def test_an_output_in_a_missing_folder_is_the_environments_fault(specification, capsys):
    err = refused(capsys, "sweep", specification, "-o", "absent/tiny.nc", code=ENVIRONMENT)
    assert "cannot make the folder absent/tiny.nc.parts: No such file or directory; there is no folder absent" in err
    assert ". is a folder or a device" in refused(capsys, "sweep", specification, "-o", ".", "--overwrite")


def test_a_map_that_cannot_be_written_is_refused_before_anything_is_solved(specification, tmp_path, capsys):
    err = refused(capsys, "sweep", specification, "--map", "absent/map.png", code=ENVIRONMENT)
    assert err == "freesweep: --map: the folder absent is not there, make it first\n"
    assert "must be one of .png" in refused(capsys, "sweep", specification, "--dry-run", "--map", "map.jpg")
    assert [path.name for path in tmp_path.iterdir()] == ["tiny.toml"]
    assert run("sweep", specification, "--quiet") == DONE
    err = refused(capsys, "plot", "map", "tiny.nc", "-o", "absent/map.png", code=ENVIRONMENT)
    assert "cannot write absent/map.png: No such file or directory" in err


@pytest.mark.filterwarnings("always")
@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("", "", None),
        ("wall = 0.00159", "wall = 1.59", "wall 1.59 m is thicker than the inner radius 0.00476 m"),
        ("wall = 0.00159", "wall = [[0, 1e-3], [1, 6e-3]]", "wall 0.006 m is thicker"),
        ("radius = 0.00476", "radius = 4.76", "the radius is 4.76 m; plain numbers are in SI units"),
        ("c10 = 170000.0", "c10 = 0.17", "the pressure reaches 50000 Pa, 3e+05 times a c10 of 0.17 Pa"),
        ("20000.0, 50000.0]", "20.0, 50.0]", "no pressure exceeds 50 Pa, which hardly deforms a c10 of 170000 Pa"),
        ("20000.0, 50000.0]", "]", None),
    ],
)
def test_numbers_that_look_like_slips_of_units_are_told(old, new, says, specification, tmp_path, capsys):
    (tmp_path / "tiny.toml").write_text(TINY.replace(old, new))
    assert run("sweep", specification, "--dry-run") == DONE
    err = capsys.readouterr().err
    assert err == "" if says is None else f"freesweep: warning: {says}" in err
    assert err.count("\n") == err.count("freesweep: warning: ")


def test_each_named_design_has_its_own_wall_and_radius():
    designs = [{"name": "a", "radius": 5e-3, "wall": 4e-3}, {"name": "b", "radius": 2e-3, "wall": 1e-3}]
    axes = {"alpha": [20.0], "beta": [-50.0], "pressure": [1e5]}
    assert doubts_of(parse(spec(axes, designs))) == []
    designs[1]["wall"] = 3e-3
    assert [text[:15] for text in doubts_of(parse(spec(axes, designs)))] == ["wall 0.003 m is"]


def test_a_specification_is_neither_overwritten_nor_taken_for_an_address(specification, tmp_path, capsys):
    err = refused(capsys, "sweep", specification, "-o", specification, "--overwrite")
    assert "tiny.toml is the specification itself; give the name of the atlas to make" in err
    assert (tmp_path / "tiny.toml").read_text() == TINY
    err = refused(capsys, "sweep", "--dask", specification)
    assert "tiny.toml', which is no address; write SPEC before --dask" in err


@pytest.mark.parametrize(("name", "more"), [("x.csv", "freesweep export x.nc -o x.csv"), ("x.PNG", "such as x.nc")])
def test_an_atlas_is_not_named_as_what_it_is_not(name, more, specification, tmp_path, capsys):
    for words in (["--dry-run"], []):
        assert more in refused(capsys, "sweep", specification, "-o", str(tmp_path / name), *words)
    with pytest.raises(SweepError, match="an atlas is netCDF"):
        run_sweep(specification, tmp_path / name)
    assert not list(tmp_path.glob("x*"))


def test_threads_and_places_in_the_atlas_are_checked(specification, capsys):
    assert "--threads: found 0; give 1 or more" in refused(capsys, "sweep", specification, "--threads", "0")
    assert run("sweep", specification, "--quiet") == DONE
    assert "give NAME=VALUE" in refused(capsys, "plot", "map", "tiny.nc", "--at", "pressure")
    assert "expects a pressure" in refused(capsys, "plot", "map", "tiny.nc", "--at", "pressure=1 mm")
    assert "sideways" in refused(capsys, "plot", "map", "tiny.nc", "--variable", "sideways")


def test_too_little_memory_is_one_line(specification, capsys, monkeypatch):
    def fill(*_, **__):
        raise MemoryError

    monkeypatch.setattr("freesweep.sweep.run.run", fill)
    error = refused(capsys, "sweep", specification, code=ENVIRONMENT)
    assert error.startswith("freesweep: not enough memory; ")
    assert error.count("\n") == 1


def test_an_interruption_has_its_own_exit_code(specification, capsys, monkeypatch):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("freesweep.sweep.run.run", interrupt)
    assert "a sweep that is started again goes on from where it was" in refused(
        capsys, "sweep", specification, code=INTERRUPTED
    )

"""The command line: what it prints, which files it makes, which exit code it gives; never a traceback."""

import csv
import os
import subprocess
import sys

import pytest
import xarray as xr
from commands import refused, run
from grids import CHILD_ENVIRONMENT

from freesweep import Actuator, MooneyRivlin, __version__, inflate, lock
from freesweep.cli import DONE, ENVIRONMENT

TUBE = ["--alpha", "10deg", "--beta", "-50 deg", "--length", "141 mm", "--radius", "4.76mm", "--wall", "1.59 mm"]
RUBBER = ["--c10", "0.17 MPa", "--c01", "80 kPa"]
SAME = Actuator(alpha=10, beta=-50, length=0.141, radius=4.76e-3, wall=1.59e-3, material=MooneyRivlin(0.17e6, 0.08e6))
COMMANDS = ([], ["sweep"], ["plot"], ["plot", "map"], ["info"], ["lock"], ["inflate"])
HEAVY = ("numba", "xarray", "matplotlib", "scipy", "netCDF4", "tqdm")


@pytest.fixture(autouse=True)
def _somewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


# --- help


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_every_command_explains_itself(command, capsys):
    assert run(*command, "--help") == DONE
    assert f"usage: {' '.join(['freesweep', *command])}" in capsys.readouterr().out


def test_help_comes_at_once_and_loads_nothing_heavy():
    code = f"""
import sys, time
from freesweep.cli import main
for command in {COMMANDS!r}:
    begun = time.process_time()
    try:
        main([*command, "--help"])
    except SystemExit as end:
        assert end.code == 0
    assert time.process_time() - begun < 0.6, command
loaded = sorted(set({HEAVY!r}) & set(sys.modules))
assert not loaded, loaded
"""
    child = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=CHILD_ENVIRONMENT)
    assert child.returncode == 0, child.stderr


def test_the_module_runs_as_a_program():
    child = subprocess.run(
        [sys.executable, "-m", "freesweep", "--version"], capture_output=True, text=True, env=CHILD_ENVIRONMENT
    )
    assert (child.returncode, child.stdout, child.stderr) == (0, f"freesweep {__version__}\n", "")


# --- one actuator


def test_lock_prints_and_keeps_the_locked_shape(capsys, tmp_path):
    assert run("lock", *TUBE, *RUBBER, "-o", "locked.nc") == DONE
    head, row, name = capsys.readouterr().out.splitlines()
    expected = lock(SAME)
    assert head.split("  ")[0].strip() == "deformed length [mm]"
    assert float(row.split()[0]) == pytest.approx(expected["deformed_length"].item() * 1e3, rel=1e-6)
    assert row.endswith("ok")
    assert name == "locked.nc"
    with xr.open_dataset("locked.nc") as kept:
        assert kept["rotation"].item() == pytest.approx(expected["rotation"].item(), rel=1e-9)
        assert kept["deformed_radius"].sizes == {"x": 201}
    assert [path.name for path in tmp_path.iterdir()] == ["locked.nc"]


def test_lock_without_a_material_gives_no_energy(capsys):
    assert run("lock", *TUBE) == DONE
    assert "energy" not in capsys.readouterr().out


def test_inflate_prints_a_line_for_each_pressure(capsys):
    assert run("inflate", *TUBE, *RUBBER, "--pressure", "0", "1 bar", "--steps", "3", "-o", "kept.nc") == DONE
    head, *rows, name = capsys.readouterr().out.splitlines()
    assert head.startswith("pressure [bar]  deformed length [mm]")
    assert [row.split()[0] for row in rows] == ["0", "0.5", "1"]
    lengths = inflate(SAME, [0.0, 5e4, 1e5])["deformed_length"].values
    assert [float(row.split()[1]) for row in rows] == pytest.approx(lengths * 1e3, rel=1e-6)
    with xr.open_dataset(name) as kept:
        assert kept["pressure"].values.tolist() == [0.0, 5e4, 1e5]


def test_states_are_kept_as_a_table_too(capsys):
    """A row for each pressure in SI units; any other suffix is refused before anything is solved."""
    assert run("inflate", *TUBE, *RUBBER, "--pressure", "0", "1 bar", "--steps", "3", "-o", "kept.csv") == DONE
    with open("kept.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    lengths = inflate(SAME, [0.0, 5e4, 1e5])["deformed_length"].values
    assert [float(row["deformed_length [m]"]) for row in rows] == pytest.approx(lengths, rel=1e-6)
    assert [row["status"] for row in rows] == ["ok"] * 3
    capsys.readouterr()
    assert "the suffix must be one of .nc, .csv" in refused(capsys, "lock", *TUBE, "-o", "kept.xlsx")


def test_a_unit_that_stands_alone_is_put_to_its_number(capsys):
    err = refused(capsys, "inflate", *TUBE, *RUBBER, "--pressure", "0", "2", "bar")
    assert 'as one word: "2 bar"' in err


def test_inflate_explains_a_status(capsys):
    assert run("inflate", *TUBE, *RUBBER, "--pressure", "10 kPa", "--force", "-5 N") == DONE
    out = capsys.readouterr().out
    assert "meridional_compression: the wall would have to be pushed along its length" in out
    assert out.splitlines()[1].split()[:5] == ["-"] * 5


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--length", "2 kPa", "--wall", "x"], ["--length: expects a length", "--wall: expects a length"]),
        (["--beta", "10"], ["alpha, beta: both are 10 degree"]),
        (["--pressure", "-1 kPa"], ["pressure: found -1000"]),
        (["--pressure", "1 kPa", "--steps", "3"], ["--steps: give two pressures"]),
        (["--pressure", "1 kPa", "2 kPa", "--steps", "1"], ["--steps: give two pressures"]),
        (["--energy", "half"], ["argument --energy: invalid choice: 'half'"]),
        (["--c10", "0 Pa"], ["c10: found 0 Pa; it has to be above 0"]),
    ],
)
def test_wrong_quantities_are_refused_all_at_once(words, says, capsys):
    err = refused(capsys, "inflate", *TUBE, *RUBBER, "--pressure", "1 kPa", *words)
    assert all(sentence in err for sentence in says)


def test_wrong_loads_are_refused_all_at_once_by_name(capsys):
    err = refused(capsys, "inflate", *TUBE, *RUBBER, "--pressure", "1 mm", "--force", "x", "--torque", "3 N")
    assert [f"--{name}:" in err for name in ("pressure", "force", "torque")] == [True] * 3


def test_a_missing_folder_is_the_environments_fault(capsys):
    assert run("lock", *TUBE, *RUBBER, "-o", "absent/locked.nc") == ENVIRONMENT
    err = capsys.readouterr().err
    assert "cannot write absent/locked.nc: No such file or directory" in err
    assert "bytes needed" in err


@pytest.mark.parametrize("words", [[], ["nonsense"], ["plot"], ["lock"], ["inflate", *TUBE]])
def test_incomplete_commands_show_their_usage(words, capsys):
    assert "usage: freesweep" in refused(capsys, *words)


WISH = """
[actuator]
alpha = 30
beta = -30
length = "0.2 m"
wall = "1 mm"
c10 = "1 bar"
[free]
radius = ["4 mm", "5 mm"]
[[goals]]
output = "rotation"
at_most = 90
pressure = "1 bar"
"""


@pytest.mark.parametrize(
    ("command", "files"),
    [
        (["inflate", *TUBE, *RUBBER, "--pressure", "1 bar", "-o", "states.csv"], ["states.csv"]),
        (["design", "wish.toml", "-o", "tubes.csv", "--picture", "tubes.png"], ["tubes.csv", "tubes.png"]),
    ],
    ids=["inflate", "design"],
)
def test_what_is_kept_is_kept_though_nobody_reads_the_table(command, files, tmp_path):
    """`freesweep ... -o FILE | head -1` had lost the file."""
    (tmp_path / "wish.toml").write_text(WISH)
    reader, writer = os.pipe()
    os.close(reader)
    subprocess.run([sys.executable, "-m", "freesweep", *command], stdout=writer, env=CHILD_ENVIRONMENT, check=False)
    os.close(writer)
    assert all((tmp_path / name).stat().st_size > 0 for name in files)

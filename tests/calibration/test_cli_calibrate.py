"""CSV files of measured curves, and `freesweep calibrate`: what is read, printed, kept, and refused with the reason."""

import json

import numpy as np
import pytest
import xarray as xr
from commands import refused, run

from freesweep import Actuator, ActuatorError, MooneyRivlin, blocked_force, inflate, read_measurements
from freesweep.cli import DONE

SIZES = ["--radius", "4.76 mm", "--wall", "1.59 mm"]
MUSCLE = ["--alpha", "30", "--beta", "-30 deg", "--length", "192 mm", *SIZES]
KILOPASCAL = np.array([20.0, 50.0, 90.0, 140.0, 200.0])


@pytest.fixture(autouse=True)
def _somewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def tube(alpha=30, length=0.192):
    rubber = MooneyRivlin(0.15e6, 0.08e6)
    return Actuator(
        alpha=alpha, beta=-alpha, length=length, radius=4.76e-3, wall=1.59e-3, material=rubber, fiber_extension=1.005
    )


def written(name, *lines):
    with open(name, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))
    return name


def lengths(name="lengths.csv"):
    """Free lengths of one muscle in millimetres."""
    found = inflate(tube(), KILOPASCAL * 1e3, x=0.0)["deformed_length"].values * 1e3
    return written(name, "pressure [kPa],deformed_length [mm]", *(f"{p},{v:.9f}" for p, v in zip(KILOPASCAL, found)))


def forces(name="forces.csv"):
    """Blocked forces of two muscles, which the columns describe; semicolons, a comment, other spellings."""
    lines = ["# two muscles", "Pressure (psi);Force [N];alpha [deg];beta [deg];length [cm]"]
    for alpha, length in ((30, 0.192), (40, 0.2)):
        psi = np.array([6.0, 12.0, 20.0])
        found = blocked_force(tube(alpha, length), psi * 6894.757293168361, x=0.0)["force"].values
        lines += [f"{p};{v:.9f};{alpha};{-alpha};{length * 100:g}" for p, v in zip(psi, found)]
    return written(name, *lines, "")


def test_a_file_with_a_curve_of_one_actuator():
    (found,) = read_measurements(lengths(), alpha=30, beta=-30, length=0.192, radius=4.76e-3, wall=1.59e-3)
    assert found.measured == ("deformed_length",)
    assert found.pressure.tolist() == (KILOPASCAL * 1e3).tolist()
    assert found.deformed_length[0] == pytest.approx(inflate(tube(), 2e4).deformed_length.item(), abs=1e-12)
    assert found.tube.length == 0.192


def test_a_file_whose_columns_describe_the_actuators():
    first, second = read_measurements(forces(), radius=4.76e-3, wall=1.59e-3)
    assert (first.tube.alpha, first.tube.length, second.tube.alpha, second.tube.length) == (30, 0.192, 40, 0.2)
    assert first.pressure.tolist() == [6 * 6894.757293168361, 12 * 6894.757293168361, 20 * 6894.757293168361]
    assert second.measured == ("force",)


def test_uncertainties_are_columns_too():
    name = written("s.csv", "pressure [kPa]\tforce [N]\tforce_sigma [mN]", "10\t3\t250", "20\t5\t500")
    (found,) = read_measurements(name, alpha=30, beta=-30, length=0.192, radius=4.76e-3, wall=1.59e-3)
    assert found.sigma["force"].tolist() == [0.25, 0.5]


def test_constants_from_both_files(capsys):
    assert (
        run("calibrate", lengths(), forces(), *MUSCLE[-4:], "--alpha", "30", "--beta", "-30", "--length", "0.192")
        != DONE
    )
    assert "forces.csv: alpha: a column, and given beside it; keep one" in capsys.readouterr().err
    with open(lengths(), encoding="utf-8") as file:
        rows = file.read().splitlines()[1:]
    described = written(
        "described.csv", "pressure [kPa],deformed_length [mm],alpha [deg],beta [deg],length [mm]",
        *(f"{line},30,-30,192" for line in rows),
    )  # fmt: skip
    assert run("calibrate", described, forces(), *SIZES, "--c10", "0.3 MPa", "-o", "fit.nc") == DONE
    out = capsys.readouterr().out
    rows = {line.split()[0]: line.split() for line in out.splitlines() if line.strip() and not line.startswith("-")}
    assert float(rows["c10"][1]) == pytest.approx(0.15, rel=1e-3)
    assert float(rows["c01"][1]) == pytest.approx(0.08, rel=2e-3)
    assert float(rows["fiber_extension"][1]) == pytest.approx(1.005, abs=1e-5)
    assert rows["deformed_length"][1:3] == ["5", "5"]
    assert rows["force"][1:3] == ["6", "6"]
    assert "c10 and c01 are hardly separable" in out
    assert "MooneyRivlin(c10=" in out
    with xr.open_dataset("fit.nc") as kept:
        assert kept["parameter"].values.tolist() == ["c10", "c01", "fiber_extension"]
        assert kept["value"].values == pytest.approx([0.15e6, 0.08e6, 1.005], rel=2e-3)
        assert kept["curve"].values.tolist() == [0] * 5 + [1] * 3 + [2] * 3
        measured, predicted = kept["measured_force"].values, kept["predicted_force"].values
        assert np.isnan(measured[:5]).all()
        assert measured[5:] == pytest.approx(predicted[5:], abs=1e-5)
        assert kept["covariance"].values == pytest.approx(kept["covariance"].values.T)


@pytest.mark.parametrize(
    ("lines", "faults"),
    [
        (["pressure [kPa]"], ["found 1 lines; give a line of names and units"]),
        (["pressure,deformed_length [mm]", "1,2"], ["column 'pressure': names no unit; write 'pressure [kPa]'"]),
        (["pressure [kPa],deformed_lenght [mm]", "1,2"],
         ["column 'deformed_lenght [mm]': unknown; did you mean deformed_length?"]),
        (["pressure [kPa],force [mm]", "1,2"], ["column force: expects a force such as '12 N', got '1 mm', a length"]),
        (["pressure [kPa],force [N],force (N)", "1,2,3"], ["column 'force (N)': given twice"]),
        (["pressure [kPa];force [N]", "1,5;2", "x;y"], ["line 3, pressure: expects", "line 3, force: expects"]),
        (["pressure [kPa],force [N]", "1,5,2"], ["line 2: 3 cells under 2 names"]),
        (["force [N]", "1"], ["pressure: is missing; give it as a column"]),
        (["pressure [kPa],length [mm]", "1,192"], ["length: a column, and given beside it", "measured: nothing was"]),
        (["pressure [kPa],force [N]", "-3,1"], ["pressure: found -3000 Pa; it has to be 0 or more"]),
    ],
)  # fmt: skip
def test_every_fault_of_a_file_is_named(lines, faults, capsys):
    name = written("bad.csv", *lines)
    with pytest.raises(ActuatorError) as error:
        read_measurements(name, alpha=30, beta=-30, length=0.192, radius=4.76e-3, wall=1.59e-3)
    expected = [f"bad.csv: {fault}" for fault in faults]
    assert [found[: len(text)] for found, text in zip(error.value.faults, expected, strict=True)] == expected
    err = refused(capsys, "calibrate", name, *MUSCLE)
    assert all(fault in err for fault in error.value.faults)


def test_what_the_command_refuses(capsys):
    err = refused(capsys, "calibrate", lengths(), *MUSCLE[2:], "--alpha", "30 mm", "--c10", "1 N")
    assert "--alpha: expects an angle" in err
    assert "--c10: expects a pressure" in err
    assert "c10: found -1 Pa; it has to be above 0" in refused(
        capsys, "calibrate", lengths(), *MUSCLE, "--c10", "-1 Pa"
    )
    assert "measured: no file has a column 'torque'" in refused(
        capsys, "calibrate", lengths(), *MUSCLE, "--measured", "torque"
    )
    assert "fit: found 'c1'; choose among c10" in refused(capsys, "calibrate", lengths(), *MUSCLE, "--fit", "c1")
    assert refused(capsys, "calibrate", "nothing.csv", *MUSCLE) == "freesweep: nothing.csv: No such file or directory\n"
    assert "the suffix must be one of .nc" in refused(capsys, "calibrate", lengths(), *MUSCLE, "-o", "fit.csv")
    written("latin.csv", "pressure [kPa],force [N]")
    with open("latin.csv", "ab") as file:
        file.write(b"\n1,\xb5")
    assert "not a text in UTF-8" in refused(capsys, "calibrate", "latin.csv", *MUSCLE)


def test_parameters_are_told_in_the_units_of_the_data_and_as_json(capsys):
    psi = np.array([4.0, 8.0, 14.0, 20.0])
    inches = inflate(tube(), psi * 6894.757293168361, x=0.0)["deformed_length"].values / 0.0254
    name = written("psi.csv", "pressure [psi],deformed_length [in]", *(f"{p},{v:.9f}" for p, v in zip(psi, inches)))
    words = (
        "calibrate",
        name,
        *MUSCLE,
        "--fit",
        "c10",
        "wall",
        "--prior",
        "wall=1.59 mm,0.1 mm",
        "--tie",
        "c01=0.53333333*c10",
    )
    assert run(*words, "--fiber-extension", "1.005") == DONE
    rows = {line.split()[0]: line.split() for line in capsys.readouterr().out.splitlines() if line.strip()}
    assert rows["c10"][2] == "psi"
    assert float(rows["c10"][1]) == pytest.approx(0.15e6 / 6894.757, rel=0.05)
    assert rows["wall"][2] == "in"
    assert rows["deformed_length"][4] == "in"
    assert run(*words, "--fiber-extension", "1.005", "--json") == DONE
    found = json.loads(capsys.readouterr().out)
    assert found["parameters"]["c10"]["value"] == pytest.approx(0.15e6, rel=0.05)
    assert found["parameters"]["wall"]["units"] == "m"
    assert found["material"].startswith("MooneyRivlin(c10=")
    text = f"""[data]
files = ["{name}"]
[actuator]
alpha = "30 deg"
length = "192 mm"
radius = "4.76 mm"
wall = "1.59 mm"
fiber_extension = 1.005
[fit]
parameters = ["c10"]
[ties]
c01 = "0.5*c10"
"""
    assert run("calibrate", written("case.toml", text)) == DONE
    assert " psi " in capsys.readouterr().out.splitlines()[1]

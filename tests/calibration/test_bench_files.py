"""Bench data as people have them: what is read, what is passed over and counted, what is refused and where."""

import numpy as np
import pytest

from freesweep import ActuatorError, Measurement, MooneyRivlin, read_measurements
from freesweep.calibration.branches import curves_of, mean_of_loops
from freesweep.description.actuator import Actuator

MUSCLE = {"alpha": 30, "beta": -30, "length": 0.2, "radius": 5e-3, "wall": 1e-3}
TUBE = Actuator(**MUSCLE, material=MooneyRivlin(0.2e6, 0.1e6))


def read(tmp_path, text, encoding="utf-8", **given):
    (tmp_path / "bench.csv").write_bytes(text.encode(encoding))
    (found,) = read_measurements(tmp_path / "bench.csv", **(MUSCLE | given))
    return found


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("pressure [kPa],stroke [mm]\n100,1.5\n200,3\n", "utf-8"),
        ("\ufeffpressure [kPa(g)];stroke [mm]\r\n100;1,5\r\n200;3,0\r\n", "utf-8"),
        ("pressure\tstroke\nkPa\tmm\n100\t1.5\n200\t3\n", "utf-16"),
        ("Pressure (kPa(g)),Stroke (mm)\n1e2,1.5\n2e2,3\n", "utf-8"),
        ("p / barg;shortening / mm\n1,0;1,5\n2,0;3\n", "utf-8"),
        ("pressure_kPa,stroke_mm\n100,1.5\n200,3\n", "utf-8"),
        ('pressure [kPa],stroke [mm]\n"100","1,5"\n"200","3,0"\n', "utf-8"),
        ("% rig 4\n\npressure [psig],contraction [%]\n14.503773773020923,0.75\n29.007547546041846,1.5\n", "utf-8"),
        ("pressure [bar],deformed length [cm]\n1,19.85\n2,19.7\n", "utf-8"),
    ],
)
def test_spellings_of_the_same_bench(tmp_path, text, encoding):
    found = read(tmp_path, text, encoding)
    assert found.pressure == pytest.approx([1e5, 2e5], rel=1e-12)
    assert found.deformed_length == pytest.approx([0.1985, 0.197], rel=1e-12)
    assert found.measured == ("deformed_length",)


def test_what_is_passed_over_is_counted(tmp_path):
    lines = [
        "rig 4, operator N", "# zero before the run", "", "pressure [kPa],force [N],force_zero [V],pump", "10,1,0,a",
        "20,NaN,1,a", "30,,2,b", ",,,", "40,4,3,", "#N/A,5,4,c",
    ]  # fmt: skip
    found = read(tmp_path, "\n".join(lines))
    assert found.force.tolist() == [1.0, 4.0]
    assert found.notes == (
        "bench.csv: 1 empty line passed over",
        "bench.csv: 2 comment lines passed over",
        "bench.csv: 1 line above the names passed over",
        "bench.csv: 1 row of empty cells passed over (line 8)",
        "bench.csv: 2 columns not needed and passed over: 'force_zero [V]' (column 3), 'pump' (column 4)",
        "bench.csv: 2 rows without a number skipped (force: lines 6, 7)",
    )


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "found 0 lines"),
        ("pressure [kPa],force [N]\n", "found 1 lines"),
        ("pressure [psia],force [N]\n15,1\n", "subtract the atmosphere, 14.6959 psi by standard, and write"),
        ("pressure [kPa abs],force [N]\n15,1\n", "subtract the atmosphere, 101.325 kPa by standard"),
        ("pressure,force [N]\n15,1\n", "names no unit; write 'pressure [kPa]' (line 1, column 1)"),
        ("pressure [kPa],contraction\n15,1\n", "a share or a percentage? write 'contraction [%]'"),
        ("pressure [kPa],forse [N]\n15,1\n", "column 'forse [N]': unknown; did you mean force? (line 1, column 2)"),
        ("pressure [kPa],force [mm]\n15,1\n", "got '1 mm', a length (line 1, column 2)"),
        ("pressure [kPa],force [N]\n15,1\n16,x1\n", "line 3, force: expects a force such as '12 N', found 'x1 N'"),
        ("pressure [kPa];force [N]\n1,5;2\n1.5;3\n", "line 2, pressure: '1,5' beside '1.5' on line 3: decimal commas"),
        ("pressure [kPa],force [N]\n1,5,2,5\n", "line 2: 4 cells under 2 names; a separator too many, or a decimal comma"),
        ("pressure [kPa],force [N]\n5\n", "line 2: 1 cells under 2 names; cells are missing at its end (from column 2)"),
        ("pressure [kPa],force [N]\n-5,1\n", "pressure: found -5000 Pa; it has to be 0 or more (line 2, column 1)"),
        ("pressure [kPa],force [N]\n,1\nnan,2\n", "no row has a number in each of pressure, force"),
        ("pressure [kPa],force [N],branch\n5,1,up\n6,1,back\n", "'back'; write loading or unloading (line 3, column 3)"),
        ("force [N],time [s]\n5,1\n", "pressure: is missing; give it as a column"),
        ("pressure [kPa],force [N],force (N)\n5,1,1\n", "column 'force (N)': given twice (line 1, column 3)"),
        ('pressure [Pa],force [N]\n"50,000",1\n"60,500",2\n', "'50,000' is 50.000 or 50000? write points, and nothing"),
        ('pressure [kPa],force [N]\n"50,1\n60,2\n', "line 2: a quotation mark opens and does not end (character 1)"),
        ("pressure [kPa] force [N]\n50 1\n60 2\n", "line 1: blanks alone part its columns; write commas"),
        ("pressure [kPa],force [N]\n5,1\n6,2 N\n", "line 3, force: found '2 N': its unit stands above; write the number"),
        ("absolute pressure [psi],force [N]\n15,1\n", "give it as a column (passed over: 'absolute pressure [psi]')"),
        ("pressure [kPa],contraction [%]\n5,1\n6,120\n", "contraction: found 1.2; it has to be below 1"),
        ("pressure [kPa],force [N],force_sigma [N]\n5,1,0\n", "found 0 N; it has to be above 0 (line 2, column 3)"),
        ("pressure [kPa],force [N],fiber_extension [1]\n5,1,0.5\n", "fiber_extension: found 0.5"),
    ],
)  # fmt: skip
def test_a_wrong_file_gets_one_clear_line(tmp_path, text, says):
    with pytest.raises(ActuatorError) as caught:
        read(tmp_path, text)
    (fault,) = caught.value.faults
    assert says in fault
    assert fault.startswith("bench.csv: ")


@pytest.mark.parametrize("end", [("", ","), (",", ","), (",", ""), (",,", ",")])
def test_separators_at_the_ends_of_lines_say_nothing(tmp_path, end):
    """As spreadsheets leave them, in the line of names or below."""
    found = read(tmp_path, f"pressure [kPa],force [N]{end[0]}\n5,1{end[1]}\n6,2\n")
    assert (found.pressure.tolist(), found.force.tolist()) == ([5e3, 6e3], [1.0, 2.0])


def test_points_and_commas_are_told_apart(tmp_path):
    """A comma that can only be a decimal one makes all of them such."""
    found = read(tmp_path, 'pressure [Pa],force [N]\n"50,000",1\n"60,5",2\n')
    assert found.pressure.tolist() == [50.0, 60.5]
    assert read(tmp_path, "pressure [Pa];force [N]\n50,125;1\n").pressure.tolist() == [50.125]


def test_a_fault_of_the_tube_names_its_place(tmp_path):
    with pytest.raises(ActuatorError, match=r"fiber_extension: found 0\.5.*\(line 3, column 3\)"):
        read(tmp_path, "pressure [kPa],force [N],fiber_extension [1]\n5,1,1\n6,1,0.5\n")


def test_shortenings_are_lengths():
    found = Measurement(TUBE, [1e5, 2e5], contraction=[0.1, 0.25])
    assert found.deformed_length == pytest.approx([0.18, 0.15])
    assert (found.measured, found.length_as) == (("deformed_length",), "contraction")
    pulled = Measurement(TUBE, 1e5, stroke=["5 mm", "10 mm"], force=[3.0, 0.0], measured="force")
    assert pulled.deformed_length == pytest.approx([0.195, 0.19])
    assert pulled.slack.tolist() == [False, True]
    with pytest.raises(ActuatorError, match="stroke: deformed lengths are given too"):
        Measurement(TUBE, 1e5, stroke=0.01, deformed_length=0.19)
    with pytest.raises(ActuatorError, match=r"found 0\.3; nothing would be left"):
        Measurement(TUBE, 1e5, stroke=0.3)


def test_a_loop_becomes_its_mean_and_half_of_what_parts_it(tmp_path):
    """Lengths under rising, then falling pressure, 2 mm apart; one curve of constant pressure each in a force table."""
    up = np.linspace(0.0, 2e5, 9)
    down = np.linspace(1.9e5, 0.1e5, 7)
    mean = 0.2 - 1e-7 * np.concatenate([up, down])
    half = np.where(np.arange(16) < 9, 1e-3, -1e-3)
    found, note = mean_of_loops(Measurement(TUBE, np.concatenate([up, down]), deformed_length=mean + half))
    own = (found.pressure >= 0.1e5) & (found.pressure <= 1.9e5)
    assert found.deformed_length[own] == pytest.approx(0.2 - 1e-7 * found.pressure[own])
    assert found.half_width["deformed_length"][own] == pytest.approx(1e-3)
    assert note == "16 states of 1 loop: 7 of the mean curve and 2 of one branch alone were fitted"
    length = np.tile([0.2, 0.19, 0.18, 0.17], 2)
    table = Measurement(TUBE, np.repeat([1e5, 2e5], 4), deformed_length=length, force=length, measured="force")
    assert curves_of(table)[0].tolist() == [0] * 4 + [1] * 4
    assert curves_of(table)[1] == "deformed_length"
    assert mean_of_loops(table)[1] == ""
    text = "pressure [kPa],force [N],branch\n10,1,loading\n20,2,loading\n20,3,unloading\n10,2,unloading\n"
    averaged, _ = mean_of_loops(read(tmp_path, text))
    assert averaged.force.tolist() == [1.5, 2.5]
    assert averaged.half_width["force"].tolist() == [-0.5, -0.5]

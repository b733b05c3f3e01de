"""`freesweep block`: what it prints and keeps, and what it refuses with the reason."""

import pytest
import xarray as xr
from commands import refused, run

from freesweep import Actuator, MooneyRivlin, blocked_force, blocked_torque
from freesweep.cli import DONE

SIZES = ["--length", "131 mm", "--radius", "4.76mm", "--wall", "1.59 mm", "--c10", "0.17 MPa", "--c01", "80 kPa"]
ROTATOR = ["block", "--alpha", "0", "--beta", "30deg", *SIZES]  # prototype B of the source
MIXED = ["block", "--alpha", "20", "--beta", "-50 deg", *SIZES]
LENGTH, ROTATION = ["--hold", "length"], ["--hold", "rotation"]
RUBBER = MooneyRivlin(0.17e6, 0.08e6)


def tube(alpha, beta):
    return Actuator(alpha=alpha, beta=beta, length=0.131, radius=4.76e-3, wall=1.59e-3, material=RUBBER)


@pytest.fixture(autouse=True)
def _somewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def columns(text):
    """Heads and rows of a table."""
    head, *rows = text.splitlines()
    return [part.strip() for part in head.split("  ") if part.strip()], [row.split() for row in rows]


def test_help_tells_what_is_held_and_what_is_free(capsys):
    assert run("block", "--help") == DONE
    out = capsys.readouterr().out
    assert "usage: freesweep block" in out
    assert "--hold {length,rotation}" in out
    assert "what is held; the other is free" in " ".join(out.split())


def test_a_line_for_each_pressure_with_the_force_that_holds(capsys):
    assert run(*MIXED, *LENGTH, "--pressure", "20 kPa", "0.05 MPa", "-o", "kept.nc") == DONE
    heads, [*rows, name] = columns(capsys.readouterr().out)
    expected = blocked_force(tube(20, -50), [2e4, 5e4])
    assert heads[:2] == ["pressure [kPa]", "force [N]"]
    assert not any(head.startswith("deformed length") for head in heads)  # it was given
    assert [row[0] for row in rows] == ["20", "50"]
    assert [float(row[1]) for row in rows] == pytest.approx(expected["force"].values, rel=1e-6)
    assert [row[-1] for row in rows] == ["ok", "ok"]
    with xr.open_dataset(name[0]) as kept:
        assert kept["force"].values == pytest.approx(expected["force"].values, rel=1e-9)
        assert kept["deformed_length"].item() == 0.131


def test_pressures_in_steps_as_of_inflate(capsys):
    assert run(*MIXED, *LENGTH, "--pressure", "20 kPa", "50 kPa", "--steps", "4") == DONE
    _, rows = columns(capsys.readouterr().out)
    assert [row[0] for row in rows] == ["20", "30", "40", "50"]
    assert "--steps: give two pressures" in refused(capsys, *MIXED, *LENGTH, "--pressure", "1bar", "--steps", "4")


def test_the_torque_that_holds_another_rotation_under_a_force(capsys):
    assert run(*MIXED, *ROTATION, "--pressure", "30 kPa", "--at", "-4 deg", "--force", "1.5 N") == DONE
    heads, [row] = columns(capsys.readouterr().out)
    expected = blocked_torque(tube(20, -50), 3e4, -4.0, 1.5)
    assert heads[0] == "torque [mN m]"
    assert float(row[0]) == pytest.approx(1e3 * expected["torque"].item(), rel=1e-6)
    assert float(row[heads.index("deformed length [mm]")]) == pytest.approx(
        expected["deformed_length"].item() * 1e3, rel=1e-6
    )


def test_the_force_that_holds_another_length_under_a_torque(capsys):
    assert run(*MIXED, *LENGTH, "--pressure", "30 kPa", "--at", "12.9 cm", "--torque", "1 N mm") == DONE
    _, [row] = columns(capsys.readouterr().out)
    expected = blocked_force(tube(20, -50), 3e4, 0.129, 1e-3)
    assert float(row[0]) == pytest.approx(expected["force"].item(), rel=2e-6)


def test_an_unstable_cylinder_is_called_so_and_the_buckled_state_is_not(capsys):
    """Prototype B beyond 0.222 MPa."""
    pressure = ["--pressure", "230 kPa"]
    assert run(*ROTATOR, *ROTATION, *pressure) == DONE
    straight = capsys.readouterr().out
    assert run(*ROTATOR, *ROTATION, *pressure, "--buckled") == DONE
    buckled = capsys.readouterr().out
    assert "unstable" in straight
    assert "unstable" not in buckled
    torque = [float(columns(text)[1][0][0]) for text in (straight, buckled)]
    assert 1.02 < torque[1] / torque[0] < 1.07


def test_where_nothing_can_be_held_a_dash_and_the_reason(capsys):
    """A straight fiber cannot stretch: whatever the force, the length stays (a pole of Eq. 2.16)."""
    assert run(*ROTATOR, *LENGTH, "--pressure", "50 kPa") == DONE
    out = capsys.readouterr().out
    assert columns(out)[1][0][0] == "-"
    assert "held_impossible: the held length or rotation cannot be reached, or is none (straight fibers" in out


@pytest.mark.parametrize(("held", "unused", "value"), [(LENGTH, "--force", "1 N"), (ROTATION, "--torque", "1 N m")])
def test_the_load_that_holds_cannot_be_given(held, unused, value, capsys):
    err = refused(capsys, *MIXED, *held, "--pressure", "1 kPa", unused, value)
    assert f"{unused}: it is what holds the {held[1]}, so it cannot be given" in err
    assert "With length and rotation both held, force and torque are not separately determined" in err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([*MIXED, *LENGTH, "--buckled"], ["--buckled: only a held rotation"]),
        ([*MIXED, *LENGTH, "--at", "3 deg"], ["--at: expects a length"]),
        ([*MIXED, *ROTATION, "--at", "3 mm", "--force", "x"], ["--at:", "--force:"]),
        ([*MIXED, *LENGTH, "--at", "-1 mm"], ["deformed_length: found -0.001 m; it has to be above 0"]),
        ([*MIXED, *LENGTH, "--c10", "0 Pa"], ["c10: found 0 Pa; it has to be above 0"]),
        (["block", "--alpha", "30", "--beta", "-30", *SIZES, *ROTATION], ["alpha = -beta does not rotate"]),
        (MIXED, ["usage: freesweep block", "--hold"]),
        ([*MIXED, "--hold", "both"], ["argument --hold: invalid choice: 'both'"]),
    ],
)
def test_what_cannot_be_read_or_held_is_refused(words, says, capsys):
    err = refused(capsys, *words, "--pressure", "1 kPa")
    assert all(sentence in err for sentence in says), err


def test_a_negative_pressure_is_refused(capsys):
    assert "pressure: found -1 Pa; it has to be 0 or more" in refused(capsys, *MIXED, *LENGTH, "--pressure", "-1 Pa")

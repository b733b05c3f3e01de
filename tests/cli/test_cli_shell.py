"""The shell as people use it: examples, suggestions, completion, JSON, units of the question."""

import importlib.util
import json
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from commands import refused, run

import freesweep as fs
from freesweep.cli import BAD_INPUT, DONE, _joined, parser
from freesweep.cli.examples import EXAMPLES

TUBE = ("--alpha", "30", "--beta", "-30", "--length", "192 mm", "--radius", "4.76 mm", "--wall", "1.59 mm")
ATLAS = str(fs.example_atlas().path)


def commands(of, found):
    """Name of each command -> its parser."""
    found[of.prog] = of
    for action in of._actions:
        if isinstance(action.choices, dict):
            for one in action.choices.values():
                commands(one, found)
    return found


def test_every_help_ends_with_examples_that_can_be_read():
    every = commands(parser(), {})
    assert set(EXAMPLES) == set(every)
    for name, lines in EXAMPLES.items():
        told = every[name].format_help()
        for line in lines:
            assert f"\n  {line}\n" in told
            words = shlex.split(line.partition(" > ")[0])
            if "--print-completion" not in words:
                parser().parse_args(_joined(words[1:]))


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (("swep", "quick.toml"), "did you mean sweep?"),
        (("plot", "mapp", "quick.nc"), "did you mean map?"),
        (("query", "quick.nc", "--presure", "1bar"), "did you mean --pressure?"),
        (("block", "--hold", "lenght", *TUBE, "--pressure", "1bar"), "did you mean length?"),
    ],
)
def test_what_was_mistyped_is_named(words, meant, capsys):
    assert meant in refused(capsys, *words)


@pytest.mark.skipif(importlib.util.find_spec("shtab") is None, reason="shtab is not installed")
def test_a_shell_completes_commands_options_and_choices(capsys, tmp_path):
    assert run("--print-completion", "bash") == DONE
    script = capsys.readouterr().out
    (tmp_path / "script").write_text(script)
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("there is no bash here")
    ask = "source ./script; COMP_WORDS=(freesweep {}); COMP_CWORD={}; _shtab_freesweep; echo ${{COMPREPLY[@]}}"
    (tmp_path / "here.html").write_text("")
    for typed, expected in (
        ("qu", {"query"}),
        ("inflate --press", {"--pressure"}),
        ("block --hold l", {"length"}),
        ("lock --material dr", {"dragon-skin-30"}),
        ("query a.nc --variable rot", {"rotation"}),
        ("plot curve a.nc --each rad", {"radius"}),
        ("thesis 3-1", {"3-11", "3-13"}),
        ("sweep --example qu", {"quick"}),
        ("calibrate --report her", {"here.html"}),
        ("explore a.nc --html her", {"here.html"}),
    ):
        line = ask.format(typed, len(typed.split()))
        told = subprocess.run([bash, "-c", line], cwd=tmp_path, capture_output=True, text=True, check=True)
        assert set(told.stdout.split()) == expected, told


def printed(capsys, *words):
    assert run(*words) == DONE
    return json.loads(capsys.readouterr().out)


def test_tables_are_printed_as_json_too(capsys, tmp_path):
    (state,) = printed(capsys, "lock", *TUBE, "--json")["points"]
    assert state["deformed_length"] == fs.lock(fs.Actuator(
        alpha=30, beta=-30, length=0.192, radius=4.76e-3, wall=1.59e-3, material=fs.NeoHookean(1e5)
    )).deformed_length.item()  # fmt: skip
    assert state["status"] == "ok"
    (kept,) = printed(capsys, "lock", *TUBE, "--json", "-o", str(tmp_path / "kept.nc"))["points"]  # nothing behind it
    assert kept["deformed_length"] == pytest.approx(state["deformed_length"], abs=state["deformed_length_error"])
    held = printed(capsys, "info", ATLAS, "--json")
    assert held["axes"]["pressure"]["units"] == "Pa"
    assert held["statuses"]["status"] == {"ok": 23616, "degenerate": 1476}
    assert held["attributes"]["energy"] == "full"
    checked = printed(capsys, "verify", ATLAS, "--resolve", "3", "--json")
    rotation = checked["resolved"]["rotation"]
    assert (checked["whole"], rotation["broken"], rotation["units"]) == (True, 0, "degree")
    assert rotation["largest_difference"] < rotation["its_bound"]
    damaged = tmp_path / "damaged.nc"
    content = bytearray(Path(ATLAS).read_bytes())
    content[len(content) // 2] ^= 1
    damaged.write_bytes(content)
    assert run("verify", str(damaged), "--json") == BAD_INPUT
    assert json.loads(capsys.readouterr().out)["whole"] is False
    asked = ("--alpha", "20", "--beta", "-50", "--length", "100 mm", "--radius", "4.76 mm", "--pressure", "75 kPa")
    (point,) = printed(capsys, "query", ATLAS, *asked, "--variable", "rotation", "--json")["points"]
    assert point["pressure"] == 75e3


def test_a_query_answers_in_the_units_of_its_question(capsys):
    asked = ("--alpha", "0.35 rad", "--beta", "-50", "--length", "4 in", "--radius", "0.2 in", "--pressure", "10 psi")
    assert (
        run("query", ATLAS, *asked, "--variable", "deformed_length", "rotation", "limit_pressure", "--refine") == DONE
    )
    told = capsys.readouterr().out
    with fs.example_atlas() as atlas:
        point = {"alpha": "0.35 rad", "beta": -50, "length": "4 in", "radius": "0.2 in", "pressure": "10 psi"}
        found = atlas.query(["deformed_length", "rotation"], refine=True, **point)
    shown = dict(re.findall(r"(deformed_length|rotation)\s+(-?[0-9.]+) (?:in|rad)\b", told))
    assert float(shown["deformed_length"]) == pytest.approx(found.deformed_length.item() / 0.0254, rel=1e-4)
    assert float(shown["rotation"]) == pytest.approx(found.rotation.item() / 57.29578, rel=1e-4)


def test_what_is_refused_is_neither_unstable_nor_taut(capsys):
    asked = ("--alpha", "33", "--beta", "-40", "--length", "150 mm", "--radius", "5 mm", "--pressure", "100 kPa")
    for more, flags in (((), ("-", "-")), (("--refine",), ("stable", "none"))):
        assert run("query", ATLAS, *asked, *more) == DONE
        told = capsys.readouterr().out
        assert re.search(r"^ +status +(\S+)", told, re.M)[1] == ("ok" if more else "not_interpolable")
        assert (
            re.search(r"^ +stable +(\S+)", told, re.M)[1],
            re.search(r"^ +slack_fiber +(\S+)", told, re.M)[1],
        ) == flags
        assert "none up to the largest pressure" in told


def test_single_actuators_answer_in_the_units_of_the_question(capsys):
    sizes = ["--alpha", "30", "--beta", "-30", "--length", "7.5 in", "--radius", "5 mm", "--wall", "1 mm"]
    assert run("inflate", *sizes, "--c10", "0.1 MPa", "--pressure", "0", "10 psi", "--force", "1 lbf") == DONE
    head, _, row, *_ = capsys.readouterr().out.splitlines()
    assert head.split("  ")[0] == "pressure [psi]"
    tube = fs.Actuator(alpha=30, beta=-30, length="7.5 in", radius=5e-3, wall=1e-3, material=fs.NeoHookean(1e5))
    found = fs.inflate(tube, "10 psi", force="1 lbf", x=0.0)
    assert "deformed length [in]" in head
    assert [float(cell) for cell in row.split()[:2]] == pytest.approx(
        [10.0, found.deformed_length.item() / 0.0254], rel=1e-6
    )
    assert run("block", *sizes, "--c10", "0.1 MPa", "--pressure", "1 bar", "--hold", "length", "--at", "190 mm") == DONE
    assert "force [N]" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (("inflate", *TUBE, "--presure", "1 bar"), "no option --presure; did you mean --pressure?"),
        (("--hepl",), "no option --hepl; did you mean --help?"),
        (("query", ATLAS, "--alhpa=3"), "no option --alhpa; did you mean --alpha?"),
    ],
)
def test_mistyped_options_are_told_before_others_are_missed(capsys, words, meant):
    with pytest.raises(SystemExit):
        parser().parse_args([*words])
    assert meant in capsys.readouterr().err

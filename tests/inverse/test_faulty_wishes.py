"""What cannot be wished for, or cannot be free, is refused before the search, with every fault; nothing is ignored."""

import json
import re

import numpy as np
import pytest

import freesweep as fs
from freesweep.cli import main
from freesweep.inverse import freedom

RUBBER = fs.MooneyRivlin(1.2e5, 6e4)
TURN = fs.Goal("rotation", 90, pressure=1e5, tolerance=1)
TUBE = {"alpha": 30.0, "beta": -50.0, "length": 0.15, "radius": 5e-3, "wall": 1e-3, "material": RUBBER}
NAN = float("nan")
WISH = """
[actuator]
beta = -50
length = "150 mm"
radius = "5 mm"
wall = "1 mm"
c10 = "120 kPa"
c01 = "60 kPa"
[free]
alpha = {start = 5, stop = 60}
[[goals]]
output = "force"
value = "pull.csv"
pressure = "1 bar"
[search]
count = 1
"""


def faults_of(free, goals=TURN, limits=(), tube=(), **more):
    with pytest.raises(fs.ActuatorError) as fault:
        fs.design(fs.Actuator(**TUBE | dict(tube)), free, goals, limits, **more)
    return fault.value.faults


@pytest.mark.parametrize(
    ("free", "words"),
    [
        ({"alpha": (0, 95)}, ["free['alpha']: found 95, allowed is between -90 and 90"]),
        ({"alpha": fs.Profile(3, (-95, 20))}, ["found -95"]),
        ({"radius": (-1e-3, 5e-3), "wall": [NAN, 0.0, 1e-3]}, ["found -0.001", "found nan", "found 0.0"]),
        ({"fiber_extension": (0.5, 1.2)}, ["found 0.5, allowed is 1 to 10"]),
        ({"c10": (0, 1e5), "taper": (0, 2)}, ["free['c10']: found 0", "free['taper']: found 2"]),
        ({"pressure": ["-1 bar", "1 bar"]}, ["pressures are 0 or more"]),
        ({"radius": [[1e-3, 2e-3]]}, ["give one number of radius in [m]"]),
        ({"radius,wall": [("a", 1e-3), (1, 2, 3)]}, ["found 'a'", "give 2 values each"]),
        ({"material": [5, "rubber"]}, ["found int 5", "found 'rubber'"]),
        ({"material": "natural-latex"}, ["give a list of what can be bought"]),
        ({"radius": (3e-3, 6e-3), "radius,wall": [(4e-3, 1e-3)]}, ["radius is free twice"]),
        ({"radius,radius": [(4e-3, 5e-3)]}, ["radius is free twice"]),
        ({"material": ["natural-latex"], "c10": (1e5, 2e5)}, ["keep one of both"]),
        ({"c20": (0, 1e4)}, ["found c20 of a MooneyRivlin"]),
        ({"wall": "1.2.3*radius", "radius": (3e-3, 6e-3)}, ["a tie is a parameter"]),
        ({"wall": "-radius", "radius": (3e-3, 6e-3)}, ["'-radius', which gives -0.003"]),
        ({"beta": "-radius", "radius": (3e-3, 6e-3)}, ["[degree] cannot follow what is in [m]"]),
        ({"length": "9*radius", "radius": fs.Profile(2, (3e-3, 6e-3))}, ["whose profile is free"]),
        ({"beta": "alpha", "alpha": (5, 80)}, ["no design that it allows is a tube: alpha, beta: both are"]),
        ({"radius": list(range(1, 200)), "wall": list(range(1, 200))}, ["39601 choices"]),
    ],
)
def test_what_no_tube_has_is_not_free(free, words):
    faults = faults_of(free)
    assert len(faults) == len(words)
    assert all(word in fault for word, fault in zip(words, faults))


@pytest.mark.parametrize(
    ("wish", "word"),
    [
        (dict(output="rotation", at_least=[9, 10], at_most=5, pressure=[1e5, 2e5]), "found 9, then 5"),
        (dict(output="rotation", value=NAN, pressure=1e5), "found float nan"),
        (dict(output="limit_pressure", at_least=float("inf")), "found float inf"),
        (dict(output="limit_pressure", value=-1e5), "pressures are 0 or more"),
        (dict(output="force", value=5, pressure=1e5, deformed_length=[0.1, -0.1]), "found -0.1 m; lengths are above 0"),
    ],
)
def test_a_wish_in_no_state_is_refused(wish, word):
    with pytest.raises(fs.ActuatorError, match=re.escape(word)):
        fs.Goal(**wish)


def test_a_family_that_is_not_there_is_neither_wished_for_nor_followed():
    single = {"beta": None}
    assert "the template has not" in faults_of({"alpha": (5, 60)}, fs.Goal("beta", 5), tube=single)[0]
    assert "the template has not" in faults_of({"alpha": (5, 60)}, [], minimize="beta", tube=single)[0]
    assert "the template has not" in faults_of({"alpha": "-beta", "radius": (3e-3, 6e-3)}, tube=single)[0]


def test_two_numbers_at_most_are_minimized():
    several = fs.Limit("stroke", at_most=[5, 6, 7], pressure=[1e5, 2e5, 3e5])
    assert faults_of({"alpha": (5, 60)}, minimize=several) == [
        "minimize: found 3 numbers; one, or two for a front between them"
    ]
    assert "radius twice" in faults_of({"alpha": (5, 60)}, minimize=["radius", "radius"])[0]


def test_loads_that_are_free_in_no_state_are_told():
    free = {"alpha": (5, 60), "force": (0, 5), "radius": (3e-3, 9e-3)}
    with pytest.warns(UserWarning, match=r"free\['force'\] changes nothing"):
        fs.design(fs.Actuator(**TUBE), free, fs.Goal("rotation", 90, pressure=1e5, force=0, tolerance=1), count=1)


def test_limits_that_leave_nothing_between_are_named():
    limits = [fs.Limit("radius", at_most=4e-3), fs.Limit("radius", at_least=5e-3)]
    found = fs.design(fs.Actuator(**TUBE), {"alpha": (5, 60), "radius": (3e-3, 9e-3)}, TURN, limits, count=1)
    assert "it fights with radius, at " in found.attrs["summary"]


def test_a_rubber_gets_the_constants_that_are_free():
    """Of its own kind where that has them, else of the kind that has them all."""
    for rubber, name, kind in (
        (fs.NeoHookean(1e5), "c01", fs.MooneyRivlin),
        (fs.NeoHookean(1e5), "c20", fs.Yeoh),
        (fs.Yeoh(1e5, 1e3), "c10", fs.Yeoh),
        (fs.NeoHookean(1e5), "c10", fs.NeoHookean),
    ):
        faults = []
        space = freedom.read(fs.Actuator(**TUBE | {"material": rubber}), {name: (1e4, 2e4)}, faults)
        made = space.actuator(np.array([0.5]), 0).material
        assert (faults, type(made)) == ([], kind)
        assert getattr(made, name) == pytest.approx(1.5e4)


def test_a_wish_for_what_varies_is_for_its_middle():
    """As of an actuator's design: of three knots the second, of two half way."""
    for knots, u, middle in ((3, [0.0, 0.5, 0.25], 40.0), (2, [0.0, 0.5], 30.0)):
        space = freedom.read(fs.Actuator(**TUBE), {"alpha": fs.Profile(knots, (20, 60))}, [])
        assert space.columns(np.array([u]), np.array([0]))["alpha"].item() == pytest.approx(middle)
        assert space.actuator(np.array(u), 0).design()["alpha"] == pytest.approx(middle)


def test_rows_of_a_curve_that_lack_a_number_are_counted(tmp_path, capsys):
    path = tmp_path / "pull.csv"
    path.write_text("deformed_length [mm],force [N]\n140,nan\n148,3\n")
    found = fs.design(fs.Actuator(**TUBE), {"alpha": (5, 60)}, fs.Goal("force", path, pressure=1e5), count=1)
    assert found.attrs["notes"] == "pull.csv: 1 row without a number skipped (force: line 2)"
    wish = tmp_path / "wish.toml"
    wish.write_text(WISH)
    assert main(["design", str(wish)]) == 0
    assert "- pull.csv: 1 row without a number skipped" in capsys.readouterr().out
    assert main(["design", str(wish), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["notes"] == [found.attrs["notes"]]


def test_an_uncertainty_of_nothing_is_refused_where_it_stands(tmp_path):
    path = tmp_path / "pull.csv"
    path.write_text("deformed_length [mm],force [N],force_sigma [N]\n-140,5,0\n150,3,1\n")
    with pytest.raises(fs.ActuatorError) as fault:
        fs.Goal("force", path, pressure=1e5)
    told = ["deformed_length: found -0.14 m", "force_sigma: found 0 N; it has to be above 0 (line 2, column 3)"]
    assert all(any(word in one for one in fault.value.faults) for word in told)


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ('value = "pull.csv"', "between = 5", "between: give two numbers"),
        ('c01 = "60 kPa"', 'c01 = "60 kPa"\nmaterial = "natural-latex"', "actuator.material: found beside c10, c01"),
        ("stop = 60", "stop = 95", "free['alpha']: found 95"),
    ],
)
def test_a_file_of_wishes_with_a_fault_ends_in_words(tmp_path, capsys, old, new, word):
    path = tmp_path / "wish.toml"
    (tmp_path / "pull.csv").write_text("deformed_length [mm],force [N]\n148,3\n")
    path.write_text(WISH.replace(old, new))
    assert main(["design", str(path)]) == 2
    assert word in capsys.readouterr().err


def test_states_are_told_in_the_units_in_which_they_were_given(tmp_path, capsys):
    """Fifteen psi are no round number of pascals."""
    path = tmp_path / "wish.toml"
    asked = WISH.replace('"force"', '"rotation"').replace('"pull.csv"', '"1 rad"').replace('"1 bar"', '"15 psi"')
    path.write_text(asked)
    assert main(["design", str(path)]) == 0
    assert "at pressure 15 psi" in capsys.readouterr().out

"""Inverse design: hidden tubes are found again, limits are kept, and what cannot be done is said in a sentence."""

import csv
import re
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from grids import CHILD_ENVIRONMENT, make

import freesweep as fs
from freesweep.cli import main
from freesweep.inverse import look, wish_file
from freesweep.inverse.designing import find
from freesweep.inverse.least import beaten
from freesweep.inverse.predict import State
from freesweep.inverse.report import csv as candidates_csv
from freesweep.inverse.report import table
from freesweep.inverse.shown import shown
from freesweep.inverse.singles import solve_single
from freesweep.inverse.wishes import Wish
from freesweep.plot.candidates import draw
from freesweep.report import shown_in
from freesweep.sweep.spec import parse
from freesweep.thesis.prototypes import found_rotator

ROOT = Path(__file__).parents[2]
RUBBER = fs.MooneyRivlin(1.2e5, 6e4)
AT = look.Misfit.at
ATLAS = """
title = "A small atlas"
[actuator]
length = 0.15
radius = 5e-3
wall = 1e-3
c10 = 1.2e5
c01 = 6e4
model = "source"
[axes]
alpha = {start = 30, stop = 60, step = 5}
beta = {start = -60, stop = -30, step = 5}
pressure = {start = 0, stop = 1e5, num = 9}
"""
BOUNDS = {"alpha": (0, 85), "beta": (-85, 85), "radius": (3e-3, 12e-3), "length": (0.05, 0.3), "pressure": (2e4, 3e5)}


def tube(alpha=30.0, beta=-50.0, length=0.15, radius=5e-3, wall=1e-3, rubber=RUBBER):
    return fs.Actuator(alpha=alpha, beta=beta, length=length, radius=radius, wall=wall, material=rubber, model="source")


def made_by(found):
    """The actuators that the candidates' lines of Python make."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of thick walls
        return [eval(line, {"fs": fs}) for line in found["python"].values]


def bounds(*names):
    return {name: BOUNDS[name] for name in names}


@pytest.fixture(scope="module")
def hidden():
    """A tube that nobody knows, and what it does."""
    secret = tube(alpha=62.0, beta=-23.0, radius=6.5e-3)
    return secret, fs.inflate(secret, 8e4, x=0.0), fs.blocked_force(secret, 1.5e5, x=0.0)


def test_a_hidden_tube_is_found_again(hidden):
    secret, free, held = hidden
    goals = [
        fs.Goal("rotation", free["rotation"].item(), pressure=8e4),
        fs.Goal("deformed_length", free["deformed_length"].item(), pressure=8e4),
        fs.Goal("force", held["force"].item(), pressure=1.5e5),
    ]
    found = fs.design(tube(), bounds("alpha", "beta", "radius"), goals, count=5)
    assert found["met"].values[0]
    np.testing.assert_allclose(found["goal_value"].values[0], [goal.value for goal in goals], rtol=1e-4)
    near = np.hypot(found["alpha"] - secret.alpha, found["beta"] - secret.beta)  # perhaps among others
    again = np.hypot(found["alpha"] - secret.beta, found["beta"] - secret.alpha)
    assert min(near.min(), again.min()) < 0.1 or found["met"].values.sum() > 1


def test_a_candidate_does_what_it_says(hidden):
    """The line of Python makes a tube whose own solution is the value that was told, within both bounds."""
    _, free, _ = hidden
    goals = [fs.Goal("rotation", free["rotation"].item(), pressure=8e4), fs.Goal("stroke", 0.05, pressure=8e4)]
    found = fs.design(tube(), bounds("alpha", "beta", "length"), goals, count=3)
    for k, made in enumerate(made_by(found)):
        state = fs.inflate(made, 8e4, x=0.0)
        stroke = 1.0 - state["deformed_length"].item() / made.length
        errors = found["goal_error"].values[k] + [state["rotation_error"].item(), state["deformed_length_error"].item()]
        assert np.all(np.abs(found["goal_value"].values[k] - [state["rotation"].item(), stroke]) <= errors)


def test_a_way_through_states_that_vectors_cannot_tell_is_gone():
    """Blocked forces that push, of a tube that leaves its straight cylinder for them."""
    design = {"alpha": 54, "beta": 22, "length": 0.215, "radius": 0.0101, "material": RUBBER, "model": "source"}
    pushed = [
        float(fs.blocked_force(fs.Actuator(wall=wall, **design), 66e3, x=0.0)["force"]) for wall in (1e-3, 1.18e-3)
    ]
    assert pushed[0] > 0.0 > pushed[1]
    goals = [fs.Goal("force", pushed[1], pressure=66e3), fs.Goal("deformed_length", 0.222)]
    free = {"wall": (3e-4, 2e-3), "pressure": (2e4, 3e5)}
    found = fs.design(fs.Actuator(wall=6e-4, **design), free, goals, count=3)
    assert found["met"][0]
    assert found["wall"][0] == pytest.approx(1.18e-3, rel=1e-4)


def test_a_free_pressure_is_found(hidden):
    secret, free, _ = hidden
    found = fs.design(secret, bounds("pressure"), [fs.Goal("rotation", free["rotation"].item())], count=1)
    assert found["pressure"].item() == pytest.approx(8e4, rel=1e-3)


def test_a_curve_is_one_wish_of_many_points(hidden):
    secret, _, _ = hidden
    pressures = np.linspace(2e4, 2e5, 7)
    curve = fs.inflate(secret, pressures, x=0.0)["rotation"].values
    found = fs.design(
        secret, bounds("alpha", "beta"), [fs.Goal("rotation", curve, pressure=pressures, tolerance=0.1)], count=2
    )
    assert found.sizes["goal"] == 7
    assert found["met"].values[0]


def test_a_straight_muscle_that_shall_rotate_says_why_not():
    wish = [fs.Goal("rotation", 90, pressure=1e5, tolerance=1)]
    found = fs.design(tube(beta=-30.0), {"alpha": (10, 80), "beta": "-alpha"}, wish)
    assert not found["met"].values.any()
    assert found.attrs["summary"].endswith("instead of 90 deg: nothing that is free changes it")
    asked = shown_in([("15 psi", "Pa"), ("1 rad", "degree")])
    result, _ = find(tube(beta=-30.0), {"alpha": (10, 80), "beta": "-alpha"}, wish, shown=asked)
    assert "has rotation at pressure 14.5038 psi of 0 rad instead of 1.5708 rad" in result.attrs["summary"]


def test_lists_that_were_meant_as_ranges_are_told_to_be_none():
    goal = fs.Goal("rotation", 120, pressure=1e5, tolerance=1)
    template = fs.Actuator(
        alpha=30,
        beta=-60,
        length=0.12,
        radius=6e-3,
        wall=1.5e-3,
        material=fs.MooneyRivlin(0.11e6, 0.06e6),
        model="source",
    )
    found = fs.design(template, {"alpha": [0, 80], "beta": [-80, 0]}, [goal])
    assert not found["met"].any()
    assert found.sizes["candidate"] == 3  # no tube has both families at 0 degree
    assert "nothing between: ranges are (low, high)" in found.attrs["summary"]


def test_goals_that_fight_are_named():
    wish = [
        fs.Goal("stroke", at_least=0.2, pressure=2e5, tolerance=0.001),
        fs.Goal("force", at_least=5000, pressure=2e5, tolerance=1),
    ]
    found = fs.design(tube(beta=-30.0), {"alpha": (20, 50), "beta": "-alpha"}, wish, count=2)
    assert not found["met"].values.any()
    assert re.search("fights with|bounds .* stop it", found.attrs["summary"])


@pytest.mark.parametrize(
    ("goal", "limits", "says"),
    [
        (
            fs.Goal("force", 500, pressure=1e5, tolerance=1),
            [fs.Limit("outer_radius", at_most=8e-3, pressure=1e5)],
            "N instead of 500 N: it fights with outer_radius at pressure 100 kPa",
        ),
        (
            fs.Goal("stroke", 0.1, pressure=1e5),
            [
                fs.Limit("deformed_length", at_most=0.1, pressure=1e5),
                fs.Limit("deformed_length", at_least=0.2, pressure=1e5),
            ],
            "mm instead of at most 100 mm: it fights with deformed_length at pressure 100 kPa, at least 200 mm",
        ),
    ],
)
def test_limits_that_fight_are_named(goal, limits, says):
    found = fs.design(tube(alpha=30, beta=-30), {"alpha": (10, 80), "beta": "-alpha"}, goal, limits, count=2)
    assert found.attrs["summary"].endswith(says)


def test_what_is_beaten_in_both_is_on_no_front():
    """The slimmest of all, and as slim with less of the other; nor counts what rounding parts."""
    values = np.array([[3.0, 8.0], [3.0, 4.6], [5.0, 2.0], [5.0 + 1e-6, 2.0 + 1e-6], [6.0, 3.0], [np.inf, np.inf]])
    assert beaten(values, np.array([6.0, 8.0])).tolist() == [True, False, False, False, True, True]


def test_the_slimmest_muscle_and_the_price_of_its_force():
    """A blocked force grows with r^2: one newton more costs dr/dF = r/(2 F) where only the radius is left."""
    free, state = {"radius": ("2 mm", "15 mm")}, {"pressure": 2e5}
    found = fs.design(
        tube(beta=-30.0), free, [fs.Goal("force", 100, tolerance=1e-3, **state)], minimize="radius", count=1
    )
    radius = found["radius"].item()
    assert found["met"].item()
    assert found["goal_price"].item() == pytest.approx(radius / 200.0, rel=0.02)


def test_no_candidate_breaks_a_limit():
    wish = [fs.Goal("rotation", 200, pressure=1e5, tolerance=1)]
    kept = [fs.Limit("outer_radius", at_most=7e-3, pressure=1e5), fs.Limit("limit_pressure", at_least=2e5)]
    found = fs.design(tube(), bounds("alpha", "beta", "radius"), wish, kept, count=6)
    good = found["met"].values
    assert good.any()
    assert np.all(found["limit_value"].values[good, 0] <= 7e-3 + found["limit_error"].values[good, 0])
    for made, fine in zip(made_by(found), good):
        if fine:
            assert fs.inflate(made, 2e5, x=0.0)["status"] == 0


def test_a_front_trades_one_for_the_other():
    wish = [fs.Goal("force", at_least=60, pressure=2e5, tolerance=0.1)]
    least = ["radius", fs.Limit("stroke", at_least=-1, pressure=2e5)]
    found = fs.design(tube(beta=-30.0), {"alpha": (15, 50), "beta": "-alpha", "radius": (3e-3, 9e-3)}, wish,
                      minimize=least, count=5)  # fmt: skip
    first = np.argsort(found["objective"].values[:, 0])
    second = found["objective"].values[first, 1]
    assert len(second) >= 3
    assert found["met"].values.all()
    assert np.all(np.diff(second) < 1e-4)


def test_what_can_be_bought_is_chosen_from():
    shop = [(4.76e-3, 1.59e-3), (6.35e-3, 0.8e-3)]
    free = bounds("alpha", "beta") | {"radius,wall": shop, "material": ["natural-latex", "natural-latex-40"]}
    found = fs.design(tube(), free, [fs.Goal("rotation", 300, pressure=1e5, tolerance=1)], count=8)
    assert found["met"].values.any()
    assert {*zip(found["radius"].values.tolist(), found["wall"].values.tolist())} <= set(shop)
    assert all(made.material in fs.materials.values() for made in made_by(found))


def test_a_profile_along_the_tube_is_free():
    wish = [
        fs.Goal("rotation", 60, pressure=1e5, tolerance=0.5),
        fs.Goal("length_change", 0, pressure=1e5, tolerance=1e-4),
    ]
    start = tube(alpha=[(0, 20), (1, 40)], beta=-60.0)
    found = fs.design(start, {"alpha": fs.Profile(2, (10, 60))}, wish, count=1)
    assert found["alpha"].dims == ("candidate", "knot")
    (made,) = made_by(found)
    assert fs.inflate(made, 1e5, x=0.0)["rotation"].item() == pytest.approx(found["goal_value"].values[0, 0], abs=1e-3)
    assert found["misfit"].item() < 0.5 * _missed(start, wish)
    _, heading, row = table(found).splitlines()[:3]
    assert re.split("  +", heading.strip())[:2] == ["at x/l 0", "at x/l 1"]
    assert [float(cell) for cell in row.split()[1:3]] == pytest.approx(found["alpha"].values[0], rel=1e-5)


def _missed(made, wish):
    state = fs.inflate(made, 1e5, x=0.0)
    values = state["rotation"].item(), state["deformed_length"].item() - made.length
    return np.hypot(*((value - goal.value) / goal.tolerance for value, goal in zip(values, wish)))


def test_an_atlas_is_asked_for_the_first_look(tmp_path, monkeypatch):
    make(tmp_path / "atlas.nc", parse(ATLAS))
    looked = []
    monkeypatch.setattr(
        look.Misfit, "at", lambda self, u, *rest, **named: looked.append(len(u)) or AT(self, u, *rest, **named)
    )
    does = fs.inflate(tube(alpha=48.0, beta=-38.0), 5e4, x=0.0)
    wish = [fs.Goal(name, does[name].item(), pressure=5e4) for name in ("rotation", "deformed_length")]
    with fs.open_atlas(tmp_path / "atlas.nc") as atlas:
        found = fs.design(
            tube(alpha=40.0, beta=-20.0), {"alpha": (30, 60), "beta": (-60, -30)}, wish, count=2, atlas=atlas
        )
    assert max(looked) <= 6  # starts only
    assert found["met"].values[0]


@pytest.mark.parametrize(
    "other",
    [dict(length=0.2), dict(model="physical"), dict(material=fs.MooneyRivlin(2e5, 6e4)), dict(material=fs.Yeoh(1.2e5))],
)
def test_an_atlas_of_other_tubes_is_not_asked(tmp_path, other):
    """It is told so; what it does not hold had been refused as what no tube does."""
    make(tmp_path / "atlas.nc", parse(ATLAS))
    goal, template = fs.Goal("rotation", 30, pressure=5e4), replace(tube(alpha=40.0, beta=-20.0), **other)
    with fs.open_atlas(tmp_path / "atlas.nc") as atlas, pytest.warns(UserWarning, match="it was not asked"):
        found = fs.design(template, {"alpha": (30, 60), "beta": (-60, -30)}, goal, count=1, atlas=atlas)
    assert found["met"].item()


def test_the_same_seed_gives_the_same_bits():
    wish = [fs.Goal("rotation", 120, pressure=1e5)]
    one, other = (fs.design(tube(), bounds("alpha", "beta"), wish, count=4, seed=3) for _ in range(2))
    assert one.identical(other)


def test_symmetric_copies_are_one_candidate():
    found = fs.design(
        tube(), {"alpha": (-80, 80), "beta": (-80, 80)}, [fs.Goal("rotation", 120, pressure=1e5)], count=8
    )
    pairs = np.sort(np.column_stack([found["alpha"], found["beta"]]), axis=1)
    apart = np.linalg.norm(pairs[:, None] - pairs, axis=-1) + 1e3 * np.eye(len(pairs))
    assert apart.min() > 1.0


@pytest.mark.parametrize(
    ("free", "goals", "words"),
    [
        ({"alpha": (0, 85), "size": (1, 2)}, [], ["free: found 'size'", "goals: none"]),
        ({"alpha": (85, 0)}, [fs.Goal("rotation", 90)], ["free['alpha']", "lowest, highest"]),
        ({"alpha": "3*gamma"}, [fs.Goal("rotation", 90, pressure=1e5)], ["a tie is a parameter"]),
        ({"alpha": "beta", "beta": "-alpha"}, [fs.Goal("rotation", 90, pressure=1e5)], ["tied itself"]),
        ({"radius": ["five"]}, [fs.Goal("rotation", 90, pressure=1e5)], ["free['radius']"]),
        ({"material": ["rubber"]}, [fs.Goal("rotation", 90, pressure=1e5)], ["The library holds"]),
        ({"alpha": (0, 85)}, [fs.Goal("rotation", 90)], ["give its pressure, or let 'pressure' be free"]),
        ({"alpha": (0, 85)}, "rotation", ["give a list of freesweep.Goal"]),
        (
            {"alpha": (30, 30)},
            [fs.Goal("rotation", 90, pressure=1e5)],
            ["lowest, highest), the first below the second"],
        ),
        ({"pressure": (-1e5, 1e5)}, [fs.Goal("rotation", 90)], ["pressures are 0 or more"]),
        ({"alpha": (0, 85)}, [fs.Goal("pressure", at_most=1e5)], ["each state has its own"]),
    ],
)
def test_every_fault_of_a_wish_is_listed(free, goals, words):
    with pytest.raises(fs.ActuatorError) as fault:
        fs.design(tube(), free, goals)
    assert all(word in str(fault.value) for word in words)


def test_what_a_template_has_not_is_not_free():
    one, same = replace(tube(), beta=None), replace(tube(), beta=30.0, fibers="loose")
    wish = [fs.Goal("rotation", 9, pressure=1e4)]
    with pytest.raises(fs.ActuatorError, match=r"free\['beta,wall'\]: the template has no family beta"):
        fs.design(one, {"beta,wall": [(20, 1e-3)]}, wish)
    with pytest.raises(fs.ActuatorError, match="template: its two families have one angle"):
        fs.design(same, {"alpha": (20, 40)}, wish)


@pytest.mark.parametrize(
    ("wish", "word"),
    [
        (dict(output="rotatoin", value=1), "choose one of"),
        (dict(output="rotation"), "give one of value"),
        (dict(output="rotation", value=90, at_most=3), "give one of value"),
        (dict(output="force", value=10, pressure=1e5, force=3), "give pressure, deformed_length, torque"),
        (dict(output="rotation", value=[1, 2], pressure=[1, 2, 3]), "arrays of one length"),
        (dict(output="rotation", value="ninety"), "rotation"),
        (dict(output="rotation", between=(5, 3)), "lower number first"),
        (dict(output="radius", value=5e-3, pressure=1e5), "no matter of a state"),
        (dict(output="rotation", value=5, pressure=[1e5, -1e4]), "pressures are 0 or more"),
    ],
)
def test_a_wish_that_makes_no_sense_is_refused(wish, word):
    with pytest.raises(fs.ActuatorError, match=re.escape(word)):
        fs.Goal(**wish)


def test_units_are_read_in_wishes():
    (wish,) = fs.Goal("rotation", "90 deg", pressure="1 bar", tolerance="1 deg").wishes([])
    assert wish == Wish("rotation", (("pressure", 1e5),), 90.0, 90.0, 1.0, wish.title)


def test_a_rotator_beats_the_switch_of_the_source():
    """Section 2.5.1: 150 degrees at 0.14 MPa, within 0.1 mm of its length at every pressure on the way. Found by
    `freesweep design sweeps/wishes/pure-rotator.toml`, which takes some minutes.
    """
    found = fs.inflate(found_rotator(), np.linspace(0.0, 0.14e6, 57), x=0.0)
    assert np.all(found["status"] == 0)
    assert found["rotation"].values[-1] > 149.9
    assert np.max(np.abs(found["deformed_length"] - 0.2)) < 0.1e-3


def test_a_single_limit_needs_no_list():
    kept = fs.Limit("radius", at_most=4e-3)
    found = fs.design(
        tube(), bounds("alpha", "radius"), fs.Goal("rotation", -60, pressure=1e5, tolerance=1), kept, count=2
    )
    assert np.all(found["radius"].values[found["met"].values] <= 4e-3)


def test_what_no_design_has_a_state_for_is_refused():
    wish = fs.Goal("force", 10, pressure=1.0, deformed_length=1e-4)
    none = pytest.raises(fs.ActuatorError, match="none of the designs that were looked at has all the states")
    with none, pytest.warns(UserWarning, match="a held length of 0.0001 m|no pressure exceeds 1 Pa"):
        fs.design(tube(), bounds("alpha"), wish, count=1)


def test_the_smallest_tube_without_a_goal_is_at_its_bound():
    found = fs.design(tube(), bounds("radius"), [], minimize="radius", count=1)
    assert found["radius"].item() == pytest.approx(3e-3)


def test_a_hidden_force_stroke_curve_with_noise_is_met_within_it(tmp_path):
    """From a CSV file with units in its header; the noise of 2 % is the tolerance."""
    secret = tube(alpha=35.0, beta=-35.0, radius=6e-3)
    lengths = np.linspace(0.12, 0.148, 9)
    exact = fs.blocked_force(secret, 1.5e5, lengths, x=0.0)["force"].values
    noise = 0.02 * np.max(np.abs(exact))
    measured = exact + noise * np.random.default_rng(5).standard_normal(9)
    rows = [f"{1e3 * a!r},{b!r},{float(noise)!r}" for a, b in zip(lengths.tolist(), measured.tolist())]
    path = tmp_path / "force-stroke.csv"
    path.write_text("\n".join(["deformed_length [mm],force [N],force_sigma [N]", *rows]))
    found = fs.design(
        tube(beta=-30.0), bounds("radius") | {"alpha": (10, 60), "beta": "-alpha"},
        fs.Goal("force", path, pressure="1.5 bar"), count=1,
    )  # fmt: skip
    assert found.sizes["goal"] == 9
    np.testing.assert_allclose(found["goal_value"].values[0], exact, atol=1.5 * noise)
    assert found["misfit"].item() <= np.linalg.norm((measured - exact) / noise)  # a best fit is no worse than the truth


@pytest.mark.parametrize(
    ("text", "output", "words"),
    [
        ("pressure [kPa],rotation [deg]\n10,3\n", "force", "no column 'force'; found pressure, rotation"),
        ("pressure [kPa],rotation [deg],force [N]\n10,3,4\n", "force", "'rotation' is no state of force"),
        ("pressure [kPa],force\n10,3\n", "force", "names no unit"),
    ],
)
def test_a_curve_file_that_tells_no_curve_is_refused(tmp_path, text, output, words):
    path = tmp_path / "curve.csv"
    path.write_text(text)
    with pytest.raises(fs.ActuatorError, match=re.escape(words)):
        fs.Goal(output, path)


def test_a_stiffness_is_wished_for_and_is_that_of_the_tube(hidden):
    """A free end's stiffness, and that of one that is held, against the solver's own differences."""
    goals = [
        fs.Goal("stiffness", 900, pressure=1e5, deformed_length=0.145),
        fs.Goal("torsional_stiffness", 2e-3, pressure=1e5),
    ]
    found = fs.design(tube(), bounds("alpha", "beta", "radius"), goals, count=1)
    assert found["met"].item()
    (made,) = made_by(found)
    force = fs.blocked_force(made, 1e5, [0.1449, 0.1451], x=0.0, accuracy=1e-9)["force"].values
    turned = fs.inflate(made, 1e5, torque=[-1e-3, 1e-3], x=0.0, accuracy=1e-9)["rotation"].values
    assert np.diff(force).item() / 2e-4 == pytest.approx(900, rel=1e-3)
    assert 2e-3 / np.diff(turned).item() == pytest.approx(2e-3, rel=1e-3)


def test_candidates_spread_under_tolerances_as_their_tubes_do():
    tolerances = {"alpha": "1 deg", "wall": 5e-5, "pressure": 500}
    found = fs.design(
        tube(), bounds("alpha", "beta"), fs.Goal("rotation", 90, pressure=1e5),
        fs.Limit("radius", at_most=6e-3), count=1, tolerances=tolerances,
    )  # fmt: skip
    (made,) = made_by(found)
    told = fs.tolerance(made, 1e5, alpha=1.0, wall=5e-5, pressure_tolerance=500)
    assert found["goal_spread"].item() == pytest.approx(told["rotation_deviation"].item(), rel=1e-5)
    assert found["limit_spread"].item() == 0.0
    with pytest.raises(fs.ActuatorError) as fault:
        fs.design(tube(), bounds("alpha"), [], minimize="radius", tolerances={"gamma": 1.0, "wall": -1.0})
    assert len(fault.value.faults) == 2


def test_what_a_bound_or_a_limit_costs_is_said():
    """F = pi r^2 P (2 cot^2 - 1): at 60 N, 10 N less let a muscle be r/(2 F) 10 N slimmer."""
    muscle = tube(beta=-30.0)
    least = fs.design(muscle, bounds("radius"), fs.Goal("force", at_least=60, pressure=2e5), minimize="radius", count=1)
    saved = least["radius"].item() / 120 * 6
    assert least.attrs["prices"].startswith("least radius: 6 N less of force at pressure 200 kPa would save")
    assert least.attrs["prices"].endswith(" mm")
    assert float(least.attrs["prices"].split()[-2]) == pytest.approx(1e3 * saved, rel=0.05)
    short = fs.design(muscle, {"radius": (3e-3, 4e-3)}, fs.Goal("force", at_least=60, pressure=2e5), count=1)
    assert "0.1 mm more of radius would buy" in short.attrs["summary"]


def test_a_fault_of_a_goal_is_told_once():
    with pytest.raises(fs.ActuatorError) as fault:
        fs.Goal("rotation", "90 mm", pressure=1e5)
    assert len(fault.value.faults) == 1


def test_a_limit_is_a_range():
    with pytest.raises(fs.ActuatorError, match="at_least, at_most or between"):
        fs.Limit("rotation", 3, pressure=1e5)


def test_a_candidate_whose_threads_would_have_to_push_says_so():
    rubber = fs.MooneyRivlin(0.17e6, 0.08e6)
    tube = fs.Actuator(alpha=0, beta=30, length=0.131, radius=4.76e-3, wall=1.59e-3, material=rubber)
    turn = fs.inflate(tube, 3e4, x=0.0)
    assert int(turn.slack_fiber) == 1
    wish = fs.Goal("rotation", turn.rotation.item(), pressure=3e4, tolerance=1)
    found = fs.design(tube, {"length": (0.13, 0.132)}, wish, count=1)
    assert found.slack_fiber.values.tolist() == [1]
    assert found.attrs["summary"].endswith("in 1 of them threads would have to push (slack_fiber)")
    state, loads = State("free", (("pressure", 3e4),), None), {"pressure": 3e4, "force": 0.0, "torque": 0.0}
    alone = solve_single(tube, {state: ["rotation"]}, loads, 1e-6)  # as tubes that vectors cannot solve
    assert alone[state]["slack"] == 1


@pytest.mark.parametrize("name", ["rotator", "muscle", "bought", "pure-rotator"])
def test_examples_of_wishes_are_read(name):
    asked = wish_file.read(ROOT / "sweeps" / "wishes" / f"{name}.toml")
    assert asked["goals"]
    assert isinstance(asked["template"], fs.Actuator)


def test_wishes_from_the_shell_become_a_table_a_file_and_a_picture(tmp_path, capsys):
    out, picture = tmp_path / "candidates.csv", tmp_path / "candidates.png"
    wish = str(ROOT / "sweeps" / "wishes" / "rotator.toml")
    assert main(["design", wish, "--out", str(out), "--picture", str(picture)]) == 0
    said = capsys.readouterr().out
    assert "meet every goal and keep every limit" in said
    assert "fs.Actuator(" in said
    rows = list(csv.reader(out.read_text(encoding="utf-8").splitlines()))
    assert {"alpha [degree]", "radius [m]", "rotation [degree] at pressure 100000 Pa", "python"} <= set(rows[0])
    assert {row[rows[0].index("status")] for row in rows[1:]} == {"ok"}
    assert len({len(row) for row in rows}) == 1
    # those that do it first, of these those in which no thread would push, which the table marks; in units of the wish
    found = [dict(zip(rows[0], row)) for row in rows[1:]]
    order = [(one["met"] != "True", one["met"] == "True" and one["slack_fiber"] != "0") for one in found]
    assert order == sorted(order)
    assert (False, True) in order
    above, heading, *table = said.splitlines()
    assert re.split("  +", above.strip()) == ["rotation [deg]", "length_change [mm]"]
    assert re.split("  +", heading.strip())[2:] == ["radius [mm]", *["at pressure 100 kPa"] * 2, "would push"]
    for line, one in zip(table, found):
        assert float(line.split()[3]) == pytest.approx(1e3 * float(one["radius [m]"]), rel=1e-5)
        assert line.split()[-1] == ("-", "alpha", "beta")[int(one["slack_fiber"])]
    assert picture.stat().st_size > 20_000


def test_what_is_wider_than_a_screen_stands_below_each_other():
    """Fifteen limits of nine candidates: rows and columns are exchanged, as many side by side as a screen holds."""
    limits = [fs.Limit("stroke", at_most=0.01, pressure=p) for p in np.linspace(1e4, 1e5, 15)]
    found = fs.design(tube(), bounds("alpha", "radius"), fs.Goal("rotation", 60, pressure=1e5), limits, count=9)
    lines = table(found).splitlines()
    assert max(map(len, lines)) <= 120
    numbers = [line.split() for line in lines if line and line.lstrip()[0].isdigit()]
    assert len(numbers) > 1
    assert [one for own in numbers for one in own] == [str(k) for k in range(found.sizes["candidate"])]
    count, row = len(numbers[0]), next(line for line in lines if line.startswith("rotation [deg] at pressure 100 kPa"))
    told = [float(cell) for cell in row.replace(" !", "").split()[-count:]]
    assert told == pytest.approx(found["goal_value"].values[:count, 0], rel=1e-5)


def test_a_name_that_no_picture_can_have_is_refused_before_the_search(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("freesweep.inverse.designing.find", lambda **_: pytest.fail("searched"))
    wish = str(ROOT / "sweeps" / "wishes" / "rotator.toml")
    assert main(["design", wish, "--picture", str(tmp_path / "candidates.jpg")]) == 2
    assert "--picture: found" in capsys.readouterr().err


def test_a_rubber_that_was_chosen_has_its_name_in_table_file_and_picture():
    own = fs.NeoHookean(1e5)
    goals = [fs.Goal("stroke", at_least=0.1, pressure=1e5)]
    free = {"alpha": (20, 40), "beta": "-alpha", "material": ["dragon-skin-30", fs.materials["natural-latex"], own]}
    result, tubes = find(tube(30.0, -30.0), free, goals, count=6)
    names = {"dragon-skin-30": "dragon-skin-30", "natural-latex": "natural-latex", repr(own): own}
    chosen = result["material"].values.tolist()
    assert set(chosen) == {*names}
    assert [fs.materials.get(name, own) for name in chosen] == [one.material for one in tubes]
    _, heading, *rows = table(result).splitlines()
    assert "  material  " in heading
    assert all(name in row for name, row in zip(chosen, rows))
    header, *rows = csv.reader(candidates_csv(result).splitlines())
    assert [row[header.index("material")] for row in rows] == chosen
    figure = draw(result, *shown(result, tubes, goals))
    assert not any(ax.spines[side].get_visible() for ax in figure.axes for side in ("top", "right"))
    said = [text.get_text() for text in figure.axes[-1].texts]
    assert [text.split(", ", 1)[1] for text in said] == chosen[:5]


def test_shapes_are_shown_in_the_state_that_is_asked_for():
    """Of a held rotation: undeformed, by hand; of a held length: as long as that."""
    template, loads = tube(30.0, -50.0), {}
    for goal, length, rotation in (
        (fs.Goal("torque", 0.1, pressure=5e4), 0.15, 0.0),
        (fs.Goal("force", 1.0, pressure=5e4, deformed_length=0.145), 0.145, None),
        (fs.Goal("rotation", 1.0, pressure=5e4), None, fs.inflate(template, 5e4, x=0.0)["rotation"].item()),
    ):
        _, (shape,) = shown(loads, [template], [goal])
        assert length is None or shape.position[-1] == pytest.approx(length, rel=1e-6)
        assert rotation is None or shape.rotation == pytest.approx(rotation, rel=1e-4)


def test_pictures_show_what_tells_most():
    """A limit's curve and the free state in which it counts, beside a held cylinder; forces over the lengths held, and the
    shortest of these.
    """
    template = tube(20.0, -20.0)
    goal, limit = fs.Goal("force", at_least=1, pressure=5e4), fs.Limit("stroke", at_least=0.01, pressure=5e4)
    curves, (shape,) = shown({}, [template], [goal], [limit])
    assert [(curve.output, curve.along, curve.unit) for curve in curves] == [
        ("force", "pressure", "N"), ("stroke", "pressure", "1")
    ]  # fmt: skip
    assert curves[1].asked == [(5e4, 0.01, np.inf)]
    assert shape.held == ""
    free = fs.inflate(template, 5e4, x=0.0)["deformed_length"].item()
    assert shape.position[-1] == pytest.approx(free, rel=1e-4)
    assert curves[1].values[0][curves[1].at == 5e4] == pytest.approx(1.0 - free / 0.15, abs=1e-5)
    along = fs.Goal("force", [3.0, 2.0], pressure=5e4, deformed_length=[0.15, 0.147])
    (curve,), (shape,) = shown({}, [template], [along])
    assert curve.along == "deformed_length"
    assert (curve.at[0], curve.at[-1]) == (0.147, 0.15)
    ends = fs.blocked_force(template, 5e4, [0.147, 0.15], x=0.0)["force"].values
    assert curve.values[0][[0, -1]] == pytest.approx(ends, rel=1e-5)
    assert (shape.held, shape.position[-1]) == ("force", pytest.approx(0.147, rel=1e-6))


def test_a_wish_file_lists_every_fault(tmp_path, capsys):
    path = tmp_path / "wish.toml"
    path.write_text("[actuator]\nlenght = 3\n[free]\nalpha = {start = 0}\n[[goals]]\nvalue = 3\n[extra]\n")
    assert main(["design", str(path)]) == 2
    said = capsys.readouterr().err
    assert all(word in said for word in ("extra: unknown", "actuator.lenght", "give start and stop", "goals[0].output"))


def test_help_of_design_needs_no_solver():
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "freesweep", "design", "--help"], capture_output=True, text=True,
        env=CHILD_ENVIRONMENT,
    )  # fmt: skip
    assert done.returncode == 0
    assert "WISH.toml" in done.stdout
    assert "numba" not in done.stderr

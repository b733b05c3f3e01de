"""Sweeps over the taper and the bulge of bodies: points are the single actuators, between them is told with its error."""

import numpy as np
import pytest
from grids import make
from plain import by_what_there_is

import freesweep as fs
from freesweep import interpret
from freesweep.cli import parser
from freesweep.cli.single import tube_of
from freesweep.description import courses, splines
from freesweep.description.local import Bodies
from freesweep.description.profiles import as_profile
from freesweep.description.revolution import resolved, wall_volume_inside
from freesweep.query.calibration import ATTRIBUTE
from freesweep.query.measure import measured
from freesweep.query.predictor import Predictor
from freesweep.query.reference import COLUMNS, LOADED
from freesweep.solver import batch, hold_batch
from freesweep.sweep import refine_axes
from freesweep.sweep.estimate import dry_run
from freesweep.sweep.plan import plan
from freesweep.sweep.spec import SpecificationError, parse
from freesweep.sweep.written import sweep_of
from freesweep.verification import cross_check, restate, verify

TEXT = """
title = "cones"
[actuator]
alpha = {alpha}
beta = {beta}
length = "60 mm"
radius = "6 mm"
wall = {wall}
c10 = "0.17 MPa"
c01 = "0.08 MPa"
bulge = {bulge}
[axes]
taper = [-0.1, "20 %"]
pressure = ["30 kPa", "60 kPa"]
{more}
"""
RUBBER = fs.MooneyRivlin(c10=0.17e6, c01=0.08e6)
BODY = fs.Actuator(alpha=20, beta=-45, length=0.06, radius="6 mm", wall="1 mm", taper=0.2, bulge=0.15, material=RUBBER)
OUTPUTS = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")


def text(alpha="20", beta="-45", wall='"1 mm"', bulge="0.15", more=""):
    return TEXT.format(alpha=alpha, beta=beta, wall=wall, bulge=bulge, more=more)


@pytest.fixture(scope="module")
def plain():
    """States without the compiler, but for what it has made already: free states of bodies, before the whole suite."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(interpret, "_clock", interpret._Clock())
        patch.setattr(interpret, "at_once", lambda *_, **__: False)
        for states, name in ((batch, "follow_many"), (hold_batch, "hold_many")):
            entry = getattr(states, name)
            patch.setattr(states, name, lambda *arguments, entry=entry: by_what_there_is(entry, arguments))
        yield


@pytest.fixture(scope="module")
def atlas(plain, tmp_path_factory):
    folder = tmp_path_factory.mktemp("bodies")
    with fs.run_sweep(parse(text()), folder / "atlas.nc", threads=1, progress=False) as opened:
        yield opened


def near(point, name, single):
    assert abs(point[name] - single[name]) <= point[f"{name}_error"] + single[f"{name}_error"], name


def test_a_taper_slims_the_far_end_and_a_bulge_widens_the_middle():
    tube = fs.Actuator(
        alpha=20, beta=-45, length=0.06, radius="6 mm", wall="1 mm", taper="20 %", bulge=0.1, material=RUBBER
    )
    assert tube.profile("radius").at([0.0, 0.5, 1.0]) == pytest.approx([6e-3, 6e-3 * 0.9 * 1.1, 6e-3 * 0.8])
    share, step = np.linspace(0.05, 0.95, 7), 1e-6
    radius = tube.profile("radius")
    slope = (radius.at(share + step) - radius.at(share - step)) / (2.0 * step)
    assert radius.slope_at(share) == pytest.approx(slope, rel=1e-8)


def test_a_taper_is_told_in_the_shell():
    words = [
        "inflate",
        "--alpha",
        "20",
        "--beta=-45",
        "--radius",
        "6 mm",
        "--wall",
        "1 mm",
        "--length",
        "60 mm",
        "--c10",
    ]
    words += ["1 bar", "--pressure", "1 bar", "--taper", "0.2", "--bulge", "10%"]
    tube = tube_of(parser().parse_args(words))
    assert (tube.taper, tube.bulge, tube.is_body) == (0.2, 0.1, True)


def test_points_are_the_single_bodies(atlas):
    single = fs.inflate(BODY, 6e4, x=0.0)
    point = atlas.data.sel(taper=0.2, pressure=6e4)
    assert point["status"] == single["status"]
    for name in OUTPUTS:
        near(point, name, single)


@pytest.mark.long
def test_locked_points_are_the_single_bodies(atlas):
    point, locked = atlas.data.sel(taper=0.2), fs.lock(BODY, x=0.0)
    for name in OUTPUTS:
        assert abs(point[f"locked_{name}"] - locked[name]) <= point[f"locked_{name}_error"] + locked[f"{name}_error"]


def test_an_atlas_of_bodies_is_whole_and_tells_its_axes(atlas):
    assert verify.faults(atlas.path) == []
    assert atlas.data["taper"].attrs["units"] == "1"
    assert atlas.data["taper"].attrs["long_name"] == "taper of the radius"
    assert not [name for name in atlas.data if name.startswith("ideal_")]


def test_between_its_nodes_an_atlas_of_bodies_tells_what_is_within_the_stated_error(atlas):
    here = {"taper": 0.1, "pressure": 45e3}
    exact = atlas.query(**here, refine=True)
    reader = atlas._reader
    told = reader.answer(
        reader.complete({name: np.array([value]) for name, value in here.items()}, 1), 1, OUTPUTS, tolerance=1.0
    )
    for name in OUTPUTS:
        error = abs(told[name][0] - exact[name].item())
        assert error <= told[f"{name}_error"][0]
        assert error <= 5e-3 * abs(exact[name].item())  # two nodes along each axis


@pytest.mark.long
def test_an_atlas_of_bodies_solves_profiles_along_them(atlas):
    found = atlas.query(taper=0.1, pressure=60e3, refine=True, x=[0.0, 0.03, 0.06])
    undeformed = 6e-3 * np.array([1.0, 0.95 * 1.15, 0.9])
    assert found["deformed_radius"].values[[0, 2]] == pytest.approx(undeformed[[0, 2]])
    assert abs(found["deformed_radius"].values[1] - found["mid_radius"]) <= found["mid_radius_error"] + 1e-8


@pytest.mark.long
def test_what_is_stated_of_bodies_is_what_the_solver_states(atlas):
    points = cross_check.draw(atlas.data, 2)
    comparisons, notes = restate.finer(points)
    assert {compared.name for compared in comparisons} >= set(OUTPUTS)
    assert not any(compared.broken.any() for compared in comparisons)
    assert notes
    assert restate.faults(points) == []


@pytest.mark.long
def test_an_atlas_of_bodies_measures_itself(atlas):
    found = measured(atlas.data, designs=4)
    assert set(found["variables"]) >= set(OUTPUTS)
    assert ATTRIBUTE not in atlas.data.attrs  # too small to be worth it by itself


@pytest.mark.parametrize("place", ["inner", "outer"])
def test_the_local_tube_of_a_cylinder_is_the_tube(place):
    model = fs.description.tube_model.MODELS["source"]._replace(fiber_radius=place)
    point = dict.fromkeys(COLUMNS, 0.0) | {"alpha": 20.0, "beta": -45.0, "length": 0.06, "radius": 6e-3, "wall": 1e-3}
    point |= {"fiber_radius": 6e-3 + 1e-3 * (place == "outer"), "fiber_extension": 1.0, "c10": 1.7e5, "pressure": 5e4}
    points = np.array([[point[name] for name in COLUMNS]])
    tube = Predictor(model, "full").states(LOADED, points)
    bodies = Predictor(model, "full", Bodies(model, {})).states(LOADED, points)
    assert bodies[0, [0, 1, 2, 3, 4, 5, 6]] == pytest.approx(tube[0, [0, 1, 2, 3, 4, 5, 6]], rel=1e-13)


RULES = {"alpha": "geodesic", "beta": "geodesic", "wall": "constant volume"}


@pytest.mark.parametrize("rules", [{}, RULES])
def test_bodies_at_one_place_are_what_a_tube_is_there(rules):
    bodies = Bodies(fs.description.tube_model.MODELS["physical"], rules)
    numbers = [20.0, -45.0, 1e-3, 0.06, 6e-3, 7e-3, 0.2, 0.15]
    tube, share = bodies.tube(numbers), np.linspace(0.0, 1.0, 7)
    tube.wall = tube.wall if rules else [(0.0, 1e-3), (1.0, 1e-3)]
    parts = resolved(tube)
    names = ("alpha", "beta", "wall", "length", "radius", "fiber_radius", "taper", "bulge")
    here = bodies.at(dict(zip(names, numbers)), share)
    assert here["fiber_radius"] == pytest.approx(parts.fibers.at(share), rel=1e-14)
    assert np.broadcast_to(here["wall"], 7) == pytest.approx(parts.wall.at(share), rel=1e-14)
    assert np.broadcast_to(here["alpha"], 7) == pytest.approx(parts.first.at(share), rel=1e-13)
    slope = bodies.rise(dict(zip(names, numbers)), share) * 0.06
    assert slope == pytest.approx(parts.fibers.slope_at(share), rel=1e-12, abs=1e-12)
    _, inside = bodies.surface({name: np.array([number]) for name, number in zip(names, numbers)})
    assert inside[0] == pytest.approx(wall_volume_inside(tube), rel=1e-12)


SIZES = 'length = "60 mm"\nradius = "6 mm"\nwall = "1 mm"\n'
TWICE = 'length = "120 mm"\nradius = "12 mm"\nwall = "2 mm"\n'


def test_scaled_bodies_are_solved_once_and_others_are_not():
    own = text().replace(SIZES, "")
    own += f'[[designs]]\nname = "small"\n{SIZES}[[designs]]\nname = "large"\n{TWICE}'
    assert plan(parse(own))["free"].problem.tolist() == [0, 1, 0, 1]


def test_words_and_smooth_knots_are_read_as_a_single_actuator_reads_them():
    knots = fs.Profile([(0, "5 mm"), (0.5, "8 mm"), (1, "5 mm")], smooth=True)
    given = {
        "alpha": ["geodesic 10 deg", "geodesic 20 deg"],
        "beta": "geodesic -45 deg",
        "wall": "constant volume 1 mm",
    }
    sweep = sweep_of(given | {"length": 0.06, "radius": knots, "pressure": 5e4, "c10": 1e5})
    assert sweep.rules == RULES
    assert sweep.axes["alpha"].tolist() == [10.0, 20.0]
    assert as_profile(sweep.profiles["radius"], "m").at(0.25) == pytest.approx(as_profile(knots, "m").at(0.25))
    tubes, _ = plan(sweep)["free"].job(0, 2)[5:]
    single = fs.Actuator(
        alpha="geodesic 10 deg", beta="geodesic -45 deg", wall="constant volume 1 mm", length=0.06, radius=knots,
        material=fs.NeoHookean(1e5),
    )  # fmt: skip
    course = splines.follow(single, 1e-6, courses.SHARE * 1e-6 / splines.SENSITIVITY)[0][0]
    assert tubes[0][0][0].shape == course.shape
    assert np.allclose(tubes[0][0][0], course, rtol=1e-14, atol=1e-15)


def test_a_range_that_passes_zero_has_a_straight_body():
    sweep = parse(text().replace('[-0.1, "20 %"]', '{start = "-10 %", stop = "25 %", step = "5 %"}'))
    assert sweep.axes["taper"].tolist() == [-0.1, -0.05, 0.0, 0.05, 0.1, 0.15, 0.2, 0.25]


def test_of_a_tube_a_rule_is_the_number_it_gives():
    own = text(alpha='"geodesic 20 deg"').replace("bulge = 0.15", "").replace("taper = [-0.1, ", "force = [0, ")
    sweep = parse(own.replace('"20 %"', "0.2"))
    assert (sweep.rules, sweep.fixed["alpha"]) == ({}, 20.0)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"more": "[load]\ntorque = 0\n[solver]\nbudget = 1"}, "interpolation_tolerance"),
        ({"alpha": '["geodesic 20 deg"]'}, "several values belong in [axes]"),
        ({"wall": "{smooth = true, knots = 3}"}, "actuator.wall.knots: found 3"),
        ({"wall": "{smooth = 1, knots = [[0, 1e-3], [1, 1e-3]]}"}, "actuator.wall.smooth: found 1"),
        ({"wall": '"constant volume 1 kPa"'}, "actuator.wall: expects"),
    ],
)
def test_faults_of_what_varies_are_named(given, says):
    with pytest.raises(SpecificationError) as caught:
        parse(text(**given))
    assert any(says in fault for fault in caught.value.faults), caught.value.faults


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('"20 %"', "1", "the far end is slimmer by that share"),
        ("bulge = 0.15", "bulge = -1", "-1 would close it"),
        ('"1 mm"', '"1 mm"\nfiber_radius = 6.5e-3', "the radius varies; choose one of inner, middle, outer"),
        ("taper = [", 'beta = ["geodesic 20 deg", 30]\ntaper = [', "some values follow the rule 'geodesic'"),
    ],
)
def test_shapes_that_are_none_are_refused(old, new, says):
    own = text().replace(old, new)
    with pytest.raises(SpecificationError) as caught:
        parse(own.replace("beta = -45\n", "") if "beta = [" in own else own)
    assert any(says in fault for fault in caught.value.faults), caught.value.faults


def test_a_geodesic_that_turns_back_is_invalid(plain, tmp_path):
    own = text(alpha='"geodesic 60 deg"', bulge="0").replace('[-0.1, "20 %"]', "[0.5]")
    assert (make(tmp_path / "atlas.nc", parse(own), threads=1)["status"] == fs.status.INVALID).all()


def test_the_time_of_bodies_is_told_before_they_are_solved(tmp_path):
    own = text().replace('[-0.1, "20 %"]', "{start = 0, stop = 0.3, num = 5000}\nbeta = [-50, -45]")
    told = dry_run(parse(own.replace("beta = -45\n", "", 1)), tmp_path / "atlas.nc", threads=1)
    assert "20,000 grid points, 30,000 distinct equilibria of 10,000 distinct problems" in told
    assert "time: about 115 seconds on 1 thread" in told  # 90 s, and 25 s for what it measures


@pytest.mark.long
def test_axes_of_bodies_grow_until_answers_between_them_are_exact(monkeypatch):
    monkeypatch.setattr(refine_axes, "DESIGNS", 25)  # each of which is solved by itself, and at six nodes
    own = text(bulge="0", more="[solver]\ninterpolation_tolerance = 1e-3")
    own = own.replace('["30 kPa", "60 kPa"]', '{start = "30 kPa", stop = "60 kPa", num = 4}')
    assert len(refine_axes.graded(parse(own)).axes["taper"]) > 2


@pytest.mark.long
def test_held_physical_bodies_with_worded_angles_are_the_single_ones(tmp_path):
    words = '"geodesic 20 deg"', '"geodesic -45 deg"', '"constant volume 1 mm"'
    own = text(*words, more="[solver]\nblocked = true")
    data = make(tmp_path / "atlas.nc", parse(own.replace("c01", 'model = "physical"\nc01')))
    tube = fs.Actuator(
        alpha="geodesic 20 deg", beta="geodesic -45 deg", wall="constant volume 1 mm", length=0.06, radius="6 mm",
        taper=0.2, bulge=0.15, material=RUBBER, model="physical",
    )  # fmt: skip
    point, single = data.sel(taper=0.2, pressure=6e4), fs.inflate(tube, 6e4, x=0.0)
    for name in OUTPUTS:
        near(point, name, single)
    for name, held in (("force", fs.blocked_force), ("torque", fs.blocked_torque)):
        one = held(tube, 6e4, x=0.0)
        assert point[f"blocked_{name}_status"] == one["status"]
        bound = point[f"blocked_{name}_error"] + one[f"{name}_error"]
        assert abs(point[f"blocked_{name}"] - one[name]) <= bound

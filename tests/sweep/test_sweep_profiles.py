"""Profiles along the tube in a specification: every point is the single actuator of that profile."""

import numpy as np
import pytest
from grids import make

import freesweep as fs
from freesweep.status import HELD_IMPOSSIBLE, INVALID, OK, VALUED
from freesweep.sweep.plan import plan
from freesweep.sweep.spec import SpecificationError, parse

ANGLE = [(0.0, 20.0), (0.5, 30.0), (0.5, 40.0), (1.0, 35.0)]
WALL = [(0.0, 1.2e-3), (0.6, 1.2e-3), (0.6, 2.4e-3), (1.0, 2.4e-3)]
TEXT = """
[actuator]
alpha = [[0, "20 deg"], ["50 %", 30], [0.5, 40], [1, 35]]
wall = [[0, "1.2 mm"], [0.6, "1.2 mm"], [0.6, "2.4 mm"], [1, "2.4 mm"]]
c10 = "0.17 MPa"
c01 = "0.08 MPa"
[axes]
beta = [-50, -20, 15, 34.8]
length = ["60 mm", "80 mm"]
radius = ["4.76 mm", "6 mm"]
torque = [0, 4e-3]
held_rotation = [0, "4 deg"]
pressure = ["80 kPa", "160 kPa"]
[load]
held_length_ratio = 0.98
"""
OUTPUTS = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    return make(tmp_path_factory.mktemp("profiles") / "atlas.nc", parse(TEXT))


def tube_of(point, **given):
    numbers = (
        {name: point[name].item() for name in ("beta", "length", "radius")} | {"alpha": ANGLE, "wall": WALL} | given
    )
    return fs.Actuator(**numbers, material=fs.MooneyRivlin(c10=0.17e6, c01=0.08e6))


def near(point, name, single):
    bound = point[f"{name}_error"].item() + single[1] + 1e-12 * abs(single[0])
    assert abs(point[name].item() - single[0]) <= bound, name


def test_points_equal_single_actuators(data):
    draw = np.random.default_rng(2)
    compared = 0
    for _ in range(12):
        point = data.isel({name: draw.integers(size) for name, size in data.sizes.items()})
        if point["beta"] > 30.0:
            continue
        tube, pressure, torque = tube_of(point), point["pressure"].item(), point["torque"].item()
        held = 0.98 * tube.length
        free = fs.inflate(tube, pressure, 0.0, torque, x=0.0)
        force = fs.blocked_force(tube, pressure, held, torque, x=0.0)
        turned = fs.blocked_torque(tube, pressure, point["held_rotation"].item(), x=0.0)
        assert point["status"] == free["status"]
        assert point["slack_fiber"] == free["slack_fiber"]
        for name in OUTPUTS if free["status"] == OK else ():
            near(point, name, (free[name].item(), free[f"{name}_error"].item()))
            compared += 1
        locked = fs.lock(tube, x=0.0)
        for name in OUTPUTS:
            near(point, f"locked_{name}", (locked[name].item(), locked[f"{name}_error"].item()))
        for name, single in (("force", force), ("torque", turned)):
            assert point[f"blocked_{name}_status"] == single["status"]
            if single["status"].item() in VALUED:
                near(point, f"blocked_{name}", (single[name].item(), single[f"{name}_error"].item()))
                assert point[f"blocked_{name}_stable"] == single["stable"]
                compared += 1
    assert compared > 30


def test_families_that_come_too_close_somewhere_are_invalid(data):
    assert (data["status"].sel(beta=34.8) == INVALID).all()
    assert (data["status"].sel(beta=[-50.0, -20.0, 15.0]) != INVALID).all()


def test_what_varies_along_the_tube_is_no_coordinate_and_no_closed_form(data):
    assert not {"alpha", "wall"} & set(data.coords)
    assert data.attrs["profile_alpha"].tolist() == np.ravel(ANGLE).tolist()
    assert not [name for name in data if name.startswith("ideal_")]


def test_a_wall_alone_leaves_the_closed_forms_of_its_angles(tmp_path):
    text = TEXT.replace('alpha = [[0, "20 deg"], ["50 %", 30], [0.5, 40], [1, 35]]', "alpha = 30")
    text = text.replace("[-50, -20, 15, 34.8]", "[-30]").replace("[0, 4e-3]", "[0]").replace('"4.76 mm", ', "")
    data = make(tmp_path / "atlas.nc", parse(text))
    ideal = fs.closed_form.blocked_force(30.0, -30.0, 6e-3, data["pressure"].values)
    assert data["ideal_blocked_force"].squeeze().values == pytest.approx(ideal)
    assert (data["blocked_torque_status"] == HELD_IMPOSSIBLE).all()  # nothing turns
    tube = tube_of(data.isel(beta=0, length=0, radius=0), alpha=30.0)
    single = fs.inflate(tube, 160e3, x=0.0)
    near(data.sel(pressure=160e3, length=0.06).squeeze(), "deformed_length", (single["deformed_length"].item(), 1e-9))


def test_scaled_tubes_of_one_profile_are_solved_once():
    text = """
[actuator]
alpha = [[0, 0], [1, 40]]
beta = [[0, -30], [1, -60]]
[axes]
pressure = ["50 kPa"]
[[designs]]
name = "small"
length = "50 mm"
radius = "5 mm"
wall = "1 mm"
c10 = "0.1 MPa"
[[designs]]
name = "large"
length = "100 mm"
radius = "10 mm"
wall = "2 mm"
c10 = "0.1 MPa"
[[designs]]
name = "thick"
length = "50 mm"
radius = "5 mm"
wall = "2 mm"
c10 = "0.1 MPa"
"""
    assert plan(parse(text))["free"].problem.tolist() == [0, 0, 1]


PLAIN = """
[actuator]
alpha = {alpha}
beta = {beta}
length = 0.1
radius = 5e-3
wall = {wall}
c10 = 1e5
[load]
pressure = 1e5
"""


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"alpha": "[[0, 10], [1, 95]]"}, "actuator.alpha[1][1]: found 95"),
        ({"alpha": "[[0, 10], [0.9, 20]]"}, "actuator.alpha: x/l has to rise from 0 to 1"),
        ({"alpha": "[[0, 10], [0.5, 20, 3], [1, 2]]"}, "actuator.alpha: found a list"),
        ({"alpha": "[10, 20]"}, "several values belong in [axes]"),
        ({"alpha": '[["5 mm", 10], [1, 20]]'}, "actuator.alpha[0][0]: expects a number"),
        ({"wall": "[[0, 1e-3], [1, 0]]"}, "actuator.wall[1][1]: found 0"),
        ({"alpha": "[[0, 10], [1, -50]]"}, "the fiber families cross"),
        ({"alpha": str([[k / 80, 10 + k % 2] for k in range(81)])}, "at most 64 pairs"),
        ({"wall": "1e-3\nradius_profile = 1"}, "unknown key"),
    ],
)
def test_faults_of_profiles_are_named(given, says):
    text = PLAIN.format(**({"alpha": 20, "beta": -20, "wall": 1e-3} | given))
    with pytest.raises(SpecificationError) as caught:
        parse(text)
    assert any(says in fault for fault in caught.value.faults), caught.value.faults


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[axes]\nalpha = [[0, 10], [1, 20]]", "axes.alpha"),
        ("[axes]\nlength = [0.1]\nalpha = [10, 20]", "given twice"),
        ('[[designs]]\nname = "a"\nalpha = 10', "actuator.alpha is a profile already"),
    ],
)
def test_a_profile_stands_in_the_actuator_alone(text, says):
    head = PLAIN.format(alpha="[[0, 10], [1, 20]]", beta=-20, wall=1e-3).replace("length = 0.1\n", "")
    with pytest.raises(SpecificationError) as caught:
        parse(head + text)
    assert any(says in fault for fault in caught.value.faults), caught.value.faults

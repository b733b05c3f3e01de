"""Held lengths and rotations as parameters of a sweep: the states of single actuators, whatever symmetry they came by."""

import numpy as np
import pytest
from grids import FIXED, make, spec

import freesweep as fs
from freesweep.status import COMPRESSED, DEGENERATE, HELD_IMPOSSIBLE, OK, VALUED
from freesweep.sweep.plan import plan
from freesweep.sweep.spec import SpecificationError, parse

AXES = {
    "alpha": [-20.0, 0.0, 30.0],
    "beta": [-40.0, -30.0, 20.0],
    "length": [0.1, 0.15],
    "fiber_extension": [1.0, 1.005],
    "force": [0.0, 3.0],
    "torque": [-4e-3, 0.0],
    "held_length_ratio": [0.96, 1.0, 1.01],
    "held_rotation": [-8.0, 0.0, 5.0],
    "pressure": [1e5, 2e5],
}
DIMENSIONS = {
    "blocked_force": tuple(name for name in AXES if name not in ("force", "held_rotation")),
    "blocked_torque": tuple(name for name in AXES if name not in ("torque", "held_length_ratio")),
}


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    return make(tmp_path_factory.mktemp("held") / "atlas.nc", parse(spec(AXES)))


@pytest.fixture(scope="module")
def rest(tmp_path_factory):
    """Of one pair of angles, without pressure: each such state is found alone, the dear way."""
    axes = {name: AXES[name] for name in ("length", "fiber_extension", "held_length_ratio", "held_rotation")}
    text = spec(axes | {"pressure": [0.0]}, fixed={"alpha": -20.0, "beta": -40.0})
    return make(tmp_path_factory.mktemp("rest") / "atlas.nc", parse(text))


def alone(point, name):
    """The same state of one actuator."""
    numbers = {key: point[key].item() for key in ("alpha", "beta", "length", "fiber_extension")}
    material = fs.MooneyRivlin(FIXED["c10"], FIXED["c01"])
    tube = fs.Actuator(radius=FIXED["radius"], wall=FIXED["wall"], material=material, **numbers)
    if name == "blocked_force":
        held = point["held_length_ratio"].item() * tube.length
        return fs.blocked_force(tube, point["pressure"].item(), held, point["torque"].item(), x=0.0)
    return fs.blocked_torque(
        tube, point["pressure"].item(), point["held_rotation"].item(), point["force"].item(), x=0.0
    )


@pytest.mark.parametrize("name", ["blocked_force", "blocked_torque"])
def test_a_held_point_is_the_single_actuator(data, name):
    assert data[name].dims == data[f"{name}_status"].dims == data[f"{name}_stable"].dims == DIMENSIONS[name]
    draw = np.random.default_rng(7)
    solved = np.argwhere(data[f"{name}_status"].isin(VALUED).values)
    anywhere = np.argwhere(data[name].isnull().values)
    valued = 0
    for index in [*draw.permutation(solved)[:40], *draw.permutation(anywhere)[:10]]:
        point = data.isel(dict(zip(data[name].dims, index)))
        if point["alpha"] == -point["beta"]:
            continue
        single = alone(point, name)
        assert point[f"{name}_status"] == single["status"]
        if single["status"].item() in VALUED:
            unknown = name.removeprefix("blocked_")
            bound = point[f"{name}_error"] + single[f"{unknown}_error"] + 1e-12 * abs(single[unknown])
            assert abs(point[name] - single[unknown]) <= bound
            assert point[f"{name}_stable"] == single["stable"]
            valued += 1
    assert valued > 15


def test_a_stroke_curve_falls_and_a_rotation_curve_turns_the_free_state_back(data):
    muscle = data["blocked_force"].sel(alpha=30.0, beta=-30.0, fiber_extension=1.0, torque=0.0, pressure=1e5)
    assert (muscle.diff("held_length_ratio") > 0.0).all()  # the shorter, the weaker
    assert muscle.sel(held_length_ratio=1.0, length=0.1) == pytest.approx(
        np.pi * FIXED["radius"] ** 2 * 1e5 * (2.0 / np.tan(np.radians(30.0)) ** 2 - 1.0), rel=1e-9
    )
    screw = data["blocked_torque"].sel(alpha=-20.0, beta=-40.0, force=0.0, pressure=1e5)
    assert (screw.diff("held_rotation") > 0.0).all()


def test_poles_stay_poles_and_rest_needs_no_pressure(data, rest):
    force, torque = data["blocked_force_status"], data["blocked_torque_status"]
    assert (torque.sel(alpha=30.0, beta=-30.0, pressure=1e5) == HELD_IMPOSSIBLE).all()
    straight = force.sel(alpha=0.0, fiber_extension=1.0, held_length_ratio=1.0, pressure=1e5)
    assert (straight == HELD_IMPOSSIBLE).all()
    assert (rest["blocked_force_status"].sel(held_length_ratio=0.96) == COMPRESSED).all()
    assert (rest["blocked_force_status"].sel(held_length_ratio=1.01) == OK).all()  # it stretches without pressure
    assert (rest["blocked_torque_status"].sel(held_rotation=[-8.0, 5.0]) == COMPRESSED).all()
    for name, held, at_rest in (("force", "held_length_ratio", 1.0), ("torque", "held_rotation", 0.0)):
        codes = rest[f"blocked_{name}_status"]
        assert (codes.sel({held: at_rest}) == OK).all()
        assert (rest[f"blocked_{name}"].sel({held: at_rest}) == 0.0).all()
        for made in (data, rest):
            missing = ~made[f"blocked_{name}_status"].isin(VALUED)
            assert np.array_equal(made[f"blocked_{name}"].isnull(), missing)
            assert np.array_equal(made[f"blocked_{name}_error"].isnull(), missing)


def test_absolute_lengths_of_designs_of_several_lengths(tmp_path):
    axes = {"length": [0.1, 0.12], "held_length": [0.095, 0.114], "pressure": [2.5e5]}
    ratio = axes | {"held_length_ratio": [0.95]}
    del ratio["held_length"]
    fixed = {"alpha": 30.0, "beta": -30.0}
    absolute = make(tmp_path / "absolute.nc", parse(spec(axes, fixed=fixed)))
    relative = make(tmp_path / "relative.nc", parse(spec(ratio, fixed=fixed)))
    assert "blocked_torque" not in absolute
    for k in range(2):
        first, second = absolute["blocked_force"][k, k].item(), relative["blocked_force"][k, 0].item()
        assert first == pytest.approx(second, rel=1e-11)
    assert absolute["blocked_force"][1, 0].item() < absolute["blocked_force"][0, 0].item()  # 0.12 to 0.095 is more


def test_exchanged_and_mirrored_designs_share_their_held_states():
    angles = [-40.0, -20.0, 20.0, 40.0]
    held = [-10.0, 0.0, 10.0]
    axes = {"alpha": angles, "beta": angles, "held_rotation": held, "held_length_ratio": [0.95, 1.0], "pressure": [1e5]}
    tables = plan(parse(spec(axes)))
    # 20/40 and 20/-40 with three rotations each; of McKibben muscles 20/-20 and 40/-40 the sign does not count
    assert tables["blocked_torque"].count == 2 * 3 + 2 * 2
    assert tables["blocked_force"].count == 4 * 2
    assert tables["free"].count == 4
    assert (tables["blocked_torque"].reduced(np.arange(3)).status == DEGENERATE).all()


def test_a_mirrored_torque_has_the_other_sign(data, tmp_path):
    axes = {"held_rotation": [-5.0, 0.0, 8.0], "pressure": [1e5]}
    mirror = make(tmp_path / "mirror.nc", parse(spec(axes, fixed={"alpha": 20.0, "beta": 40.0, "length": 0.1})))
    own = data["blocked_torque"].sel(alpha=-20.0, beta=-40.0, length=0.1, fiber_extension=1.0, force=0.0, pressure=1e5)
    assert np.array_equal(mirror["blocked_torque"].values[::-1, 0], -own.values)


def test_the_map_of_blocked_torque_turns_its_sign_in_the_mirror(data):
    from freesweep.plot.plane import plane

    point = {"length": 0.1, "fiber_extension": 1.0, "force": 0.0, "pressure": 1e5}
    own = data["blocked_torque"].sel(point | {"alpha": -20.0, "beta": -40.0, "held_rotation": 0.0}).item()
    quadrant = data.sel(alpha=[-20.0, 0.0], beta=[-40.0, -30.0])  # the other one is its mirror
    sheet = plane(quadrant, "blocked_torque", point)
    assert own != 0.0
    assert sheet.values[sheet.y.tolist().index(40.0), sheet.x.tolist().index(20.0)] == -own
    with pytest.raises(ValueError, match="fewer than two nodes"):  # the mirror would hold the other rotation
        plane(quadrant, "blocked_torque", point | {"held_rotation": -8.0})


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ("held_length = [0.1]\nheld_length_ratio = [1]", "the held length is given twice"),
        ("held_length = [0.0]", "axes.held_length[0]: found 0"),
        ('held_length_ratio = ["95 mm"]', "axes.held_length_ratio[0]: expects a number without unit"),
        ("held_rotation = [0]\n[solver]\nblocked = false", "found false, but axes.held_rotation is given"),
        ("held_rotatoin = [0]", "did you mean 'held_rotation'"),
    ],
)
def test_faults_of_held_quantities_are_named(lines, says):
    with pytest.raises(SpecificationError) as caught:
        parse(spec({"pressure": [1e5]}, fixed={"alpha": 30, "beta": -30}) + "\n" + lines)
    assert any(says in fault for fault in caught.value.faults), caught.value.faults


def test_held_quantities_carry_units_and_may_be_single():
    text = spec({"pressure": [1e5], "held_rotation": ["-0.5 rad", "30 deg"]}, fixed={"alpha": 30, "beta": -20})
    sweep = parse(text.replace("[axes]", '[load]\nheld_length = "95 mm"\n[axes]').replace("'", '"'))
    assert sweep.blocked == ("blocked_force", "blocked_torque")
    assert sweep.fixed["held_length"] == 0.095
    assert sweep.axes["held_rotation"] == pytest.approx([-28.64788975654116, 30.0])
    assert "held_length_ratio" not in sweep.fixed
    assert parse(text.replace("'", '"')).blocked == ("blocked_torque",)

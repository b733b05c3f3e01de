"""What an atlas answers between its nodes: held against exact solutions, symmetries, closed forms; never a wrong number."""

import numpy as np
import pytest
import xarray as xr
from grids import FIXED, spec, swept

from freesweep import Actuator, MooneyRivlin, closed_form, example_atlas, inflate, lock, run_sweep, status
from freesweep.atlas.store import Atlas
from freesweep.query import box
from freesweep.query.faults import QueryError
from freesweep.sweep.spec import parse

AXES = {
    "alpha": [0.0, 10.0, 20.0, 30.0, 40.0, 50.0],
    "beta": [-60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0],
    "length": [0.1, 0.14, 0.2],
    "radius": [4e-3, 5e-3, 6e-3],
    "pressure": [0.0, 2e3, 6e3, 1.2e4, 2e4, 3e4, 4.5e4, 6e4],
}
STATE = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")
POINT = {"alpha": 24.0, "beta": -43.0, "length": 0.12, "radius": 4.5e-3, "pressure": 3.7e4}
RUBBER = MooneyRivlin(FIXED["c10"], FIXED["c01"])


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    with swept(tmp_path_factory.mktemp("query"), AXES) as opened:
        yield opened


def random_points(count, seed=1, **spans):
    draw = np.random.default_rng(seed)
    spans = {name: (values[0], values[-1]) for name, values in AXES.items()} | spans
    return {name: draw.uniform(*span, count) for name, span in spans.items()}


def exact(points, k):
    own = {name: points[name][k] for name in ("alpha", "beta", "length", "radius")}
    tube = Actuator(**own, wall=FIXED["wall"], material=RUBBER)
    return tube, inflate(tube, points["pressure"][k], x=0.0, accuracy=1e-8)


# --- numbers


def test_at_nodes_the_stored_bits_come_back(atlas):
    data = atlas.data
    found = atlas.query(**{name: data[name] for name in AXES})
    for name in found.data_vars:
        if name == "limit_pressure_status" or (name.startswith("ideal") and name.endswith("_error")):
            continue  # made by the query; stored in single precision, rounded up
        stored = data[name].broadcast_like(found[name]).transpose(*found[name].dims)
        assert np.array_equal(found[name].values, stored.values, equal_nan=True), name


def test_answers_between_nodes_are_exact_solutions_within_their_stated_errors(atlas):
    points = random_points(400)
    found = atlas.query(**points, variables=STATE)
    answered = np.flatnonzero(found["status"] == status.OK)
    assert len(answered) > 150
    for k in answered[::2]:
        _, solved = exact(points, k)
        for name in STATE:
            size = abs(solved[name].item())
            error = abs(found[name][k].item() - solved[name].item())
            assert error <= found[f"{name}_error"][k].item() + solved[f"{name}_error"].item(), (name, k)
            assert found[f"{name}_error"][k] <= 1e-3 * max(size, 0.1)
        for flag in ("stable", "slack_fiber"):
            assert found[flag][k] == solved[flag]


def test_the_locked_state_needs_neither_pressure_nor_rubber(atlas):
    axes = {name: POINT[name] for name in ("alpha", "beta", "length", "radius")}
    found = atlas.query(variables=["locked_volume", "locked_rotation"], **axes)
    assert found["locked_status"] == status.OK
    tube = Actuator(**axes, wall=FIXED["wall"], material=RUBBER)
    locked = lock(tube, x=0.0)
    for name in ("volume", "rotation"):
        assert abs(found[f"locked_{name}"] - locked[name]) <= found[f"locked_{name}_error"] + locked[f"{name}_error"]


def test_numbers_stand_exactly_where_the_status_gives_them(atlas):
    found = atlas.query(**random_points(2000, seed=5, alpha=(-60.0, 60.0), beta=(-70.0, 60.0)))
    assert {status.OK, status.NOT_INTERPOLABLE, status.OUTSIDE} <= set(np.unique(found["status"]))
    for name in found.data_vars:
        if name.endswith("_error") or name.startswith(("ideal", "limit")) or name not in atlas.data or "status" in name:
            continue
        if f"{name}_error" in found:
            family = "locked_status" if name.startswith("locked_") else "status"
            valued = found[family].isin(status.VALUED)
            assert (found[name].notnull() == valued).all(), name
            assert (found[f"{name}_error"].notnull() == valued).all(), name


@pytest.mark.parametrize(("turn", "swap"), [(1.0, True), (-1.0, False), (-1.0, True)])
def test_half_the_plane_answers_for_the_rest(atlas, turn, swap):
    points = random_points(200, seed=2)
    images = dict(points)
    first, second = ("beta", "alpha") if swap else ("alpha", "beta")
    images["alpha"], images["beta"] = turn * points[first], turn * points[second]
    mine, theirs = atlas.query(**points, variables=STATE), atlas.query(**images, variables=STATE)
    # another image of the point may lie in the grid, too, and answer
    both = (mine["status"].values == status.OK) & (theirs["status"].values == status.OK)
    outside = (images["alpha"] < 0.0) | (images["beta"] < -60.0) | (images["beta"] > 30.0) | (images["alpha"] > 50.0)
    assert (both & outside).sum() > 30
    for name in STATE:
        sign = turn if name == "rotation" else 1.0
        gap = abs(theirs[name] - sign * mine[name]).values
        assert (gap <= (theirs[f"{name}_error"] + mine[f"{name}_error"]).values)[both].all(), name
    slack = mine["slack_fiber"].values
    slack = np.array([0, 2, 1, 3])[slack] if swap else slack
    np.testing.assert_array_equal(theirs["slack_fiber"].values[both], slack[both])


# --- what is not answered


def test_one_hole_spoils_nothing_beyond_its_neighbours(atlas):
    data = atlas.data.load().copy(deep=True)
    hole = {"alpha": 3, "beta": 3, "length": 1, "radius": 1, "pressure": 5}
    for name in ("status", *STATE):
        data[name][hole] = status.NOT_CONVERGED if name == "status" else np.nan
    holed = Atlas(data, atlas.path)
    points = random_points(3000, seed=3, alpha=(12.0, 48.0), beta=(-48.0, -12.0), pressure=(1.2e4, 6e4))
    before, after = atlas.query(**points, variables=STATE), holed.query(**points, variables=STATE)
    beside = np.ones(3000, bool)
    for name, k in hole.items():
        nodes = AXES[name]
        beside &= (points[name] > nodes[k - 1]) & (points[name] < nodes[min(k + 1, len(nodes) - 1)])
    assert beside.sum() > 20
    assert (after["status"][beside] == status.NOT_INTERPOLABLE).all()
    good = ~beside & (before["status"].values == status.OK) & (after["status"].values == status.OK)
    assert good.sum() > 0.9 * (~beside & (before["status"].values == status.OK)).sum()
    for name in STATE:
        bound = before[f"{name}_error"].values + after[f"{name}_error"].values
        assert (abs(before[name].values - after[name].values)[good] <= bound[good]).all(), name


def test_rubbish_in_a_file_is_never_a_number(atlas):
    draw, points = np.random.default_rng(3), random_points(300, seed=12)
    nodes = {name: draw.choice(values, 300) for name, values in AXES.items()}
    for _ in range(3):
        data = atlas.data.load().copy(deep=True)
        for name in ("status", "stable", "slack_fiber", *STATE, *(f"{name}_error" for name in STATE)):
            array, some = data[name].values, draw.random(data[name].shape) < 0.3
            rubbish = draw.integers(-128, 128, some.sum()) if array.dtype.kind == "i" else [np.nan, np.inf, -1e30]
            array[some] = rubbish if len(rubbish) == some.sum() else draw.choice(rubbish, some.sum())
        holed = Atlas(data, atlas.path)
        for asked in (points, nodes):
            found = holed.query(**asked, variables=STATE)
            valued = found["status"].isin(status.VALUED)
            for name in STATE:
                assert (np.isfinite(found[name]) == valued).all(), name
                assert (found[f"{name}_error"] >= 0.0)[valued].all(), name


@pytest.mark.parametrize("one_by_one", [True, False])
def test_a_few_points_read_a_part_of_the_grid_and_get_the_same_answer(atlas, monkeypatch, one_by_one):
    monkeypatch.setattr(box, "SMALL", 0)
    monkeypatch.setattr(box, "SPARE", 1)
    monkeypatch.setattr(box, "MARGIN", 3)
    monkeypatch.setattr(box, "WHOLE", 0)
    whole, part = atlas, Atlas(atlas.data, atlas.path)
    points = random_points(12, seed=11, alpha=(-20.0, 20.0), beta=(-55.0, 10.0))
    points["alpha"][0], points["beta"][0], points["pressure"][1] = 0.0, -60.0, 6e4 * (1.0 + 1e-13)
    points["beta"][2], points["radius"][3] = -70.0, np.nan
    asked = [{name: array[k] for name, array in points.items()} for k in range(12)] if one_by_one else [points]
    for one in asked:
        try:
            expected = whole.query(**one, variables=STATE)
        except QueryError as error:
            with pytest.raises(QueryError, match=str(error.faults[0])[:20]):
                part.query(**one, variables=STATE)
            continue
        found = part.query(**one, variables=STATE)
        np.testing.assert_array_equal(found["status"], expected["status"])
        for name in STATE:
            gap = abs(found[name] - expected[name])
            assert not (gap > 1e-3 * expected[f"{name}_error"]).any(), name  # holes are filled from fewer nodes
    made = part._reader._tables["state"]
    assert made.whole is None
    assert not one_by_one or made.read < 0.8 * len(asked) * made.size


def test_one_family_alone_is_never_interpolated(atlas):
    found = atlas.query(
        alpha=[25.0, 25.0, 25.0, 20.0], beta=[25.0, 25.2, 23.0, 20.0], length=0.12, radius=5e-3, pressure=1e4
    )
    expected = [status.DEGENERATE, status.INVALID, status.NOT_INTERPOLABLE, status.DEGENERATE]
    assert found["status"].values.tolist() == expected
    assert found["rotation"].isnull().all()


def test_nothing_is_extrapolated(atlas):
    found = atlas.query(**(POINT | {"pressure": [-1.0, 0.0, 6e4, 6.1e4, np.inf, np.nan]}))
    outside, nan = status.OUTSIDE, status.INVALID
    assert found["status"].values[[0, 3, 4, 5]].tolist() == [outside, outside, outside, nan]
    assert found["deformed_length"].values[1] == pytest.approx(POINT["length"], rel=1e-14)
    with pytest.raises(
        QueryError, match="pressure: found 61 kPa; the atlas holds 0 kPa to 60 kPa, the nearest is 60 kPa"
    ):
        atlas.query(**(POINT | {"pressure": 6.1e4}))
    with pytest.raises(
        QueryError, match=r"found 1 bar; the atlas holds 0 bar to 0.6 bar"
    ):  # in the unit of the question
        atlas.query(**(POINT | {"pressure": "1 bar"}))
    with pytest.raises(QueryError, match="alpha, beta: found 80 deg, -80 deg"):
        atlas.query(**(POINT | {"alpha": 80.0, "beta": -80.0}))


def test_refining_answers_all_by_exact_solution(atlas):
    points = random_points(120, seed=4)
    plain, refined = atlas.query(**points), atlas.query(**points, refine=True)
    open_points = np.flatnonzero(plain["status"] == status.NOT_INTERPOLABLE)
    assert len(open_points) > 10
    assert not (refined["status"] == status.NOT_INTERPOLABLE).any()
    kept = plain["status"].values == status.OK
    np.testing.assert_array_equal(refined["rotation"].values[kept], plain["rotation"].values[kept])
    for k in open_points[:8]:
        if abs(points["alpha"][k] - points["beta"][k]) < 0.5:
            assert refined["status"][k] == status.INVALID
            continue
        tube, solved = exact(points, k)
        locked = lock(tube, x=0.0)
        for name in STATE:
            bound = refined[f"{name}_error"][k] + solved[f"{name}_error"] + 1e-12 * abs(solved[name])
            assert abs(refined[name][k] - solved[name]) <= bound, name
        assert abs(refined["locked_volume"][k] - locked["volume"]) <= 2e-6 * locked["volume"]
        assert refined["slack_fiber"][k] == solved["slack_fiber"]


def test_profiles_are_solved_on_request(atlas):
    x = [0.0, 0.03, 0.06]
    found = atlas.query(**POINT, variables="rotation", refine=True, x=x)
    axes = {name: POINT[name] for name in ("alpha", "beta", "length", "radius")}
    solved = inflate(Actuator(**axes, wall=FIXED["wall"], material=RUBBER), POINT["pressure"], x=x)
    for name in ("deformed_radius", "twist", "twist_error", "fiber_tension_alpha", "fiber_tension_alpha_error"):
        np.testing.assert_array_equal(found[name].values, solved[name].values)


# --- held states, other atlases


def test_blocked_force_and_torque_follow_their_poles(tmp_path):
    axes = {
        "alpha": [5.0, 12.0, 19.0, 26.0, 33.0],
        "beta": [-61.0, -54.0, -47.0, -40.0],
        "fiber_extension": [1.0, 1.005],
        "pressure": [4e4, 6e4, 8e4, 1e5],
    }
    text = spec(axes) + "\n[solver]\nblocked = true"
    with run_sweep(parse(text), tmp_path / "held.nc", threads=2, progress=False) as opened:
        held = Atlas(opened.data.assign_attrs(interpolation_tolerance=1.0), opened.path)
        at = {"alpha": np.array([6.0, 15.0, 30.0]), "beta": -50.0, "pressure": 7e4}
        found = held.query(**at, fiber_extension=1.0)
        ideal = closed_form.blocked_force(at["alpha"], -50.0, FIXED["radius"], 7e4)
        np.testing.assert_allclose(found["blocked_force"], ideal, rtol=1e-7)
        np.testing.assert_allclose(found["ideal_blocked_force"], ideal, rtol=1e-12)
        turning = found["blocked_torque_status"] == status.OK
        torque = closed_form.blocked_torque(at["alpha"], -50.0, FIXED["radius"], 7e4)
        np.testing.assert_allclose(found["blocked_torque"][turning], torque[turning], rtol=1e-7)
        both = held.query(**at, fiber_extension=1.005), held.query(**at, fiber_extension=1.005, refine=True)
        assert (both[1]["blocked_force_status"] == status.OK).all()
        answered = both[0]["blocked_force_status"] == status.OK
        gap = abs(both[0]["blocked_force"] - both[1]["blocked_force"])[answered]
        bound = (both[0]["blocked_force_error"] + both[1]["blocked_force_error"])[answered]
        assert answered.any()
        assert (gap <= bound).all()


def test_named_designs_are_asked_by_name(tmp_path):
    designs = [{"name": "A", "alpha": 10, "beta": 50}, {"name": "B", "alpha": 0, "beta": 30}]
    axes = {"pressure": [0.0, 5e3, 1e4, 1.5e4, 2e4, 2.5e4, 3e4]}
    with swept(tmp_path, axes, designs=designs) as named:
        found = named.query(design=["A", "B"], pressure=1.7e4, variables=["rotation"])
        tube = Actuator(alpha=0, beta=30, **{k: FIXED[k] for k in ("length", "radius", "wall")}, material=RUBBER)
        solved = inflate(tube, 1.7e4, x=0.0)
        assert found["design"].values.tolist() == ["A", "B"]
        assert abs(found["rotation"][1] - solved["rotation"]) <= found["rotation_error"][1]
        with pytest.raises(QueryError, match="design 'C' is unknown here"):
            named.query(design="C", pressure=1e4)
        with pytest.raises(QueryError, match="alpha: each design has its own"):
            named.query(design="A", alpha=10, pressure=1e4)


def test_that_there_is_no_limit_pressure_is_an_answer_and_blames_no_axis(atlas):
    found = atlas.query("limit_pressure", **{name: value for name, value in POINT.items() if name != "pressure"})
    assert np.isnan(found["limit_pressure"])
    assert int(found["limit_pressure_status"]) == status.OK
    assert "too_coarse" not in found.attrs


def test_limit_pressures_are_told_only_within_their_region(tmp_path):
    axes = {"alpha": [58.0, 59.0, 60.0, 61.0], "beta": [53.0, 54.0, 55.0], "pressure": [0.0, 1e5, 2e5, 2.5e5]}
    with swept(tmp_path, axes, energy="principal", fixed={"length": 0.1904, "c01": 0.085e6}) as folded:
        found = folded.query(alpha=59.5, beta=54.5, pressure=1e5, refine=True)
        assert found["limit_found"] == 1
        near = folded.data["limit_pressure"].sel(alpha=slice(59, 60), beta=slice(54, 55))
        assert near.min() < found["limit_pressure"] < near.max()
        beyond = folded.query(alpha=59.5, beta=54.5, pressure=2.4e5)
        assert beyond["status"] == status.NOT_INTERPOLABLE
        assert folded.query(alpha=59.5, beta=54.5, pressure=2.4e5, refine=True)["status"] == status.BEYOND_LIMIT


# --- the interface


def test_arrays_broadcast_as_in_numpy_and_data_arrays_by_name(atlas):
    fixed = {name: POINT[name] for name in ("length", "radius")}
    curve = atlas.query(**(POINT | {"pressure": [1e4, 2e4]}), variables="rotation")
    assert curve["rotation"].dims == ("pressure",)
    pairs = atlas.query(alpha=[20.0, 25.0], beta=[-40.0, -45.0], pressure=2e4, variables="rotation", **fixed)
    assert pairs["rotation"].dims == ("point",)
    assert pairs["alpha"].dims == ("point",)
    alpha = xr.DataArray([20.0, 25.0], dims="a", coords={"a": [1, 2]})
    beta = xr.DataArray([-40.0, -45.0, -50.0], dims="b")
    table = atlas.query(alpha=alpha, beta=beta, pressure=2e4, variables="rotation", **fixed)
    assert dict(table.sizes) == {"a": 2, "b": 3}
    assert table["a"].values.tolist() == [1, 2]
    assert table["rotation"][1, 1] == pairs["rotation"][1]
    assert table["rotation"].attrs["units"] == "degree"
    outer = atlas.query(
        alpha=np.array([[20.0], [25.0]]), beta=[-40.0, -45.0], pressure=2e4, variables="rotation", **fixed
    )
    assert outer["rotation"].dims == ("point_0", "point_1")
    assert outer["rotation"][1, 1] == pairs["rotation"][1]


def test_linear_answers_lie_between_their_nodes_and_know_their_error(atlas):
    nodes = atlas.data["deformed_length"].sel(alpha=20.0, beta=-40.0, length=0.1, radius=5e-3)
    at = {"alpha": 20.0, "beta": -40.0, "length": 0.1, "radius": 5e-3, "pressure": 3.7e4}
    loose = Atlas(atlas.data.assign_attrs(interpolation_tolerance=1.0), atlas.path)
    linear = loose.query(**at, method="linear", variables="deformed_length")
    assert nodes[6] < linear["deformed_length"] < nodes[5]
    cubic = loose.query(**at, variables="deformed_length")
    assert abs(linear["deformed_length"] - cubic["deformed_length"]) <= linear["deformed_length_error"]


JUNK = [
    "25 deg", None, True, 1j, {"a": 1}, [[1.0], [2.0, 3.0]], object(), b"1", np.array(["x"]), [None], "", range(2),
    np.datetime64("2020"), float("nan"), float("inf"), -1e300, 1e300, [1.0, float("nan")], np.zeros(0), np.zeros((2, 0)),
    10**400, [1e308, -1e308], np.ma.masked, xr.Dataset(), np.float32(20.0), np.arange(3),
    xr.DataArray([1.0, 2.0, 3.0], dims="alpha"),
]  # fmt: skip


def test_junk_is_refused_or_answered_by_a_status(atlas):
    draw = np.random.default_rng(9)
    refused = 0
    for _ in range(400):
        asked = dict(POINT)
        for name in draw.choice([*AXES, "wall", "gamma", "design"], draw.integers(1, 4)):
            asked[str(name)] = JUNK[draw.integers(len(JUNK))]
        if draw.random() < 0.2:
            del asked[str(draw.choice(list(asked)))]
        try:
            found = atlas.query(**asked, variables=["rotation"], refine=bool(draw.random() < 0.1))
        except QueryError:
            refused += 1
            continue
        inside = np.ones(found["rotation"].shape, bool)
        for name, nodes in AXES.items():
            if name not in ("alpha", "beta"):
                given = found[name].broadcast_like(found["rotation"]).transpose(*found["rotation"].dims).values
                inside &= (given >= nodes[0]) & (given <= nodes[-1])
        assert not np.isfinite(found["rotation"].values[~inside]).any()
    assert 200 < refused < 400


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"presure": 1.0}, "axis 'presure' is unknown here; did you mean 'pressure'"),
        ({"rotation": 90}, "rotation: it is what a design does.*freesweep.design finds those that do it"),
        ({"alpha": "25 mm"}, "alpha: expects an angle such as '30 deg', got '25 mm', a length"),
        ({"wall": 1e-3}, "wall: found 1 mm; the atlas holds only 1.59 mm"),
        ({"alpha": [1.0, 2.0], "beta": [1.0, 2.0, 3.0]}, "do not broadcast"),
        ({"variables": "rotatoin"}, "did you mean 'rotation'"),
        ({"method": "quintic"}, "method: found str 'quintic'; choose one of 'cubic', 'linear'"),
        ({"x": [0.0]}, "refine=True"),
        ({"alpha": np.zeros((10**4, 1, 1)), "beta": np.zeros((10**4, 1)), "length": np.zeros(10**4)}, "ask in parts"),
    ],
)
def test_faults_say_what_to_do(atlas, change, says):
    with pytest.raises(QueryError, match=says):
        atlas.query(**(POINT | change))


def test_all_faults_come_at_once(atlas):
    with pytest.raises(QueryError) as caught:
        atlas.query(alpha="a", beta=-40.0, length=0.12, presure=3.0)
    assert len(caught.value.faults) == 4  # text, unknown axis, radius and pressure missing


def test_interpolators_give_the_same_numbers_and_their_gradients(atlas):
    f = atlas.interpolator(["rotation", "volume", "locked_deformed_length"])
    assert f.axes == tuple(AXES)
    points = random_points(60, seed=8, alpha=(-50.0, 50.0), beta=(-55.0, 55.0), pressure=(1e3, 5e4))
    found = atlas.query(**points, variables=["rotation", "volume", "locked_deformed_length"])
    values, slopes = f(*points.values(), gradient=True)
    for k, name in enumerate(f.names):
        np.testing.assert_array_equal(values[k], found[name].values)
    for a, name in enumerate(f.axes):
        step = 1e-5 * max(map(abs, AXES[name]))
        ends = [f(*(points | {name: points[name] + sign * step}).values()) for sign in (-1.0, 1.0)]
        numeric = (ends[1] - ends[0]) / (2.0 * step)
        both = np.isfinite(numeric) & np.isfinite(slopes[:, a])
        assert both.sum() > 50
        scale = np.nanmax(abs(slopes[:, a]), axis=1, keepdims=True) + 1e-30
        assert (abs(numeric - slopes[:, a]) / scale)[both].max() < 2e-4, name
    single = atlas.interpolator("rotation")
    assert single(*POINT.values()) == atlas.query(**POINT, variables="rotation")["rotation"]
    with pytest.raises(QueryError, match="found 2 values; give 5"):
        single(1.0, 2.0)


def test_a_locked_energy_that_varies_in_the_wall_is_answered_beside_what_does_not(tmp_path):
    """Of a family the fullest variable tells the axes."""
    import freesweep as fs

    atlas = fs.sweep(
        alpha=np.arange(20.0, 31.0), beta=np.arange(-50.0, -39.0), length=0.15, radius=5e-3, out=tmp_path / "walls.nc",
        wall=[1e-3, 1.25e-3, 1.5e-3, 1.75e-3, 2e-3], c10=[1e5, 1.5e5, 2e5, 2.5e5], c01=5e4, pressure=[0.0, 1e5],
        progress=False,
    )  # fmt: skip
    names = ["locked_strain_energy", "locked_rotation"]
    answer = atlas.query(names, alpha=24.5, beta=-44.5, wall=1.3e-3, c10=1.3e5)
    rubber = fs.MooneyRivlin(1.3e5, 5e4)
    tube = fs.Actuator(alpha=24.5, beta=-44.5, length=0.15, radius=5e-3, wall=1.3e-3, material=rubber)
    exact = fs.lock(tube)
    assert answer["locked_status"] == 0
    for name in names:
        missed = abs(float(answer[name] - exact[name.removeprefix("locked_")]))
        assert missed <= float(answer[f"{name}_error"]), name
    assert float(atlas.query(names[:1], alpha=24.5, beta=-44.5, wall=1.3e-3, c10=1.3e5)[names[0]]) == float(
        answer[names[0]]
    )


def test_pictures_take_for_taut_where_it_is_too_close_to_say_whether_fibers_are_slack():
    with example_atlas() as atlas:
        reader = atlas._reader
        draw, size = np.random.default_rng(5), 20_000
        values = {name: draw.uniform(*reader.frame.ranges[name], size) for name in reader.needed(["rotation"])}
        sure, drawn = (reader.answer(values, size, ["rotation"], tolerance=1e9, sure=one) for one in (True, False))
    told = (sure["status"] == status.NOT_INTERPOLABLE) & (drawn["status"] == status.OK)
    assert 5 < told.sum() < 0.02 * size
    assert np.all(drawn["slack_fiber"][told] == 0)
    assert np.all(np.isfinite(drawn["rotation"][told]))
    for name in sure:
        np.testing.assert_array_equal(sure[name][~told], drawn[name][~told])

"""Atlases of physical tubes between their nodes: the uniform tube behind them, and answers where fibers go slack."""

import numpy as np
import pytest
from grids import make, spec

from freesweep import Actuator, Atlas, MooneyRivlin, inflate, status
from freesweep.closed_form import uniform_state
from freesweep.description.tube_model import MODELS, TubeModel
from freesweep.query import reference
from freesweep.query.cells import DOUBT
from freesweep.query.exact import Tubes, solve
from freesweep.query.family import TOLD
from freesweep.query.missing_nodes import fill
from freesweep.query.predictor import Predictor
from freesweep.query.refine import as_points, exact_answers
from freesweep.query.slack import UNKNOWN
from freesweep.query.spline import NODE
from freesweep.sweep.spec import parse

PHYSICAL = MODELS["physical"]
BONDED = PHYSICAL._replace(fibers="bonded")


def points(count, seed=5, **fixed):
    """Random designs with fibers at the outer radius (count, 15), [m], [Pa], [degree]."""
    draw, made = np.random.default_rng(seed), np.zeros((count, len(reference.COLUMNS)))
    spans = {"alpha": (0, 80), "beta": (-80, 80), "length": (0.08, 0.4), "radius": (3e-3, 8e-3), "pressure": (0, 2e5)}
    for name, span in spans.items():
        made[:, reference.COLUMNS.index(name)] = draw.uniform(*span, count)
    for name, value in {"wall": 1.59e-3, "fiber_extension": 1.0, "c10": 0.17e6, "c01": 0.08e6, **fixed}.items():
        made[:, reference.COLUMNS.index(name)] = value
    made[:, reference.FIBERS] = made[:, reference.RADIUS] + made[:, reference.WALL]
    return made[np.abs(made[:, reference.ALPHA] - made[:, reference.BETA]) > 5.0]


KINDS = [
    (reference.LOADED, {"fiber_extension": 1.003, "force": 0.4}),
    (reference.LOADED, {"c01": 0.0, "c20": 1e4, "c30": 2e3}),
    (reference.LOCKED, {}),
    (reference.LENGTH_HELD, {"held": 0.97, "fiber_extension": 1.002}),
    (reference.ROTATION_HELD, {"held": 4.0}),
]


@pytest.mark.parametrize(("kind", "fixed"), KINDS)
def test_of_bonded_membranes_the_physical_tube_is_the_source_s(kind, fixed):
    here = points(60, **fixed)
    bonded = TubeModel("outer", "membrane", "bonded")
    expected = Predictor(bonded, "full").states(kind, here)
    found = Predictor(bonded, "full").physical(kind, here)
    known = np.isfinite(expected[:, 3])
    assert known.mean() > 0.7
    np.testing.assert_allclose(found[known, :7], expected[known, :7], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found[known, 7], expected[known, 7], rtol=1e-7, atol=1e-9)
    assert np.isnan(found[~known, 3]).all()


def test_the_force_that_holds_a_thick_tube_s_length_stretches_it_to_that_length():
    here = points(60, held=0.98)
    held = Predictor(BONDED, "full").states(reference.LENGTH_HELD, here)
    here[:, reference.FORCE] = held[:, 7] * np.pi * here[:, reference.FIBERS] ** 2 * here[:, reference.C10]
    free = Predictor(BONDED, "full").states(reference.LOADED, here)
    met = np.abs(free[:, 3] - held[:, 3]) < 1e-9  # else another stretch with that force comes first
    assert met.mean() > 0.3
    np.testing.assert_allclose(free[met, 4], 0.98, rtol=1e-9)


@pytest.mark.parametrize("model", [PHYSICAL, BONDED])
def test_far_from_its_ends_a_long_physical_tube_is_uniform(model):
    here = points(24, length=0.8)
    uniform = Predictor(model, "full").states(reference.LOADED, here)
    solved = solve(reference.LOADED, here, Tubes("full", model), 1e-6)
    stretch = solved["mid_radius"] / here[:, reference.FIBERS]
    known = np.isfinite(stretch)
    assert known.mean() > 0.9
    gap = np.abs(np.sqrt(uniform[:, 3]) - stretch)[known]
    assert np.median(gap) < 1e-12
    assert (gap <= 1e-6).mean() > 0.9  # near one fiber family the ends reach into the middle
    if model is PHYSICAL:
        assert {1.0, 3.0} <= set(uniform[known, reference.TAUT])


def test_which_threads_are_slack_follows_from_the_stretch_in_the_middle():
    here = points(60)
    solved = solve(reference.LOADED, here, Tubes("full", PHYSICAL), 1e-6)
    known = np.flatnonzero(np.isfinite(solved["mid_radius"]))
    predictor = Predictor(PHYSICAL, "full")
    states = predictor.states(reference.LOADED, here[known])
    told = predictor.slack_families(here[known], states, solved["mid_radius"][known])
    sure = told != UNKNOWN
    assert sure.mean() > 0.9
    np.testing.assert_array_equal(told[sure], solved["slack_fiber"][known][sure])
    assert len(set(told.tolist())) > 2


@pytest.fixture(scope="module")
def crossed(tmp_path_factory):
    """Pressures of a tube whose threads are slack all along, then in places, then at the ends only."""
    grid = {"alpha": [8.0], "beta": [36.0], "length": [0.131], "pressure": [(32.0 * k) ** 2 for k in range(15)]}
    sweep = parse(spec(grid).replace("[actuator]", '[actuator]\nmodel = "physical"'))
    return make(tmp_path_factory.mktemp("crossed") / "atlas.nc", sweep).assign_attrs(interpolation_tolerance=1e-2)


NAMES = ["deformed_length", "rotation", "mid_radius", "volume", "strain_energy"]


def test_where_fibers_go_slack_between_nodes_answers_keep_their_bounds_or_say_why_not(crossed):
    atlas = Atlas(crossed, "crossed.nc")
    pressure = np.random.default_rng(2).uniform(0.0, 2.007e5, 150)
    found = atlas.query(pressure=pressure, variables=NAMES)
    reader = atlas._reader
    asked = as_points(reader, "state", reader.complete({"pressure": pressure}, len(pressure)))
    exact = exact_answers(reader, "state", asked, NAMES)
    given = found["status"].values == status.OK
    assert set(found["status"].values) <= {status.OK, status.NOT_INTERPOLABLE}
    assert given.mean() > 0.5
    for name in NAMES:
        gap = np.abs(found[name].values - exact[name]) - exact[f"{name}_error"]
        assert (gap <= found[f"{name}_error"].values)[given].all(), name
    np.testing.assert_array_equal(found["slack_fiber"].values[given], exact["slack_fiber"][given])
    # where what pulls in the middle of the tube differs between both nodes, errors are told by other factors
    cells = np.searchsorted(crossed["pressure"].values, pressure) - 1
    table = reader.table("state")
    assert len(table.sides) > 1
    sides = table.side_of(table.predictor.states(reference.LOADED, asked))
    alike = np.zeros(len(pressure), bool)
    for side in table.sides:
        own = sides == side
        known = table.variable("rotation", side).cells.at(cells * table.strides[0])[:, DOUBT] > 0.0
        values = table.variable("rotation", side).values[:: NODE * table.strides[0]]
        assert own.any()
        assert np.isfinite(values).any()
        alike |= own & ~known
    assert alike.any()
    assert not alike.all()


def test_nodes_on_one_side_of_a_kink_say_nothing_of_the_other():
    """Where loose fibers go slack in the middle a number has a kink: on each side it is told from the nodes there."""
    nodes = np.linspace(0.0, 1.0, 11)
    line = np.where(nodes < 0.53, np.sin(nodes), np.cos(nodes))
    for own, true in ((nodes < 0.53, np.sin(nodes)), (nodes > 0.53, np.cos(nodes))):
        values = np.repeat(np.where(own, line, np.nan), 2)  # the kernels see two axes at least
        fill(values, np.array([11, 2]), np.array([2, 1]), np.stack([nodes, nodes]))
        beside = np.flatnonzero(~own & (np.convolve(own, [1, 1, 1], "same") > 0))
        np.testing.assert_allclose(values[::2][beside], true[beside], atol=2e-4)


def test_designs_of_one_angle_say_nothing_of_those_of_two(tmp_path):
    """What ends add to a design of one family is measured by another formula: it must not get into windows beside it."""
    grid = {
        "alpha": np.linspace(40.0, 65.0, 6).tolist(),
        "beta": np.linspace(40.0, 65.0, 6).tolist(),
        "length": [0.131],
    }
    sweep = parse(spec(grid | {"pressure": [2e4]}).replace("[actuator]", '[actuator]\nmodel = "physical"'))
    atlas = Atlas(make(tmp_path / "atlas.nc", sweep), "diagonal.nc")
    table = atlas._reader.table("state")
    assert (atlas.data["status"] == status.OK).all()
    for side in table.sides:
        doubt = table.variable("rotation", side).cells._grid[2].reshape(6, 6)
        assert (np.diagonal(doubt) > 0.0).all()


def test_beside_the_designs_of_one_angle_and_of_straight_threads_answers_keep_their_bounds(tmp_path):
    """A cell that touches the diagonal has nodes of one family at a corner, and no window reaches across beta = 0."""
    grid = {"alpha": np.linspace(60.0, 85.0, 11).tolist(), "beta": np.linspace(-25.0, 75.0, 41).tolist(),
            "length": [0.08, 0.1, 0.13, 0.17, 0.22, 0.3], "pressure": [1e4, 2e4, 3e4, 4e4]}  # fmt: skip
    sweep = parse(spec(grid).replace("[actuator]", '[actuator]\nmodel = "physical"'))
    atlas = Atlas(make(tmp_path / "atlas.nc", sweep).assign_attrs(interpolation_tolerance=3e-3), "touching.nc")
    draw, reader = np.random.default_rng(6), atlas._reader
    touching = {"alpha": draw.uniform(72.6, 75.0, 60), "length": draw.uniform(0.1, 0.2, 60)}
    touching |= {"beta": draw.uniform(70.0, 72.4, 60), "pressure": draw.uniform(1.5e4, 3.5e4, 60)}
    straight = touching | {"beta": draw.uniform(-2.5, 2.5, 60)}
    for asked, least in ((touching, 0.3), (straight, 0.7)):
        found = atlas.query(**asked, variables=NAMES)
        exact = exact_answers(reader, "state", as_points(reader, "state", reader.complete(asked, 60)), NAMES)
        given = found["status"].values == status.OK
        assert given.mean() > least
        for name in NAMES:
            gap = np.abs(found[name].values - exact[name]) - exact[f"{name}_error"]
            assert (gap <= found[f"{name}_error"].values)[given].all(), name
    assert atlas.query(alpha=73.1, beta=73.9, length=0.15, pressure=2e4)["status"].item() == status.NOT_INTERPOLABLE
    bends = {key: [axis.bend for axis in reader.table(key).axes] for key in ("state", "locked")}
    assert bends == {"state": [0, 10, 0, 0], "locked": [0, 0, 0]}  # of the last two there is one slope at each node


def test_at_nodes_and_at_rest_numbers_are_those_stored(crossed):
    nodes = crossed["pressure"].values
    found = Atlas(crossed, "crossed.nc").query(pressure=nodes, variables=NAMES)
    for name in (*NAMES, "slack_fiber"):
        np.testing.assert_array_equal(found[name].values, crossed[name].values.ravel())
    near = Atlas(crossed, "crossed.nc").query(pressure=1.0, variables=["deformed_length"])
    assert near["status"].item() == status.OK


def test_vectors_hold_physical_tubes_as_their_own_way_does():
    """Prototype B's: the source's closed form is eight times what loose threads give."""
    here = points(4, alpha=0.0, beta=30.0, pressure=3e4)
    found, own = (
        solve(reference.ROTATION_HELD, here, Tubes("full", PHYSICAL), 1e-6, thorough=thorough)
        for thorough in (False, True)
    )
    assert set(found["status"]) == {status.OK}
    assert found["torque"] == pytest.approx(own["torque"], rel=1e-9)


def test_shares_of_slack_are_answered_between_nodes_that_are_alike_and_change_places_with_the_families(crossed):
    atlas, names = Atlas(crossed, "crossed.nc"), ["slack_alpha", "slack_beta"]
    pressure = np.random.default_rng(3).uniform(0.0, 2.007e5, 150)
    found = atlas.query(pressure=pressure, variables=names)
    reader = atlas._reader
    exact = exact_answers(
        reader, "slack", as_points(reader, "slack", reader.complete({"pressure": pressure}, 150)), names
    )
    given = found["slack_status"].values == status.OK
    assert set(found["slack_status"].values) == {status.OK, status.NOT_INTERPOLABLE}
    nodes = crossed["pressure"].values
    cells = np.searchsorted(nodes, pressure) - 1
    for name in names:
        stored = crossed[name].values.ravel()
        assert ((stored >= 0.0) & (stored <= 1.0)).all()
        begins = (stored[cells] > 0.0) != (stored[cells + 1] > 0.0)
        assert not (given & begins & (cells > 0)).any()
        gap = np.abs(found[name].values - exact[name]) - exact[f"{name}_error"]
        assert (gap <= found[f"{name}_error"].values)[given].all(), name
        assert np.isnan(found[name].values[~given]).all()
        # where nothing is slack on either side nothing is, though the windows know better
        none = given & (stored[cells] == 0.0) & (stored[cells + 1] == 0.0) & (cells > 0)
        assert (found[name].values[none] == 0.0).all()
        assert (none & (stored[cells - 1] > 0.0)).any() == (name == "slack_alpha")
    turned = atlas.query(alpha=36.0, beta=8.0, pressure=pressure, variables=names)
    for name, other in zip(names, reversed(names)):
        np.testing.assert_array_equal(turned[name].values, found[other].values)
    refined = atlas.query(pressure=pressure, variables=names, refine=True)
    assert (refined["slack_status"] == status.OK).all()


def test_the_outer_radius_follows_from_the_middle_s(crossed):
    atlas = Atlas(crossed, "crossed.nc")
    pressure = np.random.default_rng(4).uniform(0.0, 2.007e5, 40)
    found = atlas.query(pressure=pressure, variables=["mid_radius", "outer_radius"])
    given = found["status"].values == status.OK
    assert given.any()
    fibers = 4.76e-3 + 1.59e-3  # lie outermost, and are held at the ends
    outer = np.maximum(found["mid_radius"].values, fibers)
    np.testing.assert_allclose(found["outer_radius"].values[given], outer[given], rtol=1e-12)
    at_nodes = atlas.query(pressure=crossed["pressure"].values, variables=["outer_radius"])
    np.testing.assert_array_equal(at_nodes["outer_radius"].values, crossed["outer_radius"].values.ravel())
    stored = np.maximum(crossed["mid_radius"], fibers)
    assert (
        np.abs(crossed["outer_radius"] - stored) <= crossed["outer_radius_error"] + crossed["mid_radius_error"]
    ).all()


@pytest.mark.parametrize("model", [PHYSICAL._replace(fiber_radius="inner"), BONDED._replace(fiber_radius="inner")])
def test_the_middle_tells_what_is_worst_along_the_tube(model):
    """Fibers lie within the wall: its outer layer is followed, too."""
    here = points(30)
    here[:, reference.FIBERS] = here[:, reference.RADIUS]
    if model.is_loose:  # two families of one angle share what it bears
        here[:5, reference.BETA] = here[:5, reference.ALPHA]
    solved = solve(reference.LOADED, here, Tubes("full", model), 1e-6)
    known = np.isfinite(solved["mid_radius"])
    nothing = np.zeros(known.sum())
    told, missed, _ = Predictor(model, "full").worst_places(here[known], solved["mid_radius"][known], nothing, nothing)
    load = np.pi * here[known, reference.FIBERS] ** 2 * here[known, reference.PRESSURE]
    for name, value, lacks in zip(TOLD, told, missed):
        gap, size = np.abs(value - solved[name][known]), load if "tension" in name else value
        assert (gap <= lacks + solved[f"{name}_error"][known] + 1e-9 * size).mean() > 0.9, name
        assert np.median(gap / size) < 1e-6, name


def test_a_tension_may_be_least_just_before_the_middle():
    """There, at 7 % of the length, it is 0.03 N less than in the middle of the tube, and than at any twelfth of the way."""
    here, model = points(1), MODELS["physical"]
    for column, value in (("ALPHA", 18.2487), ("BETA", 69.2368), ("LENGTH", 0.144391), ("PRESSURE", 133680.8)):
        here[:, getattr(reference, column)] = value
    here[:, reference.RADIUS] = 7.1863e-3
    here[:, reference.FIBERS] = 7.1863e-3 + 1.59e-3
    solved = solve(reference.LOADED, here, Tubes("full", model), 1e-8)
    sizes = {"alpha": 18.2487, "beta": 69.2368, "length": 0.144391, "radius": 7.1863e-3, "wall": 1.59e-3}
    tube = Actuator(**sizes, material=MooneyRivlin(0.17e6, 0.08e6), model="physical")
    along = inflate(tube, 133680.8, x=np.linspace(0.0, 0.072, 2001))["fiber_tension_alpha"].values.ravel()
    nothing = np.zeros(1)
    told, missed, _ = Predictor(model, "full").worst_places(here, solved["mid_radius"], nothing, nothing)
    at = list(TOLD).index("least_tension_alpha")
    assert along.min() < along[-1] - 0.02
    assert told[at, 0] == pytest.approx(along.min(), abs=2e-4)
    assert abs(told[at, 0] - along.min()) <= missed[at, 0] + 2e-5


def test_the_middle_of_bonded_membranes_is_strained_as_the_source_s():
    here, model = points(40), TubeModel("outer", "membrane", "bonded")
    radius = here[:, reference.FIBERS] * 1.1
    meridional, stretch, twist = Predictor(model, "full").middles(here, radius).T
    axial, turn, *_ = uniform_state(here[:, reference.ALPHA], here[:, reference.BETA], 1.1)
    known = np.isfinite(axial)
    assert known.sum() > 20
    np.testing.assert_allclose(stretch, 1.1)
    np.testing.assert_allclose(meridional[known], axial[known], rtol=1e-12)
    np.testing.assert_allclose(twist[known], turn[known], rtol=1e-12, atol=1e-14)

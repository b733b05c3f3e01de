"""Sweeps of tubes with one family of fibers, or none, and of loose families that share an angle."""

import numpy as np
import pytest
from grids import FIXED, make, spec

import freesweep as fs
from freesweep.description.families import families_of, lines_of
from freesweep.description.tube_model import THREADS
from freesweep.status import DEGENERATE, OK
from freesweep.sweep.canonical_problem import PHYSICAL, reduced
from freesweep.sweep.plan import plan
from freesweep.sweep.spec import SpecificationError, parse
from freesweep.verification import cross_check, restate, verify

ANGLES = [-30.0, 20.0, 45.0]
DIAGONAL = {"alpha": ANGLES, "beta": ANGLES, "torque": [-4e-3, 4e-3], "pressure": [2e4, 5e4]}
OUTPUTS = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")
RUBBER = fs.MooneyRivlin(c10=FIXED["c10"], c01=FIXED["c01"])


def worded(axes, words, **more):
    return parse(spec(axes, **more).replace("[actuator]", f"[actuator]\n{words}"))


def near(point, single):
    for name in OUTPUTS:
        bound = point[f"{name}_error"] + single[f"{name}_error"]
        assert abs(point[name] - single[name]) <= bound, name


def tube(alpha, beta, **more):
    sizes = {name: FIXED[name] for name in ("length", "radius", "wall")}
    return fs.Actuator(alpha=alpha, beta=beta, **sizes, material=RUBBER, **more)


# --- the diagonal of loose fibers


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    folder = tmp_path_factory.mktemp("diagonal")
    with fs.run_sweep(worded(DIAGONAL, 'fibers = "loose"'), folder / "atlas.nc", threads=1, progress=False) as opened:
        yield opened


@pytest.mark.parametrize(("angle", "torque"), [(-30.0, 4e-3), (20.0, -4e-3), (45.0, 4e-3)])
def test_on_the_diagonal_one_loose_family_holds_the_rubber(atlas, angle, torque):
    single = fs.inflate(tube(angle, angle, fibers="loose"), [2e4, 5e4], torque=torque, x=0.0)
    for pressure in (2e4, 5e4):
        point = atlas.data.sel(alpha=angle, beta=angle, torque=torque, pressure=pressure)
        one = single.sel(pressure=pressure)
        assert (point["status"], point["slack_fiber"]) == (one["status"], one["slack_fiber"])
        near(point, one)
        for name in ("slack_alpha", "slack_beta"):
            assert abs(point[name] - one[name]) <= point[f"{name}_error"] + one[f"{name}_error"]


def test_one_loose_family_has_no_locked_shape(atlas):
    status = atlas.data["locked_status"].values
    assert np.diag(status).tolist() == [DEGENERATE] * 3
    assert (status[~np.eye(3, dtype=bool)] == OK).all()


def test_an_atlas_with_a_loose_diagonal_is_whole_and_is_the_solver_s(atlas):
    assert verify.faults(atlas.path) == []
    diagonal = atlas.data.isel(alpha=[1], beta=[1])
    points = cross_check.draw(diagonal, 3)
    assert not any(compared.broken.any() for compared in restate.finer(points)[0])


def test_beside_the_nodes_the_diagonal_is_solved(atlas):
    here = {"alpha": 30.0, "beta": 30.0, "torque": 1e-3, "pressure": 3e4}
    assert atlas.query(**here)["status"] == fs.status.NOT_INTERPOLABLE
    near(atlas.query(**here, refine=True), fs.inflate(tube(30, 30, fibers="loose"), 3e4, torque=1e-3, x=0.0))
    assert atlas.query(**here, refine=True)["locked_status"] == DEGENERATE


def test_bonded_fibers_of_one_angle_stay_degenerate():
    sweep = worded(DIAGONAL, "")
    table = plan(sweep)["free"]
    found = table.reduced(np.arange(table.grid.size))
    alike = found.status.reshape(3, 3, -1)[np.eye(3, dtype=bool)]
    assert (alike == DEGENERATE).all()
    assert not found.single.any()


def test_the_mirror_image_of_one_family_is_one_problem():
    axes = {"alpha": [-20.0, 20.0], "beta": [-20.0, 20.0], "torque": [-3e-3, 3e-3], "pressure": [2e4]}
    table = plan(worded(axes, 'fibers = "loose"'))["free"]
    problem = table.problem.reshape(2, 2, 2)
    assert problem[0, 0].tolist() == problem[1, 1, ::-1].tolist()
    found = table.reduced(np.arange(8))
    assert found.single.reshape(2, 2, 2)[:, :, 0].tolist() == [[True, False], [False, True]]
    assert found.mirrored.reshape(2, 2, 2)[0, 0].all()
    assert set(found.rows[found.single, PHYSICAL + 1]) == {THREADS[1, "loose"]}


# --- none


@pytest.mark.parametrize(
    ("names", "fibers", "code"),
    [(("beta",), "bonded", (1, "bonded")), (("alpha",), "loose", (1, "loose")), ((), "bonded", (0, "bonded"))],
)
def test_lines_of_designs_are_those_of_a_single_tube(names, fibers, code):
    angle = {"alpha": 30.0, "beta": -50.0}
    given = {name: angle[name] if name in names else None for name in angle}
    one = tube(**given, fibers=fibers)
    found = lines_of(np.array([angle["alpha"]]), np.array([angle["beta"]]), names, fibers == "loose")
    assert [found.alpha[0], found.beta[0]] == pytest.approx([line.item() for line in one.lines(0.5)], rel=1e-14)
    assert (found.threads[0], found.single[0]) == (one.threads, True)
    assert one.threads == THREADS[code]


@pytest.mark.parametrize("words", ['alpha = "none"\nbeta = -30', 'alpha = "none"\nbeta = "None"\nfibers = "loose"'])
def test_points_of_a_sweep_without_a_family_are_the_single_tubes(tmp_path, words):
    axes = {"wall": [1.2e-3, 1.59e-3], "torque": [0.0, 3e-3], "pressure": [1e4, 3e4]}
    path = tmp_path / "atlas.nc"
    data = make(path, worded(axes, words), threads=1)
    bare, loose = "beta = -30" not in words, "loose" in words
    single = fs.inflate(tube(None, None if bare else -30, fibers="loose" if loose else None), 3e4, torque=3e-3, x=0.0)
    point = data.sel(wall=1.59e-3, torque=3e-3, pressure=3e4)
    assert point["status"] == single["status"] == OK
    near(point, single)
    assert (data["locked_status"] == DEGENERATE).all()
    assert "alpha" not in data.coords
    assert families_of(data.attrs) == (() if bare else ("beta",))
    assert verify.faults(path) == []


def test_a_balloon_s_limit_pressure_is_that_of_the_single_one(tmp_path):
    axes = {"wall": [0.6e-3, 0.8e-3], "pressure": [1e4, 6e4]}
    more = {"fixed": {"c10": 0.1e6, "c01": 0.0, "length": 0.1}}
    data = make(tmp_path / "atlas.nc", worded(axes, 'alpha = "none"\nbeta = "none"', **more), threads=1)
    one = fs.Actuator(
        alpha=None, beta=None, length=0.1, radius=FIXED["radius"], wall=0.6e-3, material=fs.NeoHookean(c10=0.1e6)
    )
    single, point = fs.inflate(one, 6e4, x=0.0), data.sel(wall=0.6e-3)
    assert point["status"].sel(pressure=6e4) == single["status"] == fs.status.BEYOND_LIMIT
    bound = point["limit_pressure_error"] + single["limit_pressure_error"]
    assert abs(point["limit_pressure"] - single["limit_pressure"]) <= bound


def test_between_its_nodes_an_atlas_of_one_family_tells_what_is_within_the_stated_error(tmp_path):
    axes = {"alpha": np.linspace(10.0, 50.0, 9).tolist(), "pressure": np.linspace(1e4, 4e4, 6).tolist()}
    sweep = worded(axes, 'beta = "none"\nfibers = "loose"')
    with fs.run_sweep(sweep, tmp_path / "atlas.nc", threads=1, progress=False) as atlas:
        draw = np.random.default_rng(3)
        here = {"alpha": draw.uniform(10.0, 50.0, 12), "pressure": draw.uniform(1e4, 4e4, 12)}
        names = ["deformed_length", "rotation", "mid_radius"]
        told = atlas.query(**here, variables=names)
        assert (told["status"] == OK).mean() > 0.8
        for k in np.flatnonzero(told["status"] == OK)[:4]:
            alpha, pressure = (here[name][k] for name in here)
            single = fs.inflate(tube(alpha, None, fibers="loose"), pressure, x=0.0)
            for name in names:
                bound = told[f"{name}_error"][k] + single[f"{name}_error"]
                assert abs(told[name][k] - single[name]) <= bound, (name, alpha, pressure)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('[axes]\nbeta = ["none", 10]', "axes.beta: some of its values are none; an axis is of numbers"),
        (
            'beta = 10\n[[designs]]\nname = "A"\nalpha = "none"',
            "designs[0].alpha: is none; designs of one sweep have the same",
        ),
        ('beta = 10\nalpha = "none"\n[axes]\nalpha = [10, 20]', "axes.alpha: actuator.alpha is none already"),
        ('beta = 10\nalpha = "none"\nenergy = "principal"', "fewer than two families would leave it open"),
    ],
)
def test_none_stands_in_the_actuator_for_all_tubes_or_is_refused_with_a_reason(text, says):
    head = "[actuator]\nlength = 0.1\nradius = 5e-3\nwall = 1e-3\nc10 = 1e5\n"
    alpha = "" if "alpha" in text else "alpha = 20\n"
    with pytest.raises(SpecificationError) as caught:
        parse(f"[load]\npressure = 1e4\n{head}{alpha}{text}")
    assert any(says in fault for fault in caught.value.faults), caught.value.faults


def test_reduced_problems_of_two_families_are_what_they_were():
    """What a sweep of two bonded families is reduced to knows nothing of single ones."""
    sweep = parse(spec({"alpha": [20.0], "beta": [-50.0], "pressure": [1e4]}))
    columns = plan(sweep)["free"].grid.columns(np.arange(1))
    found = reduced(columns, sweep, "free")
    tangents = np.tan(np.radians([20.0, -50.0]))
    assert found.rows[0, :2] == pytest.approx([abs(tangents.sum()) / 2.0, (tangents[0] - tangents[1]) / 2.0])
    assert found.rows[0, PHYSICAL : PHYSICAL + 2].tolist() == [0.0, 0.0]

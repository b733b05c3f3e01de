"""Grids of designs: what is solved once, what every point must equal, what the dataset says of itself."""

import hashlib

import numpy as np
import pytest
from grids import GRID, make, spec, swept

from freesweep import Actuator, MooneyRivlin, closed_form, inflate, lock, status
from freesweep.atlas.schema import FLAG_OF, PARAMETERS, STATUS_OF, VARIABLES, attributes
from freesweep.scaling import ALONG
from freesweep.sweep.canonical_problem import significant
from freesweep.sweep.plan import NONE, plan
from freesweep.sweep.records import upward
from freesweep.sweep.spec import parse

OUTPUTS = ("deformed_length", "rotation", "mid_radius", "volume", "strain_energy")
WITHOUT = {name: variable.without for name, variable in VARIABLES.items()}
WITHOUT |= {name: without for name, (_, without) in (STATUS_OF | FLAG_OF).items()}

ROUNDED = 5e-13  # relative: problems that differ less are one


def planned(axes, **more):
    return plan(parse(spec(axes, **more)))["free"]


def everything(made):
    """All problems, all pressures, all designs of a table."""
    return made.job(0, made.count).problems, made.job(0, made.count).pressures, np.arange(made.grid.size)


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    with swept(tmp_path_factory.mktemp("grid"), GRID) as atlas:
        yield atlas.data.load()


# --- the plan


def test_exchanged_and_mirrored_designs_are_solved_once():
    """alpha, beta = +-20, +-50: four designs of two kinds; the diagonal is none."""
    angles = [-50.0, -20.0, 20.0, 50.0]
    made = planned({"alpha": angles, "beta": angles, "pressure": [0.0, 1e5]})
    assert made.count == 4  # 20/50, 20/-50, 20/-20, 50/-50
    assert made.equilibria == 4 * 3  # the locked shapes too
    assert (made.reduced(np.arange(16)).status == status.DEGENERATE).sum() == 4
    assert (made.problem == NONE).sum() == 4
    twisted = planned({"alpha": angles, "beta": angles, "torque": [-0.01, 0.01], "pressure": [1e5]})
    assert twisted.count == 2 * 2 + 2  # mirrored in a torque too; McKibben muscles do not tell its sign


def test_scaled_designs_are_solved_once():
    """Twice as long, wide and thick; three times as stiff under three times the pressure: ratios alone count."""
    small = {"name": "small", "alpha": 20, "beta": -50, "length": 0.1, "radius": 4e-3, "wall": 1e-3}
    large = {"name": "large", "alpha": 20, "beta": -50, "length": 0.2, "radius": 8e-3, "wall": 2e-3}
    soft, stiff = {"c10": 1e5, "c01": 5e4}, {"c10": 3e5, "c01": 1.5e5}
    designs = [small | soft, large | soft, small | stiff | {"name": "stiff"}]
    made = planned({"pressure": [0.0, 1e5, 3e5]}, designs=designs)
    assert made.count == 1
    # p = 0, 1, 3 and 0, 1/3, 1: four different ones and the locked shape
    assert everything(made)[1].tolist() == [*significant(np.array([0, 1 / 3, 1, 3])), np.inf]


def test_every_point_of_the_grid_has_the_row_of_its_own_problem():
    made = planned(GRID)
    problems, pressures, designs = everything(made)
    own = made.reduced(designs)
    good = own.status == status.OK
    assert np.array_equal(good, made.problem != NONE)
    assert np.array_equal(problems[made.problem[good]], significant(own.rows[good, :11]))
    scaled = pressures[made.rows(designs)][good] * made.grid.columns(designs)["c10"][good, None]
    assert scaled == pytest.approx(np.broadcast_to(GRID["pressure"], scaled.shape), rel=1e-12)
    assert np.isinf(pressures[made.locked_rows(designs)][good]).all()
    assert made.equilibria == len(pressures) == made.first[-1]
    assert len(np.unique(problems, axis=0)) == len(problems)


# --- the results


def actuator(point):
    numbers = {name: point[name].item() for name in PARAMETERS if name in point.coords}
    material = MooneyRivlin(numbers.pop("c10"), numbers.pop("c01"))
    loads = {name: numbers.pop(name) for name in ("force", "torque", "pressure")}
    return Actuator(**numbers, material=material), loads


def agrees(point, prefix, reference):
    for name in OUTPUTS:
        mine, bound = point[f"{prefix}{name}"].item(), point[f"{prefix}{name}_error"].item()
        assert abs(mine - reference[name].item()) <= bound + reference[f"{name}_error"].item() + ROUNDED * abs(mine), (
            name
        )


def test_points_of_a_grid_equal_single_actuators(grid):
    draw = np.random.default_rng(3)
    compared = 0
    for _ in range(60):
        point = grid.isel({name: draw.integers(size) for name, size in grid.sizes.items()})
        if abs(point["alpha"] - point["beta"]) < 0.5:
            continue
        tube, loads = actuator(point)
        alone = inflate(tube, **loads, x=0.0)
        assert point["status"] == alone["status"]
        for name in ("slack_fiber", "stable"):
            assert point[name] == alone[name]
        if point["status"] == status.OK:
            agrees(point, "", alone)
            compared += 1
        agrees(point, "locked_", lock(tube, x=0.0))
    assert compared > 25


def test_points_of_designs_equal_single_actuators(tmp_path):
    designs = [
        {"name": "mirrored", "alpha": -20, "beta": 50, "fiber_extension": 1.005},
        {"name": "swapped", "alpha": 60, "beta": 0, "c10": 0.3e6},
        {"name": "muscle", "alpha": 30, "beta": -30, "length": 0.05, "fiber_radius": 6e-3},
    ]
    with swept(tmp_path, {"pressure": [0.0, 5e4]}, designs=designs, fixed={"fiber_radius": 4.76e-3}) as atlas:
        data = atlas.data.load()
    assert data["design"].values.tolist() == ["mirrored", "swapped", "muscle"]
    assert data["rotation"].dims == ("design", "pressure")
    for name in data["design"].values:
        point = data.sel(design=name, pressure=5e4)
        tube, loads = actuator(point)
        agrees(point, "", inflate(tube, **loads, x=0.0))
        agrees(point, "locked_", lock(tube, x=0.0))
    assert data["rotation"].sel(design="mirrored", pressure=5e4) < 0
    np.testing.assert_allclose(data["deformed_length"].sel(pressure=0.0), data["length"], rtol=ROUNDED)


def test_bounds_of_the_undeformed_cylinder_hold(grid):
    rest = grid.sel(pressure=0.0, force=0.0, torque=0.0, alpha=10.0, beta=50.0)
    assert (abs(rest["deformed_length"] - 0.1) <= rest["deformed_length_error"] + 1e-16).all()


def test_designs_that_cannot_be_solved_say_why(grid):
    same = grid["status"].sel(alpha=30.0, beta=30.0)
    close = grid["status"].sel(alpha=30.0, beta=30.25)
    assert (same == status.DEGENERATE).all()
    assert (close == status.INVALID).all()
    assert (grid["locked_status"].sel(alpha=30.0, beta=30.0) == status.DEGENERATE).all()
    others = grid["status"].sel(beta=[-30.0, 50.0])
    assert set(np.unique(others)) == {status.OK, status.COMPRESSED}
    assert (grid["status"].sel(force=-0.4, pressure=0.0).sel(alpha=10.0) == status.COMPRESSED).all()


def test_fibers_outside_the_wall_are_invalid(tmp_path):
    axes = {"alpha": [20.0], "beta": [-50.0], "radius": [4e-3, 5e-3], "fiber_radius": [4.5e-3, 5.5e-3, 7e-3]}
    with swept(tmp_path, axes, fixed={"pressure": 5e4}) as atlas:
        codes = atlas.data["status"].squeeze().values
        assert atlas.data["status"].dims == ("alpha", "beta", "radius", "fiber_radius")  # one pressure is no axis
        assert atlas.data["pressure"] == 5e4
    assert codes.tolist() == [[0, 0, 7], [7, 0, 7]]


def test_values_are_nan_exactly_where_the_status_gives_none(grid):
    for name in (name for name in VARIABLES if name in grid):
        if name == "limit_pressure":
            assert (grid[name].notnull() == (grid["limit_found"] == 1)).all()
            continue
        prefix = "locked_status" if name.startswith("locked_") else f"{name}_status" if "ideal" in name else "status"
        valued = grid[prefix].isin(status.VALUED)
        for each in (name, f"{name}_error"):
            assert (grid[each].notnull() == valued.broadcast_like(grid[each])).all(), each
    assert (grid["stable"] == grid["status"].isin(status.VALUED)).all()


def test_ideal_blocked_values_are_the_closed_forms(grid):
    alpha, beta, radius, pressure = np.ix_(*(GRID[name] for name in ("alpha", "beta", "fiber_radius", "pressure")))
    for name, formula in (("force", closed_form.blocked_force), ("torque", closed_form.blocked_torque)):
        variable = grid[f"ideal_blocked_{name}"]
        assert variable.dims == ("alpha", "beta", "fiber_radius", "pressure")
        codes = grid[f"ideal_blocked_{name}_status"]
        expected = np.where(codes == status.INVALID, np.nan, formula(alpha, beta, radius, pressure))
        np.testing.assert_allclose(variable, expected, rtol=1e-13)
        assert (codes.sel(alpha=30.0, beta=30.0) == status.DEGENERATE).all()
    assert (grid["ideal_blocked_force_status"].sel(alpha=10.0, beta=50.0) == status.COMPRESSED).all()


# --- the dataset


def test_bounds_are_kept_in_single_precision_and_still_hold(grid):
    draw = np.random.default_rng(1)
    bounds = np.concatenate([10 ** draw.uniform(-30, 3, 10_000), [0.0, 1.0, 1e-300, 0.1]])
    single = upward(bounds)
    assert single.dtype == np.float32
    assert np.all(single.astype(float) >= bounds)
    assert np.all(np.nextafter(single, np.float32(-1))[:-1] <= bounds[:-1])
    assert np.isnan(upward(np.array([np.nan])))
    assert all(grid[name].dtype == np.float32 for name in grid if name.endswith("_error"))


def test_every_variable_is_described_and_has_the_dimensions_it_varies_in(grid):
    names = {*VARIABLES, *(f"{name}_error" for name in VARIABLES), *STATUS_OF, *FLAG_OF}
    names = {name for name in names if not name.startswith("blocked_")}  # stored only where asked for
    names = {
        name for name in names if name.removesuffix("_error").removeprefix("locked_") not in ALONG
    }  # of physical tubes
    assert set(grid.data_vars) == names
    for name, variable in grid.data_vars.items():
        absent = WITHOUT[name.removesuffix("_error")]
        absent = tuple(axis for axis in absent if axis != "wall")  # kept beside fiber_radius, with which it decides
        assert variable.dims == tuple(axis for axis in GRID if axis not in absent), name
    for name, variable in grid.variables.items():
        expected = attributes(name)
        assert set(variable.attrs) == set(expected), name
        assert all(np.array_equal(variable.attrs[key], value) for key, value in expected.items()), name
    for name, values in GRID.items():
        assert grid[name].values.tolist() == values
    assert grid["length"] == 0.1


def test_an_atlas_names_its_specification_and_its_code(grid):
    text = spec(GRID)
    assert grid.attrs["specification"] == text
    assert grid.attrs["specification_sha256"] == hashlib.sha256(text.encode()).hexdigest()
    assert grid.attrs["title"] == "A sweep"
    assert grid.attrs["energy"] == "full"
    assert grid.attrs["accuracy"] == 1e-6
    assert grid.attrs["distinct_problems"] < 3 * 4 * 2 * 2 * 9
    for name in (
        "version",
        "code_sha256",
        "started",
        "python",
        "numpy",
        "source",
        "Conventions",
        "freesweep_format",
    ):
        assert grid.attrs[name], name


@pytest.mark.parametrize("axes", [{"pressure": [0.0, 5e4]}, {"c10": [1e5, 2e5], "pressure": [0.0, 5e4]}])
def test_a_single_design_may_be_swept(axes, tmp_path):
    data = make(tmp_path / "atlas.nc", parse(spec(axes, fixed={"alpha": 20.0, "beta": -30.0})))
    assert (data["status"] == status.OK).all()
    assert data["locked_deformed_length"].ndim == 0


def test_a_grid_of_degenerate_designs_is_an_atlas_too(tmp_path):
    data = make(tmp_path / "atlas.nc", parse(spec({"pressure": [0.0, 5e4]}, fixed={"alpha": 30.0, "beta": 30.0})))
    assert (data["status"] == status.DEGENERATE).all()
    assert data["rotation"].isnull().all()
    assert data["locked_status"] == status.DEGENERATE


def test_a_limit_met_for_another_material_is_not_reported(tmp_path):
    """In units of c10 the stiffer rubber is asked for less than the limit that the softer one meets."""
    axes = {"c10": [1e5, 2e5], "pressure": [5e4, 1.25e5]}
    text = spec(axes, fixed={"alpha": 60.0, "beta": 55.0, "length": 0.1904, "c01": 5e4}, energy="principal")
    data = make(tmp_path / "atlas.nc", parse(text))
    assert data["limit_found"].values.tolist() == [1, 0]
    assert np.isnan(data["limit_pressure"][1])

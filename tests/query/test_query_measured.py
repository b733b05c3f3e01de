"""Atlases that measure themselves, curves, and the command: what is stated is what was measured; files in, files out."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from commands import refused, run
from grids import FIXED, make, spec

from freesweep import Actuator, MooneyRivlin, inflate, run_sweep, status
from freesweep.atlas.store import Atlas, describe
from freesweep.bench.query import table
from freesweep.cli import DONE
from freesweep.query import calibration, errors, measure
from freesweep.query.calibrate import calibrate, cell_factors, piece_scales
from freesweep.query.cells import ROUGH
from freesweep.query.faults import QueryError
from freesweep.query.reference import VOLUME
from freesweep.query.refine import as_points, exact_answers
from freesweep.sweep.refine_axes import graded
from freesweep.sweep.run import run as run_looked_at
from freesweep.sweep.spec import SpecificationError, parse
from freesweep.verification.verify import faults as verify

AXES = {
    "alpha": np.linspace(10.0, 60.0, 9).tolist(),
    "beta": np.linspace(-70.0, -20.0, 9).tolist(),
    "length": [0.1, 0.14, 0.2, 0.3],
    "pressure": (np.linspace(0.0, np.sqrt(1e5), 17) ** 2).tolist(),
}
POINT = {"alpha": 24.0, "beta": -43.0, "length": 0.12, "pressure": 3.7e4}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    out = tmp_path_factory.mktemp("measured") / "atlas.nc"
    with run_sweep(parse(spec(AXES)), out, threads=2, progress=False) as atlas:
        yield atlas


def test_an_atlas_knows_how_well_it_answers(made):
    found = calibration.read(made.data)
    assert found["designs"] >= 200
    assert 0.5 < found["answered"]["state"] <= 1.0
    for name in ("deformed_length", "rotation", "volume", "locked_volume"):
        rows = found["variables"][name]["regions"]
        assert set(rows) == {"all", "IIa", "IIb"}  # opposite signs: no region I
        count, share, median, high, worst, ratio = rows["all"]
        assert count == found["designs"]
        assert 0.5 < share <= 1.0
        assert 0.0 <= median <= high <= worst <= 1e-3
        assert 1.0 < ratio < 100.0
    text = describe(made)
    assert "random designs solved exactly" in text
    assert "region IIb" in text


def test_stated_errors_hold_at_designs_that_were_not_measured(made):
    draw = np.random.default_rng(4)
    points = {name: draw.uniform(values[0], values[-1], 300) for name, values in AXES.items()}
    found = made.query(**points, variables=["deformed_length", "rotation", "volume"])
    answered = np.flatnonzero(found["status"] == status.OK)
    missed = 0
    for k in answered[::2]:
        own = {name: points[name][k] for name in ("alpha", "beta", "length")}
        rest = {name: FIXED[name] for name in ("radius", "wall")}
        tube = Actuator(**own, **rest, material=MooneyRivlin(FIXED["c10"], FIXED["c01"]))
        solved = inflate(tube, points["pressure"][k], x=0.0, accuracy=1e-8)
        for name in ("deformed_length", "rotation", "volume"):
            gap = abs(found[name][k] - solved[name])
            missed += bool(gap > found[f"{name}_error"][k] + solved[f"{name}_error"])
            assert gap <= 1e-3 * max(abs(solved[name]), 0.1)
    assert missed <= 1


COARSE = {
    "alpha": [10.0, 35.0, 60.0], "beta": [-70.0, -45.0, -20.0], "length": [0.1, 0.2, 0.3], "pressure": [0.0, 3e4, 1e5],
}  # fmt: skip


def test_axes_grow_until_answers_are_as_exact_as_asked(tmp_path):
    solver = "\n[solver]\ninterpolation_tolerance = 1e-5\nbudget = 6000"
    sweep = parse(spec(COARSE) + solver)
    grown = graded(sweep)
    assert grown.points <= 6000
    again = graded(sweep)
    for name, values in COARSE.items():
        assert set(values) <= set(grown.axes[name])
        assert np.array_equal(grown.axes[name], again.axes[name])
    assert grown.points > 10 * sweep.points
    points = {name: np.random.default_rng(5).uniform(v[0], v[-1], 200) for name, v in COARSE.items()}
    shares = []
    for text in ("", solver):
        with run_sweep(parse(spec(COARSE) + text), tmp_path / f"{len(text)}.nc", threads=2, progress=False) as atlas:
            data = atlas.data.load().assign_attrs(interpolation_tolerance=1e-5)
            found = Atlas(data, atlas.path).query(**points, variables=["deformed_length", "volume"])
            shares.append((found["status"] == status.OK).mean().item())
            assert verify(atlas.path) == []
    assert shares[1] > max(0.6, 2.0 * shares[0])


@pytest.mark.parametrize(
    ("solver", "says"),
    [
        ("interpolation_tolerance = 2.0", "interpolation_tolerance: found 2, allowed is"),
        ("budget = 10", "give interpolation_tolerance, too"),
        ("interpolation_tolerance = 1e-3\nbudget = 0", "budget: found 0"),
    ],
)
def test_tolerances_and_budgets_are_checked(solver, says):
    with pytest.raises(SpecificationError, match=says):
        parse(spec(COARSE) + "\n[solver]\n" + solver)


def test_factors_are_the_least_that_hold():
    draw = np.random.default_rng(0)
    count = 40_000
    estimate, bound, size = 10.0 ** draw.uniform(-9, -3, count), np.full(count, 1e-8), np.ones(count)
    beside = draw.random(count) < 0.1
    error = estimate * draw.uniform(0.0, 3.0, count) * np.where(beside, 20.0, 1.0) + 1e-9 * draw.uniform(
        0.0, 1.0, count
    )
    seen, fresh = np.arange(count) % 2 == 0, np.arange(count) % 2 == 1
    factors = calibrate(*(each[seen] for each in (error, estimate, bound, size, beside)), np.full(count // 2, 1e-2))
    stated = errors.stated(factors, estimate, bound, size, beside)
    assert (stated >= error)[fresh].mean() >= 0.999
    assert np.median((stated / error)[fresh]) < 4.0
    assert factors.classes[1, 7] > 10.0 * factors.classes[0, 7]
    assert factors.bound < 1.0
    few = calibrate(*(each[:50] for each in (error, estimate, bound, size, beside)), np.full(50, 1e-2))
    assert (few.classes == calibration.UNMEASURED).all()
    assert few.bound * calibration.UNMEASURED == pytest.approx(1.0)


def test_designs_of_which_no_error_is_told_change_no_factor():
    """Between nodes whose fibers are taut all along shares of slack are 0, and nothing is told of them. Alone they were a
    division by zero, beside others one in a logarithm where they were wrong by rounding.
    """
    draw, count, silent = np.random.default_rng(0), 4000, 500
    estimate, nothing = 10.0 ** draw.uniform(-9, -3, count), np.zeros(silent)
    told = estimate * draw.uniform(0.0, 3.0, count), estimate, np.full(count, 1e-8), np.ones(count)
    wrong = np.where(np.arange(silent) % 2, 1e-17, 0.0), nothing, nothing, np.ones(silent)
    with np.errstate(all="raise"):
        both, one, none = (
            calibrate(*rest, np.zeros(len(rest[0]), bool), np.full(len(rest[0]), 1e-2))
            for rest in (list(map(np.concatenate, zip(told, wrong))), told, wrong)
        )
    np.testing.assert_array_equal(both.classes, one.classes)
    assert both.bound == one.bound
    assert (none.classes == calibration.UNMEASURED).all()


def test_what_was_stored_wrongly_does_not_pass_for_roughness():
    draw, count = np.random.default_rng(0), 8000
    pieces = np.repeat([[0, 2], [2, 2]], count // 2, axis=0)
    rough = 10.0 ** draw.uniform(-9, -4, count)
    bound = np.full(count, 1e-6)
    cells = np.zeros((count, ROUGH + 2))
    cells[:, ROUGH] = rough
    table = SimpleNamespace(axes=(0, 1), family=SimpleNamespace(variables={"volume": VOLUME}))
    true = rough * draw.uniform(0.0, 1.0, count) * np.where(pieces[:, 0] == 0, 0.3, 1.0)
    noise = 0.15 * bound * draw.uniform(-1.0, 1.0, count)
    inquiry = SimpleNamespace(table=table, ranks=pieces, rests=lambda known, scales, places: known[:, ROUGH:])
    inquiry.estimate = lambda name, scales, interpolated: (true, rough, bound, np.zeros(count, bool))
    scales = piece_scales(inquiry, "volume", (None, cells), np.arange(count), noise)
    assert scales[0, 0] / scales[0, 2] == pytest.approx(0.3, rel=0.15)


def test_few_designs_cannot_have_met_the_worst():
    draw = np.random.default_rng(3)
    size = np.ones(40_000)
    error = 1e-6 * (1.0 + draw.pareto(3.0, len(size)))  # errors of atlases fall off about so
    rest = np.full(len(size), 1e-6), np.zeros(len(size)), size, np.zeros(len(size), bool)
    held = []
    for begin in range(0, 20_000, 500):
        some = slice(begin, begin + 500)
        factors = calibrate(error[some], *(each[some] for each in rest), np.full(500, 1e-2))
        held.append((error[20_000:] <= errors.stated(factors, *(each[20_000:] for each in rest))).mean())
    assert np.mean(held) >= 0.9994


def test_the_middle_of_a_long_tube_is_known_to_the_last_digits(made):
    draw, count = np.random.default_rng(6), 400
    points = {name: draw.uniform(values[0], values[-1], count) for name, values in AXES.items()}
    found = made.query(**points, variables=["mid_radius"])
    reader = made._reader
    asked = as_points(reader, "state", reader.complete(points, count))
    exact = exact_answers(reader, "state", asked, ["mid_radius"], 1e-8)["mid_radius"]
    known = (found["status"].values == status.OK) & np.isfinite(exact)
    gap = np.abs(found["mid_radius"].values - exact)[known]
    stated = found["mid_radius_error"].values[known]
    assert (gap <= stated).mean() >= 0.995
    assert np.median(stated / exact[known]) < 1e-14
    assert np.median(stated) < 10.0 * np.median(gap)


def test_ends_of_an_axis_have_estimates_of_their_own(made):
    found = calibration.factors(made.data, "volume", ("alpha", "beta", "length", "pressure"))
    assert found.scales.shape == (4, calibration.RANKS)
    assert (found.scales != 1.0).sum() >= 3
    assert (calibration.factors(made.data, "volume", ("torque",)).scales == 1.0).all()


OF_OTHER_FORM = {"estimates": calibration.ESTIMATES, "variables": {"rotation": {"factors": [1], "bound": 0}}}


@pytest.mark.parametrize("text", ["", "{", "[]", json.dumps(OF_OTHER_FORM)])
def test_what_cannot_be_read_of_a_measurement_is_replaced_by_caution(made, text):
    data = made.data.assign_attrs({calibration.ATTRIBUTE: text})
    assert (calibration.factors(data, "rotation").classes == calibration.UNMEASURED).all()


def test_factors_of_other_estimates_are_not_taken(made):
    found = calibration.read(made.data)
    assert (calibration.factors(made.data, "rotation").classes != calibration.UNMEASURED).any()
    older = made.data.assign_attrs({calibration.ATTRIBUTE: json.dumps(found | {"estimates": 1})})
    assert (calibration.factors(older, "rotation").classes == calibration.UNMEASURED).all()


def test_curves_run_along_one_axis(made):
    rest = {name: POINT[name] for name in ("alpha", "beta", "length")}
    curve = made.curve("pressure", **rest, variables="rotation")
    assert curve["rotation"].dims == ("pressure",)
    assert curve["pressure"][0] == 0.0
    assert curve["pressure"][-1] == made.data["pressure"][-1]
    assert (curve["status"] == status.OK).mean() > 0.9
    some = made.curve("length", [0.12, 0.15], alpha=24.0, beta=-43.0, pressure=3.7e4, variables="rotation")
    assert some["rotation"][0] == made.query(**POINT, variables="rotation")["rotation"]
    with pytest.raises(QueryError, match="axis 'presure' is unknown here; did you mean 'pressure'"):
        made.curve("presure", **rest)
    with pytest.raises(QueryError, match="radius: the atlas holds only"):
        made.curve("radius", **POINT)


COARSER = [5e4 * k for k in range(1, 9)]


def test_a_node_more_withdraws_no_answers_and_what_is_too_coarse_is_named(tmp_path):
    """At an end, far beyond it, in between: what the new cells need is not asked of the others, and all bounds hold."""
    draw, shares, names = np.random.default_rng(0), {}, ["deformed_length", "rotation", "volume"]
    points = {"alpha": draw.uniform(20.0, 40.0, 2000), "pressure": draw.uniform(5e4, 4e5, 2000)}
    low = {"alpha": 33.0, "pressure": [1e3, 2e3, 3e3], "variables": "volume"}
    fixed = {"beta": -30.0, "length": 0.1, "radius": 5e-3, "wall": 1.5e-3, "c10": 0.11e6, "c01": 0.06e6}
    head = "\n".join(f"{name} = {value!r}" for name, value in fixed.items())
    for added in ((), (0.0,), (1e4,), (2.5e4,), (2.2e5,), (1e6,)):
        pressures = sorted([*added, *COARSER])
        text = (
            f'title = "few nodes"\n[actuator]\n{head}\n[axes]\nalpha = [20, 25, 30, 35, 40]\npressure = {pressures}\n'
        )
        with run_sweep(parse(text), tmp_path / f"{len(shares)}.nc", threads=2, progress=False) as atlas:
            found = atlas.query(**points, variables=names)
            shares[added] = (found["status"].values == status.OK).mean()
            if not added:
                reader = atlas._reader
                asked = as_points(reader, "state", reader.complete(points, 2000))
                exact = exact_answers(reader, "state", asked, names, 1e-9)
            elif added == (0.0,):
                assert atlas.query(**low).attrs["too_coarse"].startswith("pressure")
                assert "too_coarse" not in atlas.query(**low, refine=True).attrs
        for name in names:
            beyond = np.abs(found[name].values - exact[name]) > found[f"{name}_error"].values
            assert beyond.mean() <= 2e-3, (added, name)
    assert shares[()] > 0.75
    for added, answered in shares.items():
        assert answered >= shares[()] - 0.02, added
    assert max(shares.values()) > shares[()] + 0.03


def test_what_a_cell_needs_less_of_the_error_is_told_of_it_alone():
    draw, count, nodes = np.random.default_rng(2), 8000, 20
    cell = draw.integers(nodes, size=count)
    error, stated = draw.uniform(0.0, 1.0, count) * np.where(cell < 10, 0.1, 1.0), np.full(count, 1.5)
    found = cell_factors(error, stated, cell, nodes)
    assert (found[:10] < 0.13).all()
    assert (found[10:] > 0.6).all()
    assert (error <= found[cell] * stated).all()
    rare = cell_factors(error[:300], stated[:300], cell[:300], nodes)
    assert (rare == 1.0).all()  # fifteen designs in each
    assert len(cell_factors(error, stated, cell, calibration.MOST_CELLS + 1)) == 0


def test_plots_between_nodes_show_what_a_query_answers_and_leave_failed_neighbours_failed(made):
    from freesweep.plot.curve import curve
    from freesweep.plot.plane import plane
    from freesweep.plot.validity import validity_map

    at = {"length": 0.12, "pressure": 3.7e4}
    sheet = plane(made.data, "rotation", at)
    beta = made.data["beta"].values[4]
    (shown,) = sheet.values[sheet.y == beta]
    answer = made.query(alpha=sheet.x, beta=beta, **at, variables="rotation", refine=True)["rotation"].values
    here = ~np.ma.getmaskarray(shown) & np.isin(sheet.x, AXES["alpha"])
    assert here.sum() > 5
    assert (np.abs(shown - answer)[here] <= 1e-3 * np.abs(answer[here])).all()
    assert sheet.point["pressure"] == 3.7e4
    assert not sheet.point.missed
    holed = made.data.load().copy(deep=True)
    where = {"alpha": 3, "beta": 4, "length": 0, "pressure": int(np.searchsorted(AXES["pressure"], 3.7e4))}
    holed["status"][where], holed["rotation"][where] = status.BEYOND_LIMIT, np.nan
    found = plane(holed, "rotation", at)
    lost = found.reason == status.BEYOND_LIMIT
    assert found.x[lost.any(axis=0)].tolist() == [AXES["alpha"][3]]
    assert lost.sum() == 1
    assert found.values.mask[lost].all()
    _, _, states = validity_map(holed, **at)
    assert (states.reason == status.BEYOND_LIMIT).sum() == 1
    (line,) = [one for one in curve(made.data, "rotation", alpha=24.0, beta=-43.0, length=0.12).lines if one.get_gid()]
    asked = {"alpha": 24.0, "beta": -43.0, "length": 0.12, "pressure": AXES["pressure"]}
    expected = made.query(**asked, variables="rotation")["rotation"].values
    known = np.isfinite(expected)
    np.testing.assert_allclose(line.get_ydata()[known], expected[known], rtol=1e-3)


# --- the command

ASKED = ("--alpha", "24deg", "--beta", "-43deg", "--length", "120 mm", "--pressure", "37 kPa")


def test_one_point_on_the_screen(made, capsys):
    assert run("query", str(made.path), *ASKED, "--variable", "deformed_length", "rotation") == DONE
    out = capsys.readouterr().out
    value = made.query(**POINT, variables="deformed_length")["deformed_length"].item()
    assert f"{1e3 * value:.7g}"[:6] in out
    assert "stated error" in out
    flags = dict(line.split(maxsplit=1) for line in out.splitlines() if line.split()[0] in ("stable", "slack_fiber"))
    assert flags == {"stable": "stable", "slack_fiber": "none"}
    slack = ("query", str(made.path), "--alpha", "10", "--beta", "-20", "--length", "0.1 m", "--pressure")
    assert run(*slack, "100 Pa", "--variable", "rotation", "--refine") == DONE
    (line,) = (line for line in capsys.readouterr().out.splitlines() if "slack_fiber" in line)
    assert line.split() == ["slack_fiber", "alpha", "family"]


def test_a_csv_of_points_in_their_own_units(made, tmp_path, capsys):
    points = tmp_path / "points.csv"
    points.write_text("alpha [rad], beta [deg], length [mm], pressure [psi]\n0.42, -43, 120, 5\n0.5, -43, 120, 50\n")
    words = ("query", str(made.path), "--points", str(points), "--variable", "rotation")
    assert run(*words, "--format", "json") == DONE
    found = json.loads(capsys.readouterr().out)
    asked = {"alpha": np.degrees(0.42), "beta": -43.0, "length": 0.12, "pressure": 5 * 6894.757293168361}
    answer = made.query(**asked, variables="rotation")
    assert found["points"][0]["rotation"] == pytest.approx(answer["rotation"].item(), rel=1e-12)
    assert found["points"][1]["status"] == "outside_atlas"
    assert found["points"][1]["rotation"] is None
    assert run(*words, "-o", str(tmp_path / "answers.csv")) == DONE  # the suffix says how
    head, first, second = (tmp_path / "answers.csv").read_text().splitlines()
    assert head.startswith(
        "alpha [degree],beta [degree],length [m],pressure [Pa],rotation [degree],rotation_error [degree]"
    )
    assert float(first.split(",")[4]) == found["points"][0]["rotation"]
    assert second.endswith(",outside_atlas")
    capsys.readouterr()
    heads = "\ufeffalpha [deg];beta [deg];length [mm];pressure [kPa(g)];operator"
    points.write_text(f"{heads}\n24,5;-43;120;30;x\n25;;120;30;y\n")
    assert run(*words, "--format", "json") == DONE
    out, err = capsys.readouterr()
    (only,) = json.loads(out)["points"]
    assert only["alpha"] == 24.5
    assert "1 column not needed and passed over: 'operator' (column 5)" in err
    assert "1 row without a number skipped (beta: line 3)" in err


def test_faults_of_a_question_are_listed(made, tmp_path, capsys):
    name = str(made.path)
    text = refused(
        capsys, "query", name, "--alpha", "24 mm", "--beta", "-43deg", "--points", str(tmp_path / "none.csv")
    )
    assert "--alpha: expects an angle" in text
    assert "there is no file" in text
    text = refused(capsys, "query", name, "--alpha", "24deg", "--beta", "-43deg")
    assert "pressure: is missing; the atlas holds 0 kPa to " in text
    assert "so give a value (a plain number is in Pa)" in text
    bad = tmp_path / "bad.csv"
    bad.write_text("alpha [deg], pressur\n24\n25, 3\n")
    text = refused(capsys, "query", name, "--points", str(bad))
    for part in ("did you mean pressure?", "line 2: 1 cells under 2 names"):
        assert part in text


def test_the_benchmark_of_the_query_is_one_table():
    row = {"points": 1000, "rate": 1e6, "single": 2e-5, "error": 1e-7}
    text = table({"nodes": 10, "repeats": 3, "rows": [{"way": "a way", **row}]})
    assert "1,000,000" in text
    assert "1.0e-07" in text


def test_who_looks_at_an_atlas_while_it_measures_itself_sees_its_numbers_and_disturbs_nothing(made, tmp_path):
    seen = {}

    def look(data):
        seen["rotation"] = data["rotation"].values
        raise RuntimeError("of no interest to a sweep")

    sweep = parse(spec(AXES))
    with run_looked_at(sweep, tmp_path / "again.nc", 2, None, False, False, 2, ["json"], look) as again:
        np.testing.assert_array_equal(seen["rotation"], made.data["rotation"].values)
        assert again.data.attrs[calibration.ATTRIBUTE] == made.data.attrs[calibration.ATTRIBUTE]
    path = tmp_path / "sweep.toml"
    path.write_text(spec(AXES))
    for name in ("one.png", "two.png"):
        assert (
            run("sweep", str(path), "-o", str(tmp_path / "map.nc"), "--map", str(tmp_path / name), "--overwrite")
            == DONE
        )
    assert run("plot", "map", str(tmp_path / "map.nc"), "-o", str(tmp_path / "plain.png")) == DONE
    pictures = {(tmp_path / name).read_bytes() for name in ("one.png", "two.png", "plain.png")}
    assert len(pictures) == 1


def test_designs_of_which_shares_are_not_told_count_where_other_numbers_are(tmp_path, monkeypatch):
    """Locked shapes had been measured without those between whose nodes fibers go slack: the hardest of them."""
    axes = {
        "alpha": [5.0, 15.0, 25.0, 35.0],
        "beta": [-20.0, 10.0, 40.0, 70.0],
        "length": [0.1, 0.2],
        "pressure": [0.0, 1e5],
    }
    text = spec(axes).replace('energy = "full"', 'energy = "full"\nmodel = "physical"')
    data, solved, compare = make(tmp_path / "atlas.nc", parse(text)), {}, measure._compare

    def look(inquiry, name, places, *rest):
        solved[name] = len(places), rest[2].mean()
        return compare(inquiry, name, places, *rest)

    monkeypatch.setattr(measure, "_compare", look)
    measure.measured(data, designs=300)
    assert solved["locked_slack_alpha"][0] < solved["locked_rotation"][0]
    assert {name: share for name, (_, share) in solved.items() if share < 1.0} == {}

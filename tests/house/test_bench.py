"""The benchmark: its peers solve the same problems, its counts are right. Nothing here is timed."""

import json
from types import SimpleNamespace

import numba
import numpy as np
import pytest
from commands import refused, run

from freesweep.bench import models, peak, scipy_bvp, solver, table
from freesweep.bench.flops import density_flops
from freesweep.bench.sample import Reference, reference, sample, typical
from freesweep.cli import DONE
from freesweep.solver.lanes.vector import WIDTH
from freesweep.solver.physics import membrane


def test_every_method_solves_the_same_problems():
    chosen = sample(4, 3, seed=5)
    exact = reference(chosen)
    assert exact.values.shape == (12, 3)
    values, seconds = scipy_bvp.solve_all(chosen, exact.stretch, 1e-6)
    assert seconds > 0.0
    assert exact.errors(values).max() < 1e-8
    assert exact.errors(solver._solve(chosen, 1e-6)).max() < 1e-6
    assert exact.errors(solver._scalar(chosen, 1e-9, 48)).max() < 1e-9


def test_errors_are_those_of_the_worse_of_length_and_rotation():
    exact = Reference(np.array([[10.0, 3.0, 0.2], [10.0, 3.0, 4.0]]), np.array([5.0, 5.0]), np.ones(2))
    assert exact.errors(exact.values + np.array([0.0, 9.0, 1e-3])) == pytest.approx([2e-3, 2.5e-4])
    assert exact.errors(exact.values + np.array([1e-3, 9.0, 0.0])) == pytest.approx([2e-4, 2e-4])
    assert typical(np.linspace(0.0, 1.0, 101)) == pytest.approx(0.95)
    assert typical(np.full(20, np.nan)) == np.inf


def test_a_sample_is_the_same_again_and_within_its_ranges():
    a, b = sample(50, 20), sample(50, 20)
    assert np.array_equal(a.problems, b.problems)
    assert not np.array_equal(a.problems, sample(50, 20, seed=1).problems)
    problems, first, pressures = a.listed()
    assert len(pressures) == first[-1] == a.size == 1000
    assert np.all((problems[:, 8] >= 8.0) & (problems[:, 8] <= 60.0))
    assert np.all(np.abs(problems[:, 1]) > 0.0)


def test_a_model_s_tubes_are_the_same_in_units_of_their_outer_radius():
    """Inner radius, wall's area and length; loads are pressures."""
    problems = sample(20, 1).problems
    rows, outer = models.as_model(problems, True, 1.0), np.sqrt(1.0 + problems[:, 2])
    assert rows[:, 11] * outer**2 == pytest.approx(1.0)
    assert rows[:, 11] + rows[:, 2] == pytest.approx(1.0)
    assert rows[:, 8] * outer == pytest.approx(problems[:, 8])
    assert np.all(rows[:, 12] == 1.0)
    assert np.all(models.as_model(problems, False, 0.0)[:, 11:] == 0.0)


def test_each_model_s_cost_is_told_beside_the_source_s(monkeypatch):
    seconds = iter([2.0, 5.0, 6.0, 12.0])
    monkeypatch.setattr("freesweep.solver.batch.walk_by_vectors", lambda *_: SimpleNamespace(status=np.array([0, -1])))
    found = models.models(sample(2, 2), 1e-6, lambda run: (next(seconds), run()))
    assert [row["times_source"] for row in found] == [1.0, 2.5, 3.0, 6.0]
    assert "  thick, loose        3e+06 us a state, 6 times the source's, 50.0 % solved" in table._models(found)


@numba.njit
def helper(y, k):
    return y * y * k, y / 3.0


@numba.njit
def density(y, v, cell, load):
    twice, _ = helper(y, cell[0])  # two products; a quotient that nobody needs
    again, _ = helper(y, cell[0])
    constant = load[0] * load[2][0] + 2.0  # does not depend on the point
    return -(twice + again) - constant, max(v, y) / twice


def test_flops_are_counted_once_and_only_where_needed():
    toy = SimpleNamespace(density=density, helper=helper)
    assert density_flops(toy) == 5  # two products, a sum, a difference, a quotient
    assert 100 < density_flops(membrane) < 300


def test_the_machine_is_faster_than_the_solver():
    most = peak.peak(seconds=0.005, repeats=2)
    assert density_flops(membrane) / peak.cell_time(repeats=2) < most
    assert peak.vector_width() in (2, 4, 8)


def test_the_command_prints_one_table_and_keeps_the_figures(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(solver.SIZES, True, (3, 2, 1, 1))
    assert run("bench", "--quick", "--json", str(tmp_path / "bench.json")) == 0
    out = capsys.readouterr().out
    for text in (
        "this solver",
        "its scalar kernel",
        "SciPy solve_bvp",
        "times solve_bvp",
        "multiply-add peak",
        "threads",
    ):
        assert text in out
    found = json.loads((tmp_path / "bench.json").read_text())
    rows = {row["method"]: row for row in found["rows"]}
    assert rows["SciPy solve_bvp"]["times_scipy"] == 1.0
    assert rows["this solver"]["error"] < 1e-6
    assert rows["this solver"]["failed"] == 0
    assert found["threads"][0]["threads"] == 1
    assert [cost["designs"] for cost in found["newton_passes"]] == [1, WIDTH]
    assert all(0.0 < cost["share_of_peak"] < 1.0 for cost in found["newton_passes"])


def test_json_is_printed_and_what_is_timed_is_no_file(capsys, monkeypatch):
    monkeypatch.setattr(solver, "measure", lambda *_: {"rows": []})
    assert run("bench", "--json") == DONE
    assert json.loads(capsys.readouterr().out) == {"rows": []}
    assert "write it before --json" in refused(capsys, "bench", "--json", "query")

"""The census: draws the whole domain, counts every state once, explains what has no result, audits the bounds."""

import json

import numpy as np
import pytest
from commands import refused, run

from freesweep.census.count import Census
from freesweep.census.designs import BLOCK, COLUMNS, PRESSURES, draw, quadrature, quadrature_held
from freesweep.census.run import census
from freesweep.scaling import OUTPUTS
from freesweep.status import NOT_CONVERGED, OK
from freesweep.sweep.records import FREE_STATE, HELD_STATE

DESIGNS = 40


@pytest.fixture(scope="module")
def small():
    return census(DESIGNS, seed=4, audit=60, threads=2, progress=False)


def test_designs_cover_the_domain_and_a_larger_census_begins_with_a_smaller_one():
    drawn = draw(BLOCK, 0, 0)
    assert np.array_equal(draw(10, 0, 0).designs, drawn.designs[:10])
    assert not np.array_equal(draw(10, 0, 1).designs, drawn.designs[:10])
    assert not np.array_equal(draw(10, 1, 0).designs, drawn.designs[:10])
    alpha, beta, length, wall, gamma, ratio, force, torque, full = drawn.designs.T
    assert np.all((np.abs(alpha) >= 2.0) & (np.abs(alpha) <= 85.0) & (np.abs(alpha - beta) >= 0.5))
    assert {(a, b) for a, b in zip(np.sign(alpha), np.sign(beta))} == {(1, 1), (1, -1), (-1, 1), (-1, -1)}
    assert np.all((length > 2.0) & (wall <= 1.0) & (gamma >= 1.0) & (ratio >= 0.0))
    for column in (gamma - 1.0, force, torque, full):
        assert 0.2 < np.mean(column == 0.0) < 0.8
    assert np.all(np.diff(drawn.pressures, axis=1) > 0.0)


def test_every_state_is_counted_once(small):
    assert sum(small.counts["free"].values()) == DESIGNS * PRESSURES
    assert sum(small.counts["locked"].values()) == DESIGNS
    assert sum(small.counts["blocked_force"].values()) == sum(small.counts["blocked_torque"].values()) == 3
    assert small.counts["free"][OK] > 0.6 * DESIGNS * PRESSURES
    assert small.audit.states > 40
    assert not small.audit.breaches
    every = [np.concatenate(ratios) for ratios in small.audit.ratios.values()]
    for ratios in every:
        assert not np.any(ratios < 1.0)


def test_threads_change_nothing(small):
    alone = census(DESIGNS, seed=4, audit=60, threads=1, progress=False)
    assert alone.counts == small.counts
    assert alone.report() == small.report()


def records(designs, values):
    found = np.zeros(len(designs), FREE_STATE)
    found["values"], found["bounds"] = values, 1e-8
    return found


def test_a_bound_that_does_not_hold_is_counted_and_the_quadrature_decides_which():
    design = np.array([30.0, -50.0, 10.0, 0.3, 1.0, 0.5, 0.0, 0.0, 0.8, 1.0])
    designs = np.array([design, design, design, design])
    exact, own = quadrature(designs, np.ones(4))
    assert np.all(own < 1e-10)
    states, finer = records(designs, exact), records(designs, exact)
    states["values"][1, 2] += 3e-8  # beyond its bound
    finer["values"][2, 0] += 3e-8  # the reference is off
    finer["status"][3] = NOT_CONVERGED
    found = Census(4, 0)
    found.audit.free(designs, states, finer)
    audit = found.audit
    assert (audit.states, len(audit.breaches), audit.acquitted, audit.differing) == (3, 1, 1, 1)
    seen = {name: np.concatenate(audit.ratios[name]).tolist() for name in OUTPUTS}
    assert seen.pop("rotation") == pytest.approx([1 / 3], rel=1e-3)
    assert seen.pop("deformed_length") == pytest.approx([1 / 3], rel=1e-3)
    assert not any(seen.values())  # differences that are rounding have no ratio
    report = found.report()
    assert "volume           3 of 3 left out" in report
    assert f"{3 * len(OUTPUTS)} bounds, 1 broken (6.67 %); 1 states" in report
    assert "1 more seemed broken" in report
    assert "rotation off by 3 times its bound: alpha 30.0, beta -50.0" in report


@pytest.mark.parametrize(("kind", "load", "near"), [("blocked_force", 6, 1.5), ("blocked_torque", 7, -1.6)])
def test_so_is_a_bound_of_a_held_state(kind, load, near):
    design = np.array([30.0, -50.0, 10.0, 0.3, 1.004, 0.5, 0.1, 0.1, 0.8, 1.0])
    design[load] = 0.0
    designs = np.array([design] * 3)
    exact, own = quadrature_held(kind, designs, np.full(3, near))
    assert np.all(own < 1e-10)
    states, finer = np.zeros(3, HELD_STATE), np.zeros(3, HELD_STATE)
    for records in (states, finer):
        records["value"], records["bound"] = exact, 1e-8
    states["value"][1] += 4e-8  # beyond its bound
    finer["value"][2] += 4e-8  # the reference is off
    found = Census(3, 0)
    found.audit.held(kind, designs, states, finer)
    assert (found.audit.states, found.audit.bounds, found.audit.acquitted) == (3, 3, 1)
    ((name, ratio, where),) = found.audit.breaches
    assert (name, where.tolist()) == (kind, design.tolist())
    assert ratio == pytest.approx(4.0, rel=1e-2)
    assert f"{kind:<16} median 0.25, least 0.25; 1 of 3 left out" in found.report()


def test_defects_are_listed_in_full_and_failures_by_where_they_lie():
    found = Census(3, 0)
    design = np.array([[30.0, -60.0, 10.0, 0.3, 1.0, 0.5, 0.0, 0.0, 9.5, 1.0]])
    found.add("free", np.repeat(design, 3, axis=0), np.array([OK, NOT_CONVERGED, OK]))
    report = found.report()
    assert "1  not_converged: " in report
    assert "pressure 9.5" in report
    listed = ", ".join(f"{name} {value!r}" for name, value in zip(COLUMNS, design[0].tolist()))
    assert f"free: {listed}" in report
    assert "every state is solved" in Census(1, 0).report()


def test_the_command(capsys):
    assert run("census", "20", "--audit", "5", "--quiet", "--seed", "3") == 0
    out = capsys.readouterr().out
    assert "20 random designs, seed 3" in out
    assert "bounds held against a mesh 4 times finer" in out
    err = refused(capsys, "census", "0", "--threads", "-1", "--seed", "-1")
    for text in ("N: found 0", "threads: found -1", "seed: found -1"):
        assert text in err


def test_all_figures_are_told_as_json(capsys, small):
    found = small.figures()
    assert json.loads(json.dumps(found)) == found
    assert sum(found["counts"]["free"].values()) == DESIGNS * PRESSURES
    assert found["counts"]["free"]["ok"] == small.counts["free"][OK]
    audit = found["audit"]
    assert (audit["states"], audit["broken"]) == (small.audit.states, [])
    told = audit["bound_over_difference"]["rotation"]
    assert told["least"] == np.min(np.concatenate(small.audit.ratios["rotation"]))
    assert run("census", "20", "--audit", "5", "--quiet", "--seed", "3", "--json") == 0
    assert json.loads(capsys.readouterr().out)["designs"] == 20

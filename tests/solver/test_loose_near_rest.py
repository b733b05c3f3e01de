"""Tubes whose threads hang loose: where their densities have corners, states are found like others."""

import numpy as np
import pytest
from test_relaxed_density import random_point

import freesweep as fs
from freesweep.scaling import problem_rows
from freesweep.solver import batch
from freesweep.solver.cells import nothing_yet, of_length
from freesweep.solver.load import Load
from freesweep.solver.physics import lagrangian, physical, uniform_tube
from freesweep.solver.problem import PHYSICAL, rubber_of, wall_of
from freesweep.solver.status import OK

KPA = np.array([0.255, 20.0, 200.0])


def problem(alpha, beta, length, radius):
    """A physical tube of the main atlas' section."""
    rubber = fs.MooneyRivlin(0.17e6, 0.08e6)
    tube = fs.Actuator(
        alpha=alpha, beta=beta, length=length, radius=radius, wall=1.59e-3, material=rubber, model="physical"
    )
    design = {name: np.array([value]) for name, value in tube.design().items()}
    return problem_rows(design | {"force": np.zeros(1), "torque": np.zeros(1)}, "full", True, True)


def point(row, p):
    """Cell and load of :mod:`lagrangian` at the pressure ``p``."""
    return tuple(row[:3]), Load(1.0, rubber_of(row), wall_of(row, PHYSICAL), p, 0.0, 0.0, 1.0)


# each was unsolved, or took minutes: the load of a stretch has corners, and L_yy jumps a hundredfold between families
@pytest.mark.parametrize(
    "design",
    [(40, -80, 0.1, 4.76e-3), (85, 52.5, 0.105, 6.1e-3), (32.5, 82.5, 0.14, 7e-3), (82.5, -70, 0.265, 3.9e-3)],
)
def test_loose_tubes_near_rest_are_solved_in_vectors(design, monkeypatch):
    monkeypatch.setattr(batch, "follow_many", lambda *arguments: None)
    found = batch.walk_all(
        problem(*design), np.array([0, len(KPA)]), KPA / 170.0, batch.uniform(24), 1e-6
    )  # fmt: skip
    assert np.all(found.status == OK)
    assert np.all(np.diff(np.abs(found.values[:, 2])) != 0.0)


@pytest.mark.parametrize("design", [(40, -80, 0.1, 4.76e-3), (82.5, -70, 0.265, 3.9e-3), (85, 52.5, 0.105, 6.1e-3)])
def test_uniform_stretch_near_rest_lies_where_l_y_vanishes(design):
    row = problem(*design)[0]
    for p in np.geomspace(1e-9, 1e-2, 36):
        cell, load = point(row, p)
        u, met = uniform_tube.near_rest(lagrangian.density, cell, load)
        below, above = (lagrangian.density(u + e, 0.0, cell, load)[1] for e in (-1e-9, 1e-9))
        assert met
        assert below > 0.0 > above


def test_density_of_a_cell_is_its_mean_along_it():
    """Against plain sums, and finite differences, where the kind changes in the cell and where not."""
    draw, seen = np.random.default_rng(4), {True: 0, False: 0}
    while min(seen.values()) < 20:
        y, v, cell, load = random_point(draw)
        h, e = draw.uniform(0.01, 0.1), 1e-6

        def at(y, v, h=h, cell=cell, load=load):
            return lagrangian.density(y, v, of_length(cell, h), load)

        places = y + (np.arange(100) + 0.5 - 50) / 100 * h * v
        found = [physical.state(one, v, cell, load, nothing_yet(0.0)) for one in places]
        parts = np.array([physical.partials(here, one, v, load) for here, one in zip(found, places)])
        if not np.all(parts[:, 0] > 0.1):
            continue
        changes = len({here.kind for here in found}) > 1
        seen[changes] += 1
        room, L_y, _, L_yy, L_yv, L_vv = at(y, v)
        spread = np.ptp(parts[:, 1])
        assert 0.0 < room <= np.max(parts[:, 0])
        assert abs(L_y - parts[:, 1].mean()) < (0.1 if changes else 0.05) * spread + 1e-9
        if changes:
            continue
        along_y, along_v = np.subtract(at(y + e, v), at(y - e, v)), np.subtract(at(y, v + e), at(y, v - e))
        unit = max(abs(L_yy), abs(L_yv), abs(L_vv), 1.0)
        for found, wanted in ((along_y[1], L_yy), (along_y[2], L_yv), (along_v[1], L_yv), (along_v[2], L_vv)):
            assert found / (2 * e) == pytest.approx(wanted, abs=1e-4 * unit)


def test_loose_fibers_that_vary_begin_under_a_torque():
    """From rest on full steps of Newton's method go to and fro between slack places at any share of these loads."""
    tube = fs.Actuator(
        alpha=[(0, -45.9), (0.758, 10.1), (1, -22.88)], beta=-79.9, length=22.399e-3, radius=2.68e-3,
        wall=[(0, 0.35e-3), (0.827, 0.35e-3), (0.827, 0.185e-3), (1, 0.185e-3)], material=fs.Yeoh(53565, 651, 0),
        model="physical",
    )  # fmt: skip
    state = fs.inflate(tube, 5465.1, torque=-2.1010101156600559e-4, x=0.0)
    assert (state["status"], state["stable"]) == (OK, 1)
    # finite elements of degree 4 in another program: the torque that holds it straight
    assert abs(state["rotation"].item()) < state["rotation_error"].item() < 1e-6

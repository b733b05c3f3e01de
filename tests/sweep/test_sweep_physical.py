"""Sweeps of physical tubes: which designs are one problem, what an atlas says of them, the numbers of single tubes."""

import math

import numpy as np
import pytest
import xarray as xr
from grids import FIXED, completed, make, spec
from shards import same_bits

from freesweep import Actuator, Atlas, MooneyRivlin, blocked_force, blocked_torque, inflate, status
from freesweep.atlas.content import dimensions, faults
from freesweep.description.tube_model import MODELS, attributes_of, model_of
from freesweep.query.exact import Tubes, solve
from freesweep.query.reference import COLUMNS, LOADED
from freesweep.scaling import ALONG, OUTPUTS
from freesweep.sweep import run
from freesweep.sweep.plan import plan
from freesweep.sweep.spec import SpecificationError, parse

PHYSICAL = attributes_of(MODELS["physical"])
GRID = {"alpha": [20.0, 30.0], "beta": [-50.0, 40.0], "wall": [1e-3, 1.59e-3], "pressure": [0.0, 2e4, 6e4]}


def physical(axes=None, words='model = "physical"', **more):
    """A sweep of tubes that [actuator] tells the words of."""
    return parse(spec(axes or GRID, **more).replace("[actuator]", f"[actuator]\n{words}"))


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        ('model = "physical"', ("outer", "thick", "loose")),
        ('model = "source"\nfibers = "loose"', ("inner", "membrane", "loose")),
        ('model = "physical"\nwall_model = "membrane"\nfiber_radius = "middle"', ("middle", "membrane", "loose")),
        ('wall_model = "thick"\nfiber_radius = "5 mm"', ("inner", "thick", "bonded")),  # the number counts
    ],
)
def test_a_specification_names_a_tube_by_one_word_or_part_by_part(words, parts):
    sweep = physical(words=words)
    assert tuple(sweep.model) == parts
    assert sweep.fixed.get("fiber_radius") == (5e-3 if "5 mm" in words else None)
    assert model_of(attributes_of(sweep.model)) == sweep.model


def test_every_fault_of_the_words_is_named():
    with pytest.raises(SpecificationError) as error:
        physical(words='model = "thesis"\nwall_model = 1\nfibers = "glued"\nfiber_radius = "inside"')
    for name in ("model", "wall_model", "fibers", "fiber_radius"):
        assert f"actuator.{name}: " in str(error.value)
    with pytest.raises(SpecificationError, match="'principal' charges a twist nothing"):
        physical(energy="principal")


@pytest.mark.parametrize(("place", "fibers"), [("inner", 4.76e-3), ("middle", 5.555e-3), ("outer", 6.35e-3)])
def test_fibers_lie_in_each_wall_where_its_size_says(place, fibers):
    sweep = physical(words=f'model = "physical"\nfiber_radius = "{place}"')
    grid = plan(sweep)["free"].grid
    columns = grid.columns(np.arange(grid.size))
    assert columns["fiber_radius"][columns["wall"] == 1.59e-3] == pytest.approx(fibers)
    varies = spec({"pressure": [0.0]}, fixed={"alpha": 20.0, "beta": -50.0, "wall": [[0.0, 2e-3], [1.0, 1e-3]]})
    thinnest = parse(varies.replace("[actuator]", f'[actuator]\nmodel = "physical"\nfiber_radius = "{place}"'))
    share = {"inner": 0.0, "middle": 0.5, "outer": 1.0}[place]
    assert plan(thinnest)["free"].grid.columns(np.arange(1))["fiber_radius"] == pytest.approx(4.76e-3 + share * 1e-3)


def test_thick_tubes_of_one_shape_are_one_problem_and_others_are_not():
    """A membrane of one area is one problem; of a thick wall both radii count."""
    sizes = {"radius": [4e-3, 8e-3], "length": [0.1, 0.2], "wall": [1e-3, 2e-3]}
    grid = {"alpha": [-30.0, 30.0], "beta": [-50.0, 50.0], **sizes, "pressure": [0.0, 2e4]}
    table = plan(physical(grid))["free"]
    # half of the designs is the mirror of the other; twice as large in all of length, radius and wall is the same
    assert table.count == 2 * (8 - 1)
    assert table.job(0, 1).problems.shape == (1, 13)
    assert plan(parse(spec(grid)))["free"].job(0, 1).problems.shape == (1, 11)
    area = 9.0e-6  # of the section in units of pi: fibers at 5 mm in walls that lie about them or within
    alike = [{"radius": math.sqrt(25e-6 - share * area)} for share in (0.25, 0.75)]
    for design, name in zip(alike, "ab"):
        design |= {"name": name, "wall": math.sqrt(design["radius"] ** 2 + area) - design["radius"]}
    pair = {"alpha": [30.0], "beta": [-50.0], "fiber_radius": [5e-3], "pressure": [2e4]}
    count = {
        words: plan(physical(pair, words=words, designs=alike))["free"].count
        for words in ('fibers = "loose"', 'wall_model = "thick"')
    }
    assert list(count.values()) == [1, 2]


def test_an_atlas_tells_its_model_and_strangers_are_refused():
    sweep = physical()
    coords = {**GRID, "fiber_extension": 1.0, "force": 0.0, "torque": 0.0}
    shape = [len(values) for values in GRID.values()]
    data = completed(xr.Dataset({"status": ([*GRID], np.zeros(shape, np.int8))}, coords))
    told = data.assign_attrs(attributes_of(sweep.model))
    assert dimensions("locked_rotation", data) == ("alpha", "beta")
    assert dimensions("locked_rotation", told) == ("alpha", "beta", "wall")  # with the wall the fibers' radius grows
    assert any("fibers is 'glued'" in fault for fault in faults(data.assign_attrs(fibers="glued")))


@pytest.mark.long  # a minute of compiling
def test_a_sweep_holds_what_single_solves_give_whoever_solves(tmp_path, monkeypatch):
    sweep = physical()
    one = make(tmp_path / "one.nc", sweep, threads=1)
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", 64)  # one problem each
    solved, solving = [], run.solve_shard

    def stops(*job):
        if len(solved) == 3:
            raise KeyboardInterrupt
        solved.append(job)
        return solving(*job)

    with monkeypatch.context() as patch:
        patch.setattr(run, "solve_shard", stops)
        with pytest.raises(KeyboardInterrupt):
            make(tmp_path / "two.nc", sweep, threads=1)
    same_bits(one, make(tmp_path / "two.nc", sweep, threads=2))
    assert set(np.unique(one.status)) == {0}
    assert set(np.unique(one.slack_fiber.sel(beta=40.0, pressure=6e4))) != {0}
    for beta in GRID["beta"]:
        at = {"alpha": 30.0, "beta": beta, "wall": 1e-3}
        tube = Actuator(
            **at, length=FIXED["length"], radius=FIXED["radius"], model="physical",
            material=MooneyRivlin(FIXED["c10"], FIXED["c01"]),
        )  # fmt: skip
        alone, stored = inflate(tube, GRID["pressure"], x=0.0), one.sel(at)
        for name in (*OUTPUTS, *ALONG):
            apart = np.abs(alone[name].values - stored[name].values)
            assert np.all(apart <= alone[f"{name}_error"].values + stored[f"{name}_error"].values)
        assert np.array_equal(alone.slack_fiber, stored.slack_fiber)


def test_where_held_tubes_are_slack_is_stored_and_solved_for_between_nodes(tmp_path):
    grid = {"alpha": [20.0, 30.0], "beta": [-50.0, 60.0], "pressure": [3e4, 6e4]}
    sweep = parse(spec(grid).replace("[actuator]", '[actuator]\nmodel = "physical"') + "\n[solver]\nblocked = true")
    made = make(tmp_path / "held.nc", sweep, threads=1)
    names = [f"blocked_{load}_slack_{family}" for load in ("force", "torque") for family in ("alpha", "beta")]
    assert float(made["blocked_force_slack_alpha"].max()) > 0.0
    for beta in grid["beta"]:
        design = {
            "alpha": 30.0,
            "beta": beta,
            "length": FIXED["length"],
            "radius": FIXED["radius"],
            "wall": FIXED["wall"],
        }
        tube = Actuator(**design, model="physical", material=MooneyRivlin(FIXED["c10"], FIXED["c01"]))
        stored = made.sel(alpha=30.0, beta=beta)
        for load, solve_one in (("force", blocked_force), ("torque", blocked_torque)):
            alone = solve_one(tube, grid["pressure"], accuracy=1e-7)
            for family in ("alpha", "beta"):
                name, own = f"blocked_{load}_slack_{family}", f"slack_{family}"
                apart = np.abs(alone[own].values - stored[name].values)
                assert np.all(apart <= alone[f"{own}_error"].values + stored[f"{name}_error"].values), name
    atlas = Atlas(made, "held.nc")
    between = atlas.query(alpha=30.0, beta=60.0, pressure=4e4, variables=names)
    assert int(between["blocked_force_slack_status"]) == status.NOT_INTERPOLABLE
    turned = atlas.query(alpha=60.0, beta=30.0, pressure=4e4, variables=names, refine=True)
    refined = atlas.query(alpha=30.0, beta=60.0, pressure=4e4, variables=names, refine=True)
    for name in names:
        assert np.isfinite(refined[name]), name
    for load in ("force", "torque"):
        one, other = f"blocked_{load}_slack_alpha", f"blocked_{load}_slack_beta"
        assert float(turned[one]) == pytest.approx(float(refined[other]), abs=float(refined[f"{other}_error"]) + 1e-9)


@pytest.mark.long  # compiles as the sweep above
def test_exact_answers_of_thick_and_loose_tubes_are_those_of_single_ones():
    tube = Actuator(
        alpha=25, beta=-45, length=0.1, radius=5e-3, wall=1.5e-3, material=MooneyRivlin(0.2e6, 0.1e6), model="physical"
    )
    point = tube.design() | {"force": 0.5, "torque": 0.0, "pressure": 3e4, "held": 1.0, "taper": 0.0, "bulge": 0.0}
    found = solve(LOADED, np.array([[point[name] for name in COLUMNS]]), Tubes("full", MODELS["physical"]), 1e-6)
    alone = inflate(tube, 3e4, force=0.5, x=0.0)
    for name in ("deformed_length", "rotation", "strain_energy"):
        both = float(alone[f"{name}_error"]) + found[f"{name}_error"][0]
        assert found[name][0] == pytest.approx(float(alone[name]), rel=0.0, abs=both)

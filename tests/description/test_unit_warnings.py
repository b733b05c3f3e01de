"""Slips of units are told, in single solves as in sweeps, and nothing else is."""

import warnings

import numpy as np
import pytest
import xarray as xr
from commands import run
from grids import swept

from freesweep import Actuator, Goal, MooneyRivlin, design, inflate, lock, tolerance
from freesweep.closed_form import region
from freesweep.description.unit_warnings import design_doubts, load_doubts
from freesweep.statics import thin_wall_attributes
from freesweep.status import NOT_CONVERGED
from freesweep.thick_wall import grid_attributes, softer
from freesweep.verification.verify import faults

USUAL = {"alpha": 30, "beta": -30, "length": 0.192, "radius": 4.76e-3, "wall": 1.59e-3, "c10": 0.11e6}


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({}, []),
        ({"length": 131.0}, ["the length is 131 m", "a length of 131 m is 2.8e+04 radii"]),
        ({"length": 131.0, "radius": 4.76, "wall": 1.59}, ["the length is 131 m", "the radius is 4.76 m"]),
        ({"length": 192.0, "wall": 1e-3}, ["the length is 192 m", "a length of 192 m is 4e+04 radii"]),
        ({"radius": 4.76e-6, "wall": 1.59e-6}, ["the radius is only", "a length of 0.192 m is 4e+04 radii"]),
        ({"wall": 1.59e-7}, ["the wall is only 1.59e-07 m"]),
        ({"wall": 5e-3}, ["wall 0.005 m is thicker than the inner radius 0.00476 m"]),
        ({"wall": 5e-3, "thick": True}, []),
        ({"wall": 0.15, "thick": True}, ["wall 0.15 m is thicker than the inner radius"]),
        (
            {"pressure": 1e5, "deformed_length": np.array([120.0])},
            ["a held length of 120 m is far from the tube's 0.192 m"],
        ),
        ({"pressure": 1e5, "deformed_length": np.array([0.12, 0.2])}, []),
        ({"alpha": 0.52, "beta": -0.52}, ["no fiber angle exceeds 0.52 degree, as if they were radians"]),
        ({"alpha": 0.0, "beta": 30.0}, []),
        ({"c10": 0.11}, ['no rubber has a c10 of 0.11 Pa ("0.11 MPa"?); plain numbers']),
        ({"c10": 5.0}, ['no rubber has a c10 of 5 Pa ("5 psi" or "5 kPa" or "5 MPa"?); plain numbers']),
        ({"c10": 0.11e12}, ["no rubber has a c10 of 1.1e+11 Pa; plain numbers"]),
        ({"pressure": 0.1}, ["no pressure exceeds 0.1 Pa"]),
        ({"pressure": 15.0}, ["no pressure exceeds 15 Pa"]),
        ({"pressure": [0.0, 15.0, 1e5]}, []),
        ({"pressure": 0.0}, []),
        ({"pressure": 1e5, "c10": 11.0}, ["the pressure reaches 100000 Pa, 9e+03 times a c10 of 11 Pa"]),
        (
            {"pressure": 1e5, "c10": 0.17},
            [
                'the pressure reaches 100000 Pa, 6e+05 times a c10 of 0.17 Pa ("0.17 MPa"?); so far beyond its rubber a tube'
            ],
        ),
        (
            {"pressure": 1e10},
            ["the pressure reaches 1e+10 Pa, 9e+04 times a c10 of 110000 Pa; so far beyond its rubber"],
        ),
        ({"pressure": 1e10, "force": 1.0}, ["the pressure reaches 1e+10 Pa, 9e+04 times a c10 of 110000 Pa; plain"]),
        ({"pressure": 1e5, "torque": 500.0}, ["a torque of 500 N m is far beyond"]),
        ({"pressure": 1e5, "force": [0.0, 10.0]}, []),
    ],
)
def test_what_looks_like_a_slip_of_units_is_told(given, says):
    loads = {name: given[name] for name in ("pressure", "force", "torque", "deformed_length") if name in given}
    design = USUAL | {name: given[name] for name in given.keys() & USUAL.keys()}
    found = load_doubts(design, loads) if loads else design_doubts(design, given.get("thick", False))
    assert (
        [sentence.startswith(start) for sentence, start in zip(found, says)]
        == [True] * len(says)
        == [True] * len(found)
    )


def test_single_tubes_and_their_loads_are_doubted_in_python():
    material = MooneyRivlin(0.11e6)
    with pytest.warns(UserWarning, match=r"the length is 200 m|the radius is 4\.76 m") as caught:
        Actuator(alpha=30, beta=-30, length=200, radius=4.76, wall=1.59, material=material)
    assert caught[0].filename == __file__
    with pytest.warns(UserWarning, match="as if they were radians"):
        Actuator(alpha=0.52, beta=-0.52, length=0.2, radius=4.76e-3, wall=1.59e-3, material=material)
    tube = Actuator(alpha=30, beta=-30, length=0.2, radius=4.76e-3, wall=1.59e-3, material=material)
    with pytest.warns(UserWarning, match=r"no pressure exceeds 0\.1 Pa") as caught:
        inflate(tube, 0.1, x=0.0)
    assert caught[0].filename == __file__


def test_a_tolerance_that_is_larger_than_what_it_is_of_is_doubted():
    """Half a millimetre that was meant for a hundredth."""
    tube = Actuator(**{name: USUAL[name] for name in USUAL if name != "c10"}, material=MooneyRivlin(0.11e6))
    with pytest.warns(UserWarning, match="a tolerance of 0.05 m of wall is more than 0.00159 m"):
        tolerance(tube, 1e5, wall=0.05, alpha=1.0, pressure_tolerance=1e3)
    goal = Goal("stroke", 0.1, pressure=1e5)
    with pytest.warns(UserWarning, match="a tolerance of 0.5 m of length is more than 0.192 m"):
        design(tube, {"alpha": (20, 40), "beta": "-alpha"}, goal, count=1, tolerances={"length": 0.5, "alpha": 2.0})


def test_the_shell_tells_slips_and_what_the_thin_wall_leaves_out(capsys):
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        run(
            *(
                "inflate",
                "--alpha",
                "30",
                "--beta",
                "-30",
                "--length",
                "131",
                "--radius",
                "4.76 mm",
                "--wall",
                "1.59 mm",
            ),
            *("--c10", "0.11 MPa", "--pressure", "0.1"),
        )
    err = capsys.readouterr().err
    assert "freesweep: warning: the length is 131 m" in err
    assert "freesweep: warning: no pressure exceeds 0.1 Pa" in err
    assert (
        "freesweep: note: wall/radius 0.33: this model takes a thin wall; a thick one deforms 1.64 times as much" in err
    )


def layer(y, axial, twist, rho2):
    """I1 - 3 of the layer of undeformed radius sqrt(rho2), of a tube whose fibers lie at radius 1."""
    r2 = y * y + (rho2 - 1.0) / axial
    return axial**2 + r2 / rho2 + r2 * twist**2 + rho2 / (axial**2 * r2) - 3.0


def test_the_effect_of_the_thin_wall_is_that_of_the_layers_of_a_thick_one():
    """Known: about 1.4 at moderate pressure for a third of the radius, 3 for a wall as thick as the radius."""
    assert softer(30, -30, 1.0, 1.0, 1.0, "full") == pytest.approx(3.03, abs=5e-3)
    assert softer(30, -30, 1.0, 1e-6, 1.0, "full") == pytest.approx(1.0, abs=1e-5)
    for alpha, beta in ((30, -30), (0, 40), (20, -60)):
        assert region(alpha, beta) in ("AF", "I", "IIa")
        ta, tb, step = np.tan(np.radians(alpha)), np.tan(np.radians(beta)), 1e-3
        y, axial, twist = 1.0 + step, 1.0 + ta * tb * step, -(ta + tb) * step
        for fibers in (1.0, 1.2, 1.5):
            inner, outer = 1.0 / fibers**2, (1.5 / fibers) ** 2
            nodes, weights = np.polynomial.legendre.leggauss(16)
            layers = layer(y, axial, twist, 0.5 * (inner + outer) + 0.5 * (outer - inner) * nodes)
            expected = layer(y, axial, twist, 1.0) / (0.5 * np.sum(weights * layers))
            assert softer(alpha, beta, 1.0, 0.5, fibers, "full") == pytest.approx(expected, rel=2e-2)


def test_thin_walls_carry_no_note():
    given = {"alpha": 30, "beta": -30, "length": 0.2, "radius": 5e-3, "material": MooneyRivlin(1e5)}
    assert thin_wall_attributes(Actuator(**given, wall=4.9e-4)) == {}
    assert thin_wall_attributes(Actuator(**given, wall=[(0, 4e-4), (1, 5.1e-4)]))["thin_wall_ratio"] > 1.05


def test_sweeps_and_their_answers_say_what_the_thin_wall_leaves_out(tmp_path, capsys):
    axes = {"alpha": [20.0, 30.0], "beta": [-50.0, -45.0], "wall": [2e-4, 1.59e-3], "pressure": [0.0, 5e4]}
    with swept(tmp_path, axes) as atlas:
        thick = Actuator(alpha=30, beta=-45, length=0.1, radius=4.76e-3, wall=1.59e-3, material=MooneyRivlin(1e5))
        alone = thin_wall_attributes(thick)["thin_wall_ratio"]
        ratios = [softer(a, b, 4.76e-3, 1.59e-3, 4.76e-3, "full") for a in axes["alpha"] for b in axes["beta"]]
        assert alone in ratios
        assert atlas.data.attrs["thin_wall_ratio"] == pytest.approx(max(ratios), rel=1e-12)
        assert f"deforms {min(ratios):.3g} to {max(ratios):.3g} times" in atlas.data.attrs["thin_wall_note"]
        place = {"alpha": 30.0, "beta": -45.0, "pressure": 5e4}
        answer = atlas.query("rotation", wall=1.59e-3, **place)
        assert answer.attrs["thin_wall_ratio"] == pytest.approx(alone, rel=1e-12)
        assert "thin_wall_note" not in atlas.query("rotation", wall=2e-4, **place).attrs
        assert "thin_wall_note" not in atlas.query("ideal_blocked_torque", alpha=30, beta=-45, pressure=5e4).attrs
    assert faults(atlas.path) == []
    run("info", str(atlas.path))
    assert "wall/radius up to 0.33: this model takes a thin wall" in capsys.readouterr().out
    run(
        "query",
        str(atlas.path),
        "--alpha=30",
        "--beta=-45",
        "--wall=1.59mm",
        "--pressure=50kPa",
        "--variable",
        "rotation",
    )
    assert "freesweep: note: wall/radius 0.33: this model takes a thin wall" in capsys.readouterr().err


@pytest.mark.parametrize("profiles", [True, False], ids=("profiles", "designs"))
def test_the_note_of_an_atlas_is_that_of_its_worst_tube(profiles):
    angles = np.array([10.0, 35.0, 60.0])
    design = ("design",) if not profiles else ()
    data = xr.Dataset(
        coords={
            "radius": ((), 5e-3), "fiber_radius": (("fiber_radius",), [5e-3, 5.5e-3, 8e-3]), "wall": ((), 1e-3),
            **({} if profiles else {"alpha": (design, angles), "beta": (design, -2.0 * angles[::-1] + 40.0)}),
        },
        attrs={"energy": "full"} | ({"profile_alpha": [0, 10, 1, 60], "profile_beta": [0, -80, 1, 20]} if profiles else {}),
    )  # fmt: skip
    alpha = np.linspace(10.0, 60.0, 33) if profiles else angles
    beta = np.linspace(-80.0, 20.0, 33) if profiles else -2.0 * angles[::-1] + 40.0
    ratios = np.stack([softer(alpha, beta, 5e-3, 1e-3, fibers, "full") for fibers in (5e-3, 5.5e-3)])
    worst = ratios.ravel()[np.argmax(np.abs(np.log(ratios)))]
    assert grid_attributes(data)["thin_wall_ratio"] == pytest.approx(worst, rel=1e-12)


@pytest.mark.filterwarnings("ignore:no rubber", "ignore:the pressure reaches")
def test_where_the_rubber_is_nothing_the_shape_is_the_locked_one_or_the_status_says_so():
    """What a tube differs by from its locked shape falls as c10 over pressure, until digits run out."""
    tube = {"alpha": 30, "beta": -30, "length": 0.192, "radius": 4.76e-3, "wall": 1.59e-3}
    soft = Actuator(**tube, material=MooneyRivlin(1.0, 0.5))
    locked = lock(soft, x=0.0)
    near = inflate(soft, [1e3, 1e4], x=0.0)
    apart = (near.deformed_length / locked.deformed_length - 1.0) * near.pressure
    assert apart.values == pytest.approx([0.5722, 0.5722], abs=1e-3)
    with pytest.warns(UserWarning, match="no state was found: where the pressure is 1e4 times the rubber"):
        assert int(inflate(soft, 1e9, x=0.0).status) == NOT_CONVERGED

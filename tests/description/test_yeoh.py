"""Yeoh rubbers: convexity, the small-strain limit, equilibria against quadrature and collocation, sweeps, calibration."""

import warnings

import numpy as np
import pytest
import xarray as xr
from commands import run
from grids import make, swept
from oracle import collocation, first_integral

from freesweep import (
    Actuator,
    ActuatorError,
    Measurement,
    NeoHookean,
    Yeoh,
    blocked_force,
    blocked_torque,
    calibrate,
    closed_form,
    inflate,
    materials,
)  # fmt: skip
from freesweep.cli import DONE
from freesweep.description.elastomer import convex_to
from freesweep.description.strain import invariant, membrane
from freesweep.status import BEYOND_LIMIT
from freesweep.sweep.spec import SpecificationError, parse
from freesweep.verification.cross_check import draw, resolve

SIZES = {"length": 0.08, "radius": 5e-3, "wall": 1.5e-3}
AREA, HALF_LENGTHS = (6.5**2 - 25) / 25, 16.0
SILICONES = ("ecoflex-00-30", "dragon-skin-30", "elastosil-m4601")
SOFTENING = Yeoh(60e3, -2.4e3, 160.0)  # softens first, stiffens then: convex all the way


def ratios(rubber):
    return tuple(value / rubber.c10 for value in (rubber.c01, rubber.c20, rubber.c30))


@pytest.mark.parametrize(
    "constants", [(90e3, 9e3, -4e3), (90e3, -5e3, 0.0), (90e3, 0.0, -1e3), (90e3, -30e3, 2e3), (1.0, -1 / 6, 0.0)]
)
def test_a_yeoh_energy_is_convex_up_to_where_a_sheared_block_gives_way(constants):
    c1, c2, c3 = constants
    shear = np.linspace(0, 8, 80_001)
    i = shear**2
    stress = 2 * shear * (c1 + 2 * c2 * i + 3 * c3 * i**2)
    falls = i[1 + np.argmax(np.diff(stress) < 0)]
    assert convex_to(*constants) == pytest.approx(falls, rel=1e-3)
    with pytest.warns(UserWarning, match=r"convex only up to I1 - 3 = .*, a strip drawn to .* times its length"):
        rubber = Yeoh(*constants)
    assert (rubber.c10, rubber.c01, rubber.c20, rubber.c30) == (c1, 0.0, c2, c3)


def test_a_yeoh_energy_that_is_convex_as_far_as_it_is_used_gives_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert convex_to(9e4, [0.0, 9e3, 9e3, -9e3], [0.0, 0.0, 1e3, 2e3]).tolist() == [np.inf] * 4
        Yeoh(9e4, 9e3, -4e3, largest_stretch=1.5)
        Yeoh(9e4, -9e3, 2e3)


def test_every_fault_of_a_yeoh_rubber_is_named():
    with pytest.raises(ActuatorError) as error:
        Yeoh(0.0, "1 mm", np.nan, largest_stretch=1.0)
    assert [fault.split(":")[0] for fault in error.value.faults] == ["c1", "c2", "c3", "largest_stretch"]


def test_neo_hookean_is_yeoh_without_its_higher_constants():
    pressure = [1e4, 8e4]
    one, other = (
        inflate(Actuator(alpha=20, beta=-50, **SIZES, material=rubber), pressure, 0.3, 1e-3)
        for rubber in (NeoHookean(0.1e6), Yeoh(0.1e6))
    )
    for name in one.data_vars:  # plain Python, which first states are solved in, does not fuse what machine code does
        if not name.endswith("_error"):
            xr.testing.assert_allclose(one[name].drop_attrs(), other[name].drop_attrs(), rtol=1e-9, atol=1e-9)


def test_a_hardly_strained_wall_feels_the_first_constant_only():
    """The higher constants count by the square of the strain: of a hundredth of the pressure, a ten-thousandth."""
    apart = []
    for pressure in (2e3, 2e2):
        soft, stiff = (
            inflate(Actuator(alpha=0, beta=35, **SIZES, material=rubber), pressure, x=0.0)["rotation"].item()
            for rubber in (NeoHookean(0.1e6), Yeoh(0.1e6, 0.1e6, 0.1e6))
        )
        apart.append(abs(stiff / soft - 1.0))
    assert apart[1] < 0.02 * apart[0] < 2e-4


@pytest.mark.parametrize("rubber", [*(materials[name] for name in SILICONES), SOFTENING], ids=[*SILICONES, "softening"])
@pytest.mark.parametrize(("alpha", "beta", "p", "loads"), [
    (30, -30, 0.4, (0.0, 0.0)), (0, 30, 0.9, (0.05, 0.02)), (20, -60, 3.0, (-0.1, 0.0)),
])  # fmt: skip
def test_equilibria_against_the_first_integral(rubber, alpha, beta, p, loads):
    r, c10 = 5e-3, rubber.c10
    tube = Actuator(alpha=alpha, beta=beta, **SIZES, material=rubber, fiber_extension=1.002)
    force, torque = loads[0] * np.pi * r**2 * c10, loads[1] * np.pi * r**3 * c10
    found = inflate(tube, p * c10, force, torque, x=[0.0, 0.004, 0.04])
    shape = first_integral(alpha, beta, HALF_LENGTHS, AREA, ratios(rubber), p, *loads, 1.002, stations=(0.8, 8.0))
    wanted = {
        "deformed_length": shape.length * r, "volume": shape.volume * np.pi * r**3, "rotation": np.degrees(shape.rotation),
        "strain_energy": shape.energy * np.pi * r**3 * c10, "mid_radius": shape.middle * r,
    }  # fmt: skip
    for output, value in wanted.items():
        own = 2e-9 * abs(value)  # the oracle's
        assert abs(found[output].item() - value) <= found[f"{output}_error"].item() + own, output
    assert found["deformed_radius"].values[1:] / r == pytest.approx(shape.y, rel=1e-7)


def test_a_wall_that_varies_against_collocation():
    rubber = materials["dragon-skin-30"]
    tube = Actuator(alpha=25, beta=-40, **SIZES | {"wall": [(0, 1e-3), (1, 2e-3)]}, material=rubber)
    found = inflate(tube, 0.5 * rubber.c10, x=[0.02, 0.04])

    def cell(x):
        wall = 1e-3 * (1 + x / 16.0)
        return np.full_like(x, 25.0), np.full_like(x, -40.0), ((5e-3 + wall) ** 2 - 25e-6) / 25e-6

    length, _, rotation, energy, _, y = collocation(
        cell, 16.0, ratios(rubber), [0.1, 0.3, 0.5], stations=[4.0, 8.0], symmetric=False
    )[-1]  # fmt: skip
    assert found["deformed_length"].item() == pytest.approx(length * 5e-3, rel=1e-8)
    assert found["rotation"].item() == pytest.approx(np.degrees(rotation), rel=1e-8)
    assert found["strain_energy"].item() == pytest.approx(energy * np.pi * 125e-9 * rubber.c10, rel=1e-7)
    assert found["deformed_radius"].values / 5e-3 == pytest.approx(y, rel=1e-8)


def test_a_held_state_is_that_of_its_load():
    """Blocked force and torque, put on as loads, keep what was held."""
    rubber = materials["ecoflex-00-30"]
    tube = Actuator(alpha=20, beta=-50, **SIZES, material=rubber, fiber_extension=1.005)
    force = blocked_force(tube, 8e3, 0.07)["force"].item()
    assert inflate(tube, 8e3, force)["deformed_length"].item() == pytest.approx(0.07, rel=1e-8)
    torque = blocked_torque(tube, 8e3, 20.0)["torque"].item()
    assert inflate(tube, 8e3, torque=torque)["rotation"].item() == pytest.approx(20.0, rel=1e-7)


def test_the_held_cylinder_buckles_at_the_pressure_of_its_first_constant():
    """Nothing is strained in it: the closed form of the first constant holds, whatever the others."""
    rubber = Yeoh(0.1e6, 0.05e6, 0.01e6)
    tube = Actuator(alpha=0, beta=30, **SIZES, material=rubber)
    critical = closed_form.critical_pressure(0, 30, 0.08, 5e-3, 1.5e-3, rubber.c10)
    held = blocked_torque(tube, critical * np.array([0.99, 1.01]))
    assert held["stable"].values.tolist() == [1, 0]
    assert held["torque"].values == pytest.approx(
        closed_form.blocked_torque(0, 30, 5e-3, held["pressure"].values), rel=1e-9
    )


def test_fiber_tensions_balance_the_free_tube():
    """No force on a section: the axial part of fiber tension and of the wall's stress carries the pressure on the ends."""
    rubber, r = materials["dragon-skin-30"], 5e-3
    tube = Actuator(alpha=30, beta=-30, length=0.4, radius=r, wall=1.5e-3, material=rubber)
    state = inflate(tube, 0.1e6, x=0.2)
    y = state["deformed_radius"].item() / r
    axial = np.sqrt(1 + np.tan(np.pi / 6) ** 2 * (1 - y**2))
    i = axial**2 + y**2 + 1 / (axial * y) ** 2 - 3
    slope = rubber.c1 + 2 * rubber.c2 * i + 3 * rubber.c3 * i**2
    wall = np.pi * (6.5e-3**2 - r**2) * 2 * slope * (axial - axial**-3 * y**-2)  # per undeformed section
    fibers = sum(
        state[f"fiber_tension_{name}"].item() * np.cos(np.radians(state[f"{name}_deformed"].item()))
        for name in ("alpha", "beta")
    )
    assert wall + fibers == pytest.approx(0.1e6 * np.pi * (y * r) ** 2, rel=1e-6)


def test_a_state_beyond_convexity_is_warned_of():
    with pytest.warns(UserWarning, match="convex only up to"):
        rubber = Yeoh(90e3, 9e3, -4e3)
    tube = Actuator(alpha=10, beta=50, **SIZES, material=rubber)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        near = inflate(tube, 5e4, x=0.0)
    assert invariant(*membrane(10, 50, near["mid_radius"].item() / 5e-3, 1.0, "full")) < convex_to(90e3, 9e3, -4e3)
    with pytest.warns(UserWarning, match=r"strained to I1 - 3 = .*, but Yeoh\(.*\) is convex only up to 1.75") as seen:
        inflate(tube, [5e4, 3e5], x=0.0)
    assert [warning.filename for warning in seen] == [__file__]


def test_constants_are_recovered_from_curves(tmp_path, capsys):
    rubber = Yeoh(90e3, 9e3, 200.0)
    pressure = np.linspace(1e4, 2e5, 8)
    curves, rows = [], ["alpha [deg],beta [deg],pressure [Pa],deformed_length [m]"]
    for alpha, beta in ((20, -20), (10, 50)):
        exact = inflate(Actuator(alpha=alpha, beta=beta, **SIZES, material=rubber), pressure, x=0.0)
        guess = Actuator(alpha=alpha, beta=beta, **SIZES, material=Yeoh(0.2e6))
        curves.append(Measurement(guess, pressure, deformed_length=exact["deformed_length"].values))
        rows += [
            f"{alpha},{beta},{p!r},{y!r}" for p, y in zip(pressure.tolist(), exact["deformed_length"].values.tolist())
        ]
    found = calibrate(curves, ["c1", "c2", "c3"])
    assert found.values == pytest.approx([90e3, 9e3, 200.0], rel=1e-3)
    assert isinstance(found.material, Yeoh)
    (tmp_path / "curves.csv").write_text("\n".join(rows))
    sizes = [f"--{name}={value}" for name, value in SIZES.items()]
    assert run("calibrate", str(tmp_path / "curves.csv"), *sizes, "--fit", "c1", "c2", "c3") == DONE
    shown = capsys.readouterr().out
    assert "Yeoh(c1=" in shown
    rows = {line.split()[0]: line.split() for line in shown.splitlines() if line.strip()}
    assert float(rows["c1"][1]) == pytest.approx(0.09, rel=1e-3)
    assert float(rows["c2"][1]) == pytest.approx(0.009, rel=1e-2)


SWEEP = """
[actuator]
length = "100 mm"
radius = "5 mm"
wall = "1.5 mm"
c10 = "92.2 kPa"
[axes]
alpha = ["5 deg", "40 deg"]
beta = ["-60 deg", "30 deg"]
c20 = [0, 9.03e3]
c30 = ["-1 kPa", "0 kPa"]
pressure = ["20 kPa", "0.1 MPa", "0.8 MPa"]
"""


def test_a_sweep_over_the_constants_stands_the_second_method(tmp_path):
    dataset = make(tmp_path / "a.nc", parse(SWEEP))
    soft = dataset.sel(c30=-1e3, beta=30.0)
    assert np.all(soft["status"].sel(pressure=8e5) == BEYOND_LIMIT)  # a rubber that gives way has a limit pressure
    assert np.all(np.isfinite(soft["limit_pressure"]))
    comparisons, _ = resolve(draw(dataset, dataset["status"].size))
    judged = {c.name: (c.difference <= c.bound + c.own) for c in comparisons}
    assert {"deformed_length", "rotation", "strain_energy", "limit_pressure"} <= set(judged)
    assert all(within.size > 2 and np.all(within) for within in judged.values())
    tube = Actuator(alpha=40, beta=-60, length=0.1, radius=5e-3, wall=1.5e-3, material=Yeoh(92.2e3, 9.03e3))
    here = dataset["rotation"].sel(alpha=40, beta=-60, c20=9.03e3, c30=0.0, pressure=1e5).item()
    assert here == pytest.approx(inflate(tube, 1e5)["rotation"].item(), rel=1e-7)


def test_an_atlas_answers_between_constants(tmp_path):
    axes = {"alpha": [20.0, 25.0, 30.0, 35.0], "beta": [-60.0, -55.0, -50.0, -45.0], "c20": [0.0, 4e3, 8e3, 12e3]}
    axes["pressure"] = [4e4, 7e4, 1e5, 1.3e5]
    with swept(tmp_path, axes, fixed={"c01": 0.0, "c10": 90e3, "c30": 100.0}) as atlas:
        here = {"alpha": 27.0, "beta": -52.0, "c20": 7e3, "pressure": 9e4}
        names = ["deformed_length", "rotation", "strain_energy"]
        between, exact = (atlas.query(**here, variables=names, refine=refine, **more)
                          for refine, more in ((False, {}), (True, {"x": [0.05]})))  # fmt: skip
        sizes = {"length": 0.1, "radius": 4.76e-3, "wall": 1.59e-3}
    tube = Actuator(alpha=27, beta=-52, **sizes, material=Yeoh(90e3, 7e3, 100.0))
    alone = inflate(tube, 9e4, x=[0.05])
    for name in names:
        assert between[name].item() == pytest.approx(alone[name].item(), abs=between[f"{name}_error"].item())
        assert between[f"{name}_error"].item() < 2e-3 * abs(alone[name].item())
    assert exact["deformed_radius"].item() == pytest.approx(alone["deformed_radius"].item(), rel=1e-8)


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("[axes]", 'c01 = "1 kPa"\n[axes]', "actuator.c01: a Yeoh rubber, with c20 or c30, has no c01"),
        ("c20 = [0, 9.03e3]", "c2 = [0, 9.03e3]", "axes.c2: unknown key; Yeoh's C2 is c20 here"),
        ('c10 = "92.2 kPa"', 'c10 = "92.2 kPa"\nc1 = 5', "actuator.c1: unknown key; Yeoh's C1 is c10 here"),
    ],
)
def test_a_specification_says_what_no_yeoh_rubber_is(old, new, fault):
    with pytest.raises(SpecificationError) as error:
        parse(SWEEP.replace(old, new))
    assert len(error.value.faults) == 1
    assert error.value.faults[0].startswith(fault)

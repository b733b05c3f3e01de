"""Rubbers: the library of published constants, and the range in which they hold."""

import warnings

import numpy as np
import pytest
from commands import refused, run
from grids import make

from freesweep import (
    Actuator,
    ActuatorError,
    MooneyRivlin,
    NeoHookean,
    blocked_force,
    inflate,
    lock,
    material,
    materials,
)  # fmt: skip
from freesweep.cli import DONE
from freesweep.description.strain import largest_stretch
from freesweep.sweep.spec import SpecificationError, parse
from freesweep.verification.cross_check import draw, resolve

DRAWN = {  # nominal stress [MPa] at stretch, from the tensile tests of the database that the library cites
    "ecoflex-00-30": {1.5: 0.01689, 2: 0.02972, 3: 0.05239, 4: 0.08015},
    "dragon-skin-30": {1.25: 0.11087, 1.5: 0.2139, 2: 0.4371, 3: 0.9595},
}
SIZES = {"length": 0.08, "radius": 5e-3, "wall": 1.5e-3}


def strip(rubber, stretch):
    """Nominal stress of a strip under tension: derivative of its energy along the stretch (complex step)."""
    x = stretch + 1e-30j
    first, second = x**2 + 2 / x - 3, 2 * x + 1 / x**2 - 3
    energy = rubber.c10 * first + rubber.c01 * second + rubber.c20 * first**2 + rubber.c30 * first**3
    return np.imag(energy) / 1e-30


@pytest.mark.parametrize("name", materials)
def test_every_rubber_of_the_library_says_where_it_comes_from_and_how_far_it_holds(name):
    rubber = material(name.upper().replace("-", " "))
    assert rubber is materials[name]
    assert len(rubber.source) > 40
    stretches = np.linspace(1.0, rubber.largest_stretch, 200)
    assert np.all(np.diff(strip(rubber, stretches)) > 0)


@pytest.mark.parametrize("name", DRAWN)
def test_constants_meet_the_tensile_tests_that_they_cite(name):
    stretch, stress = np.array(list(DRAWN[name])), np.array(list(DRAWN[name].values())) * 1e6
    assert strip(materials[name], stretch) == pytest.approx(stress, abs=0.02 * stress[-1])


def test_latex_of_table_1():
    constants = [(materials[name].c10, materials[name].c01) for name in materials if name.startswith("natural-latex")]
    assert constants == [(0.11e6, 0.06e6), (0.18e6, 0.12e6), (0.18e6, 0.10e6)]


@pytest.mark.parametrize(
    ("made", "faults"),
    [
        (
            lambda: material("ecoflx-0030"),
            ["material: found 'ecoflx-0030'; did you mean 'ecoflex-00-30'? The library holds"],
        ),
        (lambda: material(7), ["material: found int 7; The library holds natural-latex"]),
        (lambda: MooneyRivlin(1e5, largest_stretch=0.9), ["largest_stretch: found 0.9; it has to be above 1"]),
        (lambda: NeoHookean(1e5, largest_stretch="2 mm"), ["largest_stretch: expects a number"]),
    ],
)
def test_every_fault_of_a_rubber_is_named(made, faults):
    with pytest.raises(ActuatorError) as error:
        made()
    assert [found.startswith(fault) for found, fault in zip(error.value.faults, faults, strict=True)] == [True] * len(
        faults
    )


@pytest.mark.parametrize("energy", ["full", "principal"])
def test_largest_stretch_is_that_of_the_deformation_gradient(energy):
    for alpha, beta, y in ((10, 50, 1.6), (0, 30, 2.5), (60, -70, 0.92), (30, -30, 1.3)):
        ta, tb = np.tan(np.radians([alpha, beta]))
        half_sum, half_difference, gamma = (ta + tb) / 2, (ta - tb) / 2, 1.01
        psi = half_sum * (gamma**2 / y**2 - 1)
        along = np.sqrt(gamma**2 * (1 + ta**2) - (y * (ta + psi)) ** 2)  # Eq. 2.3
        assert along**2 == pytest.approx(gamma**2 * (1 + half_sum**2 + half_difference**2)
                                         - half_difference**2 * y**2 - gamma**4 * half_sum**2 / y**2)  # fmt: skip
        gradient = np.array([[along, 0.0], [y * psi * (energy == "full"), y]])
        stretches = [*np.linalg.svd(gradient)[1], 1 / (along * y)]
        assert largest_stretch(alpha, beta, y, gamma, energy) == pytest.approx(max(stretches), rel=1e-12)


def test_a_solution_that_leaves_the_range_of_its_rubber_is_warned_of():
    latex = material("natural-latex")
    tube = Actuator(alpha=10, beta=50, **SIZES, material=latex)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        near = inflate(tube, 1e5)
        lock(tube)  # its shape is that of any rubber
        inflate(Actuator(alpha=10, beta=50, **SIZES, material=MooneyRivlin(latex.c10, latex.c01)), 4e5)
    assert near["mid_radius"].item() < 1.64 * 5e-3
    for x in (None, 0.0):
        with pytest.warns(UserWarning, match="stretched 2.* times, but the constants .* known to hold to 1.64") as seen:
            inflate(tube, [1e5, 4e5], x=x)
        assert [warning.filename for warning in seen] == [__file__]
    muscle = Actuator(alpha=30, beta=-30, **SIZES, material=material("natural-latex-40"))
    with pytest.warns(UserWarning, match="known to hold to 1.28"):
        assert blocked_force(muscle, 4e5, 0.064)["status"] == 0


SWEEP = """
title = "A silicone"
[actuator]
length = "100 mm"
radius = "5 mm"
wall = "1.5 mm"
material = "dragon-skin-30"
[axes]
alpha = ["5 deg", "40 deg", "65 deg"]
beta = ["-60 deg", "-15 deg", "30 deg"]
fiber_extension = [1.0, 1.005]
pressure = ["20 kPa", "0.1 MPa", "1.6 MPa"]
[solver]
blocked = true
"""


def test_a_sweep_of_a_named_rubber_stands_the_second_method(tmp_path):
    with (
        pytest.warns(UserWarning, match="2 states strain the wall beyond where its Yeoh energy is convex"),
        pytest.warns(
            UserWarning, match="4 states stretch the wall by more than 3, to which the constants of dragon-skin-30"
        ),
    ):
        dataset = make(tmp_path / "a.nc", parse(SWEEP))
    assert (dataset["c10"], dataset["c01"], dataset["c20"], dataset["c30"]) == (92.2e3, 0.0, 9.03e3, -357.0)
    assert "10.1089/soro.2019.0115" in dataset.attrs["material_source"]
    comparisons, _ = resolve(draw(dataset, dataset["status"].size))
    judged = {c.name: (c.difference <= c.bound + c.own) for c in comparisons}
    assert {"deformed_length", "rotation", "strain_energy", "blocked_force", "blocked_torque"} <= set(judged)
    assert {name: (within.size > 2, bool(np.all(within))) for name, within in judged.items()} == dict.fromkeys(
        judged, (True, True)
    )
    tube = Actuator(alpha=40, beta=-60, length=0.1, radius=5e-3, wall=1.5e-3, material=material("dragon-skin-30"))
    alone = inflate(tube, 1e5)["rotation"].item()
    assert dataset["rotation"].sel(alpha=40, beta=-60, fiber_extension=1, pressure=1e5).item() == pytest.approx(
        alone, rel=1e-7
    )


def test_a_name_excludes_constants():
    assert parse(SWEEP).fixed["c20"] == 9.03e3
    assert parse(SWEEP).material == "dragon-skin-30"
    for text, fault in (
        (SWEEP.replace("[axes]", 'c01 = "1 kPa"\n[axes]'), "actuator.c01: actuator.material names the rubber"),
        (SWEEP.replace("[solver]", "c10 = [1e5, 2e5]\n[solver]"), "axes.c10: given twice, also as actuator.material"),
        (
            SWEEP.replace("dragon-skin-30", "dragonskin30"),
            "actuator.material: found 'dragonskin30'; did you mean 'dragon-skin-30'",
        ),
        (
            SWEEP.replace("[solver]", 'material = ["a"]\n[solver]'),
            "axes.material: unknown key; it belongs in [actuator]",
        ),
    ):
        with pytest.raises(SpecificationError) as error:
            parse(text)
        assert len(error.value.faults) == 1
        assert error.value.faults[0].startswith(fault)


MUSCLE = ["--alpha", "30", "--beta", "-30", "--length", "80 mm", "--radius", "5 mm", "--wall", "1.5 mm"]


def test_the_command_line_knows_rubbers_by_name_and_by_constants(capsys):
    shown = []
    for rubber in (["--material", "elastosil-m4601"], ["--c1", "0.11 MPa", "--c20", "20 kPa"]):
        assert run("inflate", *MUSCLE, *rubber, "--pressure", "90 kPa") == DONE
        shown.append(capsys.readouterr().out)
    expected = inflate(
        Actuator(alpha=30, beta=-30, **SIZES, material=material("elastosil-m4601")), 9e4
    )["deformed_length"].item()  # fmt: skip
    assert float(shown[0].splitlines()[1].split()[0]) == pytest.approx(1e3 * expected, rel=1e-6)
    assert shown[0] == shown[1]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--material", "ecoflex"], "material: found 'ecoflex'; did you mean 'ecoflex-00-30'?"),
        (["--material", "ecoflex-00-30", "--c01", "1 kPa"], "--material: --c01 is given too; give a name or constants"),
        (["--c10", "1 kPa", "--c01", "1 kPa", "--c30", "1 kPa"], "--c01: a Yeoh rubber, with --c20 or --c30, has none"),
        (["--c1", "0 Pa", "--c2", "1 Pa"], "c1: found 0 Pa; it has to be above 0"),
        ([], "--c10: is missing; give the constants of the rubber, or its name, --material"),
    ],
)
def test_what_no_rubber_is_is_refused(words, says, capsys):
    assert says in refused(capsys, "inflate", *MUSCLE, *words, "--pressure", "1 kPa")


def test_the_locked_shape_of_a_wall_with_negative_energy_is_that_of_any_other():
    """Stretched seven times the Yeoh energy of Dragon Skin 30 is below 0: fibers alone tell the shape."""
    sizes = {"alpha": 40, "beta": 30, "length": 0.1, "radius": 5e-3, "wall": 1.5e-3}
    other, own = (lock(Actuator(**sizes, material=one)) for one in (MooneyRivlin(1e5), material("dragon-skin-30")))
    assert int(own["status"]) == 0
    assert float(own["strain_energy"]) < 0.0
    for name in ("deformed_length", "rotation", "mid_radius", "volume"):
        assert abs(float(own[name] - other[name])) <= float(own[f"{name}_error"] + other[f"{name}_error"])

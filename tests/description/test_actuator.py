"""The description of an actuator is checked as a whole: every fault at once, what was found and what is allowed."""

import dataclasses
import math

import numpy as np
import pytest

import freesweep
from freesweep import Actuator, ActuatorError, MooneyRivlin, NeoHookean

RUBBER = MooneyRivlin(c10=0.11e6, c01=0.06e6)
PAM = {"alpha": 30, "beta": -30, "length": 0.192, "radius": 4.76e-3, "wall": 1.59e-3, "material": RUBBER}


def faults_of(build, **changes):
    with pytest.raises(ActuatorError) as caught:
        build(**changes)
    return caught.value.faults


def tube_faults(**changes):
    return faults_of(Actuator, **(PAM | changes))


def test_the_description_is_kept_as_given_and_frozen():
    tube = Actuator(**PAM)
    assert (tube.alpha, tube.beta, tube.length, tube.radius, tube.wall) == (30, -30, 0.192, 4.76e-3, 1.59e-3)
    assert (tube.fiber_extension, tube.fiber_radius, tube.energy, tube.material) == (1.0, None, "full", RUBBER)
    with pytest.raises(dataclasses.FrozenInstanceError):
        tube.alpha = 20.0


@pytest.mark.parametrize("kind", [int, np.float64, np.float32, np.int64])
def test_integers_and_numpy_scalars_become_floats(kind):
    tube = Actuator(**PAM | {"alpha": kind(30), "length": kind(2), "fiber_extension": kind(1)})
    assert all(type(value) is float for value in (tube.alpha, tube.length, tube.fiber_extension))
    assert (tube.alpha, tube.length) == (30.0, 2.0)


@pytest.mark.parametrize("name", ["alpha", "beta", "length", "radius", "wall", "fiber_extension", "fiber_radius"])
@pytest.mark.parametrize(
    ("value", "says"),
    [
        ("4.76 N", "expects a"),
        (10**400, "found a whole number of more than 38 digits; give a number that a float can hold"),
        (np.ma.masked, "found MaskedConstant with a value masked; leave those out"),
        (True, "found bool True; give one number in ["),
        (math.nan, "found nan; give a finite number in ["),
        (math.inf, "found inf; give a finite number in ["),
        ({1: 2.0}, "found dict {1: 2.0}; give one number in ["),
        (1j, "found complex 1j; give one number in ["),
    ],
)
def test_what_is_no_finite_number_is_refused_with_the_unit_to_give(name, value, says):
    (fault,) = tube_faults(**{name: value})
    assert fault.startswith(f"{name}: {says}")


def test_a_missing_number_is_refused():
    (fault,) = tube_faults(length=None)
    assert fault.startswith("length: found NoneType None")


def test_every_fault_is_listed_at_once():
    faults = tube_faults(
        alpha="30 mm", beta=math.nan, length=0.0, radius=-1.0, wall=True, fiber_extension=0.99, fiber_radius=0.0,
        material=1e5, energy="Full",
    )  # fmt: skip
    assert [fault.split(":")[0] for fault in faults] == [
        *("alpha", "beta", "length", "radius", "wall", "fiber_extension", "fiber_radius", "material", "energy")
    ]
    assert "it has to be above 0" in faults[2]
    assert "found -1 m" in faults[3]
    assert "found 0.99; it has to be 1 or more" in faults[5]
    assert "found float; give MooneyRivlin(c10, c01), NeoHookean(c10) or Yeoh(c1, c2, c3), in [Pa]" in faults[7]
    assert faults[8] == "energy: found str 'Full'; choose one of 'full', 'principal'"


def test_numbers_that_are_fine_alone_but_impossible_are_all_listed_too():
    faults = tube_faults(alpha=90, beta=-90.0, fiber_radius=1.0)
    assert [fault.split(":")[0] for fault in faults] == ["alpha", "beta", "fiber_radius"]
    assert "found 90 degree; it has to lie between -90 and 90, both excluded" in faults[0]
    assert "0.00476 to 0.00635 m" in faults[2]


def test_the_message_names_each_fault_on_its_own_line():
    with pytest.raises(ActuatorError) as caught:
        Actuator(**PAM | {"length": 0, "energy": None})
    assert isinstance(caught.value, ValueError)
    assert [line[:4] for line in str(caught.value).splitlines()[1:]] == ["  - "] * 2


def test_one_fiber_family_leaves_the_shape_free():
    (fault,) = tube_faults(alpha=30, beta=30)
    assert "both are 30 degree (line DF of Figure 1-2)" in fault
    (fault,) = tube_faults(alpha=30, beta=30.4999)
    assert "less than 0.5 degree apart" in fault
    assert Actuator(**PAM | {"alpha": 30, "beta": 30.5}).beta == 30.5


def test_angles_that_rounding_brings_a_little_too_close_are_allowed():
    """2.018 - 1.518 is less than 0.5."""
    assert 2.018 - 1.518 < 0.5
    tube = Actuator(alpha=1.518, beta=2.018, length=0.1, radius=5e-3, wall=1e-3, material=MooneyRivlin(1e5, 5e4))
    assert (tube.alpha, tube.beta) == (1.518, 2.018)


def test_fibers_lie_in_the_wall():
    outer = PAM["radius"] + PAM["wall"]
    assert Actuator(**PAM).fiber_surface == PAM["radius"]
    assert Actuator(**PAM | {"fiber_radius": PAM["radius"]}).fiber_surface == PAM["radius"]
    assert Actuator(**PAM | {"fiber_radius": outer}).fiber_surface == outer
    for outside in (0.999 * PAM["radius"], 1.001 * outer):
        (fault,) = tube_faults(fiber_radius=outside)
        assert fault.startswith("fiber_radius: found")


def test_the_outer_radius_as_a_person_writes_it_is_in_the_wall():
    """The sum of radius and wall in floating point may fall one digit short of the number that a person writes."""
    for micrometres in range(1600, 9000, 7):
        radius, wall = micrometres * 1e-6, 1.59e-3
        written = (micrometres + 1590) * 1e-6
        assert Actuator(**PAM | {"radius": radius, "wall": wall, "length": 1, "fiber_radius": written})


def test_a_wall_thicker_than_the_radius_warns_at_the_line_that_made_it():
    with pytest.warns(UserWarning, match=r"wall 0\.005 m is thicker than the inner radius 0\.00476 m") as caught:
        Actuator(**PAM | {"wall": 5e-3})
    assert caught[0].filename == __file__
    Actuator(**PAM | {"wall": PAM["radius"]})  # warnings are errors in these tests


def test_extended_fibers_that_cannot_meet_the_clamped_ends():
    (fault,) = tube_faults(alpha=80, beta=70, fiber_extension=1.2)
    assert fault.startswith("fiber_extension: with 1.2 these fibers cannot meet the clamped ends")
    assert Actuator(**PAM | {"alpha": 80, "beta": -80, "fiber_extension": 1.2}).clamped_stretch() > 0


def test_materials_are_checked_as_well():
    assert [fault.split(":")[0] for fault in faults_of(MooneyRivlin, c10=0, c01=-1.0)] == ["c10", "c01"]
    (fault,) = faults_of(MooneyRivlin, c10="0.1 mm")
    assert "expects a pressure such as '0.1 MPa', got '0.1 mm', a length" in fault
    (fault,) = faults_of(NeoHookean, c10=-1)
    assert fault == "c10: found -1 Pa; it has to be above 0"


def test_neo_hookean_is_mooney_rivlin_without_its_second_constant():
    material = NeoHookean(c10=0.1e6)
    assert (material.c10, material.c01, repr(material)) == (0.1e6, 0.0, "NeoHookean(c10=100000.0)")
    assert Actuator(**PAM | {"material": material}).design()["c01"] == 0.0
    with pytest.raises(TypeError):
        NeoHookean(1e5, 1e4)


def test_a_design_holds_every_number_that_a_sweep_would_vary():
    design = Actuator(**PAM).design()
    assert design == {
        "alpha": 30, "beta": -30, "length": 0.192, "radius": 4.76e-3, "wall": 1.59e-3, "fiber_radius": 4.76e-3,
        "fiber_extension": 1, "c10": 0.11e6, "c01": 0.06e6, "c20": 0.0, "c30": 0.0,
    }  # fmt: skip


def test_a_cord_and_its_turns():
    """b = 0.25 m, n = 1.5, l = 0.2 m: the triangle 3-4-5, 36.87 degree on a radius of 0.15 m/(3 pi) = 15.92 mm."""
    rest = {"wall": 2e-3, "material": MooneyRivlin(0.2e6)}
    inner = Actuator.from_cord(cord="0.25 m", turns=1.5, length=0.2, **rest)
    assert inner.alpha == pytest.approx(36.8699, abs=1e-4)
    assert inner.beta == -inner.alpha
    assert inner.radius == pytest.approx(0.15 / (3 * np.pi), rel=1e-12)
    outer = Actuator.from_cord(cord=0.25, turns=1.5, length=0.2, model="physical", **rest)
    assert outer.fiber_surface == pytest.approx(15.915e-3, abs=1e-6)
    assert outer.radius == pytest.approx(outer.fiber_surface - 2e-3)
    given = Actuator.from_cord(cord=0.25, turns=1.5, length=0.2, radius=15e-3, **rest)
    assert (given.radius, given.fiber_surface) == (15e-3, pytest.approx(15.915e-3, abs=1e-6))


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"cord": 0.2}, "it has to be longer"),
        ({"turns": -1}, "turns: found -1"),
        ({"alpha": 30}, "leave alpha and a fiber radius out"),
        ({"turns": 30, "model": "physical"}, "less than the wall inside it"),
        ({"model": "thesis"}, "model: found"),
    ],
)
def test_cords_that_make_no_muscle(changes, says):
    given = {"cord": 0.25, "turns": 1.5, "length": 0.2, "wall": 2e-3, "material": MooneyRivlin(0.2e6)} | changes
    with pytest.raises(ActuatorError, match=says):
        Actuator.from_cord(**given)


def test_a_rubber_may_be_given_by_its_name():
    given = {"alpha": 30, "beta": -30, "length": 0.1, "radius": 5e-3, "wall": 1e-3}
    named = Actuator(**given, material="Dragon Skin 30")
    assert named == Actuator(**given, material=freesweep.material("dragon-skin-30"))
    with pytest.raises(ActuatorError, match="'latx'; did you mean 'natural-latex'"):
        Actuator(**given, material="latx")


def test_what_is_written_of_an_actuator_makes_it_and_is_short():
    plain = Actuator(alpha=30, beta=None, length=0.1, radius=5e-3, wall=1e-3, material=NeoHookean(1e5))
    text = "Actuator(alpha=30.0, beta=None, length=0.1, radius=0.005, wall=0.001, material=NeoHookean(c10=100000.0), "
    assert repr(plain) == text + "model='source')"
    varied = Actuator(alpha=[(0, 20), (1, 40)], beta=-40, length=0.1, radius=5e-3, wall=1e-3, taper=0.2,
                      material=freesweep.Yeoh(1e5, 0.0, 1e3), model="physical", fiber_radius="middle")  # fmt: skip
    names = {name: getattr(freesweep, name) for name in ("Actuator", "NeoHookean", "Yeoh", "Profile")}
    assert all(eval(repr(tube), names) == tube for tube in (plain, varied))

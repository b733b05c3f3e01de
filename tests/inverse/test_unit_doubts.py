"""Slips of units in wishes are doubted, what is meant is not."""

import pytest

import freesweep as fs
from freesweep.inverse import freedom
from freesweep.inverse.unit_doubts import doubts_of

TUBE = fs.Actuator(alpha=30, beta=-50, length=0.15, radius=5e-3, wall=1e-3, material=fs.MooneyRivlin(1.2e5, 6e4))
RANGES = {"alpha": (0, 85), "radius": (3e-3, 12e-3)}
TURN = fs.Goal("rotation", 90, pressure=1e5)


def doubted(free, *asked):
    faults = []
    space = freedom.read(TUBE, free, faults)
    assert not faults
    return doubts_of(space, [wish for one in asked for wish in one.wishes([])])


@pytest.mark.parametrize(
    ("free", "asked", "said"),
    [
        (RANGES, [fs.Goal("rotation", 90, pressure=100)], "no pressure exceeds 100 Pa"),
        (RANGES | {"pressure": (0, 300)}, [fs.Goal("rotation", 90)], "no pressure exceeds 300 Pa"),
        (RANGES, [TURN, fs.Limit("limit_pressure", at_least=300)], "no pressure exceeds 300 Pa"),
        (RANGES, [fs.Goal("rotation", 1.57, pressure=1e5)], "no rotation that is wished for exceeds 1.57 degree"),
        (RANGES, [fs.Goal("deformed_length", 200, pressure=1e5)], "the wished deformed_length of 200 m"),
        (RANGES, [TURN, fs.Limit("outer_radius", at_most=7.5, pressure=1e5)], "the wished outer_radius of 7.5 m"),
        (RANGES, [TURN, fs.Goal("volume", 12, pressure=1e5)], "the wished volume of 12 m3"),
        (RANGES, [fs.Goal("stroke", 20, pressure=1e5)], "the wished stroke of 20"),
        (RANGES, [fs.Goal("force", 9, pressure=1e5, deformed_length=150)], "a held length of 150 m"),
        (RANGES, [fs.Goal("force", 9e7, pressure=1e5)], "a force of 9e+07 N"),
        ({"alpha": (0, 1.4), "beta": (-1.4, 1.4)}, [TURN], "no fiber angle exceeds 1.4 degree"),
        ({"radius": (3, 12)}, [TURN], "the radius is 12 m"),
    ],
)
def test_slips_of_units_are_doubted(free, asked, said):
    (only,) = doubted(free, *asked)
    assert only.startswith(said)


@pytest.mark.parametrize(
    ("free", "asked"),
    [
        (RANGES, [TURN, fs.Goal("length_change", between=(-5e-4, 5e-4), pressure=1e5)]),
        (
            RANGES,
            [fs.Goal("rotation", between=(-0.5, 0.5), pressure=1e5), fs.Goal("stroke", at_least=0.2, pressure=1e5)],
        ),
        (RANGES | {"pressure": (0, 3e5)}, [fs.Goal("torque", 0.1), fs.Limit("limit_pressure", at_least=3e5)]),
        ({"wall": (3e-4, 6e-3), "radius": (3e-3, 12e-3)}, [TURN]),  # the thickest and the slimmest are not one tube
        ({"alpha": fs.Profile(3, between=(0, 85)), "beta": "-alpha", "material": ["ecoflex-00-30"]}, [TURN]),
        (RANGES, [fs.Goal("deformed_length", 0.1, pressure=float("inf"))]),
        (RANGES, [fs.Goal("wall", at_least=1e-3)]),
    ],
)
def test_what_is_meant_is_not_doubted(free, asked):
    assert doubted(free, *asked) == []


def test_a_design_warns_where_it_is_called():
    with pytest.warns(UserWarning, match="exceeds 1.57 degree") as said:
        fs.design(TUBE, {"wall": (9e-4, 1.1e-3)}, fs.Goal("rotation", 1.57, pressure=1e5), count=1)
    assert said[0].filename == __file__

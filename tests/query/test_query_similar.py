"""Locked tubes between the nodes of length and radius: similar tubes are alike, a grid holds more of them than its nodes."""

import numpy as np
import pytest
from grids import make, spec

from freesweep import Actuator, Atlas, MooneyRivlin, lock
from freesweep.sweep.spec import parse

AXES = {
    "alpha": [25.0, 35.0], "beta": [-55.0, -45.0], "length": [0.08, 0.13, 0.2], "radius": [4e-3, 6e-3, 8e-3],
    "pressure": [0.0, 1e5],
}  # fmt: skip
WALL = 1.59e-3
POWERS = {"locked_deformed_length": 1, "locked_rotation": 0, "locked_mid_radius": 1}


@pytest.fixture(scope="module", params=["source", "physical"])
def atlas(request, tmp_path_factory):
    text = spec(AXES).replace('energy = "full"', f'energy = "full"\nmodel = "{request.param}"')
    path = tmp_path_factory.mktemp("similar") / "atlas.nc"
    data = make(path, parse(text))
    return request.param, data, Atlas(data, path)


def surface(model, radius):
    return radius + (WALL if model == "physical" else 0.0)


def test_a_tube_larger_all_over_than_one_of_the_grid_is_told_from_it(atlas):
    model, data, asked = atlas
    larger = surface(model, 5e-3) / surface(model, 4e-3)
    found = asked.query(list(POWERS), alpha=25.0, beta=-55.0, length=0.13 * larger, radius=5e-3)
    assert int(found.locked_status) == 0
    node = data.sel(alpha=25.0, beta=-55.0, length=0.13, radius=4e-3)
    for name, power in POWERS.items():
        assert float(found[name]) == pytest.approx(float(node[name]) * larger**power, rel=1e-10), name
    beyond = asked.query("locked_rotation", alpha=25.0, beta=-55.0, length=[0.21], radius=5e-3)
    assert beyond.locked_status.values.tolist() == [8]  # similar tubes are there, such lengths are not


def test_what_a_locked_tube_is_told_lies_within_its_error(atlas):
    """All but the energy of a thick wall, which is that of no similar tube."""
    model, _, asked = atlas
    names = ["deformed_length", "rotation", "mid_radius", "volume", *(["strain_energy"] if model == "source" else [])]
    rubber = MooneyRivlin(0.17e6, 0.08e6)
    for length, radius in ((0.09, 4.4e-3), (0.12, 6.7e-3), (0.17, 5.1e-3), (0.19, 7.9e-3)):
        tube = Actuator(alpha=25, beta=-55, length=length, radius=radius, wall=WALL, material=rubber, model=model)
        right = lock(tube, x=0.0)
        found = asked.query(alpha=25.0, beta=-55.0, length=length, radius=radius, pressure=0.0)
        for name in names:
            error = abs(float(found[f"locked_{name}"]) - float(right[name]))
            assert error <= float(found[f"locked_{name}_error"]) + float(right[f"{name}_error"]), name


def test_slopes_are_those_of_the_numbers(atlas):
    _, _, asked = atlas
    f = asked.interpolator("locked_volume")
    at = np.array([25.0, -55.0, 0.12, 6.7e-3])
    assert f.axes == ("alpha", "beta", "length", "radius")
    _, slopes = f(*at, gradient=True)
    for k in (2, 3):
        step = np.zeros(4)
        step[k] = 1e-5 * at[k]
        assert slopes[k] == pytest.approx((f(*(at + step)) - f(*(at - step))) / (2.0 * step[k]), rel=1e-5)

"""Rings that a callable makes, of any width and height anywhere along the tube: solved as from pairs, or refused."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from freesweep import Actuator, ActuatorError, MooneyRivlin, Profile, inflate
from freesweep.description.splines import SENSITIVITY
from freesweep.status import OK

R = 5e-3
SMOOTH = {
    "gauss": lambda t: np.exp(-4.0 * t * t),
    "flanks": lambda t: 0.5 * (np.tanh(8.0 * (t + 1.0)) - np.tanh(8.0 * (t - 1.0))),
    "cosh": lambda t: 1.0 / np.cosh(np.clip(5.0 * t, -300.0, 300.0)),
    "lorentz": lambda t: 1.0 / (1.0 + 9.0 * t * t),
}
SHARP = {"box": lambda t: np.where(np.abs(t) < 1.0, 1.0, 0.0), "tent": lambda t: np.maximum(0.0, 1.0 - np.abs(t))}
NAMES = ("deformed_length", "rotation", "volume", "strain_energy", "mid_radius", "outer_radius")


def draw(rng, shape):
    """A design, which quantity of it varies, the ring and about where it lies: place and half the width (shares of the
    length), up to five times what is beside it; and a pressure.
    """
    of_wall = bool(rng.integers(2))
    base = R * 10.0 ** rng.uniform(-1.4, -0.8) if of_wall else rng.uniform(8.0, 14.0)
    half, height = 0.5 * 10.0 ** rng.uniform(-3.0, np.log10(0.2)), 10.0 ** rng.uniform(np.log10(0.2), np.log10(5.0))
    given = {"alpha": 30.0, "beta": -33.0 if not of_wall else -25.3, "length": R * rng.uniform(10.0, 40.0), "radius": R}
    given |= {"wall": 0.1 * R, "material": MooneyRivlin(1e5, 0.4e5)}
    pressure, place = (
        1e5 * 10.0 ** rng.uniform(-1.5, -0.3) * (2.0 * base / R if of_wall else 0.2),
        rng.uniform(0.0, 1.0),
    )

    def ring(share):
        return base * (1.0 + (height - 1.0) * shape((share - place) / half))

    return given, "wall" if of_wall else "alpha", ring, place, half, pressure


def pairs_of(ring, place, half):
    """The ring as a spline through places x/l, close to each other about it, ever farther away from it; and by how much it
    misses the ring, relative, in the mean along the tube.
    """

    def places(fine):
        near = np.linspace(-2.0, 2.0, 120 * fine + 1)
        far = np.sinh(np.linspace(np.arcsinh(2.0), np.arcsinh(1.0 / half), 40 * fine + 1))[1:]
        x = place + half * np.concatenate([-far[::-1], near, far])
        x = x[(x > 1e-5) & (x < 1.0 - 1e-5) & (np.abs(x - 0.5) > 1e-5)]
        return np.concatenate([[0.0], x, [1.0]])

    x, between = places(1), places(16)
    missed = np.trapezoid(np.abs(CubicSpline(x, ring(x))(between) / ring(between) - 1.0), between)
    return Profile(list(zip(x, ring(x))), smooth=True), missed


@pytest.mark.filterwarnings("ignore:wall")
@pytest.mark.parametrize("count", [8, pytest.param(400, marks=pytest.mark.long)])
def test_a_smooth_ring_is_solved_within_its_bounds_or_refused(count):
    rng, solved = np.random.default_rng(14), 0
    for k in range(count):
        given, name, ring, place, half, pressure = draw(rng, list(SMOOTH.values())[k % len(SMOOTH)])
        try:
            found = inflate(Actuator(**given | {name: ring}), pressure, x=0.0)
        except ActuatorError:
            with pytest.raises(ActuatorError, match="changes too fast to be followed"):
                inflate(Actuator(**given | {name: ring}), pressure)
            continue
        pairs, missed = pairs_of(ring, place, half)
        other = inflate(Actuator(**given | {name: pairs}), pressure, x=0.0)
        assert found["status"] == other["status"] == OK
        for output in NAMES:
            size = max(abs(other[output].item()), {"rotation": 1.0}.get(output, 0.0))
            allowed = found[f"{output}_error"] + other[f"{output}_error"] + 0.5 * SENSITIVITY * missed * size
            assert abs(found[output] - other[output]) <= allowed, (k, output)
        solved += 1
    assert solved > 0.8 * count


@pytest.mark.parametrize("shape", SHARP)
def test_a_sharp_ring_is_refused_with_what_to_do(shape):
    rng = np.random.default_rng(15)
    for _ in range(4):
        given, name, ring, _, _, pressure = draw(rng, SHARP[shape])
        with pytest.raises(ActuatorError, match=r"changes too fast to be followed.* give pairs"):
            inflate(Actuator(**given | {name: ring}), pressure, x=0.0)

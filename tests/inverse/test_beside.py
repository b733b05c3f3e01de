"""Held states beside known ones, in two numbers: also where what would let go of the tube turns it back."""

import numpy as np
import pytest

import freesweep as fs
from freesweep.inverse import freedom
from freesweep.inverse.beside import Held, beside, load_slopes
from freesweep.inverse.predict import predict
from freesweep.inverse.vectors import Kind
from freesweep.query.reference import COLUMNS

RUBBER = fs.MooneyRivlin(1.2e5, 6e4)
# both tubes are held where no free one has such a load, or none that vectors come to
TURNED = {"alpha": 22.98, "beta": 36.51, "radius": 5.14e-3, "length": 0.06901, "wall": 1.57e-3}, "torque", 88154.0
SWOLLEN = {"alpha": 42.33, "beta": 32.73, "radius": 6.05e-3, "length": 0.1807, "wall": 6.676e-4}, "force", 253851.0
GENTLE = {"alpha": 30.0, "beta": -40.0, "radius": 6e-3, "length": 0.1, "wall": 1e-3}, "force", 40000.0
SHORTER = 0.97  # of their length: those of which the force is told


def tube(design):
    return fs.Actuator(**design, material=RUBBER, model="physical")


def alone(design, kind, pressure):
    """Load, its bound and the middle's radius of one held tube, by itself."""
    at = SHORTER * design["length"] if kind == "force" else 0.0
    held = (fs.blocked_force if kind == "force" else fs.blocked_torque)(tube(design), pressure, at, x=0.0)
    return [held[name].item() for name in (kind, f"{kind}_error", "mid_radius")]


def as_points(designs, kind, pressure):
    rows = [tube(design).design() | {"pressure": pressure, "held": SHORTER * (kind == "force")} for design in designs]
    return np.array([[row.get(name, 0.0) for name in COLUMNS] for row in rows])


@pytest.mark.filterwarnings("ignore::UserWarning")  # of thick walls
@pytest.mark.parametrize(("design", "kind", "pressure"), [TURNED, SWOLLEN, GENTLE])
def test_a_held_state_beside_another_is_what_one_tube_alone_has(design, kind, pressure):
    """Found from the state of a tube that is wider by a hundredth, and how its load grows with the radius."""
    wider, step = design | {"radius": 1.01 * design["radius"]}, 2e-3 * design["radius"]
    load, _, middle = alone(wider, kind, pressure)
    stretch = middle / tube(wider).fiber_surface
    own = Kind.of(tube(design))
    held = Held(kind, as_points([design], kind, pressure), own)
    found = beside(held, np.array([load]), np.array([stretch]), 1e-6)
    value, bound, middle = alone(design, kind, pressure)
    assert abs(found.load.item() - value) <= bound + found.bound.item()
    assert found.bound.item() <= 1e-5 * abs(value)
    assert found.middle.item() == pytest.approx(middle / tube(design).fiber_surface, rel=1e-4)
    ends = [design | {"radius": design["radius"] + sign * step} for sign in (1, -1)]
    changed = tuple(Held(kind, as_points([end], kind, pressure), own) for end in ends)
    slope = load_slopes(held, [changed], found.load, found.middle, step).item()
    more, less = (alone(end, kind, pressure)[0] for end in ends)
    assert slope == pytest.approx((more - less) / (2.0 * step), rel=1e-2)


def test_beside_what_is_far_away_is_nothing():
    """A pair that no step leads from to a state is told as none, not as another number."""
    design, kind, pressure = GENTLE
    held = Held(kind, as_points([design] * 2, kind, pressure), Kind.of(tube(design)))
    found = beside(held, np.array([1e9, np.nan]), np.array([30.0, 1.1]), 1e-6)
    assert np.isnan(found.load).all()
    assert np.isnan(found.middle).all()


@pytest.mark.filterwarnings("ignore::UserWarning")  # of thick walls
@pytest.mark.parametrize("alpha", [54.6, 53.0])
def test_a_tube_that_no_longer_stays_straight_is_found_beside_one_that_does(alpha):
    """From 54.74 degrees on all its threads pull as it is undeformed; below, one family is slack and the other swells it."""
    design = {"alpha": 55.0, "beta": 34.289, "length": 0.05586, "radius": 5.2675e-3, "wall": 1.3048e-3}
    wishes = fs.Goal("torque", 0.0, pressure=128506.0).wishes([])
    space, choice = freedom.read(tube(design), {"alpha": (50.0, 60.0)}, []), np.zeros(1, int)
    straight = predict(space, wishes, space.point(np.array([55.0]))[None], choice, 1e-7, thorough=False)
    assert np.isfinite(straight.values.item())
    assert np.isnan(straight.middles.item())
    found = predict(space, wishes, space.point(np.array([alpha]))[None], choice, 1e-7, thorough=False, near=straight)
    value, bound, middle = alone(design | {"alpha": alpha}, "torque", 128506.0)
    assert abs(found.values.item() - value) <= bound + found.bounds.item()
    assert found.middles.item() == pytest.approx(middle, rel=1e-4)
    assert middle > 1.001 * (design["radius"] + design["wall"])

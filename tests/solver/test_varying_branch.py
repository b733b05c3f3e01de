"""Tubes that vary stay on the branch from rest: an independent continuation is the judge, and no list matters."""

import warnings

import numpy as np
import pytest
from varying_branch import LOST, PUSHED, branch

from freesweep import Actuator, MooneyRivlin, inflate
from freesweep.description.profiles import as_profile
from freesweep.status import BEYOND_LIMIT, COMPRESSED, OK

C10, R0 = 1e5, 5e-3
COUNTS = (1, 2, 11, 41)  # pressures in a list that ends at the same one


def stepped(a1, a2, at, b, length, wall, ratio, energy="principal"):
    """A tube whose first angle steps from a1 to a2 at a share of its length; lengths in radii."""
    return Actuator(
        alpha=[(0, a1), (at, a1), (at, a2), (1, a2)], beta=b, length=length * R0, radius=R0, wall=wall * R0,
        material=MooneyRivlin(C10, ratio * C10), energy=energy,
    )  # fmt: skip


def inflated(tube, pressures, f=0.0, m=0.0):
    """States at dimensionless loads, without profiles."""
    force, torque = f * np.pi * R0**2 * C10, m * np.pi * R0**3 * C10
    return inflate(tube, np.asarray(pressures) * C10, force=force, torque=torque, x=[0.0])


@pytest.mark.parametrize(
    ("tube", "pressure", "limit"),
    [
        (stepped(80, 71, 0.7, 31, 6, 0.07, 0.1), 0.12, 0.0894553),
        (stepped(83, 60, 0.8, 12, 6, 0.04, 0.0), 0.49, 0.0109703),
    ],
    ids=["71 of 80 degrees", "60 of 83 degrees"],
)
@pytest.mark.parametrize("count", COUNTS)
def test_no_list_of_pressures_leads_through_a_snap(tube, pressure, limit, count):
    """Limits of an independent continuation in arclength; 41 pressures once passed through the first with status 0."""
    found = inflated(tube, pressure if count == 1 else np.linspace(0.0, pressure, count))
    pressures = np.atleast_1d(found["pressure"].values) / C10
    assert np.atleast_1d(found["status"].values).tolist() == [OK if p < limit else BEYOND_LIMIT for p in pressures]
    assert found["limit_pressure"].item() / C10 == pytest.approx(limit, abs=5e-7)


def test_states_just_below_a_limit_are_solved_and_just_above_are_not():
    """Within 1e-3 to 1e-7 of the fold, where a mesh may have no state: the status is told by the located fold, the values
    are the branch's, whose rotation falls as the root of what is left.
    """
    tube = stepped(80, 71, 0.7, 31, 6, 0.07, 0.1)
    at_once = inflated(tube, 0.12)
    limit, bound = at_once["limit_pressure"].item() / C10, at_once["limit_pressure_error"].item() / C10
    gaps = np.array([1e-3, 1e-4, 1e-5, 1e-6, 1e-7])
    assert bound < 0.1 * gaps[-1] * limit
    below = inflated(tube, np.sort(limit * (1.0 - gaps)))
    assert np.isin(below["status"].values, [0, 5]).all()
    rotation = below["rotation"].values  # the farthest first
    slopes = np.diff(rotation) / np.diff(np.sqrt(gaps))
    assert (np.diff(np.abs(slopes)) < 0.0).all()
    assert slopes[-2] == pytest.approx(slopes[-1], rel=0.05)  # one slope, close to the fold
    above = inflated(tube, np.sort(limit * (1.0 + gaps)))
    assert (above["status"] == BEYOND_LIMIT).all()


# --- random tubes


def profile(draw, low, high):
    """A step, a line, or ten steps, between two values."""
    kind = draw.integers(3)
    if kind == 0:
        at, (u, v) = draw.uniform(0.15, 0.85), draw.uniform(low, high, 2)
        return [(0, u), (at, u), (at, v), (1, v)]
    if kind == 1:
        return list(zip((0, 1), draw.uniform(low, high, 2)))
    return [(k / 10, value) for j, value in enumerate(draw.uniform(low, high, 10)) for k in (j, j + 1)]


def random_tube(draw, loads):
    """(actuator, p, f, m); None where no actuator is of that kind."""
    base, spread = draw.uniform(5, 85), draw.uniform(2, 25)
    given = {"alpha": profile(draw, max(base - spread, 2), min(base + spread, 87)), "beta": draw.uniform(-85, 85)}
    if draw.random() < 0.3:
        b = draw.uniform(-80, 80)
        given["beta"] = profile(draw, b - 5, b + 5)
    wall = draw.uniform(0.02, 0.5) * R0
    given["wall"] = wall if draw.random() < 0.7 else profile(draw, 0.7 * wall, 1.3 * wall)
    given["length"] = R0 * np.exp(draw.uniform(np.log(4), np.log(60)))
    given["material"] = MooneyRivlin(C10, draw.choice([0.0, draw.uniform(0, 1)]) * C10)
    given["energy"] = str(draw.choice(["principal", "full"]))
    given["fiber_extension"] = 1 + (draw.uniform(0, 0.02) if loads and draw.random() < 0.5 else 0.0)
    f = 0.5 * draw.normal() if loads and draw.random() < 0.7 else 0.0
    m = 0.2 * draw.normal() if loads and draw.random() < 0.5 else 0.0
    p = np.exp(draw.uniform(np.log(0.01), np.log(5)))
    try:
        return Actuator(radius=R0, **given), p, f, m
    except ValueError:
        return None


def random_tubes(seed, count, loads):
    draw, made = np.random.default_rng(seed), 0
    while made < count:
        case = random_tube(draw, loads)
        if case is not None:
            made += 1
            yield case


def judged(tube, p, f, m):
    """What the independent continuation says: see :func:`branch`."""
    alpha, beta, wall = (as_profile(value) for value in (tube.alpha, tube.beta, tube.wall))
    length = tube.length / R0

    def cells(x):
        return alpha.at(x / length), beta.at(x / length), (1 + wall.at(x / length) / R0) ** 2 - 1

    breaks = np.unique(np.concatenate([alpha.breaks, beta.breaks, wall.breaks])) * length
    return branch(cells, breaks, tube.material.c01 / C10, tube.energy, p, tube.fiber_extension, f, m)


def verdict(tube, p, f, m):
    """LOST where the judge does not know, '' where both agree, else what differs."""
    found = inflated(tube, p, f, m)
    status = found["status"].item()
    state, fold, none = judged(tube, p, f, m)
    if none == PUSHED:
        return "" if status == COMPRESSED else f"status {status} where the wall is pushed"
    if none == LOST or status not in (OK, BEYOND_LIMIT):
        return none or f"status {status}"
    if status == OK and state is None:
        return f"ok beyond {fold}"
    if status == OK:
        found = found["deformed_length"].item() / R0, np.radians(found["rotation"].item())
        sizes = tube.length / R0, max(1.0, abs(state[1]))
        return "" if np.all(np.abs(found - state) < 5e-3 * np.array(sizes)) else f"{found} for {state}"
    if state is not None:
        return f"no limit up to {p}"
    limit = found["limit_pressure"].item() / C10
    known = np.isfinite(limit) and np.isfinite(fold)
    return f"{limit} for {fold}" if known and limit != pytest.approx(fold, rel=1e-2) else ""


def by_list(tube, p, f, m):
    """What a state is at the end of each list: status, numbers and limit."""
    found = set()
    for count in COUNTS:
        pressures = p if count == 1 else np.linspace(p / count, p, count)
        last = inflated(tube, pressures, f, m).isel(pressure=-1) if count > 1 else inflated(tube, p, f, m)
        names = ("status", "deformed_length", "rotation", "volume", "limit_pressure")
        found.add(tuple(repr(last[name].item()) for name in names))
    return found


@pytest.mark.parametrize("loads", [False, True], ids=["pressure alone", "loads and extension"])
def test_random_tubes_against_an_independent_continuation(loads):
    for case in random_tubes(11, 4, loads):
        assert verdict(*case) in ("", LOST), case


@pytest.mark.parametrize("loads", [False, True], ids=["pressure alone", "loads and extension"])
def test_a_state_does_not_depend_on_the_list_it_is_asked_in(loads):
    for case in random_tubes(12, 12, loads):
        assert len(by_list(*case)) == 1, case


@pytest.mark.long
@pytest.mark.parametrize("loads", [False, True], ids=["pressure alone", "loads and extension"])
def test_two_hundred_random_tubes_against_an_independent_continuation(loads):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        verdicts = [verdict(*case) for case in random_tubes(13, 100, loads)]
    assert verdicts.count(LOST) <= 5
    assert sum(said not in ("", LOST, "status 6") for said in verdicts) == 0
    assert verdicts.count("status 6") <= 1


@pytest.mark.long
@pytest.mark.parametrize("loads", [False, True], ids=["pressure alone", "loads and extension"])
def test_two_thousand_random_tubes_in_lists_of_all_lengths(loads):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert [case for case in random_tubes(14, 1000, loads) if len(by_list(*case)) > 1] == []


@pytest.mark.parametrize(
    ("alpha", "beta", "length", "wall", "extension", "pressure"),
    [
        (74.73, 80.82, 39.2, 0.334, 1.01, 0.19), (85.11, -84.1, 9.6, 0.386, 1.1, 0.43),
        (53.19, 86.26, 38.7, 0.142, 1.02, 0.87), (-84.33, -76.86, 12.0, 0.09, 1.01, 0.073),
        (66.73, 83.62, 11.2, 0.358, 1.02, 1.8), (53.03, 73.33, 11.9, 0.326, 1.1, 1.1),
    ],
)  # fmt: skip
def test_extended_steep_fibers_stand_upright_at_the_ends_of_tubes_that_vary(
    alpha, beta, length, wall, extension, pressure
):
    """By meshes, whose slopes have a millionth of room there, and less, as by vectors, which ask for no slope."""
    tubes = [
        Actuator(
            alpha=alpha, beta=beta, length=length * R0, radius=R0, wall=own, material=MooneyRivlin(C10, 0.5 * C10),
            fiber_extension=extension,
        )
        for own in (wall * R0, [(0, wall * R0), (1, wall * R0 * (1.0 + 1e-10))])
    ]  # fmt: skip
    alike, varying = (inflated(tube, pressure) for tube in tubes)
    assert (alike["status"].item(), varying["status"].item()) == (OK, OK)
    for name in ("deformed_length", "rotation", "volume", "mid_radius"):
        bound = alike[name + "_error"].item() + varying[name + "_error"].item() + 1e-9 * abs(alike[name].item())
        assert abs(alike[name].item() - varying[name].item()) <= bound

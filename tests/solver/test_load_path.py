"""One path of loads for each design, whatever pressures are asked for, in whatever list (theory, section 7)."""

import numpy as np
import pytest
from varying_branch import branch

from freesweep import Actuator, MooneyRivlin, Yeoh, inflate
from freesweep.first_integral.folded import solve_near
from freesweep.first_integral.uniform import Tubes
from freesweep.solver import batch
from freesweep.solver.load_path import legs, settling_pressure
from freesweep.solver.problem import FORCE, GAMMA, PROBLEM_SIZE, TORQUE
from freesweep.status import BEYOND_LIMIT, COMPRESSED, INACCURATE, OK

R0, C10 = 5e-3, 1e5


def problems(**columns):
    """Rows of loads only."""
    rows = np.zeros((len(next(iter(columns.values()))), PROBLEM_SIZE))
    rows[:, GAMMA] = 1.0
    for name, values in columns.items():
        rows[:, {"f": FORCE, "m": TORQUE, "gamma": GAMMA}[name]] = values
    return rows


def test_the_settling_pressure_is_that_of_the_theory():
    """max(2 max(0, -f), |m|, gamma^2 - 1): a pulled tube needs none."""
    given = problems(f=[0.0, -0.4, 0.7, 0.0, -0.1], m=[0.0, 0.3, 0.0, -0.2, 0.0], gamma=[1.0, 1.0, 1.0, 1.0, 1.2])
    assert settling_pressure(given) == pytest.approx([0.0, 0.8, 0.0, 0.2, 0.44])


def test_legs_rise_and_fall_from_the_settled_state():
    """A loaded tube's pressures go up and down from it, an unloaded one's stay a list; a locked state rises."""
    given = problems(f=[0.0, -0.5], m=[0.0, 0.0])
    first, pressures = np.array([0, 2, 6]), np.array([0.5, 2.0, 0.6, 0.8, 3.0, np.inf])
    found = legs(given, first, pressures)
    walks = [
        (k, up, found.pressures[a:b].tolist(), found.rows[a:b].tolist())
        for k, up, a, b in zip(found.owners, found.upward, found.first[:-1], found.first[1:])
    ]
    assert walks == [
        (0, True, [0.5, 2.0], [0, 1]),
        (1, True, [1.0, 3.0, np.inf], [-1, 4, 5]),
        (1, False, [1.0, 0.8, 0.6], [-1, 3, 2]),
    ]


# --- states that once hung on what else was asked for


def test_two_stable_states_at_one_pressure_are_not_mixed_up():
    """-22.4 or +379.0 degrees it was once, with status 0 and stable both times."""
    tube = Actuator(
        alpha=-12.7, beta=22.9, length=0.0361, radius=R0, wall=1.586e-4, energy="principal",
        material=MooneyRivlin(C10, 0.61e5),
    )  # fmt: skip
    lists = ([13400.0], np.linspace(100.0, 13400.0, 30), np.linspace(13400.0, 40000.0, 10))
    rotations = []
    for pressures in lists:
        found = inflate(tube, pressures, torque=0.0447, x=[0.0]).sel(pressure=13400.0)
        assert found["status"] == OK
        rotations.append(found["rotation"].item())
    assert rotations == pytest.approx([rotations[0]] * 3, abs=1e-6)


def test_a_range_that_has_ended_is_ended_in_every_list():
    tube = Actuator(
        alpha=10.23, beta=27.33, length=0.8173, radius=R0, wall=3.05e-4, material=MooneyRivlin(C10, 1.434e5)
    )
    lists = ([1e3, 1e4, 1e5, 2.577e5], [2e5, 2.577e5], [2.577e5], [1e3, 2.577e5])
    ends = [inflate(tube, pressures, torque=0.04027, x=[0.0]).sel(pressure=2.577e5) for pressures in lists]
    assert len({end["status"].item() for end in ends}) == 1
    rotations = [end["rotation"].item() for end in ends]
    assert rotations == pytest.approx([rotations[0]] * len(lists), rel=1e-7)
    early = [
        inflate(tube, pressures, torque=0.04027, x=[0.0])["status"].values for pressures in ([1e3], [1e3, 2.577e5])
    ]
    assert early[0][0] == early[1][0]


@pytest.mark.parametrize(
    ("share", "status"), [(0.13, OK), (0.148, BEYOND_LIMIT), (0.15, BEYOND_LIMIT), (1.0, BEYOND_LIMIT)]
)
def test_loads_that_settle_while_fibers_are_extended_lead_through_no_snap(share, status):
    """A short tube that a force draws in snaps where fibers extend, too, before the uniform tube does: it once went through,
    with status 0.
    """
    tube = Actuator(
        alpha=49.45667950028321, beta=-81.70092587727888, length=20.359503343718558 * R0, radius=R0, wall=0.04362 * R0,
        material=Yeoh(C10, 0.0501569 * C10, 0.0), energy="principal", fiber_extension=1 + 0.0079901576 * share,
    )  # fmt: skip
    found = inflate(tube, 0.0338771 * share * C10, force=1.2817579 * share * np.pi * R0**2 * C10, x=[0.0])
    assert found["status"] == status


# --- no pressure


def test_a_pulled_tube_is_regular_without_pressure():
    """The condition is p y^2 + f > 0: values go on continuously to P = 0."""
    tube = Actuator(alpha=28.6, beta=-50, length=0.1, radius=R0, wall=1e-3, material=MooneyRivlin(C10, 0.5 * C10))
    found = inflate(tube, [0.0, 1.0, 10.0], force=2.0, x=[0.0])
    assert (found["status"] == OK).all()
    length = found["deformed_length"].values
    assert length[0] - length[1] == pytest.approx((length[1] - length[2]) / 9, rel=1e-2)


def test_a_tube_under_torque_alone_is_the_limit_of_falling_pressures():
    tube = Actuator(alpha=28.6, beta=-50, length=0.1, radius=R0, wall=1e-3, material=MooneyRivlin(C10, 0.5 * C10))
    found = inflate(tube, [0.0, 1e-4, 1.0], torque=0.01, x=[0.0, 0.05])
    assert np.isin(found["status"], [OK, INACCURATE]).all()  # tensions, where the ends' layers have no length
    rotation = found["rotation"].values
    assert rotation[0] == pytest.approx(rotation[1], abs=1e-5)
    assert abs(rotation[1] - rotation[2]) < 1e-2
    pushed = inflate(tube, [0.0, 1.0], force=-1.0, x=[0.0])
    assert (pushed["status"] == COMPRESSED).all()


def problem(alpha, beta, length, wall, gamma, ratio, full, f=0.0, m=0.0):
    """A row of problems from angles in degrees; ``length`` and ``wall`` in radii."""
    ta, tb = np.tan(np.radians([alpha, beta]))
    return [0.5 * (ta + tb), 0.5 * (ta - tb), wall * (2.0 + wall), gamma, ratio, full, f, m, length, 0.0, 0.0]


def states(row, pressures):
    return batch.walk_all(
        np.array([row]), np.array([0, len(pressures)]), np.array(pressures), batch.uniform(24), 1e-6
    )  # fmt: skip


SNAPS = [  # designs of a census whose loads settle through a fold, or whose pressure falls through one
    ([81.42094542, -39.20016669, 3.08941942, 0.31222384, 1.01865458, 0.19935339, 0.0, 1.30855967], 0.01843689),
    ([8.25466882, -80.90930343, 5.8071007, 0.43746311, 1.01778139, 0.93248384, 0.0], 0.0070341),
    ([-20.08438605, 83.33049413, 185.0105, 0.09916933, 1.01486304, 1.12685075, 0.0, 1.75120006, 1.02170426], 0.0868004),
]


@pytest.mark.parametrize(("design", "pressure"), SNAPS)
def test_loads_that_settle_through_a_fold_have_no_state_beyond_it(design, pressure):
    """Steps along the uniform tube alone passed over it; a continuation by someone else meets it, too."""
    row = problem(*design)
    assert states(row, [pressure]).status.tolist() == [BEYOND_LIMIT]
    alpha, beta, length, _, gamma, ratio, full, f, m = [*design, 0.0, 0.0][:9]

    def cells(x):
        return alpha + 0.0 * x, beta + 0.0 * x, row[2] + 0.0 * x

    state, fold, none = branch(
        cells, [0.0, 0.5 * length, length], ratio, "full" if full else "principal", pressure, gamma, f, m
    )
    assert (state, none) == (None, None)
    assert fold is not None


@pytest.mark.parametrize(("design", "pressures", "middles"), [
    ([-4.37683126, -7.23066935, 75.035155, 0.11796579, 1.0, 1.44629299, 0.0, 2.31393988],
     [0.0284708, 1.0150317, 2.0429121, 2.1385999], [1.0165, 20.919, 23.312, 23.388]),
    ([16.77631388, 15.84023592, 169.1242, 0.48121495, 1.0, 1.15460133, 0.0, 0.0, 0.67208396],
     [0.0801633, 0.1582366, 9.6332216], [0.9895, 0.997, 57.6]),
])  # fmt: skip
def test_nearly_straight_fibers_swell_through_no_fold_whichever_pressures_are_asked_for(design, pressures, middles):
    """A mesh loses the branch; a trace over a short way of the load must look as far as one over a long way."""
    row = problem(*design)
    for asked in (pressures, pressures[1:2], pressures[-1:]):
        found = states(row, asked)
        assert found.status.tolist() == [OK] * len(asked)
        assert found.values[:, 4] == pytest.approx([middles[pressures.index(p)] for p in asked], rel=2e-2)
        given = [np.full(len(asked), number) for number in row]
        H, D, area, gamma, ratio, full, f, m, length, *yeoh = given
        tubes = Tubes(H, D, area, gamma, ratio, full, np.array(asked), f, m, 1.0 + 0.0 * H, 0.5 * length, *yeoh)
        exact, whole = solve_near(tubes, found.values[:, 4]), np.array([2.0, 2.0, 2.0, 2.0, 1.0])
        assert np.all(np.abs(found.values * whole - exact.values) <= found.bounds * whole + 3.0 * exact.errors)

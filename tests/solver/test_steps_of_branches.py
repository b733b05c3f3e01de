"""What hid between the steps of branches in two numbers, or beside their ends: found by comparing censuses of two versions.
Right values are those of meshes, which follow branches in another way.
"""

import numpy as np
import pytest
from proportional import judged_near

import freesweep as fs
from freesweep.census.designs import BLOCK, COLUMNS, Drawn, draw, with_pressures
from freesweep.description.tube_model import MODELS
from freesweep.solver import batch, hold_batch
from freesweep.solver.held.sought import HELD_LENGTH
from freesweep.solver.problem import FORCE, GAMMA, LENGTH, TORQUE
from freesweep.status import BEYOND_LIMIT, HELD_IMPOSSIBLE, INACCURATE, OK

ACCURACY = 1e-6


def of_census(seed, number, model="source"):
    """``(problems, pressures)`` of one design of a census."""
    drawn = draw(BLOCK, seed, number // BLOCK, MODELS[model])
    row = slice(number % BLOCK, number % BLOCK + 1)
    return drawn.problems(MODELS[model])[row], drawn.pressures[row].ravel()


def walked(problems, pressures):
    return batch.walk_all(problems, np.array([0, len(pressures)]), pressures, batch.uniform(24), ACCURACY)


def test_branch_whose_meridians_end_is_not_left_for_another():
    """It turns back at .7111 of its loads, where meridians stand upright; another branch goes on at .75."""
    assert walked(*of_census(5, 109)).status.tolist() == [BEYOND_LIMIT] * 4


def test_snap_that_bends_between_two_looks_is_seen():
    """At .245 of its loads the branch falls back by 7e-5 of them, within one step of .05."""
    assert walked(*of_census(1002, 1478)).status.tolist() == [BEYOND_LIMIT] * 4


@pytest.mark.parametrize(("column", "load", "limit"), [
    (TORQUE, 0.0, 0.088962666), (TORQUE, 1e-12, 0.088962666), (TORQUE, 1e-4, 0.0895045764), (GAMMA, 1e-9, 0.088962666),
])  # fmt: skip
def test_snap_beside_the_chord_of_a_step_is_seen(column, load, limit):
    """The branch runs level from .165 of the way on and rises again behind that; its chord led on, and from loads of any
    smallness. A load that strains a tube less than can be told is none.
    """
    problems, _ = of_census(77, 658)
    problems[:, FORCE], problems[:, TORQUE], problems[:, GAMMA] = 0.0, 0.0, 1.0
    problems[:, column] += load
    walks = walked(problems, np.array([0.05, 0.088, 0.09, 0.1, 1.0]))
    assert walks.status.tolist() == [OK, OK, *[BEYOND_LIMIT] * 3]
    assert walks.limits[0, 0] == pytest.approx(limit, rel=1e-5)


@pytest.mark.parametrize("number", [137, 340, 666])
def test_steep_loose_fibers_at_little_pressure_are_not_beyond_a_limit(number):
    """Their density had another maximum by mistake, and so a corner, at which the branch turned."""
    assert walked(*of_census(77, number, "physical")).status.tolist() == [OK] * 4


@pytest.mark.parametrize(("seed", "number", "model", "middles"), [
    (1001, 2053, "source", [0.96855554, 0.9687558, 0.98251802, 0.98532672]),
    (1002, 593, "physical", [0.88149921, 0.88203437, 0.93061381, 2.26576074]),
])  # fmt: skip
def test_loads_that_come_to_rest_just_before_a_turning_point_do_come(seed, number, model, middles):
    walks = walked(*of_census(seed, number, model))
    assert walks.status.tolist() == [OK] * 4
    assert walks.values[:, batch.MIDDLE] == pytest.approx(middles, abs=2e-8)


@pytest.mark.parametrize("number", [231, 442, 763, 2309, 3424])
def test_states_just_below_a_limit_are_found_and_none_beyond_it(number):
    problems, pressures = of_census(1001, number)
    limit, bound = walked(problems, pressures).limits[0]
    near = limit * (1.0 - np.array([1e-3, 1e-4, 1e-5]))
    walks = walked(problems, np.array([*near, limit - 2.0 * bound, limit + 2.0 * bound]))
    assert walks.status[:3].tolist() == [OK] * 3
    assert walks.status[3] in (OK, INACCURATE)
    assert walks.status[4] == BEYOND_LIMIT
    moves = np.diff(walks.values[:4, batch.MIDDLE])
    assert np.all(moves > 0.0) or np.all(moves < 0.0)
    assert abs(moves[0]) > 2.0 * abs(moves[1]) > 2.0 * abs(moves[2])  # as the root of what is left to the limit


def test_long_tube_that_is_all_but_unstrained_is_met_as_far_as_its_middle_tells():
    """The strain of its middle has four digits, and the length of half of it hangs on all of them."""
    design = [-5.317899980449575, 4.51754848898938, 62.295061518100276, 0.12064316165333397, 1.0134814859182115,
              1.7863240625295373, 2.686293332225546, -0.8369012114982275, 1.0]  # fmt: skip
    pressures = np.array([0.03493084719235909])
    walks = walked(Drawn(np.array([design]), None).problems(), pressures)
    assert walks.status.tolist() == [OK]
    exact, errors = judged_near(with_pressures(np.array([design]), pressures[None])[0], walks.values[:, batch.MIDDLE])
    assert np.all(np.abs(walks.values - exact) <= walks.bounds + 3 * errors)


def test_tube_that_is_slack_all_along_is_told_so_where_its_uniform_part_begins():
    """A tube whose middle is all but uniform: what is left of it counts as its middle."""
    problems, pressures = of_census(5, 185, "physical")
    walks = walked(problems, pressures)
    assert walks.status[0] == OK
    assert walks.values[0, batch.OUTPUTS : batch.OUTPUTS + 2] == pytest.approx([1.0, 1.0], abs=1e-6)


def test_held_length_that_stands_under_a_pull_alone_is_found():
    """Free of a pull the tube would snap, and so it would on the way there with its length held."""
    problems, pressures = of_census(3001, 396)
    problems[:, FORCE] = 0.0
    held = hold_batch.hold_all(
        problems, problems[:, LENGTH].copy(), HELD_LENGTH, np.array([0, 1]), pressures[-1:], batch.uniform(24), ACCURACY
    )
    assert held.status.tolist() == [OK]
    drawn = draw(BLOCK, 3001, 396 // BLOCK, MODELS["source"]).designs[396 % BLOCK]
    design = with_pressures(drawn[None], pressures[None, -1:])[0]
    design[0, COLUMNS.index("force")] = held.loads[0]
    (exact,), (error,) = judged_near(design, held.states.values[:, batch.MIDDLE])
    assert 2.0 * exact[0] == pytest.approx(problems[0, LENGTH], rel=1e-9)
    assert np.all(np.abs(held.states.values[0] - exact) <= held.states.bounds[0] + error)


def test_held_rotation_behind_a_snap_is_found_from_a_strong_torque():
    """A free tube turns by 591 degrees under this torque; neither from the cylinder nor from rest leads a way there."""
    tube = fs.Actuator(
        alpha=65.64556561289325, beta=-11.051712103875174, length=0.05511720363501679, radius=5e-3,
        wall=5.743529811445565e-4, material=fs.MooneyRivlin(1e5, 30926.911548883596),
        fiber_extension=1.0023090317030987, model="source",
    )  # fmt: skip
    pressure, torque = 283043.3624134087, 0.09925517957995209
    held = fs.blocked_torque(tube, pressure, fs.inflate(tube, pressure, torque=torque)["rotation"].item(), x=0.0)
    assert (held["status"], held["stable"], held["held_path"]) == (OK, 1, 1)
    assert held["torque"].item() == pytest.approx(torque, rel=1e-6)


def test_length_that_a_pull_only_nears_is_impossible():
    """The longest that a pull makes of it is 1.1499 of its length, which the clamped ends keep it from."""
    problems, pressures = of_census(3002, 20)
    problems[:, FORCE] = 0.0
    target = 1.15022 * problems[:, LENGTH]
    held = hold_batch.hold_all(
        problems, target, HELD_LENGTH, np.array([0, 1]), pressures[-1:], batch.uniform(24), ACCURACY
    )
    assert held.status.tolist() == [HELD_IMPOSSIBLE]


def held_at_its_length(number):
    """``(problems, pressure, what is found)`` of one design of a census, held at its undeformed length."""
    problems, pressures = of_census(11, number)
    problems[:, FORCE] = 0.0
    lengths, last = problems[:, LENGTH].copy(), pressures[-1:]
    found = hold_batch.hold_all(problems, lengths, HELD_LENGTH, np.array([0, 1]), last, batch.uniform(24), ACCURACY)
    return problems, last, found


@pytest.mark.parametrize("number", [91, 2846, 4736])
def test_undeformed_lengths_that_a_strong_pull_leads_to(number):
    """They were pushed, or lost, by what was told; under the force found the free tube has that length."""
    problems, pressure, found = held_at_its_length(number)
    assert found.status.tolist() == [OK]
    problems[:, FORCE] = found.loads
    free = walked(problems, pressure)
    assert free.status.tolist() == [OK]
    assert 2.0 * free.values[0, 0] == pytest.approx(problems[0, LENGTH], rel=1e-7)


def test_a_way_that_begins_with_a_push_refuses_nothing():
    """A pull leads to this length, through a snap that holding keeps from it; the force is that of meshes."""
    _, _, found = held_at_its_length(4468)
    assert found.status.tolist() == [OK]
    assert found.loads[0] == pytest.approx(-1.46060373772, abs=1e-6)

"""Held rotations by a body and necks, as waves, against meshes, which need many cells for the steep fronts between them."""

import numpy as np
import pytest

from freesweep.census.designs import BLOCK, Drawn, draw
from freesweep.description.tube_model import MODELS
from freesweep.solver import hold_batch
from freesweep.solver.batch import uniform
from freesweep.solver.by_waves.held import at_share, held_of
from freesweep.solver.held.held_states import FEW
from freesweep.solver.held.sought import HELD_ROTATION, valued
from freesweep.solver.hold_batch import HOLDER, hold_all
from freesweep.solver.status import PENDING
from freesweep.status import BEYOND_LIMIT, OK

# physical tubes, a pressure; torque, half the length and stretch in the middle, as 6144 cells had them in 22 s each
STEEP = [
    ([15.431305102519211, 44.93823946332156, 7.9710502477777165, 0.04907709776175995, 1.0128263491132814, 0, 0, 0, 1],
     9.849252141160441, (23.708223746, 3e-6), (2.1772448297, 2e-7), (2.3569461531, 2e-8)),
    ([-16.369318966655378, -12.081314958472333, 35.192243004270786, 0.06481679881398845, 1.0034487585359264, 0,
      1.2119778487369586, 0, 1],
     9.335299106270496, (-601.423886670, 1.3e-5), (8.1005354867, 2.3e-6), (11.4855942434, 1e-8)),
]  # fmt: skip
LOST = [
    -27.197593317699546,
    -38.63807223519364,
    9.769584549186158,
    0.047706873625206564,
    1,
    0.2576483519456496,
    0,
    0,
    1,
]
TURNING = [-32.1439470653154, -17.662940555429792, 5.962867703255069, 0.041333445793772, 1.0059375857368886,
           0.8429548873458472, 2.8726435437046556, 0, 0]  # fmt: skip


def problem_of(design, model="physical"):
    """A design (9,) as the kernels take it."""
    return Drawn(np.array([design], float), None).problems(MODELS[model])[0]


def held(problem, pressure, **options):
    """The state of a problem whose rotation is held at none."""
    given = problem[None], np.zeros(1), HELD_ROTATION, np.array([0, 1]), np.array([pressure]), uniform(24), 1e-6
    return hold_all(*given, **options)


def by_waves(problem, pressure, stations=np.empty(0)):  # noqa: B008
    """What waves tell, whether meshes have the state or not."""

    def find(problem, pressure, stations):
        return held(problem, pressure, stations=stations, meshes=FEW)

    with np.errstate(all="ignore"):
        return held_of(problem, pressure, find, 1e-6, stations)[:2]


@pytest.fixture
def no_fine_mesh(monkeypatch):
    """Only so few meshes are asked for a state as know gentle fronts."""
    asked = hold_batch.hold_many

    def few(*given):
        assert given[9] == FEW
        asked(*given)

    monkeypatch.setattr(hold_batch, "hold_many", few)


@pytest.mark.long  # kernels of held physical tubes take a minute to compile
@pytest.mark.parametrize(("design", "pressure", "torque", "length", "middle"), STEEP)
def test_steep_fronts_need_no_fine_mesh(design, pressure, torque, length, middle, no_fine_mesh):
    found = held(problem_of(design), pressure)
    assert (found.status[0], found.stable[0]) == (OK, 0)
    assert abs(found.loads[0] - torque[0]) <= found.load_bounds[0] + torque[1]
    for k, (value, bound) in ((0, length), (4, middle)):
        assert abs(found.states.values[0, k] - value) <= found.states.bounds[0, k] + bound
    assert abs(found.states.values[0, 2]) <= found.states.bounds[0, 2]


@pytest.mark.long
def test_a_family_that_goes_slack_in_the_necks_bends_the_branch_but_does_not_end_it(no_fine_mesh):
    """Meshes lost it there, a thirtieth of the way; where its fronts are no steeper than they hold, they have this state."""
    problem, pressure = problem_of(LOST), 7.635152895398032
    found = held(problem, pressure)
    assert (found.status[0], found.stable[0]) == (OK, 0)
    assert found.states.values[0, 6] > 0.2  # of the length one family is slack
    assert found.load_bounds[0] < 1e-6 * pressure
    gentle = held(at_share(problem, 0.03), 0.03 * pressure, lanes=False, meshes=FEW)
    status, state = by_waves(at_share(problem, 0.03), 0.03 * pressure)
    assert (gentle.status[0], status) == (OK, OK)
    assert abs(state.values[HOLDER] - gentle.loads[0]) <= state.bounds[HOLDER] + gentle.load_bounds[0]


def test_loads_turn_where_meshes_have_them_turn():
    """A tube of the source: where all loads, and extension, rise in proportion to more than 0.3073, there is no state."""
    problem, pressure = problem_of(TURNING, "source"), 1.8045022306673473
    for share, expected in ((0.306, OK), (0.309, BEYOND_LIMIT), (1.0, BEYOND_LIMIT)):
        part = at_share(problem, share)
        assert held(part, share * pressure, lanes=False).status[0] == expected
        assert by_waves(part, share * pressure)[0] == expected


@pytest.mark.parametrize("share", [0.302, 0.306])
def test_profiles_are_those_of_meshes(share):
    """And so is the state: in a body and in necks of one level."""
    problem, pressure = at_share(problem_of(TURNING, "source"), share), share * 1.8045022306673473
    stations = np.linspace(0.0, 0.5 * problem[8], 23)
    status, state = by_waves(problem, pressure, stations)
    mesh = held(problem, pressure, stations=stations, lanes=False)
    assert (status, state.unstable) == (OK, 1)
    half = len(state.profiles) // 2
    missed = np.abs(state.profiles[:half] - mesh.profiles[0, :half])
    assert np.all(missed <= state.profiles[half:] + mesh.profiles[0, half:] + 1e-12)
    agree(state, mesh)


def agree(state, mesh):
    """A state of waves and one of meshes, within both bounds."""
    assert abs(state.values[HOLDER] - mesh.loads[0]) <= state.bounds[HOLDER] + mesh.load_bounds[0]
    missed = np.abs(state.values[:HOLDER] - mesh.states.values[0, :HOLDER])
    assert np.all(missed <= state.bounds[:HOLDER] + mesh.states.bounds[0, :HOLDER] + 1e-12)
    assert (state.unstable == 0) == (mesh.stable[0] == 1)


@pytest.mark.long
@pytest.mark.parametrize(("model", "every"), [("source", 1), ("physical", 4)])
def test_random_tubes_agree_with_meshes(model, every):
    """Of all that vectors leave, where waves tell something."""
    told = 0
    for block in range(4):
        drawn = draw(BLOCK, 4217, block, MODELS[model])
        for i in range(0, BLOCK, every):
            problem, pressure = drawn.problems(MODELS[model])[i], drawn.pressures[i, -1]
            problem[7] = 0.0
            if held(problem, pressure, meshes=0).status[0] != PENDING:
                continue
            status, state = by_waves(problem, pressure)
            mesh = held(problem, pressure, meshes=FEW) if status != PENDING else None
            if mesh is None or mesh.status[0] == PENDING:
                continue
            told += 1
            if state is None:
                assert mesh.status[0] == status
            else:
                assert valued(mesh.status[0])
                agree(state, mesh)
    assert told > 20

"""Held rotations of physical tubes on meshes of one half: loose fibers that lean alike hold a tube by a body and a neck.
Numbers of the first two are those of the first integral, which needs no mesh: of body and neck, two tubes of one level and
one torque, with sixty Gauss points through the wall. Those of the third are of meshes.
"""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from freesweep.census.designs import Drawn
from freesweep.description.tube_model import MODELS
from freesweep.solver.batch import uniform
from freesweep.solver.held.sought import HELD_ROTATION
from freesweep.solver.hold_batch import hold_all
from freesweep.solver.load import Load
from freesweep.solver.physics import lagrangian
from freesweep.solver.problem import AREA, FORCE, GAMMA, D, H, rubber_of, wall_of
from freesweep.solver.problem import PHYSICAL as WALLS
from freesweep.status import OK

pytestmark = pytest.mark.long  # kernels of held physical tubes take a minute to compile
PHYSICAL = MODELS["physical"]


def problems_of(design):
    """The problem of a design (9,), as a census draws it."""
    return Drawn(np.array([design]), None).problems(PHYSICAL)


def held(design, pressure):
    """The state of a design whose rotation is held at 0."""
    problems = problems_of(design)
    first, pressures = np.array([0, 1]), np.array([pressure])
    return hold_all(problems, np.zeros(1), HELD_ROTATION, first, pressures, uniform(24), 1e-6)


@pytest.mark.parametrize(("design", "pressure", "torque", "length", "middle"), [
    ([60.99091840466424, 80.91559879419881, 7.380807575274864, 0.03494392269658605, 1, 1.7835173839931515,
      0.8704949364741545, 0, 1], 9.280020721866176, 6.5433736530, 5.6276365321, 0.2495698679),
    ([-24.075374152810625, -41.65905690875003, 9.42349077059473, 0.0761076876489904, 1.004457621907689,
      0.37763610780448387, 0, 0, 1], 2.821692658741028, -13.2042805798, 2.5804229317, 2.9479958265),
    ([-56.91749431646365, -77.81347127731952, 8.885795684282925, 0.054511865663208287, 1.0120260375436598,
      1.2916816380364926, 0, 0, 1], 2.084688201355496, -2.2208976581, 6.0323646000, 0.3936626740),
])  # fmt: skip
def test_fibers_that_lean_alike_hold_a_rotation_by_a_body_and_a_neck(design, pressure, torque, length, middle):
    """Meshes of a whole tube came to the first two, each to another state or none, and to one for the third that is not its
    own mirror image. Such a tube is unstable: its slope vanishes in the neck, too. There its hole all but closes: of as
    many Gauss points as the wall of a tube without load needs the first had a torque 2e-6 off.
    """
    found = held(design, pressure)
    assert (found.status[0], found.stable[0]) == (OK, 0)
    assert abs(found.loads[0] - torque) <= found.load_bounds[0] + 1e-8 * abs(torque)
    for k, value in ((0, length), (2, 0.0), (4, middle)):
        assert abs(found.states.values[0, k] - value) <= found.states.bounds[0, k] + 2e-9 * length


def test_a_wave_between_long_uniform_parts_is_stable_where_its_slope_vanishes_in_the_middle_alone():
    """It is moved along by next to nothing, of which a mesh may see the wrong sign; Sturm's theorem does not."""
    angles, length, wall = (-61.52826295367292, 75.17830600627589), 5.264911430379812, 0.13008709161177157
    design = [*angles, length, wall, 1.0, 0.4920642051320836, 0.0, 0.0, 1.0]
    found = held(design, 3.721141288625684)
    assert (found.status[0], found.stable[0]) == (OK, 1)
    assert found.states.values[0, 4] == pytest.approx(0.7984229, abs=1e-6)


@pytest.mark.parametrize(("design", "pressure", "wide", "thin"), [
    ([75.61673756551463, -72.41159656502948, 60.410349326177936, 0.03930184549640198, 1, 1.746762423301873, 0, 0, 1],
     5.324877960015256, (0.8, 1.0), (0.2, 0.4)),
    ([-79.6777965943833, 51.48890156752979, 125.50656768198166, 0.09392270573238604, 1, 0, 2.788489180637612, 0, 1],
     4.201290322599932, (0.8, 1.0), (0.35, 0.6)),
])  # fmt: skip
def test_a_thin_and_a_wide_part_share_a_tube_under_the_torque_at_which_they_balance(design, pressure, wide, thin):
    """Two phases of loose fibers at Maxwell's torque. On the way of a whole tube a mesh saw more unstable directions than
    there are, as a front is moved along by next to nothing, and the branch seemed to end far below the pressure.
    """
    problem, found = problems_of(design)[0], held(design, pressure)
    cell, wall = (problem[H], problem[D], problem[AREA]), wall_of(problem, WALLS)

    def largest(torque, between):
        load = Load(problem[GAMMA], rubber_of(problem), wall, pressure, problem[FORCE], torque, 1.0)
        level = minimize_scalar(
            lambda y: -lagrangian.uniform_tube(y, cell, load)[2],
            bounds=between,
            method="bounded",
            options={"xatol": 1e-12},
        )
        return -level.fun, level.x

    balanced = brentq(
        lambda torque: largest(torque, wide)[0] - largest(torque, thin)[0], *(found.loads[0] + np.array([-0.01, 0.01]))
    )
    assert (found.status[0], found.stable[0]) == (OK, 1)
    assert abs(found.loads[0] - balanced) <= found.load_bounds[0] + 1e-9
    assert found.load_bounds[0] < 1e-6 * pressure  # the accuracy, by the largest of the loads
    assert abs(found.states.values[0, 4] - largest(balanced, thin)[1]) <= found.states.bounds[0, 4] + 1e-6

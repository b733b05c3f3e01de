"""Held rotations of physical tubes on meshes of one half: loose fibers that lean alike hold a tube by a body and a neck.
Numbers are those of the first integral, which needs no mesh: of body and neck, two tubes of one level and one torque.
"""

import numpy as np
import pytest

from freesweep.census.designs import Drawn
from freesweep.description.tube_model import MODELS
from freesweep.solver.batch import uniform
from freesweep.solver.held.sought import HELD_ROTATION
from freesweep.solver.hold_batch import hold_all
from freesweep.status import OK

pytestmark = pytest.mark.long  # kernels of held physical tubes take a minute to compile
PHYSICAL = MODELS["physical"]


def held(design, pressure):
    """The state of a design (9,), as a census draws it, whose rotation is held at 0."""
    problems = Drawn(np.array([design]), None).problems(PHYSICAL)
    first, pressures = np.array([0, 1]), np.array([pressure])
    return hold_all(problems, np.zeros(1), HELD_ROTATION, first, pressures, uniform(24), 1e-6)


@pytest.mark.parametrize(("design", "pressure", "torque", "length", "middle"), [
    ([60.99091840466424, 80.91559879419881, 7.380807575274864, 0.03494392269658605, 1, 1.7835173839931515,
      0.8704949364741545, 0, 1], 9.280020721866176, 6.5409820019, 5.6281794037, 0.2491733457),
    ([-24.075374152810625, -41.65905690875003, 9.42349077059473, 0.0761076876489904, 1.004457621907689,
      0.37763610780448387, 0, 0, 1], 2.821692658741028, -13.1995093907, 2.5791472135, 2.9483345120),
    ([-56.91749431646365, -77.81347127731952, 8.885795684282925, 0.054511865663208287, 1.0120260375436598,
      1.2916816380364926, 0, 0, 1], 2.084688201355496, -2.2208957681, 6.0323730271, 0.3936574980),
])  # fmt: skip
def test_fibers_that_lean_alike_hold_a_rotation_by_a_body_and_a_neck(design, pressure, torque, length, middle):
    """A whole tube's meshes came to the first two, each to another state or none, and to one for the third that is not its
    own mirror image. Such a tube is unstable: its slope vanishes in the neck, too.
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

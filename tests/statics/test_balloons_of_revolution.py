"""Balloons and single families whose undeformed radius varies, against brute force."""

import itertools

import numpy as np
import pytest
from loose_tubes import Body

from freesweep import Actuator, MooneyRivlin, blocked_force, blocked_torque, inflate, interpret
from freesweep.solver.cells import cell_at
from freesweep.solver.load import Load
from freesweep.solver.numerics import newton as kernels_of_newton
from freesweep.solver.numerics import properties_along as kernels_of_course
from freesweep.solver.numerics.newton import Mesh
from freesweep.solver.physics import lagrangian as kernels_of_physics
from freesweep.statics import read_course
from freesweep.status import OK

RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)
RADIUS, WALL, LENGTH = 6e-3, 0.8e-3, 0.03
CONE, BULB = {"taper": 0.3}, {"taper": 0.1, "bulge": 0.3}


def balloon(**more):
    return Actuator(
        **{"alpha": None, "beta": None, "length": LENGTH, "radius": RADIUS, "wall": WALL, "material": RUBBER} | more
    )


# in plain Python: that takes less than the compiler for a few calls
course, lagrangian, newton = map(interpret._Twins, (kernels_of_course, kernels_of_physics, kernels_of_newton))


def brute(actuator, pressure, *, cells=64, **held):
    """Length, volume, twist, energy, middle and the held load, in units of the fiber radius at x = 0 and of C10."""
    r0 = actuator.fiber_surface
    length, inside = actuator.length / r0, WALL * actuator.fiber_share

    def surface(x, more):
        share = x / length
        shape = (1.0 - actuator.taper * share) * (1.0 + actuator.bulge * np.sin(np.pi * share) ** 2)
        return (RADIUS * shape + more) / r0

    fibers, inner, outer = (lambda x, more=more: surface(x, more) for more in (inside, 0.0, WALL))
    wall = (
        {"inner": inner, "outer": outer} if actuator.is_thick else {"section": lambda x: outer(x) ** 2 - inner(x) ** 2}
    )
    there = [getattr(actuator, name) is not None for name in ("alpha", "beta")]
    numbers = [getattr(actuator, name) or 0.0 for name in ("alpha", "beta")]
    angles = [lambda x, angle=angle: angle + 0.0 * x for angle in numbers]
    own = Body(
        fibers, *angles, length, [0.5 * length], loose=actuator.is_loose, there=there,
        rubber=(RUBBER.c01 / RUBBER.c10, 0, 0), **wall,
    )  # fmt: skip
    return own.extrapolated(pressure / RUBBER.c10, cells=cells, **held)


def outputs(actuator, found):
    """The first five of a Dataset."""
    r0, share = actuator.fiber_surface, np.linspace(0.0, 1.0, 20001)
    surface, inner = actuator.fiber_surface_at(share), actuator.profile("radius").at(share)
    inside = np.trapezoid(surface**2 - inner**2, share) * actuator.length / r0**3
    return [
        found["deformed_length"].item() / r0,
        found["volume"].item() / (np.pi * r0**3) + inside,
        np.radians(found["rotation"].item()),
        found["strain_energy"].item() / (np.pi * r0**3 * RUBBER.c10),
        found["mid_radius"].item() / r0,
    ]


def agree(mine, other, tolerance=2e-5):
    assert mine == pytest.approx(other, rel=tolerance, abs=0.1 * tolerance)


@pytest.mark.parametrize("shape", [CONE, BULB], ids=["cone", "bulb"])
def test_meshes_of_a_balloon_of_revolution_extrapolate_to_brute_force(shape):
    """Its density on 24 to 96 cells, each mesh spread by one smooth map."""
    actuator, pressure = balloon(**shape), 2e4
    (rows, _, places), _ = read_course(actuator, 1e-6)
    load = Load(1.0, (RUBBER.c01 / RUBBER.c10,), (1.0, 0.0, actuator.threads), pressure / RUBBER.c10, 0.0, 0.0, 1.0)
    found = []
    for n in (24, 48, 96):
        x = 0.5 * places[-1] * (1.0 + np.tanh(np.linspace(-2.0, 2.0, n + 1)) / np.tanh(2.0))
        y, work = np.ones(n + 1), np.zeros((13, n + 2))
        cells = course.fill(rows, np.array([0, n // 2, n]), x, n, n, course.make_cells(rows, n))
        with np.errstate(all="ignore"):
            status, *_ = newton.solve(lagrangian.density, y, Mesh(x, n, False, cells), load, 1e300, 1e-12, work)
        assert status == kernels_of_newton.CONVERGED
        middle, slope = 0.5 * (y[1:] + y[:-1]), np.diff(y) / np.diff(x)
        local = [lagrangian.integrands(*one, cell_at(cells, j), load) for j, one in enumerate(zip(middle, slope))]
        found.append(np.diff(x) @ np.array([one[:2] for one in local]))
    first, second = ((4.0 * fine - coarse) / 3.0 for coarse, fine in itertools.pairwise(found))
    extrapolated = (16.0 * second - first) / 15.0
    agree(extrapolated.tolist(), brute(actuator, pressure, cells=32)[:2])
    at_rest = np.mean(actuator.fiber_surface_at(np.linspace(0.0, 1.0, 2001)) ** 2) * LENGTH / actuator.fiber_surface**3
    assert extrapolated[1] > 1.1 * at_rest  # it has grown


@pytest.mark.long
@pytest.mark.parametrize("shape", [CONE, BULB], ids=["cone", "bulb"])
def test_a_balloon_of_revolution_is_that_of_brute_force(shape):
    actuator, pressure = balloon(**shape), 2e4
    found = inflate(actuator, pressure, x=0.0)
    assert found["status"] == OK
    assert found["rotation"] == 0.0
    assert found["mid_radius"].item() > 1.03 * actuator.fiber_surface_at(0.5).item()  # it has grown
    agree(outputs(actuator, found), brute(actuator, pressure)[:5])


@pytest.mark.long
@pytest.mark.parametrize(
    "more",
    [CONE | {"model": "physical"}, BULB | {"model": "physical"}, BULB | {"alpha": 40, "fibers": "loose"}],
    ids=["thick cone", "thick bulb", "bulb of one loose family"],
)
def test_thick_balloons_and_one_family_are_those_of_brute_force(more):
    actuator, pressure = balloon(**more), 2.5e4
    found = inflate(actuator, pressure, x=0.0)
    assert found["status"] == OK
    agree(outputs(actuator, found), brute(actuator, pressure)[:5])


@pytest.mark.long
@pytest.mark.parametrize("shape", [CONE, BULB], ids=["cone", "bulb"])
def test_a_held_balloon_of_revolution_is_that_of_brute_force(shape):
    actuator, pressure = balloon(**shape), 2e4
    for held in (1.0, 1.05):
        found = blocked_force(actuator, pressure, held * LENGTH, x=0.0)
        assert found["status"] == OK
        mine = [*outputs(actuator, found), found["force"].item() / (np.pi * actuator.fiber_surface**2 * RUBBER.c10)]
        agree(mine, brute(actuator, pressure, held="length", target=held * LENGTH / actuator.fiber_surface))


@pytest.mark.long
def test_a_held_rotation_of_one_family_on_a_cone_is_that_of_brute_force():
    actuator, pressure = balloon(alpha=40, fibers="loose", **CONE), 2e4
    found = blocked_torque(actuator, pressure, x=0.0)
    assert found["status"] == OK
    mine = [*outputs(actuator, found), found["torque"].item() / (np.pi * actuator.fiber_surface**3 * RUBBER.c10)]
    agree(mine, brute(actuator, pressure, held="rotation", target=0.0))

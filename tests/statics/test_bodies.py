"""Bodies of revolution: tubes whose radius varies along the axis."""

import dataclasses
import itertools

import numpy as np
import pytest
from loose_tubes import Body
from plain import by_what_there_is
from scipy.integrate import cumulative_trapezoid

from freesweep import (
    Actuator,
    ActuatorError,
    MooneyRivlin,
    Profile,
    blocked_force,
    blocked_torque,
    closed_form,
    inflate,
    interpret,
    lock,
    material,
    sweep,
)
from freesweep.cli import parser
from freesweep.cli.single import tube_of
from freesweep.description.profiles import as_profile
from freesweep.plot.shape import shape_of
from freesweep.solver.cells import cell_at
from freesweep.solver.load import Load
from freesweep.solver.numerics import mesh as kernels_of_mesh
from freesweep.solver.numerics import newton as kernels_of_newton
from freesweep.solver.numerics import properties_along as kernels_of_course
from freesweep.solver.numerics.newton import Mesh
from freesweep.solver.physics import lagrangian as kernels_of_physics
from freesweep.statics import read_course
from freesweep.status import OK

RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)
CONE = [(0, 8e-3), (1, 5e-3)]
WALL = 1e-3


# in plain Python: that takes less than the compiler for a few calls
course, lagrangian, mesh, newton = map(
    interpret._Twins, (kernels_of_course, kernels_of_physics, kernels_of_mesh, kernels_of_newton)
)


@pytest.fixture(autouse=True)
def no_clock(monkeypatch):
    """Plain Python may take its time, whatever others left on the clock."""
    monkeypatch.setattr(interpret, "_clock", interpret._Clock())


@pytest.fixture
def plain(monkeypatch):
    """States without the compiler, but for what it has made already: free states of bodies, before the whole suite."""
    monkeypatch.setattr(
        interpret, "at_once", lambda _, __, entry, *arguments, **___: by_what_there_is(entry, arguments)
    )


def bulb(share):
    return 6e-3 + 3e-3 * np.sin(np.pi * share) ** 2


def body(radius, alpha=20, beta=-40, length=0.06, **more):
    given = {"length": length, "radius": radius, "wall": WALL, "material": RUBBER}
    return Actuator(**{"alpha": alpha, "beta": beta} | given | more)


# --- the density at one point

SOURCE_LOAD = Load(1.01, (0.4,), (1.0,), 0.3, 0.05, -0.02, 1.0)
LOOSE_LOAD = Load(1.0, (0.4, 0.0, 0.0), (1.0, 0.6, 1.0), 0.3, 0.05, -0.02, 1.0)
LOADS = {"source": SOURCE_LOAD, "loose": LOOSE_LOAD}


@pytest.mark.parametrize("load", LOADS.values(), ids=LOADS)
def test_a_body_of_radius_one_is_the_tube(load):
    point, y, v = (0.2, 0.6, 0.4), 1.1, 0.2
    cell = (*point, 1.0, 0.0, load[2][1] if len(load[2]) > 1 else 0.0)
    direction = Load(0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.0)
    for name, more in (("density", ()), ("integrands", ()), ("conjugate", (direction,)), ("at_slope", ())):
        function = getattr(lagrangian, name)
        assert function(y, v, cell, load, *more) == pytest.approx(function(y, v, point, load, *more), rel=1e-14), name
        if name != "at_slope":  # and so is the mean along a cell
            cells = (function(y, v, (*one, 0.2), load, *more) for one in (cell, point))
            assert next(cells) == pytest.approx(next(cells), rel=1e-14), name
    for name, given in (("at_flux", (y, 0.1)), ("uniform_tube", (y,))):
        function = getattr(lagrangian, name)
        assert function(*given, cell, load) == pytest.approx(function(*given, point, load), rel=1e-14), name


@pytest.mark.parametrize("load", LOADS.values(), ids=LOADS)
@pytest.mark.parametrize("more", [(), (0.05,)], ids=["a point", "a cell"])
def test_derivatives_of_the_density_of_a_body_are_those_of_its_integrands(load, more):
    """``L = p V + f s + m psi - energy`` by the integrands; its differences are the density's derivatives, and so on."""
    cell = (0.2, 0.6, 0.4, 1.3, -0.4, 0.55, *more)

    def L(y, v):
        s, volume, twist, energy, _ = lagrangian.integrands(y, v, cell, load)
        return load[3] * volume + load[4] * s + load[5] * twist - energy

    y, v, h = 1.1, 0.2, 1e-5
    _, L_y, L_v, L_yy, L_yv, L_vv = lagrangian.density(y, v, cell, load)
    assert L_y == pytest.approx((L(y + h, v) - L(y - h, v)) / (2 * h), abs=1e-9)
    assert L_v == pytest.approx((L(y, v + h) - L(y, v - h)) / (2 * h), abs=1e-9)
    above, below = (lagrangian.density(y + d, v, cell, load) for d in (h, -h))
    right, left = (lagrangian.density(y, v + d, cell, load) for d in (h, -h))
    assert (L_yy, L_yv) == pytest.approx([(above[k] - below[k]) / (2 * h) for k in (1, 2)], abs=1e-8)
    assert L_vv == pytest.approx((right[2] - left[2]) / (2 * h), abs=1e-8)


@pytest.mark.parametrize("radius", [CONE, bulb, Profile([(0, 5e-3), (0.4, 9e-3), (1, 4e-3)], smooth=True)])
@pytest.mark.parametrize("model", ["source", "physical"])
def test_rest_is_rest(plain, radius, model):
    """At P = 0 the undeformed shape is stationary to rounding, whatever it is, and has its own length and volume."""
    actuator = body(radius, model=model)
    (rows, edges, places), _ = read_course(actuator, 1e-6)
    n = int(edges[-1])
    x = np.concatenate([np.linspace(a, b, 49)[:-1] for a, b in itertools.pairwise(places)] + [[places[-1]]])
    cells = course.fill(rows, edges, x, n, n, course.make_cells(rows, n))
    load = Load(1.0, (0.4, 0.0, 0.0), (1.0,) if model == "source" else (1.0, 0.5, 0.0), 0.0, 0.0, 0.0, 1.0)
    own = newton.system_in(np.zeros((8, n + 1)))
    newton.assemble(lagrangian.density, x, np.ones(n + 1), n, cells, load, False, own)
    assert np.max(np.abs(own.g[1:n])) < 1e-14 * np.max(np.abs(own.d))
    length = sum((b - a) * lagrangian.integrands(1.0, 0.0, cell_at(cells, j), load)[0]
                 for j, (a, b) in enumerate(itertools.pairwise(x)))  # fmt: skip
    assert length == pytest.approx(places[-1], rel=1e-14)
    rest = inflate(actuator, 0.0)
    inner = as_profile(actuator.radius).at(np.linspace(0, 1, 200001))
    assert rest["deformed_length"].item() == pytest.approx(actuator.length, rel=1e-14)
    assert rest["volume"].item() == pytest.approx(np.pi * actuator.length * np.trapezoid(inner**2, dx=5e-6), rel=1e-9)
    surface = actuator.fiber_surface_at(rest["x"].values / actuator.length)
    assert rest["deformed_radius"].values == pytest.approx(surface, rel=1e-14)
    assert rest["axial_position"].values == pytest.approx(rest["x"].values, abs=1e-15)
    widest, error = np.max(inner) + WALL, rest["outer_radius_error"].item()
    assert rest["outer_radius"].item() == pytest.approx(widest, abs=error + 1e-12)
    assert error < 1e-3 * widest
    assert rest["largest_stretch"].item() == pytest.approx(1.0, rel=1e-12)


# --- against what shares nothing with it


def brute(actuator, breaks, pressure, *, cells=96, **held):
    """Brute force for constant angles: length, volume, twist, energy, middle and the held load, dimensionless."""
    r0, l = actuator.fiber_surface, actuator.length / actuator.fiber_surface
    radius = actuator.radius if callable(actuator.radius) else lambda s: CONE[0][1] + (CONE[1][1] - CONE[0][1]) * s
    inside = actuator.wall * actuator.fiber_share
    fibers, inner, outer = (lambda x, more=more: (radius(x / l) + more) / r0 for more in (inside, 0.0, actuator.wall))
    wall = (
        {"inner": inner, "outer": outer} if actuator.is_thick else {"section": lambda x: outer(x) ** 2 - inner(x) ** 2}
    )
    angles = [lambda x, angle=angle: angle + 0 * x for angle in (actuator.alpha, actuator.beta)]
    own = Body(fibers, *angles, l, [share * l for share in breaks], loose=actuator.is_loose,
               rubber=(RUBBER.c01 / RUBBER.c10, 0, 0), **wall)  # fmt: skip
    return own.extrapolated(pressure / RUBBER.c10, cells=cells, **held)


def outputs(actuator, found):
    """The same of a Dataset."""
    r0, c10 = actuator.fiber_surface, RUBBER.c10
    share = np.linspace(0, 1, 20001)
    surface, inner = actuator.fiber_surface_at(share), actuator.profile("radius").at(share)
    inside = np.trapezoid(surface**2 - inner**2, share) * actuator.length / r0**3
    return [
        found["deformed_length"].item() / r0,
        found["volume"].item() / (np.pi * r0**3) + inside,
        np.radians(found["rotation"].item()),
        found["strain_energy"].item() / (np.pi * r0**3 * c10),
        found["mid_radius"].item() / r0,
    ]


def agree(mine, other, tolerance):
    assert mine == pytest.approx(other, rel=tolerance, abs=0.1 * tolerance)


def test_a_cone_of_the_source_is_that_of_brute_force(plain):
    actuator, pressure = body(CONE), 5e4
    found = inflate(actuator, pressure, x=0.0)
    assert found["status"] == OK
    agree(outputs(actuator, found), brute(actuator, [0.5], pressure)[:5], 1e-7)


def test_meshes_of_a_body_are_of_second_order_and_extrapolate_to_fourth():
    """The length of a bulb on 24 to 192 cells, spread by one smooth map, against brute force on its own meshes."""
    actuator, pressure = body(bulb, length=0.03), 1e5
    (rows, _, places), _ = read_course(actuator, 1e-6)
    load = Load(1.0, (RUBBER.c01 / RUBBER.c10,), (1.0,), pressure / RUBBER.c10, 0.0, 0.0, 1.0)
    found = []
    for n in (24, 48, 96, 192):
        x = 0.5 * places[-1] * (1.0 + np.tanh(np.linspace(-2.5, 2.5, n + 1)) / np.tanh(2.5))
        y, work = np.ones(n + 1), np.zeros((13, n + 2))
        base = np.array([0, n // 2, n])
        cells = course.fill(rows, base, x, n, n, course.make_cells(rows, n))
        with np.errstate(all="ignore"):
            status, *_ = newton.solve(lagrangian.density, y, Mesh(x, n, False, cells), load, 1e300, 1e-13, work)
        assert status == kernels_of_newton.CONVERGED
        middle, slope = 0.5 * (y[1:] + y[:-1]), np.diff(y) / np.diff(x)
        s = [lagrangian.integrands(*one, cell_at(cells, j), load)[0] for j, one in enumerate(zip(middle, slope))]
        found.append(np.diff(x) @ s)
    found = np.array(found)
    exact = brute(actuator, [0.5], pressure)[0]
    extrapolated = (4 * found[1:] - found[:-1]) / 3
    assert np.log2(np.abs((found - exact)[1:-1] / (found - exact)[2:])) == pytest.approx([2, 2], abs=0.1)
    assert np.log2(np.abs((extrapolated - exact)[-2] / (extrapolated - exact)[-1])) == pytest.approx(4, abs=0.4)


@pytest.mark.long
@pytest.mark.parametrize(
    ("actuator", "pressure", "tolerance"),
    [
        (body(bulb, 0, 30, 0.08, model="physical"), 3e4, 2e-5),
        (body(bulb, 10, 50, 0.08, model="physical", fibers="bonded"), 6e4, 1e-6),
    ],
    ids=["bulb of loose fibers and a thick wall", "bulb of bonded fibers and a thick wall"],
)
def test_free_states_are_those_of_brute_force(actuator, pressure, tolerance):
    found = inflate(actuator, pressure)
    assert found["status"] == OK
    agree(outputs(actuator, found), brute(actuator, [0.5], pressure)[:5], tolerance)


def check_held_length(model, tolerance):
    actuator, pressure = body(CONE, model=model), 5e4
    found = blocked_force(actuator, pressure)
    assert found["status"] == OK
    unit = np.pi * actuator.fiber_surface**2 * RUBBER.c10
    mine = [*outputs(actuator, found), found["force"].item() / unit]
    target = actuator.length / actuator.fiber_surface
    agree(mine, brute(actuator, [0.5], pressure, held="length", target=target), tolerance)


@pytest.mark.long
@pytest.mark.parametrize(("model", "tolerance"), [("source", 1e-7), ("physical", 2e-5)])
def test_a_held_length_of_a_cone_is_that_of_brute_force(model, tolerance):
    check_held_length(model, tolerance)


@pytest.mark.long
def test_a_held_rotation_is_that_of_brute_force():
    actuator, pressure = body(bulb, 0, 30, 0.08, model="physical"), 5e4
    found = blocked_torque(actuator, pressure)
    assert found["status"] == OK
    unit = np.pi * actuator.fiber_surface**3 * RUBBER.c10
    mine = [*outputs(actuator, found), found["torque"].item() / unit]
    agree(mine, brute(actuator, [0.5], pressure, held="rotation", target=0.0), 2e-5)


# --- the tube


def test_a_radius_that_does_not_vary_is_a_tube():
    straight = body([(0, 8e-3), (0.4, "8 mm"), (1, 8e-3)])
    assert straight == body(8e-3)
    assert not straight.is_body
    assert straight.radius == 8e-3
    assert body(8e-3, "geodesic 20 deg", wall="constant volume 1 mm") == body(8e-3)


def check_the_way_leads_to_the_tube(solve, model, tolerance):
    """A radius of a function that is constant is solved as a body is, and leads to the tube."""
    one = solve(body(8e-3, model=model))
    other = solve(body(lambda share: 8e-3 + 0 * share, model=model))
    for name in ("deformed_length", "volume", "rotation", "strain_energy", "mid_radius", "outer_radius", "force"):
        if name in one:
            assert other[name].item() == pytest.approx(one[name].item(), rel=tolerance, abs=1e-11), name
    for name in ("deformed_radius", "axial_position", "twist", "alpha_deformed", "fiber_tension_alpha"):
        assert other[name].values == pytest.approx(one[name].values, rel=100 * tolerance, abs=1e-11), name


WAYS = [lambda one: inflate(one, 5e4, 0.5, 1e-3), lambda one: blocked_force(one, 5e4)]


@pytest.mark.parametrize("solve", WAYS, ids=["free", "held"])
def test_the_way_of_bodies_leads_to_the_tube(plain, solve):
    check_the_way_leads_to_the_tube(solve, "source", 2e-7)  # the tube goes by its first integral


@pytest.mark.long
@pytest.mark.parametrize("solve", WAYS, ids=["free", "held"])
def test_the_way_of_bodies_leads_to_the_physical_tube(solve):
    check_the_way_leads_to_the_tube(solve, "physical", 2e-7)  # this one, too, by now


def test_a_long_slender_cone_is_locally_the_locked_cylinder(plain):
    actuator = body([(0, 8e-3), (1, 5e-3)], 30, -30, 0.8)
    locked = lock(actuator, x=[0.2, 0.4, 0.6])
    undeformed = actuator.fiber_surface_at(np.array([0.25, 0.5, 0.75]))
    expected = np.full(3, closed_form.locked_stretch(30, -30))
    assert locked["deformed_radius"].values / undeformed == pytest.approx(expected, rel=1e-7)
    assert locked["alpha_deformed"].values == pytest.approx(np.full(3, np.degrees(np.arctan(np.sqrt(2)))), abs=1e-5)


# --- windings, walls and netting


def test_a_geodesic_winding_of_a_cone_is_straight_when_it_is_unrolled():
    actuator = body(CONE, "geodesic 25 deg", -40)
    share = np.linspace(0, 1, 20001)
    r, alpha = actuator.fiber_surface_at(share), np.radians(actuator.angles(share)[0])
    slant = np.hypot(actuator.length, np.ptp(r))  # of the unrolled cone: distance from the apex r/sine
    sine = np.ptp(r) / slant
    around = cumulative_trapezoid(np.tan(alpha) * slant / r, share, initial=0.0)
    x, y = r / sine * np.cos(around * sine), r / sine * np.sin(around * sine)
    off = (y - y[0]) - (y[-1] - y[0]) / (x[-1] - x[0]) * (x - x[0])
    assert np.max(np.abs(off)) < 1e-8 * slant
    assert np.degrees(alpha[0]) == pytest.approx(25, rel=1e-12)
    assert alpha[-1] > alpha[0]


def test_a_wall_of_constant_volume_has_the_same_section_everywhere():
    actuator = body(bulb, wall="constant volume 1.2 mm")
    share = np.linspace(0, 1, 11)
    inner, wall = actuator.profile("radius").at(share), actuator.profile("wall").at(share)
    assert (inner + wall) ** 2 - inner**2 == pytest.approx((7.2e-3) ** 2 - (6e-3) ** 2, rel=1e-12)
    assert wall[5] == pytest.approx(np.sqrt(81 + 7.2**2 - 36) * 1e-3 - 9e-3)
    assert dataclasses.replace(actuator, length=0.1).wall == actuator.wall


def test_netting_of_a_vessel(plain):
    """Locked, the fibers alone carry P pi r^2 across every section, and in the cylinder lie at tan^2 = 2 (two shells)."""
    shape = Profile([(0, "5 mm"), (0.1, "7.4 mm"), (0.2, "8 mm"), (0.2, "8 mm"), (0.8, "8 mm"), (0.8, "8 mm"),
                     (0.9, "7.4 mm"), (1, "5 mm")], smooth=True)  # fmt: skip
    actuator = body(shape, "geodesic 50 deg", -40, 0.12)
    locked = lock(actuator, x=np.linspace(0, 0.12, 2001))
    assert locked["status"] == OK
    z, r = locked["axial_position"].values, locked["deformed_radius"].values
    upright = np.gradient(z) / np.hypot(np.gradient(z), np.gradient(r))
    a, b = (np.radians(locked[f"{name}_deformed"].values) for name in ("alpha", "beta"))
    pull = locked["fiber_tension_alpha"].values * np.cos(a) + locked["fiber_tension_beta"].values * np.cos(b)
    smooth = np.abs(np.linspace(0, 1, 2001) - 0.5) < 0.48
    assert (pull * upright)[smooth] == pytest.approx((np.pi * r**2)[smooth], rel=2e-4)
    assert np.tan(a[1000]) * -np.tan(b[1000]) == pytest.approx(2, rel=1e-2)


# --- what is refused, drawn and swept


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"radius": [(0, 8e-3), (0.5, 8e-3), (0.5, 6e-3), (1, 6e-3)]}, "radius: it jumps"),
        ({"radius": [(0, 8e-3), (1, -1e-3)]}, "radius: the profile falls to -0.001 m"),
        ({"fiber_radius": 6e-3}, "the radius varies; choose one of 'inner', 'middle', 'outer'"),
        ({"alpha": "geodesic 60 deg"}, r"turns back before x/l = 0.3"),
        ({"radius": Profile(3, (4e-3, 8e-3))}, "radius: its values are free"),
        ({"wall": "geodesic 1 mm"}, "wall: "),
    ],
)
def test_bodies_that_are_refused(more, message):
    with pytest.raises(ActuatorError, match=message):
        body(**({"radius": CONE} | more))


@pytest.mark.long
def test_a_sweep_of_bodies_is_their_single_states(tmp_path):
    atlas = sweep(
        alpha=20, beta=-40, radius=CONE, wall="1 mm", length=["50 mm", "60 mm"], material="dragon-skin-30",
        pressure=["30 kPa", "50 kPa"], model="physical", out=tmp_path / "cones.nc", progress=False,
    )  # fmt: skip
    one = inflate(body(CONE, model="physical", material=material("dragon-skin-30")), 5e4, x=0.0)
    with atlas:
        other = atlas.data.sel(length=0.06, pressure=5e4)
        for name in ("deformed_length", "volume", "rotation", "strain_energy", "mid_radius"):
            assert abs(other[name] - one[name]) <= other[f"{name}_error"] + one[f"{name}_error"], name


def test_what_varies_is_told_in_the_shell():
    words = ["inflate", "--alpha", "geodesic 20 deg", "--beta=-40", "--radius", "smooth 0:6mm,0.5:9mm,1:6mm", "--wall"]
    words += ["constant volume 1 mm", "--length", "80 mm", "--c10", "0.17 MPa", "--pressure", "1 bar"]
    tube = tube_of(parser().parse_args(words))
    assert tube.radius == Profile(((0.0, 6e-3), (0.5, 9e-3), (1.0, 6e-3)), smooth=True)
    assert tube.angles(0.5)[0].item() == pytest.approx(np.degrees(np.arcsin(np.sin(np.radians(20)) * 6 / 9)))
    assert tube.profile("wall").at(0.0).item() == pytest.approx(1e-3)


def test_a_body_is_drawn_with_its_radius():
    shape = shape_of(body(CONE))
    assert (shape.radius[0], shape.radius[-1], shape.position[-1]) == pytest.approx((8.0, 5.0, 60.0))
